/* svbrdf.h - tables for reflection with varying roughness and metalness.

   The fractions of light that are computed once per material are tabulated at sixteenths of roughness,
   with linear interpolation; surroundings are blurred at several rungs. The reference renderer computes
   each point separately. */
#pragma once
#include "shade/environment_brdf.h"

#define WR_TEXTURED_REFLECTION_STEPS 17 /* roughness 0, 1/16 .. 1 */

typedef struct WrTexturedReflection {
    double mean[WR_TEXTURED_REFLECTION_STEPS], again[WR_TEXTURED_REFLECTION_STEPS]; /* WrMatter's */
    double albedo[WR_TEXTURED_REFLECTION_STEPS][WR_ALBEDO_TERMS]; /* WrMatter's, without metal */
    double matt[WR_TEXTURED_REFLECTION_STEPS]
               [WR_ALBEDO_TERMS]; /* WrEnvironmentBrdf's, without metal */
    double twice[WR_TEXTURED_REFLECTION_STEPS][WR_ALBEDO_TERMS];  /* its `again` */
    double own[2][WR_TEXTURED_REFLECTION_STEPS][WR_ALBEDO_TERMS]; /* without metal and for metal */
    double white[2][WR_TEXTURED_REFLECTION_STEPS][WR_ALBEDO_TERMS];
} WrTexturedReflection;

/* ks, tint, gated: as in wr_environment_brdf_init. Takes some milliseconds. For models without
 * roughness all steps are equal. */
void wr_textured_reflection_init(WrTexturedReflection *vary, const WrReflectance *of, double ks,
                                 double tint, bool gated);

/* The rungs' lobes: of width 1, 1/2 .. 1/64; then the unblurred surroundings. */
#define WR_TEXTURED_REFLECTION_RUNGS 8
/* The gloss of a rung except the last, for a surface of that lobe. */
void wr_textured_reflection_rung(const WrEnvironmentBrdf *gloss, int rung, WrEnvironmentBrdf *out);
