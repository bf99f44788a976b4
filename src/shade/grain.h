/* grain.h - solid textures: a pattern in space out of which an object is cut, so that its grain goes through it and stays
   where it is however the object turns.
   Layer 3. The reference renderer has formulas of its own, on purpose.

   At the point P of the object, in scene units, before it is turned and stretched:

     N = sum over i of r^-i f_i(2^i q P),  f value noise (noise/noise.h);  T = the same of |f_i|, f Perlin's
     wood      t = k rho + A N, rho the distance from the axis;  g = 1 where frac t >= 1 - d
     marble    t = k z + A T, z along the axis;                  g = 1/2 + 1/2 sin 2 pi t
     checker   g = the parity of floor k x + floor k y + floor k z
     granite   g = A T, at most 1
     noise     g = 1/2 + A N / 2, within 0 and 1

   With an edge e steps of wood and checker go over within e of a ring or cell: g is its mean over t - e/2 .. t + e/2, and
   so it is over what a pixel holds where that is wanted (shade/grain_body.h). Octaves of which a pixel holds half a cell
   are their mean, and what they would have moved edges by widens those.

   It drives, by the bits of WrGrainDrive:
     colour      light + g (dark - light), times the material's colour and the colour picture
     roughness   of the material, from the light's to the dark's
     bump        a height h g: n' = unit(n - (s - (s.n) n)), s = h grad g in space                  (Perlin 1985) */
#pragma once
#include <stdbool.h>

typedef struct WrOctavesPlan WrOctavesPlan;

typedef enum WrGrainKind {
    WR_GRAIN_OFF,
    WR_GRAIN_WOOD,
    WR_GRAIN_MARBLE,
    WR_GRAIN_CHECKER,
    WR_GRAIN_GRANITE,
    WR_GRAIN_NOISE,
    WR_GRAIN_KINDS
} WrGrainKind;

typedef enum WrGrainAxis { WR_GRAIN_X, WR_GRAIN_Y, WR_GRAIN_Z, WR_GRAIN_AXES } WrGrainAxis;
extern const char *const wr_grain_axes[WR_GRAIN_AXES]; /* as in commands */

typedef enum WrGrainDrive {
    WR_GRAIN_COLOURS = 1,
    WR_GRAIN_ROUGHENS = 2,
    WR_GRAIN_BUMPS = 4,
    WR_GRAIN_DRIVES = 8 /* sets of them; 0 is none of a command's */
} WrGrainDrive;
extern const char *const wr_grain_drives[WR_GRAIN_DRIVES];

/* Noise and what becomes of it. */
typedef enum WrGrainNoise {
    WR_GRAIN_SMOOTH, /* value noise */
    WR_GRAIN_SOFT,   /* |Perlin's| */
    WR_GRAIN_NOISES
} WrGrainNoise;
/* Of one octave: over all of space. */
extern const double wr_grain_means[WR_GRAIN_NOISES], wr_grain_variances[WR_GRAIN_NOISES];
/* Of c x^2 (shade/grain_body.h). */
extern const double wr_grain_fadings[WR_GRAIN_NOISES];

typedef struct WrGrain {
    WrGrainKind kind;
    WrGrainAxis axis;
    int drives;               /* bits of WrGrainDrive */
    double light[3], dark[3]; /* linear RGB */
    double rings;             /* k: rings, bands or cells of the board a scene unit */
    double share;             /* d: of a ring, that is dark; 0..1 */
    double amount; /* A: how far noise moves rings, in rings; of granite and noise their contrast */
    double cells;  /* q: cells of noise a scene unit, of the first octave */
    double octaves;      /* 1..WR_GRAIN_OCTAVES, whole */
    double ratio;        /* r: each octave is that much weaker than the one before; above 1 */
    double edge;         /* e: 0..1 */
    double height;       /* h, scene units; any */
    double roughness[2]; /* of light and of dark: 0..1 */
} WrGrain;

#define WR_GRAIN_OCTAVES 10

typedef struct WrGrainInfo {
    const char *name, *title, *help;
    bool ringed;  /* rings, and the axis that they go by, count */
    bool shared;  /* share counts */
    bool noisy;   /* noise counts */
    bool stepped; /* it has steps, and edge counts */
    WrGrainNoise noise;
    WrGrain usual;
} WrGrainInfo;
extern const WrGrainInfo wr_grains[WR_GRAIN_KINDS];

/* The noise of one: how many octaves, where, and how strong. */
void wr_grain_noise(const WrGrain *grain, WrOctavesPlan *out);
/* The edge that counts: a step has no slope, so that bumps have one of a sixteenth at least. */
double wr_grain_edge(const WrGrain *grain);
