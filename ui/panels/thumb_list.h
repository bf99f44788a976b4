/* thumb_list.h - cached thumbnails of tables in a list, rendered on demand and kept while their table is
   unchanged. */
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
    uint64_t key, cover;  /* keys of its content */
    double made_at;
} WrThumb;

typedef struct WrThumbList {
    WR_ARRAY(WrThumb) thumbs;
} WrThumbList;

/* Thumbnail of a list position: heights with coverage (NULL: none), `units` wide and high. unit: range 0..1, else the
 * table's own range. May be NULL. During a stroke it is updated at intervals. */
SDL_Texture *wr_thumb_list_get(const WrApp *app, WrThumbList *list, int place, const WrField *field,
                               const WrField *cover, bool unit, double units);
void wr_thumb_list_free(WrThumbList *list); /* may be used again */
