/* panel_adjust.h - the dialog of a table operation. */
#pragma once
#include "ui/canvas/view.h"
#include "ui/desk/desk.h"

#include "field/ops.h"

#include <stdbool.h>
#include <stdint.h>

/* What the dialog of an operation holds. */
typedef struct WrAdjust {
    const WrOpInfo *op; /* NULL: none */
    double param[WR_OP_PARAMS];
    int layers;        /* 0 the active one, 1 all */
    uint64_t asked_at; /* the document's revision when it was tried last */
    WrCanvasView view; /* as it was before */
} WrAdjust;

/* The operation of an action "adjust_NAME", or NULL. */
const WrOpInfo *wr_action_op(const char *name);
void wr_dialog_adjust_open(WrApp *app, const WrOpInfo *op);
void wr_dialog_adjust(WrApp *app);
bool wr_adjust_by_name(WrApp *app, const char *name); /* "adjust_NAME"; see WrActionFamily */
