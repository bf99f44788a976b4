/* lattice.h - the lattice of noise: integer points, each with a prescribed value and slope, and the
   fade functions that blend between them.

   Depends only on base. Coordinates t are in cells: lattice points are at integers. A lattice repeats
   after period[a] cells along axis a. Its index is computed by floored modulus, so that negative
   coordinates are valid (HC60), after t was reduced to one period in double, so that no cast overflows
   (HC61). */
#pragma once
#include "base/hash.h"
#include "base/enum_rows.h"

#include <stdint.h>

typedef struct WrError WrError;

#define WR_NOISE_AXES 3          /* maximum number of dimensions of a caller's noise */
#define WR_LATTICE_MAX (1 << 30) /* maximum cells of a period */

/* The fade alpha(x), from 0 at x = 0 to 1 at x = 1 with alpha(1 - x) = 1 - alpha(x). */
#define WR_FADES(X)                                                                                \
    X(WR_FADE_LINEAR, "linear")                                                                    \
    X(WR_FADE_CUBIC, "cubic")                                                                      \
    X(WR_FADE_QUINTIC, "quintic")
typedef enum WrFade { WR_FADES(WR_WORD_ID) WR_FADE_COUNT } WrFade;
extern const char *const wr_fade_words[]; /* as in commands; ends with NULL */

typedef struct WrFadeInfo {
    int continuity; /* continuous derivatives of value noise: 0, 1, 2. Gradient noise has as many,
                       and matches prescribed slopes, if it is 1 or more */
    double c[6];    /* alpha(x) = sum of c[k] x^k */
} WrFadeInfo;

/* x; 3 x^2 - 2 x^3; 10 x^3 - 15 x^4 + 6 x^5 (Perlin 2002). Indexed by WrFade. */
extern const WrFadeInfo wr_fades[WR_FADE_COUNT];

/* alpha(x); exactly 0, 1/2, 1 at x = 0, 1/2, 1. */
static inline double wr_fade_value(const WrFadeInfo *fade, double x)
{
    const double *c = fade->c;
    return x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5]))));
}

/* alpha'(x) */
static inline double wr_fade_slope(const WrFadeInfo *fade, double x)
{
    const double *c = fade->c;
    return c[1] + x * (2.0 * c[2] + x * (3.0 * c[3] + x * (4.0 * c[4] + x * (5.0 * c[5]))));
}

/* Source of a lattice's prescribed values. */
typedef enum WrLatticeSource {
    WR_LATTICE_HASH,    /* an integer hash of seed and index: the same on every processor (HC66) */
    WR_LATTICE_LECTURE, /* wr_hash_lecture; 1D and 2D; only for comparison with the lecture's images */
    WR_LATTICE_DATA,    /* tables of the caller */
    WR_LATTICE_SOURCE_COUNT
} WrLatticeSource;

typedef struct WrLattice {
    WrLatticeSource source;
    uint32_t seed; /* HASH: any; LECTURE: the salt; otherwise unused */
    int period
        [WR_NOISE_AXES];  /* cells along x, y, z, 1..WR_LATTICE_MAX; 0: not periodic (the indices
                             of a hash repeat after 2^32 cells); DATA: from 1 */
    const double *values; /* DATA: [z][y][x] of period; finite; borrowed */
    const double *slopes; /* DATA: [z][y][x][dim], d/dx first, per cell; finite; borrowed */
} WrLattice;

/* A well-mixed 32-bit hash of a lattice index, chained one coordinate at a time, each mixed separately
 * first: h = mix(h ^ mix(c_a + K_a)), so that a shift of one coordinate cannot cancel another's. dim
 * 1..4. */
uint32_t wr_lattice_hash(uint32_t seed, const uint32_t *c, int dim);

/* The steps of that chain, for loops over lattice rows: the start, and one link. */
static inline uint32_t wr_lattice_hash_start(uint32_t seed)
{
    return wr_mix32(seed + 0x9e3779b9U);
}
static inline uint32_t wr_lattice_hash_part(uint32_t c, int axis)
{
    return wr_mix32(c + 0x85ebca6bU * ((uint32_t)axis + 1U));
}
static inline uint32_t wr_lattice_hash_link(uint32_t h, uint32_t part)
{
    return wr_mix32(h ^ part);
}

/* A number in (-1, 1) from the upper 23 bits of a hash: odd multiples of 2^-23, symmetric about 0 and
 * exact in float too. */
static inline double wr_lattice_number(uint32_t h)
{
    return (double)(2 * (int32_t)(h >> 9) + 1) * 0x1p-23 - 1.0;
}

/* The hash whose number is the slope along `axis` of uniformly distributed slopes. */
static inline uint32_t wr_lattice_slope_hash(uint32_t h, int axis)
{
    return wr_mix32(h + 0xc2b2ae35U * ((uint32_t)axis + 1U));
}

/* A gradient from the fixed set of `dim`, selected by the upper bits of h:
 * 1D  eight slopes +-1/8 .. +-1
 * 2D  sixteen unit vectors at odd multiples of 11.25 degrees
 * 3D  the twelve midpoints of a cube's edges, (1,1,0) and so on: length sqrt(2)   Perlin 2002
 * 4D  the 32 midpoints of a 4-cube's edges, (0,1,1,1) and so on: length sqrt(3)   Gustavson 2005 */
const double *wr_lattice_gradient(int dim, uint32_t h);

/* random(v) = fract(5678.1234 sin(12.3456 x + 78.910 y + 1.1235 + salt)) of the lecture, in double.
 *
 * Only for reproducing old images in double: float and double give uncorrelated numbers even for small
 * integer x and y. The sine used here is deterministic, so the bits are the same everywhere; a GLSL
 * double may differ in the last digits. The result is in [0, 1): the text's fract yields 1 for tiny
 * negative numbers, this function 0. Not finite: 0. */
double wr_hash_lecture(double x, double y, double salt);

/* t reduced to [0, period): floored modulus, exact if double can represent the result, for any t;
 * non-finite t counts as 0. period > 0 and an integer; 0: t itself, or 0. */
double wr_noise_reduce(double t, double period);
