/* brush_kernels.h - the inner loops of the brush, compiled once per instruction set. All sets give the same bits:
   only + - * sqrt, comparisons and conversions, without contraction.
   Private to this module. Counts are multiples of WR_BRUSH_BLOCK up to WR_TILE: whole vectors, whose
   remainders would cost more than they. */
#pragma once
#include "brush/capsule.h"
#include "field/wrap.h"

#include <stdbool.h>

#define WR_BRUSH_BLOCK 16    /* texels */
#define WR_DAB_BLOCK 8       /* texels: a vector of doubles */
#define WR_BRUSH_STRONG 1e30 /* table units */

/* A dab that is not round, or whose falloff is libmypaint's. */
typedef struct WrEllipse {
    double x, y;                                /* centre */
    double ux, uy;                              /* the long axis, unit, y down */
    double aspect, radius2;                     /* length over breadth; half the length, squared */
    double radius, inner, inner2, inverse_edge; /* of the round brush's falloff, as in WrCapsule */
    double a, b, c; /* a ex^2 + 2 b ex ey + c ey^2 is the square of the distance */
    float alpha, hardness, slope_in, slope_out; /* 1/k - 1, k/(1 - k) of hardness k */
    float inverse_radius2;
    bool rounded; /* the round brush's falloff */
} WrEllipse;

/* Columns, not wrapped; low > high: none. Cut to +-2^30. */
typedef struct WrDabRows {
    int low[WR_TILE], high[WR_TILE];           /* all */
    int flat_low[WR_TILE], flat_high[WR_TILE]; /* of equal coverage */
} WrDabRows;

/* What of a dab lies in one tile. */
typedef struct WrDabPart {
    const WrDabRows *rows;
    int y, count; /* unwrapped row of the first one; rows, of which row k is rows' k */
    int x;        /* unwrapped column of the tile's column 0 */
    int low,
        high; /* columns of the tile, 0..WR_TILE - 1, of which it may change any; best whole WR_DAB_BLOCKs */
} WrDabPart;

typedef struct WrBrushKernels {
    const char *name; /* "v1", "v3", "v4": levels of x86-64; v1 is plain C everywhere */

    /* cover[i] = coverage times pressure of texel (x + i, y); for motions of length 0, and others. */
    void (*dab)(const WrCapsule *capsule, double y, double x, int count, float *cover);
    void (*motion)(const WrCapsule *capsule, double y, double x, int count, float *cover);

    /* The same for an ellipse: the round brush's falloff, libmypaint's (dab.h). */
    void (*ellipse)(const WrEllipse *ellipse, double y, double x, int count, float *cover);
    void (*soft)(const WrEllipse *ellipse, double y, double x, int count, float *cover);

    /* Where the rows y .. y + count - 1 of a dab lie: all that it reaches, and what lies within its inner
     * radius; a little wide and a little narrow. */
    void (*dab_rows)(const WrCapsule *capsule, double y, int count, WrDabRows *rows);
    /* What `dab` and then `add` do to one tile's texels. heights: the texel of that tile in the first row and
     * column 0. Texels beside the part that the dab reaches keep their bits. */
    void (*dab_tile)(const WrCapsule *capsule, const WrDabPart *part, double strength,
                     float *heights);

    /* Whether any cover[i] < fresh[i]; whether any cover[i] < most. */
    bool (*grows)(const float *cover, const float *fresh, int count);
    bool (*below)(const float *cover, float most, int count);
    /* cover[i] = the larger of it and fresh[i] */
    void (*join)(float *cover, const float *fresh, int count);

    /* cover[i] = 1 - (1 - cover[i]) (1 - fresh[i]) */
    void (*over)(float *cover, const float *fresh, int count);
    /* cover[i] + rest[i] = the same and fresh[i], in twice float's precision */
    void (*sum)(float *cover, float *rest, const float *fresh, int count);
    /* What `soft` and then `over` do. */
    void (*soft_over)(const WrEllipse *ellipse, double y, double x, int count, float *cover);

    /* Heights flow between each texel and four neighbours, by a fifth of the difference times the
     * smaller of both weights. f and w point into rows with `stride` texels before and after;
     * f_up, w_up, f_down, w_down: the rows `stride` away. |differences| may be beyond float's range.
     * count: any. */
    void (*flow)(const float *f, const float *w, const float *f_up, const float *w_up,
                 const float *f_down, const float *w_down, int stride, int count, float *out);

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
