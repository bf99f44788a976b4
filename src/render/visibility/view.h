/* view.h - a scene as the kernels see it: camera, lights and surface in scaled object space.
   Layer 5, private to the renderer. */
#pragma once
#include "render/kernels/kern.h"
#include "render/plan/plan.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrScene WrScene;

/* The rays of a grid of k x k samples a pixel. */
typedef struct WrViewGrid {
    int k;
    WrRays rays;
    WrRaysd rays_d;
} WrViewGrid;

#define WR_VIEW_GRIDS 8 /* 1, 2, 4 .. 64, and K */

typedef struct WrView {
    int samples;        /* K */
    int grid_w, grid_h; /* samples: picture size times K */
    double scale;       /* object units -> kernel units; a power of two */
    double radius;      /* of the object, kernel units; no larger when stretched */
    WrShapef shape;
    WrShape shape_d;
    WrShapef shell; /* what rays meet in closed form: the shape, or it grown (wr_view_grow) */
    WrShape shell_d;
    WrViewGrid lit; /* rays as light sees them: eye and toward, stretched; else K's */
    WrViewGrid grids[WR_VIEW_GRIDS]; /* K and its powers of two below, 1 first */
    int grid_count;
    /* Kernel units, object space; double for the mesh. The products of right, up and forward with what lies before the
       eye are its place in the picture and its depth. */
    WrVec3 eye, right, up, forward;
    WrVec3 across, above, ahead; /* where they point: the same, unless the object is stretched */
    /* The object is stretched (WrPlacement): stretch and what normals are multiplied with; 1 where it is not. */
    double rotation[9]; /* the object's axes -> the world */
    bool stretched, endless;
    double stretch[3], cofactor[3];
    double half_w, half_h; /* of the view: at depth 1, or the whole, orthographic */
    double near;           /* depth of the near plane */
    bool perspective;
    int x0, y0, x1, y1; /* pixels x0 <= x < x1 that the object can cover, two more on each side */
    bool cull;          /* back faces are left out (E25) */
    /* How far a point p of kernel space lies behind the plane through the camera's target that faces it, in the world:
       deep_from + deep . p. Of whatever object. */
    double deep[3], deep_from;
    double nearest;  /* of the ball that holds the object */
    WrQuad quads[6]; /* planar surfaces: those that can be seen, such as look away first */
    WrQuadd quads_d[6];
    int quad_face[6];
    int quad_count;
    WrKernLight *lights; /* [light_count], owned */
    WrKernLightd *lights_d;
    int light_count;
} WrView;

/* Is the eye outside the surface for certain, if that is closed? Of planar faces: some face looks at it. Of curved
   ones: it is farther than any of the object. radius: wr_shape_radius of the scene's. */
bool wr_view_outside(const WrScene *scene, double radius, double turn_deg, int width, int height,
                     bool *outside, WrError *err);
/* How many pixels F could move a point of the surface in the picture, at most: |F| f / z at the nearest that it can come
   to; below 0: not known. */
bool wr_view_rise(const WrScene *scene, const WrField *field, double radius, double turn_deg,
                  int width, int height, double *rise, WrError *err);
/* Is light k of the scene among the view's? Those are that shine; where none does all, for who forces light. */
bool wr_view_shows_light(const WrScene *scene, int k);
/* Fill a view, with what the plan says of samples, backs and perspective; all checks were made when the scene was accepted, so this fails only for a camera that
   cannot look (eye on target). Call fini even then. */
bool wr_view_init(WrView *view, const WrScene *scene, double radius, const WrPlan *plan,
                  double turn_deg, int width, int height, WrError *err);
/* A plane's rays go on to a relief from low to high over it (parallax.h): where they meet the base then, u and v may lie beyond
   its own, as far as the eye can look past its edges at what stands there. low, high: kernel units. */
void wr_view_widen(WrView *view, double low, double high);
/* Rays of a ball or a tube meet its shell instead, which is farther out by `more` (kernel units) and holds a relief over it; of a
   tube one without ends: which part of the ray is between them is asked later. */
void wr_view_grow(WrView *view, double more);
void wr_view_fini(WrView *view);
/* The grid of k x k samples a pixel; k is 1, K or a power of two below K. */
const WrViewGrid *wr_view_grid(const WrView *view, int k);
