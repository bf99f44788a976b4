/* accuracy_schedule.h - schedule of the Accuracy panel's measurements: never during input or rotation, a moment after the
   last change, the error before the benchmark. Pure; tested without a window. */
#pragma once
#include <stdbool.h>

#define WR_ACCURACY_REST 0.4 /* seconds without change before the error is measured */
/* seconds without change before the benchmark is measured without a request */
#define WR_ACCURACY_BENCHMARK_REST 2.
/* seconds without change before comparison pictures and maps are rendered */
#define WR_ACCURACY_LOOK_REST 0.15
#define WR_FLICKER_SECONDS                                                                         \
    0.25 /* seconds for each of two alternating pictures: two cycles per second */

typedef enum WrAccuracyNext {
    WR_ACCURACY_NOTHING,
    WR_ACCURACY_ERROR,    /* error of the static view against the reference */
    WR_ACCURACY_BENCHMARK /* error and time of all settings */
} WrAccuracyNext;

/* Input of a decision. Times are readings of one clock, seconds. */
typedef struct WrAccuracyMoment {
    double now, changed_at; /* changed_at: last change of table, scene, rotation or view size */
    bool rests;             /* nothing is dragged or drawn, and the patch does not rotate */
    bool open;              /* the error is visible */
    bool plot_open;         /* the plot is visible */
    bool plot_asked;        /* the button was pressed */
    bool error_known, plot_known; /* known for the present state, or known to fail */
    bool busy;                    /* a measurement is running */
} WrAccuracyMoment;

/* The measurement to start now. *due becomes the clock of the next decision without an event, 0 if none. */
WrAccuracyNext wr_accuracy_next(const WrAccuracyMoment *moment, double *due);

/* True if the second of two alternating pictures is shown, which started at `since`. *next becomes the clock of the
   next change. */
bool wr_accuracy_flicker(double now, double since, double *next);

/* Fraction of the view left of the divider for a pointer at x, limited so that the divider stays reachable. */
double wr_accuracy_split_from_pointer(double x, double left, double width, double margin);

/* Size of a picture with the same aspect ratio and a longer side of at most `longest`. */
void wr_accuracy_picture_size(int width, int height, int longest, int *out_width, int *out_height);
