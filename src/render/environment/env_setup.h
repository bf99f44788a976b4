/* env_setup.h - per-frame environment parameters for one object.
   Private to the renderer. */
#pragma once
#include "render/kernels/kern.h"
#include "shade/environment_brdf.h"
#include "shade/environment_map.h"
#include "shade/svbrdf.h"

#include <stdbool.h>

/* ---- environment table for mirrored directions, sharp or blurred by a material's lobe ---- */

/* Kept between frames. */

typedef struct WrPool WrPool;

typedef struct WrEnvLookup {
    WrEnvironmentMap *source; /* own share; NULL: empty */
    WrEnvironmentBrdf gloss;  /* the lobe that blurs it; lobe none: sharp */
    double fine;
    /* texels; pitch: row length including one neighbour texel on either side */
    int width, height, pitch;
    float *rgba; /* [height + 2][pitch][4], with an extra row above and below, A 0; owned */
} WrEnvLookup;

/* Updates the table. gloss NULL: sharp. fine: as in wr_blur_width. Errors: no memory, cancelled; the table is
   then empty. */
bool wr_env_lookup_update(WrEnvLookup *mirror, const WrEnvironmentMap *map,
                          const WrEnvironmentBrdf *gloss, double fine, WrPool *pool, WrError *err);
void wr_env_lookup_drop(WrEnvLookup *mirror);

/* ---- environment prefiltered by lobes of several widths, with the reflected shares at steps of roughness ---- */

/* Kept between frames. For surfaces whose roughness varies from sample to sample, or is widened by slopes. */

typedef struct WrPlan WrPlan;
typedef struct WrScene WrScene;
typedef struct WrTileJob WrTileJob;

typedef struct WrEnvPrefilter {
    WrEnvLookup rung[WR_SVBRDF_RUNGS]; /* only the levels in use */
    WrReflectance of;                  /* the reflectance that `vary` was computed for */
    double ks, tint;
    bool gated, there;
    WrSvbrdf vary;
} WrEnvPrefilter;

bool wr_env_prefilter_update(WrEnvPrefilter *grades, const WrScene *scene, const WrPlan *plan,
                             WrPool *pool, WrError *err);
void wr_env_prefilter_fill(const WrEnvPrefilter *grades, const WrScene *scene, WrTileJob *job);
void wr_env_prefilter_drop(WrEnvPrefilter *grades);
void wr_env_prefilter_drop_rungs(
    WrEnvPrefilter *grades); /* frees the prefiltered tables; keeps the reflected shares */

typedef struct WrEnvLookup WrEnvLookup;
typedef struct WrPlan WrPlan;
typedef struct WrScene WrScene;

typedef struct WrEnvironmentMapLook {
    WrKernSurround single;
    WrKernSurroundd wide;
    WrKernMirror mirror;
    WrKernMirrord mirror_wide;
    int shares; /* diffuse terms: 0: Lambert; 1: by n.v; 2: by n.v, with interreflection */
} WrEnvironmentMapLook;

/* Fills the parameters. rotation: the object's axes -> the world, as in WrPlacement. */
void wr_environment_map_look(const WrScene *scene, const WrPlan *plan, const double rotation[9],
                             const WrEnvLookup *mirror, WrEnvironmentMapLook *out);
