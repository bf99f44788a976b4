/* lattice.h - what noise is made from: whole points, each with a prescribed value and slope, and the
   fades that blend between them.
   Knows base only.

   Coordinates t are in cells: lattice points stand at whole numbers. A lattice repeats after
   period[a] cells along axis a; its index is taken by floored modulus, so that coordinates below 0
   are as good as others (HC60), and after t was brought into one period in double, so that no cast
   overflows (HC61). */
#pragma once
#include "base/hash.h"
#include "base/enum_rows.h"

#include <stdint.h>

typedef struct WrError WrError;

#define WR_NOISE_AXES 3           /* most dimensions of a caller's noise */
#define WR_LATTICE_MOST (1 << 30) /* cells of a period at most */

/* alpha(x), which goes from 0 at x = 0 to 1 at x = 1 with alpha(1 - x) = 1 - alpha(x). */
#define WR_FADES(X)                                                                                \
    X(WR_FADE_LINEAR, "linear")                                                                    \
    X(WR_FADE_CUBIC, "cubic")                                                                      \
    X(WR_FADE_QUINTIC, "quintic")
typedef enum WrFade { WR_FADES(WR_WORD_ID) WR_FADE_COUNT } WrFade;
extern const char *const wr_fade_words[]; /* as in commands; ends with NULL */

typedef struct WrFadeInfo {
    int continuity; /* derivatives of value noise that are continuous everywhere: 0, 1, 2. Gradient
                          noise has as many, and prescribed slopes are met, when it is 1 or more */
    double c[6];    /* alpha(x) = sum of c[k] x^k */
} WrFadeInfo;

/* x; 3 x^2 - 2 x^3; 10 x^3 - 15 x^4 + 6 x^5 (Perlin 2002). Indexed by WrFade. */
extern const WrFadeInfo wr_fades[WR_FADE_COUNT];

/* alpha(x); exactly 0, 1/2, 1 at x = 0, 1/2, 1. */
static inline double wr_fade_alpha(const WrFadeInfo *fade, double x)
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

/* Where a lattice's prescriptions come from. */
typedef enum WrLatticeSource {
    WR_LATTICE_HASH, /* an integer hash of seed and index: the same on every processor (HC66) */
    WR_LATTICE_LECTURE, /* wr_hash_lecture; 1D and 2D; for comparison with the lecture's pictures only */
    WR_LATTICE_DATA, /* the caller's tables */
    WR_LATTICE_SOURCE_COUNT
} WrLatticeSource;

typedef struct WrLattice {
    WrLatticeSource source;
    uint32_t seed; /* HASH: any; LECTURE: the salt; not read otherwise */
    int period
        [WR_NOISE_AXES];  /* cells along x, y, z, 1..WR_LATTICE_MOST; 0: does not repeat (a hash's
                                  indices repeat after 2^32 cells); DATA: from 1 */
    const double *values; /* DATA: [z][y][x] of period; finite; borrowed */
    const double *slopes; /* DATA: [z][y][x][dim], d/dx first, per cell; finite; borrowed */
} WrLattice;

/* A well-mixed 32-bit value of a lattice index, chained one coordinate at a time, each mixed by itself
 * first: h = mix(h ^ mix(c_a + K_a)), so that no shift of a coordinate can undo another's. dim 1..4. */
uint32_t wr_lattice_hash(uint32_t seed, const uint32_t *c, int dim);

/* The parts of that chain, for loops over rows of a lattice: the start, and one link. */
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

/* The hash whose number is the slope along `axis` of uniform prescriptions. */
static inline uint32_t wr_lattice_slope_hash(uint32_t h, int axis)
{
    return wr_mix32(h + 0xc2b2ae35U * ((uint32_t)axis + 1U));
}

/* A gradient from the fixed set of `dim`, chosen by the upper bits of h:
 * 1D  eight slopes +-1/8 .. +-1
 * 2D  sixteen unit vectors at odd multiples of 11.25 degrees
 * 3D  the twelve middles of a cube's edges, (1,1,0) and so on: length sqrt(2)   Perlin 2002
 * 4D  the 32 middles of a 4-cube's edges, (0,1,1,1) and so on: length sqrt(3)   Gustavson 2005 */
const double *wr_lattice_gradient(int dim, uint32_t h);

/* random(v) = fract(5678.1234 sin(12.3456 x + 78.910 y + 1.1235 + salt)) of the lecture, in double.
 *
 * Not to be relied on: float and double give uncorrelated numbers even for small whole x and y, so it
 * is here to repeat old pictures in double and for nothing else. Our sine is deterministic, so its bits
 * are the same everywhere; a GLSL double may differ in the last digits. The result is in [0, 1): the
 * text's fract gives 1 for tiny negative numbers, we give 0. Not finite: 0. */
double wr_hash_lecture(double x, double y, double salt);

/* t brought into [0, period): floored modulus, exact wherever double can hold the result, for any t;
 * what is not finite counts as 0. period > 0 and whole; 0: t itself, or 0. */
double wr_noise_reduce(double t, double period);
