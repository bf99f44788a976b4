/* plot_labels.h - where a plot's numbers stand, so that none covers another or a point.
   Layer 6, private to plot*.c and their test. */
#pragma once

/* All in pixels, y upwards. */
typedef struct WrPlotSpot {
    double x, y;
} WrPlotSpot;

typedef struct WrPlotBox {
    double x, y, w, h; /* its lower left corner and its size */
} WrPlotBox;

#define WR_PLOT_MARK 7 /* a point's mark: half of its side */

/* What a number of that many digits takes. */
WrPlotBox wr_plot_number_box(WrPlotSpot middle, int number);

/* The middles of the numbers 1 to `numbers`, which belong to points[0] to points[numbers - 1]: inside `frame`, none over
 * another, over a point or over one of `taken`, near their own points, where they can nearer than to any other.
 *
 * points, count   all that are drawn, those with numbers first
 * taken, boxes    places that hold something else
 * out             [numbers] */
void wr_plot_number_places(const WrPlotBox *frame, const WrPlotSpot *points, int count, int numbers,
                           const WrPlotBox *taken, int boxes, WrPlotSpot *out);

static inline int wr_plot_apart(const WrPlotBox *a, const WrPlotBox *b)
{
    return a->x + a->w <= b->x || b->x + b->w <= a->x || a->y + a->h <= b->y || b->y + b->h <= a->y;
}
