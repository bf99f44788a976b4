/* solid_texture_setup.h - kernel parameters of a solid texture.
   Private to the renderer. */
#pragma once
#include "render/kernels/kern.h"

#include <stdbool.h>

/* Fills the parameters; narrow converts them to single precision. kind: from the plan; noisy: its noise is
   computed; faded: filtered by pixels; scale: object units -> kernel units. */
void wr_solid_texture_kern_fill(const WrSolidTexture *grain, WrSolidTextureKind kind, bool noisy,
                                bool faded, double scale, WrKernGraind *out);
void wr_solid_texture_kern_narrow(const WrKernGraind *grain, WrKernGrain *out);
