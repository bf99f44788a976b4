#include "render/visibility/sphere_rows.h"

#include "base/kernmath.h"

#include <math.h>

/* with l.v closer to -1, |l + v| is not accurate to 1e-6 in single precision */
#define OPPOSITE -0.9

static WrForm plus(WrForm a, WrForm b, double by)
{
    for (int i = 0; i < 6; i++) a.c[i] += by * b.c[i];
    return a;
}

/* Product of two linear forms. */
static WrForm times(WrForm a, WrForm b)
{
    const double *p = a.c, *q = b.c;
    return (WrForm){ { p[0] * q[0], p[0] * q[1] + p[1] * q[0], p[0] * q[2] + p[2] * q[0],
                       p[1] * q[1], p[1] * q[2] + p[2] * q[1], p[2] * q[2] } };
}

/* Dot product of linear forms. */
static WrForm dot(const WrForm a[3], const WrForm b[3])
{
    const WrForm none = { { 0 } };
    WrForm sum = none;
    for (int i = 0; i < 3; i++) sum = plus(sum, times(a[i], b[i]), 1);
    return sum;
}

static double product(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Rays in units of the radius: o and d, linear in the position. False if part of the sphere is in front of the
   near plane. */
static bool set_rays(const WrRays *rays, const WrShapef *shape, WrForm o[3], WrForm d[3])
{
    const double by = 1 / (double)shape->value[0], least = (double)rays->s_min;
    double q[3][3], e[3][3]; /* coefficients of 1, x, y */
    for (int i = 0; i < 3; i++) {
        q[0][i] = by * (double)rays->q0[i], e[0][i] = by * (double)rays->d0[i];
        q[1][i] = by * (double)rays->qx[i], e[1][i] = by * (double)rays->dx[i];
        q[2][i] = by * (double)rays->qy[i], e[2][i] = by * (double)rays->dy[i];
    }
    /* With parallel rays s is constant in the picture plane.
       s of P is (P - q).a / d.a with a across the picture plane; its minimum over the unit sphere is at P =
       -+a / |a|. */
    const double across[3] = { q[1][1] * q[2][2] - q[1][2] * q[2][1],
                               q[1][2] * q[2][0] - q[1][0] * q[2][2],
                               q[1][0] * q[2][1] - q[1][1] * q[2][0] };
    const double size = sqrt(product(across, across)), along = product(e[0], across);
    const double nearest = -(product(q[0], across) / along + fabs(size / along));
    if (!(nearest > least + 1e-5 * (1 + fabs(least)))) return false;
    /* With perspective all rays pass through the eye: q - k d.
       q_x = k d_x for all x: o = q - k d is the eye, the same for every pixel. */
    const double k = rays->perspective ? product(q[1], e[1]) / product(e[1], e[1]) : 0;
    for (int i = 0; i < 3; i++) {
        o[i] = (WrForm){ { q[0][i] - k * e[0][i], q[1][i], q[2][i] } };
        d[i] = (WrForm){ { e[0][i], e[1][i], e[2][i] } };
        for (int n = 1; n < 3; n++) (rays->perspective ? o : d)[i].c[n] = 0;
    }
    return true;
}

/* along = o.w d.d - (o.d) d.w. With perspective o.w is a constant, else d.d is: each product stays a
   quadratic. */
static WrSlant slant_of(const WrForm o[3], const WrForm d[3], const WrForm *dd, const WrForm *od,
                        const double w[3], bool near)
{
    const WrForm none = { { 0 } };
    WrForm at = none, across = none, along;
    for (int i = 0; i < 3; i++) at = plus(at, o[i], w[i]), across = plus(across, d[i], w[i]);
    along = near ? plus(none, *dd, at.c[0]) : plus(none, at, dd->c[0]);
    return (WrSlant){ plus(along, times(*od, across), -1), across };
}

/* Smallest l.v of all visible points: v deviates from the direction to the centre at most as far as the outline.
   cos(a + b) with a the angle from the centre's direction to l, and sin b = 1 / |o|; -1 where a + b exceeds half a turn,
   for then a point between has l.v = -1. */
static double least_facing(const WrForm o[3], const WrForm d[3], const double l[3], bool near)
{
    double a[3];
    for (int i = 0; i < 3; i++) a[i] = near ? o[i].c[0] : -d[i].c[0];
    const double size = product(a, a), facing = product(a, l) / sqrt(size);
    const double sine = near ? 1 / sqrt(size) : 0, cosine = sqrt(1 - sine * sine);
    if (facing <= -cosine) return -1;
    return facing * cosine - sqrt(fmax(1 - facing * facing, 0)) * sine;
}

/* r^2 is negative definite in x (c[3] < 0) where rows meet the sphere in one chord. Up to 1000 radii of
   distance, coefficients keep enough bits in float. */
void wr_sphere_rows_make(WrSphereRows *ball, const WrRays *rays, const WrShapef *shape,
                         const WrKernLight *light)
{
    const WrForm none = { { 0 } };
    WrForm o[3], d[3];
    *ball = (WrSphereRows){ .good = false };
    if (!set_rays(rays, shape, o, d)) return;
    const WrForm od = dot(o, d);
    WrForm oo = dot(o, o);
    oo.c[0] -= 1;
    ball->dd = dot(d, d);
    ball->rr =
        plus(times(od, od),
             rays->perspective ? plus(none, ball->dd, oo.c[0]) : plus(none, oo, ball->dd.c[0]), -1);
    for (int i = 0; i < 3; i++) {
        const double axis[3] = { i == 0, i == 1, i == 2 };
        ball->n[i] = slant_of(o, d, &ball->dd, &od, axis, rays->perspective);
    }
    ball->by = -0.5 / ball->rr.c[3];
    ball->good = ball->rr.c[3] < 0 && (!rays->perspective || (oo.c[0] > 0 && oo.c[0] < 1e6));
    if (light && !light->point && ball->good) {
        const double l[3] = { (double)light->where[0], (double)light->where[1],
                              (double)light->where[2] };
        ball->lit = slant_of(o, d, &ball->dd, &od, l, rays->perspective);
        ball->shown = least_facing(o, d, l, rays->perspective) > OPPOSITE;
    }
}

/* Rounds up to a whole number, 0 .. most. */
static int whole_above(double x, int most)
{
    if (!(x > 0)) return 0;
    if (x > most) return most;
    const int below = (int)x;
    return below + ((double)below < x);
}

/* Roots of r^2 = r0 + r1 x + c3 x^2 in double: at = -r1 / (2 c3), half = sqrt(disc) / (2 |c3|). `middle` is a
   whole number, so that x - middle is exact. */
bool wr_chord_of(const WrSphereRows *ball, double gx, double y, int count, WrChord *chord)
{
    const double *r = ball->rr.c, r0 = r[0] + y * (r[2] + y * r[5]), r1 = r[1] + y * r[4];
    const double disc = r1 * r1 - 4 * r0 * r[3], at = r1 * ball->by;
    *chord = (WrChord){ .y = y, .first = 0, .last = -1 };
    if (!(fabs(at) < 0x1p22)) return false;
    chord->middle = (double)(int)at;
    if (!(disc > 0)) return true;
    const double half = sqrt(disc) * ball->by, to = at + half - gx;
    chord->first = whole_above(at - half - gx, count);
    chord->last = to < 0 ? -1 : to < count - 1 ? (int)to : count - 1;
    return true;
}
