/* thumbs.h - small pictures of presets and stamps, made on a thread of their own. */
#pragma once
#include "ui/state/app_state.h"
#include "ui/state/roster.h"

#include <SDL.h>

/* The picture of a preset, side x side pixels; NULL while it is not there: it comes by and by. index -1:
 * the round brush. */
SDL_Texture *wr_thumb_of(WrApp *app, int index, int side);
SDL_Texture *wr_thumb_of_stamp(WrApp *app, int index, int side); /* of stamp.stamps */
void wr_thumbs_update(WrApp *app); /* once a picture, after they were asked for */
void wr_thumbs_forget(WrApp *app);
void wr_thumbs_free(WrApp *app);

extern const WrPart wr_part_thumbs;
