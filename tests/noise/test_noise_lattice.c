/* Building blocks of noise: the integer hash and its statistics, the lecture's hash, range reduction. */
#include "test.h"

#include "noise/lattice.h"

#include <float.h>

/* Computed by hand with unlimited integers from the formula in lattice.h. */
static void hc66_the_hash_is_the_integer_formula(void **state)
{
    (void)state;
    assert_int_equal(wr_lattice_hash(0, (uint32_t[]){ 0 }, 1), 0xa53296b4);
    assert_int_equal(wr_lattice_hash(1, (uint32_t[]){ 0, 0 }, 2), 0x7e28d356);
    assert_int_equal(wr_lattice_hash(1, (uint32_t[]){ 1, 0 }, 2), 0x7176f913);
    assert_int_equal(wr_lattice_hash(1, (uint32_t[]){ 0, 1 }, 2), 0x11ea6b0a);
    assert_int_equal(wr_lattice_hash(7, (uint32_t[]){ 4294967295, 3, 12 }, 3), 0xf0cc2a09);
    uint32_t far[3] = { 1000000, 2000000, 3000000 };
    assert_int_equal(wr_lattice_hash(123456789, far, 3), 0x8f182519);
}

static void hc66_numbers_are_exact_in_float_and_symmetric(void **state)
{
    (void)state;
    assert_true(wr_lattice_number(0) == -1.0 + 0x1p-23);
    assert_true(wr_lattice_number(0xffffffff) == 1.0 - 0x1p-23);
    for (uint32_t h = 0; h < 0xfff00000U; h += 0xffff1U) {
        double x = wr_lattice_number(h);
        assert_true((double)(float)x == x && x != 0.0);
        assert_true(wr_lattice_number(~h) == -x);
    }
}

#define SIDE 300
#define COUNT (SIDE * SIDE)

/* Lattice numbers of a plane: axes selects the varying coordinates. */
static void lattice_plane(uint32_t seed, int dim, int across, int down, double *x)
{
    for (uint32_t k = 0; k < COUNT; k++) {
        uint32_t c[3] = { 1, 2, 3 };
        c[across] = k % SIDE;
        c[down] = k / SIDE;
        x[k] = wr_lattice_number(wr_lattice_hash(seed, c, dim));
    }
}

/* The correlation of x[k] with y[k + step], in units of its standard deviation for independent numbers
 * of variance 1/3. */
static double sigmas(const double *x, const double *y, int step)
{
    double sum = 0.0;
    for (int k = 0; k + step < COUNT; k++) sum += x[k] * y[k + step];
    return sum / sqrt((double)(COUNT - step)) * 3.0;
}

static void assert_random(double value_sigmas, uint32_t seed, const char *what)
{
    if (!(fabs(value_sigmas) <= 3.0))
        fail_msg("seed %u: %s is off by %.2f standard deviations", seed, what, value_sigmas);
}

static void hashed_values_have_the_mean_and_variance_of_uniform_ones(void **state)
{
    (void)state;
    static double x[COUNT];
    for (uint32_t seed = 1; seed <= 3; seed++) {
        lattice_plane(seed, 2, 0, 1, x);
        double sum = 0.0, sum2 = 0.0;
        for (int k = 0; k < COUNT; k++) sum += x[k], sum2 += x[k] * x[k];
        assert_random(sum / sqrt(COUNT / 3.0), seed, "the mean");
        /* x^2 has mean 1/3 and variance 1/5 - 1/9 */
        assert_random((sum2 - COUNT / 3.0) / sqrt(COUNT * (4.0 / 45.0)), seed, "the variance");
    }
}

static void neighbours_along_each_axis_do_not_correlate(void **state)
{
    (void)state;
    static const int planes[4][3] = { { 2, 0, 1 }, { 3, 0, 1 }, { 3, 0, 2 }, { 3, 1, 2 } };
    static double x[COUNT];
    uint32_t seed = 11;
    for (int p = 0; p < 4; p++) {
        lattice_plane(seed, planes[p][0], planes[p][1], planes[p][2], x);
        assert_random(sigmas(x, x, 1), seed, "the next point across");
        assert_random(sigmas(x, x, SIDE), seed, "the next point down");
        assert_random(sigmas(x, x, SIDE + 1), seed, "the diagonal");
        assert_random(sigmas(x, x, SIDE - 1), seed, "the other diagonal");
        assert_random(sigmas(x, x, 2), seed, "the point after the next");
    }
}

static void seeds_axes_and_slopes_do_not_correlate(void **state)
{
    (void)state;
    static double x[COUNT], y[COUNT], turned[COUNT], slope[2][COUNT];
    uint32_t seed = 23;
    lattice_plane(seed, 2, 0, 1, x);
    lattice_plane(seed + 1, 2, 0, 1, y);
    assert_random(sigmas(x, y, 0), seed, "the next seed");
    lattice_plane(seed, 2, 1, 0, turned);
    for (int k = 0; k < SIDE; k++) turned[k * SIDE + k] = 0.0; /* the diagonal is its own mirror */
    assert_random(sigmas(x, turned, 0) / sqrt(2.0), seed, "the mirror image");
    for (uint32_t k = 0; k < COUNT; k++) {
        uint32_t h = wr_lattice_hash(seed, (uint32_t[]){ k % SIDE, k / SIDE }, 2);
        for (int a = 0; a < 2; a++) slope[a][k] = wr_lattice_number(wr_lattice_slope_hash(h, a));
    }
    assert_random(sigmas(x, slope[0], 0), seed, "value and slope along x");
    assert_random(sigmas(x, slope[1], 0), seed, "value and slope along y");
    assert_random(sigmas(slope[0], slope[1], 0), seed, "the two slopes");
}

static void fixed_slopes_add_up_to_zero_and_are_drawn_equally_often(void **state)
{
    (void)state;
    static const int counts[5] = { 0, 16, 16, 12, 32 };
    static const double length2[5] = { 0, 0, 1, 2, 3 };
    uint32_t seed = 5;
    for (int dim = 1; dim <= 4; dim++) {
        int drawn[32] = { 0 }, n = counts[dim];
        double chi2 = 0.0, sum[4] = { 0 };
        const double *first = wr_lattice_gradient(dim, 0);
        for (uint32_t k = 0; k < COUNT; k++) {
            uint32_t h = wr_lattice_hash(seed, (uint32_t[]){ k % SIDE, k / SIDE }, 2);
            drawn[(wr_lattice_gradient(dim, h) - first) / dim]++;
        }
        for (int g = 0; g < n; g++) {
            double length = 0.0, expected = (double)COUNT / n;
            for (int a = 0; a < dim; a++) {
                sum[a] += first[g * dim + a];
                length += first[g * dim + a] * first[g * dim + a];
            }
            if (dim > 1) assert_near(length, length2[dim], 1e-15);
            chi2 += (drawn[g] - expected) * (drawn[g] - expected) / expected;
        }
        for (int a = 0; a < dim; a++) assert_near(sum[a], 0.0, 1e-15);
        assert_random((chi2 - (n - 1)) / sqrt(2.0 * (n - 1)), seed, "the number of draws");
    }
}

/* Against the text's formula with this machine's sine; the two may be on either side of an integer. */
static void the_lectures_hash_is_its_formula_in_double(void **state)
{
    (void)state;
    for (int k = 0; k < 10000; k++) {
        double x = k % 100 - 50, y = k / 100 - 50, salt = k % 7;
        double a = 5678.1234 * sin(12.3456 * x + 78.910 * y + 1.1235 + salt);
        double r = wr_hash_lecture(x, y, salt), off = fabs(r - (a - floor(a)));
        assert_true(r >= 0.0 && r < 1.0);
        assert_near(off < 0.5 ? off : 1.0 - off, 0.0, 1e-7);
    }
    assert_true(wr_hash_lecture(NAN, 0, 0) == 0.0 && wr_hash_lecture(0, DBL_MAX, INFINITY) == 0.0);
    assert_true(wr_hash_lecture(1e300, 0, 0) < 1.0);
    /* a tiny negative angle, whose fraction rounds to 1 */
    assert_true(wr_hash_lecture(-1e-300, 0, -1.1235) == 0.0);
}

static void hc61_reduction_is_floored_and_exact(void **state)
{
    (void)state;
    assert_true(wr_noise_reduce(-0.25, 4.0) == 3.75);
    assert_true(wr_noise_reduce(7.5, 3.0) == 1.5 && wr_noise_reduce(-7.5, 3.0) == 1.5);
    assert_true(wr_noise_reduce(12.0, 4.0) == 0.0 && wr_noise_reduce(-12.0, 4.0) == 0.0);
    assert_true(wr_noise_reduce(-1e-300, 4.0) == 0.0);
    assert_true(wr_noise_reduce(1e16, 7.0) == (double)(10000000000000000 % 7));
    assert_true(wr_noise_reduce(-1e16, 7.0) == (double)(7 - 10000000000000000 % 7));
    assert_true(wr_noise_reduce(0x1p1000, 3.0) == 1.0); /* 4^500 = 1 modulo 3 */
    assert_true(wr_noise_reduce(0x1p52 + 1.0, 0x1p30) == 1.0);
    assert_true(wr_noise_reduce(NAN, 3.0) == 0.0 && wr_noise_reduce(-INFINITY, 0.0) == 0.0);
    assert_true(wr_noise_reduce(-5.5, 0.0) == -5.5);
    TestRandom r = { 41 };
    for (int k = 0; k < 100000; k++) {
        double period = 1.0 + floor(1000.0 * test_random(&r));
        double t = ldexp(test_random(&r) - 0.5, k % 120 - 20);
        double reduced = wr_noise_reduce(t, period), exact = fmod(t, period);
        assert_true(reduced >= 0.0 && reduced < period);
        if (exact < 0.0) exact += period;
        assert_true(reduced == (exact < period ? exact : 0.0));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hc66_the_hash_is_the_integer_formula),
        cmocka_unit_test(hc66_numbers_are_exact_in_float_and_symmetric),
        cmocka_unit_test(hashed_values_have_the_mean_and_variance_of_uniform_ones),
        cmocka_unit_test(neighbours_along_each_axis_do_not_correlate),
        cmocka_unit_test(seeds_axes_and_slopes_do_not_correlate),
        cmocka_unit_test(fixed_slopes_add_up_to_zero_and_are_drawn_equally_often),
        cmocka_unit_test(the_lectures_hash_is_its_formula_in_double),
        cmocka_unit_test(hc61_reduction_is_floored_and_exact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
