/* environment_brdf.h - how a surface reflects its surroundings: for each model the shares of diffuse light and of what lies about the
   mirrored direction, as polynomials, and the lobe that the latter is blurred by.
   The reference renderer integrates a lamp's formulas over all directions instead.

   A lamp's share is pi f (n.l) (shade/reflection.h), so surroundings give (1/pi) of its integral with L over directions:
     diffuse    kd matt(n.v) E(n') / pi         exact under one colour; else matt is taken as if it did not depend on l
     glossy     (own(n.v) C + white(n.v)) G(r)  own and white are the lobe's own integrals, G the mean of L by the lobe
                                                that n = v = r has (Karis 2013): the stretch of grazing lobes is lost */
#pragma once
#include "shade/reflection.h"

/* Lobes by c = l.r. */
typedef enum WrLobe {
    WR_LOBE_NONE,   /* nothing is reflected but diffuse light */
    WR_LOBE_POWER,  /* max(0, c)^s: Phong's */
    WR_LOBE_HALF,   /* ((1 + c) / 2)^(s/2): a power of n.h */
    WR_LOBE_FACETS, /* max(0, c) D, D of GGX facets at n.h = sqrt((1 + c) / 2) */
    WR_LOBES
} WrLobe;

typedef struct WrEnvironmentBrdf {
    bool plain; /* matt is 1 and again 0: Lambert's */
    /* By x = sqrt(n'.v), terms of x^0 on: */
    double matt[WR_ALBEDO_TERMS]; /* of kd E / pi in the surface's colour */
    double
        again[WR_ALBEDO_TERMS]; /* times what each colour keeps: reflected more than once; mean */
    double own[WR_ALBEDO_TERMS],
        white[WR_ALBEDO_TERMS]; /* with ks and tint: in the surface's colour, in the light's */
    double mean;
    WrLobe lobe;
    double alpha; /* of facets; of powers sqrt(2 / (s + 2)): how wide it is */
    double power;
    bool gated; /* nothing from below the horizon */
} WrEnvironmentBrdf;

/* matter: as wr_matter_init has it of the same reflectance. ks, tint: of the material; gated: its highlights are. */
void wr_environment_brdf_init(WrEnvironmentBrdf *gloss, const WrReflectance *of,
                              const WrMatter *matter, double ks, double tint, bool gated);
/* How much of the light from a direction c = l.r, below = 1 - c, the mean takes; of any scale. */
double wr_environment_brdf_weight(const WrEnvironmentBrdf *gloss, double c, double below);
