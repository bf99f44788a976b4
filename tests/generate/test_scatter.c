/* Layouts of solids: along a path and by chance; and how copies that overlap are joined. */
#include "test.h"
#include "generate_help.h"

#include "generate/solid_places.h"

#define SIZE 256.0

static const WrGenerator *sphere(void)
{
    return wr_generator_find("solid", "sphere");
}

/* ---- chance ---- */

static double torus_distance(const double *p, const double *q, double width, double height)
{
    double x = fabs(p[0] - q[0]), y = fabs(p[1] - q[1]);
    x = fmin(x, width - x);
    y = fmin(y, height - y);
    return sqrt(x * x + y * y);
}

/* No two are nearer than the distance, over the seam too; and there is no room for one more, save for thin gaps. Discs of half the
   distance cannot be denser than hexagons: count <= area 2 / (sqrt(3) d^2); discs of 1.2 d cover all: count >= area / (pi 1.44 d^2). */
static void points_by_chance_keep_their_distance_and_leave_no_gap(void **state)
{
    (void)state;
    static const double tables[][3] = { { 256, 192, 13.7 }, { 100, 300, 31.3 }, { 40, 40, 55 } };
    for (int t = 0; t < 3; t++) {
        const double w = tables[t][0], h = tables[t][1], d = tables[t][2];
        double(*xy)[2], (*again)[2];
        int64_t count, same;
        WrError err;
        assert_true(wr_chance_points(w, h, true, true, d, 7 + (uint32_t)t, &xy, &count, &err));
        assert_true(wr_chance_points(w, h, true, true, d, 7 + (uint32_t)t, &again, &same, &err));
        assert_int_equal(count, same);
        assert_memory_equal(xy, again, (size_t)count * sizeof *xy);
        int over = 0;
        for (int64_t i = 0; i < count; i++)
            for (int64_t k = 0; k < i; k++) {
                const double apart = torus_distance(xy[i], xy[k], w, h);
                if (apart < d) fail_msg("%g apart, not %g", apart, d);
                over += apart < 1.5 * d && fabs(xy[i][0] - xy[k][0]) > 0.5 * w;
            }
        assert_true(over > 0 || t == 2); /* neighbours over the seam */
        assert_true((double)count <= w * h * 2.0 / (sqrt(3.0) * d * d) || count == 1);
        double widest = 0.0;
        for (double y = 0.5; y < h; y += 1.0)
            for (double x = 0.5; x < w; x += 1.0) {
                double nearest = INFINITY;
                const double p[2] = { x, y };
                for (int64_t i = 0; i < count; i++)
                    nearest = fmin(nearest, torus_distance(p, xy[i], w, h));
                widest = fmax(widest, nearest);
            }
        if (widest > 1.2 * d) fail_msg("a gap of %g distances", widest / d);
        wr_free(xy);
        wr_free(again);
    }
}

static void a_table_that_ends_has_points_inside_only(void **state)
{
    (void)state;
    double(*xy)[2];
    int64_t count;
    WrError err;
    assert_true(wr_chance_points(90, 70, false, false, 11, 3, &xy, &count, &err));
    bool met = false;
    for (int64_t i = 0; i < count; i++) {
        assert_true(xy[i][0] >= 0.0 && xy[i][0] < 90.0 && xy[i][1] >= 0.0 && xy[i][1] < 70.0);
        for (int64_t k = 0; k < i; k++) {
            assert_true(hypot(xy[i][0] - xy[k][0], xy[i][1] - xy[k][1]) >= 11.0);
            met = met || torus_distance(xy[i], xy[k], 90, 70) < 11.0;
        }
    }
    assert_true(met); /* the ends are free of each other */
    wr_free(xy);
    assert_false(wr_chance_points(16384, 16384, true, true, 0.5, 3, &xy, &count, &err));
    assert_non_null(strstr(err.text, "spacing="));
}

static WrField *made_at(const char *name, double value, double u)
{
    const Setting settings[] = { { "radius", 9.3 }, { "spacing", 23.7 }, { "vary", 0.3 },
                                 { "deep", 4 },     { "at", u },         { name, value },
                                 { NULL, 0 } };
    WrField *like = table_of(256, 128), *f = made_with("solid", "sphere", settings, like);
    wr_field_free(like);
    return f;
}

static void a_moved_origin_is_a_rolled_table(void **state)
{
    (void)state;
    static const Setting layouts[] = { { "layout", 1 }, { "layout", 2 }, { "join", 1 } };
    for (int i = 0; i < 3; i++) {
        WrField *a = made_at(layouts[i].name, layouts[i].value, 0.5);
        WrField *b = made_at(layouts[i].name, layouts[i].value, 0.5 + 101.0 / 256.0);
        assert_true(is_rolled(a, b, 101, 0));
        assert_false(is_rolled(a, b, 100, 0));
        wr_field_free(a);
        wr_field_free(b);
    }
}

/* ---- paths ---- */

static int64_t places_on(const double *points, int count, bool closed, double spacing,
                         WrSolidPlace **places)
{
    WrParamValue values[WR_GENERATOR_PARAMS];
    WrField *like = table_of((int)SIZE, (int)SIZE);
    const WrGenerateJob job = { .like = like };
    const WrParams params = { sphere()->params, values };
    int64_t made;
    WrError err;
    wr_generator_defaults(sphere(), values);
    *value_of(sphere(), values, "points") = (WrParamValue){ .points = points, .count = count };
    value_of(sphere(), values, "closed")->number[0] = closed;
    value_of(sphere(), values, "spacing")->number[0] = spacing;
    if (!wr_solid_places(&params, &job, places, &made, &err)) fail_msg("%s", err.text);
    wr_field_free(like);
    return made;
}

/* A straight path of 0.5 x 256 = 128 texels: round(128 / 19.3) = 7 gaps, from end to end. */
static void copies_on_a_straight_path_stand_at_equal_distances(void **state)
{
    (void)state;
    static const double points[] = { 0.2, 0.3, 0.5, 0.7 };
    WrSolidPlace *places;
    assert_int_equal(places_on(points, 2, false, 19.3, &places), 8);
    for (int i = 0; i < 8; i++) {
        const double t = i / 7.0;
        assert_true(fabs(places[i].at[0] + 0.5 - SIZE * (0.2 + 0.3 * t)) < 1e-4);
        assert_true(fabs(places[i].at[1] + 0.5 - SIZE * (0.7 - 0.4 * t)) < 1e-4);
        /* its x axis, y up, along (0.3, 0.4) / 0.5 */
        assert_true(fabs(places[i].turn[0] - 0.6) < 1e-6);
        assert_true(fabs(places[i].turn[3] - 0.8) < 1e-6);
    }
    wr_free(places);
}

/* Points of a circle: a Catmull-Rom curve through 24 of them is within 1e-3 of its radius, so that equal arcs are equal angles. */
static void copies_on_a_closed_path_close(void **state)
{
    (void)state;
    double points[48];
    WrSolidPlace *places;
    for (int i = 0; i < 24; i++) {
        points[2 * i] = 0.5 + 0.3 * cos(M_PI * i / 12.0);
        points[2 * i + 1] = 0.5 + 0.3 * sin(M_PI * i / 12.0);
    }
    const double radius = 0.3 * SIZE, around = 2.0 * M_PI * radius;
    const int count = (int)places_on(points, 24, true, around / 17.2, &places);
    assert_int_equal(count, 17);
    for (int i = 0; i < count; i++) {
        const double *p = places[i].at, *q = places[(i + 1) % count].at;
        const double chord = 2.0 * radius * sin(M_PI / count);
        if (fabs(hypot(p[0] - q[0], p[1] - q[1]) - chord) > 0.01 * chord)
            fail_msg("%d: %g, not %g", i, hypot(p[0] - q[0], p[1] - q[1]), chord);
    }
    wr_free(places);
}

/* ---- joining ---- */

/* Two spheres of radius r, a apart: between them both have the height sqrt(r^2 - a^2 / 4). */
static double saddle(int join, double melt)
{
    const Setting settings[] = { { "radius", 40 }, { "across", 2 },  { "spacing", 48 },
                                 { "height", 40 }, { "join", join }, { "melt", melt },
                                 { NULL, 0 } };
    WrField *like = table_of(257, 129), *f = made_with("solid", "sphere", settings, like);
    const double h = (double)wr_field_get(f, 128, 64);
    wr_field_free(like);
    wr_field_free(f);
    return h;
}

static void overlapping_copies_are_joined_as_said(void **state)
{
    (void)state;
    const double z = sqrt(40.0 * 40.0 - 24.0 * 24.0), k = 7.3;
    assert_true(fabs(saddle(0, k) - z) < 1e-4);
    assert_true(fabs(saddle(2, k) - 2.0 * z) < 1e-4);
    assert_true(fabs(saddle(1, k) - k * log(2.0 * exp(z / k) - 1.0)) < 1e-4);
    assert_true(fabs(saddle(1, 0.01) - z) < 0.01);
    assert_true(fabs(saddle(1, 16000) - 2.0 * z) < 0.2);
}

static void too_many_over_one_another_are_refused(void **state)
{
    (void)state;
    WrParamValue values[WR_GENERATOR_PARAMS];
    WrField *like = table_of(64, 64);
    const WrGenerateJob job = { .like = like };
    WrRelief relief = { NULL, NULL };
    WrError err = { "" };
    wr_generator_defaults(sphere(), values);
    value_of(sphere(), values, "across")->number[0] = 20;
    value_of(sphere(), values, "rows")->number[0] = 20;
    value_of(sphere(), values, "join")->number[0] = 1;
    assert_false(wr_generator_make(sphere(), values, &job, &relief, &err));
    assert_non_null(strstr(err.text, "join=max"));
    wr_field_free(like);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_by_chance_keep_their_distance_and_leave_no_gap),
        cmocka_unit_test(a_table_that_ends_has_points_inside_only),
        cmocka_unit_test(a_moved_origin_is_a_rolled_table),
        cmocka_unit_test(copies_on_a_straight_path_stand_at_equal_distances),
        cmocka_unit_test(copies_on_a_closed_path_close),
        cmocka_unit_test(overlapping_copies_are_joined_as_said),
        cmocka_unit_test(too_many_over_one_another_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
