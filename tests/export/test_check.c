/* Results of the check for pictures generated here from closed forms. */
#include "test.h"
#include "test_folder.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/file.h"
#include "base/memory.h"
#include "export/check.h"
#include "image/image.h"

#define W 37
#define H 53
#define BIT(problem) (1u << (problem))

/* F and its slopes, per cell, v up; `turns` along u: integers are seamless. */
static double height(double u, double v, double turns, double *p, double *q)
{
    const double x = 2 * WR_PI * (turns * u + 2 * v) + 0.7134, y = 6 * WR_PI * v + 2.219;
    const double z = 2 * WR_PI * (v - turns * u) + 5.071;
    *p = 2 * WR_PI * turns * (0.021 * cos(x) - 0.008 * cos(z));
    *q = 2 * WR_PI * (0.042 * cos(x) + 0.03 * cos(y) + 0.008 * cos(z));
    return 0.5 + 0.21 * sin(x) + 0.1 * sin(y) + 0.08 * sin(z);
}

static double centre_u(int t)
{
    return (t % W + 0.5) / W;
}

static double centre_v(int t)
{
    return 1 - ((double)((t - t % W) / W) + 0.5) / H;
}

/* ---- files ---- */

typedef struct Sheet {
    int channels, bits; /* bits 32: floats */
    double numbers[W * H * 3];
} Sheet;

static bool sheet_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    const Sheet *s = ctx;
    (void)err;
    for (int i = 0; i < rows * W * s->channels; i++) {
        const double x = s->numbers[y * W * s->channels + i];
        if (s->bits == 8) ((uint8_t *)out)[i] = (uint8_t)floor(x * 255 + 0.5);
        else if (s->bits == 16) ((uint16_t *)out)[i] = (uint16_t)floor(x * 65535 + 0.5);
        else ((float *)out)[i] = (float)x;
    }
    return true;
}

/* label: of this program, or NULL. */
static void write_sheet(const char *path, Sheet *s, const char *label)
{
    static const char *const slopes[] = { "p", "q" };
    const WrImageAttribute kind = { "wrinkle:kind", label };
    const WrImageOut out = { .width = W,
                             .height = H,
                             .channels = s->channels,
                             .type = s->bits == 8    ? WR_PIXEL_U8
                                     : s->bits == 16 ? WR_PIXEL_U16
                                                     : WR_PIXEL_F32,
                             .channel_names = s->channels == 2 ? slopes : NULL,
                             .attributes = &kind,
                             .attribute_count = label ? 1 : 0,
                             .data = true,
                             .rows = sheet_rows,
                             .ctx = s };
    WrError err = { "" };
    if (!wr_image_write(path, &out, 1, &err)) fail_msg("%s", err.text);
}

static WrCheck check_as(const char *path, int kind)
{
    WrCheck check;
    WrError err = { "" };
    if (!wr_check_picture(path, kind, WR_CODING_AUTO, &check, &err)) fail_msg("%s", err.text);
    return check;
}

static WrCheck check_sheet(Sheet *s, const char *label)
{
    const char *path = s->bits == 32 ? "s.exr" : "s.png";
    write_sheet(path, s, label);
    return check_as(path, -1);
}

static Sheet heights(int bits, double turns)
{
    Sheet s = { .channels = 1, .bits = bits };
    double p, q;
    for (int t = 0; t < W * H; t++) s.numbers[t] = height(centre_u(t), centre_v(t), turns, &p, &q);
    return s;
}

/* ---- edges ---- */

static void edges_that_meet_are_seamless_and_others_are_told(void **state)
{
    const int bits[] = { 8, 16, 32 };
    (void)state;
    for (int k = 0; k < 3; k++) {
        Sheet whole = heights(bits[k], 2), cut = heights(bits[k], 1.83);
        WrCheck good = check_sheet(&whole, NULL), bad = check_sheet(&cut, NULL);
        assert_true(good.kind == WR_CHECK_HEIGHT && good.width == W && good.height == H);
        assert_true(good.problems == 0 && good.u.judged && good.v.judged);
        assert_true(good.depth == bits[k] && good.u.test.order == 2 && good.v.test.order == 2);
        assert_int_equal(bad.problems, BIT(WR_CHECK_SEAM_U));
        assert_true(bad.u.seam && !bad.u.repeats && bad.u.test.order == -1 && !bad.v.seam);
    }
}

/* A jump in three of 53 rows, and one of the slope only: x^2 about the middle. */
static void short_breaks_and_creases_are_seams(void **state)
{
    (void)state;
    Sheet local = heights(16, 2), crease = { .channels = 1, .bits = 16 };
    for (int j = 20; j < 23; j++)
        for (int i = 0; i < 5; i++) local.numbers[j * W + i] += 0.17 * (5 - i) / 5;
    assert_int_equal(check_sheet(&local, NULL).problems, BIT(WR_CHECK_SEAM_U));
    for (int t = 0; t < W * H; t++)
        crease.numbers[t] = 0.1 + 2.9 * (centre_v(t) - 0.5) * (centre_v(t) - 0.5) +
                            0.03 * sin(14 * WR_PI * centre_u(t));
    assert_int_equal(check_sheet(&crease, NULL).problems, BIT(WR_CHECK_SEAM_V));
}

/* Samples at i/(W - 1): the last column repeats the first. */
static void a_repeated_line_is_told(void **state)
{
    (void)state;
    Sheet s = { .channels = 1, .bits = 32 };
    double p, q;
    for (int t = 0; t < W * H; t++)
        s.numbers[t] = height((double)(t % W % (W - 1)) / (W - 1), centre_v(t), 3, &p, &q);
    WrCheck check = check_sheet(&s, NULL);
    assert_int_equal(check.problems, BIT(WR_CHECK_SEAM_U));
    assert_true(check.u.repeats && !check.v.repeats);
}

/* ---- numbers ---- */

static void steps_of_fewer_bits_are_told(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) { /* 257 k, 256 k, k/255 and half precision as floats */
        Sheet s = heights(k < 2 ? 16 : 32, 2);
        for (int t = 0; t < W * H; t++) {
            const double code = floor(s.numbers[t] * 255 + 0.5);
            if (k == 0 || k == 2) s.numbers[t] = code / 255;
            else if (k == 1) s.numbers[t] = code * 256 / 65535;
            else s.numbers[t] = 0.5 + floor((s.numbers[t] - 0.5) * 1024) / 1024;
        }
        WrCheck check = check_sheet(&s, NULL);
        assert_int_equal(check.problems, k < 3 ? BIT(WR_CHECK_STEPS) : 0);
        assert_int_equal(check.numbers.bits, k < 3 ? 8 : 16);
        assert_true(check.numbers.half == (k == 3));
    }
    Sheet words = heights(16, 2), floats = heights(32, 2), ten = heights(16, 2);
    for (int t = 0; t < W * H; t++)
        ten.numbers[t] = floor(floor(ten.numbers[t] * 1023 + 0.5) * 65535 / 1023 + 0.5) / 65535;
    assert_int_equal(check_sheet(&words, NULL).numbers.bits, 16);
    assert_int_equal(check_sheet(&ten, NULL).numbers.bits, 10);
    WrCheck check = check_sheet(&floats, NULL);
    assert_true(check.numbers.bits == 32 && !check.numbers.half);
}

static void numbers_are_counted(void **state)
{
    (void)state;
    Sheet s = { .channels = 1, .bits = 8 };
    for (int t = 0; t < W * H; t++) s.numbers[t] = (20 + t % 13) / 255.0;
    for (int t = 0; t < 100; t++) s.numbers[7 * t] = 201 / 255.0;
    for (int t = 0; t < 30; t++) s.numbers[7 * t + 1] = 3 / 255.0;
    WrCheckNumbers n = check_sheet(&s, NULL).numbers;
    assert_int_equal(n.distinct, 15);
    assert_near(n.low, 3 / 255.0, 1e-7);
    assert_near(n.high, 201 / 255.0, 1e-7);
    assert_near(n.at_low, 30.0 / (W * H), 1e-12);
    assert_near(n.at_high, 100.0 / (W * H), 1e-12);
    Sheet floats = { .channels = 1, .bits = 32 };
    for (int t = 0; t < W * H; t++) floats.numbers[t] = 1e5 * sqrt(2.0 + t % 1234);
    assert_int_equal(check_sheet(&floats, NULL).numbers.distinct, 1234);
}

static void what_is_not_finite_is_told(void **state)
{
    (void)state;
    Sheet s = heights(32, 2);
    s.numbers[5] = NAN, s.numbers[900] = INFINITY;
    WrCheck check = check_sheet(&s, NULL);
    assert_int_equal(check.replaced, 2);
    assert_true(check.problems & BIT(WR_CHECK_LOST));
}

/* ---- normals ---- */

/* scale: length factor of every third vector. twist: green from other slopes than the heights'. */
static Sheet normals(int bits, bool down, double scale, bool twist)
{
    Sheet s = { .channels = 3, .bits = bits };
    for (int t = 0; t < W * H; t++) {
        double p, q, other, own;
        height(centre_u(t), centre_v(t), 2, &p, &q);
        height(centre_u(t) + 0.377, centre_v(t), 3, &other, &own);
        if (twist) q = other;
        const double length = sqrt(1 + p * p + q * q) / (t % 3 ? 1 : scale);
        const double n[3] = { -p / length, (down ? q : -q) / length, 1 / length };
        for (int c = 0; c < 3; c++) s.numbers[3 * t + c] = n[c] / 2 + 0.5;
    }
    return s;
}

static void greens_lengths_and_curls_are_found(void **state)
{
    const int bits[] = { 8, 16, 32 };
    (void)state;
    for (int k = 0; k < 6; k++) {
        const bool down = k / 3;
        Sheet good = normals(bits[k % 3], down, 1, false),
              bent = normals(bits[k % 3], down, 1, true);
        Sheet off = normals(bits[k % 3], down, 0.87, false);
        WrCheck check = check_sheet(&good, NULL);
        assert_true(check.kind == WR_CHECK_NORMAL && check.problems == 0);
        assert_true(check.normals.green_known && check.normals.green_down == down);
        assert_true(check.normals.curl_known && check.normals.curl < 0.1);
        assert_true(check.normals.off < (bits[k % 3] == 8 ? 0.007 : 3e-5));
        check = check_sheet(&off, NULL);
        assert_int_equal(check.problems, BIT(WR_CHECK_LENGTH));
        assert_near(check.normals.off, 0.13, bits[k % 3] == 8 ? 0.007 : 3e-5);
        check = check_sheet(&bent, NULL);
        assert_int_equal(check.problems, BIT(WR_CHECK_CURL));
        assert_true(check.normals.curl > 0.7 && check.normals.curl < 1.4143);
    }
}

/* Most of a map is flat, with code 128 for 0, around a steep disc. Rounding of unit vectors is no wrong length, and a
 * blue of 128 does not face away. */
static void a_steep_disc_in_flat_ground_is_good(void **state)
{
    (void)state;
    static const double slopes[] = { 0.7, 4, 60, 400 };
    for (int k = 0; k < 8; k++) {
        Sheet s = { .channels = 3, .bits = k < 4 ? 8 : 16 };
        for (int t = 0; t < W * H; t++) {
            const double x = t % W - 18.3, y = (double)((t - t % W) / W) - 25.7,
                         r = sqrt(x * x + y * y), slope = r < 11 ? slopes[k % 4] * r / 11 : 0;
            const double length = sqrt(1 + slope * slope);
            s.numbers[3 * t] = slope * x / r / length / 2 + 0.5;
            s.numbers[3 * t + 1] = -slope * y / r / length / 2 + 0.5;
            s.numbers[3 * t + 2] = 1 / length / 2 + 0.5;
        }
        WrCheck check = check_sheet(&s, NULL);
        assert_int_equal(check.kind, WR_CHECK_NORMAL);
        if (check.problems & (BIT(WR_CHECK_LENGTH) | BIT(WR_CHECK_AWAY)))
            fail_msg("slope %g: problems %x, off %.4g", slopes[k % 4], check.problems,
                     check.normals.off);
    }
}

/* Sharp veins in smooth marble, cut where they do not match: a few texels inside are as sharp as the whole seam. */
static void a_cut_through_marble_is_a_seam(void **state)
{
    (void)state;
    for (int k = 0; k < 12; k++) {
        Sheet s = { .channels = 1, .bits = k % 2 ? 8 : 16 };
        const double size = k < 6 ? 1 : 0.77, sharp = 0.2 + 0.15 * (k / 2 % 3);
        for (int t = 0; t < W * H; t++) {
            const double u = centre_u(t) * size, v = centre_v(t);
            const double turns =
                u + 2 * v + 0.3 * sin(2 * WR_PI * (2 * u + v)) + 0.2 * cos(2 * WR_PI * (u - 3 * v));
            s.numbers[t] = 0.9 - 0.8 * pow(fabs(sin(WR_PI * turns)), sharp);
        }
        const unsigned want = k < 6 ? 0 : BIT(WR_CHECK_SEAM_U);
        assert_int_equal(check_sheet(&s, NULL).problems, want);
    }
}

static void labels_that_lie_are_told(void **state)
{
    (void)state;
    Sheet up = normals(16, false, 1, false), plain = heights(16, 2);
    WrCheck check = check_sheet(&up, "normal+y");
    assert_string_equal(check.label, "normal+y");
    assert_int_equal(check.problems, 0);
    assert_int_equal(check_sheet(&up, "normal-y").problems, BIT(WR_CHECK_LABEL));
    check = check_sheet(&plain, "no\x1bsuch");
    assert_null(check.label);
    assert_int_equal(check.problems, BIT(WR_CHECK_LABEL));
    check = check_sheet(&plain, "curvature");
    assert_string_equal(check.label, "curvature");
    assert_int_equal(check.problems, 0);
}

static void slopes_and_colours_are_told_apart(void **state)
{
    (void)state;
    Sheet s = { .channels = 2, .bits = 32 }, colours = { .channels = 3, .bits = 8 };
    for (int t = 0; t < W * H; t++) {
        double p, q;
        height(centre_u(t), centre_v(t), 2, &p, &q);
        s.numbers[2 * t] = 3.7 * p, s.numbers[2 * t + 1] = -3.7 * q;
        for (int c = 0; c < 3; c++)
            colours.numbers[3 * t + c] = 0.5 + (c + 1) * 0.1 * sin(2 * WR_PI * centre_u(t) + c);
    }
    WrCheck check = check_sheet(&s, NULL);
    assert_true(check.kind == WR_CHECK_SLOPES && check.problems == 0 && !check.normals.lengths);
    assert_true(check.normals.green_known && check.normals.green_down);
    assert_true(check.normals.curl_known && check.normals.curl < 0.1);
    assert_int_equal(check_sheet(&colours, NULL).kind, WR_CHECK_COLOUR);
    assert_int_equal(check_as("s.png", WR_CHECK_NORMAL).kind, WR_CHECK_NORMAL);
}

/* ---- no heights ---- */

static void hostile_files_are_errors(void **state)
{
    (void)state;
    Sheet s = heights(16, 2);
    WrCheck check;
    WrError err = { "" };
    char *bytes;
    size_t length;
    write_sheet("s.png", &s, NULL);
    assert_true(wr_file_read("s.png", 1 << 20, &bytes, &length, &err));
    assert_true(wr_file_write("cut.png", bytes, length / 2, &err));
    for (int i = 16; i < 24; i++) bytes[i] = 0x7f; /* its size */
    assert_true(wr_file_write("huge.png", bytes, length, &err));
    wr_free(bytes);
    const char *const names[] = { "cut.png", "huge.png", "none.png", "/dev/zero", "." };
    for (int i = 0; i < 5; i++) {
        err.text[0] = '\0';
        assert_false(wr_check_picture(names[i], -1, WR_CODING_AUTO, &check, &err));
        assert_non_null(strstr(err.text, names[i]));
    }
    assert_false(wr_check_picture("s.png", WR_CHECK_SLOPES, WR_CODING_AUTO, &check, &err));
    assert_false(wr_check_picture("s.png", WR_CHECK_NORMAL, WR_CODING_AUTO, &check, &err));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(edges_that_meet_are_seamless_and_others_are_told),
        cmocka_unit_test(short_breaks_and_creases_are_seams),
        cmocka_unit_test(a_repeated_line_is_told),
        cmocka_unit_test(steps_of_fewer_bits_are_told),
        cmocka_unit_test(numbers_are_counted),
        cmocka_unit_test(what_is_not_finite_is_told),
        cmocka_unit_test(greens_lengths_and_curls_are_found),
        cmocka_unit_test(a_steep_disc_in_flat_ground_is_good),
        cmocka_unit_test(a_cut_through_marble_is_a_seam),
        cmocka_unit_test(labels_that_lie_are_told),
        cmocka_unit_test(slopes_and_colours_are_told_apart),
        cmocka_unit_test(hostile_files_are_errors),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
