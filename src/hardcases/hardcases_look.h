/* hardcases_look.h - fetches of heights and slopes by the renderer, for measurements. Private to this module. */
#pragma once
#include "hardcases/hardcases_internal.h"
#include "render/textures/height_copies.h"

#include <stdbool.h>

/* The renderer's copies of a table, with fetch parameters. */
typedef struct WrHardLook {
    WrTable table;
    WrLook look;
    WrScheme scheme;
} WrHardLook;
bool wr_hard_look_init(WrHardMeasurement *gauge, WrHardLook *look, const WrField *field,
                       WrScheme scheme, double ru, double rv, WrError *err);
void wr_hard_look_fini(WrHardLook *look);
/* F, Fu, Fv at (u, v) by a kernel, height 1. Also leaves the reduced position in strip->tu[0], tv[0]. */
WrHardSlope wr_hard_look_at(WrHardMeasurement *gauge, int set, const WrHardLook *look, float u,
                            float v);
