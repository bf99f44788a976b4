/* Outlines of shapes as points: areas against closed forms, curves against their formulas. */
#include "test.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "field/field.h"
#include "field/shape_outline.h"

static WrField *table(int w, int h)
{
    return wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
}

/* The shoelace formula, in texels; anticlockwise is positive. */
static double area(const WrField *like, const WrShapeOutline *figure)
{
    double sum = 0;
    for (int i = 0; i < figure->count; i++) {
        WrSelectPoint a = figure->points[i], b = figure->points[(i + 1) % figure->count];
        sum += (a.u * b.v - b.u * a.v) / 2;
    }
    return sum * wr_field_width(like) * wr_field_height(like);
}

static void rectangles_with_round_corners_have_their_area(void **state)
{
    (void)state;
    WrField *like = table(400, 200);
    WrError err;
    static const struct {
        double corner, turn;
    } ways[] = { { 0, 0 }, { 0, 33 }, { 12, 0 }, { 12, -70 }, { 1000, 10 } };
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        WrShapeOutline f;
        assert_true(wr_shape_outline_rectangle(like, (WrSelectPoint){ 0.6, 0.1 },
                                               (WrSelectPoint){ 0.1, 0.5 }, ways[i].corner,
                                               ways[i].turn, 1e-4, &f, &err));
        double r = fmin(ways[i].corner, 40); /* 200 x 80 texels */
        assert_near(area(like, &f), 200 * 80 - (4 - WR_PI) * r * r, 1e-4 * 600);
        assert_true(f.closed);
        double u = 0, v = 0;
        for (int k = 0; k < f.count; k++) {
            u += f.points[k].u / f.count;
            v += f.points[k].v / f.count;
        }
        assert_near(u, 0.35, 1e-9); /* rotated about its centre */
        assert_near(v, 0.3, 1e-9);
        wr_shape_outline_fini(&f);
    }
    wr_field_free(like);
}

static void ellipses_keep_their_area_and_form_when_turned_in_a_cell_that_is_not_square(void **state)
{
    (void)state;
    WrField *like = table(300, 900);
    WrError err;
    WrShapeOutline f;
    assert_true(wr_shape_outline_ellipse(like, (WrSelectPoint){ 0.5, 0.25 },
                                         (WrSelectPoint){ 0.2, 0.1 }, 30, 1e-4, &f, &err));
    assert_near(area(like, &f), WR_PI * 60 * 90, 0.1);
    double sine = 0.5, cosine = sqrt(0.75);
    for (int k = 0; k < f.count; k++) {
        double x = 300 * (f.points[k].u - 0.5), y = 900 * (f.points[k].v - 0.25);
        double a = (x * cosine + y * sine) / 60, b = (y * cosine - x * sine) / 90;
        assert_near(a * a + b * b, 1, 1e-12);
    }
    assert_near(300 * (f.points[0].u - 0.5), 60 * cosine, 1e-9); /* starts at its right end */
    assert_near(900 * (f.points[0].v - 0.25), 60 * sine, 1e-9);  /* anticlockwise, v up */
    wr_shape_outline_fini(&f);
    wr_field_free(like);
}

static WrSelectPoint bezier(const WrSelectPoint p[4], double t)
{
    double s = 1 - t, a = s * s * s, b = 3 * s * s * t, c = 3 * s * t * t, d = t * t * t;
    return (WrSelectPoint){ a * p[0].u + b * p[1].u + c * p[2].u + d * p[3].u,
                            a * p[0].v + b * p[1].v + c * p[2].v + d * p[3].v };
}

/* The distance of a point from the outline's pieces, in texels of a 512 x 256 table. */
static double distance(const WrShapeOutline *f, WrSelectPoint p)
{
    double best = 1e30;
    for (int i = 0; i + 1 < f->count; i++) {
        double ax = 512 * f->points[i].u, ay = 256 * f->points[i].v;
        double bx = 512 * f->points[i + 1].u - ax, by = 256 * f->points[i + 1].v - ay;
        double px = 512 * p.u - ax, py = 256 * p.v - ay, l2 = bx * bx + by * by;
        double t = l2 > 0 ? fmin(1, fmax(0, (px * bx + py * by) / l2)) : 0;
        best = fmin(best, hypot(px - t * bx, py - t * by));
    }
    return best;
}

static void bezier_curves_are_met_within_the_tolerance(void **state)
{
    (void)state;
    WrField *like = table(512, 256);
    WrError err;
    TestRandom random = { 3 };
    for (int round = 0; round < 30; round++) {
        WrSelectPoint p[7];
        WrShapeOutline f;
        double tolerance = round % 2 ? 0.125 : 0.01, worst = 0;
        for (int i = 0; i < 7; i++)
            p[i] = (WrSelectPoint){ 3 * test_random(&random) - 1, 3 * test_random(&random) - 1 };
        assert_true(wr_shape_outline_path(like, p, 7, false, tolerance, &f, &err));
        for (int k = 0; k < 2; k++)
            for (int i = 0; i <= 300; i++)
                worst = fmax(worst, distance(&f, bezier(p + 3 * k, i / 300.0)));
        if (worst > tolerance) fail_msg("round %d: %g texels away", round, worst);
        assert_true(f.count < 1 + 2 * sqrt(4000 / tolerance)); /* and not by excessive points */
        assert_memory_equal(&f.points[0], &p[0], sizeof *p);
        assert_memory_equal(&f.points[f.count - 1], &p[6], sizeof *p);
        wr_shape_outline_fini(&f);
    }
    /* x = 3w t^2 - 2w t^3, y = 3h t (1 - t): the area under it is 3/5 w h */
    WrSelectPoint arch[4] = { { 0, 0 }, { 0, 0.5 }, { 0.25, 0.5 }, { 0.25, 0 } };
    WrShapeOutline f;
    assert_true(wr_shape_outline_path(like, arch, 4, true, 1e-4, &f, &err));
    assert_near(area(like, &f), -0.6 * 128 * 128, 0.1); /* clockwise */
    wr_shape_outline_fini(&f);
    wr_field_free(like);
}

static void shapes_out_of_range_are_refused(void **state)
{
    (void)state;
    WrField *like = table(64, 64);
    WrSelectPoint p[4] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 65 } }, o = { 0, 0 };
    WrError err;
    WrShapeOutline f = { 0 };
    assert_false(wr_shape_outline_rectangle(like, o, (WrSelectPoint){ NAN, 0 }, 0, 0, 1, &f, &err));
    assert_false(wr_shape_outline_rectangle(like, o, p[2], -1, 0, 1, &f, &err));
    assert_false(wr_shape_outline_rectangle(like, o, p[2], 0, INFINITY, 1, &f, &err));
    assert_false(wr_shape_outline_ellipse(like, o, (WrSelectPoint){ -1, 1 }, 0, 1, &f, &err));
    assert_false(wr_shape_outline_ellipse(like, o, p[2], 0, 0, &f, &err));
    assert_false(wr_shape_outline_polygon(p, 2, &f, &err));
    assert_false(wr_shape_outline_polygon(p, 4, &f, &err));
    assert_non_null(strstr(err.text, "65"));
    p[3].v = 1;
    assert_true(wr_shape_outline_polygon(p, 4, &f, &err));
    wr_shape_outline_fini(&f);
    assert_false(wr_shape_outline_path(like, p, 3, false, 1, &f, &err));
    assert_false(wr_shape_outline_path(like, p, 5, false, 1, &f, &err));
    assert_null(f.points);
    wr_field_free(like);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rectangles_with_round_corners_have_their_area),
        cmocka_unit_test(
            ellipses_keep_their_area_and_form_when_turned_in_a_cell_that_is_not_square),
        cmocka_unit_test(bezier_curves_are_met_within_the_tolerance),
        cmocka_unit_test(shapes_out_of_range_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
