/* Tips: GIMP's files byte by byte, hostile ones, choice of cells, smoothing, sizes. */
#include "test.h"
#include "test_folder.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "brush/tip.h"
#include "image/image.h"

/* ---- files made here, byte by byte ---- */

typedef struct Bytes {
    uint8_t data[1 << 16];
    size_t size;
} Bytes;

static void add_big32(Bytes *b, uint32_t x)
{
    for (int shift = 24; shift >= 0; shift -= 8) b->data[b->size++] = (uint8_t)(x >> shift);
}

static void add(Bytes *b, const void *bytes, size_t size)
{
    memcpy(b->data + b->size, bytes, size);
    b->size += size;
}

static void add_gbr(Bytes *b, uint32_t version, uint32_t w, uint32_t h, uint32_t depth,
                    uint32_t spacing, const char *name, const uint8_t *pixels)
{
    uint32_t fixed = version == 2 ? 28 : 20;
    add_big32(b, fixed + (uint32_t)strlen(name) + 1);
    add_big32(b, version);
    add_big32(b, w);
    add_big32(b, h);
    add_big32(b, depth);
    if (version == 2) {
        add(b, "GIMP", 4);
        add_big32(b, spacing);
    }
    add(b, name, strlen(name) + 1);
    add(b, pixels, (size_t)w * h * depth);
}

static WrTip *parse(const Bytes *b)
{
    WrError err = { "" };
    WrTip *tip = wr_tip_parse(b->data, b->size, "file", &err);
    if (!tip) fail_msg("%s", err.text);
    return tip;
}

static void refused(const Bytes *b, const char *why)
{
    WrError err = { "" };
    assert_null(wr_tip_parse(b->data, b->size, "file", &err));
    if (!strstr(err.text, why)) fail_msg("\"%s\" does not say \"%s\"", err.text, why);
    assert_non_null(strstr(err.text, "file"));
}

/* The value at the centre of a pixel, as drawn at that scale's finest level. */
static double pixel(const WrTip *tip, int cell, int i, int j)
{
    WrTipView view;
    int w, h;
    wr_tip_size(tip, cell, &w, &h);
    wr_tip_view(tip, cell, 1.0, &view);
    return wr_tip_value(&view, (i + 0.5) / w, (j + 0.5) / h);
}

/* ---- .gbr ---- */

static void a_grey_gbr_gives_its_codes_top_row_first(void **state)
{
    (void)state;
    static const uint8_t codes[6] = { 0, 255, 100, 200, 50, 150 };
    Bytes b = { .size = 0 };
    add_gbr(&b, 2, 3, 2, 1, 20, "B\xc3\xbcrste", codes);
    WrTip *tip = parse(&b);
    assert_string_equal(wr_tip_name(tip), "B\xc3\xbcrste");
    assert_near(wr_tip_spacing(tip), 0.4, 1e-15); /* 20 % of the width is 0.4 of the radius */
    assert_int_equal(wr_tip_cells(tip), 1);
    for (int k = 0; k < 6; k++) assert_near(pixel(tip, 0, k % 3, k / 3), codes[k] / 255.0, 1e-6);
    wr_tip_free(tip);
}

static void a_gbr_of_version_1_has_no_spacing_of_its_own(void **state)
{
    (void)state;
    static const uint8_t codes[4] = { 10, 20, 30, 250 };
    Bytes b = { .size = 0 };
    add_gbr(&b, 1, 2, 2, 1, 0, "old", codes);
    WrTip *tip = parse(&b);
    assert_string_equal(wr_tip_name(tip), "old");
    assert_near(wr_tip_spacing(tip), 0.5, 0); /* 25 % */
    assert_near(pixel(tip, 0, 1, 1), 250 / 255.0, 1e-6);
    wr_tip_free(tip);
}

static void colours_of_a_gbr_count_as_luma_times_alpha(void **state)
{
    (void)state;
    static const uint8_t pixels[12] = { 255, 0, 0, 255, 255, 255, 255, 51, 0, 255, 0, 0 };
    Bytes b = { .size = 0 };
    add_gbr(&b, 2, 3, 1, 4, 10, "", pixels);
    WrTip *tip = parse(&b);
    assert_near(pixel(tip, 0, 0, 0), 0.2126, 1e-6);
    assert_near(pixel(tip, 0, 1, 0), 0.2, 1e-6);
    assert_near(pixel(tip, 0, 2, 0), 0, 0);
    wr_tip_free(tip);
}

static void a_gbr_that_lies_about_itself_is_refused(void **state)
{
    (void)state;
    static const uint8_t codes[4] = { 1, 2, 3, 4 };
    Bytes good = { .size = 0 };
    add_gbr(&good, 2, 2, 2, 1, 20, "x", codes);
    static const struct {
        int byte;
        uint8_t value;
        const char *why;
    } lies[] = { { 0, 0xff, "header of" }, { 3, 27, "header of" },   { 7, 3, "version 3" },
                 { 8, 0x7f, "pixels" },    { 11, 0, "0x2" },         { 12, 0x80, "pixels" },
                 { 15, 3, "truncated" },   { 19, 2, "2 bytes a pi" } };
    for (size_t i = 0; i < sizeof lies / sizeof *lies; i++) {
        Bytes bad = good;
        bad.data[lies[i].byte] = lies[i].value;
        refused(&bad, lies[i].why);
    }
    for (size_t size = 0; size < good.size; size++) {
        WrError err = { "" };
        assert_null(wr_tip_parse(good.data, size, "file", &err));
        assert_true(err.text[0] != '\0');
    }
}

static void names_of_strangers_are_cleaned(void **state)
{
    (void)state;
    static const uint8_t code[1] = { 9 };
    Bytes b = { .size = 0 };
    add_gbr(&b, 2, 1, 1, 1, 20, "a\x1b[2Jb\xff\xc0\x80\xf0\x9f\x96\x8c", code);
    WrTip *tip = parse(&b);
    assert_string_equal(wr_tip_name(tip), "a?[2Jb???\xf0\x9f\x96\x8c");
    wr_tip_free(tip);
}

/* ---- .gih ---- */

static WrTip *pipe_of(int cells, const char *second_line)
{
    Bytes b = { .size = 0 };
    add(&b, "leaves\n", 7);
    add(&b, second_line, strlen(second_line));
    add(&b, "\n", 1);
    for (int i = 0; i < cells; i++) {
        uint8_t code = (uint8_t)(10 * i);
        add_gbr(&b, 2, 1, 1, 1, 50, "cell", &code);
    }
    return parse(&b);
}

static void a_gih_holds_its_pictures_in_order(void **state)
{
    (void)state;
    WrTip *tip = pipe_of(6, "6 ncells:6 step:20 dim:1 cols:3 rows:2 rank0:6 sel0:incremental");
    assert_string_equal(wr_tip_name(tip), "leaves");
    assert_int_equal(wr_tip_cells(tip), 6);
    assert_near(wr_tip_spacing(tip), 1.0, 0);
    for (int i = 0; i < 6; i++) assert_near(pixel(tip, i, 0, 0), 10 * i / 255.0, 1e-6);
    for (uint64_t n = 0; n < 20; n++) assert_int_equal(wr_tip_pick(tip, n, 0, 1, 0), (int)(n % 6));
    wr_tip_free(tip);
}

static void random_choice_is_even_and_stays_in_range(void **state)
{
    (void)state;
    WrTip *tip = pipe_of(5, "5 ncells:5 dim:1 rank0:5 sel0:random");
    TestRandom r = { 7 };
    int seen[5] = { 0 };
    for (int n = 0; n < 5000; n++) seen[wr_tip_pick(tip, 0, 0, 1, test_random(&r))]++;
    for (int i = 0; i < 5; i++) assert_near(seen[i], 1000, 120); /* over 4 sigma */
    assert_int_equal(wr_tip_pick(tip, 0, 0, 1, 0), 0);
    assert_int_equal(wr_tip_pick(tip, 0, 0, 1, 1), 4);
    assert_int_equal(wr_tip_pick(tip, 0, 0, 1, NAN), 0);
    wr_tip_free(tip);
}

static void direction_goes_clockwise_from_above(void **state)
{
    (void)state;
    WrTip *tip = pipe_of(4, "4 ncells:4 dim:1 rank0:4 sel0:angular");
    static const double up_right_down_left[4] = { 0.5 * WR_PI, 0, -0.5 * WR_PI, WR_PI };
    for (int i = 0; i < 4; i++)
        for (int turns = -1; turns <= 1; turns++)
            assert_int_equal(
                wr_tip_pick(tip, 9, up_right_down_left[i] + 2 * WR_PI * turns + 0.1, 1, 0), i);
    assert_int_equal(wr_tip_pick(tip, 0, INFINITY, 1, 0), 0);
    wr_tip_free(tip);
}

static void pressure_goes_through_all_cells(void **state)
{
    (void)state;
    WrTip *tip = pipe_of(3, "3 ncells:3 dim:1 rank0:3 selection:pressure");
    assert_int_equal(wr_tip_pick(tip, 4, 0, 0, 0), 0);
    assert_int_equal(wr_tip_pick(tip, 4, 0, 0.5, 0), 1);
    assert_int_equal(wr_tip_pick(tip, 4, 0, 1, 0), 2);
    assert_int_equal(wr_tip_pick(tip, 4, 0, 7, 0), 2);
    assert_int_equal(wr_tip_pick(tip, 4, 0, NAN, 0), 0);
    wr_tip_free(tip);
}

static void ranks_are_digits_of_the_cell(void **state)
{
    (void)state;
    WrTip *tip =
        pipe_of(6, "6 ncells:6 dim:2 rank0:2 rank1:3 sel0:pressure sel1:incremental cols:1");
    for (uint64_t n = 0; n < 7; n++) {
        assert_int_equal(wr_tip_pick(tip, n, 0, 0.1, 0), (int)(n % 3));
        assert_int_equal(wr_tip_pick(tip, n, 0, 0.9, 0), 3 + (int)(n % 3));
    }
    wr_tip_free(tip);
}

static void what_a_stroke_does_not_measure_keeps_the_first(void **state)
{
    (void)state;
    static const char *const rules[] = { "constant", "velocity", "xtilt", "ytilt", "nonsense" };
    for (size_t i = 0; i < sizeof rules / sizeof *rules; i++) {
        char line[80];
        snprintf(line, sizeof line, "2 ncells:2 dim:1 rank0:2 sel0:%s", rules[i]);
        WrTip *tip = pipe_of(2, line);
        for (uint64_t n = 0; n < 4; n++) assert_int_equal(wr_tip_pick(tip, n, 1, 1, 0.9), 0);
        wr_tip_free(tip);
    }
}

static void ranks_that_do_not_fit_count_as_one(void **state)
{
    (void)state;
    static const char *const lines[] = { "4",
                                         "4 dim:2 rank0:3 rank1:2 sel0:incremental",
                                         "4 dim:99 rank0:4",
                                         "4 dim:1 rank0:-4 sel0:incremental",
                                         "4 dim:1 rank0:1000000000",
                                         "4 rank0: dim: :: sel0:" };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        WrTip *tip = pipe_of(4, lines[i]);
        for (uint64_t n = 0; n < 9; n++) {
            int cell = wr_tip_pick(tip, n, 0, 1, 0.5);
            assert_in_range(cell, 0, 3);
            if (i < 4) assert_int_equal(cell, (int)(n % 4));
        }
        wr_tip_free(tip);
    }
}

static void a_gih_that_lies_about_itself_is_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *why;
    } lies[] = { { "", "not a brush" },          { "name", "not a brush" },
                 { "name\n", "not a brush" },    { "name\nmany pictures\n", "not a brush" },
                 { "name\n0\n", "0 pictures" },  { "name\n1025\n", "1025 pictures" },
                 { "name\n2.5\n", "not a br" },  { "name\n-1\n", "not a brush" },
                 { "name\n1e300\n", "not a b" }, { "name\n3 dim:1\n", "picture 1 of 3" } };
    for (size_t i = 0; i < sizeof lies / sizeof *lies; i++) {
        Bytes b = { .size = 0 };
        add(&b, lies[i].text, strlen(lies[i].text));
        refused(&b, lies[i].why);
    }
}

/* ---- pictures ---- */

static void an_image_counts_as_luma_times_alpha(void **state)
{
    (void)state;
    const char *path = "tip.png";
    WrError err = { "" };
    static const uint16_t pixels[8] = { 65535, 0, 0, 65535, 65535, 65535, 65535, 13107 };
    assert_true(wr_image_write_pixels(path, 2, 1, 4, WR_PIXEL_U16, true, pixels, &err));
    WrTip *tip = wr_tip_read(path, &err);
    if (!tip) fail_msg("%s", err.text);
    assert_near(pixel(tip, 0, 0, 0), 0.2126, 2e-5);
    assert_near(pixel(tip, 0, 1, 0), 0.2, 2e-5);
    assert_near(wr_tip_spacing(tip), 0, 0);
    WrTip *shared = wr_tip_share(tip);
    wr_tip_free(tip);
    assert_near(pixel(shared, 0, 1, 0), 0.2, 2e-5);
    wr_tip_free(shared);
}

static void a_file_that_is_missing_or_no_picture_is_named(void **state)
{
    (void)state;
    static const char *const paths[] = { "/tmp/no such tip.gbr", "/tmp/no such tip.png",
                                         "/tmp/no such tip" };
    for (int i = 0; i < 3; i++) {
        WrError err = { "" };
        assert_null(wr_tip_read(paths[i], &err));
        assert_non_null(strstr(err.text, "no such tip"));
    }
}

/* ---- smoothing ---- */

static WrTip *smoothed(int w, int h, const float *codes)
{
    WrError err = { "" };
    float *values = wr_alloc((size_t)w * (size_t)h, sizeof *values);
    for (int k = 0; k < w * h; k++) values[k] = codes[k] / 255.0f;
    WrTip *tip = wr_tip_new(w, h, values, 255, &err);
    if (!tip) fail_msg("%s", err.text);
    wr_free(values);
    return tip;
}

/* Codes of an exact ramp with `step` pixels per code, along a direction: second differences are within a seventh of a
 * code (those of the codes are a whole one), and no value changes by over half a code. */
static void check_ramp(double step, double across)
{
    enum { W = 300, H = 90 };
    static float codes[W * H];
    for (int k = 0; k < W * H; k++)
        codes[k] = rintf((float)(3.0 + (k % W + across * (k / W)) / step));
    WrTip *tip = smoothed(W, H, codes);
    double most = 0, stair = 0;
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++) {
            double c = codes[j * W + i];
            assert_near(pixel(tip, 0, i, j) * 255, c, 0.5 + 1e-4);
            if (i < 12 || i >= W - 12 || j < 12 || j >= H - 12) continue;
            const float *row = &codes[j * W + i];
            double second =
                pixel(tip, 0, i - 1, j) + pixel(tip, 0, i + 1, j) - 2 * pixel(tip, 0, i, j);
            most = fmax(most, fabs(second) * 255);
            stair = fmax(stair, fabs((double)row[-1] + (double)row[1] - 2.0 * (double)row[0]));
        }
    assert_true(stair >= 1);
    if (most > 1.0 / 7) fail_msg("%g pixels a code: second difference of %g codes", step, most);
    wr_tip_free(tip);
}

static void hc51_8_bit_ramps_come_without_stairs(void **state)
{
    (void)state;
    check_ramp(2.3, 0);
    check_ramp(5, 0.37);
    check_ramp(8, 0.1);
    check_ramp(12.7, 0);
    check_ramp(40, 0.2);
}

static void grain_and_edges_keep_their_codes_and_black_stays_black(void **state)
{
    (void)state;
    enum { N = 64 };
    static float codes[N * N];
    TestRandom r = { 3 };
    for (int k = 0; k < N * N; k++)
        codes[k] = k % N < 20 ? 0.0f : k % N < 40 ? 255.0f : (float)(test_random_u64(&r) % 256);
    WrTip *tip = smoothed(N, N, codes);
    for (int k = 0; k < N * N; k++) {
        double value = pixel(tip, 0, k % N, k / N), code = codes[k];
        assert_near(value * 255, code, 0.5 + 1e-4);
        if (k % N < 40) assert_true(value == code / 255);
    }
    wr_tip_free(tip);
}

static void a_constant_stays_constant_at_every_scale(void **state)
{
    (void)state;
    enum { W = 37, H = 22 };
    static float codes[W * H];
    for (int c = 0; c < 256; c += 51) {
        for (int k = 0; k < W * H; k++) codes[k] = (float)c;
        WrTip *tip = smoothed(W, H, codes);
        for (double scale = 3; scale > 0.1; scale *= 0.7) {
            WrTipView view;
            wr_tip_view(tip, 0, scale, &view);
            /* Half a pixel of the coarsest used level inside. */
            double edge = 0.5 / (view.coarse ? view.coarse_h : view.fine_h);
            for (double s = edge; s <= 1 - edge; s += 0.04)
                assert_near(wr_tip_value(&view, s, 1 - s), c / 255.0, 1e-6);
        }
        wr_tip_free(tip);
    }
}

/* ---- sizes ---- */

static void every_size_keeps_the_mean(void **state)
{
    (void)state;
    static const int sizes[][2] = { { 64, 64 }, { 37, 22 }, { 1, 50 }, { 101, 3 }, { 1, 1 } };
    TestRandom r = { 5 };
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        int w = sizes[k][0], h = sizes[k][1];
        float values[64 * 64];
        double mean = 0;
        for (int i = 0; i < w * h; i++) {
            values[i] = (float)test_random(&r);
            mean += (double)values[i] / (w * h);
        }
        WrError err;
        WrTip *tip = wr_tip_new(w, h, values, 0, &err);
        assert_non_null(tip);
        WrTipView view;
        int levels = 0;
        for (double scale = 1; scale > 1e-4; scale /= 2, levels++) {
            wr_tip_view(tip, 0, scale, &view);
            assert_null(view.coarse); /* a power of two is a level itself */
            double sum = 0;
            int n = view.fine_w * view.fine_h;
            for (int i = 0; i < n; i++) sum += (double)view.fine[i];
            assert_near(sum / n, mean, 1e-6);
        }
        assert_int_equal(view.fine_w * view.fine_h, 1);
        wr_tip_free(tip);
    }
}

static void sizes_pass_into_each_other(void **state)
{
    (void)state;
    float values[32 * 32];
    TestRandom r = { 11 };
    for (int i = 0; i < 32 * 32; i++) values[i] = (float)test_random(&r);
    WrError err;
    WrTip *tip = wr_tip_new(32, 32, values, 0, &err);
    assert_non_null(tip);
    static const double scales[] = { 1, 0.5, 0.25, 0.125 };
    for (int k = 0; k < 4; k++) {
        WrTipView above, below;
        wr_tip_view(tip, 0, scales[k] * (1 + 1e-9), &above);
        wr_tip_view(tip, 0, scales[k] * (1 - 1e-9), &below);
        for (double s = 0.03; s < 1; s += 0.05)
            assert_near(wr_tip_value(&above, s, 0.6), wr_tip_value(&below, s, 0.6), 1e-6);
    }
    wr_tip_free(tip);
}

static void between_pixels_it_is_bilinear_and_outside_it_fades_to_nothing(void **state)
{
    (void)state;
    static const float values[4] = { 0.2f, 0.6f, 0.4f, 1.0f };
    WrError err;
    WrTip *tip = wr_tip_new(2, 2, values, 0, &err);
    assert_non_null(tip);
    WrTipView view;
    wr_tip_view(tip, 0, 8, &view);
    assert_near(wr_tip_value(&view, 0.25, 0.25), 0.2, 1e-7);
    assert_near(wr_tip_value(&view, 0.5, 0.5), 0.55, 1e-7);
    assert_near(wr_tip_value(&view, 0.5, 0.25), 0.4, 1e-7);
    assert_near(wr_tip_value(&view, 1, 0.75), 0.5, 1e-7); /* half-way from 1 to the 0 outside */
    assert_near(wr_tip_value(&view, 1.25, 0.75), 0, 0);
    assert_near(wr_tip_value(&view, -0.25, 0.75), 0, 0);
    assert_near(wr_tip_value(&view, 1e300, 0.5), 0, 0);
    assert_near(wr_tip_value(&view, NAN, 0.5), 0, 0);
    wr_tip_free(tip);
}

static void sizes_and_values_out_of_range_are_met(void **state)
{
    (void)state;
    static const float values[4] = { -1.0f, 2.0f, NAN, 0.5f };
    WrError err = { "" };
    assert_null(wr_tip_new(0, 4, values, 0, &err));
    assert_non_null(strstr(err.text, "0x4"));
    assert_null(wr_tip_new(4, WR_TIP_SIDE + 1, values, 0, &err));
    assert_null(wr_tip_new(2, 2, values, -1, &err));
    WrTip *tip = wr_tip_new(2, 2, values, 0, &err);
    assert_near(pixel(tip, 0, 0, 0), 0, 0);
    assert_near(pixel(tip, 0, 1, 0), 1, 0);
    assert_near(pixel(tip, 0, 0, 1), 0, 0);
    WrTipView view;
    static const double scales[] = { 0, -1, NAN, INFINITY, 1e-300 };
    for (int k = 0; k < 5; k++) {
        wr_tip_view(tip, 0, scales[k], &view);
        assert_true(isfinite(wr_tip_value(&view, 0.5, 0.5)));
    }
    wr_tip_free(tip);
    wr_tip_free(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_grey_gbr_gives_its_codes_top_row_first),
        cmocka_unit_test(a_gbr_of_version_1_has_no_spacing_of_its_own),
        cmocka_unit_test(colours_of_a_gbr_count_as_luma_times_alpha),
        cmocka_unit_test(a_gbr_that_lies_about_itself_is_refused),
        cmocka_unit_test(names_of_strangers_are_cleaned),
        cmocka_unit_test(a_gih_holds_its_pictures_in_order),
        cmocka_unit_test(random_choice_is_even_and_stays_in_range),
        cmocka_unit_test(direction_goes_clockwise_from_above),
        cmocka_unit_test(pressure_goes_through_all_cells),
        cmocka_unit_test(ranks_are_digits_of_the_cell),
        cmocka_unit_test(what_a_stroke_does_not_measure_keeps_the_first),
        cmocka_unit_test(ranks_that_do_not_fit_count_as_one),
        cmocka_unit_test(a_gih_that_lies_about_itself_is_refused),
        cmocka_unit_test(an_image_counts_as_luma_times_alpha),
        cmocka_unit_test(a_file_that_is_missing_or_no_picture_is_named),
        cmocka_unit_test(hc51_8_bit_ramps_come_without_stairs),
        cmocka_unit_test(grain_and_edges_keep_their_codes_and_black_stays_black),
        cmocka_unit_test(a_constant_stays_constant_at_every_scale),
        cmocka_unit_test(every_size_keeps_the_mean),
        cmocka_unit_test(sizes_pass_into_each_other),
        cmocka_unit_test(between_pixels_it_is_bilinear_and_outside_it_fades_to_nothing),
        cmocka_unit_test(sizes_and_values_out_of_range_are_met),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
