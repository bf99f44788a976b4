/* reference_view.h - camera, rays and surface intersection for the reference, in object space and double
   precision. Private to the reference. Closed forms if there are any, else a tree of patches and Newton's
   method. */
#pragma once
#include "render/reference/reference_mesh.h"
#include "render/reference/reference_patch.h"
#include "scene/scene.h"

#include <stdbool.h>

typedef struct WrError WrError;
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
/* The surface's point there; for a mesh as wr_reference_mesh_at. */
void wr_reference_view_at(const WrReferenceView *view, const WrReferenceHit *hit,
                          WrSurfacePoint *out);
/* Nearest visible point of the surface on the ray, beyond the near plane. */
bool wr_reference_view_hit(const WrReferenceView *view, const WrReferenceRay *ray,
                           WrReferenceHit *hit);
