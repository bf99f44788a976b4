/* canvas_chip.h - canvas chip: the displayed map and its range, with a popup; light direction of relief shading. */
#pragma once
#include "ui/canvas/canvas.h"

#include "field/maps.h"

#include <stdbool.h>

typedef struct WrApp WrApp;

/* A map that can be shown instead of the table. */
typedef struct WrCanvasMapRow {
    const char *name;
    WrFieldMapKind kind;
    WrCanvasColours colours;
    double low, high; /* low 0 and high 0: from the map's lowest value to 0 */
    bool two;         /* with slopes along v as second component */
} WrCanvasMapRow;
extern const WrCanvasMapRow wr_canvas_maps[WR_CANVAS_SHOWN];

void wr_canvas_chip(WrApp *app);
