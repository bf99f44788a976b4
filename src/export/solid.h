/* solid.h - relief as a closed triangle mesh in millimetres, for 3D printing and milling. Private to this
   module.

   A point of the relief is P + F n of the scene's surface, stretched as the object is, times millimetres per
   unit. The domain of (u,v) is divided into squares, each into two right triangles. A triangle from which a
   sample is too far is bisected at its longest side, together with the triangle beyond that side, so that no
   edge ever has a vertex of another triangle inside it. Sides of the domain that are one curve in space (a seam,
   an edge of a cube) share one set of points, and a side that is a single point (a pole) has one: so the mesh is
   closed wherever the surface is.

   Samples are all texels' centres, and for a coarse table points between: every texel's own height is tested.
   The error of a sample is its distance from the triangle that represents it, with corners rounded to the file's
   32-bit floats. */
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
#define WR_SOLID_MAX                                                                               \
    4000000 /* maximum triangles of the relief; with its back no more than readers accept */
#define WR_SOLID_SAMPLES ((int64_t)1 << 28) /* maximum */

/* A position in the domain that maps to a point: a seam has two, a pole many. */
typedef struct WrSolidLocation {
    double u, v;
    int32_t face;
} WrSolidLocation;

typedef struct WrSolidTriangle {
    int32_t point
        [3]; /* anticlockwise from outside; the side from corner 0 to corner 1 is the next one to be bisected */
    int32_t across[3]; /* the triangle beyond the side opposite corner k; -1: none */
    int32_t face;
    float error; /* mm: largest distance of its samples; below 0: not measured */
    double u[3], v[3];
} WrSolidTriangle;

/* Samples of one face: i, j stand for u = (first_u + i + 1/2) step_u and v = (first_v + j + 1/2) step_v. */
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
    double true_width; /* mm: its width instead; 0: use size */
    double error;      /* requested error, mm */
    double thickness;  /* mm below the lowest sample; 0: filled, open ends closed flat */
    WrVec3 stretch, cofactor, middle; /* a point is (stretch P - middle) scale */
    double scale;                     /* mm per object unit */
    int faces;
    WrSolidLattice lattice[WR_SOLID_FACES];
    double low, high; /* of F over the samples and points, object units */
    WR_ARRAY(WrSolidTriangle) relief;
    WR_ARRAY(WrSolidLocation) locations; /* of all points, in their order */
    WR_ARRAY(int32_t) first;             /* index of each point's first sight */
    float (*points)[3];                  /* mm; owned */
    int32_t point_count, point_room;
    int32_t (*triangles)[3]; /* of the closed mesh; owned */
    /* (u,v) of their corners in cells: u and v times the number of repeats of the table; owned */
    float (*uv)[3][2];
    int32_t triangle_count, triangle_room;
    double worst; /* mm: the largest error of all */
} WrSolid;

/* solid.c */
/* Position of a point in the file, from its sights. With `back` at the lowest height, and `thickness` below
   that. */
void wr_solid_point_position(WrSolid *solid, const WrSolidLocation *locations, int count, bool back,
                             float out[3]);
/* Adds a point with these sights; returns its number. */
int32_t wr_solid_add_point(WrSolid *solid, const WrSolidLocation *locations, int count);
int32_t wr_solid_add_bare(WrSolid *solid, const float at[3]); /* a point without sights */
/* at: (u,v) of the corners. */
void wr_solid_add_triangle(WrSolid *solid, const int32_t corners[3], const WrSolidLocation at[3]);

/* Builds the squares and joins shared sides. */
void wr_solid_lay(WrSolid *solid);
/* Computes positions and heights of all samples. */
bool wr_solid_sample(WrSolid *solid, WrError *err);
/* Bisects triangles until every sample's error is at most `error`. */
bool wr_solid_refine(WrSolid *solid, WrError *err);
/* Adds the back, and walls between it and the relief. */
bool wr_solid_close(WrSolid *solid, WrError *err);
/* mm3; positive if sides face outwards. */
double wr_solid_volume(const WrSolid *solid);
