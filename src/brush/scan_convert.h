/* scan_convert.h - a shape cut into runs of texels, tile by tile.
   Private to this module. */
#pragma once
#include "brush/shape.h"
#include "field/wrap.h"

#include <stdbool.h>

/* A run of texels of one row of a tile, widened to whole blocks. Where the brush is as large as the
 * table the texels at its ends, and at the table's edge those beyond, must get no coverage. */
typedef struct WrRun {
    int y, x;       /* unwrapped row; unwrapped column of the first block's first texel */
    int at, count;  /* place in the tile, texels: whole blocks */
    int head, tail; /* texels at the blocks' ends that get none */
} WrRun;

/* What of a shape lies in one tile. */
typedef struct WrScanPatch {
    int tx, ty, count;
    WrRun runs[WR_TILE];
} WrScanPatch;

/* One axis's range of texels, not wrapped. */
typedef struct WrWindow {
    int low, high;
} WrWindow;

/* The texels of one axis that a shape from p to p + d may reach with radius r: on a periodic axis at most
 * one period of it where d is 0, on a clamped one those that are there. */
WrWindow wr_window(double p, double d, double r, int n, WrWrap wrap);

/* How many texels from unwrapped index i to `last` lie in one tile; *texel is i in the table. */
int wr_tile_run(int i, int last, int n, int *texel);

/* Call visit for every tile that the shape reaches; each texel is in at most one run if the shape is no
 * motion. pool: tiles may be visited by several threads at once where there are many; NULL: one after
 * the other. prepare, if not NULL, is called for each tile before, on this thread; false leaves it out. */
typedef bool (*WrPrepare)(void *ctx, int tx, int ty);
typedef void (*WrVisit)(void *ctx, const WrDabShape *shape, const WrScanPatch *patch);
void wr_scan(const WrField *field, const WrDabShape *shape, WrPool *pool, WrPrepare prepare,
             WrVisit visit, void *ctx);

/* The coverage of a run: wr_shape_row with head and tail cleared. */
void wr_run_cover(const WrDabShape *shape, const WrRun *run, float *fresh);
