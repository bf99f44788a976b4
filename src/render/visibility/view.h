/* view.h - kernel-space view of a scene: camera, lights and surface in scaled object space. Private to the
   renderer. */
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
    double radius;      /* of the object, kernel units; an upper bound if stretched */
    WrShapef shape;
    WrShape shape_d;
    /* closed-form surface that rays intersect: the shape, or the shape grown by wr_view_grow */
    WrShapef shell;
    WrShape shell_d;
    WrViewGrid lit; /* rays for lighting: eye and toward, stretched; otherwise as K's */
    WrViewGrid grids[WR_VIEW_GRIDS]; /* K and the powers of two below it, 1 first */
    int grid_count;
    /* Kernel units, object space; double for the mesh. The dot products of right, up and forward with a point
       relative to the eye are its position in the picture and its depth. */
    WrVec3 eye, right, up, forward;
    /* their directions: equal to them unless the object is stretched */
    WrVec3 across, above, ahead;
    /* The object is stretched (WrPlacement): stretch factors, and factors of normals; 1 if it is not. */
    double rotation[9]; /* the object's axes -> the world */
    bool stretched, endless;
    double stretch[3], cofactor[3];
    double half_w, half_h; /* half the view's size: at depth 1, or, orthographic, in total */
    double near;           /* depth of the near plane */
    bool perspective;
    /* pixels x0 <= x < x1 that the object can cover, with a margin of two on each side */
    int x0, y0, x1, y1;
    bool cull; /* back faces are culled (E25) */
    /* Signed distance of a point p of kernel space behind the plane through the camera's target that faces it,
       in world units: deep_from + deep . p. Comparable between objects. */
    double deep[3], deep_from;
    double nearest;  /* of the object's bounding sphere */
    WrQuad quads[6]; /* planar faces that can be visible, back faces first */
    WrQuadd quads_d[6];
    int quad_face[6];
    int quad_count;
    WrKernLight *lights; /* [light_count], owned */
    WrKernLightd *lights_d;
    int light_count;
} WrView;

/* Decides whether the eye is certainly outside a closed surface. Planar faces: some face is towards it. Curved
   ones: it is farther away than any point of the object. radius: wr_shape_radius of the scene's shape. */
bool wr_view_outside(const WrScene *scene, double radius, double turn_deg, int width, int height,
                     bool *outside, WrError *err);
/* Largest displacement in the picture by F, in pixels: |F| f / z at the nearest possible depth; below 0:
   unknown. */
bool wr_view_rise(const WrScene *scene, const WrField *field, double radius, double turn_deg,
                  int width, int height, double *rise, WrError *err);
/* True if light k of the scene is in the view's list. The list has the enabled lights; if there are none, all
   lights, for forced effects. */
bool wr_view_shows_light(const WrScene *scene, int k);
/* Fills a view, by the plan's decisions about samples, back faces and perspective. The scene was checked before,
   so this fails only for an invalid camera (eye on target). Call fini even then. */
bool wr_view_init(WrView *view, const WrScene *scene, double radius, const WrPlan *plan,
                  double turn_deg, int width, int height, WrError *err);
/* Lets a plane's rays continue to a relief from low to high above it (parallax.h): u and v of their hits on the
   base may be outside its own range, as far as the eye can see past its edges. low, high: kernel units. */
void wr_view_widen(WrView *view, double low, double high);
/* Lets rays intersect the shell of a sphere or tube instead, which is larger by `more` (kernel units) and
   contains the relief; a tube then has no ends, and the part of the ray between its real ends is computed later. */
void wr_view_grow(WrView *view, double more);
void wr_view_fini(WrView *view);
/* The grid of k x k samples a pixel; k is 1, K or a power of two below K. */
const WrViewGrid *wr_view_grid(const WrView *view, int k);
