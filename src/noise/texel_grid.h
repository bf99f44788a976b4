/* texel_grid.h - fast evaluation of noise sums on the texel grid of a table.

   Texel (i, j) of a table of width x height is at u = (i + 0.5)/width, v = 1 - (j + 0.5)/height. On
   such a grid a 2D noise of square cells is 1D along each row: with y the row's position between two
   rows of the lattice,

     A_k = blend over y of f + g_y y,   B_k = blend over y of g_x,   f = blend over x of A_k + B_k x,

   so that lattice points are hashed once per band of rows, and a texel costs two multiplications and
   one blend. In float, on coordinates that were reduced in double. */
#pragma once
#include "noise/octaves.h"

#include <stddef.h>

/* A rectangle of a table. */
typedef struct WrNoiseGrid {
    int width, height;          /* of the table, texels, from 1 */
    int i, j, count_i, count_j; /* the rectangle, inside the table */
} WrNoiseGrid;

/* Fills a rectangle with N(u,v) and its slopes.
 *
 * plan     of 2 dimensions
 * f        [count_j][pitch] rows from the top; heights
 * fu, fv   dN/du, dN/dv, the same shape; both or neither NULL
 * pitch    floats from row to row, at least count_i
 * Errors   none
 * Threads  any number, on any rectangles: a texel has the same bits in every rectangle, and on every
 *          processor Agrees with wr_octaves_at at the texel's centre: heights to 1e-6 times the sum of
 *          the octaves' amplitudes, slopes to 5e-6 times the sum of amplitude times frequency, except
 *          on creases, where float and double may fall on different sides of 0. (ridged: for offset up
 *          to 1 and gain up to 2; each octave's error enters the next ones multiplied by the gain.)
 *          Value, gradient and perlin noise with at most half a cell per texel take about 0.6 ns per
 *          texel and octave with AVX2 (1.2 without, or with finer cells), 3 ns with slopes; sheared
 *          noise 4.5 and 10. Other kinds and finer lattices are evaluated point by point in double,
 *          then rounded: 60 ns and more. */
void wr_octaves_grid(const WrOctavesPlan *plan, const WrNoiseGrid *grid, float *f, float *fu,
                     float *fv, size_t pitch);

/* f[i] = level + amplitude f[i], in double and rounded once. */
void wr_octaves_scale(double level, double amplitude, int count, float *f);
