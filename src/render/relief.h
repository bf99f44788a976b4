/* relief.h - a normal map's slopes as the kernels want them: with their means and covariances over boxes.
   Layer 5, private to the renderer. Level 1 of the pyramid is the map itself, so that one kernel looks up the map and
   its means: a look-up of the map is one at level 1, of the mean of boxes of 2^l texels at level 1 + l. */
#pragma once
#include "render/pyramid.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrImage WrImage;
typedef struct WrPool WrPool;

/* Zero-initialise; drop frees. */
typedef struct WrRelief {
    const WrImage *source; /* shared; what the pyramid was made from */
    WrWrap wrap_u, wrap_v;
    WrPyramid pyramid; /* of kind MOMENTS */
} WrRelief;

void wr_relief_drop(WrRelief *relief);
/* Bring it up to date with a picture of unit vectors (WrNormalMap) that goes on beyond its ends so. */
bool wr_relief_bring(WrRelief *relief, const WrImage *image, WrWrap wrap_u, WrWrap wrap_v,
                     WrPool *pool, WrError *err);
