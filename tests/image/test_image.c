/* Pictures: round trips, bit-identical where the format allows; hostile files; full disks. */
#include "test.h"
#include "test_folder.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/pool.h"
#include "image/decode.h"
#include "image/image.h"
#include "image/readback.h"

#include <fcntl.h>
#include <float.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static size_t type_size(WrPixelType type)
{
    return type == WR_PIXEL_U8 ? 1 : type == WR_PIXEL_U16 ? 2 : 4;
}

/* The file must not exist, and no partial file either. */
static int files_here(void)
{
    FILE *list = popen("ls -A | wc -l", "r");
    int count = -1;
    assert_int_equal(fscanf(list, "%d", &count), 1);
    pclose(list);
    return count;
}

static void *random_pixels(size_t count, WrPixelType type, uint64_t seed)
{
    TestRandom random = { seed };
    unsigned char *pixels = calloc(count, type_size(type));
    for (size_t i = 0; i < count; i++) {
        if (type == WR_PIXEL_U8) pixels[i] = (unsigned char)test_random_u64(&random);
        if (type == WR_PIXEL_U16) ((uint16_t *)pixels)[i] = (uint16_t)test_random_u64(&random);
        if (type == WR_PIXEL_F32)
            ((float *)pixels)[i] = (float)(test_random(&random) * 40.0 - 20.0);
    }
    return pixels;
}

static float value_of(const void *pixels, WrPixelType type, size_t i)
{
    if (type == WR_PIXEL_U8) return (float)(((const unsigned char *)pixels)[i] / 255.0);
    if (type == WR_PIXEL_U16) return (float)(((const uint16_t *)pixels)[i] / 65535.0);
    return ((const float *)pixels)[i];
}

static void check_round_trip(const char *path, int width, int height, int channels,
                             WrPixelType type, bool data)
{
    WrError err = { "" };
    size_t count = (size_t)width * (size_t)height * (size_t)channels;
    void *pixels = random_pixels(count, type, count + 5);
    if (!wr_image_write_pixels(path, width, height, channels, type, data, pixels, &err))
        fail_msg("%s", err.text);
    WrImage *image = wr_image_read(path, &err);
    if (!image) fail_msg("%s", err.text);
    assert_int_equal(image->width, width);
    assert_int_equal(image->height, height);
    assert_int_equal(image->channels, channels);
    assert_int_equal(image->type, type);
    assert_int_equal(image->replaced, 0);
    for (size_t i = 0; i < count; i++)
        if (image->data[i] != value_of(pixels, type, i))
            fail_msg("%s: value %zu is %.9g, was %.9g", path, i, image->data[i],
                     value_of(pixels, type, i));
    wr_image_free(image);
    free(pixels);
    unlink(path);
}

static void every_type_comes_back_exactly(void **state)
{
    (void)state;
    const struct {
        const char *path;
        WrPixelType type;
        unsigned channels; /* decimal digits: numbers of channels to test */
    } cases[] = {
        { "a.png", WR_PIXEL_U8, 1234 },   { "a.png", WR_PIXEL_U16, 1234 },
        { "a.exr", WR_PIXEL_F32, 1234 },  { "a.tif", WR_PIXEL_U8, 1234 },
        { "a.tiff", WR_PIXEL_U16, 1234 }, { "A.TIF", WR_PIXEL_F32, 1234 },
        { "a.bmp", WR_PIXEL_U8, 134 },    { "a.tga", WR_PIXEL_U8, 134 },
        { "a.ppm", WR_PIXEL_U8, 3 },      { "a.pgm", WR_PIXEL_U8, 1 },
        { "a.pnm", WR_PIXEL_U8, 13 },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (unsigned digits = cases[i].channels; digits > 0; digits /= 10)
            for (int data = 0; data < 2; data++)
                check_round_trip(cases[i].path, 37, 130, (int)(digits % 10), cases[i].type, data);
}

static void hc95_single_pixels_and_lines_are_pictures_and_none_is_not(void **state)
{
    (void)state;
    const char *paths[] = { "a.png", "a.exr", "a.tif", "a.bmp", "a.tga" };
    for (int i = 0; i < 5; i++) {
        WrPixelType type = i == 1 ? WR_PIXEL_F32 : WR_PIXEL_U8;
        check_round_trip(paths[i], 1, 1, 1, type, true);
        check_round_trip(paths[i], 1, 301, 3, type, true);
        check_round_trip(paths[i], 301, 1, 3, type, true);
    }
    const int bad[][2] = { { 0, 5 }, { 5, 0 }, { -1, 5 }, { 16385, 1 }, { 1, 16385 } };
    int before = files_here();
    for (int i = 0; i < 5; i++) {
        WrError err = { "" };
        float pixel[5] = { 0 };
        assert_null(wr_image_new(bad[i][0], bad[i][1], 1, &err));
        assert_non_null(strstr(err.text, "1..16384"));
        assert_false(wr_image_write_pixels("no.exr", bad[i][0], bad[i][1], 1, WR_PIXEL_F32, true,
                                           pixel, &err));
        assert_non_null(strstr(err.text, "1..16384"));
    }
    assert_null(wr_image_new(1, 1, 5, NULL));
    assert_null(wr_image_new(1, 1, 0, NULL));
    assert_int_equal(files_here(), before);
}

static void all_codes_read_as_code_over_the_largest(void **state)
{
    (void)state;
    uint16_t *codes = malloc(65536 * sizeof *codes);
    WrError err;
    for (int i = 0; i < 65536; i++) codes[i] = (uint16_t)i;
    assert_true(wr_image_write_pixels("all.png", 256, 256, 1, WR_PIXEL_U16, true, codes, &err));
    WrImage *image = wr_image_read("all.png", &err);
    assert_non_null(image);
    for (int i = 0; i < 65536; i++) assert_true(image->data[i] == (float)i / 65535.0f);
    wr_image_free(image);
    free(codes);
}

static void odd_floats_keep_their_bits(void **state)
{
    (void)state;
    const float odd[8] = { -0.0f,  FLT_MAX,  -FLT_MAX,    FLT_MIN / 8,
                           1e-45f, 1.0f / 3, 16777217.0f, -5e4f };
    const char *paths[] = { "odd.exr", "odd.tif" };
    for (int k = 0; k < 2; k++) {
        WrError err;
        assert_true(wr_image_write_pixels(paths[k], 2, 4, 1, WR_PIXEL_F32, true, odd, &err));
        WrImage *image = wr_image_read(paths[k], &err);
        assert_non_null(image);
        assert_memory_equal(image->data, odd, sizeof odd);
        wr_image_free(image);
    }
}

static void values_that_are_not_finite_read_as_zero_and_are_counted(void **state)
{
    (void)state;
    const float bad[12] = { 1, NAN, 2, 3, 4, 5, INFINITY, -INFINITY, NAN, 6, 7, 8 };
    WrError err;
    assert_true(wr_image_write_pixels("bad.exr", 2, 2, 3, WR_PIXEL_F32, true, bad, &err));
    WrImage *image = wr_image_read("bad.exr", &err);
    assert_non_null(image);
    assert_int_equal(image->replaced, 2); /* texels, not numbers */
    for (int i = 0; i < 12; i++) assert_true(image->data[i] == (isfinite(bad[i]) ? bad[i] : 0.0f));
    wr_image_free(image);
}

static void hc96_nan_becomes_code_0_and_is_counted(void **state)
{
    (void)state;
    const float in[8] = { NAN, INFINITY, -INFINITY, -0.25f, 1.5f, 1.0f, 0.5f, 0.25f };
    uint8_t u8[8];
    uint16_t u16[8];
    float f32[8];
    int64_t clipped = -1;
    assert_int_equal(wr_image_codes(WR_PIXEL_U8, in, 8, u8, &clipped), 3);
    assert_int_equal(clipped, 2);
    const uint8_t want8[8] = { 0, 0, 0, 0, 255, 255, 128, 64 }; /* 127.5 is rounded away from 0 */
    assert_memory_equal(u8, want8, 8);
    assert_int_equal(wr_image_codes(WR_PIXEL_U16, in, 8, u16, NULL), 3);
    const uint16_t want16[8] = { 0, 0, 0, 0, 65535, 65535, 32768, 16384 };
    assert_memory_equal(u16, want16, sizeof want16);
    assert_int_equal(wr_image_codes(WR_PIXEL_F32, in, 8, f32, NULL), 3);
    assert_true(f32[0] == 0 && f32[1] == 0 && f32[3] == -0.25f && f32[4] == 1.5f);
    WrError err;
    assert_true(wr_image_write_pixels("nan.png", 8, 1, 1, WR_PIXEL_U8, true, u8, &err));
    WrImage *image = wr_image_read("nan.png", &err);
    assert_true(image && image->data[0] == 0.0f && image->data[4] == 1.0f);
    wr_image_free(image);
}

static void alpha_is_never_multiplied_into_colours(void **state)
{
    (void)state;
    const uint8_t pixels[8] = { 200, 100, 50, 0, 200, 100, 50, 128 };
    const char *paths[] = { "al.png", "al.tif", "al.tga", "al.bmp" };
    for (int k = 0; k < 4; k++) {
        WrError err;
        assert_true(wr_image_write_pixels(paths[k], 2, 1, 4, WR_PIXEL_U8, false, pixels, &err));
        WrImage *image = wr_image_read(paths[k], &err);
        assert_non_null(image);
        for (int i = 0; i < 8; i++) assert_true(image->data[i] == (float)pixels[i] / 255.0f);
        wr_image_free(image);
    }
}

static void jpeg_comes_back_nearly(void **state)
{
    (void)state;
    uint8_t ramp[64 * 64 * 3];
    for (int y = 0; y < 64; y++)
        for (int x = 0; x < 64; x++)
            for (int c = 0; c < 3; c++)
                ramp[(y * 64 + x) * 3 + c] = (uint8_t)(c == 0 ? 4 * x : 3 * y);
    WrError err;
    assert_true(wr_image_write_pixels("r.jpg", 64, 64, 3, WR_PIXEL_U8, false, ramp, &err));
    WrImage *image = wr_image_read("r.jpg", &err);
    assert_non_null(image);
    for (int i = 0; i < 64 * 64 * 3; i++) /* quality 95: a few codes */
        assert_near(image->data[i] * 255.0, ramp[i], 6.0);
    wr_image_free(image);
}

/* ---- parts and attributes ---- */

static bool counting_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    (void)err;
    const int *shape = ctx; /* width, channels, offset */
    assert_true(rows >= 1 && rows <= WR_IMAGE_STRIP);
    for (int i = 0; i < rows * shape[0] * shape[1]; i++)
        ((float *)out)[i] = (float)(shape[2] + y * shape[0] * shape[1] + i);
    return true;
}

static void parts_names_attributes_and_many_channels_come_back(void **state)
{
    (void)state;
    const char *names[] = { "b1", "a0", "z9", "m3", "k2", "q" };
    const WrImageAttribute attributes[] = { { "wrinkle:scene", "line one\nline = two\n\xc3\xa9" },
                                            { "wrinkle:x", "" } };
    int first[] = { 70, 6, 1000 }, second[] = { 9, 1, -7 };
    WrImageOut parts[2] = { { .width = 70,
                              .height = 131,
                              .channels = 6,
                              .type = WR_PIXEL_F32,
                              .channel_names = names,
                              .part_name = "F",
                              .attributes = attributes,
                              .attribute_count = 2,
                              .data = true,
                              .rows = counting_rows,
                              .ctx = first },
                            { .width = 9,
                              .height = 2,
                              .channels = 1,
                              .type = WR_PIXEL_F32,
                              .part_name = "layer:\xc3\xa9",
                              .data = true,
                              .rows = counting_rows,
                              .ctx = second } };
    WrError err = { "" };
    if (!wr_image_write("parts.exr", parts, 2, &err)) fail_msg("%s", err.text);
    WrImageFile *file = wr_image_file_open("parts.exr", &err);
    assert_non_null(file);
    assert_int_equal(wr_image_file_parts(file), 2);
    WrImagePart a = wr_image_file_part(file, 0), b = wr_image_file_part(file, 1);
    assert_string_equal(a.name, "F");
    assert_string_equal(b.name, "layer:\xc3\xa9");
    assert_string_equal(b.channel_names[0], "Y");
    assert_int_equal(a.width * 1000 + a.height, 70131);
    assert_int_equal(a.channels, 6);
    assert_string_equal(wr_image_file_attribute(file, 0, "wrinkle:scene"), attributes[0].text);
    assert_null(wr_image_file_attribute(file, 1, "wrinkle:scene"));
    float *values = malloc(70 * 131 * 6 * sizeof *values);
    assert_true(wr_image_file_read(file, 0, values, &err));
    for (int c = 0; c < 6; c++) { /* EXR sorts channels by name */
        int from = 0;
        while (strcmp(names[from], a.channel_names[c]) != 0) from++;
        for (int i = 0; i < 70 * 131; i++)
            assert_true(values[6 * i + c] == (float)(1000 + 6 * i + from));
    }
    assert_true(wr_image_file_read(file, 1, values, &err));
    assert_true(values[0] == -7.0f && values[17] == 10.0f);
    assert_true(wr_image_file_read_rows(file, 0, 100, 1, values, &err)); /* and upwards again */
    assert_true(wr_image_file_read_rows(file, 1, 1, 1, values, &err));
    assert_true(values[0] == 2.0f);
    free(values);
    wr_image_file_close(file);
    assert_false(wr_image_write("parts.tif", parts, 2, &err));
    assert_non_null(strstr(err.text, "need EXR"));
}

/* Rows are decoded before they are requested; in any order of reads, they are the file's. */
static void rows_of_two_parts_come_in_any_order(void **state)
{
    (void)state;
    int first[] = { 37, 3, 1000 }, second[] = { 37, 3, -700 };
    WrImageOut parts[2] = { { .width = 37,
                              .height = 331,
                              .channels = 3,
                              .type = WR_PIXEL_F32,
                              .part_name = "F",
                              .attributes = &(WrImageAttribute){ "wrinkle:version", "1" },
                              .attribute_count = 1,
                              .rows = counting_rows,
                              .ctx = first },
                            { .width = 37,
                              .height = 290,
                              .channels = 3,
                              .type = WR_PIXEL_F32,
                              .part_name = "G",
                              .rows = counting_rows,
                              .ctx = second } };
    WrError err = { "" };
    if (!wr_image_write("rows.exr", parts, 2, &err)) fail_msg("%s", err.text);
    WrImageFile *file = wr_image_file_open("rows.exr", &err);
    assert_non_null(file);
    float *values = malloc((size_t)37 * 3 * 331 * sizeof *values);
    uint32_t random = 1;
    for (int i = 0, part = 0, y = 0, rows = 1; i < 400; i++) {
        random = random * 1664525u + 1013904223u;
        const int draw = (int)(random >> 24); /* 0..255 */
        const bool below = draw < 160;        /* goes on below the last rows */
        if (draw & 16) assert_null(wr_image_file_attribute(file, part, i % 2 ? "a" : "b"));
        if (below) y += rows;
        else rows = 1 + (int)(random >> 10) % 140, y = (int)(random >> 5) % 200;
        if (draw % 8 == 0) rows = 64;
        if (draw % 8 <= 1) part = draw & 1;
        if (draw > 250) y = 0;
        const int *shape = part ? second : first, height = parts[part].height;
        if (y >= height) y = 0;
        if (rows > height - y) rows = height - y;
        if (!wr_image_file_read_rows(file, part, y, rows, values, &err)) fail_msg("%s", err.text);
        const int row = shape[0] * shape[1];
        for (int k = 0; k < rows * row; k++)
            if (values[k] != (float)(shape[2] + y * row + k))
                fail_msg("part %d, rows %d to %d, value %d", part, y, y + rows, k);
    }
    free(values);
    wr_image_file_close(file);
}

typedef struct Zeros {
    size_t row; /* bytes */
} Zeros;

static bool zero_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    (void)y;
    (void)err;
    memset(out, 0, (size_t)rows * ((const Zeros *)ctx)->row);
    return true;
}

static void small_formats_keep_attributes_in_their_description(void **state)
{
    (void)state;
    const WrImageAttribute attributes[] = { { "wrinkle:range", "-1,2.5" },
                                            { "wrinkle:kind", "height" } };
    const char *paths[] = { "at.png", "at.tif", "at.exr", "at.jpg" };
    const WrPixelType types[] = { WR_PIXEL_U16, WR_PIXEL_F32, WR_PIXEL_F32, WR_PIXEL_U8 };
    for (int k = 0; k < 4; k++) {
        WrError err = { "" };
        Zeros zeros = { 3 * type_size(types[k]) };
        WrImageOut out = { .width = 3,
                           .height = 3,
                           .channels = 1,
                           .type = types[k],
                           .attributes = attributes,
                           .attribute_count = 2,
                           .data = true,
                           .rows = zero_rows,
                           .ctx = &zeros };
        if (!wr_image_write(paths[k], &out, 1, &err)) fail_msg("%s", err.text);
        WrImageFile *file = wr_image_file_open(paths[k], &err);
        assert_non_null(file);
        assert_string_equal(wr_image_file_attribute(file, 0, "wrinkle:range"), "-1,2.5");
        assert_string_equal(wr_image_file_attribute(file, 0, "wrinkle:kind"), "height");
        assert_null(wr_image_file_attribute(file, 0, "wrinkle:other"));
        wr_image_file_close(file);
    }
}

static WrPixelType type_of(const char *path)
{
    char ending[16];
    wr_path_ending(path, ending);
    return strcmp(ending, "exr") == 0   ? WR_PIXEL_F32
           : strcmp(ending, "tif") == 0 ? WR_PIXEL_U16
                                        : WR_PIXEL_U8;
}

static void write_named(const char *path)
{
    WrError err;
    WrPixelType type = type_of(path);
    void *pixels = random_pixels(60 * 70 * 3, type, 3);
    if (!wr_image_write_pixels(path, 60, 70, 3, type, false, pixels, &err))
        fail_msg("%s", err.text);
    free(pixels);
}

static const char *const kinds[] = {
    "k.png", "k.exr", "k.tif", "k.jpg", "k.bmp", "k.tga", "k.ppm"
};
#define KINDS (int)(sizeof kinds / sizeof *kinds)

static void the_same_picture_is_the_same_bytes_a_second_later(void **state)
{
    (void)state;
    char *bytes[KINDS], *again;
    size_t length[KINDS], length_again;
    WrError err;
    for (int k = 0; k < KINDS; k++) {
        write_named(kinds[k]);
        assert_true(wr_file_read(kinds[k], 1 << 24, &bytes[k], &length[k], &err));
    }
    usleep(1100000); /* dates in files have whole seconds */
    for (int k = 0; k < KINDS; k++) {
        write_named(kinds[k]);
        assert_true(wr_file_read(kinds[k], 1 << 24, &again, &length_again, &err));
        assert_int_equal(length_again, length[k]);
        assert_memory_equal(again, bytes[k], length[k]);
        for (size_t i = 0; i + 8 < length[k]; i++)
            assert_true(memcmp(again + i, "DateTime", 8) != 0 &&
                        memcmp(again + i, "capDate", 7) != 0);
        wr_free(again);
        wr_free(bytes[k]);
    }
}

/* ---- hostile files ---- */

/* Internal names used with the libraries, or replacing file names: a user cannot interpret them. */
static bool has_inner_name(const char *message)
{
    return strstr(message, "/proc") || strstr(message, "/fd/") || strstr(message, "\"it\"") ||
           strstr(message, "'it'") || strstr(message, ".part");
}

static void check_refused(const char *path, const char *word)
{
    WrError err = { "" };
    WrImage *image = wr_image_read(path, &err);
    if (image) fail_msg("%s was read", path);
    if (strncmp(err.text, path, strlen(path)) != 0 || strchr(err.text, '\n') ||
        !strstr(err.text, word) || has_inner_name(err.text))
        fail_msg("message '%s' for %s: should name it and say '%s'", err.text, path, word);
    if (getenv("WR_TELL")) printf("%s\n", err.text);
    WrImageFile *file = wr_image_file_open(path, &err); /* opening may succeed and reading fail */
    if (!file) return;
    WrImagePart part = wr_image_file_part(file, 0);
    float *out =
        calloc((size_t)part.width * (size_t)part.height * (size_t)part.channels, sizeof *out);
    assert_false(wr_image_file_read(file, 0, out, &err));
    if (has_inner_name(err.text)) fail_msg("message '%s' for %s", err.text, path);
    if (getenv("WR_TELL")) printf("%s\n", err.text);
    free(out);
    wr_image_file_close(file);
}

static void truncated_files_are_refused_at_every_length(void **state)
{
    (void)state;
    for (int k = 0; k < KINDS; k++) {
        char *bytes, path[16];
        size_t length;
        WrError err;
        write_named(kinds[k]);
        assert_true(wr_file_read(kinds[k], 1 << 24, &bytes, &length, &err));
        /* bytes of pixels: TGA ends with a footer of 26 bytes and a developer area */
        size_t whole = length;
        if (strcmp(kinds[k], "k.tga") == 0) whole = 18 + 60 * 70 * 3;
        snprintf(path, sizeof path, "cut.%s", kinds[k] + 2);
        for (size_t cut = 1; cut <= 24; cut++) {
            assert_true(wr_file_write(path, bytes, cut < 24 ? whole * cut / 24 : whole - 1, &err));
            check_refused(path, "truncated");
        }
        wr_free(bytes);
    }
}

static void damaged_png_checksums_and_lengths_are_refused(void **state)
{
    (void)state;
    char *bytes;
    size_t length;
    WrError err;
    write_named("k.png");
    assert_true(wr_file_read("k.png", 1 << 24, &bytes, &length, &err));
    bytes[length / 2] ^= 1;
    assert_true(wr_file_write("d.png", bytes, length, &err));
    check_refused("d.png", "damaged: the checksum of PNG chunk IDAT");
    bytes[length / 2] ^= 1;
    bytes[8] = 0x7f; /* IHDR of 2 GB */
    assert_true(wr_file_write("d.png", bytes, length, &err));
    check_refused("d.png", "truncated");
    wr_free(bytes);
}

static void damaged_bytes_never_crash_a_reader(void **state)
{
    (void)state;
    TestRandom random = { 99 };
    for (int k = 0; k < KINDS; k++) {
        char *bytes, path[16];
        size_t length;
        WrError err;
        write_named(kinds[k]);
        assert_true(wr_file_read(kinds[k], 1 << 24, &bytes, &length, &err));
        snprintf(path, sizeof path, "bad.%s", kinds[k] + 2);
        for (int n = 0; n < 12; n++) {
            size_t at = 4 + (size_t)(test_random_u64(&random) % (n < 8 ? 60 : length - 4));
            char was = bytes[at];
            bytes[at] = (char)test_random_u64(&random);
            assert_true(wr_file_write(path, bytes, length, &err));
            err.text[0] = '\0';
            WrImage *image = wr_image_read(path, &err); /* may still be a valid picture */
            assert_true(image ? image->width <= WR_IMAGE_MAX : err.text[0] != '\0');
            wr_image_free(image);
            bytes[at] = was;
        }
        wr_free(bytes);
    }
}

static void what_is_no_picture_is_refused_with_a_reason(void **state)
{
    (void)state;
    WrError err;
    assert_true(wr_file_write("text.png", "table 512x512\n", 14, &err));
    check_refused("text.png", "");
    assert_true(wr_file_write("script.wrinkle", "table 512x512\n", 14, &err));
    check_refused("script.wrinkle", "not a picture");
    assert_true(wr_file_write("noending", "garbage garbage garbage", 23, &err));
    check_refused("noending", "not a picture");
    assert_true(wr_file_write("x.null", "garbage", 7, &err)); /* the library has such a format */
    check_refused("x.null", "not a picture");
    assert_true(wr_file_write("empty.exr", "", 0, &err));
    check_refused("empty.exr", "is empty");
    check_refused("missing.exr", "No such file");
    assert_int_equal(mkdir("folder.png", 0777), 0);
    check_refused("folder.png", "is a folder");
    assert_int_equal(mkfifo("pipe.png", 0666), 0);
    check_refused("pipe.png", "is a pipe"); /* and does not wait for a writer */
    TestRandom random = { 4 };
    unsigned char noise[4096];
    for (size_t i = 0; i < sizeof noise; i++) noise[i] = (unsigned char)test_random_u64(&random);
    for (int k = 0; k < KINDS; k++) {
        char path[16];
        snprintf(path, sizeof path, "noise.%s", kinds[k] + 2);
        if (k == 5) noise[1] = 9; /* TGA has no signature: an invalid colour map type */
        assert_true(wr_file_write(path, noise, sizeof noise, &err));
        check_refused(path, "");
    }
}

static void too_large_pictures_are_refused_before_memory_is_taken(void **state)
{
    (void)state;
    WrError err;
    check_refused("missing.ppm", "No such file");
    assert_true(wr_file_write("huge.ppm", "P6 60000 60000 255\n123", 22, &err));
    check_refused("huge.ppm", "60000x60000: each side must be 1..16384");
}

static void a_picture_is_known_by_its_content_not_its_name(void **state)
{
    (void)state;
    write_named("k.png");
    assert_int_equal(rename("k.png", "really_png.exr"), 0);
    WrError err = { "" };
    WrImage *image = wr_image_read("really_png.exr", &err);
    if (!image) fail_msg("%s", err.text);
    assert_int_equal(image->type, WR_PIXEL_U8);
    wr_image_free(image);
}

static void one_bit_and_sixteen_bit_pnm_read_sensibly(void **state)
{
    (void)state;
    WrError err = { "" };
    assert_true(wr_file_write("bits.pbm", "P1 4 1\n0 1 1 0\n", 15, &err)); /* 1 is black */
    WrImage *image = wr_image_read("bits.pbm", &err);
    if (!image) fail_msg("%s", err.text);
    assert_true(image->data[0] == 1 && image->data[1] == 0 && image->data[2] == 0 &&
                image->data[3] == 1);
    wr_image_free(image);
    assert_true(wr_file_write("deep.pgm", "P5 2 1 65535\n\x12\x34\xff\xff", 17, &err));
    image = wr_image_read("deep.pgm", &err);
    if (!image) fail_msg("%s", err.text);
    /* the library loses up to one code */
    assert_near(image->data[0], 0x1234 / 65535.0, 1.01 / 65535);
    assert_near(image->data[1], 1.0, 1.01 / 65535);
    wr_image_free(image);
}

/* ---- writing fails cleanly ---- */

static void types_that_a_format_cannot_hold_are_errors(void **state)
{
    (void)state;
    const struct {
        const char *path;
        WrPixelType type;
        int channels;
        bool data;
        const char *word;
    } cases[] = {
        { "x.png", WR_PIXEL_F32, 1, true, "PNG holds 8 or 16 bits; for floats use EXR or TIFF" },
        { "x.exr", WR_PIXEL_U8, 1, true, "EXR holds 32-bit floats" },
        { "x.exr", WR_PIXEL_U16, 1, true, "EXR holds 32-bit floats" },
        { "x.jpg", WR_PIXEL_U16, 1, true, "JPEG holds 8 bits" },
        { "x.bmp", WR_PIXEL_U16, 3, true, "BMP holds 8 bits" },
        { "x.tga", WR_PIXEL_F32, 3, true, "TGA holds 8 bits" },
        { "x.pgm", WR_PIXEL_U8, 3, true, "cannot store 3 channels" },
        { "x.ppm", WR_PIXEL_U8, 1, true, "cannot store 1 channel;" },
        { "x.png", WR_PIXEL_U8, 7, true, "cannot store 7 channels" },
        { "x.hdr", WR_PIXEL_F32, 3, true, "8 bits per channel" },
        { "x.exr", WR_PIXEL_F32, 257, true, "1..256" },
        { "x.xyz", WR_PIXEL_U8, 1, true, "'xyz' is not a picture format" },
        { "x", WR_PIXEL_U8, 1, true, "is not a picture format" },
        { ".png", WR_PIXEL_U8, 1, true, "is not a picture format" },
    };
    int before = files_here();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        WrError err = { "" };
        float pixels[257] = { 0 };
        assert_false(wr_image_write_pixels(cases[i].path, 1, 1, cases[i].channels, cases[i].type,
                                           cases[i].data, pixels, &err));
        if (!strstr(err.text, cases[i].word)) fail_msg("%s", err.text);
    }
    assert_int_equal(files_here(), before);
}

static bool rows_that_stop(void *ctx, int y, int rows, void *out, WrError *err)
{
    (void)ctx;
    memset(out, 0, (size_t)rows * 100 * 2);
    return y < 100 || wr_fail(err, "interrupted");
}

static void a_failed_write_leaves_the_old_file_and_nothing_else(void **state)
{
    (void)state;
    WrError err = { "" };
    const char *paths[] = { "old.png", "old.tif" };
    for (int k = 0; k < 2; k++) {
        assert_true(wr_file_write(paths[k], "precious", 8, &err));
        int before = files_here();
        WrImageOut out = {
            .width = 100, .height = 300, .channels = 1, .type = WR_PIXEL_U16, .rows = rows_that_stop
        };
        assert_false(wr_image_write(paths[k], &out, 1, &err));
        assert_string_equal(err.text, "interrupted");
        assert_int_equal(files_here(), before);
        char *bytes;
        size_t length;
        assert_true(wr_file_read(paths[k], 100, &bytes, &length, &err));
        assert_string_equal(bytes, "precious");
        wr_free(bytes);
    }
    uint8_t pixel = 0;
    mkdir("target.png", 0777);
    assert_false(wr_image_write_pixels("target.png", 1, 1, 1, WR_PIXEL_U8, true, &pixel, &err));
    assert_non_null(strstr(err.text, "is a folder"));
    assert_false(wr_image_write_pixels("nowhere/a.png", 1, 1, 1, WR_PIXEL_U8, true, &pixel, &err));
    assert_non_null(strstr(err.text, "folder does not exist"));
}

/* A limit on file sizes simulates a full disk: writes fail at the same points, down to the last byte, since errors in
   the final writes of libraries are easily overlooked. */
static void a_full_disk_is_an_error_and_leaves_nothing_half_written(void **state)
{
    (void)state;
    struct rlimit old, small = { 0, 0 };
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &old), 0);
    small.rlim_max = old.rlim_max;
    for (int k = 0; k < KINDS; k++)
        for (int room = 0; room < 6; room++) {
            rlim_t limit = (rlim_t)(room < 3 ? 2000 * room : 0);
            struct stat info;
            if (room >= 3) {
                const int missing[] = { 1, 9, 200 };
                write_named(kinds[k]);
                assert_int_equal(stat(kinds[k], &info), 0);
                limit = (rlim_t)info.st_size - (rlim_t)missing[room - 3];
            }
            unlink(kinds[k]);
            int before = files_here();
            WrError err = { "" };
            WrPixelType type = type_of(kinds[k]);
            void *pixels = random_pixels(60 * 70 * 3, type, 3);
            small.rlim_cur = limit;
            setrlimit(RLIMIT_FSIZE, &small);
            bool ok = wr_image_write_pixels(kinds[k], 60, 70, 3, type, false, pixels, &err);
            setrlimit(RLIMIT_FSIZE, &old);
            free(pixels);
            if (ok) fail_msg("%s was written with %d bytes allowed", kinds[k], (int)limit);
            char said[160];
            snprintf(said, sizeof said,
                     "%s: cannot be written (File too large: at most %d bytes are allowed here "
                     "(ulimit -f))",
                     kinds[k], (int)limit);
            assert_string_equal(err.text, said);
            assert_int_equal(files_here(), before);
        }
}

/* ---- the module ---- */

static void read_once(int index, int worker, void *ctx)
{
    (void)index;
    (void)worker;
    WrError err;
    WrImage *image = wr_image_read("t.png", &err);
    if (image) __atomic_fetch_add((int *)ctx, 1, __ATOMIC_RELAXED);
    wr_image_free(image);
}

static void many_threads_read_at_once(void **state)
{
    (void)state;
    int good = 0;
    write_named("t.png");
    WrPool *pool = wr_pool_new(8);
    wr_pool_run(pool, 64, read_once, &good);
    wr_pool_free(pool);
    assert_int_equal(good, 64);
}

/* This program in a separate folder, without the reader and the module. */
static void a_missing_module_is_an_error_and_the_variable_finds_it(void **state)
{
    (void)state;
    write_named("m.exr");
    char command[1024];
    char *folder = wr_program_folder();
    mkdir("lonely", 0777);
    snprintf(command, sizeof command, "cp /proc/%ld/exe lonely/program", (long)getpid());
    assert_int_equal(system(command), 0);
    unsetenv("WRINKLE_MODULES");
    assert_int_equal(WEXITSTATUS(system("lonely/program --read m.exr >out.txt")), 3);
    WrError err;
    char *text;
    size_t length;
    assert_true(wr_file_read("out.txt", 4096, &text, &length, &err));
    assert_non_null(strstr(text, "need the program wrinkle-reader, which was not found at: "));
    assert_non_null(strstr(text, "/lonely/wrinkle-reader"));
    wr_free(text);
    const char *inside = "WRINKLE_READER=inside lonely/program --read m.exr >out.txt";
    assert_int_equal(WEXITSTATUS(system(inside)), 3);
    assert_true(wr_file_read("out.txt", 4096, &text, &length, &err));
    assert_non_null(strstr(text, "need the module wrinkle_oiio.so, which was not found at: "));
    assert_non_null(strstr(text, "/lonely/wrinkle_oiio.so"));
    wr_free(text);
    setenv("WRINKLE_MODULES", folder, 1);
    assert_int_equal(WEXITSTATUS(system("lonely/program --read m.exr >out.txt")), 0);
    assert_int_equal(WEXITSTATUS(system(inside)), 0);
    assert_true(wr_file_write("lonely/wrinkle_oiio.so", "not a library", 13, &err));
    assert_int_equal(WEXITSTATUS(system("lonely/program --read m.exr >out.txt")), 0);
    assert_int_equal(WEXITSTATUS(system(inside)), 0);
    unsetenv("WRINKLE_MODULES");
    assert_int_equal(WEXITSTATUS(system("lonely/program --read m.exr >out.txt")), 3);
    wr_free(folder);
}

/* The sandboxed reader, which cannot open the module again, repeats the reason of the first attempt. */
static void the_reader_repeats_why_a_module_cannot_be_loaded(void **state)
{
    (void)state;
    WrError err;
    char command[1024], *folder = wr_program_folder(), *text;
    size_t length;
    write_named("m.tif");
    mkdir("half", 0777);
    snprintf(command, sizeof command,
             "cp /proc/%ld/exe half/program && cp '%s/wrinkle-reader' half", (long)getpid(),
             folder);
    assert_int_equal(system(command), 0);
    assert_true(wr_file_write("half/wrinkle_oiio.so", "not a library", 13, &err));
    assert_int_equal(WEXITSTATUS(system("half/program --read m.tif >out.txt")), 3);
    assert_true(wr_file_read("out.txt", 4096, &text, &length, &err));
    assert_non_null(strstr(text, "m.tif: picture files need the module wrinkle_oiio.so"));
    assert_non_null(strstr(text, "/half/wrinkle_oiio.so: file too short"));
    wr_free(text);
    wr_free(folder);
}

/* ---- colours ---- */

static void luma_is_rec_709_and_grey_stays_grey(void **state)
{
    (void)state;
    const float red[4] = { 1, 0, 0, 0.5f }, green[3] = { 0, 1, 0 }, blue[3] = { 0, 0, 1 };
    assert_true(wr_image_luma(red, 4) == 0.2126f);
    assert_true(wr_image_luma(green, 3) == 0.7152f);
    assert_true(wr_image_luma(blue, 3) == 0.0722f);
    const float pair[2] = { 0.3f, 0.9f };
    assert_true(wr_image_luma(pair, 1) == 0.3f && wr_image_luma(pair, 2) == 0.3f);
    for (int i = 0; i <= 65535; i += 3) {
        float g = (float)i / 65535.0f, pixel[3] = { g, g, g };
        assert_true(wr_image_luma(pixel, 3) == g);
    }
}

static void srgb_curves_are_exact_to_float_and_invert_each_other(void **state)
{
    (void)state;
    assert_true(wr_srgb_encode(0) == 0 && wr_srgb_decode(0) == 0);
    assert_true(wr_srgb_encode(1) == 1 && wr_srgb_decode(1) == 1);
    for (int i = 0; i <= 100000; i++) {
        float x = (float)(i / 100000.0);
        double want = x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
        assert_near(wr_srgb_encode(x), want, 0x1p-25 + 1e-15); /* half a float's step below 1 */
        double linear = x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
        assert_near(wr_srgb_decode(x), linear, 0x1p-25 + 1e-15);
    }
    for (int code = 0; code < 256; code++) {
        float back = wr_srgb_encode(wr_srgb_decode((float)code / 255.0f));
        assert_int_equal((int)lround(back * 255.0), code);
    }
}

static void shared_pictures_live_until_the_last_owner(void **state)
{
    (void)state;
    WrImage *a = wr_image_new(3, 2, 2, NULL);
    WrImage *b = wr_image_share(a);
    assert_ptr_equal(a, b);
    wr_image_free(a);
    assert_true(b->data[11] == 0.0f && b->width == 3);
    wr_image_free(b);
    wr_image_free(NULL);
}

/* ---- reading back ---- */

static bool rows_of_one(void *ctx, int y, int rows, void *out, WrError *err)
{
    (void)y, (void)err;
    for (int i = 0; i < 5 * 2 * rows; i++) ((float *)out)[i] = *(const float *)ctx + (float)i;
    return true;
}

/* Read back as `parts`, it must pass, or fail for that reason. */
static void assert_doubted(int fd, const WrImageOut *parts, int count, const WrHash *digests,
                           const char *reason)
{
    WrError err = { "" };
    const WrImageFormat *format = wr_image_format("a.exr", &err);
    bool good = wr_image_verify("a.exr", fd, format, parts, count, digests, &err);
    if (good != !*reason || !strstr(err.text, reason)) fail_msg("'%s': %s", reason, err.text);
}

static void whatever_does_not_come_back_is_told(void **state)
{
    (void)state;
    WrError err = { "" };
    float first = 1.0f, values[5 * 2 * 4];
    const WrImageAttribute text = { "wrinkle:scene", "bump height=1" };
    const WrImageAttribute other = { "wrinkle:scene", "bump height=2" };
    WrImageOut one = { .width = 5,
                       .height = 4,
                       .channels = 2,
                       .type = WR_PIXEL_F32,
                       .data = true,
                       .part_name = "one",
                       .attributes = &text,
                       .attribute_count = 1,
                       .rows = rows_of_one,
                       .ctx = &first };
    WrImageOut parts[2] = { one, one };
    parts[1].part_name = "two", parts[1].attribute_count = 0;
    if (!wr_image_write("a.exr", parts, 2, &err)) fail_msg("%s", err.text);
    int fd = open("a.exr", O_RDWR);
    WrHash digests[2] = { { 0 }, { 0 } };
    rows_of_one(&first, 0, 4, values, &err);
    for (int i = 0; i < 2; i++) wr_digest_strip(&digests[i], values, 5 * 2 * 4);
    assert_doubted(fd, parts, 2, digests, "");
    assert_doubted(fd, parts, 1, digests, "parts");
    digests[1].low ^= 1;
    assert_doubted(fd, parts, 2, digests, "texels of part 2");
    digests[1].low ^= 1;
    parts[1].width = 6;
    assert_doubted(fd, parts, 2, digests, "5x4, not 6x4");
    parts[1].width = 5, parts[1].height = 3;
    assert_doubted(fd, parts, 2, digests, "5x4, not 5x3");
    parts[1].height = 4, parts[0].channels = 3;
    assert_doubted(fd, parts, 2, digests, "2 channels, not 3");
    parts[0].channels = 2, parts[0].attributes = &other;
    assert_doubted(fd, parts, 2, digests, "wrinkle:scene of part 1");
    parts[0].attributes = &text;
    /* The two offsets of chunks are right before the first chunk; without the second it is not found. */
    uint64_t chunk = 0, none = 0;
    off_t at = 8;
    while (pread(fd, &chunk, 8, at) == 8 && chunk != (uint64_t)at + 16) at++;
    assert_int_equal(chunk, at + 16);
    assert_int_equal(pwrite(fd, &none, 8, at + 8), 8);
    assert_doubted(fd, parts, 2, digests, "tables");
    close(fd);
    unlink("a.exr");
}

int main(int argc, char **argv)
{
    if (argc == 3 && strcmp(argv[1], "--read") == 0) {
        WrError err;
        WrImage *image = wr_image_read(argv[2], &err);
        if (!image) puts(err.text);
        bool ok = image != NULL;
        wr_image_free(image);
        return ok ? 0 : 3;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(
            many_threads_read_at_once), /* first: several threads load the module at once */
        cmocka_unit_test(every_type_comes_back_exactly),
        cmocka_unit_test(whatever_does_not_come_back_is_told),
        cmocka_unit_test(hc95_single_pixels_and_lines_are_pictures_and_none_is_not),
        cmocka_unit_test(all_codes_read_as_code_over_the_largest),
        cmocka_unit_test(odd_floats_keep_their_bits),
        cmocka_unit_test(values_that_are_not_finite_read_as_zero_and_are_counted),
        cmocka_unit_test(hc96_nan_becomes_code_0_and_is_counted),
        cmocka_unit_test(alpha_is_never_multiplied_into_colours),
        cmocka_unit_test(jpeg_comes_back_nearly),
        cmocka_unit_test(parts_names_attributes_and_many_channels_come_back),
        cmocka_unit_test(rows_of_two_parts_come_in_any_order),
        cmocka_unit_test(small_formats_keep_attributes_in_their_description),
        cmocka_unit_test(the_same_picture_is_the_same_bytes_a_second_later),
        cmocka_unit_test(truncated_files_are_refused_at_every_length),
        cmocka_unit_test(damaged_png_checksums_and_lengths_are_refused),
        cmocka_unit_test(damaged_bytes_never_crash_a_reader),
        cmocka_unit_test(what_is_no_picture_is_refused_with_a_reason),
        cmocka_unit_test(too_large_pictures_are_refused_before_memory_is_taken),
        cmocka_unit_test(a_picture_is_known_by_its_content_not_its_name),
        cmocka_unit_test(one_bit_and_sixteen_bit_pnm_read_sensibly),
        cmocka_unit_test(types_that_a_format_cannot_hold_are_errors),
        cmocka_unit_test(a_failed_write_leaves_the_old_file_and_nothing_else),
        cmocka_unit_test(a_full_disk_is_an_error_and_leaves_nothing_half_written),
        cmocka_unit_test(a_missing_module_is_an_error_and_the_variable_finds_it),
        cmocka_unit_test(the_reader_repeats_why_a_module_cannot_be_loaded),
        cmocka_unit_test(luma_is_rec_709_and_grey_stays_grey),
        cmocka_unit_test(srgb_curves_are_exact_to_float_and_invert_each_other),
        cmocka_unit_test(shared_pictures_live_until_the_last_owner),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
