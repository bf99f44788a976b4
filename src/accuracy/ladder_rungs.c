/* Settings that the ladder tries. */
#include "accuracy/ladder.h"
#include "field/scheme_list.h"

#include "scene/objects.h"
#include "scene/scene.h"

#include <math.h>

typedef struct RungList {
    const WrScene *scene;
    WrRung *out;
    int count, room;
} RungList;

/* Adds a setting, reduced to its differences from the scene. */
static void add(RungList *list, WrAxis axis, const WrSetting *wanted)
{
    WrRung rung = { .axis = axis };
    for (int i = 0; i < wanted->count; i++) {
        const WrDial *dial = &wr_dials[wanted->dial[i]];
        if (dial->get(list->scene) == wanted->value[i]) continue;
        rung.setting.dial[rung.setting.count] = wanted->dial[i];
        rung.setting.value[rung.setting.count++] = wanted->value[i];
        rung.model |= wanted->dial[i] == WR_DIAL_NORMAL && wanted->value[i] == WR_BUMP_INVARIANT;
    }
    if (rung.setting.count == 0) return; /* the scene's own setting is already in the list */
    if (list->count < list->room) list->out[list->count] = rung;
    list->count++;
}

/* The values of one dial: its choices, or the numbers in its row. */
static int rungs_of(const WrDial *dial, double *out, int room)
{
    int count = 0;
    for (int i = 0; dial->choices > 0 ? i < dial->choices : dial->rungs && !isnan(dial->rungs[i]);
         i++)
        if (count < room) out[count++] = dial->choices > 0 ? (double)i : dial->rungs[i];
    return count;
}

#define RUNGS_MAX 16

/* Adds the dials of that axis that become relevant by that choice: each of their values, one at a time. */
static void add_dependents(RungList *list, WrAxis axis, const WrScene *chosen, WrSetting setting)
{
    double rungs[RUNGS_MAX];
    for (int d = 0; d < WR_DIAL_COUNT; d++) {
        const WrDial *dial = &wr_dials[d];
        if (dial->axis != axis || !dial->matters || !dial->matters(chosen)) continue;
        setting.dial[setting.count] = d;
        const int count = rungs_of(dial, rungs, RUNGS_MAX);
        for (int r = 0; r < count; r++) {
            if (rungs[r] == dial->get(list->scene)) continue;
            WrSetting with = setting;
            with.value[with.count++] = rungs[r];
            add(list, axis, &with);
        }
    }
}

static void add_dial(RungList *list, int id)
{
    const WrDial *dial = &wr_dials[id];
    double rungs[RUNGS_MAX];
    const int count = rungs_of(dial, rungs, RUNGS_MAX);
    const bool antialiasing = id == WR_DIAL_AA; /* the dial that others of its axis depend on */
    if (dial->axis == WR_AXIS_ANTIALIASING && !antialiasing) return;
    if (dial->matters && !dial->matters(list->scene)) return;
    for (int r = 0; r < count; r++) {
        WrSetting setting = { 1, { id }, { rungs[r] } };
        add(list, dial->axis, &setting);
        if (!antialiasing) continue;
        WrScene *chosen = wr_setting_apply(&setting, list->scene);
        add_dependents(list, dial->axis, chosen, setting);
        wr_scene_free(chosen);
    }
}

/* Combinations of approximations: the cheapest of all, the paper's with more samples, and the better slopes with
   the anti-aliasing methods. */
static const WrSetting combinations[] = {
    { 2, { WR_DIAL_NORMAL, WR_DIAL_ARITHMETIC }, { WR_BUMP_BLINN, WR_ARITHMETIC_FAST } },
    { 3,
      { WR_DIAL_SCHEME, WR_DIAL_NORMAL, WR_DIAL_ARITHMETIC },
      { WR_SCHEME_NEAREST, WR_BUMP_BLINN, WR_ARITHMETIC_FAST } },
    { 3,
      { WR_DIAL_AA, WR_DIAL_MOMENTS, WR_DIAL_FOOTPRINT },
      { WR_AA_MOMENTS, WR_MOMENTS_LEAN, WR_FOOTPRINT_ANISOTROPIC } },
    { 4,
      { WR_DIAL_SCHEME, WR_DIAL_NORMAL, WR_DIAL_AA, WR_DIAL_SAMPLES },
      { WR_SCHEME_CENTRAL, WR_BUMP_BLINN, WR_AA_SUPERSAMPLE, 4 } },
    { 5,
      { WR_DIAL_SCHEME, WR_DIAL_NORMAL, WR_DIAL_AA, WR_DIAL_SAMPLES, WR_DIAL_ARITHMETIC },
      { WR_SCHEME_CENTRAL, WR_BUMP_BLINN, WR_AA_SUPERSAMPLE, 4, WR_ARITHMETIC_FAST } },
    { 4,
      { WR_DIAL_SCHEME, WR_DIAL_NORMAL, WR_DIAL_AA, WR_DIAL_SAMPLES },
      { WR_SCHEME_CATMULL, WR_BUMP_BLINN, WR_AA_SUPERSAMPLE, 4 } },
    { 4,
      { WR_DIAL_SCHEME, WR_DIAL_NORMAL, WR_DIAL_AA, WR_DIAL_SAMPLES },
      { WR_SCHEME_BSPLINE_FIT, WR_BUMP_EXACT, WR_AA_SUPERSAMPLE, 2 } },
    { 4,
      { WR_DIAL_SCHEME, WR_DIAL_NORMAL, WR_DIAL_AA, WR_DIAL_SAMPLES },
      { WR_SCHEME_BSPLINE_FIT, WR_BUMP_EXACT, WR_AA_SUPERSAMPLE, 4 } },
    { 4,
      { WR_DIAL_SCHEME, WR_DIAL_NORMAL, WR_DIAL_AA, WR_DIAL_SAMPLES },
      { WR_SCHEME_BSPLINE_FIT, WR_BUMP_EXACT, WR_AA_SUPERSAMPLE, 8 } },
    { 5,
      { WR_DIAL_SCHEME, WR_DIAL_NORMAL, WR_DIAL_AA, WR_DIAL_SAMPLES, WR_DIAL_CONTRAST },
      { WR_SCHEME_BSPLINE_FIT, WR_BUMP_EXACT, WR_AA_ADAPTIVE, 8, 0.002 } },
    { 4,
      { WR_DIAL_SCHEME, WR_DIAL_NORMAL, WR_DIAL_AA, WR_DIAL_SAMPLES },
      { WR_SCHEME_BSPLINE_FIT, WR_BUMP_EXACT, WR_AA_SUPERSAMPLE, 16 } },
};

int wr_ladder_settings(const WrScene *scene, WrAxis axis, WrRung *out, int room)
{
    RungList list = { .scene = scene, .out = out, .room = room };
    if (room > 0)
        out[0] = (WrRung){ .axis = WR_AXIS_COUNT,
                           .current = true,
                           .model = scene->bump == WR_BUMP_INVARIANT };
    list.count = 1;
    for (int d = 0; d < WR_DIAL_COUNT; d++)
        if (axis == WR_AXIS_COUNT || wr_dials[d].axis == axis) add_dial(&list, d);
    for (size_t i = 0; axis == WR_AXIS_COUNT && i < sizeof combinations / sizeof *combinations; i++)
        add(&list, WR_AXIS_COUNT, &combinations[i]);
    return list.count;
}

WrScene *wr_ladder_best_but(const WrScene *scene, WrAxis axis)
{
    WrScene *best = wr_scene_clone(scene);
    if (axis != WR_AXIS_DERIVATIVE) best->scheme = WR_SCHEME_BSPLINE_FIT;
    if (axis != WR_AXIS_NORMAL && best->bump != WR_BUMP_INVARIANT) best->bump = WR_BUMP_EXACT;
    wr_scene_set_all_slopes(best, axis != WR_AXIS_DERIVATIVE, axis != WR_AXIS_NORMAL);
    if (axis != WR_AXIS_ANTIALIASING) {
        best->dials.aa = WR_AA_SUPERSAMPLE;
        best->dials.samples = 16;
        best->dials.spread = WR_SPREAD_REGULAR;
    }
    if (axis != WR_AXIS_VISIBILITY) {
        const WrDials dials = wr_dials_default();
        best->dials.mesh = dials.mesh;
        best->dials.newton = dials.newton;
        best->dials.texels = dials.texels;
    }
    if (axis != WR_AXIS_LIGHT) {
        best->dials.harmonics = 2;
        best->dials.gloss = 64;
    }
    if (axis != WR_AXIS_ARITHMETIC) {
        best->dials.heights = WR_HEIGHTS_FLOAT;
        best->dials.shading = WR_SHADING_FLOAT;
        best->dials.arithmetic = WR_ARITHMETIC_EXACT;
    }
    return best;
}
