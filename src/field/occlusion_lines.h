/* occlusion_lines.h - all lines of one course over a whole table, swept and put down.
   Private to this module. */
#pragma once
#include "field/occlusion_lattice.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define WR_SKY_BITS 28 /* of the largest height; the sums of a quarter texel hold two more */

/* The whole table, in steps that are a power of two, so that nothing is rounded that floats hold apart. */
typedef struct WrSky {
    const WrOcclusion *occlusion;
    const WrMapPart *part;
    int32_t *steps;
    size_t pitch;
    double unit;  /* scene units a step */
    double range; /* scene units */
    int k;        /* < 0: occlusion */
    const float *p, *q;
    float *out;
    const WrSkyKernels *kernels;
} WrSky;

/* Both directions of a pair: what they take of the sky is added to `out`, or the horizon of the one that is asked for is
 * put there. False: stopped. */
bool wr_sky_run_pair(const WrSky *sky, int pair, WrPool *pool);
