/* transform_piece.h - transformation of a piece of a table: moved, rotated, scaled, mirrored, across
   periodic edges.

   Lengths are in texels, with texel (i, j) from i to i + 1 and rows running down. A point p of the
   source maps to at + A (p - from), A = turn * scale; the piece is the content of the window. On a
   periodic table the result is periodic: of the images of the piece that reach a texel, the one with
   the largest weight there wins, the nearest of equals. A piece without scaling and rotation except
   quarter turns is aligned to whole texels, and texels are copied bit for bit. */
#pragma once
#include "base/enum_rows.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrGenerateJob WrGenerateJob;
typedef struct WrRelief WrRelief;

/* Interpolation between texels; when shrinking, the filter is widened. */
#define WR_PLACE_FILTERS(X)                                                                        \
    X(WR_PLACE_NEAREST, "nearest")                                                                 \
    X(WR_PLACE_LINEAR, "linear")                                                                   \
    X(WR_PLACE_CATMULL, "catmull")
typedef enum WrPlaceFilter { WR_PLACE_FILTERS(WR_WORD_ID) } WrPlaceFilter;
extern const char *const wr_place_filters[];

#define WR_PLACE_SCALE 64.0 /* maximum; the minimum is its reciprocal */

typedef struct WrPlacing {
    const WrField
        *heights; /* the source; its wraps define the content beyond its edges: repeated, or the
                     edge texel */
    const WrField *weight; /* of its size, 0..1; NULL: 1 */
    double window[4];      /* of the source: left, top, width, height; may extend across periodic
                              edges */
    double from[2], at[2];
    double scale[2]; /* negative: mirrored */
    double turn_deg; /* anticlockwise as seen */
    WrPlaceFilter filter;
} WrPlacing;

/* The piece on a table like job->like: heights and coverage. */
bool wr_transform_piece(const WrPlacing *placing, const WrGenerateJob *job, WrRelief *out,
                        WrError *err);
