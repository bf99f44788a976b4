/* Copy, cut and paste: what is copied is a file that `picture paste` reads, so that a line of the history says which. */
#include "ui/app/actions.h"
#include "ui/canvas/view.h"
#include "ui/desk/busy.h"
#include "ui/desk/desk.h"
#include "ui/desk/line.h"
#include "ui/desk/messages.h"
#include "ui/generate/generate_hand.h"
#include "ui/pen/clip.h"

#include "base/array.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/call.h"
#include "document/journal.h"
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

#define KEPT 20 /* copies, whose lines in histories can be run again */

/* "STATE/clipboard", beside the journals; made if it is missing. */
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

/* The names tell the time: the oldest go. */
static void forget_old(const char *path)
{
    Names names = { 0 };
    WrFolder *folder = wr_folder_open(path);
    for (const char *name; folder && (name = wr_folder_next(folder));)
        if (strncmp(name, "copy-", 5) == 0) wr_array_push(&names, wr_strdup(name));
    wr_folder_close(folder);
    qsort(names.data, (size_t)names.count, sizeof *names.data, by_name);
    for (int i = 0; i < names.count; i++) {
        char *old = wr_path_join(path, names.data[i]);
        if (i < names.count - KEPT) wr_path_remove(old);
        wr_free(old);
        wr_free(names.data[i]);
    }
    wr_array_free(&names);
}

/* A path for a new copy, with that ending. */
static bool new_path(WrText *path, const char *ending, WrError *err)
{
    struct tm date;
    char name[80];
    if (!clip_folder(path, err)) return false;
    forget_old(wr_text_get(path));
    wr_clock_universal((int64_t)time(NULL), &date);
    strftime(name, sizeof name, "/copy-%Y%m%d-%H%M%S", &date);
    wr_text_addf(path, "%s-%06d.%s", name,
                 (int)(1e6 * (wr_clock_seconds() - floor(wr_clock_seconds()))), ending);
    return true;
}

/* ---- copy, cut ---- */

static bool copy(WrApp *app, const char *of)
{
    WrText path = { 0 }, line = { 0 };
    WrError err;
    bool good = new_path(&path, "exr", &err);
    if (!good) wr_app_fail(app, &err);
    wr_text_add(&line, "copy ");
    wr_text_add_word(&line, wr_text_get(&path));
    if (of) wr_text_addf(&line, " of=%s", of);
    good = good && wr_app_run_line(app, wr_text_get(&line));
    if (good) SDL_SetClipboardText(wr_text_get(&path)); /* other windows of ours find it by that */
    if (good) wr_app_say(app, "Copied");
    wr_text_fini(&path);
    wr_text_fini(&line);
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

static bool save_bytes(const char *path, const char *bytes, size_t length, WrError *err)
{
    WrFileTarget target;
    if (!wr_file_begin(&target, path, err)) return false;
    if (!wr_file_put(&target, bytes, length, err)) {
        wr_file_abort(&target);
        return false;
    }
    return wr_file_commit(&target, err);
}

/* What the system's clipboard holds, as a file: a picture of another program, or the path of one. */
static bool find_picture(WrText *path, WrError *err)
{
    char *bytes = NULL, *text;
    const char *ending;
    size_t length;
    if (wr_clip_picture(&bytes, &length, &ending)) {
        bool good =
            new_path(path, ending, err) && save_bytes(wr_text_get(path), bytes, length, err);
        wr_free(bytes);
        return good;
    }
    text = SDL_GetClipboardText();
    bool is_path = text && text[0] == '/' && !strchr(text, '\n') && wr_path_is_file(text);
    if (is_path) wr_text_add(path, text);
    SDL_free(text);
    return is_path || wr_fail(err, "the clipboard holds neither heights nor a picture");
}

/* Where it was copied from is not known any more; it comes to the middle of what is seen. */
void wr_act_paste(WrApp *app)
{
    WrText path = { 0 }, line = { 0 };
    WrError err;
    double x, y;
    const WrCanvasView *v = app->view;
    if (!find_picture(&path, &err)) {
        wr_app_fail(app, &err);
        wr_text_fini(&path);
        return;
    }
    wr_view_to_texel(v, v->x + v->w / 2.0, v->y + v->h / 2.0, &x, &y);
    double at_u = x / v->table_w, at_v = 1.0 - y / v->table_h;
    wr_text_add(&line, "picture paste ");
    wr_text_add_word(&line, wr_text_get(&path));
    WrImageRows *rows = wr_image_rows_open(wr_text_get(&path), &(WrImageWish){ 0 }, &err);
    if (rows) wr_line_number(&line, "size", wr_image_rows_head(rows)->width);
    wr_image_rows_close(rows);
    wr_line_number(&line, "at", wr_line_round(at_u - floor(at_u), 6));
    wr_text_add(&line, ",");
    wr_text_add_number(&line, wr_line_round(at_v - floor(at_v), 6));
    wr_generate_open(app, wr_generator_find("picture", "paste"));
    if (wr_generate_load(app, wr_text_get(&line))) wr_generate_changed(app);
    wr_text_fini(&path);
    wr_text_fini(&line);
}
