/* slope_pyramid.h - box-filtered copies of a table's slopes, each about half as fine as the one before, and
   copies of their least and largest values; kept up to date from what changed between two snapshots.
   Layer 5, private to the renderer.

   SLOPES    means of the central differences. Theorem: the slope of the box-filtered F is the mean of the
             slopes over the box (the derivative of an integral over a shifted box), so filtering F and
             filtering its slopes are one thing.
   MOMENTS   the same and the covariance of the slopes about that mean, kept centred:
                 S = mean of (S_k + (B_k - B)(B_k - B)^T)
             which is M - B B^T of LEAN mapping (Olano and Baker 2010) without its cancellation, and never
             negative.
   RANGE     least and largest slopes of blocks of 2^l x 2^l texels; level 0 are the texels themselves.

   Level l of SLOPES and MOMENTS has max(1, floor(size / 2)) texels of the level below along each axis; a
   texel is the mean over exactly its share of the cell, parts of texels by their part, so that every level
   has the table's mean and no odd size shifts the picture (HC55). Level 0 is the table, not stored. */
#pragma once
#include "field/wrap.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrPool WrPool;

typedef enum WrPyramidKind {
    WR_PYRAMID_SLOPES,                   /* Fu, Fv, F, 0 */
    WR_PYRAMID_MOMENTS,                  /* Fu, Fv, F, 0, Suu, Suv, Svv, 0 */
    WR_PYRAMID_RANGE,                    /* least Fu, largest Fu, least Fv, largest Fv */
    WR_PYRAMID_COUNT,                    /* of those made from tables */
    WR_PYRAMID_COLOUR = WR_PYRAMID_COUNT /* R, G, B, 0: color_mips.h makes it */
} WrPyramidKind;

#define WR_PYRAMID_LEVELS 16 /* of 16384 texels: 0..14 */

/* Texel (i, j), j from the top, at data + ((j + 1) * pitch + i + 1) * floats: an apron of one texel,
   wrapped on a periodic axis, repeated on a clamped one. RANGE has the apron, unused. */
typedef struct WrPyramidLevel {
    int width, height;
    int pitch;   /* texels a row */
    float *data; /* owned; NULL at level 0 but of RANGE */
} WrPyramidLevel;

/* Zero-initialise; drop frees. */
typedef struct WrPyramid {
    WrPyramidKind kind;
    int floats; /* a texel */
    int levels; /* how many, level 0 included; the last is 1 x 1 */
    WrPyramidLevel level[WR_PYRAMID_LEVELS];
    WrField *seen;            /* snapshot that it was made from; NULL: none */
    int64_t texels_refreshed; /* of the table, by the last bring-up */
} WrPyramid;

/* Bring it up to date with field: only what changed tiles reach, unless half of the table changed. */
bool wr_pyramid_bring(WrPyramid *pyramid, WrPyramidKind kind, const WrField *field, WrPool *pool,
                      WrError *err);
void wr_pyramid_drop(WrPyramid *pyramid);

/* ---- for those who fill one otherwise ---- */

/* The share of source texels in target texel i of m, which covers [i n/m, (i+1) n/m) of n: weights of texels from
   `from` on, that sum to 1. */
typedef struct WrShare {
    int from,
        count; /* 1..3: n is at most 3 where m is 1, else n/m < 3 takes a part at either end */
    double weight[4];
} WrShare;
WrShare wr_pyramid_share(int i, int n, int m);
/* Index of a texel of the apron: round, or the edge. */
int wr_pyramid_fold(int i, int n, WrWrap wrap);
/* Levels of that kind for a picture of width x height, nothing in them yet; what was there goes. */
bool wr_pyramid_allocate(WrPyramid *pyramid, WrPyramidKind kind, int width, int height,
                         WrError *err);
/* Fill the levels above level 1, which is there but for its apron, and all aprons. */
bool wr_pyramid_finish(WrPyramid *pyramid, WrWrap wrap_u, WrWrap wrap_v, WrPool *pool,
                       WrError *err);
