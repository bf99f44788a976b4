/* marching_ants.h - pixels of a selection's outline on the canvas, for an animated dashed line. Pure geometry; tested
   without a window. */
#pragma once
#include "ui/canvas/view.h"

#include "base/array.h"
#include "field/select.h"

#include <SDL.h>
#include <stdbool.h>

#define WR_MARCHING_ANTS_MAX 200000 /* limit of pixels: the rest of a larger outline is left out */

typedef struct WrAnt {
    SDL_Point at; /* pixel of the window */
    float along;  /* pixels from the start of its line */
} WrAnt;

typedef struct WrMarchingAnts {
    WR_ARRAY(WrAnt) pixels;
    bool cut; /* more than WR_MARCHING_ANTS_MAX pixels */
} WrMarchingAnts;

void wr_marching_ants_free(WrMarchingAnts *ants);

/* Trace the pixels of an outline inside the view, on every visible copy of the cell (one copy on clamped axes).
 * Replaces earlier content. */
void wr_marching_ants_trace(WrMarchingAnts *ants, const WrOutline *outline,
                            const WrCanvasView *view, bool wraps_u, bool wraps_v);

/* Add the closed line through `count` points (u, v unwrapped), at its position and on its copies: a shape being
 * drawn. */
void wr_marching_ants_add(WrMarchingAnts *ants, const WrSelectPoint *points, int count, int wind_u,
                          int wind_v, const WrCanvasView *view, bool wraps_u, bool wraps_v);
