/* The brush tool: conversion of pointer input to strokes. Freehand; straight lines from the last stroke (Shift+click)
   or with a held key; picking a height; resizing. */
#include "ui/canvas/tools/tool_brush.h"
#include "ui/canvas/view.h"
#include "field/scheme_list.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/input/stroke_smoothing.h"
#include "ui/canvas/tools/brush_outline.h"
#include "ui/canvas/tools/option_row.h"
#include "ui/canvas/tools/stroke_input.h"
#include "ui/canvas/tools/tool.h"
#include "ui/canvas/tools/tool_rows.h"

#include "base/exactmath.h"
#include "brush/brush.h"
#include "field/field.h"
#include "field/scheme.h"

#include <math.h>

#define SNAP_DEG 15.0

static WrSmoothingPoint steady_point(const WrPointer *at)
{
    return (WrSmoothingPoint){ at->x, at->y, at->pressure, at->tilt_x, at->tilt_y, at->seconds };
}

/* Convert to the table's coordinates: mirroring flips the tilt, and a rotated view rotates it. */
static void sample(WrApp *app, const WrPointer *at, double u, double v)
{
    WrPointer seen = *at;
    double zoom = app->view->zoom, x, y;
    wr_view_step_back(app->view, at->tilt_x * zoom, at->tilt_y * zoom, &x, &y);
    seen.tilt_x = fmax(-1.0, fmin(1.0, x));
    seen.tilt_y = fmax(-1.0, fmin(1.0, y));
    wr_strokes_sample(app, &seen, u, v);
}

static WrPointer pointer_of(const WrPointer *at, const WrSmoothingPoint *p)
{
    WrPointer out = *at;
    out.x = p->x;
    out.y = p->y;
    out.pressure = p->pressure;
    out.tilt_x = p->tilt_x;
    out.tilt_y = p->tilt_y;
    out.seconds = p->seconds;
    return out;
}

void wr_brush_steady_begin(WrApp *app, const WrPointer *at)
{
    const WrSettings *s = app->settings;
    double length = s->steady == WR_SMOOTHING_STRING ? s->steady_string : s->steady_smooth;
    WrSmoothingPoint p = steady_point(at);
    wr_smoothing_begin(&app->brush->steady, (WrSmoothingKind)s->steady, length * wr_gui_scale(),
                       &p);
    app->brush->way_x = app->brush->way_y = 0.0;
}

void wr_brush_steady_move(WrApp *app, const WrPointer *at,
                          void (*draw)(WrApp *app, const WrPointer *at))
{
    WrSmoothingPoint out[WR_SMOOTHING_POINTS], p = steady_point(at);
    WrBrushState *hand = app->brush;
    int count = wr_smoothing_move(&hand->steady, &p, out);
    double dx = at->x - app->hand->at.x, dy = at->y - app->hand->at.y;
    if (hypot(dx, dy) > 0.5) {
        wr_view_step_back(app->view, dx, dy, &hand->way_x, &hand->way_y);
    }
    for (int i = 0; i < count; i++) {
        WrPointer to = pointer_of(at, &out[i]);
        draw(app, &to);
    }
    wr_app_redraw(app); /* the string moves although nothing is drawn */
}

void wr_brush_steady_end(WrApp *app, const WrPointer *at,
                         void (*draw)(WrApp *app, const WrPointer *at))
{
    WrSmoothingPoint out;
    if (wr_smoothing_end(&app->brush->steady, app->settings->steady_catch_up, &out) == 0) return;
    WrPointer to = pointer_of(at, &out);
    draw(app, &to);
}

/* ---- freehand ---- */

static void draw_at(WrApp *app, const WrPointer *at)
{
    double u, v;
    wr_view_to_uv(app->view, at->x, at->y, &u, &v);
    sample(app, at, u, v);
}

/* ---- straight lines ---- */

/* End of the aimed line in pixels: with Ctrl or Shift at the nearest of 24 directions. */
static void aim(WrApp *app, const WrPointer *at)
{
    WrBrushState *hand = app->brush;
    const WrPointer *from = &app->hand->start;
    double dx = at->x - from->x, dy = at->y - from->y;
    if (at->mods & (WR_MOD_CTRL | WR_MOD_SHIFT)) {
        double step = SNAP_DEG * WR_RAD_PER_DEG, turn = rint(atan2(dy, dx) / step) * step;
        double way = dx * cos(turn) + dy * sin(turn);
        dx = way * cos(turn);
        dy = way * sin(turn);
    }
    wr_view_to_uv(app->view, from->x, from->y, &hand->line_u, &hand->line_v);
    wr_view_to_uv(app->view, from->x + dx, from->y + dy, &hand->to_u, &hand->to_v);
    if (at->pressure > hand->pressure) hand->pressure = at->pressure;
    wr_app_redraw(app);
}

/* Straight line to a position any number of cells away. A stroke joins samples by the shortest way round, so each
 * step must be shorter than half a cell. */
static void straight_on(WrApp *app, const WrPointer *at, double u, double v, double to_u,
                        double to_v)
{
    double du = to_u - u, dv = to_v - v;
    int pieces = (int)fmin(64.0, ceil(fmax(fabs(du), fabs(dv)) / 0.4));
    for (int i = 1; i <= pieces; i++) sample(app, at, u + du * i / pieces, v + dv * i / pieces);
}

/* Draw the aimed line with the highest pressure reached. */
static void draw_line(WrApp *app, const WrPointer *at)
{
    WrBrushState *hand = app->brush;
    WrPointer steady = *at;
    steady.pressure = hand->pressure;
    WrBrush brush = wr_strokes_brush(app, at);
    if (!wr_strokes_begin(app, &brush, at)) return;
    sample(app, &steady, hand->line_u, hand->line_v);
    straight_on(app, &steady, hand->line_u, hand->line_v, hand->to_u, hand->to_v);
    wr_strokes_end(app);
}

/* ---- the tool ---- */

void wr_brush_press(WrApp *app, const WrPointer *at)
{
    WrBrushState *hand = app->brush;
    if (app->hand->line) {
        hand->straight = true;
        hand->pressure = at->pressure;
        aim(app, at);
        return;
    }
    if (wr_keys_hold(app->keys, WR_ACT(hold_pick), at->mods)) {
        wr_brush_pick(app, at);
        return;
    }
    bool joins = wr_keys_hold(app->keys, WR_ACT(hold_size), at->mods) && hand->have_last;
    double u = hand->last_u, v = hand->last_v;
    WrBrush brush = wr_strokes_brush(app, at);
    if (!wr_strokes_begin(app, &brush, at)) {
        app->hand->grab = WR_GRAB_NONE;
        return;
    }
    wr_brush_steady_begin(app, at);
    if (joins) {
        double to_u, to_v;
        wr_view_to_uv(app->view, at->x, at->y, &to_u, &to_v);
        sample(app, at, u, v);
        straight_on(app, at, u, v, to_u, to_v);
    } else {
        draw_at(app, at);
    }
}

/* True at a border between copies that the tiling shifts: the table position jumps, so another stroke begins. Brick tilings
   shift every second row, half-drop ones every second column: only crossing an odd number of them jumps. */
static bool crosses(const WrApp *app, const WrPointer *at)
{
    const WrPointer *before = &app->hand->at;
    double u0, v0, u1, v1;
    if (app->view->tiling == WR_TILING_STRAIGHT) return false;
    wr_view_to_uv(app->view, before->x, before->y, &u0, &v0);
    wr_view_to_uv(app->view, at->x, at->y, &u1, &v1);
    if (app->view->tiling == WR_TILING_BRICK) return fmod(floor(v1) - floor(v0), 2.0) != 0.0;
    return fmod(floor(u1) - floor(u0), 2.0) != 0.0;
}

void wr_brush_drag(WrApp *app, const WrPointer *at)
{
    bool pulls = app->brush->steady.kind != WR_SMOOTHING_OFF;
    if (app->brush->drawing && !app->brush->straight && !pulls && crosses(app, at)) {
        WrBrush brush = wr_strokes_brush(app, at);
        wr_strokes_end(app);
        if (!wr_strokes_begin(app, &brush, at)) return;
        wr_brush_steady_begin(app, at);
        draw_at(app, at);
        return;
    }
    if (app->brush->straight) aim(app, at);
    else if (app->brush->drawing) wr_brush_steady_move(app, at, draw_at);
    else if (wr_keys_hold(app->keys, WR_ACT(hold_pick), at->mods)) wr_brush_pick(app, at);
}

void wr_brush_release(WrApp *app, const WrPointer *at)
{
    if (app->brush->straight) {
        app->brush->straight = false;
        draw_line(app, at);
        return;
    }
    if (!app->brush->drawing) return;
    wr_brush_steady_end(app, at, draw_at);
    wr_strokes_end(app);
}

void wr_brush_pick(WrApp *app, const WrPointer *at)
{
    const WrField *field = wr_app_field(app);
    double f, u = at->u, v = at->v;
    wr_field_sample(field, WR_SCHEME_NEAREST, 1, &u, &v, &f, NULL, NULL);
    app->settings->brush.to = f;
    app->settings->brush.mode = WR_BRUSH_TO;
    wr_app_redraw(app);
}

void wr_brush_resize(WrApp *app, const WrPointer *at)
{
    double grown = app->brush->resize_radius + (at->x - app->hand->start.x) / app->view->zoom;
    double largest = 16384.0;
    grown = grown < 0.5 ? 0.5 : grown > largest ? largest : grown;
    app->settings->brush.radius = grown < 10.0 ? rint(grown * 10.0) / 10.0 : rint(grown);
    wr_app_redraw(app);
}

/* ---- options ---- */

void wr_brush_options(WrApp *app)
{
    wr_option_brush_row(app, NULL, 0);
}

/* ---- the rows ---- */

const WrTool wr_tool_brush = { .action = WR_ACT(brush),
                               .icon = WR_ICON_BRUSH,
                               .help =
                                   "Paint heights. Ctrl+click picks a height, Shift+drag sizes the "
                                   "brush, Shift+click draws a straight line from the last stroke.",
                               .press = wr_brush_press,
                               .drag = wr_brush_drag,
                               .release = wr_brush_release,
                               .overlay = wr_brush_overlay,
                               .options = wr_brush_options,
                               .paints = true };

const WrTool wr_tool_smooth = { .action = WR_ACT(smooth),
                                .icon = WR_ICON_DROP,
                                .help = "Smooth heights under the brush; their mean stays.",
                                .press = wr_brush_press,
                                .drag = wr_brush_drag,
                                .release = wr_brush_release,
                                .overlay = wr_brush_overlay,
                                .options = wr_brush_options,
                                .paints = true,
                                .mode = 1 + WR_BRUSH_SMOOTH };

const WrTool wr_tool_smear = { .action = WR_ACT(smear),
                               .icon = WR_ICON_FINGER,
                               .help = "Drag heights along with the brush, as with a finger.",
                               .press = wr_brush_press,
                               .drag = wr_brush_drag,
                               .release = wr_brush_release,
                               .overlay = wr_brush_overlay,
                               .options = wr_brush_options,
                               .paints = true,
                               .mode = 1 + WR_BRUSH_SMEAR };

const WrTool wr_tool_pick = { .action = WR_ACT(pick),
                              .icon = WR_ICON_PICK,
                              .help = "Pick the height under the pointer and paint towards it.",
                              .press = wr_brush_pick,
                              .drag = wr_brush_pick,
                              .options = wr_brush_options,
                              .meanwhile = true };
