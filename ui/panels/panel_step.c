/* Dialogs of the history: other values of a step, and the values of a macro. */
#include "ui/app/jobs/edit_preview.h"
#include "ui/app/jobs/files.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/line.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/step_label.h"
#include "ui/panels/call_rows.h"
#include "ui/panels/panel_history.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"

#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/command_line.h"
#include "command/session.h"

#include <stdio.h>
#include <string.h>

#define MACRO_BYTES ((size_t)1 << 20) /* of a macro with a dialog */
#define MACRO_LINES 200

static void forget_call(WrHistoryState *hand)
{
    wr_call_free(hand->call);
    hand->call = NULL;
    hand->err.text[0] = '\0';
    hand->previewed = false;
}

static void forget_macro(WrHistoryState *hand)
{
    for (int i = 0; i < hand->lines.count; i++) {
        wr_call_free(hand->lines.data[i].before);
        wr_call_free(hand->lines.data[i].now);
    }
    wr_array_free(&hand->lines);
    wr_free(hand->macro);
    hand->macro = NULL;
}

void wr_history_panel_free(WrApp *app)
{
    forget_call(app->history);
    forget_macro(app->history);
}

/* ---- a changed step ---- */

void wr_step_edit(WrApp *app, int step)
{
    WrHistoryState *hand = app->history;
    forget_call(hand);
    if (!wr_call_parse(wr_session_history_line(app->session, step), false, &hand->call, NULL))
        return; /* it comes from a newer version */
    hand->step = step;
    wr_dialog_open(app, WR_DIALOG_STEP);
}

/* "step set 3 line=...". */
static void add_line(const WrHistoryState *hand, WrText *line)
{
    WrText words = { 0 };
    wr_call_print(hand->call, &words);
    wr_text_addf(line, "step set %d", hand->step + 1);
    wr_line_text(line, "line", wr_text_get(&words));
    wr_text_fini(&words);
}

static void preview(WrApp *app)
{
    WrText line = { 0 };
    add_line(app->history, &line);
    wr_app_try(app,
               &(WrEditPreviewRequest){ .command = wr_text_get(&line), .session = app->session });
    app->history->previewed = true;
    app->history->err.text[0] = '\0';
    wr_text_fini(&line);
}

static void heading(const char *line)
{
    WrText words = { 0 };
    wr_step_label(line, &words);
    wr_gui_as_it_is(true); /* already translated */
    wr_gui_text_wrapped(WR_FONT_BOLD, WR_COLOUR_STRONG, wr_text_get(&words));
    wr_gui_as_it_is(false);
    wr_text_fini(&words);
}

/* Cost of a change: measured when the steps ran. One line, so that the buttons stay in place. */
static void cost(const WrApp *app, int step)
{
    char text[120];
    const int count = wr_session_history_position(app->session) - step;
    const double seconds = wr_session_history_seconds(app->session, step);
    if (count == 1) snprintf(text, sizeof text, "%s", wr_words("Runs this step again"));
    else snprintf(text, sizeof text, wr_words("Runs %d steps again"), count);
    if (seconds >= 0.05) {
        const size_t length = strlen(text);
        wr_words_print(text + length, sizeof text - length, wr_words(": about %.1f s"), seconds);
    }
    wr_gui_as_it_is(true);
    wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, text);
    wr_gui_as_it_is(false);
}

static void trouble(WrApp *app)
{
    WrHistoryState *hand = app->history;
    WrError err;
    if (wr_edit_preview_error(app->trial, &err)) hand->err = err;
    char text[WR_ERROR_TEXT + WR_ERROR_MESSAGE];
    const char *said =
        hand->err.text[0] ? wr_words_message(wr_error_message(&hand->err), text, sizeof text) : "";
    wr_gui_as_it_is(true);
    wr_gui_note(WR_COLOUR_RAISE, said, 2);
    wr_gui_as_it_is(false);
}

void wr_dialog_step(WrApp *app)
{
    WrHistoryState *hand = app->history;
    const int position = wr_session_history_position(app->session);
    if (!hand->call || (hand->step >= position && !app->busy)) {
        wr_dialog_close(app);
        return;
    }
    if (!wr_gui_dialog_begin_at("Change step", wr_dialog_side(app))) return;
    heading(wr_session_history_line(app->session, hand->step));
    wr_gui_space(4);
    wr_busy_hold(app);
    if (wr_call_rows(hand->call) != WR_EDIT_NONE) preview(app);
    wr_busy_hold_end();
    wr_gui_space(4);
    cost(app, hand->step);
    trouble(app);
    const int answer = wr_dialog_buttons(app, "Change", true);
    wr_gui_dialog_end();
    if (answer == 0 && app->dialog->now == WR_DIALOG_STEP) return;
    wr_app_try_end(app);
    WrText line = { 0 };
    if (answer > 0) add_line(hand, &line);
    forget_call(hand);
    if (answer > 0) wr_app_run_slow(app, wr_text_get(&line));
    wr_text_fini(&line);
}

/* ---- macros ---- */

static void ask(WrApp *app, WrFilePurpose purpose, const char *name)
{
    if (!wr_files_request_path(app->files, purpose, NULL, name))
        wr_dialog_open(app, WR_DIALOG_FILE);
}

void wr_macro_save(WrApp *app, int step)
{
    app->history->step = step;
    ask(app, WR_FILE_MACRO_SAVE, "macro.wrinkle");
}

void wr_macro_save_chosen(WrApp *app, const char *path)
{
    const int first = app->history->step + 1, last = wr_session_history_position(app->session);
    WrText line = { 0 };
    wr_text_add(&line, "script ");
    wr_text_add_word(&line, path);
    wr_text_addf(&line, " steps=%d..%d", first, last);
    if (wr_app_run_line(app, wr_text_get(&line)))
        wr_app_say(app, "Saved %d steps as %s", last - first + 1, path);
    wr_text_fini(&line);
}

void wr_macro_open(WrApp *app)
{
    ask(app, WR_FILE_MACRO, "");
}

/* Lines that cannot be read are left to the command, whose error names them. */
static void read_lines(WrHistoryState *hand, const char *text)
{
    int number = 1;
    for (const char *p = text; *p && hand->lines.count < MACRO_LINES; number++) {
        const size_t length = strcspn(p, "\r\n");
        char *line = wr_strndup(p, length);
        WrMacroLine one = { .number = number };
        if (wr_call_parse(line, false, &one.before, NULL) && one.before->command &&
            wr_call_parse(line, false, &one.now, NULL))
            wr_array_push(&hand->lines, one);
        else wr_call_free(one.before);
        wr_free(line);
        p += length;
        p += *p == '\r';
        p += *p == '\n';
    }
}

void wr_macro_chosen(WrApp *app, const char *path)
{
    WrHistoryState *hand = app->history;
    char *bytes;
    size_t length;
    WrError err;
    if (!wr_file_read(path, MACRO_BYTES, &bytes, &length, &err)) {
        wr_app_fail(app, &err);
        return;
    }
    forget_macro(hand);
    hand->macro = wr_strdup(path);
    read_lines(hand, bytes);
    wr_free(bytes);
    wr_dialog_open(app, WR_DIALOG_MACRO);
}

/* "macro FILE values=...". */
static void add_macro(const WrHistoryState *hand, WrText *line)
{
    WrText values = { 0 };
    for (int i = 0; i < hand->lines.count; i++) {
        const WrMacroLine *one = &hand->lines.data[i];
        WrText words = { 0 };
        wr_call_difference(one->before, one->now, &words);
        if (words.length)
            wr_text_addf(&values, "%s%d: %s", values.length ? "; " : "", one->number,
                         wr_text_get(&words));
        wr_text_fini(&words);
    }
    wr_text_add(line, "macro ");
    wr_text_add_word(line, hand->macro);
    if (values.length) wr_line_text(line, "values", wr_text_get(&values));
    wr_text_fini(&values);
}

static WrEdit macro_rows(WrHistoryState *hand)
{
    WrEdit edit = WR_EDIT_NONE;
    for (int i = 0; i < hand->lines.count; i++) {
        WrMacroLine *one = &hand->lines.data[i];
        WrText line = { 0 };
        wr_gui_push_id(one->number);
        wr_call_print(one->now, &line);
        heading(wr_text_get(&line));
        wr_text_fini(&line);
        const WrEdit now = wr_call_rows(one->now);
        if (now != WR_EDIT_NONE) edit = now;
        wr_gui_space(6);
        wr_gui_pop_id();
    }
    return edit;
}

void wr_dialog_macro(WrApp *app)
{
    WrHistoryState *hand = app->history;
    if (!hand->macro) {
        wr_dialog_close(app);
        return;
    }
    if (!wr_gui_dialog_begin_at("Run macro", wr_dialog_side(app))) return;
    WrText line = { 0 };
    wr_busy_hold(app);
    const WrEdit edit = macro_rows(hand);
    wr_busy_hold_end();
    add_macro(hand, &line);
    if (edit != WR_EDIT_NONE || app->dialog->fresh) {
        wr_app_try(app, &(WrEditPreviewRequest){ .command = wr_text_get(&line) });
        hand->err.text[0] = '\0';
    }
    trouble(app);
    const int answer = wr_dialog_buttons(app, "Run", true);
    wr_gui_dialog_end();
    if (answer != 0 || app->dialog->now != WR_DIALOG_MACRO) {
        wr_app_try_end(app);
        forget_macro(hand);
        if (answer > 0) wr_app_run_slow(app, wr_text_get(&line));
    }
    wr_text_fini(&line);
}
