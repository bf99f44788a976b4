/* Filter layers: operations over the layers below. */
#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "command/op_args.h"
#include "document/document.h"

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
    wr_fail(err, "%s is no filter: left out, layer= makes a new one above the active layer",
            wr_session_layer_name(session, index, &name));
    wr_text_fini(&name);
    return false;
}

static bool run_filter(WrSession *session, WrCall *call, WrError *err)
{
    WrDocument *document = session->state.document;
    const WrOpInfo *op = wr_op_find(call->form_name);
    const WrFilter filter = wr_call_filter(call, op);
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
    WrArgSpec *next = out->args + wr_op_args(op, out->args);
    *next++ = (WrArgSpec){ .name = "layer",
                           .type = WR_ARG_LAYER,
                           .help = "a filter layer, which becomes this one; left out, a new one "
                                   "above the active layer" };
    *next = (WrArgSpec){ .name = "name",
                         .type = WR_ARG_NAME,
                         .help = "of a new one; left out, what the operation is called" };
    return true;
}

const WrCommand wr_command_filter = {
    .name = "filter",
    .kind = WR_CLASS_EDIT,
    .form_word = "OPERATION",
    .form = form_filter,
    .run = run_filter,
    .prework = WR_PREWORK_COMPOSITE,
    .help = "a layer that is an operation over the layers below: blur, levels and the like",
    .details = "It holds no heights: what it makes of the joined layers below it follows whatever "
               "is done to them, and joins them by its blend (`mix` at first), its opacity and its "
               "mask, which `layer set` and `layer mask` change. A new one has what is selected as "
               "its mask. Edits of its heights are refused, "
               "those of its mask are not. `layer merge` and `layer flatten` make heights of it.",
    .example = "filter blur sigma=3"
};
