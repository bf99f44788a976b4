/* Fourier transforms, and equations solved with them. */
#include "test.h"

#include "base/memory.h"
#include "base/pool.h"
#include "field/fft_plane.h"

static const double tau = 6.283185307179586;

static double *random_plane(size_t count, uint64_t seed)
{
    TestRandom r = { seed };
    double *z = wr_alloc(count, sizeof *z);
    for (size_t k = 0; k < count; k++) z[k] = 2.0 * test_random(&r) - 1.0;
    return z;
}

/* By the definition, term by term. */
static void check_length(int n)
{
    WrFft *fft = wr_fft_new(n, NULL);
    double *z = random_plane(2 * (size_t)n, (uint64_t)n),
           *was = wr_alloc((size_t)n, 2 * sizeof *was);
    double *scratch = wr_alloc(wr_fft_scratch(fft), sizeof *scratch);
    memcpy(was, z, 2 * (size_t)n * sizeof *z);
    wr_fft_run(fft, z, scratch);
    for (int k = 0; k < n; k++) {
        double re = 0.0, im = 0.0;
        for (int j = 0; j < n; j++) {
            double a = tau * (double)((long long)j * k % n) / n, c = cos(a), s = sin(a);
            re += was[2 * j] * c + was[2 * j + 1] * s;
            im += was[2 * j + 1] * c - was[2 * j] * s;
        }
        assert_near(z[2 * k], re, 2e-15 * n + 1e-14);
        assert_near(z[2 * k + 1], im, 2e-15 * n + 1e-14);
    }
    wr_free(z);
    wr_free(was);
    wr_free(scratch);
    wr_fft_free(fft);
}

static void transforms_of_any_length_are_their_sums(void **state)
{
    (void)state;
    static const int more[] = { 64, 97, 100, 120, 128, 169, 210, 256, 289, 499, 512 };
    for (int n = 1; n <= 40; n++) check_length(n);
    for (size_t k = 0; k < sizeof more / sizeof *more; k++) check_length(more[k]);
}

static double basis(WrEnds ends, int j, int k, int n)
{
    if (ends == WR_ENDS_FREE) return cos(0.5 * tau * (j + 0.5) * k / n);
    double a = tau * (double)((long long)j * k % n) / n;
    return cos(a) + sin(a);
}

static void real_lines_are_sums_of_their_functions_and_come_back(void **state)
{
    (void)state;
    static const int sizes[] = { 1, 2, 3, 8, 15, 34, 60, 101 };
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++)
        for (WrEnds ends = WR_ENDS_RING; ends <= WR_ENDS_FREE; ends++) {
            int n = sizes[s];
            WrFft *fft = wr_fft_new(n, NULL);
            double *z = random_plane(2 * (size_t)n, 5), *was = random_plane(2 * (size_t)n, 5);
            double *scratch = wr_alloc(2 * (size_t)n + wr_fft_scratch(fft), sizeof *scratch);
            wr_line_forward(fft, ends, z, z + n, scratch);
            for (int k = 0; k < n; k++) {
                double a = 0.0, b = 0.0;
                for (int j = 0; j < n; j++) {
                    a += was[j] * basis(ends, j, k, n);
                    b += was[n + j] * basis(ends, j, k, n);
                }
                assert_near(z[k], a, 1e-12);
                assert_near(z[n + k], b, 1e-12);
            }
            wr_line_back(fft, ends, z, z + n, scratch);
            for (int k = 0; k < 2 * n; k++) assert_near(z[k], was[k], 1e-14);
            wr_free(z);
            wr_free(was);
            wr_free(scratch);
            wr_fft_free(fft);
        }
}

/* Steps between texels of heights, and the heights restored from them, up to their mean. */
static void check_steps(int width, int height, WrEnds u, WrEnds v)
{
    size_t w = (size_t)width, count = w * (size_t)height;
    double *f = random_plane(count, 9), *g[2], mean = 0.0;
    static const WrSlopes steps[] = { WR_SLOPES_STEP, WR_SLOPES_STEP };
    WrPlane plane = { .width = width, .height = height, .ends = { u, v } };
    for (int a = 0; a < 2; a++) {
        g[a] = wr_alloc(count, sizeof *f);
        for (int j = 0; j < height; j++)
            for (int i = 0; i < width; i++) {
                int x = a == 0 ? (i + 1) % width : i, y = a == 1 ? (j + 1) % height : j;
                g[a][(size_t)j * w + (size_t)i] =
                    f[(size_t)y * w + (size_t)x] - f[(size_t)j * w + (size_t)i];
            }
        plane.z = g[a];
        assert_true(wr_plane_slope_adjoint(&plane, a, WR_SLOPES_STEP, NULL));
    }
    for (size_t k = 0; k < count; k++) g[0][k] += g[1][k];
    for (size_t k = 0; k < count; k++) mean += f[k] / (double)count;
    plane.z = g[0];
    assert_true(wr_plane_solve(&plane, steps, NULL));
    for (size_t k = 0; k < count; k++) assert_near(g[0][k], f[k] - mean, 1e-12 * (double)count);
    wr_free(f);
    wr_free(g[0]);
    wr_free(g[1]);
}

static void heights_come_back_from_their_steps_with_any_edges(void **state)
{
    (void)state;
    for (WrEnds u = WR_ENDS_RING; u <= WR_ENDS_FREE; u++)
        for (WrEnds v = WR_ENDS_RING; v <= WR_ENDS_FREE; v++) {
            check_steps(24, 17, u, v);
            check_steps(1, 9, u, v);
            check_steps(33, 2, u, v);
        }
}

static void any_number_of_threads_gives_the_same_bits(void **state)
{
    (void)state;
    enum { W = 70, H = 53 };
    static const WrSlopes smooth[] = { WR_SLOPES_SMOOTH, WR_SLOPES_SMOOTH };
    double *first = NULL;
    for (int threads = 1; threads <= 3; threads++) {
        WrPool *pool = wr_pool_new(threads);
        WrPlane plane = { .width = W, .height = H, .z = random_plane(W * H, 4), .pool = pool };
        assert_true(wr_plane_solve(&plane, smooth, NULL));
        if (first) assert_memory_equal(first, plane.z, W * H * sizeof *first);
        if (first) wr_free(plane.z);
        else first = plane.z;
        wr_pool_free(pool);
    }
    wr_free(first);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(transforms_of_any_length_are_their_sums),
        cmocka_unit_test(real_lines_are_sums_of_their_functions_and_come_back),
        cmocka_unit_test(heights_come_back_from_their_steps_with_any_edges),
        cmocka_unit_test(any_number_of_threads_gives_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
