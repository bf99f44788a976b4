/* panel_scene.h - state of the scene panel. */
#pragma once
#include "surface/projection.h"
#include "surface/surface.h"
#include "ui/panels/profile_edit.h"

/* State of the profile editor (panel_profile.c). */
typedef struct WrProfileState {
    WrProfileEdit edit;
    uint64_t key;         /* key of the data that it was read from */
    int held;             /* index of the dragged place, from 1; 0: none */
    bool moved;           /* moved since the press */
    bool wrong;           /* the present profile is invalid */
    double scale, middle; /* pixels per scene unit; z at the pad's middle */
} WrProfileState;

#define WR_SURFACE_TILES_MAX 200

/* Text parameters of a surface while they are typed. */
typedef struct WrSurfaceState {
    char text[WR_SURFACE_TEXTS][WR_SURFACE_TEXT_MAX + 1];
    uint64_t key; /* key of the data that they were read from */
    char file[4096];
    double file_key; /* key of the mesh that the file name was read from */
    WrProfileState profile;
    uint64_t tiles_key;              /* key of the mesh that the tiles were read from */
    int tiles[WR_SURFACE_TILES_MAX]; /* UDIM numbers of the mesh, the first ones */
    int tile_count;
    WrTextureSeams seams; /* of the mesh with this key, at which the table breaks */
    uint64_t seams_key;
} WrSurfaceState;

typedef struct WrApp WrApp;
/* Run the surface command for that shape. text: texts of its row; NULL: the defaults. */
void wr_surface_run(WrApp *app, const WrShape *shape, const char *const *text);
/* A choice of none or a layer, of that name now. *which: the chosen one's number from 1; 0: none. True on a change. */
bool wr_layer_choice(WrApp *app, const char *id, const char *now, int *which);
void wr_profile_row(WrApp *app);     /* for a surface with a profile */
void wr_projection_rows(WrApp *app); /* for a mesh of a file */
void wr_mesh_parts_row(WrApp *app);  /* for one of several materials */
