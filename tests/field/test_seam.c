/* The seam test of a table, against patterns with known edges. */
#include "test.h"
#include "field/scheme_list.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "field/field.h"
#include "field/seam_check.h"

#define TURN 6.283185307179586

typedef double Height(double u, double v);

/* Samples at texel centres, from `from` on: a cell of `size` units of a function with period 1. */
static WrField *table_of(int w, int h, Height *f, double from, double size)
{
    WrField *field = wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++)
            wr_field_set(field, i, j,
                         (float)f(from + size * (i + 0.5) / w, from + size * (j + 0.5) / h));
    return field;
}

/* Waves with a phase modulated by other waves: veins that are sharp where `veins` is the root of a sine. */
static double warped(double u, double v)
{
    return 3 * u + v + 0.31 * sin(TURN * (2 * u + v)) + 0.23 * cos(TURN * (u - 3 * v)) +
           0.11 * sin(TURN * (5 * u + 4 * v));
}

static double smooth(double u, double v)
{
    return sin(TURN * warped(u, v));
}

static double veins(double u, double v)
{
    return 1 - pow(fabs(sin(TURN / 2 * warped(u, v))), 0.3);
}

static double steep(double u, double v)
{
    return 40 * sin(TURN * u) + 0.2 * cos(TURN * v);
}

static void cells_that_close_have_no_seam_and_cuts_of_them_have(void **state)
{
    static Height *const all[] = { smooth, veins, steep };
    static const double shift[] = { 0, 0.137, 0.411, 0.77 };
    (void)state;
    for (int k = 0; k < 12; k++) {
        WrField *whole = table_of(144, 96, all[k % 3], shift[k / 3], 1);
        WrField *cut = table_of(144, 96, all[k % 3], shift[k / 3], 0.71);
        const WrSeam good = wr_seam_measure(whole, NULL), bad = wr_seam_measure(cut, NULL);
        if (good.u.order != 2 || good.v.order != 2)
            fail_msg("pattern %d: orders %d and %d, not 2", k, good.u.order, good.v.order);
        if (bad.u.order != -1) fail_msg("cut %d: order %d in u, not -1", k, bad.u.order);
        assert_false(wr_seam_shows(&good.u) || wr_seam_shows(&good.v));
        assert_true(wr_seam_shows(&bad.u));
        wr_field_free(whole);
        wr_field_free(cut);
    }
}

/* HC57: a last column that repeats the first one, and one that is missing. */
static void hc57_a_repeated_or_a_missing_column_is_no_step_of_smooth_ground(void **state)
{
    (void)state;
    WrField *cut = table_of(128, 64, steep, 0, 127.0 / 128);
    const WrSeamEdge u = wr_seam_measure(cut, NULL).u;
    /* one texel of slope 40 TURN/128 is missing: that step is as large as two texels of slope, no other is */
    assert_near(u.across[WR_SEAM_STEP] / u.inside[WR_SEAM_STEP], 2, 0.05);
    assert_int_equal(u.order, -1);
    wr_field_free(cut);
}

static double peak(double u, double v)
{
    (void)v;
    return 4 * u * (1 - u);
}

static void a_crease_is_an_order_of_0(void **state)
{
    (void)state;
    WrField *field = table_of(128, 64, peak, 0, 1);
    const WrSeam seam = wr_seam_measure(field, NULL);
    /* between the last centre and the first the slope changes from -4 to 4, minus the change over half a texel */
    assert_int_equal(seam.u.order, 0);
    assert_near(seam.u.across[WR_SEAM_SLOPE], (8 - 2 * 8.0 / 128) / 128, 1e-6);
    assert_near(seam.u.inside[WR_SEAM_SLOPE], 2 * 8.0 / (128 * 128), 1e-6);
    assert_int_equal(seam.v.order, 2);
    wr_field_free(field);
}

/* ---- tilings ---- */

static WrField *laid(const WrField *cell, bool half_drop)
{
    const int w = wr_field_width(cell), h = wr_field_height(cell);
    WrField *sheet = wr_field_new(half_drop ? 2 * w : w, half_drop ? h : 2 * h, WR_WRAP_PERIODIC,
                                  WR_WRAP_PERIODIC, 0, NULL);
    for (int j = 0; j < wr_field_height(sheet); j++)
        for (int i = 0; i < wr_field_width(sheet); i++) {
            const int x = half_drop ? i % w : (i + j / h * (w / 2)) % w;
            const int y = half_drop ? (j + i / w * (h / 2)) % h : j % h;
            wr_field_set(sheet, i, j, wr_field_get(cell, x, y));
        }
    return sheet;
}

/* A half-drop pattern: f(u + 1/2, v + 1/2) = f(u, v). */
static double drops(double u, double v)
{
    return sin(TURN * (u + v)) * cos(TURN * (u - v)) + 0.2 * sin(2 * TURN * v);
}

static double drop_only(double u, double v)
{
    /* f(u + 1, v) = f(u, v + 1/2): integer periods of (u/2 + v), so plain copies do not match */
    return sin(TURN * (u / 2 + v)) + 0.3 * cos(TURN * (u + 4 * v));
}

static void a_lay_is_judged_as_it_is_laid(void **state)
{
    (void)state;
    static const struct {
        Height *f;
        bool plain, dropped;
    } cases[] = { { drops, true, true }, { drop_only, false, true }, { smooth, true, false } };
    for (int k = 0; k < 3; k++) {
        WrField *cell = table_of(96, 80, cases[k].f, 0, 1);
        const WrSeamOptions shifted = { .shift = { 40, 0 } }, two = { .copies = { 2, 1 } };
        WrField *sheet = laid(cell, true);
        const WrSeam plain = wr_seam_measure(cell, NULL), moved = wr_seam_measure(cell, &shifted);
        const WrSeam whole = wr_seam_measure(sheet, &two);
        if (wr_seam_shows(&plain.u) == cases[k].plain) fail_msg("case %d, plain", k);
        if (wr_seam_shows(&moved.u) == cases[k].dropped) fail_msg("case %d, shifted", k);
        /* an arranged sheet has the same texels as a cell with a shifted neighbour */
        assert_int_equal(whole.u.order, moved.u.order);
        for (int d = 0; d < WR_SEAM_DIFFERENCES; d++)
            assert_near(whole.u.ratio[d], moved.u.ratio[d], 1e-9 * (1 + moved.u.ratio[d]));
        assert_false(wr_seam_shows(&whole.v));
        wr_field_free(sheet);
        sheet = laid(cell, false);
        const WrSeamOptions rows = { .copies = { 1, 2 } }, aside = { .shift = { 0, 48 } };
        assert_int_equal(wr_seam_measure(sheet, &rows).v.order,
                         wr_seam_measure(cell, &aside).v.order);
        wr_field_free(sheet);
        wr_field_free(cell);
    }
}

/* ---- codes and limits ---- */

static void rounding_to_codes_is_no_seam(void **state)
{
    (void)state;
    for (int bits = 4; bits <= 16; bits += 4) {
        const double last = (1 << bits) - 1;
        WrField *field = table_of(128, 128, smooth, 0, 1);
        for (int j = 0; j < 128; j++)
            for (int i = 0; i < 128; i++) {
                /* a surface that rises by less than two codes */
                const double f = 0.5 + 0.8 * (double)wr_field_get(field, i, j) / last;
                wr_field_set(field, i, j, (float)(floor(f * last + 0.5) / last));
            }
        const WrSeamOptions codes = { .noise = 1 / last };
        const WrSeam seam = wr_seam_measure(field, &codes);
        assert_true(seam.u.order == 2 && seam.v.order == 2);
        wr_field_free(field);
    }
    WrField *high = table_of(64, 64, smooth, 0, 1);
    for (int j = 0; j < 64; j++)
        for (int i = 0; i < 64; i++) wr_field_set(high, i, j, 1e6f + (i == 63 ? 0.0625f : 0));
    assert_false(wr_seam_shows(&(WrSeamEdge){ .order = wr_seam_measure(high, NULL).u.order }));
    wr_field_free(high);
}

static void small_tables_are_not_measured(void **state)
{
    (void)state;
    for (int w = 1; w <= 12; w++) {
        WrField *field = table_of(w, 13 - w, smooth, 0, 0.7);
        const WrSeam seam = wr_seam_measure(field, NULL);
        assert_int_equal(seam.u.measured, w >= WR_SEAM_MIN);
        assert_int_equal(seam.v.measured, 13 - w >= WR_SEAM_MIN);
        assert_true(seam.u.measured || seam.u.order == 2);
        wr_field_free(field);
    }
    const WrSeamOptions many = { .copies = { 100, 100 } };
    WrField *field = table_of(64, 64, smooth, 0, 1);
    assert_false(wr_seam_measure(field, &many).u.measured);
    wr_field_free(field);
}

/* Noise on a ring: random periodic waves. There are few inner lines, so the one at the edge may be the worst by
   chance. */
static void small_seamless_tables_have_no_seam(void **state)
{
    (void)state;
    TestRandom random = { 5 };
    int flagged = 0, cut_seen = 0;
    for (int k = 0; k < 400; k++) {
        const int size = 8 + k % 5 * 4;
        double phase[9], high[9];
        for (int i = 0; i < 9; i++)
            phase[i] = TURN * test_random(&random), high[i] = test_random(&random) - 0.5;
        WrField *field = wr_field_new(size, size, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
        for (int cut = 0; cut < 2; cut++) {
            for (int j = 0; j < size; j++)
                for (int i = 0; i < size; i++) {
                    const double u = (cut ? 0.6 : 1) * (i + 0.5) / size, v = (j + 0.5) / size;
                    double f = 0;
                    for (int n = 0; n < 9; n++)
                        f += high[n] * sin(TURN * ((n % 3 + 1) * u + (n / 3) * v) + phase[n]);
                    wr_field_set(field, i, j, (float)f);
                }
            const WrSeam seam = wr_seam_measure(field, NULL);
            if (cut) cut_seen += wr_seam_shows(&seam.u);
            else flagged += wr_seam_shows(&seam.u) || wr_seam_shows(&seam.v);
        }
        wr_field_free(field);
    }
    if (flagged > 4) fail_msg("%d of 400 seamless tables have a seam", flagged);
    if (cut_seen < 300) fail_msg("%d of 400 cuts have a seam", cut_seen);
}

/* ---- the certificate ---- */

static void a_certificate_is_no_better_than_its_pattern(void **state)
{
    (void)state;
    WrText text = { 0 };
    WrField *cut = table_of(128, 96, smooth, 0, 0.71), *whole = table_of(128, 96, smooth, 0, 1);
    const WrCertificate torn = wr_certificate_table(cut, WR_SCHEME_BSPLINE, NULL);
    const WrCertificate good = wr_certificate_table(whole, WR_SCHEME_BSPLINE, NULL);
    assert_int_equal(wr_certificate_continuity(&torn), -1);
    assert_int_equal(wr_certificate_continuity(&good), 2);
    wr_certificate_text(&torn, &text);
    assert_non_null(strstr(wr_text_get(&text), "none, height differs by "));
    wr_text_clear(&text);
    wr_certificate_text(&good, &text);
    assert_string_equal(wr_text_get(&text), "seam C2");
    wr_text_fini(&text);
    wr_field_free(cut);
    wr_field_free(whole);
}

static void the_text_never_divides_by_nothing(void **state)
{
    (void)state;
    WrText text = { 0 };
    const WrSeamEdge level = { .measured = true, .order = 2 };
    wr_seam_text(&level, &text);
    assert_string_equal(wr_text_get(&text), "level ground");
    wr_text_fini(&text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cells_that_close_have_no_seam_and_cuts_of_them_have),
        cmocka_unit_test(hc57_a_repeated_or_a_missing_column_is_no_step_of_smooth_ground),
        cmocka_unit_test(a_crease_is_an_order_of_0),
        cmocka_unit_test(a_lay_is_judged_as_it_is_laid),
        cmocka_unit_test(rounding_to_codes_is_no_seam),
        cmocka_unit_test(small_tables_are_not_measured),
        cmocka_unit_test(small_seamless_tables_have_no_seam),
        cmocka_unit_test(a_certificate_is_no_better_than_its_pattern),
        cmocka_unit_test(the_text_never_divides_by_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
