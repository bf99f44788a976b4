#include "generate/zbuffer_shapes.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "generate/zbuffer.h"
#include "generate/zbuffer_tile.h"

/* The interval with (a + b t) within r of the origin, by its first `axes` coordinates; the third is
 * first lowered by shift. */
static WrZSpan zspan_round(const double a[3], const double b[3], int axes, double shift, double r);

/* ---- Intersection of rays and tori: a quartic, solved between its inflection points ---- */

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

/* The largest t inside the torus of a ring of radius 1 in the plane of the first two coordinates and a
 * tube of radius `tube`; false if the line misses it. b is not 0. */
static bool ztorus_top(const double a[3], const double b[3], double tube, double *t)
{
    /* lines in the two planes that touch the torus meet it along a circle, or not, depending on
     * rounding */
    if (b[2] == 0.0 && fabs(a[2]) >= tube * (1.0 - 1e-9)) return false;
    if (b[0] == 0.0 && b[1] == 0.0) return flat_top(a, b[2], tube, t);
    /* slightly larger than needed, so that no root falls on an end */
    WrZSpan s = wr_zspan_meet(wr_zspan_slab(a[2], b[2], 1.001 * tube),
                              zspan_round(a, b, 3, 0.0, 1.001 * (1.0 + tube)));
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

/* ---- Intersection of solids with vertical lines: q(z) = a + b z in the unit solid's own space ---- */

static const WrZSpan nothing = { 1.0, -1.0 }, everything = { -INFINITY, INFINITY };

WrZSpan wr_zspan_slab(double a, double b, double r)
{
    if (b == 0.0) return fabs(a) <= r ? everything : nothing;
    double p = (-r - a) / b, q = (r - a) / b;
    return p < q ? (WrZSpan){ p, q } : (WrZSpan){ q, p };
}

/* The interval with A z^2 + 2 B z + C <= 0 with A > 0. */
static WrZSpan inside(double a, double b, double c)
{
    double root = b * b - a * c;
    if (!(root >= 0.0)) return nothing;
    root = sqrt(root);
    /* each root by the form without cancellation */
    double far = b > 0.0 ? -(b + root) : root - b, other = far != 0.0 ? c / far : 0.0;
    double one = far / a;
    return one < other ? (WrZSpan){ one, other } : (WrZSpan){ other, one };
}

static WrZSpan zspan_round(const double a[3], const double b[3], int axes, double shift, double r)
{
    double aa = 0.0, ab = 0.0, bb = 0.0;
    for (int k = 0; k < axes; k++) {
        double p = k == 2 ? a[k] - shift : a[k];
        aa += p * p;
        ab += p * b[k];
        bb += b[k] * b[k];
    }
    if (bb == 0.0) return aa <= r * r ? everything : nothing;
    return inside(bb, ab, aa - r * r);
}

static WrZSpan cone_span(const double a[3], const double b[3])
{
    WrZSpan s = wr_zspan_slab(a[2], b[2], 1.0);
    if (!(s.low <= s.high)) return nothing;
    /* |xy|^2 <= ((1 - z)/2)^2 */
    double c0 = 0.5 * (1.0 - a[2]), c1 = -0.5 * b[2];
    double qa = b[0] * b[0] + b[1] * b[1] - c1 * c1, qb = a[0] * b[0] + a[1] * b[1] - c0 * c1;
    double qc = a[0] * a[0] + a[1] * a[1] - c0 * c0;
    if (qa > 0.0) return wr_zspan_meet(s, inside(qa, qb, qc));
    if (qa == 0.0) {
        if (qb == 0.0) return qc <= 0.0 ? s : nothing;
        double root = -qc / (2.0 * qb);
        return wr_zspan_meet(s,
                             qb > 0.0 ? (WrZSpan){ -INFINITY, root } : (WrZSpan){ root, INFINITY });
    }
    WrZSpan out = inside(-qa, -qb, -qc); /* the outside of the cone is between the roots */
    if (!(out.low <= out.high)) return s;
    WrZSpan upper = wr_zspan_meet(s, (WrZSpan){ out.high, INFINITY });
    return upper.low <= upper.high ? upper : wr_zspan_meet(s, (WrZSpan){ -INFINITY, out.low });
}

static WrZSpan capsule_span(const double a[3], const double b[3], double half)
{
    WrZSpan middle = wr_zspan_meet(zspan_round(a, b, 2, 0.0, 1.0), wr_zspan_slab(a[2], b[2], half));
    WrZSpan ends[2] = { zspan_round(a, b, 3, half, 1.0), zspan_round(a, b, 3, -half, 1.0) };
    for (int i = 0; i < 2; i++)
        if (ends[i].low <= ends[i].high &&
            (!(middle.low <= middle.high) || ends[i].high > middle.high))
            middle = ends[i];
    return middle;
}

/* ---- all shapes ---- */

static void ray(const WrZSolid *solid, double x, double y, double a[3], double b[3])
{
    const double *m = solid->inverse, dx = x - solid->at[0], dy = y - solid->at[1];
    for (int k = 0; k < 3; k++) {
        a[k] = m[3 * k] * dx + m[3 * k + 1] * dy;
        b[k] = m[3 * k + 2];
    }
}

static inline double dome_top(const WrZSolid *solid, double x, double y)
{
    const double *d = solid->dome;
    double dx = x - solid->at[0], dy = y - solid->at[1], across = dy - d[5] * dx;
    double rest = 1.0 - d[3] * (dx * dx) - d[4] * (across * across);
    double z = solid->at[2] + (d[0] * dx + d[1] * dy + d[2] * sqrt(rest > 0.0 ? rest : 0.0));
    return rest >= 0.0 ? z : -INFINITY;
}

/* Bit-identical to ztorus_top for a flat torus. */
static void ring_tops(const WrZSolid *solid, int count, const double *x, const double *y, double *z)
{
    const double *m = solid->inverse, down = m[8], tube = solid->param;
#pragma omp simd
    for (int i = 0; i < count; i++) {
        double dx = x[i] - solid->at[0], dy = y[i] - solid->at[1];
        double p = m[0] * dx + m[1] * dy, q = m[3] * dx + m[4] * dy, r = m[6] * dx + m[7] * dy;
        double d = sqrt(p * p + q * q) - 1.0, rest = tube * tube - d * d;
        double root = sqrt(rest > 0.0 ? rest : 0.0);
        double top = solid->at[2] + ((down > 0.0 ? root : -root) - r) / down;
        z[i] = rest >= 0.0 ? top : -INFINITY;
    }
}

/* Bit-identical to capsule_span for an upright capsule: its upper end, except where rounding at its rim
   determines the hit. */
static void rod_tops(const WrZSolid *solid, int count, const double *x, const double *y, double *z)
{
    const double *m = solid->inverse, up = m[8], bb = up * up, rim = 1e-6 * bb;
    const double shift = up > 0.0 ? solid->param : -solid->param;
    int doubtful = 0;
#pragma omp simd reduction(| : doubtful)
    for (int i = 0; i < count; i++) {
        double dx = x[i] - solid->at[0], dy = y[i] - solid->at[1];
        double p = m[0] * dx + m[1] * dy, q = m[3] * dx + m[4] * dy;
        double r = m[6] * dx + m[7] * dy - shift;
        double b = r * up, c = p * p + q * q + r * r - 1.0, rest = b * b - bb * c;
        double root = sqrt(rest > rim ? rest : rim);
        double far = b > 0.0 ? -(b + root) : root - b, one = far / bb, other = c / far;
        z[i] = rest > rim ? solid->at[2] + (one > other ? one : other) : -INFINITY;
        doubtful |= fabs(rest) <= rim;
    }
    if (!doubtful) return;
    for (int i = 0; i < count; i++)
        if (!(z[i] > -INFINITY) && !wr_zsolid_top(solid, x[i], y[i], &z[i])) z[i] = -INFINITY;
}

void wr_zsolid_tops(const WrZSolid *solid, int count, const double *x, const double *y, double *z)
{
    if (solid->shape == WR_Z_TORUS && solid->round) {
        ring_tops(solid, count, x, y, z);
        return;
    }
    if (solid->shape == WR_Z_CAPSULE && solid->round) {
        rod_tops(solid, count, x, y, z);
        return;
    }
    if (solid->shape == WR_Z_SPHERE) {
#pragma omp simd
        for (int i = 0; i < count; i++) z[i] = dome_top(solid, x[i], y[i]);
        return;
    }
    for (int i = 0; i < count; i++)
        if (!wr_zsolid_top(solid, x[i], y[i], &z[i])) z[i] = -INFINITY;
}

bool wr_zsolid_top(const WrZSolid *solid, double x, double y, double *z)
{
    double a[3], b[3], top;
    WrZSpan s = nothing;
    if (solid->shape == WR_Z_SPHERE) {
        top = dome_top(solid, x, y);
        if (!isfinite(top)) return false;
        *z = top;
        return true;
    }
    ray(solid, x, y, a, b);
    switch (solid->shape) {
    case WR_Z_BOX:
        s = wr_zspan_meet(
            wr_zspan_slab(a[0], b[0], 1.0),
            wr_zspan_meet(wr_zspan_slab(a[1], b[1], 1.0), wr_zspan_slab(a[2], b[2], 1.0)));
        break;
    case WR_Z_CYLINDER:
        s = wr_zspan_meet(zspan_round(a, b, 2, 0.0, 1.0), wr_zspan_slab(a[2], b[2], 1.0));
        break;
    case WR_Z_CONE: s = cone_span(a, b); break;
    case WR_Z_CAPSULE: s = capsule_span(a, b, solid->param); break;
    case WR_Z_TORUS:
        if (ztorus_top(a, b, solid->param, &top)) s = (WrZSpan){ top, top };
        break;
    case WR_Z_LETTERS:
        if (wr_zletters_meet(solid->letters, a, b, &top)) s = (WrZSpan){ top, top };
        break;
    case WR_Z_SPHERE:
    case WR_Z_SHAPES: break;
    }
    if (!(s.low <= s.high) || !isfinite(s.high)) return false;
    *z = solid->at[2] + s.high;
    return true;
}

/* Radius of the bounding sphere about the unit solid's origin. */
static double ball(const WrZSolid *solid)
{
    switch (solid->shape) {
    case WR_Z_SPHERE: return 1.0;
    case WR_Z_BOX: return 1.7320508075688774;
    case WR_Z_CYLINDER:
    case WR_Z_CONE: return 1.4142135623730951;
    default: return 1.0 + solid->param;
    }
}

bool wr_zsolid_far(const WrZSolid *solid, double x, double y, double reach)
{
    double a[3], b[3];
    const double *m = solid->inverse;
    ray(solid, x, y, a, b);
    /* maximum shift of the line in the unit solid's space per step of the position */
    double stretch = 0.0;
    for (int k = 0; k < 3; k++) stretch += m[3 * k] * m[3 * k] + m[3 * k + 1] * m[3 * k + 1];
    if (solid->shape == WR_Z_LETTERS)
        return wr_zletters_clear(solid->letters, a, b, reach * sqrt(stretch));
    double ab = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    double aa = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
    double bb = b[0] * b[0] + b[1] * b[1] + b[2] * b[2];
    double most = ball(solid) + reach * sqrt(stretch);
    return aa - ab * ab / bb > most * most * 1.000001;
}

/* ---- poses ---- */

void wr_z_turn(const double rotate_deg[3], double out[9])
{
    double s[3], c[3];
    for (int k = 0; k < 3; k++) wr_sincos_turns(rotate_deg[k] / 360.0, &s[k], &c[k]);
    out[0] = c[2] * c[1];
    out[1] = c[2] * s[1] * s[0] - s[2] * c[0];
    out[2] = c[2] * s[1] * c[0] + s[2] * s[0];
    out[3] = s[2] * c[1];
    out[4] = s[2] * s[1] * s[0] + c[2] * c[0];
    out[5] = s[2] * s[1] * c[0] - c[2] * s[0];
    out[6] = -s[1];
    out[7] = c[1] * s[0];
    out[8] = c[1] * c[0];
}

/* Half extents of the posed solid about its origin, on axis `row` of the table. */
static double reach_of(const WrZSolid *solid, int row)
{
    const double *m = &solid->pose[3 * row];
    double flat = sqrt(m[0] * m[0] + m[1] * m[1]), all = sqrt(flat * flat + m[2] * m[2]);
    switch (solid->shape) {
    case WR_Z_SPHERE: return all;
    case WR_Z_BOX: return fabs(m[0]) + fabs(m[1]) + fabs(m[2]);
    case WR_Z_CAPSULE: return all + fabs(m[2]) * solid->param;
    case WR_Z_TORUS: return flat + all * solid->param;
    default: return flat + fabs(m[2]);
    }
}

double wr_zsolid_rise(const WrZSolid *solid)
{
    const double *m = &solid->pose[6];
    if (solid->shape != WR_Z_CONE) return reach_of(solid, 2);
    double rim = sqrt(m[0] * m[0] + m[1] * m[1]) - m[2];
    return m[2] > rim ? m[2] : rim;
}

static void set_box(WrZSolid *solid)
{
    double low[2], high[2], from[3], to[3];
    for (int row = 0; row < 2; row++) {
        high[row] = reach_of(solid, row);
        low[row] = -high[row];
    }
    for (int row = 0; row < 2 && solid->shape == WR_Z_LETTERS; row++) {
        wr_zletters_box(solid->letters, from, to);
        low[row] = high[row] = 0.0;
        for (int k = 0; k < 3; k++) {
            double p = solid->pose[3 * row + k] * from[k], q = solid->pose[3 * row + k] * to[k];
            low[row] += p < q ? p : q;
            high[row] += p < q ? q : p;
        }
    }
    /* rounding of the box must not lose a texel */
    solid->left = low[0] - 1e-6 * (1.0 + fabs(low[0]));
    solid->right = high[0] + 1e-6 * (1.0 + fabs(high[0]));
    solid->top = low[1] - 1e-6 * (1.0 + fabs(low[1]));
    solid->bottom = high[1] + 1e-6 * (1.0 + fabs(high[1]));
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* An ellipsoid's projection is (x, y) S^-1 (x, y) <= 1, S = P P^T with P the pose's first two rows p,
 * q; det S = |p x q|^2 and similar forms keep thin ones exact. r is the third row. */
static void set_dome(WrZSolid *solid)
{
    const double *p = solid->pose, *q = p + 3, *r = p + 6;
    double n[3], rq[3], pr[3];
    cross(p, q, n);
    cross(r, q, rq);
    cross(p, r, pr);
    double det = dot(n, n), xx = dot(p, p);
    solid->dome[0] = dot(rq, n) / det;
    solid->dome[1] = dot(pr, n) / det;
    solid->dome[2] = fabs(dot(r, n)) / sqrt(det);
    solid->dome[3] = 1.0 / xx;
    solid->dome[4] = xx / det;
    solid->dome[5] = dot(p, q) / xx;
}

bool wr_zsolid_set(WrZSolid *solid, WrZShape shape, double param, const WrZLetters *letters,
                   const double size[3], const double turn[9], const double at[3], WrError *err)
{
    double sum = 0.0;
    for (int k = 0; k < 9; k++) sum += turn[k];
    for (int k = 0; k < 3; k++)
        if (!(size[k] > 1e-9 && size[k] < 1e9) || !isfinite(at[k]) || !isfinite(sum))
            return wr_fail(err, "size %g,%g,%g: must be above 1e-9 and below 1e9", size[0], size[1],
                           size[2]);
    *solid = (WrZSolid){ .shape = shape, .param = param, .letters = letters };
    for (int k = 0; k < 3; k++) solid->at[k] = k < 2 ? wr_z_place(at[k]) : at[k];
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++) {
            double turned = row == 1 ? -turn[3 * row + column] : turn[3 * row + column];
            solid->pose[3 * row + column] = turned * size[column];
            solid->inverse[3 * column + row] = turned / size[column];
        }
    set_box(solid);
    set_dome(solid);
    wr_zsolid_set_bounds(solid);
    return true;
}
