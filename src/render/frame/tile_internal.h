/* tile_internal.h - functions shared by tiles of one object and tiles of several. Private to the renderer. */
#pragma once
#include "render/frame/tile.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Destination of a tile's rows. */
typedef struct WrTileRows {
    float *rgba, *normals; /* first row; NULL: not requested */
    size_t rgba_step;      /* floats per row */
    size_t wide;           /* samples per row of the normals */
    uint32_t *codes;
    size_t codes_step;
    WrNearest *nearest;
    size_t nearest_step;
    bool over; /* other objects are drawn there too, before or after */
} WrTileRows;

/* Background of a pixel of the picture; only for codes. */
static inline const WrBehind *wr_tile_behind(const WrTileJob *job, int x, int y)
{
    return wr_backdrop_at(job->backdrop, x, y - job->top);
}

/* Writes the background of a row that is stored once, except its samples [from, to). */
void wr_tile_behind_strip(const WrTileJob *job, const WrSink *sink, int from, int to,
                          WrTileScratch *scratch);
/* The part of the tile that the object may cover; w or h 0: none. */
WrTilePart wr_tile_touched(const WrTileJob *job, WrTilePart part);
/* Depth in front of the whole object: anything nearer hides all of it (E52). */
float wr_tile_hidden_from(const WrTileJob *job);
