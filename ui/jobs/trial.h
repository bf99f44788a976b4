/* trial.h - what a change would look like before it is made: computed in the background on a snapshot, so
   that the document is never touched and the window never waits.
   All calls come from the window's thread. */
#pragma once
#include "document/blend.h"
#include "field/ops.h"

#include <SDL.h>
#include <stdbool.h>

typedef struct WrBrush WrBrush;
typedef struct WrDocument WrDocument;
typedef struct WrError WrError;
typedef struct WrField WrField;

typedef struct WrTrial WrTrial;

/* threads: as in wr_pool_new. done_event: an SDL event type, pushed when a result is there. */
WrTrial *wr_trial_new(int threads, Uint32 done_event);
void wr_trial_free(WrTrial *trial); /* NULL is fine */

typedef struct WrTrialAsk {
    const WrOpInfo *op; /* an operation on the active layer, inside the selection; or NULL: */
    double param[WR_OP_VALUES];
    bool all_layers;
    bool filters; /* that as a filter layer: a new one (layer -1), or in the place of layer's */

    const WrBrush
        *dab; /* or a dab of this brush at u, v on the active layer; copied, its tip shared;
                           presets do not count */
    double u, v;

    const char *line; /* or a generator's command line, or `transform` (trial_generate.h); copied */
    bool rough;       /* first roughly, at once, and only then as the command makes it */

    int layer; /* or a layer with other settings; or that filter layer */
    WrBlend blend;
    float opacity, radius;
} WrTrialAsk;

/* Ask what the document's composite would be. Replaces what was asked before, which is given up; its result,
 * if it came, stays until the new one is there. Takes a snapshot of the document. (An operation that gives
 * the table another size is tried on the composite itself.) */
void wr_trial_ask(WrTrial *trial, const WrDocument *document, const WrTrialAsk *ask);
/* Nothing is tried any more. */
void wr_trial_end(WrTrial *trial);
/* The whole document as the last ask makes it, exactly; NULL: not there yet, or of another size. Borrowed like
   the field: a share for a command that would make the same. */
const WrDocument *wr_trial_made(WrTrial *trial);
/* Stop what is under way; what was there before stays. */
void wr_trial_stop(WrTrial *trial);

/* The newest result, or NULL. Valid until the next call but wr_trial_busy. */
const WrField *wr_trial_field(WrTrial *trial);
/* Something is under way: how far it is (0..1) and for how many seconds; either may be NULL. */
bool wr_trial_busy(WrTrial *trial, double *fraction, double *seconds);
/* Of a generator's line. The newest result is the rough one: the other is under way. */
bool wr_trial_rough(WrTrial *trial);
/* What the newest result has to say, one a line; "" if nothing. Valid until the next call but wr_trial_busy. */
const char *wr_trial_notes(WrTrial *trial);
/* How long the newest result took that was not rough; 0: there is none. */
double wr_trial_seconds(WrTrial *trial);
/* Why the newest ask gave nothing, or false. Told once. */
bool wr_trial_error(WrTrial *trial, WrError *err);
