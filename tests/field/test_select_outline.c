/* Outlines of selections: closed, on the correct side of the texels, and around the table. */
#include "select_help.h"

static WrOutline outline_of(const WrField *a)
{
    WrError err;
    WrOutline outline = { 0 };
    if (!wr_select_outline(a, &outline, &err)) fail_msg("%s", err.text);
    return outline;
}

/* The point after point k of a loop, the first one's image at the end. */
static WrSelectPoint after(const WrOutline *o, WrOutlineLoop loop, int k)
{
    if (k + 1 < loop.count) return o->points[loop.first + k + 1];
    WrSelectPoint p = o->points[loop.first];
    return (WrSelectPoint){ p.u + loop.wind_u, p.v + loop.wind_v };
}

/* In texels, positive where the loop runs anticlockwise with v up. */
static double loop_area(const WrField *a, const WrOutline *o, int index)
{
    WrOutlineLoop loop = o->loops[index];
    double area = 0.0;
    for (int k = 0; k < loop.count; k++) {
        WrSelectPoint p = o->points[loop.first + k], q = after(o, loop, k);
        area += 0.5 * (p.u * q.v - q.u * p.v);
    }
    return area * wr_field_width(a) * wr_field_height(a);
}

static void fill(WrField *a, int i0, int j0, int i1, int j1, float value)
{
    for (int j = j0; j < j1; j++)
        for (int i = i0; i < i1; i++)
            wr_field_set(a, wrapped(i, wr_field_width(a)), wrapped(j, wr_field_height(a)), value);
}

static void one_texel_has_a_diamond_round_its_centre(void **state)
{
    (void)state;
    WrField *a = periodic(10, 5);
    wr_field_set(a, 3, 1, 1.0f);
    WrOutline o = outline_of(a);
    assert_int_equal(o.loop_count, 1);
    assert_int_equal(o.point_count, 4);
    for (int k = 0; k < 4; k++)
        assert_near(fabs(o.points[k].u * 10 - 3.5) + fabs((1 - o.points[k].v) * 5 - 1.5), 0.5,
                    1e-12);
    assert_near(loop_area(a, &o, 0), 0.5, 1e-12);
    wr_outline_fini(&o);
    wr_field_free(a);
}

/* Each corner is cut by an eighth of a texel. Straight runs are one segment. */
static void a_rectangle_runs_anticlockwise_and_a_hole_clockwise(void **state)
{
    (void)state;
    for (int n = 0; n < 3; n++) { /* in the middle, across one edge, across both */
        WrField *a = table(100, 80, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC);
        int i = n ? 85 : 20, j = n == 2 ? 70 : 10;
        fill(a, i, j, i + 30, j + 20, 1.0f);
        fill(a, i + 10, j + 5, i + 20, j + 10, 0.0f);
        WrOutline o = outline_of(a);
        assert_int_equal(o.loop_count, 2);
        double first = loop_area(a, &o, 0), second = loop_area(a, &o, 1);
        assert_near(fmax(first, second), 600 - 0.5, 1e-9);
        assert_near(fmin(first, second), -(50 - 0.5), 1e-9);
        for (int k = 0; k < 2; k++) {
            assert_true(o.loops[k].count >= 8 && o.loops[k].count <= 9);
            assert_int_equal(o.loops[k].wind_u, 0);
            assert_int_equal(o.loops[k].wind_v, 0);
            WrSelectPoint p = o.points[o.loops[k].first];
            assert_true(p.u >= 0 && p.u < 1 && p.v > 0 && p.v <= 1);
        }
        wr_outline_fini(&o);
        wr_field_free(a);
    }
}

static void a_band_round_the_table_has_two_loops_that_wind(void **state)
{
    (void)state;
    WrField *a = periodic(40, 30), *b = periodic(40, 30);
    fill(a, 0, 5, 40, 9, 1.0f);   /* along u */
    fill(b, 38, 0, 43, 30, 1.0f); /* along v, across the edge */
    WrOutline o = outline_of(a), p = outline_of(b);
    assert_int_equal(o.loop_count, 2);
    assert_int_equal(p.loop_count, 2);
    assert_int_equal(o.loops[0].wind_u + o.loops[1].wind_u, 0);
    assert_int_equal(p.loops[0].wind_v + p.loops[1].wind_v, 0);
    for (int k = 0; k < 2; k++) {
        assert_int_equal(abs(o.loops[k].wind_u), 1);
        assert_int_equal(o.loops[k].wind_v, 0);
        assert_int_equal(abs(p.loops[k].wind_v), 1);
        assert_int_equal(p.loops[k].wind_u, 0);
        /* inside is on the left: the band's lower border runs to the right */
        double v = o.points[o.loops[k].first].v;
        assert_near(v, o.loops[k].wind_u > 0 ? 1 - 9.0 / 30 : 1 - 5.0 / 30, 1e-12);
    }
    wr_outline_fini(&o);
    wr_outline_fini(&p);
    wr_field_free(a);
    wr_field_free(b);
}

static void a_clamped_table_selected_whole_is_outlined_along_its_edge(void **state)
{
    (void)state;
    const int sizes[][2] = { { 1, 1 }, { 7, 3 }, { 64, 64 }, { 130, 65 } };
    for (int n = 0; n < 4; n++)
        for (int filled = 0; filled < 2; filled++) { /* as a level, and as tiles */
            WrError err;
            WrField *none = table(sizes[n][0], sizes[n][1], WR_WRAP_CLAMP, WR_WRAP_CLAMP);
            WrField *a = filled ? wr_field_share(none) : wr_select_invert(none);
            if (filled) fill(a, 0, 0, sizes[n][0], sizes[n][1], 1.0f);
            WrOutline o = { 0 };
            assert_true(wr_select_outline(a, &o, &err));
            assert_int_equal(o.loop_count, 1);
            assert_near(loop_area(a, &o, 0), sizes[n][0] * sizes[n][1] - 0.5, 1e-9);
            for (int k = 0; k < o.point_count; k++) {
                WrSelectPoint p = o.points[k];
                double x = fmin(fabs(p.u), fabs(1 - p.u)), y = fmin(fabs(p.v), fabs(1 - p.v));
                assert_near(fmin(x, y), 0.0, 1e-12);
            }
            wr_outline_fini(&o);
            wr_field_free(a);
            wr_field_free(none);
        }
}

static void nothing_and_everything_have_no_outline_on_a_periodic_table(void **state)
{
    (void)state;
    WrField *none = periodic(200, 100), *all = wr_select_invert(none);
    WrOutline o = outline_of(none), p = outline_of(all);
    assert_int_equal(o.loop_count + o.point_count + p.loop_count + p.point_count, 0);
    wr_outline_fini(&o);
    wr_outline_fini(&p);
    wr_outline_fini(&p);
    wr_field_free(none);
    wr_field_free(all);
}

static void saddles_are_joined_where_their_mean_is_inside(void **state)
{
    (void)state;
    for (int joined = 0; joined < 2; joined++) {
        WrField *a = table(2, 2, WR_WRAP_CLAMP, WR_WRAP_CLAMP);
        fill(a, 0, 0, 2, 2, joined ? 0.2f : 0.05f);
        wr_field_set(a, 0, 0, 0.9f);
        wr_field_set(a, 1, 1, 0.9f);
        WrOutline o = outline_of(a);
        assert_int_equal(o.loop_count, joined ? 1 : 2);
        wr_outline_fini(&o);
        wr_field_free(a);
    }
}

/* Number of neighbours on either side of 1/2. */
static int passages(const WrField *a)
{
    int count = 0, width = wr_field_width(a), height = wr_field_height(a);
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++) {
            bool here = wr_field_get(a, i, j) >= 0.5f;
            count += here != (wr_field_get(a, (i + 1) % width, j) >= 0.5f);
            count += here != (wr_field_get(a, i, (j + 1) % height) >= 0.5f);
        }
    return count;
}

/* The bilinear surface through the centres, x, y in texels from the first centre. */
static double bilinear(const WrField *a, double x, double y)
{
    int width = wr_field_width(a), height = wr_field_height(a);
    int i = (int)floor(x), j = (int)floor(y), i1 = wrapped(i + 1, width),
        j1 = wrapped(j + 1, height);
    double s = x - i, t = y - j;
    i = wrapped(i, width);
    j = wrapped(j, height);
    return (1 - t) * ((1 - s) * wr_field_get(a, i, j) + s * wr_field_get(a, i1, j)) +
           t * ((1 - s) * wr_field_get(a, i, j1) + s * wr_field_get(a, i1, j1));
}

static void every_passage_of_noise_is_on_one_closed_loop(void **state)
{
    (void)state;
    const int sizes[][2] = { { 1, 1 }, { 1, 8 }, { 2, 2 }, { 3, 2 }, { 64, 64 }, { 150, 70 } };
    TestRandom random = { 61 };
    for (int n = 0; n < 6; n++) {
        int width = sizes[n][0], height = sizes[n][1];
        WrField *a = periodic(width, height);
        for (int j = 0; j < height; j++)
            for (int i = 0; i < width; i++) wr_field_set(a, i, j, (float)test_random(&random));
        WrOutline o = outline_of(a);
        if (height > 2 && width > 2) assert_int_equal(o.point_count, passages(a)); /* none joined */
        int total = 0;
        for (int index = 0; index < o.loop_count; index++) {
            WrOutlineLoop loop = o.loops[index];
            assert_int_equal(loop.first, total);
            total += loop.count;
            for (int k = 0; k < loop.count; k++) {
                WrSelectPoint p = o.points[loop.first + k], q = after(&o, loop, k);
                double x = p.u * width - 0.5, y = (1 - p.v) * height - 0.5;
                assert_near(bilinear(a, x, y), 0.5, 1e-6);
                assert_near(fmin(fabs(x - rint(x)), fabs(y - rint(y))), 0.0, 1e-9);
                if (width > 2) assert_true(fabs(q.u - p.u) * width <= 1 + 1e-9);
                if (height > 2) assert_true(fabs(q.v - p.v) * height <= 1 + 1e-9);
            }
        }
        assert_int_equal(total, o.point_count);
        wr_outline_fini(&o);
        wr_field_free(a);
    }
}

static void an_outline_too_fine_to_draw_is_refused(void **state)
{
    (void)state;
    WrField *a = periodic(1500, 1500);
    WrError err;
    WrOutline o = { .point_count = 77 };
    for (int j = 0; j < 1500; j++)
        for (int i = 0; i < 1500; i++)
            if ((i ^ j) & 1) wr_field_set(a, i, j, 1.0f);
    assert_false(wr_select_outline(a, &o, &err));
    assert_non_null(strstr(err.text, "4194304"));
    assert_int_equal(o.point_count, 77);
    wr_field_free(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_texel_has_a_diamond_round_its_centre),
        cmocka_unit_test(a_rectangle_runs_anticlockwise_and_a_hole_clockwise),
        cmocka_unit_test(a_band_round_the_table_has_two_loops_that_wind),
        cmocka_unit_test(a_clamped_table_selected_whole_is_outlined_along_its_edge),
        cmocka_unit_test(nothing_and_everything_have_no_outline_on_a_periodic_table),
        cmocka_unit_test(saddles_are_joined_where_their_mean_is_inside),
        cmocka_unit_test(every_passage_of_noise_is_on_one_closed_loop),
        cmocka_unit_test(an_outline_too_fine_to_draw_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
