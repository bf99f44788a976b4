/* reference_reflection.h - reflection of one lamp, for the reference: the models' formulas as published, in
   double. Private to the reference. */
#pragma once
#include "base/vec.h"
#include "shade/reflection.h"

/* All vectors unit; n faces the viewer. colour: C(u,v), the picture's times the material's. own: to be
   multiplied by the surface's colour, each channel; white: by the lamp's colour only. */
void wr_reference_reflect(const WrMatter *matter, int model, WrEnergy energy, WrVec3 n, WrVec3 l,
                          WrVec3 v, const double colour[3], double own[3], double *white);
