/* Contact sheets and thumbnails of presets. */
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "cli/brush_sample.h"
#include "cli/brushes.h"
#include "image/image.h"
#include "image/caption.h"
#include "system/process.h"

#include <string.h>

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
    WrSampler *sampler = wr_sampler_new(cli, sheet->cell_w, sheet->cell_h, err);
    uint8_t *sample = wr_alloc((size_t)sheet->cell_w * (size_t)sheet->cell_h, 1);
    bool good = sampler;
    for (int i = 0; good && i < list->count; i++) {
        const WrPresetEntry *entry = list->entry[i];
        WrError fault;
        int x = places[i][0], y = places[i][1];
        note_progress(i, list->count);
        if (new_group(list, i)) draw_heading(sheet, entry, y);
        WrPreset *preset = wr_preset_read(entry->path, entry->id, &fault);
        if (preset) good = wr_sampler_paint(sampler, preset, sample, err);
        if (good && preset) blit(sheet, sample, x, y);
        const char *why = !preset                            ? "cannot be read"
                          : wr_preset_is_colour_only(preset) ? "colour only"
                                                             : NULL;
        if (good) draw_name(sheet, entry, why, x, y);
        wr_preset_free(preset);
        if (good && wr_cancel_asked(cli->cancel)) good = wr_fail(err, "cancelled");
    }
    note_progress(list->count, list->count);
    wr_free(sample);
    wr_sampler_free(sampler);
    return good;
}

bool wr_brushes_sheet(const WrCli *cli, const WrBrushList *list, const char *path, WrError *err)
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

void wr_brushes_thumbnail_name(const WrPresetEntry *entry, WrText *name)
{
    wr_text_clear(name);
    wr_text_add(name, entry->name);
    wr_text_add(name, "_prev.png");
    for (char *p = name->data; *p; p++) *p = *p == '/' ? '-' : *p;
}

bool wr_brushes_thumbnails(const WrCli *cli, const WrBrushList *list, const char *folder,
                           WrError *err)
{
    WrSampler *sampler = wr_sampler_new(cli, WR_THUMBNAIL_W, WR_THUMBNAIL_H, err);
    uint8_t *sample = wr_alloc((size_t)WR_THUMBNAIL_W * WR_THUMBNAIL_H, 1);
    WrText name = { 0 };
    bool good = sampler;
    for (int i = 0; good && i < list->count; i++) {
        const WrPresetEntry *entry = list->entry[i];
        note_progress(i, list->count);
        WrPreset *preset = wr_preset_read(entry->path, entry->id, err);
        wr_brushes_thumbnail_name(entry, &name);
        char *path = wr_path_join(folder, wr_text_get(&name));
        good = preset && wr_sampler_paint(sampler, preset, sample, err) &&
               wr_image_write_pixels(path, WR_THUMBNAIL_W, WR_THUMBNAIL_H, 1, WR_PIXEL_U8, false,
                                     sample, err);
        wr_preset_free(preset);
        wr_free(path);
        if (good && wr_cancel_asked(cli->cancel)) good = wr_fail(err, "cancelled");
    }
    note_progress(list->count, list->count);
    wr_text_fini(&name);
    wr_free(sample);
    wr_sampler_free(sampler);
    return good;
}
