/* horizon.h - horizon slopes of a height table in many directions, for shadows and ambient occlusion.

   Slopes are heights over distances, in table units per texel. */
#pragma once
#include "base/exactmath.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrPool WrPool;

/* The horizon of a periodic polyline through n >= 1 heights one step apart, in the direction of rising
 * indices:
 *
 *   slope[i] = sup over t > 0 of (F(i + t) - F(i)) / t,
 *
 * 0 if no height is greater. Exact at the samples: corners of the upper hull, swept from right to left
 * over two periods, in linear time. hull: scratch, [2 n] */
void wr_horizon_line(const double *heights, int n, double *slope, int *hull);

/* Number of directions of a table, a multiple of 4. */
#define WR_HORIZON_MIN 4
#define WR_HORIZON_MAX 64

/* Direction k of a table: x along rising i, y along rising j, the larger of them 1. The directions
 * divide the perimeter of a square into equal steps, from x to y, so that lines meet texels evenly and
 * a look-up needs no angle. */
static inline void wr_horizon_direction(int k, int directions, double *x, double *y)
{
    const int side = (8 * k + directions) / (2 * directions) % 4;
    const double t = 2 * (4.0 * k / directions - (side == 0 && 2 * k > directions ? 4 : side));
    *x = side == 0 ? 1 : side == 1 ? -t : side == 2 ? -1 : t;
    *y = side == 0 ? t : side == 1 ? 1 : side == 2 ? -t : -1;
}

/* The horizon of a periodic table, at the centres of its texels: one plane per direction, so that a
 * look-up in one direction reads little memory. Each plane repeats its first column and row at the end.
 * Zero-initialise; wr_horizon_drop frees it. */
typedef struct WrHorizon {
    int width, height, directions;
    float *slope; /* [directions][height + 1][width + 1], owned */
    float steepest;
} WrHorizon;

/* Distance from one direction's plane to the next. */
static inline size_t wr_horizon_plane_size(const WrHorizon *h)
{
    return ((size_t)h->width + 1) * ((size_t)h->height + 1);
}

/* Slope at texel (i, j), also one past the last, in direction k. */
static inline float wr_horizon_at(const WrHorizon *h, int i, int j, int k)
{
    return h->slope[(size_t)k * wr_horizon_plane_size(h) + (size_t)j * ((size_t)h->width + 1) +
                    (size_t)i];
}

/* Heights are first multiplied by `sign`, 1 or -1, for a relief displayed inside out. Lines are closed:
 * their directions deviate by up to 1/512 radian, and by 0 if both sides are multiples of 16. Values
 * between lines are interpolated: slopes have an error of second order in the texel size. Errors: out
 * of memory. */
bool wr_horizon_make(WrHorizon *horizon, const WrField *field, int directions, double sign,
                     WrPool *pool, WrError *err);
/* Updates horizons of table `before` to `now`, of equal size and wrap, with the bits of a full
 * computation: only lines that cross a changed texel are swept again. changed: [height][width], set to
 * 1 for texels whose horizon changed in any direction, or where F changed at the texel or beside it,
 * else 0. Errors: out of memory; cancelled: the horizons are dropped. */
bool wr_horizon_update(WrHorizon *horizon, const WrField *before, const WrField *now, double sign,
                       unsigned char *changed, WrPool *pool, WrError *err);
void wr_horizon_drop(WrHorizon *horizon);

/* The visible fraction of a round lamp of angular radius a, whose centre is at an elevation above a
 * straight horizon: 1/2 + (x sqrt(1 - x^2) + asin x) / pi with x = (elevation - horizon) / a. For
 * radius 0: 1 on or above the horizon, else 0. */
static inline double wr_horizon_lamp(double elevation, double horizon, double a)
{
    const double over = elevation - horizon;
    if (!(fabs(over) < a)) return over >= 0 ? 1 : 0;
    const double x = over / a;
    const double y = sqrt(1 - x * x);
    return 0.5 + (x * y + wr_atan2(x, y)) / 3.14159265358979323846;
}

/* The fraction of a uniform sky's light that reaches a point whose unit normal is n, z up:
 *
 *   1/pi sum of dphi (n_z cos^2 h / 2 + n_phi ((pi/2 - h)/2 - sin 2h / 4)),   n_phi = n . (cos phi, sin phi),
 *
 * h is the higher of horizon and surface, for `directions` slopes at equal steps of phi from x to y. 1
 * if nothing rises above the surface's own plane and that is level. */
double wr_horizon_sky(const double *slope, int directions, const double n[3]);

/* Coefficients of ambient occlusion: WrHorizon's directions on a surface where a texel measures
   `across` x `down` in units of height. */
typedef struct WrOcclusionMap {
    int directions;
    double cosine[WR_HORIZON_MAX], sine[WR_HORIZON_MAX]; /* of the direction on the surface */
    double share[WR_HORIZON_MAX]; /* fraction of the full circle covered by the direction */
    double steep[WR_HORIZON_MAX]; /* tangent of the horizon = this times the table's slope */
} WrOcclusionMap;

void wr_occlusion_map_make(WrOcclusionMap *opening, int directions, double across, double down);
/* Ambient occlusion of every texel of the horizon's table, first column and row repeated at the end:
   out[height + 1][width + 1]. changed: as set by wr_horizon_update; only these texels are computed.
   NULL: all. */
void wr_occlusion_map_table(const WrOcclusionMap *opening, const WrHorizon *horizon,
                            const WrField *field, double sign, const unsigned char *changed,
                            WrPool *pool, float *out);
