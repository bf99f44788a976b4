/* The patch while a command runs in the background: rotation, panning and zoom still work, and their result becomes a
   command afterwards. */
#include "ui/state/app_state.h"
#include "ui/state/input_router.h"
#include "ui/state/keys.h"
#include "ui/state/layout.h"
#include "ui/patch/patch.h"
#include "ui/patch/patch_cube.h"

#include <SDL.h>

static WrPointer pointer(const WrApp *app, const SDL_Event *event, int button)
{
    const bool moves = event->type == SDL_MOUSEMOTION;
    return (WrPointer){ .x = (moves ? event->motion.x : event->button.x) + 0.5,
                        .y = (moves ? event->motion.y : event->button.y) + 0.5,
                        .pressure = 1.0,
                        .button = button,
                        .mods = app->hand->mods };
}

/* Lights, handles and the brush change the scene or the table, so they must wait. */
static bool press(WrApp *app, const SDL_Event *event)
{
    const WrPointer at = pointer(app, event, event->button.button);
    if (at.button == SDL_BUTTON_RIGHT || app->hand->grab != WR_GRAB_NONE) return false;
    if (wr_patch_paints(app) || wr_patch_cube_under(app, &at)) return false;
    app->hand->at = app->hand->start = at;
    if (wr_patch_press(app, &at) && app->hand->grab == WR_GRAB_ORBIT) {
        app->patch->meanwhile = WR_PATCH_HELD;
        return true;
    }
    app->hand->grab = WR_GRAB_NONE;
    return false;
}

static void let_go(WrApp *app)
{
    WrPatch *p = app->patch;
    app->hand->grab = WR_GRAB_NONE;
    p->meanwhile = !app->live             ? WR_PATCH_NOTHING
                   : p->pans || p->rounds ? WR_PATCH_CAMERA
                                          : WR_PATCH_TURNED;
}

static bool wheel(WrApp *app, const SDL_MouseWheelEvent *event)
{
    const double way = event->direction == SDL_MOUSEWHEEL_FLIPPED ? -1.0 : 1.0;
    const double steps = way * (double)event->preciseY;
    if (app->hand->mods & WR_MOD_CTRL) wr_patch_wheel_angle(app, steps);
    else wr_patch_wheel(app, steps);
    return true;
}

bool wr_patch_look(WrApp *app, const SDL_Event *event)
{
    const bool held = app->patch->meanwhile == WR_PATCH_HELD;
    if (held && event->type == SDL_MOUSEMOTION) {
        const WrPointer at = pointer(app, event, app->hand->start.button);
        wr_patch_drag(app, &at);
        app->hand->at = at;
        return true;
    }
    if (held && event->type == SDL_MOUSEBUTTONUP) {
        let_go(app);
        return true;
    }
    if (event->type == SDL_MOUSEBUTTONDOWN)
        return wr_layout_inside(&app->layout->patch, event->button.x, event->button.y) &&
               press(app, event);
    return event->type == SDL_MOUSEWHEEL &&
           wr_layout_inside(&app->layout->patch, app->hand->x, app->hand->y) &&
           wheel(app, &event->wheel);
}

void wr_patch_commit_late(WrApp *app)
{
    WrPatch *p = app->patch;
    if (p->meanwhile == WR_PATCH_HELD) let_go(app);
    const WrPatchLate late = p->meanwhile;
    p->meanwhile = WR_PATCH_NOTHING;
    if (!app->live) return;
    if (late == WR_PATCH_CAMERA) wr_patch_commit_camera(app);
    if (late == WR_PATCH_TURNED) wr_patch_commit_turn(app);
}
