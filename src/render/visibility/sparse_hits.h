/* sparse_hits.h - where a view sees a single sheet of a mesh (uv_raster.h), its (u,v) without a depth buffer: every eighth sample along
   rows and columns, a knot, is solved by Newton's method, and the samples between start from the bicubic through sixteen
   knots, a thousand times nearer than from the mesh's triangles. Of fast arithmetic alone.

   A block of 8 x 8 samples shows one sheet for certain if one triangle covers its knot and no edge crosses it at which the
   number of triangles that cover a place can change: one that bounds the surface, or at which it turns to or from the
   viewer. All other blocks go through the depth buffer, as all samples do without knots; so outlines are the same.

   Where patches and rings are so even that the bicubic is within 1/256 of a sample, as fourth differences tell, samples are not
   solved at all: P, Pu and Pv are its, too.
   Layer 5, private to the renderer. */
#pragma once
#include "render/simd/simd_kernels.h"
#include "render/visibility/uv_raster.h"

#include <stdbool.h>

typedef struct WrPool WrPool;

#define WR_KNOT 8               /* samples from knot to knot */
#define WR_SPARSE_HITS_AROUND 2 /* knots about the samples that their blocks go by */

/* All that knots depend on. */
typedef struct WrSparseHitsKey {
    WrViewSight sight;
    WrShapef shape;
    WrNewton newton;
    int mu, mv, grid_w; /* cells of the mesh; samples */
    int first, rows;    /* samples of the grid that are wanted, from row `first` on */
    bool cull;
    const WrKernels *kernels;
} WrSparseHitsKey;

/* Zero-initialise; fini frees. */
typedef struct WrSparseHits {
    WrSparseHitsKey key;
    bool known;            /* all of it is of that key */
    int top, across, down; /* in knots: the first row's place, and how many there are */
    /* [WR_KNOT_NUMBERS][down][across]: u, v, P, Pu, Pv, where one triangle covers a knot; else 0. Owned */
    float *numbers;
    float *u, *v;         /* the first two of those */
    unsigned char *count; /* [down][across]: how many triangles cover it. Owned */
    unsigned char
        *crossed;         /* likewise, of the block right and below of each: an edge does. Owned */
    unsigned char *even;  /* likewise: what place goes by. Owned */
    unsigned char *place; /* likewise, of blocks: WR_SPARSE_HITS_. Owned */
    unsigned char *shown; /* [blocks] of the mesh: a triangle of it is drawn. Owned */
    int blocks;
    bool closed_u, closed_v; /* the mesh's */
} WrSparseHits;

/* How a block's samples are told: not at all; by the depth buffer; by knots alone; by Newton's method from between knots, plus
   3 y + x where the three by three blocks that it goes by begin so far above and to the left. */
enum { WR_SPARSE_HITS_NOTHING, WR_SPARSE_HITS_DEPTH, WR_SPARSE_HITS_SHEET, WR_SPARSE_HITS_BETWEEN };

/* How the block at a sample of the view's grid is told; it lies in the rows that were asked for. */
static inline unsigned char wr_sparse_hits_at(const WrSparseHits *knots, int x, int y)
{
    const size_t row = (size_t)(y / WR_KNOT - knots->top);
    return knots
        ->place[row * (size_t)knots->across + (size_t)(x / WR_KNOT + WR_SPARSE_HITS_AROUND)];
}

/* The neighbours of a row from sample (x, y) of the grid on, all told by knots alone, from place `at` of a strip on: u, v, P, Pu,
   Pv, x and y. */
void wr_sparse_hits_row(const WrSparseHits *knots, const WrWide *wide, int x, int y, int count,
                        int at, WrStrip *strip);

/* What knots are solved with. */
typedef struct WrSparseHitsAsk {
    const WrKernels *kernels;
    const WrWide *wide;
    const WrWideSheet *sheet; /* NULL: a surface that there are no vectors of */
    WrNewton newton;
    int first, rows; /* samples of the grid that are wanted: tiles lie in these rows */
} WrSparseHitsAsk;

void wr_sparse_hits_fini(WrSparseHits *knots);
/* Make or keep those of a mesh that was prepared for the view. False: there are none, for want of memory, because the mesh
   reaches behind the eye, or because it was cancelled (pool.h). */
bool wr_sparse_hits_bring(WrSparseHits *knots, const WrViewMesh *mesh, const WrView *view,
                          const WrSparseHitsAsk *ask, WrPool *pool);
/* Does a rectangle, 1/256 samples, meet a block that goes through the depth buffer? */
bool wr_sparse_hits_deep(const WrSparseHits *knots, int32_t x0, int32_t y0, int32_t x1, int32_t y1);
/* A tile of the view's own grid goes by knots: fills `knots`, `untold`, `deep`. */
void wr_sparse_hits_tell(const WrSparseHits *knots, WrDepthTile *tile);
/* Guesses for its samples between knots: u, v and a depth of 0, once triangles are drawn. */
void wr_sparse_hits_fill(const WrSparseHits *knots, const WrWide *wide, WrDepthTile *tile);
