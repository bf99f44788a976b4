/* uv_tiles.h - UDIM tiles of a mesh: which triangles lie on which unit squares of (u,v) (base/udim.h).

   A triangle lies on each tile with which it shares an area; one within 1e-5 of a tile's edges does not cross them.
   Triangles without texture coordinates lie on none, nor do those over more than 100 tiles, which repeat a texture. */
#pragma once
#include "base/udim.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrText WrText;
typedef struct WrTriangles WrTriangles;

typedef struct WrUvTiles {
    int32_t *triangles; /* [WR_UDIM_COUNT] number of triangles on tile WR_UDIM_FIRST + i; owned */
    int count;          /* tiles with triangles */
    int32_t crossing;   /* triangles on several tiles */
    int32_t outside;    /* triangles that reach beyond UDIM: u below 0 or above 10, v below 0 ... */
} WrUvTiles;

WrUvTiles wr_uv_tiles(const WrTriangles *mesh);
void wr_uv_tiles_fini(WrUvTiles *tiles);
/* The numbers in rising order, up to `most`; returns how many were stored. */
int wr_uv_tiles_numbers(const WrUvTiles *tiles, int *numbers, int most);
/* The numbers, each with its triangles: "1001 (12), 1002 (8)" */
void wr_uv_tiles_print(const WrUvTiles *tiles, WrText *text);

/* The mesh with the texture coordinates of one tile: triangles that are not on it have none, in parts of their own
 * with the same names. Errors: no triangle lies there, too many parts, out of memory. */
WrTriangles *wr_triangles_of_tile(const WrTriangles *mesh, int number, WrError *err);
