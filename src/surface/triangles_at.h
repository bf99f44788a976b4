/* triangles_at.h - search for the points of a mesh or patch set with given texture coordinates.

   Texture coordinates are compared modulo 1, as the table repeats; where they overlap there are several
   points, and none where the mesh leaves a gap. */
#pragma once
#include "surface/surface.h"
#include "surface/triangles.h"

/* One such point: a triangle of a mesh with its weights of corners 1 and 2; or a patch with its own u
 * and v. */
typedef struct WrTrianglesPlace {
    int32_t index;
    double share[2]; /* 0..1 */
} WrTrianglesPlace;

/* Finds them, in the order of the triangles or patches; an edge shared by two of them counts once.
 *
 * out      [most] the first ones
 * Returns  their total number */
int64_t wr_triangles_find(const WrTriangles *triangles, double u, double v, int most,
                          WrTrianglesPlace *out);
/* The surface point there, as used in shading. n is the shading normal; Pu and Pv are perpendicular to
 * it, so that slopes of the table tilt it by their gradient over the surface:
 *
 *   Pu = |N| grad v x n,  Pv = |N| n x grad u,  |N| = 1 / |grad u x grad v|
 *
 * Blinn's formula then yields unit(n - grad F). Where (u,v) are mirrored, Pu and Pv have the opposite
 * sign. Second derivatives and those of n are 0. Where (u,v) have no area, |N| is 1. */
void wr_triangles_at(const WrTriangles *triangles, const WrTrianglesPlace *place,
                     WrSurfacePoint *out);
