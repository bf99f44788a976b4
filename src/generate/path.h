/* path.h - smooth curves through points, by arc length: for text and solids on a path.
   Private to this module. */
#pragma once
#include "base/array.h"

#include <stdbool.h>

typedef struct WrError WrError;

/* A position and the direction there; texels, y down. */
typedef struct WrStand {
    double x, y, cosine, sine; /* sine > 0: uphill as seen */
} WrStand;

/* A curve as a polyline. Zeroed is empty. */
typedef struct WrPath {
    WR_ARRAY(double) xy;     /* texels, y down */
    WR_ARRAY(double) length; /* from the start to each point */
} WrPath;

/* The Catmull-Rom curve through points [count][2] (u, v) of a table of that size; closed: back to the
 * first one, else it continues straight beyond its ends. Errors: fewer than two different places */
bool wr_path_make(WrPath *path, const double *points, int count, bool closed, double width,
                  double height, WrError *err);
void wr_path_fini(WrPath *path);
double wr_path_length(const WrPath *path);
/* At arc length s from the start. */
WrStand wr_path_at(const WrPath *path, double s);
