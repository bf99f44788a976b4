/* reference_mesh.h - ray intersection with a mesh file, for the reference.
   Private to the reference. A tree of boxes, and the watertight test of Woop, Benthin and Wald (2013), in
   double. */
#pragma once
#include "render/reference/reference_patch.h"
#include "scene/texture_sample.h"
#include "surface/tangent_frames.h"
#include "surface/triangles.h"

#include <stdbool.h>

typedef struct WrReferenceBox WrReferenceBox;
typedef struct WrReferenceMesh {
    WrTriangles *source;   /* shared; NULL: there is none */
    WrReferenceBox *boxes; /* owned; the first is the root */
    int32_t *order;        /* triangles sorted by box; owned */
    int32_t box_count;
    WrTangent *tangents; /* [3 triangles], owned; NULL: no normal map needs them */
    bool mikk;           /* they follow MikkTSpace */
} WrReferenceMesh;

/* Builds the tree and takes ownership of the mesh. Errors: no memory. */
bool wr_reference_mesh_init(WrReferenceMesh *mesh, WrTriangles *source, WrError *err);
/* Computes tangent frames for a normal map that needs them. Errors: no memory. */
bool wr_reference_mesh_frame(WrReferenceMesh *mesh, WrNormalFrame frame, WrError *err);
/* Axes of such a map at a hit; false: there is no frame. */
bool wr_reference_mesh_axes(const WrReferenceMesh *mesh, const WrReferenceHit *hit,
                            WrMapAxes *axes);
void wr_reference_mesh_fini(WrReferenceMesh *mesh); /* also for a zeroed one */
/* Nearest triangle beyond s_min: fills s, u, v, triangle and share. cull: ignores back faces. A ray through an
   edge or a corner that triangles share hits one of them. */
bool wr_reference_mesh_hit(const WrReferenceMesh *mesh, bool cull, const WrReferenceRay *ray,
                           WrReferenceHit *hit);
/* The point there: P, n, and Pu, Pv, perpendicular to n, as  grad v x n  and  n x grad u  times |N|, so that
   Blinn's formula yields unit(n - grad F). With mirrored (u,v) both have the opposite sign; with (u,v) of area 0,
   |N| is 1. The normal of a face towards the eye is turned towards the eye as well, by a cosine of at least
   1e-4. */
void wr_reference_mesh_at(const WrReferenceMesh *mesh, const WrReferenceHit *hit, WrVec3 eye,
                          bool perspective, WrSurfacePoint *out);
