/* erode.h - thermal and hydraulic erosion of whole tables, in place.
   Private to this module.
   Both only move material: the sum of heights is preserved, to rounding. A flat table is unchanged,
   bit for bit. On clamped axes no material leaves the table. */
#pragma once
#include "generate/sheet.h"

#include <stdbool.h>
#include <stdint.h>

/* Thermal erosion: material slides down slopes steeper than the angle of rest.
 *
 *   d_k = max(0, z - z_k - talus l_k)   to each of 8 neighbours, l_k = 1 or sqrt 2 texels
 *   a texel loses rate/2 max(d) in total, the fraction d_k / sum(d) of it to neighbour k
 *
 * All texels are updated at once, from the previous heights: on a periodic table, rolled heights give
 * rolled heights, bit for bit, on any number of threads. talus in table units per texel. Errors: out of
 * memory, "cancelled". */
typedef struct WrThermal {
    double talus, rate; /* rate 0..1 */
    int rounds;
} WrThermal;
bool wr_erode_thermal(WrSheet *sheet, const WrThermal *how, const WrGenerateJob *job, WrError *err);

/* Hydraulic erosion by drops of rain. Each drop runs downhill, erodes ground up to its capacity,
 * deposits where it slows, and has deposited everything when it dries up. Slopes are measured against
 * the table's whole relief over 1/256 of its width, so that units and resolution have little influence.
 *
 * A drop runs at most 64 texels. Water with a longer life first falls, in smaller numbers, on grids of
 * half the resolution, a quarter and so on; the changes there are interpolated by a cubic and added. On
 * each grid the rain falls in tiles whose drops cannot reach other tiles processed at the same time:
 * the same bits on any number of threads. Positions are those of the table, so a rolled table yields
 * another result. */
typedef struct WrRain {
    double drops;               /* per texel */
    double inertia;             /* 0..1, resistance to changes of direction */
    double capacity;            /* maximum load of a drop */
    double erosion, deposition; /* 0..1, fraction of the possible amount, per texel */
    double evaporation;         /* of its water, per texel */
    int radius;                 /* texels, of the eroded area */
    int life;                   /* maximum distance that water runs, in texels */
    uint32_t seed;
} WrRain;
bool wr_erode_rain(WrSheet *sheet, const WrRain *rain, const WrGenerateJob *job, WrError *err);

/* Maximum texels along an axis of a coarse preview. */
#define WR_ERODE_COARSE 160
