/* brush.h - brushes: dabs and strokes that change a height table.

   Double arithmetic in a fixed order, so a replay produces the same bits on every processor and any number
   of threads, however the motion was divided into events. One exception: positions and sizes of a
   preset's dabs are computed by libmypaint (preset.h). Coverage c of the round brush at distance d from
   the path's nearest point, radius R, hardness k, in texels:

     inner = max(min(k R, R - 1), 0.70711 > sqrt(1/2)),  c = 1 for d <= inner,  0 for d >= R,

   a smoothstep between: so the texel that contains the centre is always fully covered. If R <= 0.70711
   a dab is the single texel that contains its centre, a stroke a line one texel wide.

   Two kinds of modes (mode.h):

   covering   a texel's height is computed from its height before the stroke and from its coverage by
              the whole stroke, A: so crossing one's own stroke does not double it, and the division
              into events has no effect (HC75).
                A = max over the stroke of c p         flow 1 (the round brush and tips)
                A = 1 - product of (1 - flow c p)      flow < 1, and presets: builds up to 1
                A = sum of flow c p                    buildup: unlimited, also by crossing and resting
              with p the pen's pressure; then min(A, 1) opacity is used, with buildup A opacity.
   moving     each dab changes the present heights, by the fraction c p flow opacity (smooth, smear,
              ...); so do presets that smudge, in any mode. Dabs have a fixed distance along the path.

   Modes with a target never overshoot it: there A is limited to 1. Our own brush makes no dab while it
   rests; presets may. Moving dabs copy their box of the table; without memory for that (about 16 bytes
   per texel) they do nothing. Heights stay finite: they are limited to +-FLT_MAX. Non-finite brush
   values are replaced by 0 (NaN) or the end of their range. Distances are torus distances on periodic
   axes: each texel is changed once for any R (HC69, HC70, HC73). Nothing is painted beyond the ends of
   a clamped axis, but a dab may be centred there. */
#pragma once
#include "base/vec.h"
#include "brush/symmetry.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrMeshTexels WrMeshTexels;
typedef struct WrModeWork WrModeWork;
typedef struct WrPool WrPool;
typedef struct WrProgress WrProgress;

typedef enum WrBrushMode {
    /* covering */
    WR_BRUSH_RAISE, /* F + strength A */
    WR_BRUSH_LOWER, /* F - strength A */
    WR_BRUSH_TO, /* towards `to` by A min(strength, |to - F|); with buildup min(A strength, ...) */
    WR_BRUSH_FLATTEN, /* towards the height of the texel under the stroke's first sample */
    WR_BRUSH_LIFT,    /* raise valleys: towards max(F, to) */
    WR_BRUSH_CUT,     /* cut peaks: towards min(F, to) */
    WR_BRUSH_ERASE,   /* restores the heights below the layer (WrBrushGround) */
    WR_BRUSH_CLONE,   /* towards the heights at an offset, as before the stroke */
    WR_BRUSH_SHARPEN, /* away from the local mean within `reach` */
    WR_BRUSH_DILATE,  /* towards the largest height within `reach` texels */
    WR_BRUSH_ERODE,   /* towards the smallest */
    /* moving */
    WR_BRUSH_SMOOTH, /* heights diffuse between neighbours up to `reach` apart: preserves the mean
                        (HC77) */
    WR_BRUSH_LEVEL,  /* towards the best-fitting plane under the dab */
    WR_BRUSH_PINCH,  /* heights are moved towards the path */
    WR_BRUSH_SMEAR,  /* heights are dragged along the path */
    WR_BRUSH_MODE_COUNT
} WrBrushMode;

/* Members of WrBrush that a mode uses, besides the common ones. */
enum { WR_USES_STRENGTH = 1, WR_USES_TO = 2, WR_USES_REACH = 4, WR_USES_SOURCE = 8 };

typedef struct WrBrushModeInfo {
    const char *name, *label, *help;
    bool moves;
    unsigned uses;                 /* WR_USES_ bits */
    double spacing;                /* default of brush.spacing, relative to the radius */
    const struct WrModeWork *work; /* implementation: private to this module, mode.h */
} WrBrushModeInfo;
extern const WrBrushModeInfo wr_brush_modes[WR_BRUSH_MODE_COUNT];

typedef enum WrBrushPressure { /* effect of pen pressure for the round brush and tips */
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
    double strength; /* table units, may be negative */
    WrBrushMode mode;
    double to;      /* table units; modes that use it */
    double opacity; /* 0..1, of the whole stroke */
    double flow;    /* 0..1, of each dab */
    bool buildup;
    double spacing; /* between dabs, relative to the radius, 0.01..10, at least 1/4 texel; 0: the
                     default of the tip or the mode, divided by the aspect */
    double reach;   /* texels, 1..256, integer, for modes that use it; 0: an eighth of the radius.
                     Within reach are texels at most reach + 1/2 away; smooth exchanges heights
                     between texels reach, reach/2, ..., 1 apart along rows and columns */
    WrBrushPressure pressure;  /* presets have their own curves */
    double source_u, source_v; /* clone: the source is (u + source_u, v + source_v) */
    const WrPreset *preset;    /* borrowed, shared by strokes; NULL: the round brush or a tip */
    uint64_t seed;             /* of all randomness in a stroke */
    const WrTip *tip;          /* replaces the round falloff; borrowed, shared by strokes */
    double angle_deg;          /* rotates a tip or an ellipse anticlockwise, as seen */
    double aspect;             /* >= 1, length over breadth; 1: round. For tips: stretch across */
    bool follow;               /* the angle is relative to the path's direction */
    double jitter_place;       /* relative to the radius, 0.. */
    double jitter_angle_deg;   /* 0..180, in both directions */
    double jitter_size;        /* 0..1, reduces the radius */
    WrSymmetry symmetry;
} WrBrush;

/* radius 16, hardness 0.5, strength 0.1, raise, opacity and flow 1, no symmetry, the rest 0. */
WrBrush wr_brush_default(void);

typedef struct WrSample {
    double u, v;     /* any finite value; wraps on periodic axes */
    double pressure; /* 0..1; others are clamped, NaN becomes 0 (HC74) */
    double tilt_x,
        tilt_y;      /* -1..1, to the right and towards the user; the round brush ignores them */
    double seconds;  /* since the stroke's start; a motion without times is assumed to have 400
                       texels/s */
    double turn_deg; /* of the pen about its own axis, clockwise; any angle; only presets use it */
    WrVec3 p; /* on a mesh: the point, instead of u and v; the nearest of the surface counts */
} WrSample;

/* The distance in texels up to which coverage is 1, and coverage 0..1 at distance d >= 0 from the path
 * (for outlines and previews; not for a radius of 0.70711 or less, which paints single texels). */
double wr_brush_inner(const WrBrush *brush);
double wr_brush_coverage(const WrBrush *brush, double d);

/* One dab at (u, v), with the bits of a stroke of one sample at pressure 1. Does nothing if u or v is
 * not finite. */
void wr_brush_dab(WrField *field, const WrBrush *brush, double u, double v);

/* A table with its associated tables, all of one size. */
typedef struct WrBrushGround {
    WrField *field; /* the painted table */
    WrField
        *mark; /* raised to the coverage, max(mark, s c), where anything is painted; erasing lowers
                  it to mark (1 - s A); NULL: none */
    const WrField
        *selection; /* s, 0..1: multiplies coverage; where it is 0, texels keep their bits; NULL: 1
                       everywhere */
    /* Target of erasing: `below`, or `neutral` everywhere if that is NULL. */
    const WrField *below;
    float neutral;
    WrPool *pool; /* for large dabs; the bits do not depend on it; NULL: this thread */
    const WrProgress *progress; /* only for wr_brush_fill; NULL: not cancellable */
    /* Strokes are on this mesh (mesh_texels.h), of a table of that size; its texels are radius' and the other
       lengths' unit. They are dabs, without the table's symmetry; the target of clone is that of the table. NULL: strokes are on the table. */
    WrMeshTexels *mesh;
    bool clips; /* on a mesh: faces turned away from `eye` are not painted */
    WrVec3 eye; /* in the object's space */
    unsigned
        mirrors; /* on a mesh: axes across which mirrors stand, 1 x, 2 y, 4 z; each dab is drawn again in all */
    WrVec3 mirror_at; /* where they cross, in the object's space */
} WrBrushGround;

/* wr_brush_dab on a table with mark and selection. */
void wr_brush_dab_on(const WrBrushGround *ground, const WrBrush *brush, double u, double v);

typedef struct WrStroke WrStroke;

/* Begins a stroke on field, which must outlive it and must not be written by others meanwhile. The
   caller owns the stroke. */
WrStroke *wr_stroke_new(WrField *field, const WrBrush *brush);
/* Begins a stroke on a table with mark and selection: the same bits where the selection is 1. */
WrStroke *wr_stroke_new_on(const WrBrushGround *ground, const WrBrush *brush);

/* Applies one more sample at once: the first makes a dab, later ones are connected to the previous one
   along the shortest way round (HC73), with interpolated pressure. The cost depends on the covered
   area, not on the table's size. For the round brush in covering modes, a sample within max(1/4, R/32)
   texel of the last one drawn, and within 1/128 of its pressure, is deferred: the next sample that is
   not draws it too, unless it is on the straight line (within 1/4 texel), or was replaced by another
   meanwhile. The result depends only on the samples. A sample whose u or v is not finite is skipped. */
void wr_stroke_add(WrStroke *stroke, WrSample sample);
/* wr_stroke_add in two steps, so that a large brush never delays the pointer: queues the sample; draws
   queued samples for about this time (at least one piece of work). True while more is left to draw. The
   bits do not depend on the division of work. */
void wr_stroke_push(WrStroke *stroke, WrSample sample);
bool wr_stroke_work(WrStroke *stroke, double seconds);
/* Number of samples, from the first, that the heights hold; the last one of them at least. */
int64_t wr_stroke_drawn(const WrStroke *stroke);
/* Draws the rest, and a deferred sample, so that the stroke ends at the pen's position; the heights
   remain. NULL is allowed. */
void wr_stroke_finish(WrStroke *stroke);
/* Frees the stroke without drawing the rest: for a stroke that is cancelled. */
void wr_stroke_abandon(WrStroke *stroke);

/* Fills a shape given by `coverage` (0..1, the table's size): applies a covering mode with A = coverage
   opacity everywhere at once. False and an error for a moving mode, and, with a part filled, when the
   ground's progress is cancelled. first_u, first_v: position of flatten's height. Symmetry does not
   apply. */
bool wr_brush_fill(const WrBrushGround *ground, const WrBrush *brush, const WrField *coverage,
                   double first_u, double first_v, WrError *err);
