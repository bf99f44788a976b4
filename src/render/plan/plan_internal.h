/* plan_internal.h - functions shared by the plan's row files, and those that the view uses. Private to
   src/render. */
#pragma once
#include "render/plan/plan.h"
#include "scene/scene.h"
#include "surface/triangles.h"

/* Above this, r u loses more than 1e-3 texel of a 64-texel table in single precision (HC40). */
#define WR_WIDE_FROM 1024.0

static inline WrVerdict say(WrVerdict call, const char **why, const char *reason)
{
    *why = reason;
    return call;
}

static inline bool runs(const WrPlan *plan, WrEffect effect)
{
    return wr_plan_runs(plan, effect);
}

static inline bool light_shines(const WrLight *light)
{
    const WrVec3 c = light->colour;
    return light->strength != 0 && (c.x != 0 || c.y != 0 || c.z != 0);
}

static inline const WrSurfaceInfo *surface_of(const WrPlanRequest *ask)
{
    return wr_surfaces[ask->scene->shape.kind];
}

static inline bool wants_filter(const WrDials *dials)
{
    return dials->aa == WR_AA_FILTER || dials->aa == WR_AA_MOMENTS;
}

/* True if the solid texture drives roughness. A roughness picture has priority. */
static inline bool grain_roughens(const WrScene *scene)
{
    return scene->grain.kind != WR_SOLID_TEXTURE_OFF &&
           scene->grain.drives & WR_SOLID_TEXTURE_ROUGHENS &&
           !scene->facets[WR_FACET_ROUGHNESS].image && wr_reflects[scene->material.model].roughness;
}

/* True if the material's roughness varies over the surface. */
static inline bool roughens(const WrScene *scene)
{
    return grain_roughens(scene) || (scene->facets[WR_FACET_ROUGHNESS].image &&
                                     wr_reflects[scene->material.model].roughness);
}

/* True if the model reflects only diffuse light, because of its ior. */
static inline bool lacks_highlight(const WrMaterial *m)
{
    return wr_reflects[m->model].highlight == WR_HIGHLIGHT_CAVITIES && m->ior == 1;
}

static inline bool metal_varies(const WrScene *scene)
{
    return wr_reflects[scene->material.model].metalness && scene->facets[WR_FACET_METALNESS].image;
}

/* True if the material is metal everywhere, so that it has no diffuse reflection. */
static inline bool all_metal(const WrScene *scene)
{
    return wr_reflects[scene->material.model].metalness && scene->material.metalness == 1 &&
           !metal_varies(scene);
}

/* True if environment light depends on n'. */
bool wr_plan_surround_turns(const WrPlan *plan, const WrScene *scene);

/* True if the mirrored environment is blurred individually for each sample. */
bool wr_plan_graded(const WrPlan *plan, const WrScene *scene);

/* True if anything depends on n'. */
static inline bool lit(const WrPlan *plan, const WrPlanRequest *ask)
{
    return runs(plan, WR_EFFECT_DIFFUSE) || runs(plan, WR_EFFECT_SPECULAR) || ask->facts.normals ||
           wr_plan_surround_turns(plan, ask->scene);
}

static inline bool still(const WrScene *scene)
{
    return scene->replicate_u == 0 && scene->replicate_v == 0;
}

/* True if F is weighted over the mesh, by masks or blended planes (relief_weights.h): it has slopes where the table has
   none, and is read at other (u,v) than the surface's. */
static inline bool wr_plan_is_weighted(const WrScene *scene)
{
    return scene->triangles && scene->triangles->weights;
}

/* Functions of WrEffectInfo's rows. They are in plan.c, plan_light.c, plan_textures.c and plan_visibility.c. */
typedef WrVerdict WrDecide(const WrPlan *plan, const WrPlanRequest *ask, const char **why);
typedef void WrSettle(WrPlan *plan, const WrPlanRequest *ask);
WrDecide wr_decide_back, wr_decide_depth, wr_decide_newton, wr_decide_perspective, wr_decide_again,
    wr_decide_relight, wr_decide_parameters, wr_decide_tangents, wr_decide_hidden,
    wr_decide_between, wr_decide_beside, wr_decide_dark, wr_decide_ground, wr_decide_colour,
    wr_decide_tint, wr_decide_smooth, wr_decide_blocks, wr_decide_horizon, wr_decide_normals,
    wr_decide_diffuse, wr_decide_specular, wr_decide_model, wr_decide_shadow, wr_decide_cast,
    wr_decide_occlusion, wr_decide_filter, wr_decide_surround, wr_decide_harmonics,
    wr_decide_mirror, wr_decide_blur, wr_decide_displaced, wr_decide_parallax, wr_decide_exact,
    wr_decide_curvature, wr_decide_grain, wr_decide_octaves, wr_decide_faded, wr_decide_embossed,
    wr_decide_facets, wr_decide_varied, wr_decide_samples, wr_decide_bound, wr_decide_kept,
    wr_decide_widened, wr_decide_faced, wr_decide_faint, wr_decide_reoriented;
WrSettle wr_settle_filter, wr_settle_depth, wr_settle_newton, wr_settle_tint, wr_settle_normals,
    wr_settle_facets, wr_settle_model, wr_settle_cast, wr_settle_occlusion, wr_settle_harmonics,
    wr_settle_blur, wr_settle_displaced, wr_settle_parallax, wr_settle_exact, wr_settle_curvature,
    wr_settle_grain, wr_settle_samples, wr_settle_kept, wr_settle_faint, wr_settle_reoriented;

/* The formula that bends the normal: the scene's, or the exact one of a displaced surface. */
WrBumpMode wr_plan_normal(const WrPlan *plan, const WrPlanRequest *ask);
