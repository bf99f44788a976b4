/* Dragging on the patch: rotation, lights, zoom; each becomes one command at its end. */
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/layout.h"
#include "ui/patch/patch.h"
#include "ui/patch/patch_cube.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/line.h"
#include "ui/app/state/scene_line.h"
#include "ui/app/state/session_view.h"
#include "ui/toolkit/gui.h"
#include "ui/input/touch.h"
#include "ui/patch/preview/rotation.h"

#include "base/exactmath.h"
#include "base/text.h"
#include "base/vec.h"
#include "scene/param.h"
#include "scene/scene.h"
#include "shade/bump.h"
#include "surface/surface.h"
#include "system/clock.h"

#include <SDL.h>
#include <math.h>

/* ---- the patch while a command runs in the background ---- */

/* Rotation, panning and zoom still work, and their result becomes a command afterwards. */

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

bool wr_patch_view_event(WrApp *app, const SDL_Event *event)
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
    if (late == WR_PATCH_CAMERA) wr_viewport_commit_camera(app);
    if (late == WR_PATCH_TURNED) wr_patch_commit_turn(app);
}

/* ---- patch input ---- */

#define ZOOM_COMMIT_SECONDS 0.4
#define CLICK 3.0 /* pixels: shorter drags are clicks */

/* ---- the light ---- */

bool wr_patch_place(const WrApp *app, WrPlacement *out)
{
    const SDL_Rect *r = &app->layout->patch;
    return r->w > 0 &&
           wr_scene_place(wr_app_scene(app), app->patch->turn_deg, (double)r->w / r->h, out, NULL);
}

/* Rectangle in which lights are placed: the view without its edges. */
static void pad(const WrApp *app, double *cx, double *cy, double *rx, double *ry)
{
    const SDL_Rect *r = &app->layout->patch;
    double margin = 26.0 * wr_gui_scale();
    *cx = r->x + r->w / 2.0;
    *cy = r->y + r->h / 2.0;
    *rx = fmax(1.0, r->w / 2.0 - margin);
    *ry = fmax(1.0, r->h / 2.0 - margin);
}

static void light_spot(const WrApp *app, const WrPlacement *at, const WrLight *light, double *x,
                       double *y)
{
    WrVec3 w = light->where,
           camera = { v3_dot(w, at->right), v3_dot(w, at->up), -v3_dot(w, at->forward) };
    double cx, cy, rx, ry, dx, dy;
    pad(app, &cx, &cy, &rx, &ry);
    wr_light_to_pad(v3_unit(camera, (WrVec3){ 0, 0, 1 }), &dx, &dy);
    *x = cx + rx * dx;
    *y = cy - ry * dy;
}

/* Index of the light under a pixel, or -1. */
static int light_under(const WrApp *app, const WrPointer *p)
{
    WrPlacement at;
    const WrScene *scene = wr_app_scene(app);
    double reach = 14.0 * wr_gui_scale();
    if (!wr_patch_place(app, &at)) return -1;
    for (int i = scene->light_count - 1; i >= 0; i--) {
        double x, y;
        light_spot(app, &at, &scene->lights[i], &x, &y);
        if (hypot(p->x - x, p->y - y) <= reach) return i;
    }
    return -1;
}

bool wr_patch_control_under(const WrApp *app, const WrPointer *at)
{
    return wr_patch_cube_under(app, at) || light_under(app, at) >= 0;
}

/* Move the dragged light to the direction of (x, y); its distance is unchanged. */
static void move_light(WrApp *app, double x, double y)
{
    WrPlacement at;
    double cx, cy, rx, ry;
    if (!wr_patch_place(app, &at)) return;
    pad(app, &cx, &cy, &rx, &ry);
    WrVec3 d = wr_light_from_pad((x - cx) / rx, (cy - y) / ry);
    WrVec3 world =
        v3_add(v3_add(v3_scale(at.right, d.x), v3_scale(at.up, d.y)), v3_scale(at.forward, -d.z));
    WrLight *light = &wr_app_live_begin(app)->lights[app->patch->light];
    double length = wr_light_kinds[light->kind].placed ? v3_len(light->where) : 1.0;
    world = v3_scale(world, length > 0.0 ? length : 1.0);
    light->where = wr_line_round_vec(world, 3);
}

static void commit_light(WrApp *app)
{
    if (!app->live) return;
    const WrLight *light = &app->live->lights[app->patch->light];
    WrText line = { 0 };
    wr_line_light(&line, light, app->patch->light);
    wr_app_live_end(app);
    wr_app_run_line(app, wr_text_get(&line));
    wr_text_fini(&line);
}

/* ---- environment ---- */

/* A drag across the view is half a rotation; the near side follows the pointer, as in the rotation of the patch. */
static void turn_surroundings(WrApp *app, const WrPointer *at)
{
    const double dx = at->x - app->hand->start.x;
    if (!app->live && fabs(dx) < CLICK) return;
    const double deg = app->patch->from_turn + 180 * dx / app->layout->patch.w;
    wr_app_live_begin(app)->environment.turn_deg = wr_line_round(deg - 360 * rint(deg / 360), 1);
}

static void commit_surroundings(WrApp *app)
{
    if (!app->live) return;
    WrText line = { 0 };
    wr_text_add(&line, "environment");
    wr_line_number(&line, "turn", app->live->environment.turn_deg);
    wr_app_live_end(app);
    wr_app_run_line(app, wr_text_get(&line));
    wr_text_fini(&line);
}

/* ---- rotation by dragging ----

   A single object is rotated itself. With several objects the camera orbits its target, and one object is rotated by
   its handles. The middle button always orbits the camera. */

static bool several(const WrApp *app)
{
    return wr_app_scene(app)->other_count > 0;
}

static void start_orbit(WrApp *app)
{
    const WrScene *scene = wr_app_scene(app);
    const double *pose = wr_surfaces[scene->shape.kind]->pose_deg;
    WrVec3 deg = scene->posed ? scene->rotate_deg : (WrVec3){ pose[0], pose[1], pose[2] };
    WrPlacement at;
    app->patch->from = wr_rotation_from_deg(deg);
    app->patch->from_camera = scene->camera;
    if (wr_patch_place(app, &at)) app->patch->from_camera.eye = at.eye;
}

/* Half a rotation for a drag across the view, about the world's y axis and the horizontal axis; limited at the
   poles. */
static void orbit_camera(WrApp *app, double dx, double dy, double span)
{
    const WrCamera *from = &app->patch->from_camera;
    const WrVec3 back = v3_sub(from->eye, from->target);
    const double away = v3_len(back), most = 0.4999 * WR_PI, turn = WR_PI / span;
    const double round = atan2(back.x, back.z) - turn * dx;
    const double up = fmin(most, fmax(-most, asin(back.y / away) + turn * dy));
    const WrVec3 to = { cos(up) * sin(round), sin(up), cos(up) * cos(round) };
    WrCamera *camera = &wr_app_live_begin(app)->camera;
    camera->eye = v3_mad(from->target, to, away);
    camera->up = (WrVec3){ 0, 1, 0 };
}

static void pan_camera(WrApp *app, const WrPlacement *at, double dx, double dy)
{
    const WrCamera *from = &app->patch->from_camera;
    const double away = v3_len(v3_sub(from->eye, from->target));
    const double pixel = 2 * at->half_height * (at->orthographic ? 1 : away) / app->layout->patch.h;
    const WrVec3 by = v3_mad(v3_scale(at->right, -dx * pixel), at->up, dy * pixel);
    WrCamera *camera = &wr_app_live_begin(app)->camera;
    if (camera->fit) camera->frame = 0;
    camera->fit = false; /* "fit" would recompute the target's distance */
    camera->eye = v3_add(from->eye, by);
    camera->target = v3_add(from->target, by);
}

/* Drag distance in pixels for half a rotation: the width of the view. Closer than the full view it grows with the
   size of the object, so that its surface follows the pointer. */
static double half_turn(const WrApp *app, const WrPlacement *at)
{
    const SDL_Rect *r = &app->layout->patch;
    const WrCamera *camera = &app->patch->from_camera;
    const double across = r->w < r->h ? r->w : r->h, least = 0.02 * at->ball;
    if (app->patch->cube.pressed) return wr_patch_cube_span();
    double away = v3_len(v3_sub(camera->eye, camera->target));
    double fits = at->ball * r->h / (at->half_height * across); /* bounding sphere fills the view */
    if (at->orthographic) return across * fmax(1.0, fits);
    return across * fmax(1.0, fmax(fits - at->ball, least) / fmax(away - at->ball, least));
}

static void orbit(WrApp *app, const WrPointer *p)
{
    WrPlacement at;
    const double dx = p->x - app->hand->start.x, dy = p->y - app->hand->start.y;
    if (!wr_patch_place(app, &at) || (!app->live && hypot(dx, dy) < CLICK)) return;
    const double span = half_turn(app, &at);
    if (app->patch->pans) pan_camera(app, &at, dx, dy);
    else if (app->patch->rounds) orbit_camera(app, dx, dy, span);
    if (app->patch->pans || app->patch->rounds) return;
    WrRotation now =
        wr_rotation_dragged(&app->patch->from, app->patch->turn_deg, at.right, at.up, dx, dy, span);
    WrVec3 deg = wr_rotation_to_deg(&now);
    WrScene *scene = wr_app_live_begin(app);
    scene->posed = true;
    scene->rotate_deg = wr_line_round_vec(deg, 2);
}

/* Run eye, target and size of the dragged camera as a command. */
void wr_viewport_commit_camera(WrApp *app)
{
    const WrCamera *camera = &app->live->camera;
    WrText line = { 0 };
    wr_text_addf(&line, "camera %s", wr_camera_names[camera->orthographic]);
    wr_line_vec(&line, "eye", wr_line_round_vec(camera->eye, 4));
    wr_line_vec(&line, "target", wr_line_round_vec(camera->target, 4));
    wr_line_vec(&line, "up", wr_line_round_vec(camera->up, 4));
    if (camera->orthographic) wr_line_number(&line, "size", wr_line_round(camera->size, 4));
    if (camera->fit) wr_text_add(&line, " fit=on");
    wr_app_live_end(app);
    wr_app_run_line(app, wr_text_get(&line));
    wr_text_fini(&line);
}

static void commit_orbit(WrApp *app)
{
    app->hand->grab = WR_GRAB_NONE; /* a command would end the drag a second time */
    if (!app->live) {
        if (app->patch->cube.pressed) {
            wr_patch_cube_click(app, &app->hand->start);
            return;
        }
        if (!app->patch->pans && several(app)) wr_patch_choose(app, &app->hand->start);
        return;
    }
    if (app->patch->pans || app->patch->rounds) {
        wr_viewport_commit_camera(app);
        return;
    }
    wr_patch_commit_turn(app);
}

void wr_patch_commit_turn(WrApp *app)
{
    WrVec3 deg = wr_line_round_vec(app->live->rotate_deg, 2);
    WrText line = { 0 };
    wr_text_add(&line, "rotate ");
    wr_line_plain_vec(&line, deg);
    wr_app_live_end(app);
    wr_app_run_line(app, wr_text_get(&line));
    wr_text_fini(&line);
}

bool wr_patch_press(WrApp *app, const WrPointer *at)
{
    WrPatch *p = app->patch;
    if (!app->busy) {
        wr_patch_commit_zoom(app, true);
        wr_patch_cube_update(app, true);
    }
    p->cube.pressed = at->button == SDL_BUTTON_LEFT && wr_patch_cube_under(app, at);
    if (p->cube.pressed) {
        app->hand->grab = WR_GRAB_ORBIT;
        p->pans = false;
        p->rounds = several(app);
        start_orbit(app);
        return true;
    }
    int light = light_under(app, at);
    bool right = at->button == SDL_BUTTON_RIGHT;
    if (right && (at->mods & WR_MOD_SHIFT) && wr_app_scene(app)->environment.light) {
        app->hand->grab = WR_GRAB_SURROUND;
        p->from_turn = wr_app_scene(app)->environment.turn_deg;
        return true;
    }
    if (right && light < 0 && wr_app_scene(app)->light_count > 0) light = 0;
    if (light >= 0 && at->button != SDL_BUTTON_MIDDLE) {
        WrPlacement placed;
        if (!wr_patch_place(app, &placed)) return false;
        app->hand->grab = WR_GRAB_LIGHT;
        p->light = light;
        light_spot(app, &placed, &wr_app_scene(app)->lights[light], &p->light_x, &p->light_y);
        return true;
    }
    if (right) return false;
    if (at->button == SDL_BUTTON_LEFT && wr_patch_handle_under(app, at) != WR_HANDLE_NONE) {
        app->hand->grab = WR_GRAB_HANDLE;
        wr_patch_handle_press(app, at);
        return true;
    }
    app->hand->grab = WR_GRAB_ORBIT;
    p->pans = (at->mods & WR_MOD_SHIFT) != 0;
    p->rounds = several(app) || at->button == SDL_BUTTON_MIDDLE;
    start_orbit(app);
    return true;
}

void wr_patch_drag(WrApp *app, const WrPointer *at)
{
    if (app->hand->grab == WR_GRAB_LIGHT)
        move_light(app, app->patch->light_x + at->x - app->hand->start.x,
                   app->patch->light_y + at->y - app->hand->start.y);
    else if (app->hand->grab == WR_GRAB_HANDLE) wr_patch_handle_drag(app, at);
    else if (app->hand->grab == WR_GRAB_SURROUND) turn_surroundings(app, at);
    else orbit(app, at);
}

void wr_patch_release(WrApp *app)
{
    if (app->hand->grab == WR_GRAB_LIGHT) commit_light(app);
    else if (app->hand->grab == WR_GRAB_HANDLE) wr_patch_handle_release(app);
    else if (app->hand->grab == WR_GRAB_SURROUND) commit_surroundings(app);
    else commit_orbit(app);
}

/* ---- zoom ---- */

void wr_patch_wheel(WrApp *app, double steps)
{
    WrPlacement at;
    if (app->hand->grab != WR_GRAB_NONE || !wr_patch_place(app, &at)) return;
    if (app->patch->zoom_angle && !app->busy) wr_patch_commit_zoom(app, true);
    double factor = exp2(-steps / 6.0);
    WrScene *scene = wr_app_live_begin(app);
    WrCamera *camera = &scene->camera;
    WrVec3 back = v3_sub(at.eye, camera->target);
    double far_off = 400.0 * at.ball, near_by = 1.02 * at.ball;
    double distance = v3_len(back), wanted = distance * factor;
    wanted = wanted > far_off ? far_off : wanted < near_by && distance > near_by ? near_by : wanted;
    if (camera->orthographic) camera->size = 2.0 * at.half_height / at.widen * factor;
    else back = v3_scale(back, wanted / distance);
    if (camera->fit) camera->frame = 0;
    camera->fit = false;
    camera->eye = v3_add(camera->target, back);
    app->patch->zoom_commit_at = wr_clock_seconds() + ZOOM_COMMIT_SECONDS;
}

void wr_patch_grip(WrApp *app, const WrGrip *grip)
{
    WrPlacement at;
    if (app->hand->grab != WR_GRAB_NONE || !wr_patch_place(app, &at)) return;
    if (app->patch->zoom_angle && !app->busy) wr_patch_commit_zoom(app, true);
    start_orbit(app);
    if (wr_patch_paints(app)) orbit_camera(app, grip->dx, grip->dy, half_turn(app, &at));
    else pan_camera(app, &at, grip->dx, grip->dy);
    wr_patch_wheel(app, 6.0 * log2(grip->scale));
    app->patch->zoom_moves = true;
}

void wr_patch_wheel_angle(WrApp *app, double steps)
{
    const WrSceneParam *fov = &wr_scene_params[WR_SCENE_PARAM_FOV];
    if (app->hand->grab != WR_GRAB_NONE || wr_app_scene(app)->camera.orthographic) return;
    if (app->patch->zoom_commit_at > 0.0 && !app->patch->zoom_angle && !app->busy)
        wr_patch_commit_zoom(app, true);
    double *deg = &wr_app_live_begin(app)->camera.fov_deg;
    /* Six steps of the wheel halve the angle. */
    *deg = fmin(fov->soft_high, fmax(fov->soft_low, *deg * exp2(-steps / 6.0)));
    app->patch->zoom_angle = true;
    app->patch->zoom_commit_at = wr_clock_seconds() + ZOOM_COMMIT_SECONDS;
}

void wr_patch_commit_zoom(WrApp *app, bool now)
{
    if (app->patch->zoom_commit_at == 0.0 || app->busy)
        return; /* it waits for the running command */
    app->patch->zoom_commit_at = 0.0;
    const bool moves = app->patch->zoom_moves;
    app->patch->zoom_moves = false;
    if (!app->live || !now) {
        wr_app_live_end(app);
        return;
    }
    if (moves) {
        wr_viewport_commit_camera(app);
        return;
    }
    const WrCamera *camera = &app->live->camera;
    WrText line = { 0 };
    wr_text_addf(&line, "camera %s", wr_camera_names[camera->orthographic]);
    if (app->patch->zoom_angle) wr_line_number(&line, "fov", wr_line_round(camera->fov_deg, 2));
    else wr_line_vec(&line, "eye", wr_line_round_vec(camera->eye, 4));
    if (camera->orthographic) wr_line_number(&line, "size", wr_line_round(camera->size, 4));
    app->patch->zoom_angle = false;
    wr_app_live_end(app);
    wr_app_run_line(app, wr_text_get(&line));
    wr_text_fini(&line);
}

/* ---- input on the patch ---- */

void wr_patch_draw_lights(const WrApp *app)
{
    WrPlacement at;
    const WrScene *scene = wr_app_scene(app);
    double s = wr_gui_scale();
    if (!wr_patch_place(app, &at)) return;
    for (int i = 0; i < scene->light_count; i++) {
        double x, y;
        light_spot(app, &at, &scene->lights[i], &x, &y);
        bool behind = v3_dot(scene->lights[i].where, at.forward) > 0.0;
        for (int k = 4; k >= 1; k--) wr_gui_draw_disc(x, y, (9.0 + 2.2 * k) * s, 0x14ffd070u);
        wr_gui_draw_disc(x, y, 9.0 * s, behind ? 0xffb08a3cu : 0xfff2c860u);
        wr_gui_draw_disc(x - 2.0 * s, y - 2.0 * s, 5.0 * s, behind ? 0xffc49c4cu : 0xffffe7a8u);
    }
}
