/* occlusion_kern.h - inner loops of occlusion.c, compiled once per instruction set.

   All sets give the same bits: only + - * /, comparisons and conversions, without contraction.
   Private to this module. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define WR_SKY_LANES 16  /* lines swept side by side */
#define WR_SKY_STRIP 256 /* maximum count of numbers processed at once; a multiple of the lanes */

/* Parameters of one line direction and its opposite for the sky fraction of texels. */
typedef struct WrSkyShare {
    float level;      /* slopes up to this become 0, slopes from twice this on are exact */
    float ux, uy;     /* unit vector of the first direction on the cell, y up */
    float weight;     /* of each of the two: its fraction of the circle */
    bool first, last; /* first: loss starts at 0; last: finish the result */
} WrSkyShare;

/* Adjacent texels: their horizons, the slopes of their planes, and the sky fraction lost so far. */
typedef struct WrSkyRun {
    const float *ahead, *behind, *p, *q;
    float *loss;
    int count;
} WrSkyRun;

/* Heights of lines, side by side, in integer steps: h[row * LANES + lane]. */
typedef struct WrSkySweep {
    const int32_t *h;
    int64_t *seen;   /* scratch, like h: the horizon candidate, with its height in the lower half */
    const int *rows; /* relevant rows, the farthest ahead first */
    int count, from;
} WrSkySweep;

typedef struct WrSkyKernels {
    const char *name; /* "v1", "v3", "v4": levels of x86-64; v1 is plain C everywhere */

    /* Horizons of lines side by side: for rows[from ...], slope[rows[i] * LANES + lane] = scale times
     * the largest rise over rows to one ahead of it, or 0. All comparisons are exact for steps below
     * 2^30 and fewer than 2^21 rows. */
    void (*sweep)(const WrSkySweep *sweep, double scale, float *slope);
    /* Returns the first of rows from, ... count - 1, each `sign` rows from the one before it, in which
     * a lane is higher than `highest`, and raises `highest` to it; count: none. */
    int (*higher)(const int32_t *h, int sign, int from, int count, int32_t *highest);
    /* loss[i] += sky fraction hidden by horizons `ahead` and `behind`, for the slopes p, q of the
     * texel's own plane. The last direction replaces it by 1 - loss times the plane's n_z, within 0..1.
     * STRIP texels at most in all runs together. */
    void (*share)(const WrSkyShare *share, const WrSkyRun *runs, int count);
    /* best[i] = max(best[i], rise to a[i] * inverse), rises over c[i], or to a + part (b - a) where
     * part is not 0. */
    void (*look)(const float *c, const float *a, const float *b, float part, float inverse,
                 int count, float *best);
} WrSkyKernels;

extern const WrSkyKernels wr_sky_kernels_v1, wr_sky_kernels_v3, wr_sky_kernels_v4;

/* The fastest table for this processor. */
const WrSkyKernels *wr_sky_kernels(void);
/* Enumerates the tables, index = 0, 1, ...; NULL where this processor cannot run that one, or past the
 * last. */
const WrSkyKernels *wr_sky_kernels_at(int index);
