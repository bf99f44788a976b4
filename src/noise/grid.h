/* grid.h - tables filled with sums of noise, quickly.
   Layer 1.

   Texel (i, j) of a table of width x height stands at u = (i + 0.5)/width, v = 1 - (j + 0.5)/height.
   On such a grid a 2D noise of square cells is one in 1D along each row: with y the row's place between
   two rows of the lattice,
     A_k = blend over y of f + g_y y,   B_k = blend over y of g_x,   f = blend over x of A_k + B_k x,
   so that lattice points are hashed once a band of rows, and a texel costs two multiplications and one
   blend. In float, on coordinates that were reduced in double. */
#pragma once
#include "noise/octaves.h"

/* A rectangle of a table. */
typedef struct WrNoiseGrid {
    int width, height;          /* of the table, texels, from 1 */
    int i, j, count_i, count_j; /* the rectangle, inside the table */
} WrNoiseGrid;

/* Fill a rectangle with N(u,v) and its slopes.
 *
 * plan     of 2 dimensions
 * f        [count_j][pitch] rows from the top; heights
 * fu, fv   dN/du, dN/dv, the same shape; both or neither NULL
 * pitch    floats from row to row, at least count_i
 * Errors   none      Threads  any number, on any rectangles: a texel gets the same bits in whatever
 *          rectangle it is asked for, and on every processor
 * Agrees with wr_octaves_at at the texel's centre to 2e-6 times the sum of the octaves' amplitudes for f
 * (for ridged, and per offset^2, 1e-5 times max(1, gain)), and for slopes to 1e-5 times the sum of
 * amplitude times frequency. About 1 ns a texel and octave for value, gradient and perlin noise with at
 * most one cell a texel; other kinds go point by point in double, and agree to float's rounding. */
void wr_octaves_grid(const WrOctavesPlan *plan, const WrNoiseGrid *grid, float *f, float *fu,
                     float *fv, size_t pitch);

/* The same for wr_octaves_warped_at: point by point in double, some 100 ns a texel and octave. */
void wr_octaves_warped_grid(const WrOctavesPlan *plan, const WrOctavesPlan *const *warp,
                            double amount, const WrNoiseGrid *grid, float *f, float *fu, float *fv,
                            size_t pitch);
