/* knots_inner.h - what the files of knots.h share.
   Layer 5, private to knots.c and its brothers. */
#pragma once
#include "render/knots.h"

#include <stdint.h>

#define WR_KNOT_STEP (WR_KNOT * 256) /* 1/256 samples from knot to knot */

typedef struct WrKnotsJob {
    WrKnots *knots;
    const WrViewMesh *mesh;
    const WrView *view;
    const WrKnotsAsk *ask;
    const WrRays *rays;
    bool mirrored;
    float step_u;         /* from vertex to vertex */
    WrStrip *strips;      /* [threads] */
    unsigned char *sheet; /* [threads][across] */
    int behind;           /* a vertex has no place */
} WrKnotsJob;

/* What triangles cover each knot, and which blocks their edges cross, of a row of the mesh's blocks; ctx: WrKnotsJob. */
void wr_knots_meet_rows(int block, int worker, void *ctx);

static inline int32_t wr_knots_floor(int32_t x)
{
    return x >= 0 ? x / WR_KNOT_STEP : -((-x + WR_KNOT_STEP - 1) / WR_KNOT_STEP);
}

static inline int wr_knots_clamped(int x, int low, int high)
{
    return x < low ? low : x > high ? high : x;
}

/* The blocks that a rectangle of 1/256 samples meets, one sample more on each side. */
typedef struct WrKnotsBlocks {
    int x0, y0, x1, y1; /* x0 <= x <= x1, of the knots' own rows */
} WrKnotsBlocks;

static inline WrKnotsBlocks wr_knots_blocks(const WrKnots *knots, int32_t x0, int32_t y0,
                                            int32_t x1, int32_t y1)
{
    return (WrKnotsBlocks){
        wr_knots_clamped(wr_knots_floor(x0 - 256) + WR_KNOTS_AROUND, 0, knots->across),
        wr_knots_clamped(wr_knots_floor(y0 - 256) - knots->top, 0, knots->down),
        wr_knots_clamped(wr_knots_floor(x1 + 256) + WR_KNOTS_AROUND, -1, knots->across - 1),
        wr_knots_clamped(wr_knots_floor(y1 + 256) - knots->top, -1, knots->down - 1)
    };
}
