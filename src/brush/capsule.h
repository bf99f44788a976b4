/* capsule.h - the footprint of one straight motion of the round brush: a disc drawn along a segment.
   Private to this module. In texel coordinates: x to the right, y down, texel (i, j)'s centre at
   x = i, y = j; not wrapped. */
#pragma once
#include <stdbool.h>

typedef struct WrBrush WrBrush;

typedef struct WrCapsule {
    double x, y;             /* where the motion starts */
    double dx, dy;           /* where it goes; both 0: a dab */
    double pressure, growth; /* at the start; end minus start */
    double radius, inner;    /* 0 < inner < radius */
    double radius2, inner2;  /* their squares */
    double inverse_length2;  /* 1/(dx^2 + dy^2); 0 for a dab */
    double inverse_edge;     /* 1/(radius - inner) */
    float most;              /* coverage within the inner radius, of a dab */
} WrCapsule;

/* The brush must be one that wr_brush_sane returned, and not thin. */
WrCapsule wr_capsule(const WrBrush *brush, double x, double y, double dx, double dy,
                     double pressure_start, double pressure_end);

/* The columns *low .. *high outside of which the capsule does not reach on row y, a little wide and not
 * rounded; false if it misses the row. */
bool wr_capsule_span(const WrCapsule *capsule, double y, double *low, double *high);
