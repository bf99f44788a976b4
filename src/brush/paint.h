/* paint.h - places in texels, brushes put into range, and single dabs without a stroke.
   Private to this module. Texel coordinates as in capsule.h. */
#pragma once
#include "brush/shape.h"

#include <stdbool.h>

/* The brush with every value in its range: NaN becomes 0, what is too large the largest; spacing and reach
 * get their modes' own where they are 0. */
WrBrush wr_brush_sane(const WrBrush *brush);

/* Texel coordinates of (u, v); on a periodic axis -0.5 <= x < W - 0.5, on a clamped one cut at +-4e9.
 * False, and nothing written, if either is not finite. */
bool wr_paint_place(const WrField *field, double u, double v, double *x, double *y);

/* One round dab of pressure 1 of a brush that goes by motions and needs neither start nor copies. */
bool wr_paint_is_plain(const WrBrush *brush);
void wr_paint_dab(WrField *field, const WrBrush *brush, double x, double y);
