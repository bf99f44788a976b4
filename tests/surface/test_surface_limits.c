/* Surfaces where N = 0 or nearly so: poles, tips, collapsed edges. */
#include "test.h"
#include "surface_points.h"

#include "base/error.h"
#include "base/vec.h"

static void hc01_sphere_poles_are_exact_in_both_precisions(void **state)
{
    (void)state;
    WrShape shape;
    wr_shape_default(WR_SURFACE_sphere, &shape);
    for (int i = 0; i <= 16; i++) {
        for (int pole = 0; pole < 2; pole++) {
            WrSurfacePoint o;
            WrSurfacePointf of;
            both(&shape, 0, (float)i / 16, (float)pole, &o, &of);
            double z = pole ? 1 : -1;
            assert_true(o.n_unit.x == 0 && o.n_unit.y == 0 && o.n_unit.z == z);
            assert_true(of.n_unit.x == 0 && of.n_unit.y == 0 && (double)of.n_unit.z == z);
            assert_true(v3_len(o.pu) == 0 && o.n_len == 0 && v3_len(o.pv) > 3);
            assert_true(all_finite(&o) && all_finite_f(&of));
        }
    }
}

/* Near the pole the angle from it is pi 2^-k. */
static void hc02_sphere_normals_converge_to_the_pole(void **state)
{
    (void)state;
    WrShape shape;
    wr_shape_default(WR_SURFACE_sphere, &shape);
    for (int k = 1; k <= 52; k++) {
        double angle = WR_PI * ldexp(1, -k), u = 0.125, h = sin(angle) * sqrt(0.5);
        WrSurfacePoint o;
        WrSurfacePointf of;
        wr_surface_at(&shape, 0, u, 1 - ldexp(1, -k), &o);
        assert_near(o.n_unit.x / h, 1, 4e-16 * 2);
        assert_near(o.n_unit.y / h, 1, 4e-16 * 2);
        assert_near(o.n_unit.z, cos(angle), 2e-16);
        assert_true(o.n_len > 0 && (k == 1 || o.n.z > 0));
        if (k > 24) continue; /* 1 - 2^-k in float */
        both(&shape, 0, (float)u, (float)(1 - ldexp(1, -k)), &o, &of);
        assert_near((double)of.n_unit.x, h, 1e-7);
        assert_near((double)of.n_unit.y, h, 1e-7);
        assert_near((double)of.n_unit.z, cos(angle), 1.2e-7);
        assert_true(of.n_len > 0 && (k == 1 || of.n.z > 0));
    }
}

static void hc04_the_cone_has_a_normal_for_each_generator_at_its_tip(void **state)
{
    (void)state;
    WrShape shape;
    wr_shape_default(WR_SURFACE_cone, &shape);
    double R = shape.value[0], H = shape.value[1];
    for (int i = 0; i < 8; i++) {
        WrSurfacePoint o, near;
        double u = i / 8.0;
        wr_surface_at(&shape, 0, u, 1, &o);
        wr_surface_at(&shape, 0, u, 0.5, &near);
        assert_true(o.n_len == 0 && v3_len(o.pu) == 0);
        assert_near(v3_len(v3_sub(o.n_unit, near.n_unit)), 0, 1e-15);
        assert_near(v3_dot(o.n_unit, o.pv), 0, 1e-15);
        assert_near(o.n_unit.z, R / hypot(R, H), 1e-15);
    }
}

static void hc08_horn_spindle_and_thin_tori_point_away_from_their_tube(void **state)
{
    (void)state;
    static const double sizes[][2] = { { 1, 0 }, { 0.5, 0.5 }, { 0.3, 0.8 }, { 0, 1 } };
    for (int i = 0; i < 4; i++) {
        WrShape shape;
        wr_shape_default(WR_SURFACE_torus, &shape);
        shape.value[0] = sizes[i][0];
        shape.value[1] = sizes[i][1];
        assert_true(wr_shape_check(&shape, NULL));
        assert_finite_everywhere(&shape, true);
        for (int k = 0; k < 64; k++) {
            WrSurfacePoint o;
            wr_surface_at(&shape, 0, k % 8 / 8.0, k / 8 / 8.0, &o);
            double s, c;
            wr_sincos_turns(k % 8 / 8.0, &s, &c);
            WrVec3 tube = { shape.value[0] * c, shape.value[0] * s, 0 };
            WrVec3 out = v3_scale(o.n_unit, shape.value[1]);
            assert_near(v3_len(v3_sub(v3_sub(o.p, tube), out)), 0, 1e-15);
            /* N agrees except for the sign of w, the computed distance from the axis */
            double w = o.p.x * c + o.p.y * s;
            if (fabs(w) > 1e-12 && shape.value[1] > 0)
                assert_true((v3_dot(o.n, o.n_unit) > 0) == (w > 0));
        }
    }
    WrError err;
    WrShape none;
    wr_shape_default(WR_SURFACE_torus, &none);
    none.value[0] = none.value[1] = 0;
    assert_false(wr_shape_check(&none, &err));
}

/* A patch with points f(i, j), from separate random seeds. */
static WrShape patch(WrVec3 (*point)(int i, int j))
{
    WrShape shape;
    wr_shape_default(WR_SURFACE_bezier, &shape);
    for (int k = 0; k < 16; k++) {
        WrVec3 p = point(k % 4, k / 4);
        memcpy(shape.value + 3 * k, &p, sizeof p);
    }
    assert_true(wr_shape_check(&shape, NULL));
    return shape;
}

/* A dish over a quarter of a disc: i runs around, j away from the centre. */
static WrVec3 dish_point(int i, int j)
{
    static const double round[4][2] = { { 1, 0 }, { 1, 0.55 }, { 0.55, 1 }, { 0, 1 } };
    static const double away[4] = { 0, 0.4, 0.7, 1 }, high[4] = { 0.5, 0.4, 0.1, 0 };
    return (WrVec3){ round[i][0] * away[j], round[i][1] * away[j], high[j] };
}
static WrVec3 dish_v0(int i, int j)
{
    return dish_point(i, j);
}
static WrVec3 dish_v1(int i, int j)
{
    return dish_point(i, 3 - j);
}
static WrVec3 dish_u0(int i, int j)
{
    return dish_point(j, i);
}
static WrVec3 dish_u1(int i, int j)
{
    return dish_point(j, 3 - i);
}
/* The two inner rows collapsed into one point (Pv = 0 on the edge as well) or into two (Puv = 0). */
static WrVec3 blunt_v0(int i, int j)
{
    return dish_point(i, j == 1 ? 0 : j);
}
static WrVec3 blunt_u1(int i, int j)
{
    return blunt_v0(j, 3 - i);
}
static WrVec3 needle_v0(int i, int j)
{
    WrVec3 p = dish_point(i, j);
    return j == 1 ? (WrVec3){ 0, 0, p.z } : p;
}
static WrVec3 needle_v1(int i, int j)
{
    return needle_v0(i, 3 - j);
}

/* The normal on a collapsed edge is the limit of nearby normals, with an error proportional to the distance, from any
 * point of the edge. (eu, ev) is the edge: 0, 1, or -1 for "along it". */
static void check_edge(const WrShape *shape, double eu, double ev)
{
    for (int i = 1; i < 8; i++) {
        WrSurfacePoint edge, far, near;
        double t = i / 8.0, u = eu < 0 ? t : eu, v = ev < 0 ? t : ev;
        double du = eu < 0 ? 0 : 1 - 2 * eu, dv = ev < 0 ? 0 : 1 - 2 * ev;
        const double step = 0x1p-12;
        wr_surface_at(shape, 0, u, v, &edge);
        wr_surface_at(shape, 0, u + du * step, v + dv * step, &far);
        wr_surface_at(shape, 0, u + du * step / 4, v + dv * step / 4, &near);
        assert_true(edge.n_len == 0);
        assert_near(v3_len(edge.n_unit), 1, 1e-15);
        double a = v3_len(v3_sub(far.n_unit, edge.n_unit));
        double b = v3_len(v3_sub(near.n_unit, edge.n_unit));
        assert_true(a < 0.01 && b < 0.3 * a + 1e-9);
        /* down to the last value that differs from the edge */
        double last = eu == 1 || ev == 1 ? 0x1p-53 : 1e-300;
        wr_surface_at(shape, 0, u + du * last, v + dv * last, &near);
        assert_near(v3_len(v3_sub(near.n_unit, edge.n_unit)), 0, 1e-12);
        WrSurfacePointf f;
        WrSurfacePoint d;
        both(shape, 0, (float)u, (float)v, &d, &f);
        assert_near(v3_len(v3_sub(member_f(&f, UNIT), edge.n_unit)), 0, 1e-6);
    }
}

static void hc05_collapsed_bezier_edges_have_the_limiting_normal(void **state)
{
    (void)state;
    WrShape v0 = patch(dish_v0), v1 = patch(dish_v1), u0 = patch(dish_u0), u1 = patch(dish_u1);
    check_edge(&v0, -1, 0);
    check_edge(&v1, -1, 1);
    check_edge(&u0, 0, -1);
    check_edge(&u1, 1, -1);
    /* the rule itself: +(Puv x Pv) at v = 0, -(Puv x Pv) at v = 1 */
    for (int edge = 0; edge < 2; edge++) {
        WrSurfacePoint o;
        wr_surface_at(edge ? &v1 : &v0, 0, 0.3, edge, &o);
        WrVec3 rule = v3_unit(v3_cross(o.puv, o.pv), (WrVec3){ 0, 0, 0 });
        assert_near(v3_len(v3_sub(v3_scale(rule, edge ? -1 : 1), o.n_unit)), 0, 1e-15);
    }
}

static void hc05_also_where_two_rows_are_drawn_together(void **state)
{
    (void)state;
    WrShape one = patch(blunt_v0), other = patch(blunt_u1);
    check_edge(&one, -1, 0);
    check_edge(&other, 1, -1);
    WrShape needle = patch(needle_v0), upper = patch(needle_v1);
    check_edge(&needle, -1, 0);
    check_edge(&upper, -1, 1);
}

static WrVec3 handle_point(int i, int j)
{
    WrVec3 p = { i / 3.0, j / 3.0, 0.1 * i * j };
    if (i == 1 && j == 0) p.x = p.z = 0; /* onto the corner */
    return p;
}

/* Puu, Puv and Pv are not coplanar here: the limit along the diagonal is (Puu + Puv) x Pv. */
static void a_corner_with_coincident_handles_takes_the_limit_along_the_diagonal(void **state)
{
    (void)state;
    WrShape shape = patch(handle_point);
    WrSurfacePoint o, near;
    wr_surface_at(&shape, 0, 0, 0, &o);
    wr_surface_at(&shape, 0, 1e-7, 1e-7, &near);
    assert_true(v3_len(o.pu) == 0 && v3_len(o.pv) > 0);
    assert_near(v3_len(v3_sub(o.n_unit, near.n_unit)), 0, 1e-5);
}

static WrVec3 same_point(int i, int j)
{
    (void)i, (void)j;
    return (WrVec3){ 0.1, 0.7, -0.3 };
}

static void hc06_sixteen_equal_points_give_a_defined_normal(void **state)
{
    (void)state;
    WrShape shape = patch(same_point);
    assert_finite_everywhere(&shape, true);
    WrSurfacePoint o;
    wr_surface_at(&shape, 0, 0.3, 0.8, &o);
    assert_true(o.n_unit.x == 0 && o.n_unit.y == 0 && o.n_unit.z == 1 && o.n_len == 0);
    assert_true(wr_shape_radius(&shape) > 0);
}

static WrVec3 line_point(int i, int j)
{
    return v3_scale((WrVec3){ 0.3, -0.1, 0.7 }, i * 0.31 + j * 0.17 + 0.05 * i * j);
}

static void hc07_a_patch_that_is_a_line_gives_a_defined_normal(void **state)
{
    (void)state;
    WrShape shape = patch(line_point);
    assert_finite_everywhere(&shape, true);
    for (int k = 0; k < 81; k++) {
        WrSurfacePoint o;
        wr_surface_at(&shape, 0, k % 9 / 8.0, k / 9 / 8.0, &o);
        assert_true(o.n_unit.x == 0 && o.n_unit.y == 0 && o.n_unit.z == 1 && o.n_len == 0);
        assert_true(v3_len(o.n_u) == 0 && v3_len(o.n_v) == 0);
    }
}

static WrVec3 long_point(int i, int j)
{
    return (WrVec3){ 1e10 * i + j * 0.2, i * 3e9 + j * 0.7, i * 2e9 - j * 0.5 + 0.1 * i * j };
}

static void hc10_tangents_of_very_different_length_stay_perpendicular_to_n(void **state)
{
    (void)state;
    WrShape shape = patch(long_point);
    TestRandom random = { 8 };
    for (int k = 0; k < 200; k++) {
        WrSurfacePoint o;
        double u = test_random(&random), v = test_random(&random);
        wr_surface_at(&shape, 0, u, v, &o);
        assert_true(v3_len(o.pu) > 1e9 * v3_len(o.pv));
        assert_near(v3_dot(o.n_unit, o.pu) / v3_len(o.pu), 0, 4 * 0x1p-52);
        assert_near(v3_dot(o.n_unit, o.pv) / v3_len(o.pv), 0, 4 * 0x1p-52);
    }
}

/* Pu and Pv, exact in both precisions (multiples of 2^-22 up to 1): an angle of about 2^-20. */
static const WrVec3 nearly_u = { 0.75, -0.5, 0.25 };
static const WrVec3 nearly_v = { 0.75, -0.5 + 0x1p-20, 0.25 + 0x1p-21 };
static WrVec3 nearly_point(int i, int j)
{
    return v3_add(v3_scale(nearly_u, i), v3_scale(nearly_v, j));
}

/* The angle between n and the cross product of the tangents in 64-bit mantissas. */
static double angle_to_reference(WrVec3 n)
{
    WrVec3 a = nearly_u, b = nearly_v;
    long double x = (long double)a.y * b.z - (long double)a.z * b.y;
    long double y = (long double)a.z * b.x - (long double)a.x * b.z;
    long double z = (long double)a.x * b.y - (long double)a.y * b.x;
    long double cx = y * n.z - z * n.y, cy = z * n.x - x * n.z, cz = x * n.y - y * n.x;
    return (double)(sqrtl(cx * cx + cy * cy + cz * cz) / sqrtl(x * x + y * y + z * z));
}

static void hc11_nearly_parallel_tangents_keep_what_precision_allows(void **state)
{
    (void)state;
    WrShape shape = patch(nearly_point);
    double sine = v3_len(v3_cross(nearly_u, nearly_v)) / v3_len(nearly_u) / v3_len(nearly_v);
    assert_true(sine > 3e-7 && sine < 3e-6);
    WrSurfacePoint o;
    WrSurfacePointf of;
    for (int corner = 0; corner < 4; corner++) {
        both(&shape, 0, (float)(corner % 2), (float)(corner / 2), &o, &of);
        assert_near(angle_to_reference(o.n_unit), 0, 0x1p-52 / sine);
        assert_near(angle_to_reference(member_f(&of, UNIT)), 0, 0x1p-23 / sine);
    }
    wr_surface_at(&shape, 0, 0.3, 0.6, &o); /* a few more roundings in Pu and Pv */
    assert_near(angle_to_reference(o.n_unit), 0, 8 * 0x1p-52 / sine);
}

/* ---- disc, capsule, superellipsoid ---- */

static void the_disc_faces_up_at_its_centre_and_the_capsule_out_at_its_poles(void **state)
{
    (void)state;
    for (int i = 0; i <= 16; i++) {
        WrShape disc, capsule;
        WrSurfacePoint o;
        WrSurfacePointf of;
        wr_shape_default(WR_SURFACE_disc, &disc);
        wr_shape_default(WR_SURFACE_capsule, &capsule);
        both(&disc, 0, (float)i / 16, 1, &o, &of);
        assert_true(o.n_unit.z == 1 && (double)of.n_unit.z == 1 && v3_len(o.p) == 0);
        capsule.value[1] = i % 3 == 0 ? 0 : 1e-3 * pow(10, i % 7); /* no tube; a bead; a needle */
        for (int pole = 0; pole < 2; pole++) {
            both(&capsule, 0, (float)i / 16, (float)pole, &o, &of);
            const double z = pole ? 1 : -1;
            assert_true(o.n_unit.x == 0 && o.n_unit.y == 0 && o.n_unit.z == z);
            assert_true(of.n_unit.x == 0 && of.n_unit.y == 0 && (double)of.n_unit.z == z);
            wr_surface_at(&capsule, 0, i / 16.0, pole, &o);
            assert_near(o.p.z, z * (capsule.value[0] + capsule.value[1] / 2), 1e-15 * fabs(o.p.z));
        }
        assert_finite_everywhere(&capsule, true);
    }
}

/* Equal steps in v are equal lengths, on the spherical ends and between them. */
static void the_capsule_goes_by_arc_length_and_is_smooth_at_its_joints(void **state)
{
    (void)state;
    WrShape shape;
    wr_shape_default(WR_SURFACE_capsule, &shape);
    shape.value[0] = 0.3712, shape.value[1] = 0.8173;
    const double length = WR_PI * shape.value[0] + shape.value[1];
    const double joint = WR_PI * shape.value[0] / 2 / length;
    for (int side = 0; side < 2; side++) {
        const double v = side ? 1 - joint : joint;
        WrSurfacePoint a, b;
        wr_surface_at(&shape, 0, 0.137, v - 1e-9, &a);
        wr_surface_at(&shape, 0, 0.137, v + 1e-9, &b);
        assert_near(v3_len(v3_sub(a.p, b.p)), 2e-9 * length, 1e-15);
        assert_near(v3_len(v3_sub(a.n_unit, b.n_unit)), 0, 1e-8);
    }
    for (int k = 0; k <= 97; k++) {
        WrSurfacePoint o;
        wr_surface_at(&shape, 0, 0.7, k / 97.0, &o);
        assert_near(v3_len(o.pv), length, 1e-14);
    }
}

static WrShape super(double e1, double e2)
{
    WrShape shape;
    wr_shape_default(WR_SURFACE_superellipsoid, &shape);
    const double value[5] = { 0.813, 1.127, 0.641, e1, e2 };
    memcpy(shape.value, value, sizeof value);
    return shape;
}

static double signed_power(double x, double y)
{
    return x < 0 ? -pow(-x, y) : pow(x, y);
}

/* Barr's normal of a surface point: the gradient of the implicit function. */
static WrVec3 gradient(const WrShape *shape, WrVec3 p)
{
    const double *a = shape->value, e1 = a[3], e2 = a[4];
    const double x = p.x / a[0], y = p.y / a[1], z = p.z / a[2];
    const double round = pow(fabs(x), 2 / e2) + pow(fabs(y), 2 / e2), by = pow(round, e2 / e1 - 1);
    const WrVec3 g = { by * signed_power(x, 2 / e2 - 1) / a[0],
                       by * signed_power(y, 2 / e2 - 1) / a[1],
                       signed_power(z, 2 / e1 - 1) / a[2] };
    return v3_unit(g, (WrVec3){ 0, 0, 1 });
}

static const double forms[] = { 0.1, 0.37, 1, 1.4, 2, 2.71, 3.9, 4 };

static void superellipsoids_are_barrs_and_face_along_his_normal(void **state)
{
    (void)state;
    TestRandom random = { 31 };
    for (int k = 0; k < 64 * 40; k++) {
        const WrShape shape = super(forms[k % 8], forms[k / 8 % 8]);
        const double *a = shape.value, e1 = a[3], e2 = a[4];
        WrSurfacePoint o;
        wr_surface_at(&shape, 0, test_random(&random), test_random(&random), &o);
        const double round = pow(fabs(o.p.x / a[0]), 2 / e2) + pow(fabs(o.p.y / a[1]), 2 / e2);
        assert_near(pow(round, e2 / e1) + pow(fabs(o.p.z / a[2]), 2 / e1), 1, 2e-13);
        assert_near(v3_len(v3_sub(gradient(&shape, o.p), o.n_unit)), 0, 1e-11);
        assert_true(v3_dot(o.n, o.n_unit) > 0);
    }
}

/* Derivatives at random points, with a step much smaller than the distance to the next axis plane. */
static void superellipsoids_of_every_form_have_their_derivatives(void **state)
{
    (void)state;
    TestRandom random = { 32 };
    for (int k = 0; k < 64 * 12; k++) {
        const WrShape shape = super(forms[k % 8], forms[k / 8 % 8]);
        const double u = (k % 4 + 0.1 + 0.8 * test_random(&random)) / 4;
        const double v = (k % 2 + 0.1 + 0.8 * test_random(&random)) / 2, h = 1e-4;
        char what[60];
        snprintf(what, sizeof what, "e1 %g e2 %g", shape.value[3], shape.value[4]);
        expect_derivatives(&shape, u, v, h, 1e-5, what);
    }
}

/* In the axis planes the normal is the limit from the defining side. */
static void hc143_superellipsoids_keep_their_limits_at_the_axes(void **state)
{
    (void)state;
    for (int k = 0; k < 64; k++) {
        const WrShape shape = super(forms[k % 8], forms[k / 8 % 8]);
        assert_finite_everywhere(&shape, true);
        for (int i = 0; i < 3 * 4; i++) {
            const double us[3] = { 0, 0.25, 0.1371 }, vs[4] = { 0, 0.3173, 0.5, 1 };
            const double u = us[i % 3], v = vs[i / 3], near = 1e-13;
            WrSurfacePoint o, from;
            wr_surface_at(&shape, 0, u, v, &o);
            assert_true(all_finite(&o));
            /* Towards where both coordinates are positive; the poles from within. */
            const double du = i % 3 == 1 ? -near : near, dv = v == 1 ? -near : near;
            wr_surface_at(&shape, 0, u + du, v + dv, &from);
            const double e1 = shape.value[3], e2 = shape.value[4];
            /* Normals converge as near^|2/e - 1|; on an edge between cusps there is no common limit at a pole, nor
               where another edge crosses. */
            const bool quick = fabs(2 / e1 - 1) > 0.4 && fabs(2 / e2 - 1) > 0.4;
            const bool many = e2 > 2 && i % 3 < 2 && (i / 3 % 3 == 0 || (e1 > 2 && v == 0.5));
            if ((quick || (e1 == 2 && e2 == 2)) && !many)
                assert_near(v3_len(v3_sub(o.n_unit, from.n_unit)), 0, 2e-5);
        }
        WrSurfacePoint top, arm;
        wr_surface_at(&shape, 0, 0.1371, 1, &top);
        wr_surface_at(&shape, 0, 0, 0.5, &arm);
        if (shape.value[3] < 2) assert_true(top.n_unit.z == 1);
        if (shape.value[3] > 2) assert_true(top.n_unit.z == 0);
        if (shape.value[3] < 2 && shape.value[4] < 2) assert_true(arm.n_unit.x == 1);
    }
}

/* By the divergence theorem: the integral of P . N / 3. V = 2 a b c e1 e2 B(e1/2 + 1, e1) B(e2/2, e2/2). */
static void superellipsoids_have_their_volume(void **state)
{
    (void)state;
    for (int k = 0; k < 64; k++) {
        const WrShape shape = super(forms[k % 8], forms[k / 8 % 8]);
        const double *a = shape.value, e1 = a[3], e2 = a[4];
        enum { ACROSS = 200, UP = 100 };
        double sum = 0;
        for (int i = 0; i < ACROSS * UP; i++) {
            WrSurfacePoint o;
            wr_surface_at(&shape, 0, (i % ACROSS + 0.5) / ACROSS, (i / ACROSS + 0.5) / UP, &o);
            sum += v3_dot(o.p, o.n) / 3 / (ACROSS * UP);
        }
        const double b1 = tgamma(e1 / 2 + 1) * tgamma(e1) / tgamma(1.5 * e1 + 1);
        const double b2 = tgamma(e2 / 2) * tgamma(e2 / 2) / tgamma(e2);
        assert_near(sum / (2 * a[0] * a[1] * a[2] * e1 * e2 * b1 * b2), 1, 6e-3);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hc01_sphere_poles_are_exact_in_both_precisions),
        cmocka_unit_test(hc02_sphere_normals_converge_to_the_pole),
        cmocka_unit_test(hc04_the_cone_has_a_normal_for_each_generator_at_its_tip),
        cmocka_unit_test(hc08_horn_spindle_and_thin_tori_point_away_from_their_tube),
        cmocka_unit_test(hc05_collapsed_bezier_edges_have_the_limiting_normal),
        cmocka_unit_test(hc05_also_where_two_rows_are_drawn_together),
        cmocka_unit_test(a_corner_with_coincident_handles_takes_the_limit_along_the_diagonal),
        cmocka_unit_test(hc06_sixteen_equal_points_give_a_defined_normal),
        cmocka_unit_test(hc07_a_patch_that_is_a_line_gives_a_defined_normal),
        cmocka_unit_test(hc10_tangents_of_very_different_length_stay_perpendicular_to_n),
        cmocka_unit_test(hc11_nearly_parallel_tangents_keep_what_precision_allows),
        cmocka_unit_test(the_disc_faces_up_at_its_centre_and_the_capsule_out_at_its_poles),
        cmocka_unit_test(the_capsule_goes_by_arc_length_and_is_smooth_at_its_joints),
        cmocka_unit_test(superellipsoids_are_barrs_and_face_along_his_normal),
        cmocka_unit_test(superellipsoids_of_every_form_have_their_derivatives),
        cmocka_unit_test(hc143_superellipsoids_keep_their_limits_at_the_axes),
        cmocka_unit_test(superellipsoids_have_their_volume),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
