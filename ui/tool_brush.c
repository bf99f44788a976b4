/* SPDX-License-Identifier: MIT
   The brush: gestures become stroke commands. Every sample that the system sends is handed to the
   session, in one bundle before the next picture. */
#include "ui/line.h"
#include "ui/state.h"

#include <math.h>
#include <string.h>

static void sample(WrApp *app, double u, double v)
{
    wr_array_push(&app->brush.samples, ((WrSample){ .u = u, .v = v, .pressure = 1.0 }));
}

static void write_head(const WrBrush *brush, WrText *line)
{
    wr_text_add(line, "stroke");
    wr_line_number(line, "radius", brush->radius);
    wr_line_number(line, "hardness", brush->hardness);
    wr_line_number(line, "strength", brush->strength);
    wr_text_addf(line, " mode=%s", wr_brush_modes[brush->mode].name);
    if (brush->mode == WR_BRUSH_TO) wr_line_number(line, "to", brush->to);
}

void wr_brush_press(WrApp *app, const WrPointer *at)
{
    if (at->mods & WR_MOD_CTRL) {
        wr_brush_pick(app, at);
        return;
    }
    WrText head = { 0 };
    WrError err;
    write_head(&app->settings.brush, &head);
    bool begun = wr_session_stroke_begin(app->session, wr_text_get(&head), &err);
    wr_text_fini(&head);
    if (!begun) {
        wr_app_fail(app, &err);
        wr_hand_let_go(app);
        return;
    }
    app->hints = false;
    app->brush.samples.count = 0;
    if ((at->mods & WR_MOD_SHIFT) && app->brush.have_last)
        sample(app, app->brush.last_u, app->brush.last_v);
    sample(app, at->u, at->v);
    wr_app_redraw(app);
}

void wr_brush_drag(WrApp *app, const WrPointer *at)
{
    if (at->mods & WR_MOD_CTRL && !wr_session_in_stroke(app->session)) {
        wr_brush_pick(app, at);
        return;
    }
    if (!wr_session_in_stroke(app->session)) return;
    sample(app, at->u, at->v);
    wr_app_redraw(app);
}

void wr_brush_flush(WrApp *app)
{
    WrError err;
    int count = app->brush.samples.count;
    if (count == 0) return;
    app->brush.samples.count = 0;
    if (!wr_session_in_stroke(app->session)) return;
    if (!wr_session_stroke_add(app->session, app->brush.samples.data, count, &err))
        wr_app_fail(app, &err);
    const WrSample *last = &app->brush.samples.data[count - 1];
    app->brush.last_u = last->u;
    app->brush.last_v = last->v;
    app->brush.have_last = true;
}

void wr_brush_release(WrApp *app, const WrPointer *at)
{
    (void)at;
    WrError err;
    if (!wr_session_in_stroke(app->session)) return;
    wr_brush_flush(app);
    if (!wr_session_stroke_end(app->session, &err)) wr_app_fail(app, &err);
    wr_app_take_notes(app);
    wr_app_title(app);
    wr_app_redraw(app);
}

void wr_brush_pick(WrApp *app, const WrPointer *at)
{
    const WrField *field = wr_app_field(app);
    double f, u = at->u, v = at->v;
    wr_field_sample(field, WR_SCHEME_NEAREST, 1, &u, &v, &f, NULL, NULL);
    app->settings.brush.to = f;
    app->settings.brush.mode = WR_BRUSH_TO;
    wr_app_redraw(app);
}

void wr_brush_resize(WrApp *app, const WrPointer *at)
{
    double grown = app->brush.resize_radius + (at->x - app->hand.start.x) / app->view.zoom;
    double largest = 16384.0;
    grown = grown < 0.5 ? 0.5 : grown > largest ? largest : grown;
    app->settings.brush.radius = grown < 10.0 ? rint(grown * 10.0) / 10.0 : rint(grown);
    wr_app_redraw(app);
}

/* ---- outline ---- */

static void outline(double x, double y, double radius, WrColour dark, WrColour light)
{
    wr_gui_draw_circle(x, y, radius + 1.0, dark, 1.5);
    wr_gui_draw_circle(x, y, radius, light, 1.2);
}

static void cross(double x, double y)
{
    double s = wr_gui_scale(), from = 3.0 * s, to = 9.0 * s;
    for (int pass = 0; pass < 2; pass++) {
        WrColour colour = pass ? 0xfff4f4f4u : 0xb0000000u;
        double w = pass ? 1.2 : 3.0;
        wr_gui_draw_line(x - to, y, x - from, y, colour, w);
        wr_gui_draw_line(x + from, y, x + to, y, colour, w);
        wr_gui_draw_line(x, y - to, x, y - from, colour, w);
        wr_gui_draw_line(x, y + from, x, y + to, colour, w);
    }
}

/* Inside the real cell: what the stroke touches there from the other side of an edge, or from a copy. */
static void outline_in_cell(const WrApp *app, double x, double y, double radius)
{
    const WrField *field = wr_app_field(app);
    WrShift copies[WR_VIEW_COPIES];
    int count =
        wr_view_outline_copies(&app->view, wr_field_wrap_u(field) == WR_WRAP_PERIODIC,
                               wr_field_wrap_v(field) == WR_WRAP_PERIODIC, x, y, radius, copies);
    double x0, y0, x1, y1;
    wr_view_to_pixel(&app->view, 0, 0, &x0, &y0);
    wr_view_to_pixel(&app->view, app->view.table_w, app->view.table_h, &x1, &y1);
    SDL_Rect cell = { (int)x0, (int)y0, (int)(x1 - x0), (int)(y1 - y0) };
    wr_gui_draw_clip(cell);
    for (int i = 0; i < count; i++) {
        if (copies[i].dx == 0.0 && copies[i].dy == 0.0) continue;
        double px, py;
        wr_view_to_pixel(&app->view, x + copies[i].dx, y + copies[i].dy, &px, &py);
        outline(px, py, radius * app->view.zoom, 0x60000000u, 0x90f4f4f4u);
    }
    wr_gui_draw_unclip();
}

void wr_brush_overlay(WrApp *app)
{
    const WrBrush *brush = &app->settings.brush;
    const WrPointer *at = app->hand.grab == WR_GRAB_RESIZE ? &app->hand.start : &app->hand.at;
    double x, y, radius = brush->radius * app->view.zoom;
    wr_view_to_texel(&app->view, at->x, at->y, &x, &y);
    if (radius < 3.0 * wr_gui_scale()) {
        cross(at->x, at->y);
        return;
    }
    outline_in_cell(app, x, y, brush->radius);
    outline(at->x, at->y, radius, 0xb0000000u, 0xfff4f4f4u);
    if (app->hand.grab != WR_GRAB_RESIZE) return;
    char text[48];
    snprintf(text, sizeof text, "%.4g px", 2.0 * brush->radius);
    double w = wr_gui_text_width(WR_FONT_TEXT, text), h = wr_gui_line_height(WR_FONT_TEXT);
    double pad = 6.0 * wr_gui_scale();
    wr_gui_draw_fill(at->x - w / 2 - pad, at->y - h / 2 - pad, w + 2 * pad, h + 2 * pad,
                     WR_COLOUR_CHIP, 3.0);
    wr_gui_draw_text(at->x - w / 2, at->y - h / 2, WR_FONT_TEXT, WR_COLOUR_STRONG, text);
}
