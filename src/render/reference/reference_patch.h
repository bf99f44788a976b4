/* reference_patch.h - ray intersection with a curved surface, for the reference.
   Private to the reference. A tree of pieces of the (u,v) square with boxes around their images, and Newton's
   method in the pieces that the ray enters. */
#pragma once
#include "surface/patches.h"
#include "surface/surface.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;

/* Points q + s d; d's component along the view axis is 1, so that s grows with depth. */
typedef struct WrReferenceRay {
    WrVec3 q, d;
    double s_min; /* the near plane; hits are beyond */
} WrReferenceRay;

typedef struct WrReferenceHit {
    double s, u, v;
    int face;
    int32_t triangle; /* of a mesh file ... */
    double share[2];  /* ... and the shares of its second and third corner */
    bool lost;        /* Newton's method did not converge; the nearest point it reached */
} WrReferenceHit;

typedef struct WrReferencePiece WrReferencePiece;
typedef struct WrReferencePatches {
    WrReferencePiece *pieces; /* [count], owned; the first is the root */
    int count;
    double size; /* of the object, object units */
} WrReferencePatches;

bool wr_reference_patches_init(WrReferencePatches *patches, const WrShape *shape, WrError *err);
void wr_reference_patches_fini(WrReferencePatches *patches); /* also for a zeroed one */
/* Nearest root beyond s_min. cull: ignores roots whose N = Pu x Pv points away from the viewer. */
bool wr_reference_patches_hit(const WrReferencePatches *patches, const WrShape *shape, bool cull,
                              const WrReferenceRay *ray, WrReferenceHit *hit);
/* A step of Newton's method: P + Pu du + Pv dv on the ray. False if the ray is in the tangent plane. */
bool wr_reference_newton_step(const WrReferenceRay *ray, WrVec3 p, WrVec3 pu, WrVec3 pv, double *du,
                              double *dv);

/* ---- bounding boxes for ray tests, and tangents from the gradients of u and v, for the reference ---- */

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
   = n x grad u, times |N| = 1 / |grad u x grad v|, so that Blinn's formula yields unit(n - grad F). |N| is 1 if
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

/* ---- ray intersection with bicubic patches, for the reference ---- */

/* Boxes around the patches' control points, and within each reference_patch.h's tree and Newton's method. Independent of the triangles used by the fast renderer. */

typedef struct WrReferenceBezierPiece WrReferenceBezierPiece;
typedef struct WrReferenceBezier {
    const WrPatches *source;        /* borrowed; NULL: there is none */
    WrReferenceBezierPiece *pieces; /* [source->count], owned */
} WrReferenceBezier;

bool wr_reference_bezier_init(WrReferenceBezier *set, const WrPatches *source, WrError *err);
void wr_reference_bezier_fini(WrReferenceBezier *set); /* also for a zeroed one */
/* Nearest hit beyond s_min: fills s, u, v (the table's), triangle (here the patch) and share (its own u, v). */
bool wr_reference_bezier_hit(const WrReferenceBezier *set, bool cull, const WrReferenceRay *ray,
                             WrReferenceHit *hit);
/* As wr_reference_mesh_at. */
void wr_reference_bezier_at(const WrReferenceBezier *set, const WrReferenceHit *hit,
                            WrSurfacePoint *out);
