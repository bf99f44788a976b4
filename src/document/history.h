/* history.h - what was done to a document, and every state on the way, as snapshots that share their tiles.
   Layer 5. Lines are opaque text here.

   A history of n steps knows n + 1 states; state k is what the first k lines made. States are exact: going
   back and forth restores every bit. What a step costs is what its two states do not share
   (wr_document_difference); where the sum passes the budget, the oldest states are given up, their lines
   stay. The step before the present state is kept whatever it costs, so that the last command can always
   be undone.

   How the scene is looked at is no part of a state: going back and forth leaves the present view, but over a
   step that brought a view of its own (a document that was opened) the view goes along: to what it was on
   the other side of that step. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrDocument WrDocument;
typedef struct WrField WrField;
typedef struct WrSceneView WrSceneView;

#define WR_HISTORY_BUDGET ((size_t)1 << 30) /* bytes, if nobody says otherwise */

typedef struct WrHistory WrHistory;

/* start: state 0, of which a snapshot is kept; mark: a number of the caller's that belongs to it. The
   caller owns the history. */
WrHistory *wr_history_new(const WrDocument *start, uint64_t mark, size_t budget);
void wr_history_free(WrHistory *history); /* NULL is fine */
/* The same once more, to be looked at by any thread whatever becomes of the first: it shares the steps, so that it costs no
   more than their number. The caller owns it. */
WrHistory *wr_history_still(const WrHistory *history);

/* `line` led from the present state to `document`, which becomes it; the steps after the old one are
 * gone. folder: what relative file names in the line are relative to, or NULL. Strings and the document
 * are copied (the latter by a snapshot). */
void wr_history_push(WrHistory *history, const WrDocument *document, const char *line,
                     const char *folder, uint64_t mark);

int wr_history_count(const WrHistory *history);    /* steps, those that were undone too */
int wr_history_position(const WrHistory *history); /* the present state: 0..count */
int wr_history_oldest(const WrHistory *history);   /* the oldest state that is kept: 0..position */
/* Of step k, 0..count - 1, which leads from state k to state k + 1. Borrowed until the next push. */
const char *wr_history_line(const WrHistory *history, int step);
const char *wr_history_folder(const WrHistory *history, int step); /* NULL: none */
size_t wr_history_step_bytes(const WrHistory *history, int step);  /* 0 if its state was given up */
size_t wr_history_bytes(const WrHistory *history);                 /* of all steps that are kept */
uint64_t wr_history_mark(const WrHistory *history);                /* of the present state */

/* The present state is looked at in another way: `document` differs from it in nothing else. */
void wr_history_look(WrHistory *history, const WrDocument *document);
/* The view that a state had when it was the present one last; false if the state was given up. */
bool wr_history_view(const WrHistory *history, int state, WrSceneView *view);
/* The heights of a state's active layer, of that under it where it is a filter; NULL: it was given up. Borrowed until the
   history changes. */
const WrField *wr_history_heights(const WrHistory *history, int state);
/* Did step k bring a view of its own? */
bool wr_history_brings_view(const WrHistory *history, int step);

/* Make `state` (oldest..count) the present one. Its document, a snapshot that is the caller's. */
WrDocument *wr_history_go(WrHistory *history, int state);

/* Gives up at once what is over it: the oldest states first, then undone steps, the last one first. */
void wr_history_set_budget(WrHistory *history, size_t bytes);
