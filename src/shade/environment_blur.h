/* environment_blur.h - surroundings blurred by a lobe: for each direction the mean of what comes from about it. By spherical harmonics:
   a lobe about an axis multiplies those of each order by one number. */
#pragma once
#include "shade/environment_brdf.h"
#include "shade/environment_map.h"

typedef struct WrPool WrPool;

/* Lobes narrower than that mirror: surfaces so smooth are taken as mirrors (E43). */
#define WR_BLUR_LEAST (1.0 / 64)
#define WR_BLUR_WIDEST 1024 /* texels */

/* How many texels wide a blurred picture is: a power of two, `fine` of them over the width of the lobe in radians, 64 to
   WR_BLUR_WIDEST; half as high. */
int wr_blur_width(const WrEnvironmentBrdf *gloss, double fine);
/* out: [width / 2][width][3], nowhere below 0. Of one colour everywhere they stay so. Errors: no memory, cancelled. */
bool wr_environment_map_blur(const WrEnvironmentMap *surround, const WrEnvironmentBrdf *gloss,
                             int width, WrPool *pool, float *out, WrError *err);
/* What the lobe multiplies harmonics of order 0 .. count - 1 by; the first is 1. */
void wr_blur_orders(const WrEnvironmentBrdf *gloss, int count, double *out);
