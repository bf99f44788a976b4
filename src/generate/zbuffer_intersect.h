/* zbuffer_intersect.h - intersections of a line a + b t with simple bodies.
   Private to the depth buffer. */
#pragma once
#include "base/enum_rows.h"

#include <math.h>
#include <stdbool.h>

typedef struct WrZSpan {
    double low, high; /* of t; empty where low > high */
} WrZSpan;

static inline WrZSpan wr_zspan_meet(WrZSpan a, WrZSpan b)
{
    return (WrZSpan){ a.low > b.low ? a.low : b.low, a.high < b.high ? a.high : b.high };
}

/* ---- extrusions ---- */

/* Extruded outlines with a rounded or chamfered upper edge: three-dimensional
   letters.

   A body rises from the plane w = 0 to w = depth over all positions (p, q) inside its outlines by the
   nonzero rule, also for crossing outlines. Within `bevel` of the outline it is lower: at distance d by
   bevel - sqrt(bevel^2 - (bevel - d)^2) (round) or bevel - d (chamfer). The distance is the true one to
   the nearest outline, so thin strokes get a ridge and nothing folds over. */

typedef struct WrError WrError;

#define WR_Z_BEVELS(X) X(WR_Z_BEVEL_ROUND, "round") X(WR_Z_BEVEL_CHAMFER, "chamfer")
typedef enum WrZBevel { WR_Z_BEVELS(WR_WORD_ID) } WrZBevel;

typedef struct WrZContour {
    const double *points; /* [count][2]: p to the right, q up; closed automatically */
    int count;
} WrZContour;

typedef struct WrZLetters WrZLetters;

/* Contours are copied; lengths in the outlines' own unit. 0 <= bevel <= depth, depth > 0. NULL and an
 * error if no outline has an area, numbers are not finite, or out of memory. The caller owns it. */
WrZLetters *wr_zletters_new(const WrZContour *contours, int count, double depth, double bevel,
                            WrZBevel kind, WrError *err);
void wr_zletters_free(WrZLetters *letters); /* NULL is allowed */

/* Its bounding box: p, q, w of the lower corner and of the upper one. */
void wr_zletters_box(const WrZLetters *letters, double low[3], double high[3]);

/* The distance from (p, q) to the nearest outline, positive inside, negative outside; exact near the
 * outlines, and farther away a conservative bound: its size is at most the true distance, but at least
 * the bevel. */
double wr_zletters_distance(const WrZLetters *letters, double p, double q);

/* The largest t for which a + b t is inside the body; false if none. Exact to 1e-6 of a unit along the
 * line, better than 1e-12 if the line is parallel to w. */
bool wr_zletters_meet(const WrZLetters *letters, const double a[3], const double b[3], double *t);
/* True if no point of the line a + b t is within `reach` of the body; false is inconclusive. */
bool wr_zletters_clear(const WrZLetters *letters, const double a[3], const double b[3],
                       double reach);
