/* Polygons and Bezier paths painted with the brush. A press adds an anchor, a drag pulls out its handles; both can be
   moved until Enter or a double click paints the path. Backspace removes the last anchor, Escape cancels. */
#include "ui/canvas/view.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/line.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/canvas/tools/tool.h"
#include "ui/canvas/tools/tool_rows.h"
#include "ui/canvas/tools/tool_shape.h"
#include "ui/canvas/overlays/marks.h"

#include "base/array.h"
#include "base/text.h"
#include "field/select.h"
#include "system/clock.h"

#include <SDL.h>
#include <math.h>
#include <string.h>

#define NEAR_UNITS 8.0
#define DOUBLE_SECONDS 0.35
#define CURVE_POINTS 24 /* segments of a drawn piece */

enum { PART_ANCHOR, PART_IN, PART_OUT };

static bool is_path(const WrApp *app)
{
    return strcmp(wr_tool_now(app)->action, WR_ACT(shape_path)) == 0;
}

static WrAnchor *last_of(WrDrawState *draw)
{
    return &draw->anchors.data[draw->anchors.count - 1];
}

static bool is_near(const WrApp *app, const WrPointer *at, double x, double y)
{
    double px, py;
    wr_view_to_pixel(app->view, x, y, &px, &py);
    return hypot(px - at->x, py - at->y) < NEAR_UNITS * wr_gui_scale();
}

/* Find the anchor or handle under the pointer; handles first, since they are on top. */
static bool find(const WrApp *app, const WrPointer *at, int *index, int *part)
{
    const WrDrawState *draw = app->draw;
    for (int i = draw->anchors.count - 1; i >= 0; i--) {
        const WrAnchor *a = &draw->anchors.data[i];
        bool in = is_path(app) && is_near(app, at, a->in_x, a->in_y);
        bool out = is_path(app) && is_near(app, at, a->out_x, a->out_y);
        bool bare = a->in_x == a->x && a->in_y == a->y && a->out_x == a->x && a->out_y == a->y;
        bool here = is_near(app, at, a->x, a->y);
        if (!here && !((in || out) && !bare)) continue;
        *index = i;
        *part = here ? PART_ANCHOR : out ? PART_OUT : PART_IN;
        return true;
    }
    return false;
}

/* ---- the command ---- */

static void add_point(WrText *line, const WrApp *app, double x, double y, WrSelectPoint home)
{
    WrSelectPoint p = wr_overlay_uv(app, x, y);
    const char *text = wr_text_get(line);
    if (line->length > 0 && text[line->length - 1] != '=') wr_text_add(line, ";");
    wr_text_add_number(line, wr_line_round(p.u + home.u, 7));
    wr_text_add(line, ",");
    wr_text_add_number(line, wr_line_round(p.v + home.v, 7));
}

/* A cubic Bezier piece needs out-handle, in-handle and end; its start is the end of the piece before. */
static void add_piece(WrText *line, const WrApp *app, const WrAnchor *a, const WrAnchor *b,
                      WrSelectPoint home)
{
    add_point(line, app, a->out_x, a->out_y, home);
    add_point(line, app, b->in_x, b->in_y, home);
    add_point(line, app, b->x, b->y, home);
}

/* Anchors may lie on any copy of the cell; `home` shifts all of them by whole cells, so that the first one is in the cell and
   the shape keeps its connection across the edges. */
static void write_line(const WrApp *app, WrText *line)
{
    const WrDrawState *draw = app->draw;
    const WrAnchor *list = draw->anchors.data;
    WrSelectPoint first = wr_overlay_uv(app, list[0].x, list[0].y);
    WrSelectPoint home = wr_overlay_wrap_offset(app, first.u, first.v);
    bool fills = app->settings->drawing.fills, closed = draw->closed || fills;
    wr_text_add(line, is_path(app) ? "shape path points=" : "shape polygon points=");
    add_point(line, app, list[0].x, list[0].y, home);
    for (int i = 1; i < draw->anchors.count; i++) {
        if (is_path(app)) add_piece(line, app, &list[i - 1], &list[i], home);
        else add_point(line, app, list[i].x, list[i].y, home);
    }
    if (is_path(app) && closed) {
        add_piece(line, app, &list[draw->anchors.count - 1], &list[0], home);
        wr_text_add(line, " closed=on");
    }
    wr_text_addf(line, " paint=%s", fills ? "fill" : "outline");
    wr_draw_brush_line(app, line, true);
}

static void commit(WrApp *app)
{
    WrText line = { 0 };
    int least = is_path(app) ? 2 : 3;
    if (app->draw->anchors.count < least) {
        wr_app_say(app, "A %s needs %d points", wr_words(is_path(app) ? "path" : "polygon"), least);
        return;
    }
    write_line(app, &line);
    app->hand->grab = WR_GRAB_NONE;
    wr_draw_leave(app);
    wr_app_run_slow(app, wr_text_get(&line));
    wr_text_fini(&line);
}

/* ---- dragging ---- */

static void put_anchor(WrApp *app, const WrPointer *at)
{
    WrDrawState *draw = app->draw;
    double x, y;
    wr_view_to_texel(app->view, at->x, at->y, &x, &y);
    wr_array_push(&draw->anchors, ((WrAnchor){ x, y, x, y, x, y }));
    draw->active = true;
    draw->held = draw->anchors.count - 1;
    draw->part = is_path(app) ? PART_OUT : PART_ANCHOR;
}

static void press(WrApp *app, const WrPointer *at)
{
    WrDrawState *draw = app->draw;
    int index, part;
    double now = wr_clock_seconds();
    bool again = draw->active && now - draw->clicked_at < DOUBLE_SECONDS &&
                 hypot(at->x - app->hand->start.x, at->y - app->hand->start.y) < 6.0 &&
                 draw->anchors.count > 1 && is_near(app, at, draw->x1, draw->y1);
    draw->clicked_at = now;
    app->hints = false;
    wr_view_to_texel(app->view, at->x, at->y, &draw->x1, &draw->y1);
    if (again) {
        commit(app);
        return;
    }
    if (!draw->active) draw->anchors.count = 0;
    if (draw->active && find(app, at, &index, &part)) {
        bool closes = index == 0 && part == PART_ANCHOR && draw->anchors.count > 2 && !draw->closed;
        draw->held = index;
        draw->part = part;
        if (closes && !is_path(app)) commit(app);
        else if (closes) draw->closed = true;
    } else if (!draw->closed) {
        put_anchor(app, at);
    }
    wr_app_redraw(app);
}

static void drag(WrApp *app, const WrPointer *at)
{
    WrDrawState *draw = app->draw;
    double x, y;
    if (!draw->active || draw->held < 0 || draw->held >= draw->anchors.count) return;
    wr_view_to_texel(app->view, at->x, at->y, &x, &y);
    WrAnchor *a = &draw->anchors.data[draw->held];
    if (draw->part == PART_ANCHOR) {
        double dx = x - a->x, dy = y - a->y;
        *a = (WrAnchor){ x, y, a->in_x + dx, a->in_y + dy, a->out_x + dx, a->out_y + dy };
    } else {
        bool both = !(at->mods & WR_MOD_ALT); /* Alt moves one handle independently */
        /* The opposite handle mirrored at the anchor: both tangents are parallel and equal, the curve is C1 there. */
        double ox = 2.0 * a->x - x, oy = 2.0 * a->y - y;
        bool out = draw->part == PART_OUT;
        if (out || both) {
            a->out_x = out ? x : ox;
            a->out_y = out ? y : oy;
        }
        if (!out || both) {
            a->in_x = out ? ox : x;
            a->in_y = out ? oy : y;
        }
    }
    wr_app_redraw(app);
}

static void release(WrApp *app, const WrPointer *at)
{
    WrDrawState *draw = app->draw;
    if (draw->active && draw->held >= 0 && draw->held < draw->anchors.count &&
        draw->part != PART_ANCHOR &&
        hypot(at->x - app->hand->start.x, at->y - app->hand->start.y) < 3.0) {
        WrAnchor *a = &draw->anchors.data[draw->held]; /* a click: a corner without handles */
        if (hypot(a->out_x - a->x, a->out_y - a->y) * app->view->zoom < 4.0)
            *a = (WrAnchor){ a->x, a->y, a->x, a->y, a->x, a->y };
    }
    draw->held = -1;
    wr_app_redraw(app);
}

static bool key(WrApp *app, SDL_Keycode key)
{
    WrDrawState *draw = app->draw;
    if (!draw->active) return false;
    if (key == SDLK_RETURN || key == SDLK_KP_ENTER) {
        commit(app);
    } else if (key == SDLK_BACKSPACE || key == SDLK_DELETE) {
        if (draw->closed) draw->closed = false;
        else draw->anchors.count--;
        draw->held = -1;
        if (draw->anchors.count == 0) wr_draw_leave(app);
    } else if (key == SDLK_ESCAPE) {
        app->hand->grab = WR_GRAB_NONE;
        wr_draw_leave(app);
    } else {
        return false;
    }
    wr_app_redraw(app);
    return true;
}

/* ---- drawing on the canvas ---- */

static void draw_piece(const WrApp *app, const WrAnchor *a, const WrAnchor *b, WrColour colour)
{
    WrSelectPoint points[CURVE_POINTS + 1];
    bool straight = a->out_x == a->x && a->out_y == a->y && b->in_x == b->x && b->in_y == b->y;
    int count = straight ? 1 : CURVE_POINTS;
    for (int i = 0; i <= count; i++) {
        double t = (double)i / count, s = 1.0 - t;
        double k0 = s * s * s, k1 = 3 * s * s * t, k2 = 3 * s * t * t, k3 = t * t * t;
        points[i] = wr_overlay_uv(app, k0 * a->x + k1 * a->out_x + k2 * b->in_x + k3 * b->x,
                                  k0 * a->y + k1 * a->out_y + k2 * b->in_y + k3 * b->y);
    }
    wr_overlay_lines(app, points, count + 1, false, colour);
}

static void draw_arm(const WrApp *app, const WrAnchor *a, double x, double y)
{
    if (x == a->x && y == a->y) return;
    WrSelectPoint arm[2] = { wr_overlay_uv(app, a->x, a->y), wr_overlay_uv(app, x, y) };
    wr_overlay_lines(app, arm, 2, false, WR_COLOUR_ACCENT);
    wr_overlay_handle(app, arm[1].u, arm[1].v, true, false);
}

static void marks(WrApp *app)
{
    WrDrawState *draw = app->draw;
    int count = draw->anchors.count;
    if (!draw->active || count == 0) return;
    const WrAnchor *list = draw->anchors.data;
    bool closed = draw->closed || app->settings->drawing.fills;
    for (int i = 1; i < count; i++) draw_piece(app, &list[i - 1], &list[i], 0xfff4f4f4u);
    if (draw->held < 0 && app->hand->on_canvas && !draw->closed) {
        double x, y;
        wr_view_to_texel(app->view, app->hand->at.x, app->hand->at.y, &x, &y);
        WrAnchor next = { x, y, x, y, x, y };
        draw_piece(app, last_of(draw), &next, 0xb0d0d0d0u);
    }
    if (count > 2 && (closed || !is_path(app)))
        draw_piece(app, last_of(draw), &list[0], closed ? 0xfff4f4f4u : 0x90d0d0d0u);
    for (int i = 0; i < count; i++) {
        if (is_path(app)) {
            draw_arm(app, &list[i], list[i].in_x, list[i].in_y);
            draw_arm(app, &list[i], list[i].out_x, list[i].out_y);
        }
        WrSelectPoint p = wr_overlay_uv(app, list[i].x, list[i].y);
        wr_overlay_handle(app, p.u, p.v, false, i == draw->held || (i == 0 && count > 2));
    }
}

/* ---- the rows ---- */

const WrTool wr_tool_shape_polygon = { .action = WR_ACT(shape_polygon),
                                       .icon = WR_ICON_POLYGON,
                                       .help = "Click the corners; Enter or a double click paints "
                                               "the polygon, Backspace removes the last corner.",
                                       .press = press,
                                       .drag = drag,
                                       .release = release,
                                       .marks = marks,
                                       .options = wr_shape_options,
                                       .key = key,
                                       .leave = wr_draw_leave,
                                       .meanwhile = true };

const WrTool wr_tool_shape_path = { .action = WR_ACT(shape_path),
                                    .icon = WR_ICON_CURVE,
                                    .help = "Click to add points, drag their handles, move both; "
                                            "Enter or a double click paints the curve.",
                                    .press = press,
                                    .drag = drag,
                                    .release = release,
                                    .marks = marks,
                                    .options = wr_shape_options,
                                    .key = key,
                                    .leave = wr_draw_leave,
                                    .meanwhile = true };
