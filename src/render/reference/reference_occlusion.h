/* reference_occlusion.h - self-shadowing and ambient occlusion by the relief, for the reference, by ray
   marching. Private to the reference. */
#pragma once
#include "base/vec.h"
#include "render/reference/reference_environment.h"

typedef struct WrReferenceStage WrReferenceStage;
typedef struct WrSurfacePoint WrSurfacePoint;

/* Visible share of a lamp in direction l. radius: of an area lamp, angular; away: its distance. perturbed: n'
   facing the viewer; share: of the lamp's sample points. */
double wr_reference_lamp_share(const WrReferenceStage *stage, const WrSurfacePoint *at, double u,
                               double v, WrVec3 perturbed, WrVec3 l, double away, double radius,
                               WrReferenceShare share);
/* Unoccluded share of the sky's light. */
double wr_reference_open(const WrReferenceStage *stage, const WrSurfacePoint *at, double u,
                         double v, WrVec3 perturbed);
