/* Actions of pointer input: straight lines, painting on the patch, simulated pressure, stroke smoothing. */
#include "ui/app/actions.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/settings.h"
#include "ui/patch/patch_paint.h"
#include "ui/input/pen_curve.h"
#include "ui/input/stroke_smoothing.h"

#include <math.h>

void wr_act_straight_line(WrApp *app)
{
    app->hand->line = !app->hand->line;
}

bool wr_is_straight_line(const WrApp *app)
{
    return app->hand->line;
}

void wr_act_paint_patch(WrApp *app)
{
    if (app->hand->grab == WR_GRAB_PATCH_PAINT) wr_input_router_let_go(app);
    app->paint->on = !app->paint->on;
}

bool wr_is_painting_patch(const WrApp *app)
{
    return app->paint->on;
}

void wr_act_paint_round(WrApp *app)
{
    app->paint->round = !app->paint->round;
}

bool wr_is_painting_round(const WrApp *app)
{
    return app->paint->round;
}

static void press(WrApp *app, double by)
{
    WrFakePressure *fake = &app->settings->fake;
    double held = rint((fake->held + by) * 10.0) / 10.0;
    fake->held = held < 0.1 ? 0.1 : held > 1.0 ? 1.0 : held;
    fake->by_speed = false;
    wr_app_say(app, "The mouse presses with %.1f", fake->held);
}

void wr_act_pressure_up(WrApp *app)
{
    press(app, 0.1);
}

void wr_act_pressure_down(WrApp *app)
{
    press(app, -0.1);
}

void wr_act_pressure_speed(WrApp *app)
{
    app->settings->fake.by_speed = !app->settings->fake.by_speed;
    app->settings->fake.held = 1.0;
}

bool wr_is_pressure_speed(const WrApp *app)
{
    return app->settings->fake.by_speed;
}

void wr_act_steady_off(WrApp *app)
{
    app->settings->steady = WR_SMOOTHING_OFF;
}

bool wr_is_steady_off(const WrApp *app)
{
    return app->settings->steady == WR_SMOOTHING_OFF;
}

void wr_act_steady_smooth(WrApp *app)
{
    app->settings->steady = WR_SMOOTHING_SMOOTH;
}

bool wr_is_steady_smooth(const WrApp *app)
{
    return app->settings->steady == WR_SMOOTHING_SMOOTH;
}

void wr_act_steady_string(WrApp *app)
{
    app->settings->steady = WR_SMOOTHING_STRING;
}

bool wr_is_steady_string(const WrApp *app)
{
    return app->settings->steady == WR_SMOOTHING_STRING;
}

void wr_act_steady_catch_up(WrApp *app)
{
    app->settings->steady_catch_up = !app->settings->steady_catch_up;
}

bool wr_is_steady_catch_up(const WrApp *app)
{
    return app->settings->steady_catch_up;
}
