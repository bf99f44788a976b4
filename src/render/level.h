/* level.h - where a table has no slope: what is shaded there alone needs no bump (E6, for a run of samples).
   Layer 5, private to the renderer. */
#pragma once
#include <stdbool.h>

typedef struct WrLevel {
    bool asked; /* false: nothing is known */
    /* Of each tile of the table, [tiles_v][tiles_u], borrowed: is there a central difference that is not 0? Or, NULL, its
       least and largest height: slopes of other schemes are 0 where all that they read is equal (HC47). */
    const unsigned char *sloped;
    const float *low, *high;
    int tiles_u, tiles_v;
    int width, height; /* of the table, texels */
    double ru, rv;     /* replication */
    bool periodic_u, periodic_v;
} WrLevel;

/* Is every slope 0 that is looked up from u0 .. u1, v0 .. v1? Certain where true: a box over many tiles is not looked
   through. */
bool wr_level_box(const WrLevel *level, double u0, double u1, double v0, double v1);
