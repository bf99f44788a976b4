/* reference_parallax.h - parallax for the reference: a ray that has met the base goes on to the relief over its tangent plane,
   or through the shell of a round base (parallax.h), by short even steps that are bisected, in double.
   Layer 5, private to the reference. */
#pragma once
#include "render/reference/reference_shade.h"

/* Does the scene ask for it, and is it known there? */
bool wr_reference_has_parallax(const WrScene *scene);
/* Lowest and highest F, object units, and cells that hold one bend each; field may be NULL where F is a formula. */
void wr_reference_parallax_init(WrReferenceStage *stage, const WrField *field,
                                const double cells[2]);
/* Where the ray meets the relief, the base's point there with P on the ray; side: 1, or -1 of what is seen from behind. false:
   it meets nothing. */
bool wr_reference_parallax(const WrReferenceStage *stage, const WrReferenceRay *ray,
                           WrReferenceHit *hit, WrSurfacePoint *at, double *side);
/* The same of a base that has a shell (wr_parallax_has_shell), but for the point. */
bool wr_reference_shell(const WrReferenceStage *stage, const WrReferenceRay *ray,
                        WrReferenceHit *hit, double *side);
