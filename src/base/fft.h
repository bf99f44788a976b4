/* fft.h - Fourier, Hartley and cosine transforms in double precision, for lines of any length.

   No library is used because the results become heights and light, which must have the same bits on
   every processor: sines and cosines come from base/exactmath.h, and sums have a fixed order. Lengths
   with the factors 2, 3, 5, 7, 11 and 13 use mixed radices (Stockham's order); others use Bluestein's
   chirp with the next power of two. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;

typedef struct WrFft WrFft;

/* Creates a plan for lines of n complex numbers, 1..32768. Returns NULL and an error when out of
 * memory. The caller owns it. */
WrFft *wr_fft_new(int n, WrError *err);
void wr_fft_free(WrFft *fft); /* NULL is fine */
/* Number of doubles of scratch memory that a transform needs. */
size_t wr_fft_scratch(const WrFft *fft);
/* X[k] = sum over j of x[j] exp(-2 pi i j k / n), in place; z: [n][2], real and imaginary part. Error
 * about 1e-16 log2(n) of the root mean square. Any number of threads, each with its own scratch. */
void wr_fft_run(const WrFft *fft, double *z, double *scratch);

/* ---- real lines ---- */

/* Continuation of a line beyond its ends, which determines the basis functions. */
typedef enum WrEnds {
    WR_ENDS_RING, /* periodic: cos + sin of 2 pi j k / n (Hartley transform) */
    WR_ENDS_FREE  /* mirrored at half a step: cos of pi (j + 1/2) k / n (cosine transform) */
} WrEnds;

/* The two directions are exact inverses, with no factor left. a, b: [n] two lines, which cost as much
 * as one; scratch: [2 n + wr_fft_scratch]. */
void wr_line_forward(const WrFft *fft, WrEnds ends, double *a, double *b, double *scratch);
void wr_line_back(const WrFft *fft, WrEnds ends, double *a, double *b, double *scratch);
