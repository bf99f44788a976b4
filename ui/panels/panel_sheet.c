/* Export sheet dialog. */
#include "ui/panels/panel_sheet.h"
#include "ui/app/state/app_options.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/session_view.h"
#include "ui/toolkit/words.h"
#include "ui/toolkit/gui_sdl_renderer.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/document.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"

#include "base/enum_rows.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "command/command_line.h"
#include "command/session.h"
#include "command/variants.h"
#include "document/document.h"
#include "field/field.h"
#include "scene/scene.h"
#include "system/clock.h"
#include "system/path.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Background work: pictures while the dialog is open; files after the button or, in live export, after each pause in
   editing. Live export ends at the first error. */

/* Pause in editing before files are written again, so that large files are not begun after each of several strokes:
   the time of the last writing beyond SOON_SECONDS, at most PAUSE_SECONDS. Small files are written at once. */
#define PAUSE_SECONDS 0.5
#define SOON_SECONDS 0.25

/* ---- settings and their storage in the document ---- */

/* Material files beside the maps, as the word of `maps`. */
static const struct {
    const char *label, *word;
} material_choices[] = { { "As the set has it", NULL },
                         { "No material file", "material=none" },
                         { "MaterialX", "material=mtlx" },
                         { "USD", "material=usda" },
                         { "glTF with its mesh", "material=gltf" },
                         { "All material files", "material=all" } };

static bool is_same(const WrSheetRequest *a, const WrSheetRequest *b)
{
    return strcmp(a->as, b->as) == 0 && strcmp(a->folder, b->folder) == 0 &&
           strcmp(a->name, b->name) == 0 && a->depth == b->depth && a->size == b->size &&
           a->range == b->range;
}

/* Store the settings in the document by a command, if they have changed. */
static void keep(WrApp *app)
{
    static const char *const depths[] = { "set", "8", "16", "32" };
    static const char *const sizes[] = { "table", "half", "quarter", "power" };
    static const char *const ranges[] = { "set", "auto", "unit", "signed" };
    const WrSheetRequest *ask = &app->sheet->ask;
    if (is_same(ask, &wr_session_document(app->session)->scene->sheet)) return;
    WrText line = { 0 };
    wr_text_add(&line, "sheet ");
    wr_text_add_word(&line, ask->as);
    wr_text_add(&line, " folder=");
    wr_text_add_word(&line, ask->folder);
    wr_text_add(&line, " name=");
    wr_text_add_word(&line, ask->name);
    wr_text_addf(&line, " depth=%s size=%s range=%s", depths[ask->depth], sizes[ask->size],
                 ranges[ask->range]);
    wr_app_run_slow(app, wr_text_get(&line));
    wr_text_fini(&line);
}

/* Default folder and name: those of the document. */
static void take_place(const WrApp *app, WrSheetRequest *ask)
{
    const WrSheetRequest *kept = &wr_session_document(app->session)->scene->sheet;
    *ask = *kept;
    if (!*ask->as) snprintf(ask->as, sizeof ask->as, "%s", wr_map_set_rows[0].name);
    if (*ask->folder && *ask->name) return;
    const char *path = wr_session_path(app->session);
    char *here = wr_path_real(".");
    WrText name = { 0 };
    wr_map_set_cell_name(path, &name);
    snprintf(ask->name, sizeof ask->name, "%.120s", wr_text_get(&name));
    wr_text_fini(&name);
    const char *slash = strrchr(path, '/');
    if (slash)
        snprintf(ask->folder, sizeof ask->folder, "%.*s", (int)(slash - path),
                 slash > path ? path : "/");
    else snprintf(ask->folder, sizeof ask->folder, "%s", here ? here : ".");
    free(here);
}

/* created on first use */
static WrSheetState *sheet_open(WrApp *app)
{
    if (app->sheet) return app->sheet;
    app->sheet = wr_alloc(1, sizeof *app->sheet);
    take_place(app, &app->sheet->ask);
    app->sheet->names = wr_map_set_names();
    app->sheet->pause = PAUSE_SECONDS;
    return app->sheet;
}

static void forget(WrApp *app)
{
    WrSheetState *sheet = app->sheet;
    if (!sheet) return;
    for (int i = 0; i < WR_MAP_SET_ENTRIES_MAX; i++) {
        if (sheet->pictures[i]) SDL_DestroyTexture(sheet->pictures[i]);
        sheet->pictures[i] = NULL;
    }
    for (int i = 0; i < 2; i++) {
        if (sheet->greens[i]) SDL_DestroyTexture(sheet->greens[i]);
        sheet->greens[i] = NULL;
    }
    sheet->looked_key = 0;
}

void wr_sheet_free(WrApp *app)
{
    WrSheetState *sheet = app->sheet;
    if (!sheet) return;
    wr_job_free(sheet->look);
    wr_job_free(sheet->write);
    forget(app);
    wr_sheet_look_free(sheet->shown);
    wr_map_set_names_free(&sheet->names);
    wr_free(sheet);
    app->sheet = NULL;
}

/* ---- detection of changes ---- */

/* Scene lines without effect on maps. */
static bool is_seen_only(const char *line, size_t length)
{
    static const char *const verbs[] = { "camera",      "rotate",     "material",  "light",
                                         "environment", "background", "tone",      "colour",
                                         "colouring",   "grain",      "dials",     "tolerance",
                                         "view",        "normalmap",  "replicate", "sheet",
                                         "roughness",   "metalness" };
    for (size_t i = 0; i < sizeof verbs / sizeof *verbs; i++) {
        const size_t n = strlen(verbs[i]);
        if (length > n && strncmp(line, verbs[i], n) == 0 && line[n] == ' ') return true;
    }
    return false;
}

/* Hash of all inputs of the files: the table, and the parts of the scene that affect maps. */
static uint64_t make_key(const WrApp *app, uint64_t table)
{
    WrText text = { 0 }, kept = { 0 };
    wr_session_scene_text(app->session, &text);
    for (const char *at = wr_text_get(&text); *at;) {
        const size_t length = strcspn(at, "\n");
        if (!is_seen_only(at, length)) wr_text_add_n(&kept, at, length);
        at += length + (at[length] == '\n');
    }
    const WrHash hash =
        wr_hash_bytes(wr_text_get(&kept), kept.length, (WrHash){ .low = table, .high = 1 });
    wr_text_fini(&text);
    wr_text_fini(&kept);
    return hash.low | 1;
}

/* Called in every frame, so the scene is hashed only after a command. */
static uint64_t key_of(const WrApp *app)
{
    WrSheetState *sheet = app->sheet;
    const uint64_t table = wr_field_key(wr_document_field(wr_session_document(app->session)));
    const uint64_t revision = wr_session_revision(app->session);
    if (sheet->key && table == sheet->key_table && revision == sheet->key_revision)
        return sheet->key;
    sheet->key_table = table;
    sheet->key_revision = revision;
    return sheet->key = make_key(app, table);
}

/* ---- pictures ---- */

/* Request new pictures if the present or requested ones are outdated. */
static void sheet_look(WrApp *app)
{
    WrSheetState *sheet = app->sheet;
    const uint64_t key = key_of(app);
    if (key == sheet->looked_key && is_same(&sheet->ask, &sheet->looked)) return;
    if (!sheet->look)
        sheet->look = wr_job_new(&wr_sheet_look_kind, app->options->threads, app->job_event);
    sheet->looked = sheet->ask;
    sheet->looked_key = key;
    wr_job_start(
        sheet->look,
        wr_sheet_look_new(wr_document_share(wr_session_document(app->session)), &sheet->ask));
}

static SDL_Texture *texture_of(SDL_Renderer *renderer, int w, int h, const uint8_t *rgb)
{
    SDL_Texture *texture =
        SDL_CreateTexture(renderer, SDL_PIXELFORMAT_RGB24, SDL_TEXTUREACCESS_STATIC, w, h);
    if (texture) wr_gui_sdl_update(texture, NULL, rgb, w * 3);
    return texture;
}

static void take_look(WrApp *app)
{
    WrSheetState *sheet = app->sheet;
    WrSheetLook *look = sheet->look ? wr_job_take(sheet->look) : NULL;
    if (!look) return;
    wr_sheet_look_free(sheet->shown);
    sheet->shown = look;
    for (int i = 0; i < WR_MAP_SET_ENTRIES_MAX; i++) {
        const WrExportPreview *p = &look->pictures[i];
        if (sheet->pictures[i]) SDL_DestroyTexture(sheet->pictures[i]);
        sheet->pictures[i] = p->rgb ? texture_of(app->renderer, p->width, p->height, p->rgb) : NULL;
    }
    wr_app_redraw(app);
}

/* ---- files ---- */

static void sheet_write(WrApp *app, bool loud)
{
    WrSheetState *sheet = app->sheet;
    if (!sheet->write)
        sheet->write = wr_job_new(&wr_sheet_write_kind, app->options->threads, app->job_event);
    sheet->written_key = key_of(app);
    sheet->loud = loud;
    if (loud) keep(app);
    wr_job_start(sheet->write,
                 wr_sheet_write_work_new(wr_document_share(wr_session_document(app->session)),
                                         &sheet->ask, material_choices[sheet->material].word));
    wr_app_redraw(app);
}

static void take_write(WrApp *app)
{
    WrSheetState *sheet = app->sheet;
    WrSheetWrite *write = sheet->write ? wr_job_take(sheet->write) : NULL;
    if (!write) return;
    if (write->ok) {
        sheet->pause = fmin(fmax(write->seconds - SOON_SECONDS, 0.0), PAUSE_SECONDS);
        if (sheet->loud) wr_app_say_each_line(app, wr_text_get(&write->report));
        wr_app_say(app,
                   write->files == 1 ? "%s: wrote %d file to %s in %.2g s%s"
                                     : "%s: wrote %d files to %s in %.2g s%s",
                   write->ask.as, write->files, write->ask.folder, write->seconds,
                   sheet->live ? wr_words("; follows the hand") : "");
    } else {
        if (sheet->live) wr_error_prefix(&write->err, "live export stopped: ");
        sheet->live = false;
        if (write->cancelled) wr_app_say(app, "Cancelled: no file was replaced");
        else wr_app_fail(app, &write->err);
    }
    wr_sheet_write_free(write);
    wr_app_redraw(app);
}

bool wr_sheet_writing(const WrApp *app, double *fraction, double *seconds, const char **as)
{
    if (!app->sheet || !app->sheet->write) return false;
    *as = app->sheet->ask.as;
    return wr_job_busy(app->sheet->write, fraction, seconds);
}

/* The job returns its result in its present state, marked as cancelled. */
void wr_sheet_cancel(WrApp *app)
{
    if (app->sheet && app->sheet->write) wr_job_interrupt(app->sheet->write);
}

/* ---- live export ---- */

static bool hand_rests(const WrApp *app)
{
    return app->hand->grab == WR_GRAB_NONE && !wr_session_in_stroke(app->session) && !app->trying;
}

static void follow(WrApp *app)
{
    WrSheetState *sheet = app->sheet;
    const double now = wr_clock_seconds();
    if (!sheet->live || !hand_rests(app)) return;
    const uint64_t key = key_of(app);
    if (key != sheet->seen_key) {
        sheet->seen_key = key;
        sheet->seen_at = now;
    }
    if (key != sheet->written_key && now - sheet->seen_at >= sheet->pause) sheet_write(app, false);
}

static bool waits(const WrApp *app)
{
    const WrSheetState *sheet = app->sheet;
    return sheet && sheet->live && hand_rests(app) && sheet->seen_key != sheet->written_key;
}

static void update(WrApp *app)
{
    if (!app->sheet) return;
    take_look(app);
    take_write(app);
    follow(app);
}

static double next_time(const WrApp *app)
{
    return waits(app) ? app->sheet->seen_at + app->sheet->pause : 0.0;
}

static bool works(WrApp *app)
{
    const WrSheetState *sheet = app->sheet;
    if (!sheet) return false;
    return waits(app) || (sheet->look && wr_job_busy(sheet->look, NULL, NULL)) ||
           (sheet->write && wr_job_busy(sheet->write, NULL, NULL));
}

/* Live export that was requested on the command line, into that folder only. A set that is named there is written as it
   is, without the document's settings of another. */
static void start_live(WrApp *app)
{
    const WrAppOptions *o = app->options;
    WrSheetRequest *ask = &sheet_open(app)->ask;
    if (o->live_as) *ask = (WrSheetRequest){ .as = "" };
    WrText name = { 0 };
    wr_map_set_cell_name(o->live_file, &name);
    snprintf(ask->name, sizeof ask->name, "%.120s", wr_text_get(&name));
    wr_text_fini(&name);
    snprintf(ask->folder, sizeof ask->folder, "%s", o->live_folder);
    if (o->live_as) snprintf(ask->as, sizeof ask->as, "%s", o->live_as);
    app->sheet->live = true;
    sheet_write(app, false);
}

/* Another document has other files. */
static void another(WrApp *app)
{
    if (!app->sheet && app->options->live_folder && !app->file->unread) {
        start_live(app);
        return;
    }
    if (!app->sheet) return;
    app->sheet->live = false;
    app->sheet->key = 0;
    take_place(app, &app->sheet->ask);
}

const WrPart wr_part_sheet = {
    .update = update, .next_time = next_time, .works = works, .another = another, .forget = forget
};

/* ---- the dialog: choice of maps ---- */

#define WIDE_UNITS 760
#define PICTURE_UNITS 72
#define OTHERS_UNITS 402 /* height of everything except the list of maps */
#define GREEN_SIDE 48    /* texels of the pictures for the green direction */
#define MAX_CHOICES (WR_MAP_SET_ROWS + WR_MAP_SETS_MAX + WR_EXPORT_KIND_COUNT)

/* Sets first, then single maps. */
static int list_choices(const WrSheetState *sheet, const char **labels, const char **words)
{
    int count = 0;
    for (int i = 0; i < sheet->names.names.count && count < WR_MAP_SET_ROWS + WR_MAP_SETS_MAX;
         i++) {
        words[count] = sheet->names.names.data[i];
        labels[count++] = sheet->names.names.data[i];
    }
    for (int i = 0; i < WR_EXPORT_KIND_COUNT; i++) {
        if (wr_export_kinds[i].ending) continue; /* solids have their own dialog: Export... */
        words[count] = wr_export_kinds[i].name;
        labels[count++] = wr_export_kinds[i].label;
    }
    return count;
}

/* Small label, which leaves room for its value. */
static void label(const char *text)
{
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, text);
    wr_gui_same_line(0);
    wr_gui_move_to(wr_gui_px(64));
}

static void choose_what(WrSheetState *sheet)
{
    const char *labels[MAX_CHOICES], *words[MAX_CHOICES];
    int chosen = 0, count = list_choices(sheet, labels, words);
    for (int i = 0; i < count; i++)
        if (strcmp(words[i], sheet->ask.as) == 0) chosen = i;
    label("For");
    if (wr_gui_choice("as", 0, labels, count, &chosen))
        snprintf(sheet->ask.as, sizeof sheet->ask.as, "%s", words[chosen]);
    wr_gui_tip("All maps that a program needs, with its names; or one map. Your own sets are files "
               "NAME.set in the folder sets of your settings");
    const WrSheetLook *look = sheet->shown;
    const WrExportKind *kind = wr_export_find(sheet->ask.as);
    const char *about = kind                                    ? kind->help
                        : look && look->set && look->set->about ? look->set->about
                                                                : "";
    wr_gui_text_cut(WR_FONT_SMALL, WR_COLOUR_LABEL, about, wr_gui_available());
}

static void choose_how(const WrApp *app, WrSheetState *sheet)
{
    WR_ROWS(depths);
    static const char *const depths[] = { [WR_ROW(WR_SHEET_AS_SET)] = "Its own depth",
                                          [WR_ROW(WR_SHEET_8)] = "8 bits",
                                          [WR_ROW(WR_SHEET_16)] = "16 bits",
                                          [WR_ROW(WR_SHEET_FLOAT)] = "Floats" };
    WR_ROWS_END(depths, WR_SHEET_DEPTHS);
    WR_ROWS(ranges);
    static const char *const ranges[] = { [WR_ROW(WR_SHEET_RANGE_SET)] = "Its own range",
                                          [WR_ROW(WR_SHEET_RANGE_AUTO)] = "Lowest to highest",
                                          [WR_ROW(WR_SHEET_RANGE_UNIT)] = "0 to 1, others clipped",
                                          [WR_ROW(WR_SHEET_RANGE_SIGNED)] = "0 in the middle" };
    WR_ROWS_END(ranges, WR_SHEET_RANGES);
    char texts[WR_SHEET_SIZES][32];
    const char *sizes[WR_SHEET_SIZES];
    const WrField *field = wr_app_field(app);
    for (int i = 0; i < WR_SHEET_SIZES; i++) {
        int w = wr_field_width(field), h = wr_field_height(field);
        wr_sheet_size(i, &w, &h);
        snprintf(texts[i], sizeof texts[i], "%d \xc3\x97 %d%s", w, h,
                 i == WR_SHEET_POWER ? wr_words(" (power of 2)") : "");
        sizes[i] = texts[i];
    }
    label("As");
    const double third = (wr_gui_available() - wr_gui_px(16)) / 3;
    wr_gui_choice("size", third, sizes, WR_SHEET_SIZES, &sheet->ask.size);
    wr_gui_tip(
        "Size of each file in texels. In smaller files a texel is the mean of those it covers");
    wr_gui_same_line(8);
    wr_gui_choice("depth", third, depths, WR_SHEET_DEPTHS, &sheet->ask.depth);
    wr_gui_tip("Bits per channel; floats are written to EXR files, integers to PNG");
    wr_gui_same_line(8);
    wr_gui_choice("range", third, ranges, WR_SHEET_RANGES, &sheet->ask.range);
    wr_gui_tip("Heights of the first and the last code");
}

static void choose_material(WrSheetState *sheet)
{
    const char *labels[WR_LENGTH(material_choices)];
    for (size_t i = 0; i < WR_LENGTH(material_choices); i++) labels[i] = material_choices[i].label;
    label("With");
    wr_gui_choice("material", (wr_gui_available() - wr_gui_px(16)) / 3, labels,
                  (int)WR_LENGTH(material_choices), &sheet->material);
    wr_gui_tip("Writes a material that uses these maps, with their scale, direction of green and "
               "repeat: NAME.mtlx, NAME.usda or NAME.gltf");
}

/* The check that puts <VARIANT> into the cell's name, or removes it. */
static void choose_variants(const WrApp *app, WrSheetState *sheet)
{
    char *name = sheet->ask.name;
    bool all = wr_variant_is_pattern(name);
    if (!all && !wr_variant_count(wr_session_document(app->session))) return;
    if (wr_gui_check("All variants, a file for each", &all)) {
        char *made = all ? wr_variant_insert(name) : wr_variant_fill(name, "");
        size_t length = strlen(made);
        while (!all && length > 1 && made[length - 1] == '_') made[--length] = '\0';
        snprintf(name, sizeof sheet->ask.name, "%s", made);
        wr_free(made);
    }
    wr_gui_tip("<VARIANT> in the file name is replaced by the name of each variant");
}

static void choose_where(WrSheetState *sheet)
{
    label("To");
    const double name = wr_gui_px(150);
    wr_gui_text_field("##folder", wr_gui_available() - name - wr_gui_px(8), sheet->ask.folder,
                      sizeof sheet->ask.folder, false);
    wr_gui_tip("The folder");
    wr_gui_same_line(8);
    wr_gui_text_field("##name", name, sheet->ask.name, sizeof sheet->ask.name, false);
    wr_gui_tip("Name of the cell in the file names");
}

/* ---- maps ---- */

static void add_bytes(double bytes, char *text, size_t size)
{
    if (bytes >= 1e6) wr_words_print(text, size, wr_words("%.3g MB"), bytes / 1e6);
    else wr_words_print(text, size, wr_words("%.0f kB"), fmax(1, bytes / 1e3));
}

/* Heights of the lowest and highest code for the whole table, since the picture contains only a part. */
static void code_range(const WrSheetLook *look, int i, double *low, double *high)
{
    const WrMapSetRequest order = { look->set, "", "", NULL, 0, NULL };
    WrExportOptions options = wr_export_default();
    WrError none;
    if (!wr_map_set_options(&order, i, &options, &none)) options = wr_export_default();
    const double most = fmax(fabs(look->histogram.low), fabs(look->histogram.high));
    *low = look->histogram.low;
    *high = look->histogram.high;
    if (options.range == WR_EXPORT_RANGE_GIVEN) *low = options.low, *high = options.high;
    if (options.range == WR_EXPORT_RANGE_SIGNED) *low = -most, *high = most;
}

/* "512 x 512, 16 bits, codes are -0.05 to 0.93; up to 512 kB" */
static void facts_of(const WrSheetLook *look, int i, char *text, size_t size)
{
    const WrMapSetEntry *map = &look->set->maps.data[i];
    const WrExportReport *report = &look->pictures[i].report;
    const int depth = wr_sheet_depth(map);
    char bytes[24];
    size_t used = 0;
    if (map->kind->write) {
        snprintf(text, size, "%s", wr_words(map->kind->label));
        return;
    }
    add_bytes(wr_export_estimate_bytes(map->kind, look->width, look->height, depth), bytes,
              sizeof bytes);
    used += (size_t)snprintf(text, size, "%d \xc3\x97 %d, %s", look->width, look->height,
                             depth == 8    ? wr_words("8 bits")
                             : depth == 16 ? wr_words("16 bits")
                                           : wr_words("floats"));
    if (depth != 32 && strcmp(map->kind->name, "height") == 0) {
        double low, high;
        code_range(look, i, &low, &high);
        used += (size_t)wr_words_print(text + used, size - used,
                                       wr_words(", codes are %.3g to %.3g"), low, high);
    }
    if (report->convention)
        used += (size_t)snprintf(text + used, size - used, ", %s", wr_words(report->convention));
    snprintf(text + used, size - used, wr_words("; up to %s"), bytes);
}

static void map_row(const WrSheetState *sheet, int i)
{
    const WrSheetLook *look = sheet->shown;
    const WrExportPreview *p = &look->pictures[i];
    const WrMapSetRequest order = { look->set, "", look->ask.name, NULL, 0, NULL };
    const double side = wr_gui_px(PICTURE_UNITS),
                 most = p->width > p->height ? p->width : p->height;
    char facts[200];
    WrText file = { 0 };
    wr_map_set_file(&order, look->document, i, &file);
    if (p->rgb && sheet->pictures[i])
        wr_gui_image(sheet->pictures[i], side * p->width / most, side * p->height / most);
    else wr_gui_image(NULL, side, side);
    wr_gui_same_line(12);
    wr_gui_group_begin();
    wr_gui_text_cut(WR_FONT_BOLD, WR_COLOUR_TEXT, wr_text_get(&file) + 1, wr_gui_available());
    wr_gui_text_cut(WR_FONT_SMALL, WR_COLOUR_LABEL, look->set->maps.data[i].kind->label,
                    wr_gui_available());
    facts_of(look, i, facts, sizeof facts);
    wr_gui_text_cut(WR_FONT_SMALL, WR_COLOUR_LABEL, facts, wr_gui_available());
    wr_gui_group_end();
    wr_text_fini(&file);
}

static void show_maps(const WrApp *app, const WrSheetState *sheet)
{
    const double room = app->height - wr_gui_px(OTHERS_UNITS);
    const double high =
        fmax(wr_gui_px(PICTURE_UNITS + 16), fmin(wr_gui_px(3.3 * PICTURE_UNITS), room));
    const WrSheetLook *look = sheet->shown;
    wr_gui_list_begin("maps", high);
    if (look && !look->set)
        wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_BAD, wr_error_message(&look->err));
    for (int i = 0; look && look->set && i < look->set->maps.count; i++) {
        wr_gui_push_id(i);
        map_row(sheet, i);
        wr_gui_pop_id();
    }
    wr_gui_list_end();
}

/* ---- heights, and the direction of green ---- */

/* Histogram bars, with lines at the heights of the lowest and highest code; heights beyond them are clipped. */
static void histogram(const WrSheetLook *look, double wide, double high)
{
    const WrHistogram *h = &look->histogram;
    const WrPad pad = wr_gui_pad_begin("histogram", wide, high);
    int64_t most = 1;
    for (int i = 0; i < WR_HISTOGRAM; i++) most = h->count[i] > most ? h->count[i] : most;
    for (int i = 0; i < WR_HISTOGRAM; i++) {
        const double middle = h->low + (i + 0.5) / WR_HISTOGRAM * (h->high - h->low);
        const bool out = look->ask.range == WR_SHEET_RANGE_UNIT && (middle < 0 || middle > 1);
        /* The exponent 0.4 keeps rare heights visible; every height in use is at least a pixel tall. */
        const double tall =
            h->count[i] > 0 ? fmax(1, pow((double)h->count[i] / (double)most, 0.4) * (pad.h - 2))
                            : 0;
        wr_gui_draw_fill(pad.x + i * pad.w / WR_HISTOGRAM, pad.y + pad.h - tall,
                         pad.w / WR_HISTOGRAM, tall, out ? WR_COLOUR_RAISE : WR_COLOUR_LEVEL, 0);
    }
    if (h->low < 0 && h->high > 0) {
        const double x = pad.x - h->low / (h->high - h->low) * pad.w;
        wr_gui_draw_line(x, pad.y, x, pad.y + pad.h, WR_COLOUR_LABEL, 1);
    }
    wr_gui_pad_end();
    wr_gui_tip("Histogram of the heights; the line is 0. Orange: outside the range, clipped");
}

/* A round bump as a normal map: its upper side is bright green, or dark. */
static SDL_Texture *make_green(SDL_Renderer *renderer, double green)
{
    uint8_t rgb[GREEN_SIDE * GREEN_SIDE * 3];
    for (int j = 0; j < GREEN_SIDE; j++)
        for (int i = 0; i < GREEN_SIDE; i++) {
            const double x = (i + 0.5) / GREEN_SIDE * 2.4 - 1.2,
                         y = 1.2 - (j + 0.5) / GREEN_SIDE * 2.4;
            const double rr = x * x + y * y, in = rr < 1 ? 1 : 0;
            const double n[3] = { in * x, green * in * y, sqrt(rr < 1 ? 1 - rr : 1) };
            for (int c = 0; c < 3; c++)
                rgb[(j * GREEN_SIDE + i) * 3 + c] = (uint8_t)lrint(127.5 + 127.5 * n[c]);
        }
    SDL_Texture *texture = SDL_CreateTexture(renderer, SDL_PIXELFORMAT_RGB24,
                                             SDL_TEXTUREACCESS_STATIC, GREEN_SIDE, GREEN_SIDE);
    if (texture) wr_gui_sdl_update(texture, NULL, rgb, GREEN_SIDE * 3);
    return texture;
}

static bool has_green(const WrSheetLook *look, double green)
{
    for (int i = 0; i < look->set->maps.count; i++)
        if (look->set->maps.data[i].kind->green == green) return true;
    return false;
}

static void greens(const WrApp *app, WrSheetState *sheet, double side)
{
    static const char *const words[] = { "+Y", "-Y" };
    static const char *const tips[] = {
        "Green up: a bump's upper flank is bright green. OpenGL, glTF, Blender, Unity, "
        "Godot, Maya",
        "Green down: a bump's upper flank is dark. DirectX, Unreal, 3ds Max"
    };
    for (int i = 0; i < 2; i++) {
        const bool here = has_green(sheet->shown, i ? -1.0 : 1.0);
        if (!sheet->greens[i]) sheet->greens[i] = make_green(app->renderer, i ? -1.0 : 1.0);
        wr_gui_same_line(12);
        wr_gui_image(sheet->greens[i], side, side);
        wr_gui_tip(tips[i]);
        wr_gui_same_line(4);
        wr_gui_text(here ? WR_FONT_BOLD : WR_FONT_TEXT, here ? WR_COLOUR_CELL : WR_COLOUR_LABEL,
                    words[i]);
        wr_gui_tip(tips[i]);
    }
}

static void numbers(const WrApp *app, WrSheetState *sheet)
{
    const WrSheetLook *look = sheet->shown;
    const double high = wr_gui_px(48);
    if (!look || !look->set) return;
    histogram(look, wr_gui_available() - 2 * (high + wr_gui_px(48)), high);
    greens(app, sheet, high);
    char bytes[24], line[128];
    WrText seam = { 0 };
    add_bytes(look->bytes, bytes, sizeof bytes);
    wr_certificate_text(&look->seam, &seam);
    const double texels =
        (double)wr_field_width(wr_app_field(app)) * wr_field_height(wr_app_field(app));
    wr_words_print(line, sizeof line,
                   wr_words("Heights %.4g to %.4g, %.3g %% clipped; all files up to %s; seam %s"),
                   look->histogram.low, look->histogram.high,
                   100.0 * (double)look->histogram.outside / texels, bytes,
                   wr_words(wr_certificate_word(wr_certificate_continuity(&look->seam))));
    wr_gui_as_it_is(true); /* assembled from translated parts */
    wr_gui_text_cut(WR_FONT_SMALL, WR_COLOUR_TEXT, line, wr_gui_available());
    wr_gui_as_it_is(false);
    wr_gui_tip(wr_text_get(&seam));
    wr_text_fini(&seam);
}

/* ---- end of the dialog ---- */

static void buttons(WrApp *app, WrSheetState *sheet)
{
    double fraction, seconds;
    const char *as;
    const bool busy = wr_sheet_writing(app, &fraction, &seconds, &as);
    const bool good = sheet->shown && sheet->shown->set && *sheet->ask.folder && *sheet->ask.name;
    wr_gui_space(4);
    if (busy) {
        if (wr_gui_button("Stop writing", false)) wr_sheet_cancel(app);
        wr_gui_same_line(8);
        wr_gui_progress(wr_gui_px(180), fraction);
    } else {
        wr_gui_disable(!good);
        const bool enter = good && !app->dialog->fresh && wr_gui_return_pressed();
        if (wr_gui_button("Write all", true) || enter) sheet_write(app, true);
        wr_gui_disable_end();
    }
    wr_gui_same_line(8);
    if (wr_gui_button("Close", false) || (!app->dialog->fresh && wr_gui_escape_pressed()))
        wr_dialog_close(app);
    wr_gui_same_line(16);
    if (wr_gui_check("Live: write again after each pause", &sheet->live) && sheet->live && good)
        sheet_write(app, false);
    wr_gui_tip("While this is on, the files are written again within half a second after each "
               "change. An error switches it off");
}

void wr_dialog_sheet(WrApp *app)
{
    WrSheetState *sheet = sheet_open(app);
    if (app->dialog->fresh) {
        wr_map_set_names_free(&sheet->names);
        sheet->names = wr_map_set_names();
    }
    sheet_look(app);
    if (!wr_gui_dialog_begin("Export maps", WIDE_UNITS)) return;
    choose_what(sheet);
    choose_where(sheet);
    choose_variants(app, sheet);
    choose_how(app, sheet);
    choose_material(sheet);
    show_maps(app, sheet);
    numbers(app, sheet);
    buttons(app, sheet);
    wr_gui_dialog_end();
}
