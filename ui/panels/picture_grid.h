/* picture_grid.h - grids of pictures to choose from: materials, models, lights, starters. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/canvas/tools/thumbs.h"

#include "base/text.h"

#include <SDL.h>

typedef struct WrPictureItem {
    const char *title, *help; /* English; borrowed from a table */
    WrText lines;             /* commands of the scene to render; empty: a file is read */
    const char *picture;      /* path of that file; borrowed */
} WrPictureItem;

/* Draws the grid of `count` pictures of `units` width, which the search finds as `name`; picture `chosen` has a frame, -1: none. item: fills in
   picture i, whose texts the grid frees. Returns the clicked one, or -1. */
int wr_picture_grid(WrApp *app, WrThumbKind kind, const char *name, int count, double units,
                    int chosen, void (*item)(const WrApp *app, int i, WrPictureItem *out));
/* Picture i of materials, models or lights as in the scene tab; NULL while it is not made: it is requested. */
SDL_Texture *wr_picture_of(WrApp *app, WrThumbKind kind, int i);

/* The grids of the scene tab; a click runs one command. */
void wr_material_grid(WrApp *app);
void wr_model_grid(WrApp *app);
void wr_light_grid(WrApp *app);
