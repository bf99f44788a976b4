/* Plan rows of ray intersection and surface geometry. */
#include "render/plan/plan_internal.h"

#include "scene/scene.h"
#include "surface/triangles.h"

/* ---- visibility ---- */

/* Closed and seen from outside: every ray that leaves the body has entered it before, nearer to the eye. So no
   back is visible. */
static bool is_closed(const WrPlanRequest *ask)
{
    const WrSurfaceInfo *info = surface_of(ask);
    if (info->held) return ask->scene->triangles && ask->scene->triangles->closed;
    return info->convex_closed || (info->closed_u && info->closed_v);
}

static bool is_held(const WrPlanRequest *ask)
{
    return surface_of(ask)->inversion == WR_INVERT_TRIANGLES;
}

WrVerdict wr_decide_back(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (runs(plan, WR_EFFECT_DISPLACED))
        return say(WR_VERDICT_RUN, why,
                   "a displaced surface may overlap itself: its back may be visible");
    if (!is_closed(ask))
        return say(WR_VERDICT_RUN, why, "the surface is open: its back may be visible");
    if (!ask->facts.outside)
        return say(WR_VERDICT_RUN, why,
                   "the eye may be inside the body: its inner walls may be visible");
    return say(WR_VERDICT_SPARED, why, "a closed body seen from outside hides its back faces");
}

WrVerdict wr_decide_depth(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (runs(plan, WR_EFFECT_DISPLACED))
        return say(WR_VERDICT_RUN, why, "facets of the displaced surface hide others");
    if (surface_of(ask)->inversion != WR_INVERT_MESH && !is_held(ask))
        return say(WR_VERDICT_NONE, why, "the nearest intersection of the ray is enough");
    if (ask->facts.uv_cached || ask->facts.relight)
        return say(WR_VERDICT_SPARED, why, "the view is at rest: its visible points are stored");
    return say(WR_VERDICT_RUN, why, "parts of the surface may hide others");
}

void wr_settle_depth(WrPlan *plan, const WrPlanRequest *ask)
{
    plan->inversion =
        runs(plan, WR_EFFECT_DISPLACED) ? WR_INVERT_TRIANGLES : surface_of(ask)->inversion;
    if (plan->inversion == WR_INVERT_MESH) plan->mesh = ask->dials->mesh;
}

WrVerdict wr_decide_newton(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (plan->inversion == WR_INVERT_TRIANGLES)
        return say(WR_VERDICT_NONE, why,
                   "rays hit triangles in closed form, and patches near them in a few steps");
    if (plan->inversion != WR_INVERT_MESH)
        return say(WR_VERDICT_NONE, why, "rays hit this surface in closed form");
    if (ask->facts.uv_cached || ask->facts.relight)
        return say(WR_VERDICT_SPARED, why, "the view is at rest: u and v are stored");
    return say(WR_VERDICT_RUN, why, "this surface has no closed inverse");
}

void wr_settle_newton(WrPlan *plan, const WrPlanRequest *ask)
{
    if (!runs(plan, WR_EFFECT_NEWTON)) return;
    plan->newton = ask->dials->newton;
    plan->texels = ask->dials->texels;
}

WrVerdict wr_decide_perspective(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    (void)plan;
    if (ask->scene->camera.orthographic)
        return say(WR_VERDICT_NONE, why, "the camera is orthographic");
    return say(WR_VERDICT_RUN, why, "the camera is in perspective");
}

/* Not with a bound, which reads blocks of texels beyond those that the picture uses.
   E29: the tiles' boxes of texture positions (dirty_regions.h) hold for the samples that were rendered, not
   for those of a bound. */
WrVerdict wr_decide_again(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (runs(plan, WR_EFFECT_DISPLACED))
        return say(WR_VERDICT_RUN, why,
                   "an edit moves the displaced surface: facets are made again");
    if (!ask->facts.rests || runs(plan, WR_EFFECT_BOUND))
        return say(WR_VERDICT_RUN, why, "a new picture: every tile is rendered");
    return say(WR_VERDICT_SPARED, why,
               "the view is at rest: only tiles that an edit reached are rendered");
}

WrVerdict wr_decide_relight(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (!plan->normals) return say(WR_VERDICT_NONE, why, "no light depends on the normal");
    const char *status = ask->facts.relight_status;
    if (ask->facts.relight) return say(WR_VERDICT_SPARED, why, status);
    return say(WR_VERDICT_RUN, why, status ? status : "points and normals have changed");
}

/* ---- surface geometry ---- */

/* Sphere, cylinder, cone: the point follows from the ray alone. u and v are an extra step with an arc tangent,
   which may be omitted; the point of all other surfaces is found at (u, v). */

static bool is_round(const WrPlanRequest *ask)
{
    const WrInversion inversion = surface_of(ask)->inversion;
    return inversion == WR_INVERT_SPHERE || inversion == WR_INVERT_CYLINDER ||
           inversion == WR_INVERT_CONE;
}

WrVerdict wr_decide_parameters(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (runs(plan, WR_EFFECT_DISPLACED))
        return say(WR_VERDICT_RUN, why, "the displaced surface's frame needs them");
    if (runs(plan, WR_EFFECT_PARALLAX) && is_round(ask))
        return say(WR_VERDICT_RUN, why, "rays continue from there to the relief");
    if (!is_round(ask) && !is_held(ask))
        return say(WR_VERDICT_NONE, why, "rays hit this surface at u and v");
    if (plan->source != WR_SOURCE_NONE || runs(plan, WR_EFFECT_COLOUR) ||
        runs(plan, WR_EFFECT_NORMALS) || runs(plan, WR_EFFECT_OCCLUSION) ||
        runs(plan, WR_EFFECT_FACETS))
        return say(WR_VERDICT_RUN, why, "the table, a formula or a picture is evaluated there");
    if (plan->grain != WR_SOLID_TEXTURE_OFF && plan->sampling == WR_SAMPLING_ADAPTIVE)
        return say(WR_VERDICT_RUN, why, "the footprint in the solid texture needs them");
    if (runs(plan, WR_EFFECT_CURVATURE) || runs(plan, WR_EFFECT_BOUND))
        return say(WR_VERDICT_RUN, why, "second derivatives or bounds need them");
    return say(WR_VERDICT_SPARED, why, "nothing is evaluated at u and v");
}

WrVerdict wr_decide_tangents(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if ((runs(plan, WR_EFFECT_DISPLACED) && !is_held(ask)) || runs(plan, WR_EFFECT_PARALLAX) ||
        (!is_round(ask) && !is_held(ask)))
        return say(WR_VERDICT_NONE, why, "the surface's formula returns them with the point");
    if (!plan->normals) return say(WR_VERDICT_NONE, why, "no light depends on the normal");
    if (plan->bump != WR_BUMP_NONE || runs(plan, WR_EFFECT_FILTER))
        return say(WR_VERDICT_RUN, why, "slopes tilt the normal along them");
    if (runs(plan, WR_EFFECT_TINT))
        return say(WR_VERDICT_RUN, why, "the colour picture's footprints need them");
    if (plan->facets_filtered)
        return say(WR_VERDICT_RUN, why, "footprints of roughness maps need them");
    if (runs(plan, WR_EFFECT_BOUND)) return say(WR_VERDICT_RUN, why, "bounds need them");
    return say(WR_VERDICT_SPARED, why, "no slope tilts the normal");
}

/* ---- among several objects ---- */

WrVerdict wr_decide_hidden(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    (void)plan;
    if (ask->facts.among <= 1) return say(WR_VERDICT_NONE, why, "there is one visible object");
    return say(
        WR_VERDICT_SPARED, why,
        "objects are drawn front to back; in tiles that one fills, objects behind it are skipped");
}

WrVerdict wr_decide_between(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    (void)plan;
    if (ask->facts.among <= 1) return say(WR_VERDICT_NONE, why, "there is one visible object");
    return say(WR_VERDICT_RUN, why, "objects may hide others where their outlines meet");
}

/* E67: the horizon's pixels cover an unbounded part of the plane, so no number of samples would converge. */
WrVerdict wr_decide_horizon(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    (void)plan;
    if (!wr_shape_endless(&ask->scene->shape))
        return say(WR_VERDICT_NONE, why, "the surface ends within the pixel");
    if (ask->scene->camera.orthographic)
        return say(WR_VERDICT_NONE, why,
                   "parallel rays: every pixel covers the same area of the plane");
    return say(WR_VERDICT_RUN, why, "the plane is endless, and fades at the horizon");
}

/* ---- mesh files ---- */

static const char not_held[] = "the surface is not a mesh from a file";

WrVerdict wr_decide_smooth(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const WrTriangles *mesh = ask->scene->triangles;
    (void)plan;
    if (!is_held(ask)) return say(WR_VERDICT_NONE, why, not_held);
    if (!plan->normals) return say(WR_VERDICT_SPARED, why, "no light depends on the normal");
    if (mesh && mesh->patches)
        return say(WR_VERDICT_RUN, why, "normals are computed from the patches");
    if (!mesh || mesh->faceted)
        return say(WR_VERDICT_SPARED, why, "the three normals of each triangle are equal");
    return say(WR_VERDICT_RUN, why, "the normals at the corners of triangles differ");
}

WrVerdict wr_decide_blocks(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (!is_held(ask)) return say(WR_VERDICT_NONE, why, not_held);
    if (runs(plan, WR_EFFECT_BACK))
        return say(WR_VERDICT_RUN, why,
                   "back faces are drawn: blocks that face away may be visible");
    return say(WR_VERDICT_SPARED, why,
               "blocks whose normals all face away from the eye have only back faces");
}
