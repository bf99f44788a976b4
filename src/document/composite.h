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

/* Compositing of a group's members. The group's own blend selects their backdrop:

     add, subtract, mix   on a ground at height 0, as a document is. The group's result H is that composite.
     all others           on nothing: heights of partial coverage (wr_blend_tile_partial). So a group of one member,
                          with its blend, is the member itself, bit for bit: a soft edge blends with the heights
                          below the group, not with a ground at 0.

   The coverage C of a group is the union of its members': from 0, C + w (1 - C) for each from the bottom up, with w =
   opacity x mask x coverage of the member, whatever its blend; only mix fills its mask, so w is opacity x mask. An add or
   subtract member without content leaves H and C at 0. A filter changes H alone, everywhere, not C. A member that is a
   group counts with its own C. The group's blend, opacity, mask and radius then apply to H and C as those of a layer do to
   its heights and coverage. A group without visible members has no effect, whatever its blend.

   A group with blend add, opacity 1 and no mask, whose members are all add or subtract, changes the composite as its
   members alone would: bit for bit if it has one member or if nothing is visible below it, else by the rounding of sums
   in another order: up to 2^-23 of the sum of all absolute heights there for each member. Groups with blend and members all
   max, or all min, opacities 1 and coverages and masks 0 or 1 equal their members bit for bit. */

/* Input of a composite: rows of a document's layers. */
typedef struct WrRows {
    const WrLayer *layers;
    int from,
        to; /* members of one group, or layers of the top level, from..to - 1; with all of their members */
    bool partial; /* on nothing instead of the ground */
} WrRows;

/* Updates it to the rows, bottom first; solo: index of one that is shown even if it is hidden, or -1. Any
   number of threads may call it at once, as long as nobody edits the layers. Borrowed: valid until the next call
   after an edit.
   cover: output, their coverage, 0 if none is visible; borrowed until the next call after an edit. NULL: none */
const WrField *wr_composite_update(WrComposite *composite, const WrRows *rows, int solo,
                                   WrPool *pool, const WrField **cover);

/* The composite of the visible rows, those below layer `index` of `count` layers; the caller owns it. Layers with a line or a
   live mask keep theirs: only tiles that changed since their last call are blended again. Threads as above. */
WrField *wr_composite_below(WrComposite *composite, const WrRows *rows, int count, int index,
                            WrPool *pool);

/* ---- incremental compositor of a stack of layers, tile by tile ---- */

/* Works on fields and blend modes only; the caller owns the layers. */

typedef struct WrError WrError;

/* Backdrop on which a layer is blended. */
typedef enum WrBackdrop {
    WR_BACKDROP_GROUND,  /* heights everywhere: wr_blend_tile */
    WR_BACKDROP_PARTIAL, /* heights of partial coverage: wr_blend_tile_partial */
    WR_BACKDROP_FILTER   /* the same, but the coverage stays, and heights are changed everywhere */
} WrBackdrop;

/* One layer, bottom first in the stack. Fields are borrowed for the call and may be edited in place between
   calls; the heights of a stack have one size and one wrap. */
typedef struct WrBlendLayer {
    const WrField *heights;
    const WrField *cover; /* 0..1, coverage of the layer; NULL: 1 everywhere */
    const WrField *mask;  /* 0..1; NULL: 1 everywhere */
    WrBlend mode;
    float opacity; /* 0..1; exactly 0 is equivalent to hidden */
    float radius;  /* of the smooth modes, height units, >= 0 */
    WrBackdrop backdrop;
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
