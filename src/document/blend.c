/* Branch-free span loops: each choice is a ?: of scalars, which compilers turn into masks. */
#include "document/blend.h"
#include "base/enum_rows.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* 256 texels of weights and heights stay in the first-level cache. */
enum { SPAN = 256 };

static inline float bounded(float x)
{
    x = x > FLT_MAX ? FLT_MAX : x;
    return x < -FLT_MAX ? -FLT_MAX : x;
}

static inline float unit(float x)
{
    x = x > 0.0f ? x : 0.0f; /* NaN becomes 0 */
    return x < 1.0f ? x : 1.0f;
}

/* Interpolates from b to `full`, the finite result at weight 1. b + 1 (full - b) is not always `full`, and the
   rounded sum can exceed it, hence the choices; if both are equal, the sign of b's zero is kept. */
static inline float toward(float b, float full, float w)
{
    float r = b + w * (full - b);
    float low = b < full ? b : full, high = b < full ? full : b;
    r = r < low ? low : r;
    r = r > high ? high : r;
    r = full == b ? b : r;
    r = w >= 1.0f ? full : r;
    return w > 0.0f ? r : b; /* last, since 0 times infinity is NaN */
}

/* Excess of a smooth maximum over the plain one: s s k/4, a parabola that meets max(b,h) with equal slope at |b
   - h| = k and is k/4 above it where b = h. */
static inline float bulge(float b, float h, float k)
{
    float near = k - fabsf(b - h);
    near = near > 0.0f ? near : 0.0f;
    float s = near / (k > 0.0f ? k : 1.0f);
    return s * s * k * 0.25f;
}

static void span_add(size_t count, const float *h, const float *w, float radius, float *b)
{
    (void)radius;
#pragma omp simd
    for (size_t i = 0; i < count; i++) {
        float t = w[i] * h[i], r = bounded(b[i] + t);
        b[i] = t == 0.0f ? b[i] : r; /* -0 stays -0 */
    }
}

static void span_subtract(size_t count, const float *h, const float *w, float radius, float *b)
{
    (void)radius;
#pragma omp simd
    for (size_t i = 0; i < count; i++) {
        float t = w[i] * h[i], r = bounded(b[i] - t);
        b[i] = t == 0.0f ? b[i] : r;
    }
}

static void span_max(size_t count, const float *h, const float *w, float radius, float *b)
{
    (void)radius;
#pragma omp simd
    for (size_t i = 0; i < count; i++) b[i] = toward(b[i], h[i] > b[i] ? h[i] : b[i], w[i]);
}

static void span_min(size_t count, const float *h, const float *w, float radius, float *b)
{
    (void)radius;
#pragma omp simd
    for (size_t i = 0; i < count; i++) b[i] = toward(b[i], h[i] < b[i] ? h[i] : b[i], w[i]);
}

static void span_smooth_max(size_t count, const float *h, const float *w, float radius, float *b)
{
#pragma omp simd
    for (size_t i = 0; i < count; i++) {
        float larger = h[i] > b[i] ? h[i] : b[i];
        float lift = bulge(b[i], h[i], radius);
        float full = lift > 0.0f ? bounded(larger + lift) : larger;
        b[i] = toward(b[i], full, w[i]);
    }
}

static void span_smooth_min(size_t count, const float *h, const float *w, float radius, float *b)
{
#pragma omp simd
    for (size_t i = 0; i < count; i++) {
        float smaller = h[i] < b[i] ? h[i] : b[i];
        float lift = bulge(b[i], h[i], radius);
        float full = lift > 0.0f ? bounded(smaller - lift) : smaller;
        b[i] = toward(b[i], full, w[i]);
    }
}

static void span_replace(size_t count, const float *h, const float *w, float radius, float *b)
{
    (void)radius;
#pragma omp simd
    for (size_t i = 0; i < count; i++) b[i] = toward(b[i], h[i], w[i]);
}

static void span_multiply(size_t count, const float *h, const float *w, float radius, float *b)
{
    (void)radius;
#pragma omp simd
    for (size_t i = 0; i < count; i++) b[i] = toward(b[i], bounded(b[i] * h[i]), w[i]);
}

WR_ROWS(wr_blends);
const WrBlendMode wr_blends[WR_BLEND_COUNT] = {
    [WR_ROW(WR_BLEND_ADD)] = { .name = "add",
                               .label = "Add",
                               .help = "raise the layers below by this layer's heights",
                               .neutral = 0.0f,
                               .span = span_add },
    [WR_ROW(WR_BLEND_SUBTRACT)] = { .name = "subtract",
                                    .label = "Subtract",
                                    .help = "lower the layers below by this layer's heights",
                                    .neutral = 0.0f,
                                    .span = span_subtract },
    [WR_ROW(WR_BLEND_MAX)] = { .name = "max",
                               .label = "Maximum",
                               .help = "the higher of the two, where this layer is painted",
                               .uses_cover = true,
                               .neutral = -FLT_MAX,
                               .span = span_max },
    [WR_ROW(WR_BLEND_MIN)] = { .name = "min",
                               .label = "Minimum",
                               .help = "the lower of the two, where this layer is painted",
                               .uses_cover = true,
                               .neutral = FLT_MAX,
                               .span = span_min },
    [WR_ROW(WR_BLEND_SMOOTH_MAX)] = { .name = "smooth-max",
                                      .label = "Smooth maximum",
                                      .help = "the higher of the two, with the crease between them "
                                              "rounded",
                                      .uses_radius = true,
                                      .uses_cover = true,
                                      .neutral = NAN,
                                      .span = span_smooth_max },
    [WR_ROW(WR_BLEND_SMOOTH_MIN)] = { .name = "smooth-min",
                                      .label = "Smooth minimum",
                                      .help = "the lower of the two, with the crease between them "
                                              "rounded",
                                      .uses_radius = true,
                                      .uses_cover = true,
                                      .neutral = NAN,
                                      .span = span_smooth_min },
    [WR_ROW(
        WR_BLEND_REPLACE)] = { .name = "replace",
                               .label = "Replace",
                               .help =
                                   "this layer's heights replace those below, where it is painted",
                               .uses_cover = true,
                               .takes = true,
                               .neutral = NAN,
                               .span = span_replace },
    [WR_ROW(WR_BLEND_MIX)] = { .name = "mix",
                               .label = "Mix",
                               .help = "a mix of the two by the opacity, painted or not",
                               .takes = true,
                               .neutral = NAN,
                               .span = span_replace },
    [WR_ROW(WR_BLEND_MULTIPLY)] = { .name = "multiply",
                                    .label = "Multiply",
                                    .help = "scale the layers below by this layer's heights",
                                    .uses_cover = true,
                                    .neutral = 1.0f,
                                    .span = span_multiply },
};
WR_ROWS_END(wr_blends, WR_BLEND_COUNT);

const WrBlend wr_ramp_blends[] = { WR_BLEND_REPLACE, WR_BLEND_ADD, WR_BLEND_MAX, WR_BLEND_MIN };
_Static_assert(WR_LENGTH(wr_ramp_blends) == WR_RAMP_BLENDS, "blend.h counts them");

int wr_blend_find(const char *name)
{
    for (int i = 0; i < WR_BLEND_COUNT; i++)
        if (strcmp(wr_blends[i].name, name) == 0) return i;
    return -1;
}

static void fill(size_t count, float value, float *out)
{
    for (size_t i = 0; i < count; i++) out[i] = value;
}

/* Multiplies w by the values, or by their level. */
static void weigh(size_t count, const float *values, float level, float *w)
{
    float all = unit(level);
    if (!values) {
        for (size_t i = 0; i < count; i++) w[i] *= all;
        return;
    }
#pragma omp simd
    for (size_t i = 0; i < count; i++) w[i] *= unit(values[i]);
}

void wr_blend_tile(WrBlend mode, float opacity, float radius, const WrBlendTile *tile, size_t count,
                   float *below)
{
    const WrBlendMode *blend = &wr_blends[mode];
    float o = unit(opacity), k = radius > 0.0f ? bounded(radius) : 0.0f;
    if (!(o > 0.0f)) return;
    float w[SPAN], level[SPAN];
    if (!tile->heights) fill(SPAN, tile->level, level);
    for (size_t at = 0; at < count; at += SPAN) {
        size_t n = count - at < SPAN ? count - at : SPAN;
        fill(n, o, w);
        weigh(n, tile->mask ? tile->mask + at : NULL, tile->mask_level, w);
        if (blend->uses_cover)
            weigh(n, tile->cover ? tile->cover + at : NULL, tile->cover_level, w);
        blend->span(n, tile->heights ? tile->heights + at : level, w, k, below + at);
    }
}

/* One span onto heights of partial coverage, by weights w (blend.h). */
static void span_partial(const WrBlendMode *blend, size_t count, const float *h, const float *w,
                         float radius, float *b, float *cover)
{
    float full[SPAN], one[SPAN];
    memcpy(full, b, count * sizeof *b);
    fill(count, 1.0f, one);
    blend->span(count, h, one, radius, full);
#pragma omp simd
    for (size_t i = 0; i < count; i++) {
        float a = cover[i], all = toward(a, 1.0f, w[i]);
        float t = (1.0f - a) * h[i] + a * full[i];
        t = a > 0.0f ? t : h[i];
        t = a >= 1.0f || full[i] == h[i] ? full[i] : t;
        b[i] = toward(b[i], t, w[i] > 0.0f ? w[i] / all : 0.0f);
        cover[i] = all;
    }
}

static void span_cover(size_t count, const float *w, float *cover)
{
#pragma omp simd
    for (size_t i = 0; i < count; i++) cover[i] = toward(cover[i], 1.0f, w[i]);
}

void wr_blend_tile_partial(WrBlend mode, bool on_ground, float opacity, float radius,
                           const WrBlendTile *tile, size_t count, float *below, float *cover)
{
    const bool adds = mode == WR_BLEND_ADD || mode == WR_BLEND_SUBTRACT;
    float o = unit(opacity), k = radius > 0.0f ? bounded(radius) : 0.0f;
    if (!(o > 0.0f)) return;
    if (adds)
        wr_blend_tile(on_ground && mode == WR_BLEND_ADD ? WR_BLEND_MIX : mode, opacity, radius,
                      tile, count, below);
    float w[SPAN], level[SPAN];
    if (!tile->heights) fill(SPAN, tile->level, level);
    for (size_t at = 0; at < count; at += SPAN) {
        size_t n = count - at < SPAN ? count - at : SPAN;
        fill(n, o, w);
        weigh(n, tile->mask ? tile->mask + at : NULL, tile->mask_level, w);
        if (mode != WR_BLEND_MIX)
            weigh(n, tile->cover ? tile->cover + at : NULL, tile->cover_level, w);
        if (adds) span_cover(n, w, cover + at);
        else
            span_partial(&wr_blends[mode], n, tile->heights ? tile->heights + at : level, w, k,
                         below + at, cover + at);
    }
}
