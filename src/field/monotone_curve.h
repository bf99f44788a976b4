/* monotone_curve.h - a smooth curve through a few points that never turns back between two of them: Fritsch and Carlson's
   monotone cubic ("Monotone piecewise cubic interpolation", SIAM J. Numer. Anal. 17, 1980).

   With h the width of an interval, d its slope, and m0, m1 the slopes at its ends, at s from its left end
     y = y0 + s (m0 + s ((3 d - 2 m0 - m1)/h + s (m0 + m1 - 2 d)/h^2)).
   A slope m is the mean of d on both sides, 0 where these differ in sign or one is 0, and d at the two ends of the curve; then,
   interval by interval from the left, with a = m0/d, b = m1/d, where a^2 + b^2 > 9 both are made 3/sqrt(a^2 + b^2) times
   as large. Beyond its ends the curve goes on straight. */
#pragma once
#include <stdbool.h>

#define WR_CURVE_POINTS 16

typedef struct WrError WrError;

typedef struct WrCurve {
    int count; /* 2..WR_CURVE_POINTS */
    double x[WR_CURVE_POINTS], y[WR_CURVE_POINTS], slope[WR_CURVE_POINTS];
} WrCurve;

/* points: [count] x, y; x rising. False and an error where they do not, or lie so near or far that a slope is not
   finite. */
bool wr_curve_make(const double *points, int count, WrCurve *curve, WrError *err);
double wr_curve_at(const WrCurve *curve, double x);
