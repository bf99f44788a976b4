/* thumbs.h - thumbnails of brushes, stamps, generators, cells, materials and the like, made on a separate thread. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"

#include <SDL.h>
#include <stdbool.h>

typedef enum WrThumbKind {
    WR_THUMB_BRUSH,
    WR_THUMB_STAMP,
    WR_THUMB_GENERATOR,
    WR_THUMB_PRESET,
    WR_THUMB_CELL,
    WR_THUMB_LISTS, /* the kinds before it are of lists that the user can change */
    WR_THUMB_MATERIAL = WR_THUMB_LISTS,
    WR_THUMB_MODEL,
    WR_THUMB_LIGHT,
    WR_THUMB_STARTER,
    WR_THUMB_WELCOME,
    WR_THUMB_KINDS
} WrThumbKind;

/* The first that is not NULL is shown; all texts are borrowed. None: the round brush. */
typedef struct WrThumbSource {
    const char *picture; /* path of a finished picture */
    const char *stamp;   /* path of a picture, shown as a relief */
    const char *scene;   /* commands, one a line, of a scene that is rendered */
    const char *line;    /* generator's line, run on a flat table ... */
    const char *path;    /* brush preset, which paints a stroke */
    const char *id;      /* of that preset */
    const char
        *ground; /* ... or, if the table stays flat, on the result of this line; NULL: none */
    bool lower;  /* the stamp is carved */
    bool placed; /* the line makes one object: it is shown larger */
} WrThumbSource;

/* The thumbnail of entry `index` of a list, side x side pixels; NULL while it is not ready. */
SDL_Texture *wr_thumb(WrApp *app, WrThumbKind kind, int index, int side, const WrThumbSource *of);
/* That of a preset of the brush library; -1: the round brush. */
SDL_Texture *wr_thumb_of(WrApp *app, int index, int side);
void wr_thumbs_update(WrApp *app); /* once per frame, after the requests */
void wr_thumbs_free(WrApp *app);

extern const WrPart wr_part_thumbs;
