/* history.h - undo history of a document: the command lines and every state between them, as snapshots that
   share their tiles. Lines are opaque text here. Views have a history of their own, at the end of this file.

   A history of n steps has n + 1 states; state k is the result of the first k lines. States are exact: going
   back and forth restores every bit. The cost of a step is the memory that its two states do not share
   (wr_document_difference). If the sum exceeds the budget, the oldest states are discarded; their lines are
   kept. The step before the current state is kept whatever it costs, so that the last command can always be
   undone.

   The view of the scene is not part of a state: going back and forth keeps the current view, except over a step
   that had a view of its own (a document was opened). There the view changes to that on the other side of the
   step. */
#pragma once
#include "scene/camera.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrDocument WrDocument;
typedef struct WrField WrField;
typedef struct WrSceneView WrSceneView;

#define WR_HISTORY_BUDGET ((size_t)1 << 30) /* bytes, default */

typedef struct WrHistory WrHistory;

/* start: state 0, stored as a snapshot; mark: a number of the caller's that belongs to it. The caller owns the
   history. */
WrHistory *wr_history_new(const WrDocument *start, uint64_t mark, size_t budget);
void wr_history_free(WrHistory *history); /* NULL is fine */
/* A read-only snapshot that any thread may read while the original changes: it shares the steps, so its cost
   depends only on their number. The caller owns it. */
WrHistory *wr_history_snapshot(const WrHistory *history);

/* Adds a step: `line` led from the current state to `document`, which becomes the current one; the steps after
   the old one are discarded. folder: base of relative file names in the line, or NULL. Strings and the document
   are copied (the latter as a snapshot). */
void wr_history_push(WrHistory *history, const WrDocument *document, const char *line,
                     const char *folder, uint64_t mark);

int wr_history_count(const WrHistory *history);    /* steps, including undone ones */
int wr_history_position(const WrHistory *history); /* the current state: 0..count */
int wr_history_oldest(const WrHistory *history);   /* the oldest stored state: 0..position */
/* Properties of step k, 0..count - 1, which leads from state k to state k + 1. Borrowed until the next push. */
const char *wr_history_line(const WrHistory *history, int step);
const char *wr_history_folder(const WrHistory *history, int step); /* NULL: none */
size_t wr_history_step_bytes(const WrHistory *history, int step); /* 0 if its state was discarded */
size_t wr_history_bytes(const WrHistory *history);                /* of all stored steps */
uint64_t wr_history_mark(const WrHistory *history);               /* of the current state */

/* Records a changed view of the current state: `document` differs from it in nothing else. */
void wr_history_record_view(WrHistory *history, const WrDocument *document);
/* The last view of a state while it was current; false if the state was discarded. */
bool wr_history_view(const WrHistory *history, int state, WrSceneView *view);
/* The heights of a state's active layer, or for a filter of the layer below; NULL: it was discarded. Borrowed
   until the history changes. */
const WrField *wr_history_heights(const WrHistory *history, int state);
/* True if step k has a view of its own. */
bool wr_history_restores_view(const WrHistory *history, int step);

/* Makes `state` (oldest..count) the current one. Returns its document, a snapshot owned by the caller. */
WrDocument *wr_history_go(WrHistory *history, int state);

/* Discards at once whatever exceeds the budget: the oldest states first, then undone steps, the last one first. */
void wr_history_set_budget(WrHistory *history, size_t bytes);

/* ---- history of camera views, with steps back and forward ---- */

/* Separate from the undo history (history.h): views are not edits, and the two histories have separate steps. */

typedef struct WrScene WrScene;

#define WR_VIEWS_MAX 1000 /* maximum; the oldest are removed */

typedef struct WrViews WrViews;

/* Creates a history with one view. The caller owns it. */
WrViews *wr_views_new(const WrSceneView *start);
void wr_views_free(WrViews *views);            /* NULL is fine */
WrViews *wr_views_clone(const WrViews *views); /* the caller owns it */

/* Makes `view` the current one. If it equals the current view there is no step; else the views after that are
   removed. */
void wr_views_make_current(WrViews *views, const WrSceneView *view);

int wr_views_back(const WrViews *views);    /* number of steps possible back */
int wr_views_forward(const WrViews *views); /* and forward */
/* Moves by `steps` (negative: back), -back..forward, and returns the view there. */
WrSceneView wr_views_go(WrViews *views, int steps);
/* Number of the current view, counted from the start, including removed ones. */
int64_t wr_views_number(const WrViews *views);
/* The first view, always kept. */
WrSceneView wr_views_start(const WrViews *views);
