/* Selection tools: a drag draws a shape on any copy of the cell, and across its edges. */
#include "ui/canvas/tools/tool_select.h"
#include "ui/canvas/view.h"
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/line.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/canvas/tools/tool.h"
#include "ui/canvas/tools/tool_rows.h"
#include "ui/canvas/overlays/snap_grid.h"
#include "ui/canvas/overlays/marks.h"

#include "base/array.h"
#include "base/enum_rows.h"
#include "base/text.h"
#include "document/document.h"
#include "field/field.h"
#include "field/select.h"
#include "image/image.h"

#include <math.h>
#include <string.h>

#define ELLIPSE_POINTS 96
#define CLICK_PIXELS 3.0

typedef enum Shape { SHAPE_RECT, SHAPE_ELLIPSE, SHAPE_LASSO } Shape;

static Shape shape_of(const WrApp *app)
{
    const char *name = wr_tool_now(app)->action;
    return strcmp(name, WR_ACT(select_ellipse)) == 0 ? SHAPE_ELLIPSE
           : strcmp(name, WR_ACT(select_lasso)) == 0 ? SHAPE_LASSO
                                                     : SHAPE_RECT;
}

static void texel_at(const WrApp *app, const WrPointer *at, double *x, double *y)
{
    wr_view_to_texel(app->view, at->x, at->y, x, y);
}

static WrSelectPoint point_of(const WrApp *app, double x, double y)
{
    return (WrSelectPoint){ x / app->view->table_w, 1.0 - y / app->view->table_h };
}

/* ---- the shape ---- */

static void put_rect(WrApp *app, double x0, double y0, double x1, double y1)
{
    WrSelectState *hand = app->select;
    hand->points.count = 0;
    wr_array_push(&hand->points, point_of(app, x0, y0));
    wr_array_push(&hand->points, point_of(app, x1, y0));
    wr_array_push(&hand->points, point_of(app, x1, y1));
    wr_array_push(&hand->points, point_of(app, x0, y1));
}

static void put_ellipse(WrApp *app, double x0, double y0, double x1, double y1)
{
    WrSelectState *hand = app->select;
    hand->points.count = 0;
    for (int i = 0; i < ELLIPSE_POINTS; i++) {
        double a = 6.28318530717958648 * i / ELLIPSE_POINTS;
        wr_array_push(&hand->points, point_of(app, (x0 + x1) / 2 + (x1 - x0) / 2 * cos(a),
                                              (y0 + y1) / 2 + (y1 - y0) / 2 * sin(a)));
    }
}

/* The sides of a dragged rectangle, on texel borders. Sides on whole texels: the selection is then exactly 0 or 1 at every
   texel, without a soft edge. */
static void corners(const WrApp *app, const WrPointer *at, double box[4])
{
    double x, y;
    texel_at(app, at, &x, &y);
    box[0] = rint(wr_grid_snap(app, 0, app->select->x));
    box[1] = rint(wr_grid_snap(app, 1, app->select->y));
    box[2] = rint(wr_grid_snap(app, 0, x));
    box[3] = rint(wr_grid_snap(app, 1, y));
}

static void follow(WrApp *app, const WrPointer *at)
{
    double box[4], x, y;
    Shape shape = shape_of(app);
    if (shape == SHAPE_LASSO) {
        texel_at(app, at, &x, &y);
        if (app->select->points.count < WR_SELECT_POINTS)
            wr_array_push(&app->select->points, point_of(app, x, y));
        return;
    }
    corners(app, at, box);
    if (shape == SHAPE_RECT) put_rect(app, box[0], box[1], box[2], box[3]);
    else put_ellipse(app, box[0], box[1], box[2], box[3]);
}

/* ---- dragging ---- */

static void press(WrApp *app, const WrPointer *at)
{
    WrSelectState *hand = app->select;
    bool shift = (at->mods & WR_MOD_SHIFT) != 0, alt = (at->mods & WR_MOD_ALT) != 0;
    hand->active = true;
    hand->mode = shift && alt ? WR_SELECT_INTERSECT
                 : shift      ? WR_SELECT_ADD
                 : alt        ? WR_SELECT_SUBTRACT
                              : (WrSelectMode)app->settings->join;
    hand->points.count = 0;
    texel_at(app, at, &hand->x, &hand->y);
    app->hints = false;
    wr_image_warm_writing(); /* prepare for a copy of the selection */
    follow(app, at);
    wr_app_redraw(app);
}

static void drag(WrApp *app, const WrPointer *at)
{
    if (!app->select->active) return;
    follow(app, at);
    wr_app_redraw(app);
}

void wr_select_cancel(WrApp *app)
{
    app->select->active = false;
    wr_array_free(&app->select->points);
    wr_app_redraw(app);
}

/* Shift by whole cells that moves the first point into the cell. */
static WrSelectPoint home(const WrApp *app)
{
    WrSelectPoint first = app->select->points.data[0];
    const WrField *field = wr_app_field(app);
    return (WrSelectPoint){ wr_field_wrap_u(field) == WR_WRAP_PERIODIC ? -floor(first.u) : 0.0,
                            wr_field_wrap_v(field) == WR_WRAP_PERIODIC ? -floor(first.v) : 0.0 };
}

static double reach(double x)
{
    return x < -WR_SELECT_REACH ? -WR_SELECT_REACH : x > WR_SELECT_REACH ? WR_SELECT_REACH : x;
}

static void add_point(WrText *line, double u, double v)
{
    wr_text_add_number(line, wr_line_round(reach(u), 9));
    wr_text_add(line, ",");
    wr_text_add_number(line, wr_line_round(reach(v), 9));
}

static void write_lasso(const WrApp *app, WrSelectPoint shift, WrText *line)
{
    const WrSelectState *hand = app->select;
    wr_text_add(line, "select lasso points=");
    for (int i = 0; i < hand->points.count; i++) {
        if (i) wr_text_add(line, ";");
        add_point(line, hand->points.data[i].u + shift.u, hand->points.data[i].v + shift.v);
    }
}

static void write_box(const WrApp *app, const WrPointer *at, WrSelectPoint shift, WrText *line)
{
    double box[4];
    corners(app, at, box);
    WrSelectPoint a = point_of(app, box[0], box[1]), b = point_of(app, box[2], box[3]);
    a = (WrSelectPoint){ a.u + shift.u, a.v + shift.v };
    b = (WrSelectPoint){ b.u + shift.u, b.v + shift.v };
    if (shape_of(app) == SHAPE_RECT) {
        wr_text_add(line, "select rect from=");
        add_point(line, a.u, a.v);
        wr_text_add(line, " to=");
        add_point(line, b.u, b.v);
    } else {
        wr_text_add(line, "select ellipse at=");
        add_point(line, (a.u + b.u) / 2, (a.v + b.v) / 2);
        wr_text_add(line, " radii=");
        add_point(line, fabs(b.u - a.u) / 2, fabs(b.v - a.v) / 2);
    }
}

/* A click without a drag clears the selection, as in other paint programs. */
static bool is_click(const WrApp *app, const WrPointer *at)
{
    bool near_by = fabs(at->x - app->hand->start.x) < CLICK_PIXELS &&
                   fabs(at->y - app->hand->start.y) < CLICK_PIXELS;
    if (shape_of(app) == SHAPE_LASSO) return near_by && app->select->points.count < 8;
    double box[4];
    corners(app, at, box);
    return near_by || box[0] == box[2] || box[1] == box[3];
}

static void release(WrApp *app, const WrPointer *at)
{
    WrSelectState *hand = app->select;
    if (!hand->active) return;
    WrText line = { 0 };
    bool click = is_click(app, at) || (shape_of(app) == SHAPE_LASSO && hand->points.count < 3);
    if (!click) {
        WrSelectPoint shift = home(app);
        if (shape_of(app) == SHAPE_LASSO) write_lasso(app, shift, &line);
        else write_box(app, at, shift, &line);
        if (hand->mode != WR_SELECT_REPLACE)
            wr_text_addf(&line, " mode=%s", wr_select_modes[hand->mode]);
    } else if (hand->mode == WR_SELECT_REPLACE && wr_app_document(app)->selection) {
        wr_text_add(&line, "select none");
    }
    wr_select_cancel(app);
    if (line.length) wr_app_run_line(app, wr_text_get(&line));
    wr_text_fini(&line);
}

static void options(WrApp *app)
{
    WR_ROWS(joins);
    static const char *const joins[WR_SELECT_MODES] = { [WR_ROW(WR_SELECT_REPLACE)] = "Replace",
                                                        [WR_ROW(WR_SELECT_ADD)] = "Add",
                                                        [WR_ROW(WR_SELECT_SUBTRACT)] = "Subtract",
                                                        [WR_ROW(WR_SELECT_INTERSECT)] =
                                                            "Intersect" };
    WR_ROWS_END(joins, WR_SELECT_MODES);
    wr_gui_same_line(14);
    wr_gui_segments("join", joins, NULL, WR_SELECT_MODES, &app->settings->join);
    wr_gui_tip("Shift adds, Alt subtracts, both intersect");
    static const char *const names[] = { WR_ACT(select_all), WR_ACT(select_none),
                                         WR_ACT(select_invert) };
    wr_gui_same_line(16);
    for (int i = 0; i < 3; i++) {
        const WrAction *action = wr_action_find(app, names[i]);
        wr_gui_disable(!wr_action_can(app, action));
        if (wr_gui_chip(NULL, action->label)) wr_action_run(app, names[i]);
        wr_gui_disable_end();
        wr_gui_same_line(6);
    }
    if (app->width < wr_gui_px(1100)) return;
    wr_gui_same_line(16);
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL,
                "Shift adds, Alt subtracts, both intersect; a click selects nothing");
}

/* ---- the rows ---- */

const WrTool wr_tool_select_rect = {
    .action = WR_ACT(select_rect),
    .icon = WR_ICON_RECT,
    .help = "Drag a rectangle, across the cell's edges if needed, which limits edits.",
    .press = press,
    .drag = drag,
    .release = release,
    .options = options
};

const WrTool wr_tool_select_ellipse = { .action = WR_ACT(select_ellipse),
                                        .icon = WR_ICON_ELLIPSE,
                                        .help = "Drag an ellipse, which limits edits.",
                                        .press = press,
                                        .drag = drag,
                                        .release = release,
                                        .options = options };

const WrTool wr_tool_select_lasso = { .action = WR_ACT(select_lasso),
                                      .icon = WR_ICON_LASSO,
                                      .help = "Draw an outline by hand, which limits edits.",
                                      .press = press,
                                      .drag = drag,
                                      .release = release,
                                      .options = options };

static void another(WrApp *app)
{
    wr_select_cancel(app);
}

const WrPart wr_part_select = { .another = another };
