/* mesh_make.h - a mesh file read within this process, and what travels from the reader process.
   Private to this room. */
#pragma once
#include "image/mesh.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrText WrText;

/* A mesh as bytes: this, then the points, then the corners. */
typedef struct WrMeshHead {
    int32_t points, triangles;
} WrMeshHead;

/* Load the module that holds the library; it stays loaded. */
bool wr_mesh_load(WrError *err);

/* Read a file that is in memory.
 *
 * ending   of the file's name: what it is believed to be
 * block    the mesh as bytes, appended
 * memory   set to whether the failure was one of memory; may be NULL
 * Errors   one sentence that does not name the file */
bool wr_mesh_make(const void *bytes, size_t length, const char *ending, WrText *block, bool *memory,
                  WrError *err);
