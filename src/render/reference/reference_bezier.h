/* reference_bezier.h - ray intersection with bicubic patches, for the reference.
   Private to the reference. Boxes around the patches' control points, and within each reference_patch.h's tree
   and Newton's method. Independent of the triangles used by the fast renderer. */
#pragma once
#include "render/reference/reference_patch.h"
#include "surface/patches.h"

#include <stdbool.h>

typedef struct WrReferenceBezierPiece WrReferenceBezierPiece;
typedef struct WrReferenceBezier {
    const WrPatches *source;        /* borrowed; NULL: there is none */
    WrReferenceBezierPiece *pieces; /* [source->count], owned */
} WrReferenceBezier;

bool wr_reference_bezier_init(WrReferenceBezier *set, const WrPatches *source, WrError *err);
void wr_reference_bezier_fini(WrReferenceBezier *set); /* also for a zeroed one */
/* Nearest hit beyond s_min: fills s, u, v (the table's), triangle (here the patch) and share (its own u, v). */
bool wr_reference_bezier_hit(const WrReferenceBezier *set, bool cull, const WrReferenceRay *ray,
                             WrReferenceHit *hit);
/* As wr_reference_mesh_at. */
void wr_reference_bezier_at(const WrReferenceBezier *set, const WrReferenceHit *hit,
                            WrSurfacePoint *out);
