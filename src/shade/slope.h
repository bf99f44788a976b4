/* slope.h - from what a table holds to what turns the normal: height, replication and the unit of length.
   The reference renderer has its own, on purpose. */
#pragma once
#include "shade/bump.h"

#include <float.h>
#include <math.h>

/* The unit that slopes are measured in, `unit` of them to a scene unit: that of the surface's tangents. The
   scale-invariant tilt is the slope itself, in the scene's units whatever the object's size. */
static inline double wr_slope_unit(WrBumpMode mode, double unit)
{
    return mode == WR_BUMP_INVARIANT ? 1.0 : unit;
}

/* What F, Fu, Fv of the table's cell are multiplied by. */
typedef struct WrSlopeScale {
    double f, u, v;
} WrSlopeScale;

static inline WrSlopeScale wr_slope_scale(WrBumpMode mode, double height, double ru, double rv,
                                          double unit)
{
    const double slope = height * wr_slope_unit(mode, unit);
    return (WrSlopeScale){ height * unit, slope * ru, slope * rv };
}

/* A product of finite numbers, kept finite. */
static inline double wr_slope_bounded(double x)
{
    return fmax(-DBL_MAX, fmin(x, DBL_MAX));
}

/* One slope by the patch parameter, finite whatever the numbers. */
static inline double wr_slope_of(double slope, double height, double replicate)
{
    return wr_slope_bounded(wr_slope_bounded(height * slope) * replicate);
}
