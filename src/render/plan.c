#include "render/plan.h"

#include <math.h>
#include <string.h>

/* Beyond this r u loses more than 1e-3 texel of a 64-texel table in single precision (HC40). */
#define WIDE_FROM 1024.0

const WrEffectInfo wr_effects[WR_EFFECT_COUNT] = {
    [WR_EFFECT_DIFFUSE] = { "E1", "diffuse", WR_PROOF_IDENTICAL,
                            "no light shines, diffuse is 0, or the colour is black" },
    [WR_EFFECT_SPECULAR] = { "E2", "specular", WR_PROOF_IDENTICAL,
                             "no light shines, or specular is 0" },
    [WR_EFFECT_COLOUR] = { "E5", "colour picture", WR_PROOF_IDENTICAL,
                           "there is none, or it is white everywhere" },
    [WR_EFFECT_BUMP] = { "E6", "bump", WR_PROOF_IDENTICAL,
                         "the mode is none; height or replication is 0; all texels are equal; the "
                         "scheme sees no slope anywhere; no light depends on the normal" },
    [WR_EFFECT_GRADIENT] = { "E9", "gradient table", WR_PROOF_BOUNDED,
                             "the scheme takes its slopes from the heights. For central and "
                             "nearest one look-up of central differences equals the paper's four "
                             "of F" },
    [WR_EFFECT_WIDE] = { "E10", "replication in double", WR_PROOF_BOUNDED,
                         "replication is under 1024, where single precision is right to a "
                         "thousandth of a texel" },
    [WR_EFFECT_INVARIANT] = { "E11", "scale invariance", WR_PROOF_BOUNDED,
                              "the mode is not invariant; on the unit square it equals blinn" },
    [WR_EFFECT_EXACT] = { "E12", "exact normal", WR_PROOF_BOUNDED,
                          "the mode is not exact; on flat surfaces blinn is exact" },
    [WR_EFFECT_CURVATURE] = { "E13", "second derivatives", WR_PROOF_IDENTICAL, "E12 is left out" },
    [WR_EFFECT_SAMPLES] = { "E15", "supersampling", WR_PROOF_POLICY,
                            "one sample a pixel was asked for" },
    [WR_EFFECT_BOUND] = { "E16", "refinement by bound", WR_PROOF_BOUNDED,
                          "the dials do not ask for it, or no bound on the intensity's change over "
                          "a pixel is known: other surfaces than plane, cube and sphere, slopes "
                          "not from central or nearest, a normal other than blinn, a colour "
                          "picture" },
    [WR_EFFECT_FILTER] = { "E17", "filtered slopes", WR_PROOF_IDENTICAL,
                           "the dials ask for no filtering, or no table is looked up; footprints "
                           "up to one texel look up the table itself" },
    [WR_EFFECT_BACK] = { "E25", "back faces", WR_PROOF_IDENTICAL,
                         "a closed convex body hides its own back" },
    [WR_EFFECT_DEPTH] = { "E26", "depth buffer", WR_PROOF_IDENTICAL,
                          "the nearest root of the ray is enough" },
    [WR_EFFECT_NEWTON] = { "E27", "inversion by Newton", WR_PROOF_BOUNDED,
                           "rays meet the surface in closed form" },
    [WR_EFFECT_PERSPECTIVE] = { "E28", "perspective divide", WR_PROOF_IDENTICAL,
                                "the camera is orthographic" },
    [WR_EFFECT_AGAIN] = { "E29", "re-rendering", WR_PROOF_IDENTICAL,
                          "the view rests and no edit reaches the tile" },
    [WR_EFFECT_SPREAD] = { "E31", "spread of slopes", WR_PROOF_POLICY,
                           "the dials do not ask for moments, nothing is filtered, or there is no "
                           "highlight" },
    [WR_EFFECT_ROUNDED] = { "E32", "rounded heights", WR_PROOF_POLICY,
                            "the dial keeps heights as they are" },
    [WR_EFFECT_DOUBLE] = { "E33", "double precision", WR_PROOF_POLICY,
                           "single precision was asked for" },
    [WR_EFFECT_HALF] = { "E34", "half precision", WR_PROOF_POLICY,
                         "the dial does not ask for normals and light in half precision" },
};

const char *wr_proof_letter(WrProof proof)
{
    static const char *const letters[] = { "I", "B", "P" };
    return letters[proof];
}

static void say(WrPlan *plan, WrEffect effect, bool run, const char *reason)
{
    WrPlanRow *row = &plan->rows[effect];
    *row = (WrPlanRow){ .rule = wr_effects[effect].rule,
                        .name = wr_effects[effect].name,
                        .run = run,
                        .proof = wr_effects[effect].proof };
    snprintf(row->reason, sizeof row->reason, "%s", reason);
}

void wr_plan_again(WrPlan *plan, bool refresh, const char *reason)
{
    say(plan, WR_EFFECT_AGAIN, !refresh, reason);
}

void wr_plan_back(WrPlan *plan, bool closed, bool outside)
{
    say(plan, WR_EFFECT_BACK, !(closed && outside),
        !closed   ? "the surface is open: its back can be seen"
        : outside ? "a closed body seen from outside hides its own back"
                  : "the eye may be inside the body: its inner walls are seen");
}

/* ---- what it took ---- */

const char *const wr_cost_names[WR_COST_COUNT] = {
    [WR_COST_PREPARE] = "preparing", [WR_COST_VISIBILITY] = "visibility",
    [WR_COST_GEOMETRY] = "geometry", [WR_COST_STORE] = "storing",
    [WR_COST_CLEAR] = "clearing",    [WR_COST_REST] = "rest",
    [WR_COST_WAIT] = "waiting",      [WR_COST_CHOOSE] = "choosing",
};

const char *const wr_cost_reasons[WR_COST_COUNT] = {
    [WR_COST_PREPARE] = "copies of the table, pyramids, the view, the mesh",
    [WR_COST_VISIBILITY] = "which samples the object covers",
    [WR_COST_GEOMETRY] = "points, tangents and normals of the surface",
    [WR_COST_STORE] = "colours are put together and stored",
    [WR_COST_CLEAR] = "tiles are emptied; those that hold nothing are left out",
    [WR_COST_REST] = "what lies between the stages: samples moved, loops, the clock",
    [WR_COST_WAIT] = "threads that found no tile to do",
    [WR_COST_CHOOSE] = "estimates of the tolerance, blocks compared and put together",
};

static void per_pixel(WrPlan *plan)
{
    for (int e = 0; e < WR_EFFECT_COUNT; e++) {
        WrPlanRow *row = &plan->rows[e];
        row->ns_per_pixel = plan->shaded > 0 ? 1e9 * row->seconds / (double)plan->shaded : 0;
    }
}

void wr_plan_add(WrPlan *sum, const WrPlan *more)
{
    for (int e = 0; e < WR_EFFECT_COUNT; e++) {
        WrPlanRow row = more->rows[e];
        const WrPlanRow *before = &sum->rows[e];
        if (!row.run && before->run) row = *before;
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

static bool any_light(const WrScene *scene)
{
    for (int i = 0; i < scene->light_count; i++) {
        const WrLight *light = &scene->lights[i];
        if (light->strength != 0 &&
            (light->colour.x != 0 || light->colour.y != 0 || light->colour.z != 0))
            return true;
    }
    return false;
}

static bool colour_constant(const WrImage *image)
{
    const size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    for (size_t i = (size_t)image->channels; i < count; i++)
        if (image->data[i] != image->data[i - (size_t)image->channels]) return false;
    for (int c = 0; c < image->channels; c++)
        if (image->data[c] != 1.0f) return false; /* white: multiplying changes nothing */
    return true;
}

static void plan_light(WrPlan *plan, const WrScene *scene, bool everything)
{
    const WrMaterial *m = &scene->material;
    const bool lit = any_light(scene);
    const bool black = m->colour.x == 0 && m->colour.y == 0 && m->colour.z == 0;
    plan->diffuse = everything || (lit && m->diffuse != 0 && !black);
    plan->specular = everything || (lit && m->specular != 0);
    say(plan, WR_EFFECT_DIFFUSE, plan->diffuse,
        !lit              ? "no light shines"
        : m->diffuse == 0 ? "diffuse is 0"
        : black           ? "the material's colour is black"
                          : "a light shines and diffuse is not 0");
    say(plan, WR_EFFECT_SPECULAR, plan->specular,
        !lit               ? "no light shines"
        : m->specular == 0 ? "specular is 0"
                           : "a light shines and specular is not 0");
    plan->normals = plan->diffuse || plan->specular;
    plan->colour = scene->colour && (everything || !colour_constant(scene->colour));
    say(plan, WR_EFFECT_COLOUR, plan->colour,
        !scene->colour  ? "the scene has no colour picture"
        : !plan->colour ? "the colour picture is white everywhere"
                        : "the scene has a colour picture");
}

/* Why the table cannot move the normal, or NULL if it can. The exact normal of an offset surface
   (constant F) is the base's up to its sign, which flips where F passes a focal distance: so with `exact`
   on a curved base a constant F is left out only if it is 0. */
static const char *no_bump(const WrPlan *plan, const WrScene *scene, const WrTableFacts *facts)
{
    const bool table = scene->analytic.kind == WR_ANALYTIC_OFF;
    const bool offset = scene->bump == WR_BUMP_EXACT && !wr_surfaces[scene->shape.kind]->flat;
    if (scene->bump == WR_BUMP_NONE) return "bump mode is none";
    if (!plan->normals) return "no light depends on the normal";
    if (scene->height == 0) return "height is 0";
    if (table && facts->zero) return "the table is 0 everywhere";
    if (offset) return NULL;
    if (scene->replicate_u == 0 && scene->replicate_v == 0)
        return "replication is 0,0: F is constant";
    if (table && facts->flat) return "every texel of the table is equal";
    if (table && facts->slope_free) return "the scheme sees no slope anywhere in the table";
    return NULL;
}

static void plan_bump(WrPlan *plan, const WrScene *scene, const WrTableFacts *facts,
                      bool everything)
{
    const WrSurfaceInfo *info = wr_surfaces[scene->shape.kind];
    const double *size = scene->shape.value;
    const char *why = no_bump(plan, scene, facts);
    bool run = scene->bump != WR_BUMP_NONE && (everything || !why);
    bool unit_square = scene->shape.kind == WR_SURFACE_plane && size[0] == 1 && size[1] == 1;
    plan->bump = run ? scene->bump : WR_BUMP_NONE;
    say(plan, WR_EFFECT_BUMP, run, why ? why : "the table has slopes and a light shows them");

    bool invariant = plan->bump == WR_BUMP_INVARIANT && (everything || !unit_square);
    say(plan, WR_EFFECT_INVARIANT, invariant,
        scene->bump != WR_BUMP_INVARIANT ? "bump mode is not invariant"
        : !run                           ? "bump does not run"
        : unit_square                    ? "on the unit square it equals blinn"
                                         : "bump mode is invariant");
    if (plan->bump == WR_BUMP_INVARIANT && !invariant) plan->bump = WR_BUMP_BLINN;

    bool exact = plan->bump == WR_BUMP_EXACT && (everything || !info->flat);
    say(plan, WR_EFFECT_EXACT, exact,
        scene->bump != WR_BUMP_EXACT ? "bump mode is not exact"
        : !run                       ? "bump does not run"
        : info->flat                 ? "the base is flat: blinn is exact there for any F"
                                     : "bump mode is exact and the base is curved");
    if (plan->bump == WR_BUMP_EXACT && !exact) plan->bump = WR_BUMP_BLINN;
    plan->curvature = plan->bump == WR_BUMP_EXACT;
    say(plan, WR_EFFECT_CURVATURE, plan->curvature,
        plan->curvature ? "the exact normal needs how n turns"
                        : "only the exact normal needs them");
    plan->need_heights = plan->bump == WR_BUMP_EXACT;
}

static void plan_look(WrPlan *plan, const WrScene *scene)
{
    const bool table = scene->analytic.kind == WR_ANALYTIC_OFF && plan->bump != WR_BUMP_NONE;
    const bool differences =
        scene->scheme == WR_SCHEME_CENTRAL || scene->scheme == WR_SCHEME_NEAREST;
    plan->gradient_table = table && differences;
    say(plan, WR_EFFECT_GRADIENT, plan->gradient_table,
        !table        ? "no table is looked up"
        : differences ? "one look-up of central differences equals the paper's four of F"
                      : "this scheme takes its slopes from the heights");
    const double r = fmax(fabs(scene->replicate_u), fabs(scene->replicate_v));
    plan->wide = table && r >= WIDE_FROM;
    say(plan, WR_EFFECT_WIDE, plan->wide,
        !table           ? "no table is looked up"
        : r >= WIDE_FROM ? "replication of 1024 and more loses texels in single precision"
                         : "replication is under 1024: single precision is right to 1e-3 texel");
}

static void plan_visibility(WrPlan *plan, const WrScene *scene)
{
    const WrSurfaceInfo *info = wr_surfaces[scene->shape.kind];
    plan->mesh = info->inversion == WR_INVERT_MESH;
    const bool closed = info->convex_closed || (info->closed_u && info->closed_v);
    wr_plan_back(plan, closed, true); /* until the eye is known */
    say(plan, WR_EFFECT_DEPTH, plan->mesh,
        plan->mesh ? "parts of the surface may hide others"
                   : "the nearest root of the ray is enough");
    say(plan, WR_EFFECT_NEWTON, plan->mesh,
        plan->mesh ? "this surface has no closed inverse"
                   : "rays meet this surface in closed form");
    say(plan, WR_EFFECT_PERSPECTIVE, !scene->camera.orthographic,
        scene->camera.orthographic ? "the camera is orthographic" : "the camera is in perspective");
}

/* Why no bound on the intensity's change over a pixel is known, or NULL if one is. */
static const char *no_bound(const WrPlan *plan, const WrScene *scene, const WrDials *dials)
{
    if (dials->shading == WR_SHADING_HALF)
        return "no bound is known of rounding to half precision: K x K everywhere";
    const WrInversion how = wr_surfaces[scene->shape.kind]->inversion;
    if (how != WR_INVERT_PLANE && how != WR_INVERT_CUBE && how != WR_INVERT_SPHERE)
        return "no bound is known on this surface: K x K everywhere";
    if (plan->colour) return "no bound is known for a colour picture: K x K everywhere";
    if (plan->bump == WR_BUMP_NONE) return NULL;
    if (plan->bump != WR_BUMP_BLINN)
        return "no bound is known for this normal formula: K x K everywhere";
    if (!plan->gradient_table)
        return "a bound needs slopes from a table, central or nearest: K x K everywhere";
    return NULL;
}

static void plan_samples(WrPlan *plan, const WrScene *scene, const WrDials *dials)
{
    const bool adaptive = dials->aa == WR_AA_ADAPTIVE, all = dials->aa == WR_AA_SUPERSAMPLE;
    plan->samples = adaptive || all ? dials->samples : 1;
    plan->sampling = plan->samples == 1 ? WR_SAMPLING_ONE
                     : all              ? WR_SAMPLING_ALL
                                        : WR_SAMPLING_ADAPTIVE;
    say(plan, WR_EFFECT_SAMPLES, plan->samples > 1,
        !adaptive && !all    ? "the dial says one sample at the pixel's centre"
        : plan->samples == 1 ? "one sample a pixel was asked for"
        : all                ? "the dial asks for the mean of K x K intensities"
                             : "the dial asks for up to K x K where one is not enough");
    const bool wanted = plan->sampling == WR_SAMPLING_ADAPTIVE && dials->refine == WR_REFINE_BOUND;
    const char *why = no_bound(plan, scene, dials);
    plan->bounded = wanted && !why;
    say(plan, WR_EFFECT_BOUND, plan->bounded,
        !wanted ? "the dials do not ask for a bound"
        : why   ? why
                : "K x K only where the intensity may change by more than `contrast`");
}

static void plan_filter(WrPlan *plan, const WrScene *scene, const WrDials *dials)
{
    const bool wanted = dials->aa == WR_AA_FILTER || dials->aa == WR_AA_MOMENTS;
    const bool table = scene->analytic.kind == WR_ANALYTIC_OFF && plan->bump != WR_BUMP_NONE;
    const bool still = scene->replicate_u == 0 && scene->replicate_v == 0;
    plan->pyramid = wanted && table && !still;
    plan->anisotropic = plan->pyramid && dials->footprint == WR_FOOTPRINT_ANISOTROPIC;
    plan->moments = plan->pyramid && dials->aa == WR_AA_MOMENTS && plan->specular;
    plan->lean = plan->moments && dials->moments == WR_MOMENTS_LEAN;
    say(plan, WR_EFFECT_FILTER, plan->pyramid,
        !wanted  ? "the dials ask for no filtering"
        : !table ? "no table is looked up"
        : still  ? "replication is 0,0: F is constant"
                 : "footprints over a texel look up a pyramid; smaller ones level 0");
    say(plan, WR_EFFECT_SPREAD, plan->moments,
        dials->aa != WR_AA_MOMENTS ? "the dials do not ask for moments"
        : !plan->pyramid           ? "nothing is filtered"
        : !plan->specular          ? "there is no highlight to widen"
        : plan->lean               ? "the covariance of the slopes widens the highlight"
                                   : "the variance of the slopes widens the highlight");
}

static void plan_arithmetic(WrPlan *plan, const WrScene *scene, const WrDials *dials)
{
    const bool table = scene->analytic.kind == WR_ANALYTIC_OFF && plan->bump != WR_BUMP_NONE;
    const bool fewer = dials->heights != WR_HEIGHTS_DOUBLE && dials->heights != WR_HEIGHTS_FLOAT;
    const bool wide = table && dials->heights == WR_HEIGHTS_DOUBLE;
    plan->shading_double = dials->shading == WR_SHADING_DOUBLE;
    say(plan, WR_EFFECT_ROUNDED, table && fewer,
        !table   ? "no table is looked up"
        : !fewer ? "the dial keeps heights as they are"
                 : "the dial asks for heights of fewer bits");
    say(plan, WR_EFFECT_DOUBLE, plan->shading_double || wide,
        plan->shading_double ? "the dial asks for shading in double precision"
        : wide               ? "the dial asks for look-ups in double precision"
                             : "single precision was asked for");
    plan->shading_half = dials->shading == WR_SHADING_HALF;
    say(plan, WR_EFFECT_HALF, plan->shading_half,
        plan->shading_half ? "the dial asks for normals and light in half precision"
                           : "the dial does not ask for it");
}

void wr_plan_build(WrPlan *plan, const WrScene *scene, const WrDials *dials,
                   const WrTableFacts *facts, bool everything)
{
    memset(plan, 0, sizeof *plan);
    plan_light(plan, scene, everything);
    plan->normals |= facts->normals;
    plan_bump(plan, scene, facts, everything);
    plan_look(plan, scene);
    plan_visibility(plan, scene);
    plan_samples(plan, scene, dials);
    plan_filter(plan, scene, dials);
    plan_arithmetic(plan, scene, dials);
    wr_plan_again(plan, false, "a new picture: every tile is rendered");
}
