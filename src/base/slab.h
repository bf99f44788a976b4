/* slab.h - many pieces of one size, cut from blocks that are so large that the system gives them large pages: a hundred
   times fewer to ask for, and to look up.
   Layer 0. Any thread may take and give back. With the address sanitizer each piece is a block of its own. */
#pragma once
#include "system/thread.h"

#include <stddef.h>

/* Of one size, as long as the program runs: { WR_SLABS_OF(bytes) }. */
typedef struct WrSlabs {
    size_t bytes; /* of a piece */
    WrMutex lock; /* guards what follows */
    struct WrSlab *begun,
        *idle; /* blocks in use that have pieces left; of which nothing is taken */
    int idle_count;
} WrSlabs;

#define WR_SLABS_OF(size) .bytes = (size), .lock = WR_MUTEX_READY

/* A piece, aligned to WR_ALIGN, of any content; without memory the program ends, as in memory.h. */
void *wr_slab_take(WrSlabs *slabs);
/* What was taken from the same; NULL does nothing. Of the blocks of which nothing is taken any more some are kept for the
 * next who asks, since the system clears what it hands out; the others go back to it. */
void wr_slab_give(WrSlabs *slabs, void *piece);
/* Those that are kept go back as well. Any thread; pieces that are out stay as they are. */
void wr_slab_trim(WrSlabs *slabs);
