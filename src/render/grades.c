#include "render/grades.h"

#include "render/plan.h"
#include "render/tile.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

void wr_grades_drop(WrGrades *grades)
{
    for (int i = 0; i < WR_VARY_RUNGS; i++) wr_mirror_drop(&grades->rung[i]);
    grades->there = false;
}

static bool same(const WrReflectance *a, const WrReflectance *b)
{
    return a->model == b->model && a->energy == b->energy && a->shininess == b->shininess &&
           a->ior == b->ior;
}

static void bring_shares(WrGrades *grades, const WrMaterial *m)
{
    const WrReflectance of = wr_scene_reflectance(m);
    if (grades->there && same(&grades->of, &of) && grades->ks == m->specular &&
        grades->tint == m->tint && grades->gated == m->gate)
        return;
    grades->of = of, grades->ks = m->specular, grades->tint = m->tint, grades->gated = m->gate;
    grades->there = true;
    wr_vary_init(&grades->vary, &of, m->specular, m->tint, m->gate);
}

/* Between which rungs do widths lie? */
static void rungs_of(const WrGloss *gloss, const WrPlan *plan, int *first, int *last)
{
    const double rung = -log2(gloss->alpha), most = WR_VARY_RUNGS - 1;
    *first = 0, *last = (int)most;
    if (wr_plan_runs(plan, WR_EFFECT_VARIED)) return;
    *last = (int)fmin(ceil(rung) + 1, most);
    if (!wr_plan_runs(plan, WR_EFFECT_SPREAD)) *first = (int)fmin(fmax(floor(rung), 0), most - 1);
}

bool wr_grades_bring(WrGrades *grades, const WrScene *scene, const WrPlan *plan, WrPool *pool,
                     WrError *err)
{
    WrGloss gloss, lobe;
    int first, last;
    bring_shares(grades, &scene->material);
    if (!plan->graded) return true;
    wr_scene_gloss(&scene->material, &gloss);
    rungs_of(&gloss, plan, &first, &last);
    for (int i = first; i <= last; i++) {
        const bool blurred = i + 1 < WR_VARY_RUNGS;
        wr_vary_rung(&gloss, i, &lobe);
        if (!wr_mirror_bring(&grades->rung[i], scene->environment.light, blurred ? &lobe : NULL,
                             plan->gloss, pool, err))
            return false;
    }
    return true;
}

static void narrow(const double *from, float *to, size_t count)
{
    for (size_t i = 0; i < count; i++) to[i] = (float)from[i];
}

void wr_grades_fill(const WrGrades *grades, const WrScene *scene, WrTileJob *job)
{
    enum { TERMS = WR_VARY_STEPS * WR_ALBEDO_TERMS };
    const WrVary *vary = &grades->vary;
    WrKernVaryd *wide = &job->vary_double;
    WrKernVary *single = &job->vary;
    WrGloss gloss;
    wr_scene_gloss(&scene->material, &gloss);
    job->rough = sqrt(gloss.alpha);
    wide->metals = single->metals = scene->material.model == WR_REFLECT_GGX;
    memcpy(wide->mean, vary->mean, sizeof wide->mean);
    memcpy(wide->again, vary->again, sizeof wide->again);
    memcpy(wide->albedo, vary->albedo, sizeof wide->albedo);
    memcpy(wide->matt, vary->matt, sizeof wide->matt);
    memcpy(wide->twice, vary->twice, sizeof wide->twice);
    memcpy(wide->own, vary->own, sizeof wide->own);
    memcpy(wide->white, vary->white, sizeof wide->white);
    narrow(vary->mean, single->mean, WR_VARY_STEPS);
    narrow(vary->again, single->again, WR_VARY_STEPS);
    narrow(vary->albedo[0], single->albedo[0], TERMS);
    narrow(vary->matt[0], single->matt[0], TERMS);
    narrow(vary->twice[0], single->twice[0], TERMS);
    narrow(vary->own[0][0], single->own[0][0], 2 * TERMS);
    narrow(vary->white[0][0], single->white[0][0], 2 * TERMS);
    for (int i = 0; i < WR_VARY_RUNGS; i++) {
        const WrMirror *m = &grades->rung[i];
        const WrKernRung rung = { m->rgba ? m->rgba + 4 * ((ptrdiff_t)m->pitch + 1) : NULL,
                                  m->pitch, m->width, m->height };
        wide->rung[i] = single->rung[i] = rung;
    }
}
