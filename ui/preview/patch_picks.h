/* patch_picks.h - picking among several objects: the object under a pixel of the patch, and the point on it. No
   window needed. */
#pragma once
#include "ui/preview/patch_pick.h"

typedef struct WrPatchPicks WrPatchPicks;

/* wr_patch_pick_new for all visible objects. */
WrPatchPicks *wr_patch_picks_new(const WrScene *scene, double turn_deg, int width, int height,
                                 WrError *err);
void wr_patch_picks_free(WrPatchPicks *picks); /* NULL is allowed */
/* Index of the object visible at (x, y), and the point on it; -1: none. */
int wr_patch_picks_at(const WrPatchPicks *picks, double x, double y, WrPatchSpot *out);
/* Picking of that object; NULL: hidden. Borrowed. */
const WrPatchPick *wr_patch_picks_of(const WrPatchPicks *picks, int object);
