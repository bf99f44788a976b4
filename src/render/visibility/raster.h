/* raster.h - triangle rasteriser into a tile of depth, u, v: projection, clipping, integer edge functions.
   Private to the renderer. */
#pragma once
#include "render/frame/tile.h"
#include "render/visibility/uv_raster.h"

#include <stdbool.h>
#include <stdint.h>

/* A projected vertex. */
typedef struct WrRasterVertex {
    int32_t x, y; /* 1/256 samples */
    float close;  /* 1/depth (perspective) or -depth */
    float u, v;
} WrRasterVertex;

/* A vertex before projection: camera axes in kernel units, depth along the view. */
typedef struct WrClipVertex {
    double x, y, depth, u, v;
} WrClipVertex;

WrClipVertex wr_raster_camera_vertex(const WrView *view, WrVec3 p, double u, double v);
/* Projects a vertex. False if it is in front of the near plane or more than WR_GUARD views outside: then `out`
   contains zeros and the triangle has to be clipped. */
#define WR_GUARD 2.0
bool wr_raster_project(const WrView *view, WrVec3 p, double u, double v, WrRasterVertex *out);
/* Position of a vertex outside the guard band, 1/256 samples, clamped to 2^30; false if it is not beyond the
   near plane. */
bool wr_raster_bound(const WrView *view, WrVec3 p, int32_t *x, int32_t *y);
/* Projects a row of points x, y, z [count] into arrays of that length, with positions and closeness as in
   WrViewMesh. */
typedef struct WrRasterRow {
    int32_t *x, *y;
    float *close;
    unsigned char *out; /* WrVertexPlace */
} WrRasterRow;
void wr_raster_project_row(const WrView *view, int count, const float *x, const float *y,
                           const float *z, const WrRasterRow *row);
void wr_raster_triangle(const WrView *view, WrRasterVertex a, WrRasterVertex b, WrRasterVertex c,
                        WrDepthTile *tile);
/* Clips against the near plane and the guard band, before any division (HC82, HC83), and rasterises. */
void wr_raster_clipped(const WrView *view, const WrClipVertex corner[3], WrDepthTile *tile);
/* Rasterise triangles whose samples get u = `mark` and v = 0; the second one clips first. */
void wr_raster_marked(const WrView *view, const WrRasterVertex corner[3], float mark,
                      WrDepthTile *tile);
void wr_raster_clipped_marked(const WrView *view, const WrClipVertex corner[3], float mark,
                              WrDepthTile *tile);

/* A tile's rectangle in 1/256 samples of the view's grid, enlarged by the reach of a triangle. */
typedef struct WrRasterBounds {
    int64_t x0, y0, x1, y1;
} WrRasterBounds;
WrRasterBounds wr_raster_bounds(const WrDepthTile *tile, int samples);
bool wr_raster_meets(const WrViewMeshBlock *block, const WrRasterBounds *tile);

/* ---- silhouette tests that need no samples ---- */

/* True if pixel (x, y), whose centre is empty, is certainly empty. For planes, cubes and spheres. */
bool wr_outline_misses(const WrTileJob *job, double x, double y);

/* Corners of the outline, which may lie between all samples: the corners of planar faces and of patches, in
   1/256 samples. Returns their number. */
#define WR_OUTLINE_TIPS 24
int wr_outline_tips(const WrTileJob *job, WrRasterVertex tips[WR_OUTLINE_TIPS]);
