/* Selections by height and slope, their combination, growing, shrinking and feathering. */
#include "select_help.h"

#include "base/pool.h"

static WrField *noise(int width, int height, WrWrap wrap_u, WrWrap wrap_v, double low, double high,
                      uint64_t seed)
{
    TestRandom random = { seed };
    WrField *field = table(width, height, wrap_u, wrap_v);
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++)
            wr_field_set(field, i, j, (float)(low + (high - low) * test_random(&random)));
    return field;
}

/* Spots of coverage 0.3, 0.5 and 1 on nothing. */
static WrField *spots(int width, int height, WrWrap wrap_u, WrWrap wrap_v, int count, uint64_t seed)
{
    static const float values[] = { 1.0f, 0.5f, 0.3f };
    TestRandom random = { seed };
    WrField *field = table(width, height, wrap_u, wrap_v);
    for (int n = 0; n < count; n++)
        wr_field_set(field, (int)(test_random(&random) * width),
                     (int)(test_random(&random) * height), values[n % 3]);
    return field;
}

static void a_height_range_has_both_ends_and_a_straight_soft_edge(void **state)
{
    (void)state;
    const float heights[] = { 0.99f, 1.0f, 1.5f, 2.0f, 2.01f, 0.5f, 0.75f, 0.0f, 3.0f, -9.0f };
    const float hard[] = { 0, 1, 1, 1, 0, 0, 0, 0, 0, 0 };
    const float soft[] = { 0.99f, 1, 1, 1, 0.99f, 0.5f, 0.75f, 0, 0, 0 };
    WrField *f = periodic(10, 1);
    WrError err;
    for (int i = 0; i < 10; i++) wr_field_set(f, i, 0, heights[i]);
    WrField *a = good(wr_select_height(f, 1, 2, 0, NULL, &err), &err);
    WrField *b = good(wr_select_height(f, 1, 2, 1, NULL, &err), &err);
    for (int i = 0; i < 10; i++) {
        assert_true(wr_field_get(a, i, 0) == hard[i]);
        assert_near(wr_field_get(b, i, 0), soft[i], 1e-6);
    }
    wr_field_free(a);
    wr_field_free(b);
    wr_field_free(f);
}

static void the_height_of_an_empty_table_is_selected_without_tiles(void **state)
{
    (void)state;
    WrField *f = periodic(16384, 200);
    WrError err;
    WrField *a = good(wr_select_height(f, -1, 1, 0, NULL, &err), &err);
    assert_true(wr_field_level(a) == 1.0f);
    assert_int_equal(wr_field_bytes(a), 0);
    wr_field_free(a);
    wr_field_free(f);
}

/* Rising by 0.3 per column and 0.4 per row: 0.5 per texel. On clamped edges too, since a plane is extrapolated. */
static void the_slope_of_a_plane_is_its_angle_up_to_the_edges(void **state)
{
    (void)state;
    WrField *f = table(70, 20, WR_WRAP_CLAMP, WR_WRAP_CLAMP);
    WrError err;
    for (int j = 0; j < 20; j++)
        for (int i = 0; i < 70; i++) wr_field_set(f, i, j, (float)(0.3 * i + 0.4 * j));
    WrField *a = good(wr_select_slope(f, 2, 44.9, 45.1, 0, NULL, &err), &err);
    assert_all(a, 1.0f);
    wr_field_free(a);
    a = good(wr_select_slope(f, 2, 0, 44.9, 0, NULL, &err), &err);
    assert_all(a, 0.0f);
    wr_field_free(a);
    a = good(wr_select_slope(f, 2 * sqrt(3), 0, 55, 10, NULL, &err), &err); /* 60 degrees */
    for (int i = 0; i < 70; i++) assert_near(wr_field_get(a, i, i % 20), 0.5, 1e-5);
    wr_field_free(a);
    wr_field_free(f);
}

static void a_flat_table_has_slope_zero_and_the_steepest_is_below_ninety(void **state)
{
    (void)state;
    WrField *f = periodic(5, 1);
    WrError err;
    WrField *a = good(wr_select_slope(f, 1, 0, 0, 0, NULL, &err), &err);
    assert_all(a, 1.0f);
    wr_field_free(a);
    wr_field_set(f, 2, 0, 3e38f);
    a = good(wr_select_slope(f, 1e300, 89.999, 90, 0, NULL, &err), &err);
    for (int i = 0; i < 5; i++)
        assert_true(wr_field_get(a, i, 0) == (i == 1 || i == 3 ? 1.0f : 0.0f));
    wr_field_free(a);
    wr_field_free(f);
}

static void ranges_out_of_order_or_not_finite_are_refused(void **state)
{
    (void)state;
    WrField *f = periodic(5, 5);
    const double bad[] = { NAN, INFINITY, -INFINITY };
    WrError err;
    for (int k = 0; k < 3; k++) {
        assert_null(wr_select_height(f, bad[k], 1, 0, NULL, &err));
        assert_null(wr_select_height(f, 0, bad[k], 0, NULL, &err));
        assert_null(wr_select_height(f, 0, 1, bad[k], NULL, &err));
        assert_null(wr_select_slope(f, 1, bad[k], 1, 0, NULL, &err));
        assert_null(wr_select_slope(f, bad[k], 0, 1, 0, NULL, &err));
        assert_null(wr_select_grow(f, bad[k], NULL, &err));
        assert_null(wr_select_shrink(f, bad[k], NULL, &err));
        assert_null(wr_select_feather(f, bad[k], NULL, &err));
    }
    assert_null(wr_select_height(f, 2, 1, 0, NULL, &err));
    assert_non_null(strstr(err.text, "low 2"));
    assert_null(wr_select_height(f, 1, 2, -0.5, NULL, &err));
    assert_non_null(strstr(err.text, "-0.5"));
    assert_null(wr_select_slope(f, 1, -1, 2, 0, NULL, &err));
    assert_null(wr_select_slope(f, 1, 1, 91, 0, NULL, &err));
    assert_non_null(strstr(err.text, "91"));
    assert_null(wr_select_slope(f, 0, 1, 2, 0, NULL, &err));
    assert_null(wr_select_grow(f, -1, NULL, &err));
    assert_null(wr_select_feather(f, -1, NULL, &err));
    wr_field_free(f);
}

static void selections_join_texel_by_texel(void **state)
{
    (void)state;
    WrError err;
    for (int n = 0; n < 4; n++) { /* levels 0 and 1 on either side */
        WrField *a = spots(150, 70, WR_WRAP_PERIODIC, WR_WRAP_CLAMP, 9, 31);
        WrField *b = spots(150, 70, WR_WRAP_PERIODIC, WR_WRAP_CLAMP, 9, 32);
        WrField *left = n & 1 ? wr_select_invert(a) : wr_field_share(a);
        WrField *right = n & 2 ? wr_select_invert(b) : wr_field_share(b);
        for (int mode = 0; mode < WR_SELECT_MODES; mode++) {
            WrField *c = good(wr_select_combine(left, right, (WrSelectMode)mode, &err), &err);
            for (int j = 0; j < 70; j++)
                for (int i = 0; i < 150; i++) {
                    float x = wr_field_get(left, i, j), y = wr_field_get(right, i, j);
                    float expected[] = { y, fmaxf(x, y), fminf(x, 1.0f - y), fminf(x, y) };
                    assert_true(wr_field_get(c, i, j) == expected[mode]);
                }
            wr_field_free(c);
        }
        wr_field_free(a);
        wr_field_free(b);
        wr_field_free(left);
        wr_field_free(right);
    }
}

static void joining_keeps_tiles_that_the_new_selection_does_not_touch(void **state)
{
    (void)state;
    WrError err;
    WrField *a = periodic(256, 256), *b = periodic(256, 256);
    wr_field_set(a, 10, 10, 0.5f);
    wr_field_set(b, 200, 200, 1.0f);
    WrField *c = good(wr_select_combine(a, b, WR_SELECT_ADD, &err), &err);
    assert_ptr_equal(wr_field_tile(c, 0, 0), wr_field_tile(a, 0, 0));
    assert_null(wr_field_tile(c, 1, 1));
    assert_true(wr_field_get(c, 200, 200) == 1.0f);
    wr_field_free(a);
    wr_field_free(b);
    wr_field_free(c);
}

static void no_selection_means_everything(void **state)
{
    (void)state;
    WrError err;
    WrField *b = spots(20, 20, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 9, 33);
    WrField *rest = wr_select_invert(b),
            *all = good(wr_select_height(b, -1, 2, 0, NULL, &err), &err);
    for (int mode = 0; mode < WR_SELECT_MODES; mode++) {
        WrField *c = good(wr_select_combine(NULL, b, (WrSelectMode)mode, &err), &err);
        assert_same_texels(c, mode == WR_SELECT_SUBTRACT ? rest : b);
        wr_field_free(c);
    }
    WrField *c = good(wr_select_combine(all, b, WR_SELECT_SUBTRACT, &err), &err);
    assert_same_texels(c, rest);
    wr_field_free(c);
    wr_field_free(all);
    wr_field_free(rest);
    WrField *other = periodic(20, 21);
    assert_null(wr_select_combine(b, other, WR_SELECT_ADD, &err));
    assert_non_null(strstr(err.text, "20x21"));
    wr_field_free(other);
    wr_field_free(b);
}

/* The nearest target by testing all, with the images on either side. Infinite if there is none. */
static double nearest(const WrField *a, bool inside, int i, int j)
{
    int width = wr_field_width(a), height = wr_field_height(a);
    int images_u = wr_field_wrap_u(a) == WR_WRAP_PERIODIC,
        images_v = wr_field_wrap_v(a) == WR_WRAP_PERIODIC;
    double best = INFINITY;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            if ((wr_field_get(a, x, y) >= 0.5f) != inside) continue;
            for (int k = -images_v; k <= images_v; k++)
                for (int n = -images_u; n <= images_u; n++) {
                    double dx = x + n * width - i, dy = y + k * height - j;
                    best = fmin(best, dx * dx + dy * dy);
                }
        }
    return sqrt(best);
}

static void assert_grown(const WrField *a, double r)
{
    WrError err;
    WrField *grown = good(wr_select_grow(a, r, NULL, &err), &err);
    WrField *shrunk = good(wr_select_shrink(a, r, NULL, &err), &err);
    for (int j = 0; j < wr_field_height(a); j++)
        for (int i = 0; i < wr_field_width(a); i++) {
            double was = wr_field_get(a, i, j);
            double up = fmin(1, fmax(0, r + 1 - nearest(a, true, i, j)));
            double down = fmin(1, fmax(0, nearest(a, false, i, j) - r));
            assert_true(wr_field_get(grown, i, j) == (float)fmax(was, up));
            assert_true(wr_field_get(shrunk, i, j) == (float)fmin(was, down));
        }
    wr_field_free(grown);
    wr_field_free(shrunk);
}

static void growing_and_shrinking_go_by_the_exact_distance(void **state)
{
    (void)state;
    const int sizes[][2] = { { 1, 1 }, { 1, 9 }, { 2, 7 }, { 13, 1 }, { 31, 24 }, { 67, 20 } };
    const double radii[] = { 0.25, 1, 2.5, 7, 100 };
    for (int n = 0; n < 6; n++)
        for (int wrap = 0; wrap < 4; wrap++) {
            int width = sizes[n][0], height = sizes[n][1];
            WrField *few = spots(width, height, (WrWrap)(wrap & 1), (WrWrap)(wrap / 2), 4, 41);
            WrField *most = wr_select_invert(few);
            assert_grown(few, radii[(n + wrap) % 5]);
            assert_grown(most, radii[(n + wrap + 2) % 5]);
            wr_field_free(few);
            wr_field_free(most);
        }
}

static void a_straight_edge_moves_by_the_radius(void **state)
{
    (void)state;
    WrError err;
    WrField *like = periodic(100, 30);
    WrField *a = good(
        wr_select_rectangle(like, texels(like, 90, 0), texels(like, 110, 30), NULL, &err), &err);
    WrField *b = good(wr_select_grow(a, 3.25, NULL, &err), &err);
    WrField *c = good(wr_select_shrink(a, 3.25, NULL, &err), &err);
    assert_near(sum_of(b), 30 * (20 + 2 * 3.25), 1e-3);
    assert_near(sum_of(c), 30 * (20 - 2 * 3.25), 1e-3);
    assert_true(wr_field_get(b, 86, 4) == 0.25f && wr_field_get(b, 13, 4) == 0.25f);
    wr_field_free(a);
    wr_field_free(b);
    wr_field_free(c);
    wr_field_free(like);
}

static void a_rectangle_grown_then_shrunk_has_its_old_outline(void **state)
{
    (void)state;
    WrError err;
    WrField *like = periodic(80, 60);
    WrField *a = good(
        wr_select_rectangle(like, texels(like, 70, 50), texels(like, 95, 68), NULL, &err), &err);
    for (double r = 1; r < 16; r += 3) {
        WrField *b = good(wr_select_grow(a, r, NULL, &err), &err);
        WrField *c = good(wr_select_shrink(b, r, NULL, &err), &err);
        for (int j = 0; j < 60; j++)
            for (int i = 0; i < 80; i++)
                assert_true((wr_field_get(a, i, j) >= 0.5f) == (wr_field_get(c, i, j) >= 0.5f));
        wr_field_free(b);
        wr_field_free(c);
    }
    wr_field_free(a);
    wr_field_free(like);
}

static void nothing_grows_to_nothing_and_everything_stays(void **state)
{
    (void)state;
    WrError err;
    WrField *none = periodic(100, 70), *all = wr_select_invert(none);
    WrField *a = good(wr_select_grow(none, 5, NULL, &err), &err);
    WrField *b = good(wr_select_shrink(all, 5, NULL, &err), &err);
    assert_all(a, 0.0f);
    assert_all(b, 1.0f);
    wr_field_free(a);
    wr_field_free(b);
    wr_field_set(none, 3, 4, 1.0f);
    a = good(wr_select_grow(none, 1e9, NULL, &err), &err);
    assert_all(a, 1.0f);
    wr_field_free(a);
    a = good(wr_select_grow(none, 0, NULL, &err), &err);
    assert_same_texels(a, none);
    wr_field_free(a);
    wr_field_free(none);
    wr_field_free(all);
}

static void feathering_keeps_the_sum_and_gives_a_gaussian(void **state)
{
    (void)state;
    WrError err;
    WrField *a = periodic(128, 96), *none = wr_field_share(a), *all = wr_select_invert(a);
    wr_field_set(a, 2, 95, 1.0f);
    WrField *b = good(wr_select_feather(a, 3, NULL, &err), &err);
    assert_near(sum_of(b), 1.0, 1e-4);
    double top = wr_field_get(b, 2, 95);
    for (int k = 1; k < 8; k++) {
        double expected = top * exp(-k * k / 18.0);
        assert_near(wr_field_get(b, wrapped(2 - k, 128), 95), expected, 1e-3 * top);
        assert_near(wr_field_get(b, 2, wrapped(95 + k, 96)), expected, 1e-3 * top);
    }
    WrField *c = good(wr_select_feather(all, 20, NULL, &err), &err);
    assert_all(c, 1.0f);
    WrField *d = good(wr_select_feather(none, 20, NULL, &err), &err);
    assert_all(d, 0.0f);
    WrField *e = good(wr_select_feather(a, 0, NULL, &err), &err);
    assert_same_texels(e, a);
    WrField *fields[] = { a, b, c, d, e, none, all };
    for (int k = 0; k < 7; k++) wr_field_free(fields[k]);
}

/* Every function of one table. */
static WrField *make(int which, const WrField *a, WrPool *pool)
{
    WrError err;
    switch (which) {
    case 0: return good(wr_select_height(a, 0.2, 0.4, 0.1, pool, &err), &err);
    case 1: return good(wr_select_slope(a, 3, 20, 40, 10, pool, &err), &err);
    case 2: return good(wr_select_grow(a, 1.4, pool, &err), &err);
    case 3: return good(wr_select_shrink(a, 1.2, pool, &err), &err);
    case 4: return good(wr_select_feather(a, 2.5, pool, &err), &err);
    default: return good(wr_select_feather(a, 24, pool, &err), &err);
    }
}

static void rolled_tables_give_rolled_selections_on_any_threads_bit_for_bit(void **state)
{
    (void)state;
    const int threads[] = { 1, 2, 7 };
    WrField *a = noise(190, 140, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, 0.7, 51);
    WrField *moved = rolled(a, 77, -45);
    for (int which = 0; which < 6; which++) {
        WrField *b = make(which, a, NULL), *expected = rolled(b, 77, -45);
        float low, high;
        wr_field_range(b, &low, &high);
        assert_true(low >= 0.0f && high <= 1.0f && high > low);
        for (int k = 0; k < 3; k++) {
            WrPool *pool = wr_pool_new(threads[k]);
            WrField *c = make(which, moved, pool);
            assert_same_texels(c, expected);
            wr_field_free(c);
            wr_pool_free(pool);
        }
        wr_field_free(b);
        wr_field_free(expected);
    }
    wr_field_free(a);
    wr_field_free(moved);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_height_range_has_both_ends_and_a_straight_soft_edge),
        cmocka_unit_test(the_height_of_an_empty_table_is_selected_without_tiles),
        cmocka_unit_test(the_slope_of_a_plane_is_its_angle_up_to_the_edges),
        cmocka_unit_test(a_flat_table_has_slope_zero_and_the_steepest_is_below_ninety),
        cmocka_unit_test(ranges_out_of_order_or_not_finite_are_refused),
        cmocka_unit_test(selections_join_texel_by_texel),
        cmocka_unit_test(joining_keeps_tiles_that_the_new_selection_does_not_touch),
        cmocka_unit_test(no_selection_means_everything),
        cmocka_unit_test(growing_and_shrinking_go_by_the_exact_distance),
        cmocka_unit_test(a_straight_edge_moves_by_the_radius),
        cmocka_unit_test(a_rectangle_grown_then_shrunk_has_its_old_outline),
        cmocka_unit_test(nothing_grows_to_nothing_and_everything_stays),
        cmocka_unit_test(feathering_keeps_the_sum_and_gives_a_gaussian),
        cmocka_unit_test(rolled_tables_give_rolled_selections_on_any_threads_bit_for_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
