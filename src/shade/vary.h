/* vary.h - what reflection goes by where roughness and metalness are not the same everywhere: the shares of light that are
   worked out once for a material, at sixteenths of roughness, between which they go straight; and the rungs that
   surroundings are blurred by.
   Layer 3. The reference renderer works each place out by itself. */
#pragma once
#include "shade/gloss.h"

#define WR_VARY_STEPS 17 /* roughness 0, 1/16 .. 1 */

typedef struct WrVary {
    double mean[WR_VARY_STEPS], again[WR_VARY_STEPS]; /* WrMatter's */
    double albedo[WR_VARY_STEPS][WR_ALBEDO_TERMS];    /* likewise, of no metal */
    double matt[WR_VARY_STEPS][WR_ALBEDO_TERMS];      /* WrGloss's, of no metal */
    double twice[WR_VARY_STEPS][WR_ALBEDO_TERMS];     /* its again */
    double own[2][WR_VARY_STEPS][WR_ALBEDO_TERMS];    /* of no metal and of metal */
    double white[2][WR_VARY_STEPS][WR_ALBEDO_TERMS];
} WrVary;

/* ks, tint, gated: as of wr_gloss_init. Takes some milliseconds. Of models that do not go by roughness all steps are alike. */
void wr_vary_init(WrVary *vary, const WrReflectance *of, double ks, double tint, bool gated);

/* The rungs' lobes: of width 1, 1/2 .. 1/64; then the surroundings as they are. */
#define WR_VARY_RUNGS 8
/* The gloss of that rung, but the last, for a surface of that lobe. */
void wr_vary_rung(const WrGloss *gloss, int rung, WrGloss *out);
