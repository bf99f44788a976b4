/* uv_coverage.h - coverage of a map's texels by the (u,v) of a mesh, and padding about its islands, for baking.

   Texel (x, y) of a map of width x height, row 0 on top, has its centre at u = (x + 1/2) / width and
   v = 1 - (y + 1/2) / height. Texture coordinates are taken modulo 1, as the table repeats, or those of one tile
   (base/udim.h) less its column and row. Of several triangles at one point the last one counts. Triangles whose corners are almost on a line, as at a sphere's
   pole, cover nothing: they are invisible, but their slopes are unbounded. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrPool WrPool;
typedef struct WrTriangles WrTriangles;

#define WR_UV_UNCOVERED (-1)

typedef struct WrUvCoverage {
    const WrTriangles *mesh; /* borrowed */
    int width, height;
    int udim;      /* tile; 0: all, modulo 1. Set by the caller after init */
    double dx, dy; /* the sample of a texel, from its centre to the right and down, texels */
    int32_t *
        owner; /* [height][width] index of a triangle, WR_UV_UNCOVERED, or private values below; owned */
} WrUvCoverage;

/* Errors: no memory. fini is allowed after a failure. */
bool wr_uv_coverage_init(WrUvCoverage *cover, const WrTriangles *mesh, int width, int height,
                         WrError *err);
void wr_uv_coverage_fini(WrUvCoverage *cover);
/* Sets the owners of all texels' samples. Incomplete if the thread's progress is cancelled. */
void wr_uv_coverage_fill(WrUvCoverage *cover, double dx, double dy);
/* Barycentric coordinates of a texel's sample in a triangle, by (u,v). */
void wr_uv_coverage_shares(const WrUvCoverage *cover, int32_t triangle, int x, int y, double l[3]);
/* Sets uncovered texels of map, [height][width][channels], to the mean of their neighbours, ring by ring about
 * the covered ones; unit: made unit. So a filter at an island's edge reads only such values. channels: 1 or 3.
 * Incomplete if the thread's progress is cancelled. */
void wr_uv_coverage_pad(WrUvCoverage *cover, float *map, int channels, bool unit, int rings,
                        WrPool *pool);
