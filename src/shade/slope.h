/* slope.h - scaling of table slopes for the bump formulas: height, replication and the unit of length.

   The reference renderer intentionally has its own. */
#pragma once
#include "shade/bump.h"

#include <float.h>
#include <math.h>

/* The unit of slopes, `unit` of them per scene unit: that of the surface's tangents. The
   scale-invariant tilt is the slope itself, in scene units for any size of the object. */
static inline double wr_slope_unit(WrBumpMode mode, double unit)
{
    return mode == WR_BUMP_INVARIANT ? 1.0 : unit;
}

/* Factors of F, Fu, Fv of the table's cell. */
typedef struct WrSlopeScale {
    double f, u, v;
} WrSlopeScale;

static inline WrSlopeScale wr_slope_scale(WrBumpMode mode, double height, double ru, double rv,
                                          double unit)
{
    const double slope = height * wr_slope_unit(mode, unit);
    return (WrSlopeScale){ height * unit, slope * ru, slope * rv };
}

/* A product of finite numbers, clamped to finite values. */
static inline double wr_slope_bounded(double x)
{
    return fmax(-DBL_MAX, fmin(x, DBL_MAX));
}

/* One slope with respect to the patch parameter, finite for all inputs. */
static inline double wr_slope_of(double slope, double height, double replicate)
{
    return wr_slope_bounded(wr_slope_bounded(height * slope) * replicate);
}
