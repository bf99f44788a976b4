/* octaves.h - sums of noise octaves with growing frequencies and falling amplitudes.

     N(p) = sum over i of r^-i f_i(s^i n0 p + offset_i)          the lecture; fractional Brownian motion

   Each octave has a lattice and a seed of its own, unless `one_lattice` selects the lecture's literal
   sum, in which every octave is the same f at another scale. A tiling sum repeats exactly with period 1
   in each coordinate: octave i has n_i = round(n0 s^i) cells per period (rounded to a valid period of
   its kind), used both as frequency and as modulus, so that any s tiles and integer s keeps its octaves
   exact multiples (HC68). A sum that does not tile has n0 s^i cells per unit of length, unrounded.

   | mode       | sum of                                                                            |
   | fbm        | r^-i f                                                                            |
   | turbulence | r^-i |f|: creased where f is 0; its slope there is 0 (HC65)                       |
   | billow     | r^-i (2|f| - 1)                                                                   |
   | ridged     | r^-i S_i, S_i = w_i (offset - |f|)^2, w_0 = 1, w_(i+1) = min(1, gain S_i)  Musgrave |

   For r = s slopes do not fall off: the rms slope grows as the square root of the number of octaves
   while the rms height has long converged. For bumps choose r > s, or few octaves. */
#pragma once
#include "base/enum_rows.h"
#include "noise/noise.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;

#define WR_OCTAVES_MAX 32

#define WR_OCTAVES_MODES(X)                                                                        \
    X(WR_OCTAVES_FBM, "fbm")                                                                       \
    X(WR_OCTAVES_TURBULENCE, "turbulence")                                                         \
    X(WR_OCTAVES_BILLOW, "billow")                                                                 \
    X(WR_OCTAVES_RIDGED, "ridged")
typedef enum WrOctavesMode { WR_OCTAVES_MODES(WR_WORD_ID) WR_OCTAVES_MODE_COUNT } WrOctavesMode;
extern const char *const wr_octaves_words[]; /* as in commands; ends with NULL */

/* Parameters of a sum. Plain data; owned by the caller. */
typedef struct WrOctaves {
    WrNoiseKind kind;
    WrFade fade;
    WrLatticeSource source; /* HASH, or LECTURE with salt (seed + i) mod 1000 */
    int dim;                /* 1..3 */
    WrOctavesMode mode;
    bool tile;                   /* repeats with period 1 in each coordinate */
    int count;                   /* octaves, 1..WR_OCTAVES_MAX */
    double ratio;                /* r, above 1 */
    double step;                 /* s, above 1 */
    double cells[WR_NOISE_AXES]; /* n0 per axis, cells per unit; tile: 1..WR_LATTICE_MAX, rounded to
                                 integers; else above 0 */
    uint32_t seed;               /* any */
    const double *offsets; /* [count][dim] cells, |offset| <= 1e9, borrowed for the call; NULL:
                                 by `scatter` */
    bool scatter; /* without offsets: each octave gets its own from the seed, so that the octaves'
                     lattice points do not coincide at the origin; false: none */
    bool
        one_lattice; /* every octave has the seed and the period of the first: N(p) = sum r^-i f(s^i
                        n0 p). If n_i is no multiple of n_0 (s not an integer), the period is n_i */
    double ridge_offset; /* ridged: 0..10; 1 for ridges of height 1 where f is 0 */
    double ridge_gain;   /* ridged: 0..100 */
} WrOctaves;

/* Perlin noise, quintic, fbm, tiling, 8 octaves of 4 cells, r = s = 2, seed 1, scattered, ridges of
 * offset 1 and gain 2. */
WrOctaves wr_octaves_default(int dim);

/* One octave ready for evaluation: t = frequency p + offset. */
typedef struct WrOctave {
    WrNoise noise;
    double frequency
        [WR_NOISE_AXES]; /* cells per unit of p; tile: an integer, a multiple of the lattice's
                            period */
    double offset[WR_NOISE_AXES]; /* cells; tile: reduced to one period */
    double amplitude;             /* r^-i */
} WrOctave;

typedef struct WrOctavesPlan {
    WrOctavesMode mode;
    int dim;
    bool tile;
    double ridge_offset, ridge_gain;
    int asked;    /* requested octaves */
    int used;     /* octaves kept, the first ones; 0..asked. With none the sum is 0 everywhere */
    double bound; /* upper bound of |N| */
    WrOctave octave[WR_OCTAVES_MAX];
} WrOctavesPlan;

/* Checks the parameters and computes the plan.
 *
 * texels   [dim] samples per unit of p of the grid to be filled, or 0 per axis: no limit there. NULL:
 *          no limit. From the first octave on that has more than half a cell per texel along an axis
 *          (beyond the Nyquist frequency, where it would alias: HC62), octaves are dropped; so are
 *          those with more than WR_LATTICE_MAX cells per unit. plan->used is the number that is left.
 * Errors   count, r, s, cells, offsets, ridge numbers out of range (HC64); a kind that does not support
 *          the dimension, or cannot tile */
bool wr_octaves_plan(const WrOctaves *octaves, const int *texels, WrOctavesPlan *plan,
                     WrError *err);

/* Number of octaves i = 0, 1, ... with n0 s^i <= texels/2: 1 + floor(log_s(texels/(2 n0))), at most
 * WR_OCTAVES_MAX, and 0 when the first is already too fine. n0 > 0, s > 1; texels 0: no limit but
 * WR_LATTICE_MAX cells. At n0 s^i = texels k (texel centres: k even) every sample falls on the
 * lattice, where perlin and simplex are 0 and value noise is white (HC63); all of these lie beyond the
 * limit. */
int wr_octaves_usable(double n0, double s, int texels);

/* N and its gradient at p.
 *
 * p        [dim] any value; tile: first reduced to [0,1); non-finite values count as 0
 * slope    [dim] dN/dp, per unit of p; NULL = not wanted
 * Errors   none      Threads  any number The octaves are added in order, so the bits are reproducible. */
double wr_octaves_at(const WrOctavesPlan *plan, const double *p, double *slope);

/* Domain warping: M(p) = N(p + amount w(p)), w_a(p) = the sum warp[a]. With the Jacobian of the inner
 * map, dM/dp_b = N_b + amount sum over a of N_a dw_a/dp_b.
 *
 * warp     [dim] plans of the same dimension; M tiles when all of them do
 * amount   units of p, finite
 * slope    as above */
double wr_octaves_warped_at(const WrOctavesPlan *plan, const WrOctavesPlan *const *warp,
                            double amount, const double *p, double *slope);
