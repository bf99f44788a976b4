/* The normal formulas at poles, focal distances and the ends of double's range. */
#include "test.h"

#include "bump_points.h"

/* F = 0.1 x / R is single-valued at the pole, with gradient (0.1, 0, 0) for any u: every approach converges to n' =
 * (-0.1, 0, 1), normalised, to 1e-7 or better. */
static void hc02_the_bumped_normal_converges_at_a_pole(void **state)
{
    (void)state;
    WrShape sphere = shape_of(WR_SURFACE_sphere);
    WrVec3 limit = v3_unit((WrVec3){ -0.1, 0, 1 }, none);
    for (int k = 20; k <= 52; k++) {
        for (int i = 0; i < 7; i++) {
            double u = i / 7.0, v = 1 - ldexp(1, -k), s, c, sl, cl;
            WrSurfacePoint o;
            wr_surface_at(&sphere, 0, u, v, &o);
            wr_sincos_turns(u, &s, &c);
            wr_sincos_turns((v - 0.5) / 2, &sl, &cl);
            double fu = -0.1 * 2 * WR_PI * s * cl, fv = -0.1 * WR_PI * c * sl;
            WrVec3 n1 = unit_normal(WR_BUMP_BLINN, &o, 0, fu, fv);
            assert_near(distance(n1, limit), 0, 10 * ldexp(1, -k) + 1e-15);
        }
    }
}

static void hc03_a_table_that_is_not_single_valued_at_a_pole_stays_unit(void **state)
{
    (void)state;
    TestRandom random = { 10 };
    WrShape sphere = shape_of(WR_SURFACE_sphere);
    for (int k = 1; k <= 53; k++) {
        WrSurfacePoint o;
        double v = k == 53 ? 1 : 1 - ldexp(1, -k);
        wr_surface_at(&sphere, 0, test_random(&random), v, &o);
        double f = between(&random, -1, 1), fu = between(&random, 0.5, 9),
               fv = between(&random, -9, 9);
        for (int mode = 0; mode < WR_BUMP_COUNT; mode++) {
            WrVec3 n1 = unit_normal((WrBumpMode)mode, &o, f, fu, fv);
            assert_near(v3_len(n1), 1, 1e-15);
        }
        if (k < 40) continue; /* |gradient| -> infinity: blinn's tends to a tangent */
        assert_near(v3_dot(unit_normal(WR_BUMP_BLINN, &o, f, fu, fv), o.n_unit), 0, 1e-9);
    }
}

static void hc12_exact_falls_back_to_n_at_the_focal_distance(void **state)
{
    (void)state;
    for (int i = 0; i < 100; i++) {
        WrShape shape = shape_of(i % 2 ? WR_SURFACE_sphere : WR_SURFACE_cylinder);
        shape.value[0] = 0.3 + 0.017 * i;
        WrSurfacePoint o;
        wr_surface_at(&shape, 0, 0.013 * i, 0.1 + 0.008 * i, &o);
        double f = -shape.value[0], slope = i % 4 == 1 ? 0.7 : 0;
        WrVec3 n1 = normal(WR_BUMP_EXACT, &o, f, slope, slope);
        WrVec3 unit = unit_normal(WR_BUMP_EXACT, &o, f, slope, slope);
        assert_true(v3_len(n1) == 0);
        assert_true(distance(unit, o.n_unit) == 0);
        assert_true(distance(wr_bump_unit(n1, o.n_unit), o.n_unit) == 0);
    }
}

static void hc13_beyond_the_focal_distance_n_flips_with_the_determinant(void **state)
{
    (void)state;
    for (int i = 0; i < 20; i++) {
        WrShape sphere = shape_of(WR_SURFACE_sphere), tube = shape_of(WR_SURFACE_cylinder);
        WrSurfacePoint a, b;
        wr_surface_at(&sphere, 0, 0.05 * i, 0.3, &a);
        wr_surface_at(&tube, 0, 0.05 * i, 0.3, &b);
        double beyond = -1.5 - i;
        assert_near(distance(unit_normal(WR_BUMP_EXACT, &a, beyond, 0, 0), a.n_unit), 0, 1e-14);
        assert_near(distance(unit_normal(WR_BUMP_EXACT, &b, beyond, 0, 0), v3_neg(b.n_unit)), 0,
                    1e-14);
    }
}

static void hc14_a_huge_height_without_slope_leaves_a_flat_patch_alone(void **state)
{
    (void)state;
    WrShape plane = shape_of(WR_SURFACE_plane);
    WrSurfacePoint o;
    wr_surface_at(&plane, 0, 0.3, 0.2, &o);
    for (int mode = 0; mode < WR_BUMP_COUNT; mode++) {
        WrVec3 n1 = normal((WrBumpMode)mode, &o, 1e30, 0, 0);
        assert_true(same_bits(n1.x, 0) && same_bits(n1.y, 0) && same_bits(n1.z, 1));
    }
}

static void hc15_overflowing_slopes_turn_n_straight_downhill(void **state)
{
    (void)state;
    static const double steep[] = { 1e38, 1e154, 1e300, DBL_MAX };
    WrShape plane = shape_of(WR_SURFACE_plane), sphere = shape_of(WR_SURFACE_sphere);
    WrSurfacePoint o;
    for (int i = 0; i < 4; i++) {
        for (int mode = WR_BUMP_BLINN; mode < WR_BUMP_COUNT; mode++) {
            double a = steep[i];
            wr_surface_at(&plane, 0, 0.3, 0.2, &o);
            WrVec3 down = unit_normal((WrBumpMode)mode, &o, 0.1, a, -a / 2);
            WrVec3 expected = v3_unit((WrVec3){ -1, 0.5, 0 }, none);
            assert_near(distance(down, expected), 0, 1e-15);
            WrVec3 n1 = normal((WrBumpMode)mode, &o, 0.1, a, -a / 2);
            assert_near(distance(wr_bump_unit(n1, none), expected), 0, 1e-15);
            wr_surface_at(&sphere, 0, 0.3, 0.2, &o);
            down = unit_normal((WrBumpMode)mode, &o, 0.1, a, a);
            assert_near(v3_len(down), 1, 1e-15);
            assert_near(v3_dot(down, o.n_unit), 0, 1e-15);
        }
    }
}

static void hc16_slopes_too_small_to_square_leave_n(void **state)
{
    (void)state;
    TestRandom random = { 11 };
    for (int i = 0; i < 100; i++) {
        Sample s = random_sample(&random);
        for (int mode = WR_BUMP_BLINN; mode < WR_BUMP_COUNT; mode++) {
            double tiny = i % 2 ? 1e-30 : 5e-324;
            WrVec3 n1 = unit_normal((WrBumpMode)mode, &s.o, 0, tiny, -tiny);
            assert_near(distance(n1, s.o.n_unit), 0, 4e-16); /* an ulp a component */
        }
    }
}

static void hc17_without_slope_n_comes_back_bit_for_bit(void **state)
{
    (void)state;
    TestRandom random = { 12 };
    for (int i = 0; i < 100; i++) {
        Sample s = random_sample(&random);
        for (int mode = 0; mode < WR_BUMP_COUNT; mode++) {
            double f = mode == WR_BUMP_EXACT ? 0 : s.f, zero = i % 2 ? -0.0 : 0.0;
            WrVec3 n1 = normal((WrBumpMode)mode, &s.o, f, zero, 0);
            WrVec3 unit = unit_normal((WrBumpMode)mode, &s.o, f, 0, zero);
            assert_memory_equal(&n1, &s.o.n, sizeof n1);
            assert_memory_equal(&unit, &s.o.n_unit, sizeof unit);
        }
    }
}

/* tan(theta') = a also where a^2, |D|^2 and |N|^2 overflow. */
static void hc18_invariant_keeps_the_angle_of_tiny_slopes(void **state)
{
    (void)state;
    const WrSurfacePoint tiny = { .pu = { 0x1p-500, 0, 0 },
                                  .pv = { 0, 0x1p-500, 0 },
                                  .n = { 0, 0, 0x1p-1000 },
                                  .n_unit = { 0, 0, 1 } };
    WrVec3 n2 = normal(WR_BUMP_INVARIANT, &tiny, 0, 0.6, 0.8);
    assert_near(hypot(n2.x, n2.y) / n2.z, 1, 1e-15);
    static const double slopes[] = { 1e-25, 1e-170, 1e-300 };
    for (int i = 0; i < 3; i++) {
        double a = slopes[i];
        WrVec3 unit = unit_normal(WR_BUMP_INVARIANT, &tiny, 0, 0.6 * a, 0.8 * a);
        assert_near(hypot(unit.x / a, unit.y / a), 1, 1e-14);
        assert_true(unit.z == 1);
    }
}

static void hc19_invariant_at_a_pole_turns_by_the_slope_on_every_approach(void **state)
{
    (void)state;
    WrShape sphere = shape_of(WR_SURFACE_sphere), cone = shape_of(WR_SURFACE_cone);
    static const double slopes[][2] = { { 0.5, 0 }, { 0, 0.5 }, { 0.3, -0.4 }, { 1e-200, 1e-200 } };
    for (int i = 0; i < 4; i++) {
        double fu = slopes[i][0], fv = slopes[i][1], a = hypot(fu, fv);
        for (int k = 40; k <= 54; k++) {
            double v = k >= 53 ? 1 : 1 - ldexp(1, -k);
            for (int j = 0; j < 16; j++) {
                WrSurfacePoint o;
                wr_surface_at(j % 2 ? &cone : &sphere, 0, j / 16.0, k == 54 && j % 2 == 0 ? 0 : v,
                              &o);
                WrVec3 unit = unit_normal(WR_BUMP_INVARIANT, &o, 0, fu, fv);
                assert_near(v3_len(unit), 1, 1e-15);
                double along = v3_dot(unit, o.n_unit), across = v3_len(v3_cross(unit, o.n_unit));
                assert_near(across / along, a, 1e-13);
            }
        }
    }
    /* the direction where Pu = 0 and F falls along v alone is that of the points before the pole */
    WrSurfacePoint pole, before;
    wr_surface_at(&sphere, 0, 0.2, 1, &pole);
    wr_surface_at(&sphere, 0, 0.2, 1 - 0x1p-40, &before);
    assert_near(distance(unit_normal(WR_BUMP_INVARIANT, &pole, 0, 0, 0.5),
                         unit_normal(WR_BUMP_INVARIANT, &before, 0, 0, 0.5)),
                0, 1e-11);
}

static void hc21_normalising_nothing_gives_n_and_denormals_their_direction(void **state)
{
    (void)state;
    const WrVec3 n = { 0.6, 0, 0.8 };
    const WrVec3 useless[] = {
        { 0, 0, 0 }, { INFINITY, 0, 0 }, { NAN, 1, 2 }, { 0, -INFINITY, NAN }
    };
    for (int i = 0; i < 4; i++) assert_true(distance(wr_bump_unit(useless[i], n), n) == 0);
    WrVec3 denormal = wr_bump_unit((WrVec3){ 3e-320, 0, -4e-320 }, n);
    assert_near(distance(denormal, (WrVec3){ 0.6, 0, -0.8 }), 0,
                1e-3); /* 13 bits are left of them */
    assert_near(v3_len(denormal), 1, 1e-15);
    WrVec3 huge = wr_bump_unit((WrVec3){ DBL_MAX, DBL_MAX, 0 }, n);
    assert_near(distance(huge, (WrVec3){ sqrt(0.5), sqrt(0.5), 0 }), 0, 1e-15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hc02_the_bumped_normal_converges_at_a_pole),
        cmocka_unit_test(hc03_a_table_that_is_not_single_valued_at_a_pole_stays_unit),
        cmocka_unit_test(hc12_exact_falls_back_to_n_at_the_focal_distance),
        cmocka_unit_test(hc13_beyond_the_focal_distance_n_flips_with_the_determinant),
        cmocka_unit_test(hc14_a_huge_height_without_slope_leaves_a_flat_patch_alone),
        cmocka_unit_test(hc15_overflowing_slopes_turn_n_straight_downhill),
        cmocka_unit_test(hc16_slopes_too_small_to_square_leave_n),
        cmocka_unit_test(hc17_without_slope_n_comes_back_bit_for_bit),
        cmocka_unit_test(hc18_invariant_keeps_the_angle_of_tiny_slopes),
        cmocka_unit_test(hc19_invariant_at_a_pole_turns_by_the_slope_on_every_approach),
        cmocka_unit_test(hc21_normalising_nothing_gives_n_and_denormals_their_direction),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
