/* The slope limit: its bound, maximality (minimality), and the formula it solves. */
#include "test.h"
#include "ops_tables.h"

#include "field/field.h"

enum { BELOW, ABOVE, MEAN };

static const int steps[8][2] = { { 1, 0 }, { -1, 0 }, { 0, 1 },  { 0, -1 },
                                 { 1, 1 }, { -1, 1 }, { 1, -1 }, { -1, -1 } };

/* The neighbour in direction k, if there is one: none beyond a clamped edge. */
static bool neighbour(const WrField *field, int i, int j, int k, float *height)
{
    int x = i + steps[k][0], y = j + steps[k][1];
    bool out_u = x < 0 || x >= wr_field_width(field), out_v = y < 0 || y >= wr_field_height(field);
    if ((out_u && wr_field_wrap_u(field) == C) || (out_v && wr_field_wrap_v(field) == C))
        return false;
    *height = at(field, x, y);
    return true;
}

static float bound(double limit, int k)
{
    return (float)(k < 4 ? limit : limit * sqrt(2.0));
}

/* Largest amount by which a step exceeds the limit. */
static double excess(const WrField *field, double limit)
{
    double most = 0.0;
    for (int j = 0; j < wr_field_height(field); j++)
        for (int i = 0; i < wr_field_width(field); i++)
            for (int k = 0; k < 8; k++) {
                float other, here = wr_field_get(field, i, j);
                if (!neighbour(field, i, j, k, &other)) continue;
                most = fmax(most, (double)here - other - bound(limit, k));
            }
    return most;
}

static const int sizes[][2] = { { 1, 1 }, { 2, 3 }, { 1, 50 }, { 70, 1 }, { 60, 45 }, { 130, 20 } };

static void no_step_is_steeper_than_the_limit(void **state)
{
    (void)state;
    const double limits[] = { 0.0, 0.01, 0.1, 0.4 };
    for (int s = 0; s < 6; s++)
        for (int wraps = 0; wraps < 4; wraps++)
            for (int l = 0; l < 4; l++)
                for (int side = BELOW; side <= MEAN; side++) {
                    WrField *in = noisy_table(sizes[s][0], sizes[s][1], wraps & 1 ? P : C,
                                              wraps & 2 ? P : C, (uint64_t)s);
                    WrField *out = run("slope-limit", in, limits[l], side);
                    assert_true(excess(out, limits[l]) < 1e-7); /* rounding of heights under 1 */
                    wr_field_free(in);
                    wr_field_free(out);
                }
}

/* Each texel has F's height, or is at the bound above a neighbour: raising it would violate one or the other. */
static void no_texel_below_could_be_higher(void **state)
{
    (void)state;
    for (int s = 0; s < 6; s++)
        for (int wraps = 0; wraps < 4; wraps++) {
            double limit = 0.07;
            WrField *in = noisy_table(sizes[s][0], sizes[s][1], wraps & 1 ? P : C,
                                      wraps & 2 ? P : C, (uint64_t)s + 9);
            WrField *out = run("slope-limit", in, limit, BELOW);
            int lowered = 0;
            for (int j = 0; j < sizes[s][1]; j++)
                for (int i = 0; i < sizes[s][0]; i++) {
                    float g = wr_field_get(out, i, j), other;
                    bool held = g == wr_field_get(in, i, j);
                    lowered += !held;
                    assert_true(g <= wr_field_get(in, i, j));
                    for (int k = 0; k < 8 && !held; k++)
                        held = neighbour(out, i, j, k, &other) && g == other + bound(limit, k);
                    assert_true(held);
                }
            assert_true(lowered > 0 || sizes[s][0] * sizes[s][1] < 10);
            wr_field_free(in);
            wr_field_free(out);
        }
}

/* Length of the shortest path by steps of 1 and sqrt(2), on an axis that may wrap. */
static double way(int dx, int dy, int width, int height, bool wrap_u, bool wrap_v)
{
    dx = abs(dx), dy = abs(dy);
    if (wrap_u && width - dx < dx) dx = width - dx;
    if (wrap_v && height - dy < dy) dy = height - dy;
    int less = dx < dy ? dx : dy, more = dx < dy ? dy : dx;
    return more - less + sqrt(2.0) * less;
}

static void it_is_the_least_of_all_cones(void **state)
{
    (void)state;
    enum { W = 41, H = 33 };
    for (int wraps = 0; wraps < 4; wraps++) {
        WrField *in = noisy_table(W, H, wraps & 1 ? P : C, wraps & 2 ? P : C, 3);
        wr_field_set(in, 3, 30, -4.0f); /* a deep hole, with effect on the whole table */
        WrField *out = run("slope-limit", in, 0.05, BELOW);
        for (int p = 0; p < W * H; p += 5) {
            double least = 1e9;
            for (int q = 0; q < W * H; q++) {
                double far = way(p % W - q % W, p / W - q / W, W, H, wraps & 1, wraps & 2);
                least = fmin(least, wr_field_get(in, q % W, q / W) + 0.05 * far);
            }
            assert_near(wr_field_get(out, p % W, p / W), least, 5e-6); /* some 30 roundings at 4 */
        }
        wr_field_free(in);
        wr_field_free(out);
    }
}

static void above_is_below_of_the_table_turned_over_and_mean_is_between(void **state)
{
    (void)state;
    WrField *in = noisy_table(80, 70, P, C, 4), *turned = run("multiply", in, -1);
    WrField *below = run("slope-limit", in, 0.05, BELOW),
            *above = run("slope-limit", in, 0.05, ABOVE);
    WrField *mean = run("slope-limit", in, 0.05, MEAN);
    WrField *turned_below = run("slope-limit", turned, 0.05, BELOW);
    for (int j = 0; j < 70; j++)
        for (int i = 0; i < 80; i++) {
            float low = wr_field_get(below, i, j), high = wr_field_get(above, i, j);
            assert_true(high == -wr_field_get(turned_below, i, j));
            assert_true(low <= wr_field_get(in, i, j) && high >= wr_field_get(in, i, j));
            assert_near(wr_field_get(mean, i, j), 0.5 * (low + high), 3e-8);
        }
    WrField *all[] = { in, turned, below, above, mean, turned_below };
    for (int k = 0; k < 6; k++) wr_field_free(all[k]);
}

static void limiting_twice_changes_nothing_more(void **state)
{
    (void)state;
    for (int side = BELOW; side <= ABOVE; side++) {
        WrField *in = noisy_table(150, 90, P, P, 5), *once = run("slope-limit", in, 0.02, side);
        WrField *twice = run("slope-limit", once, 0.02, side);
        assert_true(same_table(once, twice) && !same_table(once, in));
        wr_field_free(in);
        wr_field_free(once);
        wr_field_free(twice);
    }
}

static void a_step_becomes_a_ramp(void **state)
{
    (void)state;
    WrField *in = flat_table(64, 5, C, P, 0.0f);
    for (int j = 0; j < 5; j++)
        for (int i = 20; i < 64; i++) wr_field_set(in, i, j, 4.0f);
    WrField *below = run("slope-limit", in, 0.5, BELOW),
            *above = run("slope-limit", in, 0.5, ABOVE);
    for (int i = 0; i < 64; i++) {
        double ramp = fmin(4.0, fmax(0.0, 0.5 * (i - 19))),
               early = fmin(4.0, fmax(0.0, 4.0 - 0.5 * (20 - i)));
        assert_true(wr_field_get(below, i, 2) == (float)ramp);
        assert_true(wr_field_get(above, i, 2) == (float)early);
    }
    wr_field_free(in);
    wr_field_free(below);
    wr_field_free(above);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_step_is_steeper_than_the_limit),
        cmocka_unit_test(no_texel_below_could_be_higher),
        cmocka_unit_test(it_is_the_least_of_all_cones),
        cmocka_unit_test(above_is_below_of_the_table_turned_over_and_mean_is_between),
        cmocka_unit_test(limiting_twice_changes_nothing_more),
        cmocka_unit_test(a_step_becomes_a_ramp),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
