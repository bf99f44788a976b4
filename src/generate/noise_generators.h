/* noise_generators.h - the generator family "noise": its parameters converted to a sum, for tables and single
   points.

     F(u,v) = level + amplitude N(p),   p = (u, v) - origin

   N is the sum of octaves of noise/octaves.h, tiling with period 1. In the domains along-u and along-v
   it depends on one coordinate only (the lecture's 1D noise, extended across the table), in the domain
   slice on three, (u, v, slice). With warp, N(p + warp/cells w(p)), w two octaves of the same noise for
   each coordinate. */
#pragma once
#include "generate/generator.h"
#include "noise/octaves.h"

#include <stdbool.h>

typedef struct WrNoiseMaker {
    WrOctavesPlan plan;
    WrOctavesPlan warp[WR_NOISE_AXES]; /* [plan.dim], used if warp_amount is not 0 */
    double warp_amount;                /* periods */
    int axis;                          /* for one dimension: 0 along u, 1 along v */
    double slice;                      /* for three: the third coordinate, periods */
    double amplitude, level;           /* table units */
    double origin[2];                  /* u, v */
} WrNoiseMaker;

/* N and F with their slopes. */
typedef struct WrNoiseReading {
    double n, nu, nv; /* N, per unit of u and v */
    double f, fu, fv; /* F = level + amplitude N */
} WrNoiseReading;

/* Converts the checked values of a row of wr_noise_rows for a table of width x height texels: octaves
 * finer than its Nyquist frequency are dropped. *maker is plain data. Errors name incompatible values. */
bool wr_noise_maker(const WrGenerator *row, const WrParamValue *values, int width, int height,
                    WrNoiseMaker *maker, WrError *err);

/* Evaluates one point in double. */
void wr_noise_maker_sample(const WrNoiseMaker *maker, double u, double v, WrNoiseReading *reading);
