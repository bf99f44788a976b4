/* panel_seam.h - seam meter: continuity of the table across the cell's edges. */
#pragma once
#include "ui/app/state/app_state.h"

void wr_panel_seam_meter(WrApp *app); /* on the canvas */
