/* hardcases_look.h - heights and slopes as the renderer looks them up, for measuring.
   Layer 6, private to this room. */
#pragma once
#include "hardcases/hardcases_internal.h"
#include "render/textures/height_copies.h"

#include <stdbool.h>

/* The renderer's copies of a table and how it looks heights up there. */
typedef struct WrHardLook {
    WrTable table;
    WrLook look;
    WrScheme scheme;
} WrHardLook;
bool wr_hard_look_init(WrHardGauge *gauge, WrHardLook *look, const WrField *field, WrScheme scheme,
                       double ru, double rv, WrError *err);
void wr_hard_look_fini(WrHardLook *look);
/* F, Fu, Fv at (u, v) by a kernel, height 1. Also leaves the reduced place in strip->tu[0], tv[0]. */
WrHardSlope wr_hard_look_at(WrHardGauge *gauge, int set, const WrHardLook *look, float u, float v);
