/* edit_preview.h - preview of an edit, computed in the background on a snapshot. The document is never changed and
   the window never waits. All calls are from the window's thread. */
#pragma once
#include "document/blend.h"
#include "document/document.h"
#include "field/ops.h"

#include <SDL.h>
#include <stdbool.h>

typedef struct WrBrush WrBrush;
typedef struct WrSession WrSession;

typedef struct WrEditPreview WrEditPreview;

/* threads: as in wr_pool_new. done_event: an SDL event type, pushed when a result is ready. */
WrEditPreview *wr_edit_preview_new(int threads, Uint32 done_event);
void wr_edit_preview_free(WrEditPreview *trial); /* NULL is allowed */

/* Destination of a generator's line. */
typedef enum WrLineTarget {
    WR_LINE_INTO_ACTIVE, /* the heights of the active layer, inside the selection */
    WR_LINE_NEW_LAYER,   /* a new generator layer above it */
    WR_LINE_OF_LAYER     /* generator layer `layer`, with the request's blend mode and radius */
} WrLineTarget;

typedef struct WrEditPreviewRequest {
    const WrOpInfo *op; /* operation on the active layer, inside the selection; or NULL: */
    double param[WR_OP_VALUES];
    bool all_layers;
    /* the operation is a filter layer: a new one (layer -1), or a change of layer `layer` */
    bool filters;

    /* or a dab of this brush at u, v on the active layer; copied, its tip shared; presets are
       ignored */
    const WrBrush *dab;
    double u, v;

    /* or a generator's command line, or `transform` (below); copied */
    const char *line;
    WrLineTarget target; /* of a generator's line */
    bool rough;          /* a fast rough result first, then the exact one */

    const char *command; /* or any other command line, run on a copy of the document; copied */
    const WrSession *
        session; /* and of this session's history, for commands that change steps; NULL: not needed */

    int layer; /* or a layer with changed settings; or the filter or generator layer */
    WrBlend blend;
    float opacity, radius;
    bool also[WR_LAYERS_MAX]; /* other layers that get that opacity */
} WrEditPreviewRequest;

/* Request the document's composite after an edit. Cancels an earlier request; its result, if any, stays until the new
 * one is ready. Copies a snapshot of the document. (An operation that changes the table's size is previewed on the
 * composite itself.) */
void wr_edit_preview_request(WrEditPreview *trial, const WrDocument *document,
                             const WrEditPreviewRequest *ask);
/* Discard the preview and its results. */
void wr_edit_preview_end(WrEditPreview *trial);
/* The whole document after the last requested edit, exact; NULL: not ready, or of another size. Borrowed like the
   field. A command with the same edit can share it. */
const WrDocument *wr_edit_preview_made(WrEditPreview *trial);
/* Cancel the running computation; earlier results stay. */
void wr_edit_preview_stop(WrEditPreview *trial);

/* The newest result, or NULL. Valid until the next call except wr_edit_preview_busy. */
const WrField *wr_edit_preview_field(WrEditPreview *trial);
/* True while a computation runs; its progress (0..1) and elapsed seconds; either may be NULL. */
bool wr_edit_preview_busy(WrEditPreview *trial, double *fraction, double *seconds);
/* True if the newest result is a rough one of a generator and the exact one is being computed. */
bool wr_edit_preview_is_rough(WrEditPreview *trial);
/* Notes of the newest result, one per line; "" if none. Valid until the next call except wr_edit_preview_busy. */
const char *wr_edit_preview_notes(WrEditPreview *trial);
/* Computation time of the newest exact result in seconds; 0: there is none. */
double wr_edit_preview_seconds(WrEditPreview *trial);
/* The error of the newest request, reported once; false: none. */
bool wr_edit_preview_error(WrEditPreview *trial, WrError *err);

/* ---- application of a generator or transform line to a document, for previews ---- */

typedef struct WrPool WrPool;
typedef struct WrProgress WrProgress;
typedef struct WrText WrText;

/* Generate a line in a document as the command would.
 *
 * document  changed; half done after a failure
 * line      of a generator family; relative file names refer to the current folder
 * target    with WR_LINE_OF_LAYER the active layer, whose blend mode and radius are final already
 * rough     fastest mode: lower quality, and a smaller table if the result depends only on the relative size
 * notes     remarks, one per line
 * Threads   one for each document */
bool wr_edit_preview_generate(WrDocument *document, const char *line, WrLineTarget target,
                              bool rough, WrPool *pool, const WrProgress *progress, WrText *notes,
                              WrError *err);
