/* The patch view: requests to the preview and their timing, and drawing. */
#include "ui/patch/patch.h"
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/retained_frame.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/patch/patch_objects.h"
#include "ui/patch/patch_paint.h"
#include "ui/patch/preview/preview.h"
#include "ui/patch/preview/rotation.h"
#include "ui/canvas/tools/stroke_input.h"
#include "ui/canvas/overlays/marks.h"

#include "command/session.h"
#include "document/document.h"
#include "base/error.h"
#include "base/text.h"
#include "field/field.h"
#include "scene/backface_range.h"
#include "scene/scene.h"
#include "surface/surface.h"
#include "system/clock.h"

#include <SDL.h>
#include <math.h>

#define TURN_DEG_PER_SECOND 14.0
#define PICTURE_SECONDS (1.0 / 40.0) /* least interval of moving pictures */
#define QUICK_SECONDS (1.0 / 150.0)  /* the interval while painting: low latency */
/* time without change before the picture is rendered at full quality */
#define REST_SECONDS 0.12

/* ---- requests ---- */

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

/* Rotation stops during aiming and dragging. */
static bool is_held(const WrApp *app)
{
    return app->hand->grab == WR_GRAB_PATCH_PAINT || (wr_patch_paints(app) && app->hand->on_patch);
}

/* Stop at the displayed rotation, not at the last requested one. */
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
           !wr_grab_on_patch(app->hand->grab);
}

/* Prepared tables of the scene's objects, if some use a table other than the composite. The caller frees them. */
static WrTables *tables_of(const WrApp *app)
{
    return wr_document_tables(wr_app_document(app), wr_app_scene(app), &app->patch->table_cache,
                              NULL);
}

static bool other_tables(const WrApp *app)
{
    WrTables *tables = tables_of(app);
    const bool other = !wr_tables_same(app->patch->wished_tables, tables);
    wr_tables_free(tables);
    return other;
}

static bool differs(const WrApp *app)
{
    const WrPatch *p = app->patch;
    return !p->wished_field || wr_field_key(p->wished_field) != wr_field_key(wr_app_field(app)) ||
           other_tables(app) || p->wished_scene != wr_app_scene(app) ||
           p->wished_turn != p->turn_deg || p->wished_w != app->layout->patch.w ||
           p->wished_h != app->layout->patch.h || !wr_preview_look_same(&p->wished_look, &p->look);
}

/* True if only the table differs from a static, finished picture (or one being refreshed). The preview then
 * re-renders only the dirty region, at full quality. */
static bool only_edited(const WrApp *app)
{
    const WrPatch *p = app->patch;
    return p->wished_field && !p->wished_moving && p->wished_scene == wr_app_scene(app) &&
           p->wished_turn == p->turn_deg && p->wished_w == app->layout->patch.w &&
           p->wished_h == app->layout->patch.h && wr_preview_look_same(&p->wished_look, &p->look) &&
           (p->refreshing || wr_preview_settled(app->preview));
}

static void wish(WrApp *app, bool moving)
{
    WrPatch *p = app->patch;
    const SDL_Rect *room = &app->layout->patch;
    WrTables *tables = tables_of(app);
    WrPreviewRequest w = { .field = wr_app_field(app),
                           .scene = wr_app_scene(app),
                           .tables = tables,
                           .turn_deg = p->turn_deg,
                           .width = room->w,
                           .height = room->h,
                           .tag = app->brush->shown,
                           .chosen = moving ? NULL : wr_session_chosen(app->session),
                           .moving = moving,
                           .painting = is_painted(app),
                           .look = p->look };
    wr_preview_want(app->preview, &w);
    wr_field_free(p->wished_field);
    wr_tables_free(p->wished_tables);
    p->wished_tables = tables;
    if (p->wished_scene) wr_scene_free(p->wished_scene);
    p->wished_field = wr_field_share(w.field);
    p->wished_scene = wr_scene_share(w.scene);
    p->wished_turn = p->turn_deg;
    p->wished_w = room->w;
    p->wished_h = room->h;
    p->wished_moving = moving;
    p->wished_painted = is_painted(app);
    p->wished_look = p->look;
    p->outstanding = moving;
    p->refreshing = false;
    p->wished_at = wr_clock_seconds();
    p->rest_at = p->wished_at + REST_SECONDS;
}

/* Store the dials chosen for the static document, to be saved with it. */
static void keep_chosen(WrApp *app, const WrPreviewPicture *picture)
{
    const WrPatch *p = app->patch;
    if (!picture->kept || p->wished_moving || p->wished_scene != wr_app_document(app)->scene)
        return;
    wr_session_keep_chosen(app->session, picture->kept);
}

/* Copy only the changed parts of the picture to the texture. */
static void put_picture(WrApp *app, const WrPreviewPicture *picture, uint64_t had)
{
    WrPatch *p = app->patch;
    const SDL_Rect *room = &app->layout->patch;
    SDL_Rect part = { 0, 0, picture->width, picture->height };
    if (had != 0 && picture->since == had) part = picture->changed;
    if (part.w == 0) return;
    const uint8_t *from =
        picture->bgra + 4 * ((size_t)part.y * (size_t)picture->width + (size_t)part.x);
    wr_gui_sdl_update(p->texture, &part, from, 4 * picture->width);
    part.x += room->x;
    part.y += room->y;
    wr_retained_frame_changed(wr_gui_kept(app->gui), &part);
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
    uint64_t had = p->texture ? p->serial : 0;
    p->serial = picture->serial;
    p->clipped = picture->clipped;
    p->seen = picture->tag;
    p->outstanding = false;
    keep_chosen(app, picture);
    if (!p->texture || p->texture_w < picture->width || p->texture_h < picture->height) {
        if (p->texture) SDL_DestroyTexture(p->texture);
        p->texture_w = picture->width > p->texture_w ? picture->width : p->texture_w;
        p->texture_h = picture->height > p->texture_h ? picture->height : p->texture_h;
        p->texture = SDL_CreateTexture(app->renderer, SDL_PIXELFORMAT_ARGB8888,
                                       SDL_TEXTUREACCESS_STREAMING, p->texture_w, p->texture_h);
        had = 0;
        if (!p->texture) return;
        SDL_SetTextureBlendMode(p->texture, SDL_BLENDMODE_NONE);
        SDL_SetTextureScaleMode(p->texture, SDL_ScaleModeLinear);
    }
    put_picture(app, picture, had);
    if (app->redraw < 1) app->redraw = 1; /* widgets need no second frame */
}

/* Closed surfaces rotate; if the mirrored back of an open one would become visible, all objects rock to and fro. */
static bool rocks(WrPatch *p, const WrScene *scene)
{
    if (p->rock_scene == scene) return p->rocks;
    if (p->rock_scene) wr_scene_free(p->rock_scene);
    p->rock_scene = wr_scene_share(scene);
    p->rocks = wr_scene_turn_shows_backs(scene);
    return p->rocks;
}

static void advance_turn(WrPatch *p, const WrScene *scene, double now)
{
    double step = now - p->turned_at;
    p->turned_at = now;
    if (step > 0.2) step = 0.2; /* after a pause the rotation continues without a jump */
    if (rocks(p, scene)) p->turn_deg = wr_rotation_rock(&p->rock, p->turn_deg, step);
    else p->turn_deg = fmod(p->turn_deg + TURN_DEG_PER_SECOND * step, 360.0);
}

/* A turned body became a sheet while the turning rests: nothing but its edge or its back would be seen. */
static void face_sheet(WrPatch *p, const WrScene *scene)
{
    const double turn = p->turn_deg;
    if (turn > WR_ROCK_DEG && turn < 360.0 - WR_ROCK_DEG && rocks(p, scene)) p->turn_deg = 0.0;
}

/* Fetch results. */
static void patch_update(WrApp *app)
{
    WrPatch *p = app->patch;
    double now = wr_clock_seconds();
    take_picture(app);
    if (!app->busy) {
        wr_patch_commit_late(app);
        wr_patch_cube_update(app, false);
    }
    hold_still(app);
    wr_patch_prepare_mesh(app);
    if (p->zoom_commit_at > 0.0 && now >= p->zoom_commit_at) wr_patch_commit_zoom(app, true);
}

/* Send requests: after the frame, because the table of a large change is drawn by all processors, sooner than the patch. */
static void patch_after(WrApp *app)
{
    WrPatch *p = app->patch;
    const double now = wr_clock_seconds();
    if (app->layout->patch.w <= 0 || !app->visible || app->drawn_at == 0.0) return;
    bool ready = !p->outstanding && now >= p->wished_at + picture_seconds(app);
    if (turns(app)) {
        if (!ready) return;
        advance_turn(p, wr_app_scene(app), now);
        wish(app, true);
        return;
    }
    p->turned_at = now;
    face_sheet(p, wr_app_scene(app));
    if (differs(app)) {
        bool edited = only_edited(app);
        if (edited ? p->outstanding : !ready) return; /* a partial re-render is fast */
        wish(app, !edited);
        p->refreshing = edited;
        p->outstanding = true;
        return;
    }
    /* motions that changed nothing are in the picture, too */
    if (!p->outstanding && !app->busy) p->seen = app->brush->shown;
    if (p->wished_painted && !is_painted(app) && !p->wished_moving && !p->outstanding) {
        wish(app, false); /* a rough picture may be refined now */
    } else if (p->wished_moving && !p->outstanding && now >= p->rest_at) {
        wish(app, false);
    }
}

double wr_patch_next_time(const WrApp *app)
{
    const WrPatch *p = app->patch;
    double next = p->cube.began > 0.0 ? p->turned_at : p->zoom_commit_at;
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
    wr_tables_free(p->wished_tables);
    wr_table_cache_fini(&p->table_cache);
    if (p->wished_scene) wr_scene_free(p->wished_scene);
    if (p->rock_scene) wr_scene_free(p->rock_scene);
    if (p->texture) SDL_DestroyTexture(p->texture);
    *p = (WrPatch){ 0 };
}

/* ---- drawing ---- */

static void patch_draw(WrApp *app)
{
    const SDL_Rect *room = &app->layout->patch;
    WrPatch *p = app->patch;
    if (room->w <= 0) return;
    const WrPreviewPicture *picture = wr_preview_picture(app->preview);
    if (!p->texture || picture->serial == 0) {
        wr_retained_frame_fill(wr_gui_kept(app->gui), room, WR_COLOUR_SURROUND);
        return;
    }
    if (picture->serial != p->serial) take_picture(app);
    wr_retained_frame_copy_tracked(wr_gui_kept(app->gui), p->texture,
                                   &(SDL_Rect){ 0, 0, picture->width, picture->height }, room);
}

/* Quality of the picture: a ring that closes. */
static void draw_ring(const WrApp *app, const WrPreviewPicture *picture)
{
    const SDL_Rect *room = &app->layout->patch;
    double s = wr_gui_scale(), x = room->x + room->w - 22.0 * s, y = room->y + room->h - 22.0 * s;
    wr_gui_draw_circle(x, y, 6.0 * s, 0x60000000u, 2.0 * s);
    if (picture->level > WR_PREVIEW_NONE)
        wr_gui_draw_arc(x, y, 6.0 * s, picture->level / (double)WR_PREVIEW_FINAL,
                        picture->level == WR_PREVIEW_FINAL ? WR_COLOUR_MUTED : WR_COLOUR_ACCENT,
                        2.0 * s);
}

/* Show a reminder that an effect was disabled or forced by hand. */
static void draw_look(const WrApp *app)
{
    const WrPreviewLook *look = &app->patch->look;
    const SDL_Rect *room = &app->layout->patch;
    WrText text = { 0 };
    if (!look->force) return;
    wr_text_addf(&text, "%s: %s", wr_words(look->force == WR_FORCE_OFF ? "without" : "with"),
                 wr_words(wr_effects[look->effect].name));
    wr_overlay_label(room->x + room->w / 2.0, room->y + room->h - 24.0 * wr_gui_scale(),
                     wr_text_get(&text));
    wr_text_fini(&text);
}

void wr_patch_overlay(WrApp *app)
{
    const SDL_Rect *room = &app->layout->patch;
    if (room->w <= 0) return;
    wr_gui_draw_clip(*room);
    wr_patch_draw_lights(app);
    wr_patch_handles_draw(app);
    wr_patch_cube_draw(app);
    draw_ring(app, wr_preview_picture(app->preview));
    draw_look(app);
    wr_gui_draw_unclip();
    int gap = wr_gui_px(12);
    if (room->w <= wr_gui_px(140)) return;
    wr_gui_overlay_begin("##turn", room->x + room->w - gap, room->y + gap, 1, 0);
    bool turning = app->settings->turning;
    if (room->w > wr_gui_px(220)) {
        wr_gui_next_id("paint");
        if (wr_gui_chip(WR_ICON_BRUSH, app->paint->on ? "painting" : "paint"))
            wr_action_run(app, WR_ACT(paint_patch));
        wr_gui_tip(app->paint->on ? "The brush paints on the object, which does not turn "
                                    "meanwhile. Click to turn it by hand again."
                                  : "Paint on the object itself.");
        wr_gui_same_line(6);
    }
    wr_gui_next_id("turning");
    if (wr_gui_chip(turning ? WR_ICON_PAUSE : WR_ICON_PLAY, turning ? "turning" : "paused"))
        wr_action_run(app, WR_ACT(turn));
    wr_gui_tip("Key: Space over the patch. Drag to turn the object, with the middle button to "
               "orbit, with Shift to pan, with the right button to move the light; the wheel "
               "zooms, with Ctrl it changes the angle of view.");
    wr_gui_overlay_end();
    bool over = app->hand->on_patch;
    wr_preview_point(app->preview, over ? (app->hand->at.x - room->x) / room->w : -1.0,
                     over ? (app->hand->at.y - room->y) / room->h : -1.0);
}

/* ---- component ---- */

static void settle(WrApp *app)
{
    if (app->busy) return;
    wr_patch_commit_late(app);
    wr_patch_cube_update(app, true);
    wr_patch_commit_zoom(app, true);
}

static void another(WrApp *app)
{
    app->patch->meanwhile = WR_PATCH_NOTHING;
    app->patch->turn_deg = app->patch->rock = 0.0; /* it is seen from its front */
    wr_patch_commit_zoom(app, false);
}

static void forget(WrApp *app)
{
    app->patch->serial = 0;
}

const WrPart wr_part_patch = { .update = patch_update,
                               .after = patch_after,
                               .next_time = wr_patch_next_time,
                               .view_event = wr_patch_view_event,
                               .draw = patch_draw,
                               .settle = settle,
                               .another = another,
                               .forget = forget };
