/* marks.h - outlines of selections on the canvas. */
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

/* The outlines on the canvas. */
typedef struct WrMarks {
    WrOutliner *outliner;
    bool trying;        /* the outline is of what a dialog would make, not of the selection */
    uint64_t asked_key; /* of the selection that was outlined last; 0: none */
    WrMarchingAnts ants, shape;
    uint64_t traced; /* serial of the outline in ants */
    WrCanvasView traced_view;
    double stepped_at; /* clock at the last step of the march */
} WrMarks;

/* A selection that is being drawn. */
typedef struct WrSelectHand {
    bool active;
    WrSelectMode mode;
    double x, y;                    /* texel where it began, unwrapped */
    WR_ARRAY(WrSelectPoint) points; /* the shape so far; of a lasso also what the command gets */
} WrSelectHand;

void wr_marks_update(WrApp *app);
void wr_marks_draw(WrApp *app);
void wr_marks_try(WrApp *app, const WrOutlineAsk *ask); /* NULL: the selection as it is */
double wr_marks_next_time(const WrApp *app); /* clock at which they move on; 0: they do not */
void wr_marks_free(WrApp *app);

extern const WrPart wr_part_marks;
