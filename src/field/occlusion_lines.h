/* occlusion_lines.h - horizon sweeps along all lines of one direction over a whole table.
   Private to this module. */
#pragma once
#include "field/occlusion_lattice.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define WR_SKY_BITS 28 /* bits of the largest height; sums at quarter texels use two more */

/* The whole table, in integer steps of a power of two, so that different floats stay different. */
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

/* Processes both directions of a pair: adds the sky fraction that they hide to `out`, or stores the
 * horizon of the requested one. False: cancelled. */
bool wr_sky_run_pair(const WrSky *sky, int pair, WrPool *pool);
