/* Profiles of surfaces of revolution: interpolation, smoothness, limits on the axis, refusals. */
#include "test.h"
#include "surface_points.h"

#include "base/error.h"
#include "base/text.h"
#include "surface/data.h"

static WrShape turned(const char *profile)
{
    WrShape shape;
    WrError err = { "" };
    const char *const text[WR_SURFACE_TEXTS] = { profile };
    wr_shape_default(WR_SURFACE_revolution, &shape);
    WrSurfaceData *data = wr_surface_data_make(WR_SURFACE_revolution, text, &err);
    if (!data) fail_msg("%s", err.text);
    wr_shape_borrow_data(&shape, data);
    return shape;
}

static void drop(WrShape *shape)
{
    wr_surface_data_free((WrSurfaceData *)shape->data);
}

static const char vase[] = "0.2137,-0.913;0.7381,-0.317;0.5113,0.271;0.3371,0.613;0.6173,0.977";

/* r, z and their derivatives along v at u = 0. */
static WrSurfacePoint at(const WrShape *shape, double v)
{
    WrSurfacePoint o;
    wr_surface_at(shape, 0, 0, v, &o);
    return o;
}

static void the_curve_goes_through_its_points_with_continuous_curvature(void **state)
{
    (void)state;
    static const double points[5][2] = { { 0.2137, -0.913 },
                                         { 0.7381, -0.317 },
                                         { 0.5113, 0.271 },
                                         { 0.3371, 0.613 },
                                         { 0.6173, 0.977 } };
    WrShape shape = turned(vase);
    const WrProfiled *p = &shape.data->profile_d;
    assert_int_equal(p->count, 4);
    for (int k = 0; k < 5; k++) {
        const double v = k < 4 ? p->from[k] : 1;
        const WrSurfacePoint o = at(&shape, v);
        assert_near(o.p.x, points[k][0], 1e-15);
        assert_near(o.p.z, points[k][1], 1e-15);
        if (k == 0 || k == 4) { /* straight at the ends */
            assert_near(v3_len(o.pvv), 0, 1e-11);
            continue;
        }
        const WrSurfacePoint before = at(&shape, v - 1e-10);
        assert_near(v3_len(v3_sub(before.pv, o.pv)), 0, 1e-7);
        assert_near(v3_len(v3_sub(before.pvv, o.pvv)), 0, 1e-6);
    }
    drop(&shape);
}

/* Against differences of the points, also across corners' pieces. */
static void derivatives_meet_differences(void **state)
{
    (void)state;
    const char *const profiles[] = { vase, "0,-1.1;0.813,-0.7;0,0.9",
                                     "0,0;0,0;0.613,0.317;0.613,0.317;0.4,1.2;0.9,1.7",
                                     "0.5,0;0.9,-0.3;1.2,0;0.9,0.3;0.5,0" };
    TestRandom random = { 41 };
    for (int k = 0; k < 4 * 100; k++) {
        WrShape shape = turned(profiles[k % 4]);
        const WrProfiled *p = &shape.data->profile_d;
        const int piece = k / 4 % p->count;
        const double u = test_random(&random), h = 1e-4;
        const double v =
            p->from[piece] + (0.1 + 0.8 * test_random(&random)) * (p->to[piece] - p->from[piece]);
        expect_derivatives(&shape, u, v, h, 1e-7, profiles[k % 4]);
        assert_near(v3_len(v3_sub(v3_cross(at(&shape, v).pu, at(&shape, v).pv), at(&shape, v).n)),
                    0, 1e-14 * (1 + v3_len(at(&shape, v).pv) * v3_len(at(&shape, v).pu)));
        drop(&shape);
    }
}

/* HC144: an end on the axis is a pole, doubled it is a tip. */
static void hc144_poles_are_single_and_tips_have_a_normal_for_each_generator(void **state)
{
    (void)state;
    WrShape egg = turned("0,-1.1;0.813,-0.7;0,0.9"), tip = turned("0.7,-1;0.7,-1;0,0.8;0,0.8");
    for (int i = 0; i < 16; i++) {
        WrSurfacePoint o;
        WrSurfacePointf of;
        for (int end = 0; end < 2; end++) {
            both(&egg, 0, (float)i / 16, (float)end, &o, &of);
            assert_near(o.n_unit.z, end ? 1 : -1, 1e-15);
            assert_near((double)of.n_unit.z, end ? 1 : -1, 1e-7);
            assert_true(o.n_len == 0 && o.p.x == 0 && o.p.y == 0);
        }
        wr_surface_at(&tip, 0, i / 16.0, 1, &o);
        assert_near(o.n_unit.z, 0.7 / hypot(0.7, 1.8), 1e-14);
        double s, c;
        wr_sincos_turns(i / 16.0, &s, &c);
        assert_near(o.n_unit.x, 1.8 / hypot(0.7, 1.8) * c, 1e-14);
        assert_near(o.n_unit.y, 1.8 / hypot(0.7, 1.8) * s, 1e-14);
    }
    assert_finite_everywhere(&egg, true);
    assert_finite_everywhere(&tip, true);
    drop(&egg);
    drop(&tip);
}

/* HC145: a piece whose handles coincide with its end, by hand: the limit is that of the second derivatives. */
static void hc145_stationary_ends_take_the_limit_of_their_second_derivatives(void **state)
{
    (void)state;
    WrShape shape = turned("0.3,0;0.9,1.1");
    WrSurfaceData *data = (WrSurfaceData *)shape.data;
    const double r[4] = { 0.3, 0.3, 0.7, 0.9 }, z[4] = { 0, 0, 0.2, 1.1 };
    for (int end = 0; end < 2; end++) {
        for (int i = 0; i < 4; i++) {
            data->profile_d.r[i] = r[end ? 3 - i : i];
            data->profile_d.z[i] = -z[end ? 3 - i : i] * (end ? 1 : -1);
        }
        wr_profile_narrow(&data->profile_d, &data->profile_f);
        const WrSurfacePoint o = at(&shape, end), near = at(&shape, end ? 1 - 1e-8 : 1e-8);
        assert_near(v3_len(o.pv), 0, 0);
        assert_near(v3_len(v3_sub(o.n_unit, near.n_unit)), 0, 1e-6);
        WrSurfacePoint both_d;
        WrSurfacePointf both_f;
        both(&shape, 0, 0.25f, (float)end, &both_d, &both_f);
        assert_true(all_finite(&both_d) && all_finite_f(&both_f));
    }
    drop(&shape);
}

static void a_point_given_twice_is_a_corner_and_a_ring_has_none(void **state)
{
    (void)state;
    double v[8];
    WrShape box = turned("0,0;0.5,0;0.5,0;0.5,0.8;0.5,0.8;0,0.8");
    assert_int_equal(wr_surfaces[WR_SURFACE_revolution]->corners(&box, v, 8), 2);
    assert_near(v[0], 0.5 / 1.8, 1e-15);
    assert_near(v[1], 1.3 / 1.8, 1e-15);
    const WrSurfacePoint wall = at(&box, 0.5), lid = at(&box, 0.9), below = at(&box, v[0] - 1e-9),
                         above = at(&box, v[0]);
    assert_near(wall.n_unit.x, 1, 1e-15);
    assert_near(lid.n_unit.z, 1, 1e-15);
    assert_near(below.n_unit.z, -1, 1e-15);
    assert_near(above.n_unit.x, 1, 1e-15); /* of the two the upper counts */
    drop(&box);
    WrShape ring = turned("0.5,0;0.9,-0.3;1.2,0;0.9,0.3;0.5,0"), vessel = turned(vase);
    assert_int_equal(wr_surfaces[WR_SURFACE_revolution]->corners(&ring, v, 8), 0);
    assert_int_equal(wr_surfaces[WR_SURFACE_revolution]->corners(&vessel, v, 8), 0);
    assert_near(v3_len(v3_sub(at(&ring, 0).pv, at(&ring, 1).pv)), 0, 1e-13);
    assert_near(v3_len(v3_sub(at(&ring, 0).pvv, at(&ring, 1).pvv)), 0, 1e-11);
    drop(&ring);
    drop(&vessel);
}

static void the_radius_and_the_middle_hold_it(void **state)
{
    (void)state;
    static const char *const profiles[] = { vase, "0,5;1,5.5;0,6", "1e-9,0;1e-9,1",
                                            "3e29,0;3e29,1e29" };
    for (int k = 0; k < 4; k++) {
        WrShape shape = turned(profiles[k]);
        const WrVec3 centre = wr_shape_centre(&shape);
        const double radius = wr_shape_radius(&shape);
        double most = 0;
        for (int i = 0; i <= 1000; i++)
            most = fmax(most, v3_len(v3_sub(at(&shape, i / 1000.0).p, centre)));
        assert_true(most <= radius && radius < 1.01 * most);
        drop(&shape);
    }
}

static void what_makes_no_profile_is_refused_with_its_place(void **state)
{
    (void)state;
    static const char *const wrong[][2] = {
        { "", "2 to 65" },
        { "1,0", "2 to 65" },
        { "1,0;", "point 1" },
        { "1,0;2", "point 2" },
        { "1,0;2,x", "point 2" },
        { "1,0;2,1,3", "point 2" },
        { "1,0;-0.1,1", "point 2" },
        { "1,0;nan,1", "point 2" },
        { "1,0;1e31,1", "point 2" },
        { "1,0;1,0", "no extent" },
        { "0,0;0,1", "no extent" },
        { "1,0;1,1;1,1.000001", "points 2 and 3" },
        { "1,0;0,0.5;1,1", "axis at v = 0." },
        { "1,0;0.01,0.5;0.01,1.5;1,2", "crosses the axis at v = 0." },
        { "1,0;1,0;0,0.5;0,0.5;1,1", "touches the axis at v = 0." },
    };
    WrError err;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        const char *const text[WR_SURFACE_TEXTS] = { wrong[i][0] };
        err.text[0] = '\0';
        if (wr_surface_data_make(WR_SURFACE_revolution, text, &err))
            fail_msg("took %s", wrong[i][0]);
        if (!strstr(err.text, wrong[i][1]) || !strstr(err.text, "revolution profile"))
            fail_msg("%s: %s", wrong[i][0], err.text);
    }
    WrText many = { 0 };
    for (int i = 0; i < 66; i++) wr_text_addf(&many, "%s1,%d", i ? ";" : "", i);
    const char *const text[WR_SURFACE_TEXTS] = { wr_text_get(&many) };
    assert_null(wr_surface_data_make(WR_SURFACE_revolution, text, &err));
    assert_non_null(strstr(err.text, "65"));
    wr_text_fini(&many);
}

/* Any bytes: an error, or a surface that is finite everywhere. */
static void noise_is_refused_or_finite(void **state)
{
    (void)state;
    static const char letters[] = "0123456789.,;;,,-e+01 x";
    TestRandom random = { 42 };
    int taken = 0;
    for (int k = 0; k < 40000; k++) {
        char text[40];
        int length = 0;
        const int points = 2 + (int)(test_random(&random) * 3);
        if (k % 2) {
            while (length < 30) text[length++] = letters[(int)(test_random(&random) * 22)];
            text[length] = '\0';
        } else {
            for (int i = 0; i < points; i++)
                length +=
                    snprintf(text + length, sizeof text - (size_t)length, "%s%d,%d", i ? ";" : "",
                             (int)(test_random(&random) * 5), (int)(test_random(&random) * 5));
        }
        const char *const texts[WR_SURFACE_TEXTS] = { text };
        WrSurfaceData *data = wr_surface_data_make(WR_SURFACE_revolution, texts, NULL);
        if (!data) continue;
        WrShape shape;
        wr_shape_default(WR_SURFACE_revolution, &shape);
        wr_shape_borrow_data(&shape, data);
        assert_finite_everywhere(&shape, true);
        drop(&shape);
        taken++;
    }
    assert_true(taken > 1000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_curve_goes_through_its_points_with_continuous_curvature),
        cmocka_unit_test(derivatives_meet_differences),
        cmocka_unit_test(hc144_poles_are_single_and_tips_have_a_normal_for_each_generator),
        cmocka_unit_test(hc145_stationary_ends_take_the_limit_of_their_second_derivatives),
        cmocka_unit_test(a_point_given_twice_is_a_corner_and_a_ring_has_none),
        cmocka_unit_test(the_radius_and_the_middle_hold_it),
        cmocka_unit_test(what_makes_no_profile_is_refused_with_its_place),
        cmocka_unit_test(noise_is_refused_or_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
