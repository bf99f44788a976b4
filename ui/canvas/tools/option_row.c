/* Option row: brush parameters shared by several tools, and layout of a tool's options. Options that do not fit are
   in a popup at the row's end. */
#include "ui/canvas/tools/option_row.h"

#include "base/enum_rows.h"
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/gui_rows.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/input/stroke_smoothing.h"
#include "ui/canvas/tools/stroke_input.h"
#include "ui/canvas/tools/preset_browser.h"
#include "ui/canvas/tools/thumbs.h"
#include "ui/canvas/tools/tool.h"

#include "brush/brush.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define MORE_UNITS 44 /* width reserved for the popup's button */

static void label(const char *text)
{
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, text);
    wr_gui_same_line(8);
}

/* ---- brush parameters ---- */

const WrBrushModeInfo *wr_current_brush_mode(const WrApp *app)
{
    return &wr_brush_modes[app->settings->brush.mode];
}

static void size(WrApp *app, double width)
{
    WrNumber spec = { .low = 1,
                      .high = 1000,
                      .hard_low = 0,
                      .hard_high = 2e9,
                      .reset = 2.0 * wr_preset_browser_own(app).radius,
                      .decimals = -1,
                      .unit = "px",
                      .logarithmic = true,
                      .tip = "Diameter of the brush in texels of the table.\n"
                             "Drag, click to type, Ctrl+click to reset." };
    double diameter = 2.0 * app->settings->brush.radius;
    if (wr_gui_number("size", width, &spec, &diameter))
        app->settings->brush.radius = diameter / 2.0;
}

void wr_option_hardness(WrApp *app, double width)
{
    WrNumber spec = { .low = 0,
                      .high = 1,
                      .reset = wr_preset_browser_own(app).hardness,
                      .decimals = 2,
                      .tip = "Share of the radius with full coverage." };
    wr_gui_number("hardness", width, &spec, &app->settings->brush.hardness);
}

void wr_option_strength(WrApp *app, double width)
{
    wr_strength_number(app, "strength", width);
}

static void percent(const char *id, double width, const char *tip, double *part)
{
    WrNumber spec = { .low = 0, .high = 100, .reset = 100, .decimals = 0, .unit = "%", .tip = tip };
    double value = *part * 100.0;
    if (wr_gui_number(id, width, &spec, &value)) *part = rint(value * 100.0) / 1e4;
}

void wr_option_opacity(WrApp *app, double width)
{
    percent("opacity", width, "Opacity of the whole stroke: overlaps never exceed it",
            &app->settings->brush.opacity);
}

static void flow(WrApp *app, double width)
{
    percent("flow", width, "Opacity of each dab: low flow builds up slowly",
            &app->settings->brush.flow);
}

void wr_option_to_height(WrApp *app, double width)
{
    static const WrNumber spec = {
        .low = 0,
        .high = 1,
        .hard_low = -1e30,
        .hard_high = 1e30,
        .reset = 0,
        .decimals = 3,
        .tip = "Target height of the brush. Ctrl+click on the table picks it."
    };
    wr_gui_number("to", width, &spec, &app->settings->brush.to);
}

static void reach(WrApp *app, double width)
{
    static const WrNumber spec = {
        .low = 0,
        .high = 64,
        .hard_high = 16384,
        .reset = 0,
        .decimals = 1,
        .unit = "px",
        .tip = "Radius of the neighbourhood that the mode reads; 0: an eighth of the brush's radius"
    };
    wr_gui_number("reach", width, &spec, &app->settings->brush.reach);
}

static WrColour mode_colour(WrBrushMode mode)
{
    return mode == WR_BRUSH_RAISE || mode == WR_BRUSH_LIFT  ? WR_COLOUR_RAISE
           : mode == WR_BRUSH_LOWER || mode == WR_BRUSH_CUT ? WR_COLOUR_LOWER
                                                            : WR_COLOUR_LEVEL;
}

static void modes(WrApp *app, double width, bool fills)
{
    const char *labels[WR_BRUSH_MODE_COUNT];
    int count = 0, chosen = 0, map[WR_BRUSH_MODE_COUNT];
    for (int i = 0; i < WR_BRUSH_MODE_COUNT; i++) {
        if (fills && wr_brush_modes[i].moves) continue;
        if (i == (int)app->settings->brush.mode) chosen = count;
        map[count] = i;
        labels[count++] = wr_brush_modes[i].label;
    }
    wr_gui_mark(mode_colour(app->settings->brush.mode));
    wr_gui_same_line(5);
    if (wr_gui_choice("mode", width, labels, count, &chosen))
        app->settings->brush.mode = (WrBrushMode)map[chosen];
    wr_gui_tip(wr_current_brush_mode(app)->help);
}

void wr_option_mode(WrApp *app, double width)
{
    modes(app, width, false);
}

void wr_option_fill_mode(WrApp *app, double width)
{
    modes(app, width, true);
}

void wr_option_pressure(WrApp *app, double width)
{
    WR_ROWS(names);
    static const char *const names[WR_PRESSURE_COUNT] = {
        [WR_ROW(WR_PRESSURE_STRENGTH)] = "strength",
        [WR_ROW(WR_PRESSURE_SIZE)] = "size",
        [WR_ROW(WR_PRESSURE_BOTH)] = "both",
        [WR_ROW(WR_PRESSURE_NONE)] = "nothing",
    };
    WR_ROWS_END(names, WR_PRESSURE_COUNT);
    int index = (int)app->settings->brush.pressure;
    if (wr_gui_choice("pressure", width, names, WR_PRESSURE_COUNT, &index))
        app->settings->brush.pressure = (WrBrushPressure)index;
    wr_gui_tip("Effect of higher pressure");
}

static void steady(WrApp *app, double width)
{
    WR_ROWS(names);
    static const char *const names[WR_SMOOTHING_COUNT] = {
        [WR_ROW(WR_SMOOTHING_OFF)] = "off",
        [WR_ROW(WR_SMOOTHING_SMOOTH)] = "smooth",
        [WR_ROW(WR_SMOOTHING_STRING)] = "on a string",
    };
    WR_ROWS_END(names, WR_SMOOTHING_COUNT);
    static const WrNumber spec = { .low = 2,
                                   .high = 200,
                                   .hard_low = 1,
                                   .hard_high = 1000,
                                   .reset = 40,
                                   .decimals = 0,
                                   .unit = "px",
                                   .logarithmic = true,
                                   .tip = "Largest distance of the brush behind the pointer" };
    WrSettings *s = app->settings;
    wr_gui_choice("steady", width, names, WR_SMOOTHING_COUNT, &s->steady);
    wr_gui_tip("Stabilizes strokes: the brush follows the pointer smoothly, or is pulled on a "
               "string behind it");
    if (s->steady == WR_SMOOTHING_OFF) return;
    wr_gui_same_line(6);
    wr_gui_number("length", 0.7 * width, &spec,
                  s->steady == WR_SMOOTHING_STRING ? &s->steady_string : &s->steady_smooth);
}

void wr_option_symmetry(WrApp *app, double width)
{
    (void)width;
    wr_gui_centre(wr_gui_px(28));
    if (wr_gui_icon_button("symmetry", WR_ICON_MIRROR, 28, app->settings->symmetric))
        wr_action_run(app, WR_ACT(symmetry));
    wr_gui_centre_end(wr_gui_px(28));
    wr_gui_tip(app->settings->symmetric ? "Symmetry is on" : "Symmetry: mirrors, turns, a lattice");
}

/* ---- the row ---- */

static bool is_labelled(const WrOption *item)
{
    return item->label[0] != '#';
}

/* For the search. */
static const char *name_of(const WrOption *item)
{
    return is_labelled(item) ? item->label : item->label + 2;
}

static double width_of(const WrOption *item)
{
    double w = wr_gui_px(item->units) + wr_gui_px(item->extra) + wr_gui_px(14);
    if (is_labelled(item)) w += wr_gui_text_width(WR_FONT_TEXT, item->label) + wr_gui_px(8);
    return w;
}

static void put(WrApp *app, const WrOption *item, bool in_row)
{
    const bool labelled = is_labelled(item);
    if (in_row) wr_gui_same_line(14);
    if (in_row && labelled) label(item->label);
    if (in_row || !labelled) wr_gui_name_row(name_of(item));
    if (!in_row) wr_gui_label(labelled ? item->label : "");
    item->draw(app, wr_gui_px(in_row ? item->units : 140));
    if (in_row || !labelled) wr_gui_name_item(name_of(item));
}

/* True if the search highlights one of the options in the popup. */
static bool is_found(const WrOption *items, int first, int count)
{
    for (int i = first; i < count; i++)
        if (items[i].here && wr_gui_light_waits(name_of(&items[i]))) return true;
    return false;
}

/* Show as many as fit, in order; the rest in a popup. */
void wr_option_row(WrApp *app, const WrOption *items, int count)
{
    wr_gui_same_line(0);
    double room = app->width - wr_gui_place() - wr_gui_px(12), all = 0.0;
    for (int i = 0; i < count; i++) all += items[i].here ? width_of(&items[i]) : 0.0;
    double most = all <= room ? room : room - wr_gui_px(MORE_UNITS);
    int i = 0;
    for (; i < count; i++) {
        if (!items[i].here) continue;
        most -= width_of(&items[i]);
        if (most < 0.0) break;
        put(app, &items[i], true);
    }
    if (i >= count) return;
    wr_gui_same_line(14);
    wr_gui_centre(wr_gui_px(28));
    const bool found = is_found(items, i, count);
    if (wr_gui_icon_button("more", WR_ICON_TUNE, 28, false) || found)
        wr_gui_popup_open("more_options");
    wr_gui_centre_end(wr_gui_px(28));
    wr_gui_tip("More options");
    if (!wr_gui_popup_begin("more_options")) return;
    wr_gui_width_at_least(280);
    for (; i < count; i++)
        if (items[i].here) put(app, &items[i], false);
    wr_gui_popup_end();
}

/* The brush's picture; a click opens the tab. */
static void thumbnail(WrApp *app)
{
    int index = wr_preset_browser_find(app, wr_preset_browser_chosen(app));
    const char *slash = strchr(wr_preset_browser_chosen(app), '/');
    double side = wr_gui_px(32);
    wr_gui_same_line(12);
    wr_gui_centre(side);
    if (wr_gui_tile("brush", wr_thumb_of(app, index, wr_gui_px(52)), side, false, false)) {
        app->shelf->kind = WR_STOCK_BRUSHES;
        wr_action_run(app, WR_ACT(brushes));
    }
    wr_gui_centre_end(side);
    char tip[200];
    snprintf(tip, sizeof tip, wr_words("%.160s\nClick for the brushes"),
             slash ? slash + 1 : wr_words("Round brush"));
    wr_gui_as_it_is(true);
    wr_gui_tip(tip);
    wr_gui_as_it_is(false);
}

void wr_option_brush_row(WrApp *app, const WrOption *first, int first_count)
{
    unsigned uses = wr_current_brush_mode(app)->uses;
    bool strong = (uses & WR_USES_STRENGTH) != 0,
         steadies = app->settings->steady != WR_SMOOTHING_OFF;
    bool forced = wr_tool_now(app)->mode != 0, round = app->settings->brush.preset == NULL;
    bool paints = wr_tool_now(app)->paints;
    const WrOption items[] = { { "##Brush mode", 104, 12, wr_option_mode, !forced },
                               { "Size", 92, 0, size, true },
                               { "Hardness", 74, 0, wr_option_hardness, true },
                               { "Strength", 74, 0, wr_option_strength, strong },
                               { "Height", 74, 0, wr_option_to_height, (uses & WR_USES_TO) != 0 },
                               { "Opacity", 74, 0, wr_option_opacity, !strong },
                               { "Reach", 74, 0, reach, (uses & WR_USES_REACH) != 0 },
                               { "##Symmetry", 28, 0, wr_option_symmetry, true },
                               { "Pressure", 86, 0, wr_option_pressure, round && paints },
                               { "Stabilizer", 96, steadies ? 74 : 0, steady, paints },
                               { "Flow", 70, 0, flow, true },
                               { "Opacity", 74, 0, wr_option_opacity, strong } };
    int count = (int)(sizeof items / sizeof *items);
    WrOption all[24];
    if (first_count > 0) memcpy(all, first, (size_t)first_count * sizeof *first);
    memcpy(all + first_count, items, sizeof items);
    thumbnail(app);
    wr_option_row(app, all, first_count + count);
}
