/* canvas_chip.h - the chip on the canvas that says what it shows, and over which range; its popup; the light of a relief. */
#pragma once
#include "ui/canvas/canvas.h"

#include "field/maps.h"

#include <stdbool.h>

typedef struct WrApp WrApp;

/* A map that can be shown in the table's place. */
typedef struct WrCanvasMapRow {
    const char *name;
    WrFieldMapKind kind;
    WrCanvasColours colours;
    double low, high; /* low 0 and high 0: from the lowest number of the map to 0 */
    bool two;         /* slopes along v go with it */
} WrCanvasMapRow;
extern const WrCanvasMapRow wr_canvas_maps[WR_CANVAS_SHOWN];

void wr_canvas_chip(WrApp *app);
