/* reference_shadow_rays.h - shadows of objects, for the reference: rays against the objects' own forms, in
   double. Private to the reference. */
#pragma once
#include "render/reference/reference_shade.h"

/* Makes an object a shadow caster. The stage must not move in memory. */
void wr_reference_caster(WrReferenceCaster *caster, const WrReferenceStage *stage);
/* Visible share of a lamp past all objects. l: unit vector to it, along the object's axes, and away, its
   distance, both in world proportions; radius: of an area lamp, radians, of whose points each sample uses its
   share. Below the surface's own horizon the object itself is tested along the horizon. */
double wr_reference_cast_share(const WrReferenceStage *stage, const WrSurfacePoint *at,
                               const WrReferenceHit *hit, WrVec3 perturbed, WrVec3 l, double away,
                               double radius, WrReferenceShare share);
