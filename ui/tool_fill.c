/* SPDX-License-Identifier: MIT
   Filling what is connected: a click does to all of it what the brush's mode does. */
#include "ui/line.h"
#include "ui/state.h"

#include <math.h>

void wr_draw_paint_line(const WrApp *app, WrText *line)
{
    const WrBrush *brush = &app->settings.brush;
    unsigned uses = wr_brush_modes[brush->mode].uses;
    wr_line_number(line, "strength", brush->strength);
    wr_text_addf(line, " mode=%s", wr_brush_modes[brush->mode].name);
    if (uses & WR_USES_TO) wr_line_number(line, "to", brush->to);
    if (brush->opacity < 1.0) wr_line_number(line, "opacity", brush->opacity);
    if ((uses & WR_USES_REACH) && brush->reach > 0.0) wr_line_number(line, "reach", brush->reach);
    if (!(uses & WR_USES_SOURCE)) return;
    wr_line_number(line, "source", brush->source_u);
    wr_text_add(line, ",");
    wr_text_add_number(line, brush->source_v);
}

void wr_flood_press(WrApp *app, const WrPointer *at)
{
    const WrDrawing *how = &app->settings.drawing;
    WrSelectPoint home = wr_overlay_home(app, at->u, at->v);
    WrText line = { 0 };
    app->hints = false;
    wr_text_add(&line, "flood ");
    wr_text_add_number(&line, wr_line_round(at->u + home.u, 7));
    wr_text_add(&line, ",");
    wr_text_add_number(&line, wr_line_round(at->v + home.v, 7));
    wr_line_number(&line, "tolerance", how->tolerance);
    if (how->diagonal) wr_text_add(&line, " diagonal=on");
    wr_draw_paint_line(app, &line);
    wr_app_run_slow(app, wr_text_get(&line));
    wr_text_fini(&line);
}
