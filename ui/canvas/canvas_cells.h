/* canvas_cells.h - a table's tiles at the resolution that the canvas needs, and how the canvas's pixels
   weigh them. Level L holds means over 2^L x 2^L texels, made tile by tile when first looked at. */
#pragma once
#include "field/field.h"

#include <stdbool.h>

#define WR_CELL_LEVEL_MAX 6 /* one value a tile */

typedef struct WrCanvasCells WrCanvasCells;

WrCanvasCells *wr_cells_new(void);
void wr_cells_free(WrCanvasCells *cells);

/* Look at `field` (shared, kept until the next call) at `level`. Blocks of tiles that did not change are
 * kept; changed(tx, ty, ctx) is called for each tile that may have. Returns false, without calls, when
 * everything may be different (another size or level). */
bool wr_cells_look(WrCanvasCells *cells, const WrField *field, int level, WrTileVisitor changed,
                   void *ctx);

/* The block of a tile: [side * side] means, side = 64 >> level, row by row; NULL where the whole tile
 * holds *flat. Blocks not made before `deadline` (wr_clock_seconds) are rough: single texels instead of
 * means; wr_cells_rough then says that looking again would be better. Valid until the next look. */
const float *wr_cells_block(WrCanvasCells *cells, int tx, int ty, double deadline, float *flat);
bool wr_cells_rough(const WrCanvasCells *cells);
void wr_cells_forget_rough(WrCanvasCells *cells); /* before looking again */

/* Smallest and largest height of the field, from tiles that changed since it was last asked. */
void wr_cells_range(WrCanvasCells *cells, float *low, float *high);

/* How one row or column of pixels weighs cells: the exact box filter over the pixel's footprint. */
#define WR_TAPS 4
typedef struct WrCellTaps {
    int cell[WR_TAPS];     /* unused ones: the first, weight 0 */
    float weight[WR_TAPS]; /* sum 1 */
    bool outside;          /* beyond the edge of an axis that does not repeat */
} WrCellTaps;

/* The taps of the pixel that covers texels [from, to) of an axis of `size` texels at `level`; from and
 * to are unwrapped. */
WrCellTaps wr_taps_make(double from, double to, int size, int level, bool repeats);
/* The level at which a cell is half a pixel to one pixel: 0 from zoom 1/2 up. */
int wr_cells_level(double zoom);
