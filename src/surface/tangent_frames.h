/* tangent_frames.h - tangent frames of triangles, for baked normal maps.

   Heights need none: their slopes use wr_triangle_gradients (triangles.h), which is exact where frames
   are undefined or lose the shear. */
#pragma once
#include "surface/triangles.h"

/* The lecture's equation: with edges E1, E2 and differences (dU1,dV1), (dU2,dV2) from the first corner
 *
 *   T = (dV2 E1 - dV1 E2) / det,  B = (-dU2 E1 + dU1 E2) / det,  det = dU1 dV2 - dU2 dV1
 *
 * det < 0: mirrored. Returns false, with unchanged outputs, if det is rounding error of its two terms,
 * or the result is not finite. */
bool wr_tangent_lecture(const WrVec3 p[3], const double uv[3][2], WrVec3 *t, WrVec3 *b,
                        double *det);

/* Frame at one corner of one triangle. */
typedef struct WrTangent {
    WrVec3 t,
        b; /* averaged: lengths and shear of the equation are kept; mikk: unit, b = sign n x t */
    double sign; /* of det: +1, or -1 where (u,v) are mirrored; 0: no frame */
} WrTangent;

/* T and B at each corner, out [3 count]: the mean of the frames of the triangles about the corner,
 * weighted by their angles there. Never across a seam of (u,v) or of normals, nor over both signs of
 * det. */
bool wr_tangents_average(const WrTriangleCorner *corners, const WrTriangle *triangles,
                         int32_t count, WrTangent *out, WrError *err);

/* Frames by the rules of MikkTSpace (Mikkelsen 2008) for triangles, with the default angle of 180
 * degrees; out [3 count]. t is unit and, except for the cases below, perpendicular to n; never NaN.
 * Cases that the rules leave open: an indefinite triangle adopts the group that reaches it first, in
 * the order of triangles and their corners; a corner that no group reaches, or whose frame lies along
 * its normal, has (1,0,0) and sign -1; -0 is 0. */
bool wr_tangents_mikk(const WrTriangleCorner *corners, const WrTriangle *triangles, int32_t count,
                      WrTangent *out, WrError *err);

/* Unit components x, y, z of a vector, for programs that shade by unit(x vT + y vB + z vN), vB = sign vN x vT:
 * vT and vN are interpolated between corners, and neither unit nor perpendicular. Returns false, with unchanged
 * output, if the three are almost in one plane. */
bool wr_tangent_components(WrVec3 vt, WrVec3 vn, double sign, WrVec3 of, WrVec3 *out);
