/* triangle_raster.h - visibility of a mesh file by rasterising its triangles.
   Private to the renderer. Each sample stores the number of the nearest triangle; kernels (kern.h, meet) then
   intersect it with the ray. */
#pragma once
#include "render/visibility/uv_raster.h"
#include "surface/triangles.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrPool WrPool;

#define WR_TRIANGLE_BLOCK 64 /* neighbouring triangles, in the mesh's sorted order */
#define WR_TRIANGLE_GROUP 32 /* blocks per group */

/* View-independent bounds of a block. */
typedef struct WrTriangleCone {
    WrVec3 centre; /* of a bounding sphere, the mesh's units */
    double radius;
    WrVec3 axis;         /* unit; the normals of all its faces are within `angle` of it */
    double sine, cosine; /* of that angle; cosine < 0: there is no cone */
} WrTriangleCone;

/* Zero-initialise; fini frees. */
typedef struct WrViewTriangles {
    WrTriangles *source; /* shared; NULL: not prepared */
    WrTriangleCone *cones;
    int32_t block_count, group_count;
    WrViewProjection projection; /* the view of the projection that follows */
    double scale;
    bool cull, whole, coned; /* coned: the cones are computed */
    int32_t *sx, *sy;        /* projected corners, 1/256 samples */
    float *close;
    unsigned char *out;               /* WrVertexPlace */
    WrViewMeshBlock *blocks, *groups; /* x0 > x1: none of it is visible */
} WrViewTriangles;

/* Prepares the mesh for this view, or keeps the last preparation. blocks_apart: blocks that face away are
   skipped (E61). Errors: no memory. */
bool wr_view_triangles_prepare(WrViewTriangles *to, const WrTriangles *source, const WrView *view,
                               bool blocks_apart, WrPool *pool, WrError *err);
void wr_view_triangles_fini(WrViewTriangles *to);
/* Rasterises the triangles on the tile: close, and in u the number of the triangle. Triangles that share an edge
   share its integer positions, so each sample on it has one owner (HC85, HC134, HC135); at equal depths the
   first stays. */
void wr_view_triangles_raster(const WrViewTriangles *from, const WrView *view, WrDepthTile *tile);
/* As wr_view_mesh_box. */
bool wr_view_triangles_box(const WrViewTriangles *from, const WrView *view, const WrDepthTile *tile,
                           double box[4]);
