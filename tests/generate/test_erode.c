/* Erosion: rain, flow and slides conserve mass. */
#include "test.h"
#include "generate_help.h"

#include "base/pool.h"
#include "base/progress.h"
#include "generate/erode.h"

static const WrGenerateJob alone = { .pool = NULL };

/* Periodic hills of 0..1. */
static WrField *hills(int width, int height, WrWrap wrap)
{
    WrField *f = wr_field_new(width, height, wrap, wrap, 0.0f, NULL);
    TestRandom r = { 8 };
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++) {
            double a = 6.283185307179586 * i / width, b = 6.283185307179586 * j / height;
            wr_field_set(f, i, j,
                         (float)(0.5 + 0.25 * sin(a + cos(2 * b)) * cos(b) +
                                 0.1 * sin(3 * a - 2 * b) + 0.05 * test_random(&r)));
        }
    return f;
}

static double sum_of(const WrField *f)
{
    double sum = 0.0;
    for (int j = 0; j < wr_field_height(f); j++)
        for (int i = 0; i < wr_field_width(f); i++) sum += (double)wr_field_get(f, i, j);
    return sum;
}

static const char *const weathers[] = { "thermal", "hydraulic" };

/* Up to the rounding of each height to float. */
static void no_ground_is_lost_on_any_edges(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        WrField *f = hills(90, 70, k / 2 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC);
        WrField *g = made_with("terrain", weathers[k % 2], NULL, f);
        assert_near(sum_of(g), sum_of(f), 90 * 70 * 3e-8);
        assert_true(largest_difference(f, g) > 0.02);
        wr_field_free(f);
        wr_field_free(g);
    }
}

/* In double precision, without rounding to float: conserved to the last digits. */
static void the_sum_of_heights_stays_to_rounding(void **state)
{
    (void)state;
    WrField *f = hills(64, 64, WR_WRAP_PERIODIC);
    for (int k = 0; k < 2; k++) {
        WrSheet s;
        double before = 0.0, after = 0.0;
        const WrThermal slides = { .talus = 0.002, .rate = 0.9, .rounds = 100 };
        const WrRain rain = { .drops = 2,
                              .inertia = 0.02,
                              .capacity = 4,
                              .erosion = 0.4,
                              .deposition = 0.3,
                              .evaporation = 0.01,
                              .radius = 2,
                              .life = 64 };
        assert_true(wr_sheet_read(&s, f, NULL));
        for (int i = 0; i < 4096; i++) before += s.z[i];
        assert_true(k ? wr_erode_rain(&s, &rain, &alone, NULL)
                      : wr_erode_thermal(&s, &slides, &alone, NULL));
        for (int i = 0; i < 4096; i++) after += s.z[i];
        assert_near(after, before, 1e-10);
        wr_sheet_fini(&s);
    }
    wr_field_free(f);
}

static void flat_ground_stays_as_it_is_bit_for_bit(void **state)
{
    (void)state;
    WrField *f = wr_field_new(65, 40, WR_WRAP_PERIODIC, WR_WRAP_CLAMP, 0.3f, NULL);
    for (int k = 0; k < 2; k++) {
        WrField *g = made_with("terrain", weathers[k], NULL, f);
        assert_true(is_rolled(f, g, 0, 0));
        wr_field_free(g);
    }
    wr_field_free(f);
}

static void any_number_of_threads_makes_the_same_weather(void **state)
{
    (void)state;
    WrField *f = hills(130, 90, WR_WRAP_PERIODIC);
    for (int k = 0; k < 2; k++) {
        const WrGenerator *g = wr_generator_find("terrain", weathers[k]);
        WrParamValue values[WR_GENERATOR_PARAMS];
        WrField *first = NULL;
        wr_generator_defaults(g, values);
        for (int threads = 1; threads <= 4; threads++) {
            WrPool *pool = wr_pool_new(threads);
            WrField *now = made(g, values, f, pool, false);
            if (first) assert_true(is_rolled(first, now, 0, 0));
            if (first) wr_field_free(now);
            else first = now;
            wr_pool_free(pool);
        }
        wr_field_free(first);
    }
    wr_field_free(f);
}

/* 4 x 2 tiles of drops on the finest of three grids; an odd number of texels, edges of both kinds. */
static void drops_in_tiles_fall_alike_on_1_2_and_7_threads_and_lose_nothing(void **state)
{
    (void)state;
    static const int threads[] = { 1, 2, 7 };
    WrField *f = hills(563, 287, WR_WRAP_PERIODIC);
    const WrGenerator *g = wr_generator_find("terrain", "hydraulic");
    WrParamValue values[WR_GENERATOR_PARAMS];
    WrField *first = NULL;
    wr_generator_defaults(g, values);
    value_of(g, values, "life")->number[0] = 250;
    value_of(g, values, "rain")->number[0] = 0.3;
    for (int k = 0; k < 3; k++) {
        WrPool *pool = wr_pool_new(threads[k]);
        WrField *now = made(g, values, f, pool, false);
        assert_near(sum_of(now), sum_of(f), 563 * 287 * 3e-8);
        if (first) assert_true(is_rolled(first, now, 0, 0));
        if (first) wr_field_free(now);
        else first = now;
        wr_pool_free(pool);
    }
    assert_true(largest_difference(f, first) > 0.02);
    wr_field_free(first);
    wr_field_free(f);
}

/* Rain shapes the border between tiles like their interior: the mean change along rows of a uniform slope does not
 * reveal the tiles. */
static void tiles_of_drops_cannot_be_seen(void **state)
{
    (void)state;
    enum { W = 560, H = 140 };
    WrField *f = table_of(W, H);
    double change[W] = { 0 }, mean = 0.0, spread = 0.0;
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++)
            wr_field_set(f, i, j, (float)(0.5 + 0.5 * cos(6.283185307179586 * j / H)));
    WrField *g = made_with("terrain", "hydraulic", NULL, f);
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++)
            change[i] += fabs((double)wr_field_get(g, i, j) - (double)wr_field_get(f, i, j)) / H;
    for (int i = 0; i < W; i++) mean += change[i] / W;
    for (int i = 0; i < W; i++) spread += pow(change[i] - mean, 2) / W;
    spread = sqrt(spread);
    for (int k = 0; k < 4; k++) { /* four tiles: a strip of 20 texels around each border */
        double strip = 0.0;
        for (int i = -10; i < 10; i++) strip += change[(k * W / 4 + i + W) % W] / 20.0;
        assert_near(strip, mean, spread);
    }
    assert_true(mean > 0.003);
    wr_field_free(f);
    wr_field_free(g);
}

static void stones_slide_alike_wherever_the_table_begins(void **state)
{
    (void)state;
    WrField *f = hills(96, 64, WR_WRAP_PERIODIC), *moved = hills(96, 64, WR_WRAP_PERIODIC);
    for (int j = 0; j < 64; j++)
        for (int i = 0; i < 96; i++)
            wr_field_set(moved, (i + 41) % 96, (j + 64 - 13) % 64, wr_field_get(f, i, j));
    assert_true(is_rolled(f, moved, 41, 13));
    WrField *a = made_with("terrain", "thermal", NULL, f);
    WrField *b = made_with("terrain", "thermal", NULL, moved);
    assert_true(is_rolled(a, b, 41, 13));
    assert_false(is_rolled(a, f, 0, 0));
    wr_field_free(f);
    wr_field_free(moved);
    wr_field_free(a);
    wr_field_free(b);
}

/* After a long time no slope exceeds the angle of repose, along axes and diagonals. */
static void slopes_come_down_to_the_angle_of_rest(void **state)
{
    (void)state;
    WrField *f = wr_field_new(48, 48, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, NULL);
    for (int j = 20; j < 28; j++)
        for (int i = 18; i < 30; i++) wr_field_set(f, i, j, 1.0f);
    static const Setting settings[] = {
        { "talus", 45 }, { "width", 4.8 }, { "rounds", 3000 }, { NULL, 0 }
    };
    WrField *g = made_with("terrain", "thermal", settings, f); /* 0.1 a texel */
    double most = 0.0;
    for (int j = 0; j < 48; j++)
        for (int i = 0; i < 48; i++) {
            double z = (double)wr_field_get(g, i, j);
            most = fmax(most, fabs(z - (double)wr_field_get(g, (i + 1) % 48, j)));
            most = fmax(most, fabs(z - (double)wr_field_get(g, i, (j + 1) % 48)));
            most = fmax(most,
                        fabs(z - (double)wr_field_get(g, (i + 1) % 48, (j + 1) % 48)) / sqrt(2.0));
        }
    assert_true(most < 0.1005 && most > 0.09);
    wr_field_free(f);
    wr_field_free(g);
}

/* Gentler slopes are unchanged. */
static void gentle_slopes_do_not_slide(void **state)
{
    (void)state;
    WrField *f = hills(64, 64, WR_WRAP_PERIODIC);
    static const Setting settings[] = { { "talus", 80 }, { "width", 1000 }, { NULL, 0 } };
    WrField *g = made_with("terrain", "thermal", settings, f);
    assert_true(is_rolled(f, g, 0, 0));
    wr_field_free(f);
    wr_field_free(g);
}

/* Mean square of the second differences along rows. */
static double roughness(const WrField *f)
{
    double sum = 0.0;
    int w = wr_field_width(f), h = wr_field_height(f);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++)
            sum +=
                pow(2.0 * (double)wr_field_get(f, i, j) - (double)wr_field_get(f, (i + 1) % w, j) -
                        (double)wr_field_get(f, (i + w - 1) % w, j),
                    2);
    return sum / (w * h);
}

/* A smooth hill and a basin. */
static void rain_wears_peaks_fills_basins_and_cuts_gullies(void **state)
{
    (void)state;
    WrField *f = table_of(128, 128);
    double basin = 0.0, peak = 0.0;
    for (int j = 0; j < 128; j++)
        for (int i = 0; i < 128; i++)
            wr_field_set(f, i, j,
                         (float)(0.5 + 0.25 * cos(6.283185307179586 * i / 128.0) +
                                 0.25 * cos(6.283185307179586 * j / 128.0)));
    WrField *g = made_with("terrain", "hydraulic", NULL, f);
    for (int k = 0; k < 400; k++) { /* means over 20 x 20 texels */
        int i = k % 20 - 10, j = k / 20 - 10, x = (i + 128) % 128, y = (j + 128) % 128;
        peak += ((double)wr_field_get(g, x, y) - (double)wr_field_get(f, x, y)) / 400.0;
        basin +=
            ((double)wr_field_get(g, 64 + i, 64 + j) - (double)wr_field_get(f, 64 + i, 64 + j)) /
            400.0;
    }
    assert_true(basin > 0.02 && peak < -0.02);
    assert_true(roughness(g) > 10.0 * roughness(f));
    wr_field_free(f);
    wr_field_free(g);
}

static void spikes_stay_finite(void **state)
{
    (void)state;
    static const float heights[] = { 1e6f, -1e6f, 3e38f, 1e-42f };
    for (int k = 0; k < 8; k++) {
        WrField *f = hills(40, 30, k % 3 ? WR_WRAP_PERIODIC : WR_WRAP_CLAMP);
        wr_field_set(f, 0, 0, heights[k / 2]);
        wr_field_set(f, 20, 20, -heights[k / 2]);
        WrField *g = made_with("terrain", weathers[k % 2], NULL, f);
        for (int j = 0; j < 30; j++)
            for (int i = 0; i < 40; i++) assert_true(isfinite(wr_field_get(g, i, j)));
        if (fabsf(heights[k / 2]) <= 1e6f) assert_near(sum_of(g), sum_of(f), 40 * 30 * 0.07);
        wr_field_free(f);
        wr_field_free(g);
    }
}

static void tables_of_one_texel_or_row_are_weathered_too(void **state)
{
    (void)state;
    static const int sizes[][2] = { { 1, 1 }, { 1, 9 }, { 9, 1 }, { 2, 2 }, { 3, 1 } };
    for (int k = 0; k < 20; k++) {
        WrField *f =
            hills(sizes[k % 5][0], sizes[k % 5][1], k < 10 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC);
        WrField *g = made_with("terrain", weathers[k / 5 % 2], NULL, f);
        assert_near(sum_of(g), sum_of(f), 1e-6);
        wr_field_free(f);
        wr_field_free(g);
    }
}

/* ---- coarse previews, cancelling ---- */

static void a_coarse_preview_changes_the_table_about_as_much(void **state)
{
    (void)state;
    WrField *f = hills(320, 200, WR_WRAP_PERIODIC);
    const WrGenerator *g = wr_generator_find("terrain", "hydraulic");
    WrParamValue values[WR_GENERATOR_PARAMS];
    wr_generator_defaults(g, values);
    WrField *coarse = made(g, values, f, NULL, true);
    assert_int_equal(wr_field_width(coarse), 320);
    assert_near(sum_of(coarse) / 64000.0, sum_of(f) / 64000.0, 1e-3);
    assert_true(largest_difference(f, coarse) > 0.02);
    wr_field_free(f);
    wr_field_free(coarse);
}

static void stop_soon(void *ctx, double fraction)
{
    if (fraction > 0.2) *(volatile int *)ctx = 1;
}

static void weather_can_be_stopped(void **state)
{
    (void)state;
    WrField *f = hills(128, 128, WR_WRAP_PERIODIC);
    for (int k = 0; k < 2; k++) {
        const WrGenerator *g = wr_generator_find("terrain", weathers[k]);
        volatile int cancel = 0;
        const WrProgress progress = { &cancel, stop_soon, (void *)&cancel };
        const WrGenerateJob job = { .like = f, .progress = &progress };
        WrParamValue values[WR_GENERATOR_PARAMS];
        WrRelief relief = { NULL, NULL };
        WrError err;
        wr_generator_defaults(g, values);
        assert_false(wr_generator_make(g, values, &job, &relief, &err));
        assert_string_equal(err.text, "cancelled");
        assert_null(relief.heights);
    }
    wr_field_free(f);
}

typedef struct Steps {
    double fraction[64];
    int count;
} Steps;

static void note_step(void *ctx, double fraction)
{
    Steps *steps = ctx;
    if (steps->count < 64) steps->fraction[steps->count++] = fraction;
}

/* Of 96 x 96 texels there is one coarser grid, of a quarter of the texels and 0.15 of the drops, which run just as far: it has
   0.0375 / 1.0375 of the work, and both grids have 8 equal rounds. The time left depends on it. */
static void the_progress_of_rain_goes_by_its_drops(void **state)
{
    (void)state;
    WrField *f = wr_field_new(96, 96, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    wr_field_set(f, 40, 50, 1.0f);
    Steps steps = { .count = 0 };
    const WrProgress progress = { .report = note_step, .ctx = &steps };
    const WrGenerateJob job = { .like = f, .progress = &progress };
    const WrRain rain = { .drops = 0.01, .capacity = 4, .erosion = 0.4, .radius = 2, .life = 128 };
    WrSheet s;
    assert_true(wr_sheet_read(&s, f, NULL));
    assert_true(wr_erode_rain(&s, &rain, &job, NULL));
    wr_sheet_fini(&s);
    wr_field_free(f);
    assert_int_equal(steps.count, 17);
    const double coarse = 0.0375 / 1.0375;
    for (int i = 0; i < 8; i++) {
        assert_float_equal(steps.fraction[i], coarse * (i + 1) / 8, 1e-12);
        assert_float_equal(steps.fraction[8 + i], coarse + (1 - coarse) * (i + 1) / 8, 1e-12);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_ground_is_lost_on_any_edges),
        cmocka_unit_test(the_sum_of_heights_stays_to_rounding),
        cmocka_unit_test(flat_ground_stays_as_it_is_bit_for_bit),
        cmocka_unit_test(any_number_of_threads_makes_the_same_weather),
        cmocka_unit_test(drops_in_tiles_fall_alike_on_1_2_and_7_threads_and_lose_nothing),
        cmocka_unit_test(tiles_of_drops_cannot_be_seen),
        cmocka_unit_test(stones_slide_alike_wherever_the_table_begins),
        cmocka_unit_test(slopes_come_down_to_the_angle_of_rest),
        cmocka_unit_test(gentle_slopes_do_not_slide),
        cmocka_unit_test(rain_wears_peaks_fills_basins_and_cuts_gullies),
        cmocka_unit_test(spikes_stay_finite),
        cmocka_unit_test(tables_of_one_texel_or_row_are_weathered_too),
        cmocka_unit_test(a_coarse_preview_changes_the_table_about_as_much),
        cmocka_unit_test(weather_can_be_stopped),
        cmocka_unit_test(the_progress_of_rain_goes_by_its_drops),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
