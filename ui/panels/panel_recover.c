/* Crash recovery dialog: recover, discard, or keep for later. */
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/document.h"
#include "ui/app/state/action.h"
#include "ui/app/state/messages.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/panels/panels.h"

#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/session_internal.h"
#include "command/recovery.h"
#include "system/clock.h"

#include <stdio.h>
#include <string.h>
#include <time.h>

struct WrRecovery {
    WrRecoverable *list; /* owned */
    int count, chosen;
    bool sure;            /* Discard was pressed once */
    char *partial_report; /* report of a partial recovery of the chosen journal; owned; else NULL */
    bool more;            /* continuing past the damage might recover more */
};

void wr_recovery_free(WrRecovery *recovery)
{
    if (!recovery) return;
    wr_recovery_list_free(recovery->list, recovery->count);
    wr_free(recovery->partial_report);
    wr_free(recovery);
}

static void forget(WrApp *app)
{
    wr_recovery_free(app->recovery);
    app->recovery = NULL;
}

/* True if some journal is readable. The others are shown beside it; `wrinkle recover` lists all. */
static bool any_good(const WrRecovery *recovery)
{
    for (int i = 0; i < recovery->count; i++)
        if (!recovery->list[i].error) return true;
    return false;
}

void wr_dialog_recover_open(WrApp *app)
{
    WrError err;
    WrRecovery *recovery = wr_alloc(1, sizeof *recovery);
    forget(app);
    if (!wr_recovery_list(&recovery->list, &recovery->count, &err)) {
        wr_app_fail(app, &err);
        wr_free(recovery);
    } else if (!any_good(recovery)) {
        wr_recovery_free(recovery);
    } else {
        app->recovery = recovery;
        wr_dialog_open(app, WR_DIALOG_RECOVER);
    }
}

static void describe(const WrRecoverable *r, char *name, size_t name_size, char *what, size_t size)
{
    char when[48] = "";
    struct tm parts;
    time_t t = (time_t)r->written;
    const char *slash = strrchr(r->document, '/');
    if (wr_clock_local(t, &parts)) strftime(when, sizeof when, "%Y-%m-%d %H:%M", &parts);
    snprintf(name, name_size, "%.120s",
             r->document[0] == '\0' ? wr_words("never saved")
             : slash                ? slash + 1
                                    : r->document);
    if (r->error)
        snprintf(what, size, wr_words("%s   \xc2\xb7   cannot be read: %.160s"), when, r->error);
    else
        snprintf(what, size,
                 r->commands == 1 ? wr_words("%s   \xc2\xb7   %d step%s")
                                  : wr_words("%s   \xc2\xb7   %d steps%s"),
                 when, r->commands, r->damaged ? wr_words("   \xc2\xb7   damaged") : "");
}

typedef struct Call {
    const char *journal;
    bool beyond;
    WrRecovered recovered;
} Call;

static bool recover_work(WrSession *session, void *ctx, WrError *err)
{
    Call *call = ctx;
    return wr_session_recover(session, call->journal, call->beyond, &call->recovered, err);
}

/* The report in the window's language, a sentence for each line; owned by the caller. */
static char *translated(const WrText *messages)
{
    WrText text = { 0 };
    char *copy = wr_strdup(wr_text_get(messages)), said[WR_WORDS_MESSAGE];
    for (char *at = copy, *next; at; at = next) {
        next = strchr(at, '\n');
        if (next) *next++ = '\0';
        wr_text_addf(&text, "%s%s", text.length > 0 ? "\n" : "",
                     wr_words_message(at, said, sizeof said));
    }
    wr_free(copy);
    char *result = wr_strdup(wr_text_get(&text));
    wr_text_fini(&text);
    return result;
}

/* Ask about the rest of a partly recovered journal. */
static void ask_about_rest(WrApp *app, const Call *call)
{
    wr_dialog_recover_open(app);
    WrRecovery *recovery = app->recovery;
    for (int i = 0; recovery && i < recovery->count; i++) {
        if (strcmp(recovery->list[i].journal, call->journal) != 0) continue;
        recovery->chosen = i;
        recovery->partial_report = translated(&call->recovered.messages);
        recovery->more = call->recovered.more;
    }
}

static void recover(WrApp *app, const char *journal, bool beyond)
{
    WrError err;
    Call call = { .journal = journal, .beyond = beyond };
    if (wr_busy_run(app, WR_BUSY_ANOTHER, "Recovering", recover_work, &call, &err)) {
        app->file->starter = false;
        wr_app_changed_document(app);
        char *report = translated(&call.recovered.messages);
        wr_app_say_each_line(app, report);
        wr_free(report);
        if (!call.recovered.removed) ask_about_rest(app, &call);
    } else {
        wr_busy_fail(app, "recovering", &err);
    }
    wr_recovered_fini(&call.recovered);
}

static void recover_upto(WrApp *app, const char *journal)
{
    recover(app, journal, false);
}

static void recover_beyond(WrApp *app, const char *journal)
{
    recover(app, journal, true);
}

static void rows(WrRecovery *recovery)
{
    double tall = recovery->count < 5 ? recovery->count : 5;
    wr_gui_list_begin("recoverable", wr_gui_px(tall * 46) + wr_gui_px(4));
    wr_gui_space(-6);
    for (int i = 0; i < recovery->count; i++) {
        char name[128], what[256];
        describe(&recovery->list[i], name, sizeof name, what, sizeof what);
        WrRow r = wr_gui_row_begin(i, 46, i == recovery->chosen);
        wr_gui_as_it_is(true);
        wr_gui_tip(recovery->list[i].document);
        wr_gui_as_it_is(false);
        double x = wr_gui_px(12), line = wr_gui_line_height(WR_FONT_TEXT);
        wr_gui_row_set_cursor(x, 2.4 * line);
        wr_gui_as_it_is(true);
        wr_gui_text_cut(WR_FONT_TEXT, WR_COLOUR_STRONG, name, wr_gui_row_width() - 2 * x);
        wr_gui_as_it_is(false);
        wr_gui_row_set_cursor(x, 0.2 * line);
        wr_gui_text_cut(WR_FONT_SMALL, WR_COLOUR_LABEL, what, wr_gui_row_width() - 2 * x);
        wr_gui_row_end();
        if (r.clicked) {
            recovery->chosen = i;
            recovery->sure = false;
        }
    }
    wr_gui_list_end();
}

static void discard(WrApp *app)
{
    WrError err;
    if (!app->recovery->sure) { /* discarding is final: ask again */
        app->recovery->sure = true;
        return;
    }
    if (!wr_recovery_discard(app->recovery->list[app->recovery->chosen].journal, &err))
        wr_app_fail(app, &err);
    wr_dialog_close(app);
    wr_dialog_recover_open(app); /* if there are others */
}

/* Show the chosen journal, or the result of its recovery. */
static void tell(const WrRecovery *recovery)
{
    const WrRecoverable *r = &recovery->list[recovery->chosen];
    if (recovery->partial_report) {
        wr_gui_as_it_is(true); /* already translated */
        wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_TEXT, recovery->partial_report);
        wr_gui_as_it_is(false);
        wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL,
                            "The rest is kept until it is discarded.");
        return;
    }
    rows((WrRecovery *)recovery);
    char text[200];
    if (r->error)
        snprintf(text, sizeof text, wr_words("It cannot be read; a newer program may be able to."));
    else if (r->headless)
        snprintf(text, sizeof text,
                 wr_words("Its beginning is damaged: the first document is a guess."));
    else if (r->beyond > 0)
        snprintf(text, sizeof text,
                 r->beyond == 1
                     ? wr_words("It is damaged after step %d; %d step behind that can be read.")
                     : wr_words("It is damaged after step %d; %d steps behind that can be read."),
                 r->commands, r->beyond);
    else
        snprintf(
            text, sizeof text, "%s",
            r->unfinished
                ? wr_words(
                      "Its last command had not ended. It is tried in a separate process first.")
                : "");
    if (*text) wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL, text);
}

/* Buttons for the recovery. */
static void recover_buttons(WrApp *app, bool key)
{
    const WrRecovery *recovery = app->recovery;
    const WrRecoverable *r = &recovery->list[recovery->chosen];
    bool parts = r->headless || r->beyond > 0;
    bool now = false, beyond = false;
    if (!r->error && !recovery->partial_report && !r->headless) {
        now = wr_gui_button(parts ? "Up to the damage" : "Recover", true) ||
              (key && wr_gui_return_pressed());
        wr_gui_same_line(8);
    }
    if (!r->error && (recovery->partial_report ? recovery->more : parts)) {
        beyond =
            wr_gui_button("With the lines that follow", r->headless && !recovery->partial_report);
        wr_gui_tip("Steps that need missing parts are left out");
        wr_gui_same_line(8);
    }
    if (!now && !beyond) return;
    wr_deferred(app, beyond ? recover_beyond : recover_upto, r->journal);
    wr_dialog_close(app);
}

void wr_dialog_recover(WrApp *app)
{
    WrRecovery *recovery = app->recovery;
    if (!recovery) {
        wr_dialog_close(app);
        return;
    }
    const char *partial_report = recovery->partial_report;
    if (!wr_gui_dialog_begin(
            partial_report ? "Not everything was recovered" : "Work that was not saved", 500))
        return;
    bool key = !app->dialog->fresh;
    if (!partial_report)
        wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_TEXT,
                            "Wrinkle ended before this was saved. It can be recovered.");
    tell(recovery);
    wr_gui_space(8);
    wr_busy_hold(app); /* the document of the command line may still be opening */
    recover_buttons(app, key && !wr_busy_refuses(app));
    wr_busy_hold_end();
    bool lose = wr_gui_button(recovery->sure   ? "Discard for good"
                              : partial_report ? "Discard the rest"
                                               : "Discard",
                              false);
    wr_gui_same_line(8);
    bool later = wr_gui_button(partial_report ? "Keep it" : "Later", partial_report) ||
                 (key && (wr_gui_escape_pressed() || (partial_report && wr_gui_return_pressed())));
    wr_gui_tip("Keeps it; it is offered again at the next start");
    if (app->dialog->now != WR_DIALOG_RECOVER) lose = later = false;
    if (lose) discard(app);
    else if (later) wr_dialog_close(app);
    wr_gui_dialog_end();
    if (app->dialog->now != WR_DIALOG_RECOVER) forget(app);
}
