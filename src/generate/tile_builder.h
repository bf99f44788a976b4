/* tile_builder.h - a relief made tile by tile on the pool's threads.
   Private to this module. */
#pragma once
#include "generate/generator.h"

#include <stdbool.h>

/* A rectangle of a table of width x height texels, in one tile or smaller. */
typedef struct WrGenerateBlock {
    int width, height;
    int i, j, count_i, count_j; /* counts 1..WR_TILE */
} WrGenerateBlock;

/* Make the heights of a block, [count_j][WR_TILE] rows from the top. cover: the same for what it says
 * something about, NULL where the relief has none. Heights may pass float's range: they are brought back
 * into it, and not a number becomes 0. worker as in WrPiece. Any thread; what comes out may depend on
 * nothing but ctx and the texel's place. */
typedef void (*WrGenerateFill)(const void *ctx, const WrGenerateBlock *block, int worker,
                               float *heights, float *cover);

/* Make a whole relief.
 *
 * job      its `like` lends size and edges
 * covered  with coverage
 * from     what part of the whole work came before, 0..1, for reports
 * Errors   no memory; "cancelled"
 * Tiles of equal heights throughout are kept as the level where it is 0. */
bool wr_generate_build(const WrGenerateJob *job, WrGenerateFill fill, const void *ctx, bool covered,
                       double from, WrNormalMips *out, WrError *err);

/* What a generator has to say besides; fine without a listener. */
void wr_generate_note(const WrGenerateJob *job, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
