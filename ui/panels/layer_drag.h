/* layer_drag.h - drags in the layers' list: rows to another place, and over the eyes of several rows. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/panels/layer_rows.h"
#include "ui/toolkit/gui.h"

#include <stdbool.h>

/* A row of the list that is being drawn. */
typedef struct WrLayerRow {
    const WrLayerRows *rows;
    int at;    /* row, from the top */
    int layer; /* index of its layer */
    WrRow row;
} WrLayerRow;

/* Drag of the row: a line shows where it, or all chosen layers if it is one of them, would land. True if a command was
   run. */
bool wr_layer_drag(WrApp *app, const WrLayerRow *row);
bool wr_layer_is_dragged(const WrApp *app, int layer);
/* Pixels by which a layer in that many groups is indented. */
double wr_layer_indent(int depth);
/* Handles its eye, the previous widget, which returned `pressed`: a click shows or hides the layer, or all chosen ones; a drag
   does the same to all rows that it passes. True if a command was run. */
bool wr_layer_eye(WrApp *app, const WrLayerRow *row, bool pressed);
/* Whether the row's layer is visible, or would be after the drag over eyes. */
bool wr_layer_eye_shows(const WrApp *app, const WrLayerRow *row);
