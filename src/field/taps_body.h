/* taps_body.h - the text of taps.h's loop, included once by each taps_v*.c, which defines WR_TAPS_TABLE and
   WR_TAPS_NAME. A header without a guard, by intention. */
#include "field/taps.h"

#include <float.h>
#include <string.h>

/* Vectors by name, since the sums of several must stay in registers while all taps are added, which no
 * compiler does with an array: that is what makes this loop fast. */
#ifdef __AVX512F__
typedef float Vec __attribute__((vector_size(64)));
#elif defined __AVX__
typedef float Vec __attribute__((vector_size(32)));
#else
typedef float Vec __attribute__((vector_size(16)));
#endif
#define LANES ((int)(sizeof(Vec) / sizeof(float)))

static inline Vec load(const float *from)
{
    Vec v;
    memcpy(&v, from, sizeof v);
    return v;
}

/* What every texel gets; the vectors below do the same. */
static inline float one(const float *weight, int reach, const float *c, ptrdiff_t step)
{
    float sum = 0.0f, twice = c[0] + c[0];
    for (int k = 1; k <= reach; k++) sum += weight[k] * ((c[-k * step] + c[k * step]) - twice);
    return sum;
}

static inline void two(const float *weight, int reach, const float *c, ptrdiff_t step, float *sum)
{
    Vec s0 = { 0.0f }, s1 = { 0.0f }, t0 = load(c) + load(c),
        t1 = load(c + LANES) + load(c + LANES);
    const float *below = c, *above = c;
    for (int k = 1; k <= reach; k++) {
        below -= step;
        above += step;
        s0 += weight[k] * ((load(below) + load(above)) - t0);
        s1 += weight[k] * ((load(below + LANES) + load(above + LANES)) - t1);
    }
    memcpy(sum, &s0, sizeof s0);
    memcpy(sum + LANES, &s1, sizeof s1);
}

static inline void four(const float *weight, int reach, const float *c, ptrdiff_t step, float *sum)
{
    Vec s0 = { 0.0f }, s1 = s0, s2 = s0, s3 = s0;
    Vec t0 = load(c), t1 = load(c + LANES), t2 = load(c + 2 * LANES), t3 = load(c + 3 * LANES);
    const float *below = c, *above = c;
    t0 += t0, t1 += t1, t2 += t2, t3 += t3;
    for (int k = 1; k <= reach; k++) {
        Vec w = weight[k] - (Vec){ 0.0f };
        below -= step;
        above += step;
        s0 += w * ((load(below) + load(above)) - t0);
        s1 += w * ((load(below + LANES) + load(above + LANES)) - t1);
        s2 += w * ((load(below + 2 * LANES) + load(above + 2 * LANES)) - t2);
        s3 += w * ((load(below + 3 * LANES) + load(above + 3 * LANES)) - t3);
    }
    memcpy(sum, &s0, sizeof s0);
    memcpy(sum + LANES, &s1, sizeof s1);
    memcpy(sum + 2 * LANES, &s2, sizeof s2);
    memcpy(sum + 3 * LANES, &s3, sizeof s3);
}

static void add(const float *weight, int reach, const float *c, ptrdiff_t step, int count,
                float *sum)
{
    int i = 0;
    for (; i + 4 * LANES <= count; i += 4 * LANES) four(weight, reach, c + i, step, sum + i);
    for (; i + 2 * LANES <= count; i += 2 * LANES) two(weight, reach, c + i, step, sum + i);
    for (; i < count; i++) sum[i] = one(weight, reach, c + i, step);
}

static void smooth(const float *weight, int reach, const float *c, ptrdiff_t step, int count,
                   float *restrict out)
{
    add(weight, reach, c, step, count, out);
#pragma omp simd
    for (int i = 0; i < count; i++) out[i] = c[i] + out[i];
}

/* Adding and subtracting this rounds |x| < 2^51 to a whole number. */
#define ROUNDER 0x1.8p52
#define SIDE_BY_SIDE WR_BOX_LANES

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

/* The height plus what the blur adds to it, so that where that is nothing the bits stay. */
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

const WrTaps WR_TAPS_TABLE = {
    .name = WR_TAPS_NAME,
    .add = add,
    .smooth = smooth,
    .box = box,
    .to_steps = to_steps,
    .add_steps = add_steps,
    .to_steps_across = to_steps_across,
    .add_steps_across = add_steps_across,
};
