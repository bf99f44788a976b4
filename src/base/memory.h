/* memory.h - aligned allocation.

   Allocations of bounded size abort with a message when memory is exhausted; allocations sized by the
   user return an error. */
#pragma once
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;

#define WR_ALIGN 64 /* bytes; every block starts on a cache line */

/* count * size bytes, zeroed, 64-byte aligned; aborts with a message when out of memory. For small,
   bounded sizes. Free with wr_free. */
void *wr_alloc(size_t count, size_t size);

/* wr_alloc without zeroing: for blocks that are written completely at once. */
void *wr_alloc_unset(size_t count, size_t size);

/* wr_alloc for sizes chosen by the user: returns NULL and an error that names `what` and the bytes when
   count * size overflows or memory is exhausted. Large blocks come zeroed from the system, untouched. */
void *wr_try_alloc(size_t count, size_t size, const char *what, WrError *err);

/* wr_try_alloc without zeroing. Because the system clears fresh pages, up to four freed blocks of 4 to
   128 MB are cached and reused for a request of about the same size. Any thread. */
void *wr_try_alloc_unset(size_t count, size_t size, const char *what, WrError *err);
/* Returns the cached blocks to the system. Any thread. */
void wr_memory_trim(void);

/* Resizes a block of wr_alloc or wr_realloc; keeps the first min(old, new) bytes. Aborts when out of
   memory. old_count is the count of the previous allocation. */
void *wr_realloc(void *block, size_t old_count, size_t count, size_t size);

void wr_free(void *block); /* NULL is fine */

char *wr_strdup(const char *text);                 /* caller frees with wr_free; NULL for NULL */
char *wr_strndup(const char *text, size_t length); /* copies exactly length bytes and a NUL */

/* ---- bytes in use ---- */

/* The number of bytes in use by wr_alloc and by tiles; tests use it to bound the memory of a command.

   Exact and independent of the system: blocks below WR_MEMORY_COUNTED bytes, free memory that is cached for reuse, and
   memory of libraries are not counted. Any thread. */

#define WR_MEMORY_COUNTED 4096 /* bytes; smaller blocks are not worth an atomic addition */

int64_t wr_memory_bytes(void); /* in use now */
/* Largest number in use since the last call of wr_memory_peak_begin, or since the start. */
int64_t wr_memory_peak(void);
void wr_memory_peak_begin(void);

/* For allocators on top of wr_alloc: adds the bytes of a piece, below 0 when it is freed. */
void wr_memory_count(int64_t bytes);
