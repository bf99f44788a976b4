/* reference_bezier.h - where a ray meets a set of bicubic patches, for the reference: boxes about the patches' points, and
   within each reference_patch.h's tree and Newton's method. Knows nothing of the triangles that the picture goes by.
   Layer 5, private to the reference. */
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
void wr_reference_bezier_fini(WrReferenceBezier *set); /* fine on a zeroed one */
/* The nearest beyond s_min: fills s, u, v (the table's), triangle (here the patch) and share (its own u, v). */
bool wr_reference_bezier_hit(const WrReferenceBezier *set, bool cull, const WrReferenceRay *ray,
                             WrReferenceHit *hit);
/* As wr_reference_mesh_at. */
void wr_reference_bezier_at(const WrReferenceBezier *set, const WrReferenceHit *hit,
                            WrSurfacePoint *out);
