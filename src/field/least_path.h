/* least_path.h - minimum error boundary cut through the overlap of two tables.
   Source: A. A. Efros, W. T. Freeman, Image quilting for texture synthesis and transfer, 2001. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;

/* An overlap of `lines` lines, `width` texels wide. */
typedef struct WrOverlap {
    int width, lines;
    bool
        ring; /* the last line is the first one's neighbour: the path returns beside its beginning */
    double (*mismatch)(const void *ctx, int along, int line); /* squared difference at a texel */
    const void *ctx;
} WrOverlap;

/* path[lines]: 1..width - 1, at most one texel from line to line, with the least sum of mismatches. width: 2 or
 * more. Errors: out of memory. */
bool wr_least_path(const WrOverlap *overlap, int *path, WrError *err);
