/* panel_adjust.h - dialog of a table operation. */
#pragma once
#include "ui/canvas/view.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"
#include "ui/toolkit/gui.h"
#include "ui/panels/points_pad.h"

#include "document/document.h"
#include "field/ops.h"

#include <stdbool.h>
#include <stdint.h>

/* Histogram of heights from the lowest to the highest. */
#define WR_HEIGHT_BINS 160
typedef struct WrHeightCounts {
    uint64_t key; /* key of the counted table; 0: none */
    double low, high;
    unsigned most, count[WR_HEIGHT_BINS];
} WrHeightCounts;

/* Heights at the left and right edge of a histogram. */
typedef struct WrHeightSpan {
    double low, high;
} WrHeightSpan;

/* State of an operation's dialog. */
typedef struct WrAdjust {
    const WrOpInfo *op;         /* NULL: none */
    double param[WR_OP_VALUES]; /* as in WrFilter */
    int layers;                 /* 0 the active layer, 1 all layers */
    bool filters;               /* the dialog edits a filter layer */
    int layer;                  /* index of the filter layer; -1: a new one */
    /* composite below a filter that has a histogram; NULL: none. Owned */
    WrField *below;
    uint64_t asked_at;        /* the document's revision at the last preview request */
    WrCanvasView view;        /* canvas view before the dialog */
    WrHeightCounts histogram; /* for levels and curves */
    int held;                 /* dragged limit: 1 low, 2 high; 0: none */
    WrPointsState points;     /* of a curve */
    WrHeightSpan held_span;   /* range of the histogram at the start of the drag */
    bool lacks;               /* a missing filter result was reported */
} WrAdjust;

/* The operation of an action "adjust_NAME", or NULL. */
void wr_dialog_adjust(WrApp *app);
/* Open the dialog for a new filter layer; and for the values of the active layer, if it is a filter. */
void wr_filter_edit(WrApp *app);
/* Component that frees the composite below a filter when the document is replaced, and reports once a filter that
   cannot be computed. */
extern const WrPart wr_part_adjust;

/* ---- pads of levels and curves ---- */
/* True if a value was changed. */
bool wr_levels_pad(WrApp *app);
bool wr_curves_pad(WrApp *app);
/* Histogram of the heights that the dialog changes; valid until the next call. */
const WrHeightCounts *wr_height_counts(WrApp *app);
/* Draws the histogram into the pad. span: heights at its left and right edge. */
void wr_height_bars(const WrPad *pad, WrHeightSpan span, const WrHeightCounts *h);

/* ---- actions "adjust_NAME" and "filter_NAME"; see WrActionFamily ---- */
bool wr_adjust_dialog_of_action(WrApp *app, const char *name);
bool wr_filter_dialog_of_action(WrApp *app, const char *name);
