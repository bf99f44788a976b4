#include "ui/panels/points_pad.h"
#include "ui/toolkit/theme.h"
#include "ui/app/state/app_state.h"
#include "ui/toolkit/gui.h"
#include "ui/panels/panel_adjust.h"

#include "field/monotone_curve.h"

#include <SDL.h>
#include <math.h>
#include <string.h>

#define REACH_UNITS 9.0
#define OUT_UNITS 28.0 /* distance outside the pad at which a dragged point is removed */
#define STEPS 160

/* Position of x and y in pixels of the window. */
static double x_of(const WrPad *pad, const WrPointsSpan *span, double x)
{
    return pad->x + pad->w * (x - span->left) / (span->right - span->left);
}

static double y_of(const WrPad *pad, const WrPointsSpan *span, double y)
{
    return pad->y + pad->h * (1.0 - (y - span->low) / (span->high - span->low));
}

void wr_points_draw(const WrPad *pad, const WrPointsState *hand, const double *value,
                    WrPointsAt *at, const void *ctx)
{
    const WrPointsSpan *span = &hand->span;
    double before_x = 0.0, before_y = 0.0;
    bool before = false;
    for (int k = 0; k <= STEPS; k++) {
        double height;
        const double place = span->left + (span->right - span->left) * k / STEPS;
        const bool there = at(ctx, place, &height);
        const double x = x_of(pad, span, place);
        const double y = there ? fmin(fmax(y_of(pad, span, height), pad->y), pad->y + pad->h) : 0.0;
        if (before && there)
            wr_gui_draw_line(before_x, before_y, x, y, WR_COLOUR_CELL, wr_gui_px(2));
        before = there;
        before_x = x;
        before_y = y;
    }
    for (int i = 0; i < (int)*value; i++)
        wr_gui_draw_disc(x_of(pad, span, value[1 + 2 * i]), y_of(pad, span, value[2 + 2 * i]),
                         wr_gui_px(4), i == hand->chosen - 1 ? WR_COLOUR_ACCENT : WR_COLOUR_STRONG);
}

static int near(const WrPad *pad, const WrPointsSpan *span, const WrPointsRules *rules,
                const double *value)
{
    double most = wr_gui_px(rules->reach > 0.0 ? rules->reach : REACH_UNITS);
    int found = -1;
    for (int i = 0; i < (int)*value; i++) {
        const double away = hypot(x_of(pad, span, value[1 + 2 * i]) - pad->pointer_x,
                                  y_of(pad, span, value[2 + 2 * i]) - pad->pointer_y);
        if (away <= most) found = i, most = away;
    }
    return found;
}

static bool take_away(const WrPointsRules *rules, double *value, int i)
{
    const int count = (int)*value;
    if (count <= rules->least) return false;
    memmove(value + 1 + 2 * i, value + 3 + 2 * i, sizeof *value * 2 * (size_t)(count - 1 - i));
    *value = count - 1;
    return true;
}

/* Insert a point; returns its index, -1 if there is no room. */
static int add(const WrPointsRules *rules, double *value, double x, double y)
{
    const int count = (int)*value;
    int i = 0;
    while (i < count && value[1 + 2 * i] < x) i++;
    if (count == rules->most || (i < count && value[1 + 2 * i] == x)) return -1;
    memmove(value + 3 + 2 * i, value + 1 + 2 * i, sizeof *value * 2 * (size_t)(count - i));
    value[1 + 2 * i] = x;
    value[2 + 2 * i] = y;
    *value = count + 1;
    return i;
}

static double within(double x, double low, double high)
{
    return x < low ? low : x > high ? high : x;
}

static double rounded(double x)
{
    return rint(x * 1e4) / 1e4;
}

static void keep_inside(const WrPointsSpan *span, const WrPointsRules *rules, double *x, double *y)
{
    if (rules->ends) *x = within(*x, span->left, span->right);
    if (rules->inside) *y = within(*y, span->low, span->high);
    *x = rounded(*x);
    *y = rounded(*y);
}

/* Move a point, limited by its neighbours. */
static void move(const WrPointsSpan *span, const WrPointsRules *rules, double *value, int i,
                 double x, double y)
{
    const double gap = (span->right - span->left) / 1e3;
    keep_inside(span, rules, &x, &y);
    if (i > 0) x = fmax(x, value[2 * i - 1] + gap);
    if (i < (int)*value - 1) x = fmin(x, value[3 + 2 * i] - gap);
    value[1 + 2 * i] = rounded(x);
    value[2 + 2 * i] = y;
}

static bool drag(const WrPad *pad, const WrPointsRules *rules, WrPointsState *hand, double *value,
                 double x, double y)
{
    const int i = hand->held - 1;
    const double out = wr_gui_px(OUT_UNITS);
    const bool outside = pad->pointer_y < pad->y - out || pad->pointer_y > pad->y + pad->h + out ||
                         pad->pointer_x < pad->x - out || pad->pointer_x > pad->x + pad->w + out;
    if (outside && take_away(rules, value, i)) {
        hand->held = hand->chosen = 0;
        return true;
    }
    const double was_x = value[1 + 2 * i], was_y = value[2 + 2 * i];
    move(&hand->span, rules, value, i, x, y);
    return value[1 + 2 * i] != was_x || value[2 + 2 * i] != was_y;
}

static bool keys(const WrPointsRules *rules, WrPointsState *hand, double *value)
{
    const WrPointsSpan *span = &hand->span;
    const int i = hand->chosen - 1;
    if (i < 0 || i >= (int)*value) return false;
    const double dx =
        wr_gui_key_pressed(SDL_SCANCODE_RIGHT) - wr_gui_key_pressed(SDL_SCANCODE_LEFT);
    const double dy = wr_gui_key_pressed(SDL_SCANCODE_UP) - wr_gui_key_pressed(SDL_SCANCODE_DOWN);
    if (wr_gui_key_pressed(SDL_SCANCODE_DELETE) && take_away(rules, value, i)) {
        hand->chosen = 0;
        return true;
    }
    if (dx == 0.0 && dy == 0.0) return false;
    move(span, rules, value, i, value[1 + 2 * i] + dx * (span->right - span->left) / 200.0,
         value[2 + 2 * i] + dy * (span->high - span->low) / 200.0);
    return true;
}

bool wr_points_move(const WrPad *pad, const WrPointsSpan *now, const WrPointsRules *rules,
                    WrPointsState *hand, double *value)
{
    if (!hand->held) hand->span = *now;
    const WrPointsSpan *span = &hand->span;
    double x = span->left + (span->right - span->left) * (pad->pointer_x - pad->x) / pad->w;
    double y = span->high - (span->high - span->low) * (pad->pointer_y - pad->y) / pad->h;
    bool changed = false;
    if (pad->pressed) {
        int at = near(pad, span, rules, value);
        changed = at < 0;
        keep_inside(span, rules, &x, &y);
        if (at < 0) at = add(rules, value, x, y);
        hand->held = hand->chosen = at + 1;
    }
    /* The release is handled as a motion too, since it may contain the last position. */
    if (hand->held) changed |= drag(pad, rules, hand, value, x, y);
    if (!pad->held) hand->held = 0;
    if (!pad->held) changed |= keys(rules, hand, value);
    return changed;
}

/* Curve editor of the operation `curves`: the curve over the histogram of heights, with draggable points. */

#define ROOM_UNITS 200

/* Height range of the pad, the same on both axes. */
static WrPointsSpan span_of(const WrHeightCounts *h, const double *value)
{
    double low = fmin(h->low, 0.0), high = fmax(h->high, 1.0);
    for (int i = 1; i <= 2 * (int)*value; i++) {
        low = fmin(low, value[i]);
        high = fmax(high, value[i]);
    }
    return (WrPointsSpan){ low, high, low, high };
}

static bool at(const void *ctx, double x, double *y)
{
    const WrCurve *curve = ctx;
    if (curve->count == 0) return false;
    *y = wr_curve_at(curve, x);
    return true;
}

bool wr_curves_pad(WrApp *app)
{
    static const WrPointsRules rules = { .least = 2, .most = WR_CURVE_POINTS };
    WrAdjust *adjust = app->adjust;
    const WrHeightCounts *h = wr_height_counts(app);
    double *value = adjust->param; /* the operation's only parameter */
    WrPad pad = wr_gui_pad_begin("curve", 0, wr_gui_px(ROOM_UNITS));
    const WrPointsSpan now = span_of(h, value);
    const bool changed = wr_points_move(&pad, &now, &rules, &adjust->points, value);
    const WrPointsSpan *span = &adjust->points.span;
    WrCurve curve = { .count = 0 };
    if (!wr_curve_make(value + 1, (int)*value, &curve, NULL)) curve.count = 0;
    wr_height_bars(&pad, (WrHeightSpan){ span->left, span->right }, h);
    wr_gui_draw_line(pad.x, pad.y + pad.h, pad.x + pad.w, pad.y, 0x40ffffffu, wr_gui_px(1));
    wr_points_draw(&pad, &adjust->points, value, at, &curve);
    wr_gui_pad_end();
    if (!pad.held && !adjust->points.chosen)
        wr_gui_tip("Horizontal: old heights. Vertical: new heights. Drag the points; click to add "
                   "one; drag one out, or press Delete, to remove it");
    return changed;
}
