/* tile_builder.h - parallel construction of a relief, tile by tile on the pool's threads.
   Private to this module. */
#pragma once
#include "generate/generator.h"

#include <stdbool.h>

/* A rectangle of a table of width x height texels, in one tile or smaller. */
typedef struct WrGenerateBlock {
    int width, height;
    int i, j, count_i, count_j; /* counts 1..WR_TILE */
} WrGenerateBlock;

/* Computes the heights of a block, [count_j][WR_TILE] rows from the top. cover: the coverage in the
 * same layout, NULL if the relief has none. Heights beyond float's range are clamped, and NaN becomes
 * 0. worker as in WrPiece. Any thread; the output must depend only on ctx and the texel's position. */
typedef void (*WrGenerateFill)(const void *ctx, const WrGenerateBlock *block, int worker,
                               float *heights, float *cover);

/* Builds a whole relief.
 *
 * job      its `like` defines size and edges
 * covered  with coverage
 * from     fraction 0..1 of the whole work done before, for reports
 * Errors   out of memory; "cancelled" Tiles that are 0 throughout are represented by the level. */
bool wr_generate_build(const WrGenerateJob *job, WrGenerateFill fill, const void *ctx, bool covered,
                       double from, WrRelief *out, WrError *err);

/* Adds a remark of a generator; ignored without a listener. */
void wr_generate_note(const WrGenerateJob *job, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
