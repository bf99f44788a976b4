/* History panel: steps of the document; a click goes to a step, a double click changes it. */
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/app/state/settings.h"
#include "ui/app/state/step_label.h"
#include "ui/panels/panel_history.h"
#include "ui/panels/panel_layers.h"
#include "ui/panels/thumb_list.h"
#include "ui/panels/panels.h"

#include "base/text.h"
#include "command/session.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define ROWS_MAX 400 /* newest steps that are shown */
#define ROW_UNITS 34
#define LINE_UNITS 23
#define THUMB_UNITS 26

static void print_bytes(double bytes, char *text, size_t size)
{
    if (bytes >= 1e9) wr_words_print(text, size, wr_words("%.3g GB"), bytes / 1e9);
    else if (bytes >= 1e6) wr_words_print(text, size, wr_words("%.3g MB"), bytes / 1e6);
    else wr_words_print(text, size, wr_words("%.3g kB"), bytes / 1e3);
}

static void tip_of(const WrApp *app, int step, bool kept)
{
    char text[760], bytes[24];
    const char *line = wr_session_history_line(app->session, step);
    print_bytes((double)wr_session_history_step_bytes(app->session, step), bytes, sizeof bytes);
    snprintf(
        text, sizeof text, "%.640s%s\n%s", line, strlen(line) > 640 ? " ..." : "",
        kept ? bytes
             : wr_words("The state after this step was dropped to stay within the memory limit"));
    wr_gui_as_it_is(true);
    wr_gui_tip(text);
    wr_gui_as_it_is(false);
}

static void go(WrApp *app, int position)
{
    char line[WR_GO_LINE];
    wr_session_history_go_line(app->session, position, line);
    wr_app_run_line(app, line);
}

/* ---- one row ---- */

static void label_of(const WrApp *app, int position, WrText *words)
{
    const char *line = wr_session_history_line(app->session, position - 1);
    if (position == 0)
        wr_text_add(words,
                    wr_words(wr_session_path(app->session)[0] ? "as opened" : "the beginning"));
    else if (app->settings->history_lines) wr_text_add(words, line);
    else wr_step_label(line, words);
}

/* The dot of the present state, the picture, and the words; `room` pixels at the right stay free. */
static void row_content(WrApp *app, int position, bool seen, double room)
{
    const bool lines = app->settings->history_lines;
    const int now = wr_session_history_position(app->session);
    const bool kept = position >= wr_session_history_oldest(app->session);
    const bool off = wr_session_history_is_off(app->session, position - 1);
    const WrColour colour = position == now && !off          ? WR_COLOUR_STRONG
                            : position > now || !kept || off ? WR_COLOUR_FAINT
                                                             : WR_COLOUR_TEXT;
    double x = wr_gui_px(12), side = wr_gui_px(THUMB_UNITS);
    const WrField *heights = wr_session_history_heights(app->session, position);
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
    label_of(app, position, &words);
    wr_gui_row_set_cursor(x, 0);
    wr_gui_as_it_is(true); /* already translated */
    wr_gui_text_cut(WR_FONT_SMALL, colour, wr_text_get(&words),
                    wr_gui_row_width() - x - wr_gui_px(12) - room);
    wr_gui_as_it_is(false);
    wr_text_fini(&words);
}

/* Buttons of a step that can be changed. True if one was pressed. */
static bool row_buttons(WrApp *app, int step, double room)
{
    const bool off = wr_session_history_is_off(app->session, step);
    wr_gui_row_set_cursor(wr_gui_row_width() - room, wr_gui_px(24));
    const bool eye = wr_gui_glyph("on", off ? WR_ICON_EYE_OFF : WR_ICON_EYE, 24,
                                  off ? WR_COLOUR_TEXT : WR_COLOUR_FAINT);
    wr_gui_tip(off ? "Switch this step on again" : "Switch this step off");
    wr_gui_row_set_cursor(wr_gui_row_width() - room + wr_gui_px(26), wr_gui_px(24));
    const bool change = wr_gui_glyph("change", WR_ICON_TUNE, 24, WR_COLOUR_FAINT);
    wr_gui_tip("Change this step; the steps after it run again");
    if (eye) wr_app_run_linef(app, "step %s %d", off ? "on" : "off", step + 1);
    if (change) wr_step_edit(app, step);
    return eye || change;
}

/* A drag moves a step; newest on top. */
static bool row_dragged(WrApp *app, int step, const WrRow *row)
{
    WrHistoryState *hand = app->history;
    const int position = wr_session_history_position(app->session);
    const int oldest = wr_session_history_oldest(app->session);
    if (row->dragging && !wr_busy_greys(app)) {
        const int up =
            (int)floor((row->top + row->height / 2 - row->pointer_y) / row->height + 0.5);
        int drop = step + up;
        if (drop > position - 1) drop = position - 1;
        if (drop < oldest) drop = oldest;
        hand->dragged = step;
        hand->drop = drop;
        wr_gui_drop_line(wr_gui_px(12), row->top - row->height * (drop - step) +
                                            (drop < step ? row->height : 0.0));
        return true;
    }
    if (hand->dragged != step) return false;
    hand->dragged = -1;
    if (row->dropped && hand->drop != step)
        wr_app_run_linef(app, "step move %d to=%d", step + 1, hand->drop + 1);
    return true;
}

/* The state after `position` steps, with the step that led to it; position 0 is the start. The state to go to; -1: none. */
static int row(WrApp *app, int position, bool seen)
{
    WrHistoryState *hand = app->history;
    const bool lines = app->settings->history_lines;
    const int now = wr_session_history_position(app->session), step = position - 1;
    const int oldest = wr_session_history_oldest(app->session);
    const bool changes = step >= oldest && position <= now;
    const double room = changes ? wr_gui_px(60) : 0.0;
    const WrRow r = wr_gui_row_begin(position, lines ? LINE_UNITS : ROW_UNITS,
                                     position == now ? WR_ROW_SELECTED : WR_ROW_PLAIN);
    row_content(app, position, seen, room);
    const bool pressed = changes && seen && row_buttons(app, step, room);
    wr_gui_row_end();
    if (pressed || (changes && row_dragged(app, step, &r))) return -1;
    if (r.menu && step >= oldest) {
        hand->menu = step;
        hand->menu_opens = true;
    }
    if (r.doubled && step >= oldest) { /* its first click went there */
        if (hand->clicked_at > now) go(app, hand->clicked_at);
        wr_step_edit(app, step);
        return -1;
    }
    if (!r.clicked || position < oldest) return -1;
    hand->clicked_at = now;
    return position != now ? position : -1;
}

/* ---- the menu of a step ---- */

static void menu(WrApp *app)
{
    WrHistoryState *hand = app->history;
    const int position = wr_session_history_position(app->session), step = hand->menu;
    if (hand->menu_opens) wr_gui_popup_open("step");
    hand->menu_opens = false;
    if (!wr_gui_popup_begin("step")) return;
    const bool done = step < position, off = wr_session_history_is_off(app->session, step);
    if (wr_gui_menu_item("Change...", "", false, done)) wr_step_edit(app, step);
    if (wr_gui_menu_item(off ? "Switch on" : "Switch off", "", false, done))
        wr_app_run_linef(app, "step %s %d", off ? "on" : "off", step + 1);
    if (wr_gui_menu_item("Move earlier", "", false,
                         done && step > wr_session_history_oldest(app->session)))
        wr_app_run_linef(app, "step move %d to=%d", step + 1, step);
    if (wr_gui_menu_item("Move later", "", false, step + 1 < position))
        wr_app_run_linef(app, "step move %d to=%d", step + 1, step + 2);
    if (wr_gui_menu_item("Delete", "", false, done))
        wr_app_run_linef(app, "step delete %d", step + 1);
    wr_gui_menu_separator();
    if (wr_gui_menu_item("Save from here as a macro...", "", false, done)) wr_macro_save(app, step);
    wr_gui_popup_end();
}

void wr_panel_history(WrApp *app)
{
    char used[24], budget[24], text[64];
    int count = wr_session_history_count(app->session), goal = -1;
    print_bytes((double)wr_session_history_bytes(app->session), used, sizeof used);
    print_bytes((double)wr_session_history_budget(app->session), budget, sizeof budget);
    snprintf(text, sizeof text, wr_words("%s of %s"), used, budget);
    wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, text);
    wr_gui_tip("Memory of the undo states, and its limit: the oldest states are dropped first. "
               "`history budget=` changes the limit.");
    double wide = wr_gui_text_width(WR_FONT_TEXT, wr_words("Save as script...")) + wr_gui_px(28);
    wr_gui_same_line(8);
    wr_gui_move_to(wr_gui_width() - wide);
    wr_gui_disable(!wr_action_can(app, wr_action_find(app, WR_ACT(save_history))));
    if (wr_gui_chip(NULL, "Save as script...")) wr_action_run(app, WR_ACT(save_history));
    wr_gui_disable_end();
    static const char *const ways[] = { "In words", "As commands" };
    int way = app->settings->history_lines;
    if (wr_gui_segments("ways", ways, NULL, 2, &way)) app->settings->history_lines = way == 1;
    wr_gui_tip("Shows the steps, or the lines of text that run them, as in a script");
    wr_gui_space(2);
    if (count == 0) {
        wr_gui_text_wrapped(
            WR_FONT_TEXT, WR_COLOUR_LABEL,
            "Nothing yet. Every change appears here as a line of text, as in a script.");
        return;
    }
    int last = count > ROWS_MAX ? count - ROWS_MAX : 0;
    wr_busy_hold(app);
    for (int i = count; i >= last; i--) { /* newest on top */
        const int to = row(app, i, wr_gui_will_see(wr_gui_px(ROW_UNITS)));
        if (to >= 0) goal = to;
    }
    menu(app);
    wr_busy_hold_end();
    if (goal >= 0) go(app, goal);
}
