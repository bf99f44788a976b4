/* color_mips.h - mip pyramid of the colour picture: the picture for the kernels, and box-filtered levels of half
   the size each. Private to the renderer. Means are of linear light, computed like those of slopes
   (slope_pyramid.h): exact shares of texels, so that every level has the picture's mean and odd sizes cause no
   shift. */
#pragma once
#include "field/wrap.h"
#include "render/textures/slope_pyramid.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrImage WrImage;
typedef struct WrPool WrPool;

/* Zero-initialise; drop frees. */
typedef struct WrColorMips {
    const WrImage *source; /* shared; the source of rgba */
    WrWrap wrap_u, wrap_v;
    float *rgba; /* R, G, B, 0 per texel, with an apron of one texel */
    int pitch;
    WrPyramid pyramid; /* of kind COLOUR: R, G, B, 0; levels 0: none */
} WrColorMips;

void wr_color_mips_drop(WrColorMips *tint);
/* Updates level 0 from a picture of one channel, or of three and more, with these wrap modes. */
bool wr_color_mips_update(WrColorMips *tint, const WrImage *image, WrWrap wrap_u, WrWrap wrap_v,
                          WrError *err);
/* Updates the pyramid, after level 0. */
bool wr_color_mips_update_pyramid(WrColorMips *tint, WrPool *pool, WrError *err);
