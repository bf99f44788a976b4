/* occlusion_lattice.h - the lines that occlusion.c and occlusion_near.c look along.
   Private to this module. */
#pragma once
#include "field/occlusion.h"
#include "field/occlusion_kern.h"

#include <stdbool.h>

/* A direction and its opposite: of the two the one that goes to larger numbers of its own axis. */
typedef struct WrSkyCourse {
    bool upright; /* its own axis is j, else i */
    int q, p;     /* after q texels of it, 1, 2 or 4, the line has moved by p of the other */
    int k;        /* which direction it is, of all */
    double step;  /* scene units from one texel of the own axis to the next */
    WrSkyShare share;
} WrSkyCourse;

/* Of pair 0 .. directions / 2 - 1. */
WrSkyCourse wr_sky_course(const WrOcclusion *occlusion, int pair);

/* occlusion_near.c: with a reach. kinds as in occlusion.h; k < 0: occlusion. */
bool wr_sky_near(const WrOcclusion *occlusion, const WrMapPart *part, int k, const float *p,
                 const float *q, WrPool *pool, float *out, WrError *err);
