/* reference_displacement_change.h - what displacement changes at a place of the surface: where it is seen, and its light.
   Layer 5. Beside what bump mapping shows of the same u and v, in double, without shadows. */
#pragma once
#include "render/reference/reference.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrPool WrPool;

typedef struct WrMoved {
    int64_t places;            /* pixels whose centre meets the displaced surface */
    double way_mean, way_most; /* pixels between where P and P + F n are seen */
    double
        light_rms; /* linear intensity: of P + F n by its own normal less that of P by the bump mode's */
} WrMoved;

/* Of the scene's objects that are displaced; others do not count, nor do they hide any. Errors: those of a reference. */
bool wr_reference_moved(const WrReferenceRequest *request, WrPool *pool, WrMoved *out,
                        WrError *err);
