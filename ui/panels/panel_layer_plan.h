/* panel_layer_plan.h - the Plan panel: effects of the last picture, and layers at the last command, each with its time. */
#pragma once
#include "ui/app/state/app_state.h"

#include "command/layer_plan.h"
#include "document/document.h"
#include "render/plan/plan.h"

#include <stdint.h>

/* Number of rows; a row's index is its WrEffect, or WR_EFFECT_COUNT + its WrCost. */
#define WR_PLAN_ROWS (WR_EFFECT_COUNT + WR_COST_COUNT)

typedef struct WrLayerPlanState {
    uint64_t revision; /* of the document that `plan` belongs to; 0: none */
    uint64_t making;   /* number of the last making then (document/layer_times.h) */
    WrLayerPlan plan[WR_LAYERS_MAX];
    int order[WR_PLAN_ROWS], ordered; /* rows of the picture that run, dearest first */
} WrLayerPlanState;

void wr_panel_layer_plan(WrApp *app);
