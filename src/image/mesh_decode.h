/* mesh_decode.h - mesh decoding in the present process, and the serialised mesh of the reader process.
   Private to this module. */
#pragma once
#include "image/mesh.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrText WrText;

/* Header of a serialised mesh; the points follow, then the corners; for a whole mesh the normals, the
 * (u,v) and the parts. */
typedef struct WrMeshHead {
    double origin[3], bad_uv_at[3];
    int32_t points, triangles, whole, parts, single, unit, bad_uv;
} WrMeshHead;

#define WR_MESH_PARTS_MAX 4096
#define WR_MESH_WHOLE "w" /* request to the reader process for a whole mesh; else nothing */

/* Loads the module that contains the library; it stays loaded. */
bool wr_mesh_load(WrError *err);

/* Reads a file in memory.
 *
 * ending   extension of the file's name: its assumed format
 * whole    with normals, texture coordinates and parts
 * block    the serialised mesh, appended
 * memory   set to true if the failure was lack of memory; may be NULL
 * Errors   one sentence that does not name the file */
bool wr_mesh_make(const void *bytes, size_t length, const char *ending, bool whole, WrText *block,
                  bool *memory, WrError *err);
