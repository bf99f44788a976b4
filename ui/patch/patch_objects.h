/* patch_objects.h - objects of a scene on the patch: chosen by a click; moved, resized and rotated by the handles of
   the active one. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/patch/preview/patch_pick.h"

#include "scene/scene.h"

#include <stdbool.h>

typedef enum WrHandle {
    WR_HANDLE_NONE,
    WR_HANDLE_MOVE, /* disc in the middle: moves across the view */
    WR_HANDLE_SIZE, /* square on the ring: resizes */
    WR_HANDLE_TURN  /* ring: rotates like a trackball */
} WrHandle;

/* The place of a handle in the view: the active object's bounding sphere, or the origin of its projection. */
typedef struct WrPatchBall {
    WrPlacement at;
    double x, y, radius; /* pixels of the window; radius at least that of a handle */
    double pixel;        /* world units per pixel at the depth of its centre */
} WrPatchBall;

/* Pick buffers for the displayed picture, rebuilt for another picture. NULL: none. Borrowed. */
const WrObjectPicks *wr_patch_picks(WrApp *app);
/* While the patch is painted: prepares strokes on a mesh in the background, once for each mesh and table. */
void wr_patch_prepare_mesh(WrApp *app);
/* True meanwhile: picking would build the mesh's tree a second time, in the window's thread. */
bool wr_patch_prepares_mesh(const WrApp *app);
void wr_object_picks_forget(WrApp *app);
/* Make the object under the pointer the active one, and its layer the active layer if it has one of its own. False if
   there is no object. */
bool wr_patch_choose(WrApp *app, const WrPointer *at);

WrHandle wr_patch_handle_under(const WrApp *app, const WrPointer *at);
void wr_patch_handle_press(WrApp *app, const WrPointer *at);
void wr_patch_handle_drag(WrApp *app, const WrPointer *at);
void wr_patch_handle_release(WrApp *app); /* one command for the drag */
void wr_patch_handles_draw(const WrApp *app);
