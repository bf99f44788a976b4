/* filter_kernels_body.h - implementation of the loops of filter_kernels.h, compiled once for each
   instruction set (wr_kern of CMakeLists.txt). Intentionally without an include guard. */
#include "field/filter_kernels.h"

#include <float.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#ifdef __FMA__
#include <immintrin.h>
#endif

/* Named vector variables: several sums must stay in registers while all taps are added, which no
 * compiler does with an array. This makes the loop fast. */
#ifdef __AVX512F__
typedef float Vec __attribute__((vector_size(64)));
#elif defined __AVX__
typedef float Vec __attribute__((vector_size(32)));
#else
typedef float Vec __attribute__((vector_size(16)));
#endif
#define LANES ((int)(sizeof(Vec) / sizeof(float)))
#define ALWAYS static inline __attribute__((always_inline))

ALWAYS Vec load(const float *from)
{
    Vec v;
    memcpy(&v, from, sizeof v);
    return v;
}

ALWAYS void store(float *to, Vec v)
{
    memcpy(to, &v, sizeof v);
}

/* a - b, bit for bit: 1 a is a. One of a tap's three additions is written as a multiply-add, because
 * many processors have no more units for sums than for products. */
ALWAYS Vec minus(Vec a, Vec unit, Vec b)
{
#ifdef __AVX512F__
    return (Vec)_mm512_fmsub_ps((__m512)a, (__m512)unit, (__m512)b);
#elif defined __FMA__
    return (Vec)_mm256_fmsub_ps((__m256)a, (__m256)unit, (__m256)b);
#else
    (void)unit;
    return a - b;
#endif
}

/* A vector of 1 that the compiler cannot fold. */
ALWAYS Vec one_of(const float *weight)
{
    Vec one = (weight[0] - weight[0]) - (Vec){ 0.0f };
    return one + 1.0f;
}

ALWAYS void put(Vec sum, const float *from, bool adds, float *out)
{
    store(out, adds ? load(from) + sum : sum);
}

/* One vector of one element. A symmetric filter in difference form, out = c + sum over k of w[k] (c[-k] + c[k] - 2 c): a flat
   run changes by exactly 0, however the weights are rounded, and small heights on a large offset keep their digits
   (NUMERICS.md HC47, HC48). */
ALWAYS void one(const float *weight, int reach, const float *c, ptrdiff_t step, bool adds,
                float *out)
{
    Vec sum = { 0.0f }, twice = load(c) + load(c);
    for (int k = 1; k <= reach; k++)
        sum += weight[k] * ((load(c - k * step) + load(c + k * step)) - twice);
    put(sum, c, adds, out);
}

/* Four consecutive elements. With each tap their neighbours on either side, b and a, shift by one, so
 * that only one load is new. */
ALWAYS void four(const float *weight, int reach, const float *c, ptrdiff_t step, bool adds,
                 float *out, ptrdiff_t to)
{
    const float *below = c, *above = c + 3 * step;
    Vec s0 = { 0.0f }, s1 = s0, s2 = s0, s3 = s0, unit = one_of(weight);
    Vec b0 = load(c), b1 = load(c + step), b2 = load(c + 2 * step), b3 = load(above);
    Vec a0 = b0, a1 = b1, a2 = b2, a3 = b3;
    Vec t0 = b0 + b0, t1 = b1 + b1, t2 = b2 + b2, t3 = b3 + b3;
    for (int k = 1; k <= reach; k++) {
        Vec w = weight[k] - (Vec){ 0.0f };
        below -= step;
        above += step;
        b3 = b2, b2 = b1, b1 = b0, b0 = load(below);
        a0 = a1, a1 = a2, a2 = a3, a3 = load(above);
        s0 += w * minus(b0 + a0, unit, t0);
        s1 += w * minus(b1 + a1, unit, t1);
        s2 += w * minus(b2 + a2, unit, t2);
        s3 += w * minus(b3 + a3, unit, t3);
    }
    put(s0, c, adds, out);
    put(s1, c + step, adds, out + to);
    put(s2, c + 2 * step, adds, out + 2 * to);
    put(s3, c + 3 * step, adds, out + 3 * to);
}

/* WR_TAPS_LANES independent lines lie side by side: element j of line i is at c[j * step + i]. c has `reach` elements of
   margin on both sides. */
ALWAYS void filter(const float *weight, int reach, const float *c, ptrdiff_t step, int count,
                   bool adds, float *out, ptrdiff_t to)
{
    for (int lane = 0; lane < WR_TAPS_LANES; lane += LANES) {
        const float *from = c + lane;
        float *at = out + lane;
        int j = 0;
        for (; j + 4 <= count; j += 4, from += 4 * step, at += 4 * to)
            four(weight, reach, from, step, adds, at, to);
        for (; j < count; j++, from += step, at += to) one(weight, reach, from, step, adds, at);
    }
}

static void add(const float *weight, int reach, const float *c, ptrdiff_t step, int count,
                float *out, ptrdiff_t to)
{
    filter(weight, reach, c, step, count, false, out, to);
}

static void smooth(const float *weight, int reach, const float *c, ptrdiff_t step, int count,
                   float *out, ptrdiff_t to)
{
    filter(weight, reach, c, step, count, true, out, to);
}

#ifdef __AVX512F__
/* Transposes by exchanging pairs of rows that are 1, 2, 4 and 8 apart. */
static void turn(const float *in, ptrdiff_t pitch, float *out, ptrdiff_t out_pitch)
{
    __m512 a[WR_TAPS_LANES], b[WR_TAPS_LANES];
#define EACH(i) _Pragma("GCC unroll 16") for (int i = 0; i < WR_TAPS_LANES; i++)
    EACH(i) a[i] = _mm512_loadu_ps(in + i * pitch);
    EACH(i) b[i] = i & 1 ? _mm512_unpackhi_ps(a[i - 1], a[i]) : _mm512_unpacklo_ps(a[i], a[i + 1]);
    EACH(i)
    {
        const __m512d *pair = (const __m512d *)&b[(i & 12) + (i >> 1 & 1)];
        a[i] = (__m512)(i & 1 ? _mm512_unpackhi_pd(pair[0], pair[2])
                              : _mm512_unpacklo_pd(pair[0], pair[2]));
    }
    EACH(i)
    {
        const __m512 *pair = &a[i & 11];
        b[i] = i & 4 ? _mm512_shuffle_f32x4(pair[0], pair[4], 0xdd)
                     : _mm512_shuffle_f32x4(pair[0], pair[4], 0x88);
    }
    EACH(i)
    {
        const __m512 *pair = &b[i & 7];
        a[i] = i & 8 ? _mm512_shuffle_f32x4(pair[0], pair[8], 0xdd)
                     : _mm512_shuffle_f32x4(pair[0], pair[8], 0x88);
    }
    EACH(i) _mm512_storeu_ps(out + i * out_pitch, a[i]);
#undef EACH
}
#else
static void turn(const float *in, ptrdiff_t pitch, float *out, ptrdiff_t out_pitch)
{
    for (int y = 0; y < WR_TAPS_LANES; y++)
        for (int x = 0; x < WR_TAPS_LANES; x++) out[y * out_pitch + x] = in[x * pitch + y];
}
#endif

/* Adding and subtracting this rounds |x| < 2^51 to an integer. */
#define ROUNDER 0x1.8p52
#define SIDE_BY_SIDE WR_BOX_LANES

/* A running box sum of width 2 r + 1 plus two end taps of weight `end` (0..1), divided by their total: a box of fractional
   width, Gwosdz and others 2011 (extended box filter). Heights are integer steps in doubles, so that adding the entering and
   removing the leaving element is exact: the running sum has no drift, and the result does not depend on the starting point. */
static void box(const WrBox *b, const double *restrict in, int count, double *restrict out)
{
    double sum[SIDE_BY_SIDE] = { 0 }, end = b->end, inverse = b->inverse;
    for (int i = 1; i <= 2 * b->r + 1; i++)
#pragma omp simd
        for (int lane = 0; lane < SIDE_BY_SIDE; lane++) sum[lane] += in[i * SIDE_BY_SIDE + lane];
    const double *left = in, *right = in + (2 * (size_t)b->r + 2) * SIDE_BY_SIDE;
    for (int i = 0; i < count; i++) {
#pragma omp simd
        for (int lane = 0; lane < SIDE_BY_SIDE; lane++) {
            double x = (sum[lane] + end * (left[lane] + right[lane])) * inverse;
            out[lane] = (x + ROUNDER) - ROUNDER;
            sum[lane] += right[lane] - left[SIDE_BY_SIDE + lane];
        }
        left += SIDE_BY_SIDE, right += SIDE_BY_SIDE, out += SIDE_BY_SIDE;
    }
}

static inline double steps_of(double scale, float height)
{
    return ((double)height * scale + ROUNDER) - ROUNDER;
}

/* The height plus the change by the blur, so that the bits stay where the change is 0. */
static inline float blurred(double scale, double step, float height, double both)
{
    double x = (double)height + (0.5 * both - steps_of(scale, height)) * step;
    x = x > FLT_MAX ? FLT_MAX : x;
    x = x < -FLT_MAX ? -FLT_MAX : x;
    return (float)x;
}

static void to_steps(double scale, const float *restrict texels, int count, double *restrict row)
{
    for (int i = 0; i < count; i++) row[(size_t)i * SIDE_BY_SIDE] = steps_of(scale, texels[i]);
}

static void add_steps(double scale, double step, const double *restrict both, int count,
                      float *restrict heights)
{
    for (int i = 0; i < count; i++)
        heights[i] = blurred(scale, step, heights[i], both[(size_t)i * SIDE_BY_SIDE]);
}

static void to_steps_across(double scale, const float *restrict texels, double *restrict element)
{
#pragma omp simd
    for (int lane = 0; lane < SIDE_BY_SIDE; lane++) element[lane] = steps_of(scale, texels[lane]);
}

static void add_steps_across(double scale, double step, const double *restrict both,
                             float *restrict heights)
{
#pragma omp simd
    for (int lane = 0; lane < SIDE_BY_SIDE; lane++)
        heights[lane] = blurred(scale, step, heights[lane], both[lane]);
}

/* The OR of all bits that differ in a row. */
ALWAYS uint32_t settle_row(const float *restrict before, float *restrict now, int columns)
{
    uint32_t differs = 0;
#pragma omp simd reduction(| : differs)
    for (int i = 0; i < columns; i++) {
        float was = before[i], x = now[i] > FLT_MAX ? FLT_MAX : now[i];
        x = x < -FLT_MAX ? -FLT_MAX : x;
        const bool changes = (x < was) | (x > was); /* false where x is NaN */
        x = changes ? x : was;
        uint32_t old, new;
        memcpy(&old, &was, sizeof old);
        memcpy(&new, &x, sizeof new);
        differs |= old ^ new;
        now[i] = x;
    }
    return differs;
}

static bool settle(const float *before, size_t before_pitch, float *now, size_t pitch, int columns,
                   int rows)
{
    uint32_t differs = 0;
    for (int y = 0; y < rows; y++)
        differs |= settle_row(before + (size_t)y * before_pitch, now + (size_t)y * pitch, columns);
    return differs != 0;
}

const WrTaps WR_SET_TABLE = {
    .name = WR_SET_NAME,
    .add = add,
    .smooth = smooth,
    .turn = turn,
    .box = box,
    .to_steps = to_steps,
    .add_steps = add_steps,
    .to_steps_across = to_steps_across,
    .add_steps_across = add_steps_across,
    .settle = settle,
};

#undef LANES
#undef ALWAYS
