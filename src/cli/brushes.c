#include "base/enum_rows.h"
#include "base/error.h"
#include "base/exactmath.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "brush/library.h"
#include "brush/preset.h"
#include "brush/tip.h"
#include "cli/cli.h"
#include "command/brush_sample.h"
#include "command/session.h"
#include "document/document.h"
#include "field/field.h"
#include "image/caption.h"
#include "image/image.h"
#include "render/frame/frame.h"
#include "scene/scene.h"
#include "system/process.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/* The presets of the library that a command lists. */
typedef struct WrBrushList {
    WrLibrary *library;          /* owned */
    const WrPresetEntry **entry; /* [count], borrowed from the library; the array is owned */
    int count;
} WrBrushList;

/* ---- Contact sheets and thumbnails of presets ---- */

#define WR_SHEET_MANY 96 /* presets; above this number samples are small */
#define WR_THUMBNAIL_W 128
#define WR_THUMBNAIL_H 96

enum { BACKGROUND = 38, HEADING = 235, NAME = 190, FAULT = 120 }; /* grey values */

typedef struct Sheet {
    int cell_w, cell_h; /* size of a sample, pixels */
    int columns, gap, name_h, heading_h;
    int width, height;
    uint8_t *pixels; /* [height][width], owned */
    WrLabel *names, *headings;
} Sheet;

static void note_progress(int index, int count)
{
    if (!wr_process_has_terminal()) return;
    if (index < count) fprintf(stderr, "\rbrush %d of %d ", index + 1, count);
    else fputs("\n", stderr);
}

static bool new_group(const WrBrushList *list, int index)
{
    return index == 0 || strcmp(list->entry[index]->group, list->entry[index - 1]->group) != 0 ||
           strcmp(list->entry[index]->collection, list->entry[index - 1]->collection) != 0;
}

/* Compute the upper left corner x, y of each entry's sample into places [count][2]; each group starts a row with a
 * heading above. Returns the sheet's height. */
static int lay_out(const Sheet *sheet, const WrBrushList *list, int (*places)[2])
{
    const int step_x = sheet->cell_w + sheet->gap;
    const int step_y = sheet->cell_h + sheet->name_h + sheet->gap;
    int column = 0, y = sheet->gap;
    for (int i = 0; i < list->count; i++) {
        if (new_group(list, i)) {
            y += (i > 0 ? step_y : 0) + sheet->heading_h;
            column = 0;
        } else if (column == sheet->columns) {
            y += step_y;
            column = 0;
        }
        places[i][0] = sheet->gap + column++ * step_x;
        places[i][1] = y;
    }
    return y + step_y;
}

static void blit(Sheet *sheet, const uint8_t *sample, int x, int y)
{
    for (int j = 0; j < sheet->cell_h; j++)
        memcpy(sheet->pixels + (size_t)(y + j) * (size_t)sheet->width + x,
               sample + (size_t)j * (size_t)sheet->cell_w, (size_t)sheet->cell_w);
}

static void draw_heading(Sheet *sheet, const WrPresetEntry *entry, int y)
{
    WrText text = { 0 };
    wr_text_addf(&text, "%s", entry->collection);
    if (*entry->group) wr_text_addf(&text, " / %s", entry->group);
    wr_label_draw(sheet->headings, wr_text_get(&text), sheet->gap, y - sheet->gap,
                  sheet->width - 2 * sheet->gap, HEADING, sheet->pixels, sheet->width,
                  sheet->height);
    wr_text_fini(&text);
}

/* Draw the preset's name without its folder, which is in the group heading. */
static void draw_name(Sheet *sheet, const WrPresetEntry *entry, const char *fault, int x, int y)
{
    const char *slash = strrchr(entry->name, '/');
    const char *name = slash ? slash + 1 : entry->name;
    const int baseline = y + sheet->cell_h + sheet->name_h - sheet->name_h / 3;
    wr_label_draw(sheet->names, name, x + 1, baseline, sheet->cell_w - 2, NAME, sheet->pixels,
                  sheet->width, sheet->height);
    if (fault)
        wr_label_draw(sheet->names, fault, x + 4, y + sheet->cell_h / 2, sheet->cell_w - 8, FAULT,
                      sheet->pixels, sheet->width, sheet->height);
}

static bool fill_sheet(const WrCli *cli, Sheet *sheet, const WrBrushList *list,
                       const int (*places)[2], WrError *err)
{
    WrBrushSample *sampler =
        wr_brush_sample_new(cli->pool, cli->isa, sheet->cell_w, sheet->cell_h, err);
    uint8_t *sample = wr_alloc((size_t)sheet->cell_w * (size_t)sheet->cell_h, 1);
    bool good = sampler;
    for (int i = 0; good && i < list->count; i++) {
        const WrPresetEntry *entry = list->entry[i];
        WrError fault;
        int x = places[i][0], y = places[i][1];
        note_progress(i, list->count);
        if (new_group(list, i)) draw_heading(sheet, entry, y);
        WrPreset *preset = wr_preset_read(entry->path, entry->id, &fault);
        if (preset) good = wr_brush_sample_paint(sampler, preset, sample, err);
        if (good && preset) blit(sheet, sample, x, y);
        const char *why = !preset                            ? "cannot be read"
                          : wr_preset_is_colour_only(preset) ? "colour only"
                                                             : NULL;
        if (good) draw_name(sheet, entry, why, x, y);
        wr_preset_free(preset);
        if (good && wr_cancel_requested(cli->cancel)) good = wr_fail(err, "cancelled");
    }
    note_progress(list->count, list->count);
    wr_free(sample);
    wr_brush_sample_free(sampler);
    return good;
}

/* Write one picture of all entries with their names, by collection and group; PNG, or the format of the extension. */
static bool brushes_sheet(const WrCli *cli, const WrBrushList *list, const char *path, WrError *err)
{
    const bool many = list->count > WR_SHEET_MANY;
    Sheet sheet = { .cell_w = many ? 96 : 192,
                    .cell_h = many ? 72 : 144,
                    .columns = many ? 20 : 6,
                    .gap = many ? 6 : 10,
                    .name_h = many ? 14 : 20,
                    .heading_h = many ? 24 : 32 };
    if (!wr_image_can_write(path, WR_PIXEL_U8, 1, false, err)) return false;
    int(*places)[2] = wr_alloc((size_t)list->count + 1, sizeof *places);
    sheet.width = sheet.gap + sheet.columns * (sheet.cell_w + sheet.gap);
    sheet.height = lay_out(&sheet, list, places);
    bool good = sheet.height <= WR_IMAGE_MAX ||
                wr_fail(err, "a sheet of %d presets: too many for one picture of %d pixels",
                        list->count, WR_IMAGE_MAX);
    size_t bytes = (size_t)sheet.width * (size_t)sheet.height;
    if (good) sheet.pixels = wr_try_alloc(bytes, 1, "the sheet", err);
    good = sheet.pixels && (sheet.names = wr_label_new(many ? 10 : 14, err)) &&
           (sheet.headings = wr_label_new(many ? 14 : 18, err));
    if (good) {
        memset(sheet.pixels, BACKGROUND, bytes);
        good = fill_sheet(cli, &sheet, list, (const int(*)[2])places, err) &&
               wr_image_write_pixels(path, sheet.width, sheet.height, 1, WR_PIXEL_U8, false,
                                     sheet.pixels, err);
    }
    wr_label_free(sheet.names);
    wr_label_free(sheet.headings);
    wr_free(sheet.pixels);
    wr_free(places);
    return good;
}

/* File name of an entry's thumbnail in MyPaint's form: its name with '/' as '-', and "_prev.png". */
static void brushes_thumbnail_name(const WrPresetEntry *entry, WrText *name)
{
    wr_text_clear(name);
    wr_text_add(name, entry->name);
    wr_text_add(name, "_prev.png");
    for (char *p = name->data; *p; p++) *p = *p == '/' ? '-' : *p;
}

/* Write one picture for each entry into an existing folder. */
static bool brushes_thumbnails(const WrCli *cli, const WrBrushList *list, const char *folder,
                               WrError *err)
{
    WrBrushSample *sampler =
        wr_brush_sample_new(cli->pool, cli->isa, WR_THUMBNAIL_W, WR_THUMBNAIL_H, err);
    uint8_t *sample = wr_alloc((size_t)WR_THUMBNAIL_W * WR_THUMBNAIL_H, 1);
    WrText name = { 0 };
    bool good = sampler;
    for (int i = 0; good && i < list->count; i++) {
        const WrPresetEntry *entry = list->entry[i];
        note_progress(i, list->count);
        WrPreset *preset = wr_preset_read(entry->path, entry->id, err);
        brushes_thumbnail_name(entry, &name);
        char *path = wr_path_join(folder, wr_text_get(&name));
        good = preset && wr_brush_sample_paint(sampler, preset, sample, err) &&
               wr_image_write_pixels(path, WR_THUMBNAIL_W, WR_THUMBNAIL_H, 1, WR_PIXEL_U8, false,
                                     sample, err);
        wr_preset_free(preset);
        wr_free(path);
        if (good && wr_cancel_requested(cli->cancel)) good = wr_fail(err, "cancelled");
    }
    note_progress(list->count, list->count);
    wr_text_fini(&name);
    wr_free(sample);
    wr_brush_sample_free(sampler);
    return good;
}

/* ---- Text description of one preset ---- */

/* ---- the brush ---- */

typedef void Tell(WrText *text, const char *name, double value);

static void report_line(WrText *text, const char *name, double value)
{
    char number[WR_NUMBER_SIZE];
    wr_text_addf(text, "    %-14s %s\n", name, wr_number_print(value, number));
}

static void report_json(WrText *text, const char *name, double value)
{
    wr_text_addf(text, ",\"%s\":", name);
    wr_text_add_json_number(text, value);
}

static void report_numbers(const WrBrush *brush, Tell *tell, WrText *text)
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

static void report_text(const WrPresetEntry *entry, const WrPreset *preset, WrText *text)
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
    report_numbers(&brush, report_line, text);
    settings_lines(preset, WR_SETTING_USED, "settings, as MyPaint means them", text);
    settings_lines(preset, WR_SETTING_MAPPED, "settings that mean something for heights instead",
                   text);
    settings_lines(preset, WR_SETTING_IGNORED, "settings that are left out: colour", text);
}

static void report_flag(WrText *text, const char *name, bool value)
{
    wr_text_addf(text, ",\"%s\":%s", name, value ? "true" : "false");
}

static void report_string(WrText *text, const char *name, const char *value)
{
    wr_text_addf(text, ",\"%s\":", name);
    if (value) wr_text_add_json_string(text, value);
    else wr_text_add(text, "null");
}

static void report_object(const WrPresetEntry *entry, const WrPreset *preset, WrText *text)
{
    const WrBrush brush = wr_preset_brush(preset);
    wr_text_add(text, "{\"id\":");
    wr_text_add_json_string(text, entry->id);
    report_string(text, "name", entry->name);
    report_string(text, "collection", entry->collection);
    report_string(text, "group", entry->group);
    report_string(text, "file", entry->path);
    report_string(text, "picture", entry->picture);
    report_string(text, "description", wr_preset_description(preset));
    report_flag(text, "smudges", wr_preset_smudges(preset));
    report_flag(text, "sprays", wr_preset_sprays(preset));
    report_flag(text, "colour_only", wr_preset_is_colour_only(preset));
    report_flag(text, "tip", wr_preset_tip(preset) != NULL);
    wr_text_addf(text, ",\"brush\":{\"mode\":\"%s\"", wr_brush_modes[brush.mode].name);
    report_numbers(&brush, report_json, text);
    report_flag(text, "buildup", brush.buildup);
    wr_text_add(text, "},\"settings\":[");
    for (int i = 0, any = 0; i < wr_preset_setting_count(); i++) {
        if (!is_told(preset, i)) continue;
        if (any++) wr_text_add(text, ",");
        setting_json(preset, i, text);
    }
    wr_text_add(text, "]}\n");
}

/* Print everything about a preset, as lines or as one JSON object and a line end. */
static void brushes_report(const WrPresetEntry *entry, const WrPreset *preset, bool json,
                           WrText *text)
{
    if (json) report_object(entry, preset, text);
    else report_text(entry, preset, text);
}

/* ---- cmd brushes ---- */

/* ---- choice of presets ---- */

static const WrPresetEntry *entry_at(const WrLibrary *library, const char *path)
{
    for (int i = 0; i < wr_library_count(library); i++)
        if (strcmp(wr_library_entry(library, i)->path, path) == 0)
            return wr_library_entry(library, i);
    return NULL;
}

/* Presets that the words name, in their order. */
static bool choose_named(const WrCli *cli, WrBrushList *list, WrError *err)
{
    for (int i = 0; i < cli->word_count; i++) {
        char *path = wr_library_find(cli->words[i], err);
        const WrPresetEntry *entry = path ? entry_at(list->library, path) : NULL;
        wr_free(path);
        if (path && !entry)
            wr_fail(err, "brushes: %.200s: not in a collection: `wrinkle brushes` lists them",
                    cli->words[i]);
        if (!entry) return false;
        list->entry[list->count++] = entry;
    }
    return true;
}

/* All presets whose collection has this name or prefix: "mypaint" is both of its versions. */
static bool choose_all(const char *collection, WrBrushList *list, WrError *err)
{
    const int count = wr_library_count(list->library);
    for (int i = 0; i < count; i++) {
        const WrPresetEntry *entry = wr_library_entry(list->library, i);
        if (!collection || strncmp(collection, entry->collection, strlen(collection)) == 0)
            list->entry[list->count++] = entry;
    }
    if (list->count > 0 || !collection) return true;
    WrText known = { 0 };
    const char *last = "";
    for (int i = 0; i < count; i++) {
        const WrPresetEntry *entry = wr_library_entry(list->library, i);
        if (strcmp(entry->collection, last) != 0)
            wr_text_addf(&known, "%s%s", known.length ? ", " : "", entry->collection);
        last = entry->collection;
    }
    wr_fail(err, "--collection %.60s: has no presets here; there are: %s", collection,
            wr_text_get(&known));
    wr_text_fini(&known);
    return false;
}

/* ---- lists ---- */

/* Append the first sentence of a description, since a list has no room for more. */
static void add_first_sentence(WrText *text, const char *description)
{
    const char *end = strpbrk(description, "\r\n");
    const char *stop = strstr(description, ". ");
    size_t length = end ? (size_t)(end - description) : strlen(description);
    if (stop && (size_t)(stop - description) < length) length = (size_t)(stop - description);
    wr_text_add_n(text, description, length);
}

static void list_lines(const WrBrushList *list, WrText *text)
{
    const char *collection = "", *group = "";
    for (int i = 0; i < list->count; i++) {
        const WrPresetEntry *entry = list->entry[i];
        WrError why;
        if (strcmp(entry->collection, collection) != 0) {
            wr_text_addf(text, "%s%s\n", i > 0 ? "\n" : "", entry->collection);
            group = "";
        }
        if (strcmp(entry->group, group) != 0) wr_text_addf(text, "  %s\n", entry->group);
        collection = entry->collection;
        group = entry->group;
        WrPreset *preset = wr_preset_read(entry->path, entry->id, &why);
        wr_text_addf(text, "    %-24s", entry->name);
        if (!preset) wr_text_addf(text, " cannot be read: %s", why.text);
        else if (*wr_preset_description(preset)) {
            wr_text_add(text, " ");
            add_first_sentence(text, wr_preset_description(preset));
        }
        wr_text_add(text, "\n");
        wr_preset_free(preset);
    }
}

static bool report_each(const WrCli *cli, const WrBrushList *list, WrText *text, WrError *err)
{
    for (int i = 0; i < list->count; i++) {
        WrPreset *preset = wr_preset_read(list->entry[i]->path, list->entry[i]->id, err);
        if (!preset) return false;
        if (i > 0 && !cli->json) wr_text_add(text, "\n");
        brushes_report(list->entry[i], preset, cli->json, text);
        wr_preset_free(preset);
    }
    return true;
}

/* ---- the subcommand ---- */

/* Print the table of brushes/README.md. */
static void settings_table(WrText *text)
{
    WR_ROWS(uses);
    static const char *const uses[] = { [WR_ROW(WR_SETTING_USED)] = "as MyPaint means it",
                                        [WR_ROW(WR_SETTING_MAPPED)] = "something else",
                                        [WR_ROW(WR_SETTING_IGNORED)] = "nothing" };
    WR_ROWS_END(uses, WR_SETTING_USES);
    wr_text_add(text, "| setting | means for heights | from | to | |\n"
                      "| --- | --- | --- | --- | --- |\n");
    for (int i = 0; i < wr_preset_setting_count(); i++) {
        const WrSettingInfo *info = wr_preset_setting(i);
        char low[WR_NUMBER_SIZE], high[WR_NUMBER_SIZE];
        wr_text_addf(text, "| `%s` | %s | %s | %s | %s |\n", info->name, uses[info->use],
                     wr_number_print_float((float)info->low, low),
                     wr_number_print_float((float)info->high, high), info->meaning);
    }
}

static bool answer(const WrCli *cli, const WrBrushList *list, WrText *text, WrError *err)
{
    if (cli->sheet && !brushes_sheet(cli, list, cli->sheet, err)) return false;
    if (cli->thumbnails && !brushes_thumbnails(cli, list, cli->thumbnails, err)) return false;
    if (cli->settings) settings_table(text);
    if (cli->sheet || cli->thumbnails || cli->settings) return true;
    if (cli->word_count > 0 || cli->json) return report_each(cli, list, text, err);
    list_lines(list, text);
    return true;
}

int wr_cli_brushes(const WrCli *cli)
{
    WrError err = { "" };
    if (cli->collection && cli->word_count > 0) {
        wr_fail(&err, "brushes: either --collection or names, not both");
        return wr_cli_fail(cli, WR_EXIT_USAGE, &err);
    }
    WrText text = { 0 };
    WrBrushList list = { .library = wr_library_new() };
    /* Without names, thumbnails are made for the presets shipped with the program. */
    const char *collection = cli->collection || !cli->thumbnails ? cli->collection : "wrinkle";
    size_t room = (size_t)(wr_library_count(list.library) + cli->word_count) + 1;
    list.entry = wr_alloc(room, sizeof *list.entry);
    bool good = (cli->word_count > 0 ? choose_named(cli, &list, &err)
                                     : choose_all(collection, &list, &err)) &&
                answer(cli, &list, &text, &err);
    int status = good ? wr_cli_print(cli, &text) : wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    wr_free(list.entry);
    wr_library_free(list.library);
    wr_text_fini(&text);
    return status;
}
