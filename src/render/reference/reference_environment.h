/* reference_environment.h - environment light for the reference: a lamp's formulas integrated over all
   directions. Private to the reference. Uses its own fetch and none of the renderer's kernels, harmonics or
   lobes. */
#pragma once
#include "base/vec.h"
#include "shade/reflection.h"

typedef struct WrScene WrScene;
typedef struct WrReferenceStage WrReferenceStage;

/* A part of the sphere, as one lamp: the mean direction of its light, and that light times its solid angle over
   pi. */
typedef struct WrReferenceSector {
    WrVec3 where; /* the object's axes; unit */
    double rgb[3];
} WrReferenceSector;

/* The part of an integral over directions that one sample computes, standing for all. The samples of a pixel
   take different parts, so that together they cover each several times. */
typedef struct WrReferenceShare {
    int part, of; /* 0 <= part < of; of 1: all */
} WrReferenceShare;

/* directions of facets along each axis, over which highlights are summed */
#define WR_REFERENCE_FACETS 48

typedef struct WrReferenceSurround {
    WrReferenceSector *sectors; /* [count], owned; NULL: no environment */
    int count;
    double rotation[9];
    double turn[2];                        /* cosine and sine of the user's turn */
    double around[WR_REFERENCE_FACETS][2]; /* rotations of facets about the normal */
} WrReferenceSurround;

/* Prepares the environment. rotation: the object's axes -> the world. */
void wr_reference_surround_init(WrReferenceSurround *surround, const WrScene *scene,
                                const double rotation[9]);
void wr_reference_surround_fini(WrReferenceSurround *surround);
/* Adds the environment's light: `own` is multiplied by the surface's colour, `white` by none. is: the material
   there; n: facing the viewer; colour: as in wr_reference_reflect. */
void wr_reference_surround_light(const WrReferenceStage *stage, const WrMatter *is, WrVec3 n,
                                 WrVec3 v, const double colour[3], WrReferenceShare share,
                                 double own[3], double white[3]);
