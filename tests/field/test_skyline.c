/* Horizons of lines and tables against brute force and closed forms, and the remaining light. */
#include "test.h"

#include "base/error.h"
#include "base/hash.h"
#include "base/pool.h"
#include "base/vec.h"
#include "field/field.h"
#include "field/horizon.h"

#include <math.h>

#define PI 3.14159265358979323846
#define MAX_MOST 200

static double random_of(int i, int j)
{
    return (double)wr_mix32((uint32_t)(i * 7919 + j * 104729 + 5)) * 0x1p-32;
}

/* The horizon at i of n heights, by checking each of a period. */
static double brute(const double *heights, int n, int i)
{
    double best = 0;
    for (int t = 1; t <= n; t++) best = fmax(best, (heights[(i + t) % n] - heights[i]) / t);
    return best;
}

static void a_line_has_the_slopes_of_brute_force(void **state)
{
    double heights[MAX_MOST], slope[MAX_MOST];
    int hull[2 * MAX_MOST];
    (void)state;
    for (int n = 1; n <= 100; n++)
        for (int kind = 0; kind < 4; kind++) {
            for (int i = 0; i < n; i++)
                heights[i] = kind == 0   ? 2 * random_of(i, n) - 1
                             : kind == 1 ? sin(2 * PI * i / n) + 0.1 * random_of(i, n)
                             : kind == 2 ? floor(3 * random_of(i, n)) /* many equal */
                                         : 0.37 * i;                  /* a ramp over the seam */
            wr_horizon_line(heights, n, slope, hull);
            for (int i = 0; i < n; i++) assert_near(slope[i], brute(heights, n, i), 1e-12);
        }
}

/* From its lowest point a trough A cos 2 pi x is seen at tan(y / 2) = y. */
static void a_trough_has_its_closed_form(void **state)
{
    enum { N = 20000 };
    static double heights[N], slope[N];
    static int hull[2 * N];
    (void)state;
    for (int i = 0; i < N; i++) heights[i] = 0.7 * cos(2 * PI * i / N);
    wr_horizon_line(heights, N, slope, hull);
    assert_near(slope[N / 2] * N, 2 * PI * 0.7 * 0.724611, 1e-5);
    for (int i = 0; i < N; i++)
        if (slope[i] > slope[N / 2] * (1 + 1e-9)) return;
    fail_msg("points of the slope look up no steeper than the floor");
}

static double waves(double x, double y)
{
    return 3 * sin(2 * PI * x) + 2 * cos(2 * PI * (2 * y + x)) + sin(2 * PI * (3 * x - y) + 0.7);
}

/* The horizon of the waves over w x h texels, marched by a twentieth of a texel, from the next sample of a line on: a
   line has no data nearer than that. */
static double marched(double i, double j, int w, int h, int direction)
{
    const double from = waves(i / w, j / h);
    double across, down;
    wr_horizon_direction(direction, 16, &across, &down);
    const double length = hypot(across, down);
    across /= length, down /= length;
    double best = 0;
    for (double t = length; t < 2 * (w + h) && t * best < 12; t += 0.05)
        best = fmax(best, (waves((i + t * across) / w, (j + t * down) / h) - from) / t);
    return best;
}

static WrField *waves_of(int w, int h)
{
    WrError err;
    WrField *field = wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, &err);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++)
            wr_field_set(field, i, j, (float)waves((double)i / w, (double)j / h));
    return field;
}

/* Slopes of the waves reach 0.6 of a texel; a direction is off by 1/512, a chord by its square. */
static void a_table_has_the_horizon_of_what_it_samples(void **state)
{
    const int sizes[][2] = { { 83, 71 }, { 128, 64 }, { 45, 150 } };
    WrPool *pool = wr_pool_new(2);
    (void)state;
    for (int s = 0; s < 3; s++) {
        const int w = sizes[s][0], h = sizes[s][1];
        WrField *field = waves_of(w, h);
        WrHorizon made = { 0 };
        WrError err;
        double sum = 0;
        assert_true(wr_horizon_make(&made, field, 16, 1, pool, &err));
        for (int k = 0; k < 300; k++) {
            const int i = (int)(w * random_of(k, 1)), j = (int)(h * random_of(k, 2)), d = k % 16;
            const double got = (double)wr_horizon_at(&made, i, j, d);
            const double off = got - marched(i, j, w, h, d);
            assert_near(off, 0, 0.03);
            sum += off * off;
        }
        assert_true(sqrt(sum / 300) < 0.004);
        wr_horizon_drop(&made);
        wr_field_free(field);
    }
    wr_pool_free(pool);
}

/* Fraction of texels reported as changed. Every changed texel must be reported. */
static double compare_updated(const WrHorizon *was, const WrHorizon *updated, const WrHorizon *anew,
                              const unsigned char *changed)
{
    int told = 0;
    assert_float_equal(updated->steepest, anew->steepest, 0);
    for (int j = 0; j <= anew->height; j++)
        for (int i = 0; i <= anew->width; i++) {
            const bool mark = changed[j % anew->height * anew->width + i % anew->width];
            told += mark;
            for (int k = 0; k < anew->directions; k++) {
                const float a = wr_horizon_at(updated, i, j, k), b = wr_horizon_at(anew, i, j, k);
                assert_memory_equal(&a, &b, sizeof a);
                const float before = wr_horizon_at(was, i, j, k);
                if (before != b) assert_true(mark);
            }
        }
    return (double)told / ((anew->width + 1) * (anew->height + 1));
}

/* After a random edit, also at the ends, updated horizons are bit-identical to new ones. */
static void an_update_is_the_horizon_made_anew(void **state)
{
    const int sizes[][3] = {
        { 64, 96, 16 }, { 61, 47, 8 }, { 128, 32, 64 }, { 75, 52, 4 }, { 5, 7, 12 }
    };
    double least = 1;
    (void)state;
    for (int n = 0; n < 25; n++) {
        const int w = sizes[n % 5][0], h = sizes[n % 5][1], sign = n % 2 ? 1 : -1;
        WrError err;
        WrHorizon was = { 0 }, updated = { 0 }, anew = { 0 };
        WrField *field = waves_of(w, h), *next = wr_field_share(field);
        const int i = (int)(w * random_of(n, 5)), j = (int)(h * random_of(n, 6));
        const int side = 1 + (int)(6 * random_of(n, 7));
        for (int k = 0; k < side * side; k++)
            wr_field_set(next, (i + k % side) % w, (j + k / side) % h,
                         (float)(1.5 * random_of(n, 8 + k) - 0.5));
        unsigned char *changed = calloc((size_t)w * (size_t)h, 1);
        const int directions = sizes[n % 5][2];
        assert_true(wr_horizon_make(&was, field, directions, sign, NULL, &err));
        assert_true(wr_horizon_make(&updated, field, directions, sign, NULL, &err));
        assert_true(wr_horizon_update(&updated, field, next, sign, changed, NULL, &err));
        assert_true(wr_horizon_make(&anew, next, directions, sign, NULL, &err));
        least = fmin(least, compare_updated(&was, &updated, &anew, changed));
        wr_horizon_drop(&was), wr_horizon_drop(&updated), wr_horizon_drop(&anew);
        wr_field_free(field), wr_field_free(next);
        free(changed);
    }
    assert_true(least < 0.1); /* not the whole table is reported as changed */
}

/* Along axes there is no interpolation: exact in float. */
static void along_axes_a_table_is_exact(void **state)
{
    const int sizes[][2] = { { 1, 1 }, { 2, 1 }, { 1, 2 }, { 37, 23 }, { 2, 65 }, { 300, 3 } };
    (void)state;
    for (int s = 0; s < 6; s++)
        for (int sign = -1; sign <= 1; sign += 2) {
            const int w = sizes[s][0], h = sizes[s][1];
            WrError err;
            WrHorizon made = { 0 };
            WrField *field = wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, &err);
            for (int i = 0; i < w * h; i++)
                wr_field_set(field, i % w, i / w, (float)random_of(i, s));
            assert_true(wr_horizon_make(&made, field, 4, sign, NULL, &err));
            for (int at = 0; at < 4 * w * h; at++) {
                const int d = at % 4, i = at / 4 % w, j = at / 4 / w, n = d % 2 ? h : w;
                double heights[512];
                for (int t = 0; t < n; t++) {
                    const int go = d < 2 ? t : n - t;
                    heights[t] = sign * (double)wr_field_get(field, d % 2 ? i : (i + go) % w,
                                                             d % 2 ? (j + go) % h : j);
                }
                const float got = wr_horizon_at(&made, i, j, d);
                assert_near((double)got, brute(heights, n, 0), 1e-7);
                assert_true(got <= made.steepest);
                if (i == 0) assert_true(wr_horizon_at(&made, w, j, d) == got);
                if (j == 0) assert_true(wr_horizon_at(&made, i, h, d) == got);
                if (i + j == 0) assert_true(wr_horizon_at(&made, w, h, d) == got);
            }
            wr_horizon_drop(&made);
            wr_field_free(field);
        }
}

static double sky_of(double (*slope)(double phi), WrVec3 n)
{
    double slopes[4096];
    for (int k = 0; k < 4096; k++) slopes[k] = slope(2 * PI * k / 4096);
    return wr_horizon_sky(slopes, 4096, (const double[]){ n.x, n.y, n.z });
}

static double level(double phi)
{
    (void)phi;
    return 0;
}

static double pit(double phi)
{
    (void)phi;
    return 0.8 / 1.3;
}

/* 0.9 deep, with walls 0.4 and 1.7 away. */
static double trench(double phi)
{
    const double c = cos(phi);
    return c > 0 ? 0.9 * c / 0.4 : -0.9 * c / 1.7;
}

static void a_sky_is_as_dark_as_closed_forms_say(void **state)
{
    (void)state;
    const WrVec3 up = { 0, 0, 1 }, tilted = { sin(0.7) * 0.6, sin(0.7) * -0.8, cos(0.7) };
    const double a = 0.9 / 0.4, b = 0.9 / 1.7;
    assert_near(sky_of(level, up), 1, 1e-12);
    assert_near(sky_of(level, tilted), (1 + cos(0.7)) / 2, 1e-6);
    assert_near(sky_of(pit, up), 1.69 / (1.69 + 0.64), 1e-12);
    assert_near(sky_of(trench, up), 0.5 / sqrt(1 + a * a) + 0.5 / sqrt(1 + b * b), 1e-6);
}

/* Area of a disc above a straight line, counted. */
static void a_round_lamp_sets_as_its_disc_does(void **state)
{
    (void)state;
    for (int k = -12; k <= 12; k++) {
        const double over = 0.1 * k, a = 1;
        double above = 0, all = 0;
        for (int j = 0; j < 20000; j++) {
            const double y = (j + 0.5) / 10000 - 1, chord = sqrt(1 - y * y);
            all += chord;
            above += y + over >= 0 ? chord : 0;
        }
        assert_near(wr_horizon_lamp(0.3 + 0.01 * over, 0.3, 0.01 * a), above / all, 1e-4);
    }
    assert_true(wr_horizon_lamp(0.3, 0.3, 0) == 1);
    assert_true(wr_horizon_lamp(0.2999, 0.3, 0) == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_line_has_the_slopes_of_brute_force),
        cmocka_unit_test(a_trough_has_its_closed_form),
        cmocka_unit_test(a_table_has_the_horizon_of_what_it_samples),
        cmocka_unit_test(along_axes_a_table_is_exact),
        cmocka_unit_test(an_update_is_the_horizon_made_anew),
        cmocka_unit_test(a_sky_is_as_dark_as_closed_forms_say),
        cmocka_unit_test(a_round_lamp_sets_as_its_disc_does),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
