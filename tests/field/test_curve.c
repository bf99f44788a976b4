/* The monotone cubic: independently computed numbers; monotonicity and interpolation. */
#include "test.h"
#include "ops_tables.h"

#include "base/error.h"
#include "field/monotone_curve.h"

static WrCurve curve_of(const double *points, int count)
{
    WrCurve curve;
    WrError err;
    if (!wr_curve_make(points, count, &curve, &err)) fail_msg("%s", err.text);
    return curve;
}

/* By hand, in fractions. Points (0,0) (1,1) (3,2) (4,6): d = 1, 1/2, 4. m = 1, 3/4, 9/4, 4. Interval 2: a = 3/2,
   b = 9/2, a^2 + b^2 = 22.5 > 9, so both times 3/sqrt(22.5): m1 = 0.75 t, m2 = 2.25 t. Interval 3: a = m2/4 and
   b = 1: fine. */
static void numbers_worked_out_by_hand(void **state)
{
    (void)state;
    static const double points[] = { 0, 0, 1, 1, 3, 2, 4, 6 };
    const WrCurve c = curve_of(points, 4);
    const double t = 3 / sqrt(22.5);
    assert_near(c.slope[0], 1, 1e-15);
    assert_near(c.slope[1], 0.75 * t, 1e-15);
    assert_near(c.slope[2], 2.25 * t, 1e-15);
    assert_near(c.slope[3], 4, 1e-15);
    /* the middle of an interval is the mean of its ends and h/8 of the slopes' difference */
    assert_near(wr_curve_at(&c, 0.5), 0.5 + (1 - 0.75 * t) / 8, 1e-15);
    assert_near(wr_curve_at(&c, 2), 1.5 + 2 * (0.75 * t - 2.25 * t) / 8, 1e-15);
    assert_near(wr_curve_at(&c, 3.5), 4 + (2.25 * t - 4) / 8, 1e-15);
    /* a quarter: the Hermite basis there is 27/32, 9/64, 5/32, -3/64 */
    assert_near(wr_curve_at(&c, 1.5),
                27 / 32. * 1 + 5 / 32. * 2 + 2 * (9 / 64. * 0.75 * t - 3 / 64. * 2.25 * t), 1e-15);
    assert_near(wr_curve_at(&c, -2.5), -2.5, 1e-15);
    assert_near(wr_curve_at(&c, 4.75), 6 + 3, 1e-15);
    /* up, level, down: the level stays level */
    static const double hill[] = { -1, 0.5, 0, 2, 1, 2, 2.5, -1 };
    const WrCurve h = curve_of(hill, 4);
    assert_near(wr_curve_at(&h, 0.37), 2, 0);
    assert_near(h.slope[1], 0, 0);
}

static void it_meets_its_points_and_rises_where_they_rise(void **state)
{
    (void)state;
    TestRandom r = { 8 };
    for (int k = 0; k < 500; k++) {
        double points[2 * WR_CURVE_POINTS], x = -2, y = -1;
        const int count = 2 + (int)(15 * test_random(&r));
        for (int i = 0; i < count; i++) {
            points[2 * i] = x += 1e-3 + pow(test_random(&r), 4);
            points[2 * i + 1] = y += test_random(&r) < 0.2 ? 0 : pow(test_random(&r), 6);
        }
        const WrCurve c = curve_of(points, count);
        for (int i = 0; i < count; i++)
            assert_near(wr_curve_at(&c, points[2 * i]), points[2 * i + 1], 1e-13);
        double before = -INFINITY;
        for (int i = 0; i <= 400; i++) {
            const double at = points[0] - 0.2 + (x - points[0] + 0.4) * i / 400;
            const double now = wr_curve_at(&c, at);
            if (now < before - 1e-13) fail_msg("curve %d falls at %.17g", k, at);
            before = now;
        }
    }
}

static void what_makes_no_curve_is_refused(void **state)
{
    (void)state;
    static const double back[] = { 0, 0, 0.7, 1, 0.5, 1 }, twice[] = { 0, 0, 0, 1 };
    static const double steep[] = { 0, -1e308, 1e-10, 1e308 };
    WrCurve curve;
    WrError err = { "" };
    assert_false(wr_curve_make(back, 3, &curve, &err));
    assert_non_null(strstr(err.text, "point 3 at 0.5"));
    assert_false(wr_curve_make(twice, 2, &curve, &err));
    assert_false(wr_curve_make(steep, 2, &curve, &err));
    assert_false(wr_curve_make(twice, 1, &curve, &err));
}

static void the_operation_is_the_curve(void **state)
{
    (void)state;
    WrField *in = noisy_table(77, 35, P, C, 4);
    const double param[WR_OP_VALUES] = { 3, -0.5, 0.1, 0.4, 0.6, 1.2, 0.7 };
    const WrCurve c = curve_of(param + 1, 3);
    WrField *out = run_with("curves", in, param, NULL);
    for (int j = 0; j < 35; j++)
        for (int i = 0; i < 77; i++)
            assert_near(wr_field_get(out, i, j),
                        (float)wr_curve_at(&c, (double)wr_field_get(in, i, j)), 0);
    WrField *same = run_with("curves", in, NULL, NULL); /* 0,0;1,1 */
    assert_true(same_table(same, in));
    wr_field_free(same);
    wr_field_free(out);
    wr_field_free(in);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_worked_out_by_hand),
        cmocka_unit_test(it_meets_its_points_and_rises_where_they_rise),
        cmocka_unit_test(what_makes_no_curve_is_refused),
        cmocka_unit_test(the_operation_is_the_curve),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
