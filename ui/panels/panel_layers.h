/* panel_layers.h - layers panel. */
#pragma once
#include "ui/panels/layer_rows.h"
#include "ui/panels/thumb_list.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"

#include "base/array.h"
#include "document/document.h"
#include "document/variants.h"

#include <SDL.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct WrLayersState {
    int dragged;            /* index of the dragged layer, -1: none */
    WrLayerDrop drop;       /* where it would land */
    int eyes_from, eyes_to; /* rows whose eyes a drag passed over; eyes_from -1: no drag */
    unsigned ring; /* the row with the ring of the keyboard focus, as in focus.h; 0: none */
    int renamed;   /* index of the layer being renamed, -1: none */
    bool fresh;    /* first frame of the text field */
    char name[WR_LAYER_NAME_MAX + 1];
    bool open;            /* open the menu */
    bool renames_variant; /* the open dialog renames the variant in use; else it adds one */
    char variant[WR_VARIANT_NAME_MAX + 1]; /* the name in that dialog */
    WrThumbList thumbs;                    /* two per layer: heights, mask */
    WrThumbList steps;                     /* one per state of the history */
    char *missing
        [WR_LAYERS_MAX]; /* missing_files.h: a missing file of each layer's line; owned; NULL: none */
    const WrDocument *missing_of; /* looked up for this document, borrowed, */
    uint64_t missing_at;          /* at this revision */
    char *located;                /* the missing file that is being located; owned; NULL: none */
} WrLayersState;

void wr_panel_layers(WrApp *app, SDL_Rect room);
void wr_panel_layers_forget(WrApp *app); /* drop its textures */
void wr_layer_rename_start(WrApp *app, int index);
/* If the active layer is a generator layer whose heights would be painted on, open the question; returns true. */
bool wr_rasterize_ask(WrApp *app);
void wr_dialog_rasterize(WrApp *app);

extern const WrPart wr_part_layers;
