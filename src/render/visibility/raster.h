/* raster.h - visibility by rasterising: curved surfaces by a mesh of (u,v), mesh files, triangles into a tile. Private to the
   renderer. */
#pragma once
#include "render/visibility/view.h"
#include "surface/triangles.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrTileJob WrTileJob;

/* ---- curved surfaces ---- */

typedef struct WrPool WrPool;

#define WR_MESH_BLOCK 8  /* cells along a block's side */
#define WR_MESH_MAX 2048 /* maximum cells along u, and along v */

typedef struct WrViewMeshBlock { /* bounds of a block's vertices, 1/256 samples */
    int32_t x0, y0, x1, y1;
    bool clipped; /* some vertices are behind the near plane, but not all: the bounds are unknown */
} WrViewMeshBlock;

/* State of a projected vertex. */
typedef enum WrVertexPlace {
    WR_VERTEX_IN,
    /* outside the guard band: its triangles need clipping, its position is only a bound */
    WR_VERTEX_OUT,
    WR_VERTEX_BEHIND /* not beyond the near plane: it has no position */
} WrVertexPlace;

/* All parts of a view that projection depends on. */
typedef struct WrViewProjection {
    WrVec3 eye, right, up, forward;
    double half_w, half_h, near, grid_w, grid_h, perspective;
} WrViewProjection;

WrViewProjection wr_view_projection(const WrView *view);

/* Zero-initialise; fini frees. */
typedef struct WrViewMesh {
    WrShape source; /* the shape whose second derivatives were measured */
    bool measured;
    double uu, uv, vv;  /* largest |Puu|, |Puv|, |Pvv| */
    WrSurfaceKind kind; /* surface of the points */
    WrShapef shape;
    int mu, mv; /* cells along u and v; 0: not built */
    float *v;   /* [mv + 1] of the rows, owned: evenly spaced, except those moved to corners */
    float *x, *y, *z;            /* [(mv + 1)(mu + 1)] kernel units, owned */
    WrViewProjection projection; /* the view of the projection that follows */
    int32_t *sx, *sy;            /* projected, 1/256 samples */
    float *close;                /* 1/depth (perspective) or -depth: larger is nearer */
    unsigned char *out;          /* WrVertexPlace */
    WrViewMeshBlock *blocks;     /* [blocks_v][blocks_u] */
    int blocks_u, blocks_v;
    WrNewton newton; /* parameters of Newton's method for its start values */
} WrViewMesh;

/* A rectangle of samples: nearest depth so far and the parameters there. */
typedef struct WrDepthTile {
    int x, y, w, h; /* samples; w h <= capacity */
    float *close;   /* [h][w]; -FLT_MAX where empty */
    float *u, *v;
    /* Samples a pixel of the grid; 0: the view's K. Vertices are converted to it from K's grid, rounded. */
    int k;
    const signed char *shift; /* [h][w][2], x and y in 1/256 samples; NULL: no offsets */
    const WrKernels *kernels; /* kernels that cover it */
} WrDepthTile;

/* Mesh settings of a scene. */
typedef struct WrMeshRequest {
    int mesh; /* WrDials: 2^mesh times as fine */
    /* steps; or -1: at most two, or three from a coarse mesh (Newton's method doubles the digits at each step),
       fewer if the tangents no longer change */
    int newton;
    double texels;           /* 0, or the largest step in texels, of a table of ... */
    double table_w, table_h; /* ... this many texels along u and v, replication included */
} WrMeshRequest;

/* Builds the points and projects them for this view, or keeps the last ones. */
void wr_view_mesh_prepare(WrViewMesh *mesh, const WrShape *shape, const WrView *view,
                          const WrMeshRequest *ask, const WrKernels *kernels, WrPool *pool);
void wr_view_mesh_fini(WrViewMesh *mesh);
/* Rasterises the mesh on the tile. Watertight: neighbouring cells share edges in whole numbers with a top-left
   rule (HC85); at equal depths the first cell stays. */
void wr_view_mesh_raster(const WrViewMesh *mesh, const WrView *view, WrDepthTile *tile);
/* Box of grid samples, x0, y0, x1, y1, that contains everything of the mesh on the tile; false if there is
   nothing. */
bool wr_view_mesh_box(const WrViewMesh *mesh, const WrView *view, const WrDepthTile *tile,
                      double box[4]);

/* ---- mesh files ---- */

/* Visibility of a mesh file by rasterising its triangles.
   Private to the renderer. Each sample stores the number of the nearest triangle; kernels (kern.h, meet) then
   intersect it with the ray. */

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

/* ---- triangles into a tile ---- */

/* Triangle rasteriser into a tile of depth, u, v: projection, clipping, integer edge functions.
   Private to the renderer. */

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

/* Projects a vertex. False if it is in front of the near plane or more than WR_GUARD views outside: then `out`
   contains zeros and the triangle has to be clipped. */
#define WR_GUARD 2.0
/* Projects a row of points x, y, z [count] into arrays of that length, with positions and closeness as in
   WrViewMesh. */
typedef struct WrRasterRow {
    int32_t *x, *y;
    float *close;
    unsigned char *out; /* WrVertexPlace */
} WrRasterRow;
void wr_raster_triangle(const WrView *view, WrRasterVertex a, WrRasterVertex b, WrRasterVertex c,
                        WrDepthTile *tile);

/* A tile's rectangle in 1/256 samples of the view's grid, enlarged by the reach of a triangle. */
typedef struct WrRasterBounds {
    int64_t x0, y0, x1, y1;
} WrRasterBounds;

/* ---- silhouette tests that need no samples ---- */

/* True if pixel (x, y), whose centre is empty, is certainly empty. For planes, cubes and spheres. */
bool wr_outline_misses(const WrTileJob *job, double x, double y);

/* Corners of the outline, which may lie between all samples: the corners of planar faces and of patches, in
   1/256 samples. Returns their number. */
#define WR_OUTLINE_TIPS 24
int wr_outline_tips(const WrTileJob *job, WrRasterVertex tips[WR_OUTLINE_TIPS]);
