/* stl.h - reader of STL files: binary, or ASCII in letters of either case.
   Private to this module.
   Part of the reader process, and of reading "inside".

   The library is not used because it rejects capitals and truncates ASCII coordinates to 32-bit floats. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;
typedef struct WrMeshBuild WrMeshBuild;

/* Reads an STL file in memory into `build`: three points per triangle, with the facet's normal; each
 * solid is a part.
 * Errors   one sentence that does not name the file, with the position and kind of the damage */
bool wr_stl_read(const char *bytes, size_t length, WrMeshBuild *build, WrError *err);
