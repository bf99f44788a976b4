/* marks.h - selection outlines, lines, handles and labels on the canvas. */
#pragma once
#include "ui/canvas/marching_ants.h"
#include "ui/canvas/outline.h"
#include "ui/canvas/view.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"
#include "ui/toolkit/theme.h"

#include "base/array.h"
#include "field/select.h"

#include <stdbool.h>
#include <stdint.h>

/* State of the outlines. */
typedef struct WrMarks {
    WrOutliner *outliner;
    bool trying;        /* show the outline of a dialog's preview, not of the selection */
    uint64_t asked_key; /* key of the last outlined selection; 0: none */
    WrMarchingAnts ants, shape;
    uint64_t traced; /* serial number of the outline in `ants` */
    WrCanvasView traced_view;
    double stepped_at; /* clock at the last animation step */
} WrMarks;

/* A selection being drawn. */
typedef struct WrSelectState {
    bool active;
    WrSelectMode mode;
    double x, y; /* start position in texels, unwrapped */
    /* the shape so far; of a lasso also the points of the command */
    WR_ARRAY(WrSelectPoint) points;
} WrSelectState;

void wr_marks_draw(WrApp *app);
void wr_marks_try(WrApp *app, const WrOutlineRequest *ask); /* NULL: the selection itself */
void wr_marks_free(WrApp *app);

extern const WrPart wr_part_marks;

/* ---- lines and marks on the canvas, on every copy of the cell ---- */

/* points: u, v, unwrapped. Drawn dark under light, to be visible on any background. */
void wr_overlay_lines(const WrApp *app, const WrSelectPoint *points, int count, bool closed,
                      WrColour colour);
/* A cross, a small square or a disc at u, v (unwrapped), on all copies. */
void wr_overlay_cross(const WrApp *app, double u, double v, WrColour colour);
void wr_overlay_handle(const WrApp *app, double u, double v, bool round, bool hot);
/* u, v (unwrapped) of a position in texels, y downwards. */
WrSelectPoint wr_overlay_uv(const WrApp *app, double x, double y);
/* Whole cells to add to u, v to move it into the cell (on periodic axes). */
WrSelectPoint wr_overlay_wrap_offset(const WrApp *app, double u, double v);
void wr_overlay_label(double x, double y, const char *text); /* centred at a pixel */
