/* Plan rows of sampling: samples per pixel, and the bound for taking fewer. */
#include "render/plan/plan_internal.h"

#include "render/textures/solid_texture_footprint.h"
#include "scene/scene.h"

static bool takes_grid(const WrDials *dials)
{
    return dials->aa == WR_AA_ADAPTIVE || dials->aa == WR_AA_SUPERSAMPLE;
}

/* True if a bound is requested but unknown. Where outlines meet, light may change by any amount. */
static bool unbounded(const WrPlanRequest *ask)
{
    return ask->facts.among > 1 && ask->dials->refine == WR_REFINE_BOUND;
}

WrVerdict wr_decide_samples(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const WrDials *dials = ask->dials;
    (void)plan;
    if (!takes_grid(dials))
        return say(WR_VERDICT_NONE, why, "the dial says one sample at the pixel's centre");
    if (dials->samples == 1) return say(WR_VERDICT_NONE, why, "one sample a pixel was asked for");
    if (dials->aa == WR_AA_ADAPTIVE && unbounded(ask))
        return say(WR_VERDICT_RUN, why,
                   "up to K x K were asked for: no bound is known of several objects");
    if (dials->aa == WR_AA_ADAPTIVE && ask->facts.lively)
        return say(WR_VERDICT_RUN, why,
                   "up to K x K were asked for: here fewer would cost more, so all are taken");
    return say(WR_VERDICT_RUN, why,
               dials->aa == WR_AA_SUPERSAMPLE
                   ? "the dial asks for the mean of K x K intensities"
                   : "up to K x K where one is not enough for `contrast`; a smooth view may be as "
                     "near with fewer");
}

void wr_settle_samples(WrPlan *plan, const WrPlanRequest *ask)
{
    const WrDials *dials = ask->dials;
    const bool run = runs(plan, WR_EFFECT_SAMPLES);
    plan->samples = run ? dials->samples : 1;
    const bool adaptive =
        dials->aa == WR_AA_ADAPTIVE && !ask->facts.lively && !unbounded(ask) &&
        (plan->grain == WR_SOLID_TEXTURE_OFF || wr_solid_texture_bounded(ask->scene));
    plan->sampling = !run ? WR_SAMPLING_ONE : adaptive ? WR_SAMPLING_ADAPTIVE : WR_SAMPLING_ALL;
    if (!run) return;
    plan->spread = dials->spread;
    plan->refine = dials->refine;
    plan->contrast = dials->contrast;
}

/* Reason why no bound on the change of intensity over a pixel is known, or NULL if one is. */
static const char *no_bound(const WrPlan *plan, const WrPlanRequest *ask)
{
    if (runs(plan, WR_EFFECT_SHADOW) || runs(plan, WR_EFFECT_CAST))
        return "no bound is known of shadows: K x K everywhere";
    if (ask->dials->shading == WR_SHADING_HALF)
        return "no bound is known of rounding to half precision: K x K everywhere";
    if (v3_len(ask->scene->sizes) > 0)
        return "no bound is known of a stretched object: K x K everywhere";
    if (runs(plan, WR_EFFECT_MODEL))
        return "no bound is known of this reflection: K x K everywhere";
    if (runs(plan, WR_EFFECT_SURROUND) || runs(plan, WR_EFFECT_MIRROR))
        return "no bound is known of light from surroundings: K x K everywhere";
    const WrInversion how = surface_of(ask)->inversion;
    if (runs(plan, WR_EFFECT_DISPLACED))
        return "no bound is known of a displaced surface: K x K everywhere";
    if (runs(plan, WR_EFFECT_PARALLAX)) return "no bound is known of parallax: K x K everywhere";
    if (how != WR_INVERT_PLANE && how != WR_INVERT_CUBE && how != WR_INVERT_SPHERE)
        return "no bound is known on this surface: K x K everywhere";
    if (runs(plan, WR_EFFECT_COLOUR))
        return "no bound is known for a colour picture: K x K everywhere";
    if (runs(plan, WR_EFFECT_GRAIN))
        return "no bound is known for a solid texture: K x K everywhere";
    if (runs(plan, WR_EFFECT_NORMALS))
        return "no bound is known for a normal map: K x K everywhere";
    if (plan->bump == WR_BUMP_NONE) return NULL;
    if (plan->bump != WR_BUMP_BLINN)
        return "no bound is known for this normal formula: K x K everywhere";
    if (!runs(plan, WR_EFFECT_GRADIENT))
        return "a bound needs slopes from a table, central or nearest: K x K everywhere";
    return NULL;
}

WrVerdict wr_decide_bound(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (ask->dials->aa != WR_AA_ADAPTIVE || plan->refine != WR_REFINE_BOUND)
        return say(WR_VERDICT_NONE, why, "the dials do not ask for a bound");
    const char *reason = no_bound(plan, ask);
    if (reason) return say(WR_VERDICT_NONE, why, reason);
    if (ask->facts.among > 1)
        return say(WR_VERDICT_NONE, why, "no bound is known of several objects: K x K everywhere");
    if (ask->facts.lively)
        return say(WR_VERDICT_NONE, why,
                   "bounds would spare too little of this view: K x K everywhere");
    return say(WR_VERDICT_RUN, why,
               "K x K only where the intensity may change by more than `contrast`");
}
