/* footprint_scan.h - scan conversion of a shape to runs of texels, tile by tile.
   Private to this module. */
#pragma once
#include "brush/footprint.h"
#include "field/wrap.h"

#include <stdbool.h>

/* A run of texels of one row of a tile, widened to whole blocks. If the brush is as large as the table,
 * the texels at its ends, and those beyond the table's edge, must get no coverage. */
typedef struct WrRun {
    int y, x;       /* unwrapped row; unwrapped column of the first block's first texel */
    int at, count;  /* position in the tile, texels: whole blocks */
    int head, tail; /* texels at the blocks' ends without coverage */
} WrRun;

/* The part of a shape in one tile. */
typedef struct WrScanPatch {
    int tx, ty, count;
    WrRun runs[WR_TILE];
} WrScanPatch;

/* One axis's range of texels, not wrapped. */
typedef struct WrWindow {
    int low, high;
} WrWindow;

/* The texels of one axis that a shape from p to p + d may reach with radius r: on a periodic axis at
 * most one period if d is 0, on a clamped one only existing texels. */
WrWindow wr_window(double p, double d, double r, int n, WrWrap wrap);

/* Number of texels from unwrapped index i to `last` in one tile; *texel is i in the table. */
int wr_tile_run(int i, int last, int n, int *texel);

/* Calls visit for every tile that the shape reaches; each texel is in at most one run if the shape is
 * no motion. pool: several threads may visit tiles if there are many; NULL: sequentially. prepare, if
 * not NULL, is called before for each tile on this thread; false skips the tile. */
typedef bool (*WrPrepare)(void *ctx, int tx, int ty);
typedef void (*WrVisit)(void *ctx, const WrDabShape *shape, const WrScanPatch *patch);
void wr_scan(const WrField *field, const WrDabShape *shape, WrPool *pool, WrPrepare prepare,
             WrVisit visit, void *ctx);

/* An upper bound of a shape's coverage in the tile whose first texel lies at (x, y), not wrapped. */
typedef float (*WrBound)(const WrDabShape *shape, double x, double y);
/* The same for several shapes [count], tile by tile, each tile on one thread. The shapes of a tile are visited from the largest
 * bound down, and not if it is 0; without bound (NULL) in their order. prepare is called once for a tile. */
void wr_scan_together(const WrField *field, const WrDabShape *shapes, int count, WrPool *pool,
                      WrPrepare prepare, WrVisit visit, WrBound bound, void *ctx);

/* The coverage of a run: wr_shape_row with head and tail cleared. */
void wr_run_cover(const WrDabShape *shape, const WrRun *run, float *fresh);
