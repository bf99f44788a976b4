/* marching_ants.h - the dashed, marching outline of a selection as pixels of the canvas. Pure geometry; tested
   without a window. */
#pragma once
#include "ui/canvas/view.h"

#include "base/array.h"
#include "field/select.h"

#include <SDL.h>
#include <stdbool.h>

#define WR_MARCHING_ANTS_MAX 200000 /* pixels at most: the rest of a larger outline is left out */

typedef struct WrAnt {
    SDL_Point at; /* pixel of the window */
    float along;  /* pixels from the beginning of its line */
} WrAnt;

typedef struct WrMarchingAnts {
    WR_ARRAY(WrAnt) pixels;
    bool cut; /* there were more than WR_MARCHING_ANTS_MAX */
} WrMarchingAnts;

void wr_marching_ants_free(WrMarchingAnts *ants);

/* The pixels of an outline inside the view, on every copy of the cell that is seen; axes that do not wrap
 * have one. Replaces what was there. */
void wr_marching_ants_trace(WrMarchingAnts *ants, const WrOutline *outline,
                            const WrCanvasView *view, bool wraps_u, bool wraps_v);

/* Add the closed line through `count` points (u, v unwrapped), where it stands and on its copies: a shape
 * that is being drawn. */
void wr_marching_ants_add(WrMarchingAnts *ants, const WrSelectPoint *points, int count, int wind_u,
                          int wind_v, const WrCanvasView *view, bool wraps_u, bool wraps_v);
