/* Filters: as layers over the layers below (filter), and over whole layers (adjust). */
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/args.h"
#include "command/command_line.h"
#include "command/commands.h"
#include "document/document.h"
#include "field/field.h"
#include "field/ops.h"
#include "field/select.h"

#include <string.h>

/* ---- arguments of an operation ---- */

static WrArgSpec argument(const WrOpParam *param)
{
    WrArgSpec spec = { .name = param->name,
                       .type = WR_ARG_NUMBER,
                       .low = param->low,
                       .high = param->high,
                       .above = param->above,
                       .whole = param->whole,
                       .share = param->share,
                       .fallback = &param->fallback,
                       .unit = *param->unit ? param->unit : NULL,
                       .help = param->help };
    if (param->choices) {
        spec.type = WR_ARG_CHOICE;
        spec.words = param->choices;
        spec.fallback = NULL;
        spec.fallback_text = param->choices[(int)param->fallback];
    } else if (param->points) {
        spec.type = WR_ARG_LIST;
        spec.components = 2;
        spec.shape = "x,y;...";
        spec.rows_low = 2;
        spec.rows_high = WR_OP_POINTS;
        spec.fallback_rows = (int)*param->points;
        spec.fallback = param->points + 1;
    }
    return spec;
}

/* Write one row for each parameter. Returns the number of rows. */
static int op_args(const WrOpInfo *op, WrArgSpec *out)
{
    const int count = wr_op_param_count(op);
    for (int k = 0; k < count; k++) out[k] = argument(&op->params[k]);
    return count;
}

/* The operation with the parameter values of a call whose form has these arguments. */
static WrFilter call_filter(const WrCall *call, const WrOpInfo *op)
{
    WrFilter filter = { .op = op };
    for (int k = 0; k < wr_op_param_count(op); k++) {
        const WrArg *arg = wr_call_arg(call, op->params[k].name);
        if (op->params[k].choices) {
            filter.param[k] = arg->choice;
        } else if (op->params[k].points) {
            filter.param[k] = arg->rows;
            memcpy(filter.param + k + 1, arg->numbers, sizeof(double) * 2 * (size_t)arg->rows);
        } else {
            filter.param[k] = arg->numbers[0];
        }
    }
    return filter;
}

/* ---- Filter layers: operations over the layers below ---- */

static bool change(WrSession *session, const WrCall *call, const WrFilter *filter, WrError *err)
{
    int index;
    if (wr_call_given(call, "name"))
        return wr_fail(err, "name= is for a new layer: `layer rename` renames one");
    if (!wr_session_find_layer(session, wr_call_arg(call, "layer")->text, &index, err) ||
        !wr_session_check_unlocked(session, index, err))
        return false;
    WrLayer *layer = &session->state.document->layers[index];
    if (layer->filter.op) {
        layer->filter = *filter;
        return true;
    }
    WrText name = { 0 };
    wr_fail(err, "%s is not a filter layer: leave layer= out to add a new one",
            wr_session_layer_name(session, index, &name));
    wr_text_fini(&name);
    return false;
}

static bool run_filter(WrSession *session, WrCall *call, WrError *err)
{
    WrDocument *document = session->state.document;
    const WrOpInfo *op = wr_op_find(call->form_name);
    const WrFilter filter = call_filter(call, op);
    const char *name = wr_call_arg(call, "name")->text;
    if (!wr_filter_check(&filter, err)) return false;
    if (wr_call_given(call, "layer")) return change(session, call, &filter, err);
    if (document->layer_count == WR_LAYERS_MAX)
        return wr_fail(err, "a document has up to %d layers", WR_LAYERS_MAX);
    wr_document_add_filter(document, name ? name : op->label, &filter);
    return true;
}

/* One form for each operation that keeps the table's size and edges. */
static bool form_filter(int i, WrForm *out)
{
    const WrOpInfo *op = wr_ops;
    for (; op->name; op++)
        if (!op->reshapes && i-- == 0) break;
    if (!op->name) return false;
    *out = (WrForm){ .name = op->name, .help = op->help };
    WrArgSpec *next = out->args + op_args(op, out->args);
    *next++ = (WrArgSpec){
        .name = "layer",
        .type = WR_ARG_LAYER,
        .help = "a filter layer to be changed; left out, a new one above the active layer"
    };
    *next = (WrArgSpec){ .name = "name",
                         .type = WR_ARG_NAME,
                         .help = "name of a new layer; left out, the operation's name" };
    return true;
}

const WrCommand wr_command_filter = {
    .name = "filter",
    .kind = WR_CLASS_EDIT,
    .form_word = "OPERATION",
    .form = form_filter,
    .run = run_filter,
    .prework = WR_PREWORK_COMPOSITE,
    .help = "add a filter layer: an operation on the layers below, such as blur or levels",
    .details =
        "A filter layer has no heights of its own. Its operation runs on the composite of the "
        "layers below, again after each change of them, and the result is blended by the layer's "
        "blend mode (`mix` at first), opacity and mask; `layer set` and `layer mask` change these. "
        "The mask of a new filter layer is the selection. Its mask can be edited, its heights "
        "cannot. `layer merge` and `layer flatten` turn it into heights.",
    .example = "filter blur sigma=3"
};

/* ---- The command adjust: filters over whole layers, coverage, masks and selections ---- */

typedef struct Adjusting {
    const WrOpInfo *op;
    WrFilter filter;
    WrOpOptions options;
    int tables, done; /* to change, and changed: equal parts of the progress */
} Adjusting;

typedef WrField *Runner(const WrOpInfo *op, const WrField *in, const double *param,
                        const WrOpOptions *options, WrError *err);

static bool run_with(Runner *run, Adjusting *adjusting, WrField **field, WrError *err)
{
    if (!*field) return true;
    WrOpOptions options = adjusting->options;
    WrProgressPart part;
    options.progress =
        wr_progress_part(&part, wr_progress_here(), (double)adjusting->done / adjusting->tables,
                         (adjusting->done + 1.0) / adjusting->tables);
    adjusting->done++;
    WrField *made = run(adjusting->op, *field, adjusting->filter.param, &options, err);
    if (!made) return false;
    wr_field_free(*field);
    *field = made;
    return true;
}

static bool run_on(Adjusting *adjusting, WrField **field, WrError *err)
{
    return run_with(wr_op_run, adjusting, field, err);
}

/* Apply the filter to coverage, a mask or a selection; the result is clamped to 0..1 even if the filter
   overshoots. */
static bool run_on_part(Adjusting *adjusting, WrField **field, WrError *err)
{
    return run_with(wr_op_run_unit, adjusting, field, err);
}

/* Number of tables that run_on_layer changes. */
static int tables_of(const WrOpInfo *op, const WrLayer *layer)
{
    const bool parts = op->moves || op->reshapes;
    return (wr_layer_holds(layer) || op->reshapes) + (parts && layer->cover) +
           (parts && layer->mask);
}

static bool run_on_layer(Adjusting *adjusting, WrLayer *layer, WrError *err)
{
    const WrOpInfo *op = adjusting->op;
    const bool holds = wr_layer_holds(layer) || op->reshapes; /* else none to change */
    if (holds && !run_on(adjusting, &layer->heights, err)) return false;
    return !(op->moves || op->reshapes) || (run_on_part(adjusting, &layer->cover, err) &&
                                            run_on_part(adjusting, &layer->mask, err));
}

static bool run_on_all(WrSession *session, Adjusting *adjusting, WrError *err)
{
    WrDocument *document = session->state.document;
    adjusting->tables = adjusting->op->reshapes && document->selection;
    for (int i = 0; i < document->layer_count; i++)
        adjusting->tables += tables_of(adjusting->op, &document->layers[i]);
    for (int i = 0; i < document->layer_count; i++) {
        /* all tables have one size, so a lock cannot keep one from being reshaped */
        if (!adjusting->op->reshapes && !wr_session_check_unlocked(session, i, err)) return false;
        if (!run_on_layer(adjusting, &document->layers[i], err)) return false;
    }
    return !adjusting->op->reshapes || run_on_part(adjusting, &document->selection, err);
}

static bool run_adjust(WrSession *session, WrCall *call, WrError *err)
{
    Adjusting adjusting = { .op = &wr_ops[call->form] };
    const WrOpInfo *op = adjusting.op;
    adjusting.options = (WrOpOptions){ .pool = session->options.pool };
    if (!op->reshapes) adjusting.options.mask = session->state.document->selection;
    adjusting.filter = call_filter(call, op);
    if (op->reshapes || wr_call_choice(call, "layers") == 1)
        return run_on_all(session, &adjusting, err);
    WrLayer *layer = wr_session_layer(session, err);
    if (layer) adjusting.tables = tables_of(op, layer);
    return layer && run_on_layer(&adjusting, layer, err);
}

static const char *const layer_choices[] = { "active", "all", NULL };

/* ---- the forms ---- */

/* One form for each operation. */
static bool form_adjust(int i, WrForm *out)
{
    if (i >= wr_op_count) return false;
    const WrOpInfo *op = &wr_ops[i];
    *out = (WrForm){ .name = op->name, .help = op->help };
    const int count = op_args(op, out->args);
    if (op->reshapes) return true;
    out->args[count] = (WrArgSpec){ .name = "layers",
                                    .type = WR_ARG_CHOICE,
                                    .words = layer_choices,
                                    .fallback_text = "active",
                                    .help = "layers that change" };
    return true;
}

/* ---- the row ---- */

const WrCommand wr_command_adjust = {
    .name = "adjust",
    .kind = WR_CLASS_EDIT,
    .form_word = "OPERATION",
    .form = form_adjust,
    .run = run_adjust,
    .prework = WR_PREWORK_TABLES,
    .help = "change a whole table: blur, levels, resize and the like",
    .details = "Operations act on the active layer inside the selection; those that change the "
               "table's size act on all layers, masks and the selection, even on locked ones. "
               "Where texels move, the layer's coverage and mask move too.",
    .example = "adjust blur sigma=3"
};
