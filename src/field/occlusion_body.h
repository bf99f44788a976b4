/* occlusion_body.h - the text of occlusion_kern.h's loops, included once by each occlusion_v*.c, which defines
   WR_SKY_TABLE and WR_SKY_NAME. A header without a guard, by intention. */
#include "field/occlusion_kern.h"

#include <string.h>
#ifdef __AVX512DQ__
#include <immintrin.h>
#endif

#define LANES WR_SKY_LANES
#define ALWAYS static inline __attribute__((always_inline))

/* Is one of them not 0? A reduction in the loops that make them would not be one of vectors. */
ALWAYS bool any(const int32_t *restrict lane)
{
    uint64_t pair[LANES / 2];
    memcpy(pair, lane, sizeof pair);
    return ((pair[0] | pair[1]) | (pair[2] | pair[3])) |
           ((pair[4] | pair[5]) | (pair[6] | pair[7]));
}

#ifdef __AVX512DQ__
#include "field/occlusion_wide_body.h"
#else
/* What the lanes of row s look at, so far: the row, and how much higher it is. */
typedef struct Sight {
    int32_t at[LANES];
    double rise[LANES];
} Sight;

/* One step along the hulls that are seen from row s; whether any lane went on. sign: 1 where rows ahead have larger
 * numbers, else -1. */
ALWAYS bool step_on(const int32_t *restrict low, const int64_t *restrict seen, int32_t s,
                    int32_t sign, Sight *restrict sight)
{
    int32_t went[LANES];
#pragma omp simd
    for (int l = 0; l < LANES; l++) {
        const int32_t c = sight->at[l];
        const int64_t at = seen[c * LANES + l];
        const int32_t n = (int32_t)(at >> 32), top = (int32_t)at;
        const double farther = (double)(top - low[l]);
        const double here = (double)(sign * (c - s)), there = (double)(sign * (n - s));
        const int go = farther * here > sight->rise[l] * there;
        sight->at[l] = go ? n : c;
        sight->rise[l] = go ? farther : sight->rise[l];
        went[l] = go;
    }
    return any(went);
}

/* The first one, whose row is the same in all lanes; what that row looks at was noted last. */
ALWAYS bool step_first(const int32_t *restrict low, const int32_t *restrict high,
                       const int64_t *restrict seen, int32_t first, int32_t s, int32_t sign,
                       Sight *restrict sight)
{
    const double here = (double)(sign * (first - s));
    int32_t went[LANES];
#pragma omp simd
    for (int l = 0; l < LANES; l++) {
        const int32_t n = (int32_t)(seen[l] >> 32), top = (int32_t)seen[l];
        const double rise = (double)(high[l] - low[l]), farther = (double)(top - low[l]);
        const int go = farther * here > rise * (double)(sign * (n - s));
        sight->at[l] = go ? n : first;
        sight->rise[l] = go ? farther : rise;
        went[l] = go;
    }
    return any(went);
}

ALWAYS void note(const int32_t *restrict low, const Sight *restrict sight, int64_t *restrict seen)
{
#pragma omp simd
    for (int l = 0; l < LANES; l++) {
        seen[l] = (int64_t)sight->at[l] << 32 | (uint32_t)(low[l] + (int32_t)sight->rise[l]);
    }
}

ALWAYS void put_slopes(const Sight *restrict sight, int32_t s, int32_t sign, double scale,
                       float *restrict slope)
{
#pragma omp simd
    for (int l = 0; l < LANES; l++) {
        const int32_t away = sign * (sight->at[l] - s);
        const double best = scale * (sight->rise[l] / (double)(away ? away : 1));
        slope[l] = (float)(best > 0 ? best : 0);
    }
}

static void sweep(const WrSkySweep *given, double scale, float *restrict slope)
{
    const WrSkySweep w = *given;
    const int32_t sign = w.rows[0] > w.rows[w.count - 1] ? 1 : -1;
    for (int i = 0; i < w.count; i++) {
        const int32_t s = w.rows[i], first = i > 0 ? w.rows[i - 1] : s;
        const int32_t *low = w.h + s * LANES, *high = w.h + first * LANES;
        Sight sight;
        if (i == 0)
            for (int l = 0; l < LANES; l++) sight.at[l] = s, sight.rise[l] = 0;
        else if (step_first(low, high, w.seen + first * LANES, first, s, sign, &sight))
            while (step_on(low, w.seen, s, sign, &sight)) {
            }
        note(low, &sight, w.seen + s * LANES);
        if (i >= w.from) put_slopes(&sight, s, sign, scale, slope + s * LANES);
    }
}

#endif

static bool higher(const int32_t *restrict row, int32_t *restrict highest)
{
    int32_t went[LANES];
#pragma omp simd
    for (int l = 0; l < LANES; l++) {
        went[l] = row[l] > highest[l];
        highest[l] = row[l] > highest[l] ? row[l] : highest[l];
    }
    return any(went);
}

/* The angle whose cotangent is x >= 0: the arc tangent of 0..1 by the first terms of its series in Chebyshev's polynomials,
 * right to 4e-8. */
ALWAYS float acot(float x)
{
    const int steep = x > 1.0f;
    const float t = steep ? 1.0f / x : x, y = t * t;
    float sum = -0.00396025723f;
    sum = sum * y + 0.0215092542f;
    sum = sum * y - 0.0553816979f;
    sum = sum * y + 0.096016564f;
    sum = sum * y - 0.138920412f;
    sum = sum * y + 0.199430812f;
    sum = sum * y - 0.33329538f;
    sum = sum * y + 0.999999249f;
    sum *= t;
    return steep ? sum : 1.57079637f - sum;
}

/* 1 - (1/(1 + H^2) - s (acot H - H/(1 + H^2))), H = max(horizon, s): what the formula of wr_horizon_sky makes of one
 * direction in which the plane rises by s, over n_z; without what cancels over all directions. */
ALWAYS float taken(float level, float horizon, float s)
{
    float h = horizon > level ? horizon : level;
    h = 2 * (h - level) < horizon ? 2 * (h - level) : horizon;
    h = h > s ? h : s;
    const float c = 1.0f / (1.0f + h * h);
    return h * h * c + s * (acot(h) - h * c);
}

/* Of `count` texels side by side. */
ALWAYS void share_run(const WrSkyShare k, const WrSkyRun *run, int count, float *restrict loss)
{
    const float *restrict ahead = run->ahead, *restrict behind = run->behind;
    const float *restrict p = run->p, *restrict q = run->q;
#pragma omp simd
    for (int i = 0; i < count; i++) {
        const float s = p[i] * k.ux + q[i] * k.uy;
        loss[i] = k.weight * (taken(k.level, ahead[i], s) + taken(k.level, behind[i], -s));
    }
}

ALWAYS void add_run(const float *restrict loss, int count, float *restrict out)
{
#pragma omp simd
    for (int i = 0; i < count; i++) out[i] += loss[i];
}

/* All is read before anything is written: rows of large tables lie a multiple of 4096 bytes apart, where a load waits
 * for every store before it. */
static void share(const WrSkyShare *given, const WrSkyRun *runs, int count)
{
    float loss[WR_SKY_STRIP];
    const WrSkyShare k = *given;
    for (int r = 0, at = 0; r < count; at += runs[r++].count) {
        if (runs[r].count == LANES) share_run(k, &runs[r], LANES, loss + at);
        else share_run(k, &runs[r], runs[r].count, loss + at);
    }
    for (int r = 0, at = 0; r < count; at += runs[r++].count) {
        if (runs[r].count == LANES) add_run(loss + at, LANES, runs[r].loss);
        else add_run(loss + at, runs[r].count, runs[r].loss);
    }
}

static void look(const float *restrict c, const float *a, const float *b, float part, float inverse,
                 int count, float *restrict best)
{
    if (part == 0.0f) {
#pragma omp simd
        for (int i = 0; i < count; i++) {
            const float slope = (a[i] - c[i]) * inverse;
            best[i] = slope > best[i] ? slope : best[i];
        }
        return;
    }
#pragma omp simd
    for (int i = 0; i < count; i++) {
        const float slope = (a[i] + part * (b[i] - a[i]) - c[i]) * inverse;
        best[i] = slope > best[i] ? slope : best[i];
    }
}

const WrSkyKernels WR_SKY_TABLE = {
    .name = WR_SKY_NAME,
    .sweep = sweep,
    .higher = higher,
    .share = share,
    .look = look,
};
