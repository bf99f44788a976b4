/* tool_shape.h - what shapes, paths and ramps hold while they are drawn. */
#pragma once
#include "ui/state/app_state.h"

#include "base/array.h"

#include <stdbool.h>

typedef struct WrText WrText;

/* An anchor of a Bezier path: its place and where its two arms end, texels, unwrapped. */
typedef struct WrAnchor {
    double x, y;
    double in_x, in_y, out_x, out_y;
} WrAnchor;

/* What the tools that draw other things than strokes hold. Places are texels, unwrapped. */
typedef struct WrDrawHand {
    bool active;                /* something is begun and neither done nor given up */
    double x0, y0, x1, y1;      /* of a drag: where it began, where it is */
    WR_ARRAY(WrAnchor) anchors; /* of polygons and paths */
    bool closed;                /* the path was closed by a click on its first anchor */
    int held, part;    /* anchor that is dragged, -1: none; 0 itself, 1 its arm back, 2 ahead */
    double clicked_at; /* clock at the last press */
} WrDrawHand;

void wr_shape_options(WrApp *app);
void wr_draw_leave(WrApp *app); /* gives up what is being drawn */
/* The brush's arguments for a command that is no stroke: symmetric or not. */
void wr_draw_brush_line(const WrApp *app, WrText *line, bool symmetric);
