/* thumbs.h - thumbnails of presets and stamps, made on a separate thread. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"

#include <SDL.h>

/* The picture of a preset, side x side pixels; NULL while it is not ready. index -1: the round brush. */
SDL_Texture *wr_thumb_of(WrApp *app, int index, int side);
SDL_Texture *wr_thumb_of_stamp(WrApp *app, int index, int side); /* index into stamp.stamps */
void wr_thumbs_update(WrApp *app); /* once per frame, after the requests */
void wr_thumbs_free(WrApp *app);

extern const WrPart wr_part_thumbs;
