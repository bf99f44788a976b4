/* Fill tool: a click applies the brush's mode to the connected region. */
#include "ui/app/state/action_list.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/line.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/canvas/tools/stroke_input.h"
#include "ui/canvas/tools/option_row.h"
#include "ui/canvas/tools/tool.h"
#include "ui/canvas/tools/tool_rows.h"
#include "ui/canvas/overlays/marks.h"

#include "base/text.h"
#include "brush/brush.h"
#include "field/select.h"

#include <math.h>

static void paint_line(const WrApp *app, WrText *line)
{
    const WrBrush now = wr_brush_now(app), *brush = &now;
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

static void press(WrApp *app, const WrPointer *at)
{
    const WrDrawSettings *how = &app->settings->drawing;
    WrSelectPoint home = wr_overlay_wrap_offset(app, at->u, at->v);
    WrText line = { 0 };
    app->hints = false;
    wr_text_add(&line, "flood ");
    wr_text_add_number(&line, wr_line_round(at->u + home.u, 7));
    wr_text_add(&line, ",");
    wr_text_add_number(&line, wr_line_round(at->v + home.v, 7));
    wr_line_number(&line, "tolerance", how->tolerance);
    if (how->diagonal) wr_text_add(&line, " diagonal=on");
    paint_line(app, &line);
    wr_app_run_slow(app, wr_text_get(&line));
    wr_text_fini(&line);
}

/* ---- options ---- */

static void tolerance(WrApp *app, double width)
{
    static const WrNumber spec = { .low = 0.0001,
                                   .high = 1,
                                   .hard_low = 0,
                                   .hard_high = 1e30,
                                   .reset = 0.01,
                                   .decimals = -1,
                                   .logarithmic = true,
                                   .tip = "Largest difference from the clicked height" };
    wr_gui_number("tolerance", width, &spec, &app->settings->drawing.tolerance);
}

static void diagonal(WrApp *app, double width)
{
    (void)width;
    wr_gui_check("over corners", &app->settings->drawing.diagonal);
    wr_gui_tip("Fills across corners, too");
}

static void options(WrApp *app)
{
    unsigned uses = wr_current_brush_mode(app)->uses;
    const WrOption items[] = { { "##Fill mode", 104, 12, wr_option_fill_mode, true },
                               { "Strength", 84, 0, wr_option_strength,
                                 (uses & WR_USES_STRENGTH) != 0 },
                               { "Height", 84, 0, wr_option_to_height, (uses & WR_USES_TO) != 0 },
                               { "Opacity", 84, 0, wr_option_opacity, true },
                               { "Tolerance", 84, 0, tolerance, true },
                               { "##", 0, 120, diagonal, true } };
    wr_option_row(app, items, (int)(sizeof items / sizeof *items));
}

/* ---- the row ---- */

const WrTool wr_tool_flood = { .action = WR_ACT(flood),
                               .icon = WR_ICON_BUCKET,
                               .help = "Click to fill a connected region of similar height.",
                               .press = press,
                               .options = options };
