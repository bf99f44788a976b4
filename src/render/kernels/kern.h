/* kern.h - span kernels of the renderer: short loops over up to WR_SPAN samples held as a structure of arrays.

   A strip fits in the first-level cache and its loops are vectorised by the compiler. The bodies (kern_body.h)
   are compiled once for each instruction set; `exact` sets give the same bits on every processor, `fast` sets
   may contract and reorder within a stated bound.

   All lengths here are scaled by a power of two so that the object's radius is near 1; positions are in object
   space: lights and eye are transformed into it once per frame, so that no normal is ever rotated. */
#pragma once
#include "field/scheme.h"
#include "scene/tone_mapping.h"
#include "shade/bump_mode.h"
#include "shade/solid_texture.h"
#include "shade/reflection.h"
#include "shade/environment_map.h"
#include "shade/svbrdf.h"
#include "surface/surface.h"

#include <stdbool.h>
#include <stdint.h>

#define WR_SPAN 256 /* samples in a strip */

#define WR_APRON 4     /* texels around the contiguous copies */
#define WR_TAPS_MAX 16 /* maximum fetches along a footprint's longer side */

typedef struct WrPyramid WrPyramid; /* slope_pyramid.h */

/* The colour picture, RGBA float with an apron of one texel. */
typedef struct WrColourLook {
    const float *rgba;
    int pitch; /* texels per row */
    int width, height;
    double ru, rv;
    bool periodic_u, periodic_v;
} WrColourLook;

/* A mesh in the form that kernels fetch triangles from. */
typedef struct WrTriangleLook {
    const float *corners;     /* 8 each: position, normal, u, v (raster.h) */
    const int32_t *triangles; /* 3 corners each */
    double scale;             /* its positions -> kernel units; a power of two */
    const float *patches;     /* 56 each, as WrPatch (patches.h); NULL: a mesh of triangles */
    const int32_t *patch_of;  /* of each triangle */
    double scale_u, scale_v;  /* cells -> the table's u, v */
    /* Relief on a mesh: the faces of each triangle; its u and v are weights of the face's corners 1 and 2. NULL: the
       triangles are the faces. */
    const int32_t *base_of, *base_triangles;
    const float *base_corners;
} WrTriangleLook;

/* Limits of Newton's method. */
typedef struct WrNewton {
    float reach_u, reach_v;   /* longest step */
    float enough_u, enough_v; /* a step shorter than both is the last; 0: no such test */
    /* A step is the last if Pu and Pv change by at most the part `last` of themselves; P then follows it along
       them. 0: no such test. uu, uv, vv: upper bounds of |Puu|, |Puv|, |Pvv|. */
    float uu, uv, vv, last;
    bool closed_u, closed_v; /* the parameter is periodic */
    int steps;               /* maximum */
} WrNewton;
typedef WrNewton WrNewtond;

/* A value interpolated over a triangle: base + l1 d1 + l2 d2, with l1, l2 the shares of the second and third
   corner. */
typedef struct WrPlane {
    float base, d1, d2;
} WrPlane;

/* A triangle over the samples x0 <= x < x1, y0 <= y < y1 of a tile, so small that its edge values fit in 32
   bits: a sample is inside if none of the three is negative. */
typedef struct WrWalk {
    /* 1/256 sample squared: at (x0, y0), and the step per sample */
    int32_t at[3], step_x[3], step_y[3];
    float inv;        /* 1 / twice the area */
    bool perspective; /* u and v are divided by depth */
    WrPlane close, u, v;
    int x0, y0, x1, y1;
    int pitch; /* samples per row of the tile */
} WrWalk;

#define WR_WALK_PAD 16 /* samples after a tile's end that `cover` may rewrite unchanged */

/* Roughening of microfacets by slopes that spread inside a pixel: none, by the whole covariance, or by its mean. */
typedef enum WrReflectSpread {
    WR_REFLECT_AS_IT_IS,
    WR_REFLECT_LEAN,
    WR_REFLECT_ROUND,
    WR_REFLECT_FACING, /* none; and every n' faces the viewer */
    WR_REFLECT_DULL    /* as FACING, and no highlight is as bright as `least` */
} WrReflectSpread;

#define WR_FACED_FROM 2e-3 /* n'.v above which no normal is bent: reflect_seen bends below 1e-3 */

/* Visibility of a lamp over a strip. */
typedef enum WrSeen {
    WR_SEEN_WHOLE, /* fully visible from every sample */
    WR_SEEN_PART,
    WR_SEEN_NOT /* visible from no sample */
} WrSeen;

/* Terms of an albedo, padded with 0 to whole vectors. */
#define WR_SVBRDF_TERMS 12
_Static_assert(WR_SVBRDF_TERMS >= WR_ALBEDO_TERMS, "all terms");

/* Environment blurred by one width, in the layout of WrKernMirror. */
typedef struct WrKernMipLevel {
    const float *rgba;
    int pitch, width, height;
} WrKernMipLevel;

#define REAL float
#define SHAPE WrShapef
#define WR_T(name) name
#include "render/kernels/kern_types_body.h"
#undef REAL
#undef SHAPE
#undef WR_T

#define REAL double
#define SHAPE WrShape
#define WR_T(name) name##d
#include "render/kernels/kern_types_body.h"
#undef REAL
#undef SHAPE
#undef WR_T

/* The kernel set of that name ("ref", "v1" .. "v4"; NULL or "auto": the best that this processor has), exact or
   fast (where no fast form exists, the exact one is used). NULL and an error for an unknown name or one that
   this processor lacks. */
const WrKernels *wr_kernels_get(const char *isa, bool fast, WrError *err);
/* The double-precision kernel set of that name, as wr_kernels_get; always exact. */
const WrKernelsd *wr_kernels_double(const char *isa, WrError *err);

/* The compiled sets; kern.c chooses among them. */
extern const WrKernels wr_kern_ref, wr_kern_v1, wr_kern_v2, wr_kern_v3, wr_kern_v4;
extern const WrKernels wr_kern_fast_v3, wr_kern_fast_v4;
extern const WrKernelsd wr_kern_double_ref, wr_kern_double_v1, wr_kern_double_v3, wr_kern_double_v4;
