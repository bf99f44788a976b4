/* Cache of presets and tips named by commands. Each is read again only if its files change. Starting a stroke then
   needs no disk access except a check of the file's date. */
#include "command/session_internal.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "brush/library.h"
#include "brush/tip.h"
#include "system/path.h"

#include <string.h>

#define FILES_MAX 48 /* entries kept in memory */

typedef struct Entry {
    bool is_tip;
    char *key;  /* a bare name, or a file's path; owned */
    char *path; /* owned */
    WrFileInfo stamp;
    char sha256[65];
    WrPreset *preset; /* owned; NULL if the entry is a tip: */
    WrTip *tip;       /* owned */
    char *tip_path;   /* owned; the preset's tip file; NULL: none */
    uint64_t used;
} Entry;

struct WrBrushFiles {
    Entry entries[FILES_MAX];
    int count;
    uint64_t clock;
};

static void entry_fini(Entry *entry)
{
    wr_free(entry->key);
    wr_free(entry->path);
    wr_free(entry->tip_path);
    wr_preset_free(entry->preset);
    wr_tip_free(entry->tip);
    *entry = (Entry){ 0 };
}

void wr_brush_files_free(WrBrushFiles *files)
{
    for (int i = 0; files && i < files->count; i++) entry_fini(&files->entries[i]);
    wr_free(files);
}

void wr_session_forget_brushes(WrSession *session)
{
    wr_brush_files_free(session->brush_files);
    session->brush_files = NULL;
}

/* ---- files ---- */

/* True if none of the entry's files has changed. */
static bool is_fresh(const Entry *entry)
{
    WrFileInfo now;
    const WrFileInfo *then = &entry->stamp;
    return wr_path_info(entry->path, &now) && now.device == then->device &&
           now.inode == then->inode && now.bytes == then->bytes && now.seconds == then->seconds &&
           now.nanoseconds == then->nanoseconds && now.changed_seconds == then->changed_seconds &&
           now.changed_nanoseconds == then->changed_nanoseconds;
}

/* The string after the next `"tip" :`, or NULL; *p advances. The caller frees it. A name with escapes is skipped. */
static char *next_tip_name(const char **p)
{
    static const char key[] = "\"tip\"", blanks[] = " \t\r\n";
    while ((*p = strstr(*p, key))) {
        const char *s = *p += sizeof key - 1;
        s += strspn(s, blanks);
        if (*s++ != ':') continue;
        s += strspn(s, blanks);
        if (*s++ != '"') continue;
        size_t length = strcspn(s, "\"\\/");
        if (length == 0 || s[length] != '"') continue;
        return wr_strndup(s, length);
    }
    return NULL;
}

/* The tip file in a preset's folder. The text was already read as a preset. A false match of the key "tip" therefore
   yields at worst a file name that is never used. */
static char *tip_beside(const char *text, const char *folder)
{
    char *name, *found = NULL;
    while (!found && (name = next_tip_name(&text))) {
        WrFileInfo info;
        char *path = wr_path_join(folder, name);
        if (wr_path_info(path, &info) && info.kind == WR_KIND_FILE) found = path;
        else wr_free(path);
        wr_free(name);
    }
    return found;
}

/* "x/soft.myb" -> "soft"; a bare name stays. */
static char *short_name(const char *word)
{
    if (!wr_names_preset_file(word)) return wr_strdup(word);
    const char *slash = strrchr(word, '/');
    const char *base = slash ? slash + 1 : word;
    return wr_strndup(base, (size_t)(strrchr(base, '.') - base));
}

static bool read_preset(Entry *entry, const char *word, WrError *err)
{
    char *bytes;
    size_t length;
    if (!wr_file_read(entry->path, WR_PRESET_BYTES, &bytes, &length, err)) return false;
    char *folder = wr_path_folder(entry->path), *name = short_name(word);
    wr_sha256_bytes(bytes, length, entry->sha256);
    entry->preset = wr_preset_parse(bytes, length, name, folder, err);
    if (entry->preset && wr_preset_tip(entry->preset)) entry->tip_path = tip_beside(bytes, folder);
    if (!entry->preset && err && !strstr(err->text, entry->path))
        wr_error_prefix(err, "%s: ", entry->path);
    wr_free(folder);
    wr_free(name);
    wr_free(bytes);
    return entry->preset != NULL;
}

static bool read_tip(Entry *entry, WrError *err)
{
    if (!wr_sha256_file(entry->path, entry->sha256, err)) return false;
    entry->tip = wr_tip_read(entry->path, err);
    return entry->tip != NULL;
}

/* ---- cache ---- */

static Entry *find(WrBrushFiles *files, bool is_tip, const char *key)
{
    for (int i = 0; i < files->count; i++)
        if (files->entries[i].is_tip == is_tip && strcmp(files->entries[i].key, key) == 0)
            return &files->entries[i];
    return NULL;
}

/* Slot for a new entry: that of `old`, a free one, or the least recently used one. */
static Entry *place_for(WrBrushFiles *files, Entry *old)
{
    Entry *place = old;
    if (!place && files->count < FILES_MAX) return &files->entries[files->count++];
    for (int i = 0; !old && i < files->count; i++)
        if (!place || files->entries[i].used < place->used) place = &files->entries[i];
    entry_fini(place);
    return place;
}

/* The path (ownership passes), absolute and without links if it can be resolved. */
static char *absolute(char *path)
{
    char *real = path ? wr_path_real(path) : NULL;
    if (!real) return path;
    wr_free(path);
    path = wr_strdup(real);
    free(real);
    return path;
}

static bool take(WrSession *session, bool is_tip, const char *key, WrBrushFile *file, WrError *err)
{
    if (!session->brush_files) session->brush_files = wr_alloc(1, sizeof *session->brush_files);
    WrBrushFiles *files = session->brush_files;
    Entry *entry = find(files, is_tip, key);
    if (!entry || !is_fresh(entry)) {
        bool bare = !is_tip && !wr_names_preset_file(key);
        Entry made = { .is_tip = is_tip,
                       .path = bare ? absolute(wr_library_find(key, err)) : wr_strdup(key) };
        /* Take the file identity before reading: a file that changes during the read is then read again. */
        bool good = made.path != NULL;
        if (good && !wr_path_info(made.path, &made.stamp)) made.stamp = (WrFileInfo){ .bytes = -1 };
        good = good && (is_tip ? read_tip(&made, err) : read_preset(&made, key, err));
        if (!good) {
            entry_fini(&made);
            return false;
        }
        made.key = wr_strdup(key);
        entry = place_for(files, entry);
        *entry = made;
    }
    entry->used = ++files->clock;
    *file = (WrBrushFile){ entry->path, entry->sha256, entry->preset, entry->tip, entry->tip_path };
    return true;
}

bool wr_session_preset_file(WrSession *session, const char *word, const char *folder,
                            WrBrushFile *file, WrError *err)
{
    char *key = wr_names_preset_file(word) ? absolute(wr_path_join(folder, word)) : wr_strdup(word);
    bool good = take(session, false, key, file, err);
    wr_free(key);
    return good;
}

bool wr_session_tip_file(WrSession *session, const char *word, const char *folder,
                         WrBrushFile *file, WrError *err)
{
    char *key = absolute(wr_path_join(folder, word));
    bool good = take(session, true, key, file, err);
    wr_free(key);
    return good;
}
