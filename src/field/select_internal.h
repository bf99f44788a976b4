/* select_internal.h - internals shared by the selection files.
   Private to select*.c; also used by ramp.c to build its table. */
#pragma once
#include "field/select.h"

#include <stdbool.h>
#include <stdint.h>

/* Computes rows j .. j + rows - 1 of a selection: out [rows][width], filled with the level. False when
 * out of memory. worker: 0..threads-1, for scratch space. */
typedef bool (*WrSelectRows)(void *ctx, int worker, int j, int rows, float *out);

/* A table like `like`, at `level`, with rows by `make`, which runs on the pool's threads with at most
 * WR_TILE rows at a time. Tiles equal to the level stay NULL. NULL and "cancelled" if progress, which
 * may be NULL, is cancelled. */
WrField *wr_select_from_rows(const WrField *like, float level, WrSelectRows make, void *ctx,
                             WrPool *pool, const WrProgress *progress, WrError *err);

/* Coordinates of shapes are integers in 1/65536 texel, x to the right, y down, from the table's top
   left corner: sums and differences are exact, so a roll by whole texels changes no bit. */
#define WR_SUB_BITS 16
#define WR_SUB (1 << WR_SUB_BITS)

typedef struct WrSelectVertex {
    int64_t x, y; /* |x|, |y| < 2^38 */
} WrSelectVertex;
