/* Plan rows of environment light. */
#include "render/plan/plan_internal.h"

#include "scene/scene.h"
#include "shade/environment_blur.h"

/* True if the environment sends any light. */
static bool shine(const WrScene *scene)
{
    const WrEnvironment *e = &scene->environment;
    double sum = 0;
    for (int c = 0; e->light && c < 3; c++) sum += e->light->harmonic[0][c];
    return e->strength != 0 && sum > 0;
}

WrVerdict wr_decide_surround(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const WrMaterial *m = &ask->scene->material;
    (void)plan;
    if (!ask->scene->environment.light)
        return say(WR_VERDICT_NONE, why, "the scene has no surroundings");
    if (!shine(ask->scene)) return say(WR_VERDICT_SPARED, why, "no light comes from them");
    if (m->diffuse == 0) return say(WR_VERDICT_SPARED, why, "diffuse is 0");
    if (all_metal(ask->scene))
        return say(WR_VERDICT_SPARED, why, "a metal has no diffuse reflection");
    if (m->colour.x == 0 && m->colour.y == 0 && m->colour.z == 0)
        return say(WR_VERDICT_SPARED, why, "the material's colour is black");
    return say(WR_VERDICT_RUN, why, "light comes from all sides and diffuse is not 0");
}

WrVerdict wr_decide_harmonics(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (!runs(plan, WR_EFFECT_SURROUND))
        return say(WR_VERDICT_NONE, why, "there is no diffuse light of surroundings");
    if (ask->scene->environment.light->even)
        return say(WR_VERDICT_SPARED, why,
                   "the surroundings are of one colour: one coefficient is all of them");
    if (ask->dials->harmonics == 0)
        return say(WR_VERDICT_NONE, why, "harmonics=0: the mean of them is all that is asked for");
    return say(WR_VERDICT_RUN, why,
               ask->dials->harmonics == 1
                   ? "diffuse light of them turns with the normal: by 4 coefficients"
                   : "diffuse light of them turns with the normal: by 9 coefficients");
}

void wr_settle_harmonics(WrPlan *plan, const WrPlanRequest *ask)
{
    plan->harmonics = runs(plan, WR_EFFECT_HARMONICS) ? ask->dials->harmonics : 0;
}

void wr_settle_blur(WrPlan *plan, const WrPlanRequest *ask)
{
    plan->gloss = runs(plan, WR_EFFECT_BLUR) ? ask->dials->gloss : 0;
}

WrVerdict wr_decide_mirror(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const WrMaterial *m = &ask->scene->material;
    (void)plan;
    if (!ask->scene->environment.light)
        return say(WR_VERDICT_NONE, why, "the scene has no surroundings");
    if (!wr_reflects[m->model].shines)
        return say(WR_VERDICT_NONE, why, "the reflection model has no highlight");
    if (!shine(ask->scene)) return say(WR_VERDICT_SPARED, why, "no light comes from them");
    if (m->specular == 0) return say(WR_VERDICT_SPARED, why, "specular is 0");
    if (lacks_highlight(m)) return say(WR_VERDICT_SPARED, why, "facets of index 1 reflect nothing");
    return say(WR_VERDICT_RUN, why, "they are seen about the mirrored direction");
}

WrVerdict wr_decide_blur(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    WrEnvironmentBrdf gloss;
    if (!runs(plan, WR_EFFECT_MIRROR))
        return say(WR_VERDICT_NONE, why, "no surroundings are seen in the surface");
    if (ask->scene->environment.light->even)
        return say(WR_VERDICT_SPARED, why, "surroundings of one colour are the same when blurred");
    wr_scene_gloss(&ask->scene->material, &gloss);
    const bool widened = roughens(ask->scene) || ask->dials->aa == WR_AA_MOMENTS;
    if (gloss.alpha <= WR_ALPHA_LEAST && !widened)
        return say(WR_VERDICT_SPARED, why,
                   "so smooth a surface mirrors: its lobe is a thousandth wide");
    if (widened)
        return say(WR_VERDICT_RUN, why,
                   "what is reflected is blurred as widely as each sample calls for");
    return say(WR_VERDICT_RUN, why, "what is reflected is blurred by the material's lobe, once");
}

bool wr_plan_surround_turns(const WrPlan *plan, const WrScene *scene)
{
    if (runs(plan, WR_EFFECT_MIRROR)) return true;
    if (!runs(plan, WR_EFFECT_SURROUND)) return false;
    return runs(plan, WR_EFFECT_HARMONICS) ||
           wr_reflects[scene->material.model].diffuse != WR_DIFFUSE_LAMBERT;
}

bool wr_plan_graded(const WrPlan *plan, const WrScene *scene)
{
    WrEnvironmentBrdf gloss;
    wr_scene_gloss(&scene->material, &gloss);
    const bool narrow = gloss.alpha < WR_BLUR_LEAST; /* too narrow for a separate blurred picture */
    const bool blurred = runs(plan, WR_EFFECT_BLUR) && (runs(plan, WR_EFFECT_SPREAD) || narrow);
    return runs(plan, WR_EFFECT_MIRROR) && (blurred || runs(plan, WR_EFFECT_VARIED));
}
