/* dab_spacing.h - dabs at equal steps along the path: the round brush and tips.
   Private to this module.
   Dab k + 1 lies `spacing` radii of dab k farther along the path's length; so how the path was cut into
   samples changes places by rounding only. What is random goes by the seed and the dab's number. */
#pragma once
#include "brush/brush.h"
#include "brush/dab.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrSpaced {
    const WrBrush *brush; /* sane; borrowed */
    const WrField *field; /* for its size; borrowed */
    bool begun;           /* `from` is there */
    WrDab from, to; /* the ends of the present piece of the path: x, y, and pressure as alpha */
    double length, done; /* of the piece; how far along it the last dab lies, negative: before it */
    double step;         /* from the last dab to the next */
    uint64_t number;     /* of the next dab */
    double last_x, last_y; /* the last dab's place on the path */
    bool holds;            /* the first dab waits for a direction: of the second, */
    bool waits;            /* which then waits for the first to be drawn */
    double first_pressure;
    WrDab first, second;
} WrSpaced;

/* Take the next point of the path; wr_spaced_next must have returned false since the one before. Texels,
 * not wrapped; pressure 0..1. */
void wr_spaced_push(WrSpaced *spaced, double x, double y, double pressure);
/* The next dab up to that point; false if there is none. */
bool wr_spaced_next(WrSpaced *spaced, WrDab *dab);
/* The path is over: a first dab that still waits. */
bool wr_spaced_last(WrSpaced *spaced, WrDab *dab);
