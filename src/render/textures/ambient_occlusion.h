/* ambient_occlusion.h - how much of the sky the relief leaves open at each texel, as the renderer keeps it.
   Layer 5, private to the renderer. */
#pragma once
#include "field/horizon.h"

#include <stdint.h>

typedef struct WrScene WrScene;

/* Zero-initialise; drop frees. */
typedef struct WrOcclusionMapTable {
    float *open; /* wr_occlusion_map_table's, owned; NULL: none */
    int width, height;
    uint64_t key; /* of the table (wr_field_key) ... */
    int directions;
    /* ... and how long a texel is, in units of height; below 0 where it stands inside out */
    double across, down;
} WrOcclusionMapTable;

void wr_occlusion_map_table_drop(WrOcclusionMapTable *table);

/* Which table horizons are of. */
typedef struct WrOcclusionMapEdit {
    uint64_t key, before;         /* of it; of the one that an edit made it of */
    const unsigned char *changed; /* what that changed (wr_horizon_update); NULL: it is not known */
} WrOcclusionMapEdit;

/* Bring it up to date with the horizons of that table. A texel is as long as on the mean over the surface;
   the scene's height is not 0. Errors: no memory; cancelled; then there is no table. */
bool wr_occlusion_map_table_bring(WrOcclusionMapTable *table, const WrScene *scene,
                                  const WrField *field, const WrOcclusionMapEdit *edit,
                                  const WrHorizon *horizon, WrPool *pool, WrError *err);
/* How long a texel is along u and v, in units of height (of one that is not 0), on the mean. */
void wr_occlusion_map_texel(const WrScene *scene, const WrField *field, double *across,
                            double *down);
