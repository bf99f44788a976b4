#include "cli/brushes.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/enum_rows.h"
#include "base/text.h"

#include <string.h>

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

static bool tell_each(const WrCli *cli, const WrBrushList *list, WrText *text, WrError *err)
{
    for (int i = 0; i < list->count; i++) {
        WrPreset *preset = wr_preset_read(list->entry[i]->path, list->entry[i]->id, err);
        if (!preset) return false;
        if (i > 0 && !cli->json) wr_text_add(text, "\n");
        wr_brushes_report(list->entry[i], preset, cli->json, text);
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
    if (cli->sheet && !wr_brushes_sheet(cli, list, cli->sheet, err)) return false;
    if (cli->thumbnails && !wr_brushes_thumbnails(cli, list, cli->thumbnails, err)) return false;
    if (cli->settings) settings_table(text);
    if (cli->sheet || cli->thumbnails || cli->settings) return true;
    if (cli->word_count > 0 || cli->json) return tell_each(cli, list, text, err);
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
