/* solid_texture_setup.h - kernel parameters of a solid texture.
   Private to the renderer. */
#pragma once
#include "render/kernels/kern.h"

#include <stdbool.h>

/* ---- resolution of a solid texture in (u,v), for adaptive sampling ---- */

typedef struct WrScene WrScene;

/* True if the resolution is known for the scene's surface: u and v have closed formulas over one piece. */
bool wr_solid_texture_resolution_known(const WrScene *scene);
/* Size, along u and v, of a picture as fine as the texture at its finest place: three texels for the narrowest
   possible band. Where u and v are denser than elsewhere this is more than necessary. */
void wr_solid_texture_texels(const WrScene *scene, double texels[2]);

/* Fills the parameters; narrow converts them to single precision. kind: from the plan; noisy: its noise is
   computed; faded: filtered by pixels; scale: object units -> kernel units. */
void wr_solid_texture_kern_fill(const WrSolidTexture *grain, WrSolidTextureKind kind, bool noisy,
                                bool faded, double scale, WrKernGraind *out);
void wr_solid_texture_kern_narrow(const WrKernGraind *grain, WrKernGrain *out);
