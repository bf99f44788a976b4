/* points_pad.h - editable points of a curve in a pad: drag to move, click to add, Delete or drag outside to remove;
   arrow keys move the last used point. The caller draws the curve. */
#pragma once
#include "ui/toolkit/gui.h"

#include <stdbool.h>

/* Range of the pad from left to right and from bottom to top. */
typedef struct WrPointsSpan {
    double left, right, low, high;
} WrPointsSpan;

/* State between frames; zero-initialised. */
typedef struct WrPointsState {
    int held;          /* index of the dragged point, from 1; 0: none */
    int chosen;        /* index of the point for keys, from 1; 0: none */
    WrPointsSpan span; /* range at the start of the drag, fixed until its end */
} WrPointsState;

/* Constraints of a curve. */
typedef struct WrPointsRules {
    int least, most; /* numbers of points */
    bool inside;     /* limited to the pad vertically */
    bool ends;       /* limited to the pad horizontally */
    double reach;    /* hit radius of a point, units; 0: default */
} WrPointsRules;

/* Handle one frame of the pad. span: the range for now; hand->span is the range in use. value: the number of points,
 * then x, y of each, x increasing; room for rules->most. True if a point was changed. */
bool wr_points_move(const WrPad *pad, const WrPointsSpan *span, const WrPointsRules *rules,
                    WrPointsState *hand, double *value);

/* Draw the points as discs, and y(x) from the left to the right edge as a line; at(ctx, x, &y) returns false where
   there is no curve. */
typedef bool WrPointsAt(const void *ctx, double x, double *y);
void wr_points_draw(const WrPad *pad, const WrPointsState *hand, const double *value,
                    WrPointsAt *at, const void *ctx);
