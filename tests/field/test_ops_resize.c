/* Resize: means, ramps, sines, and the filters' formulas. */
#include "test.h"
#include "ops_tables.h"

#include "field/field.h"

enum { BOX, LINEAR, CATMULL, LANCZOS3, FILTERS };

static void whole_ratios_keep_the_mean(void **state)
{
    (void)state;
    const int cases[][4] = { { 96, 60, 48, 20 }, { 96, 60, 192, 180 }, { 96, 60, 12, 120 },
                             { 300, 7, 600, 1 }, { 512, 512, 1, 1 },   { 3, 2, 300, 512 },
                             { 1, 1, 5, 9 },     { 270, 270, 90, 90 }, { 1024, 64, 2, 64 } };
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++)
        for (int filter = BOX; filter < FILTERS; filter++) {
            WrField *in = noisy_table(cases[c][0], cases[c][1], P, P, c);
            WrField *out = run("resize", in, cases[c][2], cases[c][3], filter);
            assert_true(wr_field_width(out) == cases[c][2] && wr_field_height(out) == cases[c][3]);
            assert_near(mean_of(out), mean_of(in), 1e-6);
            wr_field_free(in);
            wr_field_free(out);
        }
}

static void flat_tables_stay_flat_and_without_tiles(void **state)
{
    (void)state;
    const int sizes[][2] = { { 1, 1 }, { 77, 300 }, { 16384, 2 }, { 100, 90 } };
    WrField *in = flat_table(100, 90, P, C, 0.1f);
    wr_field_tile_write(in, 0, 0);
    for (size_t s = 0; s < 4; s++)
        for (int filter = BOX; filter < FILTERS; filter++) {
            WrField *out = run("resize", in, sizes[s][0], sizes[s][1], filter);
            assert_true(wr_field_level(out) == 0.1f);
            assert_true(wr_field_wrap_u(out) == P && wr_field_wrap_v(out) == C);
            assert_true(wr_field_bytes(out) == (s == 3 ? wr_field_bytes(in) : 0));
            wr_field_free(out);
        }
    wr_field_free(in);
}

/* Weights add up to exactly 1 in every order of summation: no bit of a flat table changes. */
static void flat_tables_of_all_heights_stay_flat(void **state)
{
    (void)state;
    TestRandom random = { 3 };
    for (int n = 0; n < 200; n++) {
        double scale = exp2(floor(60 * test_random(&random) - 30));
        float level = (float)((2 * test_random(&random) - 1) * scale);
        WrField *in = flat_table(19, 23, n % 2 ? P : C, P, level);
        WrField *out = run("resize", in, 1 + n * 7 % 60, 1 + n * 13 % 50, n % FILTERS);
        assert_true(wr_field_level(out) == level && wr_field_bytes(out) == 0);
        wr_field_free(in);
        wr_field_free(out);
    }
}

/* Fewer texels than filter taps: a periodic axis wraps around, a clamped one repeats its ends. */
static void tables_smaller_than_the_filter_wrap_or_repeat_their_ends(void **state)
{
    (void)state;
    enum { N = 3, OUT = 12 };
    for (int turn = 0; turn < 2; turn++) {
        WrField *in = flat_table(N, 1, turn ? P : C, C, 0.0f), *out;
        for (int i = 0; i < N; i++) wr_field_set(in, i, 0, (float)(i * i));
        out = run("resize", in, OUT, 1, CATMULL);
        for (int i = 0; i < OUT; i++) {
            double x = (i + 0.5) * N / OUT - 0.5, sum = 0.0;
            for (int k = -3; k < N + 3; k++) {
                double a = fabs(k - x);
                double w = a < 1   ? 1.5 * a * a * a - 2.5 * a * a + 1
                           : a < 2 ? -0.5 * a * a * a + 2.5 * a * a - 4 * a + 2
                                   : 0;
                sum += w * at(in, k, 0);
            }
            assert_near(wr_field_get(out, i, 0), sum, 1e-6);
        }
        wr_field_free(in);
        wr_field_free(out);
    }
}

static void a_box_shrinks_to_the_mean_of_what_it_covers(void **state)
{
    (void)state;
    WrField *in = noisy_table(100, 60, P, P, 1), *out = run("resize", in, 40, 20, BOX);
    for (int j = 0; j < 20; j++)
        for (int i = 0; i < 40; i++) { /* 2.5 x 3 texels: every other one starts half way */
            double sum = 0.0, from = 2.5 * i, to = from + 2.5;
            for (int y = 0; y < 3; y++)
                for (int x = (int)from; x < to; x++)
                    sum += (fmin(x + 1, to) - fmax(x, from)) * at(in, x, 3 * j + y);
            assert_near(wr_field_get(out, i, j), sum / 7.5, 1e-7);
        }
    wr_field_free(in);
    wr_field_free(out);
}

/* Interpolation through the samples; a clamped axis repeats its ends, so only the inside is checked. */
static void growing_keeps_a_ramp_a_ramp(void **state)
{
    (void)state;
    WrField *in = flat_table(64, 48, C, C, 0.0f);
    for (int j = 0; j < 48; j++)
        for (int i = 0; i < 64; i++) wr_field_set(in, i, j, (float)(0.25 * i - 0.5 * j));
    for (int filter = LINEAR; filter <= CATMULL; filter++) {
        WrField *out = run("resize", in, 200, 111, filter);
        for (int j = 6; j < 105; j++)
            for (int i = 8; i < 192; i++) {
                double x = (i + 0.5) * 64 / 200 - 0.5, y = (j + 0.5) * 48 / 111 - 0.5;
                assert_near(wr_field_get(out, i, j), 0.25 * x - 0.5 * y, 2e-6);
            }
        wr_field_free(out);
    }
    wr_field_free(in);
}

/* By an odd whole factor the middle of each group is the sample itself. */
static void growing_by_three_and_taking_every_third_texel_is_the_table(void **state)
{
    (void)state;
    WrField *in = noisy_table(40, 30, P, C, 2);
    for (int filter = BOX; filter < FILTERS; filter++) {
        WrField *out = run("resize", in, 120, 90, filter);
        for (int j = 0; j < 30; j++)
            for (int i = 0; i < 40; i++)
                assert_near(wr_field_get(out, 3 * i + 1, 3 * j + 1), wr_field_get(in, i, j), 1e-7);
        wr_field_free(out);
    }
    wr_field_free(in);
}

static WrField *sine_table(int width, int height)
{
    WrField *field = flat_table(width, height, P, P, 0.0f);
    double turn = 2 * acos(-1.0);
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++)
            wr_field_set(field, i, j,
                         (float)(sin(turn * (i + 0.5) / width) * cos(turn * (j + 0.5) / height)));
    return field;
}

/* The same function sampled at any size with the same texel centres: a shift by half a texel would show as 0.02. The
   error of bilinear interpolation is at most (h^2/8)(|Fxx| + |Fyy|). */
static void a_sine_keeps_its_place_and_shape_at_any_size(void **state)
{
    (void)state;
    const int sizes[][2] = { { 64, 64 }, { 300, 171 }, { 129, 400 }, { 50, 37 } };
    const double within[FILTERS] = { 0.03, 0.004, 0.002, 0.004 };
    WrField *in = sine_table(128, 150);
    for (size_t s = 0; s < 4; s++)
        for (int filter = BOX; filter < FILTERS; filter++) {
            WrField *out = run("resize", in, sizes[s][0], sizes[s][1], filter);
            WrField *right = sine_table(sizes[s][0], sizes[s][1]);
            assert_true(distance(out, right) < within[filter]);
            wr_field_free(out);
            wr_field_free(right);
        }
    wr_field_free(in);
}

static void up_and_down_again_is_the_table(void **state)
{
    (void)state;
    WrField *in = sine_table(60, 44);
    for (int filter = BOX; filter < FILTERS; filter++) {
        WrField *up = run("resize", in, 240, 176, filter),
                *down = run("resize", up, 60, 44, filter);
        assert_true(distance(down, in) < (filter == BOX ? 1e-7 : 0.02));
        wr_field_free(up);
        wr_field_free(down);
    }
    wr_field_free(in);
}

/* For a checkerboard too fine for the new size only the mean may remain: no moire. */
static void shrinking_does_not_alias(void **state)
{
    (void)state;
    WrField *in = flat_table(256, 256, P, P, 0.0f);
    for (int j = 0; j < 256; j++)
        for (int i = 0; i < 256; i++) wr_field_set(in, i, j, (float)((i ^ j) & 1));
    const double within[FILTERS] = { 0.11, 0.02, 0.04, 0.02 };
    for (int filter = BOX; filter < FILTERS; filter++) {
        WrField *out = run("resize", in, 83, 83, filter);
        float low, high;
        wr_field_range(out, &low, &high);
        assert_true(low > 0.5 - within[filter] && high < 0.5 + within[filter]);
        wr_field_free(out);
    }
    wr_field_free(in);
}

static void the_filters_are_their_formulas(void **state)
{
    (void)state;
    enum { N = 21, OUT = 210 };
    double pi = acos(-1.0);
    WrField *in = flat_table(N, 1, P, P, 0.0f);
    wr_field_set(in, 10, 0, 1.0f);
    WrField *linear = run("resize", in, OUT, 1, LINEAR),
            *catmull = run("resize", in, OUT, 1, CATMULL);
    WrField *lanczos = run("resize", in, OUT, 1, LANCZOS3);
    for (int i = 0; i < OUT; i++) {
        double x = fabs((i + 0.5) * N / OUT - 0.5 - 10), sum = 0.0, wave;
        double cubic = x < 1   ? 1.5 * x * x * x - 2.5 * x * x + 1
                       : x < 2 ? -0.5 * x * x * x + 2.5 * x * x - 4 * x + 2
                               : 0;
        for (double y = x - floor(x) - 3; y < 3; y += 1)
            sum += y == 0 ? 1 : 3 * sin(pi * y) * sin(pi * y / 3) / (pi * pi * y * y);
        wave = x >= 3 ? 0 : x == 0 ? 1 : 3 * sin(pi * x) * sin(pi * x / 3) / (pi * pi * x * x);
        assert_near(wr_field_get(linear, i, 0), fmax(0, 1 - x), 1e-7);
        assert_near(wr_field_get(catmull, i, 0), cubic, 1e-7);
        assert_near(wr_field_get(lanczos, i, 0), wave / sum, 1e-7);
    }
    WrField *all[] = { in, linear, catmull, lanczos };
    for (int k = 0; k < 4; k++) wr_field_free(all[k]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(whole_ratios_keep_the_mean),
        cmocka_unit_test(flat_tables_stay_flat_and_without_tiles),
        cmocka_unit_test(flat_tables_of_all_heights_stay_flat),
        cmocka_unit_test(tables_smaller_than_the_filter_wrap_or_repeat_their_ends),
        cmocka_unit_test(a_box_shrinks_to_the_mean_of_what_it_covers),
        cmocka_unit_test(growing_keeps_a_ramp_a_ramp),
        cmocka_unit_test(growing_by_three_and_taking_every_third_texel_is_the_table),
        cmocka_unit_test(a_sine_keeps_its_place_and_shape_at_any_size),
        cmocka_unit_test(up_and_down_again_is_the_table),
        cmocka_unit_test(shrinking_does_not_alias),
        cmocka_unit_test(the_filters_are_their_formulas),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
