/* panel_scene.h - the scene panel's own state. */
#pragma once
#include "surface/surface.h"
#include "ui/panels/profile_edit.h"

/* A profile under the hand (panel_profile.c). */
typedef struct WrProfileHand {
    WrProfileEdit edit;
    uint64_t key;         /* of the data that it was taken from */
    int held;             /* the place that is dragged, from 1; 0: none */
    bool moved;           /* since it is held */
    bool wrong;           /* no surface has it as it is now */
    double scale, middle; /* pixels a scene unit; the z in the pad's middle */
} WrProfileHand;

/* The texts of a surface as they are being written. */
typedef struct WrSurfaceHand {
    char text[WR_SURFACE_TEXTS][WR_SURFACE_TEXT_MAX + 1];
    uint64_t key; /* the data that they were taken from */
    char file[4096];
    double file_key; /* the mesh that its name was taken from */
    WrProfileHand profile;
} WrSurfaceHand;

typedef struct WrApp WrApp;
/* The surface command of that shape. text: of its row's texts; NULL: the defaults. */
void wr_surface_run(WrApp *app, const WrShape *shape, const char *const *text);
void wr_profile_row(WrApp *app); /* of a scene whose surface has a profile */
