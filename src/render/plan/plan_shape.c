/* Plan rows of the table's effect on the surface: displacement, or bending of the normal, and by which formula. */
#include "render/plan/plan_internal.h"

#include "field/analytic.h"
#include "render/shadows/shadow_rays.h"
#include "scene/scene.h"
#include "surface/triangles.h"

#define SEEN 0.5 /* pixels: bump suffices for a smaller displacement (E21, E50) */

WrVerdict wr_decide_displaced(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const WrScene *scene = ask->scene;
    (void)plan;
    if (!scene->displaced) return say(WR_VERDICT_NONE, why, "the table turns the normal alone");
    const char *reason = wr_shape_unmoved(&scene->shape);
    if (reason) return say(WR_VERDICT_NONE, why, reason);
    if (scene->height == 0) return say(WR_VERDICT_SPARED, why, "height is 0: F is 0");
    if (scene->analytic.kind == WR_ANALYTIC_OFF && ask->facts.zero)
        return say(WR_VERDICT_SPARED, why, "the table is 0 everywhere");
    /* Shadow rays intersect facets of P + F n, however low it is. Started from the base, all rays would be
       blocked, or none. */
    const bool met = wr_shadow_rays_asked(scene) && ask->dials->rays > 0;
    if (ask->facts.rise >= 0 && ask->facts.rise < SEEN && !met)
        return say(WR_VERDICT_SPARED, why, "F moves no point by half a pixel: bump looks the same");
    return say(WR_VERDICT_RUN, why, "F moves the surface: facets of P + F n are seen");
}

void wr_settle_displaced(WrPlan *plan, const WrPlanRequest *ask)
{
    if (runs(plan, WR_EFFECT_DISPLACED)) plan->dice = ask->dials->dice;
}

WrVerdict wr_decide_parallax(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const WrScene *scene = ask->scene;
    if (!scene->parallax) return say(WR_VERDICT_NONE, why, "rays end at the base");
    if (runs(plan, WR_EFFECT_DISPLACED))
        return say(WR_VERDICT_NONE, why, "the surface itself is displaced: rays meet its facets");
    const char *reason = wr_shape_without_parallax(&scene->shape);
    if (reason) return say(WR_VERDICT_NONE, why, reason);
    if (scene->height == 0) return say(WR_VERDICT_SPARED, why, "height is 0: F is 0");
    if (scene->analytic.kind == WR_ANALYTIC_OFF && ask->facts.zero)
        return say(WR_VERDICT_SPARED, why, "the table is 0 everywhere");
    if (ask->facts.rise >= 0 && ask->facts.rise < SEEN)
        return say(WR_VERDICT_SPARED, why, "F moves no point by half a pixel: bump looks the same");
    return say(WR_VERDICT_RUN, why, "rays go on from the base to the relief");
}

void wr_settle_parallax(WrPlan *plan, const WrPlanRequest *ask)
{
    if (runs(plan, WR_EFFECT_PARALLAX)) plan->steps = ask->dials->steps;
}

WrBumpMode wr_plan_normal(const WrPlan *plan, const WrPlanRequest *ask)
{
    return runs(plan, WR_EFFECT_DISPLACED) ? WR_BUMP_EXACT : ask->scene->bump;
}

/* True if the mesh is cut from patches. */
static bool is_cut(const WrPlanRequest *ask)
{
    return ask->scene->triangles && ask->scene->triangles->patches;
}

WrVerdict wr_decide_exact(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (wr_plan_normal(plan, ask) != WR_BUMP_EXACT)
        return say(WR_VERDICT_NONE, why, "bump mode is not exact");
    if (!runs(plan, WR_EFFECT_BUMP)) return say(WR_VERDICT_NONE, why, "bump does not run");
    if (surface_of(ask)->held)
        return say(WR_VERDICT_NONE, why,
                   is_cut(ask) ? "on sets of patches blinn takes the exact normal's place"
                               : "triangles are flat: blinn is exact on them for any F");
    if (surface_of(ask)->flat)
        return say(WR_VERDICT_SPARED, why, "the base is flat: blinn is exact there for any F");
    return say(WR_VERDICT_RUN, why,
               runs(plan, WR_EFFECT_DISPLACED)
                   ? "the surface is displaced: its own normal is the exact one"
                   : "bump mode is exact and the base is curved");
}

void wr_settle_exact(WrPlan *plan, const WrPlanRequest *ask)
{
    (void)ask;
    if (runs(plan, WR_EFFECT_EXACT)) plan->bump = WR_BUMP_EXACT;
}

WrVerdict wr_decide_curvature(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (surface_of(ask)->held)
        return say(WR_VERDICT_NONE, why,
                   is_cut(ask) ? "only the exact normal needs them"
                               : "triangles are flat: there are none");
    if (runs(plan, WR_EFFECT_EXACT))
        return say(WR_VERDICT_RUN, why, "the exact normal needs how n turns");
    return say(WR_VERDICT_SPARED, why, "only the exact normal needs them");
}

void wr_settle_curvature(WrPlan *plan, const WrPlanRequest *ask)
{
    plan->normals = lit(plan, ask) || runs(plan, WR_EFFECT_BUMP) ||
                    runs(plan, WR_EFFECT_CURVATURE) || runs(plan, WR_EFFECT_TINT) ||
                    runs(plan, WR_EFFECT_NORMALS) || runs(plan, WR_EFFECT_GRAIN) ||
                    runs(plan, WR_EFFECT_EMBOSSED);
}
