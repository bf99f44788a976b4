/* reference_reflection.h - what a surface reflects of one lamp, for the reference: the models' formulas as their sources
   write them, in double.
   Layer 5, private to the reference. */
#pragma once
#include "base/vec.h"
#include "shade/reflection.h"

/* All unit; n towards the viewer's side. colour: C(u,v), the picture's times the material's.
 * own: in the surface's colour (times it still), each channel; white: in the lamp's. */
void wr_reference_reflect(const WrMatter *matter, WrReflect model, WrEnergy energy, WrVec3 n,
                          WrVec3 l, WrVec3 v, const double colour[3], double own[3], double *white);
