/* reference_displaced.h - ray intersection with a displaced surface P + F n, for the reference. Private to the
   reference. Cells of about a texel with bounding boxes, a pyramid of those, and Newton's method in the cells
   that the ray enters. No facets.

   Where the domain ends two sheets may separate: at edges of a cube, at a seam across which F is not periodic.
   There the surface continues straight, from E + F n to the point nearest to both planes that E was displaced
   to; at a cube's corners to the point on all three. */
#pragma once
#include "render/reference/reference_patch.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrPool WrPool;

/* F and its derivatives by u and v of the patch. */
typedef void WrReferenceHeight(const void *ctx, double u, double v, double *f, double *fu,
                               double *fv);

typedef struct WrRaisedSheet WrRaisedSheet;
typedef struct WrReferenceRaised {
    const WrShape *shape; /* borrowed */
    WrReferenceHeight *height;
    const void *ctx;       /* borrowed: argument of height */
    WrRaisedSheet *sheets; /* [count], owned; count 0: the surface is not displaced */
    int count;
    double size; /* of the object with its relief, object units */
} WrReferenceRaised;

#define WR_RAISED_MAX 0x400000 /* cells */

/* Builds cells and boxes. cells: numbers over all of u and v for which F has at most one bend per cell. Errors:
   more cells than WR_RAISED_MAX; no memory. Call fini even then. */
bool wr_reference_raised_init(WrReferenceRaised *raised, const WrShape *shape,
                              WrReferenceHeight *height, const void *ctx, const double cells[2],
                              WrPool *pool, WrError *err);
void wr_reference_raised_fini(WrReferenceRaised *raised); /* also for a zeroed one */
/* Nearest hit beyond s_min: fills s, u, v, face and lost. */
bool wr_reference_raised_hit(const WrReferenceRaised *raised, const WrReferenceRay *ray,
                             WrReferenceHit *hit);
