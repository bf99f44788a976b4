/* triangle_raster.h - visibility of a mesh out of a file: its triangles are projected and rasterised, each sample keeps the
   number of the one that is nearest; kernels (kern.h, meet) then work out where the ray meets it.
   Layer 5, private to the renderer. */
#pragma once
#include "render/visibility/uv_raster.h"
#include "surface/triangles.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrPool WrPool;

#define WR_TRIANGLE_BLOCK 64 /* triangles that lie beside each other, as the mesh sorts them */
#define WR_TRIANGLE_GROUP 32 /* blocks of a group */

/* Of a block: what does not change with the view. */
typedef struct WrTriangleCone {
    WrVec3 centre; /* of a ball that holds it, the mesh's units */
    double radius;
    WrVec3 axis;         /* unit; all its faces' normals are within `angle` of it */
    double sine, cosine; /* of that angle; cosine < 0: none is kept */
} WrTriangleCone;

/* Zero-initialise; fini frees. */
typedef struct WrViewTriangles {
    WrTriangles *source; /* shared; NULL: nothing yet */
    WrTriangleCone *cones;
    int32_t block_count, group_count;
    WrViewSight sight; /* what the rest was projected for */
    double scale;
    bool cull, whole, coned; /* coned: the cones are made */
    int32_t *sx, *sy;        /* corners, projected, 1/256 samples */
    float *close;
    unsigned char *out;               /* WrVertexPlace */
    WrViewMeshBlock *blocks, *groups; /* x0 > x1: nothing of it is seen */
} WrViewTriangles;

/* Make or keep what the mesh comes to in this view. blocks_apart: blocks that look away are left out (E61). Errors: no
 * memory. */
bool wr_view_triangles_prepare(WrViewTriangles *to, const WrTriangles *source, const WrView *view,
                               bool blocks_apart, WrPool *pool, WrError *err);
void wr_view_triangles_fini(WrViewTriangles *to);
/* Rasterise what falls on the tile: close, and in u the number of the triangle. Triangles that share an edge share its
 * whole numbers, so each sample on it has one owner (HC85, HC134, HC135); of equal depths the first stays. */
void wr_view_triangles_raster(const WrViewTriangles *from, const WrView *view, WrDepthTile *tile);
/* As wr_view_mesh_box. */
bool wr_view_triangles_box(const WrViewTriangles *from, const WrView *view, const WrDepthTile *tile,
                           double box[4]);
