#include "ui/preview/patch_picks.h"

#include "base/memory.h"
#include "scene/objects.h"

#include <stddef.h>

struct WrPatchPicks {
    WrPatchPick *pick[WR_OBJECTS_MAX]; /* one per object; NULL: hidden. Owned */
    int count;
};

WrPatchPicks *wr_patch_picks_new(const WrScene *scene, double turn_deg, int width, int height,
                                 WrError *err)
{
    WrPatchPicks *picks = wr_alloc(1, sizeof *picks);
    picks->count = wr_scene_object_count(scene);
    for (int i = 0; i < picks->count; i++) {
        const double aspect = height > 0 ? (double)width / height : 1;
        if (!wr_scene_shows(scene, i, aspect)) continue;
        WrScene *part = wr_scene_object_alone(scene, i, aspect);
        picks->pick[i] = wr_patch_pick_new(part, turn_deg, width, height, err);
        wr_scene_free(part);
        if (picks->pick[i]) continue;
        wr_patch_picks_free(picks);
        return NULL;
    }
    return picks;
}

void wr_patch_picks_free(WrPatchPicks *picks)
{
    if (!picks) return;
    for (int i = 0; i < picks->count; i++) wr_patch_pick_free(picks->pick[i]);
    wr_free(picks);
}

int wr_patch_picks_at(const WrPatchPicks *picks, double x, double y, WrPatchSpot *out)
{
    int found = -1;
    for (int i = 0; i < picks->count; i++) {
        WrPatchSpot spot;
        if (!picks->pick[i] || !wr_patch_pick_at(picks->pick[i], x, y, &spot)) continue;
        if (found >= 0 && spot.depth >= out->depth) continue;
        found = i;
        *out = spot;
    }
    return found;
}

const WrPatchPick *wr_patch_picks_of(const WrPatchPicks *picks, int object)
{
    return object >= 0 && object < picks->count ? picks->pick[object] : NULL;
}
