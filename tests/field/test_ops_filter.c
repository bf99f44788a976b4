/* Filters of the table operations, against explicit sums and sorts. */
#include "test.h"
#include "ops_tables.h"

#include "field/field.h"

typedef struct Shape {
    int width, height;
    WrWrap u, v;
} Shape;
static const Shape shapes[] = { { 1, 1, P, P },   { 1, 13, P, P },  { 2, 3, P, C },
                                { 31, 1, C, P },  { 37, 29, P, P }, { 37, 29, C, P },
                                { 37, 29, C, C }, { 270, 20, P, P } };
enum { SHAPES = sizeof shapes / sizeof *shapes };

static WrField *shape_table(int k)
{
    return noisy_table(shapes[k].width, shapes[k].height, shapes[k].u, shapes[k].v,
                       (uint64_t)k + 20);
}

/* One height of a Gaussian blur, both axes at once, out to `reach` texels. */
static double gauss_at(const WrField *in, int i, int j, double sigma, int reach)
{
    double sum = 0.0, weights = 0.0;
    for (int y = -reach; y <= reach; y++)
        for (int x = -reach; x <= reach; x++) {
            double w = exp(-(x * x + y * y) / (2.0 * sigma * sigma));
            sum += w * at(in, i + x, j + y);
            weights += w;
        }
    return sum / weights;
}

/* Out to 7 sigma: the weights that the blur cuts off beyond 4 sum to 6e-5 per axis, for heights up to 0.5. */
static void a_blur_is_the_sum_of_gaussian_weights(void **state)
{
    (void)state;
    const double sigmas[] = { 0.3, 0.7, 2.0, 5.3, 16.0 };
    for (int k = 0; k < SHAPES; k++)
        for (int s = 0; s < 5; s++) {
            WrField *in = shape_table(k), *out = run("blur", in, sigmas[s]);
            int reach = (int)(7 * sigmas[s]) + 2, i = shapes[k].width / 2, j = shapes[k].height - 1;
            for (int n = 0; n < 3; n++, i = (i + 19) % shapes[k].width, j /= 2)
                assert_near(wr_field_get(out, i, j), gauss_at(in, i, j, sigmas[s], reach), 6e-5);
            wr_field_free(in);
            wr_field_free(out);
        }
}

/* Within the support only float rounding remains. */
static void a_blur_is_exact_but_for_what_lies_beyond_four_sigma(void **state)
{
    (void)state;
    WrField *in = noisy_table(60, 50, P, C, 1), *out = run("blur", in, 2.5);
    for (int j = 0; j < 50; j += 7)
        for (int i = 0; i < 60; i += 3)
            assert_near(wr_field_get(out, i, j), gauss_at(in, i, j, 2.5, 10), 2e-7);
    wr_field_free(in);
    wr_field_free(out);
}

/* A table so tall that a work item has several blocks in a column, with more, fewer or no threads: the same heights,
 * equal to the Gaussian's, at the ends and where blocks and tiles meet. */
static void a_tall_table_is_blurred_alike_in_any_pieces(void **state)
{
    (void)state;
    static const Shape tall[] = { { 19, 4421, P, C }, { 19, 4421, C, P }, { 281, 1061, C, C } };
    WrPool *pool = wr_pool_new(3);
    for (int k = 0; k < 3; k++) {
        const double sigma = 4.7;
        WrField *in = noisy_table(tall[k].width, tall[k].height, tall[k].u, tall[k].v, 9);
        WrField *out = run("blur", in, sigma);
        WrField *shared = run_with("blur", in, &sigma, &(WrOpOptions){ .pool = pool });
        assert_true(same_table(out, shared));
        for (int j = 0; j<tall[k].height; j += j % 256> 250 || j % 256 < 20 ? 1 : 37)
            assert_near(wr_field_get(out, j % 17, j), gauss_at(in, j % 17, j, sigma, 19), 3e-7);
        WrField *sharp = run("sharpen", in, 1.0, sigma);
        for (int j = 5; j < tall[k].height; j += 97) /* 2 F minus the blur */
            assert_near(wr_field_get(sharp, 9, j),
                        2 * (double)wr_field_get(in, 9, j) - (double)wr_field_get(out, 9, j), 3e-7);
        wr_field_free(in), wr_field_free(out), wr_field_free(shared), wr_field_free(sharp);
    }
    WrField *in = flat_table(21, 4421, C, C, 0.3f); /* most of its blocks are skipped */
    for (int j = 700; j < 2900; j += 1050) wr_field_set(in, 11, j, -5.3f);
    WrField *out = run("blur", in, 4.7);
    for (int j = 0; j<4421; j += j % 1050> 715 || j % 1050 < 685 ? 23 : 1)
        assert_near(wr_field_get(out, 13, j), gauss_at(in, 13, j, 4.7, 19), 1e-6);
    wr_field_free(in), wr_field_free(out);
    wr_pool_free(pool);
}

static void hc77_a_blur_keeps_the_mean(void **state)
{
    (void)state;
    const double sigmas[] = { 0.4, 1.0, 3.0, 10.67, 16.0, 16.5, 40.0, 300.0, 1024.0 };
    const Shape tables[] = { { 150, 130, P, P }, { 1, 300, P, P }, { 5, 7, P, P } };
    for (size_t t = 0; t < 3; t++) {
        WrField *raw = noisy_table(tables[t].width, tables[t].height, P, P, t);
        WrField *in = run("add", raw, 3.0);
        for (size_t s = 0; s < sizeof sigmas / sizeof *sigmas; s++) {
            WrField *out = run("blur", in, sigmas[s]), *sharp = run("sharpen", in, 2.0, sigmas[s]);
            assert_near(mean_of(out), mean_of(in), 2.5e-7); /* two roundings of heights up to 4 */
            assert_near(mean_of(sharp), mean_of(in), 1e-6);
            wr_field_free(out);
            wr_field_free(sharp);
        }
        wr_field_free(raw);
        wr_field_free(in);
    }
}

static void hc77_a_blur_never_passes_the_range(void **state)
{
    (void)state;
    WrField *table = noisy_table(90, 80, P, P, 3);
    for (int pass = 0; pass < 40; pass++) {
        WrField *next = run("blur", table, pass % 4 == 3 ? 17.0 : 0.5 + 0.1 * pass);
        float low, high, next_low, next_high;
        wr_field_range(table, &low, &high);
        wr_field_range(next, &next_low, &next_high);
        assert_true(next_low >= low && next_high <= high);
        wr_field_free(table);
        table = next;
    }
    wr_field_free(table);
}

/* A single texel reveals the kernel: no negative weight, the variance, and 0.7 % from a Gaussian. */
static void the_kernel_of_a_wide_blur_has_its_variance_and_shape(void **state)
{
    (void)state;
    const double sigmas[] = { 16.01, 20.0, 64.0, 511.0 };
    for (int s = 0; s < 4; s++)
        for (int turn = 0; turn < 2; turn++) {
            enum { N = 8191 };
            double sigma = sigmas[s], sum = 0, square = 0, off = 0, weights = 0;
            WrField *in = flat_table(turn ? 1 : N, turn ? N : 1, P, P, 0.0f);
            wr_field_set(in, turn ? 0 : N / 2, turn ? N / 2 : 0, 1000.0f);
            WrField *out = run("blur", in, sigma);
            for (int x = -N / 2; x <= N / 2; x++) weights += exp(-x * x / (2.0 * sigma * sigma));
            for (int x = -N / 2; x <= N / 2; x++) {
                double w = wr_field_get(out, turn ? 0 : N / 2 + x, turn ? N / 2 + x : 0) / 1000.0;
                double gauss = exp(-x * x / (2.0 * sigma * sigma)) / weights;
                assert_true(w >= 0.0);
                sum += w;
                square += w * x * x;
                off += fabs(w - gauss);
            }
            assert_near(sum, 1.0, 1e-6);
            assert_near(square / (sigma * sigma), 1.0, 1e-5);
            assert_true(off < 0.0072 && off > 0.001);
            wr_field_free(in);
            wr_field_free(out);
        }
}

/* The table is smaller than the kernel, periodic and with repeated edges. */
static void a_wide_blur_is_near_the_gaussian_on_any_table(void **state)
{
    (void)state;
    for (int k = 0; k < SHAPES; k++) {
        WrField *in = shape_table(k), *out = run("blur", in, 18.0);
        for (int n = 0; n < 3; n++) {
            int i = n * (shapes[k].width - 1) / 2, j = (2 - n) * (shapes[k].height - 1) / 2;
            assert_near(wr_field_get(out, i, j), gauss_at(in, i, j, 18.0, 80), 0.007);
        }
        wr_field_free(in);
        wr_field_free(out);
    }
}

/* A sine with a whole number of periods is only scaled, by exp(-(2 pi sigma / period)^2 / 2). */
static void a_blur_makes_a_sine_smaller_by_its_closed_form(void **state)
{
    (void)state;
    const double sigmas[] = { 2.0, 6.0, 20.0 }, within[] = { 5e-5, 5e-5, 0.004 };
    WrField *in = flat_table(1, 128, P, P, 0.0f);
    for (int j = 0; j < 128; j++) wr_field_set(in, 0, j, (float)sin(2 * acos(-1.0) * j / 128));
    for (int s = 0; s < 3; s++) {
        WrField *out = run("blur", in, sigmas[s]);
        double x = 2 * acos(-1.0) * sigmas[s] / 128, factor = exp(-x * x / 2);
        for (int j = 0; j < 128; j++)
            assert_near(wr_field_get(out, 0, j), factor * wr_field_get(in, 0, j), within[s]);
        wr_field_free(out);
    }
    wr_field_free(in);
}

static void sharpening_adds_what_the_blur_takes_away(void **state)
{
    (void)state;
    const double sigmas[] = { 1.5, 25.0 };
    for (int s = 0; s < 2; s++) {
        WrField *in = noisy_table(90, 70, P, C, 4), *blurred = run("blur", in, sigmas[s]);
        WrField *out = run("sharpen", in, 1.7, sigmas[s]);
        for (int j = 0; j < 70; j++)
            for (int i = 0; i < 90; i++) {
                double f = wr_field_get(in, i, j);
                assert_near(wr_field_get(out, i, j), f + 1.7 * (f - wr_field_get(blurred, i, j)),
                            1e-6);
            }
        wr_field_free(in);
        wr_field_free(blurred);
        wr_field_free(out);
    }
}

static int by_height(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Heights of a window in order; returns their number. */
static int sorted_window(const WrField *in, int i, int j, double radius, bool square,
                         float *heights)
{
    int count = 0, reach = (int)radius;
    for (int y = -reach; y <= reach; y++)
        for (int x = -reach; x <= reach; x++)
            if (square || x * x + y * y <= radius * radius) heights[count++] = at(in, i + x, j + y);
    qsort(heights, (size_t)count, sizeof *heights, by_height);
    return count;
}

static void the_median_is_the_middle_of_the_sorted_window(void **state)
{
    (void)state;
    static float heights[65 * 65];
    const double radii[] = { 1.0, 1.5, 3.0, 7.3 };
    for (int k = 0; k < SHAPES; k++)
        for (int r = 0; r < 4; r++)
            for (int square = 0; square < 2; square++) {
                WrField *in = shape_table(k), *out = run("median", in, radii[r], square);
                for (int j = 0; j < shapes[k].height; j += 2)
                    for (int i = j % 3; i < shapes[k].width; i += 3) {
                        int count = sorted_window(in, i, j, radii[r], square, heights);
                        assert_true(wr_field_get(out, i, j) == heights[count / 2]);
                    }
                wr_field_free(in);
                wr_field_free(out);
            }
}

static void the_largest_windows_are_exact_too(void **state)
{
    (void)state;
    static float heights[129 * 129];
    WrField *in = noisy_table(150, 140, P, C, 5);
    WrField *median = run("median", in, 32, 1), *dilated = run("dilate", in, 64);
    WrField *eroded = run("erode", in, 64);
    for (int n = 0; n < 60; n++) {
        int i = n * 37 % 150, j = n * 61 % 140;
        int count = sorted_window(in, i, j, 32, true, heights);
        assert_true(count == 65 * 65 && wr_field_get(median, i, j) == heights[count / 2]);
        count = sorted_window(in, i, j, 64, false, heights);
        assert_true(wr_field_get(dilated, i, j) == heights[count - 1]);
        assert_true(wr_field_get(eroded, i, j) == heights[0]);
    }
    WrField *all[] = { in, median, dilated, eroded };
    for (int k = 0; k < 4; k++) wr_field_free(all[k]);
}

static void a_median_takes_a_speck_away_and_keeps_an_edge(void **state)
{
    (void)state;
    WrField *in = flat_table(64, 64, C, C, 0.0f);
    for (int j = 0; j < 64; j++)
        for (int i = 32; i < 64; i++) wr_field_set(in, i, j, 1.0f);
    WrField *speck = wr_field_share(in);
    wr_field_set(speck, 10, 10, 5.0f);
    WrField *out = run("median", speck, 3, 0);
    assert_true(same_table(out, in));
    wr_field_free(in);
    wr_field_free(speck);
    wr_field_free(out);
}

static void dilate_and_erode_are_the_extremes_of_the_window(void **state)
{
    (void)state;
    static float heights[65 * 65];
    const double radii[] = { 1.0, 1.5, 4.0, 11.7 };
    for (int k = 0; k < SHAPES; k++)
        for (int r = 0; r < 4; r++) {
            WrField *in = shape_table(k);
            WrField *most = run("dilate", in, radii[r]), *least = run("erode", in, radii[r]);
            for (int j = 0; j < shapes[k].height; j += 2)
                for (int i = j % 3; i < shapes[k].width; i += 3) {
                    int count = sorted_window(in, i, j, radii[r], false, heights);
                    assert_true(wr_field_get(most, i, j) == heights[count - 1]);
                    assert_true(wr_field_get(least, i, j) == heights[0]);
                }
            wr_field_free(in);
            wr_field_free(most);
            wr_field_free(least);
        }
}

static WrField *closing(const WrField *in, double radius)
{
    WrField *grown = run("dilate", in, radius), *out = run("erode", grown, radius);
    wr_field_free(grown);
    return out;
}

static void closing_twice_is_closing_once(void **state)
{
    (void)state;
    WrField *in = noisy_table(150, 90, P, P, 6), *once = closing(in, 5.0),
            *twice = closing(once, 5.0);
    assert_true(same_table(once, twice) && !same_table(once, in));
    for (int j = 0; j < 90; j++)
        for (int i = 0; i < 150; i++)
            assert_true(wr_field_get(once, i, j) >= wr_field_get(in, i, j));
    wr_field_free(in);
    wr_field_free(once);
    wr_field_free(twice);
}

/* Texels beyond the table's edges hold the level, whatever the memory of a written tile contained. */
static void unused_texels_of_a_filtered_table_hold_the_level(void **state)
{
    (void)state;
    const int sizes[][2] = { { 70, 64 }, { 64, 70 }, { 270, 300 }, { 5, 5 } };
    for (int k = 0; k < 4; k++) {
        int width = sizes[k][0], height = sizes[k][1];
        WrField *full = noisy_table(2048, 2048, P, P, 4);
        WrField *in = noisy_table(width, height, P, P, 3);
        wr_field_free(full); /* its memory is reused for the next tiles */
        WrField *out = run("blur", in, 2.0);
        for (int t = 0; t < wr_field_tiles_u(out) * wr_field_tiles_v(out); t++) {
            int tx = t % wr_field_tiles_u(out), ty = t / wr_field_tiles_u(out);
            const float *tile = wr_field_tile(out, tx, ty);
            for (int n = 0; tile && n < WR_TILE * WR_TILE; n++)
                if (tx * WR_TILE + n % WR_TILE >= width || ty * WR_TILE + n / WR_TILE >= height)
                    assert_true(same_bits(tile[n], wr_field_level(out)));
        }
        wr_field_free(in);
        wr_field_free(out);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_blur_is_the_sum_of_gaussian_weights),
        cmocka_unit_test(a_blur_is_exact_but_for_what_lies_beyond_four_sigma),
        cmocka_unit_test(unused_texels_of_a_filtered_table_hold_the_level),
        cmocka_unit_test(a_tall_table_is_blurred_alike_in_any_pieces),
        cmocka_unit_test(hc77_a_blur_keeps_the_mean),
        cmocka_unit_test(hc77_a_blur_never_passes_the_range),
        cmocka_unit_test(the_kernel_of_a_wide_blur_has_its_variance_and_shape),
        cmocka_unit_test(a_wide_blur_is_near_the_gaussian_on_any_table),
        cmocka_unit_test(a_blur_makes_a_sine_smaller_by_its_closed_form),
        cmocka_unit_test(sharpening_adds_what_the_blur_takes_away),
        cmocka_unit_test(the_median_is_the_middle_of_the_sorted_window),
        cmocka_unit_test(the_largest_windows_are_exact_too),
        cmocka_unit_test(a_median_takes_a_speck_away_and_keeps_an_edge),
        cmocka_unit_test(dilate_and_erode_are_the_extremes_of_the_window),
        cmocka_unit_test(closing_twice_is_closing_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
