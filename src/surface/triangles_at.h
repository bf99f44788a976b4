/* triangles_at.h - the places of a mesh, or of a set of patches, that have given texture coordinates.
   Texture coordinates are compared modulo 1, as the table repeats; where they overlap there are several places,
   and none where the mesh leaves a gap. */
#pragma once
#include "surface/surface.h"
#include "surface/triangles.h"

/* One such place: a triangle of a mesh with its shares of corners 1 and 2; or a patch with its own u and v. */
typedef struct WrTrianglesPlace {
    int32_t index;
    double share[2]; /* 0..1 */
} WrTrianglesPlace;

/* Find them, in the order of the triangles or patches; an edge that two of them share counts once.
 *
 * out      [most] the first ones
 * Returns  how many there are in all */
int64_t wr_triangles_find(const WrTriangles *triangles, double u, double v, int most,
                          WrTrianglesPlace *out);
/* The point there, as pictures shade it. n is the shading normal; Pu and Pv are laid across it, so that slopes of the table
 * turn it as their gradient over the surface says:
 *   Pu = |N| grad v x n,  Pv = |N| n x grad u,  |N| = 1 / |grad u x grad v|
 * Blinn's formula then gives unit(n - grad F). Where (u,v) are mirrored, Pu and Pv have the other sign.
 * Second derivatives and those of n are 0. Where (u,v) have no area, |N| is 1. */
void wr_triangles_at(const WrTriangles *triangles, const WrTrianglesPlace *place,
                     WrSurfacePoint *out);
