/* sparse_hits.h - grid of ray hits at every eighth sample, from which (u,v) of the samples between are
   interpolated. Private to the renderer. Only for fast arithmetic, where a view sees a single sheet of a mesh
   (uv_raster.h), and without depth buffer.

   A hit at every eighth sample of rows and columns is solved by Newton's method. The samples between start
   Newton's method from the bicubic through sixteen hits, which is a thousand times closer than the mesh's
   triangles.

   A block of 8 x 8 samples certainly shows one sheet if one triangle covers its hit and no edge crosses it at
   which the number of triangles that cover a point can change: an edge on the border of the surface, or one
   where the surface turns towards or away from the viewer. All other blocks use the depth buffer, as all samples
   do without sparse hits; so outlines are equal.

   Where patches and rings are so even that the bicubic is within 1/256 of a sample, by their fourth differences,
   samples are not solved at all: P, Pu and Pv are interpolated too. */
#pragma once
#include "render/simd/simd_kernels.h"
#include "render/visibility/uv_raster.h"

#include <stdbool.h>

typedef struct WrPool WrPool;

#define WR_KNOT 8               /* samples from hit to hit */
#define WR_SPARSE_HITS_AROUND 2 /* hits beyond the samples that their blocks depend on */

/* Everything that sparse hits depend on. */
typedef struct WrSparseHitsKey {
    WrViewSight sight;
    WrShapef shape;
    WrNewton newton;
    int mu, mv, grid_w; /* mesh cells; samples per row */
    int first, rows;    /* requested samples of the grid, from row `first` on */
    bool cull;
    const WrKernels *kernels;
} WrSparseHitsKey;

/* Zero-initialise; fini frees. */
typedef struct WrSparseHits {
    WrSparseHitsKey key;
    bool known;            /* all contents belong to that key */
    int top, across, down; /* in hits: position of the first row, and the counts */
    /* [WR_KNOT_NUMBERS][down][across]: u, v, P, Pu, Pv, where one triangle covers a hit; else 0. Owned */
    float *numbers;
    float *u, *v;         /* the first two arrays of `numbers` */
    unsigned char *count; /* [down][across]: number of triangles that cover the hit. Owned */
    /* [down][across]: the block to the right and below is crossed by an edge. Owned */
    unsigned char *crossed;
    unsigned char *even;  /* [down][across]: evenness bits, from which `place` is derived. Owned */
    unsigned char *place; /* [down][across] of blocks: WR_SPARSE_HITS_. Owned */
    unsigned char *shown; /* [blocks] of the mesh: one of its triangles is drawn. Owned */
    int blocks;
    bool closed_u, closed_v; /* of the mesh */
} WrSparseHits;

/* Source of a block's samples: none; the depth buffer; interpolation without solving; Newton's method from
   interpolated starts, plus 3 y + x, the offset up and left at which the 3 x 3 blocks for the interpolation
   begin. */
enum { WR_SPARSE_HITS_NOTHING, WR_SPARSE_HITS_DEPTH, WR_SPARSE_HITS_SHEET, WR_SPARSE_HITS_BETWEEN };

/* Source of the block at a sample of the view's grid, which must be in the requested rows. */
static inline unsigned char wr_sparse_hits_at(const WrSparseHits *knots, int x, int y)
{
    const size_t row = (size_t)(y / WR_KNOT - knots->top);
    return knots
        ->place[row * (size_t)knots->across + (size_t)(x / WR_KNOT + WR_SPARSE_HITS_AROUND)];
}

/* Interpolates a run of a row from sample (x, y) of the grid on, all in blocks without solving, to position `at`
   of the strip: u, v, P, Pu, Pv, x and y. */
void wr_sparse_hits_row(const WrSparseHits *knots, const WrWide *wide, int x, int y, int count,
                        int at, WrStrip *strip);

/* Inputs for computing the hits. */
typedef struct WrSparseHitsRequest {
    const WrKernels *kernels;
    const WrWide *wide;
    const WrWideSheet *sheet; /* NULL: a surface without SIMD kernels */
    WrNewton newton;
    int first, rows; /* requested samples of the grid: tiles are within these rows */
} WrSparseHitsRequest;

void wr_sparse_hits_fini(WrSparseHits *knots);
/* Computes or keeps the hits of a mesh that was prepared for the view. False: there are none, because memory is
   short, the mesh reaches behind the eye, or the work was cancelled (pool.h). */
bool wr_sparse_hits_update(WrSparseHits *knots, const WrViewMesh *mesh, const WrView *view,
                           const WrSparseHitsRequest *ask, WrPool *pool);
/* True if a rectangle, 1/256 samples, overlaps a block that uses the depth buffer. */
bool wr_sparse_hits_deep(const WrSparseHits *knots, int32_t x0, int32_t y0, int32_t x1, int32_t y1);
/* Prepares a tile of the view's own grid to use sparse hits: fills `knots`, `untold`, `deep`. */
void wr_sparse_hits_report(const WrSparseHits *knots, WrDepthTile *tile);
/* Writes start values for interpolated samples, u, v and a depth of 0, after the triangles are drawn. */
void wr_sparse_hits_fill(const WrSparseHits *knots, const WrWide *wide, WrDepthTile *tile);
