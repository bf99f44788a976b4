/* Ramps against their closed forms; their jumps across the edges. */
#include "test.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/hash.h"
#include "base/pool.h"
#include "field/field.h"
#include "field/ramp.h"

#define W 96
#define H 64

static WrField *made(WrWrap u, WrWrap v, WrRamp ramp)
{
    WrError err;
    WrField *like = wr_field_new(W, H, u, v, 0, NULL),
            *f = wr_ramp_make(like, &ramp, NULL, NULL, &err);
    if (!f) fail_msg("%s", err.text);
    wr_field_free(like);
    return f;
}

static double u_of(int i)
{
    return (i + 0.5) / W;
}

static double v_of(int j)
{
    return 1 - (j + 0.5) / H;
}

static double cut(double t)
{
    return fmin(1, fmax(0, t));
}

static void a_linear_ramp_on_clamped_axes_is_its_formula(void **state)
{
    (void)state;
    WrRamp r = { WR_RAMP_LINEAR, 0.2, 0.3, 0.7, 0.9, -2, 5, false };
    WrField *f = made(WR_WRAP_CLAMP, WR_WRAP_CLAMP, r);
    double dx = 0.5 * W, dy = 0.6 * H;
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++) {
            double x = W * (u_of(i) - 0.2), y = H * (v_of(j) - 0.3);
            double t = cut((x * dx + y * dy) / (dx * dx + dy * dy));
            assert_near(wr_field_get(f, i, j), -2 + 7 * t, 1e-6);
        }
    wr_field_free(f);
}

/* A step from one texel to the next, over the edges as well, is at most the slope of the formula. */
static double largest_step(const WrField *f)
{
    double most = 0;
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++) {
            double here = wr_field_get(f, i, j);
            most = fmax(most, fabs(wr_field_get(f, (i + 1) % W, j) - here));
            most = fmax(most, fabs(wr_field_get(f, i, (j + 1) % H) - here));
        }
    return most;
}

static void a_linear_ramp_jumps_half_a_table_from_its_middle_alone(void **state)
{
    (void)state;
    WrField *f = made(WR_WRAP_PERIODIC, WR_WRAP_PERIODIC,
                      (WrRamp){ WR_RAMP_LINEAR, 0.25, 0.5, 0.5, 0.5, 0, 1, false });
    int cut_column = (int)(W * 0.875); /* 0.375 + 0.5 */
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++) {
            double u = u_of(i) > 0.875 ? u_of(i) - 1 : u_of(i);
            assert_near(wr_field_get(f, i, j), cut((u - 0.25) / 0.25), 1e-6);
            double step = wr_field_get(f, (i + 1) % W, j) - wr_field_get(f, i, j);
            assert_true(i == cut_column - 1 ? step == -1 : step >= 0);
        }
    wr_field_free(f);
}

static void a_fold_leads_up_the_way_and_down_the_rest_of_the_way_round(void **state)
{
    (void)state;
    WrField *f = made(WR_WRAP_PERIODIC, WR_WRAP_PERIODIC,
                      (WrRamp){ WR_RAMP_LINEAR, 0.75, 0.5, 1.0, 0.5, 1, 3, true });
    for (int i = 0; i < W; i++) { /* up from 0.75 to 1, down from 0 to 0.75 */
        double u = u_of(i), t = u > 0.75 ? (u - 0.75) / 0.25 : 1 - u / 0.75;
        assert_near(wr_field_get(f, i, 7), 1 + 2 * t, 1e-6);
    }
    wr_field_free(f);
    f = made(WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, /* in the other direction, across the edge */
             (WrRamp){ WR_RAMP_LINEAR, 0.5, 0.25, 0.5, -0.25, 0, 1, true });
    for (int j = 0; j < H; j++) {
        double v = v_of(j), t = v > 0.75 ? (1.25 - v) / 0.5 : v > 0.25 ? (v - 0.25) / 0.5 : 0;
        if (v <= 0.25) t = (0.25 - v) / 0.5;
        assert_near(wr_field_get(f, 3, j), t, 1e-6);
    }
    wr_field_free(f);
}

static void folds_never_jump_and_lead_from_low_to_high(void **state)
{
    (void)state;
    TestRandom random = { 9 };
    for (int round = 0; round < 60; round++) {
        double u0 = 2 * test_random(&random) - 1, v0 = 2 * test_random(&random) - 1;
        double du = 1.2 * test_random(&random) - 0.6, dv = 1.2 * test_random(&random) - 0.6;
        WrRamp r = { WR_RAMP_LINEAR, u0, v0, u0 + du, v0 + dv, 0, 1, true };
        double x = fabs(W * du), y = fabs(H * dv), l2 = x * x + y * y;
        /* slopes along the way and back, of both axes */
        double steepest = fmax(x, x * x / (W - x)) / l2 + fmax(y, y * y / (H - y)) / l2;
        WrField *f = made(WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, r);
        if (largest_step(f) > steepest + 1e-6)
            fail_msg("round %d: steps of %g", round, largest_step(f));
        wr_field_free(f);
        r.kind = WR_RAMP_RADIAL;
        f = made(WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, r);
        assert_true(largest_step(f) <= 1 / sqrt(l2) + 1e-6);
        wr_field_free(f);
        r.fold = false;
        f = made(WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, r);
        assert_true(largest_step(f) <= 1 / sqrt(l2) + 1e-6); /* the plain one neither */
        wr_field_free(f);
    }
    /* low at from, high at to, exactly, where both are texel centres */
    WrField *f =
        made(WR_WRAP_PERIODIC, WR_WRAP_PERIODIC,
             (WrRamp){ WR_RAMP_LINEAR, u_of(10), v_of(50), u_of(70), v_of(20), -1, 4, true });
    assert_true(wr_field_get(f, 10, 50) == -1 && wr_field_get(f, 70, 20) == 4);
    wr_field_free(f);
}

static void a_radial_ramp_goes_by_the_distance_round_the_edges(void **state)
{
    (void)state;
    for (int fold = 0; fold < 2; fold++) {
        WrField *f = made(WR_WRAP_PERIODIC, WR_WRAP_PERIODIC,
                          (WrRamp){ WR_RAMP_RADIAL, 0.05, 0.9, 0.05, 1.15, 0, 2, fold });
        for (int j = 0; j < H; j++)
            for (int i = 0; i < W; i++) {
                double best = 1e9;
                for (int k = 0; k < 25; k++)
                    best = fmin(best, hypot(W * (u_of(i) - 0.05 + k % 5 - 2),
                                            H * (v_of(j) - 0.9 + k / 5 - 2)));
                double t = best / 16; /* a quarter of 64 */
                t = fold ? 1 - fabs(1 - t) : t;
                assert_near(wr_field_get(f, i, j), 2 * cut(t), 1e-6);
            }
        wr_field_free(f);
    }
}

static void a_cone_goes_by_the_angle(void **state)
{
    (void)state;
    for (int fold = 0; fold < 2; fold++) {
        WrField *f = made(WR_WRAP_CLAMP, WR_WRAP_CLAMP,
                          (WrRamp){ WR_RAMP_CONE, 0.5, 0.5, 0.5, 0.9, 0, 1, fold });
        for (int j = 0; j < H; j++)
            for (int i = 0; i < W; i++) {
                double x = W * (u_of(i) - 0.5), y = H * (v_of(j) - 0.5);
                double t = atan2(-x, y) / (2 * WR_PI); /* from straight up, anticlockwise */
                t = fold ? 2 * fabs(t) : t < 0 ? t + 1 : t;
                assert_near(wr_field_get(f, i, j), t, 1e-6);
            }
        wr_field_free(f);
    }
}

/* By its slope: the angle turns by 1/(2 pi r) a texel at distance r from a tip. */
static void a_folded_cone_jumps_nowhere_but_at_its_four_tips(void **state)
{
    (void)state;
    WrField *f = made(WR_WRAP_PERIODIC, WR_WRAP_PERIODIC,
                      (WrRamp){ WR_RAMP_CONE, 0.25, 0.5, 0.6, 0.8, 0, 1, true });
    int far = 0;
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++) {
            double r = 1e9;
            for (int k = 0; k < 36; k++) /* tips at every half table */
                r = fmin(r, hypot(W * (u_of(i) - 0.25) + W / 2 * (k % 6 - 3),
                                  H * (v_of(j) - 0.5) + H / 2 * (k / 6 - 3)));
            double here = wr_field_get(f, i, j);
            double most = r > 3 ? 2 / (2 * WR_PI * (r - 1)) : 1;
            assert_true(fabs(wr_field_get(f, (i + 1) % W, j) - here) <= most);
            assert_true(fabs(wr_field_get(f, i, (j + 1) % H) - here) <= most);
            far += r > 3;
        }
    assert_true(far > W * H / 2);
    wr_field_free(f);
}

static void ramps_are_the_same_for_any_number_of_threads_and_roll_with_the_table(void **state)
{
    (void)state;
    WrError err;
    WrPool *pool = wr_pool_new(3);
    WrField *like = wr_field_new(128, 256, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int k = 0; k < 6; k++) {
        WrRamp r = { (WrRampKind)(k / 2), 0.25, 0.375, 0.5, 0.875, 0, 1, k % 2 };
        WrField *a = wr_ramp_make(like, &r, NULL, NULL, &err),
                *b = wr_ramp_make(like, &r, pool, NULL, &err);
        assert_true(wr_hash_equal(wr_field_hash(a), wr_field_hash(b)));
        r.from_u += 0.5;
        r.to_u += 0.5;
        r.from_v -= 0.25;
        r.to_v -= 0.25;
        WrField *c = wr_ramp_make(like, &r, pool, NULL, &err);
        for (int j = 0; j < 256; j++)
            for (int i = 0; i < 128; i++)
                assert_true(wr_field_get(c, (i + 64) % 128, (j + 64) % 256) ==
                            wr_field_get(a, i, j));
        wr_field_free(a);
        wr_field_free(b);
        wr_field_free(c);
    }
    wr_field_free(like);
    wr_pool_free(pool);
}

static void ramps_that_lead_nowhere_are_refused(void **state)
{
    (void)state;
    WrError err;
    WrField *like = wr_field_new(W, H, WR_WRAP_PERIODIC, WR_WRAP_CLAMP, 0, NULL);
    WrRamp r = { WR_RAMP_LINEAR, 0.5, 0.5, 0.5, 0.5, 0, 1, false };
    assert_null(wr_ramp_make(like, &r, NULL, NULL, &err));
    assert_non_null(strstr(err.text, "same point"));
    r = (WrRamp){ WR_RAMP_LINEAR, 0, 0, 1, 0, 0, 1, true };
    assert_null(wr_ramp_make(like, &r, NULL, NULL, &err));
    assert_non_null(strstr(err.text, "along u"));
    r = (WrRamp){ WR_RAMP_LINEAR, 0, 0, 0, 3, -3e38, 3e38, true }; /* v is clamped: no way round */
    WrField *f = wr_ramp_make(like, &r, NULL, NULL, &err);
    float low, high;
    wr_field_range(f, &low, &high);
    assert_true(low >= -3e38f && high <= 3e38f && high > low);
    wr_field_free(f);
    wr_field_free(like);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_linear_ramp_on_clamped_axes_is_its_formula),
        cmocka_unit_test(a_linear_ramp_jumps_half_a_table_from_its_middle_alone),
        cmocka_unit_test(a_fold_leads_up_the_way_and_down_the_rest_of_the_way_round),
        cmocka_unit_test(folds_never_jump_and_lead_from_low_to_high),
        cmocka_unit_test(a_radial_ramp_goes_by_the_distance_round_the_edges),
        cmocka_unit_test(a_cone_goes_by_the_angle),
        cmocka_unit_test(a_folded_cone_jumps_nowhere_but_at_its_four_tips),
        cmocka_unit_test(ramps_are_the_same_for_any_number_of_threads_and_roll_with_the_table),
        cmocka_unit_test(ramps_that_lead_nowhere_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
