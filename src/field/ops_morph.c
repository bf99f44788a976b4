/* Dilate and erode: largest and smallest height in a round window.
 *
 * The window's row d has the half width h = floor(sqrt(radius^2 - d^2)). The largest of 2h + 1 texels
 * is the larger of two overlapping runs whose length is a power of two. The maxima of all such runs are
 * computed once for each input row (each length from the previous one), and then merged into the output
 * rows whose window contains this row. Only comparisons are used, so the result is exact; eroding is
 * dilating -F. */
#include "field/ops_internal.h"

#include <math.h>

#define RADIUS_MAX 64
#define SIDE WR_OP_SIDE
#define WIDE (SIDE + 2 * RADIUS_MAX)
#define LEVELS 8 /* runs of 1, 2, .. 128 texels */

typedef struct Morph {
    int reach;
    int half[2 * RADIUS_MAX + 1],
        level[2 * RADIUS_MAX + 1]; /* for the window's row -reach .. reach */
    int levels;
    bool erode;
} Morph;

static void negate(float *row, int count)
{
    for (int i = 0; i < count; i++) row[i] = -row[i];
}

static void larger(const float *a, const float *b, int count, float *restrict out)
{
#pragma omp simd
    for (int i = 0; i < count; i++) out[i] = a[i] > b[i] ? a[i] : b[i];
}

static void larger_of_three(const float *a, const float *b, int count, float *restrict out)
{
#pragma omp simd
    for (int i = 0; i < count; i++) {
        float x = a[i] > b[i] ? a[i] : b[i];
        out[i] = x > out[i] ? x : out[i];
    }
}

/* runs[level][i] = largest of 2^level texels from i on; runs[0] is given. */
static void make_runs(const Morph *morph, float (*runs)[WIDE], int count)
{
    for (int level = 1; level < morph->levels; level++) {
        int step = 1 << (level - 1), left = count - 2 * step + 1;
        if (left > 0) larger(runs[level - 1], runs[level - 1] + step, left, runs[level]);
    }
}

static void make_dilated(const WrOpJob *job, const void *ctx, WrOpBlock b, float *out, size_t pitch,
                         void *scratch)
{
    const Morph *morph = ctx;
    float(*runs)[WIDE] = scratch;
    int r = morph->reach, across = b.count_i + 2 * r;
    for (int y = 0; y < b.count_j; y++)
        for (int x = 0; x < b.count_i; x++) out[(size_t)y * pitch + x] = -FLT_MAX;
    for (int row = -r; row < b.count_j + r; row++) {
        wr_op_read(job->in, b.i - r, b.j + row, across, 1, runs[0], WIDE);
        if (morph->erode) negate(runs[0], across);
        make_runs(morph, runs, across);
        int first = row - r < 0 ? 0 : row - r, last = row + r < b.count_j ? row + r : b.count_j - 1;
        for (int y = first; y <= last; y++) {
            int d = row - y + r, half = morph->half[d];
            const float *run = runs[morph->level[d]] + r;
            larger_of_three(run - half, run + half + 1 - (1 << morph->level[d]), b.count_i,
                            out + (size_t)y * pitch);
        }
    }
    if (morph->erode)
        for (int y = 0; y < b.count_j; y++) negate(out + (size_t)y * pitch, b.count_i);
}

static WrField *run_morph(WrOpJob *job, double radius, bool erode)
{
    Morph morph = { .reach = (int)floor(radius), .levels = 1, .erode = erode };
    for (int d = -morph.reach; d <= morph.reach; d++) {
        int half = (int)floor(sqrt(radius * radius - (double)d * d)), level = 0;
        while (2 << level <= 2 * half + 1) level++;
        morph.half[d + morph.reach] = half;
        morph.level[d + morph.reach] = level;
        morph.levels = level + 1 > morph.levels ? level + 1 : morph.levels;
    }
    WrOpWork work = { .make = make_dilated,
                      .ctx = &morph,
                      .scratch = sizeof(float[LEVELS][WIDE]),
                      .reach = morph.reach,
                      .window = 2 * morph.reach + 1 };
    return wr_op_build_same(job, &work);
}

/* param: radius */
WrField *wr_op_dilate(WrOpJob *job, const double *param)
{
    return run_morph(job, param[0], false);
}

WrField *wr_op_erode(WrOpJob *job, const double *param)
{
    return run_morph(job, param[0], true);
}
