/* reference_intersect.h - ray intersection for the reference, in object space and double precision: curved surfaces, mesh files,
   camera and closed forms. Private to the reference. */
#pragma once
#include "scene/scene.h"
#include "scene/texture_sample.h"
#include "surface/patches.h"
#include "surface/surface.h"
#include "surface/tangent_frames.h"
#include "surface/triangles.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

/* ---- curved surfaces ---- */

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
    WrVec3 facet;     /* of triangles: along the normal of the one that was hit */
    bool lost;        /* Newton's method did not converge; the nearest point it reached */
} WrReferenceHit;

typedef struct WrReferencePiece WrReferencePiece;
typedef struct WrReferencePatches {
    WrReferencePiece *pieces; /* [count], owned; the first is the root */
    int count;
    double size; /* of the object, object units */
} WrReferencePatches;

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

/* Boxes around the patches' control points, and within each the tree and Newton's method of curved surfaces. Independent of
   the triangles used by the fast renderer. */

typedef struct WrReferenceBezierPiece WrReferenceBezierPiece;
typedef struct WrReferenceBezier {
    const WrPatches *source;        /* borrowed; NULL: there is none */
    WrReferenceBezierPiece *pieces; /* [source->count], owned */
} WrReferenceBezier;

/* ---- mesh files ---- */

/* Ray intersection with a mesh file, for the reference.
   Private to the reference. A tree of boxes, and the watertight test of Woop, Benthin and Wald (2013), in
   double. */

typedef struct WrReferenceBox WrReferenceBox;
typedef struct WrReferenceMesh {
    WrTriangles *source;   /* shared; NULL: there is none */
    WrReferenceBox *boxes; /* owned; the first is the root */
    int32_t *order;        /* triangles sorted by box; owned */
    int32_t box_count;
    WrTangent *tangents; /* [3 triangles], owned; NULL: no normal map needs them */
    bool mikk;           /* they follow MikkTSpace */
} WrReferenceMesh;

/* Builds the tree and takes ownership of the mesh. Errors: no memory. */
bool wr_reference_mesh_init(WrReferenceMesh *mesh, WrTriangles *source, WrError *err);
/* Axes of such a map at a hit; false: there is no frame. */
bool wr_reference_mesh_axes(const WrReferenceMesh *mesh, const WrReferenceHit *hit,
                            WrMapAxes *axes);
void wr_reference_mesh_fini(WrReferenceMesh *mesh); /* also for a zeroed one */
/* Nearest triangle beyond s_min: fills s, u, v, triangle and share. cull: ignores back faces. A ray through an
   edge or a corner that triangles share hits one of them. */
bool wr_reference_mesh_hit(const WrReferenceMesh *mesh, bool cull, const WrReferenceRay *ray,
                           WrReferenceHit *hit);

/* ---- camera, rays and closed forms ---- */

/* Camera, rays and surface intersection for the reference, in object space and double
   precision. Private to the reference. Closed forms if there are any, else a tree of patches and Newton's
   method. */

typedef struct WrShape WrShape;
typedef struct WrSurfaceInfo WrSurfaceInfo;

typedef struct WrReferenceLight {
    bool point;
    WrVec3 where; /* object space: unit direction to the light, or its position */
    double rgb[3];
    double radius; /* of an area lamp, radians */
    bool shadow;   /* objects can hide it */
} WrReferenceLight;

typedef struct WrReferenceView {
    const WrShape *shape; /* of the scene */
    WrPlacement place;
    const WrSurfaceInfo *info;
    double width, height;                   /* pixels */
    WrVec3 eye, right, up, forward, middle; /* middle: point of the view axis at the object */
    WrVec3 toward;                          /* -forward */
    /* For a stretched object (WrPlacement): right, up and forward are the transformed camera axes, deep yields
       the depth. lit_*: along the object's axes, in world proportions. */
    bool stretched;
    WrVec3 deep, stretch, cofactor, lit_eye, lit_toward;
    /* half the view's size, at depth 1 or in total; depth of `middle` */
    double half_w, half_h, depth;
    double size;        /* world units per object unit */
    double s_min;       /* ray parameter of the near plane */
    double rotation[9]; /* the object's axes -> the world */
    bool perspective;
    bool cull; /* a closed surface seen from outside: back faces are culled */
    bool hidden[6];
    bool raised; /* a displaced mesh: its side is that of the relief, not of its faces */
    bool beyond; /* a plane is also intersected beyond its edges: rays continue to a relief on it */
    WrReferenceLight *lights; /* [light_count], owned */
    int light_count;
    WrReferenceMesh mesh;       /* of a mesh file */
    WrReferenceBezier bezier;   /* of a file of patches */
    WrReferencePatches patches; /* of surfaces without a closed-form intersection */
} WrReferenceView;

/* Prepares the view. Errors: an invalid camera; no memory. Call fini even then. */
bool wr_reference_view_init(WrReferenceView *view, const WrScene *scene, double turn_deg, int width,
                            int height, WrError *err);
void wr_reference_view_fini(WrReferenceView *view); /* also for a zeroed one */

/* A point and a unit normal of the object in world proportions. */
WrVec3 wr_reference_stretched(const WrReferenceView *view, WrVec3 p);
WrVec3 wr_reference_normal_stretched(const WrReferenceView *view, WrVec3 n);
/* The ray through (x, y), pixels from the top left corner. */
WrReferenceRay wr_reference_view_ray(const WrReferenceView *view, double x, double y);
/* Change of that ray's q and d per pixel. */
void wr_reference_view_spread(const WrReferenceView *view, WrReferenceRay *per_x,
                              WrReferenceRay *per_y);
/* The surface's point there; for a mesh as reference_mesh_at. */
void wr_reference_surface_point(const WrReferenceView *view, const WrReferenceHit *hit,
                                WrSurfacePoint *out);
/* Nearest visible point of the surface on the ray, beyond the near plane. */
bool wr_reference_view_hit(const WrReferenceView *view, const WrReferenceRay *ray,
                           WrReferenceHit *hit);
