/* fft.h - Fourier transforms in double of any length, and what is made of them on a plane of heights:
   differential equations on a torus, on a sheet with free edges, or with one axis of each.
   Layer 4, private to this room.

   Our own rather than a library's: they end in heights, which have the same bits on every processor, so
   sines and cosines come from base/exactmath.h and sums have one order. Lengths of the factors 2, 3, 5, 7,
   11 and 13 go by mixed radices (Stockham's order), others by Bluestein's chirp through the next power of
   two. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;
typedef struct WrPool WrPool;
typedef struct WrProgress WrProgress;

typedef struct WrFft WrFft;

/* For lines of n complex numbers, 1..32768. NULL and an error where memory is gone. The caller owns it. */
WrFft *wr_fft_new(int n, WrError *err);
void wr_fft_free(WrFft *fft); /* NULL is fine */
/* How many doubles of scratch a transform wants. */
size_t wr_fft_scratch(const WrFft *fft);
/* X[k] = sum over j of x[j] exp(-2 pi i j k / n), in place; z: [n][2], real and imaginary part. Error about
 * 1e-16 log2(n) of the root mean square. Any number of threads, each with scratch of its own. */
void wr_fft_run(const WrFft *fft, double *z, double *scratch);

/* ---- real lines ---- */

/* What lies beyond the ends of a line, and so what its functions of one frequency are. */
typedef enum WrEnds {
    WR_ENDS_RING, /* it begins again: cos + sin of 2 pi j k / n (Hartley's transform) */
    WR_ENDS_FREE /* its mirror image, by half a step: cos of pi (j + 1/2) k / n (cosine transform) */
} WrEnds;

/* Both directions undo each other: no factors are left over. a, b: [n] two lines at once, which costs as
 * much as one; scratch: [2 n + wr_fft_scratch]. */
void wr_line_forward(const WrFft *fft, WrEnds ends, double *a, double *b, double *scratch);
void wr_line_back(const WrFft *fft, WrEnds ends, double *a, double *b, double *scratch);

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
