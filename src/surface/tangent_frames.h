/* tangent_frames.h - tangent frames of triangles, for maps that are baked in them. Heights need none: their slopes go by
   wr_triangle_gradients (triangles.h), which is exact where frames are not there or lose the shear. */
#pragma once
#include "surface/triangles.h"

/* The lecture's solve: with edges E1, E2 and differences (dU1,dV1), (dU2,dV2) from the first corner
 *
 *   T = (dV2 E1 - dV1 E2) / det,  B = (-dU2 E1 + dU1 E2) / det,  det = dU1 dV2 - dU2 dV1
 *
 * det < 0: mirrored. false, and nothing is filled: det is rounding of its two terms, or what comes out is no number. */
bool wr_tangent_lecture(const WrVec3 p[3], const double uv[3][2], WrVec3 *t, WrVec3 *b,
                        double *det);

/* At one corner of one triangle. */
typedef struct WrTangent {
    WrVec3 t,
        b; /* averaged: as the solve has them, lengths and shear kept; mikk: unit, b = sign n x t */
    double sign; /* of det: +1, or -1 where (u,v) are mirrored; 0: there is no frame */
} WrTangent;

/* T and B at each corner, out [3 count]: the mean of the frames of the triangles about the corner, weighted by their
 * angles there. Never across a seam of (u,v) or of normals, nor over both signs of det. */
bool wr_tangents_average(const WrTriangleCorner *corners, const WrTriangle *triangles,
                         int32_t count, WrTangent *out, WrError *err);

/* By the rules of MikkTSpace (Mikkelsen 2008), of triangles, at the default angle of 180 degrees; out [3 count]. t is
 * unit and, but for those, across n; never NaN. Where a rule leaves something open: an indefinite triangle adopts the group that meets
 * it first, in the order of triangles and their corners; a corner that no group reaches, or whose frame
 * lies along its normal, has (1,0,0) and sign -1; -0 is 0. */
bool wr_tangents_mikk(const WrTriangleCorner *corners, const WrTriangle *triangles, int32_t count,
                      WrTangent *out, WrError *err);
