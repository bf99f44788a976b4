/* Actions of the patch's camera and of the floor: each is one command line. */
#include "ui/app/actions.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/line.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/settings.h"
#include "ui/patch/patch.h"

#include "base/text.h"
#include "command/session.h"
#include "scene/camera_control.h"
#include "scene/backface_range.h"
#include "scene/camera.h"
#include "scene/objects.h"
#include "surface/surface.h"

#include <stdio.h>

#define ORBIT_DEG 15

/* ---- views ---- */

void wr_act_view_back(WrApp *app)
{
    wr_app_settle(app);
    wr_app_run_line(app, "view back");
}

/* A pending wheel zoom can be undone too. */
bool wr_can_view_back(const WrApp *app)
{
    return wr_session_view_undo_count(app->session) > 0 || app->patch->zoom_commit_at > 0.0;
}

bool wr_can_view_forward(const WrApp *app)
{
    return wr_session_redoable_views(app->session) > 0;
}

void wr_act_view_forward(WrApp *app)
{
    wr_app_settle(app); /* afterwards there is no view to redo */
    if (wr_can_view_forward(app)) wr_app_run_line(app, "view forward");
}

void wr_act_camera_reset(WrApp *app)
{
    wr_patch_commit_zoom(app, false);
    wr_app_run_line(app, "camera perspective eye=0,0,1 target=0,0,0 up=0,1,0 fov=35 fit=on");
}

void wr_act_pose_reset(WrApp *app)
{
    const double *pose = wr_surfaces[wr_app_scene(app)->shape.kind]->pose_deg;
    WrText line = { 0 };
    if (wr_app_scene(app)->other_count > 0) {
        if (wr_app_run_line(app, "object set turn=own")) app->patch->turn_deg = 0.0;
        return;
    }
    wr_text_add(&line, "rotate ");
    wr_line_plain_vec(&line, (WrVec3){ pose[0], pose[1], pose[2] });
    if (wr_app_run_line(app, wr_text_get(&line))) app->patch->turn_deg = 0.0;
    wr_text_fini(&line);
}

/* Set a standard view; the turntable stops at its angle in picture files. */
static void look_from(WrApp *app, WrSide side)
{
    wr_patch_commit_zoom(app, true);
    app->settings->turning = false;
    app->patch->turn_deg = 0.0;
    wr_app_run_linef(app, "camera from %s", wr_side_names[side]);
}

void wr_act_view_from_front(WrApp *app)
{
    look_from(app, WR_SIDE_FRONT);
}

void wr_act_view_from_back(WrApp *app)
{
    look_from(app, WR_SIDE_BACK);
}

void wr_act_view_from_left(WrApp *app)
{
    look_from(app, WR_SIDE_LEFT);
}

void wr_act_view_from_right(WrApp *app)
{
    look_from(app, WR_SIDE_RIGHT);
}

void wr_act_view_from_top(WrApp *app)
{
    look_from(app, WR_SIDE_TOP);
}

void wr_act_view_from_bottom(WrApp *app)
{
    look_from(app, WR_SIDE_BOTTOM);
}

static void orbit(WrApp *app, int right, int up)
{
    wr_patch_commit_zoom(app, true);
    wr_app_run_linef(app, "camera orbit %d,%d", right * ORBIT_DEG, up * ORBIT_DEG);
}

void wr_act_orbit_left(WrApp *app)
{
    orbit(app, -1, 0);
}

void wr_act_orbit_right(WrApp *app)
{
    orbit(app, 1, 0);
}

void wr_act_orbit_up(WrApp *app)
{
    orbit(app, 0, 1);
}

void wr_act_orbit_down(WrApp *app)
{
    orbit(app, 0, -1);
}

/* Fit the visible surface or, during rotation, everything visible in a full turn. */
void wr_act_camera_fill(WrApp *app)
{
    const SDL_Rect *room = &app->layout->patch;
    const double aspect = room->w > 0 ? (double)room->w / room->h : 1.0;
    double from = app->patch->turn_deg, to = from;
    wr_patch_commit_zoom(app, true);
    if (app->settings->turning) {
        const bool rocks = wr_scene_turn_shows_backs(wr_app_scene(app));
        from = rocks ? -WR_ROCK_DEG : 0.0, to = rocks ? WR_ROCK_DEG : 360.0;
    }
    wr_app_run_linef(app, "camera fill aspect=%.5g turn=%.5g,%.5g", aspect, from, to);
}

bool wr_is_perspective(const WrApp *app)
{
    return !wr_app_scene(app)->camera.orthographic;
}

void wr_act_camera_kind(WrApp *app)
{
    wr_patch_commit_zoom(app, true);
    wr_app_run_linef(app, "camera %s", wr_camera_names[wr_is_perspective(app)]);
}

/* Save under the first free name of view 1, view 2 ... */
void wr_act_view_keep(WrApp *app)
{
    char name[24];
    int number = 1;
    wr_patch_commit_zoom(app, true);
    do snprintf(name, sizeof name, "view %d", number++);
    while (wr_scene_find_view(wr_app_scene(app), name) >= 0);
    wr_app_run_linef(app, "camera save \"%s\"", name);
}

/* ---- floor ---- */

bool wr_is_ground(const WrApp *app)
{
    const WrScene *scene = wr_app_scene(app);
    const int index = wr_scene_object_find(scene, "ground");
    return index >= 0 && wr_scene_object(scene, index)->still;
}

void wr_act_ground(WrApp *app)
{
    wr_app_run_linef(app, wr_is_ground(app) ? "ground off" : "ground on");
}
