/* shadow_rays.h - shadow rays: visibility of lamps past objects and past the object itself (E49). Private to the
   renderer. Computed in double precision, so that results are equal on every processor.

   A caster is the shape itself where rays intersect it in closed form (plane, cube, sphere, cylinder, cone,
   torus); else triangles, those of a mesh or facets of the surface, in a tree of boxes. The error of facets is
   at most the body's `lift`. A displaced surface casts the shadow of facets of P + F n.

   Rays start `lift` above the surface, on the visible side, so that no facet shadows the point that it stands
   for. If the lamp is below the surface's own horizon, as happens where bumps lean towards it, the ray against
   the own body runs along the horizon: so a convex body never shadows itself. */
#pragma once
#include "base/hash.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "surface/surface.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrRayTree WrRayTree;
typedef struct WrTriangles WrTriangles;

#define WR_SHADOW_RAYS_RAYS 256 /* maximum number of rays to an area lamp */

/* A parallelogram. */
typedef struct WrShadowRaysQuad {
    /* along, across: dot products with them give coordinates 0..1 */
    WrVec3 from, normal, along, across;
} WrShadowRaysQuad;

/* A shadow caster, in its object's units. Zero-initialise; fini frees. */
typedef struct WrShadowRaysBody {
    WrShape shape; /* key of all that follows; kept while the scene's shape is equal */
    double radius; /* about the object's centre */
    WrHash raised; /* hash of everything that F depends on, for a displaced surface; else 0 */
    /* largest distance of its points from the base, object units; 0 if not displaced */
    double rise;
    bool made; /* the geometry for intersections exists */
    WrShadowRaysQuad quads[6];
    int quad_count;
    bool endless;
    WrTriangles *triangles; /* own share; NULL: closed form */
    WrRayTree *tree;        /* of the triangles; owned */
    double lift;            /* distance from the surface at which rays start */
} WrShadowRaysBody;

/* A caster in the space of another object: o = m p + from, for p in that object's units, stretched. */
typedef struct WrShadowRaysTo {
    const WrShadowRaysBody *body;
    double m[9];
    WrVec3 from;
    WrVec3 middle; /* centre of a bounding sphere in those units; radius INFINITY: unbounded */
    double radius;
    bool own; /* the object itself */
} WrShadowRaysTo;

/* Casters that can hide lamps from one object. */
typedef struct WrShadowRays {
    WrShadowRaysTo to[WR_OBJECTS_MAX]; /* first the `count` that can, then the others of `all` */
    int count, all;
    double lift; /* offset of its rays' origins, in its units, stretched */
    double disc[WR_SHADOW_RAYS_RAYS]
               [2]; /* points on an area lamp of unit radius, evenly spread, as many as `rays` */
    int rays;
} WrShadowRays;

/* True if the scene has such shadows, of a lamp that is on. */
bool wr_shadow_rays_needed(const WrScene *scene);
void wr_shadow_rays_body_fini(WrShadowRaysBody *body);

/* Arguments of wr_shadow_rays_prepare: finds which of `count` objects (scenes of one each, and their bodies) can
   hide a lamp from object `at`; those come first in the result. Only these bodies are built, or, with `all`, all
   of them. rays: to an area lamp. Errors: no memory; an invalid camera. */
typedef struct WrShadowRaysRequest {
    const WrScene *const *scenes;
    const WrField *const *fields; /* [count]: their tables; NULL with a formula */
    WrShadowRaysBody *const *bodies;
    int count, at, rays;
    bool all;
    bool moves; /* a displaced object casts its displaced shadow */
    double turn_deg, aspect;
} WrShadowRaysRequest;
bool wr_shadow_rays_prepare(WrShadowRays *cast, const WrShadowRaysRequest *ask, WrError *err);

/* Visibility of a lamp from p, 0..1. n: the surface's unit normal there, on the visible side; p and n in the
   object's units, stretched. l: unit vector to the lamp; away: its distance; radius: of an area lamp, radians.
   count: of cast->to. */
double wr_shadow_rays_share(const WrShadowRays *cast, int count, WrVec3 p, WrVec3 n, WrVec3 l,
                            double away, double radius);
