/* Schemes of interpolation and differentiation: orders of convergence, identities, hard fetches. */
#include "test.h"
#include "field/scheme_list.h"

#include "base/memory.h"
#include "field/field.h"
#include "field/scheme.h"

#include <float.h>

typedef struct Point {
    double f, fu, fv;
} Point;

static Point sample(const WrField *field, WrScheme scheme, double u, double v)
{
    Point p;
    wr_field_sample(field, scheme, 1, &u, &v, &p.f, &p.fu, &p.fv);
    return p;
}

static bool same_point(Point a, Point b)
{
    return same_bits(a.f, b.f) && same_bits(a.fu, b.fu) && same_bits(a.fv, b.fv);
}

static bool is_flat(Point p)
{
    return same_bits(p.fu, 0.0) && same_bits(p.fv, 0.0);
}

typedef double (*Formula)(double u, double v);

static WrField *make(int width, int height, WrWrap wrap, Formula formula)
{
    WrField *field = wr_field_new(width, height, wrap, wrap, 0.0f, NULL);
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++)
            wr_field_set(field, i, j, (float)formula((i + 0.5) / width, 1.0 - (j + 0.5) / height));
    return field;
}

static WrField *make_random(int width, int height, WrWrap wrap, uint64_t seed)
{
    WrField *field = wr_field_new(width, height, wrap, wrap, 0.0f, NULL);
    TestRandom random = { seed };
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++)
            wr_field_set(field, i, j, (float)(test_random(&random) - 0.5));
    return field;
}

static double wave(double u, double v)
{
    return cos(2 * M_PI * (u + 0.13)) * cos(2 * M_PI * (v - 0.21)) +
           0.3 * sin(2 * M_PI * (u + v) + 1.0);
}

static double wave_u(double u, double v)
{
    return -2 * M_PI * sin(2 * M_PI * (u + 0.13)) * cos(2 * M_PI * (v - 0.21)) +
           0.6 * M_PI * cos(2 * M_PI * (u + v) + 1.0);
}

static double wave_v(double u, double v)
{
    return -2 * M_PI * cos(2 * M_PI * (u + 0.13)) * sin(2 * M_PI * (v - 0.21)) +
           0.6 * M_PI * cos(2 * M_PI * (u + v) + 1.0);
}

/* Largest errors of F, Fu and Fv over many points. */
static void worst_errors(WrScheme scheme, int n, double error[3])
{
    WrField *field = make(n, n, WR_WRAP_PERIODIC, wave);
    TestRandom random = { 11 };
    error[0] = error[1] = error[2] = 0.0;
    for (int k = 0; k < 4000; k++) {
        double u = test_random(&random), v = test_random(&random);
        Point p = sample(field, scheme, u, v);
        error[0] = fmax(error[0], fabs(p.f - wave(u, v)));
        error[1] = fmax(error[1], fabs(p.fu - wave_u(u, v)));
        error[2] = fmax(error[2], fabs(p.fv - wave_v(u, v)));
    }
    wr_field_free(field);
}

/* A1. n = 16 .. 256; the fitted spline only to 32, where its error is still above float's rounding. */
static void a1_errors_fall_with_the_stated_orders(void **state)
{
    (void)state;
    for (int scheme = 0; scheme < WR_SCHEME_COUNT; scheme++) {
        bool fit = scheme == WR_SCHEME_BSPLINE_FIT;
        int first = fit ? 8 : 16, steps = fit ? 3 : 5;
        double sx = 0, sxx = 0, sy[3] = { 0 }, sxy[3] = { 0 }, error[3];
        for (int k = 0; k < steps; k++) {
            worst_errors((WrScheme)scheme, first << k, error);
            sx += k;
            sxx += k * k;
            for (int q = 0; q < 3; q++) {
                sy[q] += log2(error[q]);
                sxy[q] += k * log2(error[q]);
            }
        }
        for (int q = 0; q < 3; q++) {
            double order = -(steps * sxy[q] - sx * sy[q]) / (steps * sxx - sx * sx);
            const WrSchemeInfo *info = &wr_schemes[scheme];
            double stated = q == 0 ? info->order_f : info->order_fu;
            if (fabs(order - stated) > 0.35)
                fail_msg("%s, quantity %d: order %.2f, stated %.0f", info->name, q, order, stated);
        }
    }
}

static void a2_central_equals_the_papers_four_look_ups(void **state)
{
    (void)state;
    const int sizes[][2] = { { 64, 64 }, { 48, 100 }, { 3, 7 }, { 5, 1 }, { 2, 2 } };
    TestRandom random = { 21 };
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        WrField *field = make_random(sizes[s][0], sizes[s][1], WR_WRAP_PERIODIC, s);
        for (int k = 0; k < 500; k++) {
            double u = 4 * test_random(&random) - 2, v = 4 * test_random(&random) - 2, fu, fv;
            Point p = sample(field, WR_SCHEME_CENTRAL, u, v);
            wr_field_sample_blinn(field, u, v, &fu, &fv);
            /* the four fetch positions are rounded: a few ulps of u times slopes of n^2 */
            assert_near(p.fu, fu, 1e-15 * sizes[s][0] * sizes[s][0] * 8 + 1e-13);
            assert_near(p.fv, fv, 1e-15 * sizes[s][1] * sizes[s][1] * 8 + 1e-13);
        }
        wr_field_free(field);
    }
}

static void a7_bspline_stays_within_its_taps(void **state)
{
    (void)state;
    WrField *field = make_random(40, 30, WR_WRAP_PERIODIC, 7);
    TestRandom random = { 2 };
    for (int k = 0; k < 3000; k++) {
        double u = test_random(&random), v = test_random(&random);
        float taps[16], low = FLT_MAX, high = -FLT_MAX;
        wr_field_read(field, (int)floor(40 * u - 0.5) - 1, (int)floor(30 * (1 - v) - 0.5) - 1, 4, 4,
                      taps, 4);
        for (int t = 0; t < 16; t++) {
            low = fminf(low, taps[t]);
            high = fmaxf(high, taps[t]);
        }
        double f = sample(field, WR_SCHEME_BSPLINE, u, v).f;
        assert_true(f >= low - 1e-15 && f <= high + 1e-15);
    }
    wr_field_free(field);
}

static void a8_catmull_at_texels_has_their_heights_and_central_differences(void **state)
{
    (void)state;
    WrField *field = make_random(32, 16, WR_WRAP_PERIODIC, 8);
    for (int j = 0; j < 16; j++)
        for (int i = 0; i < 32; i++) {
            Point p = sample(field, WR_SCHEME_CATMULL, (i + 0.5) / 32, 1 - (j + 0.5) / 16);
            float across[3], down[3];
            wr_field_read(field, i - 1, j, 3, 1, across, 3);
            wr_field_read(field, i, j - 1, 1, 3, down, 1);
            assert_true(p.f == across[1]);
            assert_near(p.fu, ((double)across[2] - across[0]) * 16, 1e-14 * 32);
            assert_near(p.fv, ((double)down[0] - down[2]) * 8, 1e-14 * 16);
        }
    wr_field_free(field);
}

static void names_find_their_schemes(void **state)
{
    (void)state;
    for (int scheme = 0; scheme < WR_SCHEME_COUNT; scheme++)
        assert_int_equal(wr_scheme_find(wr_schemes[scheme].name), scheme);
    assert_int_equal(wr_scheme_find("bspline-"), -1);
    assert_int_equal(wr_scheme_find(""), -1);
}

static void hc35_parameters_at_the_ends_index_inside_the_table(void **state)
{
    (void)state;
    double below_1 = nextafter(1, 0);
    for (int n = 1; n < 5000; n++) assert_true(floor(n * below_1) < n);
    const double ends[] = { 0, 1, -0.0, 5, -3 };
    const int sizes[] = { 1, 3, 64, 100 };
    for (int s = 0; s < 4; s++) {
        WrField *field = make_random(sizes[s], sizes[s], WR_WRAP_PERIODIC, 3);
        for (int scheme = 0; scheme < WR_SCHEME_COUNT; scheme++) {
            Point at_0 = sample(field, (WrScheme)scheme, 0, 0);
            for (int k = 0; k < 5; k++)
                assert_true(
                    same_point(sample(field, (WrScheme)scheme, ends[k], ends[4 - k]), at_0));
            Point near_1 = sample(field, (WrScheme)scheme, below_1, nextafter(1, 2));
            assert_true(fabs(near_1.f) < 3.0);
        }
        wr_field_free(field);
    }
}

static void hc36_tiny_negative_parameters_are_next_to_0(void **state)
{
    (void)state;
    WrField *field = make_random(64, 64, WR_WRAP_PERIODIC, 4);
    const double tiny[] = { -1e-9, -1e-17, -DBL_TRUE_MIN };
    for (int k = 0; k < 3; k++) {
        assert_true(wr_field_reduce(tiny[k], 1) < 1.0);
        double f = sample(field, WR_SCHEME_BILINEAR, tiny[k], 0.3).f;
        assert_near(f, sample(field, WR_SCHEME_BILINEAR, 0, 0.3).f, 64 * 1.1e-9);
    }
    wr_field_free(field);
}

static void hc37_parameters_that_are_not_finite_count_as_0(void **state)
{
    (void)state;
    const double bad[] = { NAN, INFINITY, -INFINITY };
    WrField *periodic = make_random(20, 30, WR_WRAP_PERIODIC, 5);
    WrField *clamped = make_random(20, 30, WR_WRAP_CLAMP, 5);
    for (int scheme = 0; scheme < WR_SCHEME_COUNT; scheme++)
        for (int k = 0; k < 3; k++) {
            Point p = sample(periodic, (WrScheme)scheme, bad[k], 0.4);
            assert_true(same_point(p, sample(periodic, (WrScheme)scheme, 0, 0.4)));
            p = sample(clamped, (WrScheme)scheme, 0.4, bad[k]);
            double end = k == 1 ? 1.0 : 0.0;
            assert_true(p.f == sample(clamped, (WrScheme)scheme, 0.4, end).f && p.fv == 0.0);
        }
    wr_field_free(periodic);
    wr_field_free(clamped);
}

static void hc38_half_a_texel_below_0_is_half_a_texel_below_1(void **state)
{
    (void)state;
    WrField *field = make_random(64, 16, WR_WRAP_PERIODIC, 6);
    for (int scheme = 0; scheme < WR_SCHEME_COUNT; scheme++)
        assert_true(same_point(sample(field, (WrScheme)scheme, -0.5 / 64, -0.5 / 16),
                               sample(field, (WrScheme)scheme, 1 - 0.5 / 64, 1 - 0.5 / 16)));
    wr_field_free(field);
}

static void hc39_edge_cells_equal_those_of_the_table_rolled_by_half(void **state)
{
    (void)state;
    WrField *field = make_random(32, 64, WR_WRAP_PERIODIC, 9);
    WrField *rolled = wr_field_new(32, 64, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int j = 0; j < 64; j++)
        for (int i = 0; i < 32; i++)
            wr_field_set(rolled, (i + 16) % 32, (j + 32) % 64, wr_field_get(field, i, j));
    TestRandom random = { 1 };
    for (int scheme = 0; scheme < WR_SCHEME_COUNT; scheme++)
        for (int k = 0; k < 400; k++) { /* dyadic places around the seams, so that sums are exact */
            double u = floor(4096 * test_random(&random)) / 65536 - 1.0 / 32;
            double v = floor(4096 * test_random(&random)) / 65536 - 1.0 / 32;
            assert_true(same_point(sample(field, (WrScheme)scheme, u, v),
                                   sample(rolled, (WrScheme)scheme, u + 0.5, v + 0.5)));
        }
    wr_field_free(field);
    wr_field_free(rolled);
}

static void hc40_a_million_repeats_are_right_to_a_thousandth_of_a_texel(void **state)
{
    (void)state;
    const double repeats[] = { 1e3, 1e5, 1e6 };
    TestRandom random = { 10 };
    for (int k = 0; k < 3000; k++) {
        double r = repeats[k % 3], u = test_random(&random);
        double p = r * u, rest = fma(r, u, -p); /* p + rest is r u exactly */
        double exact = (p - floor(p)) + rest, d = wr_field_reduce(u, r) - exact;
        d -= rint(d);
        assert_near(64 * d, 0.0, 1e-3);
    }
}

static void hc41_replication_by_0_is_constant_and_negative_mirrors(void **state)
{
    (void)state;
    assert_true(same_bits(wr_field_reduce(0.7, 0), 0));
    assert_true(wr_field_reduce(0.25, -1) == 0.75);
    assert_true(wr_field_reduce(0.25, -3) == 0.25);
    assert_true(wr_field_reduce(0.75, 0.5) == 0.375);
    assert_true(wr_field_reduce(INFINITY, 0) == 0.0 && wr_field_reduce(1, NAN) == 0.0);
}

static void hc42_a_table_of_one_texel_is_flat_to_the_bit(void **state)
{
    (void)state;
    TestRandom random = { 12 };
    for (int wrap = 0; wrap < 2; wrap++) {
        WrField *field = make_random(1, 1, wrap ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC, 1);
        for (int scheme = 0; scheme < WR_SCHEME_COUNT; scheme++)
            for (int k = 0; k < 50; k++) {
                Point p = sample(field, (WrScheme)scheme, 3 * test_random(&random) - 1,
                                 3 * test_random(&random) - 1);
                assert_true(is_flat(p) && p.f == wr_field_get(field, 0, 0));
            }
        wr_field_free(field);
    }
}

static void hc43_one_row_or_column_is_flat_across_itself(void **state)
{
    (void)state;
    WrField *column = make_random(1, 9, WR_WRAP_PERIODIC, 1);
    WrField *row = make_random(9, 1, WR_WRAP_PERIODIC, 1);
    TestRandom random = { 13 };
    for (int scheme = 0; scheme < WR_SCHEME_COUNT; scheme++)
        for (int k = 0; k < 50; k++) {
            double u = test_random(&random), v = test_random(&random);
            assert_true(same_bits(sample(column, (WrScheme)scheme, u, v).fu, 0.0));
            assert_true(same_bits(sample(row, (WrScheme)scheme, u, v).fv, 0.0));
        }
    wr_field_free(column);
    wr_field_free(row);
}

static void hc44_across_two_texels_only_bilinear_sees_a_slope(void **state)
{
    (void)state;
    WrField *field = make_random(2, 9, WR_WRAP_PERIODIC, 1);
    for (int k = 0; k < 50; k++) {
        double u = k / 50.0 + 0.003, v = k / 50.0;
        assert_true(same_bits(sample(field, WR_SCHEME_CENTRAL, u, v).fu, 0.0));
        assert_true(same_bits(sample(field, WR_SCHEME_NEAREST, u, v).fu, 0.0));
        assert_true(sample(field, WR_SCHEME_BILINEAR, u, v).fu != 0.0);
    }
    wr_field_free(field);
}

static void hc45_a_checkerboard_is_invisible_to_the_papers_difference(void **state)
{
    (void)state;
    WrField *field = wr_field_new(16, 16, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int j = 0; j < 16; j++)
        for (int i = 0; i < 16; i++) wr_field_set(field, i, j, (float)((i + j) % 2));
    double steepest = 0.0;
    for (int k = 0; k < 50; k++) {
        double u = k / 50.0 + 0.003, v = k / 71.0;
        assert_true(is_flat(sample(field, WR_SCHEME_CENTRAL, u, v)));
        steepest = fmax(steepest, fabs(sample(field, WR_SCHEME_BILINEAR, u, v).fu));
    }
    assert_true(steepest > 15.0 && steepest <= 16.0);
    wr_field_free(field);
}

static void hc46_any_size_repeats_by_true_modulus(void **state)
{
    (void)state;
    const int sizes[] = { 3, 48, 64, 100, 16383 };
    TestRandom random = { 14 };
    for (int s = 0; s < 5; s++) {
        WrField *field = make_random(sizes[s], s == 4 ? 1 : sizes[s], WR_WRAP_PERIODIC, 2);
        for (int scheme = 0; scheme < WR_SCHEME_COUNT; scheme++)
            for (int k = 0; k < 100; k++) {
                double u = floor(65536 * test_random(&random)) / 65536, v = k / 128.0;
                Point p = sample(field, (WrScheme)scheme, u, v);
                assert_true(same_point(sample(field, (WrScheme)scheme, u + 7, v - 1000), p));
                assert_true(same_point(sample(field, (WrScheme)scheme, u - 41, v + 1), p));
            }
        wr_field_free(field);
    }
}

static void hc47_flat_tables_have_their_level_and_no_slope_to_the_bit(void **state)
{
    (void)state;
    const float levels[] = { 0, 1, 0.1f, -1e6f, 3.3e38f, 1e-40f };
    TestRandom random = { 15 };
    for (int wrap = 0; wrap < 2; wrap++)
        for (int l = 0; l < 6; l++) {
            WrWrap w = wrap ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC;
            WrField *field = wr_field_new(100, 37, w, w, levels[l], NULL);
            for (int scheme = 0; scheme < WR_SCHEME_COUNT; scheme++)
                for (int k = 0; k < 30; k++) {
                    Point p =
                        sample(field, (WrScheme)scheme, test_random(&random), test_random(&random));
                    assert_true(is_flat(p) && p.f == levels[l]);
                }
            wr_field_free(field);
        }
}

/* Differences of stored heights are exact, so slopes do not depend on the level. Fitted coefficients are rounded to
 * half of 1e6's last place in double, 6e-11. */
static void hc48_a_level_of_a_million_leaves_slopes_as_they_were_stored(void **state)
{
    (void)state;
    WrField *high = wr_field_new(64, 64, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    WrField *low = wr_field_share(high);
    for (int j = 0; j < 64; j++)
        for (int i = 0; i < 64; i++) {
            float f = (float)(1e6 + 0.5 * wave(i / 64.0, j / 64.0));
            wr_field_set(high, i, j, f);
            wr_field_set(low, i, j, f - 1e6f); /* exact */
        }
    TestRandom random = { 16 };
    for (int scheme = 0; scheme < WR_SCHEME_COUNT; scheme++)
        for (int k = 0; k < 300; k++) {
            double u = test_random(&random), v = test_random(&random);
            Point a = sample(high, (WrScheme)scheme, u, v), b = sample(low, (WrScheme)scheme, u, v);
            double tolerance = scheme == WR_SCHEME_BSPLINE_FIT ? 64 * 6e-10 : 0.0;
            assert_near(a.fu, b.fu, tolerance);
            assert_near(a.fv, b.fv, tolerance);
        }
    wr_field_free(high);
    wr_field_free(low);
}

static void hc50_the_largest_heights_side_by_side_give_finite_results(void **state)
{
    (void)state;
    for (int wrap = 0; wrap < 2; wrap++) {
        WrWrap w = wrap ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC;
        WrField *field = wr_field_new(8, 8, w, w, 0, NULL);
        for (int k = 0; k < 64; k++)
            wr_field_set(field, k % 8, k / 8, (k * k / 3) % 2 ? FLT_MAX : -FLT_MAX);
        for (int scheme = 0; scheme < WR_SCHEME_COUNT; scheme++)
            for (int k = 0; k < 400; k++) {
                Point p = sample(field, (WrScheme)scheme, k / 400.0, k * k % 401 / 401.0);
                assert_true(isfinite(p.f) && isfinite(p.fu) && isfinite(p.fv));
            }
        wr_field_free(field);
    }
}

static void hc49_an_extreme_height_spoils_only_the_schemes_support(void **state)
{
    (void)state;
    WrField *field = make_random(100, 100, WR_WRAP_PERIODIC, 17), *spoilt = wr_field_share(field);
    wr_field_set(spoilt, 50, 50, FLT_MAX);
    for (int scheme = 0; scheme < WR_SCHEME_COUNT; scheme++) {
        double out = (wr_schemes[scheme].reach + 0.5 + 1e-9) / 100, u = 0.505, v = 0.495;
        Point p = sample(field, (WrScheme)scheme, u + out, 0.3);
        assert_true(same_point(sample(spoilt, (WrScheme)scheme, u + out, 0.3), p));
        p = sample(field, (WrScheme)scheme, 0.3, v - out);
        assert_true(same_point(sample(spoilt, (WrScheme)scheme, 0.3, v - out), p));
    }
    wr_field_free(field);
    wr_field_free(spoilt);
}

/* Every point of a small table whose value or slopes an edit changes is within reach. */
static void check_reach(WrScheme scheme, WrWrap wrap, int i, int j)
{
    enum { N = 80 };
    WrField *field = make_random(N, N, wrap, 18), *edited = wr_field_share(field);
    wr_field_set(edited, i, j, 2.0f);
    double farthest = 0.0;
    for (int b = 0; b < N; b += 1)
        for (int a = 0; a < 3 * N; a++) {
            double x = a / 3.0 + 0.1, y = b + 0.6;
            double dx = fabs(x - 0.5 - i), dy = fabs(y - 0.5 - j);
            if (scheme == WR_SCHEME_BSPLINE_FIT && (b % 7 || a % 5)) continue;
            if (wrap == WR_WRAP_PERIODIC) dx = fmin(dx, N - dx), dy = fmin(dy, N - dy);
            if (!same_point(sample(field, scheme, x / N, 1 - y / N),
                            sample(edited, scheme, x / N, 1 - y / N)))
                farthest = fmax(farthest, fmax(dx, dy));
        }
    if (farthest > wr_schemes[scheme].reach || farthest < 0.5)
        fail_msg("%s: edit seen %g texels away", wr_schemes[scheme].name, farthest);
    wr_field_free(field);
    wr_field_free(edited);
}

static void an_edit_is_seen_no_farther_than_the_stated_reach(void **state)
{
    (void)state;
    for (int scheme = 0; scheme < WR_SCHEME_COUNT; scheme++) {
        check_reach((WrScheme)scheme, WR_WRAP_PERIODIC, 0, 79);
        for (int i = 0; i < 4; i++) check_reach((WrScheme)scheme, WR_WRAP_CLAMP, i, 79 - i);
    }
}

static void hc54_slopes_are_continuous_across_cells_but_bilinears(void **state)
{
    (void)state;
    WrField *field = make_random(32, 32, WR_WRAP_PERIODIC, 19);
    const WrScheme smooth[] = { WR_SCHEME_CENTRAL, WR_SCHEME_BSPLINE, WR_SCHEME_BSPLINE_FIT,
                                WR_SCHEME_CATMULL };
    double crease = 0.0;
    for (int i = 0; i < 32; i++) {
        double u = (i + 0.5) / 32, v = i / 32.0 + 0.01;
        for (int k = 0; k < 4; k++) {
            Point a = sample(field, smooth[k], nextafter(u, 0), v);
            Point b = sample(field, smooth[k], nextafter(u, 1), v);
            assert_near(a.fu, b.fu, 1e-12 * 32 * 32);
            assert_near(a.fv, b.fv, 1e-12 * 32 * 32);
        }
        crease = fmax(crease, fabs(sample(field, WR_SCHEME_BILINEAR, nextafter(u, 0), v).fu -
                                   sample(field, WR_SCHEME_BILINEAR, nextafter(u, 1), v).fu));
    }
    assert_true(crease > 1.0);
    wr_field_free(field);
}

static void hc57_both_sides_of_the_seam_are_the_same_bits(void **state)
{
    (void)state;
    WrField *field = make_random(48, 31, WR_WRAP_PERIODIC, 20);
    for (int scheme = 0; scheme < WR_SCHEME_COUNT; scheme++)
        for (int k = 0; k < 40; k++) {
            double t = k / 40.0;
            assert_true(same_point(sample(field, (WrScheme)scheme, 0, t),
                                   sample(field, (WrScheme)scheme, 1, t)));
            assert_true(same_point(sample(field, (WrScheme)scheme, t, 0),
                                   sample(field, (WrScheme)scheme, t, 1)));
        }
    wr_field_free(field);
}

/* In double throughout: no float rounding remains at any level. Extrapolation beyond a clamped axis may be up to 28^2
   times as high. */
static void hc58_the_fitted_spline_passes_through_the_samples_of_any_size(void **state)
{
    (void)state;
    const int sizes[][2] = { { 1, 1 }, { 2, 2 },    { 3, 3 },  { 1, 5 },
                             { 3, 2 }, { 48, 100 }, { 29, 64 } };
    for (int wrap = 0; wrap < 2; wrap++)
        for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
            int width = sizes[s][0], height = sizes[s][1];
            WrField *field = make_random(width, height, wrap ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC, s);
            for (int j = 0; j < height; j++)
                for (int i = 0; i < width; i += 1 + width / 10) {
                    Point p = sample(field, WR_SCHEME_BSPLINE_FIT, (i + 0.5) / width,
                                     1 - (j + 0.5) / height);
                    assert_near(p.f, wr_field_get(field, i, j), 5e-13);
                }
            for (int k = 0; k < width * height; k++)
                wr_field_set(field, k % width, k / width,
                             wr_field_get(field, k % width, k / width) + 1e6f);
            Point high = sample(field, WR_SCHEME_BSPLINE_FIT, 0.5 / width, 1 - 0.5 / height);
            assert_near(high.f, wr_field_get(field, 0, 0), 1e-9);
            wr_field_free(field);
        }
}

static void fitted_coefficients_are_the_same_bits_in_any_rectangle(void **state)
{
    (void)state;
    enum { W = 600, H = 40 };
    static float whole[W * H], part[W * H];
    for (int wrap = 0; wrap < 2; wrap++) {
        WrField *field = make_random(W, H, wrap ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC, 22);
        wr_field_read_bspline_coefficients(field, 0, 0, W, H, whole, W);
        const int boxes[][4] = {
            { 0, 0, 1, 1 }, { 500, 3, 37, 5 }, { 511, 39, 2, 1 }, { 7, 0, 593, 40 }
        };
        for (int b = 0; b < 4; b++) {
            const int *box = boxes[b];
            wr_field_read_bspline_coefficients(field, box[0], box[1], box[2], box[3], part, W);
            for (int j = 0; j < box[3]; j++)
                assert_memory_equal(part + j * W, whole + (box[1] + j) * W + box[0],
                                    sizeof(float) * (size_t)box[2]);
        }
        wr_field_free(field);
    }
}

static void many_points_at_once_give_the_same_bits_as_one_by_one(void **state)
{
    (void)state;
    enum { COUNT = 2000 };
    static double u[COUNT], v[COUNT], f[COUNT], fu[COUNT], fv[COUNT];
    for (int wrap = 0; wrap < 2; wrap++) {
        WrField *field = make_random(70, 90, wrap ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC, 23);
        TestRandom random = { 24 };
        for (int k = 0; k < COUNT; k++) {
            u[k] = 2 * test_random(&random) - 0.5;
            v[k] = k % 2 ? 2 * test_random(&random) - 0.5 : v[k > 0 ? k - 1 : 0];
        }
        for (int scheme = 0; scheme < WR_SCHEME_COUNT; scheme++) {
            wr_field_sample(field, (WrScheme)scheme, COUNT, u, v, f, fu, fv);
            for (int k = 0; k < COUNT; k += 17)
                assert_true(same_point(sample(field, (WrScheme)scheme, u[k], v[k]),
                                       (Point){ f[k], fu[k], fv[k] }));
        }
        wr_field_free(field);
    }
}

/* Points in a band of rows and anywhere: so many that the whole table is fitted once. */
static void check_many(WrField *field, WrScheme scheme, int row, int rows)
{
    enum { COUNT = 300 };
    double u[COUNT], v[COUNT], f[COUNT], fu[COUNT], fv[COUNT];
    TestRandom random = { (uint64_t)row + 31 };
    const int height = wr_field_height(field);
    for (int k = 0; k < COUNT; k++) {
        const double down = row - 1 + (rows + 2) * test_random(&random);
        u[k] = 3 * test_random(&random) - 1;
        v[k] = k % 9 == 0 ? u[k] : 1 - down / height;
    }
    wr_field_sample(field, scheme, COUNT, u, v, f, fu, fv);
    for (int k = 0; k < COUNT; k++)
        assert_true(same_point(sample(field, scheme, u[k], v[k]), (Point){ f[k], fu[k], fv[k] }));
}

static void many_points_have_the_bits_of_single_ones(void **state)
{
    (void)state;
    static const int rows[][2] = { { 0, 16 }, { 37, 1 }, { 32, 9 }, { 0, 41 }, { 40, 1 } };
    for (int wrap = 0; wrap < 4; wrap++) {
        WrField *field = wr_field_new(53, 41, wrap & 1 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC,
                                      wrap & 2 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC, 0.0f, NULL);
        TestRandom random = { 25 };
        for (int t = 0; t < 53 * 41; t++)
            wr_field_set(field, t % 53, t / 53, (float)(test_random(&random) - 0.3));
        for (int scheme = 0; scheme < WR_SCHEME_COUNT; scheme++)
            for (int k = 0; k < 5; k++) check_many(field, (WrScheme)scheme, rows[k][0], rows[k][1]);
        wr_field_free(field);
    }
}

static double ramp(double u, double v)
{
    return 4 * u - 2 * v;
}

static void a_clamped_ramp_is_straight_to_its_ends_and_constant_beyond(void **state)
{
    (void)state;
    WrField *field = make(16, 32, WR_WRAP_CLAMP, ramp);
    for (int scheme = WR_SCHEME_BILINEAR; scheme < WR_SCHEME_COUNT; scheme++)
        for (int k = 0; k <= 64; k++) {
            double u = k / 64.0, v = 1 - u * u;
            Point p = sample(field, (WrScheme)scheme, u, v);
            assert_near(p.f, ramp(u, v), 1e-6);
            assert_near(p.fu, 4.0, 1e-5);
            assert_near(p.fv, -2.0, 1e-5);
            Point beyond = sample(field, (WrScheme)scheme, 1.001 + k, v);
            assert_near(beyond.f, ramp(1, v), 1e-6);
            assert_true(beyond.fu == 0.0);
            beyond = sample(field, (WrScheme)scheme, u, -0.001 - k);
            assert_near(beyond.f, ramp(u, 0), 1e-6);
            assert_true(beyond.fv == 0.0);
        }
    assert_true(sample(field, WR_SCHEME_NEAREST, 1, 0).f == wr_field_get(field, 15, 31));
    wr_field_free(field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a1_errors_fall_with_the_stated_orders),
        cmocka_unit_test(a2_central_equals_the_papers_four_look_ups),
        cmocka_unit_test(a7_bspline_stays_within_its_taps),
        cmocka_unit_test(a8_catmull_at_texels_has_their_heights_and_central_differences),
        cmocka_unit_test(names_find_their_schemes),
        cmocka_unit_test(hc35_parameters_at_the_ends_index_inside_the_table),
        cmocka_unit_test(hc36_tiny_negative_parameters_are_next_to_0),
        cmocka_unit_test(hc37_parameters_that_are_not_finite_count_as_0),
        cmocka_unit_test(hc38_half_a_texel_below_0_is_half_a_texel_below_1),
        cmocka_unit_test(hc39_edge_cells_equal_those_of_the_table_rolled_by_half),
        cmocka_unit_test(hc40_a_million_repeats_are_right_to_a_thousandth_of_a_texel),
        cmocka_unit_test(hc41_replication_by_0_is_constant_and_negative_mirrors),
        cmocka_unit_test(hc42_a_table_of_one_texel_is_flat_to_the_bit),
        cmocka_unit_test(hc43_one_row_or_column_is_flat_across_itself),
        cmocka_unit_test(hc44_across_two_texels_only_bilinear_sees_a_slope),
        cmocka_unit_test(hc45_a_checkerboard_is_invisible_to_the_papers_difference),
        cmocka_unit_test(hc46_any_size_repeats_by_true_modulus),
        cmocka_unit_test(hc47_flat_tables_have_their_level_and_no_slope_to_the_bit),
        cmocka_unit_test(hc48_a_level_of_a_million_leaves_slopes_as_they_were_stored),
        cmocka_unit_test(hc49_an_extreme_height_spoils_only_the_schemes_support),
        cmocka_unit_test(hc50_the_largest_heights_side_by_side_give_finite_results),
        cmocka_unit_test(an_edit_is_seen_no_farther_than_the_stated_reach),
        cmocka_unit_test(hc54_slopes_are_continuous_across_cells_but_bilinears),
        cmocka_unit_test(hc57_both_sides_of_the_seam_are_the_same_bits),
        cmocka_unit_test(hc58_the_fitted_spline_passes_through_the_samples_of_any_size),
        cmocka_unit_test(fitted_coefficients_are_the_same_bits_in_any_rectangle),
        cmocka_unit_test(many_points_at_once_give_the_same_bits_as_one_by_one),
        cmocka_unit_test(many_points_have_the_bits_of_single_ones),
        cmocka_unit_test(a_clamped_ramp_is_straight_to_its_ends_and_constant_beyond),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
