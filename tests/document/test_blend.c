/* Blending of layers' heights: the blend modes, texel by texel. */
#include "test.h"

#include "document/blend.h"

#include <float.h>

static float one(WrBlend mode, float opacity, float radius, float b, float h)
{
    WrBlendTile tile = { .level = h, .cover_level = 1.0f, .mask_level = 1.0f };
    wr_blend_tile(mode, opacity, radius, &tile, 1, &b);
    return b;
}

static bool same_float(float a, float b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

static float random_float(TestRandom *random, double low, double high)
{
    return (float)(low + (high - low) * test_random(random));
}

/* The formulas as written, in double. */
static double formula(WrBlend mode, double o, double m, double c, double k, double b, double h)
{
    double w = o * m * c, s = k > 0.0 ? fmax(k - fabs(b - h), 0.0) / k : 0.0;
    switch (mode) {
    case WR_BLEND_ADD: return b + o * m * h;
    case WR_BLEND_SUBTRACT: return b - o * m * h;
    case WR_BLEND_MAX: return b + w * (fmax(b, h) - b);
    case WR_BLEND_MIN: return b + w * (fmin(b, h) - b);
    case WR_BLEND_SMOOTH_MAX: return b + w * (fmax(b, h) + s * s * k / 4.0 - b);
    case WR_BLEND_SMOOTH_MIN: return b + w * (fmin(b, h) - s * s * k / 4.0 - b);
    case WR_BLEND_REPLACE: return b + w * (h - b);
    case WR_BLEND_MIX: return b + o * m * (h - b);
    case WR_BLEND_MULTIPLY: return b + w * (b * h - b);
    default: fail(); return NAN;
    }
}

static void every_mode_follows_its_formula(void **state)
{
    (void)state;
    TestRandom random = { 1 };
    for (int mode = 0; mode < WR_BLEND_COUNT; mode++)
        for (int n = 0; n < 3000; n++) {
            float b = random_float(&random, -2, 2), h = random_float(&random, -2, 2);
            float o = random_float(&random, 0, 1), m = random_float(&random, 0, 1);
            float c = random_float(&random, 0, 1), k = random_float(&random, 0, 3), r = b;
            WrBlendTile tile = { .heights = &h, .cover = &c, .mask = &m };
            wr_blend_tile((WrBlend)mode, o, k, &tile, 1, &r);
            /* some ten roundings of numbers under 8 */
            assert_near(r, formula((WrBlend)mode, o, m, c, k, b, h), 10 * 4 * FLT_EPSILON);
        }
}

static void opacity_zero_leaves_every_bit_below(void **state)
{
    (void)state;
    const float below[] = { 0.0f, -0.0f, 1.5f, -3e38f, 1e-42f };
    const float opacities[] = { 0.0f, -0.0f, -1.0f, NAN };
    for (int mode = 0; mode < WR_BLEND_COUNT; mode++)
        for (size_t i = 0; i < 5; i++)
            for (size_t n = 0; n < 4; n++)
                assert_true(same_float(one((WrBlend)mode, opacities[n], 1.0f, below[i], FLT_MAX),
                                       below[i]));
}

static void weight_zero_by_mask_or_cover_leaves_every_bit_below(void **state)
{
    (void)state;
    const float below[] = { 0.0f, -0.0f, 1.5f, FLT_MAX, -FLT_MAX };
    for (int mode = 0; mode < WR_BLEND_COUNT; mode++)
        for (size_t i = 0; i < 5; i++) {
            WrBlendTile masked = { .level = -7e37f, .cover_level = 1.0f, .mask_level = 0.0f };
            WrBlendTile bare = { .level = -7e37f, .cover_level = 0.0f, .mask_level = 1.0f };
            float a = below[i], b = below[i];
            wr_blend_tile((WrBlend)mode, 1.0f, 2.0f, &masked, 1, &a);
            assert_true(same_float(a, below[i]));
            wr_blend_tile((WrBlend)mode, 1.0f, 2.0f, &bare, 1, &b);
            if (wr_blends[mode].uses_cover) assert_true(same_float(b, below[i]));
            else if (below[i] == 1.5f) assert_false(same_float(b, below[i]));
        }
}

/* b + 1 (h - b) would be rounded: 1e8 + (0.1 - 1e8) is 0. */
static void replace_and_mix_in_full_give_exactly_the_height(void **state)
{
    (void)state;
    const float heights[] = { 0.1f, -0.0f, 0.0f, 1e-30f, -FLT_MAX, 3.3f };
    const float below[] = { 1e8f, -1e8f, FLT_MAX, -0.0f, 0.7f };
    for (size_t i = 0; i < 6; i++)
        for (size_t n = 0; n < 5; n++) {
            assert_true(same_float(one(WR_BLEND_REPLACE, 1, 0, below[n], heights[i]), heights[i]));
            assert_true(same_float(one(WR_BLEND_MIX, 1, 0, below[n], heights[i]), heights[i]));
        }
}

static void max_and_min_in_full_give_exactly_one_of_the_two(void **state)
{
    (void)state;
    TestRandom random = { 2 };
    for (int n = 0; n < 2000; n++) {
        float b = random_float(&random, -1, 1) * (n % 3 ? 1.0f : 1e20f);
        float h = random_float(&random, -1, 1) * (n % 5 ? 1.0f : 1e-20f);
        assert_true(same_float(one(WR_BLEND_MAX, 1, 0, b, h), b > h ? b : h));
        assert_true(same_float(one(WR_BLEND_MIN, 1, 0, b, h), b < h ? b : h));
        assert_true(same_float(one(WR_BLEND_SMOOTH_MAX, 1, 0, b, h), b > h ? b : h));
        assert_true(same_float(one(WR_BLEND_SMOOTH_MIN, 1, -1, b, h), b < h ? b : h));
        assert_true(same_float(one(WR_BLEND_SMOOTH_MIN, 1, NAN, b, h), b < h ? b : h));
    }
}

static void smooth_maximum_stands_a_quarter_radius_above_and_has_no_corner(void **state)
{
    (void)state;
    for (float k = 0.25f; k <= 4.0f; k *= 2.0f) {
        assert_near(one(WR_BLEND_SMOOTH_MAX, 1, k, 1, 1), 1.0 + k / 4.0, 1e-6);
        assert_near(one(WR_BLEND_SMOOTH_MIN, 1, k, 1, 1), 1.0 - k / 4.0, 1e-6);
        assert_true(same_float(one(WR_BLEND_SMOOTH_MAX, 1, k, 1, 1 + k), 1 + k));
        assert_true(same_float(one(WR_BLEND_SMOOTH_MAX, 1, k, 1, 1 - k), 1));
        /* slope in h: 0 at h = b - k, 1/2 at h = b, 1 at h = b + k, without a jump */
        for (int n = -4; n <= 4; n++) {
            float h = 1 + k * (float)n / 4.0f, step = k / 64.0f;
            double slope = ((double)one(WR_BLEND_SMOOTH_MAX, 1, k, 1, h + step) -
                            one(WR_BLEND_SMOOTH_MAX, 1, k, 1, h - step)) /
                           (2.0 * step);
            assert_near(slope, (n + 4) / 8.0, 0.005);
        }
    }
}

static void smooth_maximum_is_symmetric_and_minimum_its_mirror(void **state)
{
    (void)state;
    TestRandom random = { 3 };
    for (int n = 0; n < 2000; n++) {
        float b = random_float(&random, -1, 1), h = random_float(&random, -1, 1);
        float k = random_float(&random, 0, 2), max = one(WR_BLEND_SMOOTH_MAX, 1, k, b, h);
        assert_true(same_float(max, one(WR_BLEND_SMOOTH_MAX, 1, k, h, b)));
        assert_true(same_float(max, -one(WR_BLEND_SMOOTH_MIN, 1, k, -b, -h)));
        assert_true(max >= b && max >= h);
    }
}

static void subtract_undoes_add_of_whole_numbers(void **state)
{
    (void)state;
    for (int b = -20; b <= 20; b++)
        for (int h = -20; h <= 20; h++)
            assert_true(one(WR_BLEND_SUBTRACT, 1, 0, one(WR_BLEND_ADD, 1, 0, (float)b, (float)h),
                            (float)h) == (float)b);
}

static void the_largest_heights_stay_finite_and_between(void **state)
{
    (void)state;
    const float x[] = { FLT_MAX, -FLT_MAX, 3e38f, -2e38f, 1.0f, 0.0f, -0.0f, 1e-45f };
    const float weights[] = { 1e-45f, 1e-6f, 0.5f, 0.99999994f, 1.0f };
    const float radii[] = { 0.0f, 1e-45f, 1.0f, FLT_MAX, INFINITY };
    for (int mode = 0; mode < WR_BLEND_COUNT; mode++)
        for (int i = 0; i < 8 * 8 * 5 * 5; i++) {
            float b = x[i % 8], h = x[i / 8 % 8], w = weights[i / 64 % 5], k = radii[i / 320];
            float r = one((WrBlend)mode, w, k, b, h), full = one((WrBlend)mode, 1.0f, k, b, h);
            if (!isfinite(r) || !isfinite(full)) fail_msg("mode %d: %g and %g", mode, b, h);
            assert_true(r >= fminf(b, full) && r <= fmaxf(b, full));
        }
    assert_true(one(WR_BLEND_ADD, 1, 0, FLT_MAX, FLT_MAX) == FLT_MAX);
    assert_true(one(WR_BLEND_MULTIPLY, 1, 0, -1e30f, 1e30f) == -FLT_MAX);
}

static void neutral_heights_leave_every_bit_below(void **state)
{
    (void)state;
    const float below[] = { 0.0f, -0.0f, 1.5f, -2.0f, FLT_MAX, -FLT_MAX, 1e-45f };
    int neutrals = 0;
    for (int mode = 0; mode < WR_BLEND_COUNT; mode++) {
        if (isnan(wr_blends[mode].neutral)) continue;
        neutrals++;
        for (size_t i = 0; i < 7; i++)
            for (int n = 1; n <= 4; n++)
                assert_true(same_float(
                    one((WrBlend)mode, (float)n / 4, 0, below[i], wr_blends[mode].neutral),
                    below[i]));
    }
    assert_int_equal(neutrals, 5);
}

/* Every length up to beyond a span: each result equals that of the texel alone, and no other value is written. */
static void runs_of_any_length_give_what_each_texel_gives_alone(void **state)
{
    (void)state;
    enum { MAX_MOST = 300 };
    TestRandom random = { 4 };
    float h[MAX_MOST], c[MAX_MOST], m[MAX_MOST], b[MAX_MOST], r[MAX_MOST + 2];
    for (int mode = 0; mode < WR_BLEND_COUNT; mode++)
        for (size_t count = 0; count < MAX_MOST; count += count < 67 ? 1 : 29) {
            for (size_t i = 0; i < count; i++) {
                h[i] = random_float(&random, -1, 1);
                c[i] = random_float(&random, -0.5, 1.5);
                m[i] = random_float(&random, -0.5, 1.5);
                b[i] = random_float(&random, -1, 1);
            }
            r[0] = r[count + 1] = 123.0f;
            memcpy(r + 1, b, sizeof *b * count);
            WrBlendTile tile = { .heights = h, .cover = c, .mask = m };
            wr_blend_tile((WrBlend)mode, 0.8f, 0.5f, &tile, count, r + 1);
            assert_true(r[0] == 123.0f && r[count + 1] == 123.0f);
            for (size_t i = 0; i < count; i++) {
                WrBlendTile lone = { .level = h[i], .cover_level = c[i], .mask_level = m[i] };
                wr_blend_tile((WrBlend)mode, 0.8f, 0.5f, &lone, 1, &b[i]);
                assert_true(same_float(b[i], r[i + 1]));
            }
        }
}

static void cover_and_mask_outside_their_range_count_as_its_ends(void **state)
{
    (void)state;
    float odd[] = { -3.0f, 7.0f, NAN }, even[] = { 0.0f, 1.0f, 0.0f };
    for (int mode = 0; mode < WR_BLEND_COUNT; mode++) {
        float a[] = { 0.25f, 0.25f, 0.25f }, b[] = { 0.25f, 0.25f, 0.25f };
        WrBlendTile tile = { .level = 3.0f, .cover = odd, .mask = odd };
        wr_blend_tile((WrBlend)mode, 0.5f, 1.0f, &tile, 3, a);
        tile.cover = tile.mask = even;
        wr_blend_tile((WrBlend)mode, 0.5f, 1.0f, &tile, 3, b);
        assert_memory_equal(a, b, sizeof a);
    }
}

static void every_mode_is_found_by_its_name(void **state)
{
    (void)state;
    for (int mode = 0; mode < WR_BLEND_COUNT; mode++) {
        assert_non_null(wr_blends[mode].name);
        assert_non_null(wr_blends[mode].label);
        assert_non_null(wr_blends[mode].help);
        assert_int_equal(wr_blend_find(wr_blends[mode].name), mode);
    }
    assert_int_equal(wr_blend_find("smooth-max"), WR_BLEND_SMOOTH_MAX);
    assert_int_equal(wr_blend_find("overlay"), -1);
    assert_int_equal(wr_blend_find(""), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_mode_follows_its_formula),
        cmocka_unit_test(opacity_zero_leaves_every_bit_below),
        cmocka_unit_test(weight_zero_by_mask_or_cover_leaves_every_bit_below),
        cmocka_unit_test(replace_and_mix_in_full_give_exactly_the_height),
        cmocka_unit_test(max_and_min_in_full_give_exactly_one_of_the_two),
        cmocka_unit_test(smooth_maximum_stands_a_quarter_radius_above_and_has_no_corner),
        cmocka_unit_test(smooth_maximum_is_symmetric_and_minimum_its_mirror),
        cmocka_unit_test(subtract_undoes_add_of_whole_numbers),
        cmocka_unit_test(the_largest_heights_stay_finite_and_between),
        cmocka_unit_test(neutral_heights_leave_every_bit_below),
        cmocka_unit_test(runs_of_any_length_give_what_each_texel_gives_alone),
        cmocka_unit_test(cover_and_mask_outside_their_range_count_as_its_ends),
        cmocka_unit_test(every_mode_is_found_by_its_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
