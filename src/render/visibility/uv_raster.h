/* uv_raster.h - visibility of curved surfaces by rasterising (u,v) from a view-dependent mesh. Private to the
   renderer. A grid of P(u,v), fine enough for the picture, is projected, clipped and rasterised into depth, u,
   v. Newton's method (kern.h, polish) then refines the parameters. */
#pragma once
#include "render/visibility/view.h"

#include <stdbool.h>
#include <stdint.h>

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
