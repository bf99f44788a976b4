/* large_pages.h - how the system hands out large blocks of memory.
   Belongs to one system: platform code, see src/README.md. */
#pragma once
#include <stddef.h>
#include <stdint.h>

/* A hint: the block's pages, none of which was touched yet, are best large ones, so that fewer have to be asked for and
 * fewer are looked up. Nothing is promised, and nothing in the block changes. */
void wr_pages_large(void *block, size_t bytes);

/* Bytes that could be had now without taking any from others; 0 where the system does not say. */
uint64_t wr_pages_free_bytes(void);
