/* The table operations: their table, and common properties. */
#include "test.h"
#include "ops_tables.h"

#include "base/error.h"
#include "base/hash.h"
#include "base/progress.h"
#include "field/field.h"

#include <float.h>

static void every_row_of_the_table_is_whole(void **state)
{
    (void)state;
    assert_true(wr_op_count >= 18);
    for (int k = 0; k < wr_op_count; k++) {
        const WrOpInfo *op = &wr_ops[k];
        assert_true(op->label && op->help && op->run);
        assert_ptr_equal(wr_op_find(op->name), op);
        int count = wr_op_param_count(op);
        assert_true(count <= WR_OP_PARAMS);
        for (int p = 0; p < count; p++) {
            const WrOpParam *param = &op->params[p];
            assert_true(param->label && param->help && param->unit);
            assert_true(param->low <= param->soft_low && param->soft_low < param->soft_high &&
                        param->soft_high <= param->high);
            assert_true(param->fallback >= param->soft_low && param->fallback <= param->soft_high);
            if (!param->choices) continue;
            assert_true(param->low == 0.0 && param->whole);
            int words = 0;
            while (param->choices[words]) words++;
            assert_true(param->high == words - 1.0);
        }
    }
    assert_null(wr_ops[wr_op_count].name);
    assert_null(wr_op_find("blu"));
}

static void parameters_out_of_range_are_refused_with_name_and_value(void **state)
{
    (void)state;
    WrField *in = flat_table(8, 8, P, P, 0.0f);
    for (int k = 0; k < wr_op_count; k++)
        for (int p = 0; p < wr_op_param_count(&wr_ops[k]); p++) {
            const WrOpParam *bad = &wr_ops[k].params[p];
            const double values[] = { bad->low - 1.0 - fabs(bad->low) * 1e-3,
                                      bad->high + 1.0 + fabs(bad->high) * 1e-3,
                                      NAN,
                                      INFINITY,
                                      -INFINITY,
                                      bad->whole && !bad->share ? 0.5 : NAN };
            for (size_t v = 0; v < sizeof values / sizeof *values; v++) {
                double param[WR_OP_VALUES];
                for (int q = 0; q < WR_OP_PARAMS; q++) param[q] = wr_ops[k].params[q].fallback;
                param[p] = values[v];
                WrError err = { "" };
                assert_null(wr_op_run(&wr_ops[k], in, param, NULL, &err));
                assert_non_null(strstr(err.text, wr_ops[k].name));
                assert_non_null(strstr(err.text, bad->name));
            }
        }
    wr_field_free(in);
}

static void assert_refused(const char *name, const WrField *in, const double *param,
                           const WrOpOptions *options, const char *part)
{
    WrError err = { "" };
    assert_null(wr_op_run(wr_op_find(name), in, param, options, &err));
    if (!strstr(err.text, part)) fail_msg("%s: \"%s\" is not in \"%s\"", name, part, err.text);
}

static void parameters_that_do_not_fit_together_are_refused(void **state)
{
    (void)state;
    WrField *in = flat_table(20, 10, C, P, 0.0f), *mask = flat_table(20, 11, P, P, 1.0f);
    assert_refused("levels", in, (double[]){ 1, 1, 1, 0, 1 }, NULL, "both 1");
    assert_refused("levels", in, (double[]){ 0, 1e-310, 1, 0, 1 }, NULL, "more");
    assert_refused("clamp", in, (double[]){ 2, 1 }, NULL, "above high 1");
    assert_refused("crop", in, (double[]){ 0, 0, 21, 4 }, NULL, "21");
    assert_refused("crop", in, (double[]){ 15, 0, 6, 4 }, NULL, "not periodic");
    assert_refused("crop", in, (double[]){ 0, 10, 6, 4 }, NULL, "last is 9");
    assert_refused("blur", in, NULL, &(WrOpOptions){ .mask = mask }, "20x11");
    WrField *square = flat_table(20, 10, P, P, 1.0f);
    assert_refused("resize", in, NULL, &(WrOpOptions){ .mask = square }, "selection");
    wr_field_free(in);
    wr_field_free(mask);
    wr_field_free(square);
}

static void heights_come_out_the_same_for_any_number_of_threads(void **state)
{
    (void)state;
    WrField *in = noisy_table(300, 270, P, C, 1);
    WrPool *pools[3] = { wr_pool_new(1), wr_pool_new(2), wr_pool_new(7) };
    const OpCall extra[] = { { "resize", { 77, 410, 3 } },
                             { "rotate", { 0 } },
                             { "crop", { 3, 5, 90, 260 } } };
    for (int k = 0; k < SAME_SIZE_CALLS + 3; k++) {
        const OpCall *call =
            k < SAME_SIZE_CALLS ? &same_size_calls[k] : &extra[k - SAME_SIZE_CALLS];
        WrField *alone = run_with(call->name, in, call->param, NULL);
        for (int p = 0; p < 3; p++) {
            WrField *out =
                run_with(call->name, in, call->param, &(WrOpOptions){ .pool = pools[p] });
            if (!same_table(out, alone)) fail_msg("%s differs", call->name);
            wr_field_free(out);
        }
        wr_field_free(alone);
    }
    for (int p = 0; p < 3; p++) wr_pool_free(pools[p]);
    wr_field_free(in);
}

/* The rolled table is built anew, with another level: the storage of heights must not matter either. */
static void a_rolled_table_gives_the_rolled_result(void **state)
{
    (void)state;
    const int sizes[][2] = { { 150, 130 }, { 5, 3 }, { 1, 40 }, { 300, 1 } };
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        WrField *in = noisy_table(sizes[s][0], sizes[s][1], P, P, s);
        WrField *moved_in = rolled(in, 51, -29);
        for (int k = 0; k < SAME_SIZE_CALLS; k++) {
            const OpCall *call = &same_size_calls[k];
            const char *const by_place[] = { "flip-u", "flip-v",   "rotate",     "noise",
                                             "warp",   "seamless", "match-edges" };
            bool skip = false;
            for (size_t n = 0; n < sizeof by_place / sizeof *by_place; n++)
                skip |= strcmp(call->name, by_place[n]) == 0;
            if (skip) continue;
            WrField *out = run_with(call->name, in, call->param, NULL);
            WrField *moved_out = rolled(out, 51, -29);
            WrField *out_of_moved = run_with(call->name, moved_in, call->param, NULL);
            if (!same_table(moved_out, out_of_moved))
                fail_msg("%s %g of a table %dx%d", call->name, call->param[0], sizes[s][0],
                         sizes[s][1]);
            wr_field_free(out);
            wr_field_free(moved_out);
            wr_field_free(out_of_moved);
        }
        wr_field_free(in);
        wr_field_free(moved_in);
    }
}

static void assert_same_tiles(const WrField *a, const WrField *b, const char *name)
{
    for (int ty = 0; ty < wr_field_tiles_v(a); ty++)
        for (int tx = 0; tx < wr_field_tiles_u(a); tx++)
            if (wr_field_tile(a, tx, ty) != wr_field_tile(b, tx, ty))
                fail_msg("%s: tile %d, %d is another", name, tx, ty);
    assert_true(same_bits(wr_field_level(a), wr_field_level(b)));
}

/* Heights without exact binary fractions, -0, and the largest for which filters are exact. */
static void filters_leave_flat_tables_tile_by_tile_as_they_are(void **state)
{
    (void)state;
    const float levels[] = { 0.1f, -0.0f, 1e-30f, -1234.567f, 1e36f };
    for (size_t s = 0; s < sizeof levels / sizeof *levels; s++) {
        WrField *in = flat_table(200, 150, P, s % 2 ? C : P, levels[s]);
        for (int t = 0; t < 8; t++) wr_field_tile_write(in, t % 4, t / 4 % 3);
        for (int k = 0; k < FILTER_CALLS; k++) {
            WrField *out = run_with(same_size_calls[k].name, in, same_size_calls[k].param, NULL);
            assert_same_tiles(out, in, same_size_calls[k].name);
            wr_field_free(out);
        }
        for (int k = MOVE_CALLS; k < SAME_SIZE_CALLS; k++) { /* moves */
            WrField *out = run_with(same_size_calls[k].name, in, same_size_calls[k].param, NULL);
            assert_same_tiles(out, in, same_size_calls[k].name);
            wr_field_free(out);
        }
        wr_field_free(in);
    }
}

static void operations_that_change_nothing_share_every_tile(void **state)
{
    (void)state;
    const OpCall calls[] = { { "levels", { 0, 1, 1, 0, 1 } },
                             { "add", { 0 } },
                             { "multiply", { 1 } },
                             { "clamp", { -1, 1 } },
                             { "blur", { 0 } },
                             { "median", { 0, 0 } },
                             { "dilate", { 0.9 } },
                             { "erode", { 0 } },
                             { "slope-limit", { 2, 2 } },
                             { "offset", { 200, -150 } },
                             { "sharpen", { 0, 5 } },
                             { "crop", { 0, 0, 200, 150 } },
                             { "noise", { 0, 7, 4, 0, 0, 3 } },
                             { "warp", { 0, 4, 2, 0, 3 } },
                             { "resize", { 200, 150, 0 } },
                             { "resize", { 200, 150, 1 } },
                             { "resize", { 200, 150, 2 } },
                             { "resize", { 200, 150, 3 } } };
    WrField *in = noisy_table(200, 150, P, P, 3);
    wr_field_set(in, 7, 7, -0.0f);
    for (size_t k = 0; k < sizeof calls / sizeof *calls; k++) {
        WrField *out = run_with(calls[k].name, in, calls[k].param, NULL);
        assert_same_tiles(out, in, calls[k].name);
        wr_field_free(out);
    }
    wr_field_free(in);
}

static void a_local_filter_changes_only_the_tiles_in_its_reach(void **state)
{
    (void)state;
    WrField *in = flat_table(1000, 1000, P, P, 0.3f);
    wr_field_set(in, 500, 500, 2.0f); /* tile 7, 7, texel 52, 52 */
    wr_field_set(in, 999, 2, 2.0f);   /* tile 15, 0, at both seams */
    wr_field_tile_write(in, 3, 12);
    WrField *out = run("blur", in, 2.0); /* a support of 8 texels */
    for (int ty = 0; ty < 16; ty++)
        for (int tx = 0; tx < 16; tx++) {
            bool near_seam = (tx == 0 || tx == 15) && (ty == 0 || ty == 15);
            bool changes = (tx == 7 && ty == 7) || near_seam;
            bool same = wr_field_tile(in, tx, ty) == wr_field_tile(out, tx, ty);
            if (same == changes) fail_msg("tile %d, %d", tx, ty);
        }
    wr_field_free(in);
    wr_field_free(out);
}

static void a_tone_of_the_largest_table_costs_only_what_is_painted(void **state)
{
    (void)state;
    WrField *in = flat_table(16384, 16384, P, P, 0.25f);
    wr_field_set(in, 16383, 9000, 1.0f);
    WrField *out = run("add", in, 0.5);
    assert_true(wr_field_bytes(out) < 20000);
    assert_true(wr_field_get(out, 0, 0) == 0.75f && wr_field_get(out, 16383, 9000) == 1.5f);
    WrField *blurred = run("blur", out, 3.0);
    assert_true(wr_field_bytes(blurred) < 100000);
    assert_true(wr_field_get(blurred, 0, 9000) > 0.75f && wr_field_get(blurred, 20, 9000) == 0.75f);
    wr_field_free(in);
    wr_field_free(out);
    wr_field_free(blurred);
}

static void a_mask_blends_and_keeps_bits_where_it_is_0(void **state)
{
    (void)state;
    int width = 150, height = 140;
    WrField *in = noisy_table(width, height, P, P, 4),
            *mask = flat_table(width, height, P, P, 0.0f);
    TestRandom random = { 9 };
    wr_field_set(in, 1, 1, -0.0f);
    for (int j = 0; j < 100; j++)
        for (int i = 0; i < width; i++)
            wr_field_set(mask, i, j, fmaxf(0.0f, (float)(1.5 * test_random(&random) - 0.25)));
    wr_field_set(mask, 1, 1, 0.0f);
    for (int k = 0; k < SAME_SIZE_CALLS; k++) {
        const OpCall *call = &same_size_calls[k];
        if (wr_op_find(call->name)->reshapes) continue;
        WrField *whole = run_with(call->name, in, call->param, NULL);
        WrField *part = run_with(call->name, in, call->param, &(WrOpOptions){ .mask = mask });
        for (int j = 0; j < height; j++)
            for (int i = 0; i < width; i++) {
                double m = wr_field_get(mask, i, j), f = wr_field_get(in, i, j);
                double op = wr_field_get(whole, i, j), got = wr_field_get(part, i, j);
                if (m == 0.0) assert_true(same_bits(got, f));
                else if (m >= 1.0) assert_true(got == op);
                else assert_near(got, f + m * (op - f), 1e-7 * (fabs(f) + fabs(op)));
            }
        assert_ptr_equal(wr_field_tile(part, 0, 2), wr_field_tile(in, 0, 2));
        wr_field_free(whole);
        wr_field_free(part);
    }
    wr_field_free(in);
    wr_field_free(mask);
}

static void a_mask_without_tiles_counts_with_its_level(void **state)
{
    (void)state;
    WrField *in = flat_table(100, 90, P, P, 0.25f);
    const float levels[] = { 0.0f, -3.0f, 0.5f, 1.0f, 7.0f },
                expected[] = { 0.25f, 0.25f, 0.75f, 1.25f, 1.25f };
    for (int k = 0; k < 5; k++) {
        WrField *mask = flat_table(100, 90, P, P, levels[k]);
        WrField *out = run_with("add", in, (double[]){ 1.0 }, &(WrOpOptions){ .mask = mask });
        assert_true(wr_field_get(out, 0, 0) == expected[k] &&
                    wr_field_get(out, 99, 89) == expected[k]);
        assert_true(k > 1 || wr_field_bytes(out) == 0);
        wr_field_free(mask);
        wr_field_free(out);
    }
    wr_field_free(in);
}

/* Sets *stop at report number `at`; checks that fractions increase from 0 to 1. */
typedef struct Watch {
    int reports, at, stop;
    double last;
    bool rising;
} Watch;

static void watch(void *ctx, double fraction)
{
    Watch *w = ctx;
    w->rising = w->rising && fraction >= w->last && fraction <= 1.0;
    w->last = fraction;
    if (w->reports++ == w->at) __atomic_store_n(&w->stop, 1, __ATOMIC_RELAXED);
}

static void work_reports_its_progress_and_stops_at_any_report(void **state)
{
    (void)state;
    WrField *in = noisy_table(140, 90, P, P, 5);
    WrHash before = wr_field_hash(in);
    WrPool *pool = wr_pool_new(2);
    const OpCall extra[] = { { "resize", { 77, 310, 3 } }, { "crop", { 3, 5, 90, 60 } } };
    for (int k = 0; k < SAME_SIZE_CALLS + 2; k++) {
        const OpCall *call =
            k < SAME_SIZE_CALLS ? &same_size_calls[k] : &extra[k - SAME_SIZE_CALLS];
        Watch w = { .at = -1, .rising = true };
        WrProgress progress = { &w.stop, watch, &w };
        WrOpOptions options = { .pool = pool, .progress = &progress };
        wr_field_free(run_with(call->name, in, call->param, &options));
        assert_true(w.rising && w.last == 1.0 && w.reports >= 2);
        int reports = w.reports;
        for (int n = 0; n < reports; n++) {
            w = (Watch){ .at = n };
            assert_refused(call->name, in, call->param, &options, "cancelled");
            assert_true(w.reports == n + 1);
        }
    }
    assert_true(wr_hash_equal(wr_field_hash(in), before));
    wr_pool_free(pool);
    wr_field_free(in);
}

static void tables_of_any_size_survive_every_operation(void **state)
{
    (void)state;
    const int sizes[][2] = { { 1, 1 }, { 1, 9 }, { 7, 1 }, { 2, 3 }, { 65, 2 }, { 16384, 1 } };
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++)
        for (int wraps = 0; wraps < 4; wraps++) {
            WrField *in =
                noisy_table(sizes[s][0], sizes[s][1], wraps & 1 ? P : C, wraps & 2 ? P : C, s);
            for (int k = 0; k < wr_op_count; k++) {
                double param[WR_OP_VALUES];
                memcpy(param, wr_filter_of(&wr_ops[k]).param, sizeof param);
                if (strcmp(wr_ops[k].name, "crop") == 0) param[2] = sizes[s][0], param[3] = 1;
                WrField *out = run_with(wr_ops[k].name, in, param, NULL);
                float low, high;
                wr_field_range(out, &low, &high);
                assert_true(low > -10.0f && high < 10.0f && low <= high);
                wr_field_free(out);
            }
            wr_field_free(in);
        }
}

static void heights_at_the_end_of_floats_range_stay_finite(void **state)
{
    (void)state;
    WrField *in = noisy_table(40, 30, P, P, 6);
    for (int k = 0; k < 40 * 30; k += 3)
        wr_field_set(in, k % 40, k / 40, k % 2 ? FLT_MAX : -FLT_MAX);
    for (int k = 0; k < SAME_SIZE_CALLS; k++) {
        WrField *out = run_with(same_size_calls[k].name, in, same_size_calls[k].param, NULL);
        for (int j = 0; j < 30; j++)
            for (int i = 0; i < 40; i++) assert_true(isfinite(wr_field_get(out, i, j)));
        wr_field_free(out);
    }
    WrField *out = run("resize", in, 90, 17, 3);
    for (int j = 0; j < 17; j++)
        for (int i = 0; i < 90; i++) assert_true(isfinite(wr_field_get(out, i, j)));
    wr_field_free(out);
    wr_field_free(in);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_row_of_the_table_is_whole),
        cmocka_unit_test(parameters_out_of_range_are_refused_with_name_and_value),
        cmocka_unit_test(parameters_that_do_not_fit_together_are_refused),
        cmocka_unit_test(heights_come_out_the_same_for_any_number_of_threads),
        cmocka_unit_test(a_rolled_table_gives_the_rolled_result),
        cmocka_unit_test(filters_leave_flat_tables_tile_by_tile_as_they_are),
        cmocka_unit_test(operations_that_change_nothing_share_every_tile),
        cmocka_unit_test(a_local_filter_changes_only_the_tiles_in_its_reach),
        cmocka_unit_test(a_tone_of_the_largest_table_costs_only_what_is_painted),
        cmocka_unit_test(a_mask_blends_and_keeps_bits_where_it_is_0),
        cmocka_unit_test(a_mask_without_tiles_counts_with_its_level),
        cmocka_unit_test(work_reports_its_progress_and_stops_at_any_report),
        cmocka_unit_test(tables_of_any_size_survive_every_operation),
        cmocka_unit_test(heights_at_the_end_of_floats_range_stay_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
