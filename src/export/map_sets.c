/* Writing of a set of maps. */
#include "export/map_sets.h"

#include "base/enum_rows.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "base/udim.h"
#include "document/document.h"
#include "export/contact_sheet.h"
#include "export/export.h"
#include "export/material_files.h"
#include "export/preview.h"
#include "export/receipt.h"
#include "image/image.h"
#include "scene/scene.h"
#include "system/clock.h"
#include "system/path.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* ---- Text definitions of map sets: those of known programs, and the user's ---- */

/* A set is text, one map a line: KIND FILE [NAME=VALUE ...], with one * in FILE for the cell's name; "about TEXT" describes
   the set; "material FORMAT,..." adds material files; lines with # are comments. The built-in sets below are parsed by the same parser, so the user can copy and change
   them. */
#define SET_ENDING ".set"
#define BLANKS " \t\r"

/* Heights are floats for programs that read and scale floats; otherwise 16 bits. */
const WrMapSetRow wr_map_set_rows[] = {
    { "blender",
      "heights as floats, normals, occlusion, roughness, named as Node Wrangler looks for them",
      "height *_displacement.exr depth=32\n"
      "normal+y *_normal.png depth=16\n"
      "occlusion *_ao.png depth=8\n"
      "roughness *_roughness.png depth=8\n" },
    { "gltf",
      "the normal texture, and one for occlusion (red), roughness (green) and metalness (blue)",
      "normal+y *_normal.png depth=8\n"
      "packed *_occlusionRoughnessMetallic.png depth=8 red=occlusion green=roughness "
      "blue=metalness base=material\n"
      "material gltf\n" },
    { "unreal",
      "T_NAME_N with green down, T_NAME_H of 16 bits, T_NAME_ORM: occlusion (red), roughness "
      "(green), metalness (blue)",
      "normal-y T_*_N.png depth=8\n"
      "height T_*_H.png depth=16\n"
      "packed T_*_ORM.png depth=8 red=occlusion green=roughness blue=metalness base=material\n" },
    { "unity",
      "normals, heights, the mask map: metalness (red), occlusion (green), detail mask (blue: "
      "everywhere), smoothness (alpha); the built-in pipeline reads metalness and occlusion from "
      "it "
      "as well",
      "normal+y *_Normal.png depth=8\n"
      "height *_Height.png depth=16\n"
      "packed *_MaskMap.png depth=8 red=metalness green=occlusion blue=1 alpha=smoothness "
      "base=material\n" },
    { "godot", "normals, heights, occlusion, roughness",
      "normal+y *_normal.png depth=8\n"
      "height *_height.png depth=8 dither=on\n"
      "occlusion *_ao.png depth=8\n"
      "roughness *_roughness.png depth=8\n" },
    { "substance",
      "heights about mid-grey, normals with green down, curvature, occlusion, roughness",
      "height *_Height.png depth=16 range=signed\n"
      "normal-y *_Normal.png depth=16\n"
      "curvature *_Curvature.png depth=16\n"
      "occlusion *_AmbientOcclusion.png depth=16\n"
      "roughness *_Roughness.png depth=16\n" },
    { "renderman", "heights as floats for displacement, bump slopes with RenderMan's signs",
      "height *_disp.exr depth=32\n"
      "bump-slopes *_b2r.exr signs=renderman\n" },
    { "arnold", "all as floats: heights for displacement, normals, occlusion, roughness",
      "height *_disp.exr depth=32\n"
      "normal+y *_normal.exr depth=32\n"
      "occlusion *_ao.exr depth=32\n"
      "roughness *_roughness.exr depth=32\n" },
    { "povray", "a height field of 16 bits, which is a bump map as well",
      "height *_hf.png depth=16\n" },
    { "blender-live",
      "the heights of `blender` alone, written in a third of the time, for a live link",
      "height *_displacement.exr depth=32\n" },
};
_Static_assert(WR_LENGTH(wr_map_set_rows) == WR_MAP_SET_ROWS, "map_sets.h counts them");

void wr_map_set_free(WrMapSet *set)
{
    if (!set) return;
    for (int i = 0; i < set->maps.count; i++) {
        WrMapSetEntry *map = &set->maps.data[i];
        wr_free(map->before);
        wr_free(map->after);
        for (int k = 0; k < WR_MAP_SET_SETTINGS_MAX; k++) wr_free(map->settings[k]);
    }
    wr_array_free(&set->maps);
    wr_free(set->name);
    wr_free(set->about);
    wr_free(set);
}

/* ---- one line ---- */

/* Possible first words of a line: the kinds, "about" and "material". */
static const char *line_word(const void *ctx, int i)
{
    (void)ctx;
    return i < WR_EXPORT_KIND_COUNT        ? wr_export_kinds[i].name
           : i == WR_EXPORT_KIND_COUNT     ? "about"
           : i == WR_EXPORT_KIND_COUNT + 1 ? "material"
                                           : NULL;
}

static bool find_kind(const char *word, WrMapSetEntry *map, WrError *err)
{
    map->kind = wr_export_find(word);
    if (map->kind) return true;
    char what[80];
    snprintf(what, sizeof what, "'%.40s' is no kind of map", word);
    return wr_fail_word(err, what, word, line_word, NULL);
}

/* Parses "T_*_N.png": a name without a folder, not hidden. */
static bool take_file(const char *word, WrMapSetEntry *map, WrError *err)
{
    const char *star = strchr(word, '*');
    WrPixelType type;
    if (strchr(word, '/') || word[0] == '.')
        return wr_fail(err, "'%.80s': must be a file's name such as T_*_N.png, without a folder",
                       word);
    if (!star || strchr(star + 1, '*') || !star[1])
        return wr_fail(err, "'%.80s': must have one *, for the cell's name, and an extension",
                       word);
    map->before = wr_strndup(word, (size_t)(star - word));
    map->after = wr_strdup(star + 1);
    char ending[16];
    if (map->kind->ending && strcmp(wr_path_ending(word, ending), map->kind->ending) != 0)
        return wr_fail(err, "'%.80s': %s files end in .%s", word, map->kind->name,
                       map->kind->ending);
    if (map->kind->write) return true; /* not a picture or a drawing */
    return wr_image_deepest(word, &type, err);
}

/* The setting is tried on default options, so that an error is reported when the set is read, with its line, and not after
   half of its files are written. */
static bool take_setting(const char *word, int index, WrMapSetEntry *map, WrError *err)
{
    WrExportOptions options = wr_export_default();
    const char *equals = strchr(word, '=');
    if (!equals || equals == word)
        return wr_fail(err, "'%.60s': must be a setting, name=value", word);
    if (index >= WR_MAP_SET_SETTINGS_MAX)
        return wr_fail(err, "more than %d settings of one map", WR_MAP_SET_SETTINGS_MAX);
    char *name = wr_strndup(word, (size_t)(equals - word));
    for (int i = 0; i < index; i++)
        if (strncmp(map->settings[i], word, strlen(name) + 1) == 0) {
            wr_fail(err, "%.40s= is given twice", name);
            wr_free(name);
            return false;
        }
    bool good = wr_export_option(map->kind, &options, name, equals + 1, err);
    wr_free(name);
    if (good) map->settings[index] = wr_strdup(word);
    return good;
}

static bool check_file(const WrMapSetEntry *map, WrError *err)
{
    WrExportOptions options = wr_export_default();
    if (map->kind->write) return true;
    for (int i = 0; i < WR_MAP_SET_SETTINGS_MAX && map->settings[i]; i++)
        if (strncmp(map->settings[i], "depth=", 6) == 0)
            wr_export_option(map->kind, &options, "depth", map->settings[i] + 6, err);
    const int depth = map->kind->floats ? 32 : options.depth;
    if (depth == 0) return true;
    const WrPixelType type = depth == 8 ? WR_PIXEL_U8 : depth == 16 ? WR_PIXEL_U16 : WR_PIXEL_F32;
    WrText name = { 0 };
    wr_text_addf(&name, "*%s", map->after);
    bool good = wr_image_can_write(wr_text_get(&name), type, map->kind->channels, true, err);
    wr_text_fini(&name);
    return good;
}

static bool is_same_file(const WrMapSetEntry *a, const WrMapSetEntry *b)
{
    return strcmp(a->before, b->before) == 0 && strcmp(a->after, b->after) == 0;
}

/* Parses a map line. words: [count], the first is not "about". The map is added first, so that it is freed with
   the set. */
static bool take_map(WrMapSet *set, char **words, int count, WrError *err)
{
    if (set->maps.count == WR_MAP_SET_ENTRIES_MAX)
        return wr_fail(err, "more than %d maps", WR_MAP_SET_ENTRIES_MAX);
    wr_array_push(&set->maps, (WrMapSetEntry){ 0 });
    WrMapSetEntry *map = &set->maps.data[set->maps.count - 1];
    if (!find_kind(words[0], map, err)) return false;
    if (count < 2)
        return wr_fail(err, "%s: needs a file's name, such as T_*_N.png", map->kind->name);
    if (!take_file(words[1], map, err)) return false;
    for (int i = 2; i < count; i++)
        if (!take_setting(words[i], i - 2, map, err)) return false;
    for (int i = 0; i < set->maps.count - 1; i++)
        if (is_same_file(&set->maps.data[i], map))
            return wr_fail(err, "'%.60s' is written twice", words[1]);
    return check_file(map, err);
}

/* Parses a line without its end; modifies it. */
static bool take_line(WrMapSet *set, char *line, WrError *err)
{
    char *words[WR_MAP_SET_SETTINGS_MAX + 4];
    int count = 0;
    for (const char *c = line; *c; c++)
        if (((unsigned char)*c < ' ' && !strchr(BLANKS, *c)) || *c == 0x7f)
            return wr_fail(err, "a control character: a set is plain text");
    line += strspn(line, BLANKS);
    if (!*line || *line == '#') return true;
    if (strncmp(line, "about ", 6) == 0) {
        wr_free(set->about);
        set->about = wr_strdup(line + 6);
        set->about[strcspn(set->about, "\r")] = '\0';
        return true;
    }
    while (*line) {
        if (count == (int)WR_LENGTH(words))
            return wr_fail(err, "more than %d settings of one map", WR_MAP_SET_SETTINGS_MAX);
        words[count++] = line;
        line += strcspn(line, BLANKS);
        if (*line) *line++ = '\0';
        line += strspn(line, BLANKS);
    }
    if (strcmp(words[0], "material") != 0) return take_map(set, words, count, err);
    return count == 2 ? wr_material_formats_parse(words[1], &set->materials, err)
                      : wr_fail(err, "material: needs formats, such as mtlx,gltf");
}

WrMapSet *wr_map_set_parse(const char *name, const char *text, const char *where, WrError *err)
{
    WrMapSet *set = wr_alloc(1, sizeof *set);
    int number = 0;
    bool good = true;
    set->name = wr_strdup(name);
    set->about = wr_strdup("");
    for (const char *at = text; *at && good;) {
        const size_t length = strcspn(at, "\n");
        char *line = wr_strndup(at, length);
        number++;
        good = take_line(set, line, err);
        wr_free(line);
        at += length + (at[length] == '\n');
    }
    if (!good) wr_error_prefix(err, "%s:%d: ", where, number);
    else if (set->maps.count == 0)
        good = wr_fail(err, "%s: no map in it: a line such as \"normal+y *_normal.png\" is one",
                       where);
    if (good) return set;
    wr_map_set_free(set);
    return NULL;
}

/* ---- user's sets ---- */

static bool is_name(const char *name, size_t length)
{
    const size_t letters = strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                        "0123456789-_+");
    return length > 0 && length <= WR_MAP_SET_NAME_MAX && letters >= length;
}

/* NULL: no such file. Caller frees. A user's file replaces a built-in set of the same name. */
static char *own_path(const char *name)
{
    if (!is_name(name, strlen(name))) return NULL;
    WrText file = { 0 };
    wr_text_addf(&file, "sets/%s" SET_ENDING, name);
    char *path = wr_config_path(wr_text_get(&file));
    wr_text_fini(&file);
    if (path && wr_path_is_there(path)) return path;
    wr_free(path);
    return NULL;
}

static WrMapSet *read_own(const char *name, const char *path, WrError *err)
{
    char *text;
    size_t length;
    uint64_t size;
    int fd = wr_file_open(path, UINT64_MAX, &size, err);
    if (fd < 0) return NULL;
    wr_fd_close(fd);
    if (size > WR_MAP_SET_FILE_MAX) {
        wr_fail(err, "%s: %llu bytes: a set has at most %d", path, (unsigned long long)size,
                WR_MAP_SET_FILE_MAX);
        return NULL;
    }
    if (!wr_file_read(path, WR_MAP_SET_FILE_MAX, &text, &length, err)) return NULL;
    WrMapSet *set = NULL;
    if (strlen(text) == length) set = wr_map_set_parse(name, text, path, err);
    else wr_fail(err, "%s: a NUL byte: a set is plain text", path);
    if (set) set->own = true;
    wr_free(text);
    return set;
}

static WrMapSet *read_row(const WrMapSetRow *row, WrError *err)
{
    WrMapSet *set = wr_map_set_parse(row->name, row->maps, row->name, err);
    if (!set) return NULL;
    wr_free(set->about);
    set->about = wr_strdup(row->about);
    return set;
}

static const char *set_name(const void *ctx, int i)
{
    const WrMapSetNames *names = ctx;
    return i < names->names.count ? names->names.data[i] : NULL;
}

static void fail_unknown(const char *name, WrError *err)
{
    WrMapSetNames names = wr_map_set_names();
    char *folder = wr_config_path("sets");
    WrText what = { 0 };
    wr_text_addf(&what, "%.60s: unknown set, and there is no %.60s" SET_ENDING " in %.160s", name,
                 name, folder ? folder : "the folder of your settings");
    wr_fail_word(err, wr_text_get(&what), name, set_name, &names);
    wr_text_fini(&what);
    wr_free(folder);
    wr_map_set_names_free(&names);
}

WrMapSet *wr_map_set_find(const char *name, WrError *err)
{
    char *path = own_path(name);
    if (path) {
        WrMapSet *set = read_own(name, path, err);
        wr_free(path);
        return set;
    }
    for (int i = 0; i < WR_MAP_SET_ROWS; i++)
        if (strcmp(wr_map_set_rows[i].name, name) == 0) return read_row(&wr_map_set_rows[i], err);
    fail_unknown(name, err);
    return NULL;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static bool is_row(const char *name)
{
    for (int i = 0; i < WR_MAP_SET_ROWS; i++)
        if (strcmp(wr_map_set_rows[i].name, name) == 0) return true;
    return false;
}

WrMapSetNames wr_map_set_names(void)
{
    WrMapSetNames list = { 0 };
    for (int i = 0; i < WR_MAP_SET_ROWS; i++)
        wr_array_push(&list.names, wr_strdup(wr_map_set_rows[i].name));
    char *path = wr_config_path("sets");
    WrFolder *folder = path ? wr_folder_open(path) : NULL;
    const char *file;
    while (folder && list.names.count < WR_MAP_SET_ROWS + WR_MAP_SETS_MAX &&
           (file = wr_folder_next(folder))) {
        const size_t length = strlen(file), ending = sizeof SET_ENDING - 1;
        if (length <= ending || strcmp(file + length - ending, SET_ENDING) != 0) continue;
        char *name = wr_strndup(file, length - ending);
        if (is_name(name, length - ending) && !is_row(name)) wr_array_push(&list.names, name);
        else wr_free(name);
    }
    wr_folder_close(folder);
    wr_free(path);
    qsort(list.names.data + WR_MAP_SET_ROWS, (size_t)(list.names.count - WR_MAP_SET_ROWS),
          sizeof(char *), by_name);
    return list;
}

void wr_map_set_names_free(WrMapSetNames *list)
{
    for (int i = 0; i < list->names.count; i++) wr_free(list->names.data[i]);
    wr_array_free(&list->names);
}

#define CONTACT "contact="
#define UDIM "udim="
#define MATERIAL "material="

/* ---- options ---- */

static bool has_option(const WrExportKind *kind, const char *word, size_t length)
{
    for (const WrExportOptionInfo *o = kind->options; o->name; o++)
        if (strlen(o->name) == length && strncmp(o->name, word, length) == 0) return true;
    return false;
}

/* Sets an option if the kind has it (`taken`); false and a message only if the value is invalid. */
static bool set_word(const WrExportKind *kind, WrExportOptions *options, const char *word,
                     bool *taken, WrError *err)
{
    const char *equals = strchr(word, '=');
    char name[32];
    if (!equals) return wr_fail(err, "%.60s: must be name=value", word);
    size_t length = (size_t)(equals - word);
    if (length >= sizeof name || !has_option(kind, word, length)) return true;
    memcpy(name, word, length);
    name[length] = 0;
    *taken = true;
    return wr_export_option(kind, options, name, equals + 1, err);
}

/* Applies the set's settings, then the user's, which have priority. taken: [word_count]. */
static bool settle_map(const WrMapSetRequest *order, const WrMapSetEntry *map,
                       WrExportOptions *options, bool *taken, WrError *err)
{
    bool own;
    *options = wr_export_default();
    for (int i = 0; i < WR_MAP_SET_SETTINGS_MAX && map->settings[i]; i++)
        if (!set_word(map->kind, options, map->settings[i], &own, err)) return false;
    for (int i = 0; i < order->word_count; i++)
        if (!set_word(map->kind, options, order->words[i], &taken[i], err)) return false;
    return true;
}

bool wr_map_set_options(const WrMapSetRequest *order, int map, WrExportOptions *options,
                        WrError *err)
{
    bool taken[WR_MAP_SET_WORDS_MAX];
    return settle_map(order, &order->set->maps.data[map], options, taken, err);
}

/* Value of the word that begins with `name`, such as "contact="; NULL: none. */
static const char *value_of(const WrMapSetRequest *order, const char *name)
{
    for (int i = 0; i < order->word_count; i++)
        if (strncmp(order->words[i], name, strlen(name)) == 0)
            return order->words[i] + strlen(name);
    return NULL;
}

/* The contact sheet requested by the words; NULL: none. */
static const char *contact_of(const WrMapSetRequest *order)
{
    return value_of(order, CONTACT);
}

/* Bits of the material formats to write. */
static bool materials_of(const WrMapSetRequest *order, unsigned *formats, WrError *err)
{
    const char *value = value_of(order, MATERIAL);
    *formats = order->set->materials;
    return !value || wr_material_formats_parse(value, formats, err);
}

/* Tile of the files' names; 0: none. False: an invalid word. */
static bool udim_of(const WrMapSetRequest *order, const WrDocument *document, int *udim)
{
    const char *value = value_of(order, UDIM);
    *udim = value ? 0 : document->scene->projection.udim;
    return !value || strcmp(value, "none") == 0 || wr_udim_parse(value, udim);
}

/* True for words that are no option of a map. */
static bool is_of_set(const char *word)
{
    return strncmp(word, CONTACT, sizeof CONTACT - 1) == 0 ||
           strncmp(word, UDIM, sizeof UDIM - 1) == 0 ||
           strncmp(word, MATERIAL, sizeof MATERIAL - 1) == 0;
}

static bool settle(const WrMapSetRequest *order, const WrDocument *document,
                   WrExportOptions options[WR_MAP_SET_ENTRIES_MAX], WrError *err)
{
    bool taken[WR_MAP_SET_WORDS_MAX] = { false };
    const char *contact = contact_of(order);
    unsigned formats;
    int udim;
    if (!materials_of(order, &formats, err)) return false;
    if (!udim_of(order, document, &udim))
        return wr_fail(err, "udim=%.40s: must be none, or a tile's number, %d..%d",
                       value_of(order, UDIM), WR_UDIM_FIRST, WR_UDIM_LAST);
    if (contact && (!*contact || *contact == '.' || strchr(contact, '/')))
        return wr_fail(
            err, CONTACT "%.80s: must be a picture's name, such as contact.png, without a folder",
            contact);
    if (order->word_count > WR_MAP_SET_WORDS_MAX)
        return wr_fail(err, "%d options: a set has up to %d", order->word_count,
                       WR_MAP_SET_WORDS_MAX);
    for (int i = 0; i < order->set->maps.count; i++)
        if (!settle_map(order, &order->set->maps.data[i], &options[i], taken, err)) return false;
    for (int i = 0; i < order->word_count; i++)
        if (!taken[i] && !is_of_set(order->words[i]))
            return wr_fail(err, "%.60s: no map of the set %s has such an option", order->words[i],
                           order->set->name);
    return true;
}

/* ---- files ---- */

/* The name of one map's file without its folder; the caller frees it. */
static char *name_of(const WrMapSetRequest *order, const WrDocument *document, int map)
{
    const WrMapSetEntry *row = &order->set->maps.data[map];
    int udim;
    WrText name = { 0 };
    wr_text_addf(&name, "%s%s%s", row->before, order->name, row->after);
    if (!udim_of(order, document, &udim) || !udim) return name.data;
    char *numbered = wr_udim_insert(name.data, udim);
    wr_text_fini(&name);
    return numbered;
}

/* The names of the material files without their endings. */
static void material_name(const WrMapSetRequest *order, const WrDocument *document, WrText *name)
{
    int udim;
    wr_text_add(name, order->name);
    if (udim_of(order, document, &udim) && udim) wr_text_addf(name, ".%d", udim);
}

void wr_map_set_file(const WrMapSetRequest *order, const WrDocument *document, int map,
                     WrText *path)
{
    char *name = name_of(order, document, map);
    const size_t length = strlen(order->folder);
    const bool slash = length > 0 && order->folder[length - 1] == '/';
    wr_text_addf(path, "%s%s%s", order->folder, slash ? "" : "/", name);
    wr_free(name);
}

static bool check_names(const WrMapSetRequest *order, WrError *err)
{
    bool plain = *order->name != '\0';
    for (const char *c = order->name; *c; c++)
        plain = plain && *c != '/' && (unsigned char)*c >= ' ' && *c != 0x7f;
    if (!plain)
        return wr_fail(err,
                       "name '%.60s': must be the cell's name in the file names, without a folder",
                       order->name);
    if (!wr_path_is_folder(order->folder))
        return wr_fail(err, "%.200s: is not a folder: a set needs an existing folder",
                       order->folder);
    if (!wr_path_can_write(order->folder) || !wr_path_can_run(order->folder))
        return wr_fail(err, "%.200s: files cannot be written there (%s)", order->folder,
                       strerror(errno));
    return true;
}

static bool write_map(const WrMapSetRequest *order, int map, const WrExportOptions *options,
                      const WrDocument *document, WrPool *pool, WrExportReport *report,
                      WrText *list, WrError *err)
{
    WrText path = { 0 };
    int udim;
    (void)udim_of(order, document, &udim); /* checked before */
    wr_map_set_file(order, document, map, &path);
    const double began = wr_clock_seconds();
    bool good = wr_export(order->set->maps.data[map].kind, document, options, pool,
                          wr_text_get(&path), report, err);
    if (good) {
        wr_text_addf(list, "%s: ", wr_text_get(&path));
        wr_export_report_text(report, list);
        if (udim && report->ranged && !report->quantity && options->range != WR_EXPORT_RANGE_GIVEN)
            wr_text_add(list, "; the range is this tile's: range=LOW,HIGH gives all tiles one");
        wr_text_add(list, "\n");
        if (order->receipts)
            wr_receipts_add(order->receipts, wr_text_get(&path),
                            order->set->maps.data[map].kind->name, report, began);
    }
    wr_text_fini(&path);
    return good;
}

static bool write_maps(const WrMapSetRequest *order, const WrExportOptions *options,
                       const WrDocument *document, WrPool *pool, WrExportReport *reports,
                       WrText *list, WrError *err)
{
    const int count = order->set->maps.count;
    bool good = true;
    for (int i = 0; i < count && good; i++) {
        WrProgressPart share;
        const WrProgress *whole = wr_progress_enter(&share, (double)i / count, (i + 1.0) / count);
        good = write_map(order, i, &options[i], document, pool, &reports[i], list, err);
        wr_progress_set(whole);
    }
    return good && (!wr_progress_stopped() || wr_fail(err, "cancelled"));
}

/* ---- material files ---- */

static bool write_materials(const WrMapSetRequest *order, const WrExportOptions *options,
                            const WrExportReport *reports, const WrDocument *document, WrText *list,
                            WrError *err)
{
    WrMaterialMap maps[WR_MAP_SET_ENTRIES_MAX];
    WrText name = { 0 };
    unsigned formats;
    if (!materials_of(order, &formats, err)) return false;
    const int count = order->set->maps.count;
    for (int i = 0; i < count; i++)
        maps[i] = (WrMaterialMap){ order->set->maps.data[i].kind, name_of(order, document, i),
                                   options[i], reports[i] };
    material_name(order, document, &name);
    const WrMaterialRequest request = { order->folder, wr_text_get(&name), document, maps,
                                        count,         order->receipts };
    const bool good = wr_material_files_write(&request, formats, list, err);
    for (int i = 0; i < count; i++) wr_free((char *)maps[i].file);
    wr_text_fini(&name);
    return good;
}

/* ---- the contact sheet ---- */

/* Indices of the maps that are pictures of the table, into `shown`; returns their number. */
static int shown_of(const WrMapSet *set, int shown[WR_MAP_SET_ENTRIES_MAX])
{
    int count = 0;
    for (int i = 0; i < set->maps.count; i++)
        if (!set->maps.data[i].kind->write) shown[count++] = i;
    return count;
}

static bool add_map(WrContact *contact, const WrMapSetRequest *order, int map,
                    const WrExportOptions *options, const WrDocument *document, WrPool *pool,
                    WrError *err)
{
    const WrMapSetEntry *row = &order->set->maps.data[map];
    char *name = name_of(order, document, map);
    WrExportPreview picture;
    const bool good = wr_export_preview(row->kind, document, options, pool, &picture, err);
    if (good) wr_contact_add(contact, name, &picture);
    wr_export_preview_fini(&picture);
    wr_free(name);
    return good;
}

static bool is_map(const WrMapSetRequest *order, const WrDocument *document, const char *name)
{
    bool same = false;
    for (int i = 0; i < order->set->maps.count && !same; i++) {
        char *own = name_of(order, document, i);
        same = strcmp(own, name) == 0;
        wr_free(own);
    }
    return same;
}

static bool write_contact(const WrMapSetRequest *order, const WrExportOptions *options,
                          const WrDocument *document, WrPool *pool, WrText *list, WrError *err)
{
    int shown[WR_MAP_SET_ENTRIES_MAX];
    const int count = shown_of(order->set, shown);
    if (count == 0)
        return wr_fail(err, CONTACT "%.80s: no map of the set %s is a picture of the table",
                       contact_of(order), order->set->name);
    if (is_map(order, document, contact_of(order)))
        return wr_fail(err, CONTACT "%.80s: is the name of one of the maps", contact_of(order));
    char *path = wr_path_join(order->folder, contact_of(order));
    const double began = wr_clock_seconds();
    WrContact *contact = wr_contact_new(path, count, WR_CONTACT_TILE, err);
    bool good = contact != NULL;
    for (int i = 0; i < count && good; i++)
        good = add_map(contact, order, shown[i], &options[shown[i]], document, pool, err) &&
               (!wr_progress_stopped() || wr_fail(err, "cancelled"));
    good = good && wr_contact_write(contact, err);
    if (good) wr_text_addf(list, "%s: contact sheet of %d maps\n", path, count);
    if (good && order->receipts) wr_receipts_add(order->receipts, path, "contact", NULL, began);
    wr_contact_free(contact);
    wr_free(path);
    return good;
}

bool wr_export_map_set(const WrMapSetRequest *order, const WrDocument *document, WrPool *pool,
                       WrText *list, WrError *err)
{
    WrExportOptions options[WR_MAP_SET_ENTRIES_MAX];
    const size_t before = list->length;
    if (!check_names(order, err) || !settle(order, document, options, err)) return false;
    WrExportReport *reports = wr_alloc(WR_MAP_SET_ENTRIES_MAX, sizeof *reports);
    /* All files of a set are renamed together at the end: after an error or a crash no mixture of old and new maps remains. */
    WrFileGroup *group = wr_file_group_begin();
    bool good = write_maps(order, options, document, pool, reports, list, err) &&
                write_materials(order, options, reports, document, list, err) &&
                (!contact_of(order) || write_contact(order, options, document, pool, list, err));
    if (good) good = wr_file_group_commit(group, err);
    else wr_file_group_abort(group);
    wr_free(reports);
    if (!good && list->length > before) { /* nothing was written */
        list->length = before;
        list->data[before] = '\0';
    }
    return good;
}

void wr_map_set_cell_name(const char *path, WrText *name)
{
    const char *file = path && *path ? path : "wrinkle", *slash = strrchr(file, '/');
    const char *base = slash ? slash + 1 : file, *dot = strrchr(base, '.');
    wr_text_add_n(name, base, dot && dot > base ? (size_t)(dot - base) : strlen(base));
}
