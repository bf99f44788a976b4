/* Text description of one preset. */
#include "cli/brushes.h"

#include "base/enum_rows.h"
#include "base/text.h"
#include "brush/tip.h"

#include <string.h>

/* ---- the brush ---- */

typedef void Tell(WrText *text, const char *name, double value);

static void tell_line(WrText *text, const char *name, double value)
{
    char number[WR_NUMBER_SIZE];
    wr_text_addf(text, "    %-14s %s\n", name, wr_number_print(value, number));
}

static void tell_json(WrText *text, const char *name, double value)
{
    wr_text_addf(text, ",\"%s\":", name);
    wr_text_add_json_number(text, value);
}

static void tell_numbers(const WrBrush *brush, Tell *tell, WrText *text)
{
    unsigned uses = wr_brush_modes[brush->mode].uses;
    tell(text, "radius", brush->radius);
    tell(text, "hardness", brush->hardness);
    if (uses & WR_USES_STRENGTH) tell(text, "strength", brush->strength);
    if (uses & WR_USES_TO) tell(text, "to", brush->to);
    if (uses & WR_USES_REACH) tell(text, "reach", brush->reach);
    tell(text, "opacity", brush->opacity);
    tell(text, "flow", brush->flow);
    tell(text, "spacing", brush->spacing);
    tell(text, "angle", brush->angle_deg);
    tell(text, "aspect", brush->aspect);
}

/* ---- settings ---- */

static int curve_points(const WrPreset *preset, int index, int input)
{
    const float(*points)[2];
    return wr_preset_curve(preset, index, input, &points);
}

/* True if the setting differs from its default. */
static bool is_told(const WrPreset *preset, int index)
{
    return !wr_preset_is_constant(preset, index) ||
           wr_preset_value(preset, index) != wr_preset_setting(index)->fallback;
}

static void settings_lines(const WrPreset *preset, WrSettingUse use, const char *title,
                           WrText *text)
{
    bool first = true;
    for (int i = 0; i < wr_preset_setting_count(); i++) {
        const WrSettingInfo *info = wr_preset_setting(i);
        char number[WR_NUMBER_SIZE];
        if (info->use != use || !is_told(preset, i)) continue;
        if (first) wr_text_addf(text, "  %s\n", title);
        first = false;
        wr_number_print_float((float)wr_preset_value(preset, i), number);
        wr_text_addf(text, "    %-28s %s", info->name, number);
        for (int k = 0, any = 0; k < wr_preset_input_count(); k++)
            if (curve_points(preset, i, k) > 0)
                wr_text_addf(text, "%s %s", any++ ? "," : "  by", wr_preset_input(k)->name);
        wr_text_add(text, "\n");
        if (use == WR_SETTING_MAPPED) wr_text_addf(text, "      %s\n", info->meaning);
    }
}

static void setting_json(const WrPreset *preset, int index, WrText *text)
{
    WR_ROWS(uses);
    static const char *const uses[] = { [WR_ROW(WR_SETTING_USED)] = "used",
                                        [WR_ROW(WR_SETTING_MAPPED)] = "mapped",
                                        [WR_ROW(WR_SETTING_IGNORED)] = "ignored" };
    WR_ROWS_END(uses, WR_SETTING_USES);
    const WrSettingInfo *info = wr_preset_setting(index);
    wr_text_addf(text, "{\"name\":\"%s\",\"use\":\"%s\",\"meaning\":", info->name, uses[info->use]);
    wr_text_add_json_string(text, info->meaning);
    wr_text_add(text, ",\"value\":");
    wr_text_add_json_number(text, wr_preset_value(preset, index));
    wr_text_add(text, ",\"inputs\":[");
    for (int k = 0, any = 0; k < wr_preset_input_count(); k++)
        if (curve_points(preset, index, k) > 0)
            wr_text_addf(text, "%s\"%s\"", any++ ? "," : "", wr_preset_input(k)->name);
    wr_text_add(text, "]}");
}

/* ---- whole description ---- */

static void tell_text(const WrPresetEntry *entry, const WrPreset *preset, WrText *text)
{
    const WrBrush brush = wr_preset_brush(preset);
    const WrTip *tip = wr_preset_tip(preset);
    const char *description = wr_preset_description(preset);
    wr_text_addf(text, "%s\n", entry->id);
    if (*description) wr_text_addf(text, "  %s\n", description);
    wr_text_addf(text, "  file %s\n", entry->path);
    if (*entry->group) wr_text_addf(text, "  group %s\n", entry->group);
    if (tip && *wr_tip_name(tip)) wr_text_addf(text, "  tip %s\n", wr_tip_name(tip));
    if (wr_preset_smudges(preset)) wr_text_add(text, "  drags heights along\n");
    if (wr_preset_sprays(preset)) wr_text_add(text, "  goes on while the pen rests\n");
    if (wr_preset_is_colour_only(preset))
        wr_text_add(text, "  changes colours alone: nothing for heights\n");
    wr_text_addf(text, "  brush\n    %-14s %s\n", "mode", wr_brush_modes[brush.mode].name);
    tell_numbers(&brush, tell_line, text);
    settings_lines(preset, WR_SETTING_USED, "settings, as MyPaint means them", text);
    settings_lines(preset, WR_SETTING_MAPPED, "settings that mean something for heights instead",
                   text);
    settings_lines(preset, WR_SETTING_IGNORED, "settings that are left out: colour", text);
}

static void tell_flag(WrText *text, const char *name, bool value)
{
    wr_text_addf(text, ",\"%s\":%s", name, value ? "true" : "false");
}

static void tell_string(WrText *text, const char *name, const char *value)
{
    wr_text_addf(text, ",\"%s\":", name);
    if (value) wr_text_add_json_string(text, value);
    else wr_text_add(text, "null");
}

static void tell_object(const WrPresetEntry *entry, const WrPreset *preset, WrText *text)
{
    const WrBrush brush = wr_preset_brush(preset);
    wr_text_add(text, "{\"id\":");
    wr_text_add_json_string(text, entry->id);
    tell_string(text, "name", entry->name);
    tell_string(text, "collection", entry->collection);
    tell_string(text, "group", entry->group);
    tell_string(text, "file", entry->path);
    tell_string(text, "picture", entry->picture);
    tell_string(text, "description", wr_preset_description(preset));
    tell_flag(text, "smudges", wr_preset_smudges(preset));
    tell_flag(text, "sprays", wr_preset_sprays(preset));
    tell_flag(text, "colour_only", wr_preset_is_colour_only(preset));
    tell_flag(text, "tip", wr_preset_tip(preset) != NULL);
    wr_text_addf(text, ",\"brush\":{\"mode\":\"%s\"", wr_brush_modes[brush.mode].name);
    tell_numbers(&brush, tell_json, text);
    tell_flag(text, "buildup", brush.buildup);
    wr_text_add(text, "},\"settings\":[");
    for (int i = 0, any = 0; i < wr_preset_setting_count(); i++) {
        if (!is_told(preset, i)) continue;
        if (any++) wr_text_add(text, ",");
        setting_json(preset, i, text);
    }
    wr_text_add(text, "]}\n");
}

void wr_brushes_report(const WrPresetEntry *entry, const WrPreset *preset, bool json, WrText *text)
{
    if (json) tell_object(entry, preset, text);
    else tell_text(entry, preset, text);
}
