/* Rays and tori: a quartic, by the roots of its derivatives. */
#include "generate/zbuffer_shapes.h"

static double horner(const double *c, int degree, double t)
{
    double value = c[degree];
    for (int k = degree - 1; k >= 0; k--) value = value * t + c[k];
    return value;
}

/* The root between low and high, where the signs differ: Newton's steps, halving where one leaves the
 * interval or gains too little. */
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

/* Where c0 + c1 t + c2 t^2 changes its sign within (low, high), rising. Returns how many. */
static int quadratic_roots(const double c[3], double low, double high, double roots[2])
{
    double found[2];
    int count = 0, kept = 0;
    double rest = c[1] * c[1] - 4.0 * c[2] * c[0];
    if (c[2] == 0.0) {
        if (c[1] != 0.0) found[count++] = -c[0] / c[1];
    } else if (rest > 0.0) {
        double far = c[1] > 0.0 ? -0.5 * (c[1] + sqrt(rest)) : 0.5 * (sqrt(rest) - c[1]);
        double one = far / c[2], other = c[0] / far;
        found[count++] = one < other ? one : other;
        found[count++] = one < other ? other : one;
    }
    for (int i = 0; i < count; i++)
        if (found[i] > low && found[i] < high) roots[kept++] = found[i];
    return kept;
}

/* The same of a cubic: between the roots of its derivative there is at most one each. */
static int cubic_roots(const double c[4], double low, double high, double roots[3])
{
    const double slope[3] = { c[1], 2.0 * c[2], 3.0 * c[3] };
    double turns[3];
    int turn_count = quadratic_roots(slope, low, high, turns), count = 0;
    double from = low, at_from = horner(c, 3, low);
    for (int i = 0; i <= turn_count; i++) {
        double to = i < turn_count ? turns[i] : high, at_to = horner(c, 3, to);
        if ((at_from > 0.0) != (at_to > 0.0)) roots[count++] = root_between(c, slope, 3, from, to);
        from = to;
        at_from = at_to;
    }
    return count;
}

/* The largest t in [low, high] where a quartic is not above 0. */
static bool quartic_top(const double c[5], double low, double high, double *t)
{
    const double slope[4] = { c[1], 2.0 * c[2], 3.0 * c[3], 4.0 * c[4] };
    double turns[3], to = high;
    *t = high;
    if (!(horner(c, 4, high) > 0.0)) return true;
    for (int i = cubic_roots(slope, low, high, turns); i >= 0; i--) {
        double from = i > 0 ? turns[i - 1] : low;
        if (!(horner(c, 4, from) > 0.0)) {
            *t = root_between(c, slope, 4, from, to);
            return true;
        }
        to = from;
    }
    return false;
}

/* Straight down on a torus that lies flat. */
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
    /* lines in the planes that it lies between touch it along a circle, or not, by chance of rounding */
    if (b[2] == 0.0 && fabs(a[2]) >= tube * (1.0 - 1e-9)) return false;
    if (b[0] == 0.0 && b[1] == 0.0) return flat_top(a, b[2], tube, t);
    /* a little more than it needs, so that no root falls on an end */
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
    if (!quartic_top(c, -1.0, 1.0, &top)) return false;
    *t = mid + half * top;
    return true;
}
