/* composite.h - a document's composite, kept up to date: a compositor and its lock.
   Layer 5. Private to this room. */
#pragma once

typedef struct WrComposite WrComposite;
typedef struct WrField WrField;
typedef struct WrLayer WrLayer;
typedef struct WrPool WrPool;

/* Empty; costs nothing until updated. The caller owns it. */
WrComposite *wr_composite_new(void);
/* A second one that knows what the first knows, a few pointers a layer, for a snapshot. */
WrComposite *wr_composite_share(const WrComposite *composite);
void wr_composite_free(WrComposite *composite); /* NULL is fine */

/* Bring it up to date with layers[0..count-1], bottom first; solo: index of the one that is shown
 * alone, or -1. Any number of threads may ask at once, as long as nobody edits the layers. Borrowed: valid
 * until the next call after an edit. */
const WrField *wr_composite_update(WrComposite *composite, const WrLayer *layers, int count,
                                   int solo, WrPool *pool);
