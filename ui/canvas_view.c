/* SPDX-License-Identifier: MIT
   The table's view: its picture, and what lies on it. */
#include "ui/state.h"

#include <math.h>
#include <string.h>

#define MEANS_BUDGET 0.012 /* seconds a picture may take for the means of large tables */
#define GRID_FROM 8.0      /* zoom from which texels get a grid */

void wr_canvas_view_draw(WrApp *app)
{
    if (app->layout.canvas.w <= 0) return;
    app->canvas_unfinished =
        wr_canvas_draw(app->canvas, app->renderer, &app->view, wr_app_field(app),
                       &app->settings.look, MEANS_BUDGET, app->range);
    if (app->canvas_unfinished) wr_app_redraw(app);
    wr_marks_draw(app);
}

/* Lines between texels, faint: dark on light and light on dark. */
static void pixel_grid(const WrApp *app)
{
    const WrView *v = &app->view;
    if (v->zoom < GRID_FROM) return;
    double x0, y0, x1, y1, px, py;
    wr_view_to_texel(v, v->x, v->y, &x0, &y0);
    wr_view_to_texel(v, v->x + v->w, v->y + v->h, &x1, &y1);
    for (double x = ceil(x0); x <= x1; x += 1.0) {
        wr_view_to_pixel(v, x, y0, &px, &py);
        wr_gui_draw_fill(rint(px), v->y, 1, v->h, 0x30808080u, 0);
    }
    for (double y = ceil(y0); y <= y1; y += 1.0) {
        wr_view_to_pixel(v, x0, y, &px, &py);
        wr_gui_draw_fill(v->x, rint(py), v->w, 1, 0x30808080u, 0);
    }
}

/* The real cell. */
static void cell_outline(const WrApp *app)
{
    const WrView *v = &app->view;
    double x0, y0, x1, y1, line = wr_gui_px(1);
    wr_view_to_pixel(v, 0, 0, &x0, &y0);
    wr_view_to_pixel(v, v->table_w, v->table_h, &x1, &y1);
    double x = rint(x0), y = rint(y0), w = rint(x1) - x, h = rint(y1) - y;
    wr_gui_draw_rect(x, y, w, h, 0x90000000u, 3.0 * line);
    wr_gui_draw_rect(x, y, w, h, WR_COLOUR_CELL, line);
}

/* Where the pointer on the patch is in the table. */
static void patch_mark(const WrApp *app)
{
    double u, v, x, y, s = wr_gui_scale();
    if (!app->hand.on_patch || app->hand.grab != WR_GRAB_NONE) return;
    if (!wr_preview_point_hit(app->preview, &u, &v)) return;
    const WrScene *scene = wr_app_scene(app);
    double tu = wr_field_reduce(u, scene->replicate_u), tv = wr_field_reduce(v, scene->replicate_v);
    wr_view_to_pixel(&app->view, tu * app->view.table_w, (1.0 - tv) * app->view.table_h, &x, &y);
    wr_gui_draw_circle(x, y, 6.0 * s, 0xb0000000u, 3.0 * s);
    wr_gui_draw_circle(x, y, 6.0 * s, WR_COLOUR_ACCENT, 1.5 * s);
}

static void hints(WrApp *app)
{
    static const char *const lines[] = { "Drag to paint", "[ and ] change the size",
                                         "Drag the patch to turn it" };
    const SDL_Rect *room = &app->layout.canvas;
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

static void range_popup(WrApp *app)
{
    static const char *const looks[] = { "Grey", "Signed" };
    WrCanvasLook *look = &app->settings.look;
    int chosen = (int)look->colours;
    if (!wr_gui_popup_begin("range")) return;
    if (wr_gui_segments("look", looks, NULL, 2, &chosen)) look->colours = (WrCanvasColours)chosen;
    wr_gui_check("Range follows the table", &look->automatic);
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
    double l = app->range[0], h = app->range[1];
    wr_gui_label("Black");
    if (wr_gui_number("low", field, &low, &l) && l < look->high) look->low = l;
    wr_gui_label("White");
    if (wr_gui_number("high", field, &high, &h) && h > look->low) look->high = h;
    wr_gui_enable();
    wr_gui_popup_end();
}

static void chips(WrApp *app)
{
    const SDL_Rect *room = &app->layout.canvas;
    int gap = wr_gui_px(12);
    char text[96];
    snprintf(text, sizeof text, "%s %.3g \xe2\x80\x93 %.3g",
             app->settings.look.colours == WR_CANVAS_GREY ? "Grey" : "Signed", app->range[0],
             app->range[1]);
    wr_gui_overlay_begin("##range", room->x + gap, room->y + gap, 0, 0);
    if (wr_gui_chip(WR_ICON_DOWN, text)) wr_gui_popup_open("range");
    wr_gui_tip("Which heights are black and white");
    range_popup(app);
    wr_gui_overlay_end();
}

void wr_canvas_view_overlay(WrApp *app)
{
    const SDL_Rect *room = &app->layout.canvas;
    if (room->w <= 0) return;
    wr_gui_draw_clip(*room);
    pixel_grid(app);
    cell_outline(app);
    patch_mark(app);
    const WrTool *tool = &wr_tools[app->tool];
    bool panning = app->hand.grab == WR_GRAB_PAN || app->hand.space;
    wr_symmetry_marks(app);
    if (app->hand.on_canvas && tool->overlay && !panning) tool->overlay(app);
    if (tool->marks) tool->marks(app);
    if (app->hints && app->starter) hints(app);
    wr_gui_draw_unclip();
    if (room->w > wr_gui_px(140)) chips(app);
    wr_panel_symmetry(app);
    if (room->w > wr_gui_px(240)) wr_panel_seam(app);
}
