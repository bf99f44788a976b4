/* solid.h - the relief as a closed body of triangles, in millimetres, for printing and milling.
   Layer 6. Private to this room.

   A point of the relief is P + F n of the scene's surface, stretched as the object is, times millimetres a unit.
   The domain of (u,v) is cut into squares, each into two right triangles; a triangle from which a sample lies too
   far is halved at its longest side, together with the triangle beyond that side, so that no edge ever has a point of
   another triangle within it. Sides of the domain that are one curve in space (a seam, an edge of a cube) have one
   set of points, and a side that is one point (a pole) has one: what closes in space is closed.

   Samples are all texels' centres, and where a table is coarse places between: no texel's own height is left out.
   How far one is off is its distance from the triangle that stands for it, corners rounded to the file's 32-bit floats. */
#pragma once
#include "base/array.h"
#include "surface/surface.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrExportJob WrExportJob;
typedef struct WrField WrField;
typedef struct WrPool WrPool;
typedef struct WrScene WrScene;

#define WR_SOLID_FACES 6
#define WR_SOLID_MOST                                                                              \
    4000000 /* triangles of the relief; with its back no more than a reader takes */
#define WR_SOLID_SAMPLES ((int64_t)1 << 28) /* at most */

/* A place of the domain at which a point is seen: of a seam there are two, of a pole many. */
typedef struct WrSolidSight {
    double u, v;
    int32_t face;
} WrSolidSight;

typedef struct WrSolidTriangle {
    int32_t point
        [3]; /* against the clock from outside; the side from 0 to 1 is the next to be halved */
    int32_t
        across[3]; /* the triangle beyond the side that lies opposite corner k; -1: there is none */
    int32_t face;
    float error; /* mm: largest distance of its samples; below 0: not measured */
    double u[3], v[3];
} WrSolidTriangle;

/* Samples of one face: i, j stand for u = (first_u + i + 1/2) step_u, v likewise. */
typedef struct WrSolidLattice {
    double first_u, first_v, step_u, step_v;
    int count_u, count_v;
    float (*at)[3]; /* [count_v][count_u], mm; owned */
} WrSolidLattice;

typedef struct WrSolid {
    const WrScene *scene;
    const WrField *field;
    WrPool *pool;
    double size;       /* mm: longest side of the smooth surface */
    double true_width; /* mm: its width instead; 0: that side */
    double error;      /* mm asked for */
    double thickness;  /* mm under the lowest sample; 0: filled, open ends closed flat */
    WrVec3 stretch, cofactor, middle; /* a point is (stretch P - middle) scale */
    double scale;                     /* mm a unit of the object */
    int faces;
    WrSolidLattice lattice[WR_SOLID_FACES];
    double low, high; /* of F over the samples and points, object units */
    WR_ARRAY(WrSolidTriangle) relief;
    WR_ARRAY(WrSolidSight) sights; /* of all points, in their order */
    WR_ARRAY(int32_t) first;       /* of each point's sights */
    float (*points)[3];            /* mm; owned */
    int32_t point_count, point_room;
    int32_t (*triangles)[3]; /* of the closed body; owned */
    int32_t triangle_count, triangle_room;
    double worst; /* mm: the largest error of all */
} WrSolid;

/* solid.c */
/* A point of the file: where the sights meet. With `back` at the lowest height, and `thickness` under that. */
void wr_solid_place(WrSolid *solid, const WrSolidSight *sights, int count, bool back, float out[3]);
/* A new point that is seen there; its number. */
int32_t wr_solid_add_point(WrSolid *solid, const WrSolidSight *sights, int count);
int32_t wr_solid_add_bare(WrSolid *solid, const float at[3]); /* one that is seen nowhere */
void wr_solid_add_triangle(WrSolid *solid, int32_t a, int32_t b, int32_t c);

/* solid_base.c: the squares, and what closes in space. */
void wr_solid_lay(WrSolid *solid);
/* solid_samples.c: places and heights of all samples. */
bool wr_solid_measure(WrSolid *solid, WrError *err);
/* solid_refine.c: triangles are halved until no sample is off by more than `error`. */
bool wr_solid_refine(WrSolid *solid, WrError *err);
/* solid_close.c: the relief, its back, and walls between them. */
bool wr_solid_close(WrSolid *solid, WrError *err);
/* mm3; above 0 where sides face outwards. */
double wr_solid_volume(const WrSolid *solid);
