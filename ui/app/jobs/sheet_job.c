#include "ui/app/jobs/sheet_job.h"

#include "base/memory.h"
#include "base/progress.h"
#include "base/enum_rows.h"
#include "command/session.h"
#include "command/variants.h"
#include "document/document.h"
#include "field/field.h"
#include "field/ops.h"
#include "scene/scene.h"
#include "system/clock.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- requested maps ---- */

static bool has_option(const WrExportKind *kind, const char *name)
{
    for (const WrExportOptionInfo *o = kind->options; o->name; o++)
        if (strcmp(o->name, name) == 0) return true;
    return false;
}

/* Index of that setting in the map, or of the first free one; -1: neither. */
static int place_of(const WrMapSetEntry *map, const char *name)
{
    const size_t length = strlen(name);
    int i = 0;
    for (; i < WR_MAP_SET_SETTINGS_MAX && map->settings[i]; i++)
        if (strncmp(map->settings[i], name, length) == 0 && map->settings[i][length] == '=')
            return i;
    return i < WR_MAP_SET_SETTINGS_MAX ? i : -1;
}

static void put(WrMapSetEntry *map, const char *name, const char *value)
{
    const int at = place_of(map, name);
    if (at < 0 || !has_option(map->kind, name)) return;
    WrText text = { 0 };
    wr_text_addf(&text, "%s=%s", name, value);
    wr_free(map->settings[at]);
    map->settings[at] = text.data;
}

static void drop_setting(WrMapSetEntry *map, const char *name)
{
    const int at = place_of(map, name);
    if (at < 0 || !map->settings[at]) return;
    wr_free(map->settings[at]);
    for (int i = at; i < WR_MAP_SET_SETTINGS_MAX; i++)
        map->settings[i] = i + 1 < WR_MAP_SET_SETTINGS_MAX ? map->settings[i + 1] : NULL;
}

int wr_sheet_depth(const WrMapSetEntry *map)
{
    const int at = place_of(map, "depth");
    if (map->kind->floats) return 32;
    if (at >= 0 && map->settings[at]) return (int)strtol(map->settings[at] + 6, NULL, 10);
    return strstr(map->after, ".png") ? 16 : 32;
}

/* Change the extension: floats need another format than integers. */
static void change_ending(WrMapSetEntry *map, const char *from, const char *to)
{
    const size_t length = strlen(map->after), tail = strlen(from);
    if (length < tail || strcmp(map->after + length - tail, from) != 0) return;
    memcpy(map->after + length - tail, to, tail);
}

static void adapt(WrMapSetEntry *map, const WrSheetRequest *ask)
{
    WR_ROWS(depths);
    static const char *const depths[] = { [WR_ROW(WR_SHEET_AS_SET)] = NULL,
                                          [WR_ROW(WR_SHEET_8)] = "8",
                                          [WR_ROW(WR_SHEET_16)] = "16",
                                          [WR_ROW(WR_SHEET_FLOAT)] = "32" };
    WR_ROWS_END(depths, WR_SHEET_DEPTHS);
    WR_ROWS(ranges);
    static const char *const ranges[] = { [WR_ROW(WR_SHEET_RANGE_SET)] = NULL,
                                          [WR_ROW(WR_SHEET_RANGE_AUTO)] = "auto",
                                          [WR_ROW(WR_SHEET_RANGE_UNIT)] = "0,1",
                                          [WR_ROW(WR_SHEET_RANGE_SIGNED)] = "signed" };
    WR_ROWS_END(ranges, WR_SHEET_RANGES);
    if (ranges[ask->range]) put(map, "range", ranges[ask->range]);
    if (!depths[ask->depth] || !has_option(map->kind, "depth")) return;
    const bool fixed = map->kind->ending != NULL; /* only one format, which has no 8 bits */
    if (fixed && ask->depth == WR_SHEET_8) return;
    put(map, "depth", depths[ask->depth]);
    if (fixed) return;
    if (ask->depth == WR_SHEET_FLOAT) change_ending(map, ".png", ".exr");
    else change_ending(map, ".exr", ".png");
    if (ask->depth != WR_SHEET_8) drop_setting(map, "dither");
}

/* One map, named after the cell. */
static WrMapSet *set_of_kind(const WrExportKind *kind, WrError *err)
{
    WrText line = { 0 };
    wr_text_addf(&line, "%s *.%s", kind->name,
                 kind->ending   ? kind->ending
                 : kind->write  ? "svg"
                 : kind->floats ? "exr"
                                : "png");
    WrMapSet *set = wr_map_set_parse(kind->name, wr_text_get(&line), kind->name, err);
    wr_text_fini(&line);
    return set;
}

/* The requested maps: the set with its depth and range, or a kind as a set of one map. The caller frees it; NULL on
   failure. */
static WrMapSet *sheet_set(const WrSheetRequest *ask, WrError *err)
{
    const WrExportKind *kind = wr_export_find(ask->as);
    WrMapSet *set = kind ? set_of_kind(kind, err) : wr_map_set_find(ask->as, err);
    for (int i = 0; set && i < set->maps.count; i++) adapt(&set->maps.data[i], ask);
    return set;
}

/* The nearest power of two by ratio. */
static int power_near(int n)
{
    return 1 << (int)lrint(log2(n));
}

void wr_sheet_size(int size, int *w, int *h)
{
    const int by = size == WR_SHEET_HALF ? 2 : size == WR_SHEET_QUARTER ? 4 : 1;
    *w = size == WR_SHEET_POWER ? power_near(*w) : *w / by > 0 ? *w / by : 1;
    *h = size == WR_SHEET_POWER ? power_near(*h) : *h / by > 0 ? *h / by : 1;
}

/* ---- resized tables ---- */

/* Replace the document by one layer with its heights at that size; when it shrinks, a texel is the mean of the
   covered ones. */
static bool resize(WrDocument *document, int w, int h, WrPool *pool, WrError *err)
{
    const WrField *field = wr_document_whole(document, pool, err);
    if (!field) return false;
    const bool smaller = w <= wr_field_width(field) && h <= wr_field_height(field);
    const double param[WR_OP_VALUES] = { w, h, smaller ? WR_RESIZE_BOX : WR_RESIZE_LANCZOS3 };
    const WrOpOptions options = { .pool = pool, .progress = wr_progress_here() };
    if (w == wr_field_width(field) && h == wr_field_height(field)) return true;
    WrField *made = wr_op_run(wr_op_find("resize"), field, param, &options, err);
    if (!made) return false;
    wr_document_start_over(document, made);
    return true;
}

/* ---- pictures ---- */

WrSheetLook *wr_sheet_look_new(WrDocument *document, const WrSheetRequest *ask)
{
    WrSheetLook *look = wr_alloc(1, sizeof *look);
    look->document = document;
    look->ask = *ask;
    return look;
}

void wr_sheet_look_free(WrSheetLook *look)
{
    if (!look) return;
    for (int i = 0; i < WR_MAP_SET_ENTRIES_MAX; i++) wr_export_preview_fini(&look->pictures[i]);
    wr_map_set_free(look->set);
    wr_document_free(look->document);
    wr_free(look);
}

static void drop_look(void *work)
{
    wr_sheet_look_free(work);
}

/* Compute statistics of the whole table, since a picture contains only a part. */
static void measure(WrSheetLook *look, WrPool *pool)
{
    const WrField *field = wr_document_composite(look->document, pool);
    const WrScene *scene = look->document->scene;
    const bool unit = look->ask.range == WR_SHEET_RANGE_UNIT;
    look->width = wr_field_width(field);
    look->height = wr_field_height(field);
    wr_sheet_size(look->ask.size, &look->width, &look->height);
    look->histogram =
        wr_export_histogram(look->document, unit ? 0 : -HUGE_VAL, unit ? 1 : HUGE_VAL);
    look->seam = scene->analytic.kind != WR_ANALYTIC_OFF
                     ? wr_certificate_formula(&scene->analytic)
                     : wr_certificate_table(field, scene->scheme, NULL);
    for (int i = 0; i < look->set->maps.count; i++) {
        const WrMapSetEntry *map = &look->set->maps.data[i];
        if (!map->kind->write)
            look->bytes +=
                wr_export_estimate_bytes(map->kind, look->width, look->height, wr_sheet_depth(map));
    }
}

static void run_look(void *work, WrPool *pool, const WrProgress *progress)
{
    WrSheetLook *look = work;
    look->set = sheet_set(&look->ask, &look->err);
    if (!look->set) return;
    measure(look, pool);
    int w = look->width, h = look->height;
    const double scale = fmin(1, (double)WR_SHEET_PICTURE / (w > h ? w : h));
    w = (int)fmax(1, rint(w * scale));
    h = (int)fmax(1, rint(h * scale));
    if (!resize(look->document, w, h, pool, &look->err)) return;
    const WrMapSetRequest order = { look->set, "", "", NULL, 0, NULL };
    for (int i = 0; i < look->set->maps.count && !wr_progress_cancelled(progress); i++) {
        WrExportOptions options;
        WrError none;
        if (wr_map_set_options(&order, i, &options, &none))
            wr_export_preview(look->set->maps.data[i].kind, look->document, &options, pool,
                              &look->pictures[i], &none);
    }
}

const WrJobKind wr_sheet_look_kind = { run_look, drop_look };

/* ---- files ---- */

WrSheetWrite *wr_sheet_write_work_new(WrDocument *document, const WrSheetRequest *ask,
                                      const char *material)
{
    WrSheetWrite *write = wr_alloc(1, sizeof *write);
    write->document = document;
    write->ask = *ask;
    write->material = material;
    return write;
}

void wr_sheet_write_free(WrSheetWrite *write)
{
    if (!write) return;
    wr_text_fini(&write->report);
    wr_document_free(write->document);
    wr_free(write);
}

static void drop_write(void *work)
{
    wr_sheet_write_free(work);
}

typedef struct Writing {
    WrSheetWrite *write;
    WrSession *session; /* whose document has the variant in use */
    const WrMapSet *set;
    WrPool *pool;
} Writing;

/* Write the set once; with the variant's name in the files' names, if there is one. */
static bool write_set(void *ctx, const char *variant, WrError *err)
{
    const Writing *writing = ctx;
    const WrSheetRequest *ask = &writing->write->ask;
    WrDocument *document = wr_document_share(wr_session_document(writing->session));
    const WrField *field = wr_document_composite(document, writing->pool);
    int w = wr_field_width(field), h = wr_field_height(field);
    char *name = wr_variant_fill(ask->name, variant);
    const char *const words[] = { writing->write->material };
    const WrMapSetRequest order = {
        writing->set, ask->folder, name, words, words[0] != NULL, NULL
    };
    wr_sheet_size(ask->size, &w, &h);
    const bool good =
        resize(document, w, h, writing->pool, err) &&
        wr_export_map_set(&order, document, writing->pool, &writing->write->report, err);
    if (good) writing->write->files += writing->set->maps.count;
    wr_free(name);
    wr_document_free(document);
    return good;
}

static void run_write(void *work, WrPool *pool, const WrProgress *progress)
{
    WrSheetWrite *write = work;
    const double began = wr_clock_seconds();
    WrMapSet *set = sheet_set(&write->ask, &write->err);
    if (set) {
        Writing writing = { write, wr_session_of(write->document, pool), set, pool };
        write->ok = wr_session_for_variants(writing.session, write->ask.name, write_set, &writing,
                                            &write->err);
        wr_session_free(writing.session);
    }
    write->cancelled = !write->ok && wr_progress_cancelled(progress);
    write->seconds = wr_clock_seconds() - began;
    wr_map_set_free(set);
}

const WrJobKind wr_sheet_write_kind = { run_write, drop_write };
