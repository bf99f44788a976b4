/* paint.h - coverage put into a height table, tile by tile.
   Layer 2, inside this room. Texel coordinates as in capsule.h. */
#pragma once
#include "brush/kern.h"

/* Where paint goes. With `start` and `cover`, each texel is made anew from its height in `start` and the
 * largest coverage it ever had; without, each call must stand for a whole stroke, and touches each texel
 * at most once if the motion's length is 0. */
typedef struct WrPaint {
    WrField *field;           /* borrowed */
    const WrField *start;     /* the table as it was; borrowed, or NULL */
    WrField *cover;           /* coverage so far, 0 in a fresh tile; same size; borrowed, or NULL */
    WrField *mark;            /* what is painted at all, as in WrBrushGround; with `cover` only */
    const WrField *selection; /* the same */
    WrBrush brush;            /* from wr_brush_sane */
    const WrBrushKernels *kernels;
} WrPaint;

/* The brush with every value in its range: NaN becomes 0, what is too large the largest. */
WrBrush wr_brush_sane(const WrBrush *brush);

/* Texel coordinates of (u, v); on a periodic axis -0.5 <= x < W - 0.5, on a clamped one cut at +-4e9.
 * False, and nothing written, if either is not finite. */
bool wr_paint_place(const WrField *field, double u, double v, double *x, double *y);

/* Draw from (x, y) to (x + dx, y + dy) with pressures 0..1 at the ends, between them in proportion. */
void wr_paint_motion(WrPaint *paint, double x, double y, double dx, double dy,
                     double pressure_start, double pressure_end);
