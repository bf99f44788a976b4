/* SPDX-License-Identifier: MIT
   Ramps: a drag says from where to where heights lead from low to high. Shift keeps to multiples of 15
   degrees, Escape gives up. */
#include "ui/line.h"
#include "ui/state.h"

#include <math.h>

enum { RAMP_LINEAR, RAMP_RADIAL, RAMP_CONE };

static const char *const kinds[] = { "linear", "radial", "cone" };
static const char *const blends[] = { "replace", "add", "max", "min" };

static void end_at(WrApp *app, const WrPointer *at)
{
    WrDrawHand *draw = &app->draw;
    wr_view_to_texel(&app->view, at->x, at->y, &draw->x1, &draw->y1);
    if (!(at->mods & WR_MOD_SHIFT)) return;
    double dx = draw->x1 - draw->x0, dy = draw->y1 - draw->y0, step = 3.141592653589793 / 12.0;
    double turn = rint(atan2(dy, dx) / step) * step, way = hypot(dx, dy);
    draw->x1 = draw->x0 + way * cos(turn);
    draw->y1 = draw->y0 + way * sin(turn);
}

void wr_ramp_press(WrApp *app, const WrPointer *at)
{
    app->draw.active = true;
    app->hints = false;
    wr_view_to_texel(&app->view, at->x, at->y, &app->draw.x0, &app->draw.y0);
    end_at(app, at);
    wr_app_redraw(app);
}

void wr_ramp_drag(WrApp *app, const WrPointer *at)
{
    end_at(app, at);
    wr_app_redraw(app);
}

void wr_ramp_release(WrApp *app, const WrPointer *at)
{
    const WrDrawing *how = &app->settings.drawing;
    WrDrawHand *draw = &app->draw;
    if (!draw->active) return;
    end_at(app, at);
    draw->active = false;
    wr_app_redraw(app);
    if (hypot(draw->x1 - draw->x0, draw->y1 - draw->y0) * app->view.zoom < 3.0) return;
    WrSelectPoint a = wr_overlay_uv(app, draw->x0, draw->y0);
    WrSelectPoint b = wr_overlay_uv(app, draw->x1, draw->y1);
    WrSelectPoint home = wr_overlay_home(app, a.u, a.v);
    WrText line = { 0 };
    wr_text_addf(&line, "ramp %s", kinds[how->ramp]);
    wr_line_number(&line, "from", wr_line_round(a.u + home.u, 7));
    wr_text_add(&line, ",");
    wr_text_add_number(&line, wr_line_round(a.v + home.v, 7));
    wr_line_number(&line, "to", wr_line_round(b.u + home.u, 7));
    wr_text_add(&line, ",");
    wr_text_add_number(&line, wr_line_round(b.v + home.v, 7));
    wr_line_number(&line, "low", how->low);
    wr_line_number(&line, "high", how->high);
    if (how->fold) wr_text_add(&line, " fold=on");
    if (how->blend) wr_text_addf(&line, " blend=%s", blends[how->blend]);
    wr_app_run_slow(app, wr_text_get(&line));
    wr_text_fini(&line);
}

bool wr_ramp_key(WrApp *app, SDL_Keycode key)
{
    if (key != SDLK_ESCAPE || !app->draw.active) return false;
    wr_draw_leave(app);
    app->hand.grab = WR_GRAB_NONE;
    return true;
}

static void ring(const WrApp *app, double radius, WrColour colour)
{
    WrSelectPoint points[72];
    for (int i = 0; i < 72; i++) {
        double a = 6.283185307179586 * i / 72;
        points[i] =
            wr_overlay_uv(app, app->draw.x0 + radius * cos(a), app->draw.y0 + radius * sin(a));
    }
    wr_overlay_lines(app, points, 72, true, colour);
}

/* Across the way, at its ends: where a linear ramp begins and where it is done. */
static void bar(const WrApp *app, double x, double y)
{
    const WrDrawHand *draw = &app->draw;
    double dx = draw->x1 - draw->x0, dy = draw->y1 - draw->y0, way = fmax(hypot(dx, dy), 1e-9);
    double half = 40.0 * wr_gui_scale() / app->view.zoom;
    WrSelectPoint points[2] = { wr_overlay_uv(app, x - dy / way * half, y + dx / way * half),
                                wr_overlay_uv(app, x + dy / way * half, y - dx / way * half) };
    wr_overlay_lines(app, points, 2, false, 0xc0f4f4f4u);
}

static void end_label(const WrApp *app, double x, double y, double height)
{
    char text[40];
    double px, py;
    snprintf(text, sizeof text, "%.4g", height);
    wr_view_to_pixel(&app->view, x, y, &px, &py);
    wr_overlay_label(px, py - 16.0 * wr_gui_scale(), text);
}

void wr_ramp_marks(WrApp *app)
{
    const WrDrawHand *draw = &app->draw;
    const WrDrawing *how = &app->settings.drawing;
    if (!draw->active) return;
    WrSelectPoint way[2] = { wr_overlay_uv(app, draw->x0, draw->y0),
                             wr_overlay_uv(app, draw->x1, draw->y1) };
    double radius = hypot(draw->x1 - draw->x0, draw->y1 - draw->y0);
    if (how->ramp == RAMP_RADIAL) ring(app, radius, 0xfff4f4f4u);
    if (how->ramp == RAMP_RADIAL && how->fold) ring(app, 2.0 * radius, 0xa0d0d0d0u);
    if (how->ramp == RAMP_LINEAR) {
        bar(app, draw->x0, draw->y0);
        bar(app, draw->x1, draw->y1);
    }
    wr_overlay_lines(app, way, 2, false, 0xfff4f4f4u);
    wr_overlay_handle(app, way[0].u, way[0].v, true, false);
    wr_overlay_handle(app, way[1].u, way[1].v, true, true);
    end_label(app, draw->x0, draw->y0, how->low);
    if (how->ramp != RAMP_CONE) end_label(app, draw->x1, draw->y1, how->high);
}
