/* Common properties of all generators, row by row of every family. */
#include "test.h"
#include "generate_help.h"

#include "base/pool.h"
#include "base/progress.h"

static void for_each_row(void (*each)(const WrGenerator *g))
{
    for (const WrFamily *f = wr_families; f->name; f++)
        for (const WrGenerator *g = f->rows; g->family; g++)
            if (stands_alone(g)) each(g);
}

static void check_row(const WrGenerator *g)
{
    int count = wr_generator_param_count(g);
    assert_true(g->label && g->help && g->blend && g->make);
    assert_ptr_equal(wr_generator_find(g->family, g->name), g);
    assert_true(count <= WR_GENERATOR_PARAMS);
    for (int i = 0; i < count; i++) {
        const WrParam *p = &g->params[i];
        assert_true(p->label && p->help);
        assert_int_equal(wr_generator_param_find(g, p->name), i);
        if (p->kind != WR_PARAM_NUMBER && p->kind != WR_PARAM_WHOLE) continue;
        if (!(p->low <= p->fallback[0] && p->fallback[0] <= p->high))
            fail_msg("%s %s: %s: its default is out of range", g->family, g->name, p->name);
        if (!(p->low <= p->soft_low && p->soft_low < p->soft_high && p->soft_high <= p->high))
            fail_msg("%s %s: %s: its slider leaves the range", g->family, g->name, p->name);
    }
}

static void every_row_is_complete(void **state)
{
    (void)state;
    for_each_row(check_row);
    assert_null(wr_generator_find("pattern", "cobwebs"));
    assert_null(wr_generator_find("pattern", NULL));
    assert_null(wr_family_find("patterns"));
}

/* NaN is detected too. */
static void check_threads(const WrGenerator *g)
{
    WrField *like = table_of(200, 150), *first = NULL;
    WrParamValue values[WR_GENERATOR_PARAMS];
    usual_values(g, values);
    for (int threads = 1; threads <= 3; threads += test_amount(1, 2)) {
        WrPool *pool = wr_pool_new(threads);
        WrField *field = made(g, values, like, pool, false);
        if (first && !wr_hash_equal(wr_field_hash(first), wr_field_hash(field)))
            fail_msg("%s %s: %d threads give other bits", g->family, g->name, threads);
        if (first) wr_field_free(field);
        else first = field;
        wr_pool_free(pool);
    }
    for (int j = 0; j < 150; j++)
        for (int i = 0; i < 200; i++) assert_true(isfinite(wr_field_get(first, i, j)));
    wr_field_free(first);
    wr_field_free(like);
}

static void heights_are_finite_and_the_same_for_any_number_of_threads(void **state)
{
    (void)state;
    for_each_row(check_threads);
}

/* 128 x 64 texels: positions are exact. The shift crosses tiles and both edges. */
static void check_roll(const WrGenerator *g)
{
    if (wr_generator_param_find(g, "origin") < 0) return;
    WrField *like = table_of(128, 64);
    WrParamValue values[WR_GENERATOR_PARAMS];
    usual_values(g, values);
    WrField *still = made(g, values, like, NULL, false);
    WrParamValue *origin = value_of(g, values, "origin");
    origin->number[0] = 45.0 / 128.0;
    origin->number[1] = -19.0 / 64.0;
    WrField *moved = made(g, values, like, NULL, false);
    if (!is_rolled(still, moved, 45, -19))
        fail_msg("%s %s: a moved origin does not roll it", g->family, g->name);
    float low, high; /* lines may fill so small a table */
    wr_field_range(still, &low, &high);
    assert_false(low < high && is_rolled(still, moved, 44, -19) &&
                 is_rolled(still, moved, 45, -18));
    origin->number[0] += 3.0; /* whole tables */
    origin->number[1] -= 2.0;
    WrField *again = made(g, values, like, NULL, false);
    assert_true(is_rolled(moved, again, 0, 0));
    wr_field_free(still);
    wr_field_free(moved);
    wr_field_free(again);
    wr_field_free(like);
}

static void an_origin_moved_by_whole_texels_rolls_the_relief_bit_for_bit(void **state)
{
    (void)state;
    for_each_row(check_roll);
}

/* A shift by half a texel, where nothing is exact, must not cause a jump. Lines thinner than a texel of a small table
 * change considerably, but their mean does not. */
static void check_part_of_a_texel(const WrGenerator *g)
{
    if (wr_generator_param_find(g, "origin") < 0) return;
    WrField *like = table_of(150, 110);
    WrParamValue values[WR_GENERATOR_PARAMS];
    usual_values(g, values);
    WrField *still = made(g, values, like, NULL, false);
    value_of(g, values, "origin")->number[0] = 0.3 / 150.0;
    WrField *moved = made(g, values, like, NULL, false);
    double a = 0.0, b = 0.0;
    for (int j = 0; j < 110; j++)
        for (int i = 0; i < 150; i++) {
            a += (double)wr_field_get(still, i, j) / (150.0 * 110.0);
            b += (double)wr_field_get(moved, i, j) / (150.0 * 110.0);
        }
    if (fabs(a - b) > 0.005) fail_msg("%s %s: mean %g, moved %g", g->family, g->name, a, b);
    wr_field_free(still);
    wr_field_free(moved);
    wr_field_free(like);
}

static void an_origin_moved_by_part_of_a_texel_keeps_the_mean(void **state)
{
    (void)state;
    for_each_row(check_part_of_a_texel);
}

/* A coarse preview has the same size and edges and about the same height. */
static void check_coarse(const WrGenerator *g)
{
    WrField *like = wr_field_new(160, 96, WR_WRAP_CLAMP, WR_WRAP_PERIODIC, 0.5f, NULL);
    WrParamValue values[WR_GENERATOR_PARAMS];
    usual_values(g, values);
    WrField *fine = made(g, values, like, NULL, false), *coarse = made(g, values, like, NULL, true);
    const WrField *both[] = { fine, coarse };
    double mean[2] = { 0.0, 0.0 };
    for (int k = 0; k < 2; k++) {
        assert_int_equal(wr_field_width(both[k]), 160);
        assert_int_equal(wr_field_height(both[k]), 96);
        assert_int_equal(wr_field_wrap_u(both[k]), WR_WRAP_CLAMP);
        assert_int_equal(wr_field_wrap_v(both[k]), WR_WRAP_PERIODIC);
        for (int j = 0; j < 96; j++)
            for (int i = 0; i < 160; i++)
                mean[k] += (double)wr_field_get(both[k], i, j) / (160.0 * 96.0);
    }
    float low, high;
    wr_field_range(fine, &low, &high);
    if (fabs(mean[0] - mean[1]) > 0.05 * ((double)high - (double)low))
        fail_msg("%s %s: coarse %g, fine %g", g->family, g->name, mean[1], mean[0]);
    wr_field_free(fine);
    wr_field_free(coarse);
    wr_field_free(like);
}

static void a_coarse_preview_has_the_size_the_edges_and_about_the_heights(void **state)
{
    (void)state;
    for_each_row(check_coarse);
}

/* Each parameter beyond each end of its range, and NaN: one error that names it. */
static void check_bad_values(const WrGenerator *g)
{
    WrField *like = table_of(16, 16);
    for (int i = 0; g->params[i].name; i++) {
        const WrParam *p = &g->params[i];
        if (p->kind == WR_PARAM_TEXT || p->kind == WR_PARAM_FILE || p->kind == WR_PARAM_POINTS ||
            p->kind == WR_PARAM_TERMS)
            continue;
        double high = p->kind == WR_PARAM_CHOICE ? 99.0 : p->high;
        const double bad[] = { p->low - fabs(p->low) - 1.0, high + fabs(high) + 1.0, NAN, INFINITY,
                               p->kind == WR_PARAM_WHOLE ? p->low + 0.5 : NAN };
        for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
            WrParamValue values[WR_GENERATOR_PARAMS];
            WrError err = { "" };
            WrRelief relief = { NULL, NULL };
            WrGenerateJob job = { .like = like };
            usual_values(g, values);
            values[i].number[0] = bad[k];
            if (wr_generator_make(g, values, &job, &relief, &err))
                fail_msg("%s %s: %s=%g is taken", g->family, g->name, p->name, bad[k]);
            if (!strstr(err.text, p->name) || !strstr(err.text, "must be"))
                fail_msg("%s %s: %s=%g gives: %s", g->family, g->name, p->name, bad[k], err.text);
            assert_null(relief.heights);
        }
    }
    wr_field_free(like);
}

static void bad_values_give_one_error_that_names_the_parameter(void **state)
{
    (void)state;
    for_each_row(check_bad_values);
}

/* Every parameter at each end of its range separately, on the smallest and on odd tables (in an ordinary run each
 * end on one of those, alternating): it works with finite heights, or reports an error. */
static void check_ends(const WrGenerator *g)
{
    const bool full = getenv("WR_FULL");
    const int thin =
        strcmp(g->family, "solid") == 0 ? 27 : 9; /* copies of solids on a texel are many */
    static const int sizes[][2] = { { 1, 1 }, { 7, 3 }, { 1, 65 } };
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        WrField *like = table_of(sizes[s][0], sizes[s][1]);
        for (int i = 0; g->params[i].name; i++)
            for (int end = 0; end < 2; end++) {
                if (!full && (i + end) % test_amount(3, thin) != (int)s) continue;
                const WrParam *p = &g->params[i];
                WrParamValue values[WR_GENERATOR_PARAMS];
                WrError err = { "" };
                WrRelief relief = { NULL, NULL };
                WrGenerateJob job = { .like = like };
                usual_values(g, values);
                if (p->kind == WR_PARAM_NUMBER || p->kind == WR_PARAM_WHOLE ||
                    p->kind == WR_PARAM_TUPLE)
                    values[i].number[0] = end ? p->high : p->above ? p->low + 1e-9 : p->low;
                if (!wr_generator_make(g, values, &job, &relief, &err)) {
                    assert_true(strlen(err.text) > 10);
                    continue;
                }
                for (int y = 0; y < sizes[s][1]; y++)
                    for (int x = 0; x < sizes[s][0]; x++)
                        assert_true(isfinite(wr_field_get(relief.heights, x, y)));
                wr_relief_fini(&relief);
            }
        wr_field_free(like);
    }
}

static void extreme_values_and_tiny_tables_are_harmless(void **state)
{
    (void)state;
    for_each_row(check_ends);
}

/* ---- stopping ---- */

typedef struct Stopping {
    volatile int cancel;
    int reports;
    double last;
} Stopping;

static void stop_at_once(void *ctx, double fraction)
{
    Stopping *stopping = ctx;
    assert_true(fraction >= stopping->last && fraction <= 1.0);
    stopping->last = fraction;
    if (++stopping->reports == 2) __atomic_store_n(&stopping->cancel, 1, __ATOMIC_RELAXED);
}

static void a_cancelled_generator_stops_with_an_error_and_makes_nothing(void **state)
{
    (void)state;
    Stopping stopping = { 0 };
    WrProgress progress = { .cancel = &stopping.cancel, .report = stop_at_once, .ctx = &stopping };
    WrField *like = table_of(1024, 1024);
    WrGenerateJob job = { .like = like, .progress = &progress };
    const WrGenerator *g = wr_generator_find("pattern", "checks");
    WrParamValue values[WR_GENERATOR_PARAMS];
    WrRelief relief = { NULL, NULL };
    WrError err = { "" };
    wr_generator_defaults(g, values);
    assert_false(wr_generator_make(g, values, &job, &relief, &err));
    assert_string_equal(err.text, "cancelled");
    assert_null(relief.heights);
    assert_int_equal(stopping.reports, 2);
    wr_field_free(like);
}

/* ---- formulas ---- */

static void a_fourier_formula_is_the_series_at_the_texels_centres(void **state)
{
    (void)state;
    const double terms[] = { 3, 2, 0.5, 90, 0, 0, 0, 0.25, 0, 0 };
    const WrGenerator *g = wr_generator_find("formula", "fourier");
    WrParamValue value = { .points = terms, .count = 2 };
    WrField *like = table_of(40, 24), *field = made(g, &value, like, NULL, false);
    for (int j = 0; j < 24; j++)
        for (int i = 0; i < 40; i++) {
            double u = (i + 0.5) / 40.0, v = 1.0 - (j + 0.5) / 24.0, tau = 8.0 * atan(1.0);
            double want = 0.25 - 0.5 * sin(tau * 3.0 * u) * cos(tau * 2.0 * v);
            assert_near((double)wr_field_get(field, i, j), want, 1e-7);
        }
    wr_field_free(field);
    wr_field_free(like);
}

static void a_formula_without_terms_or_with_odd_ones_is_refused(void **state)
{
    (void)state;
    const double half[] = { 0.5, 0, 1 }, high[] = { 0, 65, 1 };
    const WrGenerator *g = wr_generator_find("formula", "poly");
    WrField *like = table_of(4, 4);
    WrGenerateJob job = { .like = like };
    WrRelief relief;
    WrError err;
    WrParamValue none = { .count = 0 }, broken = { .points = half, .count = 1 };
    WrParamValue far = { .points = high, .count = 1 };
    assert_false(wr_generator_make(g, &none, &job, &relief, &err));
    assert_non_null(strstr(err.text, "formula poly: c is missing"));
    assert_false(wr_generator_make(g, &broken, &job, &relief, &err));
    assert_non_null(strstr(err.text, "c: i=0.5: must be a whole number, 0..64"));
    assert_false(wr_generator_make(g, &far, &job, &relief, &err));
    assert_non_null(strstr(err.text, "j=65"));
    wr_field_free(like);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_row_is_complete),
        cmocka_unit_test(heights_are_finite_and_the_same_for_any_number_of_threads),
        cmocka_unit_test(an_origin_moved_by_whole_texels_rolls_the_relief_bit_for_bit),
        cmocka_unit_test(an_origin_moved_by_part_of_a_texel_keeps_the_mean),
        cmocka_unit_test(a_coarse_preview_has_the_size_the_edges_and_about_the_heights),
        cmocka_unit_test(bad_values_give_one_error_that_names_the_parameter),
        cmocka_unit_test(extreme_values_and_tiny_tables_are_harmless),
        cmocka_unit_test(a_cancelled_generator_stops_with_an_error_and_makes_nothing),
        cmocka_unit_test(a_fourier_formula_is_the_series_at_the_texels_centres),
        cmocka_unit_test(a_formula_without_terms_or_with_odd_ones_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
