/* env_lookup.h - the surroundings as kernels look them up in mirrored directions: as they are, or blurred by a material's lobe.
   Layer 5, private to the renderer. Kept from frame to frame. */
#pragma once
#include "shade/environment_brdf.h"
#include "shade/environment_map.h"

#include <stdbool.h>

typedef struct WrPool WrPool;

typedef struct WrEnvLookup {
    WrEnvironmentMap *source; /* own share; NULL: nothing is held */
    WrEnvironmentBrdf gloss;  /* what it is blurred by; lobe none: not */
    double fine;
    int width, height, pitch; /* texels; pitch: of a row with the one beside it on either side */
    float *rgba;              /* [height + 2][pitch][4], with a row above and below, A 0; owned */
} WrEnvLookup;

/* gloss NULL: not blurred. fine: as of wr_blur_width. Errors: no memory, cancelled: it is empty then. */
bool wr_env_lookup_bring(WrEnvLookup *mirror, const WrEnvironmentMap *surround,
                         const WrEnvironmentBrdf *gloss, double fine, WrPool *pool, WrError *err);
void wr_env_lookup_drop(WrEnvLookup *mirror);
