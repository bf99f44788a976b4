/* reference_grain.h - solid textures in double precision, point by point, on the noise of src/noise (shade/grain.h).
   Layer 5, private to the reference. */
#pragma once
#include "base/vec.h"
#include "shade/grain.h"

/* The texture's colour at a point of the object, scene units. noise: wr_grain_noise's. */
void wr_reference_grain(const WrGrain *grain, const WrOctavesPlan *noise, WrVec3 p, double rgb[3]);
