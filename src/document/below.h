/* below.h - composites of the layers below those layers that read them, as one chain from the bottom up. Private to this
   module. */
#pragma once

typedef struct WrField WrField;
typedef struct WrLayer WrLayer;
typedef struct WrPool WrPool;

typedef struct WrBelow WrBelow;

/* A copy that shares all tables. NULL yields NULL. The caller owns it. */
WrBelow *wr_below_share(const WrBelow *below);
void wr_below_free(WrBelow *below); /* NULL is allowed */

/* The composite of the visible layers below layer `index`, 1..count; the caller owns it. The chain has a link for each
 * layer with a line or a live mask that asked: the composite up to the link before it is blended with the layers between,
 * so that n layers that read cost as much as one pass over all layers. Tiles that did not change are not blended again.
 *
 * below    the chain; *below NULL: created
 * layers   [count], bottom first
 * Threads  one caller at a time */
WrField *wr_below_update(WrBelow **below, const WrLayer *layers, int count, int index,
                         WrPool *pool);

/* The same layers with fewer, for the composite of all: those below the last link are replaced by its table, so that they
   are not blended twice; those below a layer that hides them are left out. */
typedef struct WrBelowStack {
    const WrLayer *layers; /* [count] */
    int count;
    WrLayer *own;  /* owned; NULL: they are all */
    WrField *base; /* owned; NULL: none */
} WrBelowStack;
/* below: NULL is allowed, without effect. stack: initialised to all layers */
void wr_below_begin(WrBelow *below, const WrLayer *layers, int count, WrPool *pool,
                    WrBelowStack *stack);
void wr_below_end(WrBelowStack *stack);
