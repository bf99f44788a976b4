/* SPDX-License-Identifier: MIT
   The patch's view: what is wished of the preview and when, turning, the light, the camera. */
#include "ui/patch/patch.h"
#include "ui/desk/action.h"
#include "ui/desk/busy.h"
#include "ui/desk/desk.h"
#include "ui/desk/hand.h"
#include "ui/desk/layout.h"
#include "ui/desk/line.h"
#include "ui/desk/messages.h"
#include "ui/desk/roster.h"
#include "ui/desk/session_view.h"
#include "ui/desk/settings.h"
#include "ui/gui/gui.h"
#include "ui/gui/theme.h"
#include "ui/patch/patch_paint.h"
#include "ui/preview/preview.h"
#include "ui/preview/rotation.h"
#include "ui/tools/stroke_hand.h"

#include "base/clock.h"
#include "base/error.h"
#include "base/text.h"
#include "base/vec.h"
#include "field/field.h"
#include "scene/scene.h"
#include "shade/bump.h"
#include "surface/surface.h"

#include <SDL.h>
#include <math.h>

#define TURN_DEG_PER_SECOND 14.0
#define PICTURE_SECONDS (1.0 / 40.0) /* between moving pictures */
#define QUICK_SECONDS (1.0 / 100.0)  /* the same while it is painted on: soon, not often */
#define REST_SECONDS 0.12            /* without change before the picture is made sharp */
#define ZOOM_COMMIT_SECONDS 0.4

/* ---- wishes ---- */

bool wr_patch_paints(const WrApp *app)
{
    return app->paint->on && app->layout->patch.w > 0;
}

static bool is_painted(const WrApp *app)
{
    return app->brush->jobs.count > 0;
}

static double picture_seconds(const WrApp *app)
{
    return is_painted(app) ? QUICK_SECONDS : PICTURE_SECONDS;
}

/* Nobody can aim at what moves. */
static bool is_held(const WrApp *app)
{
    return app->hand->grab == WR_GRAB_PATCH_PAINT || (wr_patch_paints(app) && app->hand->on_patch);
}

/* It stops as it is shown, not as it was wished for last. */
static void hold_still(WrApp *app)
{
    WrPatch *p = app->patch;
    bool held = is_held(app);
    const WrPreviewPicture *picture = wr_preview_picture(app->preview);
    if (held && !p->held && app->settings->turning && picture->serial > 0)
        p->turn_deg = picture->turn_deg;
    p->held = held;
}

static bool turns(const WrApp *app)
{
    return app->settings->turning && !is_held(app) && app->visible && app->layout->patch.w > 0 &&
           app->hand->grab != WR_GRAB_ORBIT && app->hand->grab != WR_GRAB_LIGHT;
}

static bool differs(const WrApp *app)
{
    const WrPatch *p = app->patch;
    return !p->wished_field || wr_field_key(p->wished_field) != wr_field_key(wr_app_field(app)) ||
           p->wished_scene != wr_app_scene(app) || p->wished_turn != p->turn_deg ||
           p->wished_w != app->layout->patch.w || p->wished_h != app->layout->patch.h;
}

/* Only the table differs from what a resting, finished picture shows (or is being refreshed to show): the
 * preview then renders what the edit reaches, at once sharp. */
static bool only_edited(const WrApp *app)
{
    const WrPatch *p = app->patch;
    return p->wished_field && !p->wished_moving && p->wished_scene == wr_app_scene(app) &&
           p->wished_turn == p->turn_deg && p->wished_w == app->layout->patch.w &&
           p->wished_h == app->layout->patch.h &&
           (p->refreshing || wr_preview_settled(app->preview));
}

static void wish(WrApp *app, bool moving)
{
    WrPatch *p = app->patch;
    const SDL_Rect *room = &app->layout->patch;
    WrPreviewWish w = { .field = wr_app_field(app),
                        .scene = wr_app_scene(app),
                        .turn_deg = p->turn_deg,
                        .width = room->w,
                        .height = room->h,
                        .tag = app->brush->shown,
                        .moving = moving,
                        .painting = is_painted(app) };
    wr_preview_want(app->preview, &w);
    wr_field_free(p->wished_field);
    if (p->wished_scene) wr_scene_free(p->wished_scene);
    p->wished_field = wr_field_share(w.field);
    p->wished_scene = wr_scene_share(w.scene);
    p->wished_turn = p->turn_deg;
    p->wished_w = room->w;
    p->wished_h = room->h;
    p->wished_moving = moving;
    p->wished_painted = is_painted(app);
    p->outstanding = moving;
    p->refreshing = false;
    p->wished_at = wr_clock_seconds();
    p->rest_at = p->wished_at + REST_SECONDS;
}

static void take_picture(WrApp *app)
{
    WrPatch *p = app->patch;
    const WrPreviewPicture *picture = wr_preview_picture(app->preview);
    WrError err;
    if (wr_preview_error(app->preview, &err)) {
        wr_app_fail(app, &err);
        p->outstanding = false;
        if (app->settings->turning) app->settings->turning = false; /* once is enough */
    }
    if (picture->serial == 0 || (picture->serial == p->serial && p->texture)) return;
    p->serial = picture->serial;
    p->seen = picture->tag;
    p->outstanding = false;
    if (!p->texture || p->texture_w < picture->width || p->texture_h < picture->height) {
        if (p->texture) SDL_DestroyTexture(p->texture);
        p->texture_w = picture->width > p->texture_w ? picture->width : p->texture_w;
        p->texture_h = picture->height > p->texture_h ? picture->height : p->texture_h;
        p->texture = SDL_CreateTexture(app->renderer, SDL_PIXELFORMAT_ARGB8888,
                                       SDL_TEXTUREACCESS_STREAMING, p->texture_w, p->texture_h);
        if (!p->texture) return;
        SDL_SetTextureBlendMode(p->texture, SDL_BLENDMODE_NONE);
        SDL_SetTextureScaleMode(p->texture, SDL_ScaleModeLinear);
    }
    SDL_UpdateTexture(p->texture, &(SDL_Rect){ 0, 0, picture->width, picture->height },
                      picture->bgra, 4 * picture->width);
    if (app->redraw < 1) app->redraw = 1; /* the widgets have nothing to settle */
}

/* A body turns; a sheet, of which the back would be seen, mirrored, rocks to and fro. */
static void advance_turn(WrPatch *p, const WrScene *scene, double now)
{
    double step = now - p->turned_at;
    p->turned_at = now;
    if (step > 0.2) step = 0.2; /* after a pause it goes on, it does not jump */
    if (wr_surfaces[scene->shape.kind]->open)
        p->turn_deg = wr_rotation_rock(&p->rock, p->turn_deg, step);
    else p->turn_deg = fmod(p->turn_deg + TURN_DEG_PER_SECOND * step, 360.0);
}

void wr_patch_update(WrApp *app)
{
    WrPatch *p = app->patch;
    double now = wr_clock_seconds();
    take_picture(app);
    hold_still(app);
    if (p->zoom_commit_at > 0.0 && now >= p->zoom_commit_at) wr_patch_commit_zoom(app, true);
    if (app->layout->patch.w <= 0 || !app->visible || app->drawn_at == 0.0) return;
    bool ready = !p->outstanding && now >= p->wished_at + picture_seconds(app);
    if (turns(app)) {
        if (!ready) return;
        advance_turn(p, wr_app_scene(app), now);
        wish(app, true);
        return;
    }
    p->turned_at = now;
    if (differs(app)) {
        bool edited = only_edited(app);
        if (edited ? p->outstanding : !ready) return; /* what an edit reaches is made in no time */
        wish(app, !edited);
        p->refreshing = edited;
        p->outstanding = true;
    } else if (p->wished_painted && !is_painted(app) && !p->wished_moving && !p->outstanding) {
        wish(app, false); /* what was only quick may become fine */
    } else if (p->wished_moving && !p->outstanding && now >= p->rest_at) {
        wish(app, false);
    }
}

double wr_patch_next_time(const WrApp *app)
{
    const WrPatch *p = app->patch;
    double next = p->zoom_commit_at;
    if (app->layout->patch.w <= 0 || !app->visible) return next;
    double due = 0.0;
    if ((turns(app) || differs(app)) && !p->outstanding)
        due = only_edited(app) && !turns(app) ? p->wished_at : p->wished_at + picture_seconds(app);
    else if (p->wished_moving && !p->outstanding && app->hand->grab == WR_GRAB_NONE)
        due = p->rest_at;
    if (due > 0.0 && (next == 0.0 || due < next)) next = due;
    return next;
}

void wr_patch_free(WrApp *app)
{
    WrPatch *p = app->patch;
    wr_field_free(p->wished_field);
    if (p->wished_scene) wr_scene_free(p->wished_scene);
    if (p->texture) SDL_DestroyTexture(p->texture);
    *p = (WrPatch){ 0 };
}

/* ---- the light ---- */

static bool place(const WrApp *app, WrPlacement *out)
{
    const SDL_Rect *r = &app->layout->patch;
    return r->w > 0 &&
           wr_scene_place(wr_app_scene(app), app->patch->turn_deg, (double)r->w / r->h, out, NULL);
}

/* The pad on which lights stand: the view without its edges. */
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

/* The light under a pixel, or -1. */
static int light_under(const WrApp *app, const WrPointer *p)
{
    WrPlacement at;
    const WrScene *scene = wr_app_scene(app);
    double reach = 14.0 * wr_gui_scale();
    if (!place(app, &at)) return -1;
    for (int i = scene->light_count - 1; i >= 0; i--) {
        double x, y;
        light_spot(app, &at, &scene->lights[i], &x, &y);
        if (hypot(p->x - x, p->y - y) <= reach) return i;
    }
    return -1;
}

/* Put the light that is held where (x, y) says; its distance stays. */
static void move_light(WrApp *app, double x, double y)
{
    WrPlacement at;
    double cx, cy, rx, ry;
    if (!place(app, &at)) return;
    pad(app, &cx, &cy, &rx, &ry);
    WrVec3 d = wr_light_from_pad((x - cx) / rx, (cy - y) / ry);
    WrVec3 world =
        v3_add(v3_add(v3_scale(at.right, d.x), v3_scale(at.up, d.y)), v3_scale(at.forward, -d.z));
    WrLight *light = &wr_app_live(app)->lights[app->patch->light];
    double length = light->kind == WR_LIGHT_POINT ? v3_len(light->where) : 1.0;
    world = v3_scale(world, length > 0.0 ? length : 1.0);
    light->where = wr_line_round_vec(world, 3);
}

static void commit_light(WrApp *app)
{
    if (!app->live) return;
    const WrLight *light = &app->live->lights[app->patch->light];
    bool point = light->kind == WR_LIGHT_POINT;
    WrText line = { 0 };
    wr_text_add(&line, point ? "light point" : "light directional");
    wr_line_vec(&line, point ? "at" : "to", light->where);
    wr_line_vec(&line, "colour", light->colour);
    wr_line_number(&line, "strength", light->strength);
    wr_text_addf(&line, " index=%d", app->patch->light + 1);
    wr_app_live_end(app);
    wr_app_run_line(app, wr_text_get(&line));
    wr_text_fini(&line);
}

/* ---- turning by hand ---- */

static void start_orbit(WrApp *app)
{
    const WrScene *scene = wr_app_scene(app);
    const double *pose = wr_surfaces[scene->shape.kind]->pose_deg;
    WrVec3 deg = scene->posed ? scene->rotate_deg : (WrVec3){ pose[0], pose[1], pose[2] };
    app->patch->from = wr_rotation_from_deg(deg);
}

static void orbit(WrApp *app, const WrPointer *p)
{
    WrPlacement at;
    if (!place(app, &at)) return;
    const SDL_Rect *r = &app->layout->patch;
    WrRotation now = wr_rotation_dragged(&app->patch->from, app->patch->turn_deg, at.right, at.up,
                                         p->x - app->hand->start.x, p->y - app->hand->start.y,
                                         r->w < r->h ? r->w : r->h);
    WrVec3 deg = wr_rotation_to_deg(&now);
    WrScene *scene = wr_app_live(app);
    scene->posed = true;
    scene->rotate_deg = wr_line_round_vec(deg, 2);
}

static void commit_orbit(WrApp *app)
{
    if (!app->live) return;
    WrVec3 deg = app->live->rotate_deg;
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
    wr_patch_commit_zoom(app, true);
    int light = light_under(app, at);
    bool right = at->button == SDL_BUTTON_RIGHT;
    if (right && light < 0 && wr_app_scene(app)->light_count > 0) light = 0;
    if (light >= 0 && at->button != SDL_BUTTON_MIDDLE) {
        WrPlacement placed;
        if (!place(app, &placed)) return false;
        app->hand->grab = WR_GRAB_LIGHT;
        p->light = light;
        light_spot(app, &placed, &wr_app_scene(app)->lights[light], &p->light_x, &p->light_y);
        return true;
    }
    if (right) return false;
    app->hand->grab = WR_GRAB_ORBIT;
    start_orbit(app);
    return true;
}

void wr_patch_drag(WrApp *app, const WrPointer *at)
{
    if (app->hand->grab == WR_GRAB_LIGHT)
        move_light(app, app->patch->light_x + at->x - app->hand->start.x,
                   app->patch->light_y + at->y - app->hand->start.y);
    else orbit(app, at);
}

void wr_patch_release(WrApp *app)
{
    if (app->hand->grab == WR_GRAB_LIGHT) commit_light(app);
    else commit_orbit(app);
}

/* ---- zoom ---- */

void wr_patch_wheel(WrApp *app, double steps)
{
    WrPlacement at;
    if (app->hand->grab != WR_GRAB_NONE || !place(app, &at)) return;
    double factor = exp2(-steps / 6.0);
    WrScene *scene = wr_app_live(app);
    WrCamera *camera = &scene->camera;
    WrVec3 back = v3_sub(at.eye, camera->target);
    double far_off = 400.0 * at.radius, near_by = 1.02 * at.radius;
    double distance = v3_len(back), wanted = distance * factor;
    wanted = wanted > far_off ? far_off : wanted < near_by && distance > near_by ? near_by : wanted;
    if (camera->orthographic) camera->size = 2.0 * at.half_height * factor;
    else back = v3_scale(back, wanted / distance);
    camera->fit = false;
    camera->eye = v3_add(camera->target, back);
    app->patch->zoom_commit_at = wr_clock_seconds() + ZOOM_COMMIT_SECONDS;
}

void wr_patch_commit_zoom(WrApp *app, bool now)
{
    if (app->patch->zoom_commit_at == 0.0) return;
    app->patch->zoom_commit_at = 0.0;
    if (!app->live || !now) {
        wr_app_live_end(app);
        return;
    }
    const WrCamera *camera = &app->live->camera;
    WrText line = { 0 };
    wr_text_addf(&line, "camera %s", camera->orthographic ? "orthographic" : "perspective");
    wr_line_vec(&line, "eye", wr_line_round_vec(camera->eye, 4));
    if (camera->orthographic) wr_line_number(&line, "size", wr_line_round(camera->size, 4));
    wr_app_live_end(app);
    wr_app_run_line(app, wr_text_get(&line));
    wr_text_fini(&line);
}

/* ---- drawing ---- */

void wr_patch_draw(WrApp *app)
{
    const SDL_Rect *room = &app->layout->patch;
    WrPatch *p = app->patch;
    if (room->w <= 0) return;
    const WrPreviewPicture *picture = wr_preview_picture(app->preview);
    if (!p->texture || picture->serial == 0) {
        SDL_SetRenderDrawColor(app->renderer, 0x2e, 0x2f, 0x30, 255);
        SDL_RenderFillRect(app->renderer, room);
        return;
    }
    if (picture->serial != p->serial) take_picture(app);
    SDL_RenderCopy(app->renderer, p->texture, &(SDL_Rect){ 0, 0, picture->width, picture->height },
                   room);
}

static void draw_lights(const WrApp *app)
{
    WrPlacement at;
    const WrScene *scene = wr_app_scene(app);
    double s = wr_gui_scale();
    if (!place(app, &at)) return;
    for (int i = 0; i < scene->light_count; i++) {
        double x, y;
        light_spot(app, &at, &scene->lights[i], &x, &y);
        bool behind = v3_dot(scene->lights[i].where, at.forward) > 0.0;
        for (int k = 4; k >= 1; k--) wr_gui_draw_disc(x, y, (9.0 + 2.2 * k) * s, 0x14ffd070u);
        wr_gui_draw_disc(x, y, 9.0 * s, behind ? 0xffb08a3cu : 0xfff2c860u);
        wr_gui_draw_disc(x - 2.0 * s, y - 2.0 * s, 5.0 * s, behind ? 0xffc49c4cu : 0xffffe7a8u);
    }
}

/* How far the picture is from its best: a ring that closes. */
static void draw_ring(const WrApp *app, const WrPreviewPicture *picture)
{
    const SDL_Rect *room = &app->layout->patch;
    double s = wr_gui_scale(), x = room->x + room->w - 22.0 * s, y = room->y + room->h - 22.0 * s;
    wr_gui_draw_circle(x, y, 6.0 * s, 0x60000000u, 2.0 * s);
    if (picture->level > WR_PREVIEW_NONE)
        wr_gui_draw_arc(x, y, 6.0 * s, picture->level / (double)WR_PREVIEW_FINAL,
                        picture->level == WR_PREVIEW_FINAL ? 0xff8a8a8au : WR_COLOUR_ACCENT,
                        2.0 * s);
}

void wr_patch_overlay(WrApp *app)
{
    const SDL_Rect *room = &app->layout->patch;
    if (room->w <= 0) return;
    wr_gui_draw_clip(*room);
    draw_lights(app);
    draw_ring(app, wr_preview_picture(app->preview));
    wr_gui_draw_unclip();
    int gap = wr_gui_px(12);
    if (room->w <= wr_gui_px(140)) return;
    wr_gui_overlay_begin("##turn", room->x + room->w - gap, room->y + gap, 1, 0);
    bool turning = app->settings->turning;
    if (room->w > wr_gui_px(220)) {
        if (wr_gui_chip(WR_ICON_BRUSH, app->paint->on ? "painting" : "paint"))
            wr_action_run(app, "paint_patch");
        wr_gui_tip(app->paint->on ? "The brush paints on the object, which stands still under it. "
                                    "Click to turn it by hand again."
                                  : "Paint on the object itself.");
        wr_gui_same_line(6);
    }
    if (wr_gui_chip(turning ? WR_ICON_PAUSE : WR_ICON_PLAY, turning ? "turning" : "paused"))
        wr_action_run(app, "turn");
    wr_gui_tip(
        "Space over the patch. Drag it to turn it by hand, drag with the right button to move "
        "the light, wheel to come closer.");
    wr_gui_overlay_end();
    bool over = app->hand->on_patch;
    wr_preview_point(app->preview, over ? (app->hand->at.x - room->x) / room->w : -1.0,
                     over ? (app->hand->at.y - room->y) / room->h : -1.0);
}

/* ---- the part ---- */

static void settle(WrApp *app)
{
    wr_patch_commit_zoom(app, true);
}

static void another(WrApp *app)
{
    wr_patch_commit_zoom(app, false);
}

static void forget(WrApp *app)
{
    app->patch->serial = 0;
}

const WrPart wr_part_patch = { .update = wr_patch_update,
                               .next_time = wr_patch_next_time,
                               .meanwhile = wr_patch_update,
                               .draw = wr_patch_draw,
                               .settle = settle,
                               .another = another,
                               .forget = forget };
