/* brush.h - brushes: dabs and strokes that change a height table.
   Plain double arithmetic in a fixed order, so a replay gives the same bits on every processor
   and any number of threads, however the motion was cut into events. One exception: where the dabs of a
   preset fall, and how large they are, is libmypaint's arithmetic (preset.h).

   Coverage c of the round brush at distance d from the path's nearest point, radius R, hardness k, in
   texels:
     inner = max(min(k R, R - 1), 0.70711 > sqrt(1/2)),  c = 1 for d <= inner,  0 for d >= R,
     a smoothstep between: so the texel that holds the centre is always fully covered.
   Where R <= 0.70711 a dab is the one texel that holds its centre, a stroke a line one texel wide.

   Two kinds of modes (mode.h):

   covering   a texel's height is made anew from the height that it had when the stroke began, and from
              its coverage by the whole stroke, A: so crossing one's own stroke does not double it, and
              events do not matter (HC75).
                A = max over the stroke of c p         flow 1 (the round brush and tips)
                A = 1 - product of (1 - flow c p)      flow < 1, and presets: builds up to 1
                A = sum of flow c p                    buildup: without end, also by crossing and resting
              with p the pen's pressure; then A counts as min(A, 1) opacity, with buildup as A opacity.
   moving     each dab changes the heights that it finds, by the part c p flow opacity (smooth, smear,
              ...); so do presets that smudge, in any mode. Dabs lie a fixed way apart along the path.

   Modes that lead towards something never lead beyond it: there no A counts for more than 1. The brush of
   our own makes no dab while it rests; presets may. Moving dabs copy their box of the table; without
   memory for that (about 16 bytes a texel) they do nothing.

   Heights stay finite: they stop at +-FLT_MAX. Not finite brush values count as 0 (NaN) or as the end of
   their range. Distances are torus distances on periodic axes: each texel is touched once whatever R
   (HC69, HC70, HC73). Off the ends of a clamped axis there is nothing to paint; a dab may be centred
   there. */
#pragma once
#include "brush/symmetry.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrModeWork WrModeWork;
typedef struct WrPool WrPool;
typedef struct WrProgress WrProgress;

typedef enum WrBrushMode {
    /* covering */
    WR_BRUSH_RAISE, /* F + strength A */
    WR_BRUSH_LOWER, /* F - strength A */
    WR_BRUSH_TO, /* towards `to` by A min(strength, |to - F|); with buildup min(A strength, ...) */
    WR_BRUSH_FLATTEN, /* towards the height of the texel under the stroke's first sample */
    WR_BRUSH_LIFT,    /* lift floors: towards max(F, to) */
    WR_BRUSH_CUT,     /* cut peaks: towards min(F, to) */
    WR_BRUSH_ERASE,   /* back to what lies below the layer (WrBrushGround) */
    WR_BRUSH_CLONE,   /* towards the heights at an offset, as they were when the stroke began */
    WR_BRUSH_SHARPEN, /* away from the local mean within `reach` */
    WR_BRUSH_DILATE,  /* towards the largest height within `reach` texels */
    WR_BRUSH_ERODE,   /* towards the smallest */
    /* moving */
    WR_BRUSH_SMOOTH, /* heights flow between neighbours up to `reach` apart: the mean stays (HC77) */
    WR_BRUSH_LEVEL,  /* towards the plane that fits best under the dab */
    WR_BRUSH_PINCH,  /* heights are drawn towards the path */
    WR_BRUSH_SMEAR,  /* heights are dragged along the path */
    WR_BRUSH_MODE_COUNT
} WrBrushMode;

/* What of WrBrush a mode goes by, besides what all do. */
enum { WR_USES_STRENGTH = 1, WR_USES_TO = 2, WR_USES_REACH = 4, WR_USES_SOURCE = 8 };

typedef struct WrBrushModeInfo {
    const char *name, *label, *help;
    bool moves;
    unsigned uses;                 /* WR_USES_ bits */
    double spacing;                /* where brush.spacing is 0, of the radius */
    const struct WrModeWork *work; /* what it does: inside this room, mode.h */
} WrBrushModeInfo;
extern const WrBrushModeInfo wr_brush_modes[WR_BRUSH_MODE_COUNT];

typedef enum WrBrushPressure { /* what the pen's pressure of the round brush and of tips turns */
                               WR_PRESSURE_STRENGTH, /* coverage */
                               WR_PRESSURE_SIZE,     /* radius */
                               WR_PRESSURE_BOTH,
                               WR_PRESSURE_NONE,
                               WR_PRESSURE_COUNT
} WrBrushPressure;
extern const char *const wr_brush_pressures[WR_PRESSURE_COUNT]; /* "strength", ... */

typedef struct WrPreset WrPreset; /* preset.h */
typedef struct WrTip WrTip;       /* tip.h */

typedef struct WrBrush {
    double radius;   /* texels, 0..1e9; 0 paints nothing; below sqrt(1/2) one texel */
    double hardness; /* 0..1 */
    double strength; /* table units, any sign */
    WrBrushMode mode;
    double to;      /* table units; modes that use it */
    double opacity; /* 0..1, of the whole stroke */
    double flow;    /* 0..1, of each dab */
    bool buildup;
    double
        spacing;  /* of the radius, between dabs, 0.01..10, at least 1/4 texel; 0: the tip's or the
                       mode's own, over the aspect */
    double reach; /* texels, 1..256, whole, modes that use it; 0: an eighth of the radius. Within
                       reach are texels at most reach + 1/2 away; smooth lets heights flow between
                       those reach, reach/2, ..., 1 apart along rows and columns */
    WrBrushPressure pressure;  /* presets have their own curves */
    double source_u, source_v; /* clone: heights come from (u + source_u, v + source_v) */
    const WrPreset *preset;    /* borrowed, shared by strokes; NULL: the round brush or a tip */
    uint64_t seed;             /* of all that is random in a stroke */
    const WrTip *tip;          /* in place of the round falloff; borrowed, shared by strokes */
    double angle_deg;          /* turns a tip or an ellipse anticlockwise, as seen */
    double aspect;             /* >= 1, length over breadth; 1: round. Of tips: stretch across */
    bool follow;               /* the angle counts from the path's direction */
    double jitter_place;       /* of the radius, 0.. */
    double jitter_angle_deg;   /* 0..180, either way */
    double jitter_size;        /* 0..1, down from the radius */
    WrSymmetry symmetry;
} WrBrush;

/* radius 16, hardness 0.5, strength 0.1, raise, opacity and flow 1, no symmetry, the rest 0. */
WrBrush wr_brush_default(void);

typedef struct WrSample {
    double u, v;     /* any finite value; wraps on periodic axes */
    double pressure; /* 0..1; others are clamped, NaN counts as 0 (HC74) */
    double tilt_x,
        tilt_y;     /* -1..1, to the right and towards the user; the round brush ignores them */
    double seconds; /* since the stroke's start; a motion without time counts as 400 texels/s */
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
    WrField
        *mark; /* raised to the coverage, max(mark, s c), where anything is painted; erasing lowers
                       it to mark (1 - s A); NULL: not kept */
    const WrField
        *selection; /* s, 0..1: coverage counts as s c, and where it is 0 texels keep their
                                 bits; NULL: 1 everywhere */
    /* What erasing leads to: `below`, or `neutral` everywhere where that is NULL. */
    const WrField *below;
    float neutral;
    WrPool *pool; /* for large dabs; the bits do not depend on it; NULL: this thread */
    const WrProgress *progress; /* of wr_brush_fill alone; NULL: it is not stopped */
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
   never by the table's size. Of the round brush in covering modes, a sample within max(1/4, R/32) texel of
   the last one drawn, and within 1/128 of its pressure, waits: the next one that is not draws it too,
   unless it lies on the way (within 1/4 texel), or unless another took its place meanwhile. What comes
   out depends on the samples alone. A sample whose u or v is not finite is left out. */
void wr_stroke_add(WrStroke *stroke, WrSample sample);
/* The same in two steps, so that a large brush never keeps the pointer waiting: take the sample, and draw
   what was taken for about that long (at least one piece of work). True while more is left to draw. The
   bits do not depend on how the work was cut. */
void wr_stroke_push(WrStroke *stroke, WrSample sample);
bool wr_stroke_work(WrStroke *stroke, double seconds);
/* Draws what is left, and a sample that still waits, so that the stroke ends where the pen did; the
   heights stay. NULL is fine. */
void wr_stroke_free(WrStroke *stroke);
/* The same without drawing what is left: for a stroke that is given up. */
void wr_stroke_abandon(WrStroke *stroke);

/* Texels of a shape covered by `coverage` (0..1, the table's size): what a covering mode does with A =
   coverage opacity, at once and everywhere. False and an error for a moving mode, and, with a part filled,
   where the ground's progress says stop. first_u, first_v: where flatten takes its height. Symmetry does
   not apply. */
bool wr_brush_fill(const WrBrushGround *ground, const WrBrush *brush, const WrField *coverage,
                   double first_u, double first_v, WrError *err);
