/* The dialog of a table operation, made from its row: canvas and patch show what it would do, on a
   snapshot, and only Apply runs the command. */
#include "ui/panels/panel_adjust.h"
#include "ui/desk/busy.h"
#include "ui/desk/desk.h"
#include "ui/desk/dialog.h"
#include "ui/desk/line.h"
#include "ui/desk/messages.h"
#include "ui/desk/session_view.h"
#include "ui/gui/gui.h"
#include "ui/gui/words.h"
#include "ui/gui/theme.h"
#include "ui/jobs/trial.h"

#include "base/error.h"
#include "base/text.h"
#include "command/session.h"
#include "document/document.h"
#include "field/field.h"
#include "field/ops.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const char prefix[] = "adjust_";

const WrOpInfo *wr_action_op(const char *name)
{
    size_t length = sizeof prefix - 1;
    return strncmp(name, prefix, length) == 0 ? wr_op_find(name + length) : NULL;
}

static void ask(WrApp *app)
{
    WrTrialAsk trial = { .op = app->adjust->op, .all_layers = app->adjust->layers == 1 };
    memcpy(trial.param, app->adjust->param, sizeof trial.param);
    app->adjust->asked_at = wr_session_revision(app->session);
    wr_app_try(app, &trial);
}

static bool is_named(const WrOpParam *param, const char *name)
{
    return strcmp(param->name, name) == 0;
}

/* Sizes begin with the table's. */
static double beginning(const WrApp *app, const WrOpParam *param)
{
    const WrField *field = wr_app_field(app);
    if (is_named(param, "width")) return wr_field_width(field);
    if (is_named(param, "height")) return wr_field_height(field);
    return param->fallback;
}

void wr_dialog_adjust_open(WrApp *app, const WrOpInfo *op)
{
    wr_dialog_open(app, WR_DIALOG_ADJUST);
    app->adjust->op = op;
    app->adjust->view = *app->view;
    app->adjust->layers = 0;
    for (int i = 0; i < wr_op_param_count(op); i++)
        app->adjust->param[i] = beginning(app, &op->params[i]);
    ask(app);
}

/* ---- parameters ---- */

/* What a slider spans: never more texels than there are. */
static WrNumber spec_of(const WrApp *app, const WrOpParam *param)
{
    const WrField *field = wr_app_field(app);
    double w = wr_field_width(field), h = wr_field_height(field), most = w > h ? w : h;
    WrNumber spec = { .low = param->soft_low,
                      .high = param->soft_high,
                      .hard_low = param->low,
                      .hard_high = param->high,
                      .reset = param->fallback,
                      .decimals = param->whole ? 0 : 3,
                      .unit =
                          strlen(param->unit) > 0 && strlen(param->unit) < 8 ? param->unit : NULL,
                      .tip = param->help };
    if (param->high >= WR_FIELD_MAX - 1 && param->whole) {
        spec.high = is_named(param, "du") || is_named(param, "x")   ? w
                    : is_named(param, "dv") || is_named(param, "y") ? h
                                                                    : fmax(64.0, 2.0 * most);
        spec.low = param->low < 0.0 ? -spec.high : param->low;
    }
    if (!(spec.low < spec.high)) spec.high = spec.low + 1.0;
    return spec;
}

static bool choice(const WrOpParam *param, double *value)
{
    const char *words[16];
    int count = 0, index = (int)*value;
    while (count < 16 && param->choices[count]) {
        words[count] = param->choices[count];
        count++;
    }
    bool changed = wr_gui_choice(param->name, 0, words, count, &index);
    wr_gui_tip(param->help);
    *value = index;
    return changed;
}

static bool parameters(WrApp *app)
{
    const WrOpInfo *op = app->adjust->op;
    bool changed = false;
    for (int i = 0; i < wr_op_param_count(op); i++) {
        const WrOpParam *param = &op->params[i];
        wr_gui_label(param->label);
        if (param->choices) {
            changed |= choice(param, &app->adjust->param[i]);
            continue;
        }
        WrNumber spec = spec_of(app, param);
        changed |= wr_gui_number(param->name, 0, &spec, &app->adjust->param[i]) != WR_EDIT_NONE;
    }
    return changed;
}

/* Of Offset: so that the seams come to lie in the middle. */
static bool half_cell(WrApp *app)
{
    const WrField *field = wr_app_field(app);
    if (strcmp(app->adjust->op->name, "offset") != 0) return false;
    wr_gui_label("");
    if (!wr_gui_chip(NULL, "Half a cell")) return false;
    app->adjust->param[0] = wr_field_width(field) / 2;
    app->adjust->param[1] = wr_field_height(field) / 2;
    return true;
}

static bool which_layers(WrApp *app)
{
    static const char *const names[] = { "The active one", "All" };
    if (app->adjust->op->reshapes || wr_app_document(app)->layer_count == 1) return false;
    wr_gui_label("Layers");
    return wr_gui_choice("layers", 0, names, 2, &app->adjust->layers);
}

/* ---- done ---- */

static void line_of(const WrApp *app, WrText *line)
{
    const WrOpInfo *op = app->adjust->op;
    wr_text_addf(line, "adjust %s", op->name);
    for (int i = 0; i < wr_op_param_count(op); i++) {
        const WrOpParam *param = &op->params[i];
        double value = app->adjust->param[i];
        if (param->choices) wr_text_addf(line, " %s=%s", param->name, param->choices[(int)value]);
        else wr_line_number(line, param->name, value);
    }
    if (app->adjust->layers == 1 && !op->reshapes) wr_text_add(line, " layers=all");
}

static void commit(WrApp *app)
{
    WrText line = { 0 };
    line_of(app, &line);
    bool same = app->adjust->asked_at == wr_session_revision(app->session);
    if (same) wr_app_run_tried(app, wr_text_get(&line));
    else wr_app_run_slow(app, wr_text_get(&line));
    wr_text_fini(&line);
}

/* As it was, the place of the view included. */
static void cancel(WrApp *app)
{
    wr_app_try_end(app);
    *app->view = app->adjust->view;
    wr_app_redraw(app);
}

static void expectation(const WrApp *app)
{
    WrText line = { 0 };
    line_of(app, &line);
    wr_panel_estimate(app, wr_text_get(&line));
    wr_text_fini(&line);
}

/* A row below the buttons, which stay where they are. */
static void progress(WrApp *app)
{
    double fraction, seconds;
    bool shown = wr_trial_busy(app->trial, &fraction, &seconds) && seconds > 0.2;
    if (!shown) return;
    wr_gui_progress(wr_gui_available() - wr_gui_px(64), fraction);
    wr_gui_same_line(8);
    if (wr_gui_chip(NULL, "Stop")) wr_trial_stop(app->trial);
}

void wr_dialog_adjust(WrApp *app)
{
    const WrOpInfo *op = app->adjust->op;
    char title[64], help[200];
    WrError err;
    snprintf(title, sizeof title, "%.40s###adjust", wr_words(op->label));
    if (!wr_gui_dialog_begin_at(title, wr_dialog_side(app))) return;
    snprintf(help, sizeof help, "%.190s.", wr_words(op->help));
    if (help[0] >= 'a' && help[0] <= 'z') help[0] = (char)(help[0] - 'a' + 'A');
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL, help);
    wr_gui_space(4);
    bool changed = strcmp(op->name, "levels") == 0 && wr_levels_pad(app);
    changed |= parameters(app);
    changed |= half_cell(app);
    changed |= which_layers(app);
    if (wr_app_document(app)->selection)
        wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL,
                            op->reshapes ? "The whole table changes, selected or not."
                                         : "Only what is selected changes.");
    if (changed) ask(app);
    if (wr_trial_error(app->trial, &err)) wr_app_fail(app, &err);
    int answer = wr_dialog_buttons(app, "Apply", true);
    if (answer == 0) expectation(app);
    progress(app);
    if (answer > 0) commit(app);
    if (answer < 0) cancel(app);
    if (answer != 0) app->adjust->op = NULL;
    wr_gui_dialog_end();
}

bool wr_adjust_by_name(WrApp *app, const char *name)
{
    const WrOpInfo *op = wr_action_op(name);
    if (op) wr_dialog_adjust_open(app, op);
    return op != NULL;
}
