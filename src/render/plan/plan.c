#include "render/plan/plan.h"

#include "base/enum_rows.h"
#include "field/analytic.h"
#include "render/plan/plan_internal.h"
#include "render/shadows/shadow_rays.h"
#include "render/textures/solid_texture_setup.h"
#include "scene/scene.h"
#include "surface/triangles.h"

#include <stdio.h>
#include <string.h>

/* ---- runs ---- */

/* Plan rows of partial skipping: runs of samples without bump or light, and the area beside the object. These
   rows change the method, never the picture. */

/* From this share of sloped tiles on, runs over flat parts are too rare to test for. */
#define MOSTLY_SLOPED 0.75

/* True if it runs only because it is forced. Then it runs everywhere.
   Verdicts: RUN; SPARED, possible but proven without effect here; NONE, impossible or not requested. Forcing
   turns SPARED on, but never NONE. */
static bool is_forced(const WrPlan *plan, WrEffect effect)
{
    return runs(plan, effect) && plan->rows[effect].verdict != WR_VERDICT_RUN;
}

/* ---- flat parts of the table ---- */

/* Reason why bump cannot be skipped in runs whose slopes are 0, or NULL if it can.
   E63 holds if n' depends on Fu, Fv of the tile alone: every case here reads something beyond the tile, or F
   itself, or the tangents that the skipped stage would have computed. */
static const char *no_ground(const WrPlan *plan, const WrPlanRequest *ask)
{
    if (is_forced(plan, WR_EFFECT_BUMP)) return "bump is switched on: it runs everywhere";
    if (runs(plan, WR_EFFECT_NORMALS)) return "a normal map has slopes where the table has none";
    if (plan->bump == WR_BUMP_EXACT)
        return "the exact normal depends on heights, not only on slopes";
    if (wr_plan_is_weighted(ask->scene))
        return "the relief's mask has slopes where the table has none";
    if (wr_schemes[plan->scheme].taps == WR_TAPS_FITTED)
        return "each coefficient of this scheme depends on the whole table";
    if (runs(plan, WR_EFFECT_FILTER)) return "a footprint may cover any part of the table";
    if (runs(plan, WR_EFFECT_TINT)) return "the colour picture's footprints need tangents";
    if (plan->facets_filtered) return "footprints of roughness maps need tangents";
    if (plan->precision != WR_PRECISION_SINGLE)
        return "slopes in single precision do not bound those in double";
    return NULL;
}

/* sloped is -1 where no single-precision table is read. */
WrVerdict wr_decide_ground(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (plan->source != WR_SOURCE_TABLE) return say(WR_VERDICT_NONE, why, "the table is not used");
    const char *reason = no_ground(plan, ask);
    if (reason) return say(WR_VERDICT_RUN, why, reason);
    const double sloped = ask->facts.sloped;
    if (!(sloped >= 0 && sloped < MOSTLY_SLOPED))
        return say(WR_VERDICT_RUN, why, "most of the table has slopes: the test would not pay off");
    return say(WR_VERDICT_SPARED, why,
               "much of the table is flat: runs of samples there skip bump");
}

/* ---- the dark side ---- */

/* Reason why the bound on bump's rotation of the normal cannot be used to skip light, or NULL if it can.
   E18: n' stays within the cone of slopes up to the tile's largest. Every case here bends the normal by an
   amount without such a bound. */
static const char *no_cone(const WrPlan *plan, const WrPlanRequest *ask)
{
    if (runs(plan, WR_EFFECT_DISPLACED))
        return "facets of a displaced surface may face any direction";
    if (runs(plan, WR_EFFECT_PARALLAX)) return "points seen by parallax may be on either side";
    if (runs(plan, WR_EFFECT_EMBOSSED)) return "slopes of a solid texture have no bound";
    if (wr_plan_is_weighted(ask->scene)) return "slopes of the relief's mask have no bound";
    if (plan->bump == WR_BUMP_NONE) return NULL;
    if (is_forced(plan, WR_EFFECT_BUMP)) return "bump is switched on: it runs everywhere";
    if (runs(plan, WR_EFFECT_NORMALS)) return "slopes of a normal map have no bound";
    if (plan->bump != WR_BUMP_BLINN) return "the tilt of this normal has no bound";
    if (!runs(plan, WR_EFFECT_GRADIENT) || runs(plan, WR_EFFECT_FILTER) ||
        plan->precision != WR_PRECISION_SINGLE)
        return "only slopes of a gradient table have a bound";
    return NULL;
}

/* Runs of samples are dark only if n'.l <= 0 for all normals that bump may produce: the cone of slope bounds
   around n (E1, E18). */
static const char *no_dark(const WrPlan *plan, const WrPlanRequest *ask)
{
    const bool shines = runs(plan, WR_EFFECT_SPECULAR);
    if (is_forced(plan, WR_EFFECT_DIFFUSE) || is_forced(plan, WR_EFFECT_SPECULAR))
        return "light is switched on: it runs everywhere";
    if (v3_len(ask->scene->sizes) > 0) return "the object is stretched, which changes its normals";
    if (ask->facts.normals) return "normals are needed everywhere";
    if (runs(plan, WR_EFFECT_SURROUND) || runs(plan, WR_EFFECT_MIRROR))
        return "the environment lights those places too";
    if (shines && !ask->scene->material.gate)
        return "a highlight without gate is visible there too";
    if (runs(plan, WR_EFFECT_BOUND)) return "a bound of the change of light is needed everywhere";
    if (runs(plan, WR_EFFECT_HALF)) return "the dial is set to light in half precision";
    return no_cone(plan, ask);
}

WrVerdict wr_decide_dark(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (!runs(plan, WR_EFFECT_DIFFUSE) && !runs(plan, WR_EFFECT_SPECULAR))
        return say(WR_VERDICT_NONE, why, "no light is computed");
    const char *reason = no_dark(plan, ask);
    if (reason) return say(WR_VERDICT_RUN, why, reason);
    return say(
        WR_VERDICT_SPARED, why,
        "runs of samples with all lights behind them, bumped or not, get only ambient light");
}

/* ---- beside the object ---- */

/* E30: tiles and rows are cut to the bounding box of the object; pixels outside keep the background. */
WrVerdict wr_decide_beside(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    (void)plan, (void)ask;
    return say(WR_VERDICT_SPARED, why,
               "only the part of a tile that the object may cover is drawn");
}

/* ---- Plan rows of sampling: samples per pixel, and the bound for taking fewer ---- */

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
        return say(WR_VERDICT_NONE, why, "the dial is set to one sample at the pixel's centre");
    if (dials->samples == 1)
        return say(WR_VERDICT_NONE, why, "the dial is set to one sample per pixel");
    if (dials->aa == WR_AA_ADAPTIVE && unbounded(ask))
        return say(WR_VERDICT_RUN, why, "up to K x K: several objects have no bound");
    if (dials->aa == WR_AA_ADAPTIVE && ask->facts.lively)
        return say(WR_VERDICT_RUN, why, "up to K x K: fewer would cost more here, so all are used");
    return say(
        WR_VERDICT_RUN, why,
        dials->aa == WR_AA_SUPERSAMPLE
            ? "the dial is set to the mean of K x K intensities"
            : "up to K x K where one sample does not meet `contrast`; smooth views need fewer");
}

/* Solid textures need a known number of texels per pixel for the estimate (wr_solid_texture_texels). */
void wr_settle_samples(WrPlan *plan, const WrPlanRequest *ask)
{
    const WrDials *dials = ask->dials;
    const bool run = runs(plan, WR_EFFECT_SAMPLES);
    plan->samples = run ? dials->samples : 1;
    const bool adaptive =
        dials->aa == WR_AA_ADAPTIVE && !ask->facts.lively && !unbounded(ask) &&
        (plan->grain == WR_SOLID_TEXTURE_OFF || wr_solid_texture_resolution_known(ask->scene));
    plan->sampling = !run ? WR_SAMPLING_ONE : adaptive ? WR_SAMPLING_ADAPTIVE : WR_SAMPLING_ALL;
    if (!run) return;
    plan->spread = dials->spread;
    plan->refine = dials->refine;
    plan->contrast = dials->contrast;
}

/* Reason why no bound on the change of intensity over a pixel is known, or NULL if one is. The bound is the
   Lipschitz constant of the intensity over a pixel (E16), known in closed form for few cases. */
static const char *no_bound(const WrPlan *plan, const WrPlanRequest *ask)
{
    if (runs(plan, WR_EFFECT_SHADOW) || runs(plan, WR_EFFECT_CAST))
        return "shadows have no bound: K x K everywhere";
    if (ask->dials->shading == WR_SHADING_HALF)
        return "rounding to half precision has no bound: K x K everywhere";
    if (v3_len(ask->scene->sizes) > 0) return "a stretched object has no bound: K x K everywhere";
    if (runs(plan, WR_EFFECT_MODEL)) return "this reflection model has no bound: K x K everywhere";
    if (runs(plan, WR_EFFECT_SURROUND) || runs(plan, WR_EFFECT_MIRROR))
        return "light from an environment has no bound: K x K everywhere";
    const WrInversion how = surface_of(ask)->inversion;
    if (runs(plan, WR_EFFECT_DISPLACED))
        return "a displaced surface has no bound: K x K everywhere";
    if (runs(plan, WR_EFFECT_PARALLAX)) return "parallax has no bound: K x K everywhere";
    if (how != WR_INVERT_PLANE && how != WR_INVERT_CUBE && how != WR_INVERT_SPHERE)
        return "this surface has no bound: K x K everywhere";
    if (runs(plan, WR_EFFECT_COLOUR)) return "a colour picture has no bound: K x K everywhere";
    if (runs(plan, WR_EFFECT_GRAIN)) return "a solid texture has no bound: K x K everywhere";
    if (runs(plan, WR_EFFECT_NORMALS)) return "a normal map has no bound: K x K everywhere";
    if (plan->bump == WR_BUMP_NONE) return NULL;
    if (plan->bump != WR_BUMP_BLINN) return "this normal formula has no bound: K x K everywhere";
    if (!runs(plan, WR_EFFECT_GRADIENT))
        return "a bound needs slopes from a table, central or nearest: K x K everywhere";
    return NULL;
}

WrVerdict wr_decide_bound(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (ask->dials->aa != WR_AA_ADAPTIVE || plan->refine != WR_REFINE_BOUND)
        return say(WR_VERDICT_NONE, why, "the dials are not set to a bound");
    const char *reason = no_bound(plan, ask);
    if (reason) return say(WR_VERDICT_NONE, why, reason);
    if (ask->facts.among > 1)
        return say(WR_VERDICT_NONE, why, "several objects have no bound: K x K everywhere");
    if (ask->facts.lively)
        return say(WR_VERDICT_NONE, why,
                   "bounds would save too little of this view: K x K everywhere");
    return say(WR_VERDICT_RUN, why,
               "K x K only where the intensity may change by more than `contrast`");
}

/* ---- shape ---- */

/* Plan rows of the table's effect on the surface: displacement, or bending of the normal, and by which formula. */

#define SEEN 0.5 /* pixels: bump suffices for a smaller displacement (E21, E50) */

/* E21, E50: the largest displacement on screen is below half a pixel. */
WrVerdict wr_decide_displaced(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const WrScene *scene = ask->scene;
    (void)plan;
    if (!scene->displaced) return say(WR_VERDICT_NONE, why, "the table only tilts the normal");
    const char *reason = wr_shape_unmoved(&scene->shape);
    if (reason) return say(WR_VERDICT_NONE, why, reason);
    if (scene->height == 0) return say(WR_VERDICT_SPARED, why, "height is 0: F is 0");
    if (scene->analytic.kind == WR_ANALYTIC_OFF && ask->facts.zero)
        return say(WR_VERDICT_SPARED, why, "the table is 0 everywhere");
    /* Shadow rays intersect facets of P + F n, however low it is. Started from the base, all rays would be
       blocked, or none. */
    const bool met = wr_shadow_rays_needed(scene) && ask->dials->rays > 0;
    if (ask->facts.rise >= 0 && ask->facts.rise < SEEN && !met)
        return say(WR_VERDICT_SPARED, why,
                   "F moves no point by half a pixel: bump mapping looks the same");
    return say(WR_VERDICT_RUN, why, "F moves the surface: facets of P + F n are drawn");
}

void wr_settle_displaced(WrPlan *plan, const WrPlanRequest *ask)
{
    if (runs(plan, WR_EFFECT_DISPLACED)) plan->dice = ask->dials->dice;
}

/* The same rule as displacement: both move the point seen at a pixel by the same amount. */
WrVerdict wr_decide_parallax(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const WrScene *scene = ask->scene;
    if (!scene->parallax) return say(WR_VERDICT_NONE, why, "rays end at the base surface");
    if (runs(plan, WR_EFFECT_DISPLACED))
        return say(WR_VERDICT_NONE, why, "the surface itself is displaced: rays hit its facets");
    const char *reason = wr_shape_without_parallax(&scene->shape);
    if (reason) return say(WR_VERDICT_NONE, why, reason);
    if (scene->height == 0) return say(WR_VERDICT_SPARED, why, "height is 0: F is 0");
    if (scene->analytic.kind == WR_ANALYTIC_OFF && ask->facts.zero)
        return say(WR_VERDICT_SPARED, why, "the table is 0 everywhere");
    if (ask->facts.rise >= 0 && ask->facts.rise < SEEN)
        return say(WR_VERDICT_SPARED, why,
                   "F moves no point by half a pixel: bump mapping looks the same");
    return say(WR_VERDICT_RUN, why, "rays continue from the base surface to the relief");
}

void wr_settle_parallax(WrPlan *plan, const WrPlanRequest *ask)
{
    if (runs(plan, WR_EFFECT_PARALLAX)) plan->steps = ask->dials->steps;
}

/* A displaced surface is shown with its own normal, whatever mode the scene has: facets of P + F n under a
   normal of another surface would not agree with their outline. */
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
                   is_cut(ask) ? "on sets of patches the blinn normal replaces the exact one"
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

/* n_u, n_v: the exact N' of NUMERICS (Pu + Fu n + F n_u) x (Pv + Fv n + F n_v) is the only formula that reads
   them. */
WrVerdict wr_decide_curvature(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (surface_of(ask)->held)
        return say(WR_VERDICT_NONE, why,
                   is_cut(ask) ? "only the exact normal needs them"
                               : "triangles are flat: they are zero");
    if (runs(plan, WR_EFFECT_EXACT))
        return say(WR_VERDICT_RUN, why, "the exact normal needs the change of n");
    return say(WR_VERDICT_SPARED, why, "only the exact normal needs them");
}

/* `normals` is true if any later stage reads n: otherwise points alone suffice. */
void wr_settle_curvature(WrPlan *plan, const WrPlanRequest *ask)
{
    plan->normals = lit(plan, ask) || runs(plan, WR_EFFECT_BUMP) ||
                    runs(plan, WR_EFFECT_CURVATURE) || runs(plan, WR_EFFECT_TINT) ||
                    runs(plan, WR_EFFECT_NORMALS) || runs(plan, WR_EFFECT_GRAIN) ||
                    runs(plan, WR_EFFECT_EMBOSSED);
}

const char *wr_proof_letter(WrProof proof)
{
    WR_ROWS(letters);
    static const char *const letters[] = { [WR_ROW(WR_PROOF_IDENTICAL)] = "I",
                                           [WR_ROW(WR_PROOF_BOUNDED)] = "B",
                                           [WR_ROW(WR_PROOF_POLICY)] = "P" };
    WR_ROWS_END(letters, WR_PROOF_COUNT);
    return letters[proof];
}

/* ---- deciding ---- */

/* Rows are decided in the order of the enumeration; a decide function may read only rows above its own, and
   settle writes the settings that follow from the verdict. */

static void decide(WrPlan *plan, WrEffect effect, const WrPlanRequest *ask)
{
    const WrEffectInfo *info = &wr_effects[effect];
    const WrForce force = ask->force ? ask->force[effect] : WR_FORCE_NONE;
    const char *why = "";
    const WrVerdict verdict = info->decide(plan, ask, &why);
    WrPlanRow *row = &plan->rows[effect];
    *row = (WrPlanRow){ .rule = info->rule,
                        .name = info->name,
                        .proof = info->proof,
                        .verdict = verdict,
                        .run = verdict == WR_VERDICT_RUN };
    const bool on = force == WR_FORCE_ON || (ask->full && !info->finer);
    if (verdict == WR_VERDICT_SPARED && on) row->run = true;
    if (force == WR_FORCE_OFF && !info->only_way) row->run = false;
    snprintf(row->reason, sizeof row->reason, "%s%s",
             row->run == (verdict == WR_VERDICT_RUN) ? ""
             : row->run                              ? "forced: "
                                                     : "forced off: ",
             why);
    if (info->settle) info->settle(plan, ask);
}

void wr_plan_build(WrPlan *plan, const WrPlanRequest *ask)
{
    memset(plan, 0, sizeof *plan);
    for (int e = 0; e < WR_EFFECT_COUNT; e++) decide(plan, (WrEffect)e, ask);
}

/* Repeats the rows that depend on facts.lively, which is measured after the others are settled. */
void wr_plan_samples(WrPlan *plan, const WrPlanRequest *ask)
{
    decide(plan, WR_EFFECT_SAMPLES, ask);
    decide(plan, WR_EFFECT_BOUND, ask);
    decide(plan, WR_EFFECT_DARK, ask); /* depends on the bound */
}

void wr_plan_again(WrPlan *plan, const WrPlanRequest *ask)
{
    for (int e = 0; e < WR_EFFECT_COUNT; e++)
        if (wr_effects[e].manner) decide(plan, (WrEffect)e, ask);
}

/* `manner` rows change the way a picture is computed, never the picture; they are not compared. */
bool wr_plan_same(const WrPlan *a, const WrPlan *b)
{
    for (int e = 0; e < WR_EFFECT_COUNT; e++)
        if (!wr_effects[e].manner && a->rows[e].run != b->rows[e].run) return false;
#define WR_PLAN_DIFFERS(effect, type, name) || a->name != b->name
    return !(false WR_PLAN_SETTINGS(WR_PLAN_DIFFERS));
#undef WR_PLAN_DIFFERS
}

/* ---- costs ---- */

WR_ROWS(wr_cost_names);
const char *const wr_cost_names[WR_COST_COUNT] = {
    [WR_ROW(WR_COST_PREPARE)] = "preparing", [WR_ROW(WR_COST_VISIBILITY)] = "visibility",
    [WR_ROW(WR_COST_GEOMETRY)] = "geometry", [WR_ROW(WR_COST_LIGHT)] = "light",
    [WR_ROW(WR_COST_STORE)] = "storing",     [WR_ROW(WR_COST_CLEAR)] = "clearing",
    [WR_ROW(WR_COST_REST)] = "rest",         [WR_ROW(WR_COST_WAIT)] = "waiting",
    [WR_ROW(WR_COST_CHOOSE)] = "choosing",
};
WR_ROWS_END(wr_cost_names, WR_COST_COUNT);

WR_ROWS(wr_cost_reasons);
const char *const wr_cost_reasons[WR_COST_COUNT] = {
    [WR_ROW(WR_COST_PREPARE)] = "tables, pyramids, the view, the mesh",
    [WR_ROW(WR_COST_VISIBILITY)] = "samples that the object covers",
    [WR_ROW(WR_COST_GEOMETRY)] = "points, tangents and normals of the surface",
    [WR_ROW(WR_COST_LIGHT)] = "diffuse light and highlight of the one light, in one pass",
    [WR_ROW(WR_COST_STORE)] = "colours are combined and stored",
    [WR_ROW(WR_COST_CLEAR)] = "tiles are cleared; empty ones are skipped",
    [WR_ROW(WR_COST_REST)] = "overhead between the stages: loops, timing",
    [WR_ROW(WR_COST_WAIT)] = "threads without work",
    [WR_ROW(WR_COST_CHOOSE)] = "error estimates of the tolerance, comparing and combining blocks",
};
WR_ROWS_END(wr_cost_reasons, WR_COST_COUNT);

/* Cost that a stage's time is added to if none of its effects runs. */
WR_ROWS(stage_costs);
static const WrCost stage_costs[] = {
    [WR_ROW(WR_STAGE_VISIBILITY)] = WR_COST_VISIBILITY,
    [WR_ROW(WR_STAGE_NEWTON)] = WR_COST_VISIBILITY,
    [WR_ROW(WR_STAGE_PARAMETERS)] = WR_COST_GEOMETRY,
    [WR_ROW(WR_STAGE_GEOMETRY)] = WR_COST_GEOMETRY,
    [WR_ROW(WR_STAGE_PARALLAX)] = WR_COST_VISIBILITY,
    [WR_ROW(WR_STAGE_CURVATURE)] = WR_COST_GEOMETRY,
    [WR_ROW(WR_STAGE_FOOTPRINT)] = WR_COST_GEOMETRY,
    [WR_ROW(WR_STAGE_LOOK)] = WR_COST_GEOMETRY,
    [WR_ROW(WR_STAGE_PYRAMID)] = WR_COST_GEOMETRY,
    [WR_ROW(WR_STAGE_NORMALS)] = WR_COST_GEOMETRY,
    [WR_ROW(WR_STAGE_BUMP)] = WR_COST_GEOMETRY,
    [WR_ROW(WR_STAGE_SPREAD)] = WR_COST_GEOMETRY,
    [WR_ROW(WR_STAGE_COLOUR)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_TINT)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_FACETS)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_GRAIN)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_DIFFUSE)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_SPECULAR)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_SURROUND)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_MIRROR)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_SHADOW)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_CAST)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_OCCLUSION)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_LIGHT)] = WR_COST_LIGHT,
    [WR_ROW(WR_STAGE_BOUND)] = WR_COST_REST,
    [WR_ROW(WR_STAGE_HALF)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_RESOLVE)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_STORE)] = WR_COST_STORE,
    [WR_ROW(WR_STAGE_CLEAR)] = WR_COST_CLEAR,
    [WR_ROW(WR_STAGE_BETWEEN)] = WR_COST_VISIBILITY,
};
WR_ROWS_END(stage_costs, WR_STAGE_COUNT);

/* A stage's time belongs to the last running effect that lists it, otherwise to a general cost. */
void wr_plan_charge(WrPlan *plan, WrStage stage, double seconds)
{
    double *to = &plan->cost[stage_costs[stage]];
    for (int e = 0; e < WR_EFFECT_COUNT; e++)
        if (plan->rows[e].run && (wr_effects[e].stages >> stage & 1)) to = &plan->rows[e].seconds;
    *to += seconds;
}

static void per_pixel(WrPlan *plan)
{
    for (int e = 0; e < WR_EFFECT_COUNT; e++) {
        WrPlanRow *row = &plan->rows[e];
        row->ns_per_pixel = plan->shaded > 0 ? 1e9 * row->seconds / (double)plan->shaded : 0;
    }
}

/* Sums the plans of several passes; an effect runs if it ran in any pass. */
void wr_plan_add(WrPlan *sum, const WrPlan *more)
{
    for (int e = 0; e < WR_EFFECT_COUNT; e++) {
        WrPlanRow row = more->rows[e];
        const WrPlanRow *before = &sum->rows[e];
        if (!row.run && before->run) row = *before;
        if (row.verdict < before->verdict) row.verdict = before->verdict;
        row.ran = before->ran || more->rows[e].ran;
        row.seconds = before->seconds + more->rows[e].seconds;
        row.tiles = before->tiles + more->rows[e].tiles;
        row.pixels = before->pixels + more->rows[e].pixels;
        sum->rows[e] = row;
    }
    for (int c = 0; c < WR_COST_COUNT; c++) sum->cost[c] += more->cost[c];
    sum->work += more->work;
    sum->shaded += more->shaded;
    per_pixel(sum);
}
