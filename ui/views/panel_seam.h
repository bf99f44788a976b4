/* panel_seam.h - how well the cell's edges meet, on the canvas. */
#pragma once
#include "ui/state/app_state.h"

void wr_panel_seam(WrApp *app); /* on the canvas */
