/* slope_bounds.h - upper bounds of the table's slopes over the area that a run of samples reads. Private to the
   renderer. Where the bound is 0 no bump is needed; elsewhere it bounds the bent normals. */
#pragma once
#include <stdbool.h>

typedef struct WrLevel {
    /* [tiles_v][tiles_u], borrowed: each tile's largest central differences, dF/du and dF/dv. If NULL, low and
       high are each tile's least and largest height: slopes of other schemes are 0 where all texels read are
       equal (HC47), and else unknown. */
    const float (*steep)[2];
    const float *low, *high;
    float steepest[2], gentlest[2]; /* of all tiles */
    int tiles_u, tiles_v;
    int width, height; /* of the table, texels */
    double ru, rv;     /* replication */
    bool periodic_u, periodic_v;
} WrLevel;

/* Upper bound of |dF/du| and |dF/dv| over fetches from u0 .. u1, v0 .. v1; INFINITY: unknown. A box over many
   tiles is not searched: it gets the bound of the whole table. */
void wr_level_box(const WrLevel *level, double u0, double u1, double v0, double v1,
                  float steepest[2]);
