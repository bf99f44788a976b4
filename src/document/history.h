/* history.h - undo history of a document: the command lines and every state between them, as snapshots that
   share their tiles. Lines are opaque text here. Views have a history of their own, at the end of this file.

   A history of n steps has n + 1 states; state k is the result of the first k lines. States are exact: going
   back and forth restores every bit. The cost of a step is the memory that its two states do not share
   (wr_document_difference). If the sum exceeds the budget, the oldest states are discarded; their lines are
   kept. The step before the current state is kept whatever it costs, so that the last command can always be
   undone.

   The view of the scene is not part of a state: going back and forth keeps the current view, except over a step
   that had a view of its own (a document was opened). There the view changes to that on the other side of the
   step.

   A list of steps can be revised: a new history shares the steps before the first change, and the changed ones are
   added to it. The former list is kept behind it, so that one undo goes back to it and a redo returns. */
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

/* Properties of the last added step: its running time in seconds, and whether it is switched off: its line is kept, but its
   two states are equal. */
void wr_history_note_step(WrHistory *history, double seconds, bool off);

int wr_history_count(const WrHistory *history);    /* steps, including undone ones */
int wr_history_position(const WrHistory *history); /* the current state: 0..count */
int wr_history_oldest(const WrHistory *history);   /* the oldest stored state: 0..position */
/* Properties of step k, 0..count - 1, which leads from state k to state k + 1. Borrowed until the next push. */
const char *wr_history_line(const WrHistory *history, int step);
const char *wr_history_folder(const WrHistory *history, int step); /* NULL: none */
size_t wr_history_step_bytes(const WrHistory *history, int step); /* 0 if its state was discarded */
double wr_history_step_seconds(const WrHistory *history, int step);
bool wr_history_is_off(const WrHistory *history, int step);
size_t wr_history_bytes(const WrHistory *history);  /* of all stored steps */
uint64_t wr_history_mark(const WrHistory *history); /* of the current state */

/* Records a changed view of the current state: `document` differs from it in nothing else. */
void wr_history_record_view(WrHistory *history, const WrDocument *document);
/* The same of a changed choice of the active layer, or of its part. line: the command that chose it. */
void wr_history_record_choice(WrHistory *history, const WrDocument *document, const char *line);
/* The lines of the choices in a state while it was current, each with its line end; "": none. Borrowed until the history
   changes. */
const char *wr_history_choices(const WrHistory *history, int state);
/* The last view of a state while it was current; false if the state was discarded. */
bool wr_history_view(const WrHistory *history, int state, WrSceneView *view);
/* The document of a state; NULL: it was discarded. Borrowed until the history changes. */
const WrDocument *wr_history_document(const WrHistory *history, int state);
/* The heights of a state's active layer, or for a filter of the layer below; NULL: it was discarded. Borrowed
   until the history changes. */
const WrField *wr_history_heights(const WrHistory *history, int state);
/* True if step k has a view of its own. */
bool wr_history_restores_view(const WrHistory *history, int step);

/* Makes `state` (oldest..count) the current one. Returns its document, a snapshot owned by the caller. */
WrDocument *wr_history_go(WrHistory *history, int state);

/* ---- revised lists of steps ---- */

/* A history with the first `state` steps (oldest..position) of this one, which it owns from now on. The caller adds the
   other steps, and then ends the revision, which removes the undone steps of the former list, or takes it back. */
WrHistory *wr_history_revise(WrHistory *history, int state);
void wr_history_revised(WrHistory *history);
/* Frees the new history, and returns the former one. */
WrHistory *wr_history_take_back(WrHistory *history);
/* Steps that wr_history_travel can go back and forward: revisions count as one each. */
int wr_history_undo_count(const WrHistory *history);
int wr_history_redo_count(const WrHistory *history);
/* The lowest state that is reached without a revision in between. */
int wr_history_list_end(const WrHistory *history);
/* Goes `steps` back (negative) or forward; *history becomes another one over a revision. Returns the document there, a snapshot
   owned by the caller. steps: not 0, within the two counts */
WrDocument *wr_history_travel(WrHistory **history, int steps);

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
