/* horizon.h - how high the relief stands about each of its points: what shadows and occludes it.
   Slopes are heights over distances, both of the table: of table units over texels here. */
#pragma once
#include "base/exactmath.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrPool WrPool;

/* The horizon of a polyline through n >= 1 heights one step apart that repeats without end, seen along rising indices:
 *   slope[i] = sup over t > 0 of (F(i + t) - F(i)) / t,
 * 0 where nothing is higher. Exact at the samples: corners of the upper hull, swept from right to left over two periods,
 * with as much work as samples. hull: scratch, [2 n] */
void wr_horizon_line(const double *heights, int n, double *slope, int *hull);

/* Of a table's directions, a multiple of 4. */
#define WR_HORIZON_LEAST 4
#define WR_HORIZON_MOST 64

/* Direction k of a table's: x along rising i, y along rising j, the larger of them 1. They go round a square in equal
 * steps, from x to y, so that lines meet texels evenly and no angle is asked for where one is looked up. */
static inline void wr_horizon_direction(int k, int directions, double *x, double *y)
{
    const int side = (8 * k + directions) / (2 * directions) % 4;
    const double t = 2 * (4.0 * k / directions - (side == 0 && 2 * k > directions ? 4 : side));
    *x = side == 0 ? 1 : side == 1 ? -t : side == 2 ? -1 : t;
    *y = side == 0 ? t : side == 1 ? 1 : side == 2 ? -t : -1;
}

/* The horizon of a table that repeats on both axes, at the centres of its texels: a picture a direction, so that who looks
 * one way reads little memory, each with its first column and row again after the last. Zero-initialise; drop frees. */
typedef struct WrHorizon {
    int width, height, directions;
    float *slope; /* [directions][height + 1][width + 1], owned */
    float steepest;
} WrHorizon;

/* From one direction's picture to the next. */
static inline size_t wr_horizon_plane(const WrHorizon *h)
{
    return ((size_t)h->width + 1) * ((size_t)h->height + 1);
}

/* Of texel (i, j), also one past the last, in direction k. */
static inline float wr_horizon_at(const WrHorizon *h, int i, int j, int k)
{
    return h
        ->slope[(size_t)k * wr_horizon_plane(h) + (size_t)j * ((size_t)h->width + 1) + (size_t)i];
}

/* Heights are times `sign`, 1 or -1, first: what looks up where the relief stands inside out.
 * Lines close in themselves: their directions are off by up to 1/512 radian, and of sides of whole
 * sixteenths by nothing. What lies between rows is interpolated: slopes are right to the square of a texel.
 * Errors: no memory. */
bool wr_horizon_make(WrHorizon *horizon, const WrField *field, int directions, double sign,
                     WrPool *pool, WrError *err);
/* Bring horizons of table `before` up to date with `now`, of equal size and wrap, to the bits that making them anew would
 * give: only lines that pass a texel which changed are swept again. changed: [height][width], 1 afterwards where a texel's own
 * horizon is another in any direction, or F at it or beside it, else 0.
 * Errors: no memory; cancelled: the horizons are dropped. */
bool wr_horizon_update(WrHorizon *horizon, const WrField *before, const WrField *now, double sign,
                       unsigned char *changed, WrPool *pool, WrError *err);
void wr_horizon_drop(WrHorizon *horizon);

/* The share that is seen of a round lamp of angular radius a, whose middle stands at an elevation over a straight horizon:
 * 1/2 + (x sqrt(1 - x^2) + asin x) / pi with x = (elevation - horizon) / a. Of radius 0: 1 above it or on it, else 0. */
static inline double wr_horizon_lamp(double elevation, double horizon, double a)
{
    const double over = elevation - horizon;
    if (!(fabs(over) < a)) return over >= 0 ? 1 : 0;
    const double x = over / a;
    const double y = sqrt(1 - x * x);
    return 0.5 + (x * y + wr_atan2(x, y)) / 3.14159265358979323846;
}

/* The share of the light of a whole sky that reaches a point whose unit normal is n, z up:
 *   1/pi sum of dphi (n_z cos^2 h / 2 + n_phi ((pi/2 - h)/2 - sin 2h / 4)),   n_phi = n . (cos phi, sin phi),
 * h the higher of horizon and surface, of `directions` slopes at equal steps of phi from x to y. 1 where nothing stands
 * above the surface's own plane, and that is level. */
double wr_horizon_sky(const double *slope, int directions, const double n[3]);

/* What a table's relief leaves open of the sky at each texel: WrHorizon's directions on a surface where a texel is `across`
   and `down` long, in units of height. */
typedef struct WrOcclusionMap {
    int directions;
    double cosine[WR_HORIZON_MOST], sine[WR_HORIZON_MOST]; /* of the direction on the surface */
    double share[WR_HORIZON_MOST]; /* of the whole circle, that it stands for */
    double steep[WR_HORIZON_MOST]; /* times the table's slope: the horizon's tangent */
} WrOcclusionMap;

void wr_occlusion_map_make(WrOcclusionMap *opening, int directions, double across, double down);
/* As wr_horizon_sky, of one texel's slopes: n by the slopes of F along i and j, heights over texels. */
double wr_occlusion_map_sky(const WrOcclusionMap *opening, const float *slope, double along_i,
                            double along_j);
/* The same of each texel of the table that the horizon is of, its first column and row again after the last:
   out[height + 1][width + 1]. changed: as wr_horizon_update has it, of texels whose numbers are not there yet; NULL: all. */
void wr_occlusion_map_table(const WrOcclusionMap *opening, const WrHorizon *horizon,
                            const WrField *field, double sign, const unsigned char *changed,
                            WrPool *pool, float *out);
