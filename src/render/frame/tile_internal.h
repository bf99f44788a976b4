/* tile_internal.h - functions shared by tiles of one object and tiles of several.
   Private to tile.c and tile_multi_object.c. */
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
/* Encodes a row of premultiplied colours, [width][4], into the picture's codes. */
void wr_tile_code_row(const WrTileJob *job, int x, int y, int width, const float *rgba,
                      WrTileScratch *scratch);

/* Writes the background of a row that is stored once, except its samples [from, to). */
void wr_tile_behind_strip(const WrTileJob *job, const WrSink *sink, int from, int to,
                          WrTileScratch *scratch);
/* Draws all samples of a tile in the grid of k x k samples a pixel. */
void wr_tile_samples(const WrTileJob *job, int k, const WrDepthTile *tile, const WrTileRows *out,
                     WrTileScratch *scratch);
/* The part of the tile that the object may cover; w or h 0: none. */
WrTilePart wr_tile_touched(const WrTileJob *job, WrTilePart part);
/* Sets the cost bits that every pixel of the tile has, whatever it shows. */
void wr_tile_start_map(const WrTileJob *job, WrTilePart whole, WrTileScratch *scratch);
/* Clears the tile; of codes only those beside `part`, because each is written once. */
void wr_tile_clear(const WrTileJob *job, WrTilePart whole, WrTilePart part);
/* Depth in front of the whole object: anything nearer hides all of it (E52). */
float wr_tile_hidden_from(const WrTileJob *job);
/* wr_tile_apart: a job that renders to the tile's own floats. wr_tile_code: encodes those floats to the picture. */
WrTileJob wr_tile_apart(const WrTileJob *job, WrTilePart part, WrTileScratch *scratch);
void wr_tile_code(const WrTileJob *apart, WrTilePart part, WrTileScratch *scratch);
/* Means of a row of `width` pixels, from k rows of samples `step` floats apart, which are overwritten. Returns
   the number of covered pixels. */
int wr_tile_means(int k, int width, float *sample, size_t step, float *pixel);
