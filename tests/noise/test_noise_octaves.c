/* Sums of noise octaves: requested and dropped octaves, modes, slopes, warping. */
#include "test.h"

#include "base/error.h"
#include "noise/octaves.h"

static WrOctavesPlan plan_of(const WrOctaves *octaves)
{
    WrOctavesPlan plan;
    WrError err = { "" };
    if (!wr_octaves_plan(octaves, NULL, &plan, &err)) fail_msg("%s", err.text);
    return plan;
}

/* Kinds and dimensions that tile. */
#define TILING 13
static int tiling_sums(WrOctaves *out)
{
    int count = 0;
    for (int kind = 0; kind < WR_NOISE_KIND_COUNT; kind++)
        for (int dim = 1; dim <= 3; dim++) {
            WrOctaves octaves = wr_octaves_default(dim);
            octaves.kind = (WrNoiseKind)kind;
            octaves.count = 4;
            octaves.cells[0] = 3, octaves.cells[1] = 6, octaves.cells[2] = 3;
            WrOctavesPlan plan;
            if (wr_octaves_plan(&octaves, NULL, &plan, NULL)) out[count++] = octaves;
        }
    assert_int_equal(count, TILING);
    return count;
}

static void the_sum_is_the_lectures_series(void **state)
{
    (void)state;
    TestRandom r = { 1 };
    WrOctaves octaves = wr_octaves_default(2);
    octaves.kind = WR_NOISE_GRADIENT;
    octaves.ratio = 3.0;
    octaves.count = 5;
    double offsets[10];
    for (int k = 0; k < 10; k++) offsets[k] = 100.0 * test_random(&r) - 50.0;
    octaves.offsets = offsets;
    WrOctavesPlan plan = plan_of(&octaves);
    for (int k = 0; k < 500; k++) {
        double p[2] = { test_random(&r), test_random(&r) }, sum = 0.0;
        for (int i = 0; i < 5; i++) {
            double s = ldexp(4.0, i);
            double t[2] = { s * p[0] + offsets[2 * i], s * p[1] + offsets[2 * i + 1] };
            WrNoise noise = plan.octave[i].noise;
            assert_int_equal(noise.lattice.period[0], (int)s);
            sum += pow(3.0, -i) * wr_noise_at(&noise, t, NULL);
        }
        assert_near(wr_octaves_at(&plan, p, NULL), sum, 1e-11);
    }
    for (int i = 1; i < 5; i++)
        assert_true(plan.octave[i].noise.lattice.seed != plan.octave[i - 1].noise.lattice.seed);
}

/* With one lattice for all octaves the sum is g(t) + g(2t)/2 + g(4t)/4 + ... of one g with n cells, as in the
   lecture; here g is evaluated separately at each point. */
static void one_lattice_is_the_lectures_literal_sum(void **state)
{
    (void)state;
    TestRandom r = { 3 };
    static const WrNoiseKind kinds[] = { WR_NOISE_VALUE,   WR_NOISE_GRADIENT, WR_NOISE_PERLIN,
                                         WR_NOISE_SHEARED, WR_NOISE_TORUS,    WR_NOISE_CUBES };
    for (int k = 0; k < 18; k++) {
        const WrNoiseKind kind = kinds[k % 6];
        const double step = 2 + k / 6 % 2;
        const int n = 8;
        WrOctaves octaves = wr_octaves_default(2);
        octaves.kind = kind;
        octaves.count = 4;
        octaves.step = octaves.ratio = step;
        octaves.cells[0] = octaves.cells[1] = n;
        octaves.scatter = false;
        octaves.one_lattice = true;
        WrOctavesPlan plan = plan_of(&octaves);
        octaves.count = 1;
        const WrNoise g = plan_of(&octaves).octave[0].noise;
        assert_int_equal(g.lattice.period[0], n);
        for (int i = 0; i < 200; i++) {
            double p[2] = { test_random(&r), test_random(&r) }, sum = 0;
            for (int o = 0; o < 4; o++) {
                const double t[2] = { n * p[0] * pow(step, o), n * p[1] * pow(step, o) };
                sum += wr_noise_at(&g, t, NULL) / pow(step, o);
            }
            assert_near(wr_octaves_at(&plan, p, NULL), sum, 1e-9);
            p[0] += 1, p[1] -= 1; /* and it tiles */
            assert_near(wr_octaves_at(&plan, p, NULL), sum, 1e-9);
        }
    }
    /* at the origin all octaves are at one lattice point: value noise is 1 + 1/2 + 1/4 times its height there */
    WrOctaves value = wr_octaves_default(2);
    value.kind = WR_NOISE_VALUE;
    value.count = 3;
    value.scatter = false;
    value.one_lattice = true;
    const WrOctavesPlan plan = plan_of(&value);
    const double origin[2] = { 0, 0 };
    assert_near(wr_octaves_at(&plan, origin, NULL),
                1.75 * wr_noise_at(&plan.octave[0].noise, origin, NULL), 1e-12);
    /* a step that is not an integer tiles all the same */
    value.step = 1.7;
    const WrOctavesPlan odd = plan_of(&value);
    const double a[2] = { 0.3, 0.1 }, b[2] = { 1.3, -0.9 };
    assert_near(wr_octaves_at(&odd, a, NULL), wr_octaves_at(&odd, b, NULL), 1e-9);
}

static void modes_are_their_formulas_and_stay_within_the_bound(void **state)
{
    (void)state;
    TestRandom r = { 2 };
    WrOctaves octaves = wr_octaves_default(2);
    octaves.count = 6;
    octaves.ridge_offset = 0.9;
    octaves.ridge_gain = 1.7;
    for (int k = 0; k < 4000; k++) {
        octaves.mode = (WrOctavesMode)(k % WR_OCTAVES_MODE_COUNT);
        WrOctavesPlan plan = plan_of(&octaves);
        double p[2] = { test_random(&r), test_random(&r) }, sum = 0.0, w = 1.0;
        for (int i = 0; i < 6; i++) {
            const WrOctave *o = &plan.octave[i];
            double t[2] = { o->frequency[0] * p[0] + o->offset[0],
                            o->frequency[1] * p[1] + o->offset[1] };
            double f = wr_noise_at(&o->noise, t, NULL), ridge = w * pow(0.9 - fabs(f), 2.0);
            double terms[] = { f, fabs(f), 2.0 * fabs(f) - 1.0, ridge };
            sum += ldexp(terms[octaves.mode], -i);
            w = fmin(1.0, 1.7 * ridge);
        }
        assert_near(wr_octaves_at(&plan, p, NULL), sum, 1e-14);
        assert_true(fabs(sum) <= plan.bound && plan.bound < 2.5);
    }
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The median error of the analytic slope against central differences of step h; *bad is the fraction of points with
 * an error over 1/100, possible only within h of a crease. */
static double slope_error(double (*at)(const void *, const double *, double *), const void *ctx,
                          int dim, double h, double *bad)
{
    TestRandom r = { 9 };
    double errors[1200];
    int count = 0, over = 0;
    for (int k = 0; k < 400; k++) {
        double p[3], slope[3];
        for (int a = 0; a < 3; a++) p[a] = 2.0 * test_random(&r) - 1.0;
        at(ctx, p, slope);
        for (int a = 0; a < dim; a++) {
            double up[3] = { p[0], p[1], p[2] }, down[3] = { p[0], p[1], p[2] };
            up[a] += h, down[a] -= h;
            double off = (at(ctx, up, NULL) - at(ctx, down, NULL)) / (2.0 * h) - slope[a];
            errors[count++] = fabs(off);
            over += fabs(off) > 0.01;
        }
    }
    *bad = (double)over / count;
    qsort(errors, (size_t)count, sizeof *errors, by_size);
    return errors[count / 2];
}

static double plain(const void *ctx, const double *p, double *slope)
{
    return wr_octaves_at(ctx, p, slope);
}

static void slopes_are_those_of_the_sums(void **state)
{
    (void)state;
    WrOctaves sums[TILING];
    int count = tiling_sums(sums);
    for (int n = 0; n < count; n++)
        for (int mode = 0; mode < WR_OCTAVES_MODE_COUNT; mode++) {
            sums[n].mode = (WrOctavesMode)mode;
            WrOctavesPlan plan = plan_of(&sums[n]);
            double bad, bad_fine;
            double coarse = slope_error(plain, &plan, plan.dim, 4e-5, &bad);
            double fine = slope_error(plain, &plan, plan.dim, 2e-5, &bad_fine);
            assert_true(bad < 0.03 && bad_fine < 0.015);
            if (!(coarse < 3e-4 && coarse / fine > 3.8 && coarse / fine < 4.2))
                fail_msg("%s %dD %s: slopes off by %g, and by %g at half the step",
                         wr_noises[sums[n].kind].name, plan.dim, wr_octaves_words[mode], coarse,
                         fine);
        }
}

static void hc62_octaves_beyond_half_a_cell_a_texel_are_dropped(void **state)
{
    (void)state;
    assert_int_equal(wr_octaves_usable(4, 2, 256), 6); /* 4 .. 128 */
    assert_int_equal(wr_octaves_usable(4, 2, 255), 5);
    assert_int_equal(wr_octaves_usable(128, 2, 256), 1);
    assert_int_equal(wr_octaves_usable(129, 2, 256), 0);
    assert_int_equal(wr_octaves_usable(1, 1.000001, 2), 1);
    assert_int_equal(wr_octaves_usable(1, 1.000001, 1024), WR_OCTAVES_MAX);
    assert_int_equal(wr_octaves_usable(1, 1e300, 0), 1);
    assert_int_equal(wr_octaves_usable(1, 2, 0), 31); /* 2^0 .. 2^30 */
    for (double n0 = 1.3; n0 < 40.0; n0 += 2.9)
        for (double s = 1.7; s < 4.0; s += 0.3)
            assert_int_equal(wr_octaves_usable(n0, s, 1000),
                             1 + (int)floor(log(1000.0 / (2.0 * n0)) / log(s)));

    WrOctaves octaves = wr_octaves_default(2);
    WrOctavesPlan plan;
    assert_true(wr_octaves_plan(&octaves, (int[]){ 256, 4096 }, &plan, NULL));
    assert_true(plan.asked == 8 && plan.used == 6);
    WrOctavesPlan six = (octaves.count = 6, plan_of(&octaves));
    for (int k = 0; k < 50; k++) {
        double p[2] = { k * 0.37, k * 0.11 };
        assert_true(same_bits(wr_octaves_at(&plan, p, NULL), wr_octaves_at(&six, p, NULL)));
    }
    assert_true(wr_octaves_plan(&octaves, (int[]){ 4, 4 }, &plan, NULL));
    assert_int_equal(plan.used, 0);
    assert_true(wr_octaves_at(&plan, (double[]){ 0.3, 0.4 }, NULL) == 0.0 && plan.bound == 0.0);
}

/* W texels and a lattice of 2W cells: texel centres are odd lattice points. With W cells they are the cells' centres.
 */
static void hc63_samples_on_the_lattice_see_no_perlin_noise_and_white_value_noise(void **state)
{
    (void)state;
    enum { W = 300 };
    WrOctaves octaves = wr_octaves_default(2);
    octaves.count = 1;
    octaves.scatter = false;
    octaves.cells[0] = octaves.cells[1] = 2 * W;
    WrOctavesPlan perlin = plan_of(&octaves);
    octaves.kind = WR_NOISE_VALUE;
    WrOctavesPlan value = plan_of(&octaves);
    octaves.kind = WR_NOISE_PERLIN;
    octaves.cells[0] = octaves.cells[1] = W;
    WrOctavesPlan middle = plan_of(&octaves);
    double sum2 = 0.0, pairs = 0.0, last = 0.0, middles = 0.0;
    for (int k = 0; k < W * W; k++) {
        double p[2] = { (k % W + 0.5) / W, (k / W + 0.5) / W };
        assert_near(wr_octaves_at(&perlin, p, NULL), 0.0, 1e-12);
        middles += fabs(wr_octaves_at(&middle, p, NULL));
        double f = wr_octaves_at(&value, p, NULL);
        sum2 += f * f;
        pairs += f * last;
        last = f;
    }
    assert_true(middles / (W * W) > 0.1);
    assert_near(sum2 / (W * W), 1.0 / 3.0, 3.0 * sqrt(4.0 / 45.0) / W);
    assert_near(pairs / (W * W), 0.0, 3.0 * (1.0 / 3.0) / W);
}

static void assert_refused(WrOctaves octaves, const char *part)
{
    WrError err = { "" };
    WrOctavesPlan plan = { .used = 77 };
    assert_false(wr_octaves_plan(&octaves, NULL, &plan, &err));
    if (!strstr(err.text, part)) fail_msg("\"%s\" is not in \"%s\"", part, err.text);
    assert_int_equal(plan.used, 77);
}

static void hc64_counts_and_factors_that_do_not_converge_are_refused(void **state)
{
    (void)state;
    const WrOctaves good = wr_octaves_default(2);
    WrOctaves bad = good;
    const int counts[] = { 0, -1, 33, 64, 1000000 };
    for (int k = 0; k < 5; k++) {
        bad.count = counts[k];
        assert_refused(bad, "octaves: must be 1..32");
    }
    const double factors[] = { 1.0, 0.5, 0.0, -2.0, NAN, INFINITY };
    for (int k = 0; k < 6; k++) {
        bad = good, bad.ratio = factors[k];
        assert_refused(bad, "r = ");
        bad = good, bad.step = factors[k];
        assert_refused(bad, "s = ");
    }
    bad = good, bad.count = 32, bad.step = 1e300, bad.ratio = 1e300;
    WrOctavesPlan plan = plan_of(&bad);
    assert_int_equal(plan.used, 1);
    assert_true(isfinite(wr_octaves_at(&plan, (double[]){ 0.3, 0.4 }, NULL)));
    bad.step = 1.5;
    plan = plan_of(&bad);
    assert_int_equal(plan.used, 32);
    assert_true(isfinite(wr_octaves_at(&plan, (double[]){ 0.3, 0.4 }, NULL)));
}

static void what_cannot_be_summed_is_refused_with_a_reason(void **state)
{
    (void)state;
    const WrOctaves good = wr_octaves_default(2);
    WrOctaves bad = good;
    bad.dim = 0;
    assert_refused(bad, "0 dimensions");
    bad = good, bad.mode = (WrOctavesMode)9;
    assert_refused(bad, "octave mode 9");
    bad = good, bad.kind = (WrNoiseKind)-3;
    assert_refused(bad, "noise kind -3");
    bad = good, bad.source = WR_LATTICE_DATA;
    assert_refused(bad, "from data");
    bad = good, bad.cells[1] = 0.5;
    assert_refused(bad, "cells along y 0.5: must be 1..1073741824");
    bad = good, bad.cells[0] = NAN;
    assert_refused(bad, "cells along x nan");
    bad = good, bad.offsets = (double[16]){ [5] = INFINITY };
    assert_refused(bad, "offset inf");
    bad = good, bad.mode = WR_OCTAVES_RIDGED, bad.ridge_gain = -1.0;
    assert_refused(bad, "ridge gain -1: must be 0..100");
    bad = good, bad.kind = WR_NOISE_SIMPLEX;
    assert_refused(bad, "cannot repeat on a square");
    bad = good, bad.kind = WR_NOISE_TORUS, bad.tile = false;
    assert_refused(bad, "needs a period");
}

/* At its lattice points perlin noise is 0 and |f| has a crease: the slope is 0 there, and that of +f and -f on either
 * side. */
static void hc65_turbulence_has_slope_zero_on_its_creases(void **state)
{
    (void)state;
    WrOctaves octaves = wr_octaves_default(1);
    octaves.count = 1;
    octaves.scatter = false;
    octaves.cells[0] = 16;
    for (int mode = WR_OCTAVES_TURBULENCE; mode <= WR_OCTAVES_RIDGED; mode++) {
        octaves.mode = (WrOctavesMode)mode;
        WrOctavesPlan plan = plan_of(&octaves);
        octaves.mode = WR_OCTAVES_FBM;
        WrOctavesPlan smooth = plan_of(&octaves);
        const double factor[] = { 0, 1.0, 2.0, 2.0 };
        for (int k = 0; k < 16; k++) {
            double u = k / 16.0, d, left, right, g;
            wr_octaves_at(&plan, &u, &d);
            wr_octaves_at(&smooth, &u, &g);
            wr_octaves_at(&plan, (double[]){ u - 1e-9 }, &left);
            wr_octaves_at(&plan, (double[]){ u + 1e-9 }, &right);
            assert_true(d == 0.0);
            assert_near(fabs(left), factor[mode] * fabs(g), 1e-5);
            assert_near(right, -left, 1e-5);
            assert_true((right > 0.0) == (mode != WR_OCTAVES_RIDGED));
        }
    }
}

static void hc68_sums_tile_bit_for_bit_for_any_step(void **state)
{
    (void)state;
    WrOctaves sums[TILING];
    int count = tiling_sums(sums);
    TestRandom r = { 4 };
    for (int n = 0; n < count; n++)
        for (int k = 0; k < 60; k++) {
            sums[n].step = k & 1 ? 1.99 : 2.0;
            sums[n].mode = (WrOctavesMode)(k / 2 % WR_OCTAVES_MODE_COUNT);
            WrOctavesPlan plan = plan_of(&sums[n]);
            double p[3], moved[3], d[3], d0[3];
            for (int a = 0; a < 3; a++) {
                p[a] = floor(1024.0 * test_random(&r)) / 1024.0;
                moved[a] = p[a] + (k % 7 - 3);
            }
            double f = wr_octaves_at(&plan, p, d);
            assert_true(same_bits(wr_octaves_at(&plan, moved, d0), f));
            for (int a = 0; a < plan.dim; a++) assert_true(same_bits(d[a], d0[a]));
            p[0] = 0.0, moved[0] = -1e-13; /* and without a step at the seam */
            assert_near(wr_octaves_at(&plan, p, NULL), wr_octaves_at(&plan, moved, NULL), 1e-10);
        }
}

static void hc68_counts_of_cells_are_whole_and_both_frequency_and_period(void **state)
{
    (void)state;
    WrOctaves octaves = wr_octaves_default(2);
    octaves.step = 1.99;
    octaves.cells[0] = 3, octaves.cells[1] = 5;
    for (int sheared = 0; sheared < 2; sheared++) {
        octaves.kind = sheared ? WR_NOISE_SHEARED : WR_NOISE_PERLIN;
        WrOctavesPlan plan = plan_of(&octaves);
        for (int i = 0; i < plan.used; i++)
            for (int a = 0; a < 2; a++) {
                int period = plan.octave[i].noise.lattice.period[a];
                int step = sheared && a == 1 ? 2 : 1;
                assert_true(plan.octave[i].frequency[a] == period && period % step == 0);
                assert_near(period, octaves.cells[a] * pow(1.99, i), 0.5 * step + 1e-9);
            }
    }
    octaves.tile = false;
    WrOctavesPlan plan = plan_of(&octaves);
    assert_near(plan.octave[3].frequency[0], 3.0 * pow(1.99, 3), 1e-12);
    assert_int_equal(plan.octave[3].noise.lattice.period[0], 0);
}

/* Independent octaves of amplitude r^-i and frequency s^i have slopes of equal size if r = s, so the mean squares add
 * up: the RMS slope grows as the square root of their number. */
static void slopes_grow_as_the_root_of_the_octaves_when_r_is_s(void **state)
{
    (void)state;
    double mean2[8] = { 0 };
    for (int count = 1; count <= 7; count += 3) {
        WrOctaves octaves = wr_octaves_default(2);
        octaves.cells[0] = octaves.cells[1] = 16;
        octaves.count = count;
        WrOctavesPlan plan = plan_of(&octaves);
        TestRandom r = { 6 };
        for (int k = 0; k < 40000; k++) {
            double p[2] = { test_random(&r), test_random(&r) }, d[2];
            wr_octaves_at(&plan, p, d);
            mean2[count] += (d[0] * d[0] + d[1] * d[1]) / 40000.0;
        }
    }
    assert_near(mean2[4] / mean2[1], 4.0, 0.2);
    assert_near(mean2[7] / mean2[1], 7.0, 0.35);
}

typedef struct Warped {
    WrOctavesPlan plan, by[3];
    const WrOctavesPlan *warp[3];
    double amount;
} Warped;

static double warped(const void *ctx, const double *p, double *slope)
{
    const Warped *w = ctx;
    return wr_octaves_warped_at(&w->plan, w->warp, w->amount, p, slope);
}

static void warped_noise_has_its_slopes_and_tiles(void **state)
{
    (void)state;
    for (int dim = 1; dim <= 3; dim++) {
        static Warped w;
        WrOctaves octaves = wr_octaves_default(dim);
        octaves.count = 3;
        w.plan = plan_of(&octaves);
        for (int a = 0; a < dim; a++) {
            octaves.seed = 100 + (uint32_t)a;
            w.by[a] = plan_of(&octaves);
            w.warp[a] = &w.by[a];
        }
        w.amount = 0.1;
        double bad, coarse = slope_error(warped, &w, dim, 4e-5, &bad);
        double fine = slope_error(warped, &w, dim, 2e-5, &bad);
        assert_true(coarse < 1e-4 && coarse / fine > 3.8 && coarse / fine < 4.2 && bad == 0.0);
        double p[3] = { 0.375, 0.8125, 0.0625 }, moved[3] = { 5.375, -3.1875, 1.0625 };
        double f = warped(&w, p, NULL);
        assert_true(same_bits(f, warped(&w, moved, NULL)));
        assert_true(f != wr_octaves_at(&w.plan, p, NULL));
        w.amount = 0.0;
        assert_true(same_bits(warped(&w, p, NULL), wr_octaves_at(&w.plan, p, NULL)));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_sum_is_the_lectures_series),
        cmocka_unit_test(one_lattice_is_the_lectures_literal_sum),
        cmocka_unit_test(modes_are_their_formulas_and_stay_within_the_bound),
        cmocka_unit_test(slopes_are_those_of_the_sums),
        cmocka_unit_test(hc62_octaves_beyond_half_a_cell_a_texel_are_dropped),
        cmocka_unit_test(hc63_samples_on_the_lattice_see_no_perlin_noise_and_white_value_noise),
        cmocka_unit_test(hc64_counts_and_factors_that_do_not_converge_are_refused),
        cmocka_unit_test(what_cannot_be_summed_is_refused_with_a_reason),
        cmocka_unit_test(hc65_turbulence_has_slope_zero_on_its_creases),
        cmocka_unit_test(hc68_sums_tile_bit_for_bit_for_any_step),
        cmocka_unit_test(hc68_counts_of_cells_are_whole_and_both_frequency_and_period),
        cmocka_unit_test(slopes_grow_as_the_root_of_the_octaves_when_r_is_s),
        cmocka_unit_test(warped_noise_has_its_slopes_and_tiles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
