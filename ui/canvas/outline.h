/* outline.h - the outline of a selection, or of what it would become, computed in the background.
   All calls come from the window's thread. */
#pragma once
#include "field/select.h"

#include <SDL.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct WrDocument WrDocument;

typedef struct WrOutliner WrOutliner;

WrOutliner *wr_outliner_new(int threads, Uint32 done_event);
void wr_outliner_free(WrOutliner *outliner); /* NULL is fine */

typedef enum WrOutlineKind {
    WR_OUTLINE_PRESENT, /* the selection as it is */
    WR_OUTLINE_GROW,    /* by `by` texels */
    WR_OUTLINE_SHRINK,
    WR_OUTLINE_FEATHER,
    WR_OUTLINE_HEIGHT, /* low..high, faded over `soft`, joined by `mode` */
    WR_OUTLINE_SLOPE,  /* the same in degrees */
    WR_OUTLINE_KINDS
} WrOutlineKind;

typedef struct WrOutlineAsk {
    WrOutlineKind kind;
    double by, low, high, soft;
    WrSelectMode mode;
    bool to_mask; /* it is to be the active layer's mask, not the selection */
} WrOutlineAsk;

/* Ask for it; replaces what was asked before. A snapshot is taken. */
void wr_outliner_ask(WrOutliner *outliner, const WrDocument *document, const WrOutlineAsk *ask);
/* There is nothing to outline. */
void wr_outliner_clear(WrOutliner *outliner);
/* The newest outline; NULL: none. serial changes with it. Valid until the next call. */
const WrOutline *wr_outliner_get(WrOutliner *outliner, uint64_t *serial);
bool wr_outliner_busy(WrOutliner *outliner, double *fraction, double *seconds);
