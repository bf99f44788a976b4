/* svbrdf.h - tables for a spatially varying BRDF: roughness and metalness of each sample.

   The fractions of light that are computed once per material are tabulated at sixteenths of roughness,
   with linear interpolation; surroundings are blurred at several rungs. The reference renderer computes
   each point separately. */
#pragma once
#include "shade/environment_brdf.h"

#define WR_SVBRDF_STEPS 17 /* roughness 0, 1/16 .. 1 */

typedef struct WrSvbrdf {
    double mean[WR_SVBRDF_STEPS], again[WR_SVBRDF_STEPS]; /* WrMatter's */
    double albedo[WR_SVBRDF_STEPS][WR_ALBEDO_TERMS];      /* WrMatter's, without metal */
    double matt[WR_SVBRDF_STEPS][WR_ALBEDO_TERMS];        /* WrEnvironmentBrdf's, without metal */
    double twice[WR_SVBRDF_STEPS][WR_ALBEDO_TERMS];       /* its `again` */
    double own[2][WR_SVBRDF_STEPS][WR_ALBEDO_TERMS];      /* without metal and for metal */
    double white[2][WR_SVBRDF_STEPS][WR_ALBEDO_TERMS];
} WrSvbrdf;

/* ks, tint, gated: as in wr_environment_brdf_init. Takes some milliseconds. For models without
 * roughness all steps are equal. */
void wr_svbrdf_init(WrSvbrdf *vary, const WrReflectance *of, double ks, double tint, bool gated);

/* The rungs' lobes: of width 1, 1/2 .. 1/64; then the unblurred surroundings. */
#define WR_SVBRDF_RUNGS 8
/* The gloss of a rung except the last, for a surface of that lobe. */
void wr_svbrdf_rung(const WrEnvironmentBrdf *gloss, int rung, WrEnvironmentBrdf *out);
