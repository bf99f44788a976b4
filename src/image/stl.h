/* stl.h - STL files: binary, or written out in letters of either case.
   Private to this module. Part of the reader process, and of reading "inside".

   They are read here because the library takes no capitals and cuts written-out coordinates to 32-bit floats. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;
typedef struct WrMeshBuild WrMeshBuild;

/* Read an STL file that is in memory into `build`: three points a triangle, with the facet's normal; each solid is a part.
 * Errors   one sentence that does not name the file, but says where it is damaged and by what */
bool wr_stl_read(const char *bytes, size_t length, WrMeshBuild *build, WrError *err);
