/* panel_layer_plan.h - layers in the Plan panel: whether each ran at the last command, its time and its memory. */
#pragma once
#include "ui/app/state/app_state.h"

#include "command/layer_plan.h"
#include "document/document.h"

#include <stdint.h>

typedef struct WrLayerPlanState {
    uint64_t revision; /* of the document that `plan` belongs to; 0: none */
    uint64_t making;   /* number of the last making then (document/layer_times.h) */
    WrLayerPlan plan[WR_LAYERS_MAX];
} WrLayerPlanState;

void wr_panel_layer_plan(WrApp *app);
