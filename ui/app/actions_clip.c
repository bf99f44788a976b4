/* Copy, cut and paste. A copy is a file that `picture paste` reads, so that the line in the history names it. */
#include "ui/app/actions.h"
#include "ui/canvas/tools/tool_transform.h"
#include "ui/canvas/view.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/drawing.h"
#include "ui/app/state/line.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/session_view.h"
#include "ui/panels/generate/generate_state.h"
#include "ui/input/clip.h"
#include "ui/toolkit/words.h"

#include "base/array.h"
#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/command_line.h"
#include "document/document.h"
#include "document/recovery_journal.h"
#include "field/field.h"
#include "field/select.h"
#include "generate/generator.h"
#include "image/image.h"
#include "image/svg.h"
#include "system/clock.h"
#include "system/path.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define KEPT 20 /* number of kept copies, so that lines in histories can run again */

/* "STATE/clipboard", beside the journals; created if missing. */
static bool clip_folder(WrText *path, WrError *err)
{
    if (!wr_journal_folder(path, err)) return false;
    char *name = strrchr(path->data, '/');
    WrText folder = { 0 };
    wr_text_add_n(&folder, path->data, name ? (size_t)(name - path->data) : 0);
    wr_text_add(&folder, "/clipboard");
    wr_text_fini(path);
    *path = folder;
    for (char *slash = path->data + 1; (slash = strchr(slash, '/')); slash++) {
        *slash = '\0';
        wr_folder_make(path->data, WR_FOLDER_FOR_ME);
        *slash = '/';
    }
    wr_folder_make(path->data, WR_FOLDER_FOR_ME);
    return wr_path_is_folder(path->data) || wr_fail(err, "%s: cannot be created", path->data);
}

typedef WR_ARRAY(char *) Names;

static int by_name(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* File names contain the time: remove the oldest. */
static void forget_old(const char *path)
{
    Names names = { 0 };
    WrFolder *folder = wr_folder_open(path);
    for (const char *name; folder && (name = wr_folder_next(folder));)
        if (strncmp(name, "copy-", 5) == 0) wr_array_push(&names, wr_strdup(name));
    wr_folder_close(folder);
    if (names.count > 1) qsort(names.data, (size_t)names.count, sizeof *names.data, by_name);
    for (int i = 0; i < names.count; i++) {
        char *old = wr_path_join(path, names.data[i]);
        if (i < names.count - KEPT) wr_path_remove(old);
        wr_free(old);
        wr_free(names.data[i]);
    }
    wr_array_free(&names);
}

/* A path for a new copy with that extension. tail: between the date and the extension. */
static bool new_path(WrText *path, const char *tail, const char *ending, WrError *err)
{
    struct tm date;
    char name[80];
    if (!clip_folder(path, err)) return false;
    forget_old(wr_text_get(path));
    wr_clock_universal((int64_t)time(NULL), &date);
    strftime(name, sizeof name, "/copy-%Y%m%d-%H%M%S", &date);
    wr_text_addf(path, "%s-%06d%s.%s", name,
                 (int)(1e6 * (wr_clock_seconds() - floor(wr_clock_seconds()))), tail, ending);
    return true;
}

/* ---- position of a copy ---- */

/* The file name contains the position, so that any window can paste in place: "copy-DATE-at-U-V.exr". */
static const char place_mark[] = "-at-";

/* Centre of the selection, or of the table without a selection. */
static void add_place(const WrApp *app, WrText *tail)
{
    const WrField *field = wr_app_field(app), *selection = wr_app_document(app)->selection;
    const double w = wr_field_width(field), h = wr_field_height(field);
    WrSelectBox box = { 0, 0, (int)w, (int)h };
    if (selection && !wr_select_box(selection, &box)) return;
    const double u = (box.i + 0.5 * box.count_i) / w, v = 1.0 - (box.j + 0.5 * box.count_j) / h;
    wr_text_add(tail, place_mark);
    wr_text_add_number(tail, u - floor(u));
    wr_text_add(tail, "_");
    wr_text_add_number(tail, v - floor(v));
}

/* at: u, v. False: the file is not such a copy. */
static bool find_place(const char *path, double at[2])
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const char *mark = strstr(name, place_mark);
    if (!mark || strncmp(name, "copy-", 5) != 0) return false;
    mark += sizeof place_mark - 1;
    const char *second = strchr(mark, '_'), *dot = strrchr(mark, '.');
    return second && dot && dot > second &&
           wr_number_parse(mark, (size_t)(second - mark), &at[0]) &&
           wr_number_parse(second + 1, (size_t)(dot - second - 1), &at[1]);
}

/* ---- copy, cut ---- */

static bool copy(WrApp *app, const char *of)
{
    WrText path = { 0 }, line = { 0 }, tail = { 0 };
    WrError err;
    add_place(app, &tail);
    bool good = new_path(&path, wr_text_get(&tail), "exr", &err);
    if (!good) wr_app_fail(app, &err);
    wr_text_add(&line, "copy ");
    wr_text_add_word(&line, wr_text_get(&path));
    if (of) wr_text_addf(&line, " of=%s", of);
    good = good && wr_app_run_line(app, wr_text_get(&line));
    if (good)
        SDL_SetClipboardText(wr_text_get(&path)); /* other windows of the program find the
                                                           copy by its path */
    if (good) wr_app_say(app, "Copied");
    wr_text_fini(&path);
    wr_text_fini(&line);
    wr_text_fini(&tail);
    return good;
}

void wr_act_copy(WrApp *app)
{
    copy(app, NULL);
}

void wr_act_copy_shown(WrApp *app)
{
    copy(app, "composite");
}

void wr_act_cut(WrApp *app)
{
    if (copy(app, NULL)) wr_act_layer_clear(app);
}

/* ---- paste ---- */

/* Content of the clipboard: the path of a file, or path data of a drawing. Zeroed is empty. */
typedef struct Clip {
    WrText path;
    char *data;       /* owned; NULL: a file */
    const char *name; /* of a drawing without a file: of its layer; NULL: the file's name */
} Clip;

/* A drawing without a file: one path is kept in the layer's line; any other drawing becomes a file named by its content,
   which is never removed, since layers keep its name. */
static bool take_drawing(Clip *clip, const char *bytes, size_t length, WrError *err)
{
    char hex[65], *text = wr_strndup(bytes, length);
    clip->name = wr_words("Vector drawing");
    clip->data = wr_svg_one_path(text);
    wr_free(text);
    if (clip->data && strlen(clip->data) < WR_GENERATE_TEXT) return true;
    wr_free(clip->data);
    clip->data = NULL;
    if (!clip_folder(&clip->path, err)) return false;
    wr_sha256_bytes(bytes, length, hex);
    wr_text_addf(&clip->path, "/drawing-%.16s.svg", hex);
    return wr_path_is_file(wr_text_get(&clip->path)) ||
           wr_file_write(wr_text_get(&clip->path), bytes, length, err);
}

/* The first line's path, as file managers copy it: "/a b" or "file:///a%20b". False: it names no file. */
static bool take_path(Clip *clip, const char *text, size_t length)
{
    static const char scheme[] = "file://";
    const char *end = memchr(text, '\n', length);
    if (end) length = (size_t)(end - text);
    while (length > 0 && text[length - 1] == '\r') length--;
    const bool coded = length > 7 && strncmp(text, scheme, 7) == 0;
    for (size_t i = coded ? 7 : 0; i < length; i++) {
        char hex[3] = { 0 }, *last = hex;
        if (coded && text[i] == '%' && i + 2 < length) memcpy(hex, text + i + 1, 2);
        const char byte = (char)strtol(hex, &last, 16);
        const bool code = last == hex + 2;
        wr_text_add_n(&clip->path, code ? &byte : text + i, 1);
        if (code) i += 2;
    }
    const char *path = wr_text_get(&clip->path);
    if (path[0] == '/' && wr_path_is_file(path)) return true;
    wr_text_fini(&clip->path);
    return false;
}

static bool take_bytes(Clip *clip, const char *bytes, size_t length, const char *ending,
                       WrError *err)
{
    if (strcmp(ending, "svg") == 0) return take_drawing(clip, bytes, length, err);
    if (strcmp(ending, "uri") == 0)
        return take_path(clip, bytes, length) ||
               wr_fail(err, "the file on the clipboard does not exist");
    return new_path(&clip->path, "", ending, err) &&
           wr_file_write(wr_text_get(&clip->path), bytes, length, err);
}

/* Take the system clipboard's content: a picture or a drawing of another program, which is written to a file, or a file's
   name. *none: it holds nothing that can be pasted. */
static bool find_picture(Clip *clip, bool *none, WrError *err)
{
    char *bytes = NULL, *text;
    *none = false;
    const char *ending;
    size_t length;
    if (wr_clip_picture(&bytes, &length, &ending)) {
        bool good = take_bytes(clip, bytes, length, ending, err);
        wr_free(bytes);
        return good;
    }
    text = SDL_GetClipboardText();
    length = text ? strlen(text) : 0;
    char *path = text ? wr_svg_one_path(text) : NULL;
    bool good = true;
    if (path || (text && wr_svg_is_text(text))) good = take_drawing(clip, text, length, err);
    else *none = !text || !take_path(clip, text, length);
    wr_free(path);
    SDL_free(text);
    if (*none) return wr_fail(err, "the clipboard contains neither heights nor a picture");
    return good;
}

/* Position of the copy; NULL: it is no such copy. */
static const double *place_in(const char *path, double at[2])
{
    return find_place(path, at) ? at : NULL;
}

/* On a mask the picture is placed interactively like a generator; on heights it becomes a layer at once. */
static void paste_on_mask(WrApp *app, const char *path)
{
    double at[2];
    WrText line = { 0 };
    wr_text_add(&line, "picture paste ");
    wr_text_add_word(&line, path);
    wr_transform_add_place(app, place_in(path, at), &line);
    wr_generate_open(app, wr_generator_find("picture", "paste"));
    if (wr_generate_load(app, wr_text_get(&line))) wr_generate_changed(app);
    wr_text_fini(&line);
}

void wr_act_paste(WrApp *app)
{
    Clip clip = { .data = NULL };
    WrError err;
    const WrDocument *document = wr_app_document(app);
    double at[2];
    bool none, good = find_picture(&clip, &none, &err);
    const char *path = wr_text_get(&clip.path);
    if (good && (clip.data || wr_svg_named(path)))
        wr_app_add_drawing(app, clip.data ? NULL : path, clip.data, clip.name);
    else if (good && document->layers[document->active].on_mask) paste_on_mask(app, path);
    else good = good && wr_transform_paste(app, path, place_in(path, at), &err);
    if (none) wr_app_say_why(app, &err);
    else if (!good) wr_app_fail(app, &err);
    wr_text_fini(&clip.path);
    wr_free(clip.data);
}
