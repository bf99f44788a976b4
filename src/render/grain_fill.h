/* grain_fill.h - a solid texture as the kernels want it.
   Layer 5, private to the renderer. */
#pragma once
#include "render/kern.h"

#include <stdbool.h>

/* kind: of the plan; noisy: its noise is worked out; faded: over pixels; scale: object units -> kernel units. */
void wr_grain_kern_fill(const WrGrain *grain, WrGrainKind kind, bool noisy, bool faded,
                        double scale, WrKernGraind *out);
void wr_grain_kern_narrow(const WrKernGraind *grain, WrKernGrain *out);
