/* noise_rows.h - the family "noise": what its parameters describe, for filling tables and for asking at one
   point.

     F(u,v) = level + amplitude N(p),   p = (u, v) - origin

   N is the sum of octaves of noise/octaves.h, tiling with period 1; in the domains along-u and along-v of
   one coordinate alone (the lecture's 1D noise, drawn out across the table), in the domain slice of three,
   (u, v, slice). With warp, N(p + warp/cells w(p)), w two octaves of the same noise for each coordinate. */
#pragma once
#include "generate/generator.h"
#include "noise/octaves.h"

#include <stdbool.h>

typedef struct WrNoiseMaker {
    WrOctavesPlan plan;
    WrOctavesPlan warp[WR_NOISE_AXES]; /* [plan.dim], in use if warp_amount is not 0 */
    double warp_amount;                /* periods */
    int axis;                          /* of one dimension: 0 along u, 1 along v */
    double slice;                      /* of three: the third coordinate, periods */
    double amplitude, level;           /* table units */
    double origin[2];                  /* u, v */
} WrNoiseMaker;

/* N and F with their slopes. */
typedef struct WrNoiseReading {
    double n, nu, nv; /* N, per unit of u and v */
    double f, fu, fv; /* F = level + amplitude N */
} WrNoiseReading;

/* Work out what a row of wr_noise_rows with these values, checked against it, makes of a table of width x
 * height texels: octaves finer than its Nyquist frequency are left out. *maker is plain data. Errors name
 * what does not fit together. */
bool wr_noise_maker(const WrGenerator *row, const WrParamValue *values, int width, int height,
                    WrNoiseMaker *maker, WrError *err);

/* At one point, in double. */
void wr_noise_maker_at(const WrNoiseMaker *maker, double u, double v, WrNoiseReading *reading);
