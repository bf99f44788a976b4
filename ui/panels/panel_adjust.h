/* panel_adjust.h - the dialog of a table operation. */
#pragma once
#include "ui/canvas/view.h"
#include "ui/state/app_state.h"
#include "ui/state/roster.h"
#include "ui/toolkit/gui.h"
#include "ui/panels/points_pad.h"

#include "document/document.h"
#include "field/ops.h"

#include <stdbool.h>
#include <stdint.h>

/* How often heights are there, from the lowest to the highest. */
#define WR_HEIGHT_BINS 160
typedef struct WrHeightCounts {
    uint64_t key; /* of the table that was counted; 0: none */
    double low, high;
    unsigned most, count[WR_HEIGHT_BINS];
} WrHeightCounts;

/* Heights from the left to the right edge of a histogram. */
typedef struct WrHeightSpan {
    double low, high;
} WrHeightSpan;

/* What the dialog of an operation holds. */
typedef struct WrAdjust {
    const WrOpInfo *op;         /* NULL: none */
    double param[WR_OP_VALUES]; /* as in WrFilter */
    int layers;                 /* 0 the active one, 1 all */
    bool filters;               /* it is of a filter layer */
    int layer;                  /* that layer's index; -1: a new one */
    WrField *below;             /* what a filter with a histogram is over; NULL: nothing. Owned */
    uint64_t asked_at;          /* the document's revision when it was tried last */
    WrCanvasView view;          /* as it was before */
    WrHeightCounts histogram;   /* of levels and curves */
    int held;                   /* on it: 1 the low end, 2 the high one; 0: none */
    WrPointsHand points;        /* of a curve */
    WrHeightSpan held_span;     /* what it showed then */
    bool lacks;                 /* a filter could not be carried out, which was said */
} WrAdjust;

/* The operation of an action "adjust_NAME", or NULL. */
const WrOpInfo *wr_action_op(const char *name);
void wr_dialog_adjust_open(WrApp *app, const WrOpInfo *op);
void wr_dialog_adjust(WrApp *app);
/* The same of a new filter layer, and of the values of the active one, if that is one. */
void wr_dialog_filter_open(WrApp *app, const WrOpInfo *op);
void wr_filter_edit(WrApp *app);
/* Of another document what lay below a filter is let go; a filter that cannot be carried out is told of, once. */
extern const WrPart wr_part_adjust;

/* ---- levels_pad.c, curves_pad.c ---- */
/* True if a value was changed. */
bool wr_levels_pad(WrApp *app);
bool wr_curves_pad(WrApp *app);
/* The heights that the dialog changes, counted: valid until the next call. */
const WrHeightCounts *wr_height_counts(WrApp *app);
/* Where a height stands in the pad, in pixels of the window. */
double wr_height_x(const WrPad *pad, WrHeightSpan span, double height);
void wr_height_bars(const WrPad *pad, WrHeightSpan span, const WrHeightCounts *h);

/* ---- actions "adjust_NAME" and "filter_NAME"; see WrActionFamily ---- */
bool wr_adjust_by_name(WrApp *app, const char *name);
bool wr_filter_by_name(WrApp *app, const char *name);
