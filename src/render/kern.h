/* kern.h - the span kernels of the renderer: each is a short loop over up to WR_SPAN samples held as a
   structure of arrays, so that everything stays in the first-level cache and compilers vectorise it.
   Layer 5. The bodies (kern_body.h) are compiled once for each instruction set; `exact` sets give the
   same bits on every processor, `fast` sets may contract and reorder within a stated bound.

   All lengths here are scaled by a power of two so that the object's radius is near 1; positions are in
   object space: lights and eye are turned into it once a frame, so that no normal is ever rotated. */
#pragma once
#include "field/scheme.h"
#include "shade/bump_mode.h"
#include "surface/surface.h"

#include <stdbool.h>
#include <stdint.h>

#define WR_SPAN 256 /* samples in a strip */

#define WR_APRON 4      /* texels around the contiguous copies */
#define WR_TAPS_MOST 16 /* look-ups along a footprint's longer side */

typedef struct WrPyramid WrPyramid; /* pyramid.h */

/* The colour picture, RGBA float with an apron of one texel. */
typedef struct WrColourLook {
    const float *rgba;
    int pitch; /* texels a row */
    int width, height;
    double ru, rv;
    bool periodic_u, periodic_v;
} WrColourLook;

/* How far Newton's method goes. */
typedef struct WrNewton {
    float reach_u, reach_v;   /* longest step */
    float enough_u, enough_v; /* a step shorter than both is the last; 0: none is */
    bool closed_u, closed_v;  /* the parameter goes round */
    int steps;                /* at most */
} WrNewton;
typedef WrNewton WrNewtond;

#define REAL float
#define SHAPE WrShapef
#define WR_T(name) name
#include "render/kern_types_body.h"
#undef REAL
#undef SHAPE
#undef WR_T

#define REAL double
#define SHAPE WrShape
#define WR_T(name) name##d
#include "render/kern_types_body.h"
#undef REAL
#undef SHAPE
#undef WR_T

/* The kernel set of that name ("ref", "v1" .. "v4"; NULL or "auto": the best that this processor has),
   exact or fast (where no fast form exists the exact one serves). NULL and an error for an unknown
   name or one that this processor lacks. */
const WrKernels *wr_kernels_get(const char *isa, bool fast, WrError *err);
/* The same in double precision; always exact. */
const WrKernelsd *wr_kernels_double(const char *isa, WrError *err);
