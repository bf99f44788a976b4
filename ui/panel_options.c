/* SPDX-License-Identifier: MIT
   The option row under the menu: what the tool in hand needs, and no more. */
#include "ui/state.h"

#include <string.h>

static void label(const char *text)
{
    wr_gui_same_line(14);
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, text);
    wr_gui_same_line(8);
}

void wr_brush_options(WrApp *app)
{
    static const WrColour colours[] = { WR_COLOUR_RAISE, WR_COLOUR_LOWER, WR_COLOUR_LEVEL };
    static const char *const modes[] = { "Raise", "Lower", "To height" };
    static const WrNumber size = { .low = 1,
                                   .high = 1000,
                                   .hard_low = 0,
                                   .hard_high = 2e9,
                                   .reset = 32,
                                   .decimals = -1,
                                   .unit = "px",
                                   .logarithmic = true,
                                   .tip = "Diameter of the brush in texels of the table.\n"
                                          "Drag, click to type, double-click to reset." };
    static const WrNumber hard = { .low = 0,
                                   .high = 1,
                                   .reset = 0.5,
                                   .decimals = 2,
                                   .tip = "Part of the radius that is fully covered." };
    static const WrNumber strength = { .low = 0.001,
                                       .high = 1,
                                       .hard_low = -1e30,
                                       .hard_high = 1e30,
                                       .reset = 0.1,
                                       .decimals = -1,
                                       .logarithmic = true,
                                       .tip =
                                           "How much one stroke changes the height at its middle, "
                                           "in units of the table." };
    static const WrNumber to = { .low = 0,
                                 .high = 1,
                                 .hard_low = -1e30,
                                 .hard_high = 1e30,
                                 .reset = 0,
                                 .decimals = 3,
                                 .tip =
                                     "The height that the brush moves to. Ctrl and a click on the "
                                     "table picks it." };
    WrBrush *brush = &app->settings.brush;
    bool narrow = app->width < wr_gui_px(1060);
    double field = wr_gui_px(narrow ? 84 : 118);
    double diameter = 2.0 * brush->radius;
    label("Size");
    if (wr_gui_number("size", field, &size, &diameter)) brush->radius = diameter / 2.0;
    label(narrow ? "Hard" : "Hardness");
    wr_gui_number("hardness", field, &hard, &brush->hardness);
    label("Strength");
    wr_gui_number("strength", field, &strength, &brush->strength);
    wr_gui_same_line(16);
    int mode = (int)brush->mode;
    if (wr_gui_segments("mode", modes, colours, 3, &mode)) brush->mode = (WrBrushMode)mode;
    if (brush->mode != WR_BRUSH_TO) return;
    wr_gui_same_line(8);
    wr_gui_number("to", field, &to, &brush->to);
}

void wr_panel_options(WrApp *app)
{
    const WrTool *tool = &wr_tools[app->tool];
    const WrAction *action = wr_action_find(tool->action);
    if (app->layout.options.w <= 0) return;
    wr_gui_area_begin("##options", WR_AREA_BAR, app->layout.options, WR_COLOUR_BAR);
    wr_gui_text(WR_FONT_BOLD, WR_COLOUR_STRONG, action->label);
    if (tool->options) {
        tool->options(app);
    } else {
        wr_gui_same_line(14);
        wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, tool->help);
    }
    wr_gui_area_end();
}
