/* points_pad.h - points of a curve that are moved by hand over a pad: dragged, added by a click, taken away by dragging them
   out of it or by Delete; arrows move the one that was touched last. What the curve is, the caller draws. */
#pragma once
#include "ui/toolkit/gui.h"

#include <stdbool.h>

/* What the pad spans, from left to right and from bottom to top. */
typedef struct WrPointsSpan {
    double left, right, low, high;
} WrPointsSpan;

/* What is kept from picture to picture; zero at first. */
typedef struct WrPointsHand {
    int held;          /* the point under the pointer, from 1; 0: none */
    int chosen;        /* the one that keys move; likewise */
    WrPointsSpan span; /* that the pad had when the hold began, and keeps until its end */
} WrPointsHand;

/* The rules of a curve. */
typedef struct WrPointsRules {
    int least, most; /* points */
    bool inside;     /* they stay within the span from bottom to top */
    bool ends;       /* and from left to right */
    double reach;    /* units from a point that still are on it; 0: as usual */
} WrPointsRules;

/* One picture of the pad. span: as it would be now; hand->span is what it is. value: the number of points, then x, y of each,
 * x rising; room for rules->most. True if a point was changed. */
bool wr_points_move(const WrPad *pad, const WrPointsSpan *span, const WrPointsRules *rules,
                    WrPointsHand *hand, double *value);

/* The points as discs, and y(x) from the left to the right edge as a line; at(ctx, x, &y) is false where there is nothing. */
typedef bool WrPointsAt(const void *ctx, double x, double *y);
void wr_points_draw(const WrPad *pad, const WrPointsHand *hand, const double *value, WrPointsAt *at,
                    const void *ctx);
