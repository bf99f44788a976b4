/* Ramp tool: a drag sets start and end, where the height goes from low to high. Shift snaps to multiples of 15
   degrees, Escape cancels. */
#include "ui/canvas/view.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/line.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/canvas/tools/option_row.h"
#include "ui/canvas/tools/tool.h"
#include "ui/canvas/tools/tool_rows.h"
#include "ui/canvas/tools/tool_shape.h"
#include "ui/canvas/overlays/marks.h"
#include "ui/toolkit/words.h"

#include "base/text.h"
#include "base/enum_rows.h"
#include "document/blend.h"
#include "field/ramp.h"
#include "field/select.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>

static void end_at(WrApp *app, const WrPointer *at)
{
    WrDrawState *draw = app->draw;
    wr_view_to_texel(app->view, at->x, at->y, &draw->x1, &draw->y1);
    if (!(at->mods & WR_MOD_SHIFT)) return;
    double dx = draw->x1 - draw->x0, dy = draw->y1 - draw->y0, step = 3.141592653589793 / 12.0;
    double turn = rint(atan2(dy, dx) / step) * step, way = hypot(dx, dy);
    draw->x1 = draw->x0 + way * cos(turn);
    draw->y1 = draw->y0 + way * sin(turn);
}

static void press(WrApp *app, const WrPointer *at)
{
    app->draw->active = true;
    app->hints = false;
    wr_view_to_texel(app->view, at->x, at->y, &app->draw->x0, &app->draw->y0);
    end_at(app, at);
    wr_app_redraw(app);
}

static void drag(WrApp *app, const WrPointer *at)
{
    end_at(app, at);
    wr_app_redraw(app);
}

/* A drag shorter than three pixels is a click and draws nothing. Both ends are moved by the same whole cell (`home` of the
   start), so a ramp across the edge keeps its direction; 7 digits resolve 1/1000 texel of a table of 8192. */
static void release(WrApp *app, const WrPointer *at)
{
    const WrDrawSettings *how = &app->settings->drawing;
    WrDrawState *draw = app->draw;
    if (!draw->active) return;
    end_at(app, at);
    draw->active = false;
    wr_app_redraw(app);
    if (hypot(draw->x1 - draw->x0, draw->y1 - draw->y0) * app->view->zoom < 3.0) return;
    WrSelectPoint a = wr_overlay_uv(app, draw->x0, draw->y0);
    WrSelectPoint b = wr_overlay_uv(app, draw->x1, draw->y1);
    WrSelectPoint home = wr_overlay_wrap_offset(app, a.u, a.v);
    WrText line = { 0 };
    wr_text_addf(&line, "ramp %s", wr_ramp_names[how->ramp]);
    wr_line_number(&line, "from", wr_line_round(a.u + home.u, 7));
    wr_text_add(&line, ",");
    wr_text_add_number(&line, wr_line_round(a.v + home.v, 7));
    wr_line_number(&line, "to", wr_line_round(b.u + home.u, 7));
    wr_text_add(&line, ",");
    wr_text_add_number(&line, wr_line_round(b.v + home.v, 7));
    wr_line_number(&line, "low", how->low);
    wr_line_number(&line, "high", how->high);
    if (how->fold) wr_text_add(&line, " fold=on");
    if (how->blend) wr_text_addf(&line, " blend=%s", wr_blends[wr_ramp_blends[how->blend]].name);
    wr_app_run_slow(app, wr_text_get(&line));
    wr_text_fini(&line);
}

static bool key(WrApp *app, SDL_Keycode key)
{
    if (key != SDLK_ESCAPE || !app->draw->active) return false;
    wr_draw_leave(app);
    app->hand->grab = WR_GRAB_NONE;
    return true;
}

/* Drawn as a polygon in texels, because the view may mirror or rotate, and wr_overlay_lines repeats it in all visible cells. */
static void ring(const WrApp *app, double radius, WrColour colour)
{
    WrSelectPoint points[72];
    for (int i = 0; i < 72; i++) {
        double a = 6.283185307179586 * i / 72;
        points[i] =
            wr_overlay_uv(app, app->draw->x0 + radius * cos(a), app->draw->y0 + radius * sin(a));
    }
    wr_overlay_lines(app, points, 72, true, colour);
}

/* A bar across the drag at its end: the limit of a linear ramp. */
static void bar(const WrApp *app, double x, double y)
{
    const WrDrawState *draw = app->draw;
    double dx = draw->x1 - draw->x0, dy = draw->y1 - draw->y0, way = fmax(hypot(dx, dy), 1e-9);
    double half = 40.0 * wr_gui_scale() / app->view->zoom;
    WrSelectPoint points[2] = { wr_overlay_uv(app, x - dy / way * half, y + dx / way * half),
                                wr_overlay_uv(app, x + dy / way * half, y - dx / way * half) };
    wr_overlay_lines(app, points, 2, false, 0xc0f4f4f4u);
}

static void end_label(const WrApp *app, double x, double y, double height)
{
    char text[40];
    double px, py;
    wr_words_print(text, sizeof text, "%.4g", height);
    wr_view_to_pixel(app->view, x, y, &px, &py);
    wr_overlay_label(px, py - 16.0 * wr_gui_scale(), text);
}

static void marks(WrApp *app)
{
    const WrDrawState *draw = app->draw;
    const WrDrawSettings *how = &app->settings->drawing;
    if (!draw->active) return;
    WrSelectPoint way[2] = { wr_overlay_uv(app, draw->x0, draw->y0),
                             wr_overlay_uv(app, draw->x1, draw->y1) };
    double radius = hypot(draw->x1 - draw->x0, draw->y1 - draw->y0);
    if (how->ramp == WR_RAMP_RADIAL) ring(app, radius, 0xfff4f4f4u);
    if (how->ramp == WR_RAMP_RADIAL && how->fold) ring(app, 2.0 * radius, 0xa0d0d0d0u);
    if (how->ramp == WR_RAMP_LINEAR) {
        bar(app, draw->x0, draw->y0);
        bar(app, draw->x1, draw->y1);
    }
    wr_overlay_lines(app, way, 2, false, 0xfff4f4f4u);
    wr_overlay_handle(app, way[0].u, way[0].v, true, false);
    wr_overlay_handle(app, way[1].u, way[1].v, true, true);
    end_label(app, draw->x0, draw->y0, how->low);
    if (how->ramp != WR_RAMP_CONE) end_label(app, draw->x1, draw->y1, how->high);
}

/* ---- options ---- */

static void ramp_kind(WrApp *app, double width)
{
    WR_ROWS(names);
    static const char *const names[WR_RAMP_KINDS] = { [WR_ROW(WR_RAMP_LINEAR)] = "Linear",
                                                      [WR_ROW(WR_RAMP_RADIAL)] = "Radial",
                                                      [WR_ROW(WR_RAMP_CONE)] = "Cone" };
    WR_ROWS_END(names, WR_RAMP_KINDS);
    (void)width;
    wr_gui_segments("ramp", names, NULL, WR_RAMP_KINDS, &app->settings->drawing.ramp);
}

static void ramp_end(const char *id, double width, const char *tip, double reset, double *value)
{
    WrNumber spec = { .low = -1,
                      .high = 1,
                      .hard_low = -1e30,
                      .hard_high = 1e30,
                      .reset = reset,
                      .decimals = 3,
                      .tip = tip };
    wr_gui_number(id, width, &spec, value);
}

static void ramp_low(WrApp *app, double width)
{
    ramp_end("low", width, "Height at the start of the drag", 0, &app->settings->drawing.low);
}

static void ramp_high(WrApp *app, double width)
{
    ramp_end("high", width, "Height where it ends", 1, &app->settings->drawing.high);
}

static void ramp_fold(WrApp *app, double width)
{
    (void)width;
    wr_gui_check("back down", &app->settings->drawing.fold);
    wr_gui_tip("Returns to the low height, so that the ramp tiles");
}

static void ramp_blend(WrApp *app, double width)
{
    const char *names[WR_RAMP_BLENDS];
    for (int i = 0; i < WR_RAMP_BLENDS; i++) names[i] = wr_blends[wr_ramp_blends[i]].name;
    wr_gui_choice("blend", width, names, WR_RAMP_BLENDS, &app->settings->drawing.blend);
    wr_gui_tip("How it blends with the present heights");
}

static void options(WrApp *app)
{
    const WrOption items[] = { { "##Kind of ramp", 0, 190, ramp_kind, true },
                               { "Low", 84, 0, ramp_low, true },
                               { "High", 84, 0, ramp_high, true },
                               { "##", 0, 110, ramp_fold, true },
                               { "Blend", 90, 0, ramp_blend, true } };
    wr_option_row(app, items, (int)(sizeof items / sizeof *items));
}

/* ---- the row ---- */

const WrTool wr_tool_ramp = {
    .action = WR_ACT(ramp),
    .icon = WR_ICON_RAMP,
    .help = "Drag from the low end of a slope to its high end; Shift keeps to 15 degrees.",
    .press = press,
    .drag = drag,
    .release = release,
    .marks = marks,
    .options = options,
    .key = key,
    .leave = wr_draw_leave,
    .meanwhile = true
};
