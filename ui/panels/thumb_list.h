/* thumb_list.h - small pictures of tables in a list, made when they are asked for and kept while their table is the same. */
#pragma once
#include "base/array.h"

#include <SDL.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct WrApp WrApp;
typedef struct WrField WrField;

typedef struct WrThumb {
    SDL_Texture *texture; /* owned */
    int side;             /* pixels */
    uint64_t key, cover;  /* of what it shows */
    double made_at;
} WrThumb;

typedef struct WrThumbList {
    WR_ARRAY(WrThumb) thumbs;
} WrThumbList;

/* That of a place of the list: of heights, with what covers them (NULL: nothing), `units` wide and high. unit: from 0 to 1,
 * else over their own range. May be NULL. While a stroke is drawn it is made anew now and then. */
SDL_Texture *wr_thumb_list_get(const WrApp *app, WrThumbList *list, int place, const WrField *field,
                               const WrField *cover, bool unit, double units);
void wr_thumb_list_free(WrThumbList *list); /* it may be used again */
