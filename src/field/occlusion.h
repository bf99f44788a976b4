/* occlusion.h - maps of ambient occlusion and of horizons for the texels of a table.

   The directions divide the perimeter of a square into equal steps (horizon.h): they meet texels, so
   that every sample on a line is a texel or lies between two at halves or quarters. Each direction is
   weighted by the part of the circle nearest to it. With H the horizon's slope, never below the plane's
   own slope s in that direction, and weights w that sum to 1,

     occlusion = n_z sum of w (1/(1 + H^2) - s (acot H - H / (1 + H^2))),   n_z = 1 / sqrt(1 + p^2 + q^2),

   which is 1 if nothing rises above the plane of a level texel, and cos^2 of the horizon in a round
   pit. A table shifted by whole texels along its periodic axes produces the shifted map, to the bit, on
   any number of threads. */
#pragma once
#include "field/derivatives.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrPool WrPool;

#define WR_OCCLUSION_FARTHEST 256 /* texels; largest finite reach */

typedef struct WrOcclusion {
    const WrField *field;
    double height;           /* for F = 1, scene units; finite */
    double texel_w, texel_h; /* scene units, > 0 */
    int directions;          /* 4, 8, 16 or 32 */
    /* Search distance in texels along a line's main axis: 1..FARTHEST. 0: unlimited. Then horizons are
     * exact except for rounding to single precision, of heights to 2^-28 of the largest, where a line
     * closes within WR_OCCLUSION_ROUND of the table; elsewhere slopes up to `range / search distance`
     * are 0, and exact from twice that on. A clamped axis repeats its edge. */
    int reach;
} WrOcclusion;

/* The search stops on a line that does not close within 2 of the table's longer sides, or 1024 texels. */
#define WR_OCCLUSION_ROUND 2
#define WR_OCCLUSION_MIN 1024

/* out: 0..1. p, q: slopes of the texels' planes in scene units, y up. A part of the table needs a
 * reach; then pool must be NULL. Errors: out of memory; cancelled. */
bool wr_occlusion_make(const WrOcclusion *occlusion, const WrMapPart *part, const float *p,
                       const float *q, WrPool *pool, float *out, WrError *err);

/* out: the slope of the horizon in direction k, 0..directions-1, anticlockwise from u; 0 if no height
 * is greater. */
bool wr_occlusion_horizon(const WrOcclusion *occlusion, const WrMapPart *part, int k, WrPool *pool,
                          float *out, WrError *err);

/* The angle of direction k in degrees from u, v up, over a cell of these texels. */
double wr_occlusion_degrees(const WrOcclusion *occlusion, int k);
