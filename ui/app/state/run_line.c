/* Command lines: the only way for the window to change a document. */
#include "ui/app/state/background_command_internal.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/action.h"
#include "ui/app/state/step_label.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/session_view.h"
#include "ui/app/jobs/edit_preview.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/session.h"
#include "document/document.h"
#include "system/clock.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

typedef struct Line {
    char *text, *words, *notes; /* owned; notes: notes of the preview that computed it, or NULL */
    WrDocument *made;           /* owned; NULL: still to be computed */
    double since;               /* clock */
} Line;

static void free_line(Line *line)
{
    wr_free(line->text);
    wr_free(line->words);
    wr_free(line->notes);
    wr_document_free(line->made);
    wr_free(line);
}

static bool run_line(WrSession *session, void *ctx, WrError *err)
{
    const Line *line = ctx;
    if (line->made) return wr_session_run_made(session, line->text, line->made, err);
    return wr_session_run(session, line->text, err);
}

/* Finish a line; ctx is freed. */
static void is_done(WrApp *app, void *ctx, bool ok, const WrError *err)
{
    Line *line = ctx;
    if (ok) wr_messages_overtake(app->messages, line->since);
    else wr_busy_fail(app, line->words, err);
    wr_app_try_end(app);
    wr_app_take_notes(app);
    if (ok && line->notes) wr_app_say_each_line(app, line->notes);
    wr_app_title(app);
    wr_app_redraw(app);
    free_line(line);
}

/* ---- during another command ---- */

/* True for lines that have the same meaning later while the layers are the same: layer settings, and painting at
   fixed positions. */
static bool can_wait(const char *line)
{
    static const char *const begin[] = { "layer use ", "layer set ", "layer solo ", "shape ",
                                         "ramp ",      "dab ",       "transform " };
    for (size_t i = 0; i < sizeof begin / sizeof *begin; i++)
        if (strncmp(line, begin[i], strlen(begin[i])) == 0) return true;
    return false;
}

static void run_late(WrApp *app, const char *line, bool dropped)
{
    if (!dropped) wr_app_run_line(app, line);
}

/* True for a line of the same user action as the running command: one of several lines that belong together. */
static bool belongs(const WrApp *app)
{
    return app->in_frame && app->busy->in_frame && app->busy->picture == app->drawn_at;
}

static bool put_off(WrApp *app, const char *line)
{
    const bool tended = !wr_busy_refuses(app);
    if (!tended && !(wr_busy_lets_wait(app) && (can_wait(line) || belongs(app)))) {
        wr_busy_refuse(app);
        return false;
    }
    WrText words = { 0 };
    wr_step_label(line, &words);
    wr_busy_put_off(app, wr_text_get(&words), run_late, line, !tended);
    wr_text_fini(&words);
    return true;
}

/* ---- running ---- */

/* notes, made: as in Line, or NULL. */
static bool run_command(WrApp *app, const char *text, const WrDocument *made, const char *notes)
{
    if (app->busy) return put_off(app, text);
    WrError err = { "" };
    WrText words = { 0 };
    wr_input_router_let_go(app);                       /* an open stroke would refuse the line */
    if (app->trying) wr_edit_preview_stop(app->trial); /* the preview is outdated */
    wr_step_label(text, &words);
    Line *line = wr_alloc(1, sizeof *line);
    *line = (Line){ .text = wr_strdup(text),
                    .words = wr_strdup(wr_text_get(&words)),
                    .notes = wr_strdup(notes),
                    .made = made ? wr_document_share(made) : NULL,
                    .since = wr_clock_seconds() };
    wr_text_fini(&words);
    app->gave_up = false;
    bool ok;
    if (app->drawn_at == 0.0) {
        ok = run_line(app->session, line, &err);
    } else {
        const WrBusy busy = {
            .kind = WR_BUSY_EDIT, .what = line->words, .work = run_line, .ctx = line
        };
        if (!wr_busy_begin(app, &busy)) {
            if (app->in_frame) { /* the frame continues, and the main loop finishes the line */
                app->busy->after = is_done;
                app->busy->after_ctx = line;
                return true;
            }
            wr_busy_wait(app);
        }
        ok = wr_busy_end(app, &err);
    }
    is_done(app, line, ok, &err);
    return ok;
}

bool wr_app_run_line(WrApp *app, const char *line)
{
    return run_command(app, line, NULL, NULL);
}

void wr_app_run_tried(WrApp *app, const char *line)
{
    const WrDocument *made = app->trying ? wr_edit_preview_made(app->trial) : NULL;
    if (made && wr_session_takes_made(line))
        run_command(app, line, made, wr_edit_preview_notes(app->trial));
    else wr_app_run_slow(app, line);
}

void wr_app_try_command(WrApp *app, WrEdit edit, const char *line)
{
    if (edit == WR_EDIT_LIVE) {
        wr_app_try(app, &(WrEditPreviewRequest){ .command = line });
    } else if (edit == WR_EDIT_DONE) {
        wr_app_try_end(app);
        wr_app_run_slow(app, line);
    }
}

bool wr_app_run_linef(WrApp *app, const char *format, ...)
{
    char line[256];
    va_list args;
    va_start(args, format);
    vsnprintf(line, sizeof line, format, args);
    va_end(args);
    return wr_app_run_line(app, line);
}

static void run_later(WrApp *app, const char *line)
{
    wr_app_run_line(app, line);
}

void wr_app_run_slow(WrApp *app, const char *line)
{
    if (app->in_frame) wr_deferred(app, run_later, line);
    else wr_app_run_line(app, line);
}

bool wr_app_line_waits(const WrApp *app)
{
    return wr_deferred_waits(app, run_later);
}
