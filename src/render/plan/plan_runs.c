/* Plan rows of partial skipping: runs of samples without bump or light, and the area beside the object. These
   rows change the method, never the picture. */
#include "render/plan/plan_internal.h"

#include "scene/scene.h"

/* From this share of sloped tiles on, runs over flat parts are too rare to test for. */
#define MOSTLY_SLOPED 0.75

/* True if it runs only because it is forced. Then it runs everywhere. */
static bool is_forced(const WrPlan *plan, WrEffect effect)
{
    return runs(plan, effect) && plan->rows[effect].verdict != WR_VERDICT_RUN;
}

/* ---- flat parts of the table ---- */

/* Reason why bump cannot be skipped in runs whose slopes are 0, or NULL if it can. */
static const char *no_ground(const WrPlan *plan)
{
    if (is_forced(plan, WR_EFFECT_BUMP)) return "bump is forced: it runs everywhere";
    if (runs(plan, WR_EFFECT_NORMALS)) return "a normal map has slopes where the table has none";
    if (plan->bump == WR_BUMP_EXACT) return "the exact normal turns with heights, not slopes alone";
    if (wr_schemes[plan->scheme].taps == WR_TAPS_FITTED)
        return "this scheme's coefficients each reach over the whole table";
    if (runs(plan, WR_EFFECT_FILTER)) return "a footprint may reach over any of the table";
    if (runs(plan, WR_EFFECT_TINT)) return "the colour picture's footprints go by tangents";
    if (plan->facets_filtered) return "footprints of pictures of roughness go by tangents";
    if (plan->precision != WR_PRECISION_SINGLE)
        return "slopes of single precision say nothing of those in double";
    return NULL;
}

WrVerdict wr_decide_ground(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (plan->source != WR_SOURCE_TABLE) return say(WR_VERDICT_NONE, why, "no table is looked up");
    const char *reason = no_ground(plan);
    if (reason) return say(WR_VERDICT_RUN, why, reason);
    const double sloped = ask->facts.sloped;
    if (!(sloped >= 0 && sloped < MOSTLY_SLOPED))
        return say(WR_VERDICT_RUN, why, "most of the table has slopes: asking is not worth it");
    return say(WR_VERDICT_SPARED, why,
               "much of the table is level: runs of samples there have no bump");
}

/* ---- the dark side ---- */

/* Reason why the bound on bump's rotation of the normal cannot be used to skip light, or NULL if it can. */
static const char *no_cone(const WrPlan *plan)
{
    if (runs(plan, WR_EFFECT_DISPLACED)) return "facets of a displaced surface face anywhere";
    if (runs(plan, WR_EFFECT_PARALLAX)) return "what parallax shows may stand on either side";
    if (runs(plan, WR_EFFECT_EMBOSSED)) return "no bound is known of a solid texture's slopes";
    if (plan->bump == WR_BUMP_NONE) return NULL;
    if (is_forced(plan, WR_EFFECT_BUMP)) return "bump is forced: it runs everywhere";
    if (runs(plan, WR_EFFECT_NORMALS)) return "no bound is known of a normal map's slopes";
    if (plan->bump != WR_BUMP_BLINN) return "no bound is known of how far this normal turns";
    if (!runs(plan, WR_EFFECT_GRADIENT) || runs(plan, WR_EFFECT_FILTER) ||
        plan->precision != WR_PRECISION_SINGLE)
        return "no bound is known of slopes but a gradient table's own";
    return NULL;
}

static const char *no_dark(const WrPlan *plan, const WrPlanRequest *ask)
{
    const bool shines = runs(plan, WR_EFFECT_SPECULAR);
    if (is_forced(plan, WR_EFFECT_DIFFUSE) || is_forced(plan, WR_EFFECT_SPECULAR))
        return "light is forced: it runs everywhere";
    if (v3_len(ask->scene->sizes) > 0) return "the object is stretched: its normals turn with it";
    if (ask->facts.normals) return "normals are wanted everywhere";
    if (runs(plan, WR_EFFECT_SURROUND) || runs(plan, WR_EFFECT_MIRROR))
        return "surroundings shine there too";
    if (shines && !ask->scene->material.gate) return "a highlight without gate shows there too";
    if (runs(plan, WR_EFFECT_BOUND)) return "a bound of the light's change is wanted everywhere";
    if (runs(plan, WR_EFFECT_HALF)) return "the dial asks for light in half precision";
    return no_cone(plan);
}

WrVerdict wr_decide_dark(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (!runs(plan, WR_EFFECT_DIFFUSE) && !runs(plan, WR_EFFECT_SPECULAR))
        return say(WR_VERDICT_NONE, why, "no light is worked out");
    const char *reason = no_dark(plan, ask);
    if (reason) return say(WR_VERDICT_RUN, why, reason);
    return say(WR_VERDICT_SPARED, why,
               "runs that all lights are behind, bump or not, have ambient light alone");
}

/* ---- beside the object ---- */

WrVerdict wr_decide_beside(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    (void)plan, (void)ask;
    return say(WR_VERDICT_SPARED, why,
               "only the part of a tile is drawn that the object may be on");
}
