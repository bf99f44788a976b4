/* composite.h - composite of a document's layers, updated incrementally: compositors and their lock. Private to
   this module. */
#pragma once
#include "document/blend.h"

#include <stdbool.h>

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

/* The composite of the visible layers below layer `index`, 1..count; the caller owns it. Layers with a line or a live mask
   keep theirs: only what changed since their last call is blended again. Threads as above. */
WrField *wr_composite_below(WrComposite *composite, const WrLayer *layers, int count, int index,
                            WrPool *pool);

/* ---- incremental compositor of a stack of layers, tile by tile ---- */

/* Works on fields and blend modes only; the caller owns the layers. */

typedef struct WrError WrError;

/* One layer, bottom first in the stack. Fields are borrowed for the call and may be edited in place between
   calls; the heights of a stack have one size and one wrap. */
typedef struct WrBlendLayer {
    const WrField *heights;
    const WrField *cover; /* 0..1, coverage of the layer; NULL: 1 everywhere */
    const WrField *mask;  /* 0..1; NULL: 1 everywhere */
    WrBlend mode;
    float opacity; /* 0..1; exactly 0 is equivalent to hidden */
    float radius;  /* of the smooth modes, height units, >= 0 */
    bool hidden;
} WrBlendLayer;

/* Checks the user's settings: mode, opacity, radius, and that cover and mask have the heights' size. */
bool wr_blend_layer_check(const WrBlendLayer *layer, WrError *err);

typedef struct WrCompositor WrCompositor;

/* Creates an empty compositor, without cost until it is updated. The caller owns it. */
WrCompositor *wr_compositor_new(void);
/* A copy for a snapshot that shares all cached tiles: a few pointers per layer. */
WrCompositor *wr_compositor_snapshot(const WrCompositor *compositor);
void wr_compositor_free(WrCompositor *compositor); /* NULL is fine */

/* Updates the composite to the layers and returns it.

     b = 0, the ground; then b = blend(layer, b) for each visible layer with opacity > 0, from the
     bottom up (blend.h). The lowest of these uses mix if its mode is add, which is equivalent
     except for -0: so a single layer with opacity 1 yields exactly its heights.

   The bits depend on the layers alone: not on the edits that led to them, nor on the threads, nor on which flat
   tiles are NULL.

   Cost: the tiles whose heights, cover or mask changed since the last call, times the layers there. For a layer
   whose settings, position or visibility changed: the tiles in which it (or, if several layers changed position
   at once, any of these) is not empty. Only a layer that has an effect where it is empty (mix, or max without
   cover) and the first call update all allocated tiles.
   Memory: tiles that show only the lowest layer are shared with it, and tiles in which all layers are empty are
   NULL, except for at most about as many as there are blended ones.

   layers   [count], count >= 1; checked by wr_blend_layer_check
   pool     NULL: all on this thread
   Returns  borrowed: valid until the next call. If the thread's progress is cancelled: any table Threads  one
   caller at a time, and nobody edits the layers meanwhile */
const WrField *wr_compositor_update(WrCompositor *compositor, const WrBlendLayer *layers, int count,
                                    WrPool *pool);
