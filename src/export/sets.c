#include "export/sets.h"

#include "base/error.h"
#include "base/progress.h"
#include "base/rows.h"
#include "base/text.h"
#include "export/export.h"
#include "system/path.h"

#include <errno.h>
#include <string.h>

/* Heights that a program multiplies itself leave as floats where it reads them; elsewhere as 16 bits. */
const WrExportSet wr_export_sets[] = {
    { "blender",
      "heights as floats and a normal map, named as Node Wrangler looks for them",
      { { "height", { "depth=32" }, "", "_displacement.exr" },
        { "normal+y", { "depth=16" }, "", "_normal.png" } } },
    { "gltf", "the normal texture", { { "normal+y", { "depth=8" }, "", "_normal.png" } } },
    { "unreal",
      "T_NAME_N with green down, T_NAME_H of 16 bits",
      { { "normal-y", { "depth=8" }, "T_", "_N.png" },
        { "height", { "depth=16" }, "T_", "_H.png" } } },
    { "unity",
      "normal map and height map",
      { { "normal+y", { "depth=8" }, "", "_Normal.png" },
        { "height", { "depth=16" }, "", "_Height.png" } } },
    { "godot",
      "normal map and height map",
      { { "normal+y", { "depth=8" }, "", "_normal.png" },
        { "height", { "depth=8", "dither=on" }, "", "_height.png" } } },
    { "substance",
      "heights about mid-grey and a normal map with green down",
      { { "height", { "depth=16", "range=signed" }, "", "_Height.png" },
        { "normal-y", { "depth=16" }, "", "_Normal.png" } } },
    { "renderman",
      "heights as floats for displacement, slopes for bump",
      { { "height", { "depth=32" }, "", "_disp.exr" },
        { "slopes", { "depth=32" }, "", "_slopes.exr" } } },
    { "arnold",
      "heights as floats for displacement, a normal map as floats",
      { { "height", { "depth=32" }, "", "_disp.exr" },
        { "normal+y", { "depth=32" }, "", "_normal.exr" } } },
    { "povray", "a height field of 16 bits", { { "height", { "depth=16" }, "", "_hf.png" } } },
};
_Static_assert(WR_LENGTH(wr_export_sets) == WR_EXPORT_SET_COUNT, "sets.h counts them");

const WrExportSet *wr_export_set_find(const char *name)
{
    for (int i = 0; i < WR_EXPORT_SET_COUNT; i++)
        if (strcmp(wr_export_sets[i].name, name) == 0) return &wr_export_sets[i];
    return NULL;
}

/* ---- options ---- */

static const char *value_of(const char *word)
{
    const char *equals = strchr(word, '=');
    return equals ? equals + 1 : NULL;
}

static bool has_option(const WrExportKind *kind, const char *word, size_t length)
{
    for (const WrExportOptionInfo *o = kind->options; o->name; o++)
        if (strlen(o->name) == length && strncmp(o->name, word, length) == 0) return true;
    return false;
}

/* Whether the kind has the option; false and a message only where the value is bad. */
static bool set_word(const WrExportKind *kind, WrExportOptions *options, const char *word,
                     bool *taken, WrError *err)
{
    const char *value = value_of(word);
    char name[32];
    if (!value) return wr_fail(err, "%.60s: must be name=value", word);
    size_t length = (size_t)(value - 1 - word);
    if (length >= sizeof name || !has_option(kind, word, length)) return true;
    memcpy(name, word, length);
    name[length] = 0;
    *taken = true;
    return wr_export_option(kind, options, name, value, err);
}

/* The set's settings, then the user's, which win. taken: [word_count]. */
static bool settle_map(const WrSetOrder *order, const WrExportMap *map, WrExportOptions *options,
                       bool *taken, WrError *err)
{
    const WrExportKind *kind = wr_export_find(map->kind);
    bool own;
    *options = wr_export_default();
    for (int i = 0; i < WR_SET_SETTINGS && map->settings[i]; i++)
        if (!set_word(kind, options, map->settings[i], &own, err)) return false;
    for (int i = 0; i < order->word_count; i++)
        if (!set_word(kind, options, order->words[i], &taken[i], err)) return false;
    return true;
}

static bool settle(const WrSetOrder *order, WrExportOptions options[WR_SET_MAPS], WrError *err)
{
    bool taken[WR_SET_WORDS] = { false };
    if (order->word_count > WR_SET_WORDS)
        return wr_fail(err, "%d options: a set takes up to %d", order->word_count, WR_SET_WORDS);
    for (int i = 0; order->set->maps[i].kind; i++)
        if (!settle_map(order, &order->set->maps[i], &options[i], taken, err)) return false;
    for (int i = 0; i < order->word_count; i++)
        if (!taken[i])
            return wr_fail(err, "%.60s: no map of the set %s has such an option", order->words[i],
                           order->set->name);
    return true;
}

/* ---- files ---- */

static const char *file_name(WrText *text, const char *folder, const WrSetOrder *order, int map)
{
    const WrExportMap *row = &order->set->maps[map];
    wr_text_clear(text);
    wr_text_addf(text, "%s/%s%s%s", folder, row->prefix, order->name, row->suffix);
    return wr_text_get(text);
}

static const char *old_name(WrText *text, const char *folder, int map)
{
    wr_text_clear(text);
    wr_text_addf(text, "%s/old-%d", folder, map);
    return wr_text_get(text);
}

static bool write_map(const WrSetOrder *order, int map, const WrExportOptions *options,
                      const WrDocument *document, WrPool *pool, const char *folder, WrText *told,
                      WrError *err)
{
    WrText path = { 0 };
    WrExportReport report;
    const WrExportKind *kind = wr_export_find(order->set->maps[map].kind);
    bool good = wr_export(kind, document, options, pool, file_name(&path, folder, order, map),
                          &report, err);
    if (good) {
        wr_text_addf(told, "%s: ", file_name(&path, order->folder, order, map));
        wr_export_report_text(&report, told);
        wr_text_add(told, "\n");
    }
    wr_text_fini(&path);
    return good;
}

static int map_count(const WrExportSet *set)
{
    int count = 0;
    while (set->maps[count].kind) count++;
    return count;
}

static bool write_maps(const WrSetOrder *order, const WrExportOptions *options,
                       const WrDocument *document, WrPool *pool, const char *folder, WrText *told,
                       WrError *err)
{
    const int count = map_count(order->set);
    bool good = true;
    for (int i = 0; i < count && good; i++) {
        WrProgressPart share;
        const WrProgress *whole = wr_progress_enter(&share, (double)i / count, (i + 1.0) / count);
        good = write_map(order, i, &options[i], document, pool, folder, told, err);
        wr_progress_set(whole);
    }
    return good && (!wr_progress_stopped() || wr_fail(err, "cancelled"));
}

/* A file takes its place; what stood there waits in the folder. */
static bool place(const WrSetOrder *order, int map, const char *folder, WrError *err)
{
    WrText from = { 0 }, to = { 0 }, old = { 0 };
    const char *target = file_name(&to, order->folder, order, map);
    const char *kept = old_name(&old, folder, map);
    bool good = !wr_path_is_folder(target);
    if (!good) errno = EISDIR;
    good = good && (!wr_path_is_there(target) || wr_path_rename(target, kept));
    if (good && !wr_path_rename(file_name(&from, folder, order, map), target)) {
        int why = errno;
        wr_path_rename(kept, target);
        errno = why;
        good = false;
    }
    if (!good) wr_fail(err, "%s: cannot be written (%s)", target, strerror(errno));
    wr_text_fini(&from);
    wr_text_fini(&to);
    wr_text_fini(&old);
    return good;
}

/* As it was before: what stood there comes back, or nothing stands there. */
static void take_back(const WrSetOrder *order, int map, const char *folder)
{
    WrText to = { 0 }, old = { 0 };
    const char *target = file_name(&to, order->folder, order, map);
    if (!wr_path_rename(old_name(&old, folder, map), target)) wr_path_remove(target);
    wr_text_fini(&to);
    wr_text_fini(&old);
}

static bool place_all(const WrSetOrder *order, const char *folder, WrError *err)
{
    const int count = map_count(order->set);
    for (int i = 0; i < count; i++) {
        if (place(order, i, folder, err)) continue;
        while (--i >= 0) take_back(order, i, folder);
        return false;
    }
    return true;
}

static void clear_folder(const WrSetOrder *order, const char *folder)
{
    WrText path = { 0 };
    for (int i = 0; i < map_count(order->set); i++) {
        wr_path_remove(file_name(&path, folder, order, i));
        wr_path_remove(old_name(&path, folder, i));
    }
    wr_folder_remove(folder);
    wr_text_fini(&path);
}

bool wr_export_set(const WrSetOrder *order, const WrDocument *document, WrPool *pool, WrText *told,
                   WrError *err)
{
    WrExportOptions options[WR_SET_MAPS];
    WrText folder = { 0 };
    char own[4096];
    if (!settle(order, options, err)) return false;
    wr_text_addf(&folder, "%s/.wrinkle-set-XXXXXX", order->folder);
    bool fits = folder.length < sizeof own;
    if (fits) memcpy(own, wr_text_get(&folder), folder.length + 1);
    else errno = ENAMETOOLONG;
    wr_text_fini(&folder);
    if (!fits || !wr_folder_make_temporary(own))
        return wr_fail(err, "%.200s: files cannot be written there (%s)", order->folder,
                       strerror(errno));
    bool good =
        write_maps(order, options, document, pool, own, told, err) && place_all(order, own, err);
    clear_folder(order, own);
    return good;
}
