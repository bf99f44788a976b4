/* Text definitions of map sets: those of known programs, and the user's. */
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/enum_rows.h"
#include "base/suggest.h"
#include "base/text.h"
#include "export/export.h"
#include "export/map_sets.h"
#include "image/image.h"
#include "system/path.h"

#include <stdlib.h>
#include <string.h>

#define SET_ENDING ".set"
#define BLANKS " \t\r"

/* Heights are floats for programs that read and scale floats; otherwise 16 bits. */
const WrSetRow wr_set_rows[] = {
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
      "blue=metalness base=material\n" },
    { "unreal",
      "T_NAME_N with green down, T_NAME_H of 16 bits, T_NAME_ORM: occlusion (red), roughness "
      "(green), metalness (blue)",
      "normal-y T_*_N.png depth=8\n"
      "height T_*_H.png depth=16\n"
      "packed T_*_ORM.png depth=8 red=occlusion green=roughness blue=metalness base=material\n" },
    { "unity",
      "normals, heights, the mask map: metalness (red), occlusion (green), where details go "
      "(blue: everywhere), smoothness (alpha); the built-in pipeline takes it for metalness and "
      "occlusion as well",
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
};
_Static_assert(WR_LENGTH(wr_set_rows) == WR_SET_ROWS, "map_sets.h counts them");

void wr_set_free(WrSet *set)
{
    if (!set) return;
    for (int i = 0; i < set->maps.count; i++) {
        WrSetMap *map = &set->maps.data[i];
        wr_free(map->before);
        wr_free(map->after);
        for (int k = 0; k < WR_SET_SETTINGS; k++) wr_free(map->settings[k]);
    }
    wr_array_free(&set->maps);
    wr_free(set->name);
    wr_free(set->about);
    wr_free(set);
}

/* ---- one line ---- */

/* Possible first words of a line: the kinds, and "about". */
static const char *line_word(const void *ctx, int i)
{
    (void)ctx;
    return i < WR_EXPORT_KIND_COUNT    ? wr_export_kinds[i].name
           : i == WR_EXPORT_KIND_COUNT ? "about"
                                       : NULL;
}

static bool find_kind(const char *word, WrSetMap *map, WrError *err)
{
    map->kind = wr_export_find(word);
    if (map->kind) return true;
    char what[80];
    snprintf(what, sizeof what, "'%.40s' is no kind of map", word);
    return wr_fail_word(err, what, word, line_word, NULL);
}

/* Parses "T_*_N.png": a name without a folder, not hidden. */
static bool take_file(const char *word, WrSetMap *map, WrError *err)
{
    const char *star = strchr(word, '*');
    WrPixelType type;
    if (strchr(word, '/') || word[0] == '.')
        return wr_fail(err, "'%.80s': must be a file's name such as T_*_N.png, without a folder",
                       word);
    if (!star || strchr(star + 1, '*') || !star[1])
        return wr_fail(err, "'%.80s': must have one *, where the cell's name comes, and an ending",
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

static bool take_setting(const char *word, int index, WrSetMap *map, WrError *err)
{
    WrExportOptions options = wr_export_default();
    const char *equals = strchr(word, '=');
    if (!equals || equals == word)
        return wr_fail(err, "'%.60s': must be a setting, name=value", word);
    if (index >= WR_SET_SETTINGS)
        return wr_fail(err, "more than %d settings of one map", WR_SET_SETTINGS);
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

static bool check_file(const WrSetMap *map, WrError *err)
{
    WrExportOptions options = wr_export_default();
    if (map->kind->write) return true;
    for (int i = 0; i < WR_SET_SETTINGS && map->settings[i]; i++)
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

static bool is_same_file(const WrSetMap *a, const WrSetMap *b)
{
    return strcmp(a->before, b->before) == 0 && strcmp(a->after, b->after) == 0;
}

/* Parses a map line. words: [count], the first is not "about". The map is added first, so that it is freed with
   the set. */
static bool take_map(WrSet *set, char **words, int count, WrError *err)
{
    if (set->maps.count == WR_SET_MAPS) return wr_fail(err, "more than %d maps", WR_SET_MAPS);
    wr_array_push(&set->maps, (WrSetMap){ 0 });
    WrSetMap *map = &set->maps.data[set->maps.count - 1];
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
static bool take_line(WrSet *set, char *line, WrError *err)
{
    char *words[WR_SET_SETTINGS + 4];
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
            return wr_fail(err, "more than %d settings of one map", WR_SET_SETTINGS);
        words[count++] = line;
        line += strcspn(line, BLANKS);
        if (*line) *line++ = '\0';
        line += strspn(line, BLANKS);
    }
    return take_map(set, words, count, err);
}

WrSet *wr_set_parse(const char *name, const char *text, const char *where, WrError *err)
{
    WrSet *set = wr_alloc(1, sizeof *set);
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
    wr_set_free(set);
    return NULL;
}

/* ---- user's sets ---- */

static bool is_name(const char *name, size_t length)
{
    const size_t letters = strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                        "0123456789-_+");
    return length > 0 && length <= WR_SET_NAME && letters >= length;
}

/* NULL: no such file. Caller frees. */
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

static WrSet *read_own(const char *name, const char *path, WrError *err)
{
    char *text;
    size_t length;
    uint64_t size;
    int fd = wr_file_open(path, UINT64_MAX, &size, err);
    if (fd < 0) return NULL;
    wr_fd_close(fd);
    if (size > WR_SET_FILE_MOST) {
        wr_fail(err, "%s: %llu bytes: a set has at most %d", path, (unsigned long long)size,
                WR_SET_FILE_MOST);
        return NULL;
    }
    if (!wr_file_read(path, WR_SET_FILE_MOST, &text, &length, err)) return NULL;
    WrSet *set = NULL;
    if (strlen(text) == length) set = wr_set_parse(name, text, path, err);
    else wr_fail(err, "%s: a NUL byte: a set is plain text", path);
    if (set) set->own = true;
    wr_free(text);
    return set;
}

static WrSet *read_row(const WrSetRow *row, WrError *err)
{
    WrSet *set = wr_set_parse(row->name, row->maps, row->name, err);
    if (!set) return NULL;
    wr_free(set->about);
    set->about = wr_strdup(row->about);
    return set;
}

static const char *set_name(const void *ctx, int i)
{
    const WrSetNames *names = ctx;
    return i < names->names.count ? names->names.data[i] : NULL;
}

static void fail_unknown(const char *name, WrError *err)
{
    WrSetNames names = wr_set_names();
    char *folder = wr_config_path("sets");
    WrText what = { 0 };
    wr_text_addf(&what, "%.60s: unknown set, and there is no %.60s" SET_ENDING " in %.160s", name,
                 name, folder ? folder : "the folder of your settings");
    wr_fail_word(err, wr_text_get(&what), name, set_name, &names);
    wr_text_fini(&what);
    wr_free(folder);
    wr_set_names_free(&names);
}

WrSet *wr_set_find(const char *name, WrError *err)
{
    char *path = own_path(name);
    if (path) {
        WrSet *set = read_own(name, path, err);
        wr_free(path);
        return set;
    }
    for (int i = 0; i < WR_SET_ROWS; i++)
        if (strcmp(wr_set_rows[i].name, name) == 0) return read_row(&wr_set_rows[i], err);
    fail_unknown(name, err);
    return NULL;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static bool is_row(const char *name)
{
    for (int i = 0; i < WR_SET_ROWS; i++)
        if (strcmp(wr_set_rows[i].name, name) == 0) return true;
    return false;
}

WrSetNames wr_set_names(void)
{
    WrSetNames list = { 0 };
    for (int i = 0; i < WR_SET_ROWS; i++)
        wr_array_push(&list.names, wr_strdup(wr_set_rows[i].name));
    char *path = wr_config_path("sets");
    WrFolder *folder = path ? wr_folder_open(path) : NULL;
    const char *file;
    while (folder && list.names.count < WR_SET_ROWS + WR_SETS_MOST &&
           (file = wr_folder_next(folder))) {
        const size_t length = strlen(file), ending = sizeof SET_ENDING - 1;
        if (length <= ending || strcmp(file + length - ending, SET_ENDING) != 0) continue;
        char *name = wr_strndup(file, length - ending);
        if (is_name(name, length - ending) && !is_row(name)) wr_array_push(&list.names, name);
        else wr_free(name);
    }
    wr_folder_close(folder);
    wr_free(path);
    qsort(list.names.data + WR_SET_ROWS, (size_t)(list.names.count - WR_SET_ROWS), sizeof(char *),
          by_name);
    return list;
}

void wr_set_names_free(WrSetNames *list)
{
    for (int i = 0; i < list->names.count; i++) wr_free(list->names.data[i]);
    wr_array_free(&list->names);
}
