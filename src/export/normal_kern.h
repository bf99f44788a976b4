/* normal_kern.h - the inner loops of normal maps, bump slopes and other maps' codes, compiled once per instruction set.
   All sets give the same bits, but for what nearly8 leaves in doubt: only + - * / sqrt, comparisons and conversions, without
   contraction.
   Layer 6. Private to this room. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define WR_NORMAL_STRIP 256 /* texels of a row at most */
#define WR_NORMAL_BLOCK 16  /* texels of a row that nearly8 makes, or leaves, together */

/* Whether slopes are such that plain products give the bits of v3_unit, which scales by powers of two
 * against overflow. What is not finite is not. */
#define WR_NORMAL_PLAIN 1e100

/* The stencil that gives a scheme's slopes at texel centres (normal.c). */
typedef enum WrNormalStencil {
    WR_STENCIL_CENTRAL,
    WR_STENCIL_FORWARD,
    WR_STENCIL_SPLINE
} WrNormalStencil;

WrNormalStencil wr_normal_stencil(int scheme); /* a WrScheme */

typedef struct WrNormalJob {
    WrNormalStencil stencil;
    double height, cell_w, cell_h; /* of the scene; of the cell */
    double width, rows;            /* texels */
    double last, green;            /* the largest code; sign of the second component */
} WrNormalJob;

/* What numbers are as codes: zero + round(times (x - less) / by), halves away from zero, cut to 0..last. */
typedef struct WrMapCodes {
    double times, less, by;
    double zero, last;
    double low, high; /* x beyond these are counted */
} WrMapCodes;

typedef struct WrNormalKernels {
    const char *name; /* "v1", "v3", "v4": levels of x86-64; v1 is plain C everywhere */

    /* Exact. */
    void (*widen)(const float *in, int count, double *out);
    /* x = -height Fu / cell_w and y = -height Fv / cell_h of `count` texels. at: the first one's tap, with one more
     * before and after each row; the rows beside it are `pitch` away. True if all are plain. */
    bool (*tilts)(const WrNormalJob *job, const double *at, ptrdiff_t pitch, int count, double *x,
                  double *y);
    /* Of plain tilts: the normal's three codes, or floats, texel after texel. */
    void (*codes8)(const WrNormalJob *job, const double *x, const double *y, int count,
                   uint8_t *out);
    void (*codes16)(const WrNormalJob *job, const double *x, const double *y, int count,
                    uint16_t *out);
    /* Codes of 8 bits from the heights themselves, in single precision, of blocks of WR_NORMAL_BLOCK texels; not by
     * WR_STENCIL_SPLINE. Bit k of what is returned: block k was not made, or a code of it may be the next one to the right
     * one; it is to be made as above, as is what is left over beyond the last whole block. Which are in doubt differs
     * between sets. */
    uint32_t (*nearly8)(const WrNormalJob *job, const float *at, ptrdiff_t pitch, int count,
                        uint8_t *out);
    void (*floats)(const WrNormalJob *job, const double *x, const double *y, int count, float *out);
    /* The six numbers of bump slopes, texel after texel: f, s, t, s s, t t, s t. False, and nothing is said of `out`, where
     * a height is beyond `most`, a slope beyond `steepest`, or either is no number. STRIP texels at most. */
    bool (*moments)(const float *f, const double *s, const double *t, int count, float most,
                    double steepest, float *out);
    /* Codes of `count` numbers; how many of these are beyond low..high. No number is none. */
    int64_t (*codes_of)(const WrMapCodes *codes, const float *x, int count, int32_t *out);
    /* Of two rows of 2 count texels of six numbers each, `count` means of four. */
    void (*halve)(const float *a, const float *b, int count, float *out);
} WrNormalKernels;

extern const WrNormalKernels wr_normal_kernels_v1, wr_normal_kernels_v3, wr_normal_kernels_v4;

/* Those that this processor runs best. */
const WrNormalKernels *wr_normal_kernels(void);

/* One after another for index = 0, 1, ...; NULL where this processor cannot run it, or there is none. */
const WrNormalKernels *wr_normal_kernels_at(int index);
