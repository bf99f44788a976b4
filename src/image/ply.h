/* ply.h - what a PLY file says that it holds, before anybody believes it.
   Private to this room. Part of the reader process, and of reading "inside". */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;

/* Whether the bytes are no PLY file, or one whose header names no more vertices, faces or other elements
 * than there are bytes after it: readers work off, one by one, whatever number stands there.
 * Errors   one sentence that does not name the file */
bool wr_ply_check(const char *bytes, size_t length, WrError *err);
