/* Copy, cut and paste. A copy is a file that `picture paste` reads, so that the line in the history names it. */
#include "ui/app/actions.h"
#include "ui/canvas/view.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/line.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/session_view.h"
#include "ui/panels/generate/generate_state.h"
#include "ui/input/clip.h"

#include "base/array.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/command_line.h"
#include "document/document.h"
#include "document/recovery_journal.h"
#include "field/field.h"
#include "field/select.h"
#include "generate/generator.h"
#include "image/image.h"
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
    return wr_path_is_folder(path->data) || wr_fail(err, "%s: cannot be made", path->data);
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

/* Write the system clipboard's content to a file: a picture of another program, or use the path it contains. *none: it
   holds nothing that can be pasted. */
static bool find_picture(WrText *path, bool *none, WrError *err)
{
    char *bytes = NULL, *text;
    *none = false;
    const char *ending;
    size_t length;
    if (wr_clip_picture(&bytes, &length, &ending)) {
        bool good =
            new_path(path, "", ending, err) && wr_file_write(wr_text_get(path), bytes, length, err);
        wr_free(bytes);
        return good;
    }
    text = SDL_GetClipboardText();
    bool is_path = text && text[0] == '/' && !strchr(text, '\n') && wr_path_is_file(text);
    if (is_path) wr_text_add(path, text);
    SDL_free(text);
    *none = !is_path;
    return is_path || wr_fail(err, "the clipboard holds neither heights nor a picture");
}

/* Position of the copy; else the centre of the visible canvas. */
static void add_at(const WrApp *app, const char *path, WrText *line)
{
    double at[2];
    const WrCanvasView *v = app->view;
    if (!find_place(path, at)) {
        double x, y;
        wr_view_to_texel(v, v->x + v->w / 2.0, v->y + v->h / 2.0, &x, &y);
        at[0] = wr_line_round(x / v->table_w - floor(x / v->table_w), 6);
        at[1] = 1.0 - y / v->table_h;
        at[1] = wr_line_round(at[1] - floor(at[1]), 6);
    }
    wr_line_number(line, "at", at[0]);
    wr_text_add(line, ",");
    wr_text_add_number(line, at[1]);
}

/* Scale a picture down that is larger than the table. */
static bool add_size(const WrApp *app, const char *path, WrText *line, WrError *err)
{
    WrImageRows *rows = wr_image_rows_open(path, &(WrImageRequest){ 0 }, err);
    if (!rows) return false;
    const double w = wr_image_rows_head(rows)->width, h = wr_image_rows_head(rows)->height;
    const double by = fmin(app->view->table_w / w, app->view->table_h / h);
    if (by < 1.0) wr_line_number(line, "size", floor(w * by));
    wr_image_rows_close(rows);
    return true;
}

/* On a mask the picture is placed interactively like a generator; on heights it becomes a layer at once. */
static void paste_on_mask(WrApp *app, const char *path)
{
    WrText line = { 0 };
    wr_text_add(&line, "picture paste ");
    wr_text_add_word(&line, path);
    add_at(app, path, &line);
    wr_generate_open(app, wr_generator_find("picture", "paste"));
    if (wr_generate_load(app, wr_text_get(&line))) wr_generate_changed(app);
    wr_text_fini(&line);
}

static bool paste_layer(WrApp *app, const char *path, WrError *err)
{
    WrText line = { 0 };
    wr_text_add(&line, "layer paste ");
    wr_text_add_word(&line, path);
    add_at(app, path, &line);
    const bool good = add_size(app, path, &line, err);
    if (good && wr_app_run_line(app, wr_text_get(&line)))
        wr_app_say(app, "Pasted as a new layer; Free transform moves it");
    wr_text_fini(&line);
    return good;
}

void wr_act_paste(WrApp *app)
{
    WrText path = { 0 };
    WrError err;
    const WrDocument *document = wr_app_document(app);
    bool none, good = find_picture(&path, &none, &err);
    if (good && document->layers[document->active].on_mask) paste_on_mask(app, wr_text_get(&path));
    else good = good && paste_layer(app, wr_text_get(&path), &err);
    if (none) wr_app_say_why(app, &err);
    else if (!good) wr_app_fail(app, &err);
    wr_text_fini(&path);
}
