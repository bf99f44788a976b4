#include "field/monotone_curve.h"

#include "base/error.h"

#include <math.h>

/* Monotone cubic interpolation of Fritsch and Carlson (1980). Between points i and i+1, with h = x[i+1] - x[i], s = x - x[i],
   chord d = (y[i+1] - y[i]) / h and end slopes m0, m1, the cubic is
     y[i] + m0 s + (3 d - 2 m0 - m1) s^2 / h + (m0 + m1 - 2 d) s^3 / h^2
   With a = m0 / d and b = m1 / d it is monotone on the interval if a, b >= 0 and a^2 + b^2 <= 9. */
static double chord(const WrCurve *c, int i)
{
    return (c->y[i + 1] - c->y[i]) / (c->x[i + 1] - c->x[i]);
}

static bool check(const double *points, int count, WrError *err)
{
    if (count < 2 || count > WR_CURVE_POINTS)
        return wr_fail(err, "%d points: must be 2..%d", count, WR_CURVE_POINTS);
    for (int i = 1; i < count; i++) {
        const double *p = points + 2 * i - 2;
        if (!(p[2] > p[0]))
            return wr_fail(err, "point %d at %g follows one at %g: points must rise", i + 1, p[2],
                           p[0]);
        /* Two points an ulp apart with distant heights would make an infinite chord, and NaN in all products with it. */
        if (!isfinite((p[3] - p[1]) / (p[2] - p[0])))
            return wr_fail(err, "points %d and %d are too steep", i, i + 1);
    }
    return true;
}

bool wr_curve_make(const double *points, int count, WrCurve *curve, WrError *err)
{
    if (!check(points, count, err)) return false;
    *curve = (WrCurve){ .count = count };
    for (int i = 0; i < count; i++) {
        curve->x[i] = points[2 * i];
        curve->y[i] = points[2 * i + 1];
    }
    /* Outer slopes are the outer chords, so a curve of two points is the straight line through them, and extrapolation
       continues it. */
    curve->slope[0] = chord(curve, 0);
    curve->slope[count - 1] = chord(curve, count - 2);
    /* Inner slopes start as the mean of both chords; at a local extremum the slope must be 0, or the curve would overshoot
       the point. Halving each chord first avoids an overflow of the sum. */
    for (int i = 1; i < count - 1; i++) {
        const double left = chord(curve, i - 1), right = chord(curve, i);
        const bool turns = !((left > 0.0 && right > 0.0) || (left < 0.0 && right < 0.0));
        curve->slope[i] = turns ? 0.0 : 0.5 * left + 0.5 * right;
    }
    /* One pass suffices: intervals are scaled onto the circle a^2 + b^2 = 9 from left to right. Shrinking the shared slope
       i+1 for the next interval also shrinks b of this one, which therefore stays inside the circle. */
    for (int i = 0; i < count - 1; i++) {
        const double d = chord(curve, i);
        if (d == 0.0) {
            curve->slope[i] = curve->slope[i + 1] = 0.0;
            continue;
        }
        const double a = curve->slope[i] / d, b = curve->slope[i + 1] / d;
        if (!(a * a + b * b > 9.0)) continue;
        const double less = 3.0 / sqrt(a * a + b * b);
        curve->slope[i] = less * a * d;
        curve->slope[i + 1] = less * b * d;
    }
    return true;
}

double wr_curve_at(const WrCurve *c, double x)
{
    const int last = c->count - 1;
    if (!(x > c->x[0])) return c->y[0] + c->slope[0] * (x - c->x[0]);
    if (x >= c->x[last]) return c->y[last] + c->slope[last] * (x - c->x[last]);
    int i = 0;
    while (x >= c->x[i + 1]) i++;
    const double h = c->x[i + 1] - c->x[i], s = x - c->x[i], d = chord(c, i);
    const double m0 = c->slope[i], m1 = c->slope[i + 1];
    /* Horner's form in s about the left point, so that a point's own height is returned exactly. */
    return c->y[i] +
           s * (m0 + s * ((3.0 * d - 2.0 * m0 - m1) / h + s * (m0 + m1 - 2.0 * d) / (h * h)));
}
