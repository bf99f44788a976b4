/* accuracy_plan.h - when what the Accuracy panel shows is measured: never while the hand works or the patch turns,
   a moment after the last change, the error before the ladder. Pure; tested without a window. */
#pragma once
#include <stdbool.h>

#define WR_ACCURACY_REST 0.4       /* seconds without change before the error is measured */
#define WR_ACCURACY_LADDER_REST 2. /* before the ladder is climbed without being asked for */
#define WR_ACCURACY_LOOK_REST 0.15 /* before pictures to compare and maps are made */
#define WR_FLICKER_SECONDS                                                                         \
    0.25 /* that each of two pictures is shown: two changes there and back a second */

typedef enum WrAccuracyNext {
    WR_ACCURACY_NOTHING,
    WR_ACCURACY_ERROR, /* of the resting view against the reference */
    WR_ACCURACY_LADDER /* error and time of all settings */
} WrAccuracyNext;

/* What is known at one moment. Times are of one clock, seconds. */
typedef struct WrAccuracyMoment {
    double now, changed_at; /* changed_at: table, scene, turn or size of the view became others */
    bool rests;             /* nothing is held or drawn, and the patch does not turn */
    bool open;              /* somebody looks at the error */
    bool plot_open;         /* somebody looks at the plot */
    bool plot_asked;        /* the button was pressed */
    bool error_known, plot_known; /* for what is seen now; or that they cannot be had */
    bool busy;                    /* something is being measured */
} WrAccuracyMoment;

/* What to begin now. *due becomes the clock at which to ask again though nothing happens, 0 if there is no such
 * time. */
WrAccuracyNext wr_accuracy_next(const WrAccuracyMoment *moment, double *due);

/* Is the second picture shown, of two that flicker since `since`? *next becomes the clock of the next change. */
bool wr_accuracy_flicker(double now, double since, double *next);

/* The share of the view left of the line between two pictures, for a pointer at x: kept where the line can be
 * grasped again. */
double wr_accuracy_split_at(double x, double left, double width, double margin);

/* The size of a picture of the same shape whose longer side is at most `longest`. */
void wr_accuracy_fit(int width, int height, int longest, int *out_width, int *out_height);
