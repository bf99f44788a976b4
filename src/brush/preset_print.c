/* A preset as text. */
#include "base/error.h"
#include "base/exactmath.h"
#include "base/text.h"
#include "brush/preset_internal.h"

#include <math.h>
#include <string.h>

#define LN2 0.69314718055994530942

static void add_text(WrText *text, const char *name, const char *value)
{
    if (!value) return;
    wr_text_addf(text, "    \"%s\": ", name);
    wr_text_add_json_string(text, value);
    wr_text_add(text, ",\n");
}

static void add_curve(WrText *text, const WrCurve *curve, bool first)
{
    char x[WR_NUMBER_SIZE], y[WR_NUMBER_SIZE];
    wr_text_addf(text, "%s\"%s\": [", first ? " " : ", ", wr_preset_input(curve->input)->name);
    for (int i = 0; i < curve->count; i++)
        wr_text_addf(text, "%s[%s, %s]", i > 0 ? ", " : "",
                     wr_number_print_float(curve->points[i][0], x),
                     wr_number_print_float(curve->points[i][1], y));
    wr_text_add(text, "]");
}

static void add_setting(WrText *text, const WrPreset *preset, int setting, double base, bool last)
{
    bool first = true;
    wr_text_addf(text, "        \"%s\": { \"base_value\": ", wr_preset_setting(setting)->name);
    wr_text_add_number(text, base);
    wr_text_add(text, ", \"inputs\": {");
    for (int input = 0; input < wr_preset_input_count(); input++) {
        const WrCurve *curve = wr_preset_find_curve(preset, setting, input);
        if (!curve) continue;
        add_curve(text, curve, first);
        first = false;
    }
    wr_text_addf(text, "%s} }%s\n", first ? "" : " ", last ? "" : ",");
}

static void add_number(WrText *text, const char *name, double value)
{
    wr_text_addf(text, ", \"%s\": ", name);
    wr_text_add_number(text, value);
}

/* Writes the brush's properties beyond the settings; defaults are omitted. */
static void add_relief(WrText *text, const WrPreset *preset, const WrBrush *brush, bool odd_radius)
{
    WrBrush usual = wr_brush_default();
    wr_text_addf(text, "    \"wrinkle\": { \"mode\": \"%s\"", wr_brush_modes[brush->mode].name);
    add_number(text, "strength", brush->strength);
    if (odd_radius) add_number(text, "radius", brush->radius);
    if (brush->to != usual.to) add_number(text, "to", brush->to);
    if (brush->opacity != usual.opacity) add_number(text, "opacity", brush->opacity);
    if (brush->flow != usual.flow) add_number(text, "flow", brush->flow);
    if (brush->buildup) wr_text_add(text, ", \"buildup\": true");
    if (brush->reach > 0.0) add_number(text, "reach", brush->reach);
    if (brush->aspect > 1.0) add_number(text, "aspect", brush->aspect);
    if (brush->angle_deg != 0.0) add_number(text, "angle", brush->angle_deg);
    if (brush->follow) wr_text_add(text, ", \"follow\": true");
    if (brush->jitter_place > 0.0 || brush->jitter_angle_deg > 0.0 || brush->jitter_size > 0.0) {
        char place[WR_NUMBER_SIZE], angle[WR_NUMBER_SIZE], size[WR_NUMBER_SIZE];
        wr_text_addf(text, ", \"jitter\": [%s, %s, %s]",
                     wr_number_print(brush->jitter_place, place),
                     wr_number_print(brush->jitter_angle_deg, angle),
                     wr_number_print(brush->jitter_size, size));
    }
    if (preset->tip_file && brush->tip == preset->tip) {
        wr_text_add(text, ", \"tip\": ");
        wr_text_add_json_string(text, preset->tip_file);
        wr_text_addf(text, ", \"tip_sha256\": \"%s\"", preset->tip_sha256);
    }
    wr_text_add(text, " },\n");
}

void wr_preset_print(const WrPreset *preset, const WrBrush *brush, WrText *text)
{
    const WrSettingInfo *radius = wr_preset_setting(MYPAINT_BRUSH_SETTING_RADIUS_LOGARITHMIC);
    double log_radius = brush->radius > 0.0 ? wr_log2(brush->radius) * LN2 : radius->low;
    bool odd = !(log_radius >= radius->low && log_radius <= radius->high);
    log_radius = log_radius > radius->high  ? radius->high
                 : log_radius > radius->low ? log_radius
                                            : radius->low;
    wr_text_add(text, "{\n");
    add_text(text, "comment", preset->comment);
    add_text(text, "group", preset->group);
    add_text(text, "description", preset->description);
    add_text(text, "notes", preset->notes);
    add_relief(text, preset, brush, odd);
    wr_text_add(text, "    \"settings\": {\n");
    for (int i = 0; i < MYPAINT_BRUSH_SETTINGS_COUNT; i++) {
        double base = preset->base[i];
        if (i == MYPAINT_BRUSH_SETTING_RADIUS_LOGARITHMIC) base = log_radius;
        if (i == MYPAINT_BRUSH_SETTING_HARDNESS) base = brush->hardness;
        add_setting(text, preset, i, base, i == MYPAINT_BRUSH_SETTINGS_COUNT - 1);
    }
    wr_text_add(text, "    },\n    \"version\": 3\n}\n");
}
