/* file_map.h - files seen as memory.
   Belongs to one system: platform code, see src/README.md. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef enum WrMapFor {
    WR_MAP_READ,  /* what others write to the file need not show */
    WR_MAP_WATCH, /* what others write to it shows */
    WR_MAP_SHARE  /* and what is written here shows to them */
} WrMapFor;

/* The first `length` bytes; NULL and errno. Reading beyond the file's end ends the program: for files that nobody can
   make shorter, or where that is taken into account. */
void *wr_map(int fd, size_t length, WrMapFor what);
void wr_map_end(const void *bytes, size_t length); /* NULL is fine */
