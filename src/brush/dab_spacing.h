/* dab_spacing.h - dabs at equal distances along the path: the round brush and tips.
   Private to this module.
   Dab k + 1 is `spacing` radii of dab k farther along the path's length; so the division of the path
   into samples changes positions only by rounding. Random values depend on the seed and the dab's
   number. */
#pragma once
#include "brush/brush.h"
#include "brush/dab.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrSpaced {
    const WrBrush *brush; /* sane; borrowed */
    const WrField *field; /* for its size; borrowed */
    bool begun;           /* `from` is valid */
    WrDab from, to; /* the ends of the present piece of the path: x, y, and pressure as alpha */
    double length, done; /* of the piece; position of the last dab along it, negative: before it */
    double step;         /* from the last dab to the next */
    uint64_t number;     /* of the next dab */
    double last_x, last_y; /* position of the last dab on the path */
    bool holds;            /* the first dab is held until the second defines a direction, */
    bool waits;            /* and the second until the first is drawn */
    double first_pressure;
    WrDab first, second;
} WrSpaced;

/* Adds the next point of the path; wr_spaced_next must have returned false since the previous one.
 * Texels, not wrapped; pressure 0..1. */
void wr_spaced_push(WrSpaced *spaced, double x, double y, double pressure);
/* The next dab up to that point; false if there is none. */
bool wr_spaced_next(WrSpaced *spaced, WrDab *dab);
/* At the end of the path: a first dab that is still held. */
bool wr_spaced_last(WrSpaced *spaced, WrDab *dab);
