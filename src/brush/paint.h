/* paint.h - positions in texels, sanitised brushes, and single dabs without a stroke.
   Private to this module.
   Texel coordinates as in capsule.h. */
#pragma once
#include "brush/shape.h"

#include <stdbool.h>

/* The brush with every value limited to its range: NaN becomes 0, larger values the largest; spacing
 * and reach of 0 become the mode's defaults. */
WrBrush wr_brush_sane(const WrBrush *brush);

/* Texel coordinates of (u, v); on a periodic axis -0.5 <= x < W - 0.5, on a clamped one limited to
 * +-4e9. False, with unchanged outputs, if either is not finite. */
bool wr_paint_place(const WrField *field, double u, double v, double *x, double *y);

/* One round dab of pressure 1 of a brush that consists of motions and needs neither the initial heights
 * nor copies. */
bool wr_paint_is_plain(const WrBrush *brush);
void wr_paint_dab(WrField *field, const WrBrush *brush, double x, double y);
