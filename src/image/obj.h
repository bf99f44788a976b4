/* obj.h - OBJ files of triangles and quadrilaterals, which most are, several times as fast as the library reads them.
   Private to this room. Part of the reader process, and of reading "inside". */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrText WrText;

/* Read an OBJ file that is in memory: v, vt, vn, f, o, g and usemtl; numbers in any locale have a point. Comments,
 * smoothing groups and material libraries are passed over.
 *
 * whole    with normals, texture coordinates and parts
 * block    the mesh as bytes (mesh_make.h), appended; corners of one place, (u,v) and normal are one point, in the order
 *          in which faces name them first
 * Returns  false for whatever else is there: polygons of more corners, curves, points, lines, weights, continued lines,
 *          indices of what is not there yet, numbers that are none, damage, no memory. The block is then untouched, and
 *          the library reads the file, or says what is wrong with it. */
bool wr_obj_make(const char *bytes, size_t length, bool whole, WrText *block);
