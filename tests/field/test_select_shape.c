/* Rectangles, ellipses and lassos: coverage of each texel, across all edges. */
#include "select_help.h"

#include "base/pool.h"

static WrField *rectangle(const WrField *like, double x0, double y0, double x1, double y1)
{
    WrError err;
    return good(wr_select_rectangle(like, texels(like, x0, y0), texels(like, x1, y1), NULL, &err),
                &err);
}

static WrField *ellipse(const WrField *like, double x0, double y0, double x1, double y1)
{
    WrError err;
    return good(wr_select_ellipse(like, texels(like, x0, y0), texels(like, x1, y1), NULL, &err),
                &err);
}

/* xy: [count][2] in texels */
static WrField *lasso(const WrField *like, double (*xy)[2], int count, WrPool *pool)
{
    WrSelectPoint points[64];
    WrError err;
    assert_true(count <= 64);
    for (int i = 0; i < count; i++) points[i] = texels(like, xy[i][0], xy[i][1]);
    return good(wr_select_lasso(like, points, count, pool, &err), &err);
}

static void a_rectangle_on_texel_borders_is_exact(void **state)
{
    (void)state;
    const int sizes[][2] = { { 7, 5 }, { 64, 64 }, { 100, 3 }, { 130, 67 } };
    for (int n = 0; n < 4; n++) {
        WrField *like = periodic(sizes[n][0], sizes[n][1]);
        int i0 = sizes[n][0] / 3, i1 = sizes[n][0] * 2 / 3, j1 = sizes[n][1] - 1;
        WrField *a = rectangle(like, i1, 1, i0, j1), *b = rectangle(like, i0, j1, i1, 1);
        for (int j = 0; j < sizes[n][1]; j++)
            for (int i = 0; i < sizes[n][0]; i++)
                assert_true(wr_field_get(a, i, j) ==
                            (i >= i0 && i < i1 && j >= 1 && j < j1 ? 1.0f : 0.0f));
        assert_same_texels(a, b); /* any two opposite corners */
        wr_field_free(a);
        wr_field_free(b);
        wr_field_free(like);
    }
}

static void a_rectangle_covers_parts_of_texels(void **state)
{
    (void)state;
    WrField *like = periodic(8, 8), *a = rectangle(like, 2.25, 3.5, 2.75, 5.125);
    assert_true(wr_field_get(a, 2, 3) == 0.25f);
    assert_true(wr_field_get(a, 2, 4) == 0.5f);
    assert_true(wr_field_get(a, 2, 5) == 0.0625f);
    assert_true(sum_of(a) == 0.5 * 1.625);
    wr_field_free(a);
    wr_field_free(like);
}

static void a_rectangle_crosses_periodic_edges_and_ends_at_clamped_ones(void **state)
{
    (void)state;
    WrField *like = table(10, 10, WR_WRAP_PERIODIC, WR_WRAP_CLAMP);
    WrField *a = rectangle(like, 8.5, -3, 12, 2);
    for (int j = 0; j < 10; j++)
        for (int i = 0; i < 10; i++) {
            float across = i == 8 ? 0.5f : i == 9 || i < 2 ? 1.0f : 0.0f;
            assert_true(wr_field_get(a, i, j) == (j < 2 ? across : 0.0f));
        }
    wr_field_free(a);
    wr_field_free(like);
}

static void shapes_larger_than_the_table_select_all_of_it(void **state)
{
    (void)state;
    const int sizes[][2] = { { 1, 1 }, { 1, 9 }, { 70, 1 }, { 33, 65 } };
    for (int n = 0; n < 4; n++) {
        double w = sizes[n][0], h = sizes[n][1];
        WrField *like = periodic(sizes[n][0], sizes[n][1]);
        double square[][2] = {
            { -20 * w, 3 }, { 30.5 * w, 3 }, { 30.5 * w, -9 * h }, { -20 * w, -9 * h }
        };
        WrField *a[] = { rectangle(like, 0.3, 0.7, w + 0.3, h + 0.7),
                         rectangle(like, -60 * w, -60 * h, 60 * w, 60 * h),
                         ellipse(like, 0, 0, 9 * w, 9 * h), lasso(like, square, 4, NULL) };
        for (int k = 0; k < 4; k++) assert_all(a[k], 1.0f);
        for (int k = 0; k < 4; k++) wr_field_free(a[k]);
        wr_field_free(like);
    }
}

/* Two ways to compute the same areas. */
static void a_lasso_round_a_rectangle_is_that_rectangle_bit_for_bit(void **state)
{
    (void)state;
    TestRandom random = { 21 };
    for (int n = 0; n < 40; n++) {
        WrField *like = table(5 + n * 3, 40 - n / 2, n % 2 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC,
                              n % 3 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC);
        double x0 = 60 * test_random(&random) - 20, x1 = x0 + 40 * test_random(&random) * (n % 4);
        double y0 = 60 * test_random(&random) - 20, y1 = y0 + 30 * test_random(&random) * (n % 5);
        double ring[][2] = { { x0, y0 }, { x1, y0 }, { x1, y1 }, { x0, y1 } };
        WrField *a = rectangle(like, x0, y0, x1, y1), *b = lasso(like, ring, 4, NULL);
        assert_same_texels(a, b);
        wr_field_free(a);
        wr_field_free(b);
        wr_field_free(like);
    }
}

/* --- Brute force: LINES lines through each row of texels, on each the union of all images' spans. --- */

enum { LINES = 2048, SIDE = 16 };

/* Intersection of a shape with a horizontal line: pairs of x, unrolled; returns the number of values. */
typedef int (*Meet)(const void *shape, double y, double *x);

static int compare_doubles(const void *a, const void *b)
{
    double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

/* Fraction of [i, i + 1] covered by the spans and their images. They overlap, so cut at all ends, and test for each
 * piece whether any image contains its centre. */
static double covered(const double *spans, int count, int i, int width, bool wraps)
{
    double cuts[512], sum = 0.0;
    int cut_count = 0;
    int images = wraps ? 6 : 0;
    cuts[cut_count++] = i;
    cuts[cut_count++] = i + 1;
    for (int s = 0; s < count; s++)
        for (int k = -images; k <= images; k++) {
            double x = spans[s] + k * width;
            if (x > i && x < i + 1 && cut_count < 512) cuts[cut_count++] = x;
        }
    qsort(cuts, (size_t)cut_count, sizeof *cuts, compare_doubles);
    for (int n = 0; n + 1 < cut_count; n++) {
        double middle = 0.5 * (cuts[n] + cuts[n + 1]);
        bool inside = false;
        for (int s = 0; s < count && !inside; s += 2)
            for (int k = -images; k <= images && !inside; k++)
                inside = spans[s] + k * width <= middle && middle < spans[s + 1] + k * width;
        sum += inside ? cuts[n + 1] - cuts[n] : 0.0;
    }
    return sum;
}

/* Tolerance: the lines miss features between two of them; the selection's own bound is 1/256. */
static void assert_covers(const WrField *a, Meet meet, const void *shape)
{
    int width = wr_field_width(a), height = wr_field_height(a);
    bool wrap_u = wr_field_wrap_u(a) == WR_WRAP_PERIODIC;
    int images = wr_field_wrap_v(a) == WR_WRAP_PERIODIC ? 6 : 0;
    for (int j = 0; j < height; j++) {
        double area[SIDE] = { 0 };
        for (int line = 0; line < LINES; line++) {
            double y = j + (line + 0.5) / LINES, spans[512];
            int count = 0;
            for (int k = -images; k <= images; k++)
                count += meet(shape, y + k * height, spans + count);
            if (count == 0) continue;
            for (int i = 0; i < width; i++)
                area[i] += covered(spans, count, i, width, wrap_u) / LINES;
        }
        for (int i = 0; i < width; i++)
            if (!(fabs(area[i] - wr_field_get(a, i, j)) < 1.0 / 256))
                fail_msg("texel %d,%d: %g, should be %g", i, j, wr_field_get(a, i, j), area[i]);
    }
}

typedef struct Polygon {
    double xy[16][2];
    int count;
} Polygon;

static int meet_polygon(const void *shape, double y, double *x)
{
    const Polygon *p = shape;
    int found = 0;
    for (int i = 0; i < p->count; i++) {
        const double *a = p->xy[i], *b = p->xy[(i + 1) % p->count];
        if ((a[1] <= y) != (b[1] <= y))
            x[found++] = a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]);
    }
    qsort(x, (size_t)found, sizeof *x, compare_doubles);
    return found;
}

static void a_lasso_covers_what_dense_lines_find_even_where_it_crosses_itself(void **state)
{
    (void)state;
    TestRandom random = { 22 };
    for (int n = 0; n < 12; n++) {
        WrField *like = table(5 + n % 7, 4 + n % 3, n % 3 == 1 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC,
                              n % 4 == 2 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC);
        double reach = n < 6 ? 1.0 : 2.2; /* in cells: the later ones overlap themselves */
        Polygon p = { .count = 3 + n % 6 };
        for (int i = 0; i < p.count; i++) {
            p.xy[i][0] = (test_random(&random) * reach - 0.3) * wr_field_width(like);
            p.xy[i][1] = (test_random(&random) * reach - 0.3) * wr_field_height(like);
        }
        WrField *a = lasso(like, p.xy, p.count, NULL);
        assert_covers(a, meet_polygon, &p);
        wr_field_free(a);
        wr_field_free(like);
    }
}

typedef struct Ellipse {
    double x, y, rx, ry;
} Ellipse;

static int meet_ellipse(const void *shape, double y, double *x)
{
    const Ellipse *e = shape;
    double t = (y - e->y) / e->ry;
    if (!(t * t < 1.0)) return 0;
    x[0] = e->x - e->rx * sqrt(1.0 - t * t);
    x[1] = e->x + e->rx * sqrt(1.0 - t * t);
    return 2;
}

static void an_ellipse_covers_what_dense_lines_find(void **state)
{
    (void)state;
    const Ellipse ellipses[] = { { 5, 4, 3, 2 },     { 0, 0, 2.5, 2.5 }, { 3.3, 7.7, 0.4, 0.2 },
                                 { 6, 4, 7, 3 },     { 6, 4, 3, 6 },     { 2, 2, 8, 5 },
                                 { 4, 4, 3.9, 0.05 } };
    for (size_t n = 0; n < sizeof ellipses / sizeof *ellipses; n++) {
        Ellipse e = ellipses[n];
        WrField *like = table(11, 8, WR_WRAP_PERIODIC, n == 4 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC);
        WrField *a = ellipse(like, e.x - e.rx, e.y - e.ry, e.x + e.rx, e.y + e.ry);
        assert_covers(a, meet_ellipse, &e);
        wr_field_free(a);
        wr_field_free(like);
    }
}

static void a_large_ellipse_has_the_area_of_one(void **state)
{
    (void)state;
    WrField *like = periodic(700, 500), *a = ellipse(like, 350, -200, 950, 200);
    /* inscribed: at most 1/2048 texel short along the whole circumference, under 1600 texels */
    assert_near(sum_of(a), 3.14159265358979 * 300 * 200, 0.8);
    wr_field_free(a);
    wr_field_free(like);
}

static void polygons_rolled_by_whole_texels_give_rolled_selections_bit_for_bit(void **state)
{
    (void)state;
    TestRandom random = { 23 };
    for (int n = 0; n < 20; n++) {
        WrField *like = periodic(n % 2 ? 48 : 150, n % 3 ? 100 : 33);
        double xy[12][2], moved[12][2];
        int di = (int)(test_random(&random) * 300) - 150,
            dj = (int)(test_random(&random) * 200) - 99;
        double reach = n < 10 ? 0.9 : 2.5;
        for (int i = 0; i < 12; i++) {
            xy[i][0] = floor(test_random(&random) * reach * wr_field_width(like) * 512) / 512;
            xy[i][1] = floor(test_random(&random) * reach * wr_field_height(like) * 512) / 512;
            moved[i][0] = xy[i][0] + di;
            moved[i][1] = xy[i][1] + dj;
        }
        WrField *a = lasso(like, xy, 12, NULL), *b = lasso(like, moved, 12, NULL);
        WrField *c = rolled(a, di, dj);
        assert_same_texels(b, c);
        wr_field_free(a);
        wr_field_free(b);
        a = ellipse(like, xy[0][0], xy[0][1], xy[1][0], xy[1][1]);
        b = ellipse(like, moved[0][0], moved[0][1], moved[1][0], moved[1][1]);
        wr_field_free(c);
        c = rolled(a, di, dj);
        assert_same_texels(b, c);
        wr_field_free(a);
        wr_field_free(b);
        wr_field_free(c);
        wr_field_free(like);
    }
}

static void shapes_have_the_same_bits_on_any_threads_and_in_either_direction(void **state)
{
    (void)state;
    const int threads[] = { 1, 2, 7 };
    WrField *like = periodic(300, 1000);
    double xy[40][2], back[40][2];
    TestRandom random = { 24 };
    for (int i = 0; i < 40; i++) {
        back[39 - i][0] = xy[i][0] = test_random(&random) * 500;
        back[39 - i][1] = xy[i][1] = test_random(&random) * 900;
    }
    WrField *first = lasso(like, back, 40, NULL);
    for (int k = 0; k < 3; k++) {
        WrPool *pool = wr_pool_new(threads[k]);
        WrField *a = lasso(like, xy, 40, pool);
        assert_true(wr_hash_equal(wr_field_hash(a), wr_field_hash(first)));
        wr_field_free(a);
        wr_pool_free(pool);
    }
    wr_field_free(first);
    wr_field_free(like);
}

static void inside_is_where_a_ray_meets_the_lasso_an_odd_number_of_times(void **state)
{
    (void)state;
    WrField *like = periodic(32, 32);
    double twice[8][2];
    double square[][2] = { { 4, 4 }, { 20, 4 }, { 20, 20 }, { 4, 20 } };
    for (int i = 0; i < 8; i++) memcpy(twice[i], square[i % 4], sizeof *twice);
    WrField *a = lasso(like, twice, 8, NULL); /* round it twice */
    assert_all(a, 0.0f);
    wr_field_free(a);
    double bow[][2] = { { 4, 4 }, { 20, 20 }, { 20, 4 }, { 4, 20 } };
    a = lasso(like, bow, 4, NULL); /* two triangles of 64 texels that touch at a point */
    assert_near(sum_of(a), 128.0, 0.01);
    assert_true(wr_field_get(a, 5, 12) == 1.0f && wr_field_get(a, 12, 5) == 0.0f);
    wr_field_free(a);
    wr_field_free(like);
}

static void polygons_without_area_select_nothing(void **state)
{
    (void)state;
    WrField *like = periodic(20, 20);
    double point[][2] = { { 3.2, 3.3 }, { 3.2, 3.3 }, { 3.2, 3.3 } };
    double line[][2] = { { 1, 2 }, { 17, 12 }, { 9, 7 }, { 5, 4.5 } };
    double level[][2] = { { 1, 2 }, { 17, 2 }, { 9, 2 } };
    WrField *a[] = { lasso(like, point, 3, NULL), lasso(like, line, 4, NULL),
                     lasso(like, level, 3, NULL), rectangle(like, 3, 3, 3, 9),
                     ellipse(like, 2, 5, 9, 5) };
    for (int k = 0; k < 5; k++) {
        assert_near(sum_of(a[k]), 0.0, 1e-3); /* points are rounded to 1/65536 texel */
        wr_field_free(a[k]);
    }
    wr_field_free(like);
}

static void repeated_points_change_nothing(void **state)
{
    (void)state;
    WrField *like = periodic(20, 20);
    double once[][2] = { { 1.3, 2.1 }, { 17.4, 12.9 }, { 5.5, 18.2 } };
    double often[][2] = { { 1.3, 2.1 },   { 1.3, 2.1 },  { 17.4, 12.9 },
                          { 17.4, 12.9 }, { 5.5, 18.2 }, { 1.3, 2.1 } };
    WrField *a = lasso(like, once, 3, NULL), *b = lasso(like, often, 6, NULL);
    assert_same_texels(a, b);
    wr_field_free(a);
    wr_field_free(b);
    wr_field_free(like);
}

static void shapes_that_are_not_finite_or_too_far_are_refused(void **state)
{
    (void)state;
    WrField *like = periodic(20, 20);
    const double bad[] = { NAN, INFINITY, -INFINITY, 64.5, -1e300 };
    const WrSelectPoint fine = { 0.1, 0.2 };
    WrSelectPoint three[3] = { { 0, 0 }, { 1, 0 }, { 0, 1 } };
    WrError err;
    for (int k = 0; k < 5; k++) {
        WrSelectPoint p = { 0.5, bad[k] }, q = { bad[k], 0.5 };
        assert_null(wr_select_rectangle(like, fine, p, NULL, &err));
        assert_null(wr_select_rectangle(like, q, fine, NULL, &err));
        assert_null(wr_select_ellipse(like, q, fine, NULL, &err));
        three[1] = p;
        assert_null(wr_select_lasso(like, three, 3, NULL, &err));
        assert_non_null(strstr(err.text, "-64..64"));
    }
    assert_null(wr_select_lasso(like, three, 2, NULL, &err));
    assert_non_null(strstr(err.text, "2 points"));
    assert_null(wr_select_lasso(like, three, WR_SELECT_POINTS + 1, NULL, &err));
    assert_null(wr_select_lasso(like, three, -1, NULL, &err));
    wr_field_free(like);
}

/* A star of many long, mutually crossing sides, larger than the table. */
static void a_wild_lasso_ends_in_time_and_stays_in_range(void **state)
{
    (void)state;
    enum { COUNT = 400 };
    WrSelectPoint points[COUNT];
    WrField *like = periodic(40, 24);
    WrError err;
    TestRandom random = { 25 };
    for (int i = 0; i < COUNT; i++)
        points[i] = (WrSelectPoint){ test_random(&random) * 3 - 1, test_random(&random) * 2 - 1 };
    WrField *a = good(wr_select_lasso(like, points, COUNT, NULL, &err), &err);
    for (int j = 0; j < 24; j++)
        for (int i = 0; i < 40; i++)
            assert_true(wr_field_get(a, i, j) >= 0.0f && wr_field_get(a, i, j) <= 1.0f);
    wr_field_free(a);
    wr_field_free(like);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_rectangle_on_texel_borders_is_exact),
        cmocka_unit_test(a_rectangle_covers_parts_of_texels),
        cmocka_unit_test(a_rectangle_crosses_periodic_edges_and_ends_at_clamped_ones),
        cmocka_unit_test(shapes_larger_than_the_table_select_all_of_it),
        cmocka_unit_test(a_lasso_round_a_rectangle_is_that_rectangle_bit_for_bit),
        cmocka_unit_test(a_lasso_covers_what_dense_lines_find_even_where_it_crosses_itself),
        cmocka_unit_test(an_ellipse_covers_what_dense_lines_find),
        cmocka_unit_test(a_large_ellipse_has_the_area_of_one),
        cmocka_unit_test(polygons_rolled_by_whole_texels_give_rolled_selections_bit_for_bit),
        cmocka_unit_test(shapes_have_the_same_bits_on_any_threads_and_in_either_direction),
        cmocka_unit_test(inside_is_where_a_ray_meets_the_lasso_an_odd_number_of_times),
        cmocka_unit_test(polygons_without_area_select_nothing),
        cmocka_unit_test(repeated_points_change_nothing),
        cmocka_unit_test(shapes_that_are_not_finite_or_too_far_are_refused),
        cmocka_unit_test(a_wild_lasso_ends_in_time_and_stays_in_range),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
