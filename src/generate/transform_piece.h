/* transform_piece.h - a piece of a table put elsewhere: moved, turned, scaled, mirrored, round the edges of periodic axes.

   Lengths are texels, with texel (i, j) from i to i + 1 and rows running down. A point p of the source goes to
   at + A (p - from), A = turn * scale; the piece is what lies in the window. Where the table is periodic, so is what is
   put there: of the images of the piece that reach a texel, the one that says most there counts, the nearest of equals.

   A piece that is neither scaled nor turned by other than quarter turns is brought to whole texels, and every texel
   has the bits of the one that comes there. */
#pragma once
#include "base/enum_rows.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrGenerateJob WrGenerateJob;
typedef struct WrNormalMips WrNormalMips;

/* How it is read between texels; where it shrinks, the filter widens. */
#define WR_PLACE_FILTERS(X)                                                                        \
    X(WR_PLACE_NEAREST, "nearest")                                                                 \
    X(WR_PLACE_LINEAR, "linear")                                                                   \
    X(WR_PLACE_CATMULL, "catmull")
typedef enum WrPlaceFilter { WR_PLACE_FILTERS(WR_WORD_ID) } WrPlaceFilter;
extern const char *const wr_place_filters[];

#define WR_PLACE_SCALE 64.0 /* at most, and one over it at least */

typedef struct WrPlacing {
    const WrField
        *heights; /* the source; its wraps say what lies beyond its edges: again, or the edge */
    const WrField *weight; /* of its size, 0..1; NULL: 1 */
    double window[4];      /* of the source: left, top, width, height; may go over periodic edges */
    double from[2], at[2];
    double scale[2]; /* below 0: mirrored */
    double turn_deg; /* anticlockwise as seen */
    WrPlaceFilter filter;
} WrPlacing;

/* The piece on a table like job->like: heights, and how much it covers. */
bool wr_place(const WrPlacing *placing, const WrGenerateJob *job, WrNormalMips *out, WrError *err);
