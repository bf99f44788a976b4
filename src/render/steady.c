#include "render/steady.h"

#include "base/memory.h"
#include "scene/scene.h"

#include <string.h>

static void drop_notes(WrSteady *steady)
{
    wr_free(steady->normals);
    wr_free(steady->points);
    steady->normals = steady->points = NULL;
}

static void drop_numbers(WrSteady *steady)
{
    drop_notes(steady);
    wr_free(steady->numbers);
    wr_free(steady->there);
    steady->numbers = NULL;
    steady->there = NULL;
    steady->whole = false;
}

void wr_steady_fini(WrSteady *steady)
{
    drop_numbers(steady);
    wr_scene_free(steady->scene);
    *steady = (WrSteady){ .scene = NULL };
}

/* What light looks at besides n' and P, or what gives a pixel more than one of them. */
static const WrEffect more[] = { WR_EFFECT_COLOUR,    WR_EFFECT_TINT,      WR_EFFECT_VARIED,
                                 WR_EFFECT_GRAIN,     WR_EFFECT_FADED,     WR_EFFECT_EMBOSSED,
                                 WR_EFFECT_SHADOW,    WR_EFFECT_CAST,      WR_EFFECT_BOUND,
                                 WR_EFFECT_OCCLUSION, WR_EFFECT_DISPLACED, WR_EFFECT_SPREAD,
                                 WR_EFFECT_HORIZON,   WR_EFFECT_HALF };

bool wr_steady_suits(const WrScene *scene, const WrPlan *plan)
{
    for (size_t i = 0; i < sizeof more / sizeof *more; i++)
        if (wr_plan_runs(plan, more[i])) return false;
    return plan->normals && plan->sampling == WR_SAMPLING_ONE && !plan->shading_double &&
           !plan->graded && v3_len(scene->sizes) == 0 && !wr_shape_endless(&scene->shape);
}

/* Rows that light alone decides, and what they own. */
static const WrEffect of_light[] = { WR_EFFECT_DIFFUSE,  WR_EFFECT_SPECULAR, WR_EFFECT_MODEL,
                                     WR_EFFECT_SURROUND, WR_EFFECT_MIRROR,   WR_EFFECT_BLUR,
                                     WR_EFFECT_HARMONICS };

static bool same_plan(const WrPlan *a, const WrPlan *b)
{
    WrPlan lit = *a;
    for (size_t i = 0; i < sizeof of_light / sizeof *of_light; i++)
        lit.rows[of_light[i]].run = b->rows[of_light[i]].run;
    lit.model = b->model;
    lit.tint = b->tint;
    lit.harmonics = b->harmonics;
    lit.gloss = b->gloss;
    return wr_plan_same(&lit, b);
}

static bool same(const WrSteadyView *a, const WrSteadyView *b)
{
    return a->scene && a->kernels == b->kernels && a->turn_deg == b->turn_deg &&
           a->width == b->width && a->height == b->height && a->field == b->field &&
           wr_scene_same_normals(a->scene, b->scene) && same_plan(a->plan, b->plan);
}

/* From now on this view is compared. */
static void take(WrSteady *steady, const WrSteadyView *view)
{
    drop_numbers(steady);
    WrScene *scene = wr_scene_share(view->scene); /* before the old one goes: it may be the same */
    wr_scene_free(steady->scene);
    steady->scene = scene;
    steady->plan = *view->plan;
    steady->view = *view;
    steady->view.scene = steady->scene;
    steady->view.plan = &steady->plan;
}

WrSteadyUse wr_steady_bring(WrSteady *steady, const WrSteadyView *view)
{
    const size_t count = (size_t)view->width * (size_t)view->height;
    if (!same(&steady->view, view)) {
        take(steady, view);
        return WR_STEADY_NONE;
    }
    if (steady->whole) return WR_STEADY_KNOWN;
    drop_numbers(steady);
    steady->normals = wr_try_alloc(count, 3 * sizeof(float), "normals", NULL);
    steady->points = wr_try_alloc(count, 3 * sizeof(float), "points", NULL);
    if (steady->normals && steady->points) return WR_STEADY_NOTE;
    drop_numbers(steady);
    return WR_STEADY_NONE;
}

/* A row of n' or P to its blocks. */
static void put_row(const WrSteady *steady, const float *from, int y, int first)
{
    for (int x = 0; x < steady->view.width; x++) {
        float *to = steady->numbers + (wr_steady_at(steady, x, y) - steady->numbers);
        for (int k = 0; k < 3; k++) to[(first + k) * WR_STEADY_BLOCK] = from[3 * x + k];
    }
}

/* Which samples there are, and how many. */
static int64_t find_samples(WrSteady *steady, size_t count)
{
    int64_t seen = 0;
    for (size_t i = 0; i < count; i++) {
        const float *n = steady->normals + 3 * i;
        steady->there[i] = (n[0] != 0.0f) | (n[1] != 0.0f) | (n[2] != 0.0f);
        seen += steady->there[i];
    }
    return seen;
}

void wr_steady_noted(WrSteady *steady, int64_t samples)
{
    const size_t width = (size_t)steady->view.width, height = (size_t)steady->view.height;
    const size_t blocks = (width + WR_STEADY_BLOCK - 1) / WR_STEADY_BLOCK * height;
    steady->numbers = wr_try_alloc(blocks, 6 * WR_STEADY_BLOCK * sizeof(float), "normals", NULL);
    steady->there = wr_try_alloc(width, height, "samples", NULL);
    steady->whole =
        steady->numbers && steady->there && find_samples(steady, width * height) == samples;
    if (!steady->whole) {
        drop_numbers(steady);
        return;
    }
    for (size_t y = 0; y < height; y++) {
        put_row(steady, steady->normals + 3 * y * width, (int)y, 0);
        put_row(steady, steady->points + 3 * y * width, (int)y, 3);
    }
    drop_notes(steady);
}
