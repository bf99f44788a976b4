/* memory.h - allocation.
   Small things abort with a message when memory is gone; things sized by the user report.
   Layer 0. */
#pragma once
#include <stddef.h>

typedef struct WrError WrError;

#define WR_ALIGN 64 /* bytes; every block starts on a cache line */

/* count * size bytes, zeroed, 64-byte aligned; aborts with a message if there is none.
   For things of a bounded, small size. Free with wr_free. */
void *wr_alloc(size_t count, size_t size);

/* The same with whatever the memory held before: for what is written whole at once. */
void *wr_alloc_unset(size_t count, size_t size);

/* As wr_alloc for sizes that come from the user: NULL and an error that names `what` and the bytes
   when count * size overflows or memory is gone. Large blocks come zeroed from the system and
   untouched. */
void *wr_try_alloc(size_t count, size_t size, const char *what, WrError *err);

/* The same of any content, for what is written whole; errors likewise. Since the system clears what it hands out, two such
   blocks of 4 to 128 MB that were given back are kept for the next who asks here for about as much. Any thread. */
void *wr_try_alloc_unset(size_t count, size_t size, const char *what, WrError *err);
/* What is kept goes back to the system. Any thread. */
void wr_memory_trim(void);

/* Grow or shrink a block of wr_alloc or wr_realloc; keeps the first min(old, new) bytes. Aborts when
   memory is gone. old_count is what was asked for before. */
void *wr_realloc(void *block, size_t old_count, size_t count, size_t size);

void wr_free(void *block); /* NULL is fine */

char *wr_strdup(const char *text);                 /* caller frees with wr_free; NULL gives NULL */
char *wr_strndup(const char *text, size_t length); /* copies exactly length bytes and a NUL */
