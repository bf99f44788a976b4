/* layer_choice.h - layers chosen in the window, and command lines that change several layers in one step. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/app/state/chosen_layers.h"
#include "ui/panels/layer_rows.h"

#include <stdbool.h>

/* Choose layer `index`; true if a command was run, since another layer becomes active. */
bool wr_layer_pick(WrApp *app, int index, WrChoosing how);
/* Choose all layers of the list. */
void wr_layer_pick_all(WrApp *app);
/* Choose the layer of the next row up (1) or down (-1) alone. */
void wr_layer_pick_next(WrApp *app, int way);
/* The layers changed by a widget in the row of layer `index`: the chosen ones if it is one of them, else it alone.
   Returns out. */
const bool *wr_layers_of_row(const WrApp *app, int index, bool out[WR_LAYERS_MAX]);
/* Run "layer FORM 2,4,5 REST" on these layers; rest: "" for none. Returns whether a command was run. */
bool wr_layers_run(WrApp *app, const char *form, const bool layers[WR_LAYERS_MAX],
                   const char *rest);
/* The same for the chosen layers, of a form after which they or their copies lie together, the lowest at index `first`: these
   are chosen then. */
bool wr_layers_run_to(WrApp *app, const char *form, const char *rest, int first);
/* Move these layers to a place that they can have: drop->to is not 0. */
bool wr_layers_move(WrApp *app, const bool layers[WR_LAYERS_MAX], const WrLayerDrop *drop);
/* Move the chosen layers a step up (1) or down (-1). */
void wr_layers_step(WrApp *app, int way);
