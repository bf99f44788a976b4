/* The normal formulas: identities of the paper, and displaced surfaces. */
#include "test.h"

#include "bump_points.h"

/* A smooth F that is periodic in u and single-valued where a surface comes together (v = 0, 1). */
static double bumps(double u, double v, double *fu, double *fv)
{
    double su, cu, sv, cv;
    wr_sincos_turns(2 * u + 0.1, &su, &cu);
    wr_sincos_turns(v, &sv, &cv);
    double w = 1 - cv;
    *fu = 4 * WR_PI * cu * w;
    *fv = su * 2 * WR_PI * sv;
    return su * w;
}

/* P + amplitude F n */
static WrVec3 displaced(const WrShape *shape, double amplitude, double u, double v)
{
    double fu, fv;
    WrSurfacePoint o;
    wr_surface_at(shape, 0, u, v, &o);
    return v3_mad(o.p, o.n_unit, amplitude * bumps(u, v, &fu, &fv));
}

/* The displaced surface's normal by central differences of its points, of fourth order. */
static WrVec3 displaced_normal(const WrShape *shape, double amplitude, double u, double v)
{
    const double h = 1e-3;
    WrVec3 d[2];
    for (int along = 0; along < 2; along++) {
        double a = along ? 0 : h, b = along ? h : 0;
        WrVec3 one = v3_sub(displaced(shape, amplitude, u + a, v + b),
                            displaced(shape, amplitude, u - a, v - b));
        WrVec3 two = v3_sub(displaced(shape, amplitude, u + 2 * a, v + 2 * b),
                            displaced(shape, amplitude, u - 2 * a, v - 2 * b));
        d[along] = v3_scale(v3_sub(v3_scale(one, 8), two), 1 / (12 * h));
    }
    return v3_unit(v3_cross(d[0], d[1]), none);
}

/* N' = N + D; N x N' = |N| A; |D| = |A|; tan(theta) = |D|/|N| */
static void b7_to_b10_blinn_turns_n_about_a_by_the_angle_of_the_paper(void **state)
{
    (void)state;
    TestRandom random = { 1 };
    for (int i = 0; i < 500; i++) {
        Sample s = random_sample(&random);
        WrVec3 n1 = normal(WR_BUMP_BLINN, &s.o, s.f, s.fu, s.fv);
        WrVec3 plain = v3_sub(v3_scale(v3_cross(s.o.n_unit, s.o.pv), s.fu),
                              v3_scale(v3_cross(s.o.n_unit, s.o.pu), s.fv));
        WrVec3 d = wr_bump_d(s.o.n_unit, s.o.pu, s.o.pv, s.fu, s.fv);
        WrVec3 a = wr_bump_axis(s.o.pu, s.o.pv, s.fu, s.fv);
        double size = s.o.n_len + v3_len(a);
        assert_near(distance(d, plain), 0, 1e-14 * size);
        assert_near(distance(n1, v3_add(s.o.n, d)), 0, 1e-15 * size);
        assert_near(distance(v3_cross(s.o.n, n1), v3_scale(a, s.o.n_len)), 0, 1e-14 * size * size);
        assert_near(v3_len(d), v3_len(a), 1e-14 * size);
        double tilt = wr_bump_tilt_deg(s.o.n_unit, wr_bump_unit(n1, s.o.n_unit));
        assert_near(tilt, atan(v3_len(d) / s.o.n_len) * 180 / WR_PI, 1e-11);
    }
}

static void b14_on_the_unit_patch_n_tips_downhill(void **state)
{
    (void)state;
    WrShape plane = shape_of(WR_SURFACE_plane);
    WrSurfacePoint o;
    wr_surface_at(&plane, 0, 0.4, 0.7, &o);
    WrVec3 n1 = normal(WR_BUMP_BLINN, &o, 0.3, 0.25, -1.5);
    assert_true(n1.x == -0.25 && n1.y == 1.5 && n1.z == 1);
}

static void b15_invariant_turns_by_the_slope_itself(void **state)
{
    (void)state;
    TestRandom random = { 2 };
    for (int i = 0; i < 500; i++) {
        Sample s = random_sample(&random);
        WrVec3 blinn = normal(WR_BUMP_BLINN, &s.o, s.f, s.fu, s.fv);
        WrVec3 n2 = normal(WR_BUMP_INVARIANT, &s.o, s.f, s.fu, s.fv);
        WrVec3 unit = unit_normal(WR_BUMP_INVARIANT, &s.o, s.f, s.fu, s.fv);
        double a = sqrt(s.fu * s.fu + s.fv * s.fv);
        WrVec3 d2 = v3_sub(n2, s.o.n), d = v3_sub(blinn, s.o.n);
        assert_near(v3_len(d2), a * s.o.n_len, 1e-13 * (1 + a) * s.o.n_len);
        assert_near(v3_len(v3_cross(d, d2)), 0, 1e-13 * v3_len(d) * v3_len(d2) + 1e-13 * s.o.n_len);
        assert_true(v3_dot(d, d2) >= 0);
        assert_near(distance(unit, wr_bump_unit(n2, s.o.n_unit)), 0, 1e-14);
        assert_near(wr_bump_tilt_deg(s.o.n_unit, unit), atan(a) * 180 / WR_PI, 1e-12);
    }
}

static WrSurfacePoint scaled(const WrSurfacePoint *o, double k)
{
    WrSurfacePoint big = *o;
    big.pu = v3_scale(o->pu, k);
    big.pv = v3_scale(o->pv, k);
    big.n = v3_scale(o->n, k * k);
    return big;
}

static double tangent_of_tilt(WrVec3 a, WrVec3 b)
{
    return v3_len(v3_cross(a, b)) / v3_dot(a, b);
}

static void b16_blinns_tangent_falls_as_the_object_grows(void **state)
{
    (void)state;
    static const double scales[] = { 0.01, 0.5, 10, 1e4 };
    TestRandom random = { 3 };
    for (int i = 0; i < 200; i++) {
        Sample s = random_sample(&random);
        double k = scales[i % 4];
        WrSurfacePoint big = scaled(&s.o, k);
        double small_tan =
            tangent_of_tilt(unit_normal(WR_BUMP_BLINN, &s.o, 0, s.fu, s.fv), s.o.n_unit);
        double big_tan =
            tangent_of_tilt(unit_normal(WR_BUMP_BLINN, &big, 0, s.fu, s.fv), s.o.n_unit);
        assert_near(big_tan * k / small_tan, 1, 1e-9);
    }
}

/* Bumps scaled with the object leave blinn unchanged; invariant is unchanged for any size of the object. */
static void a9_hc09_scaling_by_ten_to_the_twenty_either_way(void **state)
{
    (void)state;
    static const double scales[] = { 1e-20, 1e-6, 1e6, 1e20 };
    TestRandom random = { 16 };
    for (int i = 0; i < 200; i++) {
        Sample s = random_sample(&random);
        double k = scales[i % 4];
        WrSurfacePoint big = scaled(&s.o, k);
        WrVec3 blinn = unit_normal(WR_BUMP_BLINN, &s.o, 0, s.fu, s.fv);
        WrVec3 same = unit_normal(WR_BUMP_BLINN, &big, 0, k * s.fu, k * s.fv);
        assert_near(distance(same, blinn), 0, 1e-14);
        WrVec3 invariant = unit_normal(WR_BUMP_INVARIANT, &s.o, 0, s.fu, s.fv);
        assert_near(distance(unit_normal(WR_BUMP_INVARIANT, &big, 0, s.fu, s.fv), invariant), 0,
                    1e-14);
        WrVec3 long_form = normal(WR_BUMP_INVARIANT, &big, 0, s.fu, s.fv);
        assert_near(distance(wr_bump_unit(long_form, s.o.n_unit), invariant), 0, 1e-14);
        /* blinn without scaled bumps: n itself on a huge object, straight downhill on a tiny one */
        WrVec3 d = v3_unit(wr_bump_d(s.o.n_unit, s.o.pu, s.o.pv, s.fu, s.fv), none);
        if (i % 4 == 0 || i % 4 == 3)
            assert_near(
                distance(unit_normal(WR_BUMP_BLINN, &big, 0, s.fu, s.fv), k > 1 ? s.o.n_unit : d),
                0, 1e-15);
    }
}

/* The same point with another parameter, u = 2 t: Pt = 2 Pu, Ft = 2 Fu, n_t = 2 n_u. */
static void a10_the_result_does_not_depend_on_the_parameters(void **state)
{
    (void)state;
    TestRandom random = { 4 };
    for (int i = 0; i < 200; i++) {
        Sample s = random_sample(&random);
        WrSurfacePoint other = s.o;
        other.pu = v3_scale(s.o.pu, 2);
        other.n_u = v3_scale(s.o.n_u, 2);
        other.n = v3_scale(s.o.n, 2);
        for (int mode = WR_BUMP_BLINN; mode < WR_BUMP_COUNT; mode++) {
            if (mode == WR_BUMP_INVARIANT)
                continue; /* its angle is that of the parameters' slope */
            WrVec3 a = unit_normal((WrBumpMode)mode, &s.o, s.f, s.fu, s.fv);
            WrVec3 b = unit_normal((WrBumpMode)mode, &other, s.f, 2 * s.fu, s.fv);
            assert_near(distance(a, b), 0, 4e-15);
        }
    }
}

static void hc22_swapping_u_and_v_exchanges_bumps_and_dents(void **state)
{
    (void)state;
    TestRandom random = { 5 };
    for (int i = 0; i < 200; i++) {
        Sample s = random_sample(&random);
        WrVec3 d = wr_bump_d(s.o.n_unit, s.o.pu, s.o.pv, s.fu, s.fv);
        WrVec3 swapped = wr_bump_normal(WR_BUMP_BLINN, v3_neg(s.o.n), v3_neg(s.o.n_unit), s.o.pv,
                                        s.o.pu, none, none, s.f, s.fv, s.fu);
        WrVec3 expected = v3_sub(d, s.o.n); /* -N + D, to the last bit */
        assert_true(swapped.x == expected.x && swapped.y == expected.y && swapped.z == expected.z);
    }
}

/* The exact normal is the displaced surface's; seen from behind it is its opposite (HC23). */
static void hc23_exact_is_the_normal_of_the_displaced_surface_from_both_sides(void **state)
{
    (void)state;
    TestRandom random = { 6 };
    for (int i = 0; i < 300; i++) {
        Sample s = random_sample(&random);
        double amplitude = between(&random, -0.1, 0.1), fu, fv;
        double f = amplitude * bumps(s.u, s.v, &fu, &fv);
        WrVec3 exact = unit_normal(WR_BUMP_EXACT, &s.o, f, amplitude * fu, amplitude * fv);
        WrVec3 reference = displaced_normal(&s.shape, amplitude, s.u, s.v);
        assert_near(distance(exact, reference), 0, 2e-6);
        WrVec3 view = v3_neg(reference); /* the eye behind: there the visible side has -N' */
        assert_true(v3_dot(v3_neg(exact), view) > 0.999);
        /* and the long form equals Pu' x Pv' itself */
        WrVec3 pu = v3_add(v3_mad(s.o.pu, s.o.n_unit, amplitude * fu), v3_scale(s.o.n_u, f));
        WrVec3 pv = v3_add(v3_mad(s.o.pv, s.o.n_unit, amplitude * fv), v3_scale(s.o.n_v, f));
        WrVec3 n1 = normal(WR_BUMP_EXACT, &s.o, f, amplitude * fu, amplitude * fv);
        assert_near(distance(n1, v3_cross(pu, pv)), 0, 1e-13 * v3_len(pu) * v3_len(pv));
    }
}

/* At a fixed slope the dropped terms are proportional to F. */
static void blinns_error_is_proportional_to_the_height_it_drops(void **state)
{
    (void)state;
    TestRandom random = { 15 };
    int counted = 0;
    for (int i = 0; i < 200; i++) {
        Sample s = random_sample(&random);
        WrVec3 blinn = unit_normal(WR_BUMP_BLINN, &s.o, 0, s.fu, s.fv);
        double error[2];
        for (int k = 0; k < 2; k++) {
            double f = s.f * (k ? 0x1p-12 : 0x1p-10);
            error[k] = distance(unit_normal(WR_BUMP_EXACT, &s.o, f, s.fu, s.fv), blinn);
        }
        if (error[0] < 1e-9) continue;
        counted++;
        assert_true(error[0] / error[1] > 3.8 && error[0] / error[1] < 4.2);
    }
    assert_true(counted > 100);
}

/* The angle between Blinn's and the displaced surface's normal at fixed points falls as the square
 * of the amplitude (its slope times the dropped F). */
static void a5_blinns_error_falls_with_the_square_of_the_amplitude(void **state)
{
    (void)state;
    TestRandom random = { 7 };
    int counted = 0;
    for (int i = 0; i < 200; i++) {
        Sample s = random_sample(&random);
        double error[2], fu, fv, f = bumps(s.u, s.v, &fu, &fv);
        for (int k = 0; k < 2; k++) {
            double a = k ? 0x1p-14 : 0x1p-12;
            WrVec3 blinn = unit_normal(WR_BUMP_BLINN, &s.o, a * f, a * fu, a * fv);
            WrVec3 exact = unit_normal(WR_BUMP_EXACT, &s.o, a * f, a * fu, a * fv);
            error[k] = distance(blinn, exact);
        }
        if (error[0] < 1e-9) continue;
        counted++;
        assert_true(error[0] / error[1] > 14 && error[0] / error[1] < 18);
    }
    assert_true(counted > 100);
}

/* angle <= |F| k / (1 - |F| k) |grad F|, k the largest curvature: 1/R on the sphere and the
   cylinder */
static void a3_blinns_error_stays_under_its_bound(void **state)
{
    (void)state;
    TestRandom random = { 8 };
    for (int i = 0; i < 2000; i++) {
        WrShape shape = shape_of(i % 2 ? WR_SURFACE_sphere : WR_SURFACE_cylinder);
        double k = 1 / shape.value[0], f = between(&random, -0.9, 0.9) / k;
        double fu = between(&random, -3, 3), fv = between(&random, -3, 3);
        WrSurfacePoint o;
        wr_surface_at(&shape, 0, test_random(&random), between(&random, 0.05, 0.95), &o);
        double slope = v3_len(wr_bump_axis(o.pu, o.pv, fu, fv)) / o.n_len;
        WrVec3 blinn = unit_normal(WR_BUMP_BLINN, &o, f, fu, fv);
        WrVec3 exact = unit_normal(WR_BUMP_EXACT, &o, f, fu, fv);
        double bound = fabs(f) * k / (1 - fabs(f) * k) * slope;
        assert_true(v3_angle_rad(blinn, exact) <= bound * (1 + 1e-9) + 1e-15);
    }
}

static void a4_on_a_flat_base_blinn_is_exact_for_any_height(void **state)
{
    (void)state;
    TestRandom random = { 9 };
    for (int i = 0; i < 300; i++) {
        WrShape shape = shape_of(i % 2 ? WR_SURFACE_plane : WR_SURFACE_cube);
        shape.value[0] = between(&random, 0.1, 10);
        WrSurfacePoint o;
        wr_surface_at(&shape, i % wr_surfaces[shape.kind]->faces, 0.3, 0.6, &o);
        double f = between(&random, -1e6, 1e6), fu = between(&random, -9, 9), fv = -fu * 0.7 + 1;
        WrVec3 blinn = normal(WR_BUMP_BLINN, &o, f, fu, fv);
        WrVec3 exact = normal(WR_BUMP_EXACT, &o, f, fu, fv);
        assert_true(blinn.x == exact.x && blinn.y == exact.y && blinn.z == exact.z);
    }
}

static void hc20_the_tilt_of_equal_normals_is_zero_and_small_ones_are_kept(void **state)
{
    (void)state;
    TestRandom random = { 14 };
    for (int i = 0; i < 200; i++) {
        WrVec3 n = v3_unit((WrVec3){ between(&random, -1, 1), between(&random, -1, 1), 0.2 }, none);
        assert_true(wr_bump_tilt_deg(n, n) == 0);
        assert_near(wr_bump_tilt_deg(n, v3_neg(n)), 180, 1e-13);
    }
    WrVec3 up = { 0, 0, 1 }, little = { 1e-9, 0, 1 }, side = { 1, 0, 0 };
    assert_near(wr_bump_tilt_deg(up, little) / (1e-9 * 180 / WR_PI), 1, 1e-14);
    assert_near(wr_bump_tilt_deg(up, side), 90, 1e-13);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(b7_to_b10_blinn_turns_n_about_a_by_the_angle_of_the_paper),
        cmocka_unit_test(b14_on_the_unit_patch_n_tips_downhill),
        cmocka_unit_test(b15_invariant_turns_by_the_slope_itself),
        cmocka_unit_test(b16_blinns_tangent_falls_as_the_object_grows),
        cmocka_unit_test(a9_hc09_scaling_by_ten_to_the_twenty_either_way),
        cmocka_unit_test(a10_the_result_does_not_depend_on_the_parameters),
        cmocka_unit_test(hc22_swapping_u_and_v_exchanges_bumps_and_dents),
        cmocka_unit_test(hc23_exact_is_the_normal_of_the_displaced_surface_from_both_sides),
        cmocka_unit_test(blinns_error_is_proportional_to_the_height_it_drops),
        cmocka_unit_test(a5_blinns_error_falls_with_the_square_of_the_amplitude),
        cmocka_unit_test(a3_blinns_error_stays_under_its_bound),
        cmocka_unit_test(a4_on_a_flat_base_blinn_is_exact_for_any_height),
        cmocka_unit_test(hc20_the_tilt_of_equal_normals_is_zero_and_small_ones_are_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
