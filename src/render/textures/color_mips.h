/* color_mips.h - the colour picture as the kernels want it, and box-filtered copies of it, each about half as fine as the one
   before.
   Layer 5, private to the renderer. Means are of linear light, made as those of slopes are (slope_pyramid.h): exact shares
   of texels, so that every level has the picture's mean and no odd size shifts it. */
#pragma once
#include "field/wrap.h"
#include "render/textures/slope_pyramid.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrImage WrImage;
typedef struct WrPool WrPool;

/* Zero-initialise; drop frees. */
typedef struct WrColorMips {
    const WrImage *source; /* shared; what rgba was made from */
    WrWrap wrap_u, wrap_v;
    float *rgba; /* R, G, B, 0 a texel, with an apron of one texel */
    int pitch;
    WrPyramid pyramid; /* of kind COLOUR: R, G, B, 0; levels 0: none */
} WrColorMips;

void wr_color_mips_drop(WrColorMips *tint);
/* Bring it up to date with a picture of one channel, or three and more, that goes on beyond its ends so. */
bool wr_color_mips_bring(WrColorMips *tint, const WrImage *image, WrWrap wrap_u, WrWrap wrap_v,
                         WrError *err);
/* The same of its pyramid, once it is up to date itself. */
bool wr_color_mips_bring_pyramid(WrColorMips *tint, WrPool *pool, WrError *err);
