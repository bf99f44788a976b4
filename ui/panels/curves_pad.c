/* The curve of `curves` over the heights' histogram: its points are dragged, added by a click, taken away by dragging them
   out of it or by Delete; arrows move the one that was touched last. */
#include "ui/desk/desk.h"
#include "ui/gui/gui.h"
#include "ui/gui/theme.h"
#include "ui/panels/panel_adjust.h"

#include "field/curve.h"

#include <SDL.h>
#include <math.h>
#include <string.h>

#define ROOM_UNITS 200
#define REACH_UNITS 9.0
#define OUT_UNITS 28.0 /* so far outside a point is let go */
#define STEPS 128

/* The heights that the pad spans, both ways alike. */
static WrHeightSpan span_of(const WrHeightCounts *h, const double *value)
{
    WrHeightSpan span = { fmin(h->low, 0.0), fmax(h->high, 1.0) };
    for (int i = 1; i <= 2 * (int)*value; i++) {
        span.low = fmin(span.low, value[i]);
        span.high = fmax(span.high, value[i]);
    }
    return span;
}

static double y_of(const WrPad *pad, WrHeightSpan span, double height)
{
    return pad->y + pad->h * (1.0 - (height - span.low) / (span.high - span.low));
}

static void draw(const WrPad *pad, WrHeightSpan span, const double *value, int chosen)
{
    const double one = wr_gui_px(1);
    WrCurve curve;
    wr_gui_draw_line(pad->x, y_of(pad, span, span.low), pad->x + pad->w, y_of(pad, span, span.high),
                     0x40ffffffu, one);
    if (wr_curve_make(value + 1, (int)*value, &curve, NULL)) {
        double before_x = 0.0, before_y = 0.0;
        for (int k = 0; k <= STEPS; k++) {
            const double height = span.low + (span.high - span.low) * k / STEPS;
            const double x = wr_height_x(pad, span, height);
            double y = y_of(pad, span, wr_curve_at(&curve, height));
            y = fmin(fmax(y, pad->y), pad->y + pad->h);
            if (k) wr_gui_draw_line(before_x, before_y, x, y, WR_COLOUR_CELL, wr_gui_px(2));
            before_x = x;
            before_y = y;
        }
    }
    for (int i = 0; i < (int)*value; i++)
        wr_gui_draw_disc(wr_height_x(pad, span, value[1 + 2 * i]),
                         y_of(pad, span, value[2 + 2 * i]), wr_gui_px(4),
                         i == chosen ? WR_COLOUR_ACCENT : WR_COLOUR_STRONG);
}

static int near(const WrPad *pad, WrHeightSpan span, const double *value)
{
    double most = wr_gui_px(REACH_UNITS);
    int found = -1;
    for (int i = 0; i < (int)*value; i++) {
        const double away = hypot(wr_height_x(pad, span, value[1 + 2 * i]) - pad->pointer_x,
                                  y_of(pad, span, value[2 + 2 * i]) - pad->pointer_y);
        if (away <= most) found = i, most = away;
    }
    return found;
}

static bool take_away(double *value, int i)
{
    const int count = (int)*value;
    if (count <= 2) return false;
    memmove(value + 1 + 2 * i, value + 3 + 2 * i, sizeof *value * 2 * (size_t)(count - 1 - i));
    *value = count - 1;
    return true;
}

/* The new point's index; -1: there is no room. */
static int add(double *value, double x, double y)
{
    const int count = (int)*value;
    int i = 0;
    while (i < count && value[1 + 2 * i] < x) i++;
    if (count == WR_CURVE_POINTS || (i < count && value[1 + 2 * i] == x)) return -1;
    memmove(value + 3 + 2 * i, value + 1 + 2 * i, sizeof *value * 2 * (size_t)(count - i));
    value[1 + 2 * i] = x;
    value[2 + 2 * i] = y;
    *value = count + 1;
    return i;
}

/* Between its neighbours, which it never passes. */
static void move(double *value, WrHeightSpan span, int i, double x, double y)
{
    const double gap = (span.high - span.low) / 1e3;
    if (i > 0) x = fmax(x, value[2 * i - 1] + gap);
    if (i < (int)*value - 1) x = fmin(x, value[3 + 2 * i] - gap);
    value[1 + 2 * i] = rint(x * 1e4) / 1e4;
    value[2 + 2 * i] = rint(y * 1e4) / 1e4;
}

static bool drag(WrAdjust *adjust, const WrPad *pad, double *value, double x, double y)
{
    const int i = adjust->held - 1;
    const double out = wr_gui_px(OUT_UNITS);
    const bool outside = pad->pointer_y < pad->y - out || pad->pointer_y > pad->y + pad->h + out ||
                         pad->pointer_x < pad->x - out || pad->pointer_x > pad->x + pad->w + out;
    if (outside && take_away(value, i)) {
        adjust->held = adjust->chosen = 0;
        return true;
    }
    const double was_x = value[1 + 2 * i], was_y = value[2 + 2 * i];
    move(value, adjust->held_span, i, x, y);
    return value[1 + 2 * i] != was_x || value[2 + 2 * i] != was_y;
}

static bool keys(WrAdjust *adjust, WrHeightSpan span, double *value)
{
    const double step = (span.high - span.low) / 200.0;
    const int i = adjust->chosen - 1;
    if (i < 0 || i >= (int)*value) return false;
    const double dx =
        wr_gui_key_pressed(SDL_SCANCODE_RIGHT) - wr_gui_key_pressed(SDL_SCANCODE_LEFT);
    const double dy = wr_gui_key_pressed(SDL_SCANCODE_UP) - wr_gui_key_pressed(SDL_SCANCODE_DOWN);
    if (wr_gui_key_pressed(SDL_SCANCODE_DELETE) && take_away(value, i)) {
        adjust->chosen = 0;
        return true;
    }
    if (dx == 0.0 && dy == 0.0) return false;
    move(value, span, i, value[1 + 2 * i] + dx * step, value[2 + 2 * i] + dy * step);
    return true;
}

bool wr_curves_pad(WrApp *app)
{
    WrAdjust *adjust = app->adjust;
    const WrHeightCounts *h = wr_height_counts(app);
    double *value = adjust->param; /* its only parameter */
    WrPad pad = wr_gui_pad_begin("curve", 0, wr_gui_px(ROOM_UNITS));
    if (!adjust->held) adjust->held_span = span_of(h, value);
    const WrHeightSpan span = adjust->held_span;
    const double x = span.low + (span.high - span.low) * (pad.pointer_x - pad.x) / pad.w;
    const double y = span.high - (span.high - span.low) * (pad.pointer_y - pad.y) / pad.h;
    bool changed = false;
    if (pad.pressed) {
        int at = near(&pad, span, value);
        changed = at < 0;
        if (at < 0) at = add(value, rint(x * 1e4) / 1e4, rint(y * 1e4) / 1e4);
        adjust->held = adjust->chosen = at + 1;
    }
    if (pad.held && adjust->held) changed |= drag(adjust, &pad, value, x, y);
    if (!pad.held) adjust->held = 0;
    if (!pad.held) changed |= keys(adjust, span, value);
    wr_height_bars(&pad, span, h);
    draw(&pad, span, value, adjust->chosen - 1);
    wr_gui_pad_end();
    if (!pad.held)
        wr_gui_tip("What each height, from left to right, becomes, from bottom to top. Drag the "
                   "points; click for one more; drag one out, or press Delete, to take it away");
    return changed;
}
