/* test_image_files.c - picture files written byte by byte from their format descriptions: PNM of any depth, GIMP
   patterns, SRTM elevations, pictures with an orientation, EXR files with channels in layers. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "command/session.h"
#include "base/text.h"
#include "image/image.h"
#include "scene/scene.h"

typedef struct Bytes {
    uint8_t *data; /* owned */
    size_t length;
} Bytes;

static Bytes bytes_new(size_t room)
{
    return (Bytes){ wr_alloc(room + 1, 1), 0 };
}

static void put(Bytes *b, int byte)
{
    b->data[b->length++] = (uint8_t)byte;
}

static void put_text(Bytes *b, const char *text)
{
    while (*text) put(b, *text++);
}

static void put_big16(Bytes *b, unsigned n)
{
    put(b, n >> 8 & 255), put(b, n & 255);
}

static void put_big32(Bytes *b, unsigned n)
{
    put_big16(b, n >> 16), put_big16(b, n & 65535);
}

/* Write the bytes and free them. */
static void write_bytes(const char *path, Bytes *b)
{
    WrError err;
    if (!wr_file_write(path, b->data, b->length, &err)) fail_msg("%s", err.text);
    wr_free(b->data);
}

static WrImage *read_well(const char *path)
{
    WrError err = { "" };
    WrImage *image = wr_image_read(path, &err);
    if (!image) fail_msg("%s", err.text);
    return image;
}

static void refuse(const char *path, const char *word)
{
    WrError err = { "" };
    if (wr_image_read(path, &err)) fail_msg("%s was read", path);
    if (!strstr(err.text, word) || !strstr(err.text, path))
        fail_msg("%s\n  without %s", err.text, word);
}

/* ---- PNM ---- */

static void every_code_of_a_16_bit_pgm_is_read_as_it_is(void **state)
{
    (void)state;
    static const unsigned most[] = { 65535, 65534, 4095, 1000, 256, 255, 254, 100, 1 };
    for (size_t m = 0; m < sizeof most / sizeof *most; m++) {
        enum { W = 331, H = 199 }; /* more texels than codes */
        Bytes b = bytes_new(W * H * 2 + 100);
        char head[60];
        snprintf(head, sizeof head, "P5\n# made by hand\n%d %d # so wide\n%u\n", W, H, most[m]);
        put_text(&b, head);
        for (unsigned k = 0; k < W * H; k++) {
            if (most[m] > 255) put_big16(&b, k % (most[m] + 1));
            else put(&b, (int)(k % (most[m] + 1)));
        }
        write_bytes("a.pgm", &b);
        WrImage *image = read_well("a.pgm");
        assert_int_equal(image->width, W);
        assert_int_equal(image->channels, 1);
        assert_int_equal(image->type, most[m] > 255 ? WR_PIXEL_U16 : WR_PIXEL_U8);
        for (unsigned k = 0; k < W * H; k++)
            assert_true(image->data[k] == (float)(k % (most[m] + 1)) / (float)most[m]);
        wr_image_free(image);
    }
}

static void pnm_in_words_and_in_colours_is_read(void **state)
{
    (void)state;
    static const char *const files[] = { "P2 3 2 65535\n0 1 65535\n32767 32768# middle\n 7\n",
                                         "P3\n1 2\n65535\n0 1\t65535\r\n32767 32768 7" };
    static const unsigned codes[] = { 0, 1, 65535, 32767, 32768, 7 };
    for (int k = 0; k < 3; k++) {
        Bytes b = bytes_new(200);
        put_text(&b, k < 2 ? files[k] : "P6 1 2 65535 ");
        for (int c = 0; c < 6 && k == 2; c++) put_big16(&b, codes[c]);
        write_bytes("b.ppm", &b);
        WrImage *image = read_well("b.ppm");
        assert_int_equal(image->channels, k == 0 ? 1 : 3);
        for (int c = 0; c < 6; c++) assert_true(image->data[c] == (float)codes[c] / 65535.0f);
        wr_image_free(image);
    }
}

/* The format's definition (netpbm, "Plain PBM") makes spaces between the pixels optional; 1 is black. */
static void pixels_of_a_plain_pbm_need_no_spaces(void **state)
{
    (void)state;
    static const char *const files[] = { "P1\n5 3\n10110\n01001\n11100\n",
                                         "P1 5 3 1 0 1 1 0 0 1 0 0 1 1 1 1 0 0",
                                         "P1\n# made by hand\n5\n3\n101 10010 # middle\n0111100" };
    static const float codes[] = { 0, 1, 0, 0, 1, 1, 0, 1, 1, 0, 0, 0, 0, 1, 1 };
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
        Bytes b = bytes_new(200);
        put_text(&b, files[k]);
        write_bytes("p.pbm", &b);
        WrImage *image = read_well("p.pbm");
        assert_true(image->width == 5 && image->height == 3 && image->channels == 1);
        for (int c = 0; c < 15; c++) assert_true(image->data[c] == codes[c]);
        wr_image_free(image);
    }
}

static void pnm_that_is_too_short_or_makes_no_sense_is_refused(void **state)
{
    (void)state;
    static const struct {
        const char *file, *word;
    } cases[] = {
        { "P5 3 2 255\n12345", "truncated" },      { "P5 3 2 65535\n12345678901", "truncated" },
        { "P2 3 2 9\n1 2 3 4 5", "truncated" },    { "P2 3 2 9\n1 2 3 4 x 6", "truncated" },
        { "P5 0 2 255\n", "each side" },           { "P5 99999 2 255\n", "each side" },
        { "P6 16384 16384 65535\n", "truncated" }, { "P2 16384 16384 255\n", "truncated" },
        { "P5 2 2 0\n1234", "largest code" },      { "P5 2 2 65536\n12341234", "largest code" },
        { "P1 3 2\n10110", "truncated" },          { "P1 3 2\n101102", "truncated" },
        { "P5 -2 2 255\n1234", "header" },         { "P5 2 2", "header" }
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Bytes b = bytes_new(100);
        put_text(&b, cases[k].file);
        write_bytes("c.pgm", &b);
        refuse("c.pgm", cases[k].word);
    }
}

/* ---- GIMP patterns: header length, version, width, height, bytes per pixel, "GPAT", name ---- */

static void write_pattern(int w, int h, int channels, unsigned version, size_t cut)
{
    Bytes b = bytes_new((size_t)(w * h * channels) + 100);
    static const char name[] = "Pine, old";
    put_big32(&b, 24 + sizeof name);
    put_big32(&b, version);
    put_big32(&b, (unsigned)w), put_big32(&b, (unsigned)h), put_big32(&b, (unsigned)channels);
    put_text(&b, "GPAT");
    put_text(&b, name);
    put(&b, 0);
    for (int k = 0; k < w * h * channels; k++) put(&b, k * 37 % 251);
    b.length -= cut;
    write_bytes("wood.pat", &b);
}

static void gimp_patterns_are_read(void **state)
{
    (void)state;
    for (int channels = 1; channels <= 4; channels++) {
        write_pattern(13, 7, channels, 1, 0);
        WrImage *image = read_well("wood.pat");
        assert_int_equal(image->width, 13);
        assert_int_equal(image->height, 7);
        assert_int_equal(image->channels, channels);
        assert_int_equal(image->type, WR_PIXEL_U8);
        for (int k = 0; k < 13 * 7 * channels; k++)
            assert_true(image->data[k] == (float)(k * 37 % 251) / 255.0f);
        wr_image_free(image);
    }
    write_pattern(13, 7, 3, 1, 1);
    refuse("wood.pat", "truncated");
    write_pattern(13, 7, 3, 2, 0);
    refuse("wood.pat", "version 2");
    write_pattern(13, 7, 5, 1, 0);
    refuse("wood.pat", "bytes a pixel");
}

/* ---- elevations ---- */

static int metres_at(int i, int j)
{
    if (i > 600 && i < 620 && j > 300 && j < 310) return -32768;
    return j < 100 ? 0 : (i * 3 + j * 5) % 9000 - 400;
}

static void srtm_elevations_are_metres_and_voids_are_filled(void **state)
{
    (void)state;
    enum { N = 1201 };
    Bytes b = bytes_new(2 * N * N);
    for (int k = 0; k < N * N; k++) put_big16(&b, (unsigned)metres_at(k % N, k / N) & 65535);
    write_bytes("N47E011.hgt", &b);
    WrImage *image = read_well("N47E011.hgt");
    assert_int_equal(image->width, N);
    assert_int_equal(image->type, WR_PIXEL_F32);
    assert_int_equal(image->filled, 19 * 9);
    /* Voids are between the plane's heights at the surrounding corners: 3 * 600 + 5 * 300 - 400 and 3 * 620 + 5 * 310
       - 400. */
    for (int k = 0; k < N * N; k++) {
        const int metres = metres_at(k % N, k / N);
        if (metres != -32768) assert_true(image->data[k] == (float)metres);
        else assert_true(image->data[k] > 2900 && image->data[k] < 3010);
    }
    wr_image_free(image);
    WrSession *s = session_of((const char *[]){ "table 1201x1201 wrap=clamp", NULL });
    must_run(s, "terrain elevation N47E011.hgt");
    for (int k = 0; k < N * N; k += 7) {
        const int metres = metres_at(k % N, k / N);
        const float f = f_at(s, k % N, k / N);
        if (metres != -32768) assert_true(f == (float)metres); /* the sea stays at 0 */
        else assert_true(f > 2000 && f < 5000);
    }
    wr_session_free(s);
    b = bytes_new(100);
    put_text(&b, "too little");
    write_bytes("N00E000.hgt", &b);
    refuse("N00E000.hgt", "1201x1201");
}

/* ---- orientation ---- */

/* A TIFF of 8-bit greys, 3 x 2, codes 10 row + column, with that orientation. */
static void write_turned_tiff(const char *path, unsigned orientation)
{
    static const unsigned tags[][3] = { { 256, 3, 3 }, { 257, 3, 2 }, { 258, 3, 8 }, { 259, 3, 1 },
                                        { 262, 3, 1 }, { 273, 4, 8 }, { 274, 3, 0 }, { 277, 3, 1 },
                                        { 278, 3, 2 }, { 279, 4, 6 } };
    Bytes b = bytes_new(300);
    put_text(&b, "MM");
    put_big16(&b, 42);
    put_big32(&b, 14);
    for (int k = 0; k < 6; k++) put(&b, 10 * (k / 3) + k % 3);
    put_big16(&b, 10);
    for (int t = 0; t < 10; t++) {
        const unsigned value = tags[t][0] == 274 ? orientation : tags[t][2];
        put_big16(&b, tags[t][0]), put_big16(&b, tags[t][1]), put_big32(&b, 1);
        if (tags[t][1] == 3) put_big16(&b, value), put_big16(&b, 0);
        else put_big32(&b, value);
    }
    put_big32(&b, 0);
    write_bytes(path, &b);
}

/* TIFF 6, page 36: display position of row 0 and column 0 of the file. */
static void seen_at(int orientation, int row, int column, int w, int h, int *x, int *y)
{
    static const struct {
        bool across, from_end_x, from_end_y; /* across: rows run across the picture, not down */
    } ways[9] = { { 0 },       { 0, 0, 0 }, { 0, 1, 0 }, { 0, 1, 1 }, { 0, 0, 1 },
                  { 1, 0, 0 }, { 1, 1, 0 }, { 1, 1, 1 }, { 1, 0, 1 } };
    *x = ways[orientation].across ? row : column;
    *y = ways[orientation].across ? column : row;
    if (ways[orientation].from_end_x) *x = w - 1 - *x;
    if (ways[orientation].from_end_y) *y = h - 1 - *y;
}

static void expect_turned(const WrImage *image, int orientation, double tolerance)
{
    assert_int_equal(image->width, orientation >= 5 ? 2 : 3);
    assert_int_equal(image->height, orientation >= 5 ? 3 : 2);
    for (int k = 0; k < 6; k++) {
        int x, y;
        seen_at(orientation, k / 3, k % 3, image->width, image->height, &x, &y);
        const float got = image->data[(y * image->width + x) * image->channels];
        assert_near(255 * got, 10 * (k / 3) + k % 3, tolerance);
    }
}

/* Read row by row, it is the same picture. */
static void expect_rows(const char *path, const WrImage *image)
{
    WrError err = { "" };
    const WrImageRequest all = { .channel = NULL };
    WrImageRows *rows = wr_image_rows_open(path, &all, &err);
    if (!rows) fail_msg("%s", err.text);
    assert_int_equal(wr_image_rows_head(rows)->width, image->width);
    assert_int_equal(wr_image_rows_head(rows)->height, image->height);
    const size_t row = (size_t)image->width * (size_t)image->channels;
    for (int y = 0; y < image->height; y++) {
        const float *values = wr_image_rows_get(rows, y, &err);
        assert_non_null(values);
        assert_memory_equal(values, image->data + (size_t)y * row, row * sizeof *values);
    }
    wr_image_rows_close(rows);
}

static void pictures_stand_the_way_up_that_they_tell(void **state)
{
    (void)state;
    for (int o = 0; o <= 9; o++) {
        write_turned_tiff("turned.tif", (unsigned)o);
        WrImage *image = read_well("turned.tif");
        expect_turned(image, o >= 1 && o <= 8 ? o : 1, 1e-4);
        expect_rows("turned.tif", image);
        wr_image_free(image);
    }
}

/* Camera format: an Exif block with one entry, inserted after the first marker of a JPEG of the program. */
static void photographs_are_turned_by_their_exif(void **state)
{
    (void)state;
    uint8_t codes[6];
    char *bytes;
    size_t length;
    WrError err;
    for (int k = 0; k < 6; k++) codes[k] = (uint8_t)(10 * (k / 3) + k % 3);
    if (!wr_image_write_pixels("plain.jpg", 3, 2, 1, WR_PIXEL_U8, false, codes, &err) ||
        !wr_file_read("plain.jpg", 1 << 20, &bytes, &length, &err))
        fail_msg("%s", err.text);
    for (int o = 1; o <= 8; o++) {
        Bytes b = bytes_new(length + 100);
        put(&b, 0xff), put(&b, 0xd8), put(&b, 0xff), put(&b, 0xe1);
        put_big16(&b, 2 + 6 + 26);
        put_text(&b, "Exif"), put(&b, 0), put(&b, 0);
        put_text(&b, "MM"), put_big16(&b, 42), put_big32(&b, 8), put_big16(&b, 1);
        put_big16(&b, 274), put_big16(&b, 3), put_big32(&b, 1);
        put_big16(&b, (unsigned)o), put_big16(&b, 0), put_big32(&b, 0);
        for (size_t k = 2; k < length; k++) put(&b, bytes[k]);
        write_bytes("photo.jpg", &b);
        WrImage *image = read_well("photo.jpg");
        expect_turned(image, o, 3);
        expect_rows("photo.jpg", image);
        wr_image_free(image);
    }
    wr_free(bytes);
}

/* ---- channels and parts ---- */

typedef struct Layers {
    int channels, part;
} Layers;

/* Channel c of part p is 100 p + 10 c + row + column / 4. */
static bool layer_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    const Layers *is = ctx;
    float *to = out;
    (void)err;
    for (int j = y; j < y + rows; j++)
        for (int i = 0; i < 5; i++)
            for (int c = 0; c < is->channels; c++)
                *to++ = (float)(100 * is->part + 10 * c + j + i / 4.0);
    return true;
}

static void write_layers(const char *path, const char *const *names, int channels, int parts)
{
    Layers layers[2] = { { channels, 0 }, { channels, 1 } };
    WrImageOut out[2];
    WrError err;
    for (int p = 0; p < parts; p++)
        out[p] = (WrImageOut){ .width = 5,
                               .height = 3,
                               .channels = channels,
                               .type = WR_PIXEL_F32,
                               .channel_names = names,
                               .part_name = p == 0 ? "near" : "far",
                               .data = true,
                               .rows = layer_rows,
                               .ctx = &layers[p] };
    if (!wr_image_write(path, out, parts, &err)) fail_msg("%s", err.text);
}

/* A request, and the expected channel numbers in order; none: an error. */
static void expect_channels(const char *path, const char *channel, const char *part, int part_index,
                            const char *answer)
{
    WrError err = { "" };
    const WrImageRequest wish = { .channel = channel, .part = part };
    WrImage *image = wr_image_read_request(path, &wish, &err);
    if (!image != !*answer)
        fail_msg("%s, channel %s: %s", path, channel ? channel : "-", image ? "read" : err.text);
    if (!image) return;
    assert_int_equal(image->channels, strlen(answer));
    for (int k = 0; k < 15; k++)
        for (int c = 0; c < image->channels; c++)
            assert_near(image->data[k * image->channels + c],
                        100 * part_index + 10 * (answer[c] - '0') + k / 5 + k % 5 / 4.0, 1e-6);
    wr_image_free(image);
}

/* EXR sorts channels by name, as in these lists. */
static void channels_in_layers_are_not_mixed(void **state)
{
    (void)state;
    static const char *const mixed[] = { "Z", "diffuse.B", "diffuse.G", "diffuse.R" };
    static const char *const blender[] = { "ViewLayer.Combined.A", "ViewLayer.Combined.B",
                                           "ViewLayer.Combined.G", "ViewLayer.Combined.R",
                                           "ViewLayer.Depth.Z" };
    static const char *const depth[] = { "B", "G", "R", "Z" };
    write_layers("mixed.exr", mixed, 4, 1);
    expect_channels("mixed.exr", NULL, NULL, 0, "321");
    expect_channels("mixed.exr", "Z", NULL, 0, "0");
    expect_channels("mixed.exr", "diffuse", NULL, 0, "321");
    expect_channels("mixed.exr", "diffuse.G", NULL, 0, "2");
    expect_channels("mixed.exr", "specular", NULL, 0, "");
    write_layers("blender.exr", blender, 5, 1);
    expect_channels("blender.exr", NULL, NULL, 0, "3210");
    expect_channels("blender.exr", "ViewLayer.Depth.Z", NULL, 0, "4");
    expect_channels("blender.exr", "ViewLayer.Combined", NULL, 0, "3210");
    write_layers("depth.exr", depth, 4, 1);
    expect_channels("depth.exr", NULL, NULL, 0, "210");
    expect_channels("depth.exr", "Z", NULL, 0, "3");
}

static void a_part_is_chosen_by_number_or_name(void **state)
{
    (void)state;
    static const char *const names[] = { "Y" };
    write_layers("parts.exr", names, 1, 2);
    expect_channels("parts.exr", NULL, NULL, 0, "0");
    expect_channels("parts.exr", NULL, "1", 0, "0");
    expect_channels("parts.exr", NULL, "2", 1, "0");
    expect_channels("parts.exr", NULL, "far", 1, "0");
    expect_channels("parts.exr", "Y", "far", 1, "0");
    expect_channels("parts.exr", NULL, "3", 0, "");
    expect_channels("parts.exr", NULL, "0", 0, "");
    expect_channels("parts.exr", NULL, "middle", 0, "");
}

static void commands_choose_and_tell_what_they_took(void **state)
{
    (void)state;
    static const char *const names[] = { "Depth.Z", "diffuse.B", "diffuse.G", "diffuse.R" };
    Said said = { "" };
    const WrSessionOptions options = { .note = hear_note, .note_ctx = &said };
    WrSession *s = wr_session_new(&options);
    write_layers("scene.exr", names, 4, 1);
    must_run(s, "image scene.exr");
    assert_non_null(
        strstr(said.text, "used diffuse.R, diffuse.G, diffuse.B of its channels Depth.Z"));
    must_run(s, "image scene.exr channel=Depth.Z");
    for (int k = 0; k < 15; k++) assert_near(f_at(s, k % 5, k / 5), k / 5 + k % 5 / 4.0, 1e-6);
    assert_non_null(strstr(wr_session_last_command(s), "layer=Depth.Z"));
    must_run(s, "terrain elevation scene.exr channel=diffuse.G values=real");
    assert_near(f_at(s, 2, 1), 20 + 1 + 0.5, 1e-5);
    must_fail(s, "image scene.exr channel=Depth", "Depth.Z");
    must_fail(s, "image scene.exr part=2", "part '2'");
    wr_session_free(s);
}

/* Its lines select the same channels again: from a script beside the file, and in a document without it. */
static void a_scene_names_the_channels_that_its_pictures_took(void **state)
{
    (void)state;
    static const char *const names[] = { "Depth.Z", "diffuse.B", "diffuse.G", "diffuse.R" };
    WrError err = { "" };
    WrText lines = { 0 }, again = { 0 }, one = { 0 };
    WrSession *s = wr_session_new(NULL), *opened = wr_session_new(NULL),
              *script = wr_session_new(NULL);
    write_layers("maps.exr", names, 4, 2);
    must_run(s, "colour maps.exr channel=Depth.Z part=2 repeat=once");
    must_run(s, "normalmap maps.exr channel=diffuse");
    must_run(s, "environment maps.exr channel=diffuse part=1 turn=30");
    wr_session_scene_text(s, &lines);
    assert_non_null(strstr(wr_text_get(&lines), "environment maps.exr channel=diffuse part=1 "));
    assert_non_null(strstr(wr_text_get(&lines), "colour maps.exr channel=Depth.Z part=2 "));
    assert_non_null(strstr(wr_text_get(&lines), "normalmap maps.exr channel=diffuse "));
    assert_true(wr_session_save(s, "kept.exr", &err));
    const char *line = strstr(wr_text_get(&lines), "colour maps");
    wr_text_add_n(&one, line, strcspn(line, "\n"));
    must_run(script, wr_text_get(&one));
    assert_int_equal(unlink("maps.exr"), 0);
    if (!wr_session_open(opened, "kept.exr", &err)) fail_msg("%s", err.text);
    wr_session_scene_text(opened, &again);
    assert_string_equal(wr_text_get(&lines), wr_text_get(&again));
    const WrImage *took = wr_session_document(s)->scene->colour;
    const WrImage *same = wr_session_document(script)->scene->colour;
    assert_int_equal(took->channels, 1);
    assert_memory_equal(took->data, same->data, 15 * sizeof(float));
    wr_text_fini(&lines), wr_text_fini(&again), wr_text_fini(&one);
    wr_session_free(s), wr_session_free(opened), wr_session_free(script);
}

/* ---- messages list names in the part's order, whatever the format's ---- */

typedef struct Shown {
    int rows, wrong;
} Shown;

static bool fill_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    (void)ctx;
    (void)err;
    float *at = out;
    for (int j = 0; j < rows; j++)
        for (int i = 0; i < 7; i++)
            for (int c = 0; c < 3; c++) *at++ = (float)(0.37 * c + 0.01 * i + 0.0013 * (y + j));
    return true;
}

static bool look_at_rows(void *ctx, int y, int rows, const float *values, bool exact, WrError *err)
{
    (void)exact;
    Shown *shown = ctx;
    float want[7 * 3 * WR_IMAGE_STRIP];
    fill_rows(NULL, y, rows, want, err);
    shown->rows += rows;
    for (int i = 0; i < 7 * 3 * rows; i++) shown->wrong += want[i] != values[i];
    return true;
}

static void channels_are_shown_in_the_order_in_which_they_were_given(void **state)
{
    (void)state;
    static const char *const orders[][3] = { { "a", "b", "c" }, { "z_h", "b", "m" } };
    for (int k = 0; k < 2; k++) {
        Shown shown = { 0, 0 };
        WrError err = { "" };
        const WrImageOut out = { .width = 7,
                                 .height = 93,
                                 .channels = 3,
                                 .type = WR_PIXEL_F32,
                                 .channel_names = orders[k],
                                 .data = true,
                                 .rows = fill_rows,
                                 .seen = look_at_rows,
                                 .ctx = &shown };
        if (!wr_image_write("channels.exr", &out, 1, &err)) fail_msg("%s", err.text);
        assert_int_equal(shown.rows, 93);
        assert_int_equal(shown.wrong, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_code_of_a_16_bit_pgm_is_read_as_it_is),
        cmocka_unit_test(pnm_in_words_and_in_colours_is_read),
        cmocka_unit_test(pixels_of_a_plain_pbm_need_no_spaces),
        cmocka_unit_test(pnm_that_is_too_short_or_makes_no_sense_is_refused),
        cmocka_unit_test(gimp_patterns_are_read),
        cmocka_unit_test(srtm_elevations_are_metres_and_voids_are_filled),
        cmocka_unit_test(pictures_stand_the_way_up_that_they_tell),
        cmocka_unit_test(photographs_are_turned_by_their_exif),
        cmocka_unit_test(channels_in_layers_are_not_mixed),
        cmocka_unit_test(a_part_is_chosen_by_number_or_name),
        cmocka_unit_test(commands_choose_and_tell_what_they_took),
        cmocka_unit_test(a_scene_names_the_channels_that_its_pictures_took),
        cmocka_unit_test(channels_are_shown_in_the_order_in_which_they_were_given),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
