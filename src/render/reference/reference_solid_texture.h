/* reference_solid_texture.h - solid textures in double precision, point by point, on the noise of src/noise
   (shade/solid_texture.h). Private to the reference. */
#pragma once
#include "base/vec.h"
#include "shade/solid_texture.h"

/* The pattern at a point of the object, scene units, 0..1, and its slope per scene unit. noise: from
   wr_solid_texture_noise; slope NULL: not requested. */
double wr_reference_grain(const WrSolidTexture *grain, const WrOctavesPlan *noise, WrVec3 p,
                          WrVec3 *slope);
