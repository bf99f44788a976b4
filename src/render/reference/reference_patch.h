/* reference_patch.h - ray intersection with a curved surface, for the reference.
   Private to the reference. A tree of pieces of the (u,v) square with boxes around their images, and Newton's
   method in the pieces that the ray enters. */
#pragma once
#include "surface/surface.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;

/* Points q + s d; d's component along the view axis is 1, so that s grows with depth. */
typedef struct WrReferenceRay {
    WrVec3 q, d;
    double s_min; /* the near plane; hits are beyond */
} WrReferenceRay;

typedef struct WrReferenceHit {
    double s, u, v;
    int face;
    int32_t triangle; /* of a mesh file ... */
    double share[2];  /* ... and the shares of its second and third corner */
    bool lost;        /* Newton's method did not converge; the nearest point it reached */
} WrReferenceHit;

typedef struct WrReferencePiece WrReferencePiece;
typedef struct WrReferencePatches {
    WrReferencePiece *pieces; /* [count], owned; the first is the root */
    int count;
    double size; /* of the object, object units */
} WrReferencePatches;

bool wr_reference_patches_init(WrReferencePatches *patches, const WrShape *shape, WrError *err);
void wr_reference_patches_fini(WrReferencePatches *patches); /* also for a zeroed one */
/* Nearest root beyond s_min. cull: ignores roots whose N = Pu x Pv points away from the viewer. */
bool wr_reference_patches_hit(const WrReferencePatches *patches, const WrShape *shape, bool cull,
                              const WrReferenceRay *ray, WrReferenceHit *hit);
/* A step of Newton's method: P + Pu du + Pv dv on the ray. False if the ray is in the tangent plane. */
bool wr_reference_newton_step(const WrReferenceRay *ray, WrVec3 p, WrVec3 pu, WrVec3 pv, double *du,
                              double *dv);
