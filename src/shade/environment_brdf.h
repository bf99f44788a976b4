/* environment_brdf.h - reflection of surroundings: for each model the fractions of diffuse and mirrored
   light, as polynomials, and the lobe that blurs the latter.

   The reference renderer integrates a lamp's formulas over all directions instead. A lamp contributes
   pi f (n.l) (shade/reflection.h), so surroundings contribute (1/pi) of its integral with L over
   directions:

     diffuse    kd matt(n.v) E(n') / pi         exact for a constant colour; else approximated,
                                                with matt independent of l
     glossy     (own(n.v) C + white(n.v)) G(r)  own and white are the lobe's own integrals, G the mean
                                                of L with the lobe of n = v = r (Karis 2013):
                                                ignores the stretch of lobes at grazing angles
   */
#pragma once
#include "shade/reflection.h"

/* Lobes as functions of c = l.r. */
typedef enum WrLobe {
    WR_LOBE_NONE,   /* only diffuse light is reflected */
    WR_LOBE_POWER,  /* max(0, c)^s: Phong's */
    WR_LOBE_HALF,   /* ((1 + c) / 2)^(s/2): a power of n.h */
    WR_LOBE_FACETS, /* max(0, c) D, D of GGX facets at n.h = sqrt((1 + c) / 2) */
    WR_LOBES
} WrLobe;

typedef struct WrEnvironmentBrdf {
    bool plain; /* matt is 1 and again 0: Lambert's */
    /* Polynomials in x = sqrt(n'.v), coefficients from x^0 on: */
    double matt[WR_ALBEDO_TERMS]; /* of kd E / pi in the surface's colour */
    double
        again[WR_ALBEDO_TERMS]; /* interreflection, multiplied by each colour's kept fraction, with
                                   `mean` */
    double own[WR_ALBEDO_TERMS],
        white[WR_ALBEDO_TERMS]; /* including ks and tint: in the surface's colour, in the light's */
    double mean;
    WrLobe lobe;
    double alpha; /* of facets; for powers the equivalent width sqrt(2 / (s + 2)) */
    double power;
    bool gated; /* no light from below the horizon */
} WrEnvironmentBrdf;

/* matter: from wr_matter_init for the same reflectance. ks, tint: of the material; gated: its
 * highlights are. */
void wr_environment_brdf_init(WrEnvironmentBrdf *gloss, const WrReflectance *of,
                              const WrMatter *matter, double ks, double tint, bool gated);
/* Weight in the mean of the light from a direction c = l.r, below = 1 - c; in any scale. */
double wr_environment_brdf_lobe(const WrEnvironmentBrdf *gloss, double c, double below);
