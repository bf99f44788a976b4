/* dice.h - dicing of displaced surfaces into facets, and their F prepared for many single evaluations.
   Private to the renderer. */
#pragma once
#include "base/hash.h"
#include "scene/scene.h"
#include "surface/triangles.h"

#include <stdbool.h>
#include <stdint.h>

/* ---- heights ---- */

/* With a fitted spline each evaluation of F would compute the nearby coefficients again; here they are computed once. */

typedef struct WrError WrError;
typedef struct WrField WrField;

/* wr_scene_height(raised.scene, raised.field, ...) is F. Zero-initialise; fini frees. */
typedef struct WrRaised {
    WrScene *scene;       /* own share */
    const WrField *field; /* borrowed, or `own`; NULL with a formula */
    WrField *own;
} WrRaised;

/* Prepares F. field: must outlive `raised`; not read with a formula. Call fini even after a failure. Errors: no
   memory. */
bool wr_raised_init(WrRaised *raised, const WrScene *scene, const WrField *field, WrError *err);
void wr_raised_fini(WrRaised *raised);
/* True if F displaces the surface itself. */
bool wr_is_raised(const WrScene *scene);
/* Upper bound of |F|, object units. field: not read with a formula. */
double wr_raised_most(const WrScene *scene, const WrField *field);
/* Hash of everything that changes the displaced shape, and of nothing else: material edits keep its facets. */
WrHash wr_raised_key(const WrScene *scene, const WrField *field);

/* ---- dicing ---- */

/* View-dependent tessellation of a displaced surface P + F n.
   Private to the renderer.

   The domain is cut at lines through F's texels, with a block of texels for each cell, and each cell into rows
   and columns. With s the step along u and P' = P + F n, the error of straight facets is at most

     s^2 |P'uu| / 8,   |P'uu| <= |Puu| + |Fuu| + 2 |Fu nu| + |F nuu|

   which at depth z is s^2 |P'uu| f / (8 z) pixels: this determines the step. A bilinear F is straight between
   its lines except for its twist, of which a facet cuts off a quarter.

   The facets have no gaps. An edge of a cell is cut by the needs of its two ends, so both its cells cut it
   alike. Points along it are computed from equal numbers. Points that the surface shares where its domain ends
   (seams, poles, edges of a cube) move together, to the position nearest to all the planes that they were
   displaced to.

   A mesh's faces are bisected instead (mesh_relief.h), each to the same error in pixels at its own depth. */

typedef struct WrPool WrPool;
typedef struct WrScene WrScene;
typedef struct WrView WrView;

#define WR_DICE_FACES 6
#define WR_DICE_MAX 3000000       /* maximum triangles; beyond it facets are coarser (HC125) */
#define WR_DICE_MOVING_MAX 100000 /* of a moving view, in addition to a mesh's own */

typedef struct WrDiceCell WrDiceCell;

typedef struct WrDice {
    WrTriangles *triangles;     /* owned; corners have u and v, no normals; NULL: not built */
    int32_t end[WR_DICE_FACES]; /* for each face, one past its last triangle */
    int faces;
    /* Relief on a mesh: its faces. u and v of the corners above are weights of the face's corners 1 and 2, and they
       belong to one triangle each. Else NULL. */
    WrTriangles *base; /* own share */
    int32_t *base_of;  /* [triangles] the face of each; owned */
    double epsilon;    /* largest error of the facets in pixels: the requested one, or more */
    double rise;       /* largest |F|, object units */
    WrHash key;        /* of everything that the facets depend on */
    /* measured needs of the parts of a surface that is no mesh, for the next view; owned, or NULL */
    WrDiceCell *cells;
    WrHash shape; /* wr_raised_key of the surface that `cells` belong to */
} WrDice;

typedef struct WrDiceRequest {
    const WrScene *scene;
    const WrField *field; /* not read with a formula */
    const WrView *view;
    double epsilon; /* pixels */
    /* The view moves: facets are even and do not depend on its direction. Their error is twice epsilon or less at the
       nearest point of the bounding sphere, unless they would be too many. A pixel is rounded down there to a power of
       two of the unit: facets remain until the distance has doubled or halved. */
    bool moving;
    WrPool *pool;
    const volatile int *cancel; /* may be NULL; read for meshes only */
} WrDiceRequest;

/* Builds the triangles, or keeps those of an equal request. dice: zero-initialised before the first. Errors: no memory,
   cancelled. */
bool wr_dice_update(WrDice *dice, const WrDiceRequest *request, WrError *err);
void wr_dice_fini(WrDice *dice);
