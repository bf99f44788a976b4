/* memory_count.h - the number of bytes in use by wr_alloc and by tiles; tests use it to bound the memory of a command.

   Exact and independent of the system: blocks below WR_MEMORY_COUNTED bytes, free memory that is cached for reuse, and
   memory of libraries are not counted. Any thread. */
#pragma once
#include <stdint.h>

#define WR_MEMORY_COUNTED 4096 /* bytes; smaller blocks are not worth an atomic addition */

int64_t wr_memory_bytes(void); /* in use now */
/* Largest number in use since the last call of wr_memory_peak_begin, or since the start. */
int64_t wr_memory_peak(void);
void wr_memory_peak_begin(void);

/* For allocators on top of wr_alloc: adds the bytes of a piece, below 0 when it is freed. */
void wr_memory_count(int64_t bytes);
