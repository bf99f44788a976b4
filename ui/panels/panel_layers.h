/* panel_layers.h - the list of layers. */
#pragma once
#include "ui/panels/thumb_list.h"
#include "ui/state/app_state.h"
#include "ui/state/roster.h"

#include "base/array.h"
#include "document/document.h"

#include <SDL.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct WrLayersHand {
    int dragged; /* index of the layer that is held, -1: none */
    int gap;     /* where it would go: between layers gap - 1 and gap */
    int renamed; /* index of the layer whose name is being typed, -1: none */
    bool fresh;  /* it is the field's first frame */
    char name[WR_LAYER_NAME_MAX + 1];
    bool open;          /* the menu is asked for */
    WrThumbList thumbs; /* two a layer: heights, mask */
    WrThumbList steps;  /* one a state of the history */
} WrLayersHand;

void wr_panel_layers(WrApp *app, SDL_Rect room);
void wr_panel_layers_forget(WrApp *app); /* its pictures */
void wr_layer_rename_start(WrApp *app, int index);

extern const WrPart wr_part_layers;
