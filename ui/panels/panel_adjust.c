/* Dialog of a table operation, built from its row: canvas and patch show a preview on a snapshot; only Apply runs the
   command. */
#include "ui/panels/panel_adjust.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/line.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/session_view.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/app/jobs/edit_preview.h"

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

static const WrOpInfo *action_op(const char *name)
{
    size_t length = sizeof prefix - 1;
    return strncmp(name, prefix, length) == 0 ? wr_op_find(name + length) : NULL;
}

static void ask(WrApp *app)
{
    WrEditPreviewRequest trial = { .op = app->adjust->op,
                                   .all_layers = app->adjust->layers == 1,
                                   .filters = app->adjust->filters,
                                   .layer = app->adjust->layer };
    memcpy(trial.param, app->adjust->param, sizeof trial.param);
    app->adjust->asked_at = wr_session_revision(app->session);
    wr_app_try(app, &trial);
}

static bool is_named(const WrOpParam *param, const char *name)
{
    return strcmp(param->name, name) == 0;
}

/* The sizes of a new table start with the table's size. */
static double beginning(const WrApp *app, const WrOpInfo *op, const WrOpParam *param)
{
    const WrField *field = wr_app_field(app);
    if (op->reshapes && is_named(param, "width")) return wr_field_width(field);
    if (op->reshapes && is_named(param, "height")) return wr_field_height(field);
    return param->fallback;
}

static bool has_histogram(const WrOpInfo *op)
{
    return strcmp(op->name, "levels") == 0 || strcmp(op->name, "curves") == 0;
}

static void forget_below(WrApp *app)
{
    wr_field_free(app->adjust->below);
    app->adjust->below = NULL;
}

/* Composite below a new filter above the active layer. */
static WrField *below_new(const WrDocument *document)
{
    const int at = document->active + 1;
    if (document->layer_count == WR_LAYERS_MAX) return wr_field_share(wr_document_field(document));
    WrDocument *with = wr_document_snapshot(document);
    wr_document_insert(with, at, wr_layer_make("", document->layers[0].heights));
    WrField *below = wr_document_below(with, at, NULL);
    wr_document_free(with);
    return below;
}

/* layer: index of a filter layer, -1 for a new one. */
static void ask_values(WrApp *app, const WrFilter *filter, bool filters, int layer)
{
    wr_dialog_open(app, WR_DIALOG_ADJUST);
    app->adjust->op = filter->op;
    app->adjust->view = *app->view;
    app->adjust->layers = app->adjust->held = 0;
    app->adjust->points = (WrPointsState){ 0 };
    app->adjust->filters = filters;
    app->adjust->layer = layer;
    memcpy(app->adjust->param, filter->param, sizeof app->adjust->param);
    forget_below(app);
    if (filters && has_histogram(filter->op)) {
        const WrDocument *document = wr_app_document(app);
        app->adjust->below =
            layer >= 0 ? wr_document_below(document, layer, NULL) : below_new(document);
    }
    ask(app);
}

static void dialog_adjust_open(WrApp *app, const WrOpInfo *op)
{
    if (wr_busy_refuse(app)) return;
    WrFilter filter = wr_filter_of(op);
    for (int i = 0; i < wr_op_param_count(op); i++)
        if (!op->params[i].points) filter.param[i] = beginning(app, op, &op->params[i]);
    ask_values(app, &filter, false, -1);
}

static void dialog_filter_open(WrApp *app, const WrOpInfo *op)
{
    if (wr_busy_refuse(app)) return;
    const WrFilter filter = wr_filter_of(op);
    ask_values(app, &filter, true, -1);
}

void wr_filter_edit(WrApp *app)
{
    const WrDocument *document = wr_app_document(app);
    const WrLayer *layer = &document->layers[document->active];
    if (layer->filter.op) ask_values(app, &layer->filter, true, document->active);
}

/* ---- parameters ---- */

static void bound(WrNumber *spec, double low, double high)
{
    spec->hard_low = low;
    spec->hard_high = fmax(low, high);
    spec->low = fmin(fmax(spec->low, low), spec->hard_high);
    spec->high = fmin(spec->high, spec->hard_high);
}

/* Limit a parameter by the others, as the operation requires: a rectangle stays inside the table, a low value below
   the high one. */
static void bound_by_others(const WrApp *app, int index, WrNumber *spec)
{
    const WrField *field = wr_app_field(app);
    const double *v = app->adjust->param;
    const double size[2] = { wr_field_width(field), wr_field_height(field) };
    if (strcmp(app->adjust->op->name, "crop") == 0) {
        const bool corner = index < 2;
        const double other = v[corner ? index + 2 : index - 2];
        bound(spec, spec->hard_low, size[index % 2] - other);
    } else if (strcmp(app->adjust->op->name, "clamp") == 0) {
        bound(spec, index == 0 ? spec->hard_low : v[0], index == 0 ? v[1] : spec->hard_high);
    }
}

/* Range of a slider: at most the table's texels. */
static WrNumber spec_of(const WrApp *app, int index)
{
    const WrOpParam *param = &app->adjust->op->params[index];
    const WrField *field = wr_app_field(app);
    double w = wr_field_width(field), h = wr_field_height(field), most = w > h ? w : h;
    WrNumber spec = { .low = param->soft_low,
                      .high = param->soft_high,
                      .hard_low = param->low,
                      .hard_high = param->high,
                      .reset = beginning(app, app->adjust->op, param),
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
    bound_by_others(app, index, &spec);
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
        if (param->points) continue; /* edited in its own pad */
        wr_gui_label(param->label);
        if (param->choices) {
            changed |= choice(param, &app->adjust->param[i]);
            continue;
        }
        WrNumber spec = spec_of(app, i);
        changed |= wr_gui_number(param->name, 0, &spec, &app->adjust->param[i]) != WR_EDIT_NONE;
    }
    return changed;
}

/* For Offset: shift by half a cell, so that the seams are in the middle. */
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
    if (app->adjust->filters || app->adjust->op->reshapes || wr_app_document(app)->layer_count == 1)
        return false;
    wr_gui_label("Layers");
    return wr_gui_choice("layers", 0, names, 2, &app->adjust->layers);
}

/* ---- end of the dialog ---- */

static void line_of(const WrApp *app, WrText *line)
{
    const WrAdjust *adjust = app->adjust;
    WrFilter filter = { .op = adjust->op };
    memcpy(filter.param, adjust->param, sizeof filter.param);
    wr_text_add(line, adjust->filters ? "filter " : "adjust ");
    wr_filter_print(&filter, line);
    if (adjust->filters && adjust->layer >= 0) wr_text_addf(line, " layer=%d", adjust->layer + 1);
    if (adjust->layers == 1 && !adjust->op->reshapes) wr_text_add(line, " layers=all");
}

static void commit(WrApp *app)
{
    WrText line = { 0 };
    line_of(app, &line);
    const bool same = app->adjust->asked_at == wr_session_revision(app->session);
    if (same) wr_app_run_tried(app, wr_text_get(&line));
    else wr_app_run_slow(app, wr_text_get(&line));
    wr_text_fini(&line);
}

/* Restore the previous state, including the view's position. */
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

/* Progress, in a row below the buttons, so that these do not move. */
static void progress(WrApp *app)
{
    double fraction, seconds;
    bool shown = wr_edit_preview_busy(app->trial, &fraction, &seconds) && seconds > 0.2;
    if (!shown) return;
    wr_gui_progress(wr_gui_available() - wr_gui_px(64), fraction);
    wr_gui_same_line(8);
    if (wr_gui_chip(NULL, "Stop")) wr_edit_preview_stop(app->trial);
}

void wr_dialog_adjust(WrApp *app)
{
    const WrOpInfo *op = app->adjust->op;
    char name[80], title[96], help[200];
    WrError err;
    const bool filters = app->adjust->filters;
    if (!filters) snprintf(name, sizeof name, "%.40s", wr_words(op->label));
    else if (app->adjust->layer >= 0)
        snprintf(name, sizeof name, wr_words("%s: filter layer"), wr_words(op->label));
    else snprintf(name, sizeof name, wr_words("%s: new filter layer"), wr_words(op->label));
    snprintf(title, sizeof title, "%s###adjust", name);
    if (!wr_gui_dialog_begin_at(title, wr_dialog_side(app))) return;
    snprintf(help, sizeof help, "%.190s.", wr_words(op->help));
    if (help[0] >= 'a' && help[0] <= 'z') help[0] = (char)(help[0] - 'a' + 'A');
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL, help);
    wr_gui_space(4);
    bool changed =
        has_histogram(op) && (op->params->points ? wr_curves_pad(app) : wr_levels_pad(app));
    changed |= parameters(app);
    changed |= half_cell(app);
    changed |= which_layers(app);
    if (wr_app_document(app)->selection && !(filters && app->adjust->layer >= 0))
        wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL,
                            filters        ? "The selection becomes the layer's mask."
                            : op->reshapes ? "The whole table changes, selected or not."
                                           : "Only the selection changes.");
    if (changed) ask(app);
    if (wr_edit_preview_error(app->trial, &err)) wr_app_fail(app, &err);
    int answer = wr_dialog_buttons(app, "Apply", true);
    if (answer == 0) expectation(app);
    progress(app);
    if (answer > 0) commit(app);
    if (answer < 0) cancel(app);
    if (answer != 0) app->adjust->op = NULL;
    if (answer != 0) forget_below(app);
    wr_gui_dialog_end();
}

bool wr_adjust_dialog_of_action(WrApp *app, const char *name)
{
    const WrOpInfo *op = action_op(name);
    if (op) dialog_adjust_open(app, op);
    return op != NULL;
}

static void report_of_lack(WrApp *app)
{
    WrError err;
    const bool lacked = app->adjust->lacks;
    wr_filters_forget();
    if (wr_document_filters(wr_app_document(app))) wr_document_field(wr_app_document(app));
    app->adjust->lacks = !wr_filters_carried(&err);
    if (app->adjust->lacks && !lacked) wr_app_fail(app, &err);
}

const WrPart wr_part_adjust = { .update = report_of_lack, .another = forget_below };

bool wr_filter_dialog_of_action(WrApp *app, const char *name)
{
    static const char start[] = "filter_";
    const bool ours = strncmp(name, start, sizeof start - 1) == 0;
    const WrOpInfo *op = ours ? wr_op_find(name + sizeof start - 1) : NULL;
    if (op && op->reshapes) op = NULL;
    if (op) dialog_filter_open(app, op);
    return op != NULL;
}
