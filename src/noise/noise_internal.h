/* noise_internal.h - internals shared by the files of noise.
   Private to this module. */
#pragma once
#include "noise/texel_grid.h"

#include <stdbool.h>

#define WR_NOISE_DIMENSIONS 4 /* maximum of any kind: a torus lies in four dimensions */

/* The linear function at a corner of a cube, at a point: its value and gradient. */
typedef struct WrNoiseBlend {
    double f, d[WR_NOISE_DIMENSIONS];
} WrNoiseBlend;

/* The scale of perlin noise's slopes from the fixed set. */
double wr_noise_perlin_scale(int dim);

/* A grid is filled in pieces of this size, whose intermediate values fit a core's caches. */
#define WR_NOISE_STRIP 64 /* texels of a row, like a tile */
#define WR_NOISE_BAND 64  /* rows */

/* One octave over a piece: f and df/dt (per cell), [row][column]. */
typedef struct WrNoiseBand {
    float f[WR_NOISE_BAND][WR_NOISE_STRIP];
    float fx[WR_NOISE_BAND][WR_NOISE_STRIP], fy[WR_NOISE_BAND][WR_NOISE_STRIP];
} WrNoiseBand;

/* The centre of a texel. */
static inline double wr_noise_grid_u(const WrNoiseGrid *grid, int i)
{
    return (i + 0.5) / grid->width;
}
static inline double wr_noise_grid_v(const WrNoiseGrid *grid, int j)
{
    return 1.0 - (j + 0.5) / grid->height;
}
