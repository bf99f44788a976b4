/* The command adjust: filters over whole layers, coverage, masks and selections. */
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "command/args.h"
#include "command/commands.h"
#include "command/op_args.h"
#include "document/document.h"
#include "field/field.h"
#include "field/ops.h"
#include "field/select.h"

#include <string.h>

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
    return (!layer->filter.op || op->reshapes) + (parts && layer->cover) + (parts && layer->mask);
}

static bool run_on_layer(Adjusting *adjusting, WrLayer *layer, WrError *err)
{
    const WrOpInfo *op = adjusting->op;
    const bool holds = !layer->filter.op || op->reshapes; /* a filter has no heights to change */
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
    adjusting.filter = wr_call_filter(call, op);
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
    const int count = wr_op_args(op, out->args);
    if (op->reshapes) return true;
    out->args[count] = (WrArgSpec){ .name = "layers",
                                    .type = WR_ARG_CHOICE,
                                    .words = layer_choices,
                                    .fallback_text = "active",
                                    .help = "which layers it changes" };
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
    .details =
        "They act on the active layer inside the selection; those that change the table's size "
        "act "
        "on all layers, masks and the selection, locked or not. Where texels move, a layer's "
        "coverage and mask move along.",
    .example = "adjust blur sigma=3"
};
