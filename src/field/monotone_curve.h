/* monotone_curve.h - monotone cubic interpolation of a few points (Fritsch and Carlson, "Monotone
   piecewise cubic interpolation", SIAM J. Numer. Anal. 17, 1980).

   With h the width of an interval, d its slope, and m0, m1 the slopes at its ends, at s from its left
   end

     y = y0 + s (m0 + s ((3 d - 2 m0 - m1)/h + s (m0 + m1 - 2 d)/h^2)).

   A slope m is the mean of d on both sides, 0 where these differ in sign or one is 0, and d at the two
   ends of the curve. Then, interval by interval from the left, with a = m0/d, b = m1/d: where a^2 + b^2
   > 9, both are multiplied by 3/sqrt(a^2 + b^2). Beyond its ends the curve continues as a straight
   line. */
#pragma once
#include <stdbool.h>

#define WR_CURVE_POINTS 16

typedef struct WrError WrError;

typedef struct WrCurve {
    int count; /* 2..WR_CURVE_POINTS */
    double x[WR_CURVE_POINTS], y[WR_CURVE_POINTS], slope[WR_CURVE_POINTS];
} WrCurve;

/* points: [count] x, y; x rising. False and an error if x does not rise, or if points are so near or
   far apart that a slope is not finite. */
bool wr_curve_make(const double *points, int count, WrCurve *curve, WrError *err);
double wr_curve_at(const WrCurve *curve, double x);
