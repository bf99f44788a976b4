/* Shadow test of a torus in closed form. Sign changes show whether a ray hits it, so no root of the quartic has
   to be found. */
#include "render/shadows/shadow_rays.h"

#include <math.h>

/* c[0] + c[1] t + ... c[degree] t^degree */
static double value(const double *c, int degree, double t)
{
    double sum = c[degree];
    for (int k = degree - 1; k >= 0; k--) sum = sum * t + c[k];
    return sum;
}

/* of the interval: near an extreme, the value's error is the square of this */
#define NEAR_ENOUGH 1e-7

/* Root of the cubic c, which is monotonic from a to b. false: there is none. */
static bool root_of(const double c[4], double a, double b, double *root)
{
    const double slopes[3] = { c[1], 2 * c[2], 3 * c[3] };
    const double from = value(c, 3, a), to = value(c, 3, b), near = NEAR_ENOUGH * (b - a);
    if (!(a < b) || (from > 0) == (to > 0)) return false;
    double t = a + (b - a) * (from / (from - to));
    for (int step = 0; step < 60; step++) {
        const double at = value(c, 3, t), slope = value(slopes, 2, t);
        if ((at > 0) == (from > 0)) a = t;
        else b = t;
        double next = slope != 0 ? t - at / slope : a;
        if (!(next > a && next < b)) next = a + (b - a) / 2;
        const bool done = fabs(next - t) <= near;
        t = next;
        if (done) break;
    }
    *root = t;
    return true;
}

/* True if p is on the outer half and the ray leads outwards. Then it never returns, because the squared distance
   from the circle in the tube's middle is convex outside that circle. */
static bool goes_away(double R, double r, WrVec3 p, WrVec3 d)
{
    const double rho = sqrt(p.x * p.x + p.y * p.y), out = p.x * d.x + p.y * d.y;
    const double off = rho - R;
    return off >= 0 && out >= 0 && off * off + p.z * p.z > r * r &&
           off * out + rho * p.z * d.z >= 0;
}

/* With the foot f nearest the middle and p = f + t d, G = (p.p + R^2 - r^2)^2 - 4 R^2 (x^2 + y^2) is 0 on the
   torus; p.p = f.f + t^2 d.d, so it has no t^3. G changes sign on the way exactly if it does so between the ends
   of the way and its extremes, the roots of a cubic. */
bool wr_shadow_rays_meets_torus(const WrShape *shape, WrVec3 o, WrVec3 d, double most)
{
    const double R = shape->value[0], r = shape->value[1], dd = v3_dot(d, d);
    const double start = v3_dot(o, d) / dd;
    const WrVec3 f = v3_mad(o, d, -start);
    const double left = (R + r) * (R + r) - v3_dot(f, f);
    if (!(left >= 0) || goes_away(R, r, o, d)) return false;
    const double half = sqrt(left / dd);
    const double low = fmax(start, -half), high = fmin(start + most, half);
    if (!(low < high)) return false;
    const double k = v3_dot(f, f) + (R - r) * (R + r), four = 4 * R * R;
    const double q = 2 * dd * k - four * (d.x * d.x + d.y * d.y);
    const double G[5] = { k * k - four * (f.x * f.x + f.y * f.y),
                          -2 * four * (f.x * d.x + f.y * d.y), q, 0, dd * dd };
    const double slope[4] = { G[1], 2 * q, 0, 4 * dd * dd };
    const double turn = q < 0 ? sqrt(-q / (6 * dd * dd)) : 0;
    const double ends[4] = { low, fmin(fmax(-turn, low), high), fmin(fmax(turn, low), high), high };
    const bool outside = value(G, 4, low) > 0;
    bool meets = (value(G, 4, high) > 0) != outside;
    for (int i = 0; i < 3 && !meets; i++) {
        double t;
        if (root_of(slope, ends[i], ends[i + 1], &t)) meets = (value(G, 4, t) > 0) != outside;
    }
    return meets;
}
