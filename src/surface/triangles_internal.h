/* triangles_internal.h - a mesh while it is made.
   Private to this module. */
#pragma once
#include "surface/triangles.h"

#include "base/exactmath.h"

#include <math.h>

/* det of the (u,v) differences, in parts of its terms, that is nothing but the rounding of (u,v), which are floats. */
#define WR_COLLINEAR (8 * 0x1p-24)

typedef struct WrTrianglesBuild {
    const WrTrianglesSource *source;
    float (*points)[3]; /* the source's, without -0 */
    int32_t *at;        /* point -> place */
    int32_t places;
    WrVec3 *own;              /* each point's normal, unit; 0: none */
    WrTriangle *face;         /* [count] those with an area, by points */
    int32_t *of;              /* their numbers in the source */
    WrVec3 *normal;           /* theirs */
    bool *mapped;             /* they have texture coordinates */
    WrTriangleCorner *corner; /* [3 count] */
    int32_t count;
    bool closed;
    double centre[3], radius;
    WrTrianglesTold told;
} WrTrianglesBuild;

/* Rows of `size` bytes, a multiple of 4, that have the same bits get the same number, 0 .. kinds - 1 in the order of
 * their first. */
bool wr_weld(const void *rows, size_t size, int32_t count, int32_t *to, int32_t *kinds,
             WrError *err);

/* Sort, number the corners in that order, and pack the whole. NULL: no memory. */
WrTriangles *wr_triangles_finish(WrTrianglesBuild *build, WrError *err);
/* Fill in all that follows from the arrays alone. */
void wr_triangles_measure(WrTriangles *made);

/* The angle between two vectors, radians, 0 .. pi; 0 where one is 0. */
static inline double wr_angle(WrVec3 a, WrVec3 b)
{
    const WrVec3 none = { 0, 0, 0 };
    const WrVec3 p = v3_unit(a, none), q = v3_unit(b, none);
    return 2 * wr_atan2(v3_len(v3_sub(p, q)), v3_len(v3_add(p, q)));
}
