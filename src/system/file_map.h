/* file_map.h - memory-mapped files.
   Belongs to one system: platform code, see src/README.md. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef enum WrMapFor {
    WR_MAP_READ,  /* later writes to the file need not be visible */
    WR_MAP_WATCH, /* later writes to the file are visible */
    WR_MAP_SHARE  /* writes to the memory change the file */
} WrMapFor;

/* Maps the first `length` bytes; NULL and errno. Access beyond the file's end kills the program: use it
   only for files that cannot be shortened, or where that risk is handled. */
void *wr_map(int fd, size_t length, WrMapFor what);
void wr_map_end(const void *bytes, size_t length); /* NULL is allowed */
