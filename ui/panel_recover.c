/* SPDX-License-Identifier: MIT
   What a program that crashed left behind: take it back, give it up, or leave it for later. */
#include "ui/state.h"

#include "base/memory.h"
#include "command/recovery.h"

#include <string.h>
#include <time.h>

struct WrRecovery {
    WrRecoverable *list; /* owned */
    int count, chosen;
    bool sure; /* Discard was pressed once */
};

void wr_recovery_free(WrRecovery *recovery)
{
    if (!recovery) return;
    wr_recovery_list_free(recovery->list, recovery->count);
    wr_free(recovery);
}

static void forget(WrApp *app)
{
    wr_recovery_free(app->recovery);
    app->recovery = NULL;
}

void wr_dialog_recover_open(WrApp *app)
{
    WrError err;
    WrRecovery *recovery = wr_alloc(1, sizeof *recovery);
    forget(app);
    if (!wr_recovery_list(&recovery->list, &recovery->count, &err)) {
        wr_app_fail(app, &err);
        wr_free(recovery);
    } else if (recovery->count == 0) {
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
    if (localtime_r(&t, &parts)) strftime(when, sizeof when, "%e %B %Y, %H:%M", &parts);
    snprintf(name, name_size, "%.120s",
             r->document[0] == '\0' ? "never saved"
             : slash                ? slash + 1
                                    : r->document);
    snprintf(what, size, "%s   \xc2\xb7   %d step%s%s", when, r->commands,
             r->commands == 1 ? "" : "s", r->damaged ? "   \xc2\xb7   its end is damaged" : "");
}

typedef struct Call {
    WrSession *session;
    const char *journal;
    WrText report;
} Call;

static bool recover_work(void *ctx, WrError *err)
{
    Call *call = ctx;
    return wr_session_recover(call->session, call->journal, &call->report, err);
}

static void say_lines(WrApp *app, const char *text)
{
    for (const char *at = text; *at;) {
        size_t length = strcspn(at, "\n");
        if (length > 0) wr_app_say(app, "%.*s", (int)(length < 400 ? length : 400), at);
        at += length + (at[length] == '\n');
    }
}

void wr_recover(WrApp *app, const char *journal)
{
    WrError err;
    Call call = { .session = app->session, .journal = journal };
    if (wr_busy_run(app, "Recovering", recover_work, &call, &err)) {
        app->starter = false;
        wr_app_changed_document(app);
        say_lines(app, wr_text_get(&call.report));
    } else {
        wr_app_fail(app, &err);
    }
    wr_text_fini(&call.report);
}

static void rows(WrRecovery *recovery)
{
    double tall = recovery->count < 5 ? recovery->count : 5;
    wr_gui_list_begin("recoverable", wr_gui_px(tall * 46) + wr_gui_px(4));
    wr_gui_space(-6);
    for (int i = 0; i < recovery->count; i++) {
        char name[128], what[128];
        describe(&recovery->list[i], name, sizeof name, what, sizeof what);
        WrRow r = wr_gui_row_begin(i, 46, i == recovery->chosen);
        wr_gui_tip(recovery->list[i].document);
        double x = wr_gui_px(12), line = wr_gui_line_height(WR_FONT_TEXT);
        wr_gui_row_at(x, 2.4 * line);
        wr_gui_text_cut(WR_FONT_TEXT, WR_COLOUR_STRONG, name, wr_gui_row_width() - 2 * x);
        wr_gui_row_at(x, 0.2 * line);
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
    if (!app->recovery->sure) { /* what is given up cannot be brought back: ask again */
        app->recovery->sure = true;
        return;
    }
    if (!wr_recovery_discard(app->recovery->list[app->recovery->chosen].journal, &err))
        wr_app_fail(app, &err);
    wr_dialog_close(app);
    wr_dialog_recover_open(app); /* if there are others */
}

void wr_dialog_recover(WrApp *app)
{
    WrRecovery *recovery = app->recovery;
    if (!recovery) {
        wr_dialog_close(app);
        return;
    }
    if (!wr_gui_dialog_begin("Work that was not saved", 500)) return;
    bool key = !app->dialog_fresh;
    wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_TEXT,
                        "Wrinkle ended before this was saved. It can be brought back.");
    rows(recovery);
    if (recovery->list[recovery->chosen].unfinished)
        wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL,
                            "Its last command had not ended. It is tried apart first.");
    wr_gui_space(8);
    bool now = wr_gui_button("Recover", true) || (key && wr_gui_return_pressed());
    wr_gui_same_line(8);
    bool lose = wr_gui_button(recovery->sure ? "Discard for good" : "Discard", false);
    wr_gui_same_line(8);
    bool later = wr_gui_button("Later", false) || (key && wr_gui_escape_pressed());
    wr_gui_tip("It is offered again the next time");
    if (now) {
        wr_later_recover(app, recovery->list[recovery->chosen].journal);
        wr_dialog_close(app);
    } else if (lose) {
        discard(app);
    } else if (later) {
        wr_dialog_close(app);
    }
    wr_gui_dialog_end();
    if (app->dialog != WR_DIALOG_RECOVER) forget(app);
}
