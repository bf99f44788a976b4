/* dice.h - a displaced surface P + F n as facets that are fine enough for the view at hand.
   Layer 5, private to the renderer.

   The domain is cut at lines that F's texels lie on, a block of them a cell, and each cell into rows and columns. With s
   the step along u and P' = P + F n, straight facets are off by at most

     s^2 |P'uu| / 8,   |P'uu| <= |Puu| + |Fuu| + 2 |Fu nu| + |F nuu|

   which at depth z is s^2 |P'uu| f / (8 z) pixels: from that comes the step. A bilinear F is straight between its
   lines but for its twist, which a facet cuts off by a quarter.

   No ray passes between facets: an edge of a cell is cut by what its two ends ask for, so both its cells cut it alike;
   points along it are made from the same numbers; and points that the surface shares where its domain ends (seams,
   poles, edges of a cube) move together, to the place that is nearest to all the planes that they were moved to. */
#pragma once
#include "surface/triangles.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrPool WrPool;
typedef struct WrScene WrScene;
typedef struct WrView WrView;

#define WR_DICE_FACES 6
#define WR_DICE_MOST 3000000 /* triangles; beyond it facets are coarser (HC125) */

typedef struct WrDice {
    WrTriangles *triangles;     /* owned; corners have u and v, no normals; NULL: nothing yet */
    int32_t end[WR_DICE_FACES]; /* of each face's triangles, one past the last */
    int faces;
    double epsilon; /* pixels that facets are off at most: what was asked for, or more */
    double rise;    /* largest |F|, object units */
} WrDice;

/* field: NULL with a formula. epsilon: pixels. Errors: no memory. */
bool wr_dice_make(WrDice *dice, const WrScene *scene, const WrField *field, const WrView *view,
                  double epsilon, WrPool *pool, WrError *err);
void wr_dice_fini(WrDice *dice);
