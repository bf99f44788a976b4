/* fft.h - Fourier transforms in double of lines of any length.
   Layer 1.

   Our own rather than a library's: they end in heights and light, which have the same bits on every processor, so
   sines and cosines come from base/exactmath.h and sums have one order. Lengths of the factors 2, 3, 5, 7,
   11 and 13 go by mixed radices (Stockham's order), others by Bluestein's chirp through the next power of
   two. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;

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
