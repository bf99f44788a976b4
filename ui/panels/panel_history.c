/* History panel: steps of the document; a click goes to a step. */
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/app/state/settings.h"
#include "ui/app/state/step_label.h"
#include "ui/panels/panel_layers.h"
#include "ui/panels/thumb_list.h"
#include "ui/panels/panels.h"

#include "base/text.h"
#include "command/session.h"

#include <stdio.h>
#include <string.h>

#define ROWS_MAX 400 /* newest steps that are shown */
#define ROW_UNITS 34
#define LINE_UNITS 23
#define THUMB_UNITS 26

static void print_bytes(double bytes, char *text, size_t size)
{
    if (bytes >= 1e9) snprintf(text, size, "%.3g GB", bytes / 1e9);
    else if (bytes >= 1e6) snprintf(text, size, "%.3g MB", bytes / 1e6);
    else snprintf(text, size, "%.3g kB", bytes / 1e3);
}

static void tip_of(const WrApp *app, int step, bool kept)
{
    char text[760], bytes[24];
    const char *line = wr_session_history_line(app->session, step);
    print_bytes((double)wr_session_history_step_bytes(app->session, step), bytes, sizeof bytes);
    snprintf(text, sizeof text, "%.640s%s\n%s", line, strlen(line) > 640 ? " ..." : "",
             kept ? bytes : wr_words("The state after it was given up to keep within the budget"));
    wr_gui_as_it_is(true);
    wr_gui_tip(text);
    wr_gui_as_it_is(false);
}

/* The state after `position` steps, with the step that led to it; position 0 is the start. True if clicked. */
static bool row(WrApp *app, int position, bool seen)
{
    const bool lines = app->settings->history_lines;
    int now = wr_session_history_position(app->session);
    bool kept = position >= wr_session_history_oldest(app->session);
    WrColour colour = position == now           ? WR_COLOUR_STRONG
                      : position > now || !kept ? WR_COLOUR_FAINT
                                                : WR_COLOUR_TEXT;
    WrRow r = wr_gui_row_begin(position, lines ? LINE_UNITS : ROW_UNITS, position == now);
    double x = wr_gui_px(12), side = wr_gui_px(THUMB_UNITS);
    const WrField *heights = wr_session_history_heights(app->session, position);
    const char *begin = wr_words(wr_session_path(app->session)[0] ? "as opened" : "the beginning");
    WrText words = { 0 };
    if (position > 0) tip_of(app, position - 1, kept);
    wr_gui_row_set_cursor(x, 0);
    if (position == now) wr_gui_text(WR_FONT_SMALL, WR_COLOUR_ACCENT, "\xe2\x80\xa2");
    x += wr_gui_px(12);
    if (!lines && heights && seen) {
        wr_gui_row_set_cursor(x, side);
        wr_gui_image(wr_thumb_list_get(app, &app->layers->steps, position, heights, NULL, false,
                                       THUMB_UNITS),
                     side, side);
    }
    if (!lines) x += side + wr_gui_px(8);
    if (position == 0) wr_text_add(&words, begin);
    else if (lines) wr_text_add(&words, wr_session_history_line(app->session, position - 1));
    else wr_step_label(wr_session_history_line(app->session, position - 1), &words);
    wr_gui_row_set_cursor(x, 0);
    wr_gui_as_it_is(true); /* already translated */
    wr_gui_text_cut(WR_FONT_SMALL, colour, wr_text_get(&words),
                    wr_gui_row_width() - x - wr_gui_px(12));
    wr_gui_as_it_is(false);
    wr_text_fini(&words);
    wr_gui_row_end();
    return r.clicked && kept && position != now;
}

void wr_panel_history(WrApp *app)
{
    char used[24], budget[24], text[64];
    int count = wr_session_history_count(app->session), goal = -1;
    print_bytes((double)wr_session_history_bytes(app->session), used, sizeof used);
    print_bytes((double)wr_session_history_budget(app->session), budget, sizeof budget);
    snprintf(text, sizeof text, wr_words("%s of %s"), used, budget);
    wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, text);
    wr_gui_tip(
        "Memory that the states on the way take, and how much they may: the oldest are given "
        "up first. `history budget=` changes it.");
    double wide = wr_gui_text_width(WR_FONT_TEXT, wr_words("Save as script...")) + wr_gui_px(28);
    wr_gui_same_line(8);
    wr_gui_move_to(wr_gui_width() - wide);
    wr_gui_disable(!wr_action_can(app, wr_action_find(app, WR_ACT(save_history))));
    if (wr_gui_chip(NULL, "Save as script...")) wr_action_run(app, WR_ACT(save_history));
    wr_gui_disable_end();
    static const char *const ways[] = { "In words", "As commands" };
    int way = app->settings->history_lines;
    if (wr_gui_segments("ways", ways, NULL, 2, &way)) app->settings->history_lines = way == 1;
    wr_gui_tip("The steps, or the lines of text that run them, as in a script");
    wr_gui_space(2);
    if (count == 0) {
        wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_LABEL,
                            "Nothing yet. Every change is one line of text here, as a script would "
                            "have it.");
        return;
    }
    int last = count > ROWS_MAX ? count - ROWS_MAX : 0;
    wr_busy_hold(app);
    for (int i = count; i >= last; i--) /* newest on top */
        if (row(app, i, wr_gui_will_see(wr_gui_px(ROW_UNITS)))) goal = i;
    wr_busy_hold_end();
    if (goal >= 0) wr_app_run_linef(app, "step go %d", goal);
}
