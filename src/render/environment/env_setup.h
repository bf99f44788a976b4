/* env_setup.h - the scene's surroundings as an object's pictures need them.
   Layer 5, private to the renderer. */
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
    int shares; /* of diffuse light: 0: Lambert's; 1: by n.v; 2: and what is reflected again */
} WrEnvironmentMapLook;

/* rotation: the object's axes -> the world, as WrPlacement has it. */
void wr_environment_map_look(const WrScene *scene, const WrPlan *plan, const double rotation[9],
                             const WrEnvLookup *mirror, WrEnvironmentMapLook *out);
