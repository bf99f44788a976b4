/* reference_environment.h - light of surroundings for the reference: a lamp's formulas integrated over all directions, by its own
   look-up and without a kernel, harmonic or lobe of the renderer's.
   Layer 5, private to the reference. */
#pragma once
#include "base/vec.h"
#include "shade/reflection.h"

typedef struct WrScene WrScene;
typedef struct WrReferenceStage WrReferenceStage;

/* A part of the sphere, as one lamp: the mean direction of its light, and that light times its solid angle over pi. */
typedef struct WrReferenceSector {
    WrVec3 where; /* the object's axes; unit */
    double rgb[3];
} WrReferenceSector;

/* Which of the parts of an integral over directions a sample takes, in the place of all: where a pixel has many samples,
   each takes others, so that together they take all of them several times. */
typedef struct WrReferenceShare {
    int part, of; /* 0 <= part < of; of 1: all */
} WrReferenceShare;

#define WR_REFERENCE_FACETS 48 /* directions of facets each way: highlights are summed over them */

typedef struct WrReferenceSurround {
    WrReferenceSector *sectors; /* [count], owned; NULL: there are no surroundings */
    int count;
    double rotation[9];
    double turn[2];                        /* cosine and sine of the turn by hand */
    double around[WR_REFERENCE_FACETS][2]; /* of facets' turns about the normal */
} WrReferenceSurround;

/* rotation: the object's axes -> the world. */
void wr_reference_surround_init(WrReferenceSurround *surround, const WrScene *scene,
                                const double rotation[9]);
void wr_reference_surround_fini(WrReferenceSurround *surround);
/* What they add, is: the material there: in the surface's colour, and in their own. n towards the viewer's side; colour as wr_reference_reflect's. */
void wr_reference_surround_light(const WrReferenceStage *stage, const WrMatter *is, WrVec3 n,
                                 WrVec3 v, const double colour[3], WrReferenceShare share,
                                 double own[3], double white[3]);
