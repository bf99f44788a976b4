/* data.h - text parameters of a surface, and the data computed from them once for all samples.

   Immutable and reference-counted. Owned by the shape's scene (wr_scene_set_shape); shapes borrow it. */
#pragma once
#include "surface/expression.h"
#include "surface/profile.h"
#include "surface/surface.h"

#include <stdint.h>

typedef struct WrError WrError;

struct WrSurfaceData {
    int refs;     /* atomic; private; below 0: a default, never freed */
    uint64_t key; /* hash of kind and texts */
    WrSurfaceKind kind;
    char *text[WR_SURFACE_TEXTS]; /* as given, in the order of the row's texts; owned */
    WrVec3 centre;                /* centre of rotations */
    double radius;                /* of the bounding sphere about it */
    WrProfiled profile_d;         /* revolution */
    WrProfilef profile_f;
    WrProgram program; /* formula */
};

/* Parses the row's texts; NULL instead of the texts: the defaults. Errors name the surface, the text
 * and the position. */
WrSurfaceData *wr_surface_data_make(WrSurfaceKind kind, const char *const text[WR_SURFACE_TEXTS],
                                    WrError *err);
WrSurfaceData *wr_surface_data_share(const WrSurfaceData *data); /* NULL returns NULL */
void wr_surface_data_free(WrSurfaceData *data);
/* The data of the default texts: created once, never freed. NULL for surfaces without texts. */
const WrSurfaceData *wr_surface_data_default(WrSurfaceKind kind);
/* Sets a borrowed reference in a shape of the same kind. */
void wr_shape_borrow_data(WrShape *shape, const WrSurfaceData *data);
