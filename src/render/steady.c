#include "render/steady.h"

#include "base/memory.h"
#include "scene/scene.h"

#include <string.h>

/* Of a picture. */
static size_t pixels_of(const WrSteadyView *view)
{
    return (size_t)view->width * (size_t)view->height;
}

static void drop_notes(WrSteady *steady)
{
    wr_free(steady->normals);
    wr_free(steady->points);
    wr_free(steady->uv);
    steady->normals = steady->points = steady->uv = NULL;
}

static void drop_numbers(WrSteady *steady)
{
    drop_notes(steady);
    wr_free(steady->numbers);
    wr_free(steady->owner);
    steady->numbers = NULL;
    steady->owner = NULL;
    steady->whole = false;
}

static void free_parts(WrSteadyPart *parts, int count)
{
    for (int i = 0; i < count; i++) {
        wr_scene_free((WrScene *)parts[i].scene);
        wr_free((WrPlan *)parts[i].plan);
    }
    wr_free(parts);
}

void wr_steady_fini(WrSteady *steady)
{
    drop_numbers(steady);
    free_parts(steady->parts, steady->view.count);
    *steady = (WrSteady){ .parts = NULL };
}

/* What light looks at besides n', P, u and v, or what gives a pixel more than one of them. */
static const WrEffect more[] = { WR_EFFECT_TINT,      WR_EFFECT_FADED,     WR_EFFECT_EMBOSSED,
                                 WR_EFFECT_SHADOW,    WR_EFFECT_CAST,      WR_EFFECT_BOUND,
                                 WR_EFFECT_OCCLUSION, WR_EFFECT_DISPLACED, WR_EFFECT_PARALLAX,
                                 WR_EFFECT_SPREAD,    WR_EFFECT_HORIZON,   WR_EFFECT_HALF };

bool wr_steady_suits(const WrScene *scene, const WrPlan *plan)
{
    for (size_t i = 0; i < sizeof more / sizeof *more; i++)
        if (wr_plan_runs(plan, more[i])) return false;
    return plan->normals && plan->sampling == WR_SAMPLING_ONE && !plan->shading_double &&
           !plan->facets_filtered && v3_len(scene->sizes) == 0 && !wr_shape_endless(&scene->shape);
}

/* Rows that light alone decides, or material that goes by P, and what they own. */
static const WrEffect of_light[] = { WR_EFFECT_DIFFUSE, WR_EFFECT_SPECULAR, WR_EFFECT_MODEL,
                                     WR_EFFECT_KEPT,    WR_EFFECT_FAINT,    WR_EFFECT_SURROUND,
                                     WR_EFFECT_MIRROR,  WR_EFFECT_BLUR,     WR_EFFECT_HARMONICS,
                                     WR_EFFECT_VARIED,  WR_EFFECT_GRAIN,    WR_EFFECT_OCTAVES };

static bool same_plan(const WrPlan *a, const WrPlan *b)
{
    WrPlan lit = *a;
    for (size_t i = 0; i < sizeof of_light / sizeof *of_light; i++)
        lit.rows[of_light[i]].run = b->rows[of_light[i]].run;
    lit.model = b->model;
    lit.tint = b->tint;
    lit.kept = b->kept;
    lit.faint = b->faint;
    lit.harmonics = b->harmonics;
    lit.gloss = b->gloss;
    lit.grain = b->grain;
    lit.graded = b->graded;
    return wr_plan_same(&lit, b);
}

static bool same_part(const WrSteadyPart *a, const WrSteadyPart *b)
{
    return a->field == b->field && a->object == b->object &&
           wr_scene_same_normals(a->scene, b->scene) && same_plan(a->plan, b->plan);
}

static bool same(const WrSteadyView *a, const WrSteadyView *b)
{
    bool all = a->count == b->count && a->kernels == b->kernels && a->turn_deg == b->turn_deg &&
               a->width == b->width && a->height == b->height;
    for (int i = 0; i < b->count && all; i++) all = same_part(&a->parts[i], &b->parts[i]);
    return all;
}

/* From now on this view is compared. */
static void take(WrSteady *steady, const WrSteadyView *view)
{
    WrSteadyPart *parts = wr_alloc((size_t)view->count, sizeof *parts);
    for (int i = 0; i < view->count; i++) {
        WrPlan *plan = wr_alloc(1, sizeof *plan);
        parts[i] = view->parts[i];
        *plan = *view->parts[i].plan;
        parts[i].plan = plan;
        parts[i].scene =
            wr_scene_share(parts[i].scene); /* before the old one goes: it may be the same */
    }
    drop_numbers(steady);
    free_parts(steady->parts, steady->view.count);
    steady->parts = parts;
    steady->view = *view;
    steady->view.parts = parts;
}

/* Is a picture looked up at u and v? */
static bool looks_up(const WrSteadyView *view)
{
    bool any = false;
    for (int i = 0; i < view->count; i++)
        any |= wr_plan_runs(view->parts[i].plan, WR_EFFECT_COLOUR) ||
               wr_plan_runs(view->parts[i].plan, WR_EFFECT_FACETS);
    return any;
}

WrSteadyUse wr_steady_bring(WrSteady *steady, const WrSteadyView *view)
{
    const size_t count = pixels_of(view);
    if (!same(&steady->view, view)) {
        take(steady, view);
        return WR_STEADY_NONE;
    }
    if (steady->whole) return WR_STEADY_KNOWN;
    drop_numbers(steady);
    steady->each = looks_up(view) ? 8 : 6;
    steady->normals = wr_try_alloc(count, 3 * sizeof(float), "normals", NULL);
    steady->points = wr_try_alloc(count, 3 * sizeof(float), "points", NULL);
    steady->owner = wr_try_alloc(count, 1, "samples", NULL);
    if (steady->each == 8) steady->uv = wr_try_alloc(count, 2 * sizeof(float), "places", NULL);
    const bool looked = steady->uv || steady->each == 6;
    if (steady->normals && steady->points && steady->owner && looked) return WR_STEADY_NOTE;
    drop_numbers(steady);
    return WR_STEADY_NONE;
}

/* A row of what was noted, `count` numbers a sample, to its blocks. */
static void put_row(const WrSteady *steady, const float *from, int y, int first, int count)
{
    for (int x = 0; x < steady->view.width; x++) {
        float *to = steady->numbers + (wr_steady_at(steady, x, y) - steady->numbers);
        for (int k = 0; k < count; k++) to[(first + k) * WR_STEADY_BLOCK] = from[count * x + k];
    }
}

/* Which samples there are of a single object, and how many. */
static int64_t find_samples(WrSteady *steady, int object)
{
    const size_t count = pixels_of(&steady->view);
    int64_t seen = 0;
    for (size_t i = 0; i < count; i++) {
        const float *n = steady->normals + 3 * i;
        const bool there = (n[0] != 0.0f) | (n[1] != 0.0f) | (n[2] != 0.0f);
        steady->owner[i] = (unsigned char)(there ? object + 1 : 0);
        seen += there;
    }
    return seen;
}

void wr_steady_noted(WrSteady *steady, int64_t samples)
{
    const size_t width = (size_t)steady->view.width, height = (size_t)steady->view.height;
    const size_t blocks = (width + WR_STEADY_BLOCK - 1) / WR_STEADY_BLOCK * height;
    const size_t each = (size_t)steady->each;
    const bool single = samples >= 0;
    steady->numbers = wr_try_alloc(blocks, each * WR_STEADY_BLOCK * sizeof(float), "normals", NULL);
    steady->whole =
        steady->numbers && (!single || find_samples(steady, steady->parts[0].object) == samples);
    if (!steady->whole) {
        drop_numbers(steady);
        return;
    }
    for (size_t y = 0; y < height; y++) {
        put_row(steady, steady->normals + 3 * y * width, (int)y, 0, 3);
        put_row(steady, steady->points + 3 * y * width, (int)y, 3, 3);
        if (steady->uv) put_row(steady, steady->uv + 2 * y * width, (int)y, 6, 2);
    }
    drop_notes(steady);
}
