/* app.h - the window: paint a table on the left, watch it wrinkle a turning patch on the right.
   Layer 7. The only header of ui/ that others include. */
#pragma once
#include "ui/state/app_options.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;

/* Open the window and stay until it is closed. Returns the process's exit status: 0, or 1 with a
 * message on standard error when there is no display to open it on.
 *
 * Environment: WRINKLE_RENDERER=software|opengl, WRINKLE_SCALE=0.75..3 (size of everything),
 * WRINKLE_DIALOG=own (never the desktop's file dialog), WRINKLE_TIMING=1 (milliseconds to the first
 * picture on standard error; a time of wr_clock_seconds: counted from there, and the window closes
 * after it). Settings: $XDG_CONFIG_HOME/wrinkle/window.conf; keys: keys.conf there. */
int wr_app_run(const WrAppOptions *options);

/* How soon a pointer's motion is seen: milliseconds from the moment that the system has an event until a
   picture of the window shows what it did. */
typedef struct WrAppDelays {
    double half, most, nearly_all, all; /* of the events: within this many ms (50, 95, 99, 100 %) */
} WrAppDelays;

typedef struct WrAppLatency {
    /* asked for */
    double radius;       /* of the brush, texels */
    double seconds;      /* of scribbling, 0.5..600 */
    bool turning;        /* the patch turns meanwhile */
    int width, height;   /* of the window, pixels; 0: 1440 x 900 */
    double idle_seconds; /* that nothing happens before, and nothing turns; 0: none */
    /* measured */
    double idle; /* of one processor, 0..: what the program takes while nothing happens */
    int64_t events, pictures;
    WrAppDelays pointer; /* the outline stands at the pointer's place */
    WrAppDelays canvas;  /* the table's picture holds all that the event paints */
    WrAppDelays preview; /* so does the patch's picture */
} WrAppLatency;

/* Open a window that nobody sees (without a display), leave it alone for a while, scribble on its canvas for a while, the
 * same each time, at 125 events a second of real time, and measure. The session's document is painted on.
 * Reads and writes no settings. Error: no window, nothing measured, interrupted. */
bool wr_app_latency(const WrAppOptions *options, WrAppLatency *latency, WrError *err);
