/* brush.h - the built-in round brush: dabs and strokes that raise, lower or level a height table.
   Layer 2. Ours and exact: plain double arithmetic in a fixed order, so a replay gives the same bits on
   every processor and any number of threads, however the motion was cut into events.

   Coverage c at distance d from the path's nearest point, radius R, hardness k, in texels:
     inner = max(min(k R, R - 1), 0.70711 > sqrt(1/2)),  c = 1 for d <= inner,  0 for d >= R,
     a smoothstep between: so the texel that holds the centre is always fully covered.
   Where R <= 0.70711 a dab is the one texel that holds its centre, a stroke a line one texel wide.
   raise: F + strength c   lower: F - strength c   to: F moves towards `to` by c * min(strength, |to - F|)
   Heights stay finite: they stop at +-FLT_MAX. Not finite brush values count as 0 (NaN) or as the end of
   their range.
   A stroke covers each texel at most once: c is the largest over the whole stroke (times the pen's
   pressure there), so that a stroke that crosses itself does not double and events do not matter
   (HC75). Distances are torus distances on periodic axes: each texel is touched once whatever R
   (HC69, HC70, HC73). Off the ends of a clamped axis there is nothing to paint; a dab may be centred
   there. */
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
    double to; /* table units; mode `to` only */
} WrBrush;

WrBrush wr_brush_default(void); /* radius 16, hardness 0.5, strength 0.1, raise */

typedef struct WrSample {
    double u, v;           /* any finite value; wraps on periodic axes */
    double pressure;       /* 0..1; others are clamped, NaN counts as 0 (HC74) */
    double tilt_x, tilt_y; /* -1..1; the round brush ignores them */
    double seconds;        /* since the stroke's start */
} WrSample;

/* The distance in texels up to which coverage is 1, and coverage 0..1 at distance d >= 0 from the path
 * (for outlines and previews; not for a radius of 0.70711 or less, whose shape is the texel). */
double wr_brush_inner(const WrBrush *brush);
double wr_brush_coverage(const WrBrush *brush, double d);

/* One dab at (u, v), the same bits as a stroke of one sample at pressure 1. Nothing if u or v is not
 * finite. */
void wr_brush_dab(WrField *field, const WrBrush *brush, double u, double v);

/* A table with what belongs to it, all of one size. */
typedef struct WrBrushGround {
    WrField *field; /* what is painted on */
    WrField *
        mark; /* raised to the coverage, max(mark, s c), where anything is painted; NULL: not kept */
    const WrField
        *selection; /* s, 0..1: coverage counts as s c, and where it is 0 texels keep their bits;
                                 NULL: 1 everywhere */
} WrBrushGround;

/* The same as wr_brush_dab with neither mark nor selection. */
void wr_brush_dab_on(const WrBrushGround *ground, const WrBrush *brush, double u, double v);

typedef struct WrStroke WrStroke;

/* Begin a stroke on field, which must outlive it and must not be written to by others meanwhile.
   The caller owns the stroke. */
WrStroke *wr_stroke_new(WrField *field, const WrBrush *brush);
/* The same on a table with mark and selection: the same bits where the selection is 1. */
WrStroke *wr_stroke_new_on(const WrBrushGround *ground, const WrBrush *brush);
/* Apply one more sample at once: the first makes a dab, later ones join to the one before along the
   shortest way round (HC73), with the pressure between theirs. Cost goes by the area that it covers,
   never by the table's size. A sample within max(1/4, R/32) texel of the last one drawn, and within
   1/128 of its pressure, waits: the next one that is not draws it too, unless it lies on the way (within
   1/4 texel), or unless another took its place meanwhile. What comes out depends on the samples alone.
   A sample whose u or v is not finite is left out. */
void wr_stroke_add(WrStroke *stroke, WrSample sample);
/* Draws a sample that still waits, so that the stroke ends where the pen did; the heights stay. NULL is
   fine. */
void wr_stroke_free(WrStroke *stroke);
