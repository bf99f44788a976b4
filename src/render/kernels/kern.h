/* kern.h - the span kernels of the renderer: each is a short loop over up to WR_SPAN samples held as a
   structure of arrays, so that everything stays in the first-level cache and compilers vectorise it.
   Layer 5. The bodies (kern_body.h) are compiled once for each instruction set; `exact` sets give the
   same bits on every processor, `fast` sets may contract and reorder within a stated bound.

   All lengths here are scaled by a power of two so that the object's radius is near 1; positions are in
   object space: lights and eye are turned into it once a frame, so that no normal is ever rotated. */
#pragma once
#include "field/scheme.h"
#include "scene/tone_mapping.h"
#include "shade/bump_mode.h"
#include "shade/solid_texture.h"
#include "shade/reflection.h"
#include "shade/environment_map.h"
#include "shade/textured_reflection.h"
#include "surface/surface.h"

#include <stdbool.h>
#include <stdint.h>

#define WR_SPAN 256 /* samples in a strip */

#define WR_APRON 4      /* texels around the contiguous copies */
#define WR_TAPS_MOST 16 /* look-ups along a footprint's longer side */

typedef struct WrPyramid WrPyramid; /* slope_pyramid.h */

/* The colour picture, RGBA float with an apron of one texel. */
typedef struct WrColourLook {
    const float *rgba;
    int pitch; /* texels a row */
    int width, height;
    double ru, rv;
    bool periodic_u, periodic_v;
} WrColourLook;

/* A mesh as kernels look its triangles up. */
typedef struct WrTriangleLook {
    const float *corners;     /* 8 each: place, normal, u, v (triangle_raster.h) */
    const int32_t *triangles; /* 3 corners each */
    double scale;             /* its places -> kernel units; a power of two */
    const float *patches;     /* 56 each, as WrPatch (patches.h); NULL: a mesh of triangles */
    const int32_t *patch_of;  /* of each triangle */
    double scale_u, scale_v;  /* cells -> the table's u, v */
} WrTriangleLook;

/* How far Newton's method goes. */
typedef struct WrNewton {
    float reach_u, reach_v;   /* longest step */
    float enough_u, enough_v; /* a step shorter than both is the last; 0: none is */
    /* A step during which Pu or Pv changes by no more than the `last` part of itself is the last, and P follows it
       along them; 0: none is. By |Puu|, |Puv|, |Pvv| at most. */
    float uu, uv, vv, last;
    bool closed_u, closed_v; /* the parameter goes round */
    int steps;               /* at most */
} WrNewton;
typedef WrNewton WrNewtond;

/* What a triangle interpolates: base + l1 d1 + l2 d2, of its second and third corner's shares l1, l2. */
typedef struct WrPlane {
    float base, d1, d2;
} WrPlane;

/* A triangle over the samples x0 <= x < x1, y0 <= y < y1 of a tile, so small that its edges are 32-bit numbers: a
   sample is in it where none of the three is negative. */
typedef struct WrWalk {
    int32_t at[3], step_x[3], step_y[3]; /* 1/256 sample squared: at (x0, y0), and a sample on */
    float inv;                           /* 1 / twice the area */
    bool perspective;                    /* u and v are divided by depth */
    WrPlane close, u, v;
    int x0, y0, x1, y1;
    int pitch; /* samples a row of the tile */
} WrWalk;

#define WR_WALK_PAD 16 /* samples past a tile's end that `cover` may write back as they were */

/* How facets are roughened by slopes that spread inside a pixel: not, by their whole covariance, by its mean. */
typedef enum WrReflectSpread {
    WR_REFLECT_AS_IT_IS,
    WR_REFLECT_LEAN,
    WR_REFLECT_ROUND,
    WR_REFLECT_FACING, /* not; all n' are seen from their front */
    WR_REFLECT_DULL    /* and no highlight is as bright as `least` */
} WrReflectSpread;

#define WR_FACED_FROM 2e-3 /* n'.v from which nothing is bent: reflect_seen bends below 1e-3 */

/* What a strip's samples see of a lamp. */
typedef enum WrSeen {
    WR_SEEN_WHOLE, /* all of it, everywhere */
    WR_SEEN_PART,
    WR_SEEN_NOT /* nothing, anywhere */
} WrSeen;

/* Terms of an albedo, and 0 after them: whole vectors. */
#define WR_TEXTURED_REFLECTION_TERMS 12
_Static_assert(WR_TEXTURED_REFLECTION_TERMS >= WR_ALBEDO_TERMS, "all terms");

/* Surroundings blurred by one width, as WrKernMirror has them. */
typedef struct WrKernRung {
    const float *rgba;
    int pitch, width, height;
} WrKernRung;

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

/* The kernel set of that name ("ref", "v1" .. "v4"; NULL or "auto": the best that this processor has),
   exact or fast (where no fast form exists the exact one serves). NULL and an error for an unknown
   name or one that this processor lacks. */
const WrKernels *wr_kernels_get(const char *isa, bool fast, WrError *err);
/* The same in double precision; always exact. */
const WrKernelsd *wr_kernels_double(const char *isa, WrError *err);
