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
    if (plan->source != WR_SOURCE_TABLE) return say(WR_VERDICT_NONE, why, "no table is looked up");
    if (scheme != WR_SCHEME_CENTRAL && scheme != WR_SCHEME_NEAREST)
        return say(WR_VERDICT_NONE, why, "this scheme computes slopes from the heights");
    return say(WR_VERDICT_RUN, why,
               "one look-up of central differences equals the paper's four of F");
}

/* r u is rounded by at most r 2^-24 periods, r W 2^-24 texels of a table of width W (HC40). */
static WrVerdict decide_wide(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const double r = fmax(fabs(ask->scene->replicate_u), fabs(ask->scene->replicate_v));
    if (plan->source != WR_SOURCE_TABLE) return say(WR_VERDICT_NONE, why, "no table is looked up");
    if (r < WR_WIDE_FROM)
        return say(WR_VERDICT_SPARED, why,
                   "replication is under 1024: single precision is right to 1e-3 texel");
    return say(WR_VERDICT_RUN, why,
               "replication of 1024 and more loses texels in single precision");
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
        return say(WR_VERDICT_NONE, why, "the dials do not ask for moments");
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
    if (plan->source != WR_SOURCE_TABLE) return say(WR_VERDICT_NONE, why, "no table is looked up");
    if (heights == WR_HEIGHTS_DOUBLE || heights == WR_HEIGHTS_FLOAT)
        return say(WR_VERDICT_NONE, why, "the dial keeps heights as they are");
    return say(WR_VERDICT_RUN, why, "the dial is set to heights of fewer bits");
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
                   "the object is so flat that single precision would not find its place");
    if (plan->source == WR_SOURCE_TABLE && ask->dials->heights == WR_HEIGHTS_DOUBLE)
        return say(WR_VERDICT_RUN, why, "the dial is set to look-ups in double precision");
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
        return say(WR_VERDICT_NONE, why, "the dial does not ask for it");
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
                                    "no light shines, diffuse is 0, the colour is black, or the "
                                    "material is all metal; of "
                                    "several lights those that do not shine",
                                    STAGE(DIFFUSE), .spared = WR_RUN_DARK,
                                    .decide = wr_decide_diffuse },
    [WR_ROW(WR_EFFECT_SPECULAR)] = { "E2", "specular", WR_PROOF_IDENTICAL, NULL,
                                     "no light shines, specular is 0, the reflection model has no "
                                     "highlight, or its facets' index is 1",
                                     STAGE(SPECULAR), .spared = WR_RUN_DARK | WR_RUN_DULL,
                                     .decide = wr_decide_specular },
    [WR_ROW(WR_EFFECT_MODEL)] = { "E36", "reflection model", WR_PROOF_BOUNDED,
                                  "rounding of the light",
                                  "the model is that of new scenes, its highlight white; without a "
                                  "highlight, or of matt facets of roughness 0, it is Lambert's",
                                  0, .only_way = true, .spared = WR_RUN_DARK,
                                  .decide = wr_decide_model, .settle = wr_settle_model },
    [WR_ROW(WR_EFFECT_KEPT)] = { "E44", "kept diffuse light", WR_PROOF_IDENTICAL, NULL,
                                 "highlights leave the model's diffuse light as it is, or its "
                                 "energy is as published; there "
                                 "is no diffuse light, as of metal, that could be too much beside "
                                 "the highlight",
                                 0, .spared = WR_RUN_DARK, .decide = wr_decide_kept,
                                 .settle = wr_settle_kept },
    [WR_ROW(WR_EFFECT_SURROUND)] = { "E41", "surroundings", WR_PROOF_IDENTICAL, NULL,
                                     "there are none, or no light comes from them; diffuse is 0, "
                                     "the colour is black, or the material is all metal",
                                     STAGE(SURROUND), .decide = wr_decide_surround },
    [WR_ROW(WR_EFFECT_HARMONICS)] = { "E42", "harmonics", WR_PROOF_IDENTICAL, NULL,
                                      "no diffuse light comes from surroundings, or they are of "
                                      "one colour, for which one coefficient of the nine is enough",
                                      0, .decide = wr_decide_harmonics,
                                      .settle = wr_settle_harmonics },
    [WR_ROW(
        WR_EFFECT_MIRROR)] = { "E65", "mirrored surroundings", WR_PROOF_IDENTICAL, NULL,
                               "there are none, or no light comes from them; specular is 0, the "
                               "reflection model has no highlight, or its facets' index is 1",
                               STAGE(MIRROR), .decide = wr_decide_mirror },
    [WR_ROW(WR_EFFECT_BLUR)] = { "E43", "blurred surroundings", WR_PROOF_BOUNDED,
                                 "lookups within a thousandth of a radian",
                                 "none are seen in the surface, they are of one colour, or the "
                                 "lobe is a thousandth wide, where the surface mirrors",
                                 0, .decide = wr_decide_blur, .settle = wr_settle_blur },
    [WR_ROW(WR_EFFECT_COLOUR)] = { "E5", "colour picture", WR_PROOF_IDENTICAL, NULL,
                                   "there is none, or it is white everywhere", STAGE(COLOUR),
                                   .decide = wr_decide_colour },
    [WR_ROW(WR_EFFECT_TINT)] = { "E64", "filtered colour", WR_PROOF_IDENTICAL, NULL,
                                 "the dials ask for no filtering and no plane goes on to the "
                                 "horizon, no colour picture is looked up, "
                                 "or it is of one colour; footprints up to one of its texels look "
                                 "up the picture itself",
                                 STAGE(TINT), .decide = wr_decide_tint, .settle = wr_settle_tint },
    [WR_ROW(WR_EFFECT_FACETS)] = { "E75", "pictures of roughness and metalness", WR_PROOF_IDENTICAL,
                                   NULL,
                                   "there is none, the reflection model goes by neither, or no "
                                   "light is worked out that does; footprints up to one of their "
                                   "texels look up the pictures themselves",
                                   STAGE(FACETS), .only_way = true, .decide = wr_decide_facets,
                                   .settle = wr_settle_facets },
    [WR_ROW(WR_EFFECT_VARIED)] = { "E72", "roughness by place", WR_PROOF_IDENTICAL, NULL,
                                   "neither a picture nor a solid texture drives it, the "
                                   "reflection model goes by no "
                                   "roughness, or no light is worked out",
                                   0, .only_way = true, .decide = wr_decide_varied },
    [WR_ROW(WR_EFFECT_EMBOSSED)] = { "E71", "bump of the solid texture", WR_PROOF_BOUNDED,
                                     "rounding of the normal",
                                     "there is none, or it drives no bump; its height is 0; no "
                                     "light depends on the normal",
                                     STAGE(GRAIN), .spared = WR_RUN_DARK,
                                     .decide = wr_decide_embossed },
    [WR_ROW(WR_EFFECT_GRAIN)] = { "E46", "solid texture", WR_PROOF_IDENTICAL, NULL,
                                  "there is none, or both its colours are white; of two that are "
                                  "one the pattern is left out",
                                  STAGE(GRAIN), .decide = wr_decide_grain,
                                  .settle = wr_settle_grain },
    [WR_ROW(WR_EFFECT_OCTAVES)] = { "E45", "solid noise", WR_PROOF_IDENTICAL, NULL,
                                    "no pattern is worked out, it has no noise, or the noise's "
                                    "amount is 0",
                                    STAGE(GRAIN), .decide = wr_decide_octaves },
    [WR_ROW(WR_EFFECT_FADED)] = { "E70", "filtered solid texture", WR_PROOF_POLICY, NULL,
                                  "no pattern is worked out; the dials ask for no filtering and no "
                                  "plane goes on to the horizon",
                                  STAGE(GRAIN), .decide = wr_decide_faded },
    [WR_ROW(WR_EFFECT_NORMALS)] = { "E58", "normal map", WR_PROOF_IDENTICAL, NULL,
                                    "there is none, or it is straight up everywhere; its strength "
                                    "or repetition is 0; the mode is none; no light depends on "
                                    "the normal",
                                    STAGE(NORMALS), .spared = WR_RUN_DARK,
                                    .decide = wr_decide_normals, .settle = wr_settle_normals },
    [WR_ROW(WR_EFFECT_DISPLACED)] = { "E50", "displacement", WR_PROOF_BOUNDED,
                                      "half a pixel, of where a point of the surface is seen",
                                      "the surface is not displaced, or F moves no point of it by "
                                      "half a pixel, and no lamp lets objects hide it: bump "
                                      "suffices",
                                      0, .finer = true, .decide = wr_decide_displaced,
                                      .settle = wr_settle_displaced },
    [WR_ROW(
        WR_EFFECT_PARALLAX)] = { "E85", "parallax", WR_PROOF_BOUNDED,
                                 "half a pixel, of where a point of the surface is seen",
                                 "the dial is off, the surface is displaced, or F moves no "
                                 "point of it by half a pixel: bump suffices; meshes, bodies of "
                                 "several faces and infinite planes have none",
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
                                       "has no relief over it",
                                       0, .spared = WR_RUN_DARK, .decide = wr_decide_reoriented,
                                       .settle = wr_settle_reoriented },
    [WR_ROW(
        WR_EFFECT_GRADIENT)] = { "E9", "gradient table", WR_PROOF_BOUNDED, "rounding of the slopes",
                                 "the scheme computes slopes from the heights. For central and "
                                 "nearest one look-up of central differences equals the paper's "
                                 "four of F",
                                 STAGE(LOOK), .only_way = true,
                                 .spared = WR_RUN_LEVEL | WR_RUN_DARK, .decide = decide_gradient },
    [WR_ROW(WR_EFFECT_WIDE)] = { "E10", "replication in double", WR_PROOF_BOUNDED,
                                 "a thousandth of a texel",
                                 "replication is under 1024, where single precision is right to a "
                                 "thousandth of a texel",
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
                                   "the material asks for none, no light is worked out, there is "
                                   "no relief; of "
                                   "formulas, tables that end, meshes, faces with tables of their "
                                   "own and stretched "
                                   "objects it is not known; of a displaced one all lights let "
                                   "objects hide them. Lamps above the steepest horizon of "
                                   "all look none up",
                                   STAGE(SHADOW), .only_way = true, .decide = wr_decide_shadow },
    [WR_ROW(WR_EFFECT_CAST)] = { "E49", "object shadow", WR_PROOF_IDENTICAL, NULL,
                                 "no light that shines asks for any, `dials rays=0`, no light is "
                                 "worked out; one convex or flat object "
                                 "alone that is not displaced, or no ball about another stands "
                                 "between its own and a lamp",
                                 STAGE(CAST), .spared = WR_RUN_DARK, .decide = wr_decide_cast,
                                 .settle = wr_settle_cast },
    [WR_ROW(WR_EFFECT_OCCLUSION)] = { "E48", "ambient occlusion", WR_PROOF_IDENTICAL, NULL,
                                      "the material asks for none, there is neither ambient light "
                                      "nor surroundings, there is no relief; of what has no relief "
                                      "shadow it is not known either",
                                      STAGE(OCCLUSION), .only_way = true,
                                      .decide = wr_decide_occlusion,
                                      .settle = wr_settle_occlusion },
    [WR_ROW(WR_EFFECT_SAMPLES)] = { "E15", "supersampling", WR_PROOF_POLICY, NULL,
                                    "the dial is set to one sample a pixel", STAGE(RESOLVE),
                                    .decide = wr_decide_samples, .settle = wr_settle_samples },
    [WR_ROW(
        WR_EFFECT_BOUND)] = { "E16", "refinement by bound", WR_PROOF_BOUNDED, "`contrast`",
                              "the dials do not ask for it, or no bound on the intensity's change "
                              "over "
                              "a pixel is known: other surfaces than plane, cube and sphere, "
                              "slopes "
                              "not from central or nearest, a normal other than blinn, a colour "
                              "picture; or bounds would spare too little of the view",
                              STAGE(BOUND), .decide = wr_decide_bound },
    [WR_ROW(WR_EFFECT_FILTER)] = { "E17", "filtered slopes", WR_PROOF_IDENTICAL, NULL,
                                   "the dials ask for no filtering, or no table is looked up; "
                                   "footprints "
                                   "up to one texel look up the table itself",
                                   STAGE(FOOTPRINT) | STAGE(PYRAMID), .decide = wr_decide_filter,
                                   .settle = wr_settle_filter },
    [WR_ROW(WR_EFFECT_BACK)] = { "E25", "back faces", WR_PROOF_IDENTICAL, NULL,
                                 "a closed body seen from outside hides its own back", 0,
                                 .decide = wr_decide_back },
    [WR_ROW(WR_EFFECT_DEPTH)] = { "E26", "depth buffer", WR_PROOF_IDENTICAL, NULL,
                                  "the nearest root of the ray is enough; the view is still, and "
                                  "the visible points of its samples are stored",
                                  STAGE(VISIBILITY), .only_way = true, .manner = true,
                                  .decide = wr_decide_depth, .settle = wr_settle_depth },
    [WR_ROW(WR_EFFECT_NEWTON)] = { "E27", "inversion by Newton", WR_PROOF_BOUNDED,
                                   "rounding of u and v",
                                   "rays meet the surface in closed form; the view rests, and its "
                                   "(u,v) are known",
                                   STAGE(NEWTON), .manner = true, .decide = wr_decide_newton,
                                   .settle = wr_settle_newton },
    [WR_ROW(WR_EFFECT_PERSPECTIVE)] = { "E28", "perspective divide", WR_PROOF_IDENTICAL, NULL,
                                        "the camera is orthographic", 0, .only_way = true,
                                        .decide = wr_decide_perspective },
    [WR_ROW(WR_EFFECT_AGAIN)] = { "E29", "re-rendering", WR_PROOF_IDENTICAL, NULL,
                                  "the view rests and no edit reaches the tile", 0,
                                  .only_way = true, .manner = true, .decide = wr_decide_again },
    [WR_ROW(WR_EFFECT_STEADY)] = { "E76", "normals of a resting view", WR_PROOF_IDENTICAL, NULL,
                                   "nothing but light and material of a resting view has changed "
                                   "since its points and normals were noted",
                                   0, .only_way = true, .manner = true,
                                   .decide = wr_decide_relight },
    [WR_ROW(WR_EFFECT_BESIDE)] = { "E30", "tiles beside the object", WR_PROOF_IDENTICAL, NULL,
                                   "beyond the object's outline tiles, and parts of tiles, are "
                                   "cleared and no more",
                                   0, .only_way = true, .manner = true,
                                   .decide = wr_decide_beside },
    [WR_ROW(WR_EFFECT_SPREAD)] = { "E31", "spread of slopes", WR_PROOF_POLICY, NULL,
                                   "the dials do not ask for moments, nothing is filtered, or "
                                   "there is no "
                                   "highlight",
                                   STAGE(SPREAD), .decide = decide_spread,
                                   .settle = settle_spread },
    [WR_ROW(WR_EFFECT_WIDENED)] = { "E39", "widening without spread", WR_PROOF_IDENTICAL, NULL,
                                    "no highlight is widened. Else runs of samples over which "
                                    "slopes do not spread, as where a pixel is no larger than a "
                                    "texel, have theirs as it is",
                                    0, .only_way = true, .manner = true,
                                    .decide = wr_decide_widened },
    [WR_ROW(WR_EFFECT_FACED)] = { "E40", "normals bent into view", WR_PROOF_IDENTICAL, NULL,
                                  "only facets that are small mirrors are bent. Of those, "
                                  "runs of samples whose normals all face the viewer",
                                  0, .only_way = true, .manner = true, .decide = wr_decide_faced },
    [WR_ROW(WR_EFFECT_FAINT)] = { "E37", "faint highlights", WR_PROOF_BOUNDED,
                                  "`faint` for each light, where colours are up to 1",
                                  "highlights are not of facets, or the dial keeps them however "
                                  "faint; by place they are not bounded. Else those below `faint` "
                                  "are none, and runs of samples where all are, by the most that "
                                  "D, V and F can be there, have none worked out",
                                  0, .decide = wr_decide_faint, .settle = wr_settle_faint },
    [WR_ROW(WR_EFFECT_ROUNDED)] = { "E32", "rounded heights", WR_PROOF_POLICY, NULL,
                                    "the dial keeps heights as they are", 0,
                                    .decide = decide_rounded, .settle = settle_rounded },
    [WR_ROW(WR_EFFECT_DOUBLE)] = { "E33", "double precision", WR_PROOF_POLICY, NULL,
                                   "the dial is set to single precision", 0,
                                   .decide = decide_double, .settle = settle_double },
    [WR_ROW(WR_EFFECT_HALF)] = { "E34", "half precision", WR_PROOF_POLICY, NULL,
                                 "the dial does not ask for normals and light in half precision",
                                 STAGE(HALF), .decide = decide_half },
    [WR_ROW(
        WR_EFFECT_PARAMETERS)] = { "E54", "u and v", WR_PROOF_IDENTICAL, NULL,
                                   "on a sphere, a cylinder, a cone or a mesh nothing is looked up "
                                   "there: no "
                                   "bump, no colour "
                                   "picture; other surfaces are met at u and v",
                                   STAGE(PARAMETERS), .only_way = true,
                                   .decide = wr_decide_parameters },
    [WR_ROW(WR_EFFECT_TANGENTS)] = { "E55", "tangents", WR_PROOF_IDENTICAL, NULL,
                                     "on a sphere, a cylinder, a cone or a mesh no slope turns the "
                                     "normal "
                                     "and no colour picture is filtered; other surfaces give them "
                                     "with the point",
                                     0, .only_way = true, .spared = WR_RUN_LEVEL,
                                     .decide = wr_decide_tangents },
    [WR_ROW(WR_EFFECT_DARK)] = { "E18", "light on the dark side", WR_PROOF_IDENTICAL, NULL,
                                 "all lights are behind a run of samples, however the slopes that "
                                 "it could read bend its normals: it has the ambient light alone, "
                                 "and no bump. Asked where the highlight is gated, of blinn's "
                                 "normals from a gradient table, and where nothing is bent",
                                 0, .only_way = true, .manner = true, .decide = wr_decide_dark },
    [WR_ROW(WR_EFFECT_GROUND)] = { "E63", "bump on level ground", WR_PROOF_IDENTICAL, NULL,
                                   "no tile of the table that a run of samples could read has a "
                                   "slope: n' is n there. Asked where less than three quarters of "
                                   "the table's tiles have slopes",
                                   0, .only_way = true, .manner = true,
                                   .decide = wr_decide_ground },
    [WR_ROW(WR_EFFECT_HIDDEN)] = { "E52", "hidden objects", WR_PROOF_IDENTICAL, NULL,
                                   "one object is shown. Of several, drawn from the front, one "
                                   "is left out of each tile that nearer ones fill",
                                   0, .only_way = true, .manner = true,
                                   .decide = wr_decide_hidden },
    [WR_ROW(WR_EFFECT_BETWEEN)] = { "E53", "depth between objects", WR_PROOF_IDENTICAL, NULL,
                                    "one object is shown, and in tiles that only one object's "
                                    "bound meets. Where several do, a sample that another hides "
                                    "goes before its light is worked out",
                                    STAGE(BETWEEN), .only_way = true, .manner = true,
                                    .decide = wr_decide_between },
    [WR_ROW(WR_EFFECT_SMOOTH)] = { "E57", "interpolated normals", WR_PROOF_BOUNDED,
                                   "two units of the last place",
                                   "the three normals of each of a mesh's triangles are the same, "
                                   "or no light depends on them",
                                   0, .decide = wr_decide_smooth },
    [WR_ROW(WR_EFFECT_BLOCKS)] = { "E61", "blocks that look away", WR_PROOF_IDENTICAL, NULL,
                                   "of a closed mesh seen from outside, blocks of triangles whose "
                                   "normals all look away from the eye",
                                   0, .only_way = true, .manner = true,
                                   .decide = wr_decide_blocks },
    [WR_ROW(WR_EFFECT_HORIZON)] = { "E67", "horizon", WR_PROOF_IDENTICAL, NULL,
                                    "no plane goes on to the horizon, or rays are parallel. Else "
                                    "slopes ease off where a pixel holds half a period, "
                                    "and the plane fades where it holds all its sides",
                                    0, .only_way = true, .decide = wr_decide_horizon },
};
WR_ROWS_END(wr_effects, WR_EFFECT_COUNT);
