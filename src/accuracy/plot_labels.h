/* plot_labels.h - positions of a plot's numbers without overlaps.
   Private to plot*.c and their test. */
#pragma once
#include "accuracy/plot.h"

typedef struct WrPlotBox {
    double x, y, w, h; /* upper left corner and size, pixels */
} WrPlotBox;

#define WR_PLOT_MARK 7 /* half the side of a point's mark */

/* The box of a number with that many digits. */
WrPlotBox wr_plot_number_box(WrPlotSpot middle, int number);

/* Finds the centres of the numbers 1 to `numbers`, which belong to points[0] to points[numbers - 1]: inside
   `frame`, without overlapping each other, a point or a box of `taken`, near their own points, and if possible
   nearer than to any other.

   points, count   all drawn points, those with numbers first
   taken, boxes    occupied boxes
   out             [numbers] */
void wr_plot_number_places(const WrPlotBox *frame, const WrPlotSpot *points, int count, int numbers,
                           const WrPlotBox *taken, int boxes, WrPlotSpot *out);

static inline int wr_plot_apart(const WrPlotBox *a, const WrPlotBox *b)
{
    return a->x + a->w <= b->x || b->x + b->w <= a->x || a->y + a->h <= b->y || b->y + b->h <= a->y;
}
