/* brush_help.h - shared helpers of the brush tests: tables, samples, strokes, comparisons. */
#pragma once
#include "base/hash.h"
#include "field/field.h"
#include "field/wrap.h"
#include "test.h"

#include "base/pool.h"
#include "brush/brush.h"
#include "brush/mode.h"
#include "brush/tip.h"

static inline WrField *torus(int width, int height)
{
    return wr_field_new(width, height, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, NULL);
}

/* Heights between -1/2 and 1/2, smooth over a few texels and a little noisy; periodic. */
static inline WrField *rough(int width, int height, WrWrap wrap)
{
    WrField *field = wr_field_new(width, height, wrap, wrap, 0.0f, NULL);
    TestRandom random = { 77 };
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++) {
            double a = 6.283185307179586 * i / width, b = 6.283185307179586 * j / height;
            double f = 0.2 * sin(3 * a + b) + 0.15 * cos(2 * b - a) + 0.1 * sin(7 * a) * cos(9 * b);
            wr_field_set(field, i, j, (float)(f + 0.1 * (test_random(&random) - 0.5)));
        }
    return field;
}

/* A table whose texel (i, j) is texel (i - di, j - dj) of this one. */
static inline WrField *rolled(const WrField *field, int di, int dj)
{
    int w = wr_field_width(field), h = wr_field_height(field);
    WrField *out = torus(w, h);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++)
            wr_field_set(out, ((i + di) % w + w) % w, ((j + dj) % h + h) % h,
                         wr_field_get(field, i, j));
    return out;
}

static inline bool same_heights(const WrField *a, const WrField *b)
{
    return wr_hash_equal(wr_field_hash(a), wr_field_hash(b));
}

static inline double largest_difference(const WrField *a, const WrField *b)
{
    double most = 0;
    for (int j = 0; j < wr_field_height(a); j++)
        for (int i = 0; i < wr_field_width(a); i++)
            most = fmax(most, fabs((double)wr_field_get(a, i, j) - wr_field_get(b, i, j)));
    return most;
}

static inline WrSample at(double u, double v, double pressure)
{
    return (WrSample){ .u = u, .v = v, .pressure = pressure };
}

static inline WrBrush brush_of(WrBrushMode mode, double radius)
{
    WrBrush brush = wr_brush_default();
    brush.mode = mode;
    brush.radius = radius;
    brush.strength = 0.25;
    brush.to = 0.125;
    brush.reach = 2;
    brush.source_u = 0.25;
    brush.source_v = 0.125;
    return brush;
}

static inline void run_on(const WrBrushGround *ground, const WrBrush *brush,
                          const WrSample *samples, int count)
{
    WrStroke *stroke = wr_stroke_new_on(ground, brush);
    for (int k = 0; k < count; k++) wr_stroke_add(stroke, samples[k]);
    wr_stroke_finish(stroke);
}

static inline void run_stroke(WrField *field, const WrBrush *brush, const WrSample *samples,
                              int count)
{
    WrBrushGround ground = { .field = field };
    run_on(&ground, brush, samples, count);
}

/* An asymmetric arrow, so that rotations and mirror images are detectable. */
static inline WrTip *arrow_tip(void)
{
    float values[24 * 12];
    for (int y = 0; y < 12; y++)
        for (int x = 0; x < 24; x++)
            values[y * 24 + x] = y < 3 + x / 3 && y > 1 ? 0.3f + 0.03f * (float)x : 0.0f;
    return wr_tip_new(24, 12, values, 0, NULL);
}

/* Variants of drawing with a brush of one mode. */
enum { WAY_PLAIN, WAY_FLOW, WAY_BUILDUP, WAY_ELLIPSE, WAY_TIP, WAY_JITTER, WAY_COUNT };

static inline WrBrush brush_by(int way, WrBrush brush, const WrTip *tip)
{
    if (way == WAY_FLOW) brush.flow = 0.3;
    if (way == WAY_BUILDUP) {
        brush.buildup = true;
        brush.flow = 0.05;
    }
    if (way == WAY_ELLIPSE) {
        brush.aspect = 3;
        brush.angle_deg = 30;
        brush.follow = true;
        brush.pressure = WR_PRESSURE_BOTH;
    }
    if (way == WAY_TIP) brush.tip = tip;
    if (way == WAY_JITTER) {
        brush.jitter_place = 0.5;
        brush.jitter_size = 0.4;
        brush.jitter_angle_deg = 90;
        brush.aspect = 2;
        brush.seed = 5;
    }
    return brush;
}
