/* panel_presets.h - material menu: a list of materials as pictures, opened from the scene tab. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"

#include <SDL.h>

/* Row with the material's name, which opens the list; and the open list. */
void wr_panel_presets(WrApp *app);
/* The picture of a material preset; NULL while it is not rendered: the next frame has one more. */
SDL_Texture *wr_presets_picture(WrApp *app, int preset);
void wr_presets_free(WrApp *app);

extern const WrPart wr_part_presets;
