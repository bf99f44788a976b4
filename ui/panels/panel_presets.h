/* panel_presets.h - the list of materials as pictures, opened from the scene's tab. */
#pragma once
#include "ui/state/app_state.h"
#include "ui/state/roster.h"

/* The row that names the material at hand and opens the list; the list itself while it is open. */
void wr_panel_presets(WrApp *app);
void wr_presets_free(WrApp *app);

extern const WrPart wr_part_presets;
