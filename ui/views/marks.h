/* marks.h - selection outlines on the canvas. */
#pragma once
#include "ui/canvas/marching_ants.h"
#include "ui/canvas/outline.h"
#include "ui/canvas/view.h"
#include "ui/state/app_state.h"
#include "ui/state/roster.h"

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

void wr_marks_update(WrApp *app);
void wr_marks_draw(WrApp *app);
void wr_marks_try(WrApp *app, const WrOutlineRequest *ask); /* NULL: the selection itself */
double wr_marks_next_time(const WrApp *app); /* clock of the next animation step; 0: none */
void wr_marks_free(WrApp *app);

extern const WrPart wr_part_marks;
