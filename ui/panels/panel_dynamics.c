#include "ui/panels/panel_dynamics.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/messages.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/panels/points_pad.h"
#include "ui/canvas/tools/preset_browser.h"
#include "ui/canvas/tools/preset_overrides.h"

#include "base/array.h"
#include "base/memory.h"
#include "base/text.h"
#include "brush/preset.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define PAD_UNITS 210
#define NAME_SIZE 96
#define MARK "\xe2\x80\xa2 " /* prefix of settings with a curve */
#define CHOICES 64           /* upper limit of settings and inputs */

struct WrDynamics {
    int setting, input; /* libmypaint's numbers */
    WrPointsState hand;
    /* points of the current curve, in the form of wr_points_move */
    double value[1 + 2 * WR_PRESET_POINTS];
    /* the pad spans -reach..reach; 0: derived from the points */
    double reach;
    WR_ARRAY(char *) before; /* for undo: the preset's changes before each edit */
};

static void forget_steps(WrDynamics *d)
{
    for (int i = 0; i < d->before.count; i++) wr_free(d->before.data[i]);
    d->before.count = 0;
}

void wr_dynamics_free(WrApp *app)
{
    if (!app->dynamics) return;
    forget_steps(app->dynamics);
    wr_array_free(&app->dynamics->before);
    wr_free(app->dynamics);
    app->dynamics = NULL;
}

static bool is_shown(int setting)
{
    return wr_preset_setting(setting)->use != WR_SETTING_IGNORED;
}

void wr_dialog_dynamics_open(WrApp *app, int setting)
{
    if (!app->shelf->preset) {
        wr_app_say(app, "The round brush has no curves: choose a preset. The pen's pressure curve "
                        "is in the tablet tester");
        return;
    }
    if (!app->dynamics) {
        app->dynamics = wr_alloc(1, sizeof *app->dynamics);
        app->dynamics->setting = wr_preset_setting_find("opaque_multiply");
    }
    WrDynamics *d = app->dynamics;
    if (setting >= 0 && setting != d->setting) {
        d->setting = setting;
        d->input = 0;
        for (int i = wr_preset_input_count() - 1; i >= 0; i--) {
            const float(*points)[2];
            if (wr_preset_curve(app->shelf->tuned, setting, i, &points) > 0) d->input = i;
        }
    }
    d->hand = (WrPointsState){ 0 };
    d->reach = 0.0;
    forget_steps(d);
    wr_dialog_open(app, WR_DIALOG_DYNAMICS);
}

/* ---- changes of the preset ---- */

static void name_of(const WrDynamics *d, char name[NAME_SIZE])
{
    snprintf(name, NAME_SIZE, "%s:%s", wr_preset_setting(d->setting)->name,
             wr_preset_input(d->input)->name);
}

static void keep_step(const WrApp *app)
{
    const char *set = app->brush_files->set;
    wr_array_push(&app->dynamics->before, wr_strdup(set ? set : ""));
}

static void take_back(WrApp *app)
{
    WrDynamics *d = app->dynamics;
    if (d->before.count == 0) return;
    char *set = d->before.data[--d->before.count];
    d->hand = (WrPointsState){ 0 };
    wr_preset_browser_tune_all(app, set);
    wr_free(set);
}

/* text NULL: restore the preset's own curve. */
static void put(WrApp *app, const char *text)
{
    char name[NAME_SIZE];
    WrText set = { 0 };
    name_of(app->dynamics, name);
    wr_tuning_put_text(app->brush_files->set, name, text, &set);
    wr_preset_browser_tune_all(app, wr_text_get(&set));
    wr_text_fini(&set);
}

static void put_points(WrApp *app)
{
    const double *value = app->dynamics->value;
    WrText text = { 0 };
    for (int i = 1; i <= 2 * (int)*value; i++) {
        char number[WR_NUMBER_SIZE];
        if (i > 1) wr_text_add(&text, i % 2 ? "|" : ",");
        wr_text_add(&text, wr_number_print_float((float)value[i], number));
    }
    put(app, wr_text_get(&text));
    wr_text_fini(&text);
}

/* ---- the curve ---- */

/* Without a curve: a flat line at 0, which has no effect. */
static void take_points(const WrApp *app)
{
    WrDynamics *d = app->dynamics;
    const float(*points)[2] = NULL;
    const WrInputInfo *input = wr_preset_input(d->input);
    const int count = wr_preset_curve(app->shelf->tuned, d->setting, d->input, &points);
    d->value[0] = count > 0 ? count : 2;
    d->value[1] = input->low;
    d->value[3] = input->high;
    d->value[2] = d->value[4] = 0.0;
    for (int i = 0; i < count; i++)
        for (int k = 0; k < 2; k++) d->value[1 + 2 * i + k] = (double)points[i][k];
}

static WrPointsSpan span_of(const WrDynamics *d)
{
    const WrInputInfo *input = wr_preset_input(d->input);
    const double most = wr_preset_reach(d->setting);
    WrPointsSpan span = { input->low, input->high, 0, most / 4.0 };
    for (int i = 0; i < (int)d->value[0]; i++) {
        span.left = fmin(span.left, d->value[1 + 2 * i]);
        span.right = fmax(span.right, d->value[1 + 2 * i]);
        span.high = fmax(span.high, 1.1 * fabs(d->value[2 + 2 * i]));
    }
    if (d->reach > 0.0) span.high = d->reach;
    span.high = fmin(span.high, most);
    span.low = -span.high;
    return span;
}

/* Evaluation as in libmypaint: linear between points, extrapolated linearly beyond. */
static bool at(const void *ctx, double x, double *y)
{
    const double *value = ctx, *p = value + 1;
    const int count = (int)*value;
    int i = 1;
    while (i < count - 1 && x > p[2 * i]) i++;
    const double x0 = p[2 * i - 2], y0 = p[2 * i - 1], x1 = p[2 * i], y1 = p[2 * i + 1];
    *y = x0 == x1 || y0 == y1 ? y0 : (y1 * (x - x0) + y0 * (x1 - x)) / (x1 - x0);
    return true;
}

static void grid(const WrPad *pad, const WrPointsSpan *span)
{
    char text[WR_NUMBER_SIZE];
    const double line = wr_gui_line_height(WR_FONT_SMALL), gap = wr_gui_px(4);
    for (int i = 1; i < 4; i++) {
        wr_gui_draw_fill(floor(pad->x + pad->w * i / 4), pad->y, 1, pad->h, WR_COLOUR_GRID, 0);
        wr_gui_draw_fill(pad->x, floor(pad->y + pad->h * i / 4), pad->w, 1,
                         i == 2 ? WR_COLOUR_LABEL : WR_COLOUR_GRID, 0);
    }
    wr_words_print(text, sizeof text, "%+.3g", span->high);
    wr_gui_draw_text(pad->x + gap, pad->y + gap, WR_FONT_SMALL, WR_COLOUR_LABEL, text);
    wr_words_print(text, sizeof text, "%+.3g", span->low);
    wr_gui_draw_text(pad->x + gap, pad->y + pad->h - line - gap, WR_FONT_SMALL, WR_COLOUR_LABEL,
                     text);
    wr_words_print(text, sizeof text, "%.3g", span->right);
    wr_gui_draw_text(pad->x + pad->w - gap - wr_gui_text_width(WR_FONT_SMALL, text),
                     pad->y + pad->h / 2 + gap, WR_FONT_SMALL, WR_COLOUR_LABEL, text);
    wr_words_print(text, sizeof text, "%.3g", span->left);
    wr_gui_draw_text(pad->x + gap, pad->y + pad->h / 2 + gap, WR_FONT_SMALL, WR_COLOUR_LABEL, text);
}

static void curve(WrApp *app)
{
    static const WrPointsRules rules = { .least = 2, .most = WR_PRESET_POINTS, .inside = true };
    WrDynamics *d = app->dynamics;
    WrPad pad = wr_gui_pad_begin("curve", 0, wr_gui_px(PAD_UNITS));
    if (!d->hand.held) take_points(app);
    const WrPointsSpan span = span_of(d);
    if (pad.pressed) keep_step(app);
    const int steps = d->before.count;
    const bool changed = wr_points_move(&pad, &span, &rules, &d->hand, d->value);
    if (changed && !pad.held && !pad.released) keep_step(app); /* changed by a key */
    if (changed) put_points(app);
    if (pad.released && steps == d->before.count && steps > 0 &&
        strcmp(d->before.data[steps - 1], app->brush_files->set ? app->brush_files->set : "") == 0)
        wr_free(d->before.data[--d->before.count]); /* pressed without a change */
    grid(&pad, &d->hand.span);
    wr_points_draw(&pad, &d->hand, d->value, at, d->value);
    wr_gui_pad_end();
    if (!pad.held && !d->hand.chosen)
        wr_gui_tip("Horizontal: the input. Vertical: the amount added to the setting. Drag the "
                   "points; click to add one; drag one out, or press Delete, to remove it");
}

/* ---- choice of setting and input ---- */

/* A list with a mark before entries with a curve; changes the number of the chosen entry. */
typedef struct List {
    char text[CHOICES][80];
    const char *items[CHOICES];
    int number[CHOICES], count, chosen;
} List;

static void add(List *list, int number, const char *label, bool marked, int chosen)
{
    if (list->count == CHOICES) return;
    snprintf(list->text[list->count], sizeof list->text[0], "%s%.70s", marked ? MARK : "",
             wr_words(label));
    if (number == chosen) list->chosen = list->count;
    list->items[list->count] = list->text[list->count];
    list->number[list->count++] = number;
}

static bool choose(const char *id, List *list, int *number)
{
    wr_gui_as_it_is(true);
    const bool changed = wr_gui_choice(id, 0, list->items, list->count, &list->chosen);
    wr_gui_as_it_is(false);
    *number = list->number[list->chosen];
    return changed;
}

/* Label above its list, which needs the whole width. */
static void name(const char *label)
{
    wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, label);
    wr_gui_space(-4);
}

static void what(WrApp *app)
{
    WrDynamics *d = app->dynamics;
    const WrPreset *preset = app->shelf->tuned;
    const float(*points)[2];
    List settings = { .count = 0 }, inputs = { .count = 0 };
    for (int i = 0; i < wr_preset_setting_count(); i++)
        if (is_shown(i))
            add(&settings, i, wr_preset_setting(i)->label, !wr_preset_is_constant(preset, i),
                d->setting);
    for (int i = 0; i < wr_preset_input_count(); i++)
        add(&inputs, i, wr_preset_input(i)->label,
            wr_preset_curve(preset, d->setting, i, &points) > 0, d->input);
    name("Setting");
    bool other = choose("setting", &settings, &d->setting);
    wr_gui_tip(wr_preset_setting(d->setting)->meaning);
    name("Input");
    other |= choose("input", &inputs, &d->input);
    wr_gui_tip(wr_preset_input(d->input)->help);
    if (!other) return;
    d->hand = (WrPointsState){ 0 };
    d->reach = 0.0;
}

static void height_of_pad(WrDynamics *d)
{
    const WrPointsSpan now = span_of(d);
    WrNumber spec = { .low = wr_preset_reach(d->setting) / 64.0,
                      .high = wr_preset_reach(d->setting),
                      .reset = now.high,
                      .decimals = 2,
                      .logarithmic = true,
                      .tip = "Amount added at the upper edge and subtracted at the lower edge" };
    double reach = now.high;
    wr_gui_label("Up to");
    if (wr_gui_number("reach", 0, &spec, &reach) != WR_EDIT_NONE) d->reach = reach;
}

static void chips(WrApp *app)
{
    WrDynamics *d = app->dynamics;
    char name[NAME_SIZE];
    const float(*points)[2];
    name_of(d, name);
    const bool any = wr_preset_curve(app->shelf->tuned, d->setting, d->input, &points) > 0;
    if (d->before.count > 0) {
        if (wr_gui_chip(WR_ICON_BACK, "Take back")) take_back(app);
        wr_gui_tip("Undoes the last change of a curve");
        if (any) wr_gui_same_line(6);
    }
    if (any) {
        if (wr_gui_chip(WR_ICON_DELETE, "No curve")) {
            keep_step(app);
            put(app, "");
        }
        wr_gui_tip("Removes the effect of the input on the setting");
    }
    if (wr_tuning_has(app->brush_files->set, name)) {
        if (wr_gui_chip(NULL, "As the preset has it")) {
            keep_step(app);
            put(app, NULL);
        }
    } else {
        wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, "as the preset has it");
    }
}

bool wr_dynamics_undo_key(WrApp *app, const SDL_KeyboardEvent *event)
{
    if (app->dialog->now != WR_DIALOG_DYNAMICS || !app->dynamics) return false;
    const char *action = wr_keys_find(app->keys, event->keysym);
    if (!action || strcmp(action, WR_ACT(undo)) != 0) return false;
    take_back(app);
    return true;
}

void wr_dialog_dynamics(WrApp *app)
{
    if (!app->shelf->preset) {
        wr_dialog_close(app);
        return;
    }
    if (!wr_gui_dialog_begin_at("Curves of the brush", wr_dialog_side(app))) return;
    what(app);
    wr_gui_space(4);
    curve(app);
    wr_gui_space(4);
    height_of_pad(app->dynamics);
    wr_gui_space(4);
    chips(app);
    wr_gui_space(8);
    wr_dialog_close_button(app, "Close");
    wr_gui_dialog_end();
}
