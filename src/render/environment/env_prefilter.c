#include "render/environment/env_prefilter.h"

#include "render/plan/plan.h"
#include "render/frame/tile.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

void wr_env_prefilter_drop_rungs(WrEnvPrefilter *grades)
{
    for (int i = 0; i < WR_TEXTURED_REFLECTION_RUNGS; i++) wr_env_lookup_drop(&grades->rung[i]);
}

void wr_env_prefilter_drop(WrEnvPrefilter *grades)
{
    wr_env_prefilter_drop_rungs(grades);
    grades->there = false;
}

static bool same(const WrReflectance *a, const WrReflectance *b)
{
    return a->model == b->model && a->energy == b->energy && a->shininess == b->shininess &&
           a->ior == b->ior;
}

static void bring_shares(WrEnvPrefilter *grades, const WrMaterial *m)
{
    const WrReflectance of = wr_scene_reflectance(m);
    if (grades->there && same(&grades->of, &of) && grades->ks == m->specular &&
        grades->tint == m->tint && grades->gated == m->gate)
        return;
    grades->of = of, grades->ks = m->specular, grades->tint = m->tint, grades->gated = m->gate;
    grades->there = true;
    wr_textured_reflection_init(&grades->vary, &of, m->specular, m->tint, m->gate);
}

/* Range of blur levels that the material's widths need. */
static void rungs_of(const WrEnvironmentBrdf *gloss, const WrPlan *plan, int *first, int *last)
{
    const double rung = -log2(gloss->alpha), most = WR_TEXTURED_REFLECTION_RUNGS - 1;
    *first = 0, *last = (int)most;
    if (wr_plan_runs(plan, WR_EFFECT_VARIED)) return;
    *last = (int)fmin(ceil(rung) + 1, most);
    if (!wr_plan_runs(plan, WR_EFFECT_SPREAD)) *first = (int)fmin(fmax(floor(rung), 0), most - 1);
}

bool wr_env_prefilter_update(WrEnvPrefilter *grades, const WrScene *scene, const WrPlan *plan,
                             WrPool *pool, WrError *err)
{
    WrEnvironmentBrdf gloss, lobe;
    int first, last;
    bring_shares(grades, &scene->material);
    if (!plan->graded) return true;
    wr_scene_gloss(&scene->material, &gloss);
    rungs_of(&gloss, plan, &first, &last);
    for (int i = first; i <= last; i++) {
        const bool blurred = i + 1 < WR_TEXTURED_REFLECTION_RUNGS;
        wr_textured_reflection_rung(&gloss, i, &lobe);
        if (!wr_env_lookup_update(&grades->rung[i], scene->environment.light,
                                  blurred ? &lobe : NULL, plan->gloss, pool, err))
            return false;
    }
    return true;
}

/* Copies the terms of one roughness step and pads them with 0. */
static void put_terms(const double *terms, double *to, float *single)
{
    for (int k = 0; k < WR_TEXTURED_REFLECTION_TERMS; k++)
        to[k] = k < WR_ALBEDO_TERMS ? terms[k] : 0, single[k] = (float)to[k];
}

static void put_step(const WrTexturedReflection *vary, int i, WrKernVaryd *wide, WrKernVary *single)
{
    wide->mean[i] = vary->mean[i], single->mean[i] = (float)vary->mean[i];
    wide->again[i] = vary->again[i], single->again[i] = (float)vary->again[i];
    put_terms(vary->albedo[i], wide->albedo[i], single->albedo[i]);
    put_terms(vary->matt[i], wide->matt[i], single->matt[i]);
    put_terms(vary->twice[i], wide->twice[i], single->twice[i]);
}

/* Reflected shares at step i: for non-metal and metal, or for one fixed metalness. */
static void put_shares(const WrTexturedReflection *vary, bool alike, double metal, int i,
                       WrKernVaryd *wide, WrKernVary *single)
{
    double own[2][WR_ALBEDO_TERMS], white[2][WR_ALBEDO_TERMS];
    for (int k = 0; k < 2 * WR_ALBEDO_TERMS; k++) {
        const int at = k / WR_ALBEDO_TERMS, term = k % WR_ALBEDO_TERMS;
        const double to = alike ? metal : at;
        const double o = vary->own[0][i][term], w = vary->white[0][i][term];
        own[at][term] = o + to * (vary->own[1][i][term] - o);
        white[at][term] = w + to * (vary->white[1][i][term] - w);
    }
    for (int at = 0; at < 2; at++) {
        put_terms(own[at], wide->own[at][i], single->own[at][i]);
        put_terms(white[at], wide->white[at][i], single->white[at][i]);
    }
}

void wr_env_prefilter_fill(const WrEnvPrefilter *grades, const WrScene *scene, WrTileJob *job)
{
    const WrTexturedReflection *vary = &grades->vary;
    const WrMaterial *m = &scene->material;
    WrKernVaryd *wide = &job->vary_double;
    WrKernVary *single = &job->vary;
    WrEnvironmentBrdf gloss;
    wr_scene_gloss(m, &gloss);
    job->rough = sqrt(gloss.alpha);
    wide->metals = single->metals = wr_reflects[m->model].metalness;
    wide->again_twice = single->again_twice =
        wr_reflect_again(&wr_reflects[m->model], m->energy == WR_ENERGY_KEPT);
    wide->alike = single->alike = !job->facets[WR_FACET_METALNESS].near.rgba;
    for (int i = 0; i < WR_TEXTURED_REFLECTION_STEPS; i++) {
        put_step(vary, i, wide, single);
        put_shares(vary, wide->alike, fmin(fmax(m->metalness, 0), 1), i, wide, single);
    }
    for (int i = 0; i < WR_TEXTURED_REFLECTION_RUNGS; i++) {
        const WrEnvLookup *of = &grades->rung[i];
        const WrKernRung rung = { of->rgba ? of->rgba + 4 * ((ptrdiff_t)of->pitch + 1) : NULL,
                                  of->pitch, of->width, of->height };
        wide->rung[i] = single->rung[i] = rung;
    }
}
