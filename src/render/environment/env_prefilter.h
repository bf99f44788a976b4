/* env_prefilter.h - surroundings blurred by lobes of several widths, and the shares of light at steps of roughness: for surfaces whose
   roughness changes from sample to sample, or is widened by slopes.
   Layer 5, private to the renderer. Kept from frame to frame. */
#pragma once
#include "render/environment/env_lookup.h"
#include "shade/textured_reflection.h"

typedef struct WrPlan WrPlan;
typedef struct WrScene WrScene;
typedef struct WrTileJob WrTileJob;

typedef struct WrEnvPrefilter {
    WrEnvLookup rung[WR_TEXTURED_REFLECTION_RUNGS]; /* those that are called for */
    WrReflectance of;                               /* what vary was made of */
    double ks, tint;
    bool gated, there;
    WrTexturedReflection vary;
} WrEnvPrefilter;

bool wr_env_prefilter_bring(WrEnvPrefilter *grades, const WrScene *scene, const WrPlan *plan,
                            WrPool *pool, WrError *err);
void wr_env_prefilter_fill(const WrEnvPrefilter *grades, const WrScene *scene, WrTileJob *job);
void wr_env_prefilter_drop(WrEnvPrefilter *grades);
void wr_env_prefilter_drop_rungs(
    WrEnvPrefilter *grades); /* the shares of light, which take some time, stay */
