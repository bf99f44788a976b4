/* Transform tool: a drag inside the frame moves the selection, its handles scale it, a drag outside rotates it. Enter
   applies, Escape cancels. Shift constrains to an axis, to the aspect ratio, to 15 degrees; Ctrl reverses snapping; Alt leaves
   a copy. */
#include "ui/canvas/tools/tool_transform.h"
#include "ui/canvas/view.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/chosen_layers.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/line.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/canvas/tools/option_row.h"
#include "ui/canvas/tools/tool.h"
#include "ui/canvas/tools/tool_rows.h"
#include "ui/canvas/overlays/snap_grid.h"
#include "ui/canvas/overlays/marks.h"

#include "base/exactmath.h"
#include "base/text.h"
#include "command/command_line.h"
#include "command/session.h"
#include "document/document.h"
#include "field/field.h"
#include "image/image.h"

#include <SDL.h>
#include <math.h>
#include <string.h>

#define NEAR_UNITS 9.0      /* hit radius of a handle */
#define SNAP_UNITS 6.0      /* snap distance */
#define SNAPPED 0xd0f050c8u /* magenta: no height of the canvas has it */
#define SNAP_DEGREES 2.0    /* snap angle to quarter turns */

/* A drag changes `now` only; the line of the command is written from it and tried on a snapshot by a worker thread
   (wr_app_try). Applying runs the same line, so the preview and the step have the same bits. */
static const WrTransformValues still = { .scale = { 1.0, 1.0 } };

/* ---- transformed piece ---- */

/* The layers that will move; the members of a chosen group move with it. */
static void find_layers(const WrApp *app, const bool chosen[WR_LAYERS_MAX], bool out[WR_LAYERS_MAX])
{
    const WrDocument *document = wr_app_document(app);
    const bool all = app->transform->all;
    for (int i = 0; i < WR_LAYERS_MAX; i++)
        out[i] = i < document->layer_count && (all || chosen[i]);
    for (int i = 0; i < document->layer_count; i++)
        for (int k = wr_layers_first(document->layers, i); out[i] && k < i; k++) out[k] = true;
}

static void measure(WrApp *app)
{
    WrTransformState *hand = app->transform;
    const WrDocument *document = wr_app_document(app);
    const WrField *like = document->layers[0].heights;
    const WrChosenLayers *chosen = wr_app_chosen(app);
    const uint64_t revision = wr_session_revision(app->session);
    const bool others = memcmp(hand->layers, chosen->chosen, sizeof hand->layers) != 0;
    if (hand->measured && hand->revision == revision && !others) return;
    if (hand->measured && others) wr_app_try_end(app); /* of the layers chosen before */
    *hand = (WrTransformState){ .measured = true,
                                .revision = revision,
                                .any = true,
                                .box = { 0, 0, wr_field_width(like), wr_field_height(like) },
                                .now = still,
                                .leave = hand->leave,
                                .back = hand->back,
                                .all = hand->all };
    memcpy(hand->layers, chosen->chosen, sizeof hand->layers);
    hand->layer_count = wr_chosen_count(chosen);
    bool moved[WR_LAYERS_MAX];
    find_layers(app, hand->layers, moved);
    if (document->selection) hand->any = wr_select_box(document->selection, &hand->box);
    else hand->box = wr_content_box(document, moved);
}

static bool leaves(const WrTransformState *hand)
{
    return hand->leave || hand->leave_once;
}

static bool is_still(const WrTransformState *hand)
{
    const WrTransformValues *v = &hand->now;
    return v->move[0] == 0.0 && v->move[1] == 0.0 && v->turn == 0.0 && v->scale[0] == 1.0 &&
           v->scale[1] == 1.0;
}

/* A position in the piece, 0..1 along its axes from the left and the top, in texels.
     x' = cx + mx + cos t sx x + sin t sy y,   y' = cy - my - sin t sx x + cos t sy y
   with rows down and the angle t anticlockwise as seen. */
static void place_of(const WrTransformState *hand, const WrTransformValues *v, double along,
                     double down, double out[2])
{
    double x = (along - 0.5) * hand->box.count_i * v->scale[0];
    double y = (down - 0.5) * hand->box.count_j * v->scale[1];
    double c = cos(v->turn * WR_RAD_PER_DEG), s = sin(v->turn * WR_RAD_PER_DEG);
    out[0] = hand->box.i + 0.5 * hand->box.count_i + v->move[0] + c * x + s * y;
    out[1] = hand->box.j + 0.5 * hand->box.count_j - v->move[1] - s * x + c * y;
}

/* The upright rectangle around the transformed piece: left and top, right and bottom, in texels. */
static void bounds_of(const WrTransformState *hand, const WrTransformValues *v, double low[2],
                      double high[2])
{
    for (int k = 0; k < 2; k++) low[k] = INFINITY, high[k] = -INFINITY;
    for (int corner = 0; corner < 4; corner++) {
        double p[2];
        place_of(hand, v, corner & 1, corner >> 1, p);
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], p[k]);
            high[k] = fmax(high[k], p[k]);
        }
    }
}

/* ---- lines ---- */

static void add_pair(WrText *line, const char *name, double a, double b)
{
    wr_line_number(line, name, a);
    wr_text_add(line, ",");
    wr_text_add_number(line, b);
}

/* The command rotates and scales about the centre of the selection, or of the table without one. If the frame's
   centre is another point, the line must name it. */
static void add_middle(const WrApp *app, WrText *line)
{
    const WrTransformState *hand = app->transform;
    const double w = app->view->table_w, h = app->view->table_h;
    const double x = hand->box.i + 0.5 * hand->box.count_i,
                 y = hand->box.j + 0.5 * hand->box.count_j;
    if (wr_app_document(app)->selection || (x == 0.5 * w && y == 0.5 * h)) return;
    if (hand->now.turn == 0.0 && hand->now.scale[0] == 1.0 && hand->now.scale[1] == 1.0) return;
    add_pair(line, "about", x / w, 1.0 - y / h);
}

static void write_line(const WrApp *app, WrText *line)
{
    const WrTransformState *hand = app->transform;
    const WrTransformValues *v = &hand->now;
    wr_text_add(line, "transform");
    if (v->move[0] != 0.0 || v->move[1] != 0.0) add_pair(line, "move", v->move[0], v->move[1]);
    if (v->turn != 0.0) wr_line_number(line, "turn", v->turn);
    if (v->scale[0] != 1.0 || v->scale[1] != 1.0) add_pair(line, "scale", v->scale[0], v->scale[1]);
    add_middle(app, line);
    if (leaves(hand)) wr_text_add(line, " leave=on");
    if (hand->all) wr_text_add(line, " layers=all");
    if (hand->all || hand->layer_count < 2) return;
    wr_text_add(line, " of=");
    wr_layers_print(hand->layers, line);
}

/* Values are rounded to the digits of the line before they are used: otherwise the applied step would differ from the
   preview. */
static double near_one(double x)
{
    double size = fmin(fmax(fabs(x), 1.0 / 64.0), 64.0);
    return wr_line_round(x < 0.0 ? -size : size, 5);
}

static void changed(WrApp *app)
{
    WrTransformState *hand = app->transform;
    WrText line = { 0 };
    for (int k = 0; k < 2; k++) {
        hand->now.scale[k] = near_one(hand->now.scale[k]);
        hand->now.move[k] = wr_line_round(hand->now.move[k], 2);
    }
    hand->now.turn = wr_line_round(hand->now.turn, 2);
    wr_app_redraw(app);
    if (is_still(hand)) {
        wr_app_try_end(app);
        return;
    }
    write_line(app, &line);
    WrEditPreviewRequest ask = { .line = wr_text_get(&line) };
    wr_app_try(app, &ask);
    wr_text_fini(&line);
}

static void cancel(WrApp *app)
{
    WrTransformState *hand = app->transform;
    hand->now = still;
    hand->part = WR_TRANSFORM_NONE;
    hand->leave_once = false;
    wr_app_try_end(app);
    wr_app_redraw(app);
}

static void apply(WrApp *app)
{
    WrTransformState *hand = app->transform;
    WrText line = { 0 };
    if (is_still(hand)) return;
    write_line(app, &line);
    wr_app_try_end(app);
    hand->now = still;
    hand->leave_once = false;
    wr_app_run_slow(app, wr_text_get(&line));
    wr_text_fini(&line);
}

/* Return to the tool that was left for a paste. True if there was one. */
static bool go_back(WrApp *app)
{
    const int back = app->transform->back;
    app->transform->back = 0;
    if (back > 0) wr_tool_choose(app, back - 1);
    return back > 0;
}

static void choose_pasted(WrApp *app)
{
    const int before = app->tool, tool = wr_tool_find(app, WR_ACT(transform));
    if (tool == before) return;
    wr_tool_choose(app, tool);
    app->transform->back = before + 1;
}

void wr_transform_add_place(const WrApp *app, const double at[2], WrText *line)
{
    double middle[2];
    wr_view_middle(app->view, middle);
    for (int k = 0; k < 2; k++) middle[k] = wr_line_round(middle[k], 6);
    add_pair(line, "at", at ? at[0] : middle[0], at ? at[1] : middle[1]);
}

bool wr_transform_paste(WrApp *app, const char *path, const double at[2], WrError *err)
{
    WrImageRows *rows = wr_image_rows_open(path, &(WrImageRequest){ .channel = NULL }, err);
    if (!rows) return false;
    const double w = wr_image_rows_head(rows)->width, h = wr_image_rows_head(rows)->height;
    const double by = fmin(app->view->table_w / w, app->view->table_h / h);
    wr_image_rows_close(rows);
    WrText line = { 0 };
    wr_text_add(&line, "layer paste ");
    wr_text_add_word(&line, path);
    wr_transform_add_place(app, at, &line);
    if (by < 1.0) wr_line_number(&line, "size", floor(w * by));
    if (wr_app_run_line(app, wr_text_get(&line))) {
        choose_pasted(app);
        wr_app_say(app, "Pasted as a new layer: drag it to its place, Enter keeps it");
    }
    wr_text_fini(&line);
    return true;
}

/* On a change of the tool the result is kept as a step; on a change of the document it is dropped. */
static void leave(WrApp *app)
{
    const WrTransformState *hand = app->transform;
    app->transform->back = 0;
    const bool ours = hand->measured && hand->revision == wr_session_revision(app->session);
    if (app->trying && ours && !is_still(hand)) apply(app); /* no preview of the old document */
    else cancel(app);
}

/* ---- dragging ---- */

/* The pointer relative to the centre of the nearest copy of the piece, in texels. */
static void from_middle(const WrApp *app, const WrTransformValues *v, const WrPointer *at,
                        double out[2])
{
    double middle[2];
    const WrField *like = wr_app_field(app);
    place_of(app->transform, v, 0.5, 0.5, middle);
    wr_view_to_texel(app->view, at->x, at->y, &out[0], &out[1]);
    out[0] -= middle[0];
    out[1] -= middle[1];
    double w = app->view->table_w, h = app->view->table_h;
    if (wr_field_wrap_u(like) == WR_WRAP_PERIODIC) out[0] -= w * rint(out[0] / w);
    if (wr_field_wrap_v(like) == WR_WRAP_PERIODIC) out[1] -= h * rint(out[1] / h);
}

static double texels(const WrApp *app, double units)
{
    return units * wr_gui_scale() / app->view->zoom;
}

/* The handle near the pointer. */
static bool find_handle(const WrApp *app, const double at[2], int side[2])
{
    const WrTransformState *hand = app->transform;
    double middle[2], near = texels(app, NEAR_UNITS);
    place_of(hand, &hand->now, 0.5, 0.5, middle);
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++) {
            double p[2];
            place_of(hand, &hand->now, 0.5 + 0.5 * x, 0.5 + 0.5 * y, p);
            if ((x == 0 && y == 0) ||
                hypot(p[0] - middle[0] - at[0], p[1] - middle[1] - at[1]) > near)
                continue;
            side[0] = x;
            side[1] = y;
            return true;
        }
    return false;
}

/* Components along the piece's own axes. The inverse rotation: the handles' test and scaling happen in the piece's unrotated
   frame. */
static void to_own(const WrTransformValues *v, const double at[2], double out[2])
{
    double c = cos(v->turn * WR_RAD_PER_DEG), s = sin(v->turn * WR_RAD_PER_DEG);
    out[0] = c * at[0] - s * at[1];
    out[1] = s * at[0] + c * at[1];
}

static bool is_inside(const WrTransformState *hand, const double at[2])
{
    double own[2];
    to_own(&hand->now, at, own);
    return fabs(own[0]) <= 0.5 * hand->box.count_i * fabs(hand->now.scale[0]) &&
           fabs(own[1]) <= 0.5 * hand->box.count_j * fabs(hand->now.scale[1]);
}

static void press(WrApp *app, const WrPointer *at)
{
    WrTransformState *hand = app->transform;
    app->hints = false;
    measure(app);
    if (!hand->any) return;
    bool moved[WR_LAYERS_MAX];
    find_layers(app, hand->layers, moved);
    wr_snap_measure(app, moved, &hand->others);
    from_middle(app, &hand->now, at, hand->from);
    hand->first = hand->now;
    hand->leave_first = hand->leave_once;
    hand->part = find_handle(app, hand->from, hand->side) ? WR_TRANSFORM_SCALE
                 : is_inside(hand, hand->from)            ? WR_TRANSFORM_MOVE
                                                          : WR_TRANSFORM_TURN;
    wr_app_redraw(app);
}

static bool snaps(const WrApp *app, const WrPointer *at)
{
    return app->settings->snap != ((at->mods & WR_MOD_CTRL) != 0);
}

/* The way from a position to a line in reach that is nearer than *least, which it replaces; else 0. */
static double way_to_line(WrApp *app, int axis, double at, double *least)
{
    WrTransformState *hand = app->transform;
    const double line = wr_snap_line(app, &hand->others, axis, at);
    if (!(fabs(line - at) < *least)) return 0.0;
    *least = fabs(line - at);
    hand->snapped[axis] = true;
    hand->lines[axis] = line;
    return line - at;
}

/* Snap the left and top edges, the centre, or the right and bottom edges of the piece. */
static void snap_move(WrApp *app, double m[2])
{
    WrTransformState *hand = app->transform;
    WrTransformValues v = hand->first;
    double low[2], high[2];
    v.move[0] = m[0];
    v.move[1] = -m[1];
    bounds_of(hand, &v, low, high);
    for (int axis = 0; axis < 2; axis++) {
        double least = texels(app, SNAP_UNITS), best = 0.0;
        for (int k = 0; k < 3; k++) {
            const double at = low[axis] + 0.5 * k * (high[axis] - low[axis]);
            const double way = way_to_line(app, axis, at, &least);
            if (way != 0.0) best = way;
        }
        m[axis] += best;
    }
}

static void move(WrApp *app, const WrPointer *at, const double way[2])
{
    WrTransformState *hand = app->transform;
    double m[2] = { way[0], way[1] }; /* right, down */
    const int fixed = fabs(m[0]) < fabs(m[1]) ? 0 : 1;
    const bool straight = (at->mods & WR_MOD_SHIFT) != 0;
    m[0] += hand->first.move[0];
    m[1] -= hand->first.move[1];
    if (snaps(app, at)) snap_move(app, m);
    if (straight) {
        m[fixed] = fixed ? -hand->first.move[1] : hand->first.move[0];
        hand->snapped[fixed] = false;
    }
    /* whole texels keep every height */
    hand->now.move[0] = rint(m[0]);
    hand->now.move[1] = -rint(m[1]);
    hand->leave_once = hand->leave_first || (at->mods & WR_MOD_ALT);
}

static void turn(WrApp *app, const WrPointer *at, const double here[2])
{
    WrTransformState *hand = app->transform;
    /* y is negated, since rows run down and angles are anticlockwise. */
    double by = atan2(-here[1], here[0]) - atan2(-hand->from[1], hand->from[0]);
    double deg = hand->first.turn + by * WR_DEG_PER_RAD, quarter = rint(deg / 90.0) * 90.0;
    if (at->mods & WR_MOD_SHIFT) deg = rint(deg / 15.0) * 15.0;
    else if (snaps(app, at) && fabs(deg - quarter) < SNAP_DEGREES) deg = quarter;
    else deg = wr_line_round(deg, 1);
    hand->now.turn = wr_signed_degrees(deg);
}

/* The length of the piece along an axis with its dragged edge on a line, if one is near. Only upright pieces have their edges
   along the lines. */
static double snap_edge(WrApp *app, int axis, double wide)
{
    WrTransformState *hand = app->transform;
    const WrTransformValues *v = &hand->first;
    double fixed[2], least = texels(app, SNAP_UNITS);
    if (v->turn != 0.0) return wide;
    place_of(hand, v, 0.5 - 0.5 * hand->side[0], 0.5 - 0.5 * hand->side[1], fixed);
    const double edge = fixed[axis] + hand->side[axis] * wide;
    return wide + hand->side[axis] * way_to_line(app, axis, edge, &least);
}

/* The handle follows the pointer, and the opposite one is fixed. */
static void scale(WrApp *app, const WrPointer *at, const double here[2])
{
    WrTransformState *hand = app->transform;
    const double count[2] = { hand->box.count_i, hand->box.count_j };
    const bool even = (at->mods & WR_MOD_SHIFT) && hand->side[0] && hand->side[1];
    double own[2], stays[2], stays_now[2];
    WrTransformValues v = hand->first;
    to_own(&v, here, own);
    for (int k = 0; k < 2; k++) {
        if (hand->side[k] == 0) continue;
        double wide = hand->side[k] * own[k] + 0.5 * count[k] * hand->first.scale[k];
        if (snaps(app, at) && !even) wide = snap_edge(app, k, wide);
        v.scale[k] = near_one(rint(wide) / count[k]);
    }
    if (even) {
        double by = fmax(v.scale[0] / hand->first.scale[0], v.scale[1] / hand->first.scale[1]);
        for (int k = 0; k < 2; k++) v.scale[k] = near_one(hand->first.scale[k] * by);
    }
    double along = 0.5 - 0.5 * hand->side[0], down = 0.5 - 0.5 * hand->side[1];
    place_of(hand, &hand->first, along, down, stays);
    place_of(hand, &v, along, down, stays_now);
    v.move[0] += stays[0] - stays_now[0];
    v.move[1] -= stays[1] - stays_now[1];
    hand->now = v;
}

static void drag(WrApp *app, const WrPointer *at)
{
    WrTransformState *hand = app->transform;
    double here[2], x, y, x0, y0;
    if (hand->part == WR_TRANSFORM_NONE) return;
    wr_view_to_texel(app->view, at->x, at->y, &x, &y);
    wr_view_to_texel(app->view, app->hand->start.x, app->hand->start.y, &x0, &y0);
    double way[2] = { x - x0, y - y0 };
    for (int k = 0; k < 2; k++) {
        here[k] = hand->from[k] + way[k];
        hand->snapped[k] = false;
    }
    if (hand->part == WR_TRANSFORM_MOVE) move(app, at, way);
    if (hand->part == WR_TRANSFORM_TURN) turn(app, at, here);
    if (hand->part == WR_TRANSFORM_SCALE) scale(app, at, here);
    changed(app);
}

static void release(WrApp *app, const WrPointer *at)
{
    (void)at;
    app->transform->part = WR_TRANSFORM_NONE;
    app->transform->snapped[0] = app->transform->snapped[1] = false;
    wr_app_redraw(app);
}

static bool key(WrApp *app, SDL_Keycode key)
{
    WrTransformState *hand = app->transform;
    double step = 1.0;
    if (key == SDLK_RETURN || key == SDLK_KP_ENTER) {
        apply(app);
        go_back(app);
    } else if (key == SDLK_ESCAPE && is_still(hand)) return go_back(app);
    else if (key == SDLK_ESCAPE) cancel(app);
    else if (key == SDLK_LEFT || key == SDLK_RIGHT || key == SDLK_UP || key == SDLK_DOWN) {
        measure(app);
        int axis = key == SDLK_UP || key == SDLK_DOWN;
        hand->now.move[axis] += key == SDLK_LEFT || key == SDLK_DOWN ? -step : step;
        changed(app);
    } else return false;
    return true;
}

/* ---- drawing on the canvas ---- */

/* Lines across the view where the piece snapped. */
static void draw_snapped(const WrApp *app)
{
    const WrTransformState *hand = app->transform;
    double low[2], high[2];
    wr_view_bounds(app->view, low, high);
    for (int axis = 0; axis < 2; axis++)
        if (hand->snapped[axis])
            wr_grid_line(app->view, axis, hand->lines[axis], low, high, SNAPPED);
}

static void marks(WrApp *app)
{
    measure(app);
    const WrTransformState *hand = app->transform;
    draw_snapped(app);
    WrSelectPoint frame[4];
    static const double corner[4][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
    if (!hand->any) return;
    for (int k = 0; k < 4; k++) {
        double p[2];
        place_of(hand, &hand->now, corner[k][0], corner[k][1], p);
        frame[k] = wr_overlay_uv(app, p[0], p[1]);
    }
    wr_overlay_lines(app, frame, 4, true, WR_COLOUR_ACCENT);
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++) {
            double p[2];
            place_of(hand, &hand->now, 0.5 + 0.5 * x, 0.5 + 0.5 * y, p);
            WrSelectPoint at = wr_overlay_uv(app, p[0], p[1]);
            bool hot = hand->part == WR_TRANSFORM_SCALE && hand->side[0] == x && hand->side[1] == y;
            if (x || y) wr_overlay_handle(app, at.u, at.v, false, hot);
            else wr_overlay_cross(app, at.u, at.v, 0xfff4f4f4u);
        }
}

/* ---- option row ---- */

static bool number(WrApp *app, const char *id, double width, const WrNumber *spec, double *value)
{
    return wr_gui_number(id, width, spec, value) != WR_EDIT_NONE && app->transform->any;
}

/* Left and lower edge of the rectangle around the piece, in texels from those of the cell. */
static void corner_of(const WrApp *app, double out[2])
{
    double low[2], high[2];
    bounds_of(app->transform, &app->transform->now, low, high);
    out[0] = low[0];
    out[1] = app->view->table_h - high[1];
}

static void place_corner(WrApp *app, const double at[2])
{
    double now[2];
    corner_of(app, now);
    for (int k = 0; k < 2; k++) app->transform->now.move[k] += at[k] - now[k];
    changed(app);
}

static void position(WrApp *app, const char *id, double width, int axis, const char *tip)
{
    const double cell = axis ? app->view->table_h : app->view->table_w;
    const WrTransformState *hand = app->transform;
    const WrNumber spec = { .low = -cell,
                            .high = cell,
                            .hard_low = -65536,
                            .hard_high = 65536,
                            .reset = axis ? cell - hand->box.j - hand->box.count_j : hand->box.i,
                            .decimals = hand->now.turn != 0.0,
                            .unit = "px",
                            .tip = tip };
    double at[2];
    measure(app);
    corner_of(app, at);
    if (number(app, id, width, &spec, &at[axis])) place_corner(app, at);
}

static void position_x(WrApp *app, double width)
{
    position(app, "x", width, 0, "Left edge, from the left edge of the cell");
}

static void position_y(WrApp *app, double width)
{
    position(app, "y", width, 1, "Lower edge, from the lower edge of the cell");
}

/* Other sizes; the left and lower edges are fixed. */
static void set_scale(WrApp *app, double x, double y)
{
    double corner[2];
    corner_of(app, corner);
    app->transform->now.scale[0] = near_one(x);
    app->transform->now.scale[1] = near_one(y);
    place_corner(app, corner);
}

static void length(WrApp *app, const char *id, double width, int axis, const char *tip)
{
    measure(app);
    const WrTransformState *hand = app->transform;
    const double count = axis ? hand->box.count_j : hand->box.count_i;
    const WrNumber spec = { .low = 1,
                            .high = 2.0 * (axis ? app->view->table_h : app->view->table_w),
                            .hard_low = -65536,
                            .hard_high = 65536,
                            .reset = count,
                            .decimals = 0,
                            .unit = "px",
                            .tip = tip };
    double value = count * hand->now.scale[axis];
    if (!number(app, id, width, &spec, &value)) return;
    set_scale(app, axis ? hand->now.scale[0] : value / count,
              axis ? value / count : hand->now.scale[1]);
}

static void width_of(WrApp *app, double width)
{
    length(app, "w", width, 0, "Width; a negative one mirrors");
}

static void height_of(WrApp *app, double width)
{
    length(app, "h", width, 1, "Height; a negative one mirrors");
}

static void percent(WrApp *app, double width)
{
    const double *now = app->transform->now.scale;
    const double size = fabs(now[0]);
    const WrNumber spec = { .low = 10,
                            .high = 400,
                            .hard_low = 1.5625,
                            .hard_high = 6400,
                            .reset = 100,
                            .decimals = 1,
                            .unit = "%",
                            .tip = "Keep the proportions of width and height" };
    double value = size * 100.0;
    measure(app);
    if (number(app, "scale", width, &spec, &value))
        set_scale(app, now[0] * value / (100.0 * size), now[1] * value / (100.0 * size));
}

static void turned(WrApp *app, double width)
{
    WrNumber spec = { .low = -180,
                      .high = 180,
                      .hard_low = -36000,
                      .hard_high = 36000,
                      .decimals = 1,
                      .unit = "\xc2\xb0",
                      .tip = "Turned anticlockwise" };
    measure(app);
    if (number(app, "turn", width, &spec, &app->transform->now.turn)) changed(app);
}

static void switches(WrApp *app, double width)
{
    WrTransformState *hand = app->transform;
    (void)width;
    const bool all = hand->all, left = leaves(hand);
    bool leave = left;
    wr_gui_check("snap", &app->settings->snap);
    wr_gui_tip("Snaps edges and the centre to parts of the cell, to the grid and to other layers; "
               "Ctrl reverses it "
               "while you drag");
    wr_gui_same_line(10);
    if (wr_gui_check("copy", &leave)) {
        hand->leave = leave;
        hand->leave_once = false;
    }
    wr_gui_tip(
        "Leaves the selection or the layer in place and transforms a copy; or drag with Alt");
    wr_gui_same_line(10);
    wr_gui_check("all layers", &hand->all);
    if (all != hand->all) { /* another frame with the same values */
        const WrTransformValues now = hand->now;
        hand->measured = false;
        measure(app);
        hand->now = now;
    }
    if (left != leaves(hand) || all != hand->all) changed(app);
}

static void buttons(WrApp *app, double width)
{
    (void)width;
    wr_gui_disable(is_still(app->transform));
    wr_busy_hold(app);
    if (wr_gui_chip(WR_ICON_CHECK, "Apply")) apply(app);
    wr_busy_hold_end();
    wr_gui_tip("Enter");
    wr_gui_same_line(6);
    if (wr_gui_chip(WR_ICON_CLOSE, "Cancel")) cancel(app);
    wr_gui_tip("Escape: nothing was changed");
    wr_gui_disable_end();
}

static void options(WrApp *app)
{
    const WrOption items[] = { { "X", 84, 0, position_x, true },  { "Y", 84, 0, position_y, true },
                               { "W", 84, 0, width_of, true },    { "H", 84, 0, height_of, true },
                               { "Scale", 84, 0, percent, true }, { "Turn", 84, 0, turned, true },
                               { "##", 0, 246, switches, true },  { "##", 0, 180, buttons, true } };
    wr_option_row(app, items, (int)(sizeof items / sizeof *items));
}

/* ---- the row ---- */

const WrTool wr_tool_transform = {
    .action = WR_ACT(transform),
    .icon = WR_ICON_TRANSFORM,
    .help = "Drag the selection or the layer's content to move it, its handles to scale it, "
            "outside of it to rotate it; Enter applies, Escape cancels.",
    .press = press,
    .drag = drag,
    .release = release,
    .marks = marks,
    .options = options,
    .key = key,
    .leave = leave
};
