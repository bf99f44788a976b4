/* dice_internal.h - what the files of dice.h share: cells and their corners.
   Layer 5, private to dice.c and its brothers. */
#pragma once
#include "render/tessellation/dice.h"
#include "render/visibility/view.h"
#include "surface/surface.h"

#define WR_DICE_SIDE 16       /* steps along a cell, at most, at which F is measured */
#define WR_DICE_MOST_CUTS 256 /* of a cell's side */

/* A cell of a face: what it asks for, how it is cut. */
typedef struct WrDiceCell {
    int32_t face, i, j;    /* its place among the face's */
    int steps_u, steps_v;  /* at which F was measured */
    double pixels;         /* a unit of the object is so many at its nearest; 0: it is not seen */
    double bend_u, bend_v; /* how far one straight step over it is off the base's curve, units */
    double kink_u, kink_v; /* largest second difference of F between the steps */
    double twist, range;   /* of F within a step; over the cell */
    int32_t corner, triangle; /* its first ones */
    int nu, nv, edge[4];      /* columns, rows; of its lower, upper, left and right edge */
} WrDiceCell;

/* A face's lines, and what their corners ask for. */
typedef struct WrDiceFace {
    double *u, *v; /* [nu + 1], [nv + 1], owned */
    int nu, nv, first;
    bool aligned; /* lines, and the steps between, lie on texels */
    double *rate; /* [(nv + 1)(nu + 1)][2]: steps along the whole of u and of v; owned */
} WrDiceFace;

typedef struct WrDicing {
    const WrScene *scene;
    const WrField *field;
    const WrView *view;
    double epsilon, size; /* pixels; the base's radius */
    bool straight;        /* F is bilinear between texels */
    WrDiceFace face[WR_DICE_FACES];
    WrDiceCell *cells; /* [cell_count], owned */
    int faces, cell_count;
    WrTriangleCorner *corners;
    WrTriangle *triangles;
    float *height; /* [corners]: F there */
    int64_t corner_count, triangle_count;
} WrDicing;

/* A point where the domain ends: which, and where it should go: f along n. */
typedef struct WrDicePoint {
    int64_t key[3]; /* where it was */
    int32_t index;
    WrVec3 p, n;
    double f;
} WrDicePoint;

WrDicePoint wr_dice_point(int32_t index, const WrSurfacePoint *at, double f, double size);
/* Points of one place become neighbours. */
void wr_dice_sort(WrDicePoint *points, int32_t count);
/* One past the last that is at the place of `from`. */
int32_t wr_dice_run(const WrDicePoint *points, int32_t from, int32_t count);
/* How far a place moves that these share: to where it is nearest to all their planes. */
WrVec3 wr_dice_move(const WrDicePoint *points, int32_t count);

/* ---- dice_cells.c ---- */

/* Lines and cells of all faces, and what those ask for. */
void wr_dice_lay(WrDicing *d, WrPool *pool);
/* How all of them are cut for d->epsilon; corner_count and triangle_count are known then. */
void wr_dice_choose(WrDicing *d);
