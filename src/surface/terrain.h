/* terrain.h - heights in rows as bicubic patches: a uniform cubic B-spline through nothing and near everything, C2, each
   cell of which is one patch, bit for bit with its neighbours. z = h(u,v) over the rectangle 0..a, 0..b, so Pu x Pv points
   up; laid out by WR_PATCH_SPLIT the chart's u and v run over the whole of it. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrPatches WrPatches;
typedef struct WrSurfacePoint WrSurfacePoint;

/* Row j of the heights, from the top (v = 1), finite: in room [w], or wherever it is. */
typedef const float *WrTerrainRow(const void *ctx, int j, float *room);

typedef struct WrTerrain {
    WrTerrainRow *row; /* NULL: ctx is const float [h][w], the upper row first */
    const void *ctx;   /* borrowed */
    int w, h;
    double a, b, height; /* height: of 1 */
    int cells;           /* along the longer of a and b; 2..64 */
} WrTerrain;

/* The caller frees *points (wr_free): *columns x *rows patches of 48 numbers, a row after the other from v = 0. Heights
 * are means over a cell's area. Errors: no memory. */
bool wr_terrain_points(const WrTerrain *terrain, float (**points)[48], int *columns, int *rows,
                       WrError *err);
/* The point of a terrain's patches at its own u and v, with all derivatives by these. */
void wr_terrain_at(const WrPatches *set, double u, double v, WrSurfacePoint *out);
