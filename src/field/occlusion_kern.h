/* occlusion_kern.h - the inner loops of occlusion.c, compiled once per instruction set. All sets give the same bits: only
   + - * /, comparisons and conversions, without contraction.
   Private to this module. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define WR_SKY_LANES 16  /* lines that are swept side by side */
#define WR_SKY_STRIP 256 /* numbers that are worked on at once, a multiple of it, at most */

/* Both horizons of a line through a texel, and what they take of the sky of its own normal. */
typedef struct WrSkyShare {
    float level;      /* slopes up to this are 0, from twice this on what they are */
    float ux, uy;     /* the direction of the first, a unit vector of the cell, y up */
    float weight;     /* of each: a part of the circle */
    bool first, last; /* of all lines: nothing was lost before; nothing will be */
} WrSkyShare;

/* Texels that lie side by side: their horizons, the slopes of their planes, and what they lose of the sky. */
typedef struct WrSkyRun {
    const float *ahead, *behind, *p, *q;
    float *loss;
    int count;
} WrSkyRun;

/* Heights of lines, side by side, in whole steps: h[row * LANES + lane]. */
typedef struct WrSkySweep {
    const int32_t *h;
    int64_t *seen;   /* scratch, like h: what is looked at, and in the lower half its height */
    const int *rows; /* those that count, the farthest ahead first */
    int count, from;
} WrSkySweep;

typedef struct WrSkyKernels {
    const char *name; /* "v1", "v3", "v4": levels of x86-64; v1 is plain C everywhere */

    /* Horizons of lines side by side: of rows[from ...] slope[rows[i] * LANES + lane] = scale times the largest rise
     * over rows to one ahead of it, or 0. All comparisons are exact for steps below 2^30 and fewer than 2^21 rows. */
    void (*sweep)(const WrSkySweep *sweep, double scale, float *slope);
    /* The first of rows from, ... count - 1, each `sign` rows from the one before it, in which a lane is higher than
     * `highest`, which becomes the higher of both; count: none. */
    int (*higher)(const int32_t *h, int sign, int from, int count, int32_t *highest);
    /* loss[i] += what horizons `ahead` and `behind` take of 1, by the slopes p, q of the texel's own plane; by the last
     * lines it becomes 1 - loss times the plane's n_z, within 0..1. STRIP texels at most in all runs together. */
    void (*share)(const WrSkyShare *share, const WrSkyRun *runs, int count);
    /* best[i] = max(best[i], rise to a[i] * inverse), rises over c[i], or to a + part (b - a) where part is not 0. */
    void (*look)(const float *c, const float *a, const float *b, float part, float inverse,
                 int count, float *best);
} WrSkyKernels;

extern const WrSkyKernels wr_sky_kernels_v1, wr_sky_kernels_v3, wr_sky_kernels_v4;

/* Those that this processor runs best. */
const WrSkyKernels *wr_sky_kernels(void);
/* One after another for index = 0, 1, ...; NULL where this processor cannot run it, or there is none. */
const WrSkyKernels *wr_sky_kernels_at(int index);
