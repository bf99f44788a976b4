/* composite.h - composite of a document's layers, updated incrementally: compositors and their lock. Private to
   this module. */
#pragma once

typedef struct WrComposite WrComposite;
typedef struct WrField WrField;
typedef struct WrLayer WrLayer;
typedef struct WrPool WrPool;

/* Creates an empty composite, without cost until it is updated. The caller owns it. */
WrComposite *wr_composite_new(void);
/* A copy for a snapshot that shares all cached tiles: a few pointers per layer. */
WrComposite *wr_composite_share(const WrComposite *composite);
void wr_composite_free(WrComposite *composite); /* NULL is fine */

/* Updates it to layers[0..count-1], bottom first; solo: index of the layer that is shown alone, or -1. Any
   number of threads may call it at once, as long as nobody edits the layers. Borrowed: valid until the next call
   after an edit. */
const WrField *wr_composite_update(WrComposite *composite, const WrLayer *layers, int count,
                                   int solo, WrPool *pool);
