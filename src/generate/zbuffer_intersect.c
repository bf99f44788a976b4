#include "generate/zbuffer_intersect.h"

#include "base/array.h"
#include "base/error.h"
#include "base/exactmath.h"
#include "generate/zbuffer.h"
#include "generate/zbuffer_tile.h"

#include <stdint.h>

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

/* The largest t in [-1, 1] where a quartic that rises at both ends is not positive. The second derivative 12 c4 t^2 + 6 c3 t
   + 2 c2 has real roots if 9 c3^2 > 24 c4 c2: these are the inflection points left and right. Beyond them the curve is
   convex, where Newton's method is safe. */
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

static WrZSpan zspan_slab(double a, double b, double r);

/* The largest t inside the torus of a ring of radius 1 in the plane of the first two coordinates and a
 * tube of radius `tube`; false if the line misses it. b is not 0. */
static bool ztorus_top(const double a[3], const double b[3], double tube, double *t)
{
    /* lines in the two planes that touch the torus meet it along a circle, or not, depending on
     * rounding */
    if (b[2] == 0.0 && fabs(a[2]) >= tube * (1.0 - 1e-9)) return false;
    if (b[0] == 0.0 && b[1] == 0.0) return flat_top(a, b[2], tube, t);
    /* slightly larger than needed, so that no root falls on an end */
    WrZSpan s = wr_zspan_meet(zspan_slab(a[2], b[2], 1.001 * tube),
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

/* The interval with |a + b t| <= r on one axis. */
static WrZSpan zspan_slab(double a, double b, double r)
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
    WrZSpan s = zspan_slab(a[2], b[2], 1.0);
    if (!(s.low <= s.high)) return nothing;
    /* |xy|^2 <= ((1 - z)/2)^2 */
    double c0 = 0.5 * (1.0 - a[2]), c1 = -0.5 * b[2];
    double qa = b[0] * b[0] + b[1] * b[1] - c1 * c1, qb = a[0] * b[0] + a[1] * b[1] - c0 * c1;
    double qc = a[0] * a[0] + a[1] * a[1] - c0 * c0;
    if (qa > 0.0) return wr_zspan_meet(s, inside(qa, qb, qc));
    /* The line is parallel to the cone's side: the quadratic is linear. */
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
    WrZSpan middle = wr_zspan_meet(zspan_round(a, b, 2, 0.0, 1.0), zspan_slab(a[2], b[2], half));
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

/* d0..d5 are of set_dome. Near the outline the root's argument is a small difference; it decides the hit, so all callers
   share this code. */
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
        s = wr_zspan_meet(zspan_slab(a[0], b[0], 1.0),
                          wr_zspan_meet(zspan_slab(a[1], b[1], 1.0), zspan_slab(a[2], b[2], 1.0)));
        break;
    case WR_Z_CYLINDER:
        s = wr_zspan_meet(zspan_round(a, b, 2, 0.0, 1.0), zspan_slab(a[2], b[2], 1.0));
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
   * q; det S = |p x q|^2 and similar forms keep thin ones exact. r is the third row. With the outline's quadratic form
   completed to squares, the upper half is
     z = d0 x + d1 y + d2 sqrt(1 - d3 x^2 - d4 (y - d5 x)^2),
   a plane through the outline plus a half ellipsoid over it. */
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

/* ---- extrusions ---- */

/* Extruded outlines: distances by a grid of edge lists, ray intersections by steps limited by the
   distance. */

#define EDGES_MAX 4194304
#define CELLS 256 /* maximum cells of the grid along its longer side */
#define BANDS                                                                                      \
    16 /* strips in the height of a cell: outlines consist of many short edges, of which a
          horizontal line meets few */

typedef struct Edge {
    double p, q, dp, dq; /* from (p, q) by (dp, dq) */
    double inverse;      /* 1 / length^2 */
} Edge;

typedef struct List {
    int first, count;
} List;

struct WrZLetters {
    double depth, bevel;
    WrZBevel kind;
    Edge *edges;
    int count;
    double low[2], high[2]; /* bounding box of the outlines */
    double origin[2], cell; /* of the grid */
    int across, up;         /* its cells */
    double near;            /* distances below that are exact */
    List *cells;            /* [up][across] edges within `near` of the cell */
    List *bands;            /* [up BANDS] edges that a strip across meets */
    int *items;             /* of all lists */
    signed char *inside;    /* [up][across] of cells without edges near: 1 or -1 */
};

/* ---- building ---- */

static bool add_edges(WrZLetters *l, const WrZContour *c, WrError *err)
{
    for (int i = 0; i < c->count; i++) {
        const double *from = &c->points[2 * i], *to = &c->points[2 * ((i + 1) % c->count)];
        if (!(fabs(from[0]) <= 1e6 && fabs(from[1]) <= 1e6))
            return wr_fail(err, "outline point %d: %g,%g: must be finite, within 1e6", i + 1,
                           from[0], from[1]);
        Edge e = { .p = from[0], .q = from[1], .dp = to[0] - from[0], .dq = to[1] - from[1] };
        double square = e.dp * e.dp + e.dq * e.dq;
        if (!(square > 1e-24)) continue;
        e.inverse = 1.0 / square;
        for (int k = 0; k < 2; k++) {
            l->low[k] = l->count == 0 || from[k] < l->low[k] ? from[k] : l->low[k];
            l->high[k] = l->count == 0 || from[k] > l->high[k] ? from[k] : l->high[k];
        }
        l->edges[l->count++] = e;
    }
    return true;
}

/* Cells are at least half a bevel wide: a cell's list then holds all edges within the bevel, and distances up to `near` are
   exact. Farther points only need to be known as farther. */
static void lay_grid(WrZLetters *l)
{
    double wide = l->high[0] - l->low[0], high = l->high[1] - l->low[1];
    double side = wide > high ? wide : high;
    l->cell = side / CELLS > 0.5 * l->bevel ? side / CELLS : 0.5 * l->bevel;
    l->near = l->bevel > l->cell ? l->bevel : l->cell;
    for (int k = 0; k < 2; k++) l->origin[k] = l->low[k] - l->near;
    l->across = (int)((wide + 2.0 * l->near) / l->cell) + 1;
    l->up = (int)((high + 2.0 * l->near) / l->cell) + 1;
}

static double edge_square(const Edge *e, double p, double q)
{
    double x = p - e->p, y = q - e->q, s = (x * e->dp + y * e->dq) * e->inverse;
    s = s < 0.0 ? 0.0 : s > 1.0 ? 1.0 : s;
    x -= s * e->dp;
    y -= s * e->dq;
    return x * x + y * y;
}

static int cell_of(const WrZLetters *l, double x, int axis)
{
    double i = floor((x - l->origin[axis]) / l->cell);
    int last = (axis == 0 ? l->across : l->up) - 1;
    return i < 0.0 ? 0 : i > last ? last : (int)i;
}

static int band_of(const WrZLetters *l, double q)
{
    double j = floor((q - l->origin[1]) / l->cell * BANDS);
    int last = l->up * BANDS - 1;
    return j < 0.0 ? 0 : j > last ? last : (int)j;
}

static void put(const WrZLetters *l, List *list, int edge)
{
    if (l->items) l->items[list->first + list->count] = edge;
    list->count++;
}

/* Counts the items of the lists, or fills them. */
static void put_edge(WrZLetters *l, int edge)
{
    const Edge *e = &l->edges[edge];
    double p0 = e->dp < 0.0 ? e->p + e->dp : e->p, p1 = e->dp < 0.0 ? e->p : e->p + e->dp;
    double q0 = e->dq < 0.0 ? e->q + e->dq : e->q, q1 = e->dq < 0.0 ? e->q : e->q + e->dq;
    double reach = (l->near + 0.7072 * l->cell) * 1.000001;
    int j0 = cell_of(l, q0 - l->near, 1), j1 = cell_of(l, q1 + l->near, 1);
    int i0 = cell_of(l, p0 - l->near, 0), i1 = cell_of(l, p1 + l->near, 0);
    for (int j = j0; j <= j1; j++)
        for (int i = i0; i <= i1; i++) {
            double p = l->origin[0] + (i + 0.5) * l->cell, q = l->origin[1] + (j + 0.5) * l->cell;
            if (edge_square(e, p, q) <= reach * reach) put(l, &l->cells[j * l->across + i], edge);
        }
    for (int j = band_of(l, q0 - 1e-9); j <= band_of(l, q1 + 1e-9); j++) put(l, &l->bands[j], edge);
}

static int place_lists(List *lists, int count, int first)
{
    for (int i = 0; i < count; i++) {
        lists[i].first = first;
        first += lists[i].count;
        lists[i].count = 0;
    }
    return first;
}

/* The nonzero rule, by the crossings of a line to the right. */
static bool is_inside(const WrZLetters *l, double p, double q)
{
    const List *band = &l->bands[band_of(l, q)];
    int winding = 0;
    for (int k = 0; k < band->count; k++) {
        const Edge *e = &l->edges[l->items[band->first + k]];
        bool below = e->q <= q, end_below = e->q + e->dq <= q;
        if (below == end_below) continue;
        double side = e->dp * (q - e->q) - (p - e->p) * e->dq; /* > 0: to the right, going up */
        if (below && side > 0.0) winding++;
        if (!below && side < 0.0) winding--;
    }
    return winding != 0;
}

static bool fill_grid(WrZLetters *l, WrError *err)
{
    size_t cells = (size_t)l->across * (size_t)l->up;
    l->cells = wr_alloc(cells, sizeof *l->cells);
    const int bands = l->up * BANDS;
    l->bands = wr_alloc((size_t)bands, sizeof *l->bands);
    l->inside = wr_alloc(cells, 1);
    for (int i = 0; i < l->count; i++) put_edge(l, i);
    double total = 0.0;
    for (size_t i = 0; i < cells; i++) total += l->cells[i].count;
    for (int j = 0; j < bands; j++) total += l->bands[j].count;
    if (total > 2e8) return wr_fail(err, "outlines of %d edges: must be fewer", l->count);
    int end = place_lists(l->bands, bands, place_lists(l->cells, (int)cells, 0));
    l->items = wr_try_alloc((size_t)end + 1, sizeof *l->items, "outlines", err);
    if (!l->items) return false;
    for (int i = 0; i < l->count; i++) put_edge(l, i);
    for (int j = 0; j < l->up; j++)
        for (int i = 0; i < l->across; i++) {
            double p = l->origin[0] + (i + 0.5) * l->cell, q = l->origin[1] + (j + 0.5) * l->cell;
            if (l->cells[j * l->across + i].count == 0)
                l->inside[j * l->across + i] = is_inside(l, p, q) ? 1 : -1;
        }
    return true;
}

WrZLetters *wr_zletters_new(const WrZContour *contours, int count, double depth, double bevel,
                            WrZBevel kind, WrError *err)
{
    int64_t edges = 0;
    for (int i = 0; i < count; i++) edges += contours[i].count;
    if (!(depth > 0.0 && depth <= 1e6) || !(bevel >= 0.0 && bevel <= depth)) {
        wr_fail(err, "depth %g with bevel %g: depth must be above 0, bevel 0..depth", depth, bevel);
        return NULL;
    }
    if (edges > EDGES_MAX) {
        wr_fail(err, "outlines of %lld points: must be at most %d", (long long)edges, EDGES_MAX);
        return NULL;
    }
    WrZLetters *l = wr_alloc(1, sizeof *l);
    *l = (WrZLetters){ .depth = depth, .bevel = bevel, .kind = kind };
    l->edges = wr_alloc((size_t)edges + 1, sizeof *l->edges);
    bool good = true;
    for (int i = 0; i < count && good; i++) good = add_edges(l, &contours[i], err);
    if (good && !(l->high[0] > l->low[0] && l->high[1] > l->low[1]))
        good = wr_fail(err, "the outlines hold no area");
    if (good) {
        lay_grid(l);
        good = fill_grid(l, err);
    }
    if (good) return l;
    wr_zletters_free(l);
    return NULL;
}

void wr_zletters_free(WrZLetters *letters)
{
    if (!letters) return;
    wr_free(letters->edges);
    wr_free(letters->cells);
    wr_free(letters->bands);
    wr_free(letters->items);
    wr_free(letters->inside);
    wr_free(letters);
}

void wr_zletters_box(const WrZLetters *letters, double low[3], double high[3])
{
    for (int k = 0; k < 2; k++) {
        low[k] = letters->low[k];
        high[k] = letters->high[k];
    }
    low[2] = 0.0;
    high[2] = letters->depth;
}

/* ---- distances ---- */

static double beyond(double x, double low, double high)
{
    return x < low ? low - x : x > high ? x - high : 0.0;
}

double wr_zletters_distance(const WrZLetters *l, double p, double q)
{
    double x = beyond(p, l->low[0], l->high[0]), y = beyond(q, l->low[1], l->high[1]);
    if (x * x + y * y >= l->near * l->near) return -sqrt(x * x + y * y);
    int at = cell_of(l, q, 1) * l->across + cell_of(l, p, 0);
    const List *list = &l->cells[at];
    if (list->count == 0) return l->inside[at] * l->near;
    double least = l->near * l->near;
    for (int k = 0; k < list->count; k++) {
        double square = edge_square(&l->edges[l->items[list->first + k]], p, q);
        if (square < least) least = square;
    }
    return is_inside(l, p, q) ? sqrt(least) : -sqrt(least);
}

/* A bound of the distance to the body, negative inside. A signed distance bound to the body: intersection of the slab
   0..depth with the extruded outline is their maximum; at the bevel the quarter circle sqrt(s^2 + e^2) - bevel or the chamfer
   (s + e - bevel) / sqrt 2. It never exceeds the true distance, so a step of its length cannot pass the surface (sphere
   tracing, Hart 1996). */
static double gap(const WrZLetters *l, double p, double q, double w)
{
    double top = w - l->depth, under = -w;
    double most = top > under ? top : under;
    double d = wr_zletters_distance(l, p, q), s = top + l->bevel, e = l->bevel - d;
    if (-d > most) most = -d;
    if (!(s > 0.0 && e > 0.0)) return most;
    double bevel = l->kind == WR_Z_BEVEL_ROUND ? sqrt(s * s + e * e) - l->bevel
                                               : (s + e - l->bevel) * 0.70710678118654752;
    return bevel > most ? bevel : most;
}

static double gap_at(const WrZLetters *l, const double a[3], const double b[3], double t)
{
    return gap(l, a[0] + b[0] * t, a[1] + b[1] * t, a[2] + b[2] * t);
}

/* ---- lines ---- */

/* The part of the line within `reach` of the box; empty if none. */
static WrZSpan box_span(const WrZLetters *l, const double a[3], const double b[3], double reach)
{
    WrZSpan span = { -INFINITY, INFINITY };
    for (int k = 0; k < 3; k++) {
        double low = k < 2 ? l->low[k] : 0.0, high = k < 2 ? l->high[k] : l->depth;
        double mid = 0.5 * (low + high);
        span = wr_zspan_meet(span, zspan_slab(a[k] - mid, b[k], 0.5 * (high - low) + reach));
    }
    return span;
}

/* A vertical line on a flat body. */
static bool flat_meet(const WrZLetters *l, const double a[3], double down, double *t)
{
    double d = wr_zletters_distance(l, a[0], a[1]), top = l->depth;
    if (d < 0.0) return false;
    if (d < l->bevel) {
        double e = l->bevel - d;
        top -= l->kind == WR_Z_BEVEL_CHAMFER ? e : l->bevel - sqrt(l->bevel * l->bevel - e * e);
    }
    *t = down > 0.0 ? (top - a[2]) / down : -a[2] / down;
    return true;
}

/* The crossing between `out` and `in`, whose gaps differ in sign: false position (Illinois variant). */
static double crossing(const WrZLetters *l, const double a[3], const double b[3], double out,
                       double gap_out, double in, double gap_in)
{
    for (int i = 0; i < 60 && fabs(out - in) > 1e-12 * (1.0 + fabs(in)); i++) {
        double t = out + (in - out) * (gap_out / (gap_out - gap_in));
        if (!((t < out && t > in))) t = 0.5 * (out + in);
        double g = gap_at(l, a, b, t);
        if (g > 0.0) {
            out = t;
            gap_out = g;
            gap_in *= 0.5;
        } else {
            in = t;
            gap_in = g;
            gap_out *= 0.5;
            if (g == 0.0) return t;
        }
    }
    return in;
}

bool wr_zletters_meet(const WrZLetters *l, const double a[3], const double b[3], double *t)
{
    if (b[0] == 0.0 && b[1] == 0.0) return flat_meet(l, a, b[2], t);
    double speed = sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
    WrZSpan span = box_span(l, a, b, 0.0);
    if (!(span.low <= span.high)) return false;
    double at = span.high, before = 0.0, g_before = 0.0;
    for (int i = 0; i < 500 && at >= span.low; i++) {
        double g = gap_at(l, a, b, at);
        if (g <= 1e-9) {
            *t = at;
            return true;
        }
        if (g < 0.05 && i > 0 && g_before > g) { /* close by: try a point inside */
            double guess = at - 1.5 * g * (before - at) / (g_before - g);
            double g_guess = guess > span.low ? gap_at(l, a, b, guess) : 1.0;
            if (g_guess <= 0.0 && at - guess < 8.0 * g / speed) {
                *t = crossing(l, a, b, at, g, guess, g_guess);
                return true;
            }
        }
        before = at;
        g_before = g;
        at -= (g > 1e-6 ? g : 1e-6) / speed;
    }
    return false;
}

bool wr_zletters_clear(const WrZLetters *l, const double a[3], const double b[3], double reach)
{
    if (b[0] == 0.0 && b[1] == 0.0) return wr_zletters_distance(l, a[0], a[1]) < -reach;
    double speed = sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
    WrZSpan span = box_span(l, a, b, reach);
    if (!(span.low <= span.high)) return true;
    double at = span.high;
    for (int i = 0; i < 64; i++) {
        double g = gap_at(l, a, b, at) - reach;
        if (g <= 0.0) return false;
        at -= (g > 1e-3 ? g : 1e-3) / speed;
        if (at < span.low) return true;
    }
    return false;
}
