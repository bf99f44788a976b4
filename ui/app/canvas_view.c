/* The table's view: its picture, and what lies on it. */
#include "ui/app/canvas_view.h"
#include "base/rows.h"
#include "ui/canvas/canvas.h"
#include "ui/canvas/canvas_map.h"
#include "ui/canvas/view.h"
#include "ui/desk/desk.h"
#include "ui/desk/document.h"
#include "ui/desk/hand.h"
#include "ui/desk/layout.h"
#include "ui/desk/roster.h"
#include "ui/desk/session_view.h"
#include "ui/desk/settings.h"
#include "ui/gui/gui.h"
#include "ui/gui/theme.h"
#include "ui/preview/preview.h"
#include "ui/tools/stroke_hand.h"
#include "ui/tools/symmetry.h"
#include "ui/tools/tool.h"
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

#define MEANS_BUDGET 0.012 /* seconds a picture may take for the means of large tables */
#define GRID_FROM 8.0      /* zoom from which texels get a grid */

/* The range rests when the table does. */
static bool is_held(const WrApp *app)
{
    return app->hand->grab != WR_GRAB_NONE || app->brush->jobs.count > 0;
}

/* Maps that can be shown: which, in which colours, and over which range. */
typedef struct Shown {
    const char *name;
    WrFieldMapKind kind;
    WrCanvasColours colours;
    double low, high; /* low 0 and high 0: from the lowest number of the map to 0 */
} Shown;

static const Shown shown[WR_CANVAS_SHOWN] = {
    [WR_CANVAS_HEIGHTS] = { .name = "Heights" },
    [WR_CANVAS_OCCLUSION] = { "Occlusion", WR_FIELD_MAP_OCCLUSION, WR_CANVAS_GREY, 0, 1 },
    [WR_CANVAS_CAVITY] = { "Cavity", WR_FIELD_MAP_CAVITY, WR_CANVAS_GREY, 0, 0 },
    [WR_CANVAS_CURVATURE] = { "Curvature", WR_FIELD_MAP_CURVATURE, WR_CANVAS_SIGNED, -0.2, 0.2 },
    [WR_CANVAS_SLOPE] = { "Steepness", WR_FIELD_MAP_SLOPE, WR_CANVAS_GREY, 0, 90 },
    [WR_CANVAS_ROUGHNESS] = { "Roughness", WR_FIELD_MAP_ROUGHNESS, WR_CANVAS_GREY, 0, 1 },
};

/* The map that is wanted in the table's place; NULL: none, or none yet. */
static const WrField *map_of(WrApp *app, const WrField *field)
{
    const WrScene *scene = wr_app_document(app)->scene;
    const WrCanvasShown now = app->settings->look.shown;
    if (now == WR_CANVAS_HEIGHTS || wr_app_shows_mask(app)) return NULL;
    const WrGround ground = { NULL,          NULL,         scene->scheme, wr_scene_relief(scene),
                              scene->cell.w, scene->cell.h };
    WrMapJob job = wr_map_default(&ground);
    job.directions = 8; /* near things only, so that little is made anew while it is painted */
    job.reach = 48;
    return wr_canvas_map_bring(app->canvas_map, field, shown[now].kind, &job);
}

void wr_canvas_view_draw(WrApp *app)
{
    if (app->layout->canvas.w <= 0) return;
    const WrField *field = wr_app_canvas_field(app), *map = map_of(app, field);
    WrCanvasLook look = app->settings->look;
    if (map) {
        const Shown *now = &shown[look.shown];
        look.colours = now->colours;
        const double lowest = app->map_range->table_low;
        look.automatic = look.marks = false;
        look.low = now->low, look.high = now->high;
        if (look.low == look.high) look.low = lowest < 0 ? lowest : -1;
    }
    if (wr_app_shows_mask(app))
        look = (WrCanvasLook){ .colours = WR_CANVAS_GREY, .low = 0.0, .high = 1.0 };
    WrCanvasRange range;
    app->canvas_unfinished =
        wr_canvas_draw(app->canvas, app->renderer, app->view, map ? map : field, &look,
                       is_held(app), MEANS_BUDGET, &range);
    app->map_shown = map != NULL;
    if (map && range.table_low != app->map_range->table_low) wr_app_redraw(app);
    if (map) *app->map_range = range;
    else *app->range = range;
    if (app->canvas_unfinished) wr_app_redraw(app);
    wr_marks_draw(app);
}

/* Lines between texels, faint: dark on light and light on dark. */
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

/* The real cell. */
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

/* Where the pointer on the patch is in the table. */
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
    static const char *const lines[] = { "Drag to paint", "[ and ] change the size",
                                         "Drag the patch to turn it" };
    const SDL_Rect *room = &app->layout->canvas;
    double s = wr_gui_scale(), pad = 10 * s, gap = 6 * s, h = wr_gui_line_height(WR_FONT_TEXT);
    double wide = 0;
    for (int i = 0; i < 3; i++) wide = fmax(wide, wr_gui_text_width(WR_FONT_TEXT, lines[i]));
    double tall = 3 * h + 2 * gap + 2 * pad;
    double x = room->x + 12 * s, y = room->y + room->h - 12 * s - tall;
    wr_gui_draw_fill(x, y, wide + 2 * pad, tall, WR_COLOUR_CHIP, 4 * s);
    for (int i = 0; i < 3; i++)
        wr_gui_draw_text(x + pad, y + pad + i * (h + gap), WR_FONT_TEXT, WR_COLOUR_TEXT, lines[i]);
}

/* ---- the range, in a popup of the chip ---- */

/* All heights that there are or that are shown, lowest first, in the colours that they have on the canvas: so
   what lies beyond the range is seen at its ends. */
static void ramp(const WrApp *app, const char *id, double wide, double tall)
{
    const WrCanvasRange *r = app->map_shown ? app->map_range : app->range;
    double low = fmin(r->low, r->table_low), high = fmax(r->high, r->table_high);
    WrPad pad = wr_gui_pad_begin(id, wide, tall);
    for (int x = 0; x < (int)pad.w; x++) {
        double height = low + (high - low) * (x + 0.5) / pad.w;
        wr_gui_draw_fill(pad.x + x, pad.y, 1, pad.h, wr_canvas_colour(app->canvas, height), 0);
    }
    wr_gui_pad_end();
}

static void ramp_tip(const WrApp *app)
{
    const WrCanvasRange *r = app->map_shown ? app->map_range : app->range;
    char tip[160];
    bool beyond = r->table_low < r->low || r->table_high > r->high;
    snprintf(tip, sizeof tip, "The %s goes from %.4g to %.4g%s", app->map_shown ? "map" : "table",
             r->table_low, r->table_high,
             beyond ? ": some of it lies beyond the range that is shown" : "");
    wr_gui_tip(tip);
}

static bool is_unit(const WrCanvasLook *look)
{
    return !look->automatic && look->low == 0.0 && look->high == 1.0;
}

static void choose_way(WrApp *app, int way)
{
    WrCanvasLook *look = &app->settings->look;
    look->automatic = way == 0;
    if (way == 0) return;
    look->low = way == 1 ? 0.0 : app->range->low;
    look->high = way == 1 ? 1.0 : app->range->high;
}

static void range_popup(WrApp *app)
{
    WR_ROWS(looks);
    static const char *const looks[] = { [WR_ROW(WR_CANVAS_GREY)] = "Grey",
                                         [WR_ROW(WR_CANVAS_SIGNED)] = "Signed" };
    WR_ROWS_END(looks, WR_CANVAS_COLOURS);
    static const char *const ways[] = { "As the table", "0 to 1", "As it is now" };
    const char *maps[WR_CANVAS_SHOWN];
    WrCanvasLook *look = &app->settings->look;
    int chosen = (int)look->colours, now = (int)look->shown,
        way = look->automatic ? 0
              : is_unit(look) ? 1
                              : 2;
    if (!wr_gui_popup_begin("range")) return;
    for (int i = 0; i < WR_CANVAS_SHOWN; i++) maps[i] = shown[i].name;
    if (wr_gui_segments("shown", maps, NULL, WR_CANVAS_SHOWN, &now))
        look->shown = (WrCanvasShown)now;
    wr_gui_tip("The table itself, or a map of it that follows the brush");
    if (look->shown != WR_CANVAS_HEIGHTS) {
        ramp(app, "wide", wr_gui_px(240), wr_gui_px(12));
        ramp_tip(app);
        wr_gui_popup_end();
        return;
    }
    if (wr_gui_segments("look", looks, NULL, WR_CANVAS_COLOURS, &chosen))
        look->colours = (WrCanvasColours)chosen;
    if (wr_gui_segments("way", ways, NULL, 3, &way)) choose_way(app, way);
    ramp(app, "wide", wr_gui_px(240), wr_gui_px(12));
    ramp_tip(app);
    wr_gui_check("Mark what lies beyond", &look->marks);
    wr_gui_tip("Warm above the range, cool below it");
    double field = 120 * wr_gui_scale();
    WrNumber low = { .low = -1,
                     .high = 1,
                     .hard_low = -1e30,
                     .hard_high = look->high - 1e-6,
                     .reset = 0,
                     .decimals = 3,
                     .tip = "Height shown as black" };
    WrNumber high = { .low = 0,
                      .high = 2,
                      .hard_low = look->low + 1e-6,
                      .hard_high = 1e30,
                      .reset = 1,
                      .decimals = 3,
                      .tip = "Height shown as white" };
    wr_gui_disable(look->automatic);
    double l = app->range->low, h = app->range->high;
    wr_gui_label("Black");
    if (wr_gui_number("low", field, &low, &l) && l < look->high) look->low = l;
    wr_gui_label("White");
    if (wr_gui_number("high", field, &high, &h) && h > look->low) look->high = h;
    wr_gui_enable();
    wr_gui_popup_end();
}

static void chips(WrApp *app)
{
    const SDL_Rect *room = &app->layout->canvas;
    int gap = wr_gui_px(12);
    char text[96];
    const WrCanvasLook *look = &app->settings->look;
    const WrCanvasRange *range = app->map_shown ? app->map_range : app->range;
    snprintf(text, sizeof text, "%s %.3g \xe2\x80\x93 %.3g",
             wr_app_shows_mask(app)            ? "Mask"
             : app->map_shown                  ? shown[look->shown].name
             : look->colours == WR_CANVAS_GREY ? "Grey"
                                               : "Signed",
             range->low, range->high);
    wr_gui_overlay_begin("##range", room->x + gap, room->y + gap, 0, 0);
    if (wr_gui_chip(WR_ICON_DOWN, text)) wr_gui_popup_open("range");
    wr_gui_tip("What is shown, and which numbers are black and white");
    /* Beside it, as long as the square at the right end has its place. */
    if (room->w > wr_gui_text_width(WR_FONT_TEXT, text) + wr_gui_px(180)) {
        wr_gui_same_line(6);
        ramp(app, "narrow", wr_gui_px(64), wr_gui_line_height(WR_FONT_TEXT));
        ramp_tip(app);
    }
    range_popup(app);
    wr_gui_overlay_end();
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
    if (app->hints && app->file->starter) hints(app);
    wr_gui_draw_unclip();
    if (room->w > wr_gui_px(140)) chips(app);
    wr_panel_symmetry(app);
    if (room->w > wr_gui_px(240)) wr_panel_seam(app);
}

/* ---- the view ---- */

void wr_app_place_view(WrApp *app)
{
    WrCanvasView *view = app->view;
    const SDL_Rect *room = &app->layout->canvas;
    const WrField *field = wr_app_field(app);
    int w = wr_field_width(field), h = wr_field_height(field);
    if (w != view->table_w || h != view->table_h) app->view_placed = false;
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
    wr_view_fit(view, 0.36); /* with enough of the copies around it that seams are seen */
    app->view_placed = true;
}

/* ---- the part ---- */

static void draw(WrApp *app)
{
    wr_app_place_view(app);
    wr_canvas_view_draw(app);
}

static void forget(WrApp *app)
{
    wr_canvas_forget(app->canvas);
}

static bool works(WrApp *app)
{
    return wr_canvas_map_busy(app->canvas_map);
}

const WrPart wr_part_canvas = { .draw = draw, .works = works, .forget = forget };
