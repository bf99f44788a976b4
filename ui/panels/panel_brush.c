/* Parameters of the brush, and the settings of a preset that affect heights. */
#include "ui/app/state/app_state.h"

#include "base/enum_rows.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/panels/panel_dynamics.h"
#include "ui/panels/panels.h"
#include "ui/canvas/tools/stroke_input.h"
#include "ui/canvas/tools/option_row.h"
#include "ui/canvas/tools/preset_browser.h"
#include "ui/canvas/tools/preset_overrides.h"

#include "brush/brush.h"
#include "brush/preset.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- the brush ---- */

static bool number(const char *label, const WrNumber *spec, double *value)
{
    wr_gui_label(label);
    return wr_gui_number(label, 0, spec, value) != WR_EDIT_NONE;
}

static void percent(const char *label, const char *tip, double *part)
{
    WrNumber spec = { .low = 0, .high = 100, .reset = 100, .decimals = 0, .unit = "%", .tip = tip };
    double value = *part * 100.0;
    if (number(label, &spec, &value)) *part = rint(value * 100.0) / 1e4;
}

static void basic(WrApp *app)
{
    WrBrush *b = &app->settings->brush, own = wr_preset_browser_own(app);
    unsigned uses = wr_brush_modes[b->mode].uses;
    WrNumber size = { .low = 1,
                      .high = 1000,
                      .hard_high = 2e9,
                      .reset = 2.0 * own.radius,
                      .decimals = -1,
                      .unit = "px",
                      .logarithmic = true,
                      .tip = "Diameter in texels of the table" };
    WrNumber hard = { .low = 0,
                      .high = 1,
                      .reset = own.hardness,
                      .decimals = 2,
                      .tip = "Share of the radius with full strength" };
    WrNumber to = { .low = 0,
                    .high = 1,
                    .hard_low = -1e30,
                    .hard_high = 1e30,
                    .reset = own.to,
                    .decimals = 3,
                    .tip = "Target height of the mode" };
    WrNumber reach = {
        .low = 0,
        .high = 64,
        .hard_high = 16384,
        .reset = own.reach,
        .decimals = 1,
        .unit = "px",
        .tip = "Radius of the neighbourhood that the mode reads; 0: an eighth of the brush's radius"
    };
    double diameter = 2.0 * b->radius;
    if (number("Size", &size, &diameter)) b->radius = diameter / 2.0;
    number("Hardness", &hard, &b->hardness);
    if (uses & WR_USES_STRENGTH) {
        wr_gui_label("Strength");
        wr_strength_number(app, "Strength", 0);
    }
    if (uses & WR_USES_TO) number("Height", &to, &b->to);
    if (uses & WR_USES_REACH) number("Reach", &reach, &b->reach);
    percent("Opacity", "Opacity of the whole stroke: overlaps never exceed it", &b->opacity);
    percent("Flow", "Opacity of each dab: low flow builds up slowly", &b->flow);
    wr_gui_label("Build up");
    wr_gui_check("##buildup", &b->buildup);
    wr_gui_tip("Adds up where the stroke crosses itself, and while the pen rests");
    wr_gui_label("Keep size");
    wr_gui_check("##lock", &app->settings->lock_size);
    wr_gui_tip("Keeps this size when another brush is chosen");
}

static void dabs(WrApp *app)
{
    WrBrush *b = &app->settings->brush, own = wr_preset_browser_own(app);
    bool preset = b->preset != NULL;
    WrNumber spacing = {
        .low = 0,
        .high = 2,
        .hard_high = 10,
        .reset = own.spacing,
        .decimals = 2,
        .tip = "Distance between dabs as a share of the radius; 0: the mode's default"
    };
    WrNumber angle = { .low = -180,
                       .high = 180,
                       .hard_low = -360,
                       .hard_high = 360,
                       .reset = own.angle_deg,
                       .decimals = 0,
                       .unit = "\xc2\xb0",
                       .tip = "Rotates the dab anticlockwise" };
    WrNumber aspect = { .low = 1,
                        .high = 10,
                        .hard_low = 1,
                        .hard_high = 100,
                        .reset = own.aspect,
                        .decimals = 2,
                        .tip = "Length divided by width" };
    if (!preset) number("Spacing", &spacing, &b->spacing);
    number("Angle", &angle, &b->angle_deg);
    number("Aspect", &aspect, &b->aspect);
    wr_gui_label("Follow");
    wr_gui_check("##follow", &b->follow);
    wr_gui_tip("Measures the angle from the stroke's direction");
}

static void chance(WrApp *app)
{
    WrBrush *b = &app->settings->brush, own = wr_preset_browser_own(app);
    WrNumber place = { .low = 0,
                       .high = 4,
                       .hard_high = 100,
                       .reset = own.jitter_place,
                       .decimals = 2,
                       .tip = "Scatters dabs by up to this distance, in radii" };
    WrNumber angle = { .low = 0,
                       .high = 180,
                       .reset = own.jitter_angle_deg,
                       .decimals = 0,
                       .unit = "\xc2\xb0",
                       .tip = "Rotates dabs at random by up to this angle" };
    WrNumber size = { .low = 0,
                      .high = 1,
                      .reset = own.jitter_size,
                      .decimals = 2,
                      .tip = "Shrinks dabs at random by up to this share" };
    number("Position", &place, &b->jitter_place);
    number("Angle ", &angle, &b->jitter_angle_deg);
    number("Size ", &size, &b->jitter_size);
}

static void pressure(WrApp *app)
{
    if (app->settings->brush.preset) return; /* the preset has its own curves */
    wr_gui_label("Pressure");
    wr_option_pressure(app, 0);
}

/* ---- settings of a preset ---- */

#define CURVE_UNITS 24 /* size of the button that opens a setting's curves */

#define GROUP_LIST(X)                                                                              \
    X(DABS, "DABS")                                                                                \
    X(SCATTER, "SCATTER")                                                                          \
    X(HAND, "HAND")                                                                                \
    X(SHAPE, "SHAPE")                                                                              \
    X(DRAGGING, "DRAGGING")                                                                        \
    X(MORE, "MORE")
enum { GROUP_LIST(WR_WORD_ID) GROUPS };
static const char *const groups[] = { GROUP_LIST(WR_WORD) };

/* The group of a setting; -1: shown elsewhere, or without effect on heights. */
static int group_of(const WrSettingInfo *info)
{
    static const struct {
        const char *name;
        int group;
    } begins[] = { { "radius_logarithmic", -1 },
                   { "hardness", -1 },
                   { "opaque", DABS },
                   { "dabs_", DABS },
                   { "anti_aliasing", DABS },
                   { "radius_by_random", SCATTER },
                   { "offset_", SCATTER },
                   { "slow_tracking", HAND },
                   { "tracking_noise", HAND },
                   { "pressure_gain", HAND },
                   { "stroke_", HAND },
                   { "elliptical", SHAPE },
                   { "direction_filter", SHAPE },
                   { "snap_to_pixel", SHAPE },
                   { "smudge", DRAGGING } };
    if (info->use == WR_SETTING_IGNORED) return -1;
    for (size_t i = 0; i < sizeof begins / sizeof *begins; i++)
        if (strncmp(info->name, begins[i].name, strlen(begins[i].name)) == 0)
            return begins[i].group;
    return MORE;
}

static void setting(WrApp *app, int index)
{
    const WrSettingInfo *info = wr_preset_setting(index);
    double own = wr_preset_value(app->shelf->preset, index), value = own;
    bool changed = wr_tuning_get(app->brush_files->set, info->name, &value);
    bool curve = !wr_preset_is_constant(app->shelf->tuned, index);
    char tip[512];
    snprintf(tip, sizeof tip, "%.300s\n%.60s%s%s", wr_words(info->meaning), info->name,
             curve ? wr_words("; the pen or the motion rotates it too") : "",
             changed ? wr_words(". Changed: Ctrl+click restores the preset's value") : "");
    WrNumber spec = { .low = info->low,
                      .high = info->high > info->low ? info->high : info->low + 1,
                      .reset = own,
                      .decimals = 2,
                      .tip = tip };
    char label[64];
    snprintf(label, sizeof label, "%s%.40s", changed ? "\xe2\x80\xa2 " : "", wr_words(info->label));
    wr_gui_push_id(index);
    wr_gui_label(label);
    WrEdit edit =
        wr_gui_number(info->name, wr_gui_available() - wr_gui_px(CURVE_UNITS + 6), &spec, &value);
    wr_gui_same_line(6);
    if (wr_gui_icon_button("curve", WR_ICON_CURVE, CURVE_UNITS, curve))
        wr_dialog_dynamics_open(app, index);
    wr_gui_tip("Effect of pen and motion, as curves");
    wr_gui_pop_id();
    if (edit != WR_EDIT_NONE)
        wr_preset_browser_tune(app, info->name,
                               value == own ? (double)NAN : rint(value * 1e4) / 1e4);
}

static void preset_settings(WrApp *app)
{
    int changed = wr_tuning_count(app->brush_files->set), all = wr_preset_setting_count();
    if (!wr_gui_fold("THE PRESET'S OWN SETTINGS", true)) return;
    if (changed > 0) {
        char text[64];
        snprintf(text, sizeof text,
                 changed > 1 ? wr_words("Take back %d changes") : wr_words("Take back %d change"),
                 changed);
        if (wr_gui_chip(WR_ICON_BACK, text)) wr_preset_browser_tune_all(app, NULL);
    }
    for (int g = 0; g < GROUPS; g++) {
        if (!wr_gui_fold(groups[g], false)) continue;
        for (int i = 0; i < all && app->shelf->preset; i++)
            if (group_of(wr_preset_setting(i)) == g) setting(app, i);
    }
}

void wr_panel_brush(WrApp *app)
{
    basic(app);
    pressure(app);
    if (wr_gui_fold("DABS", false)) dabs(app);
    if (!app->settings->brush.preset && wr_gui_fold("RANDOMNESS", false)) chance(app);
    if (app->shelf->preset) preset_settings(app);
}

void wr_dialog_preset(WrApp *app)
{
    WrPresetBrowser *shelf = app->shelf;
    char name[sizeof shelf->name];
    if (!wr_gui_dialog_begin("Save the brush as a preset", 380)) return;
    wr_gui_text_wrapped(
        WR_FONT_TEXT, WR_COLOUR_LABEL,
        "Saves all settings of the current brush, in a file that MyPaint can read too.");
    wr_gui_space(4);
    wr_gui_label("Name");
    bool enter =
        wr_gui_text_field("##name", 0, shelf->name, sizeof shelf->name, app->dialog->fresh);
    memcpy(name, shelf->name, sizeof name);
    int answer = wr_dialog_buttons(app, "Save", name[0] != '\0');
    if (enter && answer == 0 && name[0]) {
        answer = 1;
        wr_dialog_close(app);
    }
    if (answer > 0) wr_preset_browser_open_save(app, name);
    wr_gui_dialog_end();
}
