/* canvas_mips.h - mip levels of a table's tiles for the canvas, and filter weights of the canvas's pixels. Level L
   holds means over 2^L x 2^L texels, computed per tile on first use. */
#pragma once
#include "field/field.h"

#include <stdbool.h>

#define WR_CANVAS_MIPS_LEVEL_MAX 6 /* one value per tile */

typedef struct WrCanvasMips WrCanvasMips;
typedef struct WrPool WrPool;

WrCanvasMips *wr_canvas_mips_new(void);
void wr_canvas_mips_free(WrCanvasMips *cells);

/* Update to `field` (shared, kept until the next call) at `level`. Blocks of unchanged tiles are kept; changed(tx,
 * ty, ctx) is called for each tile that may have changed. Returns false, without calls, if everything may have
 * changed (another size or level). */
bool wr_canvas_mips_update(WrCanvasMips *cells, const WrField *field, int level,
                           WrTileVisitor changed, void *ctx);

/* The block of a tile: [side * side] means, side = 64 >> level, row by row; NULL if the whole tile holds *flat.
 * Blocks not computed before `deadline` (wr_clock_seconds) are rough: single texels instead of means; wr_canvas_mips_rough
 * then returns true, and another update would improve them. Valid until the next update. */
const float *wr_canvas_mips_block(WrCanvasMips *cells, int tx, int ty, double deadline,
                                  float *flat);
bool wr_canvas_mips_rough(const WrCanvasMips *cells);
void wr_canvas_mips_forget_rough(WrCanvasMips *cells); /* before the next update */

/* wr_canvas_mips_block of all tiles in the marked columns [tiles_u] and rows [tiles_v], on the threads of `pool` (NULL: this
 * one). Several threads may then call wr_canvas_mips_block for them with a deadline in the past. */
void wr_canvas_mips_prepare(WrCanvasMips *cells, const bool *columns, const bool *rows,
                            double deadline, WrPool *pool);

/* Smallest and largest height of the field; only tiles changed since the last call are read, once for their range and for
 * the means of all levels from 2. pool: for many tiles; NULL: this thread. */
void wr_canvas_mips_range(WrCanvasMips *cells, WrPool *pool, float *low, float *high);

/* Weights of the cells under one row or column of pixels: the exact box filter over the pixel's footprint. */
#define WR_TAPS 4
typedef struct WrCellTaps {
    int cell[WR_TAPS];     /* unused ones: the first cell with weight 0 */
    float weight[WR_TAPS]; /* sum 1 */
    bool outside;          /* beyond the edge of a clamped axis */
} WrCellTaps;

/* The taps of a pixel that covers texels [from, to) of an axis of `size` texels at `level`; from and to are
 * unwrapped. */
WrCellTaps wr_taps_make(double from, double to, int size, int level, bool repeats);
/* The level at which a cell is half a pixel to one pixel; 0 from zoom 1/2 up. */
int wr_canvas_mips_level(double zoom);
