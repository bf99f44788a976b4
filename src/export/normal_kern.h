/* normal_kern.h - inner loops of normal maps, bump slopes and other maps' codes, compiled once per instruction
   set. Private to this module.
   All sets give the same bits, except for the codes that nearly8 reports as in doubt: only + - * / sqrt,
   comparisons and conversions, without contraction. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define WR_NORMAL_STRIP 256 /* maximum texels of a row */
#define WR_NORMAL_BLOCK 16  /* texels of a row that nearly8 computes, or skips, together */

/* Limit of slopes for which plain products give the bits of v3_unit, which scales by powers of two against
   overflow. Non-finite slopes are above it. */
#define WR_NORMAL_PLAIN 1e100

/* The stencil of a scheme's slopes at texel centres (normal.c). */
typedef enum WrNormalStencil {
    WR_STENCIL_CENTRAL,
    WR_STENCIL_FORWARD,
    WR_STENCIL_SPLINE
} WrNormalStencil;

WrNormalStencil wr_normal_stencil(int scheme); /* scheme: a WrScheme */

typedef struct WrNormalJob {
    WrNormalStencil stencil;
    double height, cell_w, cell_h; /* of the scene; of the cell */
    double width, rows;            /* size in texels */
    double last, green;            /* the largest code; sign of the second component */
} WrNormalJob;

/* Conversion of numbers to codes: zero + round(times (x - less) / by), halves away from zero, clamped to
   0..last. */
typedef struct WrMapCodes {
    double times, less, by;
    double zero, last;
    double low, high; /* values of x outside are counted */
} WrMapCodes;

typedef struct WrNormalKernels {
    const char *name; /* "v1", "v3", "v4": levels of x86-64; v1 is plain C on every processor */

    /* Converts floats to double. */
    void (*widen)(const float *in, int count, double *out);
    /* x = -height Fu / cell_w and y = -height Fv / cell_h of `count` texels. at: the first one's tap, with one
       more before and after each row; neighbouring rows are `pitch` apart. True if all are below
       WR_NORMAL_PLAIN. */
    bool (*tilts)(const WrNormalJob *job, const double *at, ptrdiff_t pitch, int count, double *x,
                  double *y);
    /* The normal's three codes, or floats, texel after texel, from tilts below WR_NORMAL_PLAIN. */
    void (*codes8)(const WrNormalJob *job, const double *x, const double *y, int count,
                   uint8_t *out);
    void (*codes16)(const WrNormalJob *job, const double *x, const double *y, int count,
                    uint16_t *out);
    /* 8-bit codes directly from the heights, in single precision, in blocks of WR_NORMAL_BLOCK texels; not for
       WR_STENCIL_SPLINE. Bit k of the result: block k was not computed, or one of its codes may be a neighbour
       of the right one; it must be computed by the functions above, as the texels after the last whole block.
       Which blocks are in doubt differs between sets. */
    uint32_t (*nearly8)(const WrNormalJob *job, const float *at, ptrdiff_t pitch, int count,
                        uint8_t *out);
    void (*floats)(const WrNormalJob *job, const double *x, const double *y, int count, float *out);
    /* The six numbers of bump slopes, texel after texel: f, s, t, s s, t t, s t. False, with undefined `out`, if
       a height is above `most`, a slope above `steepest`, or either is NaN. At most STRIP texels. */
    bool (*moments)(const float *f, const double *s, const double *t, int count, float most,
                    double steepest, float *out);
    /* Codes of `count` numbers; returns the number of values outside low..high. NaN is inside. */
    int64_t (*codes_of)(const WrMapCodes *codes, const float *x, int count, int32_t *out);
    /* `count` means of four, from two rows of 2 count texels of six numbers each. */
    void (*halve)(const float *a, const float *b, int count, float *out);
} WrNormalKernels;

extern const WrNormalKernels wr_normal_kernels_v1, wr_normal_kernels_v3, wr_normal_kernels_v4;

/* The fastest set for this processor. */
const WrNormalKernels *wr_normal_kernels(void);

/* The set of that index, 0, 1, ...; NULL if this processor does not support it, or there is none. */
const WrNormalKernels *wr_normal_kernels_at(int index);
