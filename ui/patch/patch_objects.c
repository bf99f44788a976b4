#include "ui/patch/patch_objects.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/line.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/patch/patch.h"
#include "ui/patch/patch_paint.h"
#include "ui/patch/patch_projection.h"
#include "ui/patch/preview/rotation.h"

#include "base/text.h"
#include "command/command_line.h"
#include "command/session.h"
#include "document/document.h"
#include "scene/objects.h"
#include "surface/triangles.h"
#include "ui/canvas/tools/stroke_input.h"

#include <math.h>
#include <string.h>

#define REACH 9.0 /* units: hit radius of a handle */

/* ---- picking ---- */

const WrObjectPicks *wr_patch_picks(WrApp *app)
{
    WrPatchPaint *p = app->paint;
    const SDL_Rect *room = &app->layout->patch;
    const WrScene *scene = wr_app_scene(app);
    const double turn = app->patch->turn_deg;
    const bool same = p->picks && p->scene == scene && p->turn_deg == turn &&
                      p->room.w == room->w && p->room.h == room->h;
    if (room->w <= 0) return NULL;
    if (!same) {
        WrObjectPicks *made = wr_object_picks_new(scene, turn, room->w, room->h, p->picks, NULL);
        wr_object_picks_forget(app);
        p->picks = made;
        p->scene = wr_scene_share(scene);
        p->turn_deg = turn;
        p->room = *room;
    }
    const WrRayTree *tree =
        scene->triangles ? wr_session_mesh_tree(app->session, scene->triangles) : NULL;
    if (p->picks && tree) wr_object_picks_share_tree(p->picks, tree, scene->triangles->key);
    return p->picks;
}

/* ---- strokes on a mesh, prepared ---- */

static bool prepare(WrSession *session, void *ctx, WrError *err)
{
    (void)ctx;
    return wr_session_prepare_mesh(session, err);
}

void wr_patch_prepare_mesh(WrApp *app)
{
    WrPatchPaint *p = app->paint;
    if (app->busy) return;
    p->preparing = false;
    const uint64_t revision = wr_session_revision(app->session);
    if (!p->on || wr_strokes_under_way(app) || p->tried == revision ||
        !wr_session_mesh_needs_preparing(app->session))
        return;
    p->tried = revision; /* once for each revision; the stroke reports a failure */
    p->preparing = true;
    wr_background_upkeep_start(app, "Preparing the mesh", prepare, NULL);
}

bool wr_patch_prepares_mesh(const WrApp *app)
{
    return app->busy && app->paint->preparing;
}

void wr_object_picks_forget(WrApp *app)
{
    WrPatchPaint *p = app->paint;
    wr_object_picks_free(p->picks);
    if (p->scene) wr_scene_free(p->scene);
    p->picks = NULL;
    p->scene = NULL;
}

/* Painting edits the table of the object. */
static void use_layer(WrApp *app)
{
    const WrDocument *document = wr_app_document(app);
    const int layer = wr_layer_named(document, document->scene->layer);
    if (layer >= 0 && layer != document->active) wr_app_run_linef(app, "layer use %d", layer + 1);
}

bool wr_patch_choose(WrApp *app, const WrPointer *at)
{
    const SDL_Rect *room = &app->layout->patch;
    const WrObjectPicks *picks = wr_patch_picks(app);
    const WrScene *scene = wr_app_scene(app);
    char buffer[WR_OBJECT_LABEL];
    WrPatchSpot spot;
    const int object =
        picks ? wr_object_picks_at(picks, scene->chosen, at->x - room->x, at->y - room->y, &spot)
              : -1;
    if (object < 0) return false;
    if (object != scene->chosen) {
        WrText line = { 0 };
        wr_text_add(&line, "object choose ");
        wr_text_add_word(&line, wr_scene_object_label(scene, object, buffer));
        wr_app_run_line(app, wr_text_get(&line));
        wr_text_fini(&line);
    }
    use_layer(app);
    return true;
}

/* ---- handles ---- */

static bool find_ball(const WrApp *app, WrPatchBall *ball)
{
    const SDL_Rect *r = &app->layout->patch;
    const WrScene *scene = wr_app_scene(app);
    const bool projects = wr_patch_projects(app);
    if ((!projects && scene->other_count == 0) || r->w <= 0 || app->settings->turning) return false;
    if (!wr_scene_place(scene, app->patch->turn_deg, (double)r->w / r->h, &ball->at, NULL))
        return false;
    const WrPlacement *at = &ball->at;
    const WrVec3 middle =
        projects ? wr_object_to_world(at, wr_projection_origin(scene)) : at->position;
    const WrVec3 from = v3_sub(middle, at->eye);
    const double depth = v3_dot(from, at->forward);
    if (!(depth > 0)) return false;
    const double half = at->orthographic ? at->half_height : at->half_height * depth;
    ball->pixel = 2 * half / r->h;
    ball->x = r->x + r->w / 2.0 + v3_dot(from, at->right) / ball->pixel;
    ball->y = r->y + r->h / 2.0 - v3_dot(from, at->up) / ball->pixel;
    /* The ring of a projection is inside that of its object. */
    ball->radius = fmax((projects ? 0.6 : 1) * at->radius * at->size / ball->pixel,
                        3 * REACH * wr_gui_scale());
    return true;
}

/* The square is at the lower right. */
static void size_spot(const WrPatchBall *ball, double *x, double *y)
{
    *x = ball->x + ball->radius * sqrt(0.5);
    *y = ball->y + ball->radius * sqrt(0.5);
}

WrHandle wr_patch_handle_under(const WrApp *app, const WrPointer *at)
{
    WrPatchBall ball;
    double x, y;
    const double reach = REACH * wr_gui_scale();
    if (!find_ball(app, &ball)) return WR_HANDLE_NONE;
    size_spot(&ball, &x, &y);
    if (hypot(at->x - x, at->y - y) <= reach) return WR_HANDLE_SIZE;
    if (hypot(at->x - ball.x, at->y - ball.y) <= reach) return WR_HANDLE_MOVE;
    const double away = fabs(hypot(at->x - ball.x, at->y - ball.y) - ball.radius);
    return away <= 0.6 * reach ? WR_HANDLE_TURN : WR_HANDLE_NONE;
}

static WrVec3 turn_of(const WrScene *scene)
{
    const double *own = wr_surfaces[scene->shape.kind]->pose_deg;
    return scene->posed ? scene->rotate_deg : (WrVec3){ own[0], own[1], own[2] };
}

void wr_patch_handle_press(WrApp *app, const WrPointer *at)
{
    const WrScene *scene = wr_app_scene(app);
    app->patch->handle = wr_patch_handle_under(app, at);
    app->patch->from = wr_rotation_from_deg(turn_of(scene));
    app->patch->from_at = scene->at;
    app->patch->from_size = scene->size;
    app->patch->from_sizes = scene->sizes;
    if (!wr_patch_projects(app)) return;
    app->patch->from_projection = scene->projection;
    app->patch->from_at = wr_projection_origin(scene);
}

/* Rotate from world space to the space before the turntable rotation. */
static WrVec3 turned_back(WrVec3 v, double turn_deg)
{
    const WrRotation back = wr_rotation_axis((WrVec3){ 0, 1, 0 }, -turn_deg);
    return wr_rotation_apply(&back, v);
}

void wr_patch_handle_drag(WrApp *app, const WrPointer *at)
{
    const WrPatch *p = app->patch;
    const SDL_Rect *r = &app->layout->patch;
    const double dx = at->x - app->hand->start.x, dy = at->y - app->hand->start.y;
    WrPatchBall ball;
    if (!find_ball(app, &ball)) return;
    if (wr_patch_projects(app)) {
        wr_patch_projection_drag(app, &ball, at);
        return;
    }
    WrScene *scene = wr_app_live_begin(app);
    if (p->handle == WR_HANDLE_MOVE) {
        WrVec3 by = v3_mad(v3_scale(ball.at.right, dx * ball.pixel), ball.at.up, -dy * ball.pixel);
        by = turned_back(by, p->turn_deg);
        scene->at = wr_line_round_vec(v3_add(p->from_at, by), 4);
    } else if (p->handle == WR_HANDLE_SIZE) {
        /* The size is proportional to the pointer's distance from the centre, so the handle stays under the
           pointer. */
        const double before = hypot(app->hand->start.x - ball.x, app->hand->start.y - ball.y);
        const double now = hypot(at->x - ball.x, at->y - ball.y);
        scene->size = fmax(1e-3, wr_line_round(p->from_size * now / fmax(before, 1), 4));
        scene->sizes = wr_line_round_vec(v3_scale(p->from_sizes, scene->size / p->from_size), 4);
    } else {
        const WrRotation now =
            wr_rotation_dragged(&p->from, p->turn_deg, ball.at.right, ball.at.up, dx, dy,
                                fmin(r->w < r->h ? r->w : r->h, 2 * ball.radius));
        scene->posed = true;
        scene->rotate_deg = wr_line_round_vec(wr_rotation_to_deg(&now), 2);
    }
}

static void object_line(const WrApp *app, WrText *line)
{
    const WrScene *live = app->live;
    wr_text_add(line, "object set");
    if (app->patch->handle == WR_HANDLE_MOVE) wr_line_vec(line, "at", live->at);
    else if (app->patch->handle == WR_HANDLE_SIZE && v3_len(live->sizes) > 0)
        wr_line_vec(line, "size", live->sizes);
    else if (app->patch->handle == WR_HANDLE_SIZE) wr_line_number(line, "size", live->size);
    else wr_line_vec(line, "turn", live->rotate_deg);
}

void wr_patch_handle_release(WrApp *app)
{
    if (!app->live) return;
    WrText line = { 0 };
    if (wr_patch_projects(app)) wr_patch_projection_line(app, &line);
    else object_line(app, &line);
    wr_app_live_end(app);
    wr_app_run_line(app, wr_text_get(&line));
    wr_text_fini(&line);
}

void wr_patch_handles_draw(const WrApp *app)
{
    WrPatchBall ball;
    double x, y;
    const double s = wr_gui_scale();
    const WrInputRouter *hand = app->hand;
    if (!find_ball(app, &ball) || wr_patch_paints(app)) return;
    if (!hand->on_patch && hand->grab != WR_GRAB_HANDLE) return;
    const WrHandle over =
        hand->grab == WR_GRAB_HANDLE ? app->patch->handle : wr_patch_handle_under(app, &hand->at);
    size_spot(&ball, &x, &y);
    if (wr_patch_projects(app)) wr_patch_projection_draw(app, &ball);
    const WrColour ring = over == WR_HANDLE_TURN ? WR_COLOUR_ACCENT : 0xa0f0f0f0u;
    wr_gui_draw_circle(ball.x, ball.y, ball.radius, 0x60000000u, 3.0 * s);
    wr_gui_draw_circle(ball.x, ball.y, ball.radius, ring, 1.3 * s);
    wr_gui_draw_disc(ball.x, ball.y, 6.0 * s, 0xb0000000u);
    wr_gui_draw_disc(ball.x, ball.y, 4.5 * s,
                     over == WR_HANDLE_MOVE ? WR_COLOUR_ACCENT : 0xfff0f0f0u);
    wr_gui_draw_fill(x - 6 * s, y - 6 * s, 12 * s, 12 * s, 0xb0000000u, 2 * s);
    wr_gui_draw_fill(x - 4.5 * s, y - 4.5 * s, 9 * s, 9 * s,
                     over == WR_HANDLE_SIZE ? WR_COLOUR_ACCENT : 0xfff0f0f0u, 1.5 * s);
}
