/* slab.h - an allocator for many pieces of one size.

   Pieces are cut from blocks large enough for large pages, which need a hundred times fewer page faults
   and page look-ups. Any thread may take and free pieces. With the address sanitizer each piece is a
   block of its own. */
#pragma once
#include "system/thread.h"

#include <stddef.h>
#include <stdint.h>

/* All pieces of one size, for the life of the program: { WR_SLABS_OF(bytes) }. */
typedef struct WrSlabs {
    size_t bytes;                /* of a piece */
    WrMutex lock;                /* guards the members below */
    struct WrSlab *begun, *idle; /* blocks in use with free pieces; blocks without used pieces */
    int idle_count;
} WrSlabs;

#define WR_SLABS_OF(size) .bytes = (size), .lock = WR_MUTEX_READY

/* Returns a piece aligned to WR_ALIGN with undefined content; aborts when out of memory, like memory.h. */
void *wr_slab_alloc(WrSlabs *slabs);
/* Frees a piece of the same slabs; NULL does nothing. Some empty blocks are cached for reuse, because
 * the system clears fresh pages; the others return to the system. */
void wr_slab_free(WrSlabs *slabs, void *piece);
/* Returns the cached empty blocks to the system. Any thread; pieces in use are unchanged. */
void wr_slab_trim(WrSlabs *slabs);

/* Number of pieces that this process has taken, for tests that count work. */
int64_t wr_slab_pieces(void);
