/* outline.h - outline of a selection, or of a previewed selection, computed in the background. All calls are from the
   window's thread. */
#pragma once
#include "field/select.h"

#include <SDL.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct WrDocument WrDocument;

typedef struct WrOutliner WrOutliner;

WrOutliner *wr_outliner_new(int threads, Uint32 done_event);
void wr_outliner_free(WrOutliner *outliner); /* NULL is allowed */

typedef enum WrOutlineKind {
    WR_OUTLINE_PRESENT, /* the present selection */
    WR_OUTLINE_GROW,    /* grown by `by` texels */
    WR_OUTLINE_SHRINK,
    WR_OUTLINE_FEATHER,
    WR_OUTLINE_HEIGHT, /* heights low..high, faded over `soft`, combined by `mode` */
    WR_OUTLINE_SLOPE,  /* slopes low..high in degrees, faded and combined in the same way */
    WR_OUTLINE_KINDS
} WrOutlineKind;

typedef struct WrOutlineRequest {
    WrOutlineKind kind;
    double by, low, high, soft;
    WrSelectMode mode;
    bool to_mask; /* for the active layer's mask, not the selection */
} WrOutlineRequest;

/* Request an outline from a snapshot; replaces an earlier request. */
void wr_outliner_request(WrOutliner *outliner, const WrDocument *document,
                         const WrOutlineRequest *ask);
/* Remove the outline. */
void wr_outliner_clear(WrOutliner *outliner);
/* The newest outline; NULL: none. serial changes with it. Valid until the next call. */
const WrOutline *wr_outliner_get(WrOutliner *outliner, uint64_t *serial);
bool wr_outliner_busy(WrOutliner *outliner, double *fraction, double *seconds);
