/* zbuffer_letters.h - bodies cut out along outlines, with a rounded or slanted upper edge: letters in three
   dimensions.
   Private to this module.

   A body stands on the plane w = 0 and rises to w = depth over all places (p, q) inside its outlines by the
   nonzero rule, however they cross. Within `bevel` of the outline it is lower: at distance d by
   bevel - sqrt(bevel^2 - (bevel - d)^2) (round) or bevel - d (chamfer). The distance is the true one to the
   nearest outline, so thin strokes get a ridge and nothing ever folds over. */
#pragma once
#include "base/enum_rows.h"

#include <stdbool.h>

typedef struct WrError WrError;

#define WR_Z_BEVELS(X) X(WR_Z_BEVEL_ROUND, "round") X(WR_Z_BEVEL_CHAMFER, "chamfer")
typedef enum WrZBevel { WR_Z_BEVELS(WR_WORD_ID) } WrZBevel;

typedef struct WrZContour {
    const double *points; /* [count][2]: p to the right, q up; closed by itself */
    int count;
} WrZContour;

typedef struct WrZLetters WrZLetters;

/* Contours are copied; lengths in the outlines' own unit. 0 <= bevel <= depth, depth > 0. NULL and an error
 * where no outline has an area, numbers are not finite, or there is no memory. The caller owns it. */
WrZLetters *wr_zletters_new(const WrZContour *contours, int count, double depth, double bevel,
                            WrZBevel kind, WrError *err);
void wr_zletters_free(WrZLetters *letters); /* NULL is fine */

/* The smallest box about it: p, q, w of the lower corner and of the upper one. */
void wr_zletters_box(const WrZLetters *letters, double low[3], double high[3]);

/* The distance from (p, q) to the nearest outline, above 0 inside, below 0 outside; exact near the
 * outlines, and farther away a bound on the safe side: never larger in size than the true distance, but at
 * least the bevel. */
double wr_zletters_distance(const WrZLetters *letters, double p, double q);

/* The largest t for which a + b t is inside the body; false where there is none. Exact to 1e-6 of a unit
 * along the line, better than 1e-12 where it runs along w. */
bool wr_zletters_meet(const WrZLetters *letters, const double a[3], const double b[3], double *t);
/* Whether no point of the line a + b t is within `reach` of the body; false may mean anything. */
bool wr_zletters_clear(const WrZLetters *letters, const double a[3], const double b[3],
                       double reach);
