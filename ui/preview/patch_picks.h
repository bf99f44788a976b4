/* patch_picks.h - which of a scene's objects lies under a pixel of the patch, and where on it. No window needed. */
#pragma once
#include "ui/preview/patch_pick.h"

typedef struct WrPatchPicks WrPatchPicks;

/* As wr_patch_pick_new, for all objects that are shown. */
WrPatchPicks *wr_patch_picks_new(const WrScene *scene, double turn_deg, int width, int height,
                                 WrError *err);
void wr_patch_picks_free(WrPatchPicks *picks); /* NULL is fine */
/* The object that is seen at (x, y), by its place in the scene, and where on it; -1: none. */
int wr_patch_picks_at(const WrPatchPicks *picks, double x, double y, WrPatchSpot *out);
/* That object's own; NULL: it is not shown. Borrowed. */
const WrPatchPick *wr_patch_picks_of(const WrPatchPicks *picks, int object);
