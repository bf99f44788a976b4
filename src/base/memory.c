#include "base/memory.h"

#include "base/error.h"
#include "system/large_pages.h"
#include "system/thread.h"

#include <stdint.h>
#include <string.h>

/* bytes; malloc maps such blocks from the system, zeroed and untouched */
#define LARGE ((size_t)8 << 20)
/* From this size on, malloc maps blocks whatever was freed before; they start at a large page. */
#define PAGED ((size_t)33 << 20)
#define PAGE ((size_t)2 << 20)
/* Range of block sizes, in bytes, that are cached after wr_free. */
#define KEPT_MIN ((size_t)4 << 20)
#ifdef __SANITIZE_ADDRESS__
#define KEPT_MAX ((size_t)0) /* no cache: the sanitizer must detect any use after free */
#else
#define KEPT_MAX ((size_t)128 << 20)
#endif
#define KEPT 4 /* cached blocks: heights, two slopes and sums of an occlusion map */

/* Header before each block. */
typedef struct Head {
    void *raw;      /* pointer returned by malloc */
    size_t kept;    /* bytes of a block that may be cached when freed; else 0 */
    size_t counted; /* bytes in wr_memory_bytes while the block is in use */
} Head;

/* Cache of freed blocks; guarded by `lock`. */
static void *kept[KEPT];
static WrMutex lock = WR_MUTEX_READY;

static int64_t in_use, peak; /* bytes; atomic */

int64_t wr_memory_bytes(void)
{
    return __atomic_load_n(&in_use, __ATOMIC_RELAXED);
}

int64_t wr_memory_peak(void)
{
    return __atomic_load_n(&peak, __ATOMIC_RELAXED);
}

void wr_memory_peak_begin(void)
{
    __atomic_store_n(&peak, wr_memory_bytes(), __ATOMIC_RELAXED);
}

void wr_memory_count(int64_t bytes)
{
    const int64_t now = __atomic_add_fetch(&in_use, bytes, __ATOMIC_RELAXED);
    int64_t most = wr_memory_peak();
    while (now > most && !__atomic_compare_exchange_n(&peak, &most, now, true, __ATOMIC_RELAXED,
                                                      __ATOMIC_RELAXED)) {
    }
}

static Head *head_of(void *block)
{
    return (Head *)block - 1;
}

/* Blocks above LARGE come from mmap through malloc's own threshold. Zeroing them by hand would touch
   every page, so calloc is used and its pointer is aligned by hand. */
static void *aligned(size_t bytes, bool zeroed)
{
    const size_t align = bytes >= PAGED ? PAGE : WR_ALIGN;
    if (bytes > SIZE_MAX - align - sizeof(Head)) return NULL;
    size_t whole = bytes + align + sizeof(Head);
    char *raw = zeroed ? calloc(1, whole) : malloc(whole);
    if (!raw && whole >= KEPT_MIN) { /* cached blocks may be using the memory that is missing */
        wr_memory_trim();
        raw = zeroed ? calloc(1, whole) : malloc(whole);
    }
    if (!raw) return NULL;
    if (whole >= LARGE) wr_pages_large(raw, whole);
    /* Layout: raw ... [Head] [block]; the block is aligned to WR_ALIGN (a cache line), or to a large page for huge ones, and
       the header lies directly before it. */
    uintptr_t start = ((uintptr_t)raw + sizeof(Head) + align - 1) & ~(uintptr_t)(align - 1);
    const size_t counted = bytes < WR_MEMORY_COUNTED ? 0 : bytes;
    *head_of((void *)start) = (Head){ raw, 0, counted };
    if (counted) wr_memory_count((int64_t)counted);
    return (void *)start;
}

/* Small requests abort on failure: they cannot be refused sensibly. Sizes that depend on files or users go through
   wr_try_alloc, which returns an error. */
static void *alloc(size_t count, size_t size, bool zeroed)
{
    size_t bytes;
    void *block = __builtin_mul_overflow(count, size, &bytes) ? NULL : aligned(bytes, zeroed);
    if (!block) {
        fprintf(stderr, "wrinkle: out of memory (%zu x %zu bytes)\n", count, size);
        abort();
    }
    return block;
}

void *wr_alloc(size_t count, size_t size)
{
    return alloc(count, size, true);
}

void *wr_alloc_unset(size_t count, size_t size)
{
    return alloc(count, size, false);
}

void *wr_try_alloc(size_t count, size_t size, const char *what, WrError *err)
{
    size_t bytes;
    void *block = NULL;
    if (!__builtin_mul_overflow(count, size, &bytes)) block = aligned(bytes, true);
    if (!block)
        wr_fail(err, "%s: not enough memory for %.0f MB", what, (double)count * (double)size / 1e6);
    return block;
}

void *wr_realloc(void *block, size_t old_count, size_t count, size_t size)
{
    void *grown = wr_alloc(count, size);
    if (block) memcpy(grown, block, (old_count < count ? old_count : count) * size);
    wr_free(block);
    return grown;
}

static void give(void *block)
{
    if (block) free(head_of(block)->raw);
}

/* Returns a cached block that is large enough and not much larger; NULL if none. Reusing a large block saves the page faults
   of fresh memory, which take longer than the work on it in repeated exports and filters. */
static void *take_kept(size_t bytes)
{
    void *block = NULL;
    wr_mutex_lock(&lock);
    for (int i = 0; i < KEPT && !block; i++) {
        if (!kept[i] || head_of(kept[i])->kept < bytes || head_of(kept[i])->kept / 2 > bytes)
            continue;
        block = kept[i];
        kept[i] = NULL;
    }
    wr_mutex_unlock(&lock);
    return block;
}

/* Caches a block; returns the block to free instead: the oldest one, or NULL. */
static void *keep(void *block)
{
    wr_mutex_lock(&lock);
    void *oldest = kept[KEPT - 1];
    memmove(kept + 1, kept, (KEPT - 1) * sizeof *kept);
    kept[0] = block;
    wr_mutex_unlock(&lock);
    return oldest;
}

void *wr_try_alloc_unset(size_t count, size_t size, const char *what, WrError *err)
{
    size_t bytes;
    if (__builtin_mul_overflow(count, size, &bytes) || bytes < KEPT_MIN || bytes > KEPT_MAX)
        return wr_try_alloc(count, size, what, err);
    void *block = take_kept(bytes);
    if (block) {
        wr_memory_count((int64_t)head_of(block)->counted);
        return block;
    }
    block = wr_try_alloc(count, size, what, err);
    if (block) head_of(block)->kept = bytes;
    return block;
}

void wr_memory_trim(void)
{
    for (int i = 0; i < KEPT; i++) give(keep(NULL));
}

void wr_free(void *block)
{
    if (!block) return;
    const Head *head = head_of(block);
    if (head->counted) wr_memory_count(-(int64_t)head->counted);
    give(head->kept ? keep(block) : block);
}

char *wr_strdup(const char *text)
{
    return text ? wr_strndup(text, strlen(text)) : NULL;
}

char *wr_strndup(const char *text, size_t length)
{
    char *copy = wr_alloc(length + 1, 1);
    memcpy(copy, text, length);
    return copy;
}
