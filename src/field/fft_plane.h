/* fft_plane.h - Fourier methods (base/fft.h) on a plane of heights: differential equations on a torus,
   on a plane with free edges, or with one axis of each. */
#pragma once
#include "base/fft.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrPool WrPool;
typedef struct WrProgress WrProgress;

/* An operation on a pair of lines in place; see wr_plane_lines. */
typedef void (*WrLinePair)(const void *ctx, const WrFft *fft, double *a, double *b,
                           double *scratch);

typedef struct WrPlane {
    int width, height;          /* 1..32768 */
    WrEnds ends[2];             /* along rows, along columns */
    double *z;                  /* [height][width], borrowed */
    WrPool *pool;               /* NULL: the calling thread */
    const WrProgress *progress; /* NULL: none; only used for cancellation */
} WrPlane;

/* Calls pair for all rows (axis 0) or columns (axis 1), in fixed pairs; scratch: of one transform.
 * Errors: out of memory, "cancelled". */
bool wr_plane_lines(const WrPlane *plane, int axis, WrLinePair pair, const void *ctx, WrError *err);

/* Definition of a slope between texels, for normals and pictures. */
typedef enum WrSlopes {
    WR_SLOPES_STEP,    /* z[i+1] - z[i], between texels */
    WR_SLOPES_CENTRAL, /* (z[i+1] - z[i-1])/2; only on a ring */
    WR_SLOPES_SMOOTH   /* of the smoothest function through the texels; only on a ring */
} WrSlopes;

/* Replaces z by its transposed slope along an axis (D^T z), for least squares. WR_SLOPES_STEP: z[i] is
 * the step from i to i + 1; on a free line the last one is ignored. */
bool wr_plane_slope_adjoint(const WrPlane *plane, int axis, WrSlopes slopes, WrError *err);

/* Solves (Du^T Du + Dv^T Dv) x = z in place, with the given slope definition for each axis.
 * Undetermined components become 0: the mean, and the alternating function of a ring of even length
 * (for WR_SLOPES_SMOOTH always, for WR_SLOPES_CENTRAL if the other axis determines it too weakly). So z
 * = Du^T p + Dv^T q yields the heights whose slopes are nearest to (p, q) in the least-squares sense. */
bool wr_plane_solve(const WrPlane *plane, const WrSlopes slopes[2], WrError *err);

/* Subtracts from z the smooth component: its steps are the jumps across the edges of ring axes, and no
 * others, in the least-squares sense. So z becomes periodic and keeps its mean and, as nearly as a
 * periodic plane can, its steps inside. A plane without jumps keeps its bits. Source: L. Moisan,
 * Periodic plus smooth image decomposition, J. Math. Imaging Vis. 39, 2011. */
bool wr_plane_make_periodic(const WrPlane *plane, WrError *err);
