/* test_elevations.c - elevations, vectors and display windows in every command that reads such files: equal numbers
   in each, missing values filled, and an error or a note where the result would be useless. Files are made here, byte
   by byte. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/exactmath.h"
#include "command/session.h"
#include "image/image.h"
#include "scene/environment.h"
#include "scene/scene.h"
#include "shade/environment_map.h"
#include "surface/triangles.h"

#include <math.h>
#include <string.h>

#define WIDTH 12
#define HEIGHT 8

/* A TIFF of one channel: format 1 unsigned, 2 signed, 3 float. */
typedef struct Dem {
    const char *name;
    int bits, format;
    bool geo;            /* has a pixel scale, as in GeoTIFF */
    const char *no_data; /* GDAL's tag; NULL: none */
    double missing;      /* the value of three pixels */
    bool white_is_0;
} Dem;

static void put(FILE *file, uint64_t value, int bytes)
{
    for (int k = 0; k < bytes; k++) putc((int)(value >> 8 * k & 0xff), file);
}

static void put_value(FILE *file, const Dem *dem, double value)
{
    uint64_t bits = 0;
    if (dem->format == 3) {
        const float single = (float)value;
        memcpy(&bits, &single, sizeof single);
    } else {
        bits = (uint64_t)(int64_t)value;
    }
    put(file, bits, dem->bits / 8);
}

static void put_tag(FILE *file, unsigned tag, unsigned type, unsigned count, uint64_t value)
{
    put(file, tag, 2);
    put(file, type, 2);
    put(file, count, 4);
    put(file, value, 4);
}

static bool is_missing(int x, int y)
{
    return y == 3 && x >= 4 && x < 7;
}

static double constant(int x, int y)
{
    (void)x, (void)y;
    return 200;
}

static double sloped(int x, int y)
{
    return 10 + 3 * x + 20 * y;
}

static double all_missing(int x, int y)
{
    (void)x, (void)y;
    return NAN;
}

/* TIFF 6.0: header, pixels, data of tags, one directory. */
static void write_dem(const Dem *dem, double (*elevation)(int, int))
{
    const unsigned size = WIDTH * HEIGHT * (unsigned)dem->bits / 8, scale = 8 + size;
    const unsigned text = scale + 24,
                   length = dem->no_data ? (unsigned)strlen(dem->no_data) + 1 : 0;
    FILE *file = fopen(dem->name, "wb");
    assert_non_null(file);
    fputs("II", file);
    put(file, 42, 2);
    put(file, text + 16, 4);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const double z = elevation(x, y);
            const bool lost = isnan(z) || (dem->missing != 0 && is_missing(x, y));
            put_value(file, dem, lost ? dem->missing : z);
        }
    for (int k = 0; k < 3; k++) { /* 1, 1, 0 */
        const double metres = k < 2;
        uint64_t bits;
        memcpy(&bits, &metres, sizeof bits);
        put(file, bits, 8);
    }
    for (unsigned k = 0; k < 16; k++) putc(k < length ? dem->no_data[k] : 0, file);
    put(file, 10U + dem->geo + (dem->no_data != NULL), 2);
    put_tag(file, 256, 3, 1, WIDTH);
    put_tag(file, 257, 3, 1, HEIGHT);
    put_tag(file, 258, 3, 1, (unsigned)dem->bits);
    put_tag(file, 259, 3, 1, 1);
    put_tag(file, 262, 3, 1, dem->white_is_0 ? 0 : 1);
    put_tag(file, 273, 4, 1, 8);
    put_tag(file, 277, 3, 1, 1);
    put_tag(file, 278, 3, 1, HEIGHT);
    put_tag(file, 279, 4, 1, size);
    put_tag(file, 339, 3, 1, (unsigned)dem->format);
    if (dem->geo) put_tag(file, 33550, 12, 3, scale);
    /* otherwise it is in the tag itself */
    assert_true(length == 0 || (length > 4 && length <= 16));
    if (dem->no_data) put_tag(file, 42113, 2, length, text);
    put(file, 0, 4);
    assert_int_equal(fclose(file), 0);
}

static const Dem dems[] = {
    { "u32.tif", 32, 1, false, NULL, 0, false },
    { "u32_white.tif", 32, 1, false, NULL, 0, true },
    { "u32_geo.tif", 32, 1, true, NULL, 0, false },
    { "u32_lost.tif", 32, 1, false, "4294967295", 4294967295.0, false },
    { "u16_geo.tif", 16, 1, true, NULL, 0, false },
    { "u16_geo_white.tif", 16, 1, true, NULL, 0, true },
    { "u16_lost.tif", 16, 1, false, "65535", 65535, false },
    { "u8_lost.tif", 8, 1, true, "255.0", 255, false },
    { "i16.tif", 16, 2, false, NULL, -32768, false },
    { "i16_lost.tif", 16, 2, false, "-12345", -12345, false },
    { "i32.tif", 32, 2, true, NULL, -32768, false },
    { "f32.tif", 32, 3, false, NULL, -9999, false },
    { "f32_lost.tif", 32, 3, true, "-12345", -12345, false },
};
#define DEMS (sizeof dems / sizeof *dems)

static void a_table_has_the_elevations_of_the_file(void **state)
{
    (void)state;
    char line[100];
    for (size_t d = 0; d < DEMS; d++) {
        WrSession *s = wr_session_new(NULL);
        write_dem(&dems[d], sloped);
        must_run(s, "table 12x8");
        snprintf(line, sizeof line, "terrain elevation %s", dems[d].name);
        must_run(s, line);
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++) {
                const double z = (double)f_at(s, x, y), want = sloped(x, y);
                const bool filled = dems[d].missing != 0 && is_missing(x, y);
                /* filled ones are between the rows above and below */
                if (fabs(z - want) > (filled ? 30.0 : 0.0))
                    fail_msg("%s at %d,%d: %g instead of %g", dems[d].name, x, y, z, want);
            }
        wr_session_free(s);
    }
}

/* Constant terrain of 200 with three missing values is flat: 200 times its height. */
static void a_terrain_has_the_elevations_of_the_file(void **state)
{
    (void)state;
    char line[100];
    for (size_t d = 0; d < DEMS; d++) {
        Said said = { "" };
        WrSession *s = listening(&said);
        write_dem(&dems[d], constant);
        snprintf(line, sizeof line, "surface terrain file=%s height=0.01", dems[d].name);
        must_run(s, line);
        const WrTriangles *mesh = doc(s)->scene->triangles;
        for (int32_t k = 0; k < mesh->corner_count; k++)
            if (fabs((double)mesh->corners[k].p[2] - 2.0) > 1e-5)
                fail_msg("%s: %g instead of 2", dems[d].name, (double)mesh->corners[k].p[2]);
        assert_int_equal(strstr(said.text, "3 missing values filled") != NULL,
                         dems[d].missing != 0);
        wr_session_free(s);
    }
}

/* Codes of a grey picture without such a tag are fractions of the largest, in the same commands. */
static void codes_without_a_tag_stay_codes(void **state)
{
    (void)state;
    static const Dem plain = { "u16.tif", 16, 1, false, NULL, 0, false },
                     tagged = { "u16_geo.tif", 16, 1, true, NULL, 0, false };
    WrSession *s = wr_session_new(NULL);
    write_dem(&plain, sloped);
    write_dem(&tagged, sloped);
    must_run(s, "table 12x8");
    static const char *const lines[] = { "terrain elevation u16.tif", "image u16.tif",
                                         "image u16_geo.tif",
                                         "terrain elevation u16_geo.tif values=code" };
    for (size_t k = 0; k < sizeof lines / sizeof *lines; k++) {
        must_run(s, lines[k]);
        assert_near((double)f_at(s, 2, 1), sloped(2, 1) / 65535, 1e-9);
    }
    wr_session_free(s);
}

static void a_file_of_nothing_but_missing_values_is_refused(void **state)
{
    (void)state;
    static const char *const commands[] = { "image", "terrain elevation",
                                            "surface terrain file=", "picture photo" };
    char line[100];
    WrSession *s = wr_session_new(NULL);
    for (size_t d = 0; d < DEMS; d++) {
        if (dems[d].missing == 0) continue;
        write_dem(&dems[d], all_missing);
        /* without a tag, -9999 is an ordinary number except for elevations */
        const bool only_elevations = strcmp(dems[d].name, "f32.tif") == 0;
        for (size_t k = 0; k < sizeof commands / sizeof *commands; k++) {
            if (only_elevations && (k == 0 || k == 3)) continue;
            snprintf(line, sizeof line, "%s%s%s", commands[k], k == 2 ? "" : " ", dems[d].name);
            must_fail(s, line, k == 1 ? "contains no elevation" : "contains only no-data values");
        }
    }
    wr_session_free(s);
}

static void a_photo_that_comes_out_flat_is_noted(void **state)
{
    (void)state;
    static const Dem above = { "i16.tif", 16, 2, false, NULL, -32768, false },
                     below = { "u16.tif", 16, 1, false, NULL, 0, false };
    Said said = { "" };
    WrSession *s = listening(&said);
    write_dem(&above, sloped);
    write_dem(&below, sloped);
    must_run(s, "table 12x8");
    must_run(s, "picture photo i16.tif seamless=off");
    assert_non_null(strstr(said.text, "96 of 96 values lie outside low and high"));
    said.text[0] = '\0';
    must_run(s, "picture photo u16.tif");
    assert_non_null(strstr(said.text, "nearly flat: stretch=on"));
    said.text[0] = '\0';
    must_run(s, "picture photo i16.tif seamless=off stretch=on");
    assert_null(strstr(said.text, "stretch=on"));
    assert_true(f_at(s, 0, 0) == 0.0f && f_at(s, 11, 7) == 1.0f);
    wr_session_free(s);
}

/* ---- FITS ---- */

static void put_card(FILE *file, const char *key, const char *value)
{
    char card[81];
    snprintf(card, sizeof card, "%-8s= %20s%50s", key, value, "");
    fputs(card, file);
}

/* FITS 4.0, 4.2.4: an exponent may begin with D. Physical value = BZERO + BSCALE x stored. */
static void fits_exponents_may_be_written_with_d(void **state)
{
    (void)state;
    static const char *const scales[] = { "1.25D1", "1.25E1", "12.5", "125.D-1" };
    for (size_t k = 0; k < sizeof scales / sizeof *scales; k++) {
        WrError err;
        FILE *file = fopen("d.fits", "wb");
        assert_non_null(file);
        put_card(file, "SIMPLE", "T");
        put_card(file, "BITPIX", "16");
        put_card(file, "NAXIS", "2");
        put_card(file, "NAXIS1", "4");
        put_card(file, "NAXIS2", "2");
        put_card(file, "BSCALE", scales[k]);
        put_card(file, "BZERO", "-2.5D2");
        fprintf(file, "%-80s", "END");
        for (int card = 8; card < 36; card++) fprintf(file, "%-80s", "");
        for (int x = 0; x < 1440; x++) putc(0, file), putc(x < 8 ? x : 0, file);
        assert_int_equal(fclose(file), 0);
        WrImage *image = wr_image_read("d.fits", &err);
        if (!image) fail_msg("BSCALE %s: %s", scales[k], err.text);
        for (int x = 0; x < 4; x++) { /* the first row is the lowest */
            assert_true((double)image->data[4 + x] == 12.5 * x - 250);
            assert_true((double)image->data[x] == 12.5 * (x + 4) - 250);
        }
        wr_image_free(image);
    }
}

/* Ends a header of `cards` lines so far. */
static void end_header(FILE *file, int cards)
{
    fprintf(file, "%-80s", "END");
    for (int card = cards + 1; card < 36; card++) fprintf(file, "%-80s", "");
}

/* A file as telescopes write it: no picture in the first header, 4 x 2 numbers x - 3 in the second. */
static void write_extension(const char *path, int bits)
{
    char text[16];
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    put_card(file, "SIMPLE", "T");
    put_card(file, "BITPIX", "8");
    put_card(file, "NAXIS", "0");
    put_card(file, "EXTEND", "T");
    end_header(file, 4);
    fprintf(file, "%-80s", "XTENSION= 'IMAGE   '");
    snprintf(text, sizeof text, "%d", bits);
    put_card(file, "BITPIX", text);
    put_card(file, "NAXIS", "2");
    put_card(file, "NAXIS1", "4");
    put_card(file, "NAXIS2", "2");
    put_card(file, "PCOUNT", "0");
    put_card(file, "GCOUNT", "1");
    end_header(file, 7);
    const int size = bits / 8;
    for (int i = 0; i < 2880; i++) { /* big-endian */
        const int64_t value = i / size < 8 ? i / size - 3 : 0;
        putc((int)((uint64_t)value >> 8 * (size - 1 - i % size) & 255), file);
    }
    assert_int_equal(fclose(file), 0);
}

static void fits_headers_without_a_picture_are_skipped(void **state)
{
    (void)state;
    WrError err;
    for (int bits = 16; bits <= 32; bits *= 2) {
        write_extension("sci.fits", bits);
        WrImage *image = wr_image_read("sci.fits", &err);
        if (!image) fail_msg("%d bits: %s", bits, err.text);
        for (int x = 0; x < 4; x++) {
            assert_true(image->data[4 + x] == (float)(x - 3));
            assert_true(image->data[x] == (float)(x + 1));
        }
        wr_image_free(image);
    }
}

/* The library returns zeros for 64 bits. */
static void fits_of_64_bits_are_refused(void **state)
{
    (void)state;
    WrError err = { "" };
    write_extension("long.fits", 64);
    assert_null(wr_image_read("long.fits", &err));
    assert_non_null(strstr(err.text, "32-bit integers or floats"));
}

/* ---- EXR ---- */

#define SIDE 16

/* Unit normals of the heights 0.05 sin 2 pi x/SIDE, stored as plain numbers. */
typedef struct Vectors {
    int order
        [3]; /* the channel that x, y, z go into: EXR keeps channels in the order of their names */
} Vectors;

static bool vector_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    const Vectors *is = ctx;
    float *to = out;
    (void)y, (void)err;
    for (int k = 0; k < rows * SIDE; k++, to += 3) {
        const double slope = 0.1 * WR_PI * cos(2 * WR_PI * (k % SIDE) / SIDE);
        const double n[3] = { -slope / hypot(1, slope), 0, 1 / hypot(1, slope) };
        for (int c = 0; c < 3; c++) to[is->order[c]] = (float)n[c];
    }
    return true;
}

static void write_vectors(const char *path, const char *const names[3], Vectors order)
{
    WrError err;
    const WrImageOut out = { .width = SIDE,
                             .height = SIDE,
                             .channels = 3,
                             .type = WR_PIXEL_F32,
                             .channel_names = names,
                             .data = true,
                             .rows = vector_rows,
                             .ctx = &order };
    if (!wr_image_write(path, &out, 1, &err)) fail_msg("%s", err.text);
}

/* Channels X, Y, Z are one vector: each command treats them like R, G, B. */
static void a_vector_is_read_like_a_colour(void **state)
{
    (void)state;
    static const char *const rgb[] = { "B", "G", "R" }, *const xyz[] = { "X", "Y", "Z" },
                             *const layer[] = { "View.Normal.X", "View.Normal.Y", "View.Normal.Z" };
    static const char *const commands[] = { "image ", "picture normals ", "normalmap " };
    static const char *const files[] = { "xyz.exr", "layer.exr" };
    char line[100];
    write_vectors("rgb.exr", rgb, (Vectors){ { 2, 1, 0 } });
    write_vectors("xyz.exr", xyz, (Vectors){ { 0, 1, 2 } });
    write_vectors("layer.exr", layer, (Vectors){ { 0, 1, 2 } });
    for (size_t k = 0; k < sizeof commands / sizeof *commands; k++) {
        WrSession *want = wr_session_new(NULL);
        must_run(want, "table 16x16");
        snprintf(line, sizeof line, "%srgb.exr", commands[k]);
        must_run(want, line);
        for (size_t f = 0; f < sizeof files / sizeof *files; f++) {
            WrSession *s = wr_session_new(NULL);
            must_run(s, "table 16x16");
            snprintf(line, sizeof line, "%s%s", commands[k], files[f]);
            must_run(s, line);
            assert_true(same_field(wr_document_field(doc(s)), wr_document_field(doc(want))));
            const WrImage *map = doc(s)->scene->normals.image;
            assert_int_equal(map != NULL, k == 2);
            if (map)
                assert_memory_equal(map->data, doc(want)->scene->normals.image->data,
                                    (size_t)SIDE * SIDE * (size_t)map->channels *
                                        sizeof *map->data);
            wr_session_free(s);
        }
        /* the normals are those of a wave of 0.1 from trough to crest */
        if (k == 1) assert_near((double)f_at(want, 4, 3) - (double)f_at(want, 12, 3), 0.1, 1e-3);
        wr_session_free(want);
    }
}

/* A picture of 30 x 20 with a data window of 15 x 10 at (10,5): light comes from its position in the whole, 0 from
   elsewhere. A data window larger than the picture, 30 x 20 around 20 x 12, is cropped. */
static void surroundings_are_the_display_window(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        int width, height;
    } cases[] = { { "e_crop.exr", 30, 20 }, { "e_over.exr", 20, 12 } };
    char line[600];
    for (int k = 0; k < 2; k++) {
        Said said = { "" };
        WrSession *s = listening(&said);
        snprintf(line, sizeof line, "environment \"%s/tests/image/cases/%s\"", WR_SOURCE_DIR,
                 cases[k].name);
        must_run(s, line);
        assert_non_null(strstr(said.text, "is not its display window"));
        const WrImage *light = doc(s)->scene->environment.light->image;
        assert_true(light->width == cases[k].width && light->height == cases[k].height);
        for (int y = 0; y < light->height && k == 0; y++)
            for (int x = 0; x < light->width; x++) {
                const bool inside = x >= 10 && x < 25 && y >= 5 && y < 15;
                const float grey = light->data[(y * light->width + x) * 3];
                assert_true(inside || grey == 0.0f);
                if (x == 10 && y == 5) assert_true(grey > 0.0f);
            }
        wr_session_free(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_table_has_the_elevations_of_the_file),
        cmocka_unit_test(a_terrain_has_the_elevations_of_the_file),
        cmocka_unit_test(codes_without_a_tag_stay_codes),
        cmocka_unit_test(a_file_of_nothing_but_missing_values_is_refused),
        cmocka_unit_test(a_photo_that_comes_out_flat_is_noted),
        cmocka_unit_test(fits_exponents_may_be_written_with_d),
        cmocka_unit_test(fits_headers_without_a_picture_are_skipped),
        cmocka_unit_test(fits_of_64_bits_are_refused),
        cmocka_unit_test(a_vector_is_read_like_a_colour),
        cmocka_unit_test(surroundings_are_the_display_window),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
