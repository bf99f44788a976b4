/* Opening and closing of dialogs, and their shared buttons. */
#include "ui/app/state/dialog.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/registry.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/app/jobs/edit_preview.h"

#include "base/progress.h"
#include "command/estimate.h"

#include <SDL.h>
#include <stdio.h>
#include <string.h>

void wr_dialog_open(WrApp *app, WrDialog dialog)
{
    wr_app_settle(app);
    app->dialog->now = dialog;
    app->dialog->fresh = true;
    app->hand->on_canvas = app->hand->on_patch = app->hand->space = false;
    wr_app_redraw(app);
}

void wr_dialog_close(WrApp *app)
{
    app->dialog->now = WR_DIALOG_NONE;
    wr_app_redraw(app);
}

void wr_time_left_words(WrTimeLeft *task, double fraction, double seconds, char text[WR_TIME_LEFT])
{
    const double left = rint(wr_time_left(task, fraction, seconds));
    text[0] = '\0';
    if (left < 60000.0)
        snprintf(text, WR_TIME_LEFT, wr_words("%d:%02d left"), (int)left / 60, (int)left % 60);
}

/* Append the remaining time of the edit preview. */
static void add_time_left(const WrApp *app, char text[WR_EXPECTATION])
{
    char left[WR_TIME_LEFT];
    double fraction, seconds;
    if (!app->trying || !wr_edit_preview_busy(app->trial, &fraction, &seconds)) return;
    wr_time_left_words(&app->dialog->preview_left, fraction, seconds, left);
    size_t used = strlen(text);
    if (left[0])
        snprintf(text + used, WR_EXPECTATION - used, "%s%s", used > 0 ? "  \xc2\xb7  " : "", left);
}

void wr_expectation(const WrApp *app, const char *line, char text[WR_EXPECTATION])
{
    WrEstimate estimate;
    char about[WR_ESTIMATE_TEXT] = "";
    if (wr_session_estimate(app->session, line, &estimate, NULL))
        wr_estimate_print(&estimate, about);
    text[0] = '\0';
    if (about[0]) snprintf(text, WR_EXPECTATION, wr_words("Needs %s"), about);
    add_time_left(app, text);
}

void wr_panel_estimate(const WrApp *app, const char *line)
{
    char text[WR_EXPECTATION];
    wr_expectation(app, line, text);
    if (!text[0]) return;
    wr_gui_same_line(12);
    wr_gui_as_it_is(true); /* it is translated */
    wr_gui_text_cut(WR_FONT_SMALL, WR_COLOUR_LABEL, text, wr_gui_available());
    wr_gui_tip(text);
    wr_gui_as_it_is(false);
}

int wr_dialog_buttons(WrApp *app, const char *done, bool enabled)
{
    int answer = 0;
    wr_gui_space(8);
    wr_gui_disable(!enabled);
    if (wr_gui_button(done, true)) answer = 1;
    wr_gui_disable_end();
    wr_gui_same_line(8);
    if (wr_gui_button("Cancel", false)) answer = -1;
    if (enabled && !app->dialog->fresh && wr_gui_return_pressed()) answer = 1;
    if (!app->dialog->fresh && wr_gui_escape_pressed()) answer = -1;
    if (answer) wr_dialog_close(app);
    return answer;
}

void wr_dialog_close_button(WrApp *app, const char *word)
{
    const bool key = !app->dialog->fresh && (wr_gui_escape_pressed() || wr_gui_return_pressed());
    if (wr_gui_button(word, true) || key) wr_dialog_close(app);
}

SDL_Rect wr_dialog_side(const WrApp *app)
{
    if (app->layout->panel.w > 0) return app->layout->panel;
    const int wide = wr_gui_px(320), top = app->menu_height + app->layout->options.h;
    return (SDL_Rect){ app->width - wide, top, wide, 0 };
}

void wr_panel_dialogs(WrApp *app)
{
    WrDialog was = app->dialog->now;
    bool fresh = app->dialog->fresh;
    if (was != WR_DIALOG_NONE) app->registry->dialogs[was].draw(app);
    if (app->dialog->now == was && fresh) app->dialog->fresh = false;
    if (app->dialog->now == WR_DIALOG_NONE && was != WR_DIALOG_NONE) wr_app_redraw(app);
}
