/* Canvas view: the table's picture and overlays. */
#include "ui/app/canvas_view.h"
#include "ui/app/canvas_chip.h"
#include "base/enum_rows.h"
#include "ui/canvas/canvas.h"
#include "ui/canvas/canvas_derived_map.h"
#include "ui/canvas/view.h"
#include "ui/state/action_list.h"
#include "ui/state/app_state.h"
#include "ui/state/document.h"
#include "ui/state/input_router.h"
#include "ui/state/keys.h"
#include "ui/state/layout.h"
#include "ui/state/roster.h"
#include "ui/state/session_view.h"
#include "ui/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/preview/preview.h"
#include "ui/tools/stroke_input.h"
#include "ui/tools/symmetry.h"
#include "ui/tools/tool.h"
#include "ui/tools/tool_stamp.h"
#include "ui/views/grid.h"
#include "ui/views/marks.h"
#include "ui/views/panel_seam.h"

#include "document/document.h"
#include "field/field.h"
#include "scene/scene.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define MEANS_BUDGET 0.012 /* time limit in seconds for averaging a large table in one frame */
#define GRID_FROM 8.0      /* zoom from which a pixel grid is drawn */

static WrRangeHold range_hold(const WrApp *app)
{
    if (app->stamp->trying) return WR_RANGE_STAYS;
    const bool held = app->hand->grab != WR_GRAB_NONE || app->brush->jobs.count > 0;
    return held ? WR_RANGE_WIDENS : WR_RANGE_RESTS;
}

/* The requested map in place of the table; NULL: none, or not ready. second: its second component, or NULL. */
static const WrField *map_of(WrApp *app, const WrField *field, const WrField **second)
{
    *second = NULL;
    const WrScene *scene = wr_app_document(app)->scene;
    const WrCanvasShown now = app->settings->look.shown;
    if (now == WR_CANVAS_HEIGHTS || wr_app_shows_mask(app)) return NULL;
    const WrDerivatives ground = { NULL,          NULL,
                                   scene->scheme, wr_scene_relief(scene),
                                   scene->cell.w, scene->cell.h };
    WrMapJob job = wr_map_default(&ground);
    job.directions = 8; /* short range only, so that a dab changes a small region */
    job.reach = 48;
    const WrField *map =
        wr_canvas_map_update(app->canvas_map, field, wr_canvas_maps[now].kind, &job);
    if (!wr_canvas_maps[now].two) return map;
    *second = wr_canvas_map_update(app->canvas_second, field, WR_FIELD_MAP_SLOPE_V, &job);
    return *second ? map : NULL;
}

void wr_canvas_view_draw(WrApp *app)
{
    if (app->layout->canvas.w <= 0) return;
    const WrField *second, *field = wr_app_canvas_field(app), *map = map_of(app, field, &second);
    WrCanvasLook look = app->settings->look;
    if (map) {
        const WrCanvasMapRow *now = &wr_canvas_maps[look.shown];
        look.colours = now->colours;
        const double lowest = app->map_range->table_low;
        look.automatic = look.marks = false;
        look.low = now->low, look.high = now->high;
        if (look.low == look.high) look.low = lowest < 0 ? lowest : -1;
    }
    if (wr_app_shows_mask(app))
        look = (WrCanvasLook){ .colours = WR_CANVAS_GREY, .low = 0.0, .high = 1.0 };
    double x, y,
        zoom = app->view->zoom; /* the light is fixed to the screen when the canvas is rotated */
    wr_view_step_back(app->view, look.light_x * zoom, -look.light_y * zoom, &x, &y);
    look.light_x = x;
    look.light_y = -y;
    WrCanvasRange range;
    app->canvas_unfinished =
        wr_canvas_draw(app->canvas, wr_gui_kept(app->gui), app->view, map ? map : field,
                       map ? second : NULL, &look, range_hold(app), MEANS_BUDGET, &range);
    app->map_shown = map != NULL;
    if (map && range.table_low != app->map_range->table_low) wr_app_redraw(app);
    if (map) *app->map_range = range;
    else *app->range = range;
    if (app->canvas_unfinished) wr_app_redraw(app);
    wr_marks_draw(app);
}

/* Faint lines between texels: dark on light and light on dark. */
static void pixel_grid(const WrApp *app)
{
    const WrCanvasView *v = app->view;
    double low[2], high[2];
    if (v->zoom < GRID_FROM) return;
    wr_view_bounds(v, low, high);
    for (int axis = 0; axis < 2; axis++)
        for (double at = ceil(low[axis]); at <= high[axis]; at += 1.0)
            wr_grid_line(v, axis, at, low, high, 0x30808080u);
}

/* Outline of the cell. */
static void cell_outline(const WrApp *app)
{
    const WrCanvasView *v = app->view;
    double x[4], y[4], line = wr_gui_px(1);
    for (int k = 0; k < 4; k++)
        wr_view_place(v, k == 1 || k == 2 ? v->table_w : 0, k >= 2 ? v->table_h : 0, &x[k], &y[k]);
    for (int pass = 0; pass < 2; pass++) {
        WrColour colour = pass ? WR_COLOUR_CELL : 0x90000000u;
        double wide = pass ? line : 3.0 * line, left = rint(fmin(x[0], x[2])), top = rint(y[0]);
        if (v->turn == 0.0)
            wr_gui_draw_rect(left, top, rint(fmax(x[0], x[2])) - left, rint(y[2]) - top, colour,
                             wide);
        for (int k = 0; k < 4 && v->turn != 0.0; k++)
            wr_gui_draw_line(x[k], y[k], x[(k + 1) % 4], y[(k + 1) % 4], colour, wide * 1.2);
    }
}

/* Mark the patch pointer's position in the table. */
static void patch_mark(const WrApp *app)
{
    double u, v, x, y, s = wr_gui_scale();
    if (!app->hand->on_patch || app->hand->grab != WR_GRAB_NONE) return;
    if (!wr_preview_point_hit(app->preview, &u, &v)) return;
    const WrScene *scene = wr_app_scene(app);
    double tu = wr_field_reduce(u, scene->replicate_u), tv = wr_field_reduce(v, scene->replicate_v);
    wr_view_to_pixel(app->view, tu * app->view->table_w, (1.0 - tv) * app->view->table_h, &x, &y);
    wr_gui_draw_circle(x, y, 6.0 * s, 0xb0000000u, 3.0 * s);
    wr_gui_draw_circle(x, y, 6.0 * s, WR_COLOUR_ACCENT, 1.5 * s);
}

static void hints(WrApp *app)
{
    const char *lines[3] = { "Drag to paint", "Drag the patch to turn it" };
    char down[32], up[32], size[120];
    int count = 2;
    wr_keys_label(app->keys, WR_ACT(size_down), down);
    wr_keys_label(app->keys, WR_ACT(size_up), up);
    snprintf(size, sizeof size, wr_words("%s and %s change the size"), down, up);
    if (down[0] && up[0]) lines[count++] = size; /* not on every keyboard */
    const SDL_Rect *room = &app->layout->canvas;
    double s = wr_gui_scale(), pad = 10 * s, gap = 6 * s, h = wr_gui_line_height(WR_FONT_TEXT);
    double wide = 0;
    for (int i = 0; i < count; i++) wide = fmax(wide, wr_gui_text_width(WR_FONT_TEXT, lines[i]));
    double tall = count * h + (count - 1) * gap + 2 * pad;
    double x = room->x + 12 * s, y = room->y + room->h - 12 * s - tall;
    wr_gui_draw_fill(x, y, wide + 2 * pad, tall, WR_COLOUR_CHIP, 4 * s);
    for (int i = 0; i < count; i++)
        wr_gui_draw_text(x + pad, y + pad + i * (h + gap), WR_FONT_TEXT, WR_COLOUR_TEXT, lines[i]);
}

void wr_canvas_view_overlay(WrApp *app)
{
    const SDL_Rect *room = &app->layout->canvas;
    if (room->w <= 0) return;
    wr_gui_draw_clip(*room);
    pixel_grid(app);
    wr_grid_draw(app);
    cell_outline(app);
    patch_mark(app);
    const WrTool *tool = wr_tool_now(app);
    bool panning = app->hand->grab == WR_GRAB_PAN || app->hand->space;
    wr_symmetry_marks(app);
    if (app->hand->on_canvas && tool->overlay && !panning) tool->overlay(app);
    if (tool->marks) tool->marks(app);
    wr_strokes_marks(app);
    if (app->hints && app->file->starter) hints(app);
    wr_gui_draw_unclip();
    if (room->w > wr_gui_px(140)) wr_canvas_chip(app);
    wr_panel_symmetry(app);
    if (room->w > wr_gui_px(240)) wr_panel_seam_meter(app);
}

/* ---- the view ---- */

#define FIT_MARGIN 0.36 /* margin around the cell, so that seams are visible */

/* True if the user has not zoomed or moved the view since it was fitted. */
static bool is_fitted(const WrCanvasView *view)
{
    WrCanvasView fitted = *view;
    wr_view_fit(&fitted, FIT_MARGIN);
    return fitted.zoom == view->zoom && fitted.centre_x == view->centre_x &&
           fitted.centre_y == view->centre_y;
}

void wr_app_place_view(WrApp *app)
{
    WrCanvasView *view = app->view;
    const SDL_Rect *room = &app->layout->canvas;
    const WrField *field = wr_app_field(app);
    int w = wr_field_width(field), h = wr_field_height(field);
    if (w != view->table_w || h != view->table_h) app->view_placed = false;
    if ((room->w != view->w || room->h != view->h) && room->w > 0 && app->view_placed &&
        app->hand->grab == WR_GRAB_NONE && is_fitted(view))
        app->view_placed = false; /* the window's size has changed: fit again */
    view->x = room->x;
    view->y = room->y;
    view->w = room->w > 0 ? room->w : 1;
    view->h = room->h > 0 ? room->h : 1;
    view->table_w = w;
    view->table_h = h;
    bool wraps =
        wr_field_wrap_u(field) == WR_WRAP_PERIODIC && wr_field_wrap_v(field) == WR_WRAP_PERIODIC;
    view->tiling = wraps ? app->settings->tiling : WR_TILING_STRAIGHT;
    if (app->view_placed || room->w == 0) return;
    wr_view_fit(view, FIT_MARGIN);
    app->view_placed = true;
}

/* ---- component ---- */

static void draw(WrApp *app)
{
    wr_app_place_view(app);
    wr_canvas_view_draw(app);
}

static void forget(WrApp *app)
{
    wr_canvas_forget(app->canvas);
}

static void another(WrApp *app)
{
    wr_canvas_fit_range(app->canvas);
}

static bool works(WrApp *app)
{
    return wr_canvas_map_busy(app->canvas_map) || wr_canvas_map_busy(app->canvas_second);
}

const WrPart wr_part_canvas = {
    .draw = draw, .works = works, .another = another, .forget = forget
};
