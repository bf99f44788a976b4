/* Surfaces: derivatives against finite differences, orientation, both precisions, ranges. */
#include "test.h"
#include "surface_points.h"

#include "base/error.h"
#include "base/vec.h"

static double between(TestRandom *random, double low, double high)
{
    return low + (high - low) * test_random(random);
}

/* A shape near the default one with different, ordinary parameters. */
static WrShape random_shape(WrSurfaceKind kind, TestRandom *random)
{
    WrShape shape;
    do {
        wr_shape_default(kind, &shape);
        double *value = shape.value;
        for (const WrSurfaceParam *p = wr_surfaces[kind]->params; p->name; p++) {
            for (int i = 0; i < p->components; i++, value++) {
                if (p->ends[0]) {
                    *value = between(random, 0, 2) < 1 ? p->low : p->high;
                    continue;
                }
                *value *= between(random, 0.7, 1.4);
                if (p->low < 0) *value += between(random, -0.15, 0.15);
            }
        }
    } while (!wr_shape_check(&shape, NULL));
    return shape;
}

/* Not within `far` of the lines where the curl's or the capsule's curvature jumps, nor of a profile's points, where
   its third derivative does. */
static bool smooth_here(const WrShape *shape, double u, double v, double far)
{
    const double *value = shape->value;
    if (shape->kind == WR_SURFACE_curl) return fabs(u + v - value[1]) > far;
    for (int k = 1; shape->kind == WR_SURFACE_revolution && k < shape->data->profile_d.count; k++)
        if (fabs(v - shape->data->profile_d.from[k]) < far) return false;
    if (shape->kind != WR_SURFACE_capsule) return true;
    const double joint = WR_PI * value[0] / 2 / (WR_PI * value[0] + value[1]);
    return fabs(fmin(v, 1 - v) - joint) > far;
}

static WrVec3 difference(const WrShape *shape, int face, double u, double v, double du, double dv,
                         int which)
{
    WrSurfacePoint a, b;
    wr_surface_at(shape, face, u + du, v + dv, &a);
    wr_surface_at(shape, face, u - du, v - dv, &b);
    return v3_scale(v3_sub(member(&a, which), member(&b, which)), 0.5 / (du + dv));
}

/* d member / du (along 0) or dv (along 1) is `derived`: the error of central differences falls by 4 for each halving
 * of the step, down to rounding. */
static void check_derivative(const WrShape *shape, int face, double u, double v, int along,
                             int which, int derived)
{
    const double h = 0x1p-9;
    WrSurfacePoint o;
    wr_surface_at(shape, face, u, v, &o);
    double a = along == 0 ? h : 0, b = along == 0 ? 0 : h;
    WrVec3 coarse = difference(shape, face, u, v, a, b, which);
    WrVec3 fine = difference(shape, face, u, v, a / 2, b / 2, which);
    double error = v3_len(v3_sub(coarse, member(&o, derived)));
    double less = v3_len(v3_sub(fine, member(&o, derived)));
    double size = 1 + v3_len(member(&o, derived)) + v3_len(member(&o, which));
    const char *name = wr_surfaces[shape->kind]->name;
    if (error > 1e-2 * size || less > error / 3.5 + 1e-10 * size)
        fail_msg("%s at %g,%g: %s of %s: errors %g and %g", name, u, v, member_names[derived],
                 member_names[which], error, less);
}

static void every_derivative_meets_central_differences_to_second_order(void **state)
{
    (void)state;
    static const struct {
        int along, which, derived;
    } rules[] = { { 0, P, PU },   { 1, P, PV },   { 0, PU, PUU },  { 1, PU, PUV },
                  { 0, PV, PUV }, { 1, PV, PVV }, { 0, UNIT, NU }, { 1, UNIT, NV } };
    TestRandom random = { 1 };
    for (int kind = 0; kind < WR_SURFACE_COUNT; kind++) {
        for (int trial = 0; trial < 200; trial++) {
            WrShape shape = random_shape((WrSurfaceKind)kind, &random);
            double u = between(&random, 0.02, 0.98), v = between(&random, 0.02, 0.98);
            int face = trial % wr_surfaces[kind]->faces;
            if (!smooth_here(&shape, u, v, 0.01)) continue;
            for (size_t i = 0; i < sizeof rules / sizeof *rules; i++)
                check_derivative(&shape, face, u, v, rules[i].along, rules[i].which,
                                 rules[i].derived);
        }
    }
}

static void n_is_the_cross_product_of_the_tangents(void **state)
{
    (void)state;
    TestRandom random = { 2 };
    for (int kind = 0; kind < WR_SURFACE_COUNT; kind++) {
        for (int trial = 0; trial < 300; trial++) {
            WrShape shape = random_shape((WrSurfaceKind)kind, &random);
            WrSurfacePoint o;
            wr_surface_at(&shape, trial % wr_surfaces[kind]->faces, test_random(&random),
                          test_random(&random), &o);
            double size = v3_len(o.pu) * v3_len(o.pv);
            assert_near(v3_len(v3_sub(o.n, v3_cross(o.pu, o.pv))), 0, 2e-15 * size);
            assert_near(o.n_len, v3_len(o.n), 1e-14 * size);
            assert_near(v3_len(o.n_unit), 1, 1e-15);
            assert_near(v3_len(v3_sub(v3_scale(o.n_unit, o.n_len), o.n)), 0, 4e-15 * size);
            assert_near(v3_dot(o.n_u, o.n_unit), 0, 1e-13 * (1 + v3_len(o.n_u)));
            assert_near(v3_dot(o.n_v, o.n_unit), 0, 1e-13 * (1 + v3_len(o.n_v)));
        }
    }
}

static void normals_point_outward_or_up(void **state)
{
    (void)state;
    TestRandom random = { 3 };
    for (int kind = 0; kind < WR_SURFACE_COUNT; kind++) {
        WrShape shape;
        wr_shape_default((WrSurfaceKind)kind, &shape);
        for (int trial = 0; trial < 100; trial++) {
            WrSurfacePoint o;
            double u = test_random(&random), v = test_random(&random);
            wr_surface_at(&shape, trial % wr_surfaces[kind]->faces, u, v, &o);
            WrVec3 out = { 0, 0, 1 };
            switch ((WrSurfaceKind)kind) {
            case WR_SURFACE_sphere:
            case WR_SURFACE_capsule:
            case WR_SURFACE_superellipsoid:
            case WR_SURFACE_cube: out = o.p; break;
            case WR_SURFACE_cylinder:
            case WR_SURFACE_cone: out = (WrVec3){ o.p.x, o.p.y, 0 }; break;
            case WR_SURFACE_revolution: /* of a vase without its foot: away from its axis */
                if (v > 0.3) out = (WrVec3){ o.p.x, o.p.y, 0 };
                else out = o.p;
                break;
            case WR_SURFACE_torus: { /* away from the ring inside the tube */
                double ring = shape.value[0] / hypot(o.p.x, o.p.y);
                out = (WrVec3){ o.p.x - o.p.x * ring, o.p.y - o.p.y * ring, o.p.z };
                break;
            }
            case WR_SURFACE_curl:
                if (u + v > shape.value[1]) continue; /* rolled over */
                break;
            default: break;
            }
            assert_true(v3_dot(o.n, out) > 0);
            assert_true(v3_dot(o.n_unit, out) > 0);
        }
    }
}

/* Errors in units of float's rounding of the largest value of the member. Sines have an absolute error of 1.2e-7, and
 * second derivatives the square of the first ones'. */
static void single_precision_agrees_with_double(void **state)
{
    (void)state;
    enum { TRIALS = 300 };
    TestRandom random = { 4 };
    for (int kind = 0; kind < WR_SURFACE_COUNT; kind++) {
        WrShape shape = random_shape((WrSurfaceKind)kind, &random);
        double worst[MEMBERS] = { 0 }, size[MEMBERS] = { 0 };
        for (int trial = 0; trial < TRIALS; trial++) {
            float u = (float)test_random(&random), v = (float)test_random(&random);
            if (!smooth_here(&shape, (double)u, (double)v, 1e-5)) continue;
            WrSurfacePoint o;
            WrSurfacePointf of;
            both(&shape, trial % wr_surfaces[kind]->faces, u, v, &o, &of);
            for (int m = 0; m < MEMBERS; m++) {
                worst[m] = fmax(worst[m], v3_len(v3_sub(member(&o, m), member_f(&of, m))));
                size[m] = fmax(size[m], v3_len(member(&o, m)));
            }
        }
        for (int m = 0; m < MEMBERS; m++) {
            if (worst[m] > 32 * 0x1p-24 * size[m])
                fail_msg("%s: %s is off by %g of %g", wr_surfaces[kind]->name, member_names[m],
                         worst[m], size[m]);
        }
    }
}

static void points_are_finite_at_every_edge_and_size(void **state)
{
    (void)state;
    for (int kind = 0; kind < WR_SURFACE_COUNT; kind++) {
        WrShape shape;
        wr_shape_default((WrSurfaceKind)kind, &shape);
        assert_finite_everywhere(&shape, true);
        static const double sizes[] = { 1e-29, 1e-12, 1e12, 1e29 };
        for (int i = 0; i < 4; i++) { /* for these the renderer rescales before the conversion to
                                         float */
            WrShape sized = shape;
            double *value = sized.value;
            for (const WrSurfaceParam *p = wr_surfaces[kind]->params; p->name; p++) {
                for (int k = 0; k < p->components; k++, value++) *value *= p->length ? sizes[i] : 1;
            }
            assert_true(wr_shape_check(&sized, NULL));
            WrSurfacePoint a, b;
            for (int face = 0; face < wr_surfaces[kind]->faces; face++) {
                wr_surface_at(&shape, face, 0.3, 0.6, &a);
                wr_surface_at(&sized, face, 0.3, 0.6, &b);
                assert_true(all_finite(&b));
                assert_near(v3_len(v3_sub(a.n_unit, b.n_unit)), 0, 1e-15);
            }
        }
    }
}

static void closed_surfaces_meet_themselves_bit_for_bit(void **state)
{
    (void)state;
    for (int kind = 0; kind < WR_SURFACE_COUNT; kind++) {
        WrShape shape;
        wr_shape_default((WrSurfaceKind)kind, &shape);
        for (int along = 0; along < 2; along++) {
            WrSurfacePoint a, b;
            double u = along == 0 ? 0 : 0.3, v = along == 0 ? 0.3 : 0;
            wr_surface_at(&shape, 0, u, v, &a);
            wr_surface_at(&shape, 0, along == 0 ? 1 : u, along == 0 ? v : 1, &b);
            bool closed = along == 0 ? wr_surfaces[kind]->closed_u : wr_surfaces[kind]->closed_v;
            for (int m = 0; closed && m < MEMBERS; m++) {
                WrVec3 x = member(&a, m), y = member(&b, m);
                assert_true(x.x == y.x && x.y == y.y && x.z == y.z);
            }
            if (!closed) assert_true(v3_len(v3_sub(a.p, b.p)) > 0.1);
        }
    }
}

static void curling_stretches_nothing(void **state)
{
    (void)state;
    TestRandom random = { 5 };
    for (int trial = 0; trial < 500; trial++) {
        WrShape shape = random_shape(WR_SURFACE_curl, &random);
        WrSurfacePoint o;
        wr_surface_at(&shape, 0, test_random(&random), test_random(&random), &o);
        assert_near(v3_dot(o.pu, o.pu), 1, 1e-15);
        assert_near(v3_dot(o.pv, o.pv), 1, 1e-15);
        assert_near(v3_dot(o.pu, o.pv), 0, 1e-15);
    }
}

static void the_curl_is_smooth_across_its_line(void **state)
{
    (void)state;
    WrShape shape;
    wr_shape_default(WR_SURFACE_curl, &shape);
    WrSurfacePoint a, b;
    double v = shape.value[1] / 2;
    wr_surface_at(&shape, 0, v, v, &a);
    wr_surface_at(&shape, 0, v + 1e-9, v, &b);
    assert_near(v3_len(v3_sub(a.p, b.p)), 0, 2e-9);
    assert_near(v3_len(v3_sub(a.n_unit, b.n_unit)), 0, 1e-8);
    assert_true(v3_len(a.puu) == 0 && v3_len(b.puu) > 3); /* 1/(2R), only past the line */
}

/* Side by side with v up, each vertical face ends where the next begins. */
static void cube_faces_join_and_read_right_from_outside(void **state)
{
    (void)state;
    WrShape shape;
    wr_shape_default(WR_SURFACE_cube, &shape);
    WrSurfacePoint a, b;
    for (int face = 0; face < 4; face++) {
        wr_surface_at(&shape, face, 1, 0.25, &a);
        wr_surface_at(&shape, (face + 1) % 4, 0, 0.25, &b);
        assert_near(v3_len(v3_sub(a.p, b.p)), 0, 1e-15);
        assert_true(a.pv.y > 0 && a.pv.x == 0 && a.pv.z == 0);
    }
    for (int lid = 4; lid < 6;
         lid++) { /* the lid is above the front face, the front above the bottom */
        wr_surface_at(&shape, lid, 0.25, lid == 4 ? 0 : 1, &a);
        wr_surface_at(&shape, 0, 0.25, lid == 4 ? 1 : 0, &b);
        assert_near(v3_len(v3_sub(a.p, b.p)), 0, 1e-15);
    }
}

/* A cell for each face: the same cube, whose (u,v) identify the face. */
static void faces_with_cells_are_the_same_faces(void **state)
{
    (void)state;
    WrShape whole, cells;
    wr_shape_default(WR_SURFACE_cube, &whole);
    cells = whole;
    cells.value[wr_surface_param_offset(WR_SURFACE_cube, "faces")] = 6;
    for (int k = 0; k < 60; k++) {
        const int face = k % 6;
        const double x = k % 7 / 6.0, y = k % 11 / 10.0;
        const double u = (face % 3 + 1 / 32.0 + x * 30 / 32) / 3;
        const double v = (face / 3 + 1 / 32.0 + y * 30 / 32) / 2;
        WrSurfacePoint a, b;
        wr_surface_at(&whole, face, x, y, &a);
        wr_surface_at(&cells, face, u, v, &b);
        assert_near(v3_len(v3_sub(a.p, b.p)), 0, 1e-14);
        assert_near(v3_len(v3_sub(v3_scale(a.pu, 3.2), b.pu)), 0, 1e-14);
        assert_near(v3_len(v3_sub(v3_scale(a.pv, 32 / 15.0), b.pv)), 0, 1e-14);
        assert_near(v3_len(v3_sub(v3_cross(b.pu, b.pv), b.n)), 0, 1e-13);
        assert_near(b.n_len, v3_len(b.n), 1e-13);
        assert_int_equal(wr_surface_face(&cells, 0, u, v), face);
        assert_int_equal(wr_surface_face(&whole, 2, u, v), 2);
    }
    WrError err = { "" };
    assert_true(wr_shape_check(&cells, NULL));
    cells.value[wr_surface_param_offset(WR_SURFACE_cube, "faces")] = 3;
    assert_false(wr_shape_check(&cells, &err));
    assert_non_null(strstr(err.text, "must be 1 or 6"));
}

static void folded_corners_are_refused_and_others_are_not(void **state)
{
    (void)state;
    static const struct {
        double x, y, z;
        bool good;
    } cases[] = { { 0, 0, 0, true },       { -0.5, -0.6, 0, false }, { -1, 0, 0, false },
                  { -0.4, -0.5, 0, true }, { -2, -2, 0.5, true },    { 3, 4, 0, true },
                  { 0, -1.5, 0, false },   { -1, -1, 1e-12, false } };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        WrShape shape;
        WrError err = { "" };
        wr_shape_default(WR_SURFACE_bent, &shape);
        int c = wr_surface_param_offset(WR_SURFACE_bent, "c");
        shape.value[c] = cases[i].x;
        shape.value[c + 1] = cases[i].y;
        shape.value[c + 2] = cases[i].z;
        assert_int_equal(wr_shape_check(&shape, &err), cases[i].good);
        if (!cases[i].good) {
            assert_non_null(strstr(err.text, "bent c"));
            continue;
        }
        for (int k = 0; k < 121; k++) { /* accepted: N is nowhere 0 */
            WrSurfacePoint o;
            wr_surface_at(&shape, 0, k % 11 / 10.0, k / 11 / 10.0, &o);
            assert_true(o.n_len > 1e-3);
        }
    }
}

static void bad_numbers_are_refused_by_name_value_and_range(void **state)
{
    (void)state;
    static const double bad[] = { NAN, INFINITY, -INFINITY, 1e31, -1e31 };
    for (int kind = 0; kind < WR_SURFACE_COUNT; kind++) {
        const WrSurfaceInfo *info = wr_surfaces[kind];
        WrShape shape;
        wr_shape_default((WrSurfaceKind)kind, &shape);
        assert_true(wr_shape_check(&shape, NULL));
        assert_int_equal(wr_surface_find(info->name), kind);
        int offset = 0;
        for (const WrSurfaceParam *p = info->params; p->name; p++) {
            assert_int_equal(wr_surface_param_offset((WrSurfaceKind)kind, p->name), offset);
            for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
                WrShape broken = shape;
                WrError err = { "" };
                broken.value[offset + p->components - 1] = bad[i];
                assert_false(wr_shape_check(&broken, &err));
                assert_non_null(strstr(err.text, info->name));
                assert_non_null(strstr(err.text, p->name));
                assert_non_null(strstr(err.text, "must be"));
            }
            offset += p->components;
        }
    }
    WrError err = { "" };
    WrShape sphere;
    wr_shape_default(WR_SURFACE_sphere, &sphere);
    sphere.value[0] = -2.5;
    assert_false(wr_shape_check(&sphere, &err));
    assert_string_equal(err.text, "sphere R = -2.5: must be 1e-30..1e+30 (radius)");
    sphere.kind = (WrSurfaceKind)77;
    assert_false(wr_shape_check(&sphere, &err));
    assert_int_equal(wr_surface_find("orange"), -1);
    assert_int_equal(wr_surface_param_offset(WR_SURFACE_plane, "R"), -1);
}

static void the_radius_holds_the_surface_and_little_more(void **state)
{
    (void)state;
    TestRandom random = { 6 };
    for (int kind = 0; kind < WR_SURFACE_COUNT; kind++) {
        for (int trial = 0; trial < 4; trial++) {
            WrShape shape = random_shape((WrSurfaceKind)kind, &random);
            WrVec3 centre = wr_shape_centre(&shape);
            double radius = wr_shape_radius(&shape), most = 0;
            for (int k = 0; k <= 101 * 101; k++) {
                WrSurfacePoint o;
                const int face = k % wr_surfaces[kind]->faces;
                const WrSurfaceCell c = wr_surface_cell(&shape, face);
                wr_surface_at(&shape, face, c.u0 + (c.u1 - c.u0) * (k % 101 / 100.0),
                              c.v0 + (c.v1 - c.v0) * (k / 101 / 101.0), &o);
                most = fmax(most, v3_len(v3_sub(o.p, centre)));
            }
            assert_true(most <= radius * (1 + 1e-14));
            assert_true(radius < 1.2 * most);
        }
    }
}

static void scaling_to_single_precision_touches_lengths_alone(void **state)
{
    (void)state;
    WrShape shape;
    WrShapef out;
    wr_shape_default(WR_SURFACE_ribbon, &shape);
    wr_shape_scaled(&shape, 4, &out);
    for (int i = 0; i < 5; i++) {
        double factor = i == 2 || i == 4 ? 1 : 4; /* k and t are counts */
        assert_true(out.value[i] == (float)(shape.value[i] * factor));
    }
    shape.value[0] = 1e30;
    wr_shape_scaled(&shape, 1e30, &out);
    assert_true(isfinite(out.value[0]));
}

/* The sum of N over a surface in its default pose, seen from all sides: for a closed surface the front's and the
   back's contributions cancel, for an open one they do not. Rotations are about the vertical axis, along which cups
   may be open. */
static double sidedness(WrSurfaceKind kind)
{
    const WrSurfaceInfo *info = wr_surfaces[kind];
    WrShape shape;
    WrSurfacePoint point;
    wr_shape_default(kind, &shape);
    WrVec3 sum = { 0 };
    double all = 0;
    for (int face = 0; face < info->faces; face++)
        for (int j = 0; j < 32; j++)
            for (int i = 0; i < 32; i++) {
                wr_surface_at(&shape, face, (i + 0.5) / 32, (j + 0.5) / 32, &point);
                sum = v3_add(sum, point.n);
                all += point.n_len;
            }
    for (int axis = 0; axis < 3; axis++) {
        double a = info->pose_deg[axis] * WR_RAD_PER_DEG, c = cos(a), s = sin(a);
        WrVec3 v = sum;
        sum = axis == 0   ? (WrVec3){ v.x, c * v.y - s * v.z, s * v.y + c * v.z }
              : axis == 1 ? (WrVec3){ c * v.x + s * v.z, v.y, c * v.z - s * v.x }
                          : (WrVec3){ c * v.x - s * v.y, s * v.x + c * v.y, v.z };
    }
    return hypot(sum.x, sum.z) / all;
}

static void open_surfaces_are_those_that_show_a_back(void **state)
{
    (void)state;
    for (int kind = 0; kind < WR_SURFACE_COUNT; kind++) {
        double side = sidedness((WrSurfaceKind)kind);
        if (wr_surfaces[kind]->open != (side > 0.25))
            fail_msg("%s: open is %d, its sides differ by %g", wr_surfaces[kind]->name,
                     wr_surfaces[kind]->open, side);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_derivative_meets_central_differences_to_second_order),
        cmocka_unit_test(n_is_the_cross_product_of_the_tangents),
        cmocka_unit_test(normals_point_outward_or_up),
        cmocka_unit_test(single_precision_agrees_with_double),
        cmocka_unit_test(points_are_finite_at_every_edge_and_size),
        cmocka_unit_test(closed_surfaces_meet_themselves_bit_for_bit),
        cmocka_unit_test(curling_stretches_nothing),
        cmocka_unit_test(the_curl_is_smooth_across_its_line),
        cmocka_unit_test(cube_faces_join_and_read_right_from_outside),
        cmocka_unit_test(faces_with_cells_are_the_same_faces),
        cmocka_unit_test(folded_corners_are_refused_and_others_are_not),
        cmocka_unit_test(bad_numbers_are_refused_by_name_value_and_range),
        cmocka_unit_test(the_radius_holds_the_surface_and_little_more),
        cmocka_unit_test(open_surfaces_are_those_that_show_a_back),
        cmocka_unit_test(scaling_to_single_precision_touches_lengths_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
