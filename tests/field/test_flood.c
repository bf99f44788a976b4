/* Flood fill: the connected region of similar height, against a search that uses only neighbours. */
#include "test.h"

#include "base/error.h"
#include "field/field.h"
#include "field/select.h"

/* Reached texels by repeated passes through the whole table until none is added. */
static void grow_reached(const WrField *f, int x, int y, double tolerance, bool diagonal, bool *in)
{
    int w = wr_field_width(f), h = wr_field_height(f);
    bool wrap_u = wr_field_wrap_u(f) == WR_WRAP_PERIODIC;
    bool wrap_v = wr_field_wrap_v(f) == WR_WRAP_PERIODIC;
    double start = wr_field_get(f, x, y);
    memset(in, 0, (size_t)w * (size_t)h);
    in[y * w + x] = true;
    for (bool grown = true; grown;) {
        grown = false;
        for (int j = 0; j < h; j++)
            for (int i = 0; i < w; i++) {
                if (in[j * w + i] || fabs(wr_field_get(f, i, j) - start) > tolerance) continue;
                for (int d = 0; d < 9; d++) {
                    int di = d % 3 - 1, dj = d / 3 - 1, a = i + di, b = j + dj;
                    if (!diagonal && di && dj) continue;
                    if (wrap_u) a = (a + w) % w;
                    if (wrap_v) b = (b + h) % h;
                    if (a < 0 || b < 0 || a >= w || b >= h || !in[b * w + a]) continue;
                    in[j * w + i] = grown = true;
                }
            }
    }
}

/* Heights of few values, so that regions of all sizes and shapes occur. */
static WrField *random_field(TestRandom *random, int w, int h, WrWrap u, WrWrap v, double dense)
{
    WrField *f = wr_field_new(w, h, u, v, 0, NULL);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++)
            wr_field_set(f, i, j, test_random(random) < dense ? 0.25f : 1.0f);
    return f;
}

static void a_flood_reaches_what_a_search_by_neighbours_reaches(void **state)
{
    (void)state;
    TestRandom random = { 4711 };
    bool in[90 * 90];
    int crossed = 0;
    for (int round = 0; round < 400; round++) {
        int w = 1 + (int)(test_random(&random) * (round % 5 ? 20 : 89));
        int h = 1 + (int)(test_random(&random) * (round % 7 ? 20 : 89));
        WrField *f = random_field(&random, w, h, (WrWrap)(round & 1), (WrWrap)(round >> 1 & 1),
                                  0.35 + 0.4 * test_random(&random));
        int x = (int)(test_random(&random) * w), y = (int)(test_random(&random) * h);
        bool diagonal = round >> 2 & 1;
        double tolerance = round % 11 ? 0.5 : 0.75; /* the larger fills everything */
        WrError err;
        WrField *s = wr_select_flood(f, (x + 0.5) / w, 1 - (y + 0.5) / h, tolerance, diagonal, NULL,
                                     NULL, &err);
        if (!s) fail_msg("%s", err.text);
        grow_reached(f, x, y, tolerance, diagonal, in);
        for (int j = 0; j < h; j++)
            for (int i = 0; i < w; i++)
                if (wr_field_get(s, i, j) != (in[j * w + i] ? 1.0f : 0.0f))
                    fail_msg("round %d, %dx%d: texel %d,%d is %g", round, w, h, i, j,
                             (double)wr_field_get(s, i, j));
        crossed += w > 2 && in[y * w] && in[y * w + w - 1] && !in[y * w + w / 2];
        wr_field_free(s);
        wr_field_free(f);
    }
    assert_true(crossed > 3); /* some crossed the edge */
}

static void a_flood_over_edges_is_the_rolled_table_s_flood_rolled(void **state)
{
    (void)state;
    enum { W = 130, H = 70, DX = 37, DY = 51 };
    TestRandom random = { 12 };
    WrError err;
    WrField *a = random_field(&random, W, H, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.62);
    WrField *b = wr_field_new(W, H, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, &err);
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++)
            wr_field_set(b, (i + DX) % W, (j + DY) % H, wr_field_get(a, i, j));
    int x = 0, y = 0;
    while (wr_field_get(a, x, y) != 0.25f) x++;
    WrField *fa = wr_select_flood(a, (x + 0.5) / W, 1 - (y + 0.5) / H, 0, false, NULL, NULL, &err);
    /* a position beyond the table is wrapped */
    WrField *fb =
        wr_select_flood(b, (x + DX + 0.5) / W, 1 - (y + DY + 0.5) / H, 0, false, NULL, NULL, &err);
    int reached = 0;
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++) {
            assert_true(wr_field_get(fb, (i + DX) % W, (j + DY) % H) == wr_field_get(fa, i, j));
            reached += wr_field_get(fa, i, j) == 1;
        }
    assert_true(reached > 100);
    wr_field_free(a);
    wr_field_free(b);
    wr_field_free(fa);
    wr_field_free(fb);
}

/* A ramp of unit steps: the tolerance is relative to the start, not to each neighbour. */
static void the_tolerance_counts_from_where_it_begins_both_ends_included(void **state)
{
    (void)state;
    WrError err;
    WrField *f = wr_field_new(64, 1, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0, &err);
    for (int i = 0; i < 64; i++) wr_field_set(f, i, 0, (float)i);
    WrField *s = wr_select_flood(f, 20.5 / 64, 0.5, 7, false, NULL, NULL, &err);
    for (int i = 0; i < 64; i++)
        assert_true(wr_field_get(s, i, 0) == (i >= 13 && i <= 27 ? 1.0f : 0.0f));
    wr_field_free(s);
    /* beyond the ends the nearest texel is used */
    s = wr_select_flood(f, -3, 7, 2, false, NULL, NULL, &err);
    for (int i = 0; i < 64; i++) assert_true(wr_field_get(s, i, 0) == (i <= 2 ? 1.0f : 0.0f));
    wr_field_free(s);
    assert_null(wr_select_flood(f, NAN, 0, 1, false, NULL, NULL, &err));
    assert_null(wr_select_flood(f, 0, INFINITY, 1, false, NULL, NULL, &err));
    assert_null(wr_select_flood(f, 0, 0, -1, false, NULL, NULL, &err));
    assert_null(wr_select_flood(f, 0, 0, NAN, false, NULL, NULL, &err));
    wr_field_free(f);
}

/* One region that winds through the whole table, a texel wide. */
static void a_maze_is_followed_to_its_end(void **state)
{
    (void)state;
    enum { N = 301 };
    WrError err;
    WrField *f = wr_field_new(N, N, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0, &err);
    for (int j = 1; j < N; j += 2)
        for (int i = 0; i < N; i++)
            if (i != (j / 2 % 2 ? 0 : N - 1)) wr_field_set(f, i, j, 9);
    WrField *s = wr_select_flood(f, 0.5 / N, 1 - 0.5 / N, 1, false, NULL, NULL, &err);
    for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++)
            assert_true(wr_field_get(s, i, j) == (wr_field_get(f, i, j) == 9 ? 0.0f : 1.0f));
    wr_field_free(s);
    wr_field_free(f);
}

static void a_flat_table_of_the_largest_size_is_reached_wholly(void **state)
{
    (void)state;
    const char *full = getenv("WR_FULL");
    int side = full && *full == '1' ? WR_FIELD_MAX : 2048;
    WrError err;
    WrField *f = wr_field_new(side, side, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 2, &err);
    WrField *s = wr_select_flood(f, 0.3, 0.3, 0, false, NULL, NULL, &err);
    float low, high;
    assert_non_null(s);
    wr_field_range(s, &low, &high);
    assert_true(low == 1 && high == 1);
    wr_field_free(s);
    wr_field_free(f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_flood_reaches_what_a_search_by_neighbours_reaches),
        cmocka_unit_test(a_flood_over_edges_is_the_rolled_table_s_flood_rolled),
        cmocka_unit_test(the_tolerance_counts_from_where_it_begins_both_ends_included),
        cmocka_unit_test(a_maze_is_followed_to_its_end),
        cmocka_unit_test(a_flat_table_of_the_largest_size_is_reached_wholly),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
