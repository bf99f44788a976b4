/* env_prefilter.h - environment prefiltered by lobes of several widths, with the reflected shares at steps of
   roughness. Private to the renderer. Kept between frames. For surfaces whose roughness varies from sample to
   sample, or is widened by slopes. */
#pragma once
#include "render/environment/env_lookup.h"
#include "shade/textured_reflection.h"

typedef struct WrPlan WrPlan;
typedef struct WrScene WrScene;
typedef struct WrTileJob WrTileJob;

typedef struct WrEnvPrefilter {
    WrEnvLookup rung[WR_TEXTURED_REFLECTION_RUNGS]; /* only the levels in use */
    WrReflectance of; /* the reflectance that `vary` was computed for */
    double ks, tint;
    bool gated, there;
    WrTexturedReflection vary;
} WrEnvPrefilter;

bool wr_env_prefilter_update(WrEnvPrefilter *grades, const WrScene *scene, const WrPlan *plan,
                             WrPool *pool, WrError *err);
void wr_env_prefilter_fill(const WrEnvPrefilter *grades, const WrScene *scene, WrTileJob *job);
void wr_env_prefilter_drop(WrEnvPrefilter *grades);
void wr_env_prefilter_drop_rungs(
    WrEnvPrefilter *grades); /* frees the prefiltered tables; keeps the reflected shares */
