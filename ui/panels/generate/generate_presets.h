/* generate_presets.h - gallery of generators: a list of small pictures, opened from the Generate tab. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"

typedef struct WrGallery WrGallery;

void wr_gallery_open(WrApp *app);
void wr_gallery_list(WrApp *app); /* called in each frame of the tab; draws the list if open */
void wr_gallery_free(WrApp *app);
