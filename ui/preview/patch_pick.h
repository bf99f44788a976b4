/* patch_pick.h - which point of the surface lies under a pixel of the patch, exactly and at once, and where a
   point of the surface is seen. No window needed.

   A net of projected points of P(u,v) finds the nearest face of a net's cell under the pixel; Newton's
   method on the projection then makes (u,v) exact for any place between pixels. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrScene WrScene;

typedef struct WrPatchPick WrPatchPick;

typedef struct WrPatchSpot {
    double u, v;  /* of the patch, 0..1 */
    int face;     /* 0 but on the cube */
    double x, y;  /* pixels from the view's left and top edge */
    double depth; /* along the view, scene units: larger is farther */
} WrPatchSpot;

/* For a scene as it stands after a turn about the world's y axis, in a view of width x height pixels. NULL
 * and an error if there is no such picture. The caller owns it; it keeps no share of the scene. */
WrPatchPick *wr_patch_pick_new(const WrScene *scene, double turn_deg, int width, int height,
                               WrError *err);
void wr_patch_pick_free(WrPatchPick *pick); /* NULL is fine */

/* The nearest point of the surface under (x, y); false where there is none. */
bool wr_patch_pick_at(const WrPatchPick *pick, double x, double y, WrPatchSpot *out);
/* Where (u, v) of a face is; false before the eye's plane. *hidden: something nearer is in front of it, or
 * the surface turns its back there. hidden may be NULL, which is cheaper. */
bool wr_patch_pick_project(const WrPatchPick *pick, int face, double u, double v, WrPatchSpot *out,
                           bool *hidden);
/* How (u, v) change with x and y at a spot: jacobian = { du/dx, du/dy, dv/dx, dv/dy }. False where the
 * surface is seen edge-on, or has no tangent plane. */
bool wr_patch_pick_slopes(const WrPatchPick *pick, const WrPatchSpot *at, double jacobian[4]);
