/* Hard cases of dabs and strokes. Heights are floats; their changes are computed in double. */
#include "hardcases/hardcases_internal.h"

#include "base/error.h"
#include "brush/brush.h"
#include "field/field.h"
#include "field/ops.h"

#include <float.h>

static WrBrush brush_of(double radius, double hardness, double strength)
{
    WrBrush brush = wr_brush_default();
    brush.radius = radius;
    brush.hardness = hardness;
    brush.strength = strength;
    return brush;
}

static WrField *torus(int w, int h)
{
    return wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, NULL);
}

static void draw(WrField *field, const WrBrush *brush, const WrSample *samples, int count)
{
    WrStroke *stroke = wr_stroke_new(field, brush);
    for (int k = 0; k < count; k++) wr_stroke_add(stroke, samples[k]);
    wr_stroke_free(stroke);
}

static WrSample at(double u, double v, double pressure)
{
    return (WrSample){ .u = u, .v = v, .pressure = pressure };
}

/* Compares two tables: largest difference of heights. */
static void compare(WrHardGauge *g, const WrField *a, const WrField *b)
{
    for (int j = 0; j < wr_field_height(a); j++)
        for (int i = 0; i < wr_field_width(a); i++)
            wr_hard_near(g, WR_HARD_FLOAT, (double)wr_field_get(a, i, j),
                         (double)wr_field_get(b, i, j));
}

static bool hc69(WrHardGauge *g, WrError *err)
{
    (void)err;
    static const double radii[] = { 0.3, 1.5, 10, 31.9, 32, 50 };
    for (int r = 0; r < 6; r++) {
        WrField *corner = torus(64, 64), *middle = torus(64, 64);
        const WrBrush brush = brush_of(radii[r], 0.3, 0.7);
        wr_brush_dab(corner, &brush, 0, 0);
        wr_brush_dab(middle, &brush, 0.5, 0.5);
        WrField *rolled = wr_hard_rolled(middle, 32, 32);
        compare(g, corner, rolled);
        wr_field_free(corner);
        wr_field_free(middle);
        wr_field_free(rolled);
    }
    return true;
}

static bool hc70(WrHardGauge *g, WrError *err)
{
    (void)err;
    static const double radii[] = { 200, 1e6, 1e9, INFINITY };
    for (int r = 0; r < 4; r++) {
        WrField *field = torus(90, 64);
        const WrBrush brush = brush_of(radii[r], 1, 0.25);
        wr_brush_dab(field, &brush, 10.5 / 90, 1 - 5.5 / 64);
        for (int k = 0; k < 90 * 64; k++)
            wr_hard_near(g, WR_HARD_FLOAT, (double)wr_field_get(field, k % 90, k / 90), 0.25);
        wr_field_free(field);
    }
    return true;
}

static bool hc71(WrHardGauge *g, WrError *err)
{
    (void)err;
    static const double none[] = { 0, -1, NAN, -INFINITY };
    for (int k = 0; k < 4; k++) {
        WrField *field = wr_hard_rough(g, 50, 40, WR_WRAP_PERIODIC), *was = wr_field_share(field);
        const WrBrush brush = brush_of(none[k], 0.5, 1);
        wr_brush_dab(field, &brush, 0.4, 0.4);
        const WrSample path[] = { at(0.1, 0.1, 1), at(0.5, 0.6, 1) };
        draw(field, &brush, path, 2);
        wr_hard_holds(g, WR_HARD_FLOAT, wr_hard_equal(field, was));
        wr_field_free(field);
        wr_field_free(was);
    }
    for (int k = 0; k < 4; k++) { /* strength 0, and above the maximum; and the limits of float */
        static const double strengths[] = { 0, NAN, INFINITY, -INFINITY };
        WrField *field = wr_hard_rough(g, 50, 40, WR_WRAP_PERIODIC), *was = wr_field_share(field);
        const WrBrush brush = brush_of(3, 1, strengths[k]);
        wr_brush_dab(field, &brush, 0.5, 0.5);
        const double got = (double)wr_field_get(field, 25, 20);
        const double end = k == 2 ? (double)FLT_MAX : -(double)FLT_MAX;
        wr_hard_holds(g, WR_HARD_FLOAT, k < 2 ? wr_hard_equal(field, was) : got == end);
        wr_field_free(field);
        wr_field_free(was);
    }
    WrField *field = torus(50, 40);
    const WrBrush brush = brush_of(0.3, 0.5, 1);
    wr_brush_dab(field, &brush, 0.999, 0.001);
    for (int k = 0; k < 50 * 40; k++)
        wr_hard_holds(g, WR_HARD_FLOAT,
                      wr_field_get(field, k % 50, k / 50) == (k == 50 * 40 - 1 ? 1.0f : 0.0f));
    wr_field_free(field);
    return true;
}

static bool hc72(WrHardGauge *g, WrError *err)
{
    (void)err;
    static const double radii[] = { 0.4, 3, 30 };
    for (int r = 0; r < 3; r++) {
        WrField *dab = wr_hard_rough(g, 80, 80, WR_WRAP_PERIODIC), *stroke = wr_field_share(dab);
        const WrBrush brush = brush_of(radii[r], 0.2, 0.5);
        WrSample path[100];
        for (int k = 0; k < 100; k++) path[k] = at(0.31, 0.77, 1);
        wr_brush_dab(dab, &brush, 0.31, 0.77);
        draw(stroke, &brush, path, 100);
        compare(g, dab, stroke);
        wr_field_free(dab);
        wr_field_free(stroke);
    }
    return true;
}

static bool hc73(WrHardGauge *g, WrError *err)
{
    (void)err;
    const WrSample across[] = { at(0.9375, 0.875, 1), at(0.0625, 0.125, 1), at(0.25, 0.0, 1) };
    const WrSample inside[] = { at(0.4375, 0.375, 1), at(0.5625, 0.625, 1), at(0.75, 0.5, 1) };
    for (int thin = 0; thin < 2; thin++) {
        WrField *seam = torus(128, 64), *middle = torus(128, 64);
        const WrBrush brush = brush_of(thin ? 0.5 : 4.5, 0.4, 1);
        draw(seam, &brush, across, 3);
        draw(middle, &brush, inside, 3);
        WrField *rolled = wr_hard_rolled(middle, 64, 32);
        compare(g, seam, rolled);
        wr_field_free(seam);
        wr_field_free(middle);
        wr_field_free(rolled);
    }
    return true;
}

static bool hc74(WrHardGauge *g, WrError *err)
{
    (void)err;
    static const double pressures[][2] = { { NAN, 0 },      { -3, 0 }, { -INFINITY, 0 },
                                           { INFINITY, 1 }, { 7, 1 },  { 0.5, 0.5 } };
    for (int k = 0; k < 12; k++) { /* with both samples, and with the second alone */
        WrField *wild = wr_hard_rough(g, 64, 64, WR_WRAP_PERIODIC), *tame = wr_field_share(wild);
        const WrBrush brush = brush_of(9, 0.5, 1);
        WrSample a[] = { at(0.5, 0.5, k < 6 ? pressures[k][0] : 0.7),
                         at(0.6, 0.6, pressures[k % 6][0]) };
        WrSample b[] = { at(0.5, 0.5, k < 6 ? pressures[k][1] : 0.7),
                         at(0.6, 0.6, pressures[k % 6][1]) };
        a[0].tilt_x = a[1].tilt_y = k % 2 ? 90 : NAN;
        draw(wild, &brush, a, 2);
        draw(tame, &brush, b, 2);
        compare(g, wild, tame);
        wr_field_free(wild);
        wr_field_free(tame);
    }
    return true;
}

static bool hc75(WrHardGauge *g, WrError *err)
{
    (void)err;
    static const double radii[] = { 0.9, 6, 40 };
    static WrSample many[1001];
    for (int r = 0; r < 6; r++) {
        WrField *a = torus(256, 128), *b = torus(256, 128);
        const WrBrush brush = brush_of(radii[r / 2], 0.3, 0.8);
        for (int k = 0; k <= 1000; k++)
            many[k] = at(0.125 + 0.375 * k / 1000, r % 2 ? 0.2 + 0.3 * k / 1000 : 0.45, 0.75);
        const WrSample two[] = { many[0], many[1000] };
        draw(a, &brush, many, 1001);
        draw(b, &brush, two, 2);
        compare(g, a, b);
        wr_field_free(a);
        wr_field_free(b);
    }
    return true;
}

/* A million dabs of 2^-10 are exactly 976.5625; dabs of FLT_MAX / 10 stop at FLT_MAX. Relative deviation. */
static bool hc76(WrHardGauge *g, WrError *err)
{
    (void)err;
    static const double strengths[] = { 0x1p-10, (double)FLT_MAX / 10 };
    for (int s = 0; s < 2; s++) {
        WrField *field = torus(8, 8);
        const WrBrush brush = brush_of(0.5, 1, strengths[s]);
        for (int k = 0; k < 1000000; k++) wr_brush_dab(field, &brush, 0.3, 0.3);
        const double got = (double)wr_field_get(field, 2, 5);
        wr_hard_near(g, WR_HARD_FLOAT, got / (s ? (double)FLT_MAX : 1e6 * 0x1p-10), 1.0);
        wr_field_free(field);
    }
    return true;
}

static double mean_of(const WrField *field)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    double sum = 0.0;
    for (int k = 0; k < w * h; k++) sum += (double)wr_field_get(field, k % w, k / w);
    return sum / (w * h);
}

/* Change of the mean by one pass, and the excess over the previous range. */
static void check_pass(WrHardGauge *g, const WrField *was, const WrField *is)
{
    float low, high, low_now, high_now;
    wr_field_range(was, &low, &high);
    wr_field_range(is, &low_now, &high_now);
    wr_hard_near(g, WR_HARD_FLOAT, mean_of(is), mean_of(was));
    wr_hard_off(g, WR_HARD_FLOAT, fmax(0.0, (double)high_now - (double)high));
    wr_hard_off(g, WR_HARD_FLOAT, fmax(0.0, (double)low - (double)low_now));
}

static bool hc77(WrHardGauge *g, WrError *err)
{
    WrField *field = wr_hard_rough(g, 90, 70, WR_WRAP_PERIODIC);
    const WrOpInfo *blur = wr_op_find("blur");
    WrBrush brush = brush_of(20, 0.5, 1);
    bool good = true;
    for (int k = 0; k < 90 * 70; k++) /* a mean that is not 0 */
        wr_field_set(field, k % 90, k / 90, 0.7f + wr_field_get(field, k % 90, k / 90));
    brush.mode = WR_BRUSH_SMOOTH;
    for (int pass = 0; pass < 24 && good; pass++) {
        const double sigma = 0.5 + 0.25 * pass;
        WrField *next =
            pass % 2 ? wr_op_run(blur, field, &sigma, NULL, err) : wr_field_share(field);
        good = next != NULL;
        if (!good) break;
        if (pass % 2 == 0) {
            const WrSample path[] = { at(0.1, 0.9, 1), at(0.4, 0.5, 1), at(1.1, 0.6, 0.5) };
            draw(next, &brush, path, 3);
        }
        check_pass(g, field, next);
        wr_field_free(field);
        field = next;
    }
    wr_field_free(field);
    return good;
}

#define ROW(number, situation, rule, u, in_float, script)                                          \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_PAINT, .what = situation, .holds = rule, .unit = u, \
        .bound = { in_float, NAN }, .measure = hc##number, .scene = script                         \
    }
static const WrHardCase dabs[] = {
    ROW(69, "a dab on the table's corner", "the dab in the middle, rolled by half, to the bit",
        "height", 0, "table 64x64\ndab 0,0 radius=14 strength=1\nsurface torus\nbump height=0.3"),
    ROW(70, "a dab larger than the table, up to infinitely large", "each texel is touched once",
        "height", 0, "table 64x64\ndab 0.5,0.5 radius=1e6 strength=1\nsurface plane"),
    ROW(71, "radii of 0, below 0, NaN, and a third of a texel; strengths of 0, NaN and infinity",
        "nothing; the third of a texel one texel, the infinite strength float's end", "violations",
        0, "table 50x40\ndab 0.999,0.001 radius=0.3 strength=1\nsurface plane"),
};
WR_HARD_LIST(dab, dabs);

static const WrHardCase strokes[] = {
    ROW(72, "a stroke that stays in one place", "one dab, to the bit", "height", 0,
        "table 80x80\nstroke radius=12 strength=1 points=0.3,0.7;0.3,0.7;0.3,0.7\nsurface plane"),
    ROW(73, "a stroke across the seam", "it goes the short way: the rolled stroke, to the bit",
        "height", 0,
        "table 128x64\nstroke radius=6 strength=1 points=0.9,0.9;1.1,0.1\nsurface torus\nbump "
        "height=0.3"),
    ROW(74, "a pen's pressure that is NaN, infinite, below 0 or above 1; wild tilts",
        "clamped: the stroke of that pressure, to the bit", "height", 0, NULL),
    ROW(75, "the same stroke in one event and in a thousand", "the same heights", "height", 1e-6,
        "table 256x128\nstroke radius=8 strength=1 points=0.1,0.2;0.9,0.8\nsurface plane"),
    ROW(76, "a million dabs in one place", "their exact sum, or the largest float", "relative", 0,
        NULL),
    ROW(77, "smoothing again and again", "the mean stays and no new extremes appear", "height",
        1e-6, "table 90x70\nnoise perlin cells=12\nadjust blur sigma=3\nsurface plane"),
};
WR_HARD_LIST(stroke, strokes);
