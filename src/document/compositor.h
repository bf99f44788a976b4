/* compositor.h - the composite of a stack of layers, kept up to date tile by tile.
   Layer 5. Knows fields and blend modes only; the caller keeps the layers. */
#pragma once
#include "document/blend.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrPool WrPool;

/* One layer, bottom first in the stack. Fields are borrowed for the call and may be edited in place
 * between calls; the heights of a stack have one size and one wrap. */
typedef struct WrBlendLayer {
    const WrField *heights;
    const WrField *cover; /* 0..1, where the layer says something; NULL: 1 everywhere */
    const WrField *mask;  /* 0..1; NULL: 1 everywhere */
    WrBlend mode;
    float opacity; /* 0..1; exactly 0 is as good as hidden */
    float radius;  /* of the smooth modes, height units, 0 or more */
    bool hidden;
} WrBlendLayer;

/* Check what a user can set: mode, opacity, radius, and that cover and mask have the heights' size. */
bool wr_blend_layer_check(const WrBlendLayer *layer, WrError *err);

typedef struct WrCompositor WrCompositor;

/* Empty; costs nothing until updated. The caller owns it. */
WrCompositor *wr_compositor_new(void);
/* A second one that knows what the first knows, for a snapshot: a few pointers a layer. */
WrCompositor *wr_compositor_share(const WrCompositor *compositor);
void wr_compositor_free(WrCompositor *compositor); /* NULL is fine */

/* Bring the composite up to date with the layers and return it.
 *
 *   b = 0, the ground; then b = blend(layer, b) for each visible layer with opacity > 0, from the
 *   bottom up (blend.h). The lowest of these is taken as mix where its mode is add, which is the same
 *   but for -0: so a single layer added in full gives exactly its heights.
 *
 * The bits depend on the layers alone: not on the edits that led to them, on the threads, nor on which
 * flat tiles are NULL.
 *
 * Cost: the tiles whose heights, cover or mask changed since the last call, times the layers there;
 * for a layer whose settings, place or visibility changed, the tiles where it (or, if several layers
 * changed places at once, any of these) holds something. Only a layer that acts where it holds nothing
 * (mix, or max without cover) makes all tiles that are there be done anew, as does the first call.
 * Memory: tiles that show the lowest layer alone are that layer's own, and tiles where nothing holds
 * anything are NULL, but for at most about as many as there are blended ones.
 *
 * layers   [count], count >= 1; checked by wr_blend_layer_check
 * pool     NULL: all on this thread
 * Returns  borrowed: valid until the next call. Where the thread's progress is cancelled: any table
 * Threads  one caller at a time, and nobody edits the layers meanwhile */
const WrField *wr_compositor_update(WrCompositor *compositor, const WrBlendLayer *layers, int count,
                                    WrPool *pool);
