/* Canvas view: the table's picture and overlays. */
#include "ui/app/canvas_view.h"
#include "ui/app/jobs/edit_preview.h"
#include "ui/canvas/canvas.h"
#include "ui/canvas/canvas_colors.h"
#include "ui/app/state/action.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/canvas/canvas_derived_map.h"
#include "ui/canvas/view.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/document.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/registry.h"
#include "ui/patch/preview/preview.h"
#include "ui/canvas/tools/stroke_input.h"
#include "ui/canvas/tools/layer_points.h"
#include "ui/canvas/tools/symmetry.h"
#include "ui/canvas/tools/tool.h"
#include "ui/canvas/tools/tool_stamp.h"
#include "ui/canvas/overlays/snap_grid.h"
#include "ui/canvas/overlays/marks.h"
#include "ui/canvas/overlays/panel_seam.h"

#include "base/enum_rows.h"
#include "document/document.h"
#include "field/field.h"
#include "field/maps.h"
#include "scene/scene.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define RAMP_ROOM 0.25 /* of the table's range, shown on both sides of it */

/* ---- range popup: displays and range of greys ---- */

const WrCanvasMapRow wr_canvas_maps[WR_CANVAS_SHOWN] = {
    [WR_CANVAS_HEIGHTS] = { .name = "Heights" },
    [WR_CANVAS_OCCLUSION] = { "Occlusion", WR_FIELD_MAP_OCCLUSION, WR_CANVAS_GREY, 0, 1 },
    [WR_CANVAS_CAVITY] = { "Cavity", WR_FIELD_MAP_CAVITY, WR_CANVAS_GREY, 0, 0 },
    [WR_CANVAS_CURVATURE] = { "Curvature", WR_FIELD_MAP_CURVATURE, WR_CANVAS_SIGNED, -0.2, 0.2 },
    [WR_CANVAS_SLOPE] = { "Steepness", WR_FIELD_MAP_SLOPE, WR_CANVAS_GREY, 0, 90 },
    [WR_CANVAS_ROUGHNESS] = { "Roughness", WR_FIELD_MAP_ROUGHNESS, WR_CANVAS_GREY, 0, 1 },
    [WR_CANVAS_LIT] = { "Relief", WR_FIELD_MAP_SLOPE_U, WR_CANVAS_RELIEF, 0, 1, true },
    [WR_CANVAS_BENT] = { "Normals", WR_FIELD_MAP_SLOPE_U, WR_CANVAS_NORMALS, 0, 1, true },
};

WR_ROWS(looks);
static const char *const looks[] = { [WR_ROW(WR_CANVAS_GREY)] = "Grey",
                                     [WR_ROW(WR_CANVAS_SIGNED)] = "Signed",
                                     [WR_ROW(WR_CANVAS_CONTOURS)] = "Contours" };
WR_ROWS_END(looks, WR_CANVAS_LOOKS);

static const WrCanvasRange *shown_range(const WrApp *app)
{
    return app->map_shown ? app->map_range : app->range;
}

/* Move the nearer end of a range to a height, keeping black below white. */
static void drag_end(WrCanvasDisplay *look, const WrCanvasRange *r, double height, double least)
{
    const int end = fabs(height - r->high) < fabs(height - r->low);
    look->low = r->low;
    look->high = r->high;
    look->automatic[end] = false;
    if (end) look->high = fmax(height, r->low + least);
    else look->low = fmin(height, r->high - least);
}

/* Colour ramp over the table's heights and a bit beyond, lowest first, in the canvas colours. Dragging moves the nearer
   end of the range. The ramp's own ends are independent of the range: it does not move under the pointer. */
static void ramp(WrApp *app, const char *id, double wide, double tall)
{
    const WrCanvasRange *r = shown_range(app);
    const double span = r->table_high > r->table_low ? r->table_high - r->table_low : 1.0;
    const double low = r->table_low - RAMP_ROOM * span, high = r->table_high + RAMP_ROOM * span;
    WrPad pad = wr_gui_pad_begin(id, wide, tall);
    for (int x = 0; x < (int)pad.w; x++) {
        double height = low + (high - low) * (x + 0.5) / pad.w;
        wr_gui_draw_fill(pad.x + x, pad.y, 1, pad.h, wr_canvas_colour(app->canvas, height), 0);
    }
    if (pad.held && !app->map_shown && !wr_app_shows_mask(app)) {
        const double part = fmin(fmax((pad.pointer_x - pad.x) / pad.w, 0.0), 1.0);
        drag_end(&app->settings->look, r, low + (high - low) * part, span / 64.0);
    }
    wr_gui_pad_end();
}

static void print_range(double from, double to, char low[WR_RANGE_TEXT], char high[WR_RANGE_TEXT])
{
    wr_range_print(from, to, low, high);
    wr_words_number(low);
    wr_words_number(high);
}

static void ramp_tip(const WrApp *app)
{
    const WrCanvasRange *r = shown_range(app);
    char tip[240], low[WR_RANGE_TEXT], high[WR_RANGE_TEXT];
    const bool beyond = r->table_low < r->low || r->table_high > r->high;
    print_range(r->table_low, r->table_high, low, high);
    snprintf(tip, sizeof tip, wr_words("The %s goes from %s to %s%s"),
             wr_words(app->map_shown ? "map" : "table"), low, high,
             beyond ? wr_words(": some of it lies beyond the range that is shown") : "");
    wr_gui_tip(tip);
}

/* Index of the present range in the list of range_popup; -1: none of them. */
static int way_of(const WrCanvasDisplay *look)
{
    if (look->automatic[0] && look->automatic[1]) return 0;
    if (look->automatic[0] || look->automatic[1]) return -1;
    return look->low == 0.0 && look->high == 1.0 ? 1 : 2;
}

static void choose_way(WrApp *app, int way)
{
    WrCanvasDisplay *look = &app->settings->look;
    look->automatic[0] = look->automatic[1] = way == 0;
    if (way == 0) wr_canvas_fit_range(app->canvas);
    if (way == 0) return;
    look->low = way == 1 ? 0.0 : app->range->low;
    look->high = way == 1 ? 1.0 : app->range->high;
}

/* One end of the range, typed or dragged, and whether it follows the table instead. end: 0 black, 1 white. */
static void range_end(WrApp *app, int end)
{
    WrCanvasDisplay *look = &app->settings->look;
    const double low = app->range->low, high = app->range->high;
    const WrNumber spec = { .low = end ? 0 : -1,
                            .high = end ? 2 : 1,
                            .hard_low = end ? low + 1e-6 : -1e30,
                            .hard_high = end ? 1e30 : high - 1e-6,
                            .reset = end,
                            .decimals = 3,
                            .tip = end ? "Height shown as white" : "Height shown as black" };
    double value = end ? high : low;
    wr_gui_label(end ? "White" : "Black");
    if (wr_gui_number(end ? "high" : "low", wr_gui_px(120), &spec, &value)) {
        look->automatic[end] = false;
        *(end ? &look->high : &look->low) = value;
    }
    wr_gui_same_line(8);
    wr_gui_next_id(end ? "white_follows" : "black_follows");
    if (wr_gui_chip(look->automatic[end] ? WR_ICON_CHECK : WR_ICON_ROUND, "Automatic")) {
        look->automatic[end] = !look->automatic[end];
        *(end ? &look->high : &look->low) = value;
        if (look->automatic[end]) wr_canvas_fit_range(app->canvas);
    }
    wr_gui_tip("Follows the table after each edit, and stays during one");
}

/* Choice of display in two rows: the table and its slopes, and maps of it. */
static void choose_shown(WrCanvasDisplay *look)
{
    static const WrCanvasShown rows[2][4] = {
        { WR_CANVAS_HEIGHTS, WR_CANVAS_LIT, WR_CANVAS_SLOPE, WR_CANVAS_BENT },
        { WR_CANVAS_OCCLUSION, WR_CANVAS_CAVITY, WR_CANVAS_CURVATURE, WR_CANVAS_ROUGHNESS }
    };
    for (int r = 0; r < 2; r++) {
        const char *names[4];
        int now = -1;
        for (int i = 0; i < 4; i++) {
            names[i] = wr_canvas_maps[rows[r][i]].name;
            if (rows[r][i] == look->shown) now = i;
        }
        if (wr_gui_segments(r ? "maps" : "shown", names, NULL, 4, &now)) look->shown = rows[r][now];
        wr_gui_tip("The table itself, or a map of it that follows the brush");
    }
}

static void range_popup(WrApp *app)
{
    static const char *const ways[] = { "As the table", "0 to 1", "As it is now" };
    WrCanvasDisplay *look = &app->settings->look;
    int chosen = (int)look->colours, way = way_of(look);
    if (!wr_gui_popup_begin("range")) return;
    choose_shown(look);
    if (look->shown != WR_CANVAS_HEIGHTS) {
        if (!wr_canvas_maps[look->shown].two) ramp(app, "wide", wr_gui_px(240), wr_gui_px(12));
        ramp_tip(app);
        wr_gui_popup_end();
        return;
    }
    if (wr_gui_segments("look", looks, NULL, WR_CANVAS_LOOKS, &chosen))
        look->colours = (WrCanvasColours)chosen;
    if (wr_gui_segments("way", ways, NULL, 3, &way)) choose_way(app, way);
    ramp(app, "wide", wr_gui_px(240), wr_gui_px(12));
    ramp_tip(app);
    wr_gui_check("Mark heights beyond", &look->marks);
    wr_gui_tip("Marks heights above the range in a warm colour, those below in a cool one");
    range_end(app, 0);
    range_end(app, 1);
    wr_gui_popup_end();
}

static void chip_text(const WrApp *app, const WrCanvasRange *range, char *text, size_t size)
{
    const WrCanvasDisplay *look = &app->settings->look;
    const WrCanvasMapRow *map = app->map_shown ? &wr_canvas_maps[look->shown] : NULL;
    const char *name = wr_words(wr_app_shows_mask(app) ? "Mask"
                                : map                  ? map->name
                                                       : looks[look->colours]);
    if (map && map->two) snprintf(text, size, "%s", name);
    else if (!map && !wr_app_shows_mask(app) && look->colours == WR_CANVAS_CONTOURS)
        wr_words_print(text, size, wr_words("Contours every %.3g"),
                       wr_canvas_contour_interval(app->canvas));
    else {
        char low[WR_RANGE_TEXT], high[WR_RANGE_TEXT];
        print_range(range->low, range->high, low, high);
        snprintf(text, size, "%s %s \xe2\x80\x93 %s", name, low, high);
    }
}

/* Light direction of relief shading: a shaded ball in the corner; dragging it moves the light. */
static void light(WrApp *app)
{
    const SDL_Rect *room = &app->layout->canvas;
    WrCanvasDisplay *look = &app->settings->look;
    int gap = wr_gui_px(12), side = wr_gui_px(44);
    wr_gui_overlay_begin("##light", room->x + gap, room->y + wr_gui_px(48), 0, 0);
    WrPad pad = wr_gui_pad_begin("light", side, side);
    double r = 0.46 * side, x = pad.x + pad.w / 2, y = pad.y + pad.h / 2;
    if (pad.held) {
        double dx = (pad.pointer_x - x) / r, dy = (y - pad.pointer_y) / r, far = hypot(dx, dy);
        double most = far > 0.98 ? 0.98 / far : 1.0;
        look->light_x = dx * most;
        look->light_y = dy * most;
    }
    for (int i = 0; i < 12; i++) { /* from its dark rim towards the light */
        double t = i / 12.0;
        uint32_t g = (uint32_t)(70 + 175 * t);
        wr_gui_draw_disc(x + look->light_x * r * t * 0.9, y - look->light_y * r * t * 0.9,
                         r * (1.0 - t), 0xff000000u | g << 16 | g << 8 | g);
    }
    wr_gui_draw_disc(x + look->light_x * r * 0.9, y - look->light_y * r * 0.9, wr_gui_px(4),
                     0xffffd060u);
    wr_gui_pad_end();
    wr_gui_tip("Direction of the light: drag it");
    wr_gui_overlay_end();
}

/* Button beside the range: heights as a lit relief, or as greys. */
static void relief_switch(WrApp *app)
{
    const bool on = app->settings->look.shown == WR_CANVAS_LIT;
    wr_gui_same_line(6);
    wr_gui_next_id("relief");
    if (wr_gui_chip(on ? WR_ICON_CHECK : WR_ICON_ROUND, "Relief"))
        wr_action_run(app, WR_ACT(look_relief));
    wr_gui_tip(wr_action_help(app, wr_action_find(app, WR_ACT(look_relief))));
}

/* Banner at the upper edge while strokes go to a mask, with a button back to the layer's heights. */
static void mask_banner(WrApp *app)
{
    const SDL_Rect *room = &app->layout->canvas;
    const WrDocument *document = wr_app_document(app);
    const double s = wr_gui_scale(), tall = 32 * s;
    const char *back = "Back to the layer";
    char text[WR_LAYER_NAME_MAX + 60];
    snprintf(text, sizeof text, wr_words("Editing the mask of \"%s\""),
             document->layers[document->active].name);
    const double button = wr_gui_text_width(WR_FONT_TEXT, wr_words(back)) + 30 * s;
    const double most = fmin(room->w - 24 * s - button, 420 * s);
    const double written = fmin(wr_gui_text_width(WR_FONT_TEXT, text), most - 16 * s);
    const double wide = written + 16 * s + button, x = rint(room->x + (room->w - wide) / 2);
    /* below the range and the seams, unless there is room between them */
    const double beside = 400 * s, y = room->y + (room->w > wide + 2 * beside ? 10 : 48) * s;
    if (most < 60 * s) return;
    wr_gui_draw_fill(x, y, wide, tall, WR_COLOUR_SELECTED, 4 * s);
    wr_gui_draw_clip((SDL_Rect){ (int)x, (int)y, (int)(16 * s + written), (int)tall });
    wr_gui_draw_text(x + 10 * s, y + (tall - wr_gui_line_height(WR_FONT_TEXT)) / 2, WR_FONT_TEXT,
                     WR_COLOUR_STRONG, text);
    wr_gui_draw_unclip();
    wr_gui_overlay_begin("##mask_banner", (int)(x + wide - 4 * s), (int)(y + tall / 2), 1, 0.5);
    wr_busy_hold(app);
    if (wr_gui_chip(NULL, back)) wr_action_run(app, WR_ACT(mask_edit));
    wr_busy_hold_end();
    wr_gui_tip("Strokes change the layer's heights again");
    wr_gui_overlay_end();
}

static void canvas_chip(WrApp *app)
{
    const SDL_Rect *room = &app->layout->canvas;
    int gap = wr_gui_px(12);
    char text[96];
    const WrCanvasDisplay *look = &app->settings->look;
    chip_text(app, shown_range(app), text, sizeof text);
    wr_gui_overlay_begin("##range", room->x + gap, room->y + gap, 0, 0);
    wr_gui_next_id("range"); /* the numbers change under the pointer */
    if (wr_gui_chip(WR_ICON_DOWN, text)) wr_gui_popup_open("range");
    wr_gui_tip("Values shown as black and white");
    /* Beside the range button, if there is room for the square at the right end. */
    const double beside = room->w - wr_gui_text_width(WR_FONT_TEXT, text);
    bool ranged = !app->map_shown || !wr_canvas_maps[look->shown].two;
    if (beside > wr_gui_px(190)) relief_switch(app);
    if (ranged && beside > wr_gui_px(270)) {
        wr_gui_same_line(6);
        ramp(app, "narrow", wr_gui_px(64), wr_gui_px(22));
        ramp_tip(app);
    }
    range_popup(app);
    wr_gui_overlay_end();
    if (app->map_shown && look->shown == WR_CANVAS_LIT) light(app);
}

/* ---- picture of the table ---- */

#define MEANS_BUDGET 0.012 /* time limit in seconds for averaging a large table in one frame */
#define GRID_FROM 8.0      /* zoom from which a pixel grid is drawn */

/* The range follows the table at rest only: not while something is painted or dragged, nor a preview that follows the
   pointer. A finished preview of a dialog or a generator may widen it until it ends. */
static WrRangeHold range_hold(const WrApp *app)
{
    const bool drawn = app->hand->grab != WR_GRAB_NONE || app->brush->jobs.count > 0;
    if (drawn || app->stamp->trying || wr_gui_holds_mouse(app->gui)) return WR_RANGE_STAYS;
    if (!app->trying) return WR_RANGE_RESTS;
    return wr_edit_preview_busy(app->trial, NULL, NULL) ? WR_RANGE_STAYS : WR_RANGE_TRIES;
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

/* the picture */
static void canvas_view_draw(WrApp *app)
{
    if (app->layout->canvas.w <= 0) return;
    const WrField *second, *field = wr_app_canvas_field(app), *map = map_of(app, field, &second);
    WrCanvasDisplay look = app->settings->look;
    if (map) {
        const WrCanvasMapRow *now = &wr_canvas_maps[look.shown];
        look.colours = now->colours;
        look.marks = false;
        look.automatic[0] = now->low == now->high;
        look.automatic[1] = false;
        look.low = now->low, look.high = now->high;
    } else {
        look.shown = WR_CANVAS_HEIGHTS; /* the map is not ready */
    }
    if (wr_app_shows_mask(app))
        look = (WrCanvasDisplay){ .colours = WR_CANVAS_GREY, .low = 0.0, .high = 1.0 };
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
    wr_layer_points_marks(app);
    if (app->hand->on_canvas && tool->overlay && !panning) tool->overlay(app);
    if (tool->marks) tool->marks(app);
    wr_strokes_marks(app);
    if (app->hints && app->file->starter) hints(app);
    wr_gui_draw_unclip();
    if (room->w > wr_gui_px(140)) canvas_chip(app);
    if (wr_paints_mask(app)) mask_banner(app);
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
    canvas_view_draw(app);
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
