/* fft_plane.h - what is made of Fourier transforms (base/fft.h) on a plane of heights: differential equations on a torus, on
   a sheet with free edges, or with one axis of each.
   Private to this module. */
#pragma once
#include "base/fft.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrPool WrPool;
typedef struct WrProgress WrProgress;

/* Something done to pairs of lines in place; see wr_plane_lines. */
typedef void (*WrLinePair)(const void *ctx, const WrFft *fft, double *a, double *b,
                           double *scratch);

typedef struct WrPlane {
    int width, height;          /* 1..32768 */
    WrEnds ends[2];             /* along rows, along columns */
    double *z;                  /* [height][width], borrowed */
    WrPool *pool;               /* NULL: the calling thread */
    const WrProgress *progress; /* NULL: none; only asked whether to stop */
} WrPlane;

/* Call pair for all rows (axis 0) or columns (axis 1), two by two in a fixed way; scratch: as above. Errors:
 * no memory, "cancelled". */
bool wr_plane_lines(const WrPlane *plane, int axis, WrLinePair pair, const void *ctx, WrError *err);

/* How a slope is taken between texels, for normals and pictures. */
typedef enum WrSlopes {
    WR_SLOPES_STEP,    /* z[i+1] - z[i], between texels */
    WR_SLOPES_CENTRAL, /* (z[i+1] - z[i-1])/2; on a ring only */
    WR_SLOPES_SMOOTH   /* of the smoothest function through the texels; on a ring only */
} WrSlopes;

/* Put z in the place of its slope along an axis turned round (D^T z), for sums of squares.
 * WR_SLOPES_STEP: z[i] is the step from i to i + 1; on a free line the last one counts for nothing. */
bool wr_plane_turned_slope(const WrPlane *plane, int axis, WrSlopes slopes, WrError *err);

/* Solve (Du^T Du + Dv^T Dv) x = z in place, the slopes of each axis taken in the way given; what they do
 * not see comes out as 0: the mean, and what goes up and down from texel to texel of a ring of even length
 * (WR_SLOPES_SMOOTH all of it, WR_SLOPES_CENTRAL where the other axis tells too little of it). So z = Du^T p + Dv^T q gives the heights whose slopes
 * are nearest to (p, q) in the sense of least squares. */
bool wr_plane_solve(const WrPlane *plane, const WrSlopes slopes[2], WrError *err);
