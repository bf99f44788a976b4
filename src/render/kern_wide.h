/* kern_wide.h - kernels for the pictures that matter most, in fast arithmetic alone: several stages at once, in vectors
   written by hand (kern_wide_body.h). They keep to the bound of fast arithmetic, not to the bits of the stages; each
   sample's bits are its own, wherever in a strip it stands.
   Layer 5, private to the renderer. */
#pragma once
#include "render/kern.h"

#include <stdbool.h>

typedef struct WrWide {
    /* All of one lamp of Blinn and Phong, as WrKernels.shade does it; pictured: C is a picture's. False: not such as this
       is for, and nothing is done. */
    bool (*shade)(const WrRays *rays, const WrKernLight *light, const WrKernShine *shine,
                  const WrKernMaterial *material, bool pictured, WrStrip *strip);
} WrWide;

extern const WrWide wr_wide_v3, wr_wide_v4; /* empty where the processor is another */

/* Those beside a set of kernels; NULL: there are none. */
const WrWide *wr_wide_of(const WrKernels *kernels);
