/* below.h - composites of the layers below those layers that read them, as one chain from the bottom up. Private to this
   module. */
#pragma once

typedef struct WrField WrField;
typedef struct WrLayer WrLayer;
typedef struct WrPool WrPool;
typedef struct WrRows WrRows;

typedef struct WrBelow WrBelow;

/* A copy that shares all tables. NULL yields NULL. The caller owns it. */
WrBelow *wr_below_share(const WrBelow *below);
void wr_below_free(WrBelow *below); /* NULL is allowed */

/* The composite of the visible rows below layer `index`; the caller owns it. Only tiles that changed are blended again. Without
 * groups, the chain has a link for each layer with a line or a live mask that was requested: the composite up to the link before it is
 * blended with the layers between, so that n layers that read cost as much as one pass over all layers.
 *
 * below    the chain; *below NULL: created
 * rows     at least one; of layers [count], bottom first
 * Threads  one caller at a time */
WrField *wr_below_update(WrBelow **below, const WrRows *rows, int count, int index, WrPool *pool);

/* The same layers with fewer, for the composite of all: those below the last link are replaced by its table, so that they
   are not blended twice; those below a layer that hides them are left out. */
typedef struct WrBelowStack {
    const WrLayer *layers; /* [count]; those from `from` on are blended */
    int count, from;
    WrLayer *own;  /* owned; NULL: they are all */
    WrField *base; /* owned; NULL: none */
} WrBelowStack;
/* layers: [count], without groups. stack: initialised to all layers */
void wr_below_begin(WrBelow *below, const WrLayer *layers, int count, WrPool *pool,
                    WrBelowStack *stack);
void wr_below_end(WrBelowStack *stack);
