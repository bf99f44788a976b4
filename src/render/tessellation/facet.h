/* facet.h - distance of a point from a triangle. */
#pragma once
#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrFacet {
    WrVec3 p[3], side[3]; /* side k runs from corner k to the next */
    WrVec3 in[3];         /* across side k, inwards */
    WrVec3 n;             /* unit */
    double length2[3];
    bool flat; /* it has no area, only sides */
} WrFacet;

static inline WrFacet wr_facet_of(const float (*points)[3], const int32_t corners[3])
{
    WrFacet f;
    for (int k = 0; k < 3; k++) {
        const float *p = points[corners[k]];
        f.p[k] = (WrVec3){ (double)p[0], (double)p[1], (double)p[2] };
    }
    for (int k = 0; k < 3; k++) {
        f.side[k] = v3_sub(f.p[(k + 1) % 3], f.p[k]);
        f.length2[k] = v3_dot(f.side[k], f.side[k]);
    }
    const WrVec3 n = v3_cross(f.side[0], f.side[1]);
    f.flat = !(v3_len(n) > 1e-12 * (f.length2[0] + f.length2[1]));
    f.n = v3_unit(n, (WrVec3){ 0, 0, 0 });
    for (int k = 0; k < 3; k++) f.in[k] = v3_cross(f.n, f.side[k]);
    return f;
}

/* Squared distance from side k as a segment. */
static inline double wr_facet_side2(const WrFacet *f, int k, WrVec3 p)
{
    const WrVec3 q = v3_sub(p, f->p[k]);
    const double along = f->length2[k] > 0 ? v3_dot(q, f->side[k]) / f->length2[k] : 0.0;
    const double part = along < 0.0 ? 0.0 : along > 1.0 ? 1.0 : along;
    const WrVec3 d = v3_mad(q, f->side[k], -part);
    return v3_dot(d, d);
}

/* Squared distance of a point. Inside the prism over the triangle it is the distance from the plane; outside, from the
   nearest side as a segment. */
static inline double wr_facet_distance2(const WrFacet *f, WrVec3 p)
{
    bool over = !f->flat;
    for (int k = 0; k < 3 && over; k++) over = v3_dot(v3_sub(p, f->p[k]), f->in[k]) >= 0.0;
    if (over) {
        const double h = v3_dot(v3_sub(p, f->p[0]), f->n);
        return h * h;
    }
    const double a = wr_facet_side2(f, 0, p), b = wr_facet_side2(f, 1, p),
                 c = wr_facet_side2(f, 2, p);
    return a < b ? a < c ? a : c : b < c ? b : c;
}
