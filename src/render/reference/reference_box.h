/* reference_box.h - bounding boxes for ray tests, and tangents from the gradients of u and v, for the reference.
   Private to the reference. */
#pragma once
#include "render/reference/reference_patch.h"

#include <math.h>
#include <stdbool.h>

/* Along x, y, z; object space. */
typedef struct WrReferenceBounds {
    double low[3], high[3];
} WrReferenceBounds;

static inline double wr_reference_part(WrVec3 a, int axis)
{
    return axis == 0 ? a.x : axis == 1 ? a.y : a.z;
}

/* The empty box. */
static inline WrReferenceBounds wr_reference_bounds(void)
{
    return (WrReferenceBounds){ { INFINITY, INFINITY, INFINITY },
                                { -INFINITY, -INFINITY, -INFINITY } };
}

static inline void wr_reference_bounds_add(WrReferenceBounds *box, int axis, double x)
{
    box->low[axis] = fmin(box->low[axis], x);
    box->high[axis] = fmax(box->high[axis], x);
}

/* True if the ray enters the box before `most`. slack: relative to the distance of its sides, so that rounding
   loses no hit. */
static inline bool wr_reference_bounds_met(const WrReferenceBounds *box, const WrReferenceRay *ray,
                                           double most, double slack)
{
    double near = ray->s_min, far = most;
    for (int axis = 0; axis < 3; axis++) {
        const double inv = 1 / wr_reference_part(ray->d, axis), q = wr_reference_part(ray->q, axis);
        double a = (box->low[axis] - q) * inv, b = (box->high[axis] - q) * inv;
        if (a > b) {
            const double t = a;
            a = b, b = t;
        }
        const double more = slack * (fabs(a) + fabs(b));
        if (a - more > near) near = a - more; /* NaN: the ray lies in the side */
        if (b + more < far) far = b + more;
    }
    return near <= far;
}

/* n, N, Pu and Pv of a point from the gradients of u and v, which are perpendicular to n: Pu = grad v x n and Pv
   = n x grad u, times |N| = 1 / |grad u x grad v|, so that Blinn's formula gives unit(n - grad F). |N| is 1 if
   the gradients are parallel or 0. */
static inline void wr_reference_lay(WrVec3 n, WrVec3 grad_u, WrVec3 grad_v, WrSurfacePoint *out)
{
    const double area = v3_len(v3_cross(grad_u, grad_v)), length = area > 1e-30 ? 1 / area : 1;
    out->n_unit = n;
    out->n = v3_scale(n, length);
    out->n_len = length;
    out->pu = v3_scale(v3_cross(grad_v, n), length);
    out->pv = v3_scale(v3_cross(n, grad_u), length);
}
