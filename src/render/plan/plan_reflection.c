/* Plan rows of microfacet highlights, of the energy they leave to diffuse light, and of runs that may skip them. */
#include "render/plan/plan_internal.h"

#include "scene/scene.h"

/* ---- energy left for diffuse light ---- */

WrVerdict wr_decide_kept(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const WrMaterial *m = &ask->scene->material;
    if (!wr_reflect_shares(&wr_reflects[m->model], m->energy == WR_ENERGY_KEPT))
        return say(WR_VERDICT_NONE, why,
                   "the material's diffuse light does not go by its highlight");
    if (!runs(plan, WR_EFFECT_MODEL)) return say(WR_VERDICT_NONE, why, "no light is worked out");
    if (!runs(plan, WR_EFFECT_DIFFUSE))
        return say(WR_VERDICT_SPARED, why, "there is no diffuse light beside the highlight");
    return say(WR_VERDICT_RUN, why, "diffuse light is what the highlight leaves of what came");
}

void wr_settle_kept(WrPlan *plan, const WrPlanRequest *ask)
{
    const WrMaterial *m = &ask->scene->material;
    plan->kept = m->energy == WR_ENERGY_KEPT &&
                 (!wr_reflect_shares(&wr_reflects[m->model], true) || runs(plan, WR_EFFECT_KEPT));
}

/* ---- runs of samples ---- */

WrVerdict wr_decide_widened(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    (void)ask;
    if (!runs(plan, WR_EFFECT_SPREAD)) return say(WR_VERDICT_NONE, why, "no highlight is widened");
    return say(WR_VERDICT_SPARED, why,
               "runs of samples over which no slopes spread have their highlights as they are");
}

/* Reason why no microfacet model runs, or NULL. */
static const char *no_facets(const WrPlan *plan)
{
    if (!runs(plan, WR_EFFECT_MODEL) || !wr_reflects[plan->model].facets)
        return "highlights are not of facets";
    return NULL;
}

WrVerdict wr_decide_faced(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const char *reason = no_facets(plan);
    (void)ask;
    if (reason) return say(WR_VERDICT_NONE, why, reason);
    if (runs(plan, WR_EFFECT_VARIED))
        return say(WR_VERDICT_RUN, why, "where roughness goes by place it is not asked");
    return say(WR_VERDICT_SPARED, why,
               "runs of samples whose normals all face the viewer have none to bend");
}

WrVerdict wr_decide_faint(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const char *reason = no_facets(plan);
    if (reason) return say(WR_VERDICT_NONE, why, reason);
    if (ask->dials->faint == 0)
        return say(WR_VERDICT_NONE, why, "the dial keeps highlights however faint they are");
    if (!runs(plan, WR_EFFECT_SPECULAR))
        return say(WR_VERDICT_NONE, why, "no highlight is worked out");
    if (runs(plan, WR_EFFECT_VARIED))
        return say(WR_VERDICT_NONE, why, "where roughness goes by place they are not bounded");
    return say(WR_VERDICT_SPARED, why,
               "highlights below `faint` are none; runs that have no other are not worked out");
}

void wr_settle_faint(WrPlan *plan, const WrPlanRequest *ask)
{
    const bool spared = plan->rows[WR_EFFECT_FAINT].verdict == WR_VERDICT_SPARED;
    plan->faint = spared && !runs(plan, WR_EFFECT_FAINT) ? ask->dials->faint : 0;
}
