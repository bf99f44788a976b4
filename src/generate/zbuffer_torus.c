/* Intersection of rays and tori: a quartic, solved between its inflection points. */
#include "generate/zbuffer_shapes.h"

static double horner(const double *c, int degree, double t)
{
    double value = c[degree];
    for (int k = degree - 1; k >= 0; k--) value = value * t + c[k];
    return value;
}

/* The root between low and high, where the signs differ: Newton's method with bisection if a step
 * leaves the interval or gains too little. */
static double root_between(const double *c, const double *slope, int degree, double low,
                           double high)
{
    bool rising = horner(c, degree, high) > 0.0;
    double t = 0.5 * (low + high), last = high - low;
    for (int i = 0; i < 100; i++) {
        double value = horner(c, degree, t);
        if (value == 0.0) return t;
        if ((value > 0.0) == rising) high = t;
        else low = t;
        double step = value / horner(slope, degree - 1, t), next = t - step;
        bool good = next > low && next < high && fabs(step) < 0.5 * last;
        last = good ? fabs(step) : 0.5 * (high - low);
        if (!good) next = 0.5 * (low + high);
        if (!(next > low && next < high)) break;
        if (fabs(next - t) <= 1e-16 * fabs(t)) return next;
        t = next;
    }
    return t;
}

/* The largest root in [low, high], where the curve is convex and positive at its high end. Tangents lie
 * below the curve, so Newton's steps approach the root from above and never pass it; if there is no
 * root, they pass the minimum. */
static bool bowl_top(const double *c, const double *slope, double low, double high, double *t)
{
    double at = high;
    for (int i = 0; i < 100; i++) {
        double value = horner(c, 4, at), rise = horner(slope, 3, at);
        if (!(value > 0.0)) break;
        if (!(rise > 0.0)) return false;
        double next = at - value / rise;
        if (!(next >= low)) return false;
        if (at - next <= 2e-16) break;
        at = next;
    }
    *t = at;
    return true;
}

/* The largest t in [-1, 1] where a quartic that rises at both ends is not positive. */
static bool quartic_top(const double c[5], double *t)
{
    const double slope[4] = { c[1], 2.0 * c[2], 3.0 * c[3], 4.0 * c[4] };
    *t = 1.0;
    if (!(horner(c, 4, 1.0) > 0.0)) return true;
    double rest = 9.0 * c[3] * c[3] - 24.0 * c[4] * c[2];
    if (!(rest > 0.0)) return bowl_top(c, slope, -1.0, 1.0, t);
    double left = (-3.0 * c[3] - sqrt(rest)) / (12.0 * c[4]);
    double right = (-3.0 * c[3] + sqrt(rest)) / (12.0 * c[4]);
    /* between left and right it is concave: it is positive there if it is so at both ends */
    left = left < -1.0 ? -1.0 : left > 1.0 ? 1.0 : left;
    right = right < -1.0 ? -1.0 : right > 1.0 ? 1.0 : right;
    if (right < 1.0 && bowl_top(c, slope, right, 1.0, t)) return true;
    if (!(horner(c, 4, left) > 0.0)) {
        *t = root_between(c, slope, 4, left, right);
        return true;
    }
    return left > -1.0 && bowl_top(c, slope, -1.0, left, t);
}

/* A vertical line on a flat torus. */
static bool flat_top(const double a[3], double down, double tube, double *t)
{
    double d = sqrt(a[0] * a[0] + a[1] * a[1]) - 1.0, rest = tube * tube - d * d;
    if (!(rest >= 0.0)) return false;
    double z = sqrt(rest);
    *t = (down > 0.0 ? z - a[2] : -z - a[2]) / down;
    return true;
}

bool wr_ztorus_top(const double a[3], const double b[3], double tube, double *t)
{
    /* lines in the two planes that touch the torus meet it along a circle, or not, depending on
     * rounding */
    if (b[2] == 0.0 && fabs(a[2]) >= tube * (1.0 - 1e-9)) return false;
    if (b[0] == 0.0 && b[1] == 0.0) return flat_top(a, b[2], tube, t);
    /* slightly larger than needed, so that no root falls on an end */
    WrZSpan s = wr_zspan_meet(wr_zspan_slab(a[2], b[2], 1.001 * tube),
                              wr_zspan_round(a, b, 3, 0.0, 1.001 * (1.0 + tube)));
    if (!(s.low <= s.high)) return false;
    /* (|q|^2 + 1 - r^2)^2 - 4 (qx^2 + qy^2) <= 0, about the middle of the span, in its half lengths */
    double mid = 0.5 * (s.low + s.high), half = 0.5 * (s.high - s.low), p[3], d[3];
    for (int k = 0; k < 3; k++) {
        p[k] = a[k] + b[k] * mid;
        d[k] = b[k] * half;
    }
    double pp = p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + 1.0 - tube * tube;
    double pd = p[0] * d[0] + p[1] * d[1] + p[2] * d[2];
    double dd = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    double c[5] = { pp * pp - 4.0 * (p[0] * p[0] + p[1] * p[1]),
                    4.0 * pp * pd - 8.0 * (p[0] * d[0] + p[1] * d[1]),
                    4.0 * pd * pd + 2.0 * pp * dd - 4.0 * (d[0] * d[0] + d[1] * d[1]),
                    4.0 * pd * dd, dd * dd };
    double top;
    if (!quartic_top(c, &top)) return false;
    *t = mid + half * top;
    return true;
}
