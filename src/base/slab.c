#include "base/slab.h"

#include "base/memory.h"

#include <stdbool.h>

#define BLOCK ((size_t)8 << 20) /* bytes: the size from which memory.c requests large pages */
#define IDLE 10                 /* empty blocks kept for reuse: enough for a table of 4096 x 4096 */

/*     block: | WrSlab, rounded | address | piece | address | piece | ...      pitch = WR_ALIGN + rounded(bytes)
   A block is in `begun` while it has both used and free pieces, in `idle` while it is empty, and in no list while it is full:
   a full block is found again through the address before its pieces. Free pieces are linked through their first bytes; pieces
   never cut need no link, so a new block is not touched page by page. */
/* Header of a block; the pieces follow. The WR_ALIGN bytes before each piece contain the slab's
 * address. */
typedef struct WrSlab {
    struct WrSlab *before, *after; /* links of one of the lists, while it has free pieces */
    void *given;      /* the last freed piece, which starts with a pointer to the previous one */
    size_t used, cut; /* pieces in use; pieces ever cut */
} WrSlab;

/* Pieces ever handed out. Tiles of tables come and go by the thousand in each stroke, all of one size: lists of
   pieces in large blocks need no search, and a block can use large pages. */
static int64_t taken; /* atomic */

int64_t wr_slab_pieces(void)
{
    return __atomic_load_n(&taken, __ATOMIC_RELAXED);
}

static size_t rounded(size_t bytes)
{
    return (bytes + WR_ALIGN - 1) / WR_ALIGN * WR_ALIGN;
}

static void list(WrSlab **first, WrSlab *slab)
{
    slab->before = NULL;
    slab->after = *first;
    if (slab->after) slab->after->before = slab;
    *first = slab;
}

static void unlist(WrSlab **first, WrSlab *slab)
{
    if (slab->before) slab->before->after = slab->after;
    else *first = slab->after;
    if (slab->after) slab->after->before = slab->before;
}

static WrSlab **slab_of(void *piece)
{
    return (WrSlab **)(void *)((char *)piece - WR_ALIGN);
}

/* Called with the lock held. */
static void *cut(const WrSlabs *slabs, WrSlab *slab)
{
    const size_t pitch = WR_ALIGN + rounded(slabs->bytes);
    void *piece = (char *)slab + rounded(sizeof *slab) + slab->cut++ * pitch + WR_ALIGN;
    *slab_of(piece) = slab;
    return piece;
}

static bool is_full(const WrSlabs *slabs, const WrSlab *slab)
{
    const size_t pitch = WR_ALIGN + rounded(slabs->bytes);
    return !slab->given && rounded(sizeof *slab) + (slab->cut + 1) * pitch > BLOCK;
}

/* Called with the lock held. Returns a block with free pieces, preferably one in use. */
static WrSlab *slab_with_room(WrSlabs *slabs)
{
    if (slabs->begun) return slabs->begun;
    WrSlab *slab = slabs->idle;
    if (slab) {
        unlist(&slabs->idle, slab);
        slabs->idle_count--;
    } else {
        wr_memory_count(-(int64_t)BLOCK); /* pieces are counted in its place */
        slab = wr_alloc_unset(1, BLOCK);
        *slab = (WrSlab){ 0 };
    }
    list(&slabs->begun, slab);
    return slab;
}

/* Called with the lock held. */
static void *take(WrSlabs *slabs)
{
    WrSlab *slab = slab_with_room(slabs);
    void *piece = slab->given;
    if (piece) slab->given = *(void **)piece;
    else piece = cut(slabs, slab);
    slab->used++;
    if (is_full(slabs, slab)) unlist(&slabs->begun, slab);
    return piece;
}

/* Called with the lock held. Returns the block to free, or NULL. Filling a block in use before an idle one lets blocks become
   empty, so that memory returns to the system after a large edit. IDLE blocks stay for the next edit. The block is freed by
   the caller after the lock is released, since freeing 8 MB may take the system some time. */
static WrSlab *give(WrSlabs *slabs, void *piece)
{
    WrSlab *slab = *slab_of(piece);
    if (is_full(slabs, slab)) list(&slabs->begun, slab);
    *(void **)piece = slab->given;
    slab->given = piece;
    if (--slab->used > 0) return NULL;
    unlist(&slabs->begun, slab);
    if (slabs->idle_count == IDLE) return slab;
    slabs->idle_count++;
    list(&slabs->idle, slab);
    return NULL;
}

static void free_slab(WrSlab *slab)
{
    wr_free(slab);
    if (slab) wr_memory_count((int64_t)BLOCK);
}

/* With the address sanitizer every piece is an allocation of its own: inside a block, a use after free would go unnoticed. */
#ifdef __SANITIZE_ADDRESS__
void *wr_slab_alloc(WrSlabs *slabs)
{
    (void)take;
    __atomic_fetch_add(&taken, 1, __ATOMIC_RELAXED);
    return wr_alloc_unset(1, slabs->bytes);
}

void wr_slab_free(WrSlabs *slabs, void *piece)
{
    (void)slabs, (void)give;
    wr_free(piece);
}
#else
void *wr_slab_alloc(WrSlabs *slabs)
{
    wr_mutex_lock(&slabs->lock);
    void *piece = take(slabs);
    wr_mutex_unlock(&slabs->lock);
    wr_memory_count((int64_t)slabs->bytes);
    __atomic_fetch_add(&taken, 1, __ATOMIC_RELAXED);
    return piece;
}

void wr_slab_free(WrSlabs *slabs, void *piece)
{
    if (!piece) return;
    wr_mutex_lock(&slabs->lock);
    WrSlab *empty = give(slabs, piece);
    wr_mutex_unlock(&slabs->lock);
    wr_memory_count(-(int64_t)slabs->bytes);
    free_slab(empty);
}
#endif

void wr_slab_trim(WrSlabs *slabs)
{
    wr_mutex_lock(&slabs->lock);
    WrSlab *slab = slabs->idle;
    slabs->idle = NULL;
    slabs->idle_count = 0;
    wr_mutex_unlock(&slabs->lock);
    while (slab) {
        WrSlab *next = slab->after;
        free_slab(slab);
        slab = next;
    }
}
