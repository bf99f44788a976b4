/* reference_view.h - camera, rays and the inverse of the surfaces for the reference, in object space and
   double precision: closed forms where there are any, else a tree of patches and Newton's method.
   Layer 5, private to the reference. */
#pragma once
#include "render/reference/reference_bezier.h"
#include "render/reference/reference_mesh.h"
#include "render/reference/reference_patch.h"
#include "scene/scene.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrShape WrShape;
typedef struct WrSurfaceInfo WrSurfaceInfo;

typedef struct WrReferenceLight {
    bool point;
    WrVec3 where; /* object space: unit direction to the light, or its place */
    double rgb[3];
    double radius; /* of a round lamp, radians */
    bool shadow;   /* objects hide it */
} WrReferenceLight;

typedef struct WrReferenceView {
    const WrShape *shape; /* the scene's */
    WrPlacement place;
    const WrSurfaceInfo *info;
    double width, height;                   /* pixels */
    WrVec3 eye, right, up, forward, middle; /* middle: where the axis of view passes the object */
    WrVec3 toward;                          /* -forward */
    /* Of a stretched object (WrPlacement): right, up and forward are what becomes the camera's axes, deep is what gives the
       depth; and as light sees it: along the object's axes, stretched. */
    bool stretched;
    WrVec3 deep, stretch, cofactor, lit_eye, lit_toward;
    double half_w, half_h, depth; /* of the view, at depth 1 or whole; of `middle` */
    double size;                  /* world units per unit of the object */
    double s_min;                 /* of rays: where the near plane stands */
    double rotation[9];           /* the object's axes -> the world */
    bool perspective;
    bool cull; /* a closed surface seen from outside hides its back */
    bool hidden[6];
    bool beyond; /* a plane is met beyond its edges too: rays go on to a relief that stands on it */
    WrReferenceLight *lights; /* [light_count], owned */
    int light_count;
    WrReferenceMesh mesh;       /* of triangles out of a file */
    WrReferenceBezier bezier;   /* of patches out of a file */
    WrReferencePatches patches; /* of surfaces without a closed inverse */
} WrReferenceView;

/* Errors: a camera that cannot look; no memory. Call fini even then. */
bool wr_reference_view_init(WrReferenceView *view, const WrScene *scene, double turn_deg, int width,
                            int height, WrError *err);
void wr_reference_view_fini(WrReferenceView *view); /* fine on a zeroed one */

/* A point and a unit normal of the object as light sees them. */
WrVec3 wr_reference_stretched(const WrReferenceView *view, WrVec3 p);
WrVec3 wr_reference_normal_stretched(const WrReferenceView *view, WrVec3 n);
/* The ray through (x, y), pixels from the top left corner. */
WrReferenceRay wr_reference_view_ray(const WrReferenceView *view, double x, double y);
/* How that ray's q and d change from pixel to pixel. */
void wr_reference_view_spread(const WrReferenceView *view, WrReferenceRay *per_x,
                              WrReferenceRay *per_y);
/* The surface's point there; of a mesh as wr_reference_mesh_at has it. */
void wr_reference_view_at(const WrReferenceView *view, const WrReferenceHit *hit,
                          WrSurfacePoint *out);
/* The nearest point of the surface on the ray, in front of the near plane, as the program shows it. */
bool wr_reference_view_hit(const WrReferenceView *view, const WrReferenceRay *ray,
                           WrReferenceHit *hit);
