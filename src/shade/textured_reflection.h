/* textured_reflection.h - what reflection goes by where roughness and metalness are not the same everywhere: the shares of light that are
   worked out once for a material, at sixteenths of roughness, between which they go straight; and the rungs that
   surroundings are blurred by.
   The reference renderer works each place out by itself. */
#pragma once
#include "shade/environment_brdf.h"

#define WR_TEXTURED_REFLECTION_STEPS 17 /* roughness 0, 1/16 .. 1 */

typedef struct WrTexturedReflection {
    double mean[WR_TEXTURED_REFLECTION_STEPS], again[WR_TEXTURED_REFLECTION_STEPS]; /* WrMatter's */
    double albedo[WR_TEXTURED_REFLECTION_STEPS][WR_ALBEDO_TERMS]; /* likewise, of no metal */
    double matt[WR_TEXTURED_REFLECTION_STEPS]
               [WR_ALBEDO_TERMS]; /* WrEnvironmentBrdf's, of no metal */
    double twice[WR_TEXTURED_REFLECTION_STEPS][WR_ALBEDO_TERMS];  /* its again */
    double own[2][WR_TEXTURED_REFLECTION_STEPS][WR_ALBEDO_TERMS]; /* of no metal and of metal */
    double white[2][WR_TEXTURED_REFLECTION_STEPS][WR_ALBEDO_TERMS];
} WrTexturedReflection;

/* ks, tint, gated: as of wr_environment_brdf_init. Takes some milliseconds. Of models that do not go by roughness all steps are alike. */
void wr_textured_reflection_init(WrTexturedReflection *vary, const WrReflectance *of, double ks,
                                 double tint, bool gated);

/* The rungs' lobes: of width 1, 1/2 .. 1/64; then the surroundings as they are. */
#define WR_TEXTURED_REFLECTION_RUNGS 8
/* The gloss of that rung, but the last, for a surface of that lobe. */
void wr_textured_reflection_rung(const WrEnvironmentBrdf *gloss, int rung, WrEnvironmentBrdf *out);
