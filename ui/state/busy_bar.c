/* Progress of the background command in place of the status line: text, bar, remaining time, Cancel, and queued
   actions. */
#include "ui/state/busy_internal.h"
#include "ui/state/dialog.h"
#include "ui/state/app_state.h"
#include "ui/state/layout.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/jobs/job.h"

#include "base/array.h"
#include "base/progress.h"
#include "system/clock.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>

#define REFUSED_SECONDS 2.0 /* duration of the note about a refused action */

/* The command's name, or a note about actions requested meanwhile. */
static void say(const WrApp *app, bool refused, double wide)
{
    const WrBusy *busy = app->busy;
    const int count = app->waits->items.count;
    char waits[300], text[400];
    if (refused || busy->closes || count == 0) {
        wr_gui_text_cut(WR_FONT_TEXT, WR_COLOUR_STRONG,
                        refused        ? "Not while this is being done: wait or cancel"
                        : busy->closes ? "Closes when this is done: wait or cancel"
                                       : busy->what,
                        wide);
        return;
    }
    wr_waits_words(app, ", ", waits, sizeof waits);
    snprintf(text, sizeof text, wr_words(count == 1 ? "%d thing waits: %s" : "%d things wait: %s"),
             count, waits);
    wr_gui_as_it_is(true); /* already translated */
    wr_gui_text_cut(WR_FONT_TEXT, WR_COLOUR_STRONG, text, wide);
    wr_gui_as_it_is(false);
}

/* Narrow windows have shorter texts and a shorter bar, but all parts. */
static double squeezed(double wide, double share, double whole)
{
    double lacking = fmax(0.0, wr_gui_px(whole) - wr_gui_width());
    return fmax(wr_gui_px(20), wr_gui_px(wide) - share * lacking);
}

static void drop_button(WrApp *app)
{
    char waits[600];
    wr_waits_words(app, "\n", waits, sizeof waits);
    wr_gui_same_line(12);
    const bool drops = wr_gui_chip(NULL, "Drop waiting actions");
    wr_gui_as_it_is(true);
    wr_gui_tip(waits);
    wr_gui_as_it_is(false);
    if (drops) wr_waits_drop(app, WR_DROPPED_WISH);
}

static void bar(WrApp *app, bool refused, double now)
{
    WrBusy *busy = app->busy;
    char seconds[24], left[WR_TIME_LEFT];
    const double took = now - busy->since;
    const bool waits = app->waits->items.count > 0;
    const double whole = waits ? 970 : 830;
    const double wide = squeezed(320, 0.6, whole), long_bar = squeezed(220, 0.4, whole);
    const double end = wr_gui_px(30) + wide + long_bar;
    say(app, refused, wide);
    wr_gui_same_line(12);
    wr_gui_move_to(wr_gui_px(30) + wide);
    wr_gui_progress(long_bar, busy->furthest > 0.0 ? busy->furthest : -1.0);
    wr_gui_same_line(12);
    snprintf(seconds, sizeof seconds, "%.1f s", took);
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, seconds);
    wr_gui_same_line(12);
    wr_gui_move_to(end + wr_gui_px(70));
    wr_time_left_words(&busy->left, busy->furthest, took, left);
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, busy->cancelled ? "cancelling" : left);
    wr_gui_same_line(12);
    wr_gui_move_to(end + wr_gui_px(160));
    if (wr_gui_chip(NULL, "Cancel")) wr_busy_cancel(busy);
    wr_gui_tip("Escape");
    if (waits) drop_button(app);
}

bool wr_busy_bar(WrApp *app)
{
    WrBusy *busy = app->busy;
    SDL_Rect room = app->layout->status;
    const double now = wr_clock_seconds();
    const int tall = wr_gui_px(28);
    double fraction = 0.0;
    if (!busy || wr_busy_is_young(app)) return false;
    wr_job_busy(busy->job, &fraction, NULL);
    if (fraction > busy->furthest) busy->furthest = fraction;
    if (room.w <= 0) room = (SDL_Rect){ 0, app->height - tall, app->width, tall };
    const bool refused = now - busy->refused_at < REFUSED_SECONDS;
    wr_gui_area_begin("##busy", WR_AREA_BAR, room, refused ? WR_COLOUR_REFUSED : WR_COLOUR_BAR);
    bar(app, refused, now);
    wr_gui_area_end();
    return true;
}
