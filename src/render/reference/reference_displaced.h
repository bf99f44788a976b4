/* reference_displaced.h - where a ray meets a displaced surface P + F n, for the reference: cells of about a texel with boxes
   about what they map to, a pyramid of those, and Newton's method in the cells that the ray enters. No facets.
   Layer 5, private to the reference.

   Where the domain ends two sheets may part: at edges of a cube, at a seam that F does not close. There the surface goes on
   straight, from E + F n to the place that is nearest to both planes that E was moved to; at a cube's corners to the place
   on all three. */
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
    const void *ctx;       /* borrowed: of height */
    WrRaisedSheet *sheets; /* [count], owned; count 0: the surface is not displaced */
    int count;
    double size; /* of the object with its relief, its units */
} WrReferenceRaised;

#define WR_RAISED_MOST 0x400000 /* cells */

/* cells: so many to the whole of u and of v let F have no more than one bend in each. Errors: more cells than
 * WR_RAISED_MOST; no memory. Call fini even then. */
bool wr_reference_raised_init(WrReferenceRaised *raised, const WrShape *shape,
                              WrReferenceHeight *height, const void *ctx, const double cells[2],
                              WrPool *pool, WrError *err);
void wr_reference_raised_fini(WrReferenceRaised *raised); /* fine on a zeroed one */
/* The nearest point beyond s_min: fills s, u, v, face and lost. */
bool wr_reference_raised_hit(const WrReferenceRaised *raised, const WrReferenceRay *ray,
                             WrReferenceHit *hit);
