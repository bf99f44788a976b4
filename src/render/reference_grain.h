/* reference_grain.h - solid textures in double precision, point by point, on the noise of src/noise (shade/grain.h).
   Layer 5, private to the reference. */
#pragma once
#include "base/vec.h"
#include "shade/grain.h"

/* The pattern at a point of the object, scene units, 0..1, and its slope there by the scene unit. noise: wr_grain_noise's;
   slope NULL: not wanted. */
double wr_reference_grain(const WrGrain *grain, const WrOctavesPlan *noise, WrVec3 p,
                          WrVec3 *slope);
