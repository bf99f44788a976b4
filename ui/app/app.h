/* app.h - entry points of the window: a canvas with the table on the left, a rotating 3D preview on the right. The
   only header of ui/ for other modules. */
#pragma once
#include "ui/app/state/app_options.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;

/* Open the window and run it until it is closed. Returns the process's exit status: 0, or 1 with a message on
 * standard error if there is no display.
 *
 * Environment: WRINKLE_RENDERER=software|opengl, WRINKLE_SCALE=0.75..3 (scale of all widgets), WRINKLE_DIALOG=own
 * (never the native file dialog), WRINKLE_TIMING=1 (milliseconds to the first frame on standard error; a time of
 * wr_clock_seconds instead of 1: counted from there, and the window closes afterwards). Settings:
 * $XDG_CONFIG_HOME/wrinkle/window.conf; keys: keys.conf in that folder. */
int wr_app_run(const WrAppOptions *options);

/* The table of the module with the window, wrinkle_window.so. SDL brings some 45 libraries, which only the subcommand
   paint needs. The module calls functions of the program, which exports all of them. */
#define WR_WINDOW_VERSION 1
#define WR_WINDOW_SYMBOL "wr_window_table"
typedef struct WrWindowModule {
    int version; /* WR_WINDOW_VERSION */
    int (*run)(const WrAppOptions *options);
} WrWindowModule;

/* Latency of pointer input: milliseconds from the arrival of an event in the system to the first frame with its
   effect. */
typedef struct WrAppDelays {
    double half, most, nearly_all, all; /* percentiles of the events in ms (50, 95, 99, 100 %) */
} WrAppDelays;

typedef struct WrAppLatency {
    /* input */
    double radius;       /* of the brush, texels */
    double seconds;      /* duration of scribbling, 0.5..600 */
    bool turning;        /* the patch rotates meanwhile */
    int width, height;   /* of the window, pixels; 0: 1440 x 900 */
    double idle_seconds; /* idle period before, without rotation; 0: none */
    /* results */
    double idle; /* fraction of one processor, 0..: the program's load while idle */
    int64_t events, pictures;
    WrAppDelays pointer; /* the brush outline is at the pointer's position */
    WrAppDelays canvas;  /* the canvas shows everything the event has painted */
    WrAppDelays preview; /* the patch shows everything the event has painted */
} WrAppLatency;

/* Measure latency in a hidden window (no display needed): an idle period, then scribbling on the canvas, always the
 * same, at 125 events per second of real time. Paints on the session's document. Reads and writes no settings. Error:
 * no window, no measurement, interrupted. */
bool wr_app_latency(const WrAppOptions *options, WrAppLatency *latency, WrError *err);

/* Milliseconds from a change to its display in a hidden window. */
typedef struct WrAppMoments {
    /* input */
    /* commands, run in turns, NULL at the end; borrowed; NULL: the canvas is panned and zoomed instead */
    const char *const *lines;
    int rounds;        /* changes, 1..10000 */
    int width, height; /* of the window, pixels; 0: 1440 x 900 */
    /* results */
    WrAppDelays first;   /* the first frame of the canvas with the change */
    WrAppDelays exact;   /* the first such frame in which nothing is approximate */
    WrAppDelays preview; /* the patch shows the change; with lines only */
    /* bytes of the process's memory after the last change, with the window open; 0: unknown */
    uint64_t resident;
} WrAppMoments;

/* Measure changes in a hidden window (no display needed). With lines each change waits until everything is shown; pans
 * and zooms are sent 60 times per second like a drag, and `exact` is the time from the last to the exact frame. Changes
 * the session's document. Error: no window, a line fails, interrupted. */
bool wr_app_moments(const WrAppOptions *options, WrAppMoments *moments, WrError *err);
