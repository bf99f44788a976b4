/* Transform tool: a drag inside the frame moves the selection, its handles scale it, a drag outside rotates it. Enter
   applies, Escape cancels. Shift constrains to an axis, to the aspect ratio, to 15 degrees; Alt disables snapping. */
#include "ui/canvas/tools/tool_transform.h"
#include "ui/canvas/view.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/line.h"
#include "ui/app/state/session_view.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/canvas/tools/option_row.h"
#include "ui/canvas/tools/tool.h"
#include "ui/canvas/tools/tool_rows.h"
#include "ui/canvas/overlays/snap_grid.h"
#include "ui/canvas/overlays/marks.h"

#include "base/exactmath.h"
#include "base/text.h"
#include "command/session.h"
#include "document/document.h"
#include "field/field.h"

#include <SDL.h>
#include <math.h>

#define NEAR_UNITS 9.0   /* hit radius of a handle */
#define SNAP_UNITS 6.0   /* snap distance to the cell's edges and centre */
#define SNAP_DEGREES 2.0 /* snap angle to quarter turns */
#define NEARLY_ALL 0.9   /* fraction of an axis that counts as filled */

/* A drag changes `now` only; the line of the command is written from it and tried on a snapshot by a worker thread
   (wr_app_try). Applying runs the same line, so the preview and the step have the same bits. */
static const WrTransformValues still = { .scale = { 1.0, 1.0 } };

/* ---- transformed piece ---- */

/* Bounding box of the active layer's content; on an axis that it nearly fills, or for a layer without content, the
   whole axis. */
static WrSelectBox content_box(const WrDocument *document)
{
    const WrLayer *layer = &document->layers[document->active];
    const int w = wr_field_width(layer->heights), h = wr_field_height(layer->heights);
    WrSelectBox box = { 0, 0, w, h };
    const WrField *content = layer->on_mask ? layer->mask : layer->cover ? layer->cover : NULL;
    if (!wr_select_box(content ? content : layer->heights, &box))
        return (WrSelectBox){ 0, 0, w, h };
    if (box.count_i > NEARLY_ALL * w) box.i = 0, box.count_i = w;
    if (box.count_j > NEARLY_ALL * h) box.j = 0, box.count_j = h;
    return box;
}

static void measure(WrApp *app)
{
    WrTransformState *hand = app->transform;
    const WrDocument *document = wr_app_document(app);
    const WrField *like = document->layers[0].heights;
    uint64_t revision = wr_session_revision(app->session);
    if (hand->measured && hand->revision == revision) return;
    *hand = (WrTransformState){ .measured = true,
                                .revision = revision,
                                .any = true,
                                .box = { 0, 0, wr_field_width(like), wr_field_height(like) },
                                .now = still,
                                .leave = hand->leave,
                                .back = hand->back,
                                .all = hand->all };
    if (document->selection) hand->any = wr_select_box(document->selection, &hand->box);
    else if (!hand->all) hand->box = content_box(document);
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
    if (hand->leave) wr_text_add(line, " leave=on");
    if (hand->all) wr_text_add(line, " layers=all");
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

void wr_transform_pasted(WrApp *app)
{
    const int before = app->tool, tool = wr_tool_find(app, WR_ACT(transform));
    if (tool == before) return;
    wr_tool_choose(app, tool);
    app->transform->back = before + 1;
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
    from_middle(app, &hand->now, at, hand->from);
    hand->first = hand->now;
    hand->part = find_handle(app, hand->from, hand->side) ? WR_TRANSFORM_SCALE
                 : is_inside(hand, hand->from)            ? WR_TRANSFORM_MOVE
                                                          : WR_TRANSFORM_TURN;
    wr_app_redraw(app);
}

/* Snap an edge or the centre of the piece to one of the cell's, or to the grid. */
static double snapped(const WrApp *app, int axis, double move, double from, double count)
{
    const double cell = axis ? app->view->table_h : app->view->table_w;
    double grid = wr_grid_step(app, axis), step = grid > 0.0 ? grid : 0.5 * cell;
    double best = move, least = texels(app, SNAP_UNITS);
    /* The piece's near edge, centre and far edge (k = 0, 1, 2) are compared with multiples of the step; the nearest within
       reach wins. */
    for (int k = 0; k < 3; k++) {
        double at = from + 0.5 * k * count + move, way = step * rint(at / step) - at;
        if (fabs(way) >= least) continue;
        least = fabs(way);
        best = move + way;
    }
    return best;
}

static void move(WrApp *app, const WrPointer *at, const double way[2])
{
    WrTransformState *hand = app->transform;
    double m[2] = { way[0], way[1] }; /* right, down */
    if (at->mods & WR_MOD_SHIFT) m[fabs(m[0]) < fabs(m[1]) ? 0 : 1] = 0.0;
    m[0] += hand->first.move[0];
    m[1] -= hand->first.move[1];
    if (!(at->mods & WR_MOD_ALT)) {
        m[0] = rint(snapped(app, 0, m[0], hand->box.i, hand->box.count_i));
        m[1] = rint(snapped(app, 1, m[1], hand->box.j, hand->box.count_j));
    }
    hand->now.move[0] = m[0];
    hand->now.move[1] = -m[1];
}

static void turn(WrApp *app, const WrPointer *at, const double here[2])
{
    WrTransformState *hand = app->transform;
    /* y is negated, since rows run down and angles are anticlockwise. */
    double by = atan2(-here[1], here[0]) - atan2(-hand->from[1], hand->from[0]);
    double deg = hand->first.turn + by * WR_DEG_PER_RAD, quarter = rint(deg / 90.0) * 90.0;
    if (at->mods & WR_MOD_SHIFT) deg = rint(deg / 15.0) * 15.0;
    else if (!(at->mods & WR_MOD_ALT) && fabs(deg - quarter) < SNAP_DEGREES) deg = quarter;
    else deg = wr_line_round(deg, 1);
    hand->now.turn = deg - 360.0 * rint(deg / 360.0);
}

/* The handle follows the pointer, and the opposite one is fixed. */
static void scale(WrApp *app, const WrPointer *at, const double here[2])
{
    WrTransformState *hand = app->transform;
    const double count[2] = { hand->box.count_i, hand->box.count_j };
    double own[2], stays[2], stays_now[2];
    WrTransformValues v = hand->first;
    to_own(&v, here, own);
    for (int k = 0; k < 2; k++) {
        if (hand->side[k] == 0) continue;
        double wide = hand->side[k] * own[k] + 0.5 * count[k] * hand->first.scale[k];
        if (!(at->mods & WR_MOD_ALT)) wide = rint(wide);
        v.scale[k] = near_one(wide / count[k]);
    }
    if ((at->mods & WR_MOD_SHIFT) && hand->side[0] && hand->side[1]) {
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
    for (int k = 0; k < 2; k++) here[k] = hand->from[k] + way[k];
    if (hand->part == WR_TRANSFORM_MOVE) move(app, at, way);
    if (hand->part == WR_TRANSFORM_TURN) turn(app, at, here);
    if (hand->part == WR_TRANSFORM_SCALE) scale(app, at, here);
    changed(app);
}

static void release(WrApp *app, const WrPointer *at)
{
    (void)at;
    app->transform->part = WR_TRANSFORM_NONE;
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

static void marks(WrApp *app)
{
    measure(app);
    const WrTransformState *hand = app->transform;
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

static void number(WrApp *app, const char *id, double width, const WrNumber *spec, double *value)
{
    measure(app);
    if (wr_gui_number(id, width, spec, value) != WR_EDIT_NONE) changed(app);
}

static const WrNumber way = { .low = -512,
                              .high = 512,
                              .hard_low = -65536,
                              .hard_high = 65536,
                              .decimals = 0,
                              .unit = "px",
                              .tip = "Texels, to the right" };

static void move_x(WrApp *app, double width)
{
    number(app, "x", width, &way, &app->transform->now.move[0]);
}

static void move_y(WrApp *app, double width)
{
    WrNumber up = way;
    up.tip = "Texels, upwards";
    number(app, "y", width, &up, &app->transform->now.move[1]);
}

static void percent(WrApp *app, const char *id, double width, const char *tip, double *scale)
{
    WrNumber spec = { .low = 10,
                      .high = 400,
                      .hard_low = -6400,
                      .hard_high = 6400,
                      .reset = 100,
                      .decimals = 1,
                      .unit = "%",
                      .tip = tip };
    double value = *scale * 100.0, was = value;
    number(app, id, width, &spec, &value);
    if (value == was) return;
    *scale = near_one(value / 100.0);
    changed(app);
}

static void scale_u(WrApp *app, double width)
{
    percent(app, "w", width, "Width; a negative one mirrors", &app->transform->now.scale[0]);
}

static void scale_v(WrApp *app, double width)
{
    percent(app, "h", width, "Height; a negative one mirrors", &app->transform->now.scale[1]);
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
    number(app, "turn", width, &spec, &app->transform->now.turn);
}

static void switches(WrApp *app, double width)
{
    WrTransformState *hand = app->transform;
    (void)width;
    bool leave = hand->leave, all = hand->all;
    wr_gui_check("copy", &hand->leave);
    wr_gui_tip("Transforms a copy of the selected heights");
    wr_gui_same_line(10);
    wr_gui_check("all layers", &hand->all);
    if (all != hand->all) { /* another frame with the same values */
        const WrTransformValues now = hand->now;
        hand->measured = false;
        measure(app);
        hand->now = now;
    }
    if (leave != hand->leave || all != hand->all) changed(app);
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
    const WrOption items[] = { { "X", 84, 0, move_x, true },    { "Y", 84, 0, move_y, true },
                               { "W", 90, 0, scale_u, true },   { "H", 90, 0, scale_v, true },
                               { "Turn", 84, 0, turned, true }, { "##", 0, 176, switches, true },
                               { "##", 0, 180, buttons, true } };
    wr_option_row(app, items, (int)(sizeof items / sizeof *items));
}

/* ---- the row ---- */

const WrTool wr_tool_transform = {
    .action = WR_ACT(transform),
    .icon = WR_ICON_TRANSFORM,
    .help = "Drag the selection to move it, its handles to scale it, outside of it to turn it; "
            "Enter applies, Escape cancels.",
    .press = press,
    .drag = drag,
    .release = release,
    .marks = marks,
    .options = options,
    .key = key,
    .leave = leave
};
