#include "shade/bump.h"

#include <float.h>

#include "base/error.h"
#include "base/exactmath.h"
#include "base/enum_rows.h"

WR_ROWS(wr_bumps);
const WrBumpInfo wr_bumps[WR_BUMP_COUNT] = {
    [WR_ROW(WR_BUMP_NONE)] = { "none", "None" },
    [WR_ROW(WR_BUMP_BLINN)] = { "blinn", "Blinn, N + D" },
    [WR_ROW(WR_BUMP_INVARIANT)] = { "invariant", "Scale-invariant" },
    [WR_ROW(WR_BUMP_EXACT)] = { "exact", "Exact" },
};
WR_ROWS_END(wr_bumps, WR_BUMP_COUNT);

const char *const wr_combine_names[WR_COMBINE_COUNT + 1] = { "slopes", "reoriented", "surface",
                                                             NULL };

/* Vectors and numbers with a separate exponent, value = v 2^e, so that products of any finite inputs
   neither overflow nor underflow. Scaling by powers of two is exact: where the plain formula stays
   within double's range the result has its bits. */
typedef struct Wide {
    WrVec3 v; /* largest component 1 <= |x| < 2, or all 0 */
    int e;
} Wide;

/* Below any possible exponent; used as the exponent of 0. */
enum { FAR = 20000 };

static WrVec3 scaled(WrVec3 a, int e)
{
    return (WrVec3){ scalbn(a.x, e), scalbn(a.y, e), scalbn(a.z, e) };
}

static double largest(WrVec3 a)
{
    return fmax(fabs(a.x), fmax(fabs(a.y), fabs(a.z)));
}

/* 0 also for infinite or NaN vectors: they count as no contribution. */
static Wide wide(WrVec3 a, int e)
{
    double m = largest(a);
    if (!(m > 0 && m <= DBL_MAX)) return (Wide){ { 0, 0, 0 }, 0 };
    int k = ilogb(m);
    return (Wide){ scaled(a, -k), e + k };
}

static bool wide_zero(Wide a)
{
    return largest(a.v) == 0;
}

static Wide wide_scale(Wide a, double s)
{
    if (!(fabs(s) > 0 && fabs(s) <= DBL_MAX)) return (Wide){ { 0, 0, 0 }, 0 };
    int k = ilogb(s);
    return wide(v3_scale(a.v, scalbn(s, -k)), a.e + k);
}

/* scaled() towards the larger exponent: the smaller summand loses bits only where the sum does not have them
   anyway. */
static Wide wide_add(Wide a, Wide b)
{
    if (wide_zero(a)) return b;
    if (wide_zero(b)) return a;
    int e = a.e > b.e ? a.e : b.e;
    return wide(v3_add(scaled(a.v, a.e - e), scaled(b.v, b.e - e)), e);
}

static Wide wide_sub(Wide a, Wide b)
{
    b.v = v3_neg(b.v);
    return wide_add(a, b);
}

static Wide wide_cross(Wide a, Wide b)
{
    return wide(v3_cross(a.v, b.v), a.e + b.e);
}

/* Converts back to doubles; beyond their range divided by a power of two: only the direction matters. */
static WrVec3 wide_value(Wide a)
{
    return scaled(a.v, a.e < DBL_MAX_EXP - 2 ? a.e : DBL_MAX_EXP - 2);
}

static WrVec3 wide_unit(Wide a, WrVec3 fallback)
{
    return v3_unit(a.v, fallback);
}

/* Inputs shared by the formulas at one point. */
typedef struct Point {
    WrVec3 n_unit;
    Wide n, pu, pv;
    double fu, fv;
} Point;

/* D = n x (Fu Pv - Fv Pu)
   Fu (n x Pv) - Fv (n x Pu) with one cross product (B7). */
static Wide d_vector(const Point *p)
{
    Wide across = wide_sub(wide_scale(p->pv, p->fu), wide_scale(p->pu, p->fv));
    return wide_cross(wide(p->n_unit, 0), across);
}

/* The direction of D, also if its length has vanished: where Pu = 0, n x Pu tends to 0 along Pv (and
 * where Pv = 0, n x Pv along -Pu) if the two tangents meet at right angles there, so that D tends to 0
 * along -Fv Pv (-Fu Pu). Zero if it is undetermined. */
static WrVec3 d_direction(const Point *p)
{
    const WrVec3 zero = { 0, 0, 0 };
    Wide d = d_vector(p);
    if (wide_zero(d) && wide_zero(p->pu)) d = wide_scale(p->pv, -p->fv);
    if (wide_zero(d) && wide_zero(p->pv)) d = wide_scale(p->pu, -p->fu);
    return wide_unit(d, zero);
}

/* sqrt(Fu^2 + Fv^2) as m 2^e
   The exponent apart, so that slopes of 1e38 and 1e-30 have squares (HC15, HC16). */
static double steepness(const Point *p, int *e)
{
    WrVec3 slope = { p->fu, p->fv, 0 };
    Wide a = wide(slope, 0);
    *e = a.e;
    return sqrt(v3_dot(a.v, a.v));
}

/* N'' = N + a |N| D/|D|
   B15: tan of the tilt is a, independent of the surface's scale (HC17, HC18). D = 0 leaves N. */
static Wide invariant(const Point *p)
{
    Wide d = d_vector(p);
    if (wide_zero(d) || wide_zero(p->n)) return p->n;
    int e;
    double a = steepness(p, &e);
    const WrVec3 zero = { 0, 0, 0 };
    Wide turned = wide(wide_unit(d, zero), 0);
    turned = wide_scale(turned, a);
    turned = wide_scale(turned, sqrt(v3_dot(p->n.v, p->n.v)));
    turned.e += e + p->n.e;
    return wide_add(p->n, turned);
}

/* Q = P_u + F n_u, the tangent's part in the tangent plane, and the exponent that bounds its terms. */
static Wide offset_tangent(Wide tangent, double f, WrVec3 n_du, int *size)
{
    Wide turn = wide_scale(wide(n_du, 0), f);
    *size = -FAR;
    if (!wide_zero(tangent)) *size = tangent.e;
    if (!wide_zero(turn) && turn.e > *size) *size = turn.e;
    return wide_add(tangent, turn);
}

/* `a`, or 0 if it is only the rounding error of cancelling terms of size 2^size.
   7 of double's 53 bits are allowed for the roundings of the products and sums before. */
static Wide above_rounding(Wide a, int size)
{
    const int bits = 46;
    return a.e < size - bits ? (Wide){ { 0, 0, 0 }, 0 } : a;
}

static int exponent(double s)
{
    return s != 0 && fabs(s) <= DBL_MAX ? ilogb(s) : -FAR;
}

/* N' = (Qu + Fu n) x (Qv + Fv n), expanded, because on steep slopes the rounding error of n x n = 0
 * would otherwise dominate:
 *   N' = Qu x Qv + n x (Fu Qv - Fv Qu),   Qu = Pu + F n_u,  Qv = Pv + F n_v
 * This is Blinn's formula with Q instead of the tangents. Exactly 0 at a focal distance, where det(I -
 * F S) = 0 (HC12). */
static Wide exact(const Point *p, WrVec3 n_u, WrVec3 n_v, double f)
{
    int size_u, size_v;
    Point q = *p;
    q.pu = offset_tangent(p->pu, f, n_u, &size_u);
    q.pv = offset_tangent(p->pv, f, n_v, &size_v);
    bool moved = f != 0 && (largest(n_u) > 0 || largest(n_v) > 0);
    if (moved) q.n = above_rounding(wide_cross(q.pu, q.pv), size_u + size_v);
    int rise_u = exponent(p->fu) + size_v, rise_v = exponent(p->fv) + size_u;
    Wide d = above_rounding(d_vector(&q), rise_u > rise_v ? rise_u : rise_v);
    return wide_add(q.n, d);
}

static Wide perturbed(WrBumpMode mode, const Point *p, WrVec3 n_u, WrVec3 n_v, double f)
{
    switch (mode) {
    case WR_BUMP_EXACT: return exact(p, n_u, n_v, f);
    case WR_BUMP_INVARIANT: return invariant(p);
    case WR_BUMP_BLINN: return wide_add(p->n, d_vector(p));
    case WR_BUMP_NONE:
    case WR_BUMP_COUNT: break;
    }
    return p->n;
}

/* True if N is unchanged: no slope, and in exact mode no offset of a curved surface either.
   Then the result has N's own bits: a flat table renders exactly as no table (HC14, HC17, E6). */
static bool untouched(WrBumpMode mode, WrVec3 n_u, WrVec3 n_v, double f, double fu, double fv)
{
    if (mode == WR_BUMP_NONE) return true;
    if (fu != 0 || fv != 0) return false;
    return mode != WR_BUMP_EXACT || f == 0 || (largest(n_u) == 0 && largest(n_v) == 0);
}

WrVec3 wr_bump_normal(WrBumpMode mode, WrVec3 n, WrVec3 n_unit, WrVec3 pu, WrVec3 pv, WrVec3 n_u,
                      WrVec3 n_v, double f, double fu, double fv)
{
    if (untouched(mode, n_u, n_v, f, fu, fv)) return n;
    const Point p = { n_unit, wide(n, 0), wide(pu, 0), wide(pv, 0), fu, fv };
    return wide_value(perturbed(mode, &p, n_u, n_v, f));
}

/* n + a D/|D|: the limit of the unit N'', independent of |N| and |D| (HC19). */
static WrVec3 invariant_unit(const Point *p)
{
    int e;
    double a = steepness(p, &e);
    Wide tip = wide_scale(wide(d_direction(p), 0), a);
    tip.e += e;
    return wide_unit(wide_add(wide(p->n_unit, 0), tip), p->n_unit);
}

WrVec3 wr_bump_unit_normal(WrBumpMode mode, WrVec3 n, WrVec3 n_unit, WrVec3 pu, WrVec3 pv,
                           WrVec3 n_u, WrVec3 n_v, double f, double fu, double fv)
{
    if (untouched(mode, n_u, n_v, f, fu, fv)) return n_unit;
    const Point p = { n_unit, wide(n, 0), wide(pu, 0), wide(pv, 0), fu, fv };
    if (mode == WR_BUMP_INVARIANT) return invariant_unit(&p);
    return wide_unit(perturbed(mode, &p, n_u, n_v, f), n_unit);
}

WrVec3 wr_bump_unit(WrVec3 n_perturbed, WrVec3 n_unit)
{
    return v3_unit(n_perturbed, n_unit);
}

/* atan2 (HC20): exact 0 for equal normals, no loss near 0 and 180 degrees. */
double wr_bump_tilt_deg(WrVec3 n_unit, WrVec3 n_perturbed_unit)
{
    double sine = v3_len(v3_cross(n_unit, n_perturbed_unit));
    return wr_atan2(sine, v3_dot(n_unit, n_perturbed_unit)) / WR_RAD_PER_DEG;
}

WrVec3 wr_bump_combined(WrCombine combine, WrVec3 n_unit, WrVec3 g, WrVec3 b)
{
    const double w = sqrt(1 + v3_dot(g, g)), along = v3_dot(g, b);
    if (combine == WR_COMBINE_SLOPES) return v3_sub(n_unit, v3_add(g, b));
    const bool turned = combine == WR_COMBINE_REORIENTED;
    const WrVec3 tip = v3_mad(v3_mad(g, b, w), g, -along / (turned ? 1 + w : w));
    return v3_sub(v3_scale(n_unit, 1 - (turned ? along : along / w)), tip);
}
