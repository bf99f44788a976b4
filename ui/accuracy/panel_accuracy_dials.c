/* Dials of the scene or of the compared side, built from their table; and the tolerance, which sets them by
   measurement. */
#include "ui/accuracy/accuracy.h"
#include "ui/state/action.h"
#include "ui/state/action_list.h"
#include "ui/state/busy.h"
#include "ui/state/app_state.h"
#include "ui/state/line.h"
#include "ui/state/scene_line.h"
#include "ui/state/session_view.h"
#include "ui/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/preview/accuracy_choice.h"

#include "base/enum_rows.h"
#include "base/text.h"
#include "scene/dials.h"
#include "scene/scene.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>

#define CHOSEN_UNITS 120 /* height of the box with the chosen dials */

/* ---- tolerance ---- */

static void run_tolerance(WrApp *app, int kind, double value)
{
    WrText line = { 0 };
    wr_text_addf(&line, "tolerance %s", wr_tolerance_names[kind]);
    if (kind != WR_TOLERANCE_NONE) wr_text_add(&line, "=");
    if (kind != WR_TOLERANCE_NONE)
        wr_text_add_number(&line,
                           kind == WR_TOLERANCE_TIME ? wr_line_round(1e3 * value, 4) : value);
    if (kind == WR_TOLERANCE_TIME) wr_text_add(&line, "ms");
    wr_scene_run(app, &line);
}

static void tolerance_value(WrApp *app, const WrTolerance *t)
{
    const bool timed = t->kind == WR_TOLERANCE_TIME;
    WrNumber spec = { .low = timed ? 0.5 : 1e-4,
                      .high = timed ? 200 : 0.2,
                      .hard_low = timed ? 0.1 : 1e-9,
                      .hard_high = timed ? 3.6e6 : 1e6,
                      .reset = timed                         ? 8
                               : t->kind == WR_TOLERANCE_RMS ? 0.004
                                                             : 0.05,
                      .decimals = -1,
                      .unit = timed ? "ms" : NULL,
                      .logarithmic = true,
                      .tip = timed ? "A picture may take so long: the least error that it buys"
                                   : "Of linear intensity: the least time that keeps to it" };
    double value = timed ? 1e3 * t->value : t->value;
    wr_gui_label(timed ? "At most" : "Error up to");
    if (wr_gui_number("tolerance_value", 0, &spec, &value) == WR_EDIT_DONE)
        run_tolerance(app, (int)t->kind, timed ? 1e-3 * value : value);
}

static void tell_chosen(const WrApp *app, const WrChosen *c)
{
    if (!c->any) {
        wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL,
                            app->settings->turning ? "Chosen when the patch rests."
                                                   : "Choosing ...");
        return;
    }
    wr_gui_text_wrapped(WR_FONT_SMALL, c->met ? WR_COLOUR_TEXT : WR_COLOUR_CELL, c->reason);
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL, c->lines);
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL,
                        c->kept ? "Kept with the document for this very view: nothing was chosen."
                                : "Chosen for this view; saved with the document.");
}

/* The result of a tolerance, in a box of constant height, so that the rows below stay in place. */
static void chosen(WrApp *app)
{
    const WrChosen *c = &app->accuracy->full_times.chosen;
    wr_gui_list_begin("chosen", wr_gui_px(CHOSEN_UNITS));
    tell_chosen(app, c);
    wr_gui_list_end();
    wr_gui_disable(!c->any);
    if (wr_gui_button("Keep these dials", false)) wr_accuracy_keep(app);
    wr_gui_enable();
    wr_gui_tip("The finest of the chosen dials become the scene's own setting, for the whole "
               "picture, and the tolerance is switched off");
}

void wr_panel_accuracy_tolerance(WrApp *app)
{
    WR_ROWS(fresh);
    static const struct {
        const char *name;
        double value; /* initial value */
    } fresh[WR_TOLERANCE_COUNT] = {
        [WR_ROW(WR_TOLERANCE_NONE)] = { "Off", 0 },
        [WR_ROW(WR_TOLERANCE_RMS)] = { "RMS", 0.004 },
        [WR_ROW(WR_TOLERANCE_MAX)] = { "Max", 0.05 },
        [WR_ROW(WR_TOLERANCE_TIME)] = { "Time", 0.008 },
    };
    WR_ROWS_END(fresh, WR_TOLERANCE_COUNT);
    const char *names[WR_TOLERANCE_COUNT];
    for (int i = 0; i < WR_TOLERANCE_COUNT; i++) names[i] = fresh[i].name;
    const WrTolerance t = wr_app_scene(app)->tolerance;
    int kind = (int)t.kind;
    wr_gui_space(2);
    wr_gui_heading("TOLERANCE");
    if (wr_gui_segments("tolerance", names, NULL, WR_TOLERANCE_COUNT, &kind))
        run_tolerance(app, kind, fresh[kind].value);
    wr_gui_tip("The cheapest dials that keep to an error, or the nearest that a time allows, found "
               "by measuring "
               "samples of this very picture");
    if (t.kind == WR_TOLERANCE_NONE || kind == WR_TOLERANCE_NONE) return;
    tolerance_value(app, &t);
    chosen(app);
}

/* ---- dials ---- */

static void choose(WrApp *app, int side, int id)
{
    const WrDial *dial = &wr_dials[id];
    const char *names[32];
    int count = 0, index = (int)wr_accuracy_dial(app, side, id);
    for (; count < dial->choices && count < 32; count++) names[count] = dial->choice(count);
    if (wr_gui_choice(dial->name, 0, names, count, &index))
        wr_accuracy_set_dial(app, side, id, index);
}

/* A slider over the useful values; typing allows the whole range. */
static void number(WrApp *app, int side, int id, double reset)
{
    const WrDial *dial = &wr_dials[id];
    double value = wr_accuracy_dial(app, side, id), low = dial->low, high = dial->low;
    for (int i = 0; dial->rungs && !isnan(dial->rungs[i]); i++) high = fmax(high, dial->rungs[i]);
    if (!(high > low)) high = dial->high;
    WrNumber spec = { .low = low,
                      .high = high,
                      .hard_low = dial->low,
                      .hard_high = dial->high,
                      .reset = reset,
                      .decimals = dial->whole ? 0 : -1 };
    WrEdit edit = wr_gui_number(dial->name, 0, &spec, &value);
    if (dial->whole) value = rint(value);
    if (edit == WR_EDIT_LIVE && side == 0) dial->set(wr_app_live(app), value);
    else if (edit != WR_EDIT_NONE) wr_accuracy_set_dial(app, side, id, value);
}

static bool set_by_tolerance(const WrApp *app, int side, const WrDial *dial)
{
    return side == 0 && wr_app_scene(app)->tolerance.kind != WR_TOLERANCE_NONE &&
           (dial->axis == WR_AXIS_DERIVATIVE || dial->axis == WR_AXIS_NORMAL ||
            dial->axis == WR_AXIS_ANTIALIASING);
}

static void axis_dials(WrApp *app, int side, WrAxis axis, const WrScene *scene,
                       const WrScene *plain)
{
    for (int d = 0; d < WR_DIAL_COUNT; d++) {
        const WrDial *dial = &wr_dials[d];
        char tip[256];
        if (dial->axis != axis) continue;
        const bool matters = !dial->matters || dial->matters(scene);
        const bool chooses = set_by_tolerance(app, side, dial);
        wr_gui_disable(!matters || chooses);
        wr_gui_label(dial->label);
        if (dial->choices > 0) choose(app, side, d);
        else number(app, side, d, dial->get(plain));
        wr_gui_enable();
        snprintf(tip, sizeof tip, "%s=: %s%s", dial->name, wr_words(dial->help),
                 chooses    ? wr_words(". The tolerance sets it.")
                 : !matters ? wr_words(". As the other dials stand it changes nothing.")
                            : "");
        wr_gui_tip(tip);
    }
}

static void which_side(WrApp *app)
{
    static const char *const sides[] = { "A: the scene", "B: to compare" };
    WrAccuracy *a = app->accuracy;
    wr_gui_segments("side", sides, NULL, 2, &a->chooses);
    wr_gui_tip("The setting that the rows below, and a click in the plot, change");
    if (a->chooses == 0) return;
    if (wr_gui_chip(NULL, "Take A's")) wr_action_run(app, WR_ACT(compare_take));
    wr_gui_tip("B gets the dials that the scene has now");
    wr_gui_same_line(6);
    if (wr_gui_chip(NULL, "Swap A and B")) wr_action_run(app, WR_ACT(compare_swap));
    wr_gui_tip("The scene gets B's dials, B the scene's");
}

void wr_panel_accuracy_dials(WrApp *app)
{
    wr_gui_heading("DIALS");
    which_side(app);
    const int side = app->accuracy->chooses;
    if (side == 0) {
        wr_busy_hold(app);
        wr_panel_accuracy_tolerance(app);
    }
    WrScene *scene = wr_accuracy_scene(app, side), *plain = wr_scene_new();
    for (int axis = 0; axis < WR_AXIS_COUNT; axis++) {
        char heading[48];
        int i = 0;
        for (; wr_axis_labels[axis][i] && i < 47; i++)
            heading[i] = (char)toupper((unsigned char)wr_axis_labels[axis][i]);
        heading[i] = '\0';
        wr_gui_space(2);
        wr_gui_push_id(axis + 100 * side);
        wr_gui_heading(heading);
        axis_dials(app, side, (WrAxis)axis, scene, plain);
        wr_gui_pop_id();
    }
    if (side == 0) wr_busy_hold_end();
    wr_scene_free(plain);
    wr_scene_free(scene);
}
