/* Noise and warp: against sums of noise at single points in double, and an independent cubic. */
#include "test.h"
#include "ops_tables.h"

#include "field/field.h"
#include "noise/octaves.h"

static WrOctavesPlan plan_of(const WrField *in, WrNoiseKind kind, WrOctavesMode mode, double cells,
                             double rows, int octaves, uint32_t seed)
{
    WrOctavesPlan plan;
    WrError err;
    WrOctaves o = wr_octaves_default(2);
    o.kind = kind, o.mode = mode, o.count = octaves, o.seed = seed;
    o.cells[0] = cells, o.cells[1] = rows;
    const int texels[2] = { wr_field_width(in), wr_field_height(in) };
    if (!wr_octaves_plan(&o, texels, &plan, &err)) fail_msg("%s", err.text);
    return plan;
}

static double noise_at(const WrOctavesPlan *plan, const WrField *in, int i, int j)
{
    const double p[2] = { (i + 0.5) / wr_field_width(in), 1.0 - (j + 0.5) / wr_field_height(in) };
    return wr_octaves_at(plan, p, NULL);
}

static void noise_is_added_by_its_amount_in_cells_about_square(void **state)
{
    (void)state;
    static const WrNoiseKind kinds[] = { WR_NOISE_PERLIN, WR_NOISE_GRADIENT, WR_NOISE_VALUE,
                                         WR_NOISE_SHEARED };
    WrField *in = noisy_table(157, 83, P, C, 3);
    for (int kind = 0; kind < 4; kind++) {
        const int mode = (kind * 3 + 1) % WR_OCTAVES_MODE_COUNT;
        WrField *out = run("noise", in, 0.37, 9, 3, kind, mode, 4000000007.0);
        const WrOctavesPlan plan = plan_of(in, kinds[kind], (WrOctavesMode)mode, 9, 5, 3,
                                           4000000007U); /* 9 * 83/157 = 4.76 */
        double most = 0.0;
        for (int j = 0; j < 83; j++)
            for (int i = 0; i < 157; i++) {
                const double n = noise_at(&plan, in, i, j);
                assert_near(wr_field_get(out, i, j), wr_field_get(in, i, j) + 0.37 * n, 3e-6);
                most = fmax(most, fabs(n));
            }
        assert_true(most > 0.3);
        wr_field_free(out);
    }
    wr_field_free(in);
}

/* Catmull-Rom by its four polynomials, t from the second texel. */
static double cubic(const double f[4], double t)
{
    return 0.5 * (f[0] * (-t + 2 * t * t - t * t * t) + f[1] * (2 - 5 * t * t + 3 * t * t * t) +
                  f[2] * (t + 4 * t * t - 3 * t * t * t) + f[3] * (t * t * t - t * t));
}

static double between(const WrField *in, double x, double y, bool linear)
{
    const int i = (int)floor(x), j = (int)floor(y);
    const double t = x - i, s = y - j;
    double rows[4];
    for (int y4 = 0; y4 < 4; y4++) {
        double f[4];
        for (int x4 = 0; x4 < 4; x4++) f[x4] = at(in, i + x4 - 1, j + y4 - 1);
        rows[y4] = linear ? f[1] + t * (f[2] - f[1]) : cubic(f, t);
    }
    return linear ? rows[1] + s * (rows[2] - rows[1]) : cubic(rows, s);
}

static void warp_takes_heights_from_where_the_noises_point(void **state)
{
    (void)state;
    WrField *in = noisy_table(91, 140, C, P, 4);
    for (int linear = 0; linear < 2; linear++) {
        const double amount = 11.7;
        WrField *out = run("warp", in, amount, 3, 2, linear, 23);
        WrOctavesPlan plan[2];
        uint32_t seed = 23;
        for (int a = 0; a < 2; a++) {
            seed = wr_mix32(seed + 0x51ed270bU);
            plan[a] = plan_of(in, WR_NOISE_PERLIN, WR_OCTAVES_FBM, 3, 5, 2, seed);
        }
        double most = 0.0;
        for (int j = 0; j < 140; j++)
            for (int i = 0; i < 91; i++) {
                const double du = amount * noise_at(&plan[0], in, i, j) / plan[0].bound;
                const double dv = amount * noise_at(&plan[1], in, i, j) / plan[1].bound;
                /* to the right and up; rows run down. Linear ones have a crease of slope about 1 */
                assert_near(wr_field_get(out, i, j), between(in, i + du, j - dv, linear), 1e-4);
                most = fmax(most, fmax(fabs(du), fabs(dv)));
            }
        assert_true(most > 0.3 * amount && most <= amount);
        wr_field_free(out);
    }
    wr_field_free(in);
}

/* The largest distance that a height can move, and no more; enough seeds to reach the ends. */
static void warp_moves_no_height_farther_than_it_says(void **state)
{
    (void)state;
    WrField *in = noisy_table(64, 64, P, P, 6);
    for (int j = 0; j < 64; j++)
        for (int i = 0; i < 64; i++) wr_field_set(in, i, j, i == 20 && j == 31 ? 1.0f : 0.0f);
    for (int seed = 0; seed < 40; seed++) {
        WrField *out = run("warp", in, 5.0, 5, 1, 0, seed);
        for (int j = 0; j < 64; j++)
            for (int i = 0; i < 64; i++)
                if (abs(i - 20) > 7 || abs(j - 31) > 7)
                    assert_true(wr_field_get(out, i, j) == 0.0f);
        wr_field_free(out);
    }
    wr_field_free(in);
}

/* A coverage of 0s and 1s, warped by a cubic that overshoots. */
static void a_coverage_stays_within_0_and_1_though_its_warp_overshoots(void **state)
{
    (void)state;
    const double param[] = { 9.3, 4, 2, 0, 12 };
    WrField *in = noisy_table(70, 66, P, P, 2);
    for (int k = 0; k < 70 * 66; k++)
        wr_field_set(in, k % 70, k / 70, wr_field_get(in, k % 70, k / 70) > 0.1f ? 1.0f : 0.0f);
    WrField *warped = run_with("warp", in, param, NULL);
    WrField *kept = wr_op_run_unit(wr_op_find("warp"), in, param, NULL, NULL);
    float low, high;
    wr_field_range(warped, &low, &high);
    assert_true(low < -0.02f && high > 1.02f);
    for (int j = 0; j < 66; j++)
        for (int i = 0; i < 70; i++)
            assert_true(wr_field_get(kept, i, j) ==
                        fminf(fmaxf(wr_field_get(warped, i, j), 0.0f), 1.0f));
    wr_field_free(in);
    wr_field_free(warped);
    wr_field_free(kept);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(noise_is_added_by_its_amount_in_cells_about_square),
        cmocka_unit_test(warp_takes_heights_from_where_the_noises_point),
        cmocka_unit_test(warp_moves_no_height_farther_than_it_says),
        cmocka_unit_test(a_coverage_stays_within_0_and_1_though_its_warp_overshoots),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
