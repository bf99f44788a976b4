/* plot.h - plot of a benchmark: error against time, both logarithmic. It is described once for all canvases: axes, ticks, points,
   the Pareto front as steps, the reference's own error, a ring around the scene's own setting. Pixels; y points down. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrAccuracyBenchmark WrAccuracyBenchmark;
typedef struct WrRung WrRung;

typedef struct WrPlotSpot {
    double x, y;
} WrPlotSpot;

/* An axis; 0 < low < high. */
typedef struct WrPlotAxis {
    double low, high;
} WrPlotAxis;

/* The axis from one round number (1, 2 or 5 times a power of ten) to another that contains all positive finite values
 * with a small margin. At least half a decade long. False if there are no such values. */
bool wr_plot_axis(const double *values, int count, WrPlotAxis *out);
/* Round numbers on the axis, ascending: 1, 2 and 5 times powers of ten if at most `room` are on it, else powers of
 * ten, else every second power, and so on. Returns their number, at most `room`. */
int wr_plot_ticks(const WrPlotAxis *axis, double *out, int room);
/* Position of a value: 0 at low, 1 at high, logarithmic; 0 for values that are not positive. */
double wr_plot_place(const WrPlotAxis *axis, double value);
/* Index of the point nearest to (x, y) within `reach`, or -1. */
int wr_plot_nearest(const WrPlotSpot *points, int count, double x, double y, double reach);

/* The smallest 1, 2 or 5 times a power of ten that is not below `value`, as the end of a scale from 0; 1 if value is
 * not positive and finite. */
double wr_plot_round_up(double value);
/* A number for an axis or a table in at most 8 characters with at most three digits: "0.02", "12.5", "3e-05". Returns
 * text, of at least 16 bytes. */
char *wr_plot_number(double value, char *text);

#define WR_PLOT_TICKS 16 /* most ticks of an axis */
#define WR_PLOT_LINE 64  /* most points of a canvas's line */

typedef struct WrPlot {
    const WrAccuracyBenchmark *benchmark; /* borrowed */
    WrPlotAxis time, error;               /* ms; RMS */
    double x, y, w, h;                    /* area between the axes */
    WrPlotSpot *spots;  /* [benchmark->count]; far outside for a rung without a point */
    int *front, fronts; /* rungs on the Pareto front, fastest first */
} WrPlot;

/* True if a rung has a point: a measured approximation with a time and an error above 0. */
bool wr_plot_has_point(const WrRung *rung);
/* Finds axes and front; wr_plot_fini frees them. False if no rung has a point: then the axes are from 1 to 10. */
bool wr_plot_init(const WrAccuracyBenchmark *benchmark, WrPlot *out);
void wr_plot_fini(WrPlot *plot);
/* Finds the points for that area between the axes. */
void wr_plot_lay_out(WrPlot *plot, double x, double y, double w, double h);

typedef enum WrPlotInk {
    WR_PLOT_GRID,
    WR_PLOT_FRAME,
    WR_PLOT_LABEL,
    WR_PLOT_REFERENCE,
    WR_PLOT_FRONT,
    WR_PLOT_RING,
    WR_PLOT_SERIES /* + WrAxis, WR_AXIS_COUNT for combinations */
} WrPlotInk;

typedef struct WrPlotCanvas {
    void *ctx;         /* passed to the functions; borrowed */
    double unit;       /* width of a thin line, pixels */
    double text;       /* height of a line of text, pixels */
    int times, errors; /* ticks that fit, 2 to WR_PLOT_TICKS */
    /* a polyline of up to WR_PLOT_LINE points; width in pixels */
    void (*line)(void *ctx, const WrPlotSpot *points, int count, double width, WrPlotInk ink);
    /* a point of that series; radius in pixels */
    void (*mark)(void *ctx, WrPlotSpot at, double radius, WrPlotInk series);
    void (*ring)(void *ctx, WrPlotSpot at, double radius, double width);
    /* anchor 0: begins at x, 0.5: centred, 1: ends at x; y is the middle of the line */
    void (*word)(void *ctx, const char *word, double x, double y, double anchor, WrPlotInk ink);
} WrPlotCanvas;

/* Draws the laid out plot. reference: the label of the reference's own error. ringed: the rung with the ring, -1 for
   none. */
void wr_plot_draw(const WrPlot *plot, const WrPlotCanvas *canvas, const char *reference,
                  int ringed);

/* ---- labels ---- */

/* Positions of a plot's numbers without overlaps.
   Private to plot*.c and their test. */

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
