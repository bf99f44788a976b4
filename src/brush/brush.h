/* brush.h - the built-in round brush: dabs and strokes that raise, lower or level a height table.
   Layer 2. Ours and exact: plain double arithmetic in a fixed order, so a replay gives the same bits on
   every processor and any number of threads, however the motion was cut into events.

   Coverage c at distance d from the path's nearest point, radius R, hardness k, in texels:
     inner = max(min(k R, R - 1), sqrt(1/2) + a little),  c = 1 for d <= inner,  0 for d >= R,
     a smoothstep between: so the texel that holds the centre is always fully covered.
   raise: F + strength c   lower: F - strength c   to: F moves towards `to` by c * min(strength, |to - F|)
   A stroke covers each texel at most once: c is the largest over the whole stroke (times the pen's
   pressure there), so that a stroke that crosses itself does not double and events do not matter
   (HC75). Distances are torus distances on periodic axes: each texel is touched once whatever R
   (HC69, HC70, HC73). */
#pragma once
#include "field/field.h"

typedef enum WrBrushMode {
    WR_BRUSH_RAISE,
    WR_BRUSH_LOWER,
    WR_BRUSH_TO,
    WR_BRUSH_MODE_COUNT
} WrBrushMode;

typedef struct WrBrushModeInfo {
    const char *name, *label, *help;
} WrBrushModeInfo;
extern const WrBrushModeInfo wr_brush_modes[WR_BRUSH_MODE_COUNT];

typedef struct WrBrush {
    double radius;   /* texels, 0..1e9; 0 paints nothing; below sqrt(1/2) one texel */
    double hardness; /* 0..1 */
    double strength; /* table units, any sign */
    WrBrushMode mode;
    double to;       /* table units; mode `to` only */
} WrBrush;

WrBrush wr_brush_default(void); /* radius 16, hardness 0.5, strength 0.1, raise */

typedef struct WrSample {
    double u, v;            /* any finite value; wraps on periodic axes */
    double pressure;        /* 0..1; others are clamped, NaN counts as 0 (HC74) */
    double tilt_x, tilt_y;  /* -1..1; the round brush ignores them */
    double seconds;         /* since the stroke's start */
} WrSample;

/* One dab at (u, v). */
void wr_brush_dab(WrField *field, const WrBrush *brush, double u, double v);

typedef struct WrStroke WrStroke;

/* Begin a stroke on field, which must outlive it and must not be written to by others meanwhile.
   The caller owns the stroke. */
WrStroke *wr_stroke_new(WrField *field, const WrBrush *brush);
/* Apply one more sample at once: the first makes a dab, later ones join to the one before along the
   shortest way round (HC73). Cost goes by the area that it covers, never by the table's size. */
void wr_stroke_add(WrStroke *stroke, WrSample sample);
void wr_stroke_free(WrStroke *stroke); /* the heights stay */
