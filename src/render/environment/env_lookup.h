/* env_lookup.h - environment table for mirrored directions, sharp or blurred by a material's lobe. Private to
   the renderer. Kept between frames. */
#pragma once
#include "shade/environment_brdf.h"
#include "shade/environment_map.h"

#include <stdbool.h>

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
bool wr_env_lookup_update(WrEnvLookup *mirror, const WrEnvironmentMap *surround,
                          const WrEnvironmentBrdf *gloss, double fine, WrPool *pool, WrError *err);
void wr_env_lookup_drop(WrEnvLookup *mirror);
