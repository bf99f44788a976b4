/* Release of memory kept for the next table or picture, after an idle period of the window. */
#include "ui/app/idle_trim.h"
#include "ui/state/app_state.h"

#include "field/field.h"
#include "system/clock.h"

#define ALONE_SECONDS 20.0

static double next_time(const WrApp *app)
{
    const bool done = app->busy || app->thrifty_at >= app->input_at;
    return done ? 0.0 : app->input_at + ALONE_SECONDS;
}

static void update(WrApp *app)
{
    if (app->busy) app->thrifty_at = 0.0; /* a running command's memory is released afterwards */
    const double due = next_time(app), now = wr_clock_seconds();
    if (due == 0.0 || now < due) return;
    wr_field_trim();
    app->thrifty_at = now;
}

const WrPart wr_part_thrift = { .next_time = next_time, .update = update };
