/* Rectangles and ellipses painted with the brush: a drag draws them on any copy of the cell, and across its edges.
   Shift makes squares and circles, Ctrl starts at the centre, Escape cancels. */
#include "ui/canvas/tools/tool_shape.h"
#include "ui/canvas/view.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/line.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/canvas/tools/brush_command_text.h"
#include "ui/canvas/tools/stroke_input.h"
#include "ui/canvas/tools/option_row.h"
#include "ui/canvas/tools/preset_browser.h"
#include "ui/canvas/tools/tool.h"
#include "ui/canvas/tools/tool_rows.h"
#include "ui/canvas/overlays/marks.h"

#include "base/text.h"
#include "brush/brush.h"
#include "brush/preset.h"
#include "brush/symmetry.h"
#include "field/select.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define ROUND_POINTS 96
#define LEAST_PIXELS 2.0

void wr_draw_brush_line(const WrApp *app, WrText *line, bool symmetric)
{
    const WrBrushSources *files = app->brush_files;
    WrBrush brush = wr_brush_now(app);
    WrBrush base = brush.preset ? wr_preset_brush(brush.preset) : wr_brush_default();
    WrBrushNames names = { files->preset, files->set, files->tip };
    if (!symmetric) brush.symmetry = (WrSymmetry){ 0 };
    wr_brush_line(line, &brush, &base, &names);
}

void wr_draw_leave(WrApp *app)
{
    app->draw->active = app->draw->closed = false;
    app->draw->anchors.count = 0;
    app->draw->held = -1;
    wr_app_redraw(app);
}

static bool is_round(const WrApp *app)
{
    return strcmp(wr_tool_now(app)->action, WR_ACT(shape_ellipse)) == 0;
}

/* The two corners, with the modifiers applied. */
static void corners(const WrApp *app, int mods, double box[4])
{
    const WrDrawState *draw = app->draw;
    double dx = draw->x1 - draw->x0, dy = draw->y1 - draw->y0;
    if (mods & WR_MOD_SHIFT) {
        double side = fmax(fabs(dx), fabs(dy));
        dx = copysign(side, dx);
        dy = copysign(side, dy);
    }
    bool middle = (mods & WR_MOD_CTRL) != 0;
    box[0] = middle ? draw->x0 - dx : draw->x0;
    box[1] = middle ? draw->y0 - dy : draw->y0;
    box[2] = draw->x0 + dx;
    box[3] = draw->y0 + dy;
}

static void press(WrApp *app, const WrPointer *at)
{
    WrDrawState *draw = app->draw;
    draw->active = true;
    wr_view_to_texel(app->view, at->x, at->y, &draw->x0, &draw->y0);
    draw->x1 = draw->x0;
    draw->y1 = draw->y0;
    app->hints = false;
    wr_app_redraw(app);
}

static void drag(WrApp *app, const WrPointer *at)
{
    wr_view_to_texel(app->view, at->x, at->y, &app->draw->x1, &app->draw->y1);
    wr_app_redraw(app);
}

static void add_pair(WrText *line, const char *name, double a, double b)
{
    wr_line_number(line, name, wr_line_round(a, 7));
    wr_text_add(line, ",");
    wr_text_add_number(line, wr_line_round(b, 7));
}

static void commit(WrApp *app, const double box[4])
{
    WrSelectPoint a = wr_overlay_uv(app, box[0], box[1]), b = wr_overlay_uv(app, box[2], box[3]);
    WrSelectPoint home = wr_overlay_wrap_offset(app, (a.u + b.u) / 2, (a.v + b.v) / 2);
    bool fills = app->settings->drawing.fills;
    WrText line = { 0 };
    a = (WrSelectPoint){ a.u + home.u, a.v + home.v };
    b = (WrSelectPoint){ b.u + home.u, b.v + home.v };
    if (is_round(app)) {
        wr_text_add(&line, "shape ellipse");
        add_pair(&line, "at", (a.u + b.u) / 2, (a.v + b.v) / 2);
        add_pair(&line, "radii", fabs(b.u - a.u) / 2, fabs(b.v - a.v) / 2);
    } else {
        wr_text_add(&line, "shape rectangle");
        add_pair(&line, "a", fmin(a.u, b.u), fmin(a.v, b.v));
        add_pair(&line, "b", fmax(a.u, b.u), fmax(a.v, b.v));
        if (app->settings->drawing.corner > 0.0)
            wr_line_number(&line, "corner", app->settings->drawing.corner);
    }
    wr_text_addf(&line, " paint=%s", fills ? "fill" : "outline");
    wr_draw_brush_line(app, &line, true);
    wr_app_run_slow(app, wr_text_get(&line));
    wr_text_fini(&line);
}

static void release(WrApp *app, const WrPointer *at)
{
    WrDrawState *draw = app->draw;
    double box[4];
    if (!draw->active) return;
    corners(app, at->mods, box);
    wr_draw_leave(app);
    double least = LEAST_PIXELS / app->view->zoom;
    if (fabs(box[2] - box[0]) < least || fabs(box[3] - box[1]) < least) return;
    commit(app, box);
}

static bool key(WrApp *app, SDL_Keycode key)
{
    if (key != SDLK_ESCAPE || !app->draw->active) return false;
    wr_draw_leave(app);
    app->hand->grab = WR_GRAB_NONE;
    return true;
}

static int round_points(const double box[4], const WrApp *app, WrSelectPoint *points)
{
    double mx = (box[0] + box[2]) / 2, my = (box[1] + box[3]) / 2;
    for (int i = 0; i < ROUND_POINTS; i++) {
        double a = 6.283185307179586 * i / ROUND_POINTS;
        points[i] = wr_overlay_uv(app, mx + (box[2] - mx) * cos(a), my + (box[3] - my) * sin(a));
    }
    return ROUND_POINTS;
}

static int rect_points(const double box[4], const WrApp *app, WrSelectPoint *points)
{
    double x0 = fmin(box[0], box[2]), x1 = fmax(box[0], box[2]);
    double y0 = fmin(box[1], box[3]), y1 = fmax(box[1], box[3]);
    double r = fmin(app->settings->drawing.corner, fmin(x1 - x0, y1 - y0) / 2);
    int count = 0;
    for (int corner = 0; corner < 4; corner++) {
        double mx = corner == 0 || corner == 3 ? x1 - r : x0 + r;
        double my = corner < 2 ? y1 - r : y0 + r;
        for (int k = 0; k <= 8; k++) {
            double a = 1.5707963267948966 * (corner + k / 8.0);
            points[count++] = wr_overlay_uv(app, mx + r * cos(a), my + r * sin(a));
        }
    }
    return count;
}

static void marks(WrApp *app)
{
    WrSelectPoint points[ROUND_POINTS];
    double box[4], x, y;
    if (!app->draw->active) return;
    corners(app, app->hand->mods, box);
    int count = is_round(app) ? round_points(box, app, points) : rect_points(box, app, points);
    wr_overlay_lines(app, points, count, true, 0xfff4f4f4u);
    char text[64];
    snprintf(text, sizeof text, "%.0f x %.0f", fabs(box[2] - box[0]), fabs(box[3] - box[1]));
    wr_view_to_pixel(app->view, (box[0] + box[2]) / 2, fmax(box[1], box[3]), &x, &y);
    wr_overlay_label(x, y + 14.0 * wr_gui_scale(), text);
}

/* ---- options ---- */

static void paint_what(WrApp *app, double width)
{
    static const char *const names[] = { "Outline", "Fill" };
    int index = app->settings->drawing.fills;
    (void)width;
    if (wr_gui_segments("paint", names, NULL, 2, &index)) app->settings->drawing.fills = index == 1;
}

static void corner(WrApp *app, double width)
{
    static const WrNumber spec = { .low = 0,
                                   .high = 100,
                                   .hard_high = 16384,
                                   .reset = 0,
                                   .decimals = 0,
                                   .unit = "px",
                                   .tip = "Radius of the rectangle's corners" };
    wr_gui_number("corner", width, &spec, &app->settings->drawing.corner);
}

void wr_shape_options(WrApp *app)
{
    bool rect = strcmp(wr_tool_now(app)->action, WR_ACT(shape_rect)) == 0;
    const WrOption first[] = { { "##Outline or filled", 0, 118, paint_what, true },
                               { "Corner", 74, 0, corner, rect } };
    wr_option_brush_row(app, first, 2);
}

/* ---- the rows ---- */

const WrTool wr_tool_shape_rect = {
    .action = WR_ACT(shape_rect),
    .icon = WR_ICON_BOX,
    .help = "Drag a rectangle: Shift makes it a square, Ctrl draws it from its centre.",
    .press = press,
    .drag = drag,
    .release = release,
    .marks = marks,
    .options = wr_shape_options,
    .key = key,
    .leave = wr_draw_leave,
    .meanwhile = true
};

const WrTool wr_tool_shape_ellipse = {
    .action = WR_ACT(shape_ellipse),
    .icon = WR_ICON_ROUND,
    .help = "Drag an ellipse: Shift makes it a circle, Ctrl draws it from its centre.",
    .press = press,
    .drag = drag,
    .release = release,
    .marks = marks,
    .options = wr_shape_options,
    .key = key,
    .leave = wr_draw_leave,
    .meanwhile = true
};
