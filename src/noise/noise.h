/* noise.h - value, gradient and simplex noise with analytic gradients, at one point.

   x = t - floor(t) within a cell, per axis; alpha the fade; sums over the corners k of the cell
   (simplex), p_k their positions, f_k and g_k the values and slopes prescribed there.

   | kind     | f(t)                                                  | dims | repeats              | |f| <= |
   | value    | sum w_k f_k,  w_k products of alpha(x), 1 - alpha(x)   | 1-3  | any period           | 1      |
   | gradient | sum w_k (f_k + g_k . (t - p_k))                        | 1-3  | any period           | 1 + d/2|
   | perlin   | gradient with f_k = 0 and g_k from a fixed set         | 1-3  | any period           | 1      |
   | simplex  | c sum max(0, 1/2 - |t - p_k|^2)^4 g_k . (t - p_k)      | 2, 3 | 3D: multiples of 3   | 1      |
   | sheared  | simplex on triangles of base 1 and height 1, with 4/5  | 2    | y even               | 1      |
   | torus    | 4D simplex on a torus, circumferences the periods      | 2    | any period, always   | 1      |
   | cubes    | torus with 4D perlin, on 16 corners instead of 5       | 2    | any period, always   | 1      |

   Bounds hold for hashed lattices; for data see wr_noise_bound.

   Source   value, gradient: the lecture, "Procedural Noise". Its first form (the fade x itself) matches
            the values but not the slopes: f'(0+) = g_0 + (f_1 - f_0 - g_1); alpha'(0) = alpha'(1) = 0
            corrects that. The upper corner is floor(t) + 1, never ceil(t), taken modulo the period like
            the lower one; the far weight is 1 - alpha(x). perlin: Perlin 1985, 2002. simplex: Perlin
            2001, after Gustavson 2005 with his 0.6 for 3D replaced by 1/2, so that no corner's term is
            cut off where it is not 0. sheared: Gustavson and McEwan 2022 (psrdnoise).

   2D simplex cannot repeat on a square: its lattice is skewed by (sqrt(3) - 1)/2, irrational, so no two
   of its points are a multiple of (1, 0) apart. sheared and torus are the alternatives. In 3D the skew
   is 1/3, and a period of 3m per axis shifts lattice indices by (4m, m, m): the index is hashed as 6
   q_a - (q_1 + q_2 + q_3) modulo 18m, which no such shift changes. */
#pragma once
#include "noise/lattice.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;

typedef enum WrNoiseKind {
    WR_NOISE_VALUE,
    WR_NOISE_GRADIENT,
    WR_NOISE_PERLIN,
    WR_NOISE_SIMPLEX,
    WR_NOISE_SHEARED,
    WR_NOISE_TORUS,
    WR_NOISE_CUBES,
    WR_NOISE_KIND_COUNT
} WrNoiseKind;

/* Periodicity of a kind in `dim` dimensions. */
typedef struct WrNoiseRepeat {
    bool works;              /* the kind exists in this many dimensions */
    bool always;             /* a period is required */
    int step[WR_NOISE_AXES]; /* periods are multiples of this; 0: not periodic */
} WrNoiseRepeat;

typedef struct WrNoiseInfo {
    const char *name;  /* as in commands: "perlin" */
    const char *label; /* for people */
    const char *help;  /* one sentence */
    bool cells;        /* consists of square cells blended by a fade: uses the fade */
    WrNoiseRepeat repeat[WR_NOISE_AXES]; /* by dim - 1 */
} WrNoiseInfo;

extern const WrNoiseInfo wr_noises[WR_NOISE_KIND_COUNT];
/* The kind of that name, or -1. */
int wr_noise_find(const char *name);

typedef struct WrNoise {
    WrNoiseKind kind;
    WrFade fade; /* value, gradient, perlin */
    int dim;     /* 1..3 */
    WrLattice lattice;
} WrNoise;

/* Checks that kind, fade, dimension, periods and data fit together. Errors name the mismatch. */
bool wr_noise_check(const WrNoise *noise, WrError *err);

/* f and its gradient at t. This is the definition; wr_octaves_grid agrees with it to a stated bound.
 *
 * noise    checked by wr_noise_check
 * t        [dim] cells, any value; first reduced to one period, exactly; non-finite values count as 0.
 *          Without a period, coordinates beyond 2^40 are reduced to 2^40 cells.
 * slope    [dim] df/dt, per cell; NULL = not wanted. With the linear fade, at a cell's border that of
 *          the cell above it
 * Returns  f, finite
 * Errors   none      Threads  any number At lattice points f is exactly the prescribed value and, with
 *          a smooth fade, the slope exactly the prescribed one; perlin and sheared give exactly 0,
 *          simplex as near to 0 as its points can be represented (HC59). The same t plus whole periods
 *          produces the same bits as long as the sum is exact. */
double wr_noise_at(const WrNoise *noise, const double *t, double *slope);

/* The prescribed value and slope[dim] of a lattice at index c (within one period, each below
 * period[a]). Only for the kinds with cells. value's slopes are 0. */
double wr_noise_lattice_value(const WrNoise *noise, const uint32_t *c, double *slope);

/* An upper bound of |f|: the table above, or for data max |f_k| + max |g_k| sqrt(d)/2. */
double wr_noise_bound(const WrNoise *noise);
