/* capsule.h - the footprint of one straight motion of the round brush: a disc swept along a segment.
   Private to this module.
   In texel coordinates: x to the right, y down, texel (i, j)'s centre at x = i, y = j; not wrapped. */
#pragma once
#include <stdbool.h>

typedef struct WrBrush WrBrush;

typedef struct WrCapsule {
    double x, y;             /* start of the motion */
    double dx, dy;           /* vector of the motion; both 0: a dab */
    double pressure, growth; /* at the start; end minus start */
    double radius, inner;    /* 0 < inner < radius */
    double radius2, inner2;  /* their squares */
    double inverse_length2;  /* 1/(dx^2 + dy^2); 0 for a dab */
    double inverse_edge;     /* 1/(radius - inner) */
    float most;              /* coverage within the inner radius, for a dab */
} WrCapsule;

/* The brush must come from wr_brush_sane, and not be thin. */
WrCapsule wr_capsule(const WrBrush *brush, double x, double y, double dx, double dy,
                     double pressure_start, double pressure_end);

/* The column range *low .. *high of the capsule on row y, slightly enlarged and not rounded; false if
 * it misses the row. */
bool wr_capsule_span(const WrCapsule *capsule, double y, double *low, double *high);
