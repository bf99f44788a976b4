/* Plan rows of light: diffuse reflection, highlights, and the reflection model. */
#include "render/plan/plan_internal.h"

#include "field/horizon.h"
#include "render/shadows/shadow_rays.h"
#include "scene/scene.h"

static bool any_light(const WrScene *scene)
{
    for (int i = 0; i < scene->light_count; i++)
        if (light_shines(&scene->lights[i])) return true;
    return false;
}

WrVerdict wr_decide_diffuse(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const WrMaterial *m = &ask->scene->material;
    (void)plan;
    if (!any_light(ask->scene)) return say(WR_VERDICT_SPARED, why, "no light shines");
    if (m->diffuse == 0) return say(WR_VERDICT_SPARED, why, "diffuse is 0");
    if (all_metal(ask->scene))
        return say(WR_VERDICT_SPARED, why, "a metal has no diffuse reflection");
    if (m->colour.x == 0 && m->colour.y == 0 && m->colour.z == 0)
        return say(WR_VERDICT_SPARED, why, "the material's colour is black");
    return say(WR_VERDICT_RUN, why, "a light shines and diffuse is not 0");
}

WrVerdict wr_decide_specular(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    (void)plan;
    if (!any_light(ask->scene)) return say(WR_VERDICT_SPARED, why, "no light shines");
    const WrMaterial *m = &ask->scene->material;
    if (!wr_reflects[m->model].shines)
        return say(WR_VERDICT_SPARED, why, "the reflection model has no highlight");
    if (lacks_highlight(m)) return say(WR_VERDICT_SPARED, why, "facets of index 1 reflect nothing");
    if (m->specular == 0) return say(WR_VERDICT_SPARED, why, "specular is 0");
    return say(WR_VERDICT_RUN, why, "a light shines and specular is not 0");
}

/* Reason why another model equals Blinn-Phong's stages, or NULL. */
static const char *same_model(const WrPlan *plan, const WrScene *scene)
{
    const WrMaterial *m = &scene->material;
    const bool shines = wr_reflects[m->model].shines && runs(plan, WR_EFFECT_SPECULAR);
    const WrReflectDiffuse diffuse = wr_reflects[m->model].diffuse;
    if (diffuse == WR_DIFFUSE_ROUGH && m->roughness == 0 && !roughens(scene) && !shines)
        return "facets of roughness 0 are matt as a whole: Lambert's";
    if (diffuse == WR_DIFFUSE_LAMBERT && !shines) return "without a highlight it is Lambert's";
    return NULL;
}

WrVerdict wr_decide_model(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const WrMaterial *m = &ask->scene->material;
    if (m->model == WR_REFLECT_DEFAULT && m->tint == 0)
        return say(WR_VERDICT_NONE, why, "the material is Blinn-Phong's, its highlight white");
    if (!runs(plan, WR_EFFECT_SPECULAR) && !runs(plan, WR_EFFECT_DIFFUSE))
        return say(WR_VERDICT_NONE, why, "no light is worked out");
    const char *reason = same_model(plan, ask->scene);
    if (reason) return say(WR_VERDICT_SPARED, why, reason);
    return say(WR_VERDICT_RUN, why,
               m->model == WR_REFLECT_DEFAULT ? "the highlight has the material's colour"
                                              : wr_reflects[m->model].help);
}

void wr_settle_model(WrPlan *plan, const WrPlanRequest *ask)
{
    const WrMaterial *m = &ask->scene->material;
    const bool run = runs(plan, WR_EFFECT_MODEL);
    plan->model = run ? m->model : WR_REFLECT_DEFAULT;
    plan->tint = run && runs(plan, WR_EFFECT_SPECULAR) ? m->tint : 0;
}

/* True if light that depends on roughness is computed. */
static bool goes_by_facets(const WrPlan *plan)
{
    return runs(plan, WR_EFFECT_MODEL) || runs(plan, WR_EFFECT_SURROUND) ||
           runs(plan, WR_EFFECT_MIRROR);
}

WrVerdict wr_decide_facets(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const WrScene *scene = ask->scene;
    const bool rough = scene->facets[WR_FACET_ROUGHNESS].image;
    if (!rough && !scene->facets[WR_FACET_METALNESS].image)
        return say(WR_VERDICT_NONE, why, "the object has no picture of roughness or metalness");
    if (!(rough && roughens(scene)) && !metal_varies(scene))
        return say(WR_VERDICT_NONE, why, "the reflection model does not go by them");
    if (!goes_by_facets(plan))
        return say(WR_VERDICT_NONE, why, "no light is worked out that goes by them");
    return say(WR_VERDICT_RUN, why,
               wants_filter(ask->dials) ? "light goes by them: by their means over footprints"
                                        : "light goes by them");
}

void wr_settle_facets(WrPlan *plan, const WrPlanRequest *ask)
{
    plan->facets_filtered = runs(plan, WR_EFFECT_FACETS) && wants_filter(ask->dials);
    plan->facets_anisotropic =
        plan->facets_filtered && ask->dials->footprint == WR_FOOTPRINT_ANISOTROPIC;
}

WrVerdict wr_decide_varied(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const WrSolidTexture *grain = &ask->scene->grain;
    const bool driven =
        grain->kind != WR_SOLID_TEXTURE_OFF && grain->drives & WR_SOLID_TEXTURE_ROUGHENS;
    if (runs(plan, WR_EFFECT_FACETS)) return say(WR_VERDICT_RUN, why, "pictures tell it");
    if (!driven) return say(WR_VERDICT_NONE, why, "roughness is the same everywhere");
    if (!grain_roughens(ask->scene))
        return say(WR_VERDICT_NONE, why, "the reflection model goes by no roughness");
    if (!goes_by_facets(plan))
        return say(WR_VERDICT_NONE, why, "no light is worked out that goes by roughness");
    return say(WR_VERDICT_RUN, why, "the solid texture drives roughness");
}

/* Reason why the relief's horizons are not available, or NULL. */
static const char *no_horizon(const WrPlan *plan, const WrPlanRequest *ask)
{
    const WrVec3 sizes = ask->scene->sizes;
    int columns, rows;
    wr_surface_cells(&ask->scene->shape, &columns, &rows);
    if (plan->source == WR_SOURCE_FORMULA)
        return "the relief is a formula: only tables have shadows";
    if (surface_of(ask)->held) return "on meshes and patches the relief has no shadows yet";
    if (columns * rows != 1)
        return "where each face has its own part of the table it has no shadows yet";
    if (ask->facts.ends) return "the table ends at its edges: shadows are of tables that repeat";
    if (sizes.x != 0 || sizes.y != 0 || sizes.z != 0)
        return "the object is stretched along an axis: its relief has no shadows yet";
    return NULL;
}

/* True if every enabled lamp uses shadow rays against a displaced surface's own relief. */
static bool rays_tell(const WrPlan *plan, const WrPlanRequest *ask)
{
    bool all = runs(plan, WR_EFFECT_DISPLACED) && ask->dials->rays > 0;
    for (int i = 0; i < ask->scene->light_count; i++)
        all = all && (ask->scene->lights[i].shadow || !light_shines(&ask->scene->lights[i]));
    return all;
}

WrVerdict wr_decide_shadow(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (!ask->scene->material.shadow)
        return say(WR_VERDICT_NONE, why, "the material asks for no shadows");
    const char *reason = no_horizon(plan, ask);
    if (reason) return say(WR_VERDICT_NONE, why, reason);
    if (!runs(plan, WR_EFFECT_DIFFUSE) && !runs(plan, WR_EFFECT_SPECULAR))
        return say(WR_VERDICT_NONE, why, "no light is worked out");
    if (!runs(plan, WR_EFFECT_BUMP) || plan->source != WR_SOURCE_TABLE)
        return say(WR_VERDICT_NONE, why, "there is no relief to throw any");
    if (rays_tell(plan, ask))
        return say(WR_VERDICT_NONE, why, "rays to the lamps meet the displaced surface itself");
    return say(WR_VERDICT_RUN, why, "lamps below the relief's horizon are hidden");
}

WrVerdict wr_decide_cast(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (!wr_shadow_rays_asked(ask->scene))
        return say(WR_VERDICT_NONE, why, "no light asks for them");
    if (ask->dials->rays == 0)
        return say(WR_VERDICT_NONE, why, "the dial lets no ray go to a lamp");
    if (!runs(plan, WR_EFFECT_DIFFUSE) && !runs(plan, WR_EFFECT_SPECULAR))
        return say(WR_VERDICT_NONE, why, "no light is worked out");
    if (ask->facts.hiders > 0)
        return say(WR_VERDICT_RUN, why, "an object can stand between this one and a lamp");
    return say(
        WR_VERDICT_SPARED, why,
        ask->facts.among > 1
            ? "no object's ball stands between this one's and a lamp, and it hides none itself"
            : "a convex or flat object alone hides no lamp from itself");
}

void wr_settle_cast(WrPlan *plan, const WrPlanRequest *ask)
{
    if (runs(plan, WR_EFFECT_CAST)) plan->rays = ask->dials->rays;
}

/* True if there is light that ambient occlusion reduces: ambient light, and that of the environment. */
static bool has_sky(const WrPlan *plan, const WrMaterial *m)
{
    return m->ambient != 0 || runs(plan, WR_EFFECT_SURROUND);
}

WrVerdict wr_decide_occlusion(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (!ask->scene->material.occlusion)
        return say(WR_VERDICT_NONE, why, "the material asks for no occlusion");
    const char *reason = no_horizon(plan, ask);
    if (reason) return say(WR_VERDICT_NONE, why, reason);
    if (ask->scene->height == 0 || still(ask->scene) || ask->facts.flat || ask->facts.zero)
        return say(WR_VERDICT_NONE, why, "there is no relief to hide any sky");
    if (!has_sky(plan, &ask->scene->material))
        return say(WR_VERDICT_SPARED, why, "there is neither ambient light nor surroundings");
    return say(WR_VERDICT_RUN, why, "hollows of the relief see less of the sky");
}

void wr_settle_occlusion(WrPlan *plan, const WrPlanRequest *ask)
{
    const int n = ask->dials->horizons / WR_HORIZON_LEAST * WR_HORIZON_LEAST;
    if (runs(plan, WR_EFFECT_OCCLUSION) || runs(plan, WR_EFFECT_SHADOW)) plan->horizons = n;
}
