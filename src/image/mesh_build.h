/* mesh_build.h - a mesh under construction in double precision, filled in by the readers of mesh
   files.
   Private to src/image.
   Part of the reader process, and of reading "inside".

   Coordinates stay double until the end. A mesh far from the origin, as in map coordinates, would lose
   its relief in 32-bit floats; so the lowest corner of its bounding box is subtracted first (WrMesh,
   origin). */
#pragma once
#include "base/length_unit.h"
#include "image/mesh.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrText WrText;

/* Zero-initialise, set `whole`; fini frees. */
typedef struct WrMeshBuild {
    bool whole;              /* with normals, (u,v) and parts; otherwise these are dropped */
    bool single;             /* the coordinates were 32-bit floats already */
    WrLengthUnit unit;       /* stated by the file */
    bool memory;             /* the failure was lack of memory */
    char part[WR_MESH_NAME]; /* name of the following triangles; set by wr_mesh_build_part */
    double (*points)[3];
    float (*normals)[3]; /* only if whole; 0: none */
    float (*uv)[2];      /* only if whole; NaN: none */
    int32_t *next;       /* for wedges: 1 + previous point at the same place; 0: none */
    int32_t (*corners)[3];
    WrMeshPart *parts;
    int32_t point_count, triangle_count, part_count;
    size_t point_room, triangle_room;
    int32_t bad_uv; /* points with (u,v) that are no numbers, or beyond 1e6; stored as missing */
    double bad_uv_at[3]; /* the first of them */
    int64_t work;        /* steps used by triangulation so far */
} WrMeshBuild;

void wr_mesh_build_fini(WrMeshBuild *build);
/* Reserves memory for this many more points (triangles). Only for speed. Errors: too many, out of
 * memory. */
bool wr_mesh_build_reserve(WrMeshBuild *build, int64_t points, int64_t triangles, WrError *err);
/* Adds a point. normal, uv: NULL: none. Its index is the previous point_count. Errors: too many, out of
 * memory. */
bool wr_mesh_build_point(WrMeshBuild *build, const double p[3], const float normal[3],
                         const float uv[2], WrError *err);
/* Adds a point, unless the place already has one with this normal and (u,v).
 * first    of the place: 1 + its latest point, 0 at the beginning; updated
 * Returns  its index, or -1 with an error: too many, out of memory */
int32_t wr_mesh_build_wedge(WrMeshBuild *build, int32_t *first, const double p[3],
                            const float normal[3], const float uv[2], WrError *err);
/* Sets the name of the following triangles; long names are truncated. */
void wr_mesh_build_part(WrMeshBuild *build, const char *name, size_t length);
bool wr_mesh_build_triangle(WrMeshBuild *build, int32_t a, int32_t b, int32_t c, WrError *err);
/* Triangulates a polygon into count - 2 triangles: a concave quadrilateral at its reflex corner, other
 * concave polygons by ear clipping, convex ones as a fan.
 * corners  [count] point indices; fewer than 3 are ignored
 * Errors   too many triangles; concave polygons of so many corners that triangulation would take
 *          minutes; out of memory */
bool wr_mesh_build_polygon(WrMeshBuild *build, const int32_t *corners, int32_t count, WrError *err);
/* Adds a strip of triangles: corners i, i+1, i+2, every other one reversed. Degenerate ones are
 * skipped. */
bool wr_mesh_build_strip(WrMeshBuild *build, const int32_t *corners, int32_t count, WrError *err);
