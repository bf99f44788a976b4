/* patch_objects.h - the objects of a scene on the patch: chosen by a click, moved, sized and turned by the handles of
   the chosen one. */
#pragma once
#include "ui/state/app_state.h"
#include "ui/state/input_router.h"
#include "ui/preview/patch_picks.h"

#include <stdbool.h>

typedef enum WrHandle {
    WR_HANDLE_NONE,
    WR_HANDLE_MOVE, /* the disc in the middle: across the view */
    WR_HANDLE_SIZE, /* the square on the ring */
    WR_HANDLE_TURN  /* the ring: as a ball that is rolled */
} WrHandle;

/* What is under each pixel of the picture that is shown; made anew when another one is. NULL: there is none. Borrowed. */
const WrPatchPicks *wr_patch_picks(WrApp *app);
void wr_patch_picks_forget(WrApp *app);
/* Make the object of the scene that the pointer is over the chosen one, and its layer, if it wears one of its own, the
   active one. False beside all of them. */
bool wr_patch_choose(WrApp *app, const WrPointer *at);

WrHandle wr_patch_handle_under(const WrApp *app, const WrPointer *at);
void wr_patch_handle_press(WrApp *app, const WrPointer *at);
void wr_patch_handle_drag(WrApp *app, const WrPointer *at);
void wr_patch_handle_release(WrApp *app); /* one command for what was dragged */
void wr_patch_handles_draw(const WrApp *app);
