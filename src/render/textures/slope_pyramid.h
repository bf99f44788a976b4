/* slope_pyramid.h - mip pyramid of a table's slopes: means, covariances or ranges, updated incrementally between
   snapshots. Private to the renderer.

   SLOPES    means of the central differences. Theorem: the slope of the box-filtered F is the mean of the
             slopes over the box (the derivative of an integral over a shifted box), so filtering F and
             filtering its slopes are equivalent.
   MOMENTS   those means and the covariance of the slopes about them, stored centred:
                 S = mean of (S_k + (B_k - B)(B_k - B)^T)
             which is M - B B^T of LEAN mapping (Olano and Baker 2010) without its cancellation, and never
             negative.
   RANGE     least and largest slopes of blocks of 2^l x 2^l texels; level 0 is the texels themselves.

   Level l of SLOPES and MOMENTS has max(1, floor(size / 2)) texels of the level below along each axis. A texel
   is the mean over exactly its share of the cell, with partial texels weighted by their part, so that every
   level has the table's mean and odd sizes cause no shift (HC55). Level 0 is the table, not stored. */
#pragma once
#include "field/wrap.h"

#include <stdbool.h>
#include <stdint.h>

/* ---- upper bounds of the table's slopes over the area that a run of samples reads ---- */

/* Where the bound is 0 no bump is needed; elsewhere it bounds the bent normals. */

typedef struct WrLevel {
    /* [tiles_v][tiles_u], borrowed: each tile's largest central differences, dF/du and dF/dv. If NULL, low and
       high are each tile's least and largest height: slopes of other schemes are 0 where all texels read are
       equal (HC47), and else unknown. */
    const float (*steep)[2];
    const float *low, *high;
    float steepest[2], gentlest[2]; /* of all tiles */
    int tiles_u, tiles_v;
    int width, height; /* of the table, texels */
    double ru, rv;     /* replication */
    bool periodic_u, periodic_v;
} WrLevel;

/* Upper bound of |dF/du| and |dF/dv| over fetches from u0 .. u1, v0 .. v1; INFINITY: unknown. A box over many
   tiles is not searched: it gets the bound of the whole table. */
void wr_level_box(const WrLevel *level, double u0, double u1, double v0, double v1,
                  float steepest[2]);

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrPool WrPool;

typedef enum WrPyramidKind {
    WR_PYRAMID_SLOPES,                   /* Fu, Fv, F, 0 */
    WR_PYRAMID_MOMENTS,                  /* Fu, Fv, F, 0, Suu, Suv, Svv, 0 */
    WR_PYRAMID_RANGE,                    /* least Fu, largest Fu, least Fv, largest Fv */
    WR_PYRAMID_COUNT,                    /* number of kinds made from height tables */
    WR_PYRAMID_COLOUR = WR_PYRAMID_COUNT /* R, G, B, 0: built by mips.h */
} WrPyramidKind;

#define WR_PYRAMID_LEVELS 16 /* of 16384 texels: 0..14 */

/* Texel (i, j), j from the top, is at data + ((j + 1) * pitch + i + 1) * floats: an apron of one texel surrounds
   the level, wrapped on a periodic axis, repeated on a clamped one. RANGE has the apron, unused. */
typedef struct WrPyramidLevel {
    int width, height;
    int pitch;   /* texels per row */
    float *data; /* owned; NULL at level 0, except for RANGE */
} WrPyramidLevel;

/* Zero-initialise; drop frees. */
typedef struct WrPyramid {
    WrPyramidKind kind;
    int floats; /* floats per texel */
    int levels; /* number of levels, level 0 included; the last is 1 x 1 */
    WrPyramidLevel level[WR_PYRAMID_LEVELS];
    WrField *seen;            /* snapshot that it was made from; NULL: none */
    int64_t texels_refreshed; /* texels of the table processed by the last update */
} WrPyramid;

/* Updates the pyramid to the field: only what depends on changed tiles, unless half of the table changed. */
bool wr_pyramid_update(WrPyramid *pyramid, WrPyramidKind kind, const WrField *field, WrPool *pool,
                       WrError *err);
void wr_pyramid_drop(WrPyramid *pyramid);

/* ---- for modules that fill a pyramid themselves ---- */

/* Weights of the source texels in target texel i of m, which covers [i n/m, (i+1) n/m) of n: the texels start at
   `from`, and the weights sum to 1. */
typedef struct WrShare {
    int from, count; /* 1..3: n is at most 3 where m is 1, else n/m < 3 uses a part at either end */
    double weight[4];
} WrShare;
WrShare wr_pyramid_box_weights(int i, int n, int m);
/* Index of a texel of the apron: wrapped, or clamped to the edge. */
int wr_pyramid_fold(int i, int n, WrWrap wrap);
/* Allocates the levels of that kind for a picture of width x height, uninitialised; frees the old ones. */
bool wr_pyramid_allocate(WrPyramid *pyramid, WrPyramidKind kind, int width, int height,
                         WrError *err);
/* Fills the levels above level 1, whose texels must exist without apron, and all aprons. */
bool wr_pyramid_finish(WrPyramid *pyramid, WrWrap wrap_u, WrWrap wrap_v, WrPool *pool,
                       WrError *err);
