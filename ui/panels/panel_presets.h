/* panel_presets.h - material menu: a list of materials as pictures, opened from the scene tab. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"

/* Row with the material's name, which opens the list; and the open list. */
void wr_panel_presets(WrApp *app);
void wr_presets_free(WrApp *app);

extern const WrPart wr_part_presets;
