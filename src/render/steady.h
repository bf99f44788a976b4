/* steady.h - n' and P of the samples of a resting view, so that a change of light or material alone works out light
   alone (E76). They are noted when such a change comes for the first time: a view that turns, or that an edit reaches,
   never pays for it. n' is unit, P in kernel units (view.h): both as light finds them, before an object is stretched.
   Layer 5, private to the renderer. */
#pragma once
#include "render/plan.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrKernels WrKernels;

/* What a frame does with it. */
typedef enum WrSteadyUse {
    WR_STEADY_NONE, /* nothing */
    WR_STEADY_NOTE, /* it is filled */
    WR_STEADY_KNOWN /* it is used */
} WrSteadyUse;

/* What a frame shows but for its light. */
typedef struct WrSteadyView {
    const WrScene *scene; /* one object */
    const WrPlan *plan;
    const WrKernels *kernels;
    double turn_deg;
    int width, height; /* pixels */
    uint64_t field;    /* the table's key (wr_field_key) */
} WrSteadyView;

#define WR_STEADY_BLOCK 64 /* samples beside each other */

/* Zero-initialise; fini frees. */
typedef struct WrSteady {
    WrSteadyView view; /* of the last frame that it suits; scene NULL: there was none */
    WrScene *scene;    /* that view's, shared */
    WrPlan plan;       /* likewise */
    float *normals,
        *points; /* [height][width][3], while they are noted; n' 0,0,0: nothing is seen. Owned */
    /* Afterwards, once whole: n' and P, [height][blocks of a row][6][WR_STEADY_BLOCK], so that a row of a tile is read in
       one piece; and where there is one, [height][width], 0 or 1. Owned */
    float *numbers;
    unsigned char *there;
    bool whole;      /* each sample was noted */
    WrSteadyUse use; /* of the frame at hand */
} WrSteady;

/* The six numbers of the sample at x, y: WR_STEADY_BLOCK apart; of those beside it up to the next multiple of that. */
static inline const float *wr_steady_at(const WrSteady *steady, int x, int y)
{
    const int blocks = (steady->view.width + WR_STEADY_BLOCK - 1) / WR_STEADY_BLOCK;
    const size_t block = (size_t)y * (size_t)blocks + (size_t)(x / WR_STEADY_BLOCK);
    return steady->numbers + block * 6 * WR_STEADY_BLOCK + x % WR_STEADY_BLOCK;
}

void wr_steady_fini(WrSteady *steady);
/* Can light alone be worked out of n' and P, one sample a pixel? */
bool wr_steady_suits(const WrScene *scene, const WrPlan *plan);
/* The use of it to a frame that it suits and that draws every tile: known where it differs from the last one in light
   at most, noted where it does so for the first time. Without memory there is none. */
WrSteadyUse wr_steady_bring(WrSteady *steady, const WrSteadyView *view);
/* All was noted, of so many samples that were seen. A normal of 0,0,0 among them is told from nothing by their number:
   then it is not whole. */
void wr_steady_noted(WrSteady *steady, int64_t samples);
