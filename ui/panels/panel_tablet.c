/* Tablet tester: devices, their events and faults, and their pressure curves. */
#include "ui/panels/panel_tablet.h"
#include "ui/app/state/app_state.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/input/pen.h"
#include "ui/input/pen_curve.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/words.h"

#include "base/array.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/text.h"
#include "system/clock.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define MAX_POINTS 3000
#define POINT_STEP 1.5    /* pixels between points of the scribble */
#define RATE_SECONDS 0.5  /* interval of the event rate */
#define THICKEST 16.0     /* units, at full pressure */
#define ALIVE_SECONDS 1.5 /* redraw continues for this long after the last event */

/* ---- events ---- */

static void add_point(WrTester *t, const WrPenEvent *e)
{
    bool down = (e->held & 2u) != 0 && e->kind != WR_PEN_LOST;
    double x = e->x, y = e->y;
    bool inside =
        x >= t->pad_x && y >= t->pad_y && x < t->pad_x + t->pad_w && y < t->pad_y + t->pad_h;
    bool joined = t->drawing == e->device;
    if (!down || (!inside && !joined)) {
        if (joined) t->drawing = -1;
        return;
    }
    if (joined && t->points.count > 0) {
        const WrScribble *last = &t->points.data[t->points.count - 1];
        double dx = x - last->x, dy = y - last->y;
        if (dx * dx + dy * dy < POINT_STEP * POINT_STEP) return;
    }
    if (t->points.count >= MAX_POINTS) {
        int gone = MAX_POINTS / 3;
        t->points.count -= gone;
        memmove(t->points.data, t->points.data + gone,
                (size_t)t->points.count * sizeof *t->points.data);
        t->points.data[0].joined = false;
    }
    WrScribble point = { .x = x,
                         .y = y,
                         .pressure = e->pressure,
                         .joined = joined,
                         .eraser = e->eraser,
                         .finger = e->finger };
    wr_array_push(&t->points, point);
    t->drawing = e->device;
}

/* Handle the events since the last frame. */
static void tester_follow(WrApp *app)
{
    WrTester *t = app->tester;
    double now = wr_clock_seconds();
    int64_t total = wr_pen_total(app->pen);
    WrPenEvent event;
    for (; t->seen < total; t->seen++) {
        if (!wr_pen_event_at(app->pen, t->seen, &event)) continue;
        if (event.device != t->chosen && event.kind == WR_PEN_DOWN) t->chosen_own = false;
        if (!t->chosen_own) t->chosen = event.device;
        add_point(t, &event);
        t->newest_at = now;
    }
    if (now - t->counted_at >= RATE_SECONDS) {
        double passed = now - t->counted_at;
        t->rate = passed < 2.0 ? (double)(total - t->counted) / passed : 0.0;
        t->counted = total;
        t->counted_at = now;
    }
    if (now - t->newest_at < ALIVE_SECONDS) wr_app_redraw(app); /* until the rate is 0 again */
}

/* ---- the scribble ---- */

static WrColour ink_of(const WrScribble *point)
{
    return point->eraser ? WR_COLOUR_LOWER : point->finger ? WR_COLOUR_LABEL : WR_COLOUR_RAISE;
}

static void tester_scribble(WrApp *app, double width, double height)
{
    WrTester *t = app->tester;
    WrPad pad = wr_gui_pad_begin("scribble", width, height);
    t->pad_x = pad.x;
    t->pad_y = pad.y;
    t->pad_w = pad.w;
    t->pad_h = pad.h;
    for (int i = 0; i < t->points.count; i++) {
        const WrScribble *p = &t->points.data[i], *q = p->joined && i > 0 ? p - 1 : p;
        double thick = 1.0 + THICKEST * wr_gui_scale() * 0.5 * (p->pressure + q->pressure);
        if (q != p) wr_gui_draw_line(q->x, q->y, p->x, p->y, ink_of(p), thick);
        if (thick > 3.0 || q == p) wr_gui_draw_disc(p->x, p->y, 0.5 * thick, ink_of(p));
    }
    if (t->points.count == 0) {
        const char *hint = "Scribble here: harder is thicker";
        double w = wr_gui_text_width(WR_FONT_TEXT, hint), h = wr_gui_line_height(WR_FONT_TEXT);
        wr_gui_draw_text(floor(pad.x + (pad.w - w) / 2), floor(pad.y + (pad.h - h) / 2),
                         WR_FONT_TEXT, WR_COLOUR_OFF, hint);
    }
    wr_gui_pad_end();
}

/* ---- newest values ---- */

/* The newest event of the chosen device among the last few. */
static bool newest_of(const WrApp *app, WrPenEvent *event)
{
    int64_t total = wr_pen_total(app->pen);
    for (int64_t i = total - 1; i >= 0 && i > total - 256; i--)
        if (wr_pen_event_at(app->pen, i, event) && event->device == app->tester->chosen)
            return true;
    *event = (WrPenEvent){ .kind = WR_PEN_MOTION };
    return false;
}

typedef struct Lines { /* lines of text, from the top */
    double x, y, w, step;
} Lines;

static void put(Lines *at, const char *label, WrColour colour, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

static void put(Lines *at, const char *label, WrColour colour, const char *format, ...)
{
    char text[96];
    va_list args;
    va_start(args, format);
    wr_words_vprint(text, sizeof text, format, args);
    va_end(args);
    double w = wr_gui_text_width(WR_FONT_TEXT, text);
    wr_gui_draw_text(at->x, floor(at->y), WR_FONT_TEXT, WR_COLOUR_LABEL, label);
    wr_gui_draw_text(floor(at->x + at->w - w), floor(at->y), WR_FONT_TEXT, colour, text);
    at->y += at->step;
}

static void put_bar(Lines *at, const char *label, double value, WrColour colour)
{
    char text[32];
    double bar = wr_gui_px(8), from = at->x + wr_gui_px(70), to = at->x + at->w - wr_gui_px(50);
    double line = wr_gui_line_height(WR_FONT_TEXT), top = floor(at->y + (line - bar) / 2) + 1;
    wr_words_print(text, sizeof text, "%.3f", value);
    wr_gui_draw_text(at->x, floor(at->y), WR_FONT_TEXT, WR_COLOUR_LABEL, label);
    wr_gui_draw_fill(from, top, to - from, bar, WR_COLOUR_BUTTON, 0);
    wr_gui_draw_fill(from, top, (to - from) * value, bar, colour, 0);
    wr_gui_draw_text(floor(at->x + at->w - wr_gui_text_width(WR_FONT_TEXT, text)), floor(at->y),
                     WR_FONT_TEXT, WR_COLOUR_TEXT, text);
    at->y += at->step;
}

/* A disc with a needle in the direction of the tilt and a mark at the pen's turn, and the pen's three buttons. */
static void put_tilt(Lines *at, const WrPenDevice *d, const WrPenEvent *e)
{
    static const char *const names[] = { "tip", "2", "3" };
    double r = 1.55 * at->step, x = at->x + wr_gui_px(70) + r, y = at->y + r;
    wr_gui_draw_text(at->x, floor(at->y), WR_FONT_TEXT, WR_COLOUR_LABEL, "Tilt");
    wr_gui_draw_disc(x, y, r, WR_COLOUR_BUTTON);
    wr_gui_draw_circle(x, y, r, WR_COLOUR_GRAB, 1.0);
    if (d->has_tilt) {
        double tx = x + r * e->tilt_x, ty = y + r * e->tilt_y;
        wr_gui_draw_line(x, y, tx, ty, WR_COLOUR_ACCENT, wr_gui_px(2));
        wr_gui_draw_disc(tx, ty, wr_gui_px(4), WR_COLOUR_STRONG);
    }
    if (d->has_turn) {
        const double a = e->turn_deg / WR_DEG_PER_RAD, dx = sin(a), dy = -cos(a);
        wr_gui_draw_line(x + 0.75 * r * dx, y + 0.75 * r * dy, x + r * dx, y + r * dy,
                         WR_COLOUR_RAISE, wr_gui_px(3));
    }
    double bx = x + r + wr_gui_px(16), side = wr_gui_px(24);
    wr_gui_draw_text(bx, floor(at->y), WR_FONT_SMALL, WR_COLOUR_LABEL, "Buttons");
    for (int b = 1; b <= 3; b++) {
        bool down = (e->held & 1u << b) != 0;
        double left = bx + (b - 1) * (side + wr_gui_px(4)), top = at->y + at->step;
        double w = wr_gui_text_width(WR_FONT_SMALL, names[b - 1]);
        double h = wr_gui_line_height(WR_FONT_SMALL);
        wr_gui_draw_fill(left, top, side, side, down ? WR_COLOUR_ACCENT : WR_COLOUR_BUTTON, 3);
        wr_gui_draw_text(floor(left + (side - w) / 2), floor(top + (side - h) / 2), WR_FONT_SMALL,
                         down ? WR_COLOUR_STRONG : WR_COLOUR_LABEL, names[b - 1]);
    }
    at->y += 2.0 * r + wr_gui_px(8);
}

static void put_events(const WrApp *app, Lines *at, const WrPenDevice *d)
{
    put(at, "Events", WR_COLOUR_TEXT, "%lld,  %.0f a second", (long long)d->events,
        app->tester->rate);
}

/* Draw the newest values of the chosen device. */
static void tester_live(WrApp *app, double width, double height)
{
    const WrPenDevice *d = wr_pen_device(app->pen, app->tester->chosen);
    WrPenEvent e;
    WrPad pad = wr_gui_pad_begin("live", width, height);
    double gap = wr_gui_px(12), line = wr_gui_line_height(WR_FONT_TEXT);
    Lines at = { .x = pad.x + gap,
                 .y = pad.y + wr_gui_px(9),
                 .w = pad.w - 2 * gap,
                 .step = line + wr_gui_px(pad.h < wr_gui_px(200) ? 1 : 5) };
    bool any = newest_of(app, &e), low = height < wr_gui_px(200);
    if (d) {
        put_bar(&at, "Pressure", e.raw, WR_COLOUR_ACCENT);
        put_bar(&at, "By curve", e.pressure, WR_COLOUR_RAISE);
        if (low) put_events(app, &at, d);
        put_tilt(&at, d, &e);
        if (any) put(&at, "Place", WR_COLOUR_TEXT, "%.2f, %.2f", e.x, e.y);
        else put(&at, "Place", WR_COLOUR_TEXT, "-");
        if (!low) put_events(app, &at, d);
        put(&at, "Dropped, waiting", WR_COLOUR_TEXT, "0,  %d", wr_pen_waiting(app->pen));
        put(&at, "Bad values", d->bad_values ? WR_COLOUR_BAD : WR_COLOUR_TEXT, "%lld",
            (long long)d->bad_values);
    }
    wr_gui_pad_end();
}

/* ---- the curve ---- */

static const WrPointsRules rules = {
    .least = 2, .most = WR_PEN_POINTS, .inside = true, .ends = true, .reach = 20
};

static double within(double x, double low, double high)
{
    return x < low ? low : x > high ? high : x;
}

/* Points in the pad's form: pressures of the device and of the brush. */
static void to_pad(const WrPenCurve *c, double value[1 + 2 * WR_PEN_POINTS])
{
    value[0] = c->count;
    for (int i = 0; i < c->count; i++) {
        value[1 + 2 * i] = c->minimum + c->x[i] * (c->maximum - c->minimum);
        value[2 + 2 * i] = c->y[i] * c->gain;
    }
}

/* moved: index of the dragged point, which stays between its neighbours; -1: none. False if the result is not a valid
 * curve. */
static bool from_pad(const double *value, int moved, WrPenCurve *c)
{
    WrPenCurve made = { .minimum = c->minimum, .maximum = c->maximum, .gain = c->gain };
    made.count = (int)value[0];
    for (int i = 0; i < made.count; i++) {
        made.x[i] = within((value[1 + 2 * i] - c->minimum) / (c->maximum - c->minimum), 0.0, 1.0);
        made.y[i] = within(value[2 + 2 * i] / c->gain, 0.0, 1.0);
    }
    if (moved >= 0 && moved < made.count)
        made.y[moved] = within(made.y[moved], moved > 0 ? made.y[moved - 1] : 0.0,
                               moved + 1 < made.count ? made.y[moved + 1] : 1.0);
    const bool valid = wr_pen_curve_valid(&made);
    if (valid) *c = made;
    return valid;
}

static bool curve_at(const void *ctx, double raw, double *out)
{
    *out = wr_pen_curve_apply(ctx, raw);
    return true;
}

static void grid(const WrApp *app, const WrPad *pad)
{
    WrPenEvent e;
    for (int i = 1; i < 4; i++) {
        wr_gui_draw_fill(floor(pad->x + pad->w * i / 4), pad->y, 1, pad->h, WR_COLOUR_GRID, 0);
        wr_gui_draw_fill(pad->x, floor(pad->y + pad->h * i / 4), pad->w, 1, WR_COLOUR_GRID, 0);
    }
    if (newest_of(app, &e) && e.raw > 0.0)
        wr_gui_draw_fill(floor(pad->x + e.raw * pad->w), pad->y, 1, pad->h, 0xff6a6a6au, 0);
}

/* Editor of the pressure curve, from the device's pressure (horizontal) to the brush's (vertical). */
static WrEdit tester_curve(WrApp *app, double side, WrPenCurve *curve)
{
    static const WrPointsSpan span = { 0.0, 1.0, 0.0, 1.0 };
    WrPointsState *hand = &app->tester->grip;
    double value[1 + 2 * WR_PEN_POINTS];
    WrPad pad = wr_gui_pad_begin("curve", side, side);
    to_pad(curve, value);
    bool changed = wr_points_move(&pad, &span, &rules, hand, value);
    changed = changed && from_pad(value, hand->chosen - 1, curve);
    to_pad(curve, value);
    grid(app, &pad);
    wr_points_draw(&pad, hand, value, curve_at, curve);
    wr_gui_pad_end();
    if (!pad.held && !hand->chosen)
        wr_gui_tip("Pressure curve. Drag the points; click to add one; drag one out, or press "
                   "Delete, to remove it");
    if (pad.released || (changed && !pad.held)) return WR_EDIT_DONE;
    return changed ? WR_EDIT_LIVE : WR_EDIT_NONE;
}

/* ---- curves are stored in the settings as lines "CURVE NAME" ---- */

void wr_tablet_start(WrApp *app)
{
    for (int i = 0; i < WR_PENS_MAX && app->settings->pens[i]; i++) {
        const char *line = app->settings->pens[i], *name = wr_settings_pen_name(line);
        char numbers[WR_PEN_CURVE_TEXT];
        WrPenCurve curve;
        if (!name || (size_t)(name - line) > sizeof numbers) continue;
        memcpy(numbers, line, (size_t)(name - line));
        numbers[name - line - 1] = '\0';
        if (wr_pen_curve_parse(numbers, &curve)) wr_pen_keep_curve(app->pen, name, &curve);
    }
}

static void keep(WrApp *app, const char *name, const WrPenCurve *curve)
{
    char numbers[WR_PEN_CURVE_TEXT];
    wr_pen_curve_print(curve, numbers, sizeof numbers);
    WrText line = { 0 };
    wr_text_addf(&line, "%s %s", numbers, name);
    wr_settings_keep_pen(app->settings, wr_text_get(&line));
    wr_text_fini(&line);
}

/* ---- creation ---- */

void wr_dialog_tablet_open(WrApp *app)
{
    if (!app->tester) app->tester = wr_alloc(1, sizeof *app->tester);
    WrTester *t = app->tester;
    wr_array_free(&t->points);
    *t = (WrTester){ .seen = wr_pen_total(app->pen), .drawing = -1 };
    t->counted = t->seen;
    WrPenEvent newest;
    if (wr_pen_newest(app->pen, &newest)) t->chosen = newest.device;
    wr_dialog_open(app, WR_DIALOG_TABLET);
}

void wr_tablet_free(WrApp *app)
{
    if (!app->tester) return;
    wr_array_free(&app->tester->points);
    wr_free(app->tester);
    app->tester = NULL;
}

/* ---- devices ---- */

static const char *kind_of(const WrPenDevice *d)
{
    return !d->there ? "not there" : d->eraser ? "eraser" : d->finger ? "fingers" : "pen";
}

static void device_row(WrApp *app, int index)
{
    WrTester *t = app->tester;
    const WrPenDevice *d = wr_pen_device(app->pen, index);
    char what[128];
    snprintf(what, sizeof what, "%s%s%s", kind_of(d),
             d->there && d->has_pressure ? ", pressure" : "",
             d->there && d->has_tilt ? ", tilt" : "");
    WrRow row = wr_gui_row_begin(index, 26, index == t->chosen);
    double pad = wr_gui_px(12), wide = wr_gui_row_width(), right = wr_gui_px(180);
    wr_gui_row_set_cursor(pad, 0);
    wr_gui_as_it_is(true);
    wr_gui_text_cut(WR_FONT_TEXT, d->there ? WR_COLOUR_STRONG : WR_COLOUR_LABEL, d->name,
                    wide - right - 2 * pad);
    wr_gui_as_it_is(false);
    wr_gui_row_set_cursor(wide - right, 0);
    wr_gui_text_cut(WR_FONT_SMALL, WR_COLOUR_LABEL, what, right - pad);
    wr_gui_row_end();
    if (!row.clicked) return;
    t->chosen = index;
    t->chosen_own = true;
}

static void devices(WrApp *app)
{
    int count = wr_pen_device_count(app->pen);
    const char *none = wr_pen_diagnosis(app->pen, -1);
    if (none[0]) wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_TEXT, none);
    if (app->display_word) wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL, app->display_word);
    if (count == 0) return;
    wr_gui_list_begin("devices", wr_gui_px(26.0 * (count < 4 ? count : 4) + 14));
    wr_gui_space(-6);
    for (int i = 0; i < count; i++) device_row(app, i);
    wr_gui_list_end();
}

static void diagnosis(WrApp *app)
{
    const char *words = wr_pen_diagnosis(app->pen, app->tester->chosen);
    const WrPenDevice *d = wr_pen_device(app->pen, app->tester->chosen);
    if (!d) return;
    bool well = words[0] == '\0';
    if (well) words = "All is well with it.";
    /* Always two lines high, so that nothing below moves under the pen. */
    bool one = wr_gui_text_width(WR_FONT_TEXT, words) < wr_gui_available();
    wr_gui_text_wrapped(WR_FONT_TEXT, well ? WR_COLOUR_LABEL : WR_COLOUR_CELL, words);
    if (one) wr_gui_space(wr_gui_line_height(WR_FONT_TEXT) / wr_gui_scale());
}

/* ---- the curve ---- */

static WrEdit number(const char *label, double low, double high, bool logarithmic, double reset,
                     const char *tip, double *value)
{
    WrNumber spec = { .low = low,
                      .high = high,
                      .reset = reset,
                      .decimals = 2,
                      .logarithmic = logarithmic,
                      .tip = tip };
    wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, label);
    wr_gui_space(-4);
    return wr_gui_number(label, 0, &spec, value);
}

static void curve_row(WrApp *app, double side)
{
    const WrPenDevice *d = wr_pen_device(app->pen, app->tester->chosen);
    if (!d) return;
    WrPenCurve c = d->curve;
    WrEdit edit = tester_curve(app, side, &c), by[3];
    wr_gui_same_line(16);
    wr_gui_group_begin();
    by[0] = number("Minimum: lighter touches are ignored", 0, 1, false, 0,
                   "Raise it if the pen draws before it touches", &c.minimum);
    by[1] = number("Maximum: harder touches count as full pressure", 0, 1, false, 1,
                   "Lower it if full pressure needs too much force", &c.maximum);
    by[2] =
        number("Gain", 0.1, 10, true, 1, "Factor of the curve; the result is at most 1", &c.gain);
    wr_gui_space(2);
    if (wr_gui_button("Straight line", false)) {
        c = wr_pen_curve_default();
        edit = WR_EDIT_DONE;
    }
    wr_gui_group_end();
    for (int i = 0; i < 3; i++)
        if (by[i] != WR_EDIT_NONE) edit = by[i];
    if (edit == WR_EDIT_NONE) return;
    if (c.minimum > 0.98) c.minimum = 0.98;
    if (c.maximum < c.minimum + 0.02) c.maximum = c.minimum + 0.02;
    wr_pen_set_curve(app->pen, app->tester->chosen, &c);
    if (edit == WR_EDIT_DONE) keep(app, d->name, &c);
}

/* ---- the dialog ---- */

void wr_dialog_tablet(WrApp *app)
{
    WrTester *t = app->tester;
    tester_follow(app);
    if (!wr_gui_dialog_begin("Tablet tester", 720)) return;
    double tall = app->height - wr_gui_px(470), high = wr_gui_px(230), low = wr_gui_px(120);
    tall = tall > high ? high : tall < low ? low : tall;
    devices(app);
    if (wr_pen_device_count(app->pen) > 0) {
        diagnosis(app);
        wr_gui_space(2);
        tester_scribble(app, wr_gui_available() - wr_gui_px(276), tall);
        wr_gui_same_line(12);
        tester_live(app, 0, tall);
        wr_gui_space(2);
        curve_row(app, wr_gui_px(168));
    }
    wr_gui_space(8);
    bool leave = wr_gui_button("Close", true);
    if (t->points.count > 0) {
        wr_gui_same_line(8);
        if (wr_gui_button("Clear", false)) t->points.count = 0;
    }
    if (!app->dialog->fresh && (wr_gui_escape_pressed() || wr_gui_return_pressed())) leave = true;
    if (leave) wr_dialog_close(app);
    wr_gui_dialog_end();
}
