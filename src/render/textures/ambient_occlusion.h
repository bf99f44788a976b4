/* ambient_occlusion.h - cached ambient occlusion of the relief at each texel: the unoccluded share of the sky.
   Private to the renderer. */
#pragma once
#include "field/horizon.h"

#include <stdint.h>

typedef struct WrScene WrScene;

/* Zero-initialise; drop frees. */
typedef struct WrOcclusionMapTable {
    float *open; /* from wr_occlusion_map_table, owned; NULL: none */
    int width, height;
    uint64_t key; /* of the table (wr_field_key) ... */
    int directions;
    /* ... and the size of a texel in units of height; negative where the surface is inside out */
    double across, down;
} WrOcclusionMapTable;

void wr_occlusion_map_table_drop(WrOcclusionMapTable *table);

/* The table that horizons belong to. */
typedef struct WrOcclusionMapEdit {
    uint64_t key, before; /* key of the table, and of the table before the edit */
    /* texels that the edit changed (wr_horizon_update); NULL: unknown */
    const unsigned char *changed;
} WrOcclusionMapEdit;

/* Updates the map from the horizons of that table. A texel has its mean length on the surface; the scene's
   height must not be 0. Errors: no memory; cancelled; then there is no map. */
bool wr_occlusion_map_table_update(WrOcclusionMapTable *table, const WrScene *scene,
                                   const WrField *field, const WrOcclusionMapEdit *edit,
                                   const WrHorizon *horizon, WrPool *pool, WrError *err);
