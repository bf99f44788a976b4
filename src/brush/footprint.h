/* footprint.h - the footprint of one dab or motion: affected texels and their coverage.
   Private to this module.
   Texel coordinates as in capsule.h. */
#pragma once
#include "brush/brush.h"
#include "brush/dab.h"
#include "brush/brush_kernels.h"
#include "brush/tip.h"

#include <stdbool.h>

/* A brush of at most this radius paints single texels; slightly more than sqrt(1/2). */
#define WR_THIN 0.70711

typedef enum WrShapeKind {
    WR_SHAPE_TEXEL, /* the single texel at (x, y), which are integers */
    WR_SHAPE_DAB,   /* round: capsule */
    WR_SHAPE_MOTION,
    WR_SHAPE_ELLIPSE, /* the round brush's falloff or libmypaint's: ellipse */
    WR_SHAPE_TIP
} WrShapeKind;

typedef struct WrDabShape {
    WrShapeKind kind;
    double x, y, dx, dy;     /* centre, or start and vector of a motion; not wrapped */
    double reach_x, reach_y; /* maximum distances from (x, y) or the motion with coverage */
    double strongest;        /* upper bound of coverage */
    const WrBrushKernels *kernels;
    WrCapsule capsule;
    WrEllipse ellipse; /* of a tip: its axes, half length and half breadth, instead of the radius */
    WrTipView tip;
    double across, down; /* tip: pictures a texel */
    bool flips;
} WrDabShape;

/* The field defines size and wrap; brush from wr_brush_sane. False if nothing is painted. */
bool wr_shape_of_motion(const WrField *field, const WrBrush *brush, double x, double y, double dx,
                        double dy, double pressure_start, double pressure_end, WrDabShape *shape);
bool wr_shape_of_texel(const WrField *field, double x, double y, double alpha, WrDabShape *shape);
/* A dab transformed by `copy`. tip: NULL, or replaces the dab's falloff. */
bool wr_shape_of_dab(const WrField *field, const WrTip *tip, const WrDab *dab, const WrCopy *copy,
                     WrDabShape *shape);

/* The column range *low .. *high on row y, slightly enlarged and not rounded; false if it misses the
 * row. */
bool wr_shape_span(const WrDabShape *shape, double y, double *low, double *high);
/* fresh[i] = coverage of texel (x + i, y); count as in brush_kernels.h. */
void wr_shape_row(const WrDabShape *shape, double y, double x, int count, float *fresh);
