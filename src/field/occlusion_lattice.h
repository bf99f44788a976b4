/* occlusion_lattice.h - search directions of occlusion.c and occlusion_near.c.
   Private to this module. */
#pragma once
#include "field/occlusion.h"
#include "field/occlusion_kern.h"

#include <stdbool.h>

/* A direction and its opposite: the one of the two with rising coordinates of its main axis. */
typedef struct WrSkyCourse {
    bool upright; /* the main axis is j, else i */
    int q, p;     /* after q texels of it, 1, 2 or 4, the line has moved by p of the other */
    int k;        /* index of the direction */
    double step;  /* scene units from one texel of the main axis to the next */
    WrSkyShare share;
} WrSkyCourse;

/* pair: 0 .. directions / 2 - 1. */
WrSkyCourse wr_sky_course(const WrOcclusion *occlusion, int pair);

/* occlusion_near.c: the search with a reach. k as in occlusion.h; k < 0: occlusion. */
bool wr_sky_near(const WrOcclusion *occlusion, const WrMapPart *part, int k, const float *p,
                 const float *q, WrPool *pool, float *out, WrError *err);
