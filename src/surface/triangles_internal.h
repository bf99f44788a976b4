/* triangles_internal.h - internals of meshes: their construction and edges.
   Private to this module. */
#pragma once
#include "surface/triangles.h"

#include "base/exactmath.h"

#include <math.h>

/* Threshold of the determinant of (u,v) differences, relative to its terms, below which it is rounding
 * of (u,v), which are floats. */
#define WR_COLLINEAR (8 * 0x1p-24)

typedef struct WrTrianglesBuild {
    const WrTrianglesSource *source;
    float (*points)[3]; /* those of the source, without -0 */
    int32_t *at;        /* point -> position index */
    int32_t places;
    WrVec3 *own;              /* each point's normal, unit; 0: none */
    WrTriangle *face;         /* [count] those with an area, by point indices */
    int32_t *of;              /* their indices in the source */
    WrVec3 *normal;           /* their normals */
    bool *mapped;             /* they have texture coordinates */
    WrTriangleCorner *corner; /* [3 count] */
    int32_t count;
    bool closed;
    double centre[3], radius;
    WrTrianglesReport report;
} WrTrianglesBuild;

/* Half-edge 3 i + k leads from corner k of triangle i to the next. Edges are compared by positions. */
typedef struct WrMeshEdges {
    int32_t *place; /* [corner_count] corner -> position; owned */
    int32_t *edge;  /* [3 triangle_count] half-edge -> edge; owned */
    int32_t places, count;
} WrMeshEdges;

bool wr_mesh_edges_find(const WrTriangles *mesh, WrMeshEdges *out, WrError *err);
void wr_mesh_edges_fini(WrMeshEdges *edges);

/* The angle between two vectors, radians, 0 .. pi; 0 where one is 0. */
static inline double wr_angle(WrVec3 a, WrVec3 b)
{
    const WrVec3 none = { 0, 0, 0 };
    const WrVec3 p = v3_unit(a, none), q = v3_unit(b, none);
    return 2 * wr_atan2(v3_len(v3_sub(p, q)), v3_len(v3_add(p, q)));
}
