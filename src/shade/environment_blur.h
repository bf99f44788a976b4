/* environment_blur.h - surroundings blurred by a lobe: the weighted mean about each direction.

   Computed with spherical harmonics: a lobe symmetric about an axis multiplies those of each order by
   one number. */
#pragma once
#include "shade/environment_brdf.h"
#include "shade/environment_map.h"

typedef struct WrPool WrPool;

/* Width of the narrowest blurred lobe: smoother surfaces are treated as mirrors (E43). */
#define WR_BLUR_MIN (1.0 / 64)
#define WR_BLUR_WIDEST 1024 /* texels */

/* Width of a blurred picture in texels: a power of two with `fine` texels over the width of the lobe in
   radians, 64 to WR_BLUR_WIDEST; it is half as high. */
int wr_blur_width(const WrEnvironmentBrdf *gloss, double fine);
/* out: [width / 2][width][3], nowhere negative. A constant colour is preserved. Errors: out of memory,
 * cancelled. */
bool wr_environment_map_blur(const WrEnvironmentMap *map, const WrEnvironmentBrdf *gloss, int width,
                             WrPool *pool, float *out, WrError *err);
/* Factors of the lobe for harmonics of order 0 .. count - 1; the first is 1. */
void wr_blur_orders(const WrEnvironmentBrdf *gloss, int count, double *out);
