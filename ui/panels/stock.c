#include "ui/panels/stock.h"
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/document.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/session_view.h"
#include "ui/canvas/tools/thumbs.h"
#include "ui/canvas/tools/tool.h"
#include "ui/canvas/tools/tool_stamp.h"
#include "ui/panels/generate/generate_state.h"

#include "base/array.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "brush/library.h"
#include "document/document.h"
#include "generate/generator.h"
#include "system/path.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- brushes: the round brush, then the library ---- */

static int brush_count(WrApp *app)
{
    return wr_library_count(wr_preset_browser_library(app)) + 1;
}

static const char *collection_label(const char *collection)
{
    return strcmp(collection, "user") == 0       ? "My own"
           : strcmp(collection, "wrinkle") == 0  ? "Relief"
           : strcmp(collection, "mypaint2") == 0 ? "MyPaint"
           : strcmp(collection, "mypaint1") == 0 ? "MyPaint 1"
                                                 : collection;
}

static void brush_item(WrApp *app, int index, WrStockItem *item)
{
    if (index == 0) {
        snprintf(item->id, sizeof item->id, "%s", WR_ROUND);
        snprintf(item->name, sizeof item->name, "Round brush");
        return;
    }
    const WrPresetEntry *entry = wr_library_entry(wr_preset_browser_library(app), index - 1);
    const char *label = collection_label(entry->collection);
    bool grouped = entry->group && entry->group[0];
    snprintf(item->id, sizeof item->id, "%.290s", entry->id);
    snprintf(item->name, sizeof item->name, "%.120s", entry->name);
    snprintf(item->group, sizeof item->group, "%.20s%s%.60s", label, grouped ? ": " : "",
             grouped ? entry->group : "");
}

static SDL_Texture *brush_picture(WrApp *app, int index, int side)
{
    return wr_thumb_of(app, index - 1, side);
}

static bool brush_chosen(WrApp *app, int index)
{
    const char *chosen = wr_preset_browser_chosen(app);
    if (index == 0) return strcmp(chosen, WR_ROUND) == 0;
    return strcmp(wr_library_entry(wr_preset_browser_library(app), index - 1)->id, chosen) == 0;
}

static void brush_choose(WrApp *app, int index)
{
    WrStockItem item = { "", "", "", "" };
    brush_item(app, index, &item);
    wr_preset_browser_choose(app, item.id);
}

static void brush_drop(WrApp *app, int index, double u, double v)
{
    (void)u, (void)v;
    brush_choose(app, index);
    wr_tool_choose(app, wr_tool_find(app, WR_ACT(brush)));
}

static bool brush_remove(WrApp *app, int index)
{
    WrStockItem item = { "", "", "", "" };
    brush_item(app, index, &item);
    return strncmp(item.id, "user/", 5) == 0 && wr_preset_browser_delete(app, item.id);
}

/* ---- stamps ---- */

static int stamp_count(WrApp *app)
{
    wr_stamps_find(app);
    return app->stamp->stamps.count;
}

static void stamp_item(WrApp *app, int index, WrStockItem *item)
{
    const WrStamp *stamp = &app->stamp->stamps.data[index];
    WrText name = { 0 };
    wr_stamp_name(stamp->path, &name);
    snprintf(item->name, sizeof item->name, "%.120s", wr_text_get(&name));
    snprintf(item->id, sizeof item->id, "stamp:%.120s", wr_text_get(&name));
    snprintf(item->group, sizeof item->group, "%.90s", stamp->group);
    snprintf(item->words, sizeof item->words, "%.390s", stamp->words);
    wr_text_fini(&name);
}

static bool stamp_chosen(WrApp *app, int index)
{
    return wr_stamp_chosen(app) == index;
}

static void stamp_choose(WrApp *app, int index)
{
    wr_stamp_choose(app, index);
}

static void stamp_hover(WrApp *app, int index, double u, double v, bool over)
{
    bool ready = wr_stamp_chosen(app) == index && wr_stamp_is_chosen(app);
    if (over && !ready && !wr_stamp_choose(app, index)) return;
    wr_stamp_hover(app, u, v, over);
}

static void stamp_drop(WrApp *app, int index, double u, double v)
{
    if (wr_stamp_chosen(app) == index) wr_stamp_at(app, u, v);
}

/* ---- presets of generators ---- */

static int preset_count(WrApp *app)
{
    wr_generate_presets_find(app);
    return app->generate->presets.count;
}

static void preset_item(WrApp *app, int index, WrStockItem *item)
{
    const WrGeneratePreset *preset = &app->generate->presets.data[index];
    const WrGenerator *generator = preset->generator;
    const WrFamily *family = generator ? wr_family_find(generator->family) : NULL;
    snprintf(item->name, sizeof item->name, "%.120s", preset->name);
    snprintf(item->id, sizeof item->id, "preset:%.120s", preset->name);
    snprintf(item->group, sizeof item->group, "%.90s",
             !preset->words ? "My own"
             : family       ? family->label
                            : "");
    snprintf(item->words, sizeof item->words, "%.200s %.60s", preset->words ? preset->words : "",
             generator ? generator->label : "");
}

static bool preset_chosen(WrApp *app, int index)
{
    return app->generate->preset == index;
}

static void preset_choose(WrApp *app, int index)
{
    if (!app->generate->presets.data[index].generator) return;
    app->generate->layer = -1;
    wr_generate_preset_open(app, index);
}

/* A new generator layer; an object lies where it was dropped. */
static void preset_drop(WrApp *app, int index, double u, double v)
{
    WrGenerateState *state = app->generate;
    if (!state->presets.data[index].generator) return;
    preset_choose(app, index);
    int at = wr_generator_param_find(state->generator, "at");
    if (at >= 0) {
        state->value[at].number[0] = u - floor(u);
        state->value[at].number[1] = v - floor(v);
    }
    state->into_active = false;
    wr_generate_commit(app);
}

static bool preset_remove(WrApp *app, int index)
{
    return !app->generate->presets.data[index].words && wr_generate_preset_delete(app, index);
}

/* ---- cells ---- */

#define CELL_MAX (1 << 20) /* bytes of a script */

static int cell_count(WrApp *app)
{
    wr_script_list_find(&app->shelf->cells, "samples/cells");
    return app->shelf->cells.scripts.count;
}

static const WrScript *cell_at(const WrApp *app, int index)
{
    return &app->shelf->cells.scripts.data[index];
}

static void cell_item(WrApp *app, int index, WrStockItem *item)
{
    const WrScript *cell = cell_at(app, index);
    snprintf(item->name, sizeof item->name, "%.120s", cell->title);
    snprintf(item->id, sizeof item->id, "cell:%.120s", cell->title);
    snprintf(item->words, sizeof item->words, "%.390s", cell->words);
}

static SDL_Texture *cell_picture(WrApp *app, int index, int side)
{
    const WrThumbSource of = { .picture = cell_at(app, index)->picture };
    return wr_thumb(app, WR_THUMB_CELL, index, side, &of);
}

static void cell_choose(WrApp *app, int index)
{
    wr_app_open_path(app, cell_at(app, index)->path);
}

/* Length of a word, which may be quoted. */
static size_t word_length(const char *text)
{
    if (*text != '"') return strcspn(text, " ");
    const char *end = strchr(text + 1, '"');
    return end ? (size_t)(end + 1 - text) : strlen(text);
}

/* Append one line of a cell if it makes or changes a layer. A line about a layer follows the one that adds it, so it is
   addressed by number: the document may have others of that name. */
static void add_layer_line(const char *line, int first, int *added, WrText *lines)
{
    static const char *const verbs[] = { "layer mask ", "layer set ", "layer rename " };
    if (strncmp(line, "layer add ", 10) == 0 || strncmp(line, "filter ", 7) == 0) {
        ++*added;
        wr_text_addf(lines, "%s\n", line);
        return;
    }
    for (size_t i = 0; i < sizeof verbs / sizeof *verbs; i++) {
        size_t length = strlen(verbs[i]);
        if (strncmp(line, verbs[i], length) != 0) continue;
        wr_text_addf(lines, "%s%d%s\n", verbs[i], first + *added - 1,
                     line + length + word_length(line + length));
    }
}

/* Add the cell's layers above the active one, as a group; its table and scene are left out. */
static void insert_cell(WrApp *app, const char *path)
{
    WrError err;
    WrText lines = { 0 };
    char *text = NULL;
    size_t length;
    const WrDocument *document = wr_app_document(app);
    int first = document->active + 2, added = 0;
    bool good = wr_file_read(path, CELL_MAX, &text, &length, &err);
    for (char *line = text; good && *line;) {
        char *end = line + strcspn(line, "\n"), *next = end + (*end != '\0');
        *end = '\0';
        add_layer_line(line, first, &added, &lines);
        line = next;
    }
    if (good && added > 0) {
        char *title = text + strspn(text, "# ");
        title[strcspn(title, ":\n")] = '\0';
        wr_text_addf(&lines, "layer group \"%s\" of=%d..%d\n", title, first, first + added - 1);
        wr_app_add_lines(app, wr_text_get(&lines));
    }
    if (!good) wr_app_fail(app, &err);
    wr_free(text);
    wr_text_fini(&lines);
}

static void cell_drop(WrApp *app, int index, double u, double v)
{
    (void)u, (void)v;
    wr_deferred(app, insert_cell, cell_at(app, index)->path);
}

/* ---- the lists ---- */

const WrStockList wr_stock[WR_STOCK_KINDS] = {
    [WR_STOCK_BRUSHES] = { "Brushes", "Search brushes", brush_count, brush_item, brush_picture,
                           brush_chosen, brush_choose, NULL, brush_drop, brush_remove, NULL },
    [WR_STOCK_STAMPS] = { "Stamps", "Search stamps", stamp_count, stamp_item, wr_stamp_picture,
                          stamp_chosen, stamp_choose, stamp_hover, stamp_drop, NULL,
                          "Drag it onto the canvas to stamp it there" },
    [WR_STOCK_PRESETS] = { "Presets", "Search presets", preset_count, preset_item,
                           wr_generate_preset_picture, preset_chosen, preset_choose, NULL,
                           preset_drop, preset_remove,
                           "Drag it onto the canvas for a new generator layer" },
    [WR_STOCK_CELLS] = { "Cells", "Search cells", cell_count, cell_item, cell_picture, NULL,
                         cell_choose, NULL, cell_drop, NULL,
                         "Click to open it, or drag it onto the canvas to add its layers" },
};
