/* mesh_obj.h - reader of polygonal OBJ files in double precision, several times as fast as the
   library.
   Private to this module.
   Part of the reader process, and of reading "inside". */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrMeshBuild WrMeshBuild;

/* Reads an OBJ file in memory into `build`: v (with a weight, colours or both after it), vt of one to
 * three numbers, vn, f, o, g and usemtl; numbers always have a decimal point. A byte order mark,
 * comments (also after other words), points, lines, smoothing groups and material libraries are
 * ignored. Corners of one position, (u,v) and normal are one point, in the order of their first use by
 * faces.
 *
 * Returns  false for all other content: curves, rational weights other than 1, continued lines, forward
 *          indices, invalid numbers, damage, lack of memory. *wrong is then an error that the library
 *          would not notice, or NULL: the library reads the file, or reports the error. */
bool wr_obj_read(const char *bytes, size_t length, WrMeshBuild *build, const char **wrong);
