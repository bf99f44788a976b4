/* The round brush against a slow model of its header's specification, and its hard cases. */
#include "test.h"

#include "base/hash.h"
#include "base/memory.h"
#include "brush/brush.h"
#include "brush/brush_kernels.h"
#include "field/field.h"

#include <float.h>

static WrField *flat(int width, int height, WrWrap wrap_u, WrWrap wrap_v, float level)
{
    return wr_field_new(width, height, wrap_u, wrap_v, level, NULL);
}

static WrField *torus(int width, int height)
{
    return flat(width, height, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f);
}

static WrField *rough(int width, int height, uint64_t seed)
{
    WrField *field = torus(width, height);
    TestRandom random = { seed };
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++)
            wr_field_set(field, i, j, (float)(test_random(&random) - 0.5));
    return field;
}

static WrBrush brush_of(double radius, double hardness, double strength)
{
    WrBrush brush = wr_brush_default();
    brush.radius = radius;
    brush.hardness = hardness;
    brush.strength = strength;
    return brush;
}

static bool same_heights(const WrField *a, const WrField *b)
{
    return wr_hash_equal(wr_field_hash(a), wr_field_hash(b));
}

static WrSample at(double u, double v, double pressure)
{
    return (WrSample){ .u = u, .v = v, .pressure = pressure };
}

static void run_stroke(WrField *field, const WrBrush *brush, const WrSample *samples, int count)
{
    WrStroke *stroke = wr_stroke_new(field, brush);
    for (int k = 0; k < count; k++) wr_stroke_add(stroke, samples[k]);
    wr_stroke_finish(stroke);
}

/* The model: in double, over all images, without spans, tiles or vectors. */
static double model_profile(const WrBrush *brush, double d)
{
    double inner = fmax(fmin(brush->hardness * brush->radius, brush->radius - 1), 0.70711);
    double s = fmin(fmax((brush->radius - d) / (brush->radius - inner), 0), 1);
    return s * s * (3 - 2 * s);
}

static double model_segment(const WrBrush *brush, double x, double y, const double a[3],
                            const double b[3])
{
    double dx = b[0] - a[0], dy = b[1] - a[1], length2 = dx * dx + dy * dy;
    double t = length2 > 0 ? ((x - a[0]) * dx + (y - a[1]) * dy) / length2 : 0;
    t = fmin(fmax(t, 0), 1);
    double pressure = length2 > 0 ? a[2] + t * (b[2] - a[2]) : fmax(a[2], b[2]);
    return pressure * model_profile(brush, hypot(x - a[0] - t * dx, y - a[1] - t * dy));
}

/* Coverage of texel (i, j); path in texels, each point close to the previous one (not wrapped). */
static double model_cover(const WrField *field, const WrBrush *brush, const double (*path)[3],
                          int count, int i, int j)
{
    int across = wr_field_wrap_u(field) == WR_WRAP_PERIODIC ? 3 : 0;
    int down = wr_field_wrap_v(field) == WR_WRAP_PERIODIC ? 3 : 0;
    double cover = 0;
    for (int m = -across; m <= across; m++)
        for (int n = -down; n <= down; n++)
            for (int k = 0; k < count; k++) /* the first sample is a dab */
                cover = fmax(cover, model_segment(brush, i + m * wr_field_width(field),
                                                  j + n * wr_field_height(field),
                                                  path[k > 0 ? k - 1 : 0], path[k]));
    return cover;
}

static void check_against_model(const WrField *field, const WrBrush *brush, const double (*path)[3],
                                int count)
{
    for (int j = 0; j < wr_field_height(field); j++)
        for (int i = 0; i < wr_field_width(field); i++) {
            double f = brush->strength * model_cover(field, brush, path, count, i, j);
            assert_near(wr_field_get(field, i, j), f, 2e-7 * fabs(brush->strength));
        }
}

static void dabs_match_the_model_on_any_table(void **state)
{
    (void)state;
    const int sizes[][2] = { { 1, 1 }, { 3, 5 }, { 48, 20 }, { 70, 33 }, { 130, 7 } };
    TestRandom random = { 1 };
    for (int s = 0; s < 5; s++)
        for (int k = 0; k < 60; k++) {
            WrWrap wu = k & 1 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC;
            WrWrap wv = k & 2 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC;
            WrField *field = flat(sizes[s][0], sizes[s][1], wu, wv, 0);
            double radius = 0.8 + exp(4 * test_random(&random)) - 1;
            WrBrush brush = brush_of(radius, k % 3 * 0.5, 0.7);
            double u = 1.2 * test_random(&random) - 0.1, v = 1.2 * test_random(&random) - 0.1;
            double path[1][3] = { { sizes[s][0] * u - 0.5, sizes[s][1] * (1 - v) - 0.5, 1 } };
            wr_brush_dab(field, &brush, u, v);
            check_against_model(field, &brush, (const double(*)[3])path, 1);
            wr_field_free(field);
        }
}

/* Steps between 2 texels (so that none waits) and half the table. */
static void strokes_match_the_model(void **state)
{
    (void)state;
    TestRandom random = { 2 };
    for (int k = 0; k < 24; k++) {
        enum { POINTS = 5, W = 96, H = 72 };
        WrField *field = torus(W, H);
        WrBrush brush = brush_of(1 + 12 * test_random(&random), test_random(&random), -0.3);
        double path[POINTS][3];
        WrSample samples[POINTS];
        for (int p = 0; p < POINTS; p++) {
            double turn = 2 * M_PI * test_random(&random), step = 2 + 33 * test_random(&random);
            path[p][0] = p ? path[p - 1][0] + step * cos(turn) : 5;
            path[p][1] = p ? path[p - 1][1] + step * sin(turn) : 66;
            path[p][2] = k % 2 ? test_random(&random) : 0.8;
            samples[p] = at((path[p][0] + 0.5) / W, 1 - (path[p][1] + 0.5) / H, path[p][2]);
        }
        run_stroke(field, &brush, samples, POINTS);
        check_against_model(field, &brush, (const double(*)[3])path, POINTS);
        wr_field_free(field);
    }
}

static void strokes_wider_than_the_table_match_the_model(void **state)
{
    (void)state;
    TestRandom random = { 3 };
    for (int k = 0; k < 30; k++) {
        enum { W = 20, H = 33 };
        WrField *field = torus(W, H);
        WrBrush brush = brush_of(8 + 20 * test_random(&random), 0.2, 1);
        double x = W * test_random(&random), y = H * test_random(&random);
        double path[3][3] = { { x, y, 1 },
                              { x + 9 * test_random(&random), y + 16 * test_random(&random), 1 },
                              { x + 3, y + 5, 1 } };
        WrSample samples[3];
        for (int p = 0; p < 3; p++)
            samples[p] = at((path[p][0] + 0.5) / W, 1 - (path[p][1] + 0.5) / H, 1);
        run_stroke(field, &brush, samples, 3);
        check_against_model(field, &brush, (const double(*)[3])path, 3);
        wr_field_free(field);
    }
}

static void the_texel_that_holds_the_centre_changes_by_exactly_strength(void **state)
{
    (void)state;
    const double radii[] = { 0.01, 0.5, 0.70711, 0.71, 1, 1.7, 5, 40, 300, 1e9 };
    TestRandom random = { 4 };
    for (int r = 0; r < 10; r++)
        for (int k = 0; k < 50; k++) {
            WrField *field = torus(100, 60);
            WrBrush brush = brush_of(radii[r], test_random(&random), 0.1);
            double u = k ? test_random(&random) : 0.25, v = k ? test_random(&random) : 0.5;
            wr_brush_dab(field, &brush, u, v);
            int i = (int)floor(100 * u), j = (int)floor(60 * (1 - v));
            assert_true(wr_field_get(field, i, j) == 0.1f);
            wr_field_free(field);
        }
}

static void hc69_a_dab_on_the_corner_is_the_rolled_dab_in_the_middle(void **state)
{
    (void)state;
    const double radii[] = { 0.3, 1.5, 10, 63.9, 64, 64.1, 100 };
    for (int r = 0; r < 7; r++) {
        WrField *corner = torus(128, 128), *middle = torus(128, 128);
        WrBrush brush = brush_of(radii[r], 0.3, 0.7);
        wr_brush_dab(corner, &brush, 0, 0);
        wr_brush_dab(middle, &brush, 0.5, 0.5);
        for (int j = 0; j < 128; j++)
            for (int i = 0; i < 128; i++)
                assert_true(wr_field_get(corner, i, j) ==
                            wr_field_get(middle, (i + 64) % 128, (j + 64) % 128));
        wr_field_free(corner);
        wr_field_free(middle);
    }
}

static void hc70_a_huge_dab_raises_every_texel_once(void **state)
{
    (void)state;
    const double radii[] = { 500, 1e6, 1e9, INFINITY };
    for (int r = 0; r < 4; r++) {
        WrField *field = torus(300, 64);
        WrBrush brush = brush_of(radii[r], 1, 0.25);
        /* on a texel's centre, so that the texels half a period away are equally near on both sides */
        wr_brush_dab(field, &brush, 10.5 / 300, 1 - 5.5 / 64);
        float low, high;
        wr_field_range(field, &low, &high);
        assert_true(low == 0.25f && high == 0.25f);
        WrSample samples[] = { at(0.1, 0.1, 1), at(0.5, 0.6, 1), at(0.9, 0.2, 1) };
        run_stroke(field, &brush, samples, 3);
        wr_field_range(field, &low, &high);
        assert_true(low == 0.5f && high == 0.5f);
        wr_field_free(field);
    }
}

static void hc71_no_radius_paints_nothing_and_a_third_of_a_texel_one(void **state)
{
    (void)state;
    const double none[] = { 0, -1, NAN, -INFINITY };
    WrField *field = rough(50, 40, 5), *before = wr_field_share(field);
    for (int k = 0; k < 4; k++) {
        WrBrush brush = brush_of(none[k], 0.5, 1);
        wr_brush_dab(field, &brush, 0.4, 0.4);
        WrSample samples[] = { at(0.1, 0.1, 1), at(0.5, 0.6, 1) };
        run_stroke(field, &brush, samples, 2);
    }
    assert_true(wr_field_key(field) == wr_field_key(before));
    wr_field_fill(field, 0);
    WrBrush brush = brush_of(0.3, 0.5, 1);
    wr_brush_dab(field, &brush, 0.999, 0.001);
    for (int j = 0; j < 40; j++)
        for (int i = 0; i < 50; i++)
            assert_true(wr_field_get(field, i, j) == (i == 49 && j == 39 ? 1.0f : 0.0f));
    wr_field_free(field);
    wr_field_free(before);
}

static void hc72_repeated_points_are_one_dab(void **state)
{
    (void)state;
    const double radii[] = { 0.4, 3, 50 };
    for (int r = 0; r < 3; r++) {
        WrField *dab = rough(80, 80, 6), *stroke = wr_field_share(dab), *one = wr_field_share(dab);
        WrBrush brush = brush_of(radii[r], 0.2, 0.5);
        WrSample samples[100];
        for (int k = 0; k < 100; k++) samples[k] = at(0.31, 0.77, 1);
        wr_brush_dab(dab, &brush, 0.31, 0.77);
        run_stroke(stroke, &brush, samples, 100);
        run_stroke(one, &brush, samples, 1);
        assert_true(same_heights(dab, stroke) && same_heights(dab, one));
        wr_field_free(dab);
        wr_field_free(stroke);
        wr_field_free(one);
    }
}

static void hc73_a_stroke_across_the_seam_takes_the_short_way(void **state)
{
    (void)state;
    for (int thin = 0; thin < 2; thin++) {
        WrField *seam = torus(128, 64), *middle = torus(128, 64);
        WrBrush brush = brush_of(thin ? 0.5 : 4.5, 0.4, 1);
        WrSample across[] = { at(0.9375, 0.875, 1), at(0.0625, 0.125, 1), at(0.25, 0.0, 1) };
        WrSample inside[] = { at(0.4375, 0.375, 1), at(0.5625, 0.625, 1), at(0.75, 0.5, 1) };
        run_stroke(seam, &brush, across, 3);
        run_stroke(middle, &brush, inside, 3);
        for (int j = 0; j < 64; j++)
            for (int i = 0; i < 128; i++)
                assert_true(wr_field_get(seam, i, j) ==
                            wr_field_get(middle, (i + 64) % 128, (j + 32) % 64));
        assert_true(wr_field_get(seam, 64, 0) == 0.0f);
        wr_field_free(seam);
        wr_field_free(middle);
    }
}

static void hc74_wild_pressures_are_clamped(void **state)
{
    (void)state;
    WrField *field = rough(64, 64, 7), *before = wr_field_share(field);
    WrBrush brush = brush_of(9, 0.5, 1);
    WrSample nothing[] = { at(0.5, 0.5, NAN), at(0.6, 0.6, -3), at(0.1, 0.3, -INFINITY) };
    run_stroke(field, &brush, nothing, 3);
    assert_true(same_heights(field, before));
    WrField *full = wr_field_share(field);
    WrSample wild[] = { at(0.5, 0.5, INFINITY), at(0.6, 0.6, 7) };
    WrSample tame[] = { at(0.5, 0.5, 1), at(0.6, 0.6, 1) };
    run_stroke(field, &brush, wild, 2);
    run_stroke(full, &brush, tame, 2);
    assert_true(same_heights(field, full) && !same_heights(field, before));
    wr_field_free(field);
    wr_field_free(before);
    wr_field_free(full);
}

static void samples_in_no_place_are_left_out(void **state)
{
    (void)state;
    WrField *field = torus(64, 64), *plain = torus(64, 64);
    WrBrush brush = brush_of(5, 0.5, 1);
    wr_brush_dab(field, &brush, NAN, 0.5);
    wr_brush_dab(field, &brush, 0.5, INFINITY);
    assert_true(same_heights(field, plain));
    WrSample with[] = { at(NAN, 0, 1), at(0.2, 0.2, 1), at(0.3, -INFINITY, 1), at(0.4, 0.3, 1) };
    WrSample without[] = { at(0.2, 0.2, 1), at(0.4, 0.3, 1) };
    run_stroke(field, &brush, with, 4);
    run_stroke(plain, &brush, without, 2);
    assert_true(same_heights(field, plain));
    wr_field_free(field);
    wr_field_free(plain);
}

static void a_place_far_off_a_clamped_table_paints_nothing(void **state)
{
    (void)state;
    WrField *field = flat(64, 64, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0);
    const double radii[] = { 0.5, 20 };
    for (int r = 0; r < 2; r++) {
        WrBrush brush = brush_of(radii[r], 0.5, 1);
        wr_brush_dab(field, &brush, 1e300, -1e300);
        wr_brush_dab(field, &brush, 1.5, 0.5);
        WrSample samples[] = { at(2, 2, 1), at(3, 1e9, 1), at(1e300, 2, 1) };
        run_stroke(field, &brush, samples, 3);
        assert_int_equal(wr_field_bytes(field), 0);
        WrSample through[] = { at(-1e8, 0.51, 1), at(1e8, 0.51, 1) };
        run_stroke(field, &brush, through, 2);
        assert_true(wr_field_get(field, 0, 31) == 1.0f && wr_field_get(field, 63, 31) == 1.0f);
        assert_true(wr_field_get(field, 63, 0) == 0.0f);
        wr_field_fill(field, 0);
    }
    wr_field_free(field);
}

/* Along a row the nearest point of any part of the path is exactly equally far, so no bit may differ. */
static void hc75_one_event_and_a_thousand_draw_the_same_straight_stroke(void **state)
{
    (void)state;
    const double radii[] = { 0.5, 0.9, 6, 40 };
    static WrSample many[1001];
    for (int r = 0; r < 4; r++) {
        WrField *a = torus(256, 128), *b = torus(256, 128);
        WrBrush brush = brush_of(radii[r], 0.3, 0.8);
        for (int k = 0; k <= 1000; k++) many[k] = at(0.125 + 0.375 * k / 1000, 0.45, 0.75);
        WrSample two[] = { many[0], many[1000] };
        run_stroke(a, &brush, many, 1001);
        run_stroke(b, &brush, two, 2);
        assert_true(same_heights(a, b));
        wr_field_free(a);
        wr_field_free(b);
    }
}

static void hc75_slanted_strokes_with_changing_pressure_agree_closely(void **state)
{
    (void)state;
    static WrSample many[1001];
    for (int pressed = 0; pressed < 2; pressed++) {
        WrField *a = torus(256, 128), *b = torus(256, 128);
        WrBrush brush = brush_of(12, 0.3, 1);
        for (int k = 0; k <= 1000; k++)
            many[k] = at(0.125 + 0.375 * k / 1000, 0.2 + 0.3 * k / 1000,
                         pressed ? 0.2 + 0.8 * k / 1000 : 1);
        WrSample two[] = { many[0], many[1000] };
        run_stroke(a, &brush, many, 1001);
        run_stroke(b, &brush, two, 2);
        /* with increasing pressure the nearest point is not the strongest: a disc's radius further, 12 of 103 texels
           of 0.8, it may count for more */
        double tolerance = pressed ? 0.8 * 12 / 103 : 1e-6;
        for (int j = 0; j < 128; j++)
            for (int i = 0; i < 256; i++)
                assert_near(wr_field_get(a, i, j), wr_field_get(b, i, j), tolerance);
        wr_field_free(a);
        wr_field_free(b);
    }
}

static void a_stroke_that_crosses_itself_does_not_double(void **state)
{
    (void)state;
    WrField *field = torus(128, 128);
    WrBrush brush = brush_of(8, 0.5, 0.5);
    WrSample eight[] = { at(0.2, 0.2, 1), at(0.7, 0.7, 1), at(0.7, 0.3, 1),
                         at(0.3, 0.7, 1), at(0.2, 0.2, 1), at(0.7, 0.7, 1) };
    run_stroke(field, &brush, eight, 6);
    float low, high;
    wr_field_range(field, &low, &high);
    assert_true(low == 0.0f && high == 0.5f);
    wr_field_free(field);
}

static void what_comes_out_depends_on_the_samples_alone(void **state)
{
    (void)state;
    WrField *a = rough(200, 200, 8), *b = wr_field_share(a);
    WrBrush brush = brush_of(60, 0.5, 0.5);
    WrStroke *sa = wr_stroke_new(a, &brush), *sb = wr_stroke_new(b, &brush);
    TestRandom random = { 9 };
    double u = 0.5, v = 0.5;
    for (int k = 0; k < 300; k++) { /* a trembling pointer: most samples wait */
        WrSample sample = at(u, v, 0.9 + 0.02 * test_random(&random));
        wr_stroke_add(sa, sample);
        if (k % 7 == 0) wr_field_free(wr_field_share(a)); /* snapshots in between change nothing */
        wr_stroke_add(sb, sample);
        u += 0.01 * (test_random(&random) - 0.48);
        v += 0.01 * (test_random(&random) - 0.5);
    }
    wr_stroke_finish(sa);
    wr_stroke_finish(sb);
    assert_true(same_heights(a, b));
    wr_field_free(a);
    wr_field_free(b);
}

static void a_stroke_reaches_its_last_sample_however_near(void **state)
{
    (void)state;
    WrField *near = torus(256, 256), *dab = torus(256, 256);
    WrBrush brush = brush_of(64, 0.5, 1);
    WrSample samples[] = { at(0.5, 0.5, 1), at(0.5 + 1.5 / 256, 0.5, 1) };
    run_stroke(near, &brush, samples, 2);
    wr_brush_dab(dab, &brush, samples[1].u, 0.5);
    for (int i = 0; i < 256; i++)
        assert_true(wr_field_get(near, i, 128) >= wr_field_get(dab, i, 128) - 1e-7f);
    wr_field_free(near);
    wr_field_free(dab);
}

static void a_thin_stroke_is_a_line_without_gaps(void **state)
{
    (void)state;
    WrField *field = torus(64, 64);
    WrBrush brush = brush_of(0.5, 0.5, 1);
    WrSample samples[] = { at(10.5 / 64, 1 - 20.5 / 64, 1), at(30.5 / 64, 1 - 27.5 / 64, 1) };
    run_stroke(field, &brush, samples, 2);
    int before = 20, painted = 0;
    for (int i = 0; i < 64; i++)
        for (int j = 0; j < 64; j++) {
            if (wr_field_get(field, i, j) == 0.0f) continue;
            assert_true(wr_field_get(field, i, j) == 1.0f);
            assert_true(j - before == 0 || j - before == 1);
            assert_near(j, 20 + 7 * (i - 10) / 20.0, 0.5);
            before = j;
            painted++;
        }
    assert_int_equal(painted, 21);
    wr_field_free(field);
}

static void levelling_moves_towards_its_height_and_never_past_it(void **state)
{
    (void)state;
    const float starts[] = { 0, 0.3f, 1, -5, 1e30f, -FLT_MAX };
    const double strengths[] = { 0.01, 0.5, 1e39 };
    for (int s = 0; s < 6; s++)
        for (int k = 0; k < 3; k++) {
            WrField *field = flat(40, 40, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, starts[s]);
            WrBrush brush = brush_of(10, 0.3, strengths[k]);
            brush.mode = WR_BRUSH_TO;
            brush.to = 0.3;
            wr_brush_dab(field, &brush, 0.51, 0.51);
            double gap = 0.3 - starts[s], step = fmin(strengths[k], fabs(gap));
            double expected = step == fabs(gap) ? 0.3 : starts[s] + copysign(step, gap);
            assert_true(wr_field_get(field, 20, 19) == (float)expected);
            for (int i = 0; i < 40; i++) {
                float f = wr_field_get(field, i, 19);
                assert_true(f >= fminf(starts[s], 0.3f) && f <= fmaxf(starts[s], 0.3f));
            }
            wr_field_free(field);
        }
}

static void lower_is_raise_with_the_sign_turned(void **state)
{
    (void)state;
    WrField *a = rough(70, 70, 10), *b = wr_field_share(a);
    WrBrush raise = brush_of(20, 0.5, -0.3), lower = brush_of(20, 0.5, 0.3);
    lower.mode = WR_BRUSH_LOWER;
    wr_brush_dab(a, &raise, 0.1, 0.9);
    wr_brush_dab(b, &lower, 0.1, 0.9);
    assert_true(same_heights(a, b));
    wr_field_free(a);
    wr_field_free(b);
}

static void heights_stop_at_the_ends_of_floats_range(void **state)
{
    (void)state;
    const double strengths[] = { 1e30, 3e38, 1e308, INFINITY, -INFINITY };
    for (int k = 0; k < 5; k++) {
        WrField *field = flat(30, 30, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, FLT_MAX);
        WrBrush brush = brush_of(100, 1, fabs(strengths[k]));
        brush.mode = strengths[k] < 0 ? WR_BRUSH_LOWER : WR_BRUSH_RAISE;
        WrSample samples[] = { at(0.1, 0.1, 1), at(0.4, 0.4, 1) };
        for (int n = 0; n < 3; n++) {
            wr_brush_dab(field, &brush, 0.5, 0.5);
            run_stroke(field, &brush, samples, 2);
        }
        float low, high;
        wr_field_range(field, &low, &high);
        assert_true(low == high && fabsf(low) == FLT_MAX && (low < 0) == (strengths[k] < 0));
        wr_field_free(field);
    }
    WrField *field = rough(30, 30, 11), *before = wr_field_share(field);
    WrBrush brush = brush_of(5, 1, NAN);
    wr_brush_dab(field, &brush, 0.5, 0.5);
    assert_true(same_heights(field, before));
    wr_field_free(field);
    wr_field_free(before);
}

typedef struct Touched {
    int count, low_x, high_x, low_y, high_y;
} Touched;

static void note_tile(int tx, int ty, void *ctx)
{
    Touched *t = ctx;
    if (!t->count++) *t = (Touched){ 1, tx, tx, ty, ty };
    t->low_x = tx < t->low_x ? tx : t->low_x, t->high_x = tx > t->high_x ? tx : t->high_x;
    t->low_y = ty < t->low_y ? ty : t->low_y, t->high_y = ty > t->high_y ? ty : t->high_y;
}

static void only_tiles_under_the_brush_are_touched(void **state)
{
    (void)state;
    WrField *field = torus(16384, 16384), *before = wr_field_share(field);
    WrBrush brush = brush_of(31.9, 0.5, 1);
    wr_brush_dab(field, &brush, (64 * 10 + 32) / 16384.0, 1 - (64 * 20 + 32) / 16384.0);
    Touched touched = { 0 };
    wr_field_changes(field, before, note_tile, &touched);
    assert_int_equal(touched.count, 1);
    assert_true(touched.low_x == 10 && touched.low_y == 20);
    WrSample samples[] = { at(0.0, 0.5, 1), at(0.01, 0.5, 1) };
    run_stroke(field, &brush, samples, 2);
    assert_true(wr_field_bytes(field) < 20 * 17000);
    assert_int_equal(wr_field_bytes(before), 0);
    wr_field_free(field);
    wr_field_free(before);
}

static void texels_without_coverage_keep_their_bits(void **state)
{
    (void)state;
    WrField *field = flat(64, 64, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, -0.0f);
    WrBrush brush = brush_of(10, 0.5, 1);
    wr_brush_dab(field, &brush, 0.5, 0.5);
    WrSample samples[] = { at(0.5, 0.5, 1), at(0.55, 0.5, 1) };
    run_stroke(field, &brush, samples, 2);
    for (int j = 0; j < 64; j++)
        for (int i = 0; i < 64; i++) {
            float f = wr_field_get(field, i, j);
            assert_true(f > 0.0f || signbit(f));
        }
    wr_field_free(field);
}

static void the_table_is_free_of_seams_where_its_edge_cuts_a_tile(void **state)
{
    (void)state;
    WrField *field = torus(100, 100);
    WrBrush brush = brush_of(30, 0.5, 1);
    wr_brush_dab(field, &brush, 0.99, 0.01);
    for (int tx = 0; tx < 2; tx++)
        for (int ty = 0; ty < 2; ty++)
            for (int k = 0; k < 4096; k++) { /* unused texels hold the level */
                const float *tile = wr_field_tile(field, tx, ty);
                if (tx * 64 + k % 64 >= 100 || ty * 64 + k / 64 >= 100)
                    assert_true(!tile || tile[k] == 0.0f);
            }
    wr_field_free(field);
}

static void every_set_of_kernels_gives_the_same_bits(void **state)
{
    (void)state;
    TestRandom random = { 12 };
    for (int set = 1; set < WR_BRUSH_KERNELS; set++) {
        const WrBrushKernels *plain = wr_brush_kernels_at(0), *k = wr_brush_kernels_at(set);
        if (!k) continue;
        for (int n = 0; n < 3000; n++) {
            WrBrush brush = brush_of(1 + 60 * test_random(&random), test_random(&random), 1);
            WrCapsule c = wr_capsule(&brush, test_random(&random), test_random(&random),
                                     n % 3 * test_random(&random) * 40, test_random(&random) * 9,
                                     test_random(&random), test_random(&random));
            int count = (n % 4 + 1) * WR_BRUSH_BLOCK;
            double y = floor(60 * test_random(&random)) - 30,
                   x = floor(90 * test_random(&random)) - 70;
            float a[3][WR_TILE], b[3][WR_TILE];
            for (int i = 0; i < WR_TILE; i++) a[2][i] = b[2][i] = (float)test_random(&random);
            plain->motion(&c, y, x, count, a[0]), k->motion(&c, y, x, count, b[0]);
            plain->dab(&c, y, x, count, a[1]), k->dab(&c, y, x, count, b[1]);
            assert_int_equal(plain->grows(a[2], a[0], count), k->grows(b[2], b[0], count));
            assert_int_equal(plain->below(a[0], 0.5f, count), k->below(b[0], 0.5f, count));
            plain->add(0.3, a[2], a[0], count, a[2]), k->add(0.3, b[2], b[0], count, b[2]);
            plain->join(a[0], a[1], count), k->join(b[0], b[1], count);
            for (int q = 0; q < 3; q++)
                assert_memory_equal(a[q], b[q], sizeof(float) * (size_t)count);
        }
    }
}

/* A dab's part in one tile against its coverage row by row, added; also where columns beside the part must stay
 * unchanged, far away, and with heights of every size. */
static void a_dab_in_a_tile_is_its_rows_coverage_added(void **state)
{
    (void)state;
    TestRandom random = { 51 };
    const double sizes[] = { 0, 1e-40, 1.0, 1e30, 3e38 };
    for (int set = 0; set < WR_BRUSH_KERNELS; set++) {
        const WrBrushKernels *plain = wr_brush_kernels_at(0), *k = wr_brush_kernels_at(set);
        if (!k) continue;
        for (int n = 0; n < 2000; n++) {
            double radius = n % 5 ? 1 + 60 * test_random(&random) : 1 + 3000 * test_random(&random);
            WrBrush brush = brush_of(radius, n % 7 ? test_random(&random) : n % 2, 1);
            double strength = n % 3 ? test_random(&random) - 0.5 : -1e30;
            if (n % 3 == 1) strength = (double)(float)strength; /* floats are added as such */
            int x = (int)(16384 * test_random(&random)) - 8000,
                y = (int)(200 * test_random(&random));
            const double pressure = n % 4 ? 1 : n % 8 ? 0.3 : 1e-46; /* which is 0 as a float */
            WrCapsule c = wr_capsule(&brush, x + 64 * test_random(&random) + (n % 2 ? radius : 0),
                                     y + 64 * test_random(&random), 0, 0, pressure, pressure);
            static WrDabRows rows;
            WrDabPart part = { .rows = &rows, .y = y, .x = x };
            part.count = 1 + (int)(64 * test_random(&random));
            part.low = n % 2 ? 0 : (int)(64 * test_random(&random));
            part.high = n % 2 ? 63 : part.low + (int)((64 - part.low) * test_random(&random));
            static float a[WR_TILE * WR_TILE], b[WR_TILE * WR_TILE];
            for (int i = 0; i < WR_TILE * WR_TILE; i++)
                a[i] = b[i] = (float)(sizes[n % 5] * (1 - 2 * test_random(&random)));
            for (int i = 2; i < WR_TILE * WR_TILE; i += 7) a[i] = b[i] = -0.0f;
            k->dab_rows(&c, y, part.count, &rows);
            k->dab_tile(&c, &part, strength, a);
            for (int row = 0; row < part.count; row++) {
                float cover[WR_TILE], made[WR_TILE];
                plain->dab(&c, y + row, x, WR_TILE, cover);
                plain->add(strength, b + row * WR_TILE, cover, WR_TILE, made);
                memcpy(b + row * WR_TILE + part.low, made + part.low,
                       (size_t)(part.high - part.low + 1) * sizeof *made);
            }
            assert_memory_equal(a, b, sizeof a);
        }
    }
}

static void coverage_is_1_inside_and_0_outside(void **state)
{
    (void)state;
    WrBrush brush = brush_of(20, 0.5, 1);
    assert_true(wr_brush_inner(&brush) == 10);
    assert_true(wr_brush_coverage(&brush, 0) == 1 && wr_brush_coverage(&brush, 10) == 1);
    assert_true(wr_brush_coverage(&brush, 20) == 0 && wr_brush_coverage(&brush, 1e9) == 0);
    assert_near(wr_brush_coverage(&brush, 15), 0.5, 1e-7);
    brush.hardness = 1;
    assert_true(wr_brush_inner(&brush) == 19);
    brush.radius = 0.3;
    assert_true(wr_brush_coverage(&brush, 0.2) == 1 && wr_brush_coverage(&brush, 0.4) == 0);
}

/* Near tile corners, where a dab's bounding square reaches tiles that the dab itself does not. */
static void a_dab_makes_no_tile_that_it_does_not_change(void **state)
{
    (void)state;
    TestRandom random = { 77 };
    for (int n = 0; n < 3000; n++) {
        WrField *field = torus(256, 200);
        double radius = 1 + 20 * test_random(&random), far = radius * 1.6;
        WrBrush brush = brush_of(radius, test_random(&random), 0.5);
        double x = 128 + far * (test_random(&random) - 0.5),
               y = 64 + far * (test_random(&random) - 0.5);
        wr_brush_dab(field, &brush, x / 256, 1 - y / 200);
        for (int t = 0; t < 16; t++) {
            const float *tile = wr_field_tile(field, t % 4, t / 4);
            bool any = false;
            for (int k = 0; tile && k < WR_TILE * WR_TILE; k++) any |= tile[k] != 0.0f;
            assert_int_equal(tile != NULL, any);
        }
        wr_field_free(field);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dabs_match_the_model_on_any_table),
        cmocka_unit_test(strokes_match_the_model),
        cmocka_unit_test(strokes_wider_than_the_table_match_the_model),
        cmocka_unit_test(the_texel_that_holds_the_centre_changes_by_exactly_strength),
        cmocka_unit_test(hc69_a_dab_on_the_corner_is_the_rolled_dab_in_the_middle),
        cmocka_unit_test(hc70_a_huge_dab_raises_every_texel_once),
        cmocka_unit_test(hc71_no_radius_paints_nothing_and_a_third_of_a_texel_one),
        cmocka_unit_test(hc72_repeated_points_are_one_dab),
        cmocka_unit_test(hc73_a_stroke_across_the_seam_takes_the_short_way),
        cmocka_unit_test(hc74_wild_pressures_are_clamped),
        cmocka_unit_test(samples_in_no_place_are_left_out),
        cmocka_unit_test(a_place_far_off_a_clamped_table_paints_nothing),
        cmocka_unit_test(hc75_one_event_and_a_thousand_draw_the_same_straight_stroke),
        cmocka_unit_test(hc75_slanted_strokes_with_changing_pressure_agree_closely),
        cmocka_unit_test(a_stroke_that_crosses_itself_does_not_double),
        cmocka_unit_test(what_comes_out_depends_on_the_samples_alone),
        cmocka_unit_test(a_stroke_reaches_its_last_sample_however_near),
        cmocka_unit_test(a_thin_stroke_is_a_line_without_gaps),
        cmocka_unit_test(levelling_moves_towards_its_height_and_never_past_it),
        cmocka_unit_test(lower_is_raise_with_the_sign_turned),
        cmocka_unit_test(heights_stop_at_the_ends_of_floats_range),
        cmocka_unit_test(only_tiles_under_the_brush_are_touched),
        cmocka_unit_test(texels_without_coverage_keep_their_bits),
        cmocka_unit_test(the_table_is_free_of_seams_where_its_edge_cuts_a_tile),
        cmocka_unit_test(every_set_of_kernels_gives_the_same_bits),
        cmocka_unit_test(a_dab_in_a_tile_is_its_rows_coverage_added),
        cmocka_unit_test(a_dab_makes_no_tile_that_it_does_not_change),
        cmocka_unit_test(coverage_is_1_inside_and_0_outside),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
