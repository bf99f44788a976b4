/* brush_kernels.h - inner loops of the brush, compiled once per instruction set.

   All sets give the same bits: only + - * sqrt, comparisons and conversions, without contraction.
   Private to this module.
   Counts are multiples of WR_BRUSH_BLOCK up to WR_TILE: whole vectors, since remainder loops would
   cost more than the vectors. */
#pragma once
#include "brush/capsule.h"
#include "field/wrap.h"

#include <stdbool.h>

#define WR_BRUSH_BLOCK 16    /* texels */
#define WR_DAB_BLOCK 8       /* texels: a vector of doubles */
#define WR_BRUSH_STRONG 1e30 /* table units; largest strength for kernels */

/* A dab that is elliptic, or has libmypaint's falloff. */
typedef struct WrEllipse {
    double x, y;                                /* centre */
    double ux, uy;                              /* the long axis, unit, y down */
    double aspect, radius2;                     /* length over breadth; half the length, squared */
    double radius, inner, inner2, inverse_edge; /* of the round brush's falloff, as in WrCapsule */
    double a, b, c; /* a ex^2 + 2 b ex ey + c ey^2 is the square of the distance */
    float alpha, hardness, slope_in, slope_out; /* 1/k - 1, k/(1 - k) for hardness k */
    float inverse_radius2;
    bool rounded; /* uses the round brush's falloff */
} WrEllipse;

/* Columns, not wrapped; low > high: none. Limited to +-2^30. */
typedef struct WrDabRows {
    int low[WR_TILE], high[WR_TILE];           /* all */
    int flat_low[WR_TILE], flat_high[WR_TILE]; /* of constant coverage */
} WrDabRows;

/* The part of a dab in one tile. */
typedef struct WrDabPart {
    const WrDabRows *rows;
    int y, count;  /* unwrapped row of the first one; rows; their row k is rows' k */
    int x;         /* unwrapped column of the tile's column 0 */
    int low, high; /* columns of the tile, 0..WR_TILE - 1, that may change; preferably whole
                 WR_DAB_BLOCKs */
} WrDabPart;

typedef struct WrBrushKernels {
    const char *name; /* "v1", "v3", "v4": levels of x86-64; v1 is plain C everywhere */

    /* cover[i] = coverage times pressure of texel (x + i, y); for motions of length 0, and for others. */
    void (*dab)(const WrCapsule *capsule, double y, double x, int count, float *cover);
    void (*motion)(const WrCapsule *capsule, double y, double x, int count, float *cover);

    /* Coverage of an ellipse: with the round brush's falloff, with libmypaint's (dab.h). */
    void (*ellipse)(const WrEllipse *ellipse, double y, double x, int count, float *cover);
    void (*soft)(const WrEllipse *ellipse, double y, double x, int count, float *cover);

    /* Column ranges of the rows y .. y + count - 1 of a dab: the whole dab, slightly enlarged, and the
     * part within its inner radius, slightly reduced. */
    void (*dab_rows)(const WrCapsule *capsule, double y, int count, WrDabRows *rows);
    /* `dab` and then `add` for one tile's texels. heights: the texel of that tile in the first row and
     * column 0. Texels outside the dab keep their bits. */
    void (*dab_tile)(const WrCapsule *capsule, const WrDabPart *part, double strength,
                     float *heights);

    /* True if any cover[i] < fresh[i]; true if any cover[i] < most. */
    bool (*grows)(const float *cover, const float *fresh, int count);
    bool (*below)(const float *cover, float most, int count);
    float (*least)(const float *cover, int count); /* the smallest cover[i] */
    /* cover[i] = the larger of it and fresh[i] */
    void (*join)(float *cover, const float *fresh, int count);

    /* cover[i] = 1 - (1 - cover[i]) (1 - fresh[i]) */
    void (*over)(float *cover, const float *fresh, int count);
    /* cover[i] + rest[i] += fresh[i], in twice float's precision */
    void (*sum)(float *cover, float *rest, const float *fresh, int count);
    /* `soft` and then `over`. */
    void (*soft_over)(const WrEllipse *ellipse, double y, double x, int count, float *cover);

    /* Heights diffuse between each texel and four neighbours, by a fifth of the difference times the
     * smaller of both weights. f and w point into rows with `stride` texels before and after; f_up,
     * w_up, f_down, w_down: the rows `stride` away. |differences| may exceed float's range. count: any. */
    void (*flow)(const float *f, const float *w, const float *f_up, const float *w_up,
                 const float *f_down, const float *w_down, int stride, int count, float *out);

    /* out[i] = start[i] + strength cover[i]; where cover[i] is 0 the bits of start[i]. |strength| at
     * most WR_BRUSH_STRONG, so that nothing overflows. start may equal out. */
    void (*add)(double strength, const float *start, const float *cover, int count, float *out);
} WrBrushKernels;

extern const WrBrushKernels wr_brush_kernels_v1, wr_brush_kernels_v3, wr_brush_kernels_v4;

/* The fastest set for this processor. */
const WrBrushKernels *wr_brush_kernels(void);
/* Set `index`, NULL if this processor cannot run it; for tests. */
#define WR_BRUSH_KERNELS 3
const WrBrushKernels *wr_brush_kernels_at(int index);
