/* tile_internal.h - what a tile of one object and one of several do alike.
   Layer 5, private to tile.c, tile_multi_object.c. */
#pragma once
#include "render/frame/tile.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Where the rows of a tile go. */
typedef struct WrTileRows {
    float *rgba, *normals; /* of the first row; NULL: not wanted */
    size_t rgba_step;      /* floats a row */
    size_t wide;           /* samples a row of the normals */
    uint32_t *codes;
    size_t codes_step;
    WrNearest *nearest;
    size_t nearest_step;
    bool over; /* other objects have been drawn there, or will be */
} WrTileRows;

/* What lies behind a pixel of the picture; only where codes are wanted. */
static inline const WrBehind *wr_tile_behind(const WrTileJob *job, int x, int y)
{
    return wr_backdrop_at(job->backdrop, x, y - job->top);
}
/* A row of premultiplied colours, [width][4], to the picture's codes. */
void wr_tile_code_row(const WrTileJob *job, int x, int y, int width, const float *rgba,
                      WrTileScratch *scratch);

/* What lies behind a row that is stored once, but for its samples [from, to). */
void wr_tile_behind_strip(const WrTileJob *job, const WrSink *sink, int from, int to,
                          WrTileScratch *scratch);
/* All samples of a tile of the grid of k a pixel. */
void wr_tile_samples(const WrTileJob *job, int k, const WrDepthTile *tile, const WrTileRows *out,
                     WrTileScratch *scratch);
/* The part of it that the object may be on; w or h 0: none. */
WrTilePart wr_tile_touched(const WrTileJob *job, WrTilePart part);
/* What all of the tile takes whatever it shows, into its map. */
void wr_tile_start_map(const WrTileJob *job, WrTilePart whole, WrTileScratch *scratch);
/* Nothing anywhere on the tile yet; of codes those beside `part` alone, which are written once. */
void wr_tile_clear(const WrTileJob *job, WrTilePart whole, WrTilePart part);
/* What is nearer than that hides all of the object (E52). */
float wr_tile_hidden_from(const WrTileJob *job);
/* As the job, but into the tile's own floats; then they become codes. */
WrTileJob wr_tile_apart(const WrTileJob *job, WrTilePart part, WrTileScratch *scratch);
void wr_tile_code(const WrTileJob *apart, WrTilePart part, WrTileScratch *scratch);
/* The means of a row of `width` pixels, from k rows of samples at `step` floats, which are overwritten. How many are
   covered. */
int wr_tile_means(int k, int width, float *sample, size_t step, float *pixel);
