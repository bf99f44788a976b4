/* reference_parallax.h - parallax for the reference: ray march from the base to the relief above its tangent
   plane, or through the shell of a round base (parallax.h), by short even steps and bisection, in double.
   Private to the reference. */
#pragma once
#include "render/reference/reference_shade.h"

/* True if the scene uses parallax and it is supported. */
bool wr_reference_has_parallax(const WrScene *scene);
/* Prepares the range of F, object units, and the number of cells with at most one bend each; field may be NULL
   if F is a formula. */
void wr_reference_parallax_init(WrReferenceStage *stage, const WrField *field,
                                const double cells[2]);
/* Hit of the ray on the relief: the base's point there with P on the ray; side: 1, or -1 on back faces. false:
   no hit. */
bool wr_reference_parallax(const WrReferenceStage *stage, const WrReferenceRay *ray,
                           WrReferenceHit *hit, WrSurfacePoint *at, double *side);
