/* solid_texture_setup.h - a solid texture as the kernels want it.
   Layer 5, private to the renderer. */
#pragma once
#include "render/kernels/kern.h"

#include <stdbool.h>

/* kind: of the plan; noisy: its noise is worked out; faded: over pixels; scale: object units -> kernel units. */
void wr_solid_texture_kern_fill(const WrSolidTexture *grain, WrSolidTextureKind kind, bool noisy,
                                bool faded, double scale, WrKernGraind *out);
void wr_solid_texture_kern_narrow(const WrKernGraind *grain, WrKernGrain *out);
