/* occlusion.h - maps of what stands about each texel of a table: how much of the sky its plane sees, and horizons.

   Directions go round a square in equal steps (horizon.h): they meet texels, so that every number on a line is a texel or
   lies between two at halves or quarters. Each direction counts with the part of the circle that it is nearest to.
   With H the horizon's slope, never below the plane's own slope s that way, and weights w that sum to 1,
     occlusion = n_z sum of w (1/(1 + H^2) - s (acot H - H / (1 + H^2))),   n_z = 1 / sqrt(1 + p^2 + q^2),
   which is 1 where nothing stands above the plane of a level texel, cos^2 of the horizon in a round pit.

   A table that is moved by whole texels over its periodic axes gives the moved map, to the bit, on any number of threads. */
#pragma once
#include "field/derivatives.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrPool WrPool;

#define WR_OCCLUSION_FARTHEST 256 /* texels, where a reach is given */

typedef struct WrOcclusion {
    const WrField *field;
    double height;           /* of F = 1, scene units; finite */
    double texel_w, texel_h; /* scene units, > 0 */
    int directions;          /* 4, 8, 16 or 32 */
    /* Texels that are looked at, along the axis that a line is nearer to: 1..FARTHEST. 0: all. Then horizons are exact but for
     * their rounding to single precision, of heights to 2^-28 of the largest, where a line closes in itself within WR_OCCLUSION_ROUND of the table; else slopes
     * up to `range / that way` are 0, and from twice it on exact. On a clamped axis the edge goes on. */
    int reach;
} WrOcclusion;

/* A line that does not close within 2 of the table's longer sides, or 1024 texels, is given up. */
#define WR_OCCLUSION_ROUND 2
#define WR_OCCLUSION_LEAST 1024

/* out: 0..1. p, q: slopes of the texels' planes in scene units, y up. Of less than the whole table only with a reach; then
 * pool must be NULL. Errors: no memory; cancelled. */
bool wr_occlusion_make(const WrOcclusion *occlusion, const WrMapPart *part, const float *p,
                       const float *q, WrPool *pool, float *out, WrError *err);

/* out: the slope of the horizon in direction k, 0..directions-1, anticlockwise from u; 0 where nothing is higher. */
bool wr_occlusion_horizon(const WrOcclusion *occlusion, const WrMapPart *part, int k, WrPool *pool,
                          float *out, WrError *err);

/* The angle of direction k in degrees from u, v up, over a cell of these texels. */
double wr_occlusion_degrees(const WrOcclusion *occlusion, int k);
