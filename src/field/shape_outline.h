/* shape_outline.h - outlines of shapes as point lists: rounded rectangles, ellipses, polygons, Bezier
   paths.

   Shapes keep their proportions in texels: they are rotated there, because rotation in a cell that is
   not square would shear them. Only + - * / sqrt and base/exactmath.h: the same bits on every
   processor. */
#pragma once
#include "field/select.h"

#include <stdbool.h>

#define WR_SHAPE_OUTLINE_POINTS 1000000 /* maximum */

typedef struct WrShapeOutline {
    WrSelectPoint *points; /* [count], owned; not reduced to the table */
    int count;
    bool closed; /* closed: the last point joins the first */
} WrShapeOutline;
void wr_shape_outline_fini(WrShapeOutline *figure); /* a zeroed one is allowed */

/* Common parameters: like defines the size; tolerance is the maximum distance, in texels, of a curve
 * from its chords, above 0. Points must be finite and within WR_SELECT_REACH. On failure: false and an
 * error, *out unchanged, for values out of range or more than WR_SHAPE_OUTLINE_POINTS points. turn_deg
 * is anticlockwise as seen, about the middle. */

/* A rectangle with the corners a and b, from its lower left corner anticlockwise. corner: radius in
 * texels, 0 or more, limited to half the shorter side. */
bool wr_shape_outline_rectangle(const WrField *like, WrSelectPoint a, WrSelectPoint b,
                                double corner, double turn_deg, double tolerance,
                                WrShapeOutline *out, WrError *err);
/* radii: in fractions of the cell, 0 or more. From its right end anticlockwise. */
bool wr_shape_outline_ellipse(const WrField *like, WrSelectPoint middle, WrSelectPoint radii,
                              double turn_deg, double tolerance, WrShapeOutline *out, WrError *err);
/* points: [count], 3 or more. */
bool wr_shape_outline_polygon(const WrSelectPoint *points, int count, WrShapeOutline *out,
                              WrError *err);
/* Cubic Bezier curves: the start, then for each curve two handles and its end; count = 3 n + 1. A curve
 * is divided into m equal steps of its parameter; the chords are then within |B''| / (8 m^2) of it, and
 * |B''| <= 6 max(|p0 - 2 p1 + p2|, |p1 - 2 p2 + p3|). */
bool wr_shape_outline_path(const WrField *like, const WrSelectPoint *points, int count, bool closed,
                           double tolerance, WrShapeOutline *out, WrError *err);
