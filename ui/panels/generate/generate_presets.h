/* generate_presets.h - gallery of generators: a list of small pictures, opened from the Generate tab. The pictures
   are rendered in the background, one after the other, while it is open. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"

typedef struct WrGallery WrGallery;

void wr_gallery_open(WrApp *app);
void wr_gallery_list(WrApp *app); /* called in each frame of the tab; draws the list if open */
void wr_gallery_free(WrApp *app);

extern const WrPart wr_part_gallery;
