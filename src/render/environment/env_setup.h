/* env_setup.h - per-frame environment parameters for one object.
   Private to the renderer. */
#pragma once
#include "render/kernels/kern.h"
#include "shade/environment_brdf.h"

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
