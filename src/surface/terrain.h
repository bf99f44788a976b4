/* terrain.h - a height image as bicubic patches.

   The surface is a uniform cubic B-spline with the heights as coefficients (smoothing, C2); each cell
   is one patch, equal bit for bit to its neighbours at their edges. z = h(u,v) over the rectangle 0..a,
   0..b, so Pu x Pv points up; with WR_PATCH_SPLIT the chart's u and v cover all of it. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrPatches WrPatches;
typedef struct WrSurfacePoint WrSurfacePoint;

/* Returns row j of the heights, from the top (v = 1), finite: in room [w], or in other memory. */
typedef const float *WrTerrainRow(const void *ctx, int j, float *room);

typedef struct WrTerrain {
    WrTerrainRow *row; /* NULL: ctx is const float [h][w], the upper row first */
    const void *ctx;   /* borrowed */
    int w, h;
    double a, b, height; /* height: of value 1 */
    int cells;           /* along the longer of a and b; 2..64 */
} WrTerrain;

/* The caller frees *points (wr_free): *columns x *rows patches of 48 numbers, row by row from v = 0.
 * Heights are means over a cell's area. Errors: out of memory. */
bool wr_terrain_points(const WrTerrain *terrain, float (**points)[48], int *columns, int *rows,
                       WrError *err);
/* The point of a terrain's patches at the terrain's u and v, with derivatives by these. */
void wr_terrain_at(const WrPatches *set, double u, double v, WrSurfacePoint *out);
