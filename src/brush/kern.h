/* kern.h - the inner loops of the brush, compiled once per instruction set. All sets give the same bits:
   only + - * sqrt, comparisons and conversions, without contraction.
   Layer 2, inside this room. Counts are multiples of WR_BRUSH_BLOCK up to WR_TILE: whole vectors, whose
   remainders would cost more than they. */
#pragma once
#include "brush/capsule.h"

#define WR_BRUSH_BLOCK 16    /* texels */
#define WR_BRUSH_STRONG 1e30 /* table units */

typedef struct WrBrushKernels {
    const char *name; /* "v1", "v3", "v4": levels of x86-64; v1 is plain C everywhere */

    /* cover[i] = coverage times pressure of texel (x + i, y); for motions of length 0, and others. */
    void (*dab)(const WrCapsule *capsule, double y, double x, int count, float *cover);
    void (*motion)(const WrCapsule *capsule, double y, double x, int count, float *cover);

    /* What `dab` and then `add` do to heights[i]. */
    void (*dab_add)(const WrCapsule *capsule, double y, double x, int count, double strength,
                    float *heights);

    /* Whether any cover[i] < fresh[i]; whether any cover[i] < most. */
    bool (*grows)(const float *cover, const float *fresh, int count);
    bool (*below)(const float *cover, float most, int count);
    /* cover[i] = the larger of it and fresh[i] */
    void (*join)(float *cover, const float *fresh, int count);

    /* out[i] = start[i] + strength cover[i]; where cover[i] is 0 the bits of start[i]. |strength| at most
     * WR_BRUSH_STRONG, so that nothing overflows. start may be out itself. */
    void (*add)(double strength, const float *start, const float *cover, int count, float *out);
} WrBrushKernels;

extern const WrBrushKernels wr_brush_kernels_v1, wr_brush_kernels_v3, wr_brush_kernels_v4;

/* The best set that this processor has. */
const WrBrushKernels *wr_brush_kernels(void);
/* Set `index` of those there are, NULL if this processor lacks it; for tests. */
#define WR_BRUSH_KERNELS 3
const WrBrushKernels *wr_brush_kernels_at(int index);
