#include "brush/capsule.h"

#include "brush/brush.h"

#include <math.h>

/* texels by which spans are enlarged: more than rounding errors, with negligible cost */
#define SLACK 1e-3

/* The area that a disc of radius R covers while its centre moves from (x, y) to (x + dx, y + dy). A texel at distance d from
   the segment, at fraction t of it, has the coverage
       p(t) * s * s * (3 - 2 s),   s = (R - d) / (R - inner) limited to 0..1,   p(t) = pressure + t growth
   The reciprocals are stored because the kernels divide by neither. A motion shorter than 1e-6 texels has no usable
   direction: its squared length would overflow the reciprocal, so it becomes a dab with inverse_length2 = 0. */
WrCapsule wr_capsule(const WrBrush *brush, double x, double y, double dx, double dy,
                     double pressure_start, double pressure_end)
{
    WrCapsule c = { .x = x, .y = y, .dx = dx, .dy = dy, .pressure = pressure_start };
    c.growth = pressure_end - pressure_start;
    c.radius = brush->radius;
    c.inner = wr_brush_inner(brush);
    c.radius2 = c.radius * c.radius;
    c.inner2 = c.inner * c.inner;
    c.inverse_edge = 1.0 / (c.radius - c.inner);
    double length2 = dx * dx + dy * dy;
    if (length2 > 1e-12) {
        c.inverse_length2 = 1.0 / length2;
    } else { /* no direction: a dab, with the larger pressure of both ends */
        c.dx = c.dy = c.growth = 0.0;
        c.pressure = pressure_end > pressure_start ? pressure_end : pressure_start;
        double s = (c.radius - sqrt(c.inner2)) * c.inverse_edge; /* as in the kernels */
        c.most = (float)(c.pressure * (s * s * (3.0 - 2.0 * s)));
    }
    return c;
}

/* The disc at fraction t of the motion covers x(t) -+ sqrt(R^2 - (y - y(t))^2) on row y. As a function
 * of t this is convex (for the left end; concave for the right), and its extreme is where the disc's
 * radius is perpendicular to the motion, or else the nearer end of the range of t that reaches the row. */
static double extreme(const WrCapsule *c, double y, double from, double to, double side)
{
    double t;
    if (c->dy == 0.0) {
        t = side * c->dx > 0.0 ? to : from;
    } else {
        /* the unit normal of the motion that points to `side` is side |dy| / length, ... */
        double length = sqrt(c->dx * c->dx + c->dy * c->dy);
        double normal_y = (c->dy > 0.0 ? -side : side) * c->dx / length;
        t = (y - c->radius * normal_y - c->y) / c->dy;
        t = t < from ? from : t > to ? to : t;
    }
    double off = y - (c->y + t * c->dy), half2 = c->radius * c->radius - off * off;
    return c->x + t * c->dx + side * sqrt(half2 > 0.0 ? half2 : 0.0);
}

static bool dab_span(const WrCapsule *c, double y, double *low, double *high)
{
    double off = y - c->y, half2 = c->radius * c->radius - off * off;
    if (!(half2 > 0.0)) return false;
    double half = sqrt(half2) + SLACK;
    *low = c->x - half;
    *high = c->x + half;
    return true;
}

/* Rows in question satisfy |y - y(t)| <= R for some t in 0..1, an interval of t since y(t) is linear. The span may be too
   wide (the kernel computes 0 there) but never too narrow, which would leave a visible notch. */
bool wr_capsule_span(const WrCapsule *c, double y, double *low, double *high)
{
    if (!(c->inverse_length2 > 0.0)) return dab_span(c, y, low, high);
    double from = 0.0, to = 1.0, off = y - c->y; /* the part of the motion that reaches the row */
    if (c->dy != 0.0) {
        double t0 = (off - c->radius) / c->dy, t1 = (off + c->radius) / c->dy;
        from = t0 < t1 ? t0 : t1;
        to = t0 < t1 ? t1 : t0;
        from = from > 0.0 ? from : 0.0;
        to = to < 1.0 ? to : 1.0;
        if (from > to) return false;
    } else if (fabs(off) > c->radius) {
        return false;
    }
    *low = extreme(c, y, from, to, -1.0) - SLACK;
    *high = extreme(c, y, from, to, 1.0) + SLACK;
    return true;
}
