/* edit_preview.h - what a change would look like before it is made: computed in the background on a snapshot, so
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

typedef struct WrEditPreview WrEditPreview;

/* threads: as in wr_pool_new. done_event: an SDL event type, pushed when a result is there. */
WrEditPreview *wr_edit_preview_new(int threads, Uint32 done_event);
void wr_edit_preview_free(WrEditPreview *trial); /* NULL is fine */

typedef struct WrEditPreviewAsk {
    const WrOpInfo *op; /* an operation on the active layer, inside the selection; or NULL: */
    double param[WR_OP_VALUES];
    bool all_layers;
    bool filters; /* that as a filter layer: a new one (layer -1), or in the place of layer's */

    const WrBrush
        *dab; /* or a dab of this brush at u, v on the active layer; copied, its tip shared;
                           presets do not count */
    double u, v;

    const char
        *line; /* or a generator's command line, or `transform` (edit_preview_generate.h); copied */
    bool rough; /* first roughly, at once, and only then as the command makes it */

    int layer; /* or a layer with other settings; or that filter layer */
    WrBlend blend;
    float opacity, radius;
} WrEditPreviewAsk;

/* Ask what the document's composite would be. Replaces what was asked before, which is given up; its result,
 * if it came, stays until the new one is there. Takes a snapshot of the document. (An operation that gives
 * the table another size is tried on the composite itself.) */
void wr_edit_preview_ask(WrEditPreview *trial, const WrDocument *document,
                         const WrEditPreviewAsk *ask);
/* Nothing is tried any more. */
void wr_edit_preview_end(WrEditPreview *trial);
/* The whole document as the last ask makes it, exactly; NULL: not there yet, or of another size. Borrowed like
   the field: a share for a command that would make the same. */
const WrDocument *wr_edit_preview_made(WrEditPreview *trial);
/* Stop what is under way; what was there before stays. */
void wr_edit_preview_stop(WrEditPreview *trial);

/* The newest result, or NULL. Valid until the next call but wr_edit_preview_busy. */
const WrField *wr_edit_preview_field(WrEditPreview *trial);
/* Something is under way: how far it is (0..1) and for how many seconds; either may be NULL. */
bool wr_edit_preview_busy(WrEditPreview *trial, double *fraction, double *seconds);
/* Of a generator's line. The newest result is the rough one: the other is under way. */
bool wr_edit_preview_rough(WrEditPreview *trial);
/* What the newest result has to say, one a line; "" if nothing. Valid until the next call but wr_edit_preview_busy. */
const char *wr_edit_preview_notes(WrEditPreview *trial);
/* How long the newest result took that was not rough; 0: there is none. */
double wr_edit_preview_seconds(WrEditPreview *trial);
/* Why the newest ask gave nothing, or false. Told once. */
bool wr_edit_preview_error(WrEditPreview *trial, WrError *err);
