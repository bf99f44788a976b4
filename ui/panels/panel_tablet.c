/* Tablet tester: devices, their events and faults, and their pressure curves. */
#include "ui/panels/panel_tablet.h"
#include "ui/state/app_state.h"
#include "ui/state/dialog.h"
#include "ui/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/input/pen.h"
#include "ui/input/pen_curve.h"

#include "base/array.h"
#include "base/memory.h"
#include "base/text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

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
    wr_gui_row_at(pad, 0);
    wr_gui_as_it_is(true);
    wr_gui_text_cut(WR_FONT_TEXT, d->there ? WR_COLOUR_STRONG : WR_COLOUR_LABEL, d->name,
                    wide - right - 2 * pad);
    wr_gui_as_it_is(false);
    wr_gui_row_at(wide - right, 0);
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
    WrEdit edit = wr_tester_curve(app, side, &c), by[3];
    wr_gui_same_line(16);
    wr_gui_group_begin();
    by[0] = number("Minimum: lighter touches count as none", 0, 1, false, 0,
                   "Raise it when the pen draws before it touches", &c.minimum);
    by[1] = number("Maximum: harder ones as full", 0, 1, false, 1,
                   "Lower it when full pressure needs too much force", &c.maximum);
    by[2] = number("Gain", 0.1, 10, true, 1, "Times the curve, at most 1", &c.gain);
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
    wr_tester_follow(app);
    if (!wr_gui_dialog_begin("Tablet tester", 720)) return;
    double tall = app->height - wr_gui_px(470), high = wr_gui_px(230), low = wr_gui_px(120);
    tall = tall > high ? high : tall < low ? low : tall;
    devices(app);
    if (wr_pen_device_count(app->pen) > 0) {
        diagnosis(app);
        wr_gui_space(2);
        wr_tester_scribble(app, wr_gui_available() - wr_gui_px(276), tall);
        wr_gui_same_line(12);
        wr_tester_live(app, 0, tall);
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
