/* mesh.h - triangle mesh files: OBJ, PLY, STL, glTF, 3MF and other formats of the library.

   Independent of height tables. Files are untrusted and are read by the reader process, like images. */
#pragma once
#include "base/length_unit.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;

#define WR_MESH_FILE_MAX ((size_t)1 << 30) /* bytes */
#define WR_MESH_POINTS_MAX 9000000
#define WR_MESH_TRIANGLES_MAX 9000000

#define WR_MESH_NAME 64

/* The triangles of one material, or one instance of a body. */
typedef struct WrMeshPart {
    int32_t first, count;    /* triangles */
    char name[WR_MESH_NAME]; /* name of its material, truncated, or its own; may be empty */
} WrMeshPart;

/* The geometry of a file, each part with its transform, in the file's own unit and axes. If a body is
   so far from the file's origin that 32-bit floats would round its relief, `origin` has been subtracted
   from its coordinates. */
typedef struct WrMesh {
    double origin[3];  /* add it to get the file's coordinates; 0,0,0 for a body near the origin */
    bool single;       /* the coordinates in the file are 32-bit floats */
    WrLengthUnit unit; /* stated by the file (3MF) */
    int32_t bad_uv;    /* points whose (u,v) in the file are no numbers, or beyond 1e6: missing */
    double bad_uv_at[3];         /* the first of them, in the file's coordinates */
    const float (*points)[3];    /* [point_count] x, y, z; finite, within 1e30 of 0 */
    const int32_t (*corners)[3]; /* [triangle_count] point indices; polygons are triangulated */
    int32_t point_count, triangle_count;
    /* For a file read whole, else NULL and 0: */
    const float (*normals)[3]; /* [point_count], of any length; 0: none in the file */
    const float (*uv)[2];      /* [point_count], v upwards; NaN: none in the file */
    const WrMeshPart *parts;   /* [part_count], covering all triangles in order */
    int32_t part_count;
    char *block; /* owned: memory of all arrays */
} WrMesh;

/* Endings of the mesh files that dialogs offer and that name a mesh without another word; NULL-terminated. */
#define WR_MESH_ENDINGS                                                                            \
    "obj", "ply", "stl", "gltf", "glb", "3mf", "off", "dae", "3ds", "fbx", "lwo", "x3d"
extern const char *const wr_mesh_endings[];
bool wr_mesh_named(const char *path); /* the file's name has one of them */

/* Reads a file; for a glTF also the buffers beside it (gltf.h). out: owned by the caller (fini);
 * unchanged on failure.
 * Errors   name the file: unreadable, unknown format, damaged or hostile; no triangle, or too many; a
 *          point is not finite (the first one is named)
 * Threads  any number at once */
bool wr_mesh_read(const char *path, WrMesh *out, WrError *err);
/* Reads a mesh in memory; name is used in messages, and its extension selects the format. */
bool wr_mesh_read_bytes(const char *name, const void *bytes, size_t length, WrMesh *out,
                        WrError *err);
/* Both functions with normals, texture coordinates and parts. */
bool wr_mesh_read_attributes(const char *path, WrMesh *out, WrError *err);
bool wr_mesh_read_whole_bytes(const char *name, const void *bytes, size_t length, WrMesh *out,
                              WrError *err);
void wr_mesh_fini(WrMesh *mesh);
