#include "brush/library.h"

#include "base/array.h"
#include "base/error.h"
#include "base/file.h"
#include "base/enum_rows.h"
#include "base/text.h"
#include "system/path.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define DEEP 3        /* maximum depth of folders */
#define MANY 20000    /* presets in all */
#define ORDER 4194304 /* bytes of an order.conf */

typedef struct Found {
    WrPresetEntry entry;
    int collection, group, place; /* sort keys, before the name */
} Found;

struct WrLibrary {
    WR_ARRAY(Found) found;
};

#define NAMES(X) X(USER, "user") X(OURS, "wrinkle") X(MYPAINT2, "mypaint2") X(MYPAINT1, "mypaint1")
typedef enum Collection { NAMES(WR_WORD_ID) COLLECTIONS } Collection;
static const char *const collections[] = { NAMES(WR_WORD) };

/* ---- folders ---- */

static char *user_folder(void)
{
    const char *data = getenv("XDG_DATA_HOME"), *home = getenv("HOME");
    if (data && data[0] == '/') return wr_path_join(data, "wrinkle/brushes");
    return home && *home ? wr_path_join(home, ".local/share/wrinkle/brushes") : NULL;
}

/* The path of a search that took place; NULL if it found nothing. */
static char *taken(bool found, WrText *path)
{
    if (found) return path->data;
    wr_text_fini(path);
    return NULL;
}

/* NULL if it does not exist. The caller frees it. Collections are in order of priority: a preset of the user hides one of the
   same name further down. */
static char *collection_folder(Collection collection)
{
    WrText path = { 0 };
    switch (collection) {
    case USER: return user_folder();
    case OURS: return taken(wr_data_find("brushes", &path), &path);
    case MYPAINT2: return taken(wr_shared_find("mypaint-data/2.0/brushes", &path), &path);
    case MYPAINT1: return taken(wr_shared_find("mypaint-data/1.0/brushes", &path), &path);
    case COLLECTIONS: break;
    }
    return NULL;
}

char *wr_library_user_folder(WrError *err)
{
    char *folder = user_folder();
    if (!folder) {
        wr_fail(err, "no folder for your own presets: set XDG_DATA_HOME or HOME");
        return NULL;
    }
    for (char *slash = folder + 1;; slash++) {
        if (*slash != '/' && *slash) continue;
        char kept = *slash;
        *slash = '\0';
        bool made = wr_folder_make(folder, WR_FOLDER_FOR_ALL) || errno == EEXIST;
        if (!made) {
            wr_fail(err, "%s: cannot be created: %s", folder, strerror(errno));
            wr_free(folder);
            return NULL;
        }
        *slash = kept;
        if (!kept) return folder;
    }
}

/* ---- order.conf ---- */

/* Parses one preset per line, without extension, after its group's "Group: NAME". Sets group and place
   of the named presets of one collection; the first group that names one wins. */
static void read_order(WrLibrary *library, int first, char *text)
{
    int group = 0, place = 0;
    const char *name = "";
    for (char *next, *line = text; line; line = next) {
        next = strchr(line, '\n');
        if (next) *next++ = '\0';
        line[strcspn(line, "\r")] = '\0';
        if (strncmp(line, "Group: ", 7) == 0) {
            name = line + 7;
            group++;
        } else if (*line && *line != '#') {
            place++;
            for (int i = first; i < library->found.count; i++) {
                Found *found = &library->found.data[i];
                if (found->place > 0 || strcmp(found->entry.name, line) != 0) continue;
                found->group = group;
                found->place = place;
                wr_free(found->entry.group);
                found->entry.group = wr_strdup(name);
                break;
            }
        }
    }
}

/* ---- scanning a folder ---- */

static bool is_folder(const char *path)
{
    WrFileInfo info;
    return wr_path_info(path, &info) && info.kind == WR_KIND_FOLDER;
}

static void add_preset(WrLibrary *library, int collection, const char *root, const char *name)
{
    WrText text = { 0 };
    Found found = { .collection = collection, .group = 1 << 20 };
    size_t stem = strlen(name) - 4;
    wr_text_addf(&text, "%s/%s", root, name);
    found.entry.path = text.data;
    text = (WrText){ 0 };
    wr_text_addf(&text, "%s/%.*s_prev.png", root, (int)stem, name);
    WrFileInfo info;
    if (wr_path_info(text.data, &info) && info.kind == WR_KIND_FILE) {
        found.entry.picture = text.data;
    } else {
        wr_text_fini(&text);
    }
    text = (WrText){ 0 };
    wr_text_addf(&text, "%s/%.*s", collections[collection], (int)stem, name);
    found.entry.id = text.data;
    found.entry.name = text.data + strlen(collections[collection]) + 1;
    found.entry.collection = collections[collection];
    const char *slash = strrchr(found.entry.name, '/');
    found.entry.group =
        slash ? wr_strndup(found.entry.name, (size_t)(slash - found.entry.name)) : wr_strdup("");
    wr_array_push(&library->found, found);
}

/* below: path relative to root, "" or "classic". Depth and number are limited against links that form a cycle; sorting
   afterwards makes the order independent of the file system's. */
static void look_through(WrLibrary *library, int collection, const char *root, const char *below,
                         int deep)
{
    char *folder = *below ? wr_path_join(root, below) : wr_strdup(root);
    WrFolder *dir = wr_folder_open(folder);
    const char *item;
    while (dir && library->found.count < MANY && (item = wr_folder_next(dir))) {
        const char *name = item;
        size_t length = strlen(name);
        if (name[0] == '.') continue;
        WrText path = { 0 }, full = { 0 };
        wr_text_addf(&path, "%s%s%s", below, *below ? "/" : "", name);
        wr_text_addf(&full, "%s/%s", root, path.data);
        const char *end = length > 4 ? name + length - 4 : "";
        if (strcmp(end, ".myb") == 0) add_preset(library, collection, root, path.data);
        else if (strcmp(end, ".png") != 0 && deep < DEEP && is_folder(full.data))
            look_through(library, collection, root, path.data, deep + 1);
        wr_text_fini(&path);
        wr_text_fini(&full);
    }
    wr_folder_close(dir);
    wr_free(folder);
}

static int compare(const void *left, const void *right)
{
    const Found *a = left, *b = right;
    if (a->collection != b->collection) return a->collection - b->collection;
    if (a->group != b->group) return a->group - b->group;
    if (a->place != b->place) return a->place - b->place;
    return strcmp(a->entry.name, b->entry.name);
}

WrLibrary *wr_library_new(void)
{
    WrLibrary *library = wr_alloc(1, sizeof *library);
    for (int i = 0; i < COLLECTIONS; i++) {
        char *folder = collection_folder(i);
        if (!folder) continue;
        int first = library->found.count;
        look_through(library, i, folder, "", 0);
        char *path = wr_path_join(folder, "order.conf"), *text;
        size_t length;
        if (wr_file_read(path, ORDER, &text, &length, NULL)) {
            read_order(library, first, text);
            wr_free(text);
        }
        wr_free(path);
        wr_free(folder);
    }
    if (library->found.count > 0)
        qsort(library->found.data, (size_t)library->found.count, sizeof *library->found.data,
              compare);
    return library;
}

void wr_library_free(WrLibrary *library)
{
    if (!library) return;
    for (int i = 0; i < library->found.count; i++) {
        WrPresetEntry *entry = &library->found.data[i].entry;
        wr_free(entry->id);
        wr_free(entry->path);
        wr_free(entry->group);
        wr_free(entry->picture);
    }
    wr_array_free(&library->found);
    wr_free(library);
}

int wr_library_count(const WrLibrary *library)
{
    return library->found.count;
}

const WrPresetEntry *wr_library_entry(const WrLibrary *library, int index)
{
    WR_ASSERT(index >= 0 && index < library->found.count);
    return &library->found.data[index].entry;
}

/* ---- finding ---- */

static bool ends_in_myb(const char *name)
{
    size_t length = strlen(name);
    return length > 4 && strcmp(name + length - 4, ".myb") == 0;
}

/* The part after the last slash. */
static const char *tail(const char *name)
{
    const char *slash = strrchr(name, '/');
    return slash ? slash + 1 : name;
}

/* The entry for a name: its id, its name without collection, or only its last part; -1. */
static int find(const WrLibrary *library, const char *name)
{
    for (int way = 0; way < 3; way++)
        for (int i = 0; i < library->found.count; i++) {
            const WrPresetEntry *entry = &library->found.data[i].entry;
            const char *called = way == 0 ? entry->id : way == 1 ? entry->name : tail(entry->name);
            if (strcmp(called, name) == 0) return i;
        }
    return -1;
}

/* The names of presets: three for each. */
static const char *called(const void *ctx, int i)
{
    const WrLibrary *library = ctx;
    if (i / 3 >= library->found.count) return NULL;
    const WrPresetEntry *entry = &library->found.data[i / 3].entry;
    return i % 3 == 0 ? entry->name : i % 3 == 1 ? tail(entry->name) : entry->id;
}

static const char *id_called(const WrLibrary *library, int i)
{
    return library->found.data[i / 3].entry.id;
}

static bool fail_find(const WrLibrary *library, const char *name, WrError *err)
{
    int places[WR_NEAREST_MAX];
    const int count = wr_nearest(name, called, library, places);
    if (count > 0)
        return wr_fail(err, "no brush preset '%.80s': did you mean %s%s%s?", name,
                       id_called(library, places[0]), count > 1 ? " or " : "",
                       count > 1 ? id_called(library, places[1]) : "");
    return wr_fail(err,
                   "no brush preset '%.80s': must be one of the %d of the library, or a .myb file",
                   name, library->found.count);
}

char *wr_library_find(const char *name, WrError *err)
{
    WrFileInfo info;
    if (ends_in_myb(name)) {
        if (wr_path_info(name, &info)) return wr_strdup(name);
        wr_fail(err, "%s: %s", name, strerror(errno));
        return NULL;
    }
    WrLibrary *library = wr_library_new();
    int index = find(library, name);
    char *path = NULL;
    if (index >= 0) {
        path = wr_strdup(library->found.data[index].entry.path);
    } else {
        fail_find(library, name, err);
    }
    wr_library_free(library);
    return path;
}

WrPreset *wr_library_read(const char *name, WrError *err)
{
    char *path = wr_library_find(name, err);
    WrPreset *preset = path ? wr_preset_read(path, name, err) : NULL;
    wr_free(path);
    return preset;
}
