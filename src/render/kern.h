/* kern.h - the span kernels of the renderer: each is a short loop over up to WR_SPAN samples held as a
   structure of arrays, so that everything stays in the first-level cache and compilers vectorise it.
   Layer 5. The bodies (kern_body.h) are compiled once for each instruction set; `exact` sets give the
   same bits on every processor, `fast` sets may contract and reorder within a stated bound.

   All lengths here are scaled by a power of two so that the object's radius is near 1; positions are in
   object space: lights and eye are turned into it once a frame, so that no normal is ever rotated. */
#pragma once
#include "field/scheme.h"
#include "shade/bump.h"
#include "surface/surface.h"

#include <stdbool.h>

#define WR_SPAN 256 /* samples in a strip */

/* The samples of one strip. Members are filled stage by stage; count is how many are in use. */
typedef struct WrStrip {
    int count;
    _Alignas(64) int index[WR_SPAN];             /* which sample of the row this is, ascending */
    _Alignas(64) float s[WR_SPAN];               /* ray parameter (closed forms) */
    float u[WR_SPAN], v[WR_SPAN];                /* patch parameters, 0..1 */
    float px[WR_SPAN], py[WR_SPAN], pz[WR_SPAN]; /* P */
    float pux[WR_SPAN], puy[WR_SPAN], puz[WR_SPAN];
    float pvx[WR_SPAN], pvy[WR_SPAN], pvz[WR_SPAN];
    float nx[WR_SPAN], ny[WR_SPAN], nz[WR_SPAN];    /* n, unit */
    float n_len[WR_SPAN];                           /* |N| */
    float nux[WR_SPAN], nuy[WR_SPAN], nuz[WR_SPAN]; /* dn/du; only where curvature ran */
    float nvx[WR_SPAN], nvy[WR_SPAN], nvz[WR_SPAN];
    float tu[WR_SPAN], tv[WR_SPAN];              /* place in the table, 0..1 */
    float inside_u[WR_SPAN], inside_v[WR_SPAN];  /* 1; 0 beyond the end of a clamped axis */
    int at[WR_SPAN];                             /* first tap in the copies */
    float ta[WR_SPAN], tb[WR_SPAN];              /* fractions past it */
    float top[4 * WR_SPAN], low[4 * WR_SPAN];    /* taps of the upper and the lower row */
    float f[WR_SPAN], fu[WR_SPAN], fv[WR_SPAN];  /* height and replication included */
    float bx[WR_SPAN], by[WR_SPAN], bz[WR_SPAN]; /* n', unit, towards the viewer's side */
    float vx[WR_SPAN], vy[WR_SPAN], vz[WR_SPAN]; /* unit, towards the viewer */
    float lx[WR_SPAN], ly[WR_SPAN], lz[WR_SPAN]; /* unit, towards the light at hand */
    float n_dot_l[WR_SPAN];
    float dr[WR_SPAN], dg[WR_SPAN], db[WR_SPAN]; /* ambient and diffuse sums */
    float sr[WR_SPAN], sg[WR_SPAN], sb[WR_SPAN]; /* specular sums */
    float cr[WR_SPAN], cg[WR_SPAN], cb[WR_SPAN]; /* C(u,v), then the finished colour */
} WrStrip;

/* The ray of sample (gx, gy) of the frame's sample grid: q + s d, with q = q0 + gx qx + gy qy and d
   alike. q lies in the plane through the object's centre that faces the camera, so that its size is
   the object's and nothing cancels however far the eye is. */
typedef struct WrRays {
    float q0[3], qx[3], qy[3];
    float d0[3], dx[3], dy[3];
    float s_min; /* nearer than this is behind the near plane */
    bool perspective;
    float eye[3];    /* perspective */
    float toward[3]; /* orthographic: unit vector towards the viewer */
} WrRays;

/* A flat parallelogram with orthogonal edges: plane, or a face of the cube. */
typedef struct WrQuad {
    float origin[3], normal[3];
    float eu[3], ev[3]; /* Pu / |Pu|^2, Pv / |Pv|^2: dot products give u, v */
} WrQuad;

/* Where and how heights are looked up. Contiguous copies with an apron (table.h). */
typedef struct WrLook {
    const float *heights;  /* F, or spline coefficients; texel (i,j) at [(j + A) pitch + i + A] */
    const float *gradient; /* central differences dF/du, dF/dv interleaved, same layout */
    int pitch;             /* texels a row */
    int width, height;
    double ru, rv; /* replication */
    bool periodic_u, periodic_v;
    bool wide;                       /* reduce r u in double (E10) */
    float scale_f, scale_u, scale_v; /* height; height * ru; height * rv */
} WrLook;

#define WR_APRON 4 /* texels around the contiguous copies */

/* The colour picture, RGBA float with an apron of one texel. */
typedef struct WrColourLook {
    const float *rgba;
    int pitch; /* texels a row */
    int width, height;
    double ru, rv;
    bool periodic_u, periodic_v;
} WrColourLook;

typedef struct WrKernLight {
    bool point;
    float where[3]; /* unit direction towards it, or position */
    float rgb[3];   /* colour * strength */
} WrKernLight;

typedef int (*WrHitKernel)(const WrRays *rays, const WrShapef *shape, float gx, float gy, int count,
                           WrStrip *strip);

typedef struct WrKernels {
    const char *name; /* "v3" */
    bool exact;       /* same bits as "ref" */

    /* Visibility in closed form for `count` neighbouring samples from (gx, gy): fills index, u, v of
       those that hit and returns how many. */
    WrHitKernel hit_sphere, hit_cylinder, hit_cone;
    int (*hit_quad)(const WrRays *rays, const WrQuad *quad, float gx, float gy, int count,
                    WrStrip *strip);
    /* Newton's method from the guesses in u, v of the samples in index: solves P(u,v) = q + s d by
       3 x 3 steps, no longer than `reach` in u and v; keeps the guess where it does not improve. */
    void (*polish[WR_SURFACE_COUNT])(const WrRays *rays, const WrShapef *shape, float gx, float gy,
                                     float reach_u, float reach_v, bool closed_u, bool closed_v,
                                     int steps, WrStrip *strip);
    /* Points only, for meshes. */
    void (*points[WR_SURFACE_COUNT])(const WrShapef *shape, int count, const float *u,
                                     const float *v, float *x, float *y, float *z);
    /* P, Pu, Pv, n, |N|; and n_u, n_v. */
    void (*geometry[WR_SURFACE_COUNT])(const WrShapef *shape, int face, WrStrip *strip);
    void (*curvature[WR_SURFACE_COUNT])(const WrShapef *shape, int face, WrStrip *strip);

    /* F, Fu, Fv of the table. */
    void (*look[WR_SCHEME_COUNT])(const WrLook *look, WrStrip *strip);
    /* n' from n and the slopes, turned to the viewer's side. */
    void (*bump[WR_BUMP_COUNT])(const WrRays *rays, WrStrip *strip);

    void (*view)(const WrRays *rays, WrStrip *strip);
    void (*begin)(float ambient, WrStrip *strip);
    void (*colour)(const WrColourLook *look, WrStrip *strip); /* after begin */
    void (*light)(const WrKernLight *light, WrStrip *strip);
    void (*diffuse)(const WrKernLight *light, float kd, WrStrip *strip);
    void (*specular)(const WrKernLight *light, float ks, float shininess, bool gate,
                     WrStrip *strip);
    void (*finish)(const float colour[3], WrStrip *strip);
} WrKernels;

/* The kernel set of that name ("ref", "v1" .. "v4"; NULL or "auto": the best that this processor has),
   exact or fast (where no fast form exists the exact one serves). NULL and an error for an unknown
   name or one that this processor lacks. */
const WrKernels *wr_kernels_get(const char *isa, bool fast, WrError *err);
