/* solid_texture.h - solid textures: a pattern in space out of which an object is cut, so that its grain goes through it and stays
   where it is however the object turns.
   The reference renderer has formulas of its own, on purpose.

   At the point P of the object, in scene units, before it is turned and stretched:

     N = sum over i of r^-i f_i(2^i q P),  f value noise (noise/noise.h);  T = the same of |f_i|, f Perlin's
     wood      t = k rho + A N, rho the distance from the axis;  g = 1 where frac t >= 1 - d
     marble    t = k z + A T, z along the axis;                  g = 1/2 + 1/2 sin 2 pi t
     checker   g = the parity of floor k x + floor k y + floor k z
     granite   g = A T, at most 1
     noise     g = 1/2 + A N / 2, within 0 and 1

   With an edge e steps of wood and checker go over within e of a ring or cell: g is its mean over t - e/2 .. t + e/2, and
   so it is over what a pixel holds where that is wanted (shade/solid_texture_body.h). Octaves of which a pixel holds half a cell
   are their mean, and what they would have moved edges by widens those.

   It drives, by the bits of WrSolidTextureDrive:
     colour      light + g (dark - light), times the material's colour and the colour picture
     roughness   of the material, from the light's to the dark's
     bump        a height h g: n' = unit(n - (s - (s.n) n)), s = h grad g in space                  (Perlin 1985) */
#pragma once
#include <stdbool.h>

typedef struct WrOctavesPlan WrOctavesPlan;

typedef enum WrSolidTextureKind {
    WR_SOLID_TEXTURE_OFF,
    WR_SOLID_TEXTURE_WOOD,
    WR_SOLID_TEXTURE_MARBLE,
    WR_SOLID_TEXTURE_CHECKER,
    WR_SOLID_TEXTURE_GRANITE,
    WR_SOLID_TEXTURE_NOISE,
    WR_SOLID_TEXTURE_KINDS
} WrSolidTextureKind;

typedef enum WrSolidTextureAxis {
    WR_SOLID_TEXTURE_X,
    WR_SOLID_TEXTURE_Y,
    WR_SOLID_TEXTURE_Z,
    WR_SOLID_TEXTURE_AXES
} WrSolidTextureAxis;
extern const char *const wr_solid_texture_axes[WR_SOLID_TEXTURE_AXES]; /* as in commands */

typedef enum WrSolidTextureDrive {
    WR_SOLID_TEXTURE_COLOURS = 1,
    WR_SOLID_TEXTURE_ROUGHENS = 2,
    WR_SOLID_TEXTURE_BUMPS = 4,
    WR_SOLID_TEXTURE_DRIVES = 8 /* sets of them; 0 is none of a command's */
} WrSolidTextureDrive;
extern const char *const wr_solid_texture_drives[WR_SOLID_TEXTURE_DRIVES];

/* Noise and what becomes of it. */
typedef enum WrSolidTextureNoise {
    WR_SOLID_TEXTURE_SMOOTH, /* value noise */
    WR_SOLID_TEXTURE_SOFT,   /* |Perlin's| */
    WR_SOLID_TEXTURE_NOISES
} WrSolidTextureNoise;
/* Of one octave: over all of space. */
extern const double wr_solid_texture_means[WR_SOLID_TEXTURE_NOISES],
    wr_solid_texture_variances[WR_SOLID_TEXTURE_NOISES];
/* Of c x^2 (shade/solid_texture_body.h). */
extern const double wr_solid_texture_fadings[WR_SOLID_TEXTURE_NOISES];

typedef struct WrSolidTexture {
    WrSolidTextureKind kind;
    WrSolidTextureAxis axis;
    int drives;               /* bits of WrSolidTextureDrive */
    double light[3], dark[3]; /* linear RGB */
    double rings;             /* k: rings, bands or cells of the board a scene unit */
    double share;             /* d: of a ring, that is dark; 0..1 */
    double amount; /* A: how far noise moves rings, in rings; of granite and noise their contrast */
    double cells;  /* q: cells of noise a scene unit, of the first octave */
    double octaves;      /* 1..WR_SOLID_TEXTURE_OCTAVES, whole */
    double ratio;        /* r: each octave is that much weaker than the one before; above 1 */
    double edge;         /* e: 0..1 */
    double height;       /* h, scene units; any */
    double roughness[2]; /* of light and of dark: 0..1 */
} WrSolidTexture;

#define WR_SOLID_TEXTURE_OCTAVES 10

typedef struct WrSolidTextureInfo {
    const char *name, *title, *help;
    bool ringed;  /* rings, and the axis that they go by, count */
    bool shared;  /* share counts */
    bool noisy;   /* noise counts */
    bool stepped; /* it has steps, and edge counts */
    WrSolidTextureNoise noise;
    WrSolidTexture usual;
} WrSolidTextureInfo;
extern const WrSolidTextureInfo wr_grains[WR_SOLID_TEXTURE_KINDS];

/* The noise of one: how many octaves, where, and how strong. */
void wr_solid_texture_noise(const WrSolidTexture *grain, WrOctavesPlan *out);
/* The edge that counts: a step has no slope, so that bumps have one of a sixteenth at least. */
double wr_solid_texture_edge(const WrSolidTexture *grain);
