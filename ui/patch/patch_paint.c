/* Painting on the patch: the pen moves over the object, and the table below is painted by the same strokes as on the
   canvas. The path between two events is divided into steps of a few pixels, each located exactly (patch_pick.h). If
   the next step is elsewhere in the table than the surface derivatives predict, the path has crossed a silhouette, a
   cube edge, a border, or a seam of a replication that does not close. The stroke ends there and a new one begins.
   On a mesh the points in space are the stroke's samples (`sculpt`), so it continues across seams of (u,v) and ends
   only at silhouettes. */
#include "ui/app/state/action_list.h"
#include "ui/patch/patch_paint.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/line.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/patch/patch.h"
#include "ui/patch/patch_objects.h"
#include "ui/input/stroke_smoothing.h"
#include "ui/patch/preview/patch_pick.h"
#include "ui/canvas/tools/brush_outline.h"
#include "ui/canvas/tools/stroke_input.h"
#include "ui/canvas/tools/tool_brush.h"
#include "ui/canvas/tools/tool_stamp.h"

#include "base/exactmath.h"
#include "base/text.h"
#include "brush/brush.h"
#include "document/document.h"
#include "field/field.h"
#include "scene/scene.h"
#include "surface/surface.h"
#include "surface/triangles.h"

#include <SDL.h>
#include <math.h>
#include <string.h>

#define STEP_PIXELS 4.0
#define STEPS_MAX 256
#define JUMP_FACTOR 6.0 /* largest step, as a multiple of the prediction */
#define JUMP_TEXELS 4.0 /* step that is always accepted */
#define RING_STEPS 3    /* brush outline on the object: one of its points between them */

/* Picking for the active object. */
static const WrPatchPick *picker(WrApp *app)
{
    const WrObjectPicks *picks = wr_patch_picks(app);
    return picks ? wr_object_picks_of(picks, wr_app_scene(app)->chosen) : NULL;
}

void wr_patch_paint_free(WrApp *app)
{
    wr_object_picks_forget(app);
}

/* Point of the active object under the pixel, if visible. */
static bool spot_under(WrApp *app, double x, double y, WrPatchSpot *spot)
{
    const WrObjectPicks *picks = wr_patch_picks(app);
    const SDL_Rect *room = &app->layout->patch;
    const int chosen = wr_app_scene(app)->chosen;
    return picks && x >= room->x && x < room->x + room->w && y >= room->y &&
           y < room->y + room->h &&
           wr_object_picks_at(picks, chosen, x - room->x, y - room->y, spot) == chosen;
}

bool wr_patch_paint_uv(WrApp *app, const WrPointer *at, double *u, double *v)
{
    WrPatchSpot spot;
    const WrScene *scene = wr_app_scene(app);
    if (!spot_under(app, at->x, at->y, &spot)) return false;
    *u = scene->replicate_u * spot.u;
    *v = scene->replicate_v * spot.v;
    return true;
}

/* ---- steps ---- */

static void lift(WrApp *app)
{
    WrPatchPaint *p = app->paint;
    const WrPatchPick *pick = p->inside ? picker(app) : NULL;
    if (pick && wr_patch_pick_is_mesh(pick)) {
        p->end = p->last.p;
        p->end_key = wr_app_scene(app)->triangles->key;
    }
    p->inside = false;
    wr_strokes_end(app);
}

/* Digits after the point of lengths on the active mesh: a 10 000th of its radius or less. */
static int mesh_digits(const WrApp *app)
{
    return (int)fmin(9.0, fmax(0.0, ceil(4.0 - log10(wr_app_scene(app)->triangles->radius))));
}

/* Faces that turn away are not painted, unless that was chosen; where the back of an open sheet is seen, all are. */
static const WrVec3 *eye_for(WrApp *app, const WrPatchSpot *spot, WrVec3 *eye)
{
    *eye = wr_line_round_vec(wr_patch_pick_eye(picker(app)), mesh_digits(app));
    return spot->back || app->paint->round ? NULL : eye;
}

static bool begin_on_mesh(WrApp *app, WrBrush brush, const WrPointer *at, const WrPatchSpot *spot)
{
    WrVec3 eye;
    brush.symmetry = wr_brush_default().symmetry; /* of the table */
    return wr_strokes_begin_on_mesh(app, &brush, at, eye_for(app, spot, &eye));
}

/* The view's right, seen from u about the outer normal of a mesh, radians anticlockwise. */
static double right_of_view(const WrApp *app, const WrPatchSpot *spot)
{
    WrPlacement at;
    if (!wr_patch_place(app, &at)) return 0;
    const WrVec3 right = wr_place_turn_back(&at, at.right);
    const double turn =
        atan2(v3_dot(v3_cross(spot->along, right), spot->n), v3_dot(spot->along, right));
    return spot->back ? -turn : turn;
}

/* On a mesh it stands upright in the view, whichever way the island lies in the table. */
static void stamp(WrApp *app, const WrPointer *at)
{
    WrVec3 eye;
    WrPatchSpot spot;
    const WrScene *scene = wr_app_scene(app);
    app->hand->grab = WR_GRAB_NONE;
    if (!spot_under(app, at->x, at->y, &spot)) return;
    if (wr_patch_pick_is_mesh(picker(app)))
        wr_stamp_on_mesh(app, wr_line_round_vec(spot.p, mesh_digits(app)),
                         eye_for(app, &spot, &eye), right_of_view(app, &spot) * WR_DEG_PER_RAD);
    else wr_stamp_at(app, scene->replicate_u * spot.u, scene->replicate_v * spot.v);
}

static void put_down(WrApp *app, const WrPointer *at, const WrPatchSpot *spot)
{
    const WrScene *scene = wr_app_scene(app);
    const bool mesh = wr_patch_pick_is_mesh(picker(app));
    if (!app->brush->drawing) {
        const WrBrush brush = wr_strokes_brush(app, at);
        if (!(mesh ? begin_on_mesh(app, brush, at, spot) : wr_strokes_begin(app, &brush, at)))
            return;
    }
    app->paint->inside = true;
    app->paint->last = *spot;
    if (mesh) wr_strokes_sample_on_mesh(app, at, spot->p);
    else wr_strokes_sample(app, at, scene->replicate_u * spot->u, scene->replicate_v * spot->v);
}

/* Distance in texels between two table positions, the shortest way round on periodic axes. */
static double texels(double from, double to, int size, WrWrap wrap)
{
    double d = to - from;
    if (wrap == WR_WRAP_PERIODIC) d -= rint(d);
    return d * size;
}

/* The step predicted by the more slanted of the two triangles, at least 1 in 10. */
static bool leads_on_mesh(WrApp *app, const WrPatchSpot *spot)
{
    const WrPatchSpot *last = &app->paint->last;
    const double pixels = hypot(spot->x - last->x, spot->y - last->y);
    const WrVec3 eye = wr_patch_pick_eye(picker(app));
    double least = 1.0;
    for (int i = 0; i < 2; i++) {
        const WrPatchSpot *at = i ? spot : last;
        least = fmin(least, v3_dot(at->n, v3_unit(v3_sub(eye, at->p), at->n)));
    }
    return spot->back == last->back &&
           v3_len(v3_sub(spot->p, last->p)) <=
               JUMP_FACTOR * pixels * fmax(spot->pixel, last->pixel) / fmax(0.1, least);
}

/* True if the surface is continuous from the last point to this one. */
static bool leads(WrApp *app, const WrPatchSpot *spot)
{
    const WrPatchSpot *last = &app->paint->last;
    if (wr_patch_pick_is_mesh(picker(app))) return leads_on_mesh(app, spot);
    const WrScene *scene = wr_app_scene(app);
    const WrField *field = wr_app_field(app);
    double ru = scene->replicate_u, rv = scene->replicate_v, most = 0.0;
    int w = wr_field_width(field), h = wr_field_height(field);
    double dx = spot->x - last->x, dy = spot->y - last->y;
    if (spot->face != last->face) return false;
    double du = texels(ru * last->u, ru * spot->u, w, wr_field_wrap_u(field));
    double dv = texels(rv * last->v, rv * spot->v, h, wr_field_wrap_v(field));
    const WrPatchSpot *ends[2] = { last, spot };
    for (int i = 0; i < 2; i++) { /* near a silhouette the derivatives of one end may be far
                                     larger */
        double j[4];
        if (!wr_patch_pick_slopes(picker(app), ends[i], j))
            return true; /* a pole: no decision possible */
        most =
            fmax(most, hypot(ru * w * (j[0] * dx + j[1] * dy), rv * h * (j[2] * dx + j[3] * dy)));
    }
    return hypot(du, dv) <= JUMP_FACTOR * most + JUMP_TEXELS;
}

static void step_to(WrApp *app, const WrPointer *at)
{
    WrPatchSpot spot;
    if (!spot_under(app, at->x, at->y, &spot)) {
        if (app->paint->inside) lift(app);
        return;
    }
    if (app->paint->inside && !leads(app, &spot)) lift(app);
    put_down(app, at, &spot);
}

/* Continue the smoothed stroke straight to `at`. */
static void draw_to(WrApp *app, const WrPointer *at)
{
    WrPatchPaint *p = app->paint;
    WrPointer from = p->at;
    double way = hypot(at->x - from.x, at->y - from.y);
    int steps = (int)fmin(STEPS_MAX, fmax(1.0, ceil(way / STEP_PIXELS)));
    for (int i = 1; i <= steps; i++) {
        WrPointer to = *at;
        double t = (double)i / steps;
        to.x = from.x + t * (at->x - from.x);
        to.y = from.y + t * (at->y - from.y);
        to.pressure = from.pressure + t * (at->pressure - from.pressure);
        to.seconds = from.seconds + t * (at->seconds - from.seconds);
        step_to(app, &to);
    }
    p->at = *at;
}

/* The pixel of the last stroke's end on the mesh, if that is seen. */
static bool line_start(WrApp *app, WrPointer *from)
{
    const WrPatchPaint *p = app->paint;
    const WrScene *scene = wr_app_scene(app);
    const WrPatchPick *pick = picker(app);
    WrPatchSpot spot;
    if (!pick || !wr_patch_pick_is_mesh(pick) || scene->triangles->key != p->end_key ||
        !wr_patch_pick_project_point(pick, p->end, &from->x, &from->y))
        return false;
    from->x += app->layout->patch.x;
    from->y += app->layout->patch.y;
    return spot_under(app, from->x, from->y, &spot) &&
           v3_len(v3_sub(spot.p, p->end)) < 4.0 * spot.pixel;
}

void wr_patch_paint_press(WrApp *app, const WrPointer *at)
{
    double u, v;
    if (wr_keys_hold(app->keys, WR_ACT(hold_pick), at->mods)) {
        WrPointer there = *at;
        if (wr_patch_paint_uv(app, at, &u, &v)) {
            there.u = u;
            there.v = v;
            wr_brush_pick(app, &there);
        }
        app->hand->grab = WR_GRAB_PICK;
        return;
    }
    if (wr_stamp_is_chosen(app)) {
        stamp(app, at);
        return;
    }
    WrPointer from = *at;
    const bool joins =
        wr_keys_hold(app->keys, WR_ACT(hold_size), at->mods) && line_start(app, &from);
    app->paint->inside = false;
    app->paint->at = from;
    wr_brush_steady_begin(app, at);
    step_to(app, &from);
    if (joins) draw_to(app, at); /* straight as seen, laid onto the surface */
}

void wr_patch_paint_drag(WrApp *app, const WrPointer *at)
{
    wr_brush_steady_move(app, at, draw_to);
}

void wr_patch_paint_release(WrApp *app, const WrPointer *at)
{
    wr_brush_steady_end(app, at, draw_to);
    lift(app);
}

/* ---- projection of a layer ---- */

/* The slide stands at the depth of the object's middle, as large as the patch allows. */
void wr_patch_project_layer(WrApp *app)
{
    WrPlacement at;
    const WrField *field = wr_app_field(app);
    const SDL_Rect *room = &app->layout->patch;
    const WrPatchPick *pick = picker(app);
    if (!pick || !wr_patch_pick_is_mesh(pick) || !wr_patch_place(app, &at)) return;
    const double depth = v3_dot(v3_sub(at.position, at.eye), at.forward);
    const double half = at.orthographic ? at.half_height : at.half_height * depth;
    const double table = (double)wr_field_width(field) / wr_field_height(field);
    const double width = 2.0 * half * fmin(table, (double)room->w / room->h) / at.size;
    const WrVec3 middle = wr_world_to_object(&at, v3_mad(at.eye, at.forward, depth));
    const int digits = mesh_digits(app);
    WrText line = { 0 };
    wr_text_addf(&line, "project %d", wr_app_document(app)->active + 1);
    wr_line_vec(&line, "eye", wr_line_round_vec(wr_patch_pick_eye(pick), digits));
    wr_line_vec(&line, "at", wr_line_round_vec(middle, digits));
    wr_line_vec(&line, "up", wr_line_round_vec(wr_place_turn_back(&at, at.up), 4));
    wr_line_number(&line, "width", wr_line_round(width, digits));
    if (at.orthographic) wr_text_add(&line, " parallel=on");
    wr_line_number(&line, "strength", fabs(wr_brush_now(app).strength));
    wr_text_add(&line, " into=new");
    wr_app_run_line(app, wr_text_get(&line));
    wr_text_fini(&line);
}

/* ---- brush outline on the object ---- */

/* Position near (u, v) on the object: wraps on a closed axis, ends at the edge of an open one. */
static bool on_object(const WrPatchPick *pick, const WrScene *scene, int face, double u, double v,
                      WrPatchSpot *out, bool *hidden)
{
    const WrSurfaceInfo *info = wr_surfaces[scene->shape.kind];
    if (info->closed_u) u -= floor(u);
    if (info->closed_v) v -= floor(v);
    const WrSurfaceCell c = wr_surface_cell(&scene->shape, face);
    if (!(u >= c.u0 && u <= c.u1 && v >= c.v0 && v <= c.v1)) return false;
    return wr_patch_pick_project(pick, face, u, v, out, hidden);
}

/* Points of the brush outline on the object, pixels of the window; seen: 0 none, 1 hidden, 2 visible. */
typedef struct Ring {
    double x[WR_BRUSH_MARK_POINTS * RING_STEPS + 1], y[WR_BRUSH_MARK_POINTS * RING_STEPS + 1];
    int seen[WR_BRUSH_MARK_POINTS * RING_STEPS + 1];
    int count;
} Ring;

static void make_ring(const WrApp *app, const WrPatchPick *pick, const WrBrushMark *mark,
                      const WrPatchSpot *middle, Ring *ring)
{
    const WrScene *scene = wr_app_scene(app);
    const WrField *field = wr_app_field(app);
    const SDL_Rect *room = &app->layout->patch;
    double points[WR_BRUSH_MARK_POINTS][2];
    int count = wr_brush_mark_points(mark, points);
    double su = 1.0 / (wr_field_width(field) * scene->replicate_u);
    double sv = -1.0 / (wr_field_height(field) * scene->replicate_v);
    ring->count = count * RING_STEPS + 1;
    for (int i = 0; i < ring->count; i++) {
        const double *p = points[i / RING_STEPS % count], *q = points[(i / RING_STEPS + 1) % count];
        double t = i % RING_STEPS / (double)RING_STEPS;
        double x = p[0] + t * (q[0] - p[0]), y = p[1] + t * (q[1] - p[1]);
        WrPatchSpot spot = { 0 };
        bool hidden = false, seen = on_object(pick, scene, middle->face, middle->u + su * x,
                                              middle->v + sv * y, &spot, &hidden);
        ring->x[i] = room->x + spot.x;
        ring->y[i] = room->y + spot.y;
        ring->seen[i] = seen ? hidden ? 1 : 2 : 0;
    }
}

static double texel_side(WrApp *app)
{
    WrPatchPaint *p = app->paint;
    const WrField *field = wr_app_field(app);
    WrMeshTexelsTable table;
    memset(&table, 0, sizeof table); /* compared by its bytes */
    table.width = wr_field_width(field), table.height = wr_field_height(field);
    const WrTriangles *mesh = wr_document_painted_mesh(wr_app_document(app), &table.ru, &table.rv);
    if (p->side_key != mesh->key || memcmp(&p->side_table, &table, sizeof table) != 0) {
        p->side = wr_mesh_texel_side_of(mesh, &table);
        p->side_key = mesh->key;
        p->side_table = table;
    }
    return p->side;
}

/* The outline lies in the plane of the triangle. */
static void make_mesh_ring(WrApp *app, const WrPatchPick *pick, const WrBrushMark *mark,
                           const WrPatchSpot *middle, Ring *ring)
{
    const SDL_Rect *room = &app->layout->patch;
    const double side = texel_side(app);
    const WrVec3 up = v3_cross(middle->n, middle->along);
    double points[WR_BRUSH_MARK_POINTS][2];
    ring->count = wr_brush_mark_points(mark, points) + 1;
    for (int i = 0; i < ring->count; i++) {
        const double *at = points[i % (ring->count - 1)];
        const WrVec3 p = v3_mad(v3_mad(middle->p, middle->along, side * at[0]), up, -side * at[1]);
        ring->seen[i] = wr_patch_pick_project_point(pick, p, &ring->x[i], &ring->y[i]) ? 2 : 0;
        ring->x[i] += room->x;
        ring->y[i] += room->y;
    }
}

static void draw_ring(const Ring *ring, bool erases)
{
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 1; i < ring->count; i++) {
            int a = ring->seen[i - 1], b = ring->seen[i], seen = a < b ? a : b;
            if (seen == 0 || (seen == 1 && pass == 0)) continue;
            if (pass == 1 && erases && i % 12 >= 6) continue; /* dashes */
            WrColour light = seen == 1 ? 0x38f4f4f4u : 0xfff4f4f4u;
            wr_gui_draw_line(ring->x[i - 1], ring->y[i - 1], ring->x[i], ring->y[i],
                             pass ? light : 0xb0000000u, pass ? 1.3 : 3.0);
        }
    }
}

/* Mark the canvas pointer's position on the object, in a limited number of copies made by the replication. */
static void draw_marks(const WrApp *app, const WrPatchPick *pick)
{
    const WrScene *scene = wr_app_scene(app);
    const SDL_Rect *room = &app->layout->patch;
    double s = wr_gui_scale();
    double across = fmin(4.0, fmax(1.0, ceil(scene->replicate_u)));
    double down = fmin(4.0, fmax(1.0, ceil(scene->replicate_v)));
    double tu = app->hand->at.u - floor(app->hand->at.u),
           tv = app->hand->at.v - floor(app->hand->at.v);
    int faces = wr_surfaces[scene->shape.kind]->faces;
    for (int k = 0; k < faces * (int)across * (int)down; k++) {
        int copy = k / faces;
        double u = (tu + copy % (int)across) / scene->replicate_u;
        double v = (tv + copy / (int)across) / scene->replicate_v;
        WrPatchSpot spot;
        bool hidden;
        if (!on_object(pick, scene, k % faces, u, v, &spot, &hidden) || hidden) continue;
        wr_gui_draw_disc(room->x + spot.x, room->y + spot.y, 3.4 * s, 0xb0000000u);
        wr_gui_draw_disc(room->x + spot.x, room->y + spot.y, 2.2 * s, WR_COLOUR_ACCENT);
    }
}

/* Where the mirrors repeat the dab, through the object too. */
static void draw_mirrored(const WrApp *app, const WrPatchPick *pick, WrVec3 p)
{
    const bool *mirror = app->settings->mesh_mirror;
    const WrVec3 middle = wr_mesh_mirrors_at(wr_app_scene(app)->triangles);
    const double centre[3] = { middle.x, middle.y, middle.z };
    const SDL_Rect *room = &app->layout->patch;
    const double s = wr_gui_scale();
    for (int axes = 1; axes < 8 && app->settings->symmetric; axes++) {
        double x, y, at[3] = { p.x, p.y, p.z };
        bool all = true;
        for (int k = 0; k < 3; k++) {
            if (!(axes >> k & 1)) continue;
            all = all && mirror[k];
            at[k] = 2 * centre[k] - at[k];
        }
        if (!all || !wr_patch_pick_project_point(pick, (WrVec3){ at[0], at[1], at[2] }, &x, &y))
            continue;
        wr_gui_draw_disc(room->x + x, room->y + y, 3.4 * s, 0xb0000000u);
        wr_gui_draw_disc(room->x + x, room->y + y, 2.2 * s, 0xfff4f4f4u);
    }
}

static void overlay_clipped(WrApp *app)
{
    const WrInputRouter *hand = app->hand;
    bool painting = hand->grab == WR_GRAB_PATCH_PAINT;
    bool over = painting || (hand->on_patch && hand->grab == WR_GRAB_NONE && wr_patch_paints(app) &&
                             !wr_patch_control_under(app, &hand->at));
    bool resting = !app->settings->turning || wr_patch_paints(app);
    bool marks = hand->on_canvas && resting;
    WrPatchSpot spot;
    if (!over && !marks) return;
    if (wr_patch_prepares_mesh(app) && !painting) return; /* picking would build the tree again */
    const WrPatchPick *pick = picker(app);
    if (!pick) return;
    if (!over) {
        draw_marks(app, pick);
        return;
    }
    double x = hand->at.x, y = hand->at.y;
    if (painting && app->brush->steady.kind != WR_SMOOTHING_OFF) {
        x = app->brush->steady.follower.x;
        y = app->brush->steady.follower.y;
        wr_brush_show_string(app);
    }
    WrBrushMark mark = wr_stamp_is_chosen(app) ? wr_stamp_mark(app) : wr_brush_mark(app);
    Ring ring;
    if (!spot_under(app, x, y, &spot)) return;
    if (wr_patch_pick_is_mesh(pick)) {
        if (wr_stamp_is_chosen(app)) mark.turn += right_of_view(app, &spot);
        make_mesh_ring(app, pick, &mark, &spot, &ring);
        draw_mirrored(app, pick, spot.p);
    } else make_ring(app, pick, &mark, &spot, &ring);
    draw_ring(&ring, mark.erases);
}

void wr_patch_paint_overlay(WrApp *app)
{
    if (app->layout->patch.w <= 0) return;
    wr_gui_draw_clip(app->layout->patch);
    overlay_clipped(app);
    wr_gui_draw_unclip();
}
