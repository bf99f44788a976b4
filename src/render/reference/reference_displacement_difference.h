/* reference_displacement_difference.h - difference between displacement and bump mapping: screen position and light
   of surface points. Both at the same u and v, in double, without shadows. */
#pragma once
#include "render/reference/reference.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrPool WrPool;

typedef struct WrMoved {
    int64_t places;            /* pixels whose centre shows the displaced surface */
    double way_mean, way_most; /* distance in pixels between the images of P and P + F n */
    /* linear intensity: P + F n with its own normal minus P with the bump mode's */
    double light_rms;
} WrMoved;

/* Measures the scene's displaced objects; others are ignored and hide nothing. Errors: as wr_reference_render. */
bool wr_reference_displacement_difference(const WrReferenceRequest *request, WrPool *pool,
                                          WrMoved *out, WrError *err);
