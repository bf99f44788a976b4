/* Heights from picture files read row by row: the same bits as from the whole picture, without storing it. */
#include "test.h"
#include "test_folder.h"

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "document/document_file.h"
#include "field/field.h"
#include "image/image.h"

#include <unistd.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SANITIZED 1
#else
#define SANITIZED 0
#endif

static void write_floats(const char *path, int width, int height, int channels)
{
    WrError err;
    TestRandom random = { 12 };
    float *values = malloc((size_t)(width * height * channels) * sizeof *values);
    for (int i = 0; i < width * height * channels; i++)
        values[i] = i % 97 == 0 ? -0.0f : i % 101 == 0 ? NAN : (float)test_random(&random) - 0.5f;
    if (!wr_image_write_pixels(path, width, height, channels, WR_PIXEL_F32, true, values, &err))
        fail_msg("%s", err.text);
    free(values);
}

typedef struct TestCodes {
    int width;
    TestRandom random;
} TestCodes;

static bool code_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    TestCodes *codes = ctx;
    (void)y, (void)err;
    for (int k = 0; k < rows * codes->width; k++)
        ((uint8_t *)out)[k] = (uint8_t)(255 * test_random(&codes->random));
    return true;
}

/* Both ways to a table of that size. */
static void expect_same(const char *path, const WrImageRequest *wish, int width, int height,
                        WrWrap wrap)
{
    WrError err = { "" };
    WrImage *image = wr_image_read_request(path, wish, &err);
    WrImageRows *rows = wr_image_rows_open(path, wish, &err);
    if (!image || !rows) fail_msg("%s", err.text);
    const WrImage *head = wr_image_rows_head(rows);
    assert_int_equal(head->width, image->width);
    assert_int_equal(head->height, image->height);
    assert_int_equal(head->channels, image->channels);
    assert_int_equal(head->type, image->type);
    const bool ranged = wr_image_apply_range(image);
    assert_int_equal(wr_image_rows_apply_range(rows), ranged);
    WrField *a = wr_import_heights(image, width, height, wrap, WR_WRAP_CLAMP, &err);
    WrField *b = wr_import_rows(rows, width, height, wrap, WR_WRAP_CLAMP, &err);
    assert_non_null(a);
    assert_non_null(b);
    WrHash one = wr_field_hash(a), other = wr_field_hash(b);
    assert_true(wr_hash_equal(one, other));
    assert_int_equal(head->replaced, image->replaced);
    assert_true(image->type != WR_PIXEL_F32 || image->replaced > 0);
    assert_string_equal(head->taken, image->taken);
    wr_field_free(a);
    wr_field_free(b);
    wr_image_rows_close(rows);
    wr_image_free(image);
}

static const WrImageRequest all = { .channel = NULL };

static void rows_give_the_same_heights_as_the_whole_picture(void **state)
{
    (void)state;
    const int sizes[][2] = { { 0, 0 },    { 300, 700 }, { 100, 350 }, { 77, 699 },  { 400, 700 },
                             { 50, 701 }, { 1, 1 },     { 310, 2 },   { 300, 1400 } };
    for (int channels = 1; channels <= 4; channels++) {
        write_floats("a.tif", 300, 700, channels);
        for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++)
            for (int wrap = 0; wrap < 2; wrap++) /* an ordinary run: one of both, by turns */
                if (getenv("WR_FULL") || ((int)k + channels + wrap) % 2)
                    expect_same("a.tif", &all, sizes[k][0], sizes[k][1],
                                wrap ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC);
    }
}

enum { WIDE = 70, TALL = 1300, LAYERS = 6 };

/* Channel c is c + row / 8, with the lowest value of a column in it; Z is 0 except at the bottom, nil is all 0; and
   some values are not finite. */
static bool layer_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    float *to = out;
    (void)ctx, (void)err;
    for (int j = y; j < y + rows; j++)
        for (int i = 0; i < WIDE; i++)
            for (int c = 0; c < LAYERS; c++) {
                const bool none = c == LAYERS - 1 || (c == 3 && j < TALL - 5);
                *to++ = (j + i) % 89 == 0 ? INFINITY
                        : none            ? 0.0f
                                          : (float)(c + j / 8.0 + i / 1024.0);
            }
    return true;
}

static void write_layers(const char *path)
{
    static const char *const names[LAYERS] = { "B", "G", "R", "Z", "d.X", "nil" };
    WrImageOut out[2];
    WrError err;
    for (int p = 0; p < 2; p++)
        out[p] = (WrImageOut){ .width = WIDE,
                               .height = TALL,
                               .channels = LAYERS,
                               .type = WR_PIXEL_F32,
                               .channel_names = names,
                               .part_name = p == 0 ? "near" : "far",
                               .data = true,
                               .rows = layer_rows };
    if (!wr_image_write(path, out, 2, &err)) fail_msg("%s", err.text);
}

static void rows_are_of_the_channels_and_the_part_that_are_wished_for(void **state)
{
    (void)state;
    static const WrImageRequest wishes[] = { { .channel = NULL },
                                             { .channel = "Z" },
                                             { .channel = "d.X", .part = "far" },
                                             { .channel = "B", .part = "2" } };
    write_layers("layers.exr");
    for (size_t k = 0; k < sizeof wishes / sizeof *wishes; k++) {
        expect_same("layers.exr", &wishes[k], 0, 0, WR_WRAP_CLAMP);
        expect_same("layers.exr", &wishes[k], 35, 600, WR_WRAP_PERIODIC);
        expect_same("layers.exr", &wishes[k], 71, TALL + 1, WR_WRAP_PERIODIC);
    }
}

/* Compared with the definition, since both ways above share one loop. */
static void rows_have_the_values_of_the_file(void **state)
{
    (void)state;
    WrError err = { "" };
    const WrImageRequest wish = { .channel = "d.X" };
    write_layers("layers.exr");
    WrImageRows *rows = wr_image_rows_open("layers.exr", &wish, &err);
    if (!rows) fail_msg("%s", err.text);
    assert_int_equal(wr_image_rows_head(rows)->channels, 1);
    for (int y = 0; y < TALL; y++) {
        const float *row = wr_image_rows_get(rows, y, &err);
        if (!row) fail_msg("%s", err.text);
        for (int x = 0; x < WIDE; x++) {
            float want = (y + x) % 89 == 0 ? 0.0f : (float)(4 + y / 8.0 + x / 1024.0);
            assert_true(row[x] == want);
        }
    }
    assert_null(strstr(wr_image_rows_head(rows)->taken, "is 0"));
    wr_image_rows_close(rows);
}

/* Check that a channel is 0 or not; only its last row reveals it. */
static void expect_zero(const char *channel, bool zero)
{
    WrError err = { "" };
    const WrImageRequest wish = { .channel = channel };
    WrImageRows *rows = wr_image_rows_open("layers.exr", &wish, &err);
    if (!rows) fail_msg("%s", err.text);
    const WrImage *head = wr_image_rows_head(rows);
    assert_non_null(strstr(head->taken, channel));
    assert_null(strstr(head->taken, "is 0"));
    WrField *field = wr_import_rows(rows, 0, 0, WR_WRAP_CLAMP, WR_WRAP_CLAMP, &err);
    assert_non_null(field);
    assert_int_equal(strstr(head->taken, "; all of it is 0") != NULL, zero);
    wr_field_free(field);
    wr_image_rows_close(rows);
    expect_same("layers.exr", &wish, 0, 0, WR_WRAP_CLAMP);
}

static void it_is_told_where_all_that_was_taken_is_0(void **state)
{
    (void)state;
    WrError err = { "" };
    write_layers("layers.exr");
    expect_zero("nil", true);
    expect_zero("Z", false);
    const WrImageRequest none = { .channel = "specular" };
    assert_null(wr_image_rows_open("layers.exr", &none, &err));
    assert_non_null(strstr(err.text, "layers.exr: "));
}

/* Codes that a label converts to heights. */
static void rows_get_the_range_of_their_label(void **state)
{
    (void)state;
    static const WrImageAttribute attributes[] = { { "wrinkle:kind", "height" },
                                                   { "wrinkle:range", "-3,5" } };
    WrError err = { "" };
    TestCodes codes = { 90, { 5 } };
    const WrImageOut out = { .width = 90,
                             .height = 900,
                             .channels = 1,
                             .type = WR_PIXEL_U8,
                             .attributes = attributes,
                             .attribute_count = 2,
                             .rows = code_rows,
                             .ctx = &codes };
    if (!wr_image_write("label.png", &out, 1, &err)) fail_msg("%s", err.text);
    WrImageRows *rows = wr_image_rows_open("label.png", &all, &err);
    assert_true(rows && wr_image_rows_apply_range(rows));
    wr_image_rows_close(rows);
    expect_same("label.png", &all, 0, 0, WR_WRAP_CLAMP);
    expect_same("label.png", &all, 45, 301, WR_WRAP_CLAMP);
    expect_same("label.png", &all, 45, 901, WR_WRAP_CLAMP);
}

static void a_picture_that_breaks_off_is_an_error(void **state)
{
    (void)state;
    char *bytes;
    size_t length;
    WrError err = { "" };
    write_floats("a.tif", 300, 700, 1);
    assert_true(wr_file_read("a.tif", 1 << 24, &bytes, &length, &err));
    memset(bytes + length / 2, 0x55, length / 4);
    assert_true(wr_file_write("a.tif", bytes, length, &err));
    wr_free(bytes);
    WrImageRows *rows = wr_image_rows_open("a.tif", &all, &err);
    if (!rows) return; /* that is as good */
    assert_null(wr_import_rows(rows, 0, 0, WR_WRAP_CLAMP, WR_WRAP_CLAMP, &err));
    assert_non_null(strstr(err.text, "a.tif: "));
    wr_image_rows_close(rows);
    assert_null(wr_image_rows_open("missing.png", &all, &err));
}

/* Peak memory of this process in kilobytes since the last call. */
static long peak(void)
{
    long value = -1;
    char line[256];
    FILE *file = fopen("/proc/self/status", "r");
    while (file && fgets(line, sizeof line, file))
        if (strncmp(line, "VmHWM:", 6) == 0) value = atol(line + 6);
    if (file) fclose(file);
    file = fopen("/proc/self/clear_refs", "w");
    if (!file || fputs("5", file) < 0 || fclose(file) != 0) skip();
    return value;
}

/* Constant except for a corner. */
static void write_flat(const char *path, int side)
{
    WrError err;
    unsigned char *codes = malloc((size_t)side * (size_t)side);
    memset(codes, 0x40, (size_t)side * (size_t)side);
    codes[(size_t)side * (size_t)side - 1] = 0x41;
    if (!wr_image_write_pixels(path, side, side, 1, WR_PIXEL_U8, true, codes, &err))
        fail_msg("%s", err.text);
    free(codes);
}

static void a_large_flat_picture_costs_next_to_no_memory(void **state)
{
    (void)state;
    if (SANITIZED) skip();
    enum { SIDE = 6000 };
    WrError err = { "" };
    write_flat("flat.png", SIDE);
    WrImageRows *rows = wr_image_rows_open("flat.png", &all, &err);
    if (!rows) fail_msg("%s", err.text);
    peak();
    long before = peak();
    WrField *field = wr_import_rows(rows, 0, 0, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, &err);
    long more = peak() - before;
    assert_non_null(field);
    assert_true(wr_field_get(field, 5, 5) == 64.0f / 255.0f);
    assert_true(wr_field_get(field, SIDE - 1, SIDE - 1) == 65.0f / 255.0f);
    assert_true(wr_field_bytes(field) <= 2 * sizeof(float) * WR_TILE * WR_TILE);
    if (more > 48 << 10) fail_msg("%ld KB; the picture has %d as floats", more, SIDE * SIDE / 256);
    wr_field_free(field);
    wr_image_rows_close(rows);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_give_the_same_heights_as_the_whole_picture),
        cmocka_unit_test(rows_are_of_the_channels_and_the_part_that_are_wished_for),
        cmocka_unit_test(rows_have_the_values_of_the_file),
        cmocka_unit_test(it_is_told_where_all_that_was_taken_is_0),
        cmocka_unit_test(rows_get_the_range_of_their_label),
        cmocka_unit_test(a_picture_that_breaks_off_is_an_error),
        cmocka_unit_test(a_large_flat_picture_costs_next_to_no_memory),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
