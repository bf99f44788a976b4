/* Saving of settings while the window is open: after changes, at most once per second, between drags. */
#include "ui/app/settings_autosave.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/settings.h"
#include "ui/canvas/tools/preset_browser.h"

#include "command/session.h"
#include "image/font_list.h"
#include "system/clock.h"

#include <SDL.h>

#define CHECK_SECONDS 1.0

/* The present settings; the program owns their texts. */
static WrSettings current(const WrApp *app)
{
    WrSettings now = *app->settings;
    if (!now.maximized) SDL_GetWindowSize(app->window, &now.width, &now.height);
    wr_preset_browser_remember(app, &now);
    return now;
}

static bool write_changes(WrApp *app, bool last)
{
    WrSettings now = current(app);
    if (wr_settings_equal(app->settings_known, &now)) return true;
    if (!wr_settings_update(app->settings_known, &now, last)) return false;
    /* includes additions of other windows */
    wr_settings_take_lists(app->settings, app->settings_known);
    return true;
}

void wr_settings_begin(WrApp *app)
{
    *app->settings = wr_settings_default();
    if (!app->latency) wr_settings_load(app->settings);
    *app->settings_known = wr_settings_copy(app->settings);
}

double wr_settings_next_autosave(const WrApp *app)
{
    /* A changed setting causes a frame, so without a newer frame nothing has changed. */
    bool due = app->settings_failed || app->drawn_at > app->settings_at;
    bool busy = app->hand->grab != WR_GRAB_NONE || wr_session_in_stroke(app->session);
    return due && !busy && !app->latency ? app->settings_at + CHECK_SECONDS : 0.0;
}

void wr_settings_autosave(WrApp *app)
{
    double due = wr_settings_next_autosave(app), now = wr_clock_seconds();
    if (due == 0.0 || now < due) return;
    app->settings_failed = !write_changes(app, false);
    app->settings_at = wr_clock_seconds();
}

void wr_settings_end(WrApp *app)
{
    if (app->latency) return;
    if (wr_font_config_done()) wr_gui_find_fonts(app->settings->window_fonts);
    write_changes(app, true);
}
