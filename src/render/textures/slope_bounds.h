/* slope_bounds.h - how steep a table is where a run of samples reads it: where it has no slope they need no bump, and bounds of
   slopes bound their normals.
   Layer 5, private to the renderer. */
#pragma once
#include <stdbool.h>

typedef struct WrLevel {
    /* Of each tile of the table, [tiles_v][tiles_u], borrowed: its largest central differences, dF/du and dF/dv. Or,
       NULL, its least and largest height: slopes of other schemes are 0 where all that they read is equal (HC47), and
       else not known. */
    const float (*steep)[2];
    const float *low, *high;
    float steepest[2], gentlest[2]; /* of all tiles */
    int tiles_u, tiles_v;
    int width, height; /* of the table, texels */
    double ru, rv;     /* replication */
    bool periodic_u, periodic_v;
} WrLevel;

/* No slope dF/du, dF/dv that is looked up from u0 .. u1, v0 .. v1 is larger than this, either sign; INFINITY: not known.
   A box over many tiles is not looked through: it is as steep as any. */
void wr_level_box(const WrLevel *level, double u0, double u1, double v0, double v1,
                  float steepest[2]);
