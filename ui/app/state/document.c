/* Document commands of the window: new, open, save, and the question before unsaved work is lost. All changes go
   through the session. */
#include "ui/app/state/document.h"
#include "ui/app/state/app_options.h"
#include "ui/app/state/background_command_internal.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/action.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/overwrite_question.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/settings.h"
#include "ui/app/jobs/files.h"

#include "base/array.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/enum_rows.h"
#include "base/text.h"
#include "command/command_line.h"
#include "command/session_internal.h"
#include "command/session.h"
#include "command/command_table.h"
#include "command/variants.h"
#include "field/field.h"
#include "image/mesh.h"
#include "system/locale.h"
#include "system/path.h"
#include "system/thread.h"

#include <stdlib.h>
#include <string.h>

#define START_SECONDS 0.05 /* shorter openings need no progress display at the start */

/* Starters and cells are begun anew, not gone on with: their folder must not be offered for saving. */
static bool is_shipped(const char *full)
{
    static const char *const folders[] = { "samples/starters", "samples/cells" };
    bool shipped = false;
    for (int i = 0; i < WR_LENGTH(folders); i++) {
        WrText place = { 0 };
        char *real = wr_data_find(folders[i], &place) ? wr_path_real(wr_text_get(&place)) : NULL;
        const size_t length = real ? strlen(real) : 0;
        shipped |= real && strncmp(full, real, length) == 0 && full[length] == '/';
        free(real);
        wr_text_fini(&place);
    }
    return shipped;
}

static void note_recent(WrApp *app, const char *path)
{
    char *full = wr_path_real(path);
    if (full && !is_shipped(full)) wr_settings_add_recent(app->settings, full);
    free(full);
}

/* ---- replacing the document ---- */

void wr_app_changed_document(WrApp *app)
{
    app->file->clean_revision = wr_session_saved_revision(app->session);
    wr_app_try_end(app);
    wr_free(app->file->picture);
    app->file->picture = NULL;
    for (const WrPart *const *p = app->registry->parts; *p; p++)
        if ((*p)->another) (*p)->another(app);
    wr_app_live_end(app);
    app->view_placed = false;
    app->settings->tiling = WR_TILING_STRAIGHT; /* the tiling was chosen for another pattern */
    app->hand->grab = WR_GRAB_NONE;
    wr_app_take_notes(app);
    wr_app_title(app);
    wr_app_redraw(app);
}

/* Work functions for wr_busy_run: ctx is a path, lines, or the opened file. */

static bool lines_work(WrSession *session, void *ctx, WrError *err)
{
    bool good = true;
    for (const char *at = ctx; *at && !wr_progress_stopped();) {
        size_t length = strcspn(at, "\n");
        char *line = wr_strndup(at, length);
        WrError why;
        if (!wr_session_run(session, line, good ? err : &why)) good = false;
        wr_free(line);
        at += length + (at[length] != '\0');
    }
    return good && (!wr_progress_stopped() || wr_fail(err, "cancelled"));
}

typedef struct Opened {
    const char *path;
    bool flat;    /* a picture: its heights are shown on a plane of its shape */
    bool refused; /* the lines for that failed; err is the reason */
    WrError why;
} Opened;

/* Set a plane with the picture's aspect ratio if a picture was opened, which has no surface of its own. */
static void lay_flat(WrSession *session, Opened *opened)
{
    char ending[16];
    opened->flat = !wr_session_path(session)[0] &&
                   strcmp(wr_path_ending(opened->path, ending), "wrinkle") != 0 &&
                   !wr_mesh_named(opened->path);
    if (!opened->flat) return;
    WrText lines = { 0 };
    const WrField *field = wr_document_field(wr_session_document(session));
    wr_new_picture_lines(wr_field_width(field), wr_field_height(field), &lines);
    opened->refused = !lines_work(session, lines.data, &opened->why);
    wr_text_fini(&lines);
}

/* The document of the command line while it is being opened. */
typedef struct Asked {
    const WrAppOptions *options;
    Opened opened; /* of options->file */
} Asked;

static bool open_work(WrSession *session, void *ctx, WrError *err)
{
    Opened *opened = ctx;
    if (!wr_session_open(session, opened->path, err)) return false;
    lay_flat(session, opened);
    return true;
}

static bool save_work(WrSession *session, void *ctx, WrError *err)
{
    return wr_session_save(session, ctx, err);
}

static bool tend_work(WrSession *session, void *ctx, WrError *err)
{
    (void)ctx;
    (void)err;
    wr_session_journal_compact(session);
    return true;
}

void wr_app_compact_journal(WrApp *app)
{
    bool idle = app->hand->grab == WR_GRAB_NONE && !wr_session_in_stroke(app->session);
    if (idle && wr_session_journal_needs_compacting(app->session))
        wr_background_upkeep_start(app, "Keeping the journal short", tend_work, NULL);
}

/* Name the document after the picture. */
static void take_picture(WrApp *app, const Opened *opened)
{
    if (!opened->flat) return;
    if (opened->refused) wr_app_fail(app, &opened->why);
    app->file->picture = wr_strdup(opened->path);
    /* unmodified: it can be opened again */
    app->file->clean_revision = wr_session_revision(app->session);
    wr_app_title(app);
}

static bool open_now(WrApp *app, const char *path)
{
    WrError err;
    Opened opened = { .path = path };
    wr_input_router_let_go(app);
    app->file->opening = path;
    const bool good = wr_busy_run(app, WR_BUSY_ANOTHER, "Opening", open_work, &opened, &err);
    app->file->opening = NULL;
    if (!good) {
        wr_busy_fail(app, "opening", &err);
        return false;
    }
    app->file->starter = false;
    note_recent(app, path);
    wr_app_changed_document(app);
    take_picture(app, &opened);
    return true;
}

/* Fallback starter document if the samples are missing. */
static void make_starter(WrApp *app)
{
    static const char *const lines[] = { "grid cells=4x8 width=10 low=0.7 high=0", "surface sphere",
                                         "replicate 4,2", "bump height=0.05" };
    WrError err;
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++)
        if (!wr_session_run(app->session, lines[i], &err)) wr_app_fail(app, &err);
    app->file->clean_revision = wr_session_revision(app->session);
}

/* The starter document being loaded. */
typedef struct WrAhead {
    WrThread thread;
    bool threaded; /* the thread was started */
    WrSession *session;
    WrText path;
    bool good;
    WrError err; /* reason of a failure */
} WrAhead;

static void *open_starter(void *ctx)
{
    WrAhead *ahead = ctx;
    wr_locale_keep_plain(); /* libraries of the window set the user's locale meanwhile */
    ahead->good = wr_session_open(ahead->session, wr_text_get(&ahead->path), &ahead->err);
    return NULL;
}

void wr_app_start_ahead(WrApp *app)
{
    WrText path = { 0 };
    app->file->clean_revision = wr_session_saved_revision(app->session);
    if (app->options->file_given || !wr_data_find("samples/starters/bricks.wrinkle", &path)) {
        wr_text_fini(&path);
        return;
    }
    WrAhead *ahead = wr_alloc(1, sizeof *ahead);
    ahead->session = app->session;
    ahead->path = path;
    app->file->ahead = ahead;
    ahead->threaded = wr_thread_begin(&ahead->thread, open_starter, ahead);
}

void wr_app_start_join(WrApp *app)
{
    WrAhead *ahead = app->file->ahead;
    if (!ahead) return;
    if (ahead->threaded) wr_thread_join(ahead->thread);
    wr_text_fini(&ahead->path);
    wr_free(ahead);
    app->file->ahead = NULL;
}

static bool take_starter(WrApp *app, WrError *err)
{
    WrAhead *ahead = app->file->ahead;
    if (!ahead)
        return wr_fail(err, "the samples and brushes of the program were not found: set "
                            "WRINKLE_DATA to the folder that holds samples and brushes, or "
                            "install it");
    if (ahead->threaded) wr_thread_join(ahead->thread);
    else ahead->good = wr_session_open(ahead->session, wr_text_get(&ahead->path), &ahead->err);
    ahead->threaded = false;
    const bool good = ahead->good;
    if (!good) *err = ahead->err;
    wr_app_start_join(app);
    return good;
}

/* ---- document of the command line ---- */

static bool open_asked(WrSession *session, void *ctx, WrError *err)
{
    Asked *asked = ctx;
    const WrAppOptions *o = asked->options;
    if (!o->open(session, o->open_ctx, err)) return false;
    if (o->file) lay_flat(session, &asked->opened);
    return true;
}

/* Finish the opening; frees `asked`. */
static void asked_is_open(WrApp *app, Asked *asked)
{
    if (wr_session_path(app->session)[0]) note_recent(app, wr_session_path(app->session));
    wr_app_changed_document(app);
    if (app->options->file) take_picture(app, &asked->opened);
    wr_app_take_notes(app);
    wr_free(asked);
}

static void asked_is_done(WrApp *app, void *ctx, bool ok, const WrError *err)
{
    app->file->opening = NULL;
    if (ok) {
        asked_is_open(app, ctx);
        return;
    }
    wr_busy_fail(app, "opening", err);
    app->file->unread = true;
    wr_app_changed_document(app); /* some of the lines may have run */
    wr_free(ctx);
}

/* A document that opens within a moment is in the first frame, and its error ends the program. A slower one opens on
   a worker thread. */
static bool start_asked(WrApp *app, WrError *err)
{
    Asked *asked = wr_alloc(1, sizeof *asked);
    *asked = (Asked){ .options = app->options, .opened = { .path = app->options->file } };
    const WrBusy busy = { .kind = WR_BUSY_ANOTHER,
                          .what = (char *)"Opening",
                          .work = open_asked,
                          .ctx = asked,
                          .quiet = START_SECONDS };
    if (!wr_busy_begin(app, &busy)) {
        app->busy->after = asked_is_done;
        app->busy->after_ctx = asked;
        app->file->opening = app->options->file;
        return true;
    }
    const bool good = wr_busy_end(app, err);
    if (good) asked_is_open(app, asked);
    else wr_free(asked);
    return good;
}

bool wr_app_start(WrApp *app, WrError *err)
{
    app->hints = true;
    if (app->options->open) return start_asked(app, err);
    if (app->options->file_given) {
        if (wr_session_path(app->session)[0]) note_recent(app, wr_session_path(app->session));
        wr_app_take_notes(app);
        return true;
    }
    app->file->starter = take_starter(app, err);
    if (!app->file->starter) {
        wr_app_fail(app, err);
        make_starter(app);
    }
    wr_app_take_notes(app);
    return true;
}

/* ---- question about unsaved work ---- */

static bool new_work(WrSession *session, void *ctx, WrError *err)
{
    wr_session_reset(session);
    return lines_work(session, ctx, err);
}

/* After a failing line the rest still runs, so that a usable document results. */
void wr_app_new_of(WrApp *app, const char *lines)
{
    WrError err;
    wr_input_router_let_go(app);
    bool good =
        wr_busy_run(app, WR_BUSY_ANOTHER, "Making the document", new_work, (char *)lines, &err);
    if (!good && app->busy) { /* refused: the document is unchanged */
        wr_app_fail(app, &err);
        return;
    }
    app->file->starter = false;
    if (app->gave_up) wr_app_say(app, "Cancelled: the document contains the steps done so far");
    else if (!good) wr_app_fail(app, &err);
    wr_app_changed_document(app);
    /* unmodified: it can be opened again */
    app->file->clean_revision = wr_session_revision(app->session);
    wr_app_title(app);
}

static void go_on(WrApp *app, const char *text)
{
    (void)text;
    wr_app_go_on(app);
}

void wr_app_go_on(WrApp *app)
{
    if (app->in_frame) { /* may take long */
        wr_deferred(app, go_on, "");
        return;
    }
    WrAfter after = app->file->after;
    char *path = app->file->after_path;
    app->file->after = WR_AFTER_NOTHING;
    app->file->after_path = NULL;
    switch (after) {
    case WR_AFTER_NOTHING: break;
    case WR_AFTER_NEW: wr_dialog_open(app, WR_DIALOG_NEW); break;
    case WR_AFTER_OPEN:
        if (!wr_files_request_path(app->files, WR_FILE_OPEN, NULL, ""))
            wr_dialog_open(app, WR_DIALOG_FILE);
        break;
    case WR_AFTER_PATH: open_now(app, path); break;
    case WR_AFTER_LINES: wr_app_new_of(app, path); break;
    case WR_AFTER_QUIT: app->quit = true; break;
    }
    wr_free(path);
}

static void ask_first(WrApp *app, WrAfter after, const char *path)
{
    if (after == WR_AFTER_QUIT ? wr_busy_refuses(app) && wr_busy_close(app) : wr_busy_refuse(app))
        return;
    wr_busy_settle(app);
    wr_input_router_let_go(app);
    app->file->after = after;
    wr_free(app->file->after_path);
    app->file->after_path = path ? wr_strdup(path) : NULL;
    if (wr_app_unsaved(app)) wr_dialog_open(app, WR_DIALOG_UNSAVED);
    else wr_app_go_on(app);
}

void wr_app_new_document(WrApp *app)
{
    ask_first(app, WR_AFTER_NEW, NULL);
}

void wr_app_open(WrApp *app)
{
    ask_first(app, WR_AFTER_OPEN, NULL);
}

void wr_app_open_path(WrApp *app, const char *path)
{
    ask_first(app, WR_AFTER_PATH, path);
}

void wr_app_add_lines(WrApp *app, const char *lines)
{
    WrError err;
    char *copy = wr_strdup(lines);
    if (!wr_busy_run(app, WR_BUSY_EDIT, "Adding layers", lines_work, copy, &err))
        wr_busy_fail(app, "adding layers", &err);
    wr_free(copy);
    wr_app_take_notes(app);
    wr_app_title(app);
    wr_app_redraw(app);
}

void wr_app_open_lines(WrApp *app, const char *lines)
{
    ask_first(app, WR_AFTER_LINES, lines);
}

void wr_app_quit(WrApp *app)
{
    ask_first(app, WR_AFTER_QUIT, NULL);
}

/* ---- saving ---- */

static bool save_to(WrApp *app, const char *path)
{
    WrError err;
    wr_busy_settle(app);
    wr_app_settle(app);
    bool ok = wr_busy_run(app, WR_BUSY_EDIT, "Saving", save_work, (char *)path, &err);
    if (!ok) {
        wr_busy_fail(app, "saving", &err);
        app->file->after = WR_AFTER_NOTHING; /* no work may be lost when a disk is full */
        return false;
    }
    app->file->starter = false;
    /* the old revision is not in this file */
    app->file->clean_revision = wr_session_saved_revision(app->session);
    note_recent(app, path);
    wr_app_take_notes(app);
    wr_app_say(app, "Saved %s", path);
    wr_app_title(app);
    wr_app_go_on(app);
    return true;
}

bool wr_app_save(WrApp *app)
{
    const char *path = wr_session_path(app->session);
    if (path[0] && wr_session_file_changed(app->session) &&
        wr_replace_confirm(app, WR_REPLACE_CHANGED, WR_FILE_SAVE, path))
        return false;
    if (path[0]) {
        char *copy = wr_strdup(path); /* saving may replace the string */
        bool ok = save_to(app, copy);
        wr_free(copy);
        return ok;
    }
    wr_app_save_as(app);
    return false;
}

/* The folder of the document, or NULL. The caller frees it. */
static char *folder_of(const WrApp *app)
{
    const char *path = wr_session_path(app->session);
    return path[0] ? wr_path_folder(path) : NULL;
}

static void ask_file(WrApp *app, WrFilePurpose purpose, const char *name)
{
    char *folder = folder_of(app);
    if (!wr_files_request_path(app->files, purpose, folder, name))
        wr_dialog_open(app, WR_DIALOG_FILE);
    wr_free(folder);
}

void wr_app_save_as(WrApp *app)
{
    wr_input_router_let_go(app);
    ask_file(app, WR_FILE_SAVE,
             wr_session_path(app->session)[0] ? wr_app_name(app) : "untitled.exr");
}

void wr_app_save_history(WrApp *app)
{
    wr_input_router_let_go(app);
    ask_file(app, WR_FILE_HISTORY, "history.wrinkle");
}

static bool history_work(WrSession *session, void *ctx, WrError *err)
{
    return wr_session_save_history(session, ctx, err);
}

void wr_file_take_history(WrApp *app, const char *path)
{
    WrError err;
    if (!wr_busy_run(app, WR_BUSY_EDIT, "Saving the steps", history_work, (char *)path, &err))
        wr_busy_fail(app, "saving the steps", &err);
    else wr_app_say(app, "Saved %d steps as %s", wr_session_history_position(app->session), path);
}

void wr_file_take_import(WrApp *app, const char *path)
{
    WrText line = { 0 };
    wr_text_add(&line, "image ");
    wr_text_add_word(&line, path);
    if (app->forms->fit) wr_text_add(&line, " fit=table");
    wr_app_run_slow(app, wr_text_get(&line));
    app->view_placed = false;
    wr_text_fini(&line);
}

void wr_app_file_chosen(WrApp *app, WrFilePurpose purpose, const char *path)
{
    /* the desktop's dialog gets the name as it is, not for those that <VARIANT> stands for */
    const bool agreed = wr_files_agreed(app->files) && !wr_variant_is_pattern(path);
    bool asks = wr_file_purpose_writes(purpose) && !agreed &&
                wr_replace_confirm(app, WR_REPLACE_CHOSEN, purpose, path);
    if (!asks) wr_deferred(app, app->registry->takes[purpose], path); /* may take long */
}

void wr_file_take_open(WrApp *app, const char *path)
{
    open_now(app, path);
}

void wr_file_take_save(WrApp *app, const char *path)
{
    save_to(app, path);
}

static void run_on_file(WrApp *app, const char *verb, const char *path, const char *rest)
{
    WrText line = { 0 };
    wr_text_add(&line, verb);
    wr_text_add_word(&line, path);
    wr_text_add(&line, rest);
    wr_app_run_slow(app, wr_text_get(&line));
    wr_text_fini(&line);
}

static void choose(WrApp *app, WrFilePurpose purpose)
{
    if (!wr_files_request_path(app->files, purpose, NULL, "")) wr_dialog_open(app, WR_DIALOG_FILE);
}

void wr_file_take_gltf(WrApp *app, const char *path)
{
    run_on_file(app, "gltf ", path, "");
}

void wr_app_choose_gltf(WrApp *app)
{
    choose(app, WR_FILE_GLTF);
}

void wr_app_choose_mesh(WrApp *app)
{
    choose(app, WR_FILE_MESH);
}

bool wr_app_can_bake(const WrApp *app)
{
    const WrScene *scene = wr_app_scene(app);
    return scene->shape.kind == WR_SURFACE_mesh && scene->triangles;
}
