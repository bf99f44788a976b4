/* Canvas handles for the generator's position, size (a corner) and rotation (a ring), if it has such parameters. */
#include "ui/canvas/view.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/line.h"
#include "ui/app/state/session_view.h"
#include "ui/panels/generate/generate_state.h"
#include "ui/panels/generate/pose_path.h"
#include "ui/toolkit/gui.h"
#include "ui/canvas/overlays/marks.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/dialog.h"
#include "ui/toolkit/theme.h"
#include "ui/canvas/tools/tool.h"

#include "base/exactmath.h"
#include "base/text.h"
#include "document/document.h"
#include "field/field.h"
#include "field/select.h"
#include "generate/generator.h"

#include <SDL.h>
#include <math.h>
#include <string.h>

/* ---- points of a generator, such as a path for letters ---- */

/* On the canvas, Ctrl+click adds or removes a point, and a drag moves it. They are stored in command syntax,
   "u,v;u,v;...". */

#define POINT_NEAR_UNITS 9.0
#define POINTS_MAX 64 /* limit of editable points */

typedef struct Points {
    WrSelectPoint at[POINTS_MAX];
    int count;
} Points;

static int points_param(const WrGenerateState *hand)
{
    for (int i = 0; hand->generator && hand->generator->params[i].name; i++)
        if (hand->generator->params[i].kind == WR_PARAM_POINTS) return i;
    return -1;
}

/* False: malformed, or too many. */
static bool read_points(const char *text, Points *points)
{
    points->count = 0;
    text += strspn(text, " ");
    while (*text) {
        size_t u = strcspn(text, ",;"), v = text[u] == ',' ? strcspn(text + u + 1, ",;") : 0;
        WrSelectPoint *p = &points->at[points->count];
        if (points->count == POINTS_MAX || v == 0 || text[u + 1 + v] == ',') return false;
        if (!wr_number_parse(text, u, &p->u) || !wr_number_parse(text + u + 1, v, &p->v))
            return false;
        points->count++;
        text += u + 1 + v;
        text += *text == ';';
    }
    return true;
}

static void write_points(WrApp *app, int param, const Points *points)
{
    WrGenerateState *hand = app->generate;
    WrText text = { 0 };
    for (int i = 0; i < points->count; i++) {
        if (i > 0) wr_text_add(&text, ";");
        wr_text_add_number(&text, wr_line_round(points->at[i].u, 5));
        wr_text_add(&text, ",");
        wr_text_add_number(&text, wr_line_round(points->at[i].v, 5));
    }
    SDL_utf8strlcpy(hand->value[param].text, wr_text_get(&text), WR_GENERATE_TEXT);
    wr_text_fini(&text);
    hand->preset = -2;
    wr_generate_changed(app);
}

/* Index of the point under the pointer, on any copy of the cell; -1: none. */
static int find(const WrApp *app, const Points *points, const WrPointer *at)
{
    const WrField *field = wr_app_field(app);
    bool around_u = wr_field_wrap_u(field) == WR_WRAP_PERIODIC;
    bool around_v = wr_field_wrap_v(field) == WR_WRAP_PERIODIC;
    for (int i = points->count - 1; i >= 0; i--) {
        double du = at->u - points->at[i].u, dv = at->v - points->at[i].v;
        if (around_u) du -= rint(du);
        if (around_v) dv -= rint(dv);
        double pixels = hypot(du * app->view->table_w, dv * app->view->table_h) * app->view->zoom;
        if (pixels < POINT_NEAR_UNITS * wr_gui_scale()) return i;
    }
    return -1;
}

/* The first point is moved into the cell; further ones stay where they were clicked, so that a path may cross the
   cell's edges. */
static WrSelectPoint place(const WrApp *app, const Points *points, const WrPointer *at)
{
    WrSelectPoint home = wr_overlay_wrap_offset(app, at->u, at->v);
    if (points->count > 0) home = (WrSelectPoint){ 0.0, 0.0 };
    return (WrSelectPoint){ at->u + home.u, at->v + home.v };
}

static void take_point(Points *points, int i)
{
    memmove(points->at + i, points->at + i + 1,
            (size_t)(points->count - i - 1) * sizeof *points->at);
    points->count--;
}

static bool pose_points_press(WrApp *app, const WrPointer *at)
{
    WrGenerateState *hand = app->generate;
    Points points;
    int param = points_param(hand);
    hand->point = -1;
    if (param < 0 || !read_points(hand->value[param].text, &points)) return false;
    int i = find(app, &points, at);
    if (at->mods & WR_MOD_CTRL) {
        if (i >= 0) {
            take_point(&points, i);
        } else if (points.count < POINTS_MAX) {
            points.at[points.count] = place(app, &points, at);
            hand->point_first = points.at[points.count];
            hand->point = points.count++;
        }
        write_points(app, param, &points);
    } else if (i >= 0) {
        hand->point = i;
        hand->point_first = points.at[i];
    }
    return points.count > 0 || (at->mods & WR_MOD_CTRL);
}

static void pose_points_drag(WrApp *app, const WrPointer *at)
{
    WrGenerateState *hand = app->generate;
    Points points;
    int param = points_param(hand);
    if (param < 0 || !read_points(hand->value[param].text, &points)) return;
    if (hand->point < 0 || hand->point >= points.count) return;
    points.at[hand->point] = (WrSelectPoint){ hand->point_first.u + at->u - app->hand->start.u,
                                              hand->point_first.v + at->v - app->hand->start.v };
    write_points(app, param, &points);
}

/* it has points */
static bool pose_points_marks(const WrApp *app)
{
    const WrGenerateState *hand = app->generate;
    Points points;
    int param = points_param(hand);
    if (param < 0 || !read_points(hand->value[param].text, &points) || points.count == 0)
        return false;
    wr_overlay_lines(app, points.at, points.count, false, 0x90d0d0d0u);
    for (int i = 0; i < points.count; i++)
        wr_overlay_handle(app, points.at[i].u, points.at[i].v, true, i == hand->point);
    return true;
}

/* ---- parameters for position, size and rotation ---- */

#define NEAR_UNITS 9.0
#define LEAST_UNITS 26.0 /* least distance of the corner from the centre */
#define RING_UNITS 22.0  /* distance of the ring beyond the corner */
#define HOLD_STEPS 3     /* steps of 4 units around the pointer */

static const char *const place_names[] = { "at", "origin", "centre", NULL };
static const char *const size_names[] = { "size", "radius", NULL };
static const char *const turn_names[] = { "angle", "rotate", NULL };

/* Indices of the parameters for position, size and rotation; -1: none. */
typedef struct Pose {
    int place, size, turn;
    int turned; /* component of the rotation: the last one, about the viewing axis */
} Pose;

static bool has_unit(const WrGenerateState *hand, int i, const char *unit)
{
    return i >= 0 && strcmp(hand->generator->params[i].unit, unit) == 0;
}

static int number_or_tuple(const WrGenerateState *hand, const char *const *names)
{
    int i = wr_generate_find(hand, names, WR_PARAM_NUMBER);
    return i >= 0 ? i : wr_generate_find(hand, names, WR_PARAM_TUPLE); /* per axis */
}

static Pose pose_of(const WrGenerateState *hand)
{
    Pose pose = { wr_generate_find(hand, place_names, WR_PARAM_TUPLE),
                  number_or_tuple(hand, size_names), number_or_tuple(hand, turn_names), 0 };
    if (!has_unit(hand, pose.size, "texels")) pose.size = -1;
    if (!has_unit(hand, pose.turn, "degrees")) pose.turn = -1;
    if (pose.turn >= 0 && hand->generator->params[pose.turn].kind == WR_PARAM_TUPLE)
        pose.turned = hand->generator->params[pose.turn].components - 1;
    return pose;
}

static bool is_shown(const WrApp *app)
{
    return app->generate->active && app->dialog->now == WR_DIALOG_NONE;
}

/* ---- geometry, in texels ---- */

static void middle(const WrApp *app, const Pose *pose, double *x, double *y)
{
    const double *uv = app->generate->value[pose->place].number;
    *x = uv[0] * app->view->table_w;
    *y = (1.0 - uv[1]) * app->view->table_h;
}

static double reach_units(const WrApp *app, double units)
{
    return units * wr_gui_scale() / app->view->zoom;
}

/* Vector from the centre to the corner, from the size parameter, but long enough for a handle. */
static double corner_way(const WrApp *app, const Pose *pose)
{
    double size = pose->size >= 0 ? app->generate->value[pose->size].number[0] : 0.0;
    return fmax(fabs(size), reach_units(app, LEAST_UNITS));
}

static double ring_way(const WrApp *app, const Pose *pose)
{
    return corner_way(app, pose) + reach_units(app, RING_UNITS);
}

static double turn_rad(const WrApp *app, const Pose *pose)
{
    return app->generate->value[pose->turn].number[pose->turned] * WR_RAD_PER_DEG;
}

/* The copy of the centre nearest to the pointer. */
static void nearest(const WrApp *app, const Pose *pose, double px, double py, double *x, double *y)
{
    const WrField *field = wr_app_field(app);
    double w = app->view->table_w, h = app->view->table_h;
    middle(app, pose, x, y);
    if (wr_field_wrap_u(field) == WR_WRAP_PERIODIC) *x += w * rint((px - *x) / w);
    if (wr_field_wrap_v(field) == WR_WRAP_PERIODIC) *y += h * rint((py - *y) / h);
}

/* Vector from the centre of the nearest copy to the pointer: texels right and up. */
static void from_middle(const WrApp *app, const Pose *pose, const WrPointer *at, double *x,
                        double *y)
{
    double px, py, mx, my;
    wr_view_to_texel(app->view, at->x, at->y, &px, &py);
    nearest(app, pose, px, py, &mx, &my);
    *x = px - mx;
    *y = my - py;
}

static WrPosePart part_at(const WrApp *app, const Pose *pose, double x, double y)
{
    double near = reach_units(app, NEAR_UNITS), way = hypot(x, y);
    double corner = corner_way(app, pose) * 0.7071067811865476;
    if (pose->size >= 0 && hypot(x - corner, y + corner) < near) return WR_POSE_SIZE;
    if (pose->turn >= 0 && fabs(way - ring_way(app, pose)) < near) return WR_POSE_TURN;
    return WR_POSE_PLACE;
}

/* True if the object's heights change near the pointer: a press then drags the object instead of placing it. */
static bool is_on_it(const WrApp *app, const WrPointer *at)
{
    const WrField *now = wr_app_field(app), *was = wr_document_field(wr_app_document(app));
    int w = wr_field_width(now), h = wr_field_height(now);
    if (!app->trying || wr_field_width(was) != w || wr_field_height(was) != h) return false;
    for (int j = -HOLD_STEPS; j <= HOLD_STEPS; j++)
        for (int i = -HOLD_STEPS; i <= HOLD_STEPS; i++) {
            double x, y, step = 4.0 * wr_gui_scale();
            wr_view_to_texel(app->view, at->x + i * step, at->y + j * step, &x, &y);
            x -= w * floor(x / w);
            y -= h * floor(y / h);
            int column = x < w - 1 ? (int)x : w - 1, row = y < h - 1 ? (int)y : h - 1;
            if (wr_field_get(now, column, row) != wr_field_get(was, column, row)) return true;
        }
    return false;
}

/* ---- dragging ---- */

static double wrapped(const WrParam *p, bool periodic, double x)
{
    x = wr_line_round(periodic ? x - floor(x) : x, 6);
    if (periodic && x >= 1.0) x = 0.0;
    return x < p->low ? p->low : x > p->high ? p->high : x;
}

static void put(WrApp *app, const Pose *pose, double u, double v)
{
    WrGenerateState *hand = app->generate;
    const WrParam *p = &hand->generator->params[pose->place];
    const WrField *field = wr_app_field(app);
    double *number = hand->value[pose->place].number;
    number[0] = wrapped(p, wr_field_wrap_u(field) == WR_WRAP_PERIODIC, u);
    number[1] = wrapped(p, wr_field_wrap_v(field) == WR_WRAP_PERIODIC, v);
}

static void begin(WrGenerateState *hand, const Pose *pose)
{
    int i = hand->held == WR_POSE_SIZE   ? pose->size
            : hand->held == WR_POSE_TURN ? pose->turn
                                         : pose->place;
    memcpy(hand->first_number, hand->value[i].number, sizeof hand->first_number);
}

static void press(WrApp *app, const WrPointer *at)
{
    WrGenerateState *hand = app->generate;
    app->hints = false;
    if (!hand->generator) return;
    Pose pose = pose_of(hand);
    bool took = pose_points_press(app, at) || wr_pose_path_press(app, at);
    hand->held = took ? WR_POSE_POINT : WR_POSE_NONE;
    if (took || pose.place < 0) return;
    double x, y;
    from_middle(app, &pose, at, &x, &y);
    hand->held = part_at(app, &pose, x, y);
    /* A press outside places an object with a size; a pattern that fills the table is only moved. */
    hand->placed = hand->held == WR_POSE_PLACE &&
                   strcmp(hand->generator->params[pose.place].name, "at") == 0 &&
                   hypot(x, y) > corner_way(app, &pose) && !is_on_it(app, at);
    if (hand->placed) put(app, &pose, at->u, at->v);
    hand->first[0] = at->u;
    hand->first[1] = at->v;
    begin(hand, &pose);
    if (hand->placed || !hand->active) wr_generate_changed(app);
    wr_app_redraw(app);
}

static void resize(WrApp *app, const Pose *pose, const WrPointer *at)
{
    WrGenerateState *hand = app->generate;
    const WrParam *p = &hand->generator->params[pose->size];
    int count = p->kind == WR_PARAM_TUPLE ? p->components : 1;
    double x, y, fx, fy;
    WrPointer first = app->hand->start;
    from_middle(app, pose, at, &x, &y);
    from_middle(app, pose, &first, &fx, &fy);
    double factor = hypot(x, y) / fmax(hypot(fx, fy), 1e-6);
    for (int k = 0; k < count; k++) {
        double value = wr_line_round(hand->first_number[k] * factor, 2);
        double low = p->above ? p->low + 0.01 : p->low;
        hand->value[pose->size].number[k] = value < low ? low : value > p->high ? p->high : value;
    }
}

static void turn(WrApp *app, const Pose *pose, const WrPointer *at)
{
    WrGenerateState *hand = app->generate;
    const WrParam *p = &hand->generator->params[pose->turn];
    double x, y, fx, fy;
    WrPointer first = app->hand->start;
    from_middle(app, pose, at, &x, &y);
    from_middle(app, pose, &first, &fx, &fy);
    double deg = hand->first_number[pose->turned] + (atan2(y, x) - atan2(fy, fx)) * WR_DEG_PER_RAD;
    deg = wr_signed_degrees(deg);
    if (at->mods & WR_MOD_SHIFT) deg = rint(deg / 15.0) * 15.0;
    if (deg < p->low) deg += 360.0;
    deg = wr_line_round(deg, 1);
    hand->value[pose->turn].number[pose->turned] = deg > p->high ? p->high : deg;
}

static void drag(WrApp *app, const WrPointer *at)
{
    WrGenerateState *hand = app->generate;
    bool moved = hypot(at->x - app->hand->start.x, at->y - app->hand->start.y) >= 2.0;
    if (!hand->generator || hand->held == WR_POSE_NONE || !moved) return;
    Pose pose = pose_of(hand);
    if (hand->held == WR_POSE_POINT) {
        if (points_param(hand) >= 0) pose_points_drag(app, at);
        else wr_pose_path_drag(app, at);
        return;
    }
    if (hand->held == WR_POSE_SIZE) resize(app, &pose, at);
    else if (hand->held == WR_POSE_TURN) turn(app, &pose, at);
    else
        put(app, &pose, hand->first_number[0] + at->u - hand->first[0],
            hand->first_number[1] + at->v - hand->first[1]);
    hand->preset = -2;
    wr_generate_changed(app);
}

/* A click on a text moves the keyboard focus to its field. */
static void release(WrApp *app, const WrPointer *at)
{
    WrGenerateState *hand = app->generate;
    bool moved = hypot(at->x - app->hand->start.x, at->y - app->hand->start.y) >= 2.0;
    bool point = hand->held == WR_POSE_POINT;
    if (hand->generator && !moved && !point && wr_generate_written(hand->generator) >= 0)
        wr_generate_focus_text(app);
    hand->held = WR_POSE_NONE; /* the point stays the one that Delete removes */
    wr_app_redraw(app);
}

/* Delete removes the point touched last. */
static bool remove_point(WrApp *app)
{
    WrGenerateState *hand = app->generate;
    Points points;
    const int param = points_param(hand);
    if (param < 0) return wr_pose_path_remove(app);
    if (!read_points(hand->value[param].text, &points) || hand->point < 0 ||
        hand->point >= points.count)
        return false;
    take_point(&points, hand->point);
    hand->point = -1;
    write_points(app, param, &points);
    return true;
}

static bool key(WrApp *app, SDL_Keycode key)
{
    WrGenerateState *hand = app->generate;
    if (!hand->active) return false;
    if (key == SDLK_ESCAPE && hand->held != WR_POSE_NONE && hand->held != WR_POSE_POINT) {
        Pose pose = pose_of(hand); /* the dragged handle has priority */
        int i = hand->held == WR_POSE_SIZE   ? pose.size
                : hand->held == WR_POSE_TURN ? pose.turn
                                             : pose.place;
        memcpy(hand->value[i].number, hand->first_number, sizeof hand->first_number);
        hand->held = WR_POSE_NONE;
        app->hand->grab = WR_GRAB_NONE;
        wr_app_redraw(app);
    } else if (key == SDLK_ESCAPE) {
        wr_generate_cancel(app);
    } else if (key == SDLK_RETURN || key == SDLK_KP_ENTER) {
        wr_generate_commit(app);
    } else if (key == SDLK_DELETE || key == SDLK_BACKSPACE) {
        return remove_point(app);
    } else {
        return false;
    }
    return true;
}

/* ---- drawing on the canvas ---- */

static void circle(const WrApp *app, double x, double y, double radius, WrColour colour)
{
    WrSelectPoint points[72];
    for (int i = 0; i < 72; i++) {
        double a = 6.283185307179586 * i / 72;
        points[i] = wr_overlay_uv(app, x + radius * cos(a), y + radius * sin(a));
    }
    wr_overlay_lines(app, points, 72, true, colour);
}

static void handle(const WrApp *app, double x, double y, bool round, bool hot)
{
    WrSelectPoint p = wr_overlay_uv(app, x, y);
    wr_overlay_handle(app, p.u, p.v, round, hot);
}

static void marks(WrApp *app)
{
    const WrGenerateState *hand = app->generate;
    double x, y;
    if (!is_shown(app)) return;
    bool points = pose_points_marks(app); /* the points then set the position */
    wr_pose_path_marks(app);
    Pose pose = pose_of(hand);
    if (pose.place < 0 || points) return;
    middle(app, &pose, &x, &y);
    WrSelectPoint p = wr_overlay_uv(app, x, y);
    wr_overlay_cross(app, p.u, p.v, hand->held == WR_POSE_PLACE ? WR_COLOUR_CELL : 0xfff4f4f4u);
    if (pose.turn >= 0) {
        double ring = ring_way(app, &pose), a = turn_rad(app, &pose);
        circle(app, x, y, ring, 0xb0d0d0d0u);
        handle(app, x + ring * cos(a), y - ring * sin(a), true, hand->held == WR_POSE_TURN);
    }
    if (pose.size >= 0) {
        double way = corner_way(app, &pose), corner = way * 0.7071067811865476;
        if (hand->held == WR_POSE_SIZE) circle(app, x, y, way, 0x90f4f4f4u);
        handle(app, x + corner, y + corner, false, hand->held == WR_POSE_SIZE);
    }
}

/* ---- option row ---- */

static void options(WrApp *app)
{
    WrGenerateState *hand = app->generate;
    wr_gui_same_line(14);
    if (!hand->generator) {
        wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, "Choose a generator in the Generate tab");
        return;
    }
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_TEXT, hand->generator->label);
    wr_gui_same_line(14);
    if (wr_gui_chip(WR_ICON_CHECK, "Apply")) wr_generate_commit(app);
    wr_gui_tip("Enter");
    wr_gui_same_line(6);
    if (hand->active) {
        if (wr_gui_chip(WR_ICON_CLOSE, "Cancel")) wr_generate_cancel(app);
        wr_gui_tip("Escape: nothing was changed");
    } else if (wr_gui_chip(WR_ICON_EYE, "Show")) {
        wr_generate_open_last(app);
    }
    Pose pose = pose_of(hand);
    if (pose.place < 0 || app->width < wr_gui_px(1100)) return;
    wr_gui_same_line(14);
    const int list = points_param(hand);
    if (list >= 0 && hand->value[list].text[0]) {
        wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL,
                    "Drag the points; Ctrl+click adds one, Delete removes it");
        return;
    }
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL,
                pose.turn >= 0 ? "Drag it on the table; the corner resizes it, the ring rotates it"
                : pose.size >= 0 ? "Drag it on the table; the corner resizes it"
                                 : "Drag it on the table");
    const bool data = wr_pose_path_param(hand) >= 0;
    if ((list < 0 && !data) || app->width < wr_gui_px(data ? 1400 : 1200)) return;
    wr_gui_same_line(0);
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL,
                list >= 0 ? "; Ctrl+click begins a path"
                          : "; its points move, Ctrl+click adds one, Delete removes it");
}

/* ---- the row ---- */

const WrTool wr_tool_generate = {
    .action = WR_ACT(generate),
    .icon = WR_ICON_WAND,
    .help = "Patterns, noise, text and more from the Generate tab: drag the preview, Enter puts it "
            "on the table, Escape cancels.",
    .press = press,
    .drag = drag,
    .release = release,
    .marks = marks,
    .options = options,
    .key = key,
    .leave = wr_generate_cancel
};
