/* reference_mesh.h - where a ray meets a mesh out of a file, for the reference: a tree of boxes, and the watertight test of
   Woop, Benthin and Wald (2013), in double.
   Layer 5, private to the reference. */
#pragma once
#include "render/reference/reference_patch.h"
#include "scene/texture_sample.h"
#include "surface/tangent_frames.h"
#include "surface/triangles.h"

#include <stdbool.h>

typedef struct WrReferenceBox WrReferenceBox;
typedef struct WrReferenceMesh {
    WrTriangles *source;   /* shared; NULL: there is none */
    WrReferenceBox *boxes; /* owned; the first is the whole */
    int32_t *order;        /* triangles, those of a box one after the other; owned */
    int32_t box_count;
    WrTangent *tangents; /* [3 triangles], owned; NULL: no map is turned by them */
    bool mikk;           /* they are MikkTSpace's */
} WrReferenceMesh;

/* Takes the mesh over. Errors: no memory. */
bool wr_reference_mesh_init(WrReferenceMesh *mesh, WrTriangles *source, WrError *err);
/* Frames for a normal map that is turned by them. Errors: no memory. */
bool wr_reference_mesh_frame(WrReferenceMesh *mesh, WrNormalFrame frame, WrError *err);
/* Which way such a map runs there; false: there is no frame. */
bool wr_reference_mesh_axes(const WrReferenceMesh *mesh, const WrReferenceHit *hit,
                            WrMapAxes *axes);
void wr_reference_mesh_fini(WrReferenceMesh *mesh); /* fine on a zeroed one */
/* The nearest triangle beyond s_min: fills s, u, v, triangle and share. cull: one that looks away is none. Of a ray through
 * an edge or a corner that triangles share, one of them is hit. */
bool wr_reference_mesh_hit(const WrReferenceMesh *mesh, bool cull, const WrReferenceRay *ray,
                           WrReferenceHit *hit);
/* The point there: P, n, and Pu, Pv, laid across n, as  grad v x n  and  n x grad u  times |N|, so that Blinn's formula
 * gives unit(n - grad F); of mirrored (u,v) both have the other sign, of such without area |N| is 1. A normal whose face
 * looks to the eye does so too, by a ten-thousandth at least. */
void wr_reference_mesh_at(const WrReferenceMesh *mesh, const WrReferenceHit *hit, WrVec3 eye,
                          bool perspective, WrSurfacePoint *out);
