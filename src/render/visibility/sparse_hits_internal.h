/* sparse_hits_internal.h - working state shared by the files of sparse_hits.h.
   Private to the sparse_hits*.c files. */
#pragma once
#include "render/visibility/sparse_hits.h"

#include <stdint.h>

#define WR_KNOT_STEP (WR_KNOT * 256) /* 1/256 samples from hit to hit */

typedef struct WrSparseHitsJob {
    WrSparseHits *knots;
    const WrViewMesh *mesh;
    const WrView *view;
    const WrSparseHitsRequest *ask;
    const WrRays *rays;
    bool mirrored;
    float step_u;         /* from vertex to vertex */
    WrStrip *strips;      /* [threads] */
    unsigned char *sheet; /* [threads][across] */
    int behind;           /* a vertex is behind the near plane */
} WrSparseHitsJob;

/* Coverage of hits and crossed blocks, for a row of the mesh's blocks; ctx: WrSparseHitsJob. */
void wr_sparse_hits_meet_rows(int block, int worker, void *ctx);

static inline int32_t wr_sparse_hits_floor(int32_t x)
{
    return x >= 0 ? x / WR_KNOT_STEP : -((-x + WR_KNOT_STEP - 1) / WR_KNOT_STEP);
}

static inline int wr_sparse_hits_clamped(int x, int low, int high)
{
    return x < low ? low : x > high ? high : x;
}

/* The blocks that a rectangle of 1/256 samples overlaps, enlarged by one sample on each side. */
typedef struct WrSparseHitsBlocks {
    int x0, y0, x1, y1; /* x0 <= x <= x1, in rows of the hits' grid */
} WrSparseHitsBlocks;

static inline WrSparseHitsBlocks wr_sparse_hits_blocks(const WrSparseHits *knots, int32_t x0,
                                                       int32_t y0, int32_t x1, int32_t y1)
{
    return (WrSparseHitsBlocks){
        wr_sparse_hits_clamped(wr_sparse_hits_floor(x0 - 256) + WR_SPARSE_HITS_AROUND, 0,
                               knots->across),
        wr_sparse_hits_clamped(wr_sparse_hits_floor(y0 - 256) - knots->top, 0, knots->down),
        wr_sparse_hits_clamped(wr_sparse_hits_floor(x1 + 256) + WR_SPARSE_HITS_AROUND, -1,
                               knots->across - 1),
        wr_sparse_hits_clamped(wr_sparse_hits_floor(y1 + 256) - knots->top, -1, knots->down - 1)
    };
}
