/* large_pages.h - large memory pages, and the amount of free memory.
   Belongs to one system: platform code, see src/README.md. */
#pragma once
#include <stddef.h>
#include <stdint.h>

/* A hint to use large pages for an untouched block: fewer page faults and fewer page look-ups. No
 * guarantee; the content does not change. */
void wr_pages_large(void *block, size_t bytes);

/* The contrary hint, for a block of which little will be used. */
void wr_pages_small(void *block, size_t bytes);

/* Bytes available without taking memory from other programs; 0 if unknown. */
uint64_t wr_pages_free_bytes(void);
