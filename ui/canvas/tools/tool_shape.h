/* tool_shape.h - state of shapes, paths and ramps being drawn. */
#pragma once
#include "ui/app/state/app_state.h"

#include "base/array.h"

#include <stdbool.h>

typedef struct WrText WrText;

/* An anchor of a Bezier path: its position and the ends of its two handles, texels, unwrapped. */
typedef struct WrAnchor {
    double x, y;
    double in_x, in_y, out_x, out_y;
} WrAnchor;

/* State of drawing tools other than the brush. Positions are texels, unwrapped. */
/* A point of the active layer's line that is dragged (layer_points.h). */
typedef struct WrDrawPoint {
    int number;          /* from 1; 0: none */
    double u, v;         /* where it is now, unwrapped */
    double off_u, off_v; /* from the pointer to it */
} WrDrawPoint;

typedef struct WrDrawState {
    WrDrawPoint point;
    bool active;                /* an operation is in progress */
    double x0, y0, x1, y1;      /* of a drag: start, present position */
    WR_ARRAY(WrAnchor) anchors; /* of polygons and paths */
    bool closed;                /* the path was closed by a click on its first anchor */
    /* dragged anchor, -1: none; part 0 the anchor, 1 its back handle, 2 its front handle */
    int held, part;
    double clicked_at; /* clock at the last press */
} WrDrawState;

void wr_shape_options(WrApp *app);
void wr_draw_leave(WrApp *app); /* cancels the operation */
/* Append the brush's arguments for a command other than a stroke, with or without symmetry. */
void wr_draw_brush_line(const WrApp *app, WrText *line, bool symmetric);
