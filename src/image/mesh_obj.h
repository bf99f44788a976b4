/* mesh_obj.h - OBJ files of polygons, in double precision and several times as fast as the library reads them.
   Private to this module. Part of the reader process, and of reading "inside". */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrMeshBuild WrMeshBuild;

/* Read an OBJ file that is in memory into `build`: v (with a weight, colours or both after it), vt of one to three numbers,
 * vn, f, o, g and usemtl; numbers in any locale have a point. A byte order mark, remarks, also behind other words,
 * points, lines, smoothing groups and material libraries are passed over. Corners of one place, (u,v) and normal are one
 * point, in the order in which faces name them first.
 *
 * Returns  false for whatever else is there: curves, rational weights other than 1, continued lines, indices of what is
 *          not there yet, numbers that are none, damage, no memory. The library then reads the file, or says what is
 *          wrong with it. */
bool wr_obj_read(const char *bytes, size_t length, WrMeshBuild *build);
