/* patch_pick.h - exact picking: the surface point under a pixel of the patch, and the pixel of a surface point. No
   window needed.

   A grid of projected points of P(u,v) yields the nearest cell under the pixel; Newton's method on the projection
   then computes (u,v) exactly for any sub-pixel position. Objects of triangles are hit by a ray. */
#pragma once
#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrScene WrScene;

typedef struct WrPatchPick WrPatchPick;

typedef struct WrPatchSpot {
    double u, v;  /* of the patch, 0..1 */
    int face;     /* 0 except on the cube */
    double x, y;  /* pixels from the view's left and top edge */
    double depth; /* depth along the view in scene units: larger is farther */
    /* of an object of triangles, in its own space: the point; the unit normal of its triangle, towards the eye; and
       the direction in which u grows */
    WrVec3 p, n, along;
    bool back;    /* its triangle's back is seen */
    double pixel; /* object units per pixel there, across the view */
} WrPatchSpot;

/* For a scene rotated about the world's y axis, in a view of width x height pixels. NULL and an error if it cannot be
 * rendered. The caller owns it; it holds no reference to the scene. */
WrPatchPick *wr_patch_pick_new(const WrScene *scene, double turn_deg, int width, int height,
                               WrError *err);
void wr_patch_pick_free(WrPatchPick *pick); /* NULL is allowed */

/* The nearest surface point under (x, y); false if there is none. */
bool wr_patch_pick_at(WrPatchPick *pick, double x, double y, WrPatchSpot *out);
/* Position of (u, v) of a face; false behind the eye's plane. *hidden: a nearer surface covers it, or it faces away.
 * hidden may be NULL, which is faster. */
bool wr_patch_pick_project(const WrPatchPick *pick, int face, double u, double v, WrPatchSpot *out,
                           bool *hidden);
/* Derivatives of (u, v) by pixel position: jacobian = { du/dx, du/dy, dv/dx, dv/dy }. False if the surface is seen
 * edge-on, or has no tangent plane. */
bool wr_patch_pick_slopes(const WrPatchPick *pick, const WrPatchSpot *at, double jacobian[4]);

/* ---- objects of triangles ---- */

/* True if the object is one; then (u,v) alone determine no point: project and slopes fail. */
bool wr_patch_pick_is_mesh(const WrPatchPick *pick);
/* Position of a point of the object's space; false behind the eye's plane. */
bool wr_patch_pick_project_point(const WrPatchPick *pick, WrVec3 p, double *x, double *y);
/* The eye in the object's space; of an orthographic view a far point of its direction. */
WrVec3 wr_patch_pick_eye(const WrPatchPick *pick);

/* ---- picking among several objects ---- */

/* The object under a pixel of the patch, and the point on it. No window needed. */

typedef struct WrObjectPicks WrObjectPicks;
typedef struct WrRayTree WrRayTree;

/* wr_patch_pick_new for all visible objects. before: of another view, whose ray trees of equal meshes are shared; or
 * NULL. */
WrObjectPicks *wr_object_picks_new(const WrScene *scene, double turn_deg, int width, int height,
                                   const WrObjectPicks *before, WrError *err);
void wr_object_picks_free(WrObjectPicks *picks); /* NULL is allowed */
/* Index of the object visible at (x, y), and the point on it; -1: none. Where objects coincide, as two with relief on
 * different materials of one mesh, it is the chosen one. */
int wr_object_picks_at(const WrObjectPicks *picks, int chosen, double x, double y,
                       WrPatchSpot *out);
/* Shares a ray tree with all objects of the mesh that have none yet; else they build it when it is first needed, 0.8 s
 * for a million triangles. */
void wr_object_picks_share_tree(WrObjectPicks *picks, const WrRayTree *tree, uint64_t mesh_key);
/* Picking of that object; NULL: hidden. Borrowed. */
const WrPatchPick *wr_object_picks_of(const WrObjectPicks *picks, int object);
