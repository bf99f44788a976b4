/* patch_paint.h - painting on the patch. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/patch/preview/patch_pick.h"

#include "surface/mesh_texels.h"

#include <SDL.h>
#include <stdbool.h>

/* State of painting on the patch (patch_paint.c). */
typedef struct WrPatchPaint {
    bool on;              /* dragging over the patch paints instead of rotating it */
    bool round;           /* on a mesh: faces turned away are painted too */
    bool preparing;       /* the mesh, in the background */
    uint64_t tried;       /* revision of the document for which that began */
    WrObjectPicks *picks; /* owned */
    WrScene *scene;       /* scene for which they were made; shared, owned */
    double turn_deg;
    SDL_Rect room;
    bool inside; /* the last step was on the object */
    WrPatchSpot last;
    double side; /* object units of a texel, for the outline on a mesh; of this mesh and table: */
    uint64_t side_key;
    WrMeshTexelsTable side_table;
    WrPointer at; /* end of the last step */
    WrVec3 end;   /* of the last stroke on the mesh with this key, for straight lines; 0: none */
    uint64_t end_key;
} WrPatchPaint;

/* Table position under a pointer on the patch; false beside the object. */
bool wr_patch_paint_uv(WrApp *app, const WrPointer *at, double *u, double *v);
void wr_patch_paint_press(WrApp *app, const WrPointer *at);
void wr_patch_paint_drag(WrApp *app, const WrPointer *at);
void wr_patch_paint_release(WrApp *app, const WrPointer *at);
/* Project the active layer onto the mesh as a slide that fills the patch. */
void wr_patch_project_layer(WrApp *app);
void wr_patch_paint_overlay(WrApp *app); /* draw the brush's outline on the object */
void wr_patch_paint_free(WrApp *app);
