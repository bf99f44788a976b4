/* reference_patch.h - where a ray meets a curved surface, for the reference: a tree of pieces of the (u,v)
   square with boxes around what they map to, and Newton's method in the pieces that the ray enters.
   Layer 5, private to the reference. */
#pragma once
#include "surface/surface.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;

/* Points q + s d; d's part along the axis of view is 1, so that s grows with depth. */
typedef struct WrReferenceRay {
    WrVec3 q, d;
    double s_min; /* the near plane; hits lie beyond */
} WrReferenceRay;

typedef struct WrReferenceHit {
    double s, u, v;
    int face;
    int32_t triangle; /* of a mesh out of a file ... */
    double share[2];  /* ... and how near its second and third corner are */
    bool lost;        /* Newton's method did not settle; the nearest that it came to */
} WrReferenceHit;

typedef struct WrReferencePiece WrReferencePiece;
typedef struct WrReferencePatches {
    WrReferencePiece *pieces; /* [count], owned; the first is the whole */
    int count;
    double size; /* of the object, its units */
} WrReferencePatches;

bool wr_reference_patches_init(WrReferencePatches *patches, const WrShape *shape, WrError *err);
void wr_reference_patches_fini(WrReferencePatches *patches); /* fine on a zeroed one */
/* The nearest root beyond s_min. cull: one whose N = Pu x Pv points away from the viewer is none. */
bool wr_reference_patches_hit(const WrReferencePatches *patches, const WrShape *shape, bool cull,
                              const WrReferenceRay *ray, WrReferenceHit *hit);
/* Newton's step: P + Pu du + Pv dv on the ray. False where the ray lies in the tangent plane. */
bool wr_reference_newton_step(const WrReferenceRay *ray, WrVec3 p, WrVec3 pu, WrVec3 pv, double *du,
                              double *dv);
