#include "ui/panels/thumb_list.h"
#include "ui/canvas/canvas_colors.h"
#include "ui/app/state/app_state.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/gui_sdl_renderer.h"

#include "base/array.h"
#include "command/session.h"
#include "field/field.h"
#include "system/clock.h"

#include <SDL.h>

#define THUMB_SECONDS 0.15 /* interval between two updates of a changing table */

static void make_thumb(const WrApp *app, WrThumb *thumb, const WrField *field, const WrField *cover,
                       bool unit, int side)
{
    uint32_t argb[WR_THUMB_MAX * WR_THUMB_MAX];
    if (!thumb->texture || thumb->side != side) {
        if (thumb->texture) SDL_DestroyTexture(thumb->texture);
        thumb->texture = SDL_CreateTexture(app->renderer, SDL_PIXELFORMAT_ARGB8888,
                                           SDL_TEXTUREACCESS_STATIC, side, side);
        if (!thumb->texture) return;
    }
    wr_thumb_draw(field, cover, unit, side, argb);
    wr_gui_sdl_update(thumb->texture, NULL, argb, side * 4);
    thumb->side = side;
    thumb->key = wr_field_key(field);
    thumb->cover = cover ? wr_field_key(cover) : 0;
    thumb->made_at = wr_clock_seconds();
}

SDL_Texture *wr_thumb_list_get(const WrApp *app, WrThumbList *list, int place, const WrField *field,
                               const WrField *cover, bool unit, double units)
{
    int side = wr_gui_px(units);
    while (list->thumbs.count <= place) wr_array_push(&list->thumbs, ((WrThumb){ 0 }));
    WrThumb *t = &list->thumbs.data[place];
    side = side < WR_THUMB_MAX ? side : WR_THUMB_MAX;
    bool old = !t->texture || t->side != side || t->key != wr_field_key(field) ||
               t->cover != (cover ? wr_field_key(cover) : 0);
    bool young = t->texture && wr_clock_seconds() - t->made_at < THUMB_SECONDS;
    if (old && young && wr_session_in_stroke(app->session)) return t->texture;
    if (old) make_thumb(app, t, field, cover, unit, side);
    return t->texture;
}

void wr_thumb_list_free(WrThumbList *list)
{
    for (int i = 0; i < list->thumbs.count; i++)
        if (list->thumbs.data[i].texture) SDL_DestroyTexture(list->thumbs.data[i].texture);
    wr_array_free(&list->thumbs);
}
