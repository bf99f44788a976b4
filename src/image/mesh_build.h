/* mesh_build.h - a mesh under construction, in double precision: what every reader of mesh files fills in.
   Private to src/image. Part of the reader process, and of reading "inside".

   Coordinates stay double until the end. A mesh that lies far from the origin, as in the coordinates of a map, would lose
   its relief to 32-bit floats; then the lowest corner of its box is subtracted first (WrMesh, origin). */
#pragma once
#include "image/mesh.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrText WrText;

/* Zero-initialise, set `whole`; fini frees. */
typedef struct WrMeshBuild {
    bool whole;              /* with normals, (u,v) and parts; else those are dropped */
    bool single;             /* the coordinates were 32-bit floats already */
    bool memory;             /* a failure was one of memory */
    char part[WR_MESH_NAME]; /* of the triangles that follow; set by wr_mesh_build_part */
    double (*points)[3];
    float (*normals)[3]; /* only of a whole one; 0: none */
    float (*uv)[2];      /* only of a whole one; not a number: none */
    int32_t *next;       /* of wedges: 1 + an earlier one of the same place; 0: none */
    int32_t (*corners)[3];
    WrMeshPart *parts;
    int32_t point_count, triangle_count, part_count;
    size_t point_room, triangle_room;
    int64_t work; /* steps that cutting of polygons has taken */
} WrMeshBuild;

void wr_mesh_build_fini(WrMeshBuild *build);
/* Make room for so many points (triangles) more. Only for speed. Errors: too many, no memory. */
bool wr_mesh_build_reserve(WrMeshBuild *build, int64_t points, int64_t triangles, WrError *err);
/* Add a point. normal, uv: NULL: none. Its number is point_count before. Errors: too many, no memory. */
bool wr_mesh_build_point(WrMeshBuild *build, const double p[3], const float normal[3],
                         const float uv[2], WrError *err);
/* A point that is made only if the place has none with this normal and (u,v).
 * first    of the place: 1 + its latest point, 0 at the beginning; updated
 * Returns its number, or -1 with an error: too many, no memory */
int32_t wr_mesh_build_wedge(WrMeshBuild *build, int32_t *first, const double p[3],
                            const float normal[3], const float uv[2], WrError *err);
/* The name of the triangles that follow; cut where it is longer. */
void wr_mesh_build_part(WrMeshBuild *build, const char *name, size_t length);
bool wr_mesh_build_triangle(WrMeshBuild *build, int32_t a, int32_t b, int32_t c, WrError *err);
/* Cut a polygon into count - 2 triangles: a dented quadrilateral at its dent, another dented polygon ear by ear, else as a fan.
 * corners  [count] numbers of points; fewer than 3 are nothing
 * Errors   too many triangles; dented polygons of so many corners that cutting would take minutes; no memory */
bool wr_mesh_build_polygon(WrMeshBuild *build, const int32_t *corners, int32_t count, WrError *err);
/* A strip of triangles: corners i, i+1, i+2, every other one turned. Those with two equal corners are left out. */
bool wr_mesh_build_strip(WrMeshBuild *build, const int32_t *corners, int32_t count, WrError *err);
/* The mesh as bytes (mesh_decode.h), appended. Errors: no triangle; a point that is not finite or beyond 1e30 (the first
 * is named). */
bool wr_mesh_build_finish(const WrMeshBuild *build, WrText *block, WrError *err);
