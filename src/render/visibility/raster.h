/* raster.h - triangles into a tile of depth, u, v: projection, clipping, edge functions in whole
   numbers.
   Layer 5, private to the renderer. */
#pragma once
#include "render/visibility/uv_raster.h"

#include <stdbool.h>
#include <stdint.h>

/* A projected vertex. */
typedef struct WrRasterVertex {
    int32_t x, y; /* 1/256 samples */
    float close;  /* 1/depth or -depth */
    float u, v;
} WrRasterVertex;

/* A vertex before projection: camera axes in kernel units, depth along the view. */
typedef struct WrClipVertex {
    double x, y, depth, u, v;
} WrClipVertex;

WrClipVertex wr_raster_clip_vertex(const WrView *view, WrVec3 p, double u, double v);
/* False if the vertex lies before the near plane or more than WR_GUARD views outside: then `out` holds
   zeros and the triangle has to be clipped. */
#define WR_GUARD 2.0
bool wr_raster_project(const WrView *view, WrVec3 p, double u, double v, WrRasterVertex *out);
/* Where a vertex beyond the guard band lies, 1/256 samples, to 2^30 of them; false where it is not before the near plane. */
bool wr_raster_bound(const WrView *view, WrVec3 p, int32_t *x, int32_t *y);
/* The same of a row of points x, y, z [count], into arrays of as many: places and closeness as in WrViewMesh. */
typedef struct WrRasterRow {
    int32_t *x, *y;
    float *close;
    unsigned char *out; /* WrVertexPlace */
} WrRasterRow;
void wr_raster_project_row(const WrView *view, int count, const float *x, const float *y,
                           const float *z, const WrRasterRow *row);
void wr_raster_triangle(const WrView *view, WrRasterVertex a, WrRasterVertex b, WrRasterVertex c,
                        WrDepthTile *tile);
/* Clip against the near plane and the guard band, before any division (HC82, HC83). */
void wr_raster_clipped(const WrView *view, const WrClipVertex corner[3], WrDepthTile *tile);
/* The same of triangles whose samples get `mark` for u, and 0 for v. */
void wr_raster_marked(const WrView *view, const WrRasterVertex corner[3], float mark,
                      WrDepthTile *tile);
void wr_raster_clipped_marked(const WrView *view, const WrClipVertex corner[3], float mark,
                              WrDepthTile *tile);

/* A tile's rectangle in 1/256 samples of the view's grid, as far as a triangle may reach into it. */
typedef struct WrRasterBounds {
    int64_t x0, y0, x1, y1;
} WrRasterBounds;
WrRasterBounds wr_raster_bounds(const WrDepthTile *tile, int samples);
bool wr_raster_meets(const WrViewMeshBlock *block, const WrRasterBounds *tile);
