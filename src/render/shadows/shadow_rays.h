/* shadow_rays.h - objects that hide lamps from one another and from themselves (E49): rays from a place towards a lamp, in double
   precision, so that the answers are the same on every processor.
   Layer 5, private to the renderer.

   A body is the shape itself where rays meet it in closed form (plane, cube, sphere, cylinder, cone, torus); else triangles, those
   of a mesh or facets of the surface, in a tree of boxes. Facets are off by no more than the body's `lift`. A displaced
   surface throws the shadow of facets of P + F n.

   Rays start that far above the surface, on the side that is seen, so that no facet darkens the place that it stands for.
   Where the lamp is below the surface's own horizon, as it may be for what bumps lean towards it, the ray to the own body
   runs along the horizon: so no convex body hides a lamp from itself. */
#pragma once
#include "base/hash.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "surface/surface.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrTriangles WrTriangles;

#define WR_SHADOW_RAYS_RAYS 256 /* to a round lamp, at most */

/* A parallelogram. */
typedef struct WrShadowRaysQuad {
    WrVec3 from, normal, along, across; /* along, across: dot products with them give parts 0..1 */
} WrShadowRaysQuad;

/* What throws a shadow, in its object's units. Zero-initialise; fini frees. */
typedef struct WrShadowRaysBody {
    WrShape shape; /* that all else was made for; kept while the scene's is the same */
    double radius; /* about the object's centre */
    WrHash raised; /* of all that F goes by, of a displaced surface; else 0 */
    double rise;   /* so far its points may be from the base, object units; of another surface 0 */
    bool made;     /* what rays meet is there */
    WrShadowRaysQuad quads[6];
    int quad_count;
    bool endless;
    WrTriangles *triangles; /* own share; NULL: closed form */
    float (*boxes)[6];      /* a heap: the children of k are 2 k + 1 and 2 k + 2; owned */
    int32_t *order;         /* triangles, those of a box one after the other; owned */
    int32_t leaves;         /* of the heap, a power of two */
    double lift;            /* how far from the surface rays start */
} WrShadowRaysBody;

/* One body as places of another object see it: o = m p + from, of p in that one's units, stretched. */
typedef struct WrShadowRaysTo {
    const WrShadowRaysBody *body;
    double m[9];
    WrVec3 from;
    WrVec3 middle; /* of a ball that holds it, in those units; radius INFINITY: it has no end */
    double radius;
    bool own; /* it is the object itself */
} WrShadowRaysTo;

/* What can hide lamps from one object. */
typedef struct WrShadowRays {
    WrShadowRaysTo to[WR_OBJECTS_MAX]; /* `count` that can, then the others of `all` */
    int count, all;
    double lift; /* where its rays start, its units, stretched */
    double disc[WR_SHADOW_RAYS_RAYS]
               [2]; /* places on a round lamp of radius 1, of as many as `rays` */
    int rays;
} WrShadowRays;

/* Does the scene ask for such shadows, of a light that shines? */
bool wr_shadow_rays_asked(const WrScene *scene);
/* Is the object such that it never hides a lamp from itself? Its size is known. */
bool wr_shadow_rays_spares_itself(const WrShadowRaysBody *body);
/* The body's size alone. field: what F is looked up in where the surface is displaced; NULL with a formula. moves: a displaced
   surface is met as it is displaced, else its base. */
void wr_shadow_rays_body_size(WrShadowRaysBody *body, const WrScene *scene, const WrField *field,
                              bool moves);
/* All of it; its size is known, and field as it was for that. Errors: no memory. */
bool wr_shadow_rays_body_bring(WrShadowRaysBody *body, const WrScene *scene, const WrField *field,
                               WrError *err);
void wr_shadow_rays_body_fini(WrShadowRaysBody *body);
/* Does the ray o + t d, object units, d of any length, meet it for 0 < t < most? */
bool wr_shadow_rays_meets(const WrShadowRaysBody *body, WrVec3 o, WrVec3 d, double most);
/* The same of a torus. */
bool wr_shadow_rays_meets_torus(const WrShape *shape, WrVec3 o, WrVec3 d, double most);
/* The tree of boxes about body->triangles, and the same of it. Errors: no memory. */
bool wr_shadow_rays_tree_bring(WrShadowRaysBody *body, WrError *err);
bool wr_shadow_rays_tree_meets(const WrShadowRaysBody *body, WrVec3 o, WrVec3 d, double most);
/* Facets of a surface without a closed form, or displaced, into body->triangles, and what they are off by into its lift. */
bool wr_shadow_rays_facets(WrShadowRaysBody *body, const WrScene *scene, const WrField *field,
                           WrError *err);

/* Which of `count` objects (scenes of one each, and their bodies) can hide a lamp from object `at`: those come first. Bodies
   that can, or, if so wanted, all of them are made. rays: to a round lamp. Errors: no memory; a camera that cannot look. */
typedef struct WrShadowRaysAsk {
    const WrScene *const *scenes;
    const WrField *const *fields; /* [count]: their tables; NULL with a formula */
    WrShadowRaysBody *const *bodies;
    int count, at, rays;
    bool all;
    bool moves; /* what is displaced throws its displaced shadow */
    double turn_deg, aspect;
} WrShadowRaysAsk;
bool wr_shadow_rays_prepare(WrShadowRays *cast, const WrShadowRaysAsk *ask, WrError *err);

/* What is seen of a lamp from p, n the surface's unit normal there on the side that is seen, both in the object's units,
   stretched: 0..1. l: unit, towards it; away: how far it is; radius: of a round lamp, radians. count: of cast->to. */
double wr_shadow_rays_share(const WrShadowRays *cast, int count, WrVec3 p, WrVec3 n, WrVec3 l,
                            double away, double radius);
