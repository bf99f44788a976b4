/* triangles_internal.h - internals of the construction of meshes.
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

/* The angle between two vectors, radians, 0 .. pi; 0 where one is 0. */
static inline double wr_angle(WrVec3 a, WrVec3 b)
{
    const WrVec3 none = { 0, 0, 0 };
    const WrVec3 p = v3_unit(a, none), q = v3_unit(b, none);
    return 2 * wr_atan2(v3_len(v3_sub(p, q)), v3_len(v3_add(p, q)));
}
