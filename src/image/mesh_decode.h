/* mesh_decode.h - a mesh file read within this process, and what travels from the reader process.
   Private to this module. */
#pragma once
#include "image/mesh.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrText WrText;

/* A mesh as bytes: this, then the points, then the corners; of a whole one then the normals, the (u,v) and the parts. */
typedef struct WrMeshHead {
    double origin[3];
    int32_t points, triangles, whole, parts, single, unused;
} WrMeshHead;

#define WR_MESH_PARTS_MAX 4096
#define WR_MESH_WHOLE "w" /* what is asked of the reader process for a whole one; else nothing */

/* Load the module that holds the library; it stays loaded. */
bool wr_mesh_load(WrError *err);

/* Read a file that is in memory.
 *
 * ending   of the file's name: what it is believed to be
 * whole    with normals, texture coordinates and parts
 * block    the mesh as bytes, appended
 * memory   set to whether the failure was one of memory; may be NULL
 * Errors   one sentence that does not name the file */
bool wr_mesh_make(const void *bytes, size_t length, const char *ending, bool whole, WrText *block,
                  bool *memory, WrError *err);
