/* Value, gradient and simplex noise at a point. */
#include "test.h"
#include "noise_cases.h"

#include "base/error.h"

#include <float.h>

/* Data for a lattice of up to 3 axes with periods 5, 4, 3. */
static double data_values[60], data_slopes[180];

static WrNoise data_noise(WrNoiseKind kind, WrFade fade, int dim)
{
    TestRandom r = { 5 };
    for (int k = 0; k < 60; k++) data_values[k] = 4.0 * test_random(&r) - 2.0;
    for (int k = 0; k < 180; k++) data_slopes[k] = 4.0 * test_random(&r) - 2.0;
    WrNoise noise = { .kind = kind,
                      .fade = fade,
                      .dim = dim,
                      .lattice = { .source = WR_LATTICE_DATA,
                                   .period = { 5, 4, 3 },
                                   .values = data_values,
                                   .slopes = data_slopes } };
    WrError err = { "" };
    if (!wr_noise_check(&noise, &err)) fail_msg("%s", err.text);
    return noise;
}

static void hc59_data_values_and_slopes_are_met_at_lattice_points(void **state)
{
    (void)state;
    for (int dim = 1; dim <= 3; dim++)
        for (int fade = 0; fade < WR_FADE_COUNT; fade++) {
            WrNoise noise = data_noise(WR_NOISE_GRADIENT, (WrFade)fade, dim);
            for (int k = 0; k < (dim == 1 ? 5 : dim == 2 ? 20 : 60); k++) {
                double t[3] = { k % 5 - 5.0, k / 5 % 4 + 8.0, k / 20 }, slope[3];
                assert_true(wr_noise_at(&noise, t, slope) == data_values[k]);
                for (int a = 0; fade != WR_FADE_LINEAR && a < dim; a++)
                    assert_true(slope[a] == data_slopes[k * dim + a]);
            }
        }
}

static void hc59_hashed_prescriptions_are_met_and_perlin_noise_is_zero(void **state)
{
    (void)state;
    WrNoise cases[NOISE_CASES];
    int count = noise_cases(cases), seen = 0;
    for (int n = 0; n < count; n++) {
        if (!wr_noises[cases[n].kind].cells) continue;
        for (uint32_t k = 0; k < 100; k++, seen++) {
            uint32_t c[3] = { k % 6, k / 6 % 12, k % 9 };
            double t[3] = { c[0], c[1], c[2] }, slope[3], given[3];
            double value = wr_noise_lattice_value(&cases[n], c, given);
            assert_true(wr_noise_at(&cases[n], t, slope) == value);
            if (cases[n].kind == WR_NOISE_PERLIN) assert_true(value == 0.0);
            for (int a = 0; cases[n].fade != WR_FADE_LINEAR && a < cases[n].dim; a++)
                assert_true(slope[a] == given[a]);
        }
    }
    assert_true(seen > 3000);
}

/* At a lattice point only its own kernel contributes, with value 0 and a slope of the fixed set's length: c reach^4
 * |g|, the same at all. */
static void hc59_simplex_noise_is_zero_at_lattice_points_with_slopes_of_one_length(void **state)
{
    (void)state;
    double g2 = (1.0 - 1.0 / sqrt(3.0)) / 2.0;
    for (int k = 0; k < 200; k++) {
        int q[3] = { k % 7 - 3, k / 7 % 5 - 2, k / 35 - 1 };
        double d[3], sum2 = g2 * (q[0] + q[1]), sum3 = (q[0] + q[1] + q[2]) / 6.0;
        WrNoise flat = { .kind = WR_NOISE_SIMPLEX, .dim = 2 };
        assert_near(wr_noise_at(&flat, (double[]){ q[0] - sum2, q[1] - sum2 }, d), 0.0, 1e-13);
        assert_near(hypot(d[0], d[1]), 99.2 / 16.0, 1e-11);
        WrNoise solid = { .kind = WR_NOISE_SIMPLEX, .dim = 3 };
        double t[3] = { q[0] - sum3, q[1] - sum3, q[2] - sum3 };
        assert_near(wr_noise_at(&solid, t, d), 0.0, 1e-13);
        assert_near(sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), 107.6 / 16.0, 1e-11);
        WrNoise sheared = { .kind = WR_NOISE_SHEARED, .dim = 2 };
        assert_true(wr_noise_at(&sheared, (double[]){ q[0] + 0.5 * (q[1] & 1), q[1] }, d) == 0.0);
        assert_near(hypot(d[0], d[1]), 10.92 * 0.4096, 1e-12);
    }
}

/* The lecture's formulas, written out. */
static void two_dimensions_are_the_lectures_four_corners(void **state)
{
    (void)state;
    TestRandom r = { 8 };
    for (int k = 0; k < 2000; k++) {
        WrFade fade = (WrFade)(k % WR_FADE_COUNT);
        double x = 5.0 * test_random(&r), y = 4.0 * test_random(&r);
        int x0 = (int)x, y0 = (int)y, x1 = (x0 + 1) % 5, y1 = (y0 + 1) % 4;
        double a = x - x0, b = y - y0;
        double fa = wr_fade_value(&wr_fades[fade], a), fb = wr_fade_value(&wr_fades[fade], b);
        int at[4] = { 5 * y0 + x0, 5 * y0 + x1, 5 * y1 + x0, 5 * y1 + x1 };
        double weight[4] = { (1 - fa) * (1 - fb), fa * (1 - fb), (1 - fa) * fb, fa * fb };
        double value = 0.0, lambda = 0.0;
        WrNoise noise = data_noise(WR_NOISE_VALUE, fade, 2);
        for (int c = 0; c < 4; c++) {
            const double *g = &data_slopes[2 * at[c]];
            value += weight[c] * data_values[at[c]];
            lambda +=
                weight[c] * (data_values[at[c]] + g[0] * (a - (c & 1)) + g[1] * (b - (c >> 1)));
        }
        assert_near(wr_noise_at(&noise, (double[]){ x, y }, NULL), value, 1e-14);
        noise.kind = WR_NOISE_GRADIENT;
        assert_near(wr_noise_at(&noise, (double[]){ x, y }, NULL), lambda, 2e-14);
    }
}

/* f'(0+) = g0 + (f1 - f0 - g1) with the fade x, so slopes are missed; with a smooth fade f''(0+) =
 * alpha''(0) (f1 - f0 - g1) and f''(1-) = alpha''(1) (f1 - f0 - g0), where alpha'' is +-6 for the cubic
 * and 0 for the quintic. */
static void fades_are_as_smooth_as_their_rows_say(void **state)
{
    (void)state;
    const double h = 1e-6;
    for (int k = 0; k < 5; k++) {
        double f0 = 0, f1 = 0, g0 = 0, g1 = 0, at0, at1, d0, d1;
        for (int fade = 0; fade < WR_FADE_COUNT; fade++) {
            WrNoise noise = data_noise(WR_NOISE_GRADIENT, (WrFade)fade, 1);
            f0 = data_values[k], f1 = data_values[(k + 1) % 5];
            g0 = data_slopes[k], g1 = data_slopes[(k + 1) % 5];
            wr_noise_at(&noise, (double[]){ k }, &at0);
            wr_noise_at(&noise, (double[]){ k + h }, &d0);
            wr_noise_at(&noise, (double[]){ k + 1.0 }, &at1);
            wr_noise_at(&noise, (double[]){ k + 1 - h }, &d1);
            if (wr_fades[fade].continuity == 0) {
                assert_near(at0, g0 + (f1 - f0 - g1), 1e-14);
                assert_near(d1, g1 + (f1 - f0 - g0), 1e-4);
                continue;
            }
            double second = wr_fades[fade].continuity == 1 ? 6.0 : 0.0;
            assert_near((d0 - at0) / h, second * (f1 - f0 - g1), 2e-3);
            assert_near((at1 - d1) / h, -second * (f1 - f0 - g0), 2e-3);
        }
    }
}

static void fades_add_up_to_one_with_their_mirror_image(void **state)
{
    (void)state;
    for (int k = 0; k < WR_FADE_COUNT; k++) {
        const WrFadeInfo *fade = &wr_fades[k];
        assert_true(wr_fade_value(fade, 0.0) == 0.0 && wr_fade_value(fade, 1.0) == 1.0);
        assert_true(wr_fade_value(fade, 0.5) == 0.5);
        assert_true((wr_fade_slope(fade, 0.0) == 0.0) == (fade->continuity > 0));
        for (double x = 0.0; x <= 1.0; x += 0x1p-6)
            assert_near(wr_fade_value(fade, x) + wr_fade_value(fade, 1.0 - x), 1.0, 4e-16);
    }
}

/* Values have code of their own where no slopes are wanted. */
static void a_value_has_the_same_bits_with_and_without_slopes(void **state)
{
    (void)state;
    TestRandom r = { 77 };
    for (int k = 0; k < 40000; k++) {
        WrNoise noise = { .kind = WR_NOISE_PERLIN, .dim = 2, .fade = k % WR_FADE_COUNT };
        noise.lattice.seed = (uint32_t)test_random_u64(&r);
        for (int a = 0; a < 2; a++) noise.lattice.period[a] = (int)(test_random_u64(&r) % 7);
        double t[3], slope[3];
        random_place(&r, t);
        if (k % 5 == 0) t[0] = floor(t[0]), t[1] *= 1e9;
        const double with = wr_noise_at(&noise, t, slope), without = wr_noise_at(&noise, t, NULL);
        assert_memory_equal(&with, &without, sizeof with);
    }
}

/* The largest difference between the analytic slope and a central difference of step h. */
static double slope_error(const WrNoise *noise, double h)
{
    TestRandom r = { 21 };
    double worst = 0.0;
    for (int k = 0; k < 300; k++) {
        double t[3], slope[3];
        random_place(&r, t);
        wr_noise_at(noise, t, slope);
        for (int a = 0; a < noise->dim; a++) {
            double up[3] = { t[0], t[1], t[2] }, down[3] = { t[0], t[1], t[2] };
            up[a] += h, down[a] -= h;
            double f1 = wr_noise_at(noise, up, NULL), f0 = wr_noise_at(noise, down, NULL);
            double off = fabs((f1 - f0) / (2.0 * h) - slope[a]);
            worst = off > worst ? off : worst;
        }
    }
    return worst;
}

static void gradients_are_those_of_the_values_to_second_order(void **state)
{
    (void)state;
    WrNoise cases[NOISE_CASES];
    int count = noise_cases(cases), curved = 0;
    for (int n = 0; n < count; n++) {
        double coarse = slope_error(&cases[n], 4e-3), fine = slope_error(&cases[n], 2e-3);
        const char *name = noise_case_name(&cases[n]);
        bool straight = cases[n].kind == WR_NOISE_VALUE && cases[n].fade == WR_FADE_LINEAR;
        if (coarse > 5e-3) fail_msg("%s: slopes are off by %g", name, coarse);
        if (straight || coarse < 1e-11) {
            assert_near(coarse, 0.0, 1e-11); /* at most quadratic along an axis */
            continue;
        }
        if (!(coarse / fine > 3.5 && coarse / fine < 4.5))
            fail_msg("%s: halving the step divides the error by %g", name, coarse / fine);
        curved++;
    }
    assert_true(curved > 40);
}

static void hc60_negative_coordinates_are_as_good_as_others(void **state)
{
    (void)state;
    WrNoise cases[NOISE_CASES];
    int count = noise_cases(cases);
    TestRandom r = { 3 };
    for (int n = 0; n < count; n++) {
        const WrNoise *noise = &cases[n];
        for (int a = 0; a < noise->dim; a++) {
            double t[3] = { 0.3, 0.7, 0.6 }, minus[3], slope[3], f;
            t[a] = 0.0;
            f = wr_noise_at(noise, t, slope);
            memcpy(minus, t, sizeof t);
            minus[a] = -0.0;
            assert_true(same_bits(wr_noise_at(noise, minus, NULL), f));
            minus[a] = -1e-9;
            assert_near(wr_noise_at(noise, minus, NULL), f, 2e-8);
            minus[a] = -1e-300; /* one period more rounds to the period itself */
            assert_near(wr_noise_at(noise, minus, NULL), f, 1e-13);
        }
        for (int k = 0; k < 50 && noise->lattice.period[0]; k++) {
            double t[3], moved[3];
            for (int a = 0; a < 3; a++) {
                t[a] = floor(4096.0 * test_random(&r)) / 256.0;
                moved[a] = t[a] - (k % 5) * noise->lattice.period[a];
            }
            double slope[3], again[3];
            double f = wr_noise_at(noise, t, slope), g = wr_noise_at(noise, moved, again);
            assert_true(same_bits(f, g));
            for (int a = 0; a < noise->dim; a++) assert_true(same_bits(slope[a], again[a]));
        }
    }
}

static void hc61_huge_coordinates_are_reduced_exactly(void **state)
{
    (void)state;
    for (int dim = 1; dim <= 3; dim++) {
        WrNoise noise = data_noise(WR_NOISE_GRADIENT, WR_FADE_QUINTIC, dim);
        const int64_t whole[] = { 10000000, 10000000000000000, 9007199254740993 - 1, 1LL << 62 };
        for (int k = 0; k < 8; k++) {
            int64_t t = k & 1 ? -whole[k / 2] : whole[k / 2];
            int at = (int)(((t % 5) + 5) % 5);
            assert_true(wr_noise_at(&noise, (double[]){ (double)t, 0, 0 }, NULL) ==
                        data_values[at]);
        }
    }
    WrNoise cases[NOISE_CASES];
    int count = noise_cases(cases);
    const double wild[] = { 2147483648.5, -2147483649.25, 1e16, -1e22, 1e300, DBL_MAX, -DBL_MAX };
    for (int n = 0; n < count; n++)
        for (size_t k = 0; k < sizeof wild / sizeof *wild; k++) {
            double t[3] = { wild[k], wild[(k + 1) % 7], wild[(k + 2) % 7] }, slope[3];
            double f = wr_noise_at(&cases[n], t, slope);
            assert_true(fabs(f) <= wr_noise_bound(&cases[n]));
            for (int a = 0; a < cases[n].dim; a++) assert_true(isfinite(slope[a]));
            for (int a = 0; a < cases[n].dim; a++) {
                int period = cases[n].lattice.period[a];
                if (period) t[a] = fmod(fmod(t[a], period) + period, period);
            }
            if (cases[n].lattice.period[0])
                assert_true(same_bits(wr_noise_at(&cases[n], t, NULL), f));
        }
}

static void what_is_not_finite_counts_as_zero(void **state)
{
    (void)state;
    WrNoise cases[NOISE_CASES];
    int count = noise_cases(cases);
    const double bad[] = { NAN, INFINITY, -INFINITY };
    for (int n = 0; n < count; n++)
        for (int k = 0; k < 3; k++) {
            double t[3] = { 0.25, bad[k], 0.5 }, mended[3] = { 0.25, 0.0, 0.5 };
            assert_true(
                same_bits(wr_noise_at(&cases[n], t, NULL), wr_noise_at(&cases[n], mended, NULL)));
        }
}

/* Ties in the order of fractions, and points where a skewed coordinate is an integer: rounding chooses the simplex on
 * either side. */
static void hc67_simplex_noise_is_continuous_across_faces(void **state)
{
    (void)state;
    TestRandom r = { 12 };
    for (int k = 0; k < 4000; k++) {
        int dim = 2 + k % 2;
        WrNoise noise = { .kind = WR_NOISE_SIMPLEX, .dim = dim, .lattice = { .seed = 4 } };
        double g = dim == 2 ? (1.0 - 1.0 / sqrt(3.0)) / 2.0 : 1.0 / 6.0, q[3], sum = 0.0;
        for (int a = 0; a < dim; a++) q[a] = 4.0 * test_random(&r) - 2.0;
        if (k & 2) q[0] = floor(q[0]);
        else q[0] = q[1];
        if (k % 16 == 5) q[dim - 1] = q[0];
        for (int a = 0; a < dim; a++) sum += q[a];
        double t[3] = { q[0] - g * sum, q[1] - g * sum, q[2] - g * sum }, d[3], d0[3];
        double f = wr_noise_at(&noise, t, d);
        for (int side = 0; side < 6; side++) {
            double near[3] = { t[0], t[1], t[2] };
            near[side % 3] += side < 3 ? 4e-15 : -4e-15;
            assert_near(wr_noise_at(&noise, near, d0), f, 1e-12);
            for (int a = 0; a < dim; a++) assert_near(d0[a], d[a], 1e-11);
        }
    }
}

/* The last value before a period's end against the first of the next: values and slopes of all periodic noises; this
 * also requires that the hash ignores index shifts by (4m, m, m). */
static void a11_the_seam_of_a_period_is_smooth(void **state)
{
    (void)state;
    WrNoise cases[NOISE_CASES];
    int count = noise_cases(cases), seen = 0;
    TestRandom r = { 77 };
    for (int n = 0; n < count; n++) {
        const WrNoise *noise = &cases[n];
        if (!noise->lattice.period[0]) continue;
        for (int k = 0; k < 200; k++) {
            double t[3], before[3], d[3], d0[3];
            for (int a = 0; a < 3; a++) t[a] = before[a] = 12.0 * test_random(&r);
            int across = k % noise->dim;
            t[across] = 0.0;
            before[across] = noise->lattice.period[across] - 1e-11;
            assert_near(wr_noise_at(noise, before, d0), wr_noise_at(noise, t, d), 1e-9);
            bool creased = wr_noises[noise->kind].cells && noise->fade == WR_FADE_LINEAR;
            for (int a = 0; !creased && a < noise->dim; a++) assert_near(d0[a], d[a], 1e-8);
            seen++;
        }
    }
    assert_true(seen > 5000);
}

/* Inside its first period the 3D noise equals the aperiodic one, so the test above does not use a noise flattened at
 * its edges. */
static void a_period_changes_simplex_noise_only_where_it_repeats(void **state)
{
    (void)state;
    TestRandom r = { 6 };
    WrNoise repeats = { .kind = WR_NOISE_SIMPLEX,
                        .dim = 3,
                        .lattice = { .period = { 9, 12, 15 } } };
    WrNoise plain = { .kind = WR_NOISE_SIMPLEX, .dim = 3 };
    int differ = 0;
    for (int k = 0; k < 500; k++) {
        /* Here 6 q_a - sum of q is between 0 and the period's 6 P. */
        double t[3] = { 2 + 5 * test_random(&r), 2 + 8 * test_random(&r),
                        2 + 11 * test_random(&r) };
        assert_true(same_bits(wr_noise_at(&repeats, t, NULL), wr_noise_at(&plain, t, NULL)));
        t[0] += 9.0;
        differ += wr_noise_at(&repeats, t, NULL) != wr_noise_at(&plain, t, NULL);
    }
    assert_true(differ > 490);
}

static void a12_value_noise_stays_between_its_corners(void **state)
{
    (void)state;
    TestRandom r = { 2 };
    for (int k = 0; k < 3000; k++) {
        int dim = 1 + k % 3;
        WrNoise noise = data_noise(WR_NOISE_VALUE, (WrFade)(k / 3 % WR_FADE_COUNT), dim);
        double t[3] = { 5 * test_random(&r), 4 * test_random(&r), 3 * test_random(&r) };
        double low = INFINITY, high = -INFINITY;
        for (int c = 0; c < 1 << dim; c++) {
            int i = ((int)t[0] + (c & 1)) % 5, j = ((int)t[1] + (c >> 1 & 1)) % 4;
            int l = ((int)t[2] + (c >> 2 & 1)) % 3;
            double v = data_values[i + (dim > 1 ? 5 * j : 0) + (dim > 2 ? 20 * l : 0)];
            low = v < low ? v : low;
            high = v > high ? v : high;
        }
        double f = wr_noise_at(&noise, t, NULL);
        assert_true(f >= low - 4e-16 && f <= high + 4e-16);
    }
}

static void bounds_hold_and_are_not_far_away(void **state)
{
    (void)state;
    WrNoise cases[NOISE_CASES];
    int count = noise_cases(cases);
    for (int n = 0; n < count; n++) {
        TestRandom r = { 31 };
        double bound = wr_noise_bound(&cases[n]), most = 0.0;
        for (int k = 0; k < 20000; k++) {
            double t[3];
            random_place(&r, t);
            cases[n].lattice.seed = (uint32_t)k;
            double f = fabs(wr_noise_at(&cases[n], t, NULL));
            most = f > most ? f : most;
        }
        if (!(most <= bound && most > 0.4 * bound))
            fail_msg("%s: reaches %g of %g", noise_case_name(&cases[n]), most, bound);
    }
    WrNoise data = data_noise(WR_NOISE_GRADIENT, WR_FADE_QUINTIC, 1);
    double value = 0.0, slope = 0.0;
    for (int k = 0; k < 5; k++) {
        value = fmax(value, fabs(data_values[k]));
        slope = fmax(slope, fabs(data_slopes[k]));
    }
    assert_near(wr_noise_bound(&data), value + 0.5 * slope, 1e-15);
}

static void assert_refused(WrNoise noise, const char *part)
{
    WrError err = { "" };
    assert_false(wr_noise_check(&noise, &err));
    if (!strstr(err.text, part)) fail_msg("\"%s\" is not in \"%s\"", part, err.text);
}

static void what_does_not_fit_together_is_refused_with_a_reason(void **state)
{
    (void)state;
    const WrNoise value = { .kind = WR_NOISE_VALUE, .dim = 2 };
    WrNoise bad = value;
    bad.kind = (WrNoiseKind)99;
    assert_refused(bad, "noise kind 99: must be 0..6");
    bad = value, bad.fade = (WrFade)-1;
    assert_refused(bad, "fade -1: must be 0..2");
    bad = value, bad.dim = 4;
    assert_refused(bad, "4 dimensions: must be 1..3");
    bad = value, bad.lattice.source = (WrLatticeSource)7;
    assert_refused(bad, "lattice source 7");
    bad = value, bad.lattice.period[1] = -1;
    assert_refused(bad, "period -1 along y");
    bad = value, bad.lattice.period[0] = WR_LATTICE_MAX + 1;
    assert_refused(bad, "period 1073741825 along x");
    bad = value, bad.dim = 3, bad.lattice.source = WR_LATTICE_LECTURE;
    assert_refused(bad, "1D or 2D");

    bad = (WrNoise){ .kind = WR_NOISE_SIMPLEX, .dim = 2, .lattice = { .period = { 4, 4 } } };
    assert_refused(bad, "simplex noise in 2D cannot repeat on a square");
    bad.dim = 1;
    assert_refused(bad, "2D and 3D only");
    bad.dim = 3;
    assert_refused(bad, "period 4 along x: must be a multiple of 3");
    bad = (WrNoise){ .kind = WR_NOISE_SHEARED, .dim = 2, .lattice = { .period = { 5, 5 } } };
    assert_refused(bad, "period 5 along y: must be a multiple of 2");
    bad.dim = 3;
    assert_refused(bad, "2D only");
    bad = (WrNoise){ .kind = WR_NOISE_TORUS, .dim = 2 };
    assert_refused(bad, "torus noise needs a period along x");
    bad.lattice.source = WR_LATTICE_LECTURE;
    assert_refused(bad, "integer hash only");
}

static void data_that_cannot_be_a_lattice_is_refused(void **state)
{
    (void)state;
    WrNoise good = data_noise(WR_NOISE_GRADIENT, WR_FADE_CUBIC, 2), bad = good;
    bad.lattice.values = NULL;
    assert_refused(bad, "there are no values");
    bad = good, bad.lattice.slopes = NULL;
    assert_refused(bad, "there are no slopes");
    bad.kind = WR_NOISE_VALUE;
    assert_true(wr_noise_check(&bad, NULL));
    bad = good, bad.lattice.period[1] = 0;
    assert_refused(bad, "from data needs a period along y");
    bad = good, bad.kind = WR_NOISE_PERLIN;
    assert_refused(bad, "perlin noise from data");
    bad = good, bad.dim = 3;
    for (int a = 0; a < 3; a++) bad.lattice.period[a] = WR_LATTICE_MAX;
    assert_refused(bad, "the lattice is too large");
    data_slopes[39] = NAN;
    assert_refused(good, "slope 39 is not a finite number");
    data_values[19] = INFINITY;
    assert_refused(good, "value 19 is not a finite number");
}

static void every_row_of_the_table_is_whole(void **state)
{
    (void)state;
    for (int k = 0; k < WR_NOISE_KIND_COUNT; k++) {
        assert_int_equal(wr_noise_find(wr_noises[k].name), k);
        assert_true(wr_noises[k].label && wr_noises[k].help && wr_noises[k].repeat[1].works);
    }
    assert_int_equal(wr_noise_find("worley"), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hc59_data_values_and_slopes_are_met_at_lattice_points),
        cmocka_unit_test(hc59_hashed_prescriptions_are_met_and_perlin_noise_is_zero),
        cmocka_unit_test(hc59_simplex_noise_is_zero_at_lattice_points_with_slopes_of_one_length),
        cmocka_unit_test(two_dimensions_are_the_lectures_four_corners),
        cmocka_unit_test(fades_are_as_smooth_as_their_rows_say),
        cmocka_unit_test(fades_add_up_to_one_with_their_mirror_image),
        cmocka_unit_test(a_value_has_the_same_bits_with_and_without_slopes),
        cmocka_unit_test(gradients_are_those_of_the_values_to_second_order),
        cmocka_unit_test(hc60_negative_coordinates_are_as_good_as_others),
        cmocka_unit_test(hc61_huge_coordinates_are_reduced_exactly),
        cmocka_unit_test(what_is_not_finite_counts_as_zero),
        cmocka_unit_test(hc67_simplex_noise_is_continuous_across_faces),
        cmocka_unit_test(a11_the_seam_of_a_period_is_smooth),
        cmocka_unit_test(a_period_changes_simplex_noise_only_where_it_repeats),
        cmocka_unit_test(a12_value_noise_stays_between_its_corners),
        cmocka_unit_test(bounds_hold_and_are_not_far_away),
        cmocka_unit_test(what_does_not_fit_together_is_refused_with_a_reason),
        cmocka_unit_test(data_that_cannot_be_a_lattice_is_refused),
        cmocka_unit_test(every_row_of_the_table_is_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
