/* hardcases_frames.h - measurements of meshes and their tangent frames: HC28 to HC31 and HC126 to HC136, in two
   files. Private to this module. */
#pragma once
#include "hardcases/hardcases_internal.h"
#include "surface/tangent_frames.h"

#include <stdbool.h>

#define WR_HARD_CORNERS 12
#define WR_HARD_FACES 8

/* A mesh definition: corners with normals of their own (0: none), and a normal map's (u,v). */
typedef struct WrHardMesh {
    WrTriangleCorner corner[WR_HARD_CORNERS];
    int32_t face[WR_HARD_FACES][3];
    int32_t corners, faces;
} WrHardMesh;

/* The mesh as if read from a file; owned by the caller. NULL and an error as wr_triangles_new. */
WrTriangles *wr_hard_mesh_triangles_new(const WrHardMesh *mesh, WrError *err);

/* Pictures of a mesh seen from above in every arithmetic and by the reference: each value is finite. */
bool wr_hard_check_mesh_finite(WrHardMeasurement *gauge, const WrHardMesh *mesh, WrError *err);
/* The mesh from above, orthographic, 2.2 units high about the origin, and one light. Takes ownership of the
   mesh. */
WrScene *wr_hard_above(WrTriangles *triangles, double height);

/* Its MikkTSpace frames, [3 faces]. */
bool wr_hard_mikk_frames(const WrHardMesh *mesh, WrTangent *out, WrError *err);
/* Counts a violation for each frame that is not unit, perpendicular to the corner's normal and with b = sign n x
   t. A frame with sign -1 and t (1,0,0), the value for undefined frames, need not be perpendicular. */
void wr_hard_units(WrHardMeasurement *gauge, const WrHardMesh *mesh, const WrTangent *frames);

/* clang-format off */
#define WR_HARD_FRAMES(X)                                                                          \
    X(28) X(29) X(30) X(31)                                                                        \
    X(126) X(127) X(128) X(129) X(130) X(131) X(132) X(133) X(134) X(135) X(136)
/* clang-format on */
#define WR_HARD_DECLARE(number) bool wr_hard_hc##number(WrHardMeasurement *gauge, WrError *err);
WR_HARD_FRAMES(WR_HARD_DECLARE)
#undef WR_HARD_DECLARE
