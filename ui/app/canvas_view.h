/* canvas_view.h - canvas view: the table's picture and overlays. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"
#include "ui/canvas/canvas.h"

#include "field/maps.h"

#include <stdbool.h>

void wr_app_place_view(WrApp *app); /* fits the cell into the view unless the user has moved it */
void wr_canvas_view_overlay(WrApp *app); /* chips and popups over the picture */

extern const WrPart wr_part_canvas;

/* ---- displayed map ---- */

/* A map that can be shown instead of the table. */
typedef struct WrCanvasMapRow {
    const char *name;
    WrFieldMapKind kind;
    WrCanvasColours colours;
    double low, high; /* low 0 and high 0: from the map's lowest value to 0 */
    bool two;         /* with slopes along v as second component */
} WrCanvasMapRow;
extern const WrCanvasMapRow wr_canvas_maps[WR_CANVAS_SHOWN];
