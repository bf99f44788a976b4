/* uv_raster.h - visibility of curved surfaces: a grid of P(u,v), fine enough for the picture at hand, is
   projected, clipped and rasterised into depth, u, v; Newton's method (kern.h, polish) then makes the
   parameters exact.
   Layer 5, private to the renderer. */
#pragma once
#include "render/visibility/view.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrSparseHits WrSparseHits;
typedef struct WrPool WrPool;

#define WR_MESH_BLOCK 8   /* cells along a block's side */
#define WR_MESH_MOST 2048 /* cells along u, and along v, at most */

typedef struct WrViewMeshBlock { /* bounds of a block's vertices, 1/256 samples */
    int32_t x0, y0, x1, y1;
    bool clipped; /* some vertex is behind the near plane, but not all are: bounds say nothing */
} WrViewMeshBlock;

/* Of a projected vertex. */
typedef enum WrVertexPlace {
    WR_VERTEX_IN,
    WR_VERTEX_OUT, /* beyond the guard band: its triangles need clipping, its place is a bound alone */
    WR_VERTEX_BEHIND /* not before the near plane: it has no place */
} WrVertexPlace;

/* All that projecting asks of a view. */
typedef struct WrViewSight {
    WrVec3 eye, right, up, forward;
    double half_w, half_h, near, grid_w, grid_h, perspective;
} WrViewSight;

WrViewSight wr_view_sight(const WrView *view);

/* Zero-initialise; fini frees. */
typedef struct WrViewMesh {
    WrShape source; /* what the second derivatives were measured on */
    bool measured;
    double uu, uv, vv;  /* largest |Puu|, |Puv|, |Pvv| */
    WrSurfaceKind kind; /* what the points were made for */
    WrShapef shape;
    int mu, mv; /* cells along u and v; 0: nothing yet */
    float *v; /* [mv + 1] of the rows, owned: even, but for those that corners draw to themselves */
    float *x, *y, *z;        /* [(mv + 1)(mu + 1)] kernel units, owned */
    WrViewSight sight;       /* what the rest was projected for */
    int32_t *sx, *sy;        /* projected, 1/256 samples */
    float *close;            /* 1/depth (perspective) or -depth: larger is nearer */
    unsigned char *out;      /* WrVertexPlace */
    WrViewMeshBlock *blocks; /* [blocks_v][blocks_u] */
    int blocks_u, blocks_v;
    WrNewton newton; /* how its guesses are made exact */
} WrViewMesh;

/* A rectangle of samples: nearest depth so far and the parameters there. */
typedef struct WrDepthTile {
    int x, y, w, h; /* samples; w h <= capacity */
    float *close;   /* [h][w]; -FLT_MAX where nothing is */
    float *u, *v;
    /* The grid's samples a pixel; 0: the view's K. Vertices are brought to it from K's, rounded. */
    int k;
    const signed char *shift;  /* [h][w][2], x and y in 1/256 samples; NULL: none is shifted */
    const WrKernels *kernels;  /* that cover it */
    const WrSparseHits *knots; /* that tell some of its samples (sparse_hits.h); or NULL */
    bool untold, deep;         /* ... and not others; of those some go through the depth buffer */
} WrDepthTile;

/* What the scene asks of the mesh. */
typedef struct WrMeshAsk {
    int mesh;   /* WrDials: 2^mesh times as fine */
    int newton; /* steps; or -1: at most two, or three from a coarse mesh: Newton doubles the digits at each, and ends
                   earlier where the tangents stand still */
    double texels;           /* 0, or the step that is short enough; of a table of ... */
    double table_w, table_h; /* ... so many texels along u and v, replication included */
} WrMeshAsk;

/* Make or keep the points and what they are projected to in this view. */
void wr_view_mesh_prepare(WrViewMesh *mesh, const WrShape *shape, const WrView *view,
                          const WrMeshAsk *ask, const WrKernels *kernels, WrPool *pool);
void wr_view_mesh_fini(WrViewMesh *mesh);
/* Rasterise what falls on the tile. Watertight: neighbouring cells share edges in whole numbers with a
   top-left rule (HC85); of equal depths the first cell stays. Only what the tile's knots do not tell. */
void wr_view_mesh_raster(const WrViewMesh *mesh, const WrView *view, WrDepthTile *tile);
/* Samples of the view's grid, x0, y0, x1, y1, beyond which nothing of the mesh that meets the tile lies; false where
   nothing does. */
bool wr_view_mesh_box(const WrViewMesh *mesh, const WrView *view, const WrDepthTile *tile,
                      double box[4]);
