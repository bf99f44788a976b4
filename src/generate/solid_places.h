/* solid_places.h - places of the copies of a solid: a lattice, a path, or by chance; and how copies that
   overlap are joined.
   Private to this module. */
#pragma once
#include "generate/zbuffer.h"

#define WR_SOLID_MAX 1024 /* maximum of a lattice along an axis */

/* One copy: at x, y (wr_z_place) and z; rotated and scaled about its origin. */
typedef struct WrSolidPlace {
    double at[3], turn[9], scale;
} WrSolidPlace;

/* Positions of all copies, from the parameters of solids. *places is owned by the caller (wr_free),
 * [*count], at least 1. */
bool wr_solid_places(const WrParams *params, const WrGenerateJob *job, WrSolidPlace **places,
                     int64_t *count, WrError *err);

/* Points at random of which no two are nearer than `distance`, on a table whose axes wrap or end:
 * Poisson-disc sampling (Bridson 2007). The same on every processor. xy: owned by the caller, [*count][2]
 * texels from the table's corner, 0..width and 0..height. */
bool wr_chance_points(double width, double height, bool wraps_u, bool wraps_v, double distance,
                      uint32_t seed, double (**xy)[2], int64_t *count, WrError *err);

/* Draws the scene of `copies` with the same number of solids or triangles each; the heights of copies
 * that overlap are joined by h = melt ln(1 + sum of (exp(h_i / melt) - 1)), texels: the greatest for a
 * small melt, the sum for a large one, and a copy alone keeps its heights. melt 0: the sum.
 * Errors   too many lie over one another; those of wr_zbuffer_draw */
bool wr_solid_join(const WrZScene *scene, int64_t copies, double melt, const WrGenerateJob *job,
                   WrRelief *out, WrError *err);
