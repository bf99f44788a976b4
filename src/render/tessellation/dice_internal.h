/* dice_internal.h - cells and corners shared by the files of dice.h.
   Private to the dice*.c files. */
#pragma once
#include "render/tessellation/dice.h"
#include "render/visibility/view.h"
#include "surface/surface.h"

#define WR_DICE_SIDE 16       /* largest number of steps along a cell at which F is measured */
#define WR_DICE_MOST_CUTS 256 /* largest number of cuts of a cell's side */

/* A cell of a face: its needs, and its cuts. */
typedef struct WrDiceCell {
    int32_t face, i, j;   /* position among the face's cells */
    int steps_u, steps_v; /* steps at which F was measured */
    double pixels;        /* pixels per object unit at its nearest point; 0: it is not visible */
    /* deviation of one straight step across it from the base's curve, units */
    double bend_u, bend_v;
    double kink_u, kink_v;    /* largest second difference of F between the steps */
    double twist, range;      /* of F within a step; over the cell */
    int32_t corner, triangle; /* index of its first corner and triangle */
    int nu, nv, edge[4];      /* columns, rows; cuts of its lower, upper, left and right edge */
} WrDiceCell;

/* A face's lines, and the rates at their corners. */
typedef struct WrDiceFace {
    double *u, *v; /* [nu + 1], [nv + 1], owned */
    int nu, nv, first;
    bool aligned; /* lines and the steps between them lie on texels */
    double *rate; /* [(nv + 1)(nu + 1)][2]: steps along all of u and all of v; owned */
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
    float *height; /* [corners]: F at each */
    int64_t corner_count, triangle_count;
} WrDicing;

/* A point on the border of the domain, with its displacement f along n. */
typedef struct WrDicePoint {
    int64_t key[3]; /* position before displacement */
    int32_t index;
    WrVec3 p, n;
    double f;
} WrDicePoint;

WrDicePoint wr_dice_point(int32_t index, const WrSurfacePoint *at, double f, double size);
/* Sorts points so that those at one position are neighbours. */
void wr_dice_sort(WrDicePoint *points, int32_t count);
/* One past the last point at the position of `from`. */
int32_t wr_dice_run(const WrDicePoint *points, int32_t from, int32_t count);
/* Common displacement of the points at one position: to the point nearest to all their planes. */
WrVec3 wr_dice_move(const WrDicePoint *points, int32_t count);

/* ---- dice_cells.c ---- */

/* Computes lines, cells and the cells' needs, for all faces. */
void wr_dice_lay(WrDicing *d, WrPool *pool);
/* Chooses the cuts of all cells for d->epsilon; sets corner_count and triangle_count. */
void wr_dice_choose(WrDicing *d);
