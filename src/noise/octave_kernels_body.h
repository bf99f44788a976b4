/* octave_kernels_body.h - implementation of the loops of octave_kernels.h, compiled once for each
   instruction set (wr_kern of CMakeLists.txt). Intentionally without an include guard. */
#include "noise/octave_kernels.h"

#include <math.h>
#ifdef __AVX2__
#include <immintrin.h>
#endif

/* Counts are rounded up to whole vectors: arrays have room for it, and surplus lanes repeat the pattern
   without being used.
   t = f (i + 1/2) / W + offset in double: in float a cell far from 0 would lose the bits of x. Cells are
   stored relative to the first, which keeps them small. */
static void place(const WrFadeInfo *fade, double frequency, double offset, int i, int width,
                  WrNoiseColumns *columns)
{
    const WrFadeInfo alpha = *fade;
    int count = (columns->count + WR_NOISE_BLOCK - 1) / WR_NOISE_BLOCK * WR_NOISE_BLOCK;
    double first = floor(frequency * ((i + 0.5) / width) + offset);
    columns->first = first;
#pragma omp simd
    for (int k = 0; k < count; k++) {
        double t = frequency * ((i + k + 0.5) / width) + offset, whole = floor(t), x = t - whole;
        columns->cell[k] = (int32_t)(whole - first);
        columns->x[k] = (float)x;
        columns->alpha[k] = (float)wr_fade_value(&alpha, x);
        columns->rate[k] = (float)wr_fade_slope(&alpha, x);
    }
}

/* v = 1 - (j + 1/2) / height: rows run down, v up. */
static void stand(const WrFadeInfo *fade, double frequency, double offset, int j, int height,
                  WrNoiseRows *rows)
{
    const WrFadeInfo alpha = *fade;
#pragma omp simd
    for (int k = 0; k < rows->count; k++) {
        double t = frequency * (1.0 - (j + k + 0.5) / height) + offset, whole = floor(t);
        double y = t - whole;
        rows->whole[k] = whole;
        rows->y[k] = (float)y;
        rows->alpha[k] = (float)wr_fade_value(&alpha, y);
        rows->rate[k] = (float)wr_fade_slope(&alpha, y);
    }
}

/* wr_lattice_number in float: exact.
   The upper 23 bits h' as (2 h' + 1) / 2^23 - 1: odd multiples of 2^-23 in (-1, 1), symmetric and never 0. */
static inline float number(uint32_t h)
{
    return (float)(2 * (int32_t)(h >> 9) + 1) * 0x1p-23f - 1.0f;
}

/* The hash's link for y is the only one left for a row; a slope of Perlin noise is one of 16, already scaled. */
static void prescribe(WrNoiseKind kind, const WrNoiseColumns *columns, uint32_t part,
                      WrNoiseLattice *row)
{
    int points = columns->points;
    if (kind == WR_NOISE_PERLIN) {
#pragma omp simd
        for (int k = 0; k < points; k++) {
            uint32_t h = wr_lattice_hash_link(columns->chain[k], part) >> 28;
            row->f[k] = 0.0f;
            row->gx[k] = columns->set[0][h];
            row->gy[k] = columns->set[1][h];
        }
        return;
    }
    float slope = kind == WR_NOISE_GRADIENT ? 1.0f : 0.0f;
#pragma omp simd
    for (int k = 0; k < points; k++) {
        uint32_t h = wr_lattice_hash_link(columns->chain[k], part);
        row->f[k] = number(h);
        row->gx[k] = slope * number(wr_lattice_slope_hash(h, 0));
        row->gy[k] = slope * number(wr_lattice_slope_hash(h, 1));
    }
}

/* At column k and height y within the cell the noise is a function of x alone: value a + b x, and df/dy = c +
   d x. The next point contributes with x - 1. */
static void blend(int points, const WrNoiseLattice *near, const WrNoiseLattice *far, float y,
                  float alpha, float rate, WrNoiseBlended *out)
{
#pragma omp simd
    for (int k = 0; k < points; k++) {
        float p = near->f[k] + near->gy[k] * y, q = far->f[k] + far->gy[k] * (y - 1.0f);
        float dx = far->gx[k] - near->gx[k];
        out->a[k] = p + alpha * (q - p);
        out->b[k] = near->gx[k] + alpha * dx;
        out->c[k] = near->gy[k] + alpha * (far->gy[k] - near->gy[k]) + rate * (q - p);
        out->d[k] = rate * dx;
    }
}

/* Heights and slopes from the blended rows, in plain C; the vector versions below compute the same.
   p and q are the contributions of the points left and right of the texel, mixed by alpha(x), the fade. */
static void plain_heights(const WrNoiseColumns *columns, const WrNoiseBlended *in,
                          float *restrict f)
{
#pragma omp simd
    for (int i = 0; i < columns->count; i++) {
        int32_t k = columns->cell[i];
        float x = columns->x[i];
        float p = in->a[k] + in->b[k] * x, q = in->a[k + 1] + in->b[k + 1] * (x - 1.0f);
        f[i] = p + columns->alpha[i] * (q - p);
    }
}

/* The texels of a vector lie in few cells, whose points are contiguous: they are loaded once and
 * permuted in registers, at a third of the cost of a gather. */
#if defined __AVX512F__
#define LANES 16
typedef __m512 Vec;
typedef __m512i Lanes;
#define V_LOAD _mm512_loadu_ps
#define V_STORE _mm512_storeu_ps
#define V_ADD _mm512_add_ps
#define V_SUB _mm512_sub_ps
#define V_MUL _mm512_mul_ps
#define V_ONE _mm512_set1_ps(1.0f)
#define V_SET _mm512_set1_ps
#define V_ABS _mm512_abs_ps
#define V_TAKE(from, lanes) _mm512_permutexvar_ps(lanes, from)
#define V_DEAL(from, lanes) V_TAKE(_mm512_loadu_ps(from), lanes)
#define V_LANES(cell) _mm512_loadu_si512(cell)
#define V_NEXT(lanes) _mm512_add_epi32(lanes, _mm512_set1_epi32(1))
static inline Lanes lanes_of(const int32_t *cell)
{
    return _mm512_sub_epi32(_mm512_loadu_si512(cell), _mm512_set1_epi32(cell[0]));
}
#elif defined __AVX2__
#define LANES 8
typedef __m256 Vec;
typedef __m256i Lanes;
#define V_LOAD _mm256_loadu_ps
#define V_STORE _mm256_storeu_ps
#define V_ADD _mm256_add_ps
#define V_SUB _mm256_sub_ps
#define V_MUL _mm256_mul_ps
#define V_ONE _mm256_set1_ps(1.0f)
#define V_SET _mm256_set1_ps
#define V_ABS(x) _mm256_andnot_ps(_mm256_set1_ps(-0.0f), x)
#define V_TAKE(from, lanes) _mm256_permutevar8x32_ps(from, lanes)
#define V_DEAL(from, lanes) V_TAKE(_mm256_loadu_ps(from), lanes)
#define V_LANES(cell) _mm256_loadu_si256((const __m256i *)(cell))
#define V_NEXT(lanes) _mm256_add_epi32(lanes, _mm256_set1_epi32(1))
static inline Lanes lanes_of(const int32_t *cell)
{
    return _mm256_sub_epi32(_mm256_loadu_si256((const __m256i *)cell), _mm256_set1_epi32(cell[0]));
}
#endif

/* narrow: at most half a cell per texel, so the texels of a vector need at most LANES / 2 + 1 points and one
   load per array. */
static void heights(const WrNoiseColumns *columns, const WrNoiseBlended *in, float *restrict f)
{
#ifdef LANES
    if (columns->narrow) {
        for (int i = 0; i < columns->count; i += LANES) {
            int32_t k = columns->cell[i];
            Lanes at = lanes_of(columns->cell + i);
            Vec x = V_LOAD(columns->x + i), alpha = V_LOAD(columns->alpha + i);
            Vec p = V_ADD(V_DEAL(in->a + k, at), V_MUL(V_DEAL(in->b + k, at), x));
            Vec q =
                V_ADD(V_DEAL(in->a + k + 1, at), V_MUL(V_DEAL(in->b + k + 1, at), V_SUB(x, V_ONE)));
            V_STORE(f + i, V_ADD(p, V_MUL(alpha, V_SUB(q, p))));
        }
        return;
    }
#endif
    plain_heights(columns, in, f);
}

/* a and b of a lattice row, as in `blend`.
   c and d are needed for slopes only. */
static inline void blend_heights(int points, const WrNoiseLattice *near, const WrNoiseLattice *far,
                                 float y, float alpha, WrNoiseBlended *out)
{
#pragma omp simd
    for (int k = 0; k < points; k++) {
        float p = near->f[k] + near->gy[k] * y, q = far->f[k] + far->gy[k] * (y - 1.0f);
        out->a[k] = p + alpha * (q - p);
        out->b[k] = near->gx[k] + alpha * (far->gx[k] - near->gx[k]);
    }
}

/* magnitude: factor |f| - below, of billow 2 |f| - 1 (L6). */
static inline void count_in(WrNoiseShare share, const float *restrict f, int count,
                            float *restrict n)
{
    if (share.magnitude) {
#pragma omp simd
        for (int i = 0; i < count; i++) n[i] += share.factor * fabsf(f[i]) - share.below;
        return;
    }
#pragma omp simd
    for (int i = 0; i < count; i++) n[i] += share.factor * f[i];
}

/* Up to LANES lattice points per strip: a and b of the whole row are one register each, and V_TAKE picks a
   texel's point from it. */
#ifdef LANES
/* Few points: they stay in registers, so that a row is blended once for all its texels. */
static inline Vec v_share(WrNoiseShare share, Vec f, Vec n)
{
    if (!share.magnitude) return V_ADD(n, V_MUL(V_SET(share.factor), f));
    return V_ADD(n, V_SUB(V_MUL(V_SET(share.factor), V_ABS(f)), V_SET(share.below)));
}

/* The remainder is stored apart: n has no room beyond `count`, because it is the caller's row. */
static inline void sum_row(const WrNoiseColumns *columns, const Vec a, const Vec b,
                           WrNoiseShare share, float *restrict n)
{
    int count = columns->count;
    for (int i = 0; i < count; i += LANES) {
        Lanes at = V_LANES(columns->cell + i), next = V_NEXT(at);
        Vec x = V_LOAD(columns->x + i), alpha = V_LOAD(columns->alpha + i);
        Vec p = V_ADD(V_TAKE(a, at), V_MUL(V_TAKE(b, at), x));
        Vec q = V_ADD(V_TAKE(a, next), V_MUL(V_TAKE(b, next), V_SUB(x, V_ONE)));
        Vec f = V_ADD(p, V_MUL(alpha, V_SUB(q, p)));
        if (i + LANES <= count) {
            V_STORE(n + i, v_share(share, f, V_LOAD(n + i)));
            continue;
        }
        float rest[LANES];
        V_STORE(rest, f);
        count_in(share, rest, count - i, n + i);
    }
}

/* Loads f, gx, gy of both lattice rows once for all texel rows between them. */
static void sum_few(const WrNoiseColumns *columns, const WrNoiseLattice *near,
                    const WrNoiseLattice *far, const WrNoiseRows *rows, int first, int count,
                    WrNoiseShare share, float *n, size_t pitch)
{
    Vec f0 = V_LOAD(near->f), gx0 = V_LOAD(near->gx), gy0 = V_LOAD(near->gy);
    Vec f1 = V_LOAD(far->f), gy1 = V_LOAD(far->gy), dx = V_SUB(V_LOAD(far->gx), gx0);
    for (int j = first; j < first + count; j++, n += pitch) {
        Vec alpha = V_SET(rows->alpha[j]);
        Vec p = V_ADD(f0, V_MUL(gy0, V_SET(rows->y[j])));
        Vec q = V_ADD(f1, V_MUL(gy1, V_SET(rows->y[j] - 1.0f)));
        Vec a = V_ADD(p, V_MUL(alpha, V_SUB(q, p))), b = V_ADD(gx0, V_MUL(alpha, dx));
        sum_row(columns, a, b, share, n);
    }
}
#endif

/* V_DEAL loads whole vectors, so lanes beyond `points` are set once. */
static void sum(const WrNoiseColumns *columns, const WrNoiseLattice *near,
                const WrNoiseLattice *far, const WrNoiseRows *rows, int first, int count,
                WrNoiseShare share, float *n, size_t pitch)
{
#ifdef LANES
    if (columns->points <= LANES) {
        sum_few(columns, near, far, rows, first, count, share, n, pitch);
        return;
    }
#endif
    WrNoiseBlended blended;
    float f[WR_NOISE_STRIP];
    for (int k = columns->points; k < WR_NOISE_POINTS; k++) blended.a[k] = blended.b[k] = 0.0f;
    for (int j = first; j < first + count; j++, n += pitch) {
        blend_heights(columns->points, near, far, rows->y[j], rows->alpha[j], &blended);
        heights(columns, &blended, f);
        count_in(share, f, columns->count, n);
    }
}

/* In double: level + amplitude f is rounded once. */
static void scale(double level, double amplitude, int count, float *restrict f)
{
#pragma omp simd
    for (int i = 0; i < count; i++) f[i] = (float)(level + amplitude * (double)f[i]);
}

/* fx has the term rate (q - p) because alpha depends on x; fy has its own in c and d. */
static void slopes(const WrNoiseColumns *columns, const WrNoiseBlended *in, float *restrict fx,
                   float *restrict fy)
{
#pragma omp simd
    for (int i = 0; i < columns->count; i++) {
        int32_t k = columns->cell[i];
        float x = columns->x[i], alpha = columns->alpha[i], b0 = in->b[k], b1 = in->b[k + 1];
        float p = in->a[k] + b0 * x, q = in->a[k + 1] + b1 * (x - 1.0f);
        float py = in->c[k] + in->d[k] * x, qy = in->c[k + 1] + in->d[k + 1] * (x - 1.0f);
        fx[i] = b0 + alpha * (b1 - b0) + columns->rate[i] * (q - p);
        fy[i] = py + alpha * (qy - py);
    }
}

static void add(float factor, const float *restrict f, int count, float *restrict n)
{
#pragma omp simd
    for (int i = 0; i < count; i++) n[i] += factor * f[i];
}

static void add_magnitude(float factor, float below, const float *restrict f, int count,
                          float *restrict n)
{
#pragma omp simd
    for (int i = 0; i < count; i++) n[i] += factor * fabsf(f[i]) - below;
}

const WrNoiseKernels WR_SET_TABLE = {
    .name = WR_SET_NAME,
    .place = place,
    .stand = stand,
    .prescribe = prescribe,
    .blend = blend,
    .heights = heights,
    .slopes = slopes,
    .sum = sum,
    .scale = scale,
    .add = add,
    .add_magnitude = add_magnitude,
};
