/* Make seamless, match edges, even out light: on tables whose opposite edges are far apart. */
#include "test.h"
#include "ops_tables.h"

#include "field/field.h"

#include <stdlib.h>

enum { BLEND, PATCHES, MIRROR, FREQUENCY, WAYS };

static const int sizes[][2] = { { 67, 93 }, { 150, 41 }, { 233, 128 } };
enum { SIZES = sizeof sizes / sizeof *sizes };

/* Steps of about 1 along both axes, more often up than down: opposite edges are far apart. */
static WrField *walk(int width, int height, uint64_t seed, double scale)
{
    TestRandom random = { seed };
    double *row = calloc((size_t)width, sizeof *row), column = 0.0;
    for (int i = 1; i < width; i++) row[i] = row[i - 1] + (test_random(&random) < 0.7 ? 1 : -1);
    WrField *field = flat_table(width, height, P, P, 0.0f);
    for (int j = 0; j < height; j++, column += test_random(&random) < 0.7 ? 1 : -1)
        for (int i = 0; i < width; i++)
            wr_field_set(field, i, j,
                         (float)(scale * (row[i] + column + 0.2 * test_random(&random))));
    free(row);
    return field;
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Median step along an axis: between all neighbours inside, or only across the edge. */
static double median_step(const WrField *f, int axis, bool edge)
{
    const int w = wr_field_width(f), h = wr_field_height(f);
    double *step = malloc(sizeof *step * (size_t)w * (size_t)h);
    size_t count = 0;
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++) {
            const bool last = axis == 0 ? i == w - 1 : j == h - 1;
            if (last == edge)
                step[count++] = fabs((double)at(f, i + (axis == 0), j + (axis == 1)) - at(f, i, j));
        }
    qsort(step, count, sizeof *step, by_size);
    const double median = step[count / 2];
    free(step);
    return median;
}

/* The larger of both axes' steps across the edge, in median steps of the table `in` inside. */
static double jump(const WrField *in, const WrField *out)
{
    return fmax(median_step(out, 0, true) / median_step(in, 0, false),
                median_step(out, 1, true) / median_step(in, 1, false));
}

static void steps_across_the_edges_are_no_larger_than_inside(void **state)
{
    (void)state;
    for (int s = 0; s < SIZES; s++) {
        WrField *in = walk(sizes[s][0], sizes[s][1], (uint64_t)s + 1, 1.0);
        assert_true(jump(in, in) > 5.0);
        for (int how = 0; how < WAYS; how++)
            for (int width = 0; width < 30; width += 7) {
                WrField *out = run("seamless", in, how, width);
                if (jump(in, out) > 1.1)
                    fail_msg("%d, width %d: %g times the step", how, width, jump(in, out));
                wr_field_free(out);
            }
        wr_field_free(in);
    }
}

static int distance_to_edge(const WrField *f, int i, int j, int axis)
{
    const int n = axis == 0 ? wr_field_width(f) : wr_field_height(f), k = axis == 0 ? i : j;
    return k < n - 1 - k ? k : n - 1 - k;
}

/* Texels at least u and v away from the edges keep their bits. */
static void assert_inside_kept(const WrField *in, const WrField *out, int u, int v)
{
    for (int j = 0; j < wr_field_height(in); j++)
        for (int i = 0; i < wr_field_width(in); i++)
            if (distance_to_edge(in, i, j, 0) >= u && distance_to_edge(in, i, j, 1) >= v)
                assert_true(same_bits(wr_field_get(in, i, j), wr_field_get(out, i, j)));
}

static void blend_and_patches_change_only_the_edges(void **state)
{
    (void)state;
    WrField *in = walk(151, 93, 5, 1.0);
    for (int how = BLEND; how <= PATCHES; how++) {
        WrField *narrow = run("seamless", in, how, 9), *usual = run("seamless", in, how, 0);
        assert_inside_kept(in, narrow, 9, 9);
        assert_inside_kept(in, usual, 19, 12); /* an eighth, rounded up */
        assert_true(distance(in, narrow) > 5.0);
        wr_field_free(narrow);
        wr_field_free(usual);
    }
    wr_field_free(in);
}

/* White noise, blended half and half without correction, has half its variance. */
static void a_blend_keeps_the_variance(void **state)
{
    (void)state;
    const int width = 303, height = 401, wide = 60;
    WrField *in = flat_table(width, height, P, P, 0.0f);
    TestRandom random = { 11 };
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++) wr_field_set(in, i, j, (float)test_random(&random));
    WrField *out = run("seamless", in, BLEND, wide);
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (int j = wide; j < height - wide; j++)
        for (int i = wide / 2 - 10; i < wide / 2 + 10; i++, count++) {
            const double z = wr_field_get(out, i, j);
            sum += z;
            squares += z * z;
        }
    assert_near(sum / count, 0.5, 0.02);
    assert_near(squares / count - sum / count * sum / count, 1.0 / 12, 0.1 / 12);
    wr_field_free(in);
    wr_field_free(out);
}

/* Slopes common to both are not amplified: a blend of two equal slopes stays between them. */
static void a_blend_of_slopes_does_not_overshoot(void **state)
{
    (void)state;
    WrField *in = flat_table(64, 57, P, P, 0.0f);
    for (int j = 0; j < 57; j++)
        for (int i = 0; i < 64; i++) wr_field_set(in, i, j, (float)(2 * i + 3 * j));
    WrField *out = run("seamless", in, BLEND, 16);
    float low, high;
    wr_field_range(out, &low, &high);
    assert_true(low >= 0.0f && high <= 2 * 63 + 3 * 56);
    wr_field_free(in);
    wr_field_free(out);
}

/* The middle of a dome is copied to its edges, but not its height. */
static void edges_keep_their_level(void **state)
{
    (void)state;
    WrField *in = flat_table(91, 73, P, P, 0.0f);
    for (int j = 0; j < 73; j++)
        for (int i = 0; i < 91; i++)
            wr_field_set(in, i, j, (float)(10 * sin(M_PI * i / 90) * sin(M_PI * j / 72)));
    for (int how = BLEND; how <= PATCHES; how++) {
        WrField *out = run("seamless", in, how, 8);
        for (int j = 0; j < 73; j++) assert_true(fabs((double)wr_field_get(out, 0, j)) < 2.0);
        for (int i = 0; i < 91; i++) assert_true(fabs((double)wr_field_get(out, i, 72)) < 2.0);
        wr_field_free(out);
    }
    wr_field_free(in);
}

/* Heights times a power of two give the result times it, bit for bit. */
static void huge_and_tiny_heights_are_handled_alike(void **state)
{
    (void)state;
    const OpCall calls[] = { { "seamless", { BLEND, 0 } },  { "seamless", { PATCHES, 0 } },
                             { "seamless", { MIRROR, 0 } }, { "seamless", { FREQUENCY, 0 } },
                             { "match-edges", { 0, 0 } },   { "match-edges", { 11, 1 } },
                             { "even-light", { 5.0 } },     { "even-light", { 21.0 } } };
    const double scales[] = { 0x1p+95, 0x1p-95 }; /* about 1e30 and 1e-30 with the walk's heights */
    WrField *in = walk(77, 59, 3, 1.0);
    for (int s = 0; s < 2; s++) {
        WrField *scaled = walk(77, 59, 3, scales[s]);
        for (size_t c = 0; c < sizeof calls / sizeof *calls; c++) {
            WrField *plain = run_with(calls[c].name, in, calls[c].param, NULL);
            WrField *out = run_with(calls[c].name, scaled, calls[c].param, NULL);
            for (int j = 0; j < 59; j++)
                for (int i = 0; i < 77; i++)
                    if (wr_field_get(out, i, j) != (float)(scales[s] * wr_field_get(plain, i, j)))
                        fail_msg("%s %g: %d, %d", calls[c].name, calls[c].param[0], i, j);
            wr_field_free(plain);
            wr_field_free(out);
        }
        wr_field_free(scaled);
    }
    wr_field_free(in);
}

static void mirror_repeats_the_top_left_quarter(void **state)
{
    (void)state;
    for (int s = 0; s < SIZES; s++) {
        const int w = sizes[s][0], h = sizes[s][1];
        WrField *in = walk(w, h, 2, 1.0), *out = run("seamless", in, MIRROR, 0);
        for (int j = 0; j < h; j++)
            for (int i = 0; i < w; i++)
                assert_true(wr_field_get(out, i, j) ==
                            wr_field_get(in, i <= w / 2 ? i : w - i, j <= h / 2 ? j : h - j));
        wr_field_free(in);
        wr_field_free(out);
    }
}

static void matched_edges_are_equal(void **state)
{
    (void)state;
    for (int s = 0; s < SIZES; s++)
        for (int ramp = 0; ramp < 2; ramp++) {
            const int w = sizes[s][0], h = sizes[s][1];
            WrField *in = walk(w, h, 4, 1.0), *out = run("match-edges", in, 10, ramp);
            for (int j = 0; j < h; j++)
                assert_near(wr_field_get(out, 0, j), wr_field_get(out, w - 1, j), 1e-5);
            for (int i = 0; i < w; i++)
                assert_near(wr_field_get(out, i, 0), wr_field_get(out, i, h - 1), 1e-5);
            for (int j = 10; j < h - 10; j++) { /* the mean of both, half of the jump half way */
                const double left = wr_field_get(in, 0, j), right = wr_field_get(in, w - 1, j);
                assert_near(wr_field_get(out, 0, j), 0.5 * (left + right), 1e-5);
                assert_near(wr_field_get(out, 5, j), wr_field_get(in, 5, j) + 0.25 * (right - left),
                            1e-5);
            }
            assert_inside_kept(in, out, 10, 10);
            wr_field_free(in);
            wr_field_free(out);
        }
}

/* A Gaussian of deviation s leaves exp(-(2 pi s / n)^2 / 2) of a wave of n texels; the rest stays. */
static void even_light_subtracts_waves_and_keeps_the_mean(void **state)
{
    (void)state;
    const int w = 101, h = 77;
    const double sigmas[] = { 8.0, 25.0 };
    for (int s = 0; s < 2; s++) {
        WrField *in = flat_table(w, h, P, P, 0.0f);
        TestRandom random = { 21 };
        for (int j = 0; j < h; j++)
            for (int i = 0; i < w; i++)
                wr_field_set(in, i, j,
                             (float)(3 + 5 * cos(2 * M_PI * i / w) + test_random(&random)));
        WrField *out = run("even-light", in, sigmas[s]);
        double wave = 0.0;
        for (int j = 0; j < h; j++)
            for (int i = 0; i < w; i++)
                wave += 2.0 / w / h * cos(2 * M_PI * i / w) * wr_field_get(out, i, j);
        const double x = 2 * M_PI * sigmas[s] / w;
        assert_near(wave, 5 * (1 - exp(-0.5 * x * x)), 0.05);
        assert_near(mean_of(out), mean_of(in), 1e-5);
        wr_field_free(in);
        wr_field_free(out);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_across_the_edges_are_no_larger_than_inside),
        cmocka_unit_test(blend_and_patches_change_only_the_edges),
        cmocka_unit_test(a_blend_keeps_the_variance),
        cmocka_unit_test(a_blend_of_slopes_does_not_overshoot),
        cmocka_unit_test(edges_keep_their_level),
        cmocka_unit_test(huge_and_tiny_heights_are_handled_alike),
        cmocka_unit_test(mirror_repeats_the_top_left_quarter),
        cmocka_unit_test(matched_edges_are_equal),
        cmocka_unit_test(even_light_subtracts_waves_and_keeps_the_mean),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
