/* stroke_input.h - strokes by the pointer, drawn for a few milliseconds per frame. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"
#include "ui/input/stroke_smoothing.h"
#include "ui/toolkit/gui.h"

#include "base/array.h"
#include "brush/brush.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrPointer WrPointer;
typedef struct WrText WrText;

/* One stroke: being drawn by the session, or waiting for the previous one. */
typedef struct WrStrokeJob {
    char *head; /* command line without points, owned; NULL once the session has it */
    WR_ARRAY(WrSample) samples; /* not yet passed to the session */
    bool released;              /* the pointer was released: no more samples will follow */
    int waits; /* its number while it waits for a background command (ui/app/state/background_command.h); else 0 */
} WrStrokeJob;

/* With this number of samples of the open stroke all events up to that one are drawn. */
typedef struct WrDrawnMark {
    int64_t samples, events;
} WrDrawnMark;

typedef struct WrBrushState {
    WR_ARRAY(WrStrokeJob) jobs; /* oldest first; the first may be open in the session */
    bool opened;                /* the first is open */
    bool unfinished;            /* the session has undrawn samples of it */
    bool drawing;               /* the pointer is pressed and extends the last stroke */
    WrBrush now;                /* brush of the present stroke, with eraser and seed */
    double began;               /* time of its first sample in seconds */
    double pressure;            /* newest pressure */
    double way_x, way_y;        /* newest direction in pixels, for outlines that follow it */
    WrSmoothing steady;
    bool have_last; /* end of the last stroke, for straight lines */
    double last_u, last_v;
    bool straight; /* a straight line is being aimed */
    double line_u, line_v, to_u, to_v;
    double resize_radius; /* radius at the start of a resize */
    /* key of the table when last_u, last_v were set: no lines into other tables */
    uint64_t line_key;
    int strokes;                 /* number of strokes so far */
    uint32_t seeds;              /* number of strokes with random numbers so far */
    int64_t taken, shown;        /* pointer events passed to the session, and drawn (latency.c) */
    int64_t pushed;              /* number of samples passed to the open stroke */
    WR_ARRAY(WrDrawnMark) marks; /* of its undrawn samples, oldest first */
} WrBrushState;

/* The brush for a pointer: the eraser end erases, held keys smooth or invert; a new seed if it uses random
   numbers. */
WrBrush wr_strokes_brush(WrApp *app, const WrPointer *at);
bool wr_strokes_begin(WrApp *app, const WrBrush *brush, const WrPointer *at);
/* Begin a stroke on the active object's mesh, painting what faces the eye; NULL: all faces. */
bool wr_strokes_begin_on_mesh(WrApp *app, const WrBrush *brush, const WrPointer *at,
                              const WrVec3 *eye);
/* Append the arguments common to all strokes on a mesh: the place of the eye (NULL: none), in the mesh's units, and the
   mirror axes that are on. */
void wr_strokes_mesh_line(const WrApp *app, const WrVec3 *eye, WrText *line);
/* Add a sample at (u, v) of the table, unwrapped, with the pointer's pressure, tilt and time. */
void wr_strokes_sample(WrApp *app, const WrPointer *at, double u, double v);
/* Add one at a point of the mesh. */
void wr_strokes_sample_on_mesh(WrApp *app, const WrPointer *at, WrVec3 p);
void wr_strokes_end(WrApp *app);         /* no more samples; the rest is drawn in later frames */
void wr_strokes_work(WrApp *app);        /* once before each frame */
bool wr_strokes_waits(const WrApp *app); /* there are undrawn samples */
/* True if a stroke is being drawn or undrawn; it becomes a step before any other command. */
bool wr_strokes_under_way(const WrApp *app);
/* True if the newest stroke waits for a background command. */
bool wr_strokes_newest_is_queued(const WrApp *app);
void wr_strokes_finish(WrApp *app); /* draw the rest now */
void wr_strokes_cancel(WrApp *app); /* discard the present stroke */
/* Overlay on the canvas: strokes that wait for a background command. */
void wr_strokes_marks(const WrApp *app);
void wr_strokes_free(WrApp *app);

extern const WrPart wr_part_strokes;

/* ---- strength of brushes, fills, stamps and shapes ---- */

/* A height while heights are painted, a fraction while a mask is painted. */

/* True if edits go to the active layer's mask. */
bool wr_paints_mask(const WrApp *app);
/* The setting changed by strength sliders and keys; valid as long as the settings. */
double *wr_strength_setting(WrApp *app);
/* Its slider, in percent while a mask is painted. width: pixels; <= 0: the rest of the row. */
void wr_strength_number(WrApp *app, const char *id, double width);
/* The brush with its present strength. */
WrBrush wr_brush_now(const WrApp *app);
