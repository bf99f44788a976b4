/* Modes that move heights, and smudging presets. */
#include "brush_help.h"

#include "base/error.h"
#include "brush/preset.h"

#include <float.h>

static double mean_of(const WrField *field)
{
    double sum = 0;
    for (int j = 0; j < wr_field_height(field); j++)
        for (int i = 0; i < wr_field_width(field); i++) sum += wr_field_get(field, i, j);
    return sum / wr_field_width(field) / wr_field_height(field);
}

/* On tables of any shape, with and without edges, dabs smaller and larger than the table. */
static void hc77_smoothing_keeps_the_mean_and_makes_no_new_extremes(void **state)
{
    (void)state;
    const int sizes[][2] = { { 64, 64 }, { 100, 37 }, { 5, 90 }, { 130, 130 } };
    for (int s = 0; s < 4; s++)
        for (int wraps = 0; wraps < 2; wraps++)
            for (int large = 0; large < 2; large++) {
                WrField *field =
                    rough(sizes[s][0], sizes[s][1], wraps ? WR_WRAP_PERIODIC : WR_WRAP_CLAMP);
                for (int j = 0; j < sizes[s][1]; j++) /* non-zero mean, for relative drift */
                    for (int i = 0; i < sizes[s][0]; i++)
                        wr_field_set(field, i, j, 1 + wr_field_get(field, i, j));
                WrBrush brush = brush_of(WR_BRUSH_SMOOTH, large ? 500 : 11);
                brush.reach = 5;
                double mean = mean_of(field);
                float low, high, lower, higher;
                wr_field_range(field, &low, &high);
                float first = high - low;
                for (int pass = 0; pass < 40; pass++) {
                    wr_brush_dab(field, &brush, 0.07 * pass, 0.11 * pass);
                    double now = mean_of(field);
                    assert_near(now, mean, 1e-6 * mean);
                    wr_field_range(field, &lower, &higher);
                    assert_true(lower >= low && higher <= high);
                    mean = now;
                    low = lower;
                    high = higher;
                }
                if (large) assert_true(high - low < 0.35f * first);
                wr_field_free(field);
            }
}

static void smoothing_the_widest_heights_stays_finite(void **state)
{
    (void)state;
    WrField *field = torus(64, 64);
    for (int j = 0; j < 64; j++)
        for (int i = 0; i < 64; i++) wr_field_set(field, i, j, (i ^ j) & 1 ? FLT_MAX : -FLT_MAX);
    WrBrush brush = brush_of(WR_BRUSH_SMOOTH, 20);
    brush.hardness = 1;
    brush.reach = 1;
    wr_brush_dab(field, &brush, 0.5, 0.5);
    float low, high;
    wr_field_range(field, &low, &high);
    assert_true(low >= -FLT_MAX && high <= FLT_MAX);
    /* four neighbours give a fifth of the difference each */
    assert_near(fabs(wr_field_get(field, 32, 32)) / FLT_MAX, 0.6, 1e-6);
    wr_field_free(field);
}

static WrField *plane(int width, int height, double a, double b, double c)
{
    WrField *field = wr_field_new(width, height, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0, NULL);
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++) wr_field_set(field, i, j, (float)(a * i + b * j + c));
    return field;
}

static void levelling_a_plane_changes_nothing_and_noise_becomes_its_plane(void **state)
{
    (void)state;
    WrField *clean = plane(80, 60, 0.01, -0.02, 3), *field = wr_field_share(clean);
    WrBrush brush = brush_of(WR_BRUSH_LEVEL, 14);
    brush.hardness = 1;
    wr_brush_dab(field, &brush, 0.1, 0.9); /* partly across the edge */
    assert_true(largest_difference(clean, field) < 1e-6);
    TestRandom random = { 3 };
    for (int j = 0; j < 60; j++)
        for (int i = 0; i < 80; i++)
            wr_field_set(field, i, j,
                         wr_field_get(clean, i, j) + (float)(0.1 * (test_random(&random) - 0.5)));
    WrField *noisy = wr_field_share(field);
    wr_brush_dab(field, &brush, 0.5, 0.5);
    double sums[3] = { 0 }; /* least squares: the change has no slope and no mean */
    for (int j = 0; j < 60; j++)
        for (int i = 0; i < 80; i++) {
            double change = (double)wr_field_get(field, i, j) - wr_field_get(noisy, i, j);
            sums[0] += change;
            sums[1] += change * (i - 40);
            sums[2] += change * (j - 30);
        }
    assert_near(sums[0], 0, 1e-4);
    assert_near(sums[1], 0, 1e-3);
    assert_near(sums[2], 0, 1e-3);
    wr_field_free(noisy);
    /* noise of 0.1/sqrt(12) over 600 texels: the plane's error is 0.1 / sqrt(12 * 600) * 2.1 at its edge, at most
       four times that */
    for (int j = 20; j < 40; j++)
        for (int i = 32; i < 48; i++)
            assert_near(wr_field_get(field, i, j), wr_field_get(clean, i, j), 0.0099);
    wr_field_free(clean);
    wr_field_free(field);
}

static void levelling_tables_without_breadth_is_fine(void **state)
{
    (void)state;
    const int sizes[][2] = { { 1, 1 }, { 1, 9 }, { 9, 1 }, { 2, 2 } };
    for (int s = 0; s < 4; s++) {
        WrField *clean = plane(sizes[s][0], sizes[s][1], 0.5, -0.25, 1);
        WrField *field = wr_field_share(clean);
        WrBrush brush = brush_of(WR_BRUSH_LEVEL, 30);
        brush.hardness = 1;
        wr_brush_dab(field, &brush, 0.5, 0.5);
        assert_true(largest_difference(clean, field) < 1e-6);
        wr_field_free(clean);
        wr_field_free(field);
    }
}

/* A ridge along the path with a bell profile; its second moment measures its width. */
static double breadth(const WrField *field)
{
    double sum = 0, moment = 0;
    for (int j = 0; j < 64; j++) {
        double f = wr_field_get(field, 64, j), y = j - 31.5;
        sum += f;
        moment += f * y * y;
    }
    return sqrt(moment / sum);
}

static void pinching_along_a_ridge_makes_it_narrower_and_no_higher(void **state)
{
    (void)state;
    WrField *field = torus(128, 64);
    for (int j = 0; j < 64; j++)
        for (int i = 0; i < 128; i++)
            wr_field_set(field, i, j, (float)exp(-0.02 * (j - 31.5) * (j - 31.5)));
    double before = breadth(field);
    WrBrush brush = brush_of(WR_BRUSH_PINCH, 20);
    WrSample samples[] = { at(0.3, 0.5, 1), at(0.7, 0.5, 1) };
    run_stroke(field, &brush, samples, 2);
    float low, high;
    wr_field_range(field, &low, &high);
    assert_true(breadth(field) < 0.8 * before && breadth(field) > 0.1 * before);
    assert_true(high <= 1 && low >= 0 && high > 0.97f);
    wr_field_free(field);
}

static void smearing_takes_a_step_along_and_leaves_level_ground_alone(void **state)
{
    (void)state;
    WrField *field = torus(128, 64);
    for (int j = 0; j < 64; j++)
        for (int i = 0; i < 64; i++) wr_field_set(field, i, j, 1);
    WrField *before = wr_field_share(field);
    WrBrush brush = brush_of(WR_BRUSH_SMEAR, 6);
    brush.hardness = 0.8;
    WrSample level[] = { at(0.1, 0.5, 1), at(0.3, 0.5, 1) };
    run_stroke(field, &brush, level, 2);
    assert_true(largest_difference(field, before) < 1e-7);
    WrSample over[] = { at(0.4, 0.5, 1), at(0.6, 0.5, 1) }; /* texel 51 to 77; the step is at 64 */
    run_stroke(field, &brush, over, 2);
    assert_true(wr_field_get(field, 70, 32) > 0.9f);
    assert_true(wr_field_get(field, 90, 32) == 0 && wr_field_get(field, 70, 45) == 0);
    float low, high;
    wr_field_range(field, &low, &high);
    assert_true(low >= 0 && high <= 1);
    wr_field_free(field);
    wr_field_free(before);
}

static WrPreset *smudger(void)
{
    const char text[] =
        "{\"version\":3,\"settings\":{\"smudge\":{\"base_value\":1,\"inputs\":{}},"
        "\"smudge_length\":{\"base_value\":0.9,\"inputs\":{}},"
        "\"opaque_multiply\":{\"base_value\":0,\"inputs\":{\"pressure\":[[0,0],[1,1]]}}}}";
    WrError err = { "" };
    WrPreset *preset = wr_preset_parse(text, sizeof text - 1, "smudger", NULL, &err);
    if (!preset) fail_msg("%s", err.text);
    return preset;
}

/* Fully smudged dabs only pull towards existing heights. */
static void a_smudging_preset_drags_heights_and_makes_no_new_extremes(void **state)
{
    (void)state;
    WrPreset *preset = smudger();
    assert_true(wr_preset_smudges(preset));
    for (int mode = 0; mode < WR_BRUSH_SMOOTH; mode++) {
        WrField *field = torus(128, 64), *before;
        for (int j = 0; j < 64; j++)
            for (int i = 0; i < 64; i++) wr_field_set(field, i, j, 1);
        before = wr_field_share(field);
        WrBrush brush = wr_preset_brush(preset);
        brush.radius = 8;
        brush.mode = (WrBrushMode)mode;
        brush.strength = 0.2;
        WrStroke *stroke = wr_stroke_new(field, &brush);
        for (int k = 0; k < 60; k++)
            wr_stroke_add(
                stroke,
                (WrSample){ .u = 0.3 + 0.006 * k, .v = 0.5, .pressure = 1, .seconds = 0.01 * k });
        wr_stroke_finish(stroke);
        float low, high;
        wr_field_range(field, &low, &high);
        assert_true(low >= 0 && high <= 1.001f);
        assert_true(largest_difference(field, before) > 0.2);
        wr_field_free(field);
        wr_field_free(before);
    }
    wr_preset_free(preset);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hc77_smoothing_keeps_the_mean_and_makes_no_new_extremes),
        cmocka_unit_test(smoothing_the_widest_heights_stays_finite),
        cmocka_unit_test(levelling_a_plane_changes_nothing_and_noise_becomes_its_plane),
        cmocka_unit_test(levelling_tables_without_breadth_is_fine),
        cmocka_unit_test(pinching_along_a_ridge_makes_it_narrower_and_no_higher),
        cmocka_unit_test(smearing_takes_a_step_along_and_leaves_level_ground_alone),
        cmocka_unit_test(a_smudging_preset_drags_heights_and_makes_no_new_extremes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
