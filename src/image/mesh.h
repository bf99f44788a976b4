/* mesh.h - files of triangles: OBJ, PLY, STL, glTF and what else the library reads.
   Knows no tables. Files are strangers' and are read by the reader process, as pictures are. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;

#define WR_MESH_FILE_MAX ((size_t)1 << 30) /* bytes */
#define WR_MESH_POINTS_MAX 9000000
#define WR_MESH_TRIANGLES_MAX 9000000

#define WR_MESH_NAME 64

/* What a material carries, or one placing of a body. */
typedef struct WrMeshPart {
    int32_t first, count;    /* triangles */
    char name[WR_MESH_NAME]; /* its material's, cut, or its own; may be empty */
} WrMeshPart;

/* All that a file holds, each part where the file puts it, in the file's own unit and axes. Where a body lies so far from
   the file's origin that 32-bit floats would round its relief, `origin` has been subtracted from its coordinates. */
typedef struct WrMesh {
    double origin[3]; /* add it to get the file's coordinates; 0,0,0 of a body that is near */
    bool single;      /* the coordinates were read as 32-bit floats */
    const float (*points)[3];    /* [point_count] x, y, z; finite, within 1e30 of 0 */
    const int32_t (*corners)[3]; /* [triangle_count] indices of points; polygons are cut up */
    int32_t point_count, triangle_count;
    /* Of a file that was read whole, else NULL and 0: */
    const float (*normals)[3]; /* [point_count], of any length; 0: the file has none there */
    const float (*uv)[2];      /* [point_count], v upwards; not a number: the file has none there */
    const WrMeshPart *parts;   /* [part_count], together all triangles in order */
    int32_t part_count;
    char *block; /* owned: all */
} WrMesh;

/* Read a file, and of a glTF the buffers beside it (gltf.h). out: the caller's (fini); untouched on failure.
 * Errors   name the file: it cannot be read, is of no known kind, is damaged or hostile; it holds no
 *          triangle, or too many; a point is not finite (the first such one is named)
 * Threads  any number at once */
bool wr_mesh_read(const char *path, WrMesh *out, WrError *err);
/* The same from bytes in memory; name stands in messages, and its ending counts as a path's. */
bool wr_mesh_read_bytes(const char *name, const void *bytes, size_t length, WrMesh *out,
                        WrError *err);
/* Both with normals, texture coordinates and parts. */
bool wr_mesh_read_whole(const char *path, WrMesh *out, WrError *err);
bool wr_mesh_read_whole_bytes(const char *name, const void *bytes, size_t length, WrMesh *out,
                              WrError *err);
void wr_mesh_fini(WrMesh *mesh);
