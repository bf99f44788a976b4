#include "base/memory.h"

#include "base/error.h"
#include "system/pages.h"

#include <stdint.h>
#include <string.h>

#define LARGE ((size_t)8 << 20) /* bytes; malloc takes such blocks from the system, untouched */

/* Blocks above this come from mmap by way of malloc's own threshold; zeroing them by hand would touch
   every page, so calloc is asked for and its pointer aligned by hand. The original pointer is kept in
   the word before the block. */
static void *aligned(size_t bytes, bool zeroed)
{
    if (bytes > SIZE_MAX - WR_ALIGN - sizeof(void *)) return NULL;
    size_t whole = bytes + WR_ALIGN + sizeof(void *);
    char *raw = zeroed ? calloc(1, whole) : malloc(whole);
    if (!raw) return NULL;
    if (whole >= LARGE) wr_pages_large(raw, whole);
    uintptr_t start = ((uintptr_t)raw + sizeof(void *) + WR_ALIGN - 1) & ~(uintptr_t)(WR_ALIGN - 1);
    ((void **)start)[-1] = raw;
    return (void *)start;
}

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
    if (!block) wr_fail(err, "%s: no memory for %.0f MB", what, (double)count * (double)size / 1e6);
    return block;
}

void *wr_realloc(void *block, size_t old_count, size_t count, size_t size)
{
    void *grown = wr_alloc(count, size);
    if (block) memcpy(grown, block, (old_count < count ? old_count : count) * size);
    wr_free(block);
    return grown;
}

void wr_free(void *block)
{
    if (block) free(((void **)block)[-1]);
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
