/* Effect table: for each effect the condition under which a scene needs it, the reason, the proof for leaving it
   out, its stages and its settings. Rows are decided in order: a row may read those before it. */
#include "render/plan/plan_internal.h"
#include "field/scheme_list.h"
#include "base/enum_rows.h"

#include "field/analytic.h"
#include "scene/scene.h"
#include "surface/triangles.h"

#include <math.h>

/* ---- bump ---- */

/* Reason why the table cannot change the normal, or NULL if it can. The exact normal of an offset surface
   (constant F) is the base's up to its sign, which flips where F passes a focal distance: so with `exact` on a
   curved base a constant F is left out only if it is 0. */
static const char *no_bump(const WrPlan *plan, const WrPlanRequest *ask)
{
    const WrScene *scene = ask->scene;
    const WrPlanFacts *facts = &ask->facts;
    const bool table = scene->analytic.kind == WR_ANALYTIC_OFF;
    if (!lit(plan, ask)) return "no light depends on the normal";
    if (scene->height == 0) return "height is 0";
    if (table && facts->zero) return "the table is 0 everywhere";
    if (wr_plan_normal(plan, ask) == WR_BUMP_EXACT && !surface_of(ask)->flat) return NULL;
    if (wr_plan_is_weighted(scene)) return NULL;
    if (still(scene)) return "replication is 0,0: F is constant";
    if (table && facts->flat) return "every texel of the table is equal";
    if (table && facts->slope_free) return "the scheme has no slope anywhere in the table";
    return NULL;
}

static WrVerdict decide_bump(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (wr_plan_normal(plan, ask) == WR_BUMP_NONE)
        return say(WR_VERDICT_NONE, why, "bump mode is none");
    const char *reason = no_bump(plan, ask);
    if (reason) return say(WR_VERDICT_SPARED, why, reason);
    return say(WR_VERDICT_RUN, why, "the table has slopes and a light shows them");
}

static void settle_bump(WrPlan *plan, const WrPlanRequest *ask)
{
    const bool run = runs(plan, WR_EFFECT_BUMP);
    plan->bump = run || runs(plan, WR_EFFECT_NORMALS) ? WR_BUMP_BLINN : WR_BUMP_NONE;
    plan->scheme = ask->scene->scheme;
    plan->source = !run && !runs(plan, WR_EFFECT_PARALLAX)        ? WR_SOURCE_NONE
                   : ask->scene->analytic.kind == WR_ANALYTIC_OFF ? WR_SOURCE_TABLE
                                                                  : WR_SOURCE_FORMULA;
}

static WrVerdict decide_gradient(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const WrScheme scheme = ask->scene->scheme;
    if (plan->source != WR_SOURCE_TABLE) return say(WR_VERDICT_NONE, why, "the table is not used");
    if (scheme != WR_SCHEME_CENTRAL && scheme != WR_SCHEME_NEAREST)
        return say(WR_VERDICT_NONE, why, "this scheme computes slopes from the heights");
    return say(WR_VERDICT_RUN, why,
               "one lookup of central differences equals the paper's four lookups of F");
}

/* r u is rounded by at most r 2^-24 periods, r W 2^-24 texels of a table of width W (HC40). */
static WrVerdict decide_wide(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const double r = fmax(fabs(ask->scene->replicate_u), fabs(ask->scene->replicate_v));
    if (plan->source != WR_SOURCE_TABLE) return say(WR_VERDICT_NONE, why, "the table is not used");
    if (r < WR_WIDE_FROM)
        return say(WR_VERDICT_SPARED, why,
                   "replication is below 1024: single precision is accurate to 1e-3 texel");
    return say(WR_VERDICT_RUN, why,
               "replication is 1024 or more: single precision would lose texels");
}

static WrVerdict decide_invariant(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const WrShape *shape = &ask->scene->shape;
    if (wr_plan_normal(plan, ask) != WR_BUMP_INVARIANT)
        return say(WR_VERDICT_NONE, why, "bump mode is not invariant");
    if (!runs(plan, WR_EFFECT_BUMP) && !runs(plan, WR_EFFECT_NORMALS))
        return say(WR_VERDICT_NONE, why, "bump does not run");
    if (shape->kind == WR_SURFACE_plane && shape->value[0] == 1 && shape->value[1] == 1)
        return say(WR_VERDICT_SPARED, why, "on the unit square it equals blinn");
    return say(WR_VERDICT_RUN, why, "bump mode is invariant");
}

static void settle_invariant(WrPlan *plan, const WrPlanRequest *ask)
{
    (void)ask;
    if (runs(plan, WR_EFFECT_INVARIANT)) plan->bump = WR_BUMP_INVARIANT;
}

/* ---- samples ---- */

/* Moments exist only for filtered slopes: an unfiltered fetch has no covariance. */
static WrVerdict decide_spread(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (ask->dials->aa != WR_AA_MOMENTS)
        return say(WR_VERDICT_NONE, why, "the dials are not set to moments");
    if (!runs(plan, WR_EFFECT_FILTER) && !plan->map_filtered)
        return say(WR_VERDICT_NONE, why, "nothing is filtered");
    if (!runs(plan, WR_EFFECT_SPECULAR) && !runs(plan, WR_EFFECT_MIRROR))
        return say(WR_VERDICT_NONE, why, "there is no highlight to widen");
    return say(WR_VERDICT_RUN, why,
               ask->dials->moments == WR_MOMENTS_LEAN
                   ? "the covariance of the slopes widens the highlight"
                   : "the variance of the slopes widens the highlight");
}

/* lean: the covariance as a 2 x 2 matrix; else only its trace, half in each direction (Toksvig). */
static void settle_spread(WrPlan *plan, const WrPlanRequest *ask)
{
    plan->graded = wr_plan_graded(plan, ask->scene);
    plan->lean = runs(plan, WR_EFFECT_SPREAD) && ask->dials->moments == WR_MOMENTS_LEAN;
}

/* ---- arithmetic ---- */

static WrVerdict decide_rounded(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const WrHeights heights = ask->dials->heights;
    if (plan->source != WR_SOURCE_TABLE) return say(WR_VERDICT_NONE, why, "the table is not used");
    if (heights == WR_HEIGHTS_DOUBLE || heights == WR_HEIGHTS_FLOAT)
        return say(WR_VERDICT_NONE, why, "the dial is set to unrounded heights");
    return say(WR_VERDICT_RUN, why, "the dial is set to heights with fewer bits");
}

static void settle_rounded(WrPlan *plan, const WrPlanRequest *ask)
{
    plan->heights = runs(plan, WR_EFFECT_ROUNDED) ? ask->dials->heights : WR_HEIGHTS_FLOAT;
}

/* A thin object: coordinates along its short axis would differ by less than the rounding of those along the
   others. */
static WrVerdict decide_double(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (ask->dials->shading == WR_SHADING_DOUBLE)
        return say(WR_VERDICT_RUN, why, "the dial is set to shading in double precision");
    if (wr_scene_is_thin(ask->scene))
        return say(WR_VERDICT_RUN, why,
                   "the object is so flat that single precision would not find (u,v)");
    if (plan->source == WR_SOURCE_TABLE && ask->dials->heights == WR_HEIGHTS_DOUBLE)
        return say(WR_VERDICT_RUN, why, "the dial is set to lookups in double precision");
    return say(WR_VERDICT_NONE, why, "the dial is set to single precision");
}

static void settle_double(WrPlan *plan, const WrPlanRequest *ask)
{
    const bool run = runs(plan, WR_EFFECT_DOUBLE);
    plan->shading_double =
        run && (ask->dials->shading == WR_SHADING_DOUBLE || wr_scene_is_thin(ask->scene));
    plan->precision = !run                                       ? WR_PRECISION_SINGLE
                      : ask->dials->heights == WR_HEIGHTS_DOUBLE ? WR_PRECISION_DOUBLE
                                                                 : WR_PRECISION_WIDENED;
}

static WrVerdict decide_half(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    (void)plan;
    if (ask->dials->shading != WR_SHADING_HALF)
        return say(WR_VERDICT_NONE, why, "the dial is not set to it");
    return say(WR_VERDICT_RUN, why, "the dial is set to normals and light in half precision");
}

/* ---- the table ---- */

/* Columns: name in the documents (Enn), title, proof that leaving it out is harmless, size of the difference
   if it is bounded, condition under which it is left out, stages whose time it explains, flags of
   WrEffectInfo, functions. The order is light, pictures, bump, samples, geometry. */

#define STAGE(name) (1U << WR_STAGE_##name)

WR_ROWS(wr_effects);
const WrEffectInfo wr_effects[WR_EFFECT_COUNT] = {
    [WR_ROW(WR_EFFECT_DIFFUSE)] = { "E1", "diffuse", WR_PROOF_IDENTICAL, NULL,
                                    "no light is on, diffuse is 0, the colour is black, or the "
                                    "material is pure metal; with several lights, for those that "
                                    "are off",
                                    STAGE(DIFFUSE), .spared = WR_RUN_DARK,
                                    .decide = wr_decide_diffuse },
    [WR_ROW(WR_EFFECT_SPECULAR)] = { "E2", "specular", WR_PROOF_IDENTICAL, NULL,
                                     "no light is on, specular is 0, the reflection model has no "
                                     "highlight, or its index of refraction is 1",
                                     STAGE(SPECULAR), .spared = WR_RUN_DARK | WR_RUN_DULL,
                                     .decide = wr_decide_specular },
    [WR_ROW(WR_EFFECT_MODEL)] = { "E36", "reflection model", WR_PROOF_BOUNDED,
                                  "rounding of the light",
                                  "the model is blinn-phong with a white highlight; without a "
                                  "highlight, or for oren-nayar with roughness 0, Lambert's model "
                                  "is used",
                                  0, .only_way = true, .spared = WR_RUN_DARK,
                                  .decide = wr_decide_model, .settle = wr_settle_model },
    [WR_ROW(WR_EFFECT_KEPT)] = { "E44", "kept diffuse light", WR_PROOF_IDENTICAL, NULL,
                                 "the highlight does not change the model's diffuse light, or "
                                 "energy=published; there is no diffuse light, as for metal",
                                 0, .spared = WR_RUN_DARK, .decide = wr_decide_kept,
                                 .settle = wr_settle_kept },
    [WR_ROW(WR_EFFECT_SURROUND)] = { "E41", "surroundings", WR_PROOF_IDENTICAL, NULL,
                                     "there is no environment, or it is black; diffuse is 0, the "
                                     "colour is black, or the material is pure metal",
                                     STAGE(SURROUND), .decide = wr_decide_surround },
    [WR_ROW(WR_EFFECT_HARMONICS)] = { "E42", "harmonics", WR_PROOF_IDENTICAL, NULL,
                                      "the environment gives no diffuse light, or has one colour, "
                                      "for which one of the nine coefficients is enough",
                                      0, .decide = wr_decide_harmonics,
                                      .settle = wr_settle_harmonics },
    [WR_ROW(
        WR_EFFECT_MIRROR)] = { "E65", "mirrored surroundings", WR_PROOF_IDENTICAL, NULL,
                               "there is no environment, or it is black; specular is 0, the "
                               "reflection model has no highlight, or its index of refraction is 1",
                               STAGE(MIRROR), .decide = wr_decide_mirror },
    [WR_ROW(WR_EFFECT_BLUR)] = { "E43", "blurred surroundings", WR_PROOF_BOUNDED,
                                 "lookups within a thousandth of a radian",
                                 "no environment is reflected, it has one colour, or the lobe is "
                                 "narrower than a thousandth: a mirror",
                                 0, .decide = wr_decide_blur, .settle = wr_settle_blur },
    [WR_ROW(WR_EFFECT_COLOUR)] = { "E5", "colour picture", WR_PROOF_IDENTICAL, NULL,
                                   "there is no picture, or it is white everywhere", STAGE(COLOUR),
                                   .decide = wr_decide_colour },
    [WR_ROW(WR_EFFECT_TINT)] = { "E64", "filtered colour", WR_PROOF_IDENTICAL, NULL,
                                 "the dials are not set to filtering and no plane is endless, "
                                 "there is no colour picture, or it has one colour; footprints up "
                                 "to one of its texels use the picture itself",
                                 STAGE(TINT), .decide = wr_decide_tint, .settle = wr_settle_tint },
    [WR_ROW(WR_EFFECT_FACETS)] = { "E75", "pictures of roughness and metalness", WR_PROOF_IDENTICAL,
                                   NULL,
                                   "there are no such pictures, the reflection model uses neither, "
                                   "or no light that needs them is computed; footprints up to one "
                                   "of their texels use the pictures themselves",
                                   STAGE(FACETS), .only_way = true, .decide = wr_decide_facets,
                                   .settle = wr_settle_facets },
    [WR_ROW(WR_EFFECT_VARIED)] = { "E72", "roughness by place", WR_PROOF_IDENTICAL, NULL,
                                   "neither a picture nor a solid texture sets the roughness, the "
                                   "reflection model has none, or no light is computed",
                                   0, .only_way = true, .decide = wr_decide_varied },
    [WR_ROW(WR_EFFECT_EMBOSSED)] = { "E71", "bump of the solid texture", WR_PROOF_BOUNDED,
                                     "rounding of the normal",
                                     "there is no solid texture, or it does not drive bump; its "
                                     "height is 0; no light depends on the normal",
                                     STAGE(GRAIN), .spared = WR_RUN_DARK,
                                     .decide = wr_decide_embossed },
    [WR_ROW(WR_EFFECT_GRAIN)] = { "E46", "solid texture", WR_PROOF_IDENTICAL, NULL,
                                  "there is no solid texture, or both its colours are white; if "
                                  "both are equal, the pattern is left out",
                                  STAGE(GRAIN), .decide = wr_decide_grain,
                                  .settle = wr_settle_grain },
    [WR_ROW(WR_EFFECT_OCTAVES)] = { "E45", "solid noise", WR_PROOF_IDENTICAL, NULL,
                                    "no pattern is computed, it has no noise, or the amount of "
                                    "noise is 0",
                                    STAGE(GRAIN), .decide = wr_decide_octaves },
    [WR_ROW(WR_EFFECT_FADED)] = { "E70", "filtered solid texture", WR_PROOF_POLICY, NULL,
                                  "no pattern is computed; the dials are not set to filtering and "
                                  "no plane is endless",
                                  STAGE(GRAIN), .decide = wr_decide_faded },
    [WR_ROW(
        WR_EFFECT_NORMALS)] = { "E58", "normal map", WR_PROOF_IDENTICAL, NULL,
                                "there is no normal map, or it is flat; its strength or repetition "
                                "is 0; the mode is none; no light depends on the normal",
                                STAGE(NORMALS), .spared = WR_RUN_DARK, .decide = wr_decide_normals,
                                .settle = wr_settle_normals },
    [WR_ROW(
        WR_EFFECT_DISPLACED)] = { "E50", "displacement", WR_PROOF_BOUNDED,
                                  "half a pixel in the position of a surface point",
                                  "the surface is not displaced, or F moves no point by half a "
                                  "pixel and no lamp casts object shadows: bump mapping is enough",
                                  0, .finer = true, .decide = wr_decide_displaced,
                                  .settle = wr_settle_displaced },
    [WR_ROW(
        WR_EFFECT_PARALLAX)] = { "E85", "parallax", WR_PROOF_BOUNDED,
                                 "half a pixel in the position of a surface point",
                                 "the dial is off, the surface is displaced, or F moves no point "
                                 "by half a pixel: bump mapping is enough; meshes, surfaces of "
                                 "several faces and endless planes have no parallax",
                                 STAGE(PARALLAX), .finer = true, .decide = wr_decide_parallax,
                                 .settle = wr_settle_parallax },
    [WR_ROW(WR_EFFECT_BUMP)] = { "E6", "bump", WR_PROOF_IDENTICAL, NULL,
                                 "the mode is none; height or replication is 0; all texels are "
                                 "equal; the scheme has no slope anywhere; no light depends on the "
                                 "normal",
                                 STAGE(LOOK) | STAGE(BUMP), .spared = WR_RUN_LEVEL | WR_RUN_DARK,
                                 .decide = decide_bump, .settle = settle_bump },
    [WR_ROW(WR_EFFECT_REORIENTED)] = { "E86", "relief over a normal map", WR_PROOF_IDENTICAL, NULL,
                                       "there is no normal map, its slopes are added, or the table "
                                       "has no relief on it",
                                       0, .spared = WR_RUN_DARK, .decide = wr_decide_reoriented,
                                       .settle = wr_settle_reoriented },
    [WR_ROW(
        WR_EFFECT_GRADIENT)] = { "E9", "gradient table", WR_PROOF_BOUNDED, "rounding of the slopes",
                                 "the scheme computes slopes from the heights. For central and "
                                 "nearest, one lookup of central differences equals the paper's "
                                 "four lookups of F",
                                 STAGE(LOOK), .only_way = true,
                                 .spared = WR_RUN_LEVEL | WR_RUN_DARK, .decide = decide_gradient },
    [WR_ROW(WR_EFFECT_WIDE)] = { "E10", "replication in double", WR_PROOF_BOUNDED,
                                 "a thousandth of a texel",
                                 "replication is below 1024, where single precision is accurate to "
                                 "a thousandth of a texel",
                                 0, .finer = true, .decide = decide_wide },
    [WR_ROW(
        WR_EFFECT_INVARIANT)] = { "E11", "scale invariance", WR_PROOF_BOUNDED,
                                  "rounding of the normal",
                                  "the mode is not invariant; on the unit square it equals blinn",
                                  STAGE(BUMP), .spared = WR_RUN_LEVEL, .decide = decide_invariant,
                                  .settle = settle_invariant },
    [WR_ROW(WR_EFFECT_EXACT)] = { "E12", "exact normal", WR_PROOF_BOUNDED, "rounding of the normal",
                                  "the mode is not exact; on flat surfaces blinn is exact",
                                  STAGE(BUMP), .decide = wr_decide_exact,
                                  .settle = wr_settle_exact },
    [WR_ROW(WR_EFFECT_CURVATURE)] = { "E13", "second derivatives", WR_PROOF_IDENTICAL, NULL,
                                      "E12 is left out", STAGE(CURVATURE), .only_way = true,
                                      .decide = wr_decide_curvature,
                                      .settle = wr_settle_curvature },
    [WR_ROW(WR_EFFECT_SHADOW)] = { "E47", "relief shadow", WR_PROOF_IDENTICAL, NULL,
                                   "the material's shadow is off, no light is computed, or there "
                                   "is no relief. It is not available for formulas, tables that "
                                   "are not periodic, meshes, faces with tables of their own and "
                                   "stretched objects; for displaced surfaces, object shadows "
                                   "replace it. Lamps above the steepest horizon need no lookup",
                                   STAGE(SHADOW), .only_way = true, .decide = wr_decide_shadow },
    [WR_ROW(WR_EFFECT_CAST)] = { "E49", "object shadow", WR_PROOF_IDENTICAL, NULL,
                                 "no light casts object shadows, `dials rays=0`, or no light is "
                                 "computed; the only object is convex or flat and not displaced, "
                                 "or no bounding sphere of another object is between it and a lamp",
                                 STAGE(CAST), .spared = WR_RUN_DARK, .decide = wr_decide_cast,
                                 .settle = wr_settle_cast },
    [WR_ROW(WR_EFFECT_OCCLUSION)] = { "E48", "ambient occlusion", WR_PROOF_IDENTICAL, NULL,
                                      "the material's occlusion is off, there is neither ambient "
                                      "light nor an environment, or there is no relief; not "
                                      "available where relief shadows are not",
                                      STAGE(OCCLUSION), .only_way = true,
                                      .decide = wr_decide_occlusion,
                                      .settle = wr_settle_occlusion },
    [WR_ROW(WR_EFFECT_SAMPLES)] = { "E15", "supersampling", WR_PROOF_POLICY, NULL,
                                    "the dial is set to one sample per pixel", STAGE(RESOLVE),
                                    .decide = wr_decide_samples, .settle = wr_settle_samples },
    [WR_ROW(WR_EFFECT_BOUND)] = { "E16", "refinement by bound", WR_PROOF_BOUNDED, "`contrast`",
                                  "the dials are not set to it, or no bound on the change of "
                                  "intensity within a pixel is available: surfaces other than "
                                  "plane, cube and sphere, schemes other than central and nearest, "
                                  "normals other than blinn, a colour picture; or bounds would "
                                  "save too little of the view",
                                  STAGE(BOUND), .decide = wr_decide_bound },
    [WR_ROW(WR_EFFECT_FILTER)] = { "E17", "filtered slopes", WR_PROOF_IDENTICAL, NULL,
                                   "the dials are not set to filtering, or the table is not used; "
                                   "footprints up to one texel use the table itself",
                                   STAGE(FOOTPRINT) | STAGE(PYRAMID), .decide = wr_decide_filter,
                                   .settle = wr_settle_filter },
    [WR_ROW(WR_EFFECT_BACK)] = { "E25", "back faces", WR_PROOF_IDENTICAL, NULL,
                                 "a closed body seen from outside hides its back faces", 0,
                                 .decide = wr_decide_back },
    [WR_ROW(WR_EFFECT_DEPTH)] = { "E26", "depth buffer", WR_PROOF_IDENTICAL, NULL,
                                  "the nearest intersection of the ray is enough; the view is at "
                                  "rest, and the visible points of its samples are stored",
                                  STAGE(VISIBILITY), .only_way = true, .manner = true,
                                  .decide = wr_decide_depth, .settle = wr_settle_depth },
    [WR_ROW(WR_EFFECT_NEWTON)] = { "E27", "inversion by Newton", WR_PROOF_BOUNDED,
                                   "rounding of u and v",
                                   "rays are intersected in closed form; the view is at rest, and "
                                   "its (u,v) are stored",
                                   STAGE(NEWTON), .manner = true, .decide = wr_decide_newton,
                                   .settle = wr_settle_newton },
    [WR_ROW(WR_EFFECT_PERSPECTIVE)] = { "E28", "perspective divide", WR_PROOF_IDENTICAL, NULL,
                                        "the camera is orthographic", 0, .only_way = true,
                                        .decide = wr_decide_perspective },
    [WR_ROW(WR_EFFECT_AGAIN)] = { "E29", "re-rendering", WR_PROOF_IDENTICAL, NULL,
                                  "the view is at rest and no edit reaches the tile", 0,
                                  .only_way = true, .manner = true, .decide = wr_decide_again },
    [WR_ROW(WR_EFFECT_STEADY)] = { "E76", "normals of a resting view", WR_PROOF_IDENTICAL, NULL,
                                   "the view is at rest, and only light and material have changed "
                                   "since its points and normals were stored",
                                   0, .only_way = true, .manner = true,
                                   .decide = wr_decide_relight },
    [WR_ROW(WR_EFFECT_BESIDE)] = { "E30", "tiles beside the object", WR_PROOF_IDENTICAL, NULL,
                                   "tiles, and parts of tiles, outside the object's outline are "
                                   "only cleared",
                                   0, .only_way = true, .manner = true,
                                   .decide = wr_decide_beside },
    [WR_ROW(WR_EFFECT_SPREAD)] = { "E31", "spread of slopes", WR_PROOF_POLICY, NULL,
                                   "the dials are not set to moments, nothing is filtered, or "
                                   "there is no highlight",
                                   STAGE(SPREAD), .decide = decide_spread,
                                   .settle = settle_spread },
    [WR_ROW(WR_EFFECT_WIDENED)] = { "E39", "widening without spread", WR_PROOF_IDENTICAL, NULL,
                                    "no highlight is widened. Otherwise it is skipped for runs of "
                                    "samples without a spread of slopes, as where a pixel is not "
                                    "larger than a texel",
                                    0, .only_way = true, .manner = true,
                                    .decide = wr_decide_widened },
    [WR_ROW(
        WR_EFFECT_FACED)] = { "E40", "normals bent into view", WR_PROOF_IDENTICAL, NULL,
                              "the reflection model has no microfacet highlight. Otherwise it is "
                              "skipped for runs of samples whose normals all face the viewer",
                              0, .only_way = true, .manner = true, .decide = wr_decide_faced },
    [WR_ROW(WR_EFFECT_FAINT)] = { "E37", "faint highlights", WR_PROOF_BOUNDED,
                                  "`faint` for each light, for colours up to 1",
                                  "the reflection model has no microfacet highlight, or the dial "
                                  "keeps faint highlights; with roughness by place there is no "
                                  "bound. Otherwise highlights below `faint` are dropped, and "
                                  "skipped for runs of samples where all are below it by the "
                                  "largest possible D, V and F",
                                  0, .decide = wr_decide_faint, .settle = wr_settle_faint },
    [WR_ROW(WR_EFFECT_ROUNDED)] = { "E32", "rounded heights", WR_PROOF_POLICY, NULL,
                                    "the dial is set to unrounded heights", 0,
                                    .decide = decide_rounded, .settle = settle_rounded },
    [WR_ROW(WR_EFFECT_DOUBLE)] = { "E33", "double precision", WR_PROOF_POLICY, NULL,
                                   "the dial is set to single precision", 0,
                                   .decide = decide_double, .settle = settle_double },
    [WR_ROW(WR_EFFECT_HALF)] = { "E34", "half precision", WR_PROOF_POLICY, NULL,
                                 "the dial is not set to normals and light in half precision",
                                 STAGE(HALF), .decide = decide_half },
    [WR_ROW(WR_EFFECT_PARAMETERS)] = { "E54", "u and v", WR_PROOF_IDENTICAL, NULL,
                                       "on a sphere, a cylinder, a cone or a mesh, nothing needs "
                                       "them: no bump, no colour picture; other surfaces are "
                                       "intersected at u and v",
                                       STAGE(PARAMETERS), .only_way = true,
                                       .decide = wr_decide_parameters },
    [WR_ROW(WR_EFFECT_TANGENTS)] = { "E55", "tangents", WR_PROOF_IDENTICAL, NULL,
                                     "on a sphere, a cylinder, a cone or a mesh, no slope tilts "
                                     "the normal and no colour picture is filtered; other surfaces "
                                     "compute them with the point",
                                     0, .only_way = true, .spared = WR_RUN_LEVEL,
                                     .decide = wr_decide_tangents },
    [WR_ROW(WR_EFFECT_DARK)] = { "E18", "light on the dark side", WR_PROOF_IDENTICAL, NULL,
                                 "all lights are behind a run of samples, for every slope that it "
                                 "could read: it gets only ambient light, without bump. Tested "
                                 "where the highlight is gated, for blinn's normals from a "
                                 "gradient table, and for unbumped normals",
                                 0, .only_way = true, .manner = true, .decide = wr_decide_dark },
    [WR_ROW(WR_EFFECT_GROUND)] = { "E63", "bump on level ground", WR_PROOF_IDENTICAL, NULL,
                                   "no tile of the table that a run of samples could read has a "
                                   "slope, so n' is n. Tested if less than three quarters of the "
                                   "table's tiles have slopes",
                                   0, .only_way = true, .manner = true,
                                   .decide = wr_decide_ground },
    [WR_ROW(WR_EFFECT_HIDDEN)] = { "E52", "hidden objects", WR_PROOF_IDENTICAL, NULL,
                                   "there is one visible object. Several are drawn front to back, "
                                   "and an object is skipped in tiles that nearer objects fill",
                                   0, .only_way = true, .manner = true,
                                   .decide = wr_decide_hidden },
    [WR_ROW(WR_EFFECT_BETWEEN)] = { "E53", "depth between objects", WR_PROOF_IDENTICAL, NULL,
                                    "there is one visible object; in tiles that only one object's "
                                    "bounding box touches. Elsewhere hidden samples are dropped "
                                    "before shading",
                                    STAGE(BETWEEN), .only_way = true, .manner = true,
                                    .decide = wr_decide_between },
    [WR_ROW(WR_EFFECT_SMOOTH)] = { "E57", "interpolated normals", WR_PROOF_BOUNDED,
                                   "two units of the last place",
                                   "the three normals of each triangle are equal, or no light "
                                   "depends on them",
                                   0, .decide = wr_decide_smooth },
    [WR_ROW(WR_EFFECT_BLOCKS)] = { "E61", "blocks that look away", WR_PROOF_IDENTICAL, NULL,
                                   "for a closed mesh seen from outside, blocks of triangles that "
                                   "all face away are skipped",
                                   0, .only_way = true, .manner = true,
                                   .decide = wr_decide_blocks },
    [WR_ROW(WR_EFFECT_HORIZON)] = { "E67", "horizon", WR_PROOF_IDENTICAL, NULL,
                                    "no plane is endless, or rays are parallel. Otherwise slopes "
                                    "fade where a pixel covers half a period, and the plane fades "
                                    "where a pixel covers its whole width",
                                    0, .only_way = true, .decide = wr_decide_horizon },
};
WR_ROWS_END(wr_effects, WR_EFFECT_COUNT);
