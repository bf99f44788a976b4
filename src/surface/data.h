/* data.h - what numbers alone do not say of a surface: the texts that its command gives, and what was made of them once
   for all samples. Shared and never changed.
   Owned by the scene that a shape belongs to (wr_scene_set_shape); shapes borrow it. */
#pragma once
#include "surface/expression.h"
#include "surface/profile.h"
#include "surface/surface.h"

#include <stdint.h>

typedef struct WrError WrError;

struct WrSurfaceData {
    int refs;     /* atomic; private; below 0: of a default, which stays */
    uint64_t key; /* of kind and texts: equal where those are */
    WrSurfaceKind kind;
    char *text[WR_SURFACE_TEXTS]; /* as given, in the order of the row's texts; owned */
    WrVec3 centre;                /* what turns stay about */
    double radius;                /* of the ball about it that holds the surface */
    WrProfiled profile_d;         /* revolution */
    WrProfilef profile_f;
    WrProgram program; /* formula */
};

/* Made of the row's texts; NULL in their place: the defaults. Errors name the surface, the text and where in it. */
WrSurfaceData *wr_surface_data_make(WrSurfaceKind kind, const char *const text[WR_SURFACE_TEXTS],
                                    WrError *err);
WrSurfaceData *wr_surface_data_share(const WrSurfaceData *data); /* NULL stays NULL */
void wr_surface_data_free(WrSurfaceData *data);
/* That of the defaults: made once, and stays. NULL for surfaces that have none. */
const WrSurfaceData *wr_surface_data_default(WrSurfaceKind kind);
/* Let a shape of the same kind borrow it. */
void wr_shape_take_data(WrShape *shape, const WrSurfaceData *data);
