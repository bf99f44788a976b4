/* erode.h - weather over whole tables, in place.
   Private to this module.

   Both only move material: the sum of heights stays what it was, to rounding. A flat table stays as it is,
   bit for bit. On clamped axes nothing leaves the table. */
#pragma once
#include "generate/terrain.h"

#include <stdbool.h>
#include <stdint.h>

/* Stones roll down what is steeper than the angle of rest.
 *
 *   d_k = max(0, z - z_k - talus l_k)   to each of 8 neighbours, l_k = 1 or sqrt 2 texels
 *   of a texel flows rate/2 max(d) in all, d_k / sum(d) of it to neighbour k
 *
 * All texels at once, from the heights before: on a ring, rolled heights give rolled heights, bit for bit,
 * on any number of threads. talus in table units a texel. Errors: no memory, "cancelled". */
typedef struct WrThermal {
    double talus, rate; /* rate 0..1 */
    int rounds;
} WrThermal;
bool wr_erode_thermal(WrSheet *sheet, const WrThermal *how, const WrGenerateJob *job, WrError *err);

/* Drops of rain. Each runs downhill, takes up ground while it can carry more, lays it down where it slows,
 * and has laid down all that it carries when it dries up. Slopes are measured against the table's whole
 * relief over 1/256 of its width, so neither units nor the number of texels matter much.
 *
 * A drop runs at most 64 texels. Water that lives longer falls on grids of half and quarter the texels and
 * so on first, in smaller numbers; what it has changed there is added, drawn by a cubic. On each grid the
 * rain falls in tiles that no drop of another tile of the same time reaches: the same bits on any number of
 * threads. Places are those of the table, so a rolled one weathers otherwise. */
typedef struct WrRain {
    double drops;               /* per texel */
    double inertia;             /* 0..1, how hard it is to turn a drop */
    double capacity;            /* how much a drop can carry */
    double erosion, deposition; /* 0..1 of what it could take up or lay down, each texel */
    double evaporation;         /* of its water, each texel */
    int radius;                 /* texels, of the ground that it takes from */
    int life;                   /* texels that water runs at most */
    uint32_t seed;
} WrRain;
bool wr_erode_rain(WrSheet *sheet, const WrRain *rain, const WrGenerateJob *job, WrError *err);

/* What a coarse preview works on: no more than this many texels along an axis. */
#define WR_ERODE_COARSE 160

/* The table under a job, ready to be worked on: smaller for a coarse preview. */
bool wr_erode_begin(WrSheet *sheet, const WrGenerateJob *job, WrError *err);
/* The sheet as what comes out; of a smaller one, what has changed is added to the table. Releases it. */
bool wr_erode_end(WrSheet *sheet, const WrGenerateJob *job, bool good, WrNormalMips *out,
                  WrError *err);
