#include "ui/app/jobs/files.h"
#include "ui/app/jobs/portal.h"
#include "ui/toolkit/desktop_scale.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/app/jobs/job.h"

#include "base/array.h"
#include "base/enum_rows.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "image/image.h"
#include "image/mesh.h"
#include "system/path.h"
#include "system/thread.h"

#include <SDL.h>
#include <errno.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PATH_SIZE 4096
#define ENTRIES_MAX 4000 /* entries of a folder in the panel */

typedef struct Entry {
    char *name; /* owned */
    bool folder;
} Entry;

struct WrFiles {
    Uint32 done_event;
    WrFilePurpose purpose;
    char answer[PATH_SIZE]; /* "" if cancelled */
    /* the native dialog confirmed before it returned the name of an existing file */
    bool agreed;
    char *from; /* owned: initial file of the dialog, as a path */
    WrFileWay way;
    char parent[32]; /* identifier of the window for the portal */
    /* native dialog */
    bool running;
    WrPortalRequest ask; /* its texts are owned */
    WrPortalEnd end;
    volatile int stop;
    WrThread waiter;
    /* panel */
    char folder[PATH_SIZE], field[PATH_SIZE];
    WR_ARRAY(Entry) entries;
    int hidden; /* entries that cannot be read for the purpose */
    bool all;   /* show them too */
    bool focus;
    WrError trouble;                    /* text is "" if there is none */
    WrFilePlace places[WR_FILE_PLACES]; /* owned; as at the opening */
    int place_count;                    /* -1: not yet looked up */
};

#define PICTURES                                                                                   \
    "png", "exr", "tif", "tiff", "jpg", "jpeg", "jp2", "bmp", "tga", "hdr", "pfm", "pgm", "ppm",   \
        "webp", "gif", "psd", "dpx", "heic", "avif", "jxl"

/* Endings of the files that a purpose reads. */
static const char *const pictures[] = { PICTURES, NULL };
static const char *const stamps[] = { PICTURES, "gbr", "gih", "pat", NULL };
static const char *const documents[] = { PICTURES, "wrinkle",       "ora", "svg",
                                         "svgz",   WR_MESH_ENDINGS, NULL };
static const char *const scripts[] = { "wrinkle", NULL };
static const char *const tables[] = { PICTURES, "wrinkle", "ora", NULL };
static const char *const models[] = { "gltf", "glb", NULL };
static const char *const brushes[] = { "myb", NULL };
static const char *const patches[] = { "bpt", "txt", NULL };
static const char *const grounds[] = { PICTURES, "r16", "r32", "raw", "hgt", "fits", NULL };

WR_ROWS(purposes);
static const struct {
    const char *title, *done;
    /* of a file to be written, for names without extension; NULL: the file is read */
    const char *ending;
    const char *const *endings; /* of files that are read; NULL: any */
} purposes[WR_FILE_PURPOSES] = {
    [WR_ROW(WR_FILE_OPEN)] = { "Open", "Open", NULL, documents },
    [WR_ROW(WR_FILE_SAVE)] = { "Save as", "Save", ".exr", NULL },
    [WR_ROW(WR_FILE_EXPORT)] = { "Export to", "Export", ".png", NULL },
    [WR_ROW(WR_FILE_RENDER)] = { "Render to", "Render", ".png", NULL },
    [WR_ROW(WR_FILE_FILM)] = { "Save the film to", "Save", ".mp4", NULL },
    [WR_ROW(WR_FILE_IMPORT)] = { "Import heights", "Import", NULL, pictures },
    [WR_ROW(WR_FILE_HISTORY)] = { "Save the history as a script", "Save", ".wrinkle", NULL },
    [WR_ROW(WR_FILE_MACRO_SAVE)] = { "Save steps as a macro", "Save", ".wrinkle", NULL },
    [WR_ROW(WR_FILE_MACRO)] = { "Run a macro", "Open", NULL, scripts },
    [WR_ROW(WR_FILE_STAMP)] = { "Open a picture as a stamp", "Open", NULL, stamps },
    [WR_ROW(WR_FILE_GENERATE)] = { "Choose a file", "Choose", NULL, NULL },
    [WR_ROW(WR_FILE_LOCATE)] = { "Locate the missing file", "Locate", NULL, NULL },
    [WR_ROW(WR_FILE_TABLE)] = { "A table for the object", "Choose", NULL, tables },
    [WR_ROW(WR_FILE_COLOUR)] = { "Choose a picture of colours", "Choose", NULL, pictures },
    [WR_ROW(WR_FILE_NORMALS)] = { "Choose a normal map", "Choose", NULL, pictures },
    [WR_ROW(WR_FILE_ROUGHNESS)] = { "Choose a picture of roughness", "Choose", NULL, pictures },
    [WR_ROW(WR_FILE_METALNESS)] = { "Choose a picture of metalness", "Choose", NULL, pictures },
    [WR_ROW(WR_FILE_SURROUND)] = { "Choose a picture of surroundings", "Choose", NULL, pictures },
    [WR_ROW(WR_FILE_MESH)] = { "Choose a mesh", "Choose", NULL, wr_mesh_endings },
    [WR_ROW(WR_FILE_PATCHES)] = { "Choose a set of patches", "Choose", NULL, patches },
    [WR_ROW(WR_FILE_TERRAIN)] = { "Choose a picture of elevations", "Choose", NULL, grounds },
    [WR_ROW(WR_FILE_GLTF)] = { "Take the materials of a glTF", "Take", NULL, models },
    [WR_ROW(WR_FILE_BAKE)] = { "Choose a detailed mesh", "Choose", NULL, wr_mesh_endings },
    [WR_ROW(WR_FILE_BRUSH)] = { "Choose a brush", "Choose", NULL, brushes },
    [WR_ROW(WR_FILE_PRESET)] = { NULL, NULL, NULL, NULL }, /* typed name, no file dialog */
};
WR_ROWS_END(purposes, WR_FILE_PURPOSES);

bool wr_file_purpose_writes(WrFilePurpose purpose)
{
    return purposes[purpose].ending != NULL;
}

/* The name with the purpose's default extension if it has none. The caller frees it. */
static char *with_ending(const WrFiles *files, const char *path)
{
    char buffer[16];
    const char *ending = purposes[files->purpose].ending;
    WrText text = { 0 };
    if (!ending || wr_path_ending(path, buffer)[0]) return wr_strdup(path);
    wr_text_addf(&text, "%s%s", path, ending);
    return text.data;
}

static void free_entries(WrFiles *files)
{
    for (int i = 0; i < files->entries.count; i++) wr_free(files->entries.data[i].name);
    wr_array_free(&files->entries);
}

/* Look the places up again when the panel is shown. */
static void forget_places(WrFiles *files)
{
    wr_file_places_free(files->places, files->place_count);
    files->place_count = -1;
}

WrFiles *wr_files_new(Uint32 done_event)
{
    WrFiles *files = wr_alloc(1, sizeof *files);
    files->done_event = done_event;
    files->place_count = -1;
    return files;
}

/* ---- the portal ---- */

/* timeout in seconds for the portal's first response, before the panel opens */
#define SOON 1.0
#define LATE 10.0 /* timeout if the user has chosen the portal: it may be starting */

static void free_ask(WrPortalRequest *ask)
{
    const char *const texts[] = { ask->title, ask->accept, ask->folder, ask->name };
    for (int i = 0; i < WR_LENGTH(texts); i++) wr_free((char *)(uintptr_t)texts[i]);
    *ask = (WrPortalRequest){ 0 };
}

/* Runs on a separate thread. */
static void *wait_for_portal(void *arg)
{
    WrFiles *files = arg;
    files->end = wr_portal_request(&files->ask, &files->stop, files->answer, sizeof files->answer);
    SDL_Event event = { .type = files->done_event };
    SDL_PushEvent(&event);
    return NULL;
}

static bool ask_portal(WrFiles *files, const char *folder, const char *name)
{
    const bool writes = wr_file_purpose_writes(files->purpose);
    if (!wr_portal_may_be()) return false;
    free_ask(&files->ask);
    files->ask = (WrPortalRequest){ .title = wr_strdup(wr_words(purposes[files->purpose].title)),
                                    .accept = wr_strdup(wr_words(purposes[files->purpose].done)),
                                    .folder = wr_strdup(folder),
                                    .name = wr_strdup(name),
                                    .parent = files->parent,
                                    .kind = wr_words("What can be read here"),
                                    .all = wr_words("All files"),
                                    .endings = writes ? NULL : purposes[files->purpose].endings,
                                    .save = writes,
                                    .patience = files->way == WR_FILE_WAY_DESKTOP ? LATE : SOON };
    files->stop = 0;
    files->running = wr_thread_start(&files->waiter, wait_for_portal, files);
    return files->running;
}

static bool wants_own(const WrFiles *files)
{
    const char *forced = getenv("WRINKLE_DIALOG");
    return files->way == WR_FILE_WAY_OWN || (forced && strcmp(forced, "own") == 0);
}

void wr_files_choose_way(WrFiles *files, WrFileWay way)
{
    files->way = way;
}

void wr_files_set_window(WrFiles *files, SDL_Window *window)
{
    const unsigned long number = wr_desktop_window(window);
    files->parent[0] = '\0';
    if (number) snprintf(files->parent, sizeof files->parent, "x11:%lx", number);
}

static void join(WrFiles *files)
{
    wr_thread_join(files->waiter);
    files->running = false;
}

/* ---- folder of the panel ---- */

static int by_name(const void *a, const void *b)
{
    const Entry *x = a, *y = b;
    if (x->folder != y->folder) return x->folder ? -1 : 1;
    return SDL_strcasecmp(x->name, y->name);
}

static bool is_folder(const char *path)
{
    WrFileInfo info;
    return wr_path_info(path, &info) && info.kind == WR_KIND_FOLDER;
}

static void list_folder(WrFiles *files)
{
    free_entries(files);
    files->trouble = (WrError){ "" };
    files->hidden = 0;
    WrFolder *dir = wr_folder_open(files->folder);
    if (!dir) {
        wr_fail(&files->trouble, "%s: %s", files->folder, strerror(errno));
        return;
    }
    for (const char *e; (e = wr_folder_next(dir)) && files->entries.count < ENTRIES_MAX;) {
        if (e[0] == '.') continue;
        char *full = wr_path_join(files->folder, e);
        bool folder = is_folder(full), fits = folder || wr_file_fits(files->purpose, e);
        if (fits || files->all) wr_array_push(&files->entries, ((Entry){ wr_strdup(e), folder }));
        files->hidden += !fits;
        wr_free(full);
    }
    wr_folder_close(dir);
    if (files->entries.count > 1)
        qsort(files->entries.data, (size_t)files->entries.count, sizeof(Entry), by_name);
}

static void go_to(WrFiles *files, const char *folder)
{
    char *full = wr_path_real(folder);
    snprintf(files->folder, sizeof files->folder, "%s", full ? full : folder);
    free(full);
    list_folder(files);
    files->focus = true;
}

/* The field's text as a path: "~" is the home folder; relative paths refer to the shown folder. */
static char *typed_path(const WrFiles *files)
{
    const char *home = getenv("HOME"), *text = files->field;
    while (*text == ' ') text++;
    if (text[0] == '~' && (text[1] == '/' || text[1] == '\0') && home)
        return wr_path_join(home, text[1] ? text + 2 : "");
    return wr_path_join(files->folder, text);
}

/* Handle Return: show a folder, or accept a file. */
static bool accept(WrFiles *files)
{
    if (files->field[0] == '\0') return false;
    char *path = typed_path(files);
    bool done = false;
    if (is_folder(path)) {
        go_to(files, path);
        files->field[0] = '\0';
    } else if (!wr_file_purpose_writes(files->purpose) && !wr_path_can_read(path)) {
        wr_fail(&files->trouble, "%s: %s", path, strerror(errno));
    } else {
        char *full = with_ending(files, path);
        snprintf(files->answer, sizeof files->answer, "%s", full);
        wr_free(full);
        done = true;
    }
    wr_free(path);
    return done;
}

bool wr_files_request_path(WrFiles *files, WrFilePurpose purpose, const char *folder,
                           const char *name)
{
    if (files->running) return true; /* one at a time: the first is still open */
    files->purpose = purpose;
    files->answer[0] = '\0';
    files->agreed = false;
    /* Only for purposes with a typed name. */
    if (purpose == WR_FILE_SAVE || purpose == WR_FILE_EXPORT || purpose == WR_FILE_RENDER)
        wr_image_warm_writing();
    char *from = folder ? wr_strdup(folder) : wr_path_real(".");
    forget_places(files);
    wr_free(files->from);
    files->from = wr_path_join(from ? from : "/", name);
    snprintf(files->field, sizeof files->field, "%s", name);
    const bool native = !wants_own(files) && ask_portal(files, from ? from : "", name);
    if (!native) go_to(files, from ? from : "/");
    if (folder) wr_free(from);
    else free(from);
    return native;
}

/* The native dialog has seen the name without the added extension, so it has not confirmed the file of the full
   name. */
static void take_native(WrFiles *files)
{
    char *full = with_ending(files, files->answer);
    if (!files->answer[0]) full[0] = '\0';
    files->agreed = strcmp(full, files->answer) == 0;
    snprintf(files->answer, sizeof files->answer, "%s", full);
    wr_free(full);
}

bool wr_files_hear(WrFiles *files)
{
    if (!files->running) return true;
    join(files);
    if (files->end != WR_PORTAL_NONE) {
        take_native(files);
        return true;
    }
    files->answer[0] = '\0';
    char *folder = wr_path_folder(files->from);
    go_to(files, folder);
    wr_free(folder);
    return false;
}

bool wr_files_agreed(const WrFiles *files)
{
    return files->agreed;
}

const char *wr_files_answer(WrFiles *files, WrFilePurpose *purpose)
{
    if (files->running) {
        join(files);
        take_native(files);
    }
    *purpose = files->purpose;
    return files->answer[0] ? files->answer : NULL;
}

void wr_files_free(WrFiles *files)
{
    if (!files) return;
    WrFilePurpose unused;
    __atomic_store_n(&files->stop, 1, __ATOMIC_RELAXED);
    wr_files_answer(files, &unused);
    free_ask(&files->ask);
    wr_free(files->from);
    free_entries(files);
    forget_places(files);
    wr_free(files);
}

/* ---- the panel ---- */

static void show_entries(WrFiles *files, bool *done)
{
    const char *enter = NULL;
    wr_gui_list_begin("entries", wr_gui_px(300));
    if (strcmp(files->folder, "/") != 0 && wr_gui_list_row(WR_ICON_UP, "..", false)) enter = "..";
    for (int i = 0; i < files->entries.count; i++) {
        const Entry *e = &files->entries.data[i];
        wr_gui_push_id(i);
        wr_gui_as_it_is(true);
        int clicked = wr_gui_list_row(e->folder ? WR_ICON_FOLDER : WR_ICON_FILE, e->name,
                                      strcmp(files->field, e->name) == 0);
        wr_gui_as_it_is(false);
        wr_gui_pop_id();
        if (!clicked) continue;
        if (e->folder) {
            enter = e->name;
        } else {
            snprintf(files->field, sizeof files->field, "%s", e->name);
            if (clicked == 2) *done = true;
        }
    }
    wr_gui_list_end();
    if (!enter) return;
    char *full = wr_path_join(files->folder, enter);
    go_to(files, full);
    wr_free(full);
}

/* An existing file has the typed name. */
static bool overwrites(const WrFiles *files)
{
    if (!wr_file_purpose_writes(files->purpose) || files->field[0] == '\0') return false;
    char *path = typed_path(files), *full = with_ending(files, path);
    const bool there = wr_path_is_there(full) && !is_folder(path);
    wr_free(full);
    wr_free(path);
    return there;
}

WrFilePurpose wr_files_purpose(const WrFiles *files)
{
    return files->purpose;
}

/* Buttons of the shortcut folders, in rows of the dialog's width. */
static void show_places(WrFiles *files, char *const recent[])
{
    if (files->place_count < 0)
        files->place_count = wr_file_places(getenv("HOME"), recent, files->places);
    const WrFilePlace *places = files->places;
    int count = files->place_count, chosen = -1;
    double left = wr_gui_available();
    for (int i = 0; i < count; i++) {
        wr_gui_as_it_is(!places[i].named); /* a folder's name must not be translated */
        double wide = wr_gui_text_width(WR_FONT_TEXT, places[i].label) + wr_gui_px(46);
        if (i > 0 && wide < left) wr_gui_same_line(6);
        else left = wr_gui_available();
        left -= wide;
        wr_gui_push_id(i);
        if (wr_gui_chip(WR_ICON_FOLDER, places[i].label)) chosen = i;
        wr_gui_as_it_is(false);
        wr_gui_pop_id();
        wr_gui_as_it_is(true);
        wr_gui_tip(places[i].path);
        wr_gui_as_it_is(false);
    }
    if (chosen >= 0) go_to(files, places[chosen].path);
}

int wr_files_panel(WrFiles *files, const char *note, char *const recent[])
{
    if (!wr_gui_dialog_begin(purposes[files->purpose].title, 620)) return 0;
    bool done = false;
    int answer = 0;
    show_places(files, recent);
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL, files->folder);
    show_entries(files, &done);
    if (files->hidden > 0 || files->all) {
        if (wr_gui_check("All files", &files->all)) list_folder(files);
        wr_gui_tip("Also files whose names suggest that they cannot be read");
    }
    bool entered = wr_gui_text_field("##name", 0, files->field, sizeof files->field, files->focus);
    files->focus = false;
    if (files->trouble.text[0]) wr_gui_note(WR_COLOUR_BAD, wr_error_message(&files->trouble), 1);
    else wr_gui_note(WR_COLOUR_CELL, overwrites(files) ? "A file with this name exists." : "", 1);
    wr_gui_space(4);
    if (wr_gui_button(purposes[files->purpose].done, true)) done = true;
    wr_gui_same_line(8);
    if (wr_gui_button("Cancel", false) || wr_gui_escape_pressed()) answer = -1;
    if (note[0]) {
        wr_gui_same_line(12);
        wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, note);
    }
    if (entered || done) answer = accept(files) ? 1 : 0;
    if (answer < 0) files->answer[0] = '\0';
    wr_gui_dialog_end();
    return answer;
}

/* ---- places: folders in the panel ---- */

/* Takes ownership of both strings. */
static void add(WrFilePlace *places, int *count, char *label, char *path, bool named)
{
    bool wanted = *count < WR_FILE_PLACES && is_folder(path);
    for (int i = 0; i < *count && wanted; i++) wanted = strcmp(places[i].path, path) != 0;
    if (wanted) {
        places[(*count)++] = (WrFilePlace){ label, path, named };
        return;
    }
    wr_free(label);
    wr_free(path);
}

int wr_file_places(const char *home, char *const recent[], WrFilePlace places[WR_FILE_PLACES])
{
    static const char *const own[] = { "Documents", "Pictures", "Downloads" };
    int count = 0;
    if (home && home[0]) add(places, &count, wr_strdup("Home"), wr_strdup(home), true);
    for (size_t i = 0; home && home[0] && i < sizeof own / sizeof *own; i++)
        add(places, &count, wr_strdup(own[i]), wr_path_join(home, own[i]), true);
    for (int i = 0; recent[i]; i++) {
        char *folder = wr_path_folder(recent[i]), *slash = strrchr(folder, '/');
        add(places, &count, wr_strdup(slash && slash[1] ? slash + 1 : folder), folder, false);
    }
    return count;
}

void wr_file_places_free(WrFilePlace places[], int count)
{
    for (int i = 0; i < count; i++) {
        wr_free(places[i].label);
        wr_free(places[i].path);
    }
}

static bool is_one_of(const char *ending, const char *const *list)
{
    for (int i = 0; list[i]; i++)
        if (strcmp(ending, list[i]) == 0) return true;
    return false;
}

bool wr_file_fits(WrFilePurpose purpose, const char *name)
{
    char buffer[16];
    const char *const *endings = purposes[purpose].endings;
    return !endings || is_one_of(wr_path_ending(name, buffer), endings);
}
