/* reference_shadow_rays.h - lamps that objects hide, for the reference: rays against the objects' own forms, in double.
   Layer 5, private to the reference. */
#pragma once
#include "render/reference/reference_shade.h"

/* An object as shadow rays meet it. The stage stays where it is. */
void wr_reference_caster(WrReferenceCaster *caster, const WrReferenceStage *stage);
/* The share of a lamp that no object hides; l: unit, towards it, along the object's axes, and away, how far it is, as light
   sees it; radius: of a round lamp, radians, of whose places each sample takes its share. Below the surface's own horizon
   the object hides what it hides at the horizon. */
double wr_reference_cast_share(const WrReferenceStage *stage, const WrSurfacePoint *at,
                               const WrReferenceHit *hit, WrVec3 perturbed, WrVec3 l, double away,
                               double radius, WrReferenceShare share);
