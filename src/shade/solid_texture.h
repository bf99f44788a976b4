/* solid_texture.h - solid textures: a pattern in object space that colours, roughens or bumps the
   object as if carved from it.

   The grain stays fixed however the object turns. The reference renderer intentionally has formulas of
   its own. At the point P of the object, in scene units, before rotation and stretch:

     N = sum over i of r^-i f_i(2^i q P),  f value noise (noise/noise.h);  T = the sum of |f_i|, f Perlin noise
     wood      t = k rho + A N, rho the distance from the axis;  g = 1 where frac t >= 1 - d
     marble    t = k z + A T, z along the axis;                  g = 1/2 + 1/2 sin 2 pi t
     checker   g = the parity of floor k x + floor k y + floor k z
     granite   g = A T, at most 1
     noise     g = 1/2 + A N / 2, within 0 and 1

   With an edge e, steps of wood and checker are smoothed within e of a ring or cell: g is its mean over
   t - e/2 .. t + e/2. It can also be averaged over a pixel (shade/solid_texture_body.h). Octaves with
   half a cell or more per pixel are replaced by their mean, and their displacement of edges widens
   those. It affects, by the bits of WrSolidTextureDrive:

     colour      light + g (dark - light), times the material's colour and the colour picture
     roughness   of the material, from the light's to the dark's
     bump        a height h g: n' = unit(n - (s - (s.n) n)), s = h grad g in space                  (Perlin 1985)
   */
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
    WR_SOLID_TEXTURE_DRIVES = 8 /* number of combinations; 0 is not available in commands */
} WrSolidTextureDrive;
extern const char *const wr_solid_texture_drives[WR_SOLID_TEXTURE_DRIVES];

/* Kinds of noise. */
typedef enum WrSolidTextureNoise {
    WR_SOLID_TEXTURE_SMOOTH, /* value noise */
    WR_SOLID_TEXTURE_SOFT,   /* |Perlin's| */
    WR_SOLID_TEXTURE_NOISES
} WrSolidTextureNoise;
/* For one octave: over all of space. */
extern const double wr_solid_texture_means[WR_SOLID_TEXTURE_NOISES],
    wr_solid_texture_variances[WR_SOLID_TEXTURE_NOISES];
/* Factor c of c x^2 (shade/solid_texture_body.h). */
extern const double wr_solid_texture_fadings[WR_SOLID_TEXTURE_NOISES];

typedef struct WrSolidTexture {
    WrSolidTextureKind kind;
    WrSolidTextureAxis axis;
    int drives;               /* bits of WrSolidTextureDrive */
    double light[3], dark[3]; /* linear RGB */
    double rings;             /* k: rings, bands or checker cells per scene unit */
    double share;             /* d: dark fraction of a ring; 0..1 */
    double amount;       /* A: displacement of rings by noise, in rings; for granite and noise their
                      contrast */
    double cells;        /* q: noise cells per scene unit, of the first octave */
    double octaves;      /* 1..WR_SOLID_TEXTURE_OCTAVES, an integer */
    double ratio;        /* r: amplitude ratio of successive octaves; above 1 */
    double edge;         /* e: 0..1 */
    double height;       /* h, scene units; any value */
    double roughness[2]; /* for light and for dark: 0..1 */
} WrSolidTexture;

#define WR_SOLID_TEXTURE_OCTAVES 10

typedef struct WrSolidTextureInfo {
    const char *name, *title, *help;
    bool ringed;  /* uses rings and their axis */
    bool shared;  /* uses share */
    bool noisy;   /* uses noise */
    bool stepped; /* has steps, and uses edge */
    WrSolidTextureNoise noise;
    WrSolidTexture usual;
} WrSolidTextureInfo;
extern const WrSolidTextureInfo wr_grains[WR_SOLID_TEXTURE_KINDS];

/* The noise of a solid texture: number, frequencies and strengths of octaves. */
void wr_solid_texture_noise(const WrSolidTexture *grain, WrOctavesPlan *out);
/* The effective edge: a step has no slope, so bumps use at least a sixteenth. */
double wr_solid_texture_edge(const WrSolidTexture *grain);
