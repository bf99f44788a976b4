/* steady.h - n' and P of the samples of a resting view, and where pictures are looked up also u and v, so that a change of
   light or material alone works out light alone (E76). They are noted when such a change comes for the first time: a view
   that turns, or that an edit reaches, never pays for it. n' is unit, P in kernel units (view.h): both as light finds
   them, before an object is stretched. Of several objects each sample has the numbers of the one that it shows.
   Layer 5, private to the renderer. */
#pragma once
#include "render/plan.h"
#include "scene/objects.h"

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

/* What a frame shows of an object but for its light. */
typedef struct WrSteadyPart {
    const WrScene *scene; /* of the object alone */
    const WrPlan *plan;
    uint64_t field; /* the table's key (wr_field_key) */
    int object;     /* its place among the scene's */
} WrSteadyPart;

/* All that it shows. */
typedef struct WrSteadyView {
    const WrSteadyPart *parts; /* [count], above 0 */
    int count;
    const WrKernels *kernels;
    double turn_deg;
    int width, height; /* pixels */
} WrSteadyView;

#define WR_STEADY_BLOCK 64 /* samples beside each other */

/* Zero-initialise; fini frees. */
typedef struct WrSteady {
    /* Of the last frame that it suits; its parts are those below; count 0: there was none. */
    WrSteadyView view;
    WrSteadyPart *parts; /* [count], owned, with shares of their scenes and copies of their plans */
    float *normals,
        *points, /* [height][width][3], while they are noted; n' 0,0,0: nothing is seen. Owned */
        *uv;     /* [height][width][2], likewise; NULL: no picture is looked up */
    /* Afterwards, once whole: n', P, and u and v, [height][blocks of a row][each][WR_STEADY_BLOCK], so that a row of a tile
       is read in one piece. Owned */
    float *numbers;
    int each; /* numbers a sample: 6, or 8 */
    /* [height][width], noted: which object a sample shows, 1 + its place among the scene's; 0: nothing. Owned */
    unsigned char *owner;
    bool whole;      /* each sample was noted */
    WrSteadyUse use; /* of the frame at hand */
} WrSteady;

_Static_assert(WR_OBJECTS_MAX < 255, "an owner is a byte");

/* The numbers of the sample at x, y: WR_STEADY_BLOCK apart; of those beside it up to the next multiple of that. */
static inline const float *wr_steady_at(const WrSteady *steady, int x, int y)
{
    const int blocks = (steady->view.width + WR_STEADY_BLOCK - 1) / WR_STEADY_BLOCK;
    const size_t block = (size_t)y * (size_t)blocks + (size_t)(x / WR_STEADY_BLOCK);
    return steady->numbers + block * (size_t)steady->each * WR_STEADY_BLOCK + x % WR_STEADY_BLOCK;
}

void wr_steady_fini(WrSteady *steady);
/* Can light alone be worked out of n', P, u and v, one sample a pixel? */
bool wr_steady_suits(const WrScene *scene, const WrPlan *plan);
/* The use of it to a frame that it suits and that draws every tile: known where it differs from the last one in light
   at most, noted where it does so for the first time. Without memory there is none. */
WrSteadyUse wr_steady_bring(WrSteady *steady, const WrSteadyView *view);
/* All of one object was noted, so many samples that were seen. A normal of 0,0,0 among them is told from nothing by their
   number: then it is not whole. Of several objects `owner` was filled, and samples is -1. */
void wr_steady_noted(WrSteady *steady, int64_t samples);
