/* Plan rows of light: diffuse reflection, highlights, the reflection model, the energy that highlights leave to
   diffuse light, and runs that may skip highlights. */
#include "field/horizon.h"
#include "render/plan/plan_internal.h"
#include "render/shadows/shadow_rays.h"
#include "scene/scene.h"
#include "shade/environment_blur.h"

/* ---- energy left for diffuse light ---- */

WrVerdict wr_decide_kept(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const WrMaterial *m = &ask->scene->material;
    if (!wr_reflect_shares(&wr_reflects[m->model], m->energy == WR_ENERGY_KEPT))
        return say(WR_VERDICT_NONE, why,
                   "the material's diffuse light does not depend on its highlight");
    if (!runs(plan, WR_EFFECT_MODEL)) return say(WR_VERDICT_NONE, why, "no light is computed");
    if (!runs(plan, WR_EFFECT_DIFFUSE))
        return say(WR_VERDICT_SPARED, why, "there is no diffuse light besides the highlight");
    return say(WR_VERDICT_RUN, why, "diffuse light is the incoming light minus the highlight's");
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
               "runs of samples without a spread of slopes keep their highlights");
}

/* Reason why no microfacet model runs, or NULL. */
static const char *no_facets(const WrPlan *plan)
{
    if (!runs(plan, WR_EFFECT_MODEL) || !wr_reflects[plan->model].facets)
        return "the highlight is not from microfacets";
    return NULL;
}

WrVerdict wr_decide_faced(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const char *reason = no_facets(plan);
    (void)ask;
    if (reason) return say(WR_VERDICT_NONE, why, reason);
    if (runs(plan, WR_EFFECT_VARIED))
        return say(WR_VERDICT_RUN, why, "not decided where roughness varies over the surface");
    return say(WR_VERDICT_SPARED, why,
               "runs of samples whose normals all face the viewer need no bending");
}

WrVerdict wr_decide_faint(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const char *reason = no_facets(plan);
    if (reason) return say(WR_VERDICT_NONE, why, reason);
    if (ask->dials->faint == 0) return say(WR_VERDICT_NONE, why, "the dial keeps faint highlights");
    if (!runs(plan, WR_EFFECT_SPECULAR))
        return say(WR_VERDICT_NONE, why, "no highlight is computed");
    if (runs(plan, WR_EFFECT_VARIED))
        return say(WR_VERDICT_NONE, why, "with roughness by place they have no bound");
    return say(WR_VERDICT_SPARED, why,
               "highlights below `faint` are dropped; runs without others are skipped");
}

void wr_settle_faint(WrPlan *plan, const WrPlanRequest *ask)
{
    const bool spared = plan->rows[WR_EFFECT_FAINT].verdict == WR_VERDICT_SPARED;
    plan->faint = spared && !runs(plan, WR_EFFECT_FAINT) ? ask->dials->faint : 0;
}

/* ---- Plan rows of environment light ---- */

/* True if the environment sends any light.
   harmonic[0] is the mean of the light over all directions, up to a constant: 0 only if every texel is 0. */
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
        return say(WR_VERDICT_NONE, why, "the scene has no environment");
    if (!shine(ask->scene)) return say(WR_VERDICT_SPARED, why, "the environment is black");
    if (m->diffuse == 0) return say(WR_VERDICT_SPARED, why, "diffuse is 0");
    if (all_metal(ask->scene))
        return say(WR_VERDICT_SPARED, why, "a metal has no diffuse reflection");
    if (m->colour.x == 0 && m->colour.y == 0 && m->colour.z == 0)
        return say(WR_VERDICT_SPARED, why, "the material's colour is black");
    return say(WR_VERDICT_RUN, why, "light comes from all sides and diffuse is not 0");
}

/* Nine coefficients, bands 0 to 2, reproduce irradiance within about 1 % (Ramamoorthi, Hanrahan 2001): the cosine
   lobe has almost nothing in higher bands. One colour has band 0 alone. */
WrVerdict wr_decide_harmonics(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (!runs(plan, WR_EFFECT_SURROUND))
        return say(WR_VERDICT_NONE, why, "the environment gives no diffuse light");
    if (ask->scene->environment.light->even)
        return say(WR_VERDICT_SPARED, why,
                   "the environment has one colour: one coefficient is enough");
    if (ask->dials->harmonics == 0)
        return say(WR_VERDICT_NONE, why, "harmonics=0: only their mean is used");
    return say(WR_VERDICT_RUN, why,
               ask->dials->harmonics == 1
                   ? "its diffuse light depends on the normal: 4 coefficients"
                   : "its diffuse light depends on the normal: 9 coefficients");
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
        return say(WR_VERDICT_NONE, why, "the scene has no environment");
    if (!wr_reflects[m->model].shines)
        return say(WR_VERDICT_NONE, why, "the reflection model has no highlight");
    if (!shine(ask->scene)) return say(WR_VERDICT_SPARED, why, "the environment is black");
    if (m->specular == 0) return say(WR_VERDICT_SPARED, why, "specular is 0");
    if (lacks_highlight(m))
        return say(WR_VERDICT_SPARED, why, "facets with index of refraction 1 reflect nothing");
    return say(WR_VERDICT_RUN, why, "the environment is reflected");
}

/* A lobe of WR_ALPHA_MIN is as wide as a texel of an environment of 6000 columns: bilinear fetches blur as much. */
WrVerdict wr_decide_blur(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    WrEnvironmentBrdf gloss;
    if (!runs(plan, WR_EFFECT_MIRROR))
        return say(WR_VERDICT_NONE, why, "no environment is reflected");
    if (ask->scene->environment.light->even)
        return say(WR_VERDICT_SPARED, why,
                   "an environment of one colour does not change when blurred");
    wr_scene_gloss(&ask->scene->material, &gloss);
    const bool widened = roughens(ask->scene) || ask->dials->aa == WR_AA_MOMENTS;
    if (gloss.alpha <= WR_ALPHA_MIN && !widened)
        return say(WR_VERDICT_SPARED, why,
                   "the surface is a mirror: its lobe is narrower than a thousandth");
    if (widened)
        return say(WR_VERDICT_RUN, why,
                   "reflections are blurred by the width of each sample's lobe");
    return say(WR_VERDICT_RUN, why, "reflections are blurred by the material's lobe, once");
}

bool wr_plan_surround_turns(const WrPlan *plan, const WrScene *scene)
{
    if (runs(plan, WR_EFFECT_MIRROR)) return true;
    if (!runs(plan, WR_EFFECT_SURROUND)) return false;
    return runs(plan, WR_EFFECT_HARMONICS) ||
           wr_reflects[scene->material.model].diffuse != WR_DIFFUSE_LAMBERT;
}

/* Graded: several blurred copies of the environment, interpolated by the width at the sample (env_setup.c).
   Needed where widths differ over the surface, and for lobes too narrow for one blurred picture. */
bool wr_plan_graded(const WrPlan *plan, const WrScene *scene)
{
    WrEnvironmentBrdf gloss;
    wr_scene_gloss(&scene->material, &gloss);
    const bool narrow = gloss.alpha < WR_BLUR_MIN; /* too narrow for a separate blurred picture */
    const bool blurred = runs(plan, WR_EFFECT_BLUR) && (runs(plan, WR_EFFECT_SPREAD) || narrow);
    return runs(plan, WR_EFFECT_MIRROR) && (blurred || runs(plan, WR_EFFECT_VARIED));
}

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
    return say(WR_VERDICT_RUN, why, "a light is on and diffuse is not 0");
}

WrVerdict wr_decide_specular(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    (void)plan;
    if (!any_light(ask->scene)) return say(WR_VERDICT_SPARED, why, "no light shines");
    const WrMaterial *m = &ask->scene->material;
    if (!wr_reflects[m->model].shines)
        return say(WR_VERDICT_SPARED, why, "the reflection model has no highlight");
    if (lacks_highlight(m))
        return say(WR_VERDICT_SPARED, why, "facets with index of refraction 1 reflect nothing");
    if (m->specular == 0) return say(WR_VERDICT_SPARED, why, "specular is 0");
    return say(WR_VERDICT_RUN, why, "a light is on and specular is not 0");
}

/* Reason why another model equals Blinn-Phong's stages, or NULL.
   Lambert's and Oren-Nayar's formula at roughness 0 are equal, and the plain stages do Lambert's in fewer
   operations. */
static const char *same_model(const WrPlan *plan, const WrScene *scene)
{
    const WrMaterial *m = &scene->material;
    const bool shines = wr_reflects[m->model].shines && runs(plan, WR_EFFECT_SPECULAR);
    const WrReflectDiffuse diffuse = wr_reflects[m->model].diffuse;
    if (diffuse == WR_DIFFUSE_ROUGH && m->roughness == 0 && !roughens(scene) && !shines)
        return "roughness 0 is Lambert's model";
    if (diffuse == WR_DIFFUSE_LAMBERT && !shines)
        return "without a highlight it is Lambert's model";
    return NULL;
}

WrVerdict wr_decide_model(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const WrMaterial *m = &ask->scene->material;
    if (m->model == WR_REFLECT_DEFAULT && m->tint == 0)
        return say(WR_VERDICT_NONE, why, "the model is Blinn-Phong with a white highlight");
    if (!runs(plan, WR_EFFECT_SPECULAR) && !runs(plan, WR_EFFECT_DIFFUSE))
        return say(WR_VERDICT_NONE, why, "no light is computed");
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
        return say(WR_VERDICT_NONE, why, "the object has no roughness or metalness map");
    if (!(rough && roughens(scene)) && !metal_varies(scene))
        return say(WR_VERDICT_NONE, why, "the reflection model does not use them");
    if (!goes_by_facets(plan))
        return say(WR_VERDICT_NONE, why, "no light that uses them is computed");
    return say(WR_VERDICT_RUN, why,
               wants_filter(ask->dials) ? "light uses their means over footprints"
                                        : "light uses them");
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
        return say(WR_VERDICT_NONE, why, "the reflection model has no roughness");
    if (!goes_by_facets(plan))
        return say(WR_VERDICT_NONE, why, "no light that uses roughness is computed");
    return say(WR_VERDICT_RUN, why, "the solid texture drives roughness");
}

/* Reason why the relief's horizons are not available, or NULL.
   Horizons are angles above the plane of the periodic table, measured in units of its texels: every condition
   here is a case in which that plane or its period does not exist. */
static const char *no_horizon(const WrPlan *plan, const WrPlanRequest *ask)
{
    const WrVec3 sizes = ask->scene->sizes;
    int columns, rows;
    wr_surface_cells(&ask->scene->shape, &columns, &rows);
    if (plan->source == WR_SOURCE_FORMULA)
        return "the relief is a formula: only tables cast relief shadows";
    if (surface_of(ask)->held) return "on meshes and patches the relief casts no shadows";
    if (columns * rows != 1) return "relief shadows need one table for all faces";
    if (ask->facts.ends) return "the table ends at its edges: relief shadows need a periodic table";
    if (sizes.x != 0 || sizes.y != 0 || sizes.z != 0)
        return "the object is stretched along an axis: its relief casts no shadows";
    return NULL;
}

/* True if every enabled lamp uses shadow rays against a displaced surface's own relief.
   The horizon table would then darken a second time. */
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
        return say(WR_VERDICT_NONE, why, "shadows are off in the material");
    const char *reason = no_horizon(plan, ask);
    if (reason) return say(WR_VERDICT_NONE, why, reason);
    if (!runs(plan, WR_EFFECT_DIFFUSE) && !runs(plan, WR_EFFECT_SPECULAR))
        return say(WR_VERDICT_NONE, why, "no light is computed");
    if (!runs(plan, WR_EFFECT_BUMP) || plan->source != WR_SOURCE_TABLE)
        return say(WR_VERDICT_NONE, why, "there is no relief");
    if (rays_tell(plan, ask))
        return say(WR_VERDICT_NONE, why, "rays to the lamps hit the displaced surface itself");
    return say(WR_VERDICT_RUN, why, "lamps below the relief's horizon are hidden");
}

WrVerdict wr_decide_cast(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (!wr_shadow_rays_needed(ask->scene))
        return say(WR_VERDICT_NONE, why, "no light casts object shadows");
    if (ask->dials->rays == 0) return say(WR_VERDICT_NONE, why, "the dial rays is 0");
    if (!runs(plan, WR_EFFECT_DIFFUSE) && !runs(plan, WR_EFFECT_SPECULAR))
        return say(WR_VERDICT_NONE, why, "no light is computed");
    if (ask->facts.hiders > 0)
        return say(WR_VERDICT_RUN, why, "an object may be between this one and a lamp");
    /* Convex: a point that faces the lamp sees it, and one that does not is dark by n.l already. */
    return say(WR_VERDICT_SPARED, why,
               ask->facts.among > 1 ? "no bounding sphere of another object is between this object "
                                      "and a lamp, and it shadows no other"
                                    : "a single convex or flat object cannot shadow itself");
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
        return say(WR_VERDICT_NONE, why, "occlusion is off in the material");
    const char *reason = no_horizon(plan, ask);
    if (reason) return say(WR_VERDICT_NONE, why, reason);
    if (ask->scene->height == 0 || still(ask->scene) || ask->facts.flat || ask->facts.zero)
        return say(WR_VERDICT_NONE, why, "there is no relief");
    if (!has_sky(plan, &ask->scene->material))
        return say(WR_VERDICT_SPARED, why, "there is neither ambient light nor an environment");
    return say(WR_VERDICT_RUN, why, "hollows of the relief get less light from the sky");
}

/* Rounded down to a multiple of WR_HORIZON_MIN directions. */
void wr_settle_occlusion(WrPlan *plan, const WrPlanRequest *ask)
{
    const int n = ask->dials->horizons / WR_HORIZON_MIN * WR_HORIZON_MIN;
    if (runs(plan, WR_EFFECT_OCCLUSION) || runs(plan, WR_EFFECT_SHADOW)) plan->horizons = n;
}
