/* stroke_input.h - strokes by hand, drawn a few milliseconds a picture. */
#pragma once
#include "ui/state/app_state.h"
#include "ui/state/roster.h"
#include "ui/input/stroke_smoothing.h"

#include "base/array.h"
#include "brush/brush.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrPointer WrPointer;
typedef struct WrText WrText;

/* One stroke: being drawn by the session, or waiting for the one before it to be done. */
typedef struct WrStrokeJob {
    char *head; /* the command without points, owned; NULL once the session has it */
    WR_ARRAY(WrSample) samples; /* not handed to the session yet */
    bool released;              /* the pointer let go: no more will come */
    int waits; /* its number while it waits for what runs beside the window (ui/state/busy.h); else 0 */
} WrStrokeJob;

typedef struct WrBrushHand {
    WR_ARRAY(WrStrokeJob) jobs; /* oldest first; the first may be open in the session */
    bool opened;                /* the first is */
    bool unfinished;            /* the session has more to draw of it */
    bool drawing;               /* the pointer is down and draws the last job */
    bool on_patch;              /* on the patch */
    WrBrush now;                /* the brush of the stroke under way: eraser, seed */
    double began;               /* seconds of its first sample */
    double pressure;            /* newest */
    double way_x, way_y;        /* newest direction in pixels, for outlines that follow it */
    WrRelight steady;
    bool have_last; /* where the last stroke ended, for straight lines */
    double last_u, last_v;
    bool straight; /* a straight line is being aimed */
    double line_u, line_v, to_u, to_v;
    double resize_radius; /* at the start of a resize */
    uint64_t line_key;    /* of the table when last_u, last_v were set: no lines into others */
    int strokes;          /* begun so far */
    uint32_t seeds;       /* strokes with chance in them so far */
    int64_t taken, shown; /* pointer events handed to the session, and drawn (latency.c) */
} WrBrushHand;

/* The stroke command without points for a brush, with the files that *app->brush_files names. */
void wr_strokes_head(const WrApp *app, const WrBrush *brush, WrText *line);
/* The brush as a pointer has it: the eraser's end erases, held keys smooth or invert; a new seed where there
   is chance in it. */
WrBrush wr_strokes_brush(WrApp *app, const WrPointer *at);
bool wr_strokes_begin(WrApp *app, const WrBrush *brush, const WrPointer *at);
/* One sample at (u, v) of the table, unwrapped, with the pointer's pressure, tilt and time. */
void wr_strokes_sample(WrApp *app, const WrPointer *at, double u, double v);
void wr_strokes_end(WrApp *app);         /* no more samples; what is left is drawn by and by */
void wr_strokes_work(WrApp *app);        /* once before each picture */
bool wr_strokes_waits(const WrApp *app); /* more is left to draw */
/* One is drawn or left to draw: a step as soon as anything else is asked for. */
bool wr_strokes_under_way(const WrApp *app);
void wr_strokes_finish(WrApp *app); /* draw all that is left, now */
void wr_strokes_cancel(WrApp *app); /* the stroke that is drawn never was */
/* Over the canvas: those that wait for what runs beside the window. */
void wr_strokes_marks(const WrApp *app);
void wr_strokes_free(WrApp *app);

extern const WrPart wr_part_strokes;
