/* reference_occlusion.h - what the relief hides, for the reference: lamps, and the sky, by marching along rays.
   Layer 5, private to the reference. */
#pragma once
#include "base/vec.h"
#include "render/reference/reference_environment.h"

typedef struct WrReferenceStage WrReferenceStage;
typedef struct WrSurfacePoint WrSurfacePoint;

/* The share of a lamp in direction l that reaches the place, of one that is round and of that angular radius; away: how far
   it stands. perturbed: n' towards the viewer's side; share: of the lamp's places. */
double wr_reference_lamp_share(const WrReferenceStage *stage, const WrSurfacePoint *at, double u,
                               double v, WrVec3 perturbed, WrVec3 l, double away, double radius,
                               WrReferenceShare share);
/* The share of the sky's light that does. */
double wr_reference_open(const WrReferenceStage *stage, const WrSurfacePoint *at, double u,
                         double v, WrVec3 perturbed);
