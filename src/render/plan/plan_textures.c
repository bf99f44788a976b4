/* Plan rows of pictures mapped onto the object. */
#include "render/plan/plan_internal.h"

#include "image/image.h"
#include "scene/texture_sample.h"
#include "scene/scene.h"

/* ---- colour ---- */

/* White everywhere: multiplying by it changes nothing.
   C = 1 is the neutral element of the product in light_sum. */
static bool colour_white(const WrImage *image)
{
    const size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    for (size_t i = 0; i < count; i++)
        if (image->data[i] != 1.0f) return false;
    return true;
}

WrVerdict wr_decide_colour(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const WrImage *image = ask->scene->colour;
    (void)plan;
    if (!image) return say(WR_VERDICT_NONE, why, "the scene has no colour picture");
    if (colour_white(image))
        return say(WR_VERDICT_SPARED, why, "the colour picture is white everywhere");
    return say(WR_VERDICT_RUN, why, "the scene has a colour picture");
}

/* All texels have one colour, so every mean equals it, to the bit.
   Mixing a with a is exact: a + t (a - a) = a. */
static bool colour_even(const WrImage *image)
{
    const size_t channels = (size_t)image->channels;
    const size_t count = (size_t)image->width * (size_t)image->height * channels;
    for (size_t i = channels; i < count; i++)
        if (image->data[i] != image->data[i - channels]) return false;
    return true;
}

WrVerdict wr_decide_tint(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    double ru, rv;
    wr_scene_repeat(ask->scene, &ask->scene->colour_laid, &ru, &rv);
    /* Towards a horizon a pixel covers arbitrarily many texels, whatever the dials say; slopes are treated the
       same way (E67). */
    const bool endless = wr_shape_endless(&ask->scene->shape) && !ask->scene->camera.orthographic;
    if (!wants_filter(ask->dials) && !endless)
        return say(WR_VERDICT_NONE, why, "the dials are not set to filtering");
    if (!runs(plan, WR_EFFECT_COLOUR))
        return say(WR_VERDICT_NONE, why, "the colour picture is not used");
    if (ru == 0 && rv == 0)
        return say(WR_VERDICT_SPARED, why, "it repeats 0 times: one point of it is visible");
    if (colour_even(ask->scene->colour))
        return say(WR_VERDICT_SPARED, why, "the colour picture has one colour");
    return say(WR_VERDICT_RUN, why,
               "footprints above a texel use its means; smaller ones the picture itself");
}

void wr_settle_tint(WrPlan *plan, const WrPlanRequest *ask)
{
    plan->tint_anisotropic =
        runs(plan, WR_EFFECT_TINT) && ask->dials->footprint == WR_FOOTPRINT_ANISOTROPIC;
}

/* ---- a solid texture ---- */

static bool one_colour(const WrSolidTexture *grain)
{
    for (int c = 0; c < 3; c++)
        if (grain->light[c] != grain->dark[c]) return false;
    return true;
}

static bool all_white(const WrSolidTexture *grain)
{
    return one_colour(grain) && grain->light[0] == 1 && grain->light[1] == 1 &&
           grain->light[2] == 1;
}

WrVerdict wr_decide_grain(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const WrSolidTexture *grain = &ask->scene->grain;
    (void)plan;
    if (grain->kind == WR_SOLID_TEXTURE_OFF)
        return say(WR_VERDICT_NONE, why, "the object has no solid texture");
    if (!(grain->drives & WR_SOLID_TEXTURE_COLOURS))
        return say(WR_VERDICT_NONE, why, "the solid texture drives no colour");
    if (all_white(grain)) return say(WR_VERDICT_SPARED, why, "both its colours are white");
    if (one_colour(grain))
        return say(WR_VERDICT_RUN, why, "both its colours are equal: no pattern is computed");
    return say(WR_VERDICT_RUN, why, "the object looks carved from it");
}

/* Reason why the solid texture does not bend the normal, or NULL if it does. */
static const char *no_embossing(const WrPlan *plan, const WrPlanRequest *ask)
{
    const WrSolidTexture *grain = &ask->scene->grain;
    if (grain->height == 0) return "the solid texture's height is 0";
    if (!lit(plan, ask)) return "no light depends on the normal";
    return NULL;
}

WrVerdict wr_decide_embossed(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const WrSolidTexture *grain = &ask->scene->grain;
    if (grain->kind == WR_SOLID_TEXTURE_OFF)
        return say(WR_VERDICT_NONE, why, "the object has no solid texture");
    if (!(grain->drives & WR_SOLID_TEXTURE_BUMPS))
        return say(WR_VERDICT_NONE, why, "the solid texture drives no bump");
    const char *reason = no_embossing(plan, ask);
    if (reason) return say(WR_VERDICT_SPARED, why, reason);
    return say(WR_VERDICT_RUN, why, "the solid texture has heights, and a light depends on them");
}

/* True if its pattern is used. */
void wr_settle_grain(WrPlan *plan, const WrPlanRequest *ask)
{
    const WrSolidTexture *grain = &ask->scene->grain;
    const bool coloured = runs(plan, WR_EFFECT_GRAIN) && !one_colour(grain);
    plan->grain = coloured || runs(plan, WR_EFFECT_EMBOSSED) ||
                          (runs(plan, WR_EFFECT_VARIED) && grain_roughens(ask->scene))
                      ? grain->kind
                      : WR_SOLID_TEXTURE_OFF;
}

WrVerdict wr_decide_octaves(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (plan->grain == WR_SOLID_TEXTURE_OFF)
        return say(WR_VERDICT_NONE, why, "no solid pattern is computed");
    if (!wr_grains[plan->grain].noisy)
        return say(WR_VERDICT_NONE, why, "the solid texture has no noise");
    if (ask->scene->grain.amount == 0)
        return say(WR_VERDICT_SPARED, why, "the amount of the solid texture's noise is 0");
    return say(WR_VERDICT_RUN, why, "noise distorts the solid texture");
}

WrVerdict wr_decide_faded(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const bool endless = wr_shape_endless(&ask->scene->shape) && !ask->scene->camera.orthographic;
    if (plan->grain == WR_SOLID_TEXTURE_OFF)
        return say(WR_VERDICT_NONE, why, "no solid pattern is computed");
    if (!wants_filter(ask->dials) && !endless)
        return say(WR_VERDICT_NONE, why, "the dials are not set to filtering");
    return say(
        WR_VERDICT_RUN, why,
        endless
            ? "towards the horizon a pixel covers many of its rings"
            : "octaves finer than a pixel are replaced by their mean, and edges are a pixel wide");
}

/* ---- a normal map ---- */

/* Normals straight up everywhere: the map adds slopes of 0.
   Only x and y are compared: slopes are -x/z and -y/z. */
static bool map_even(const WrImage *image)
{
    const size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count; i++)
        if (image->data[3 * i] != 0 || image->data[3 * i + 1] != 0) return false;
    return true;
}

static bool map_still(const WrScene *scene)
{
    double ru, rv;
    wr_scene_repeat(scene, &scene->normals.laid, &ru, &rv);
    return ru == 0 && rv == 0;
}

WrVerdict wr_decide_normals(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    const WrScene *scene = ask->scene;
    const WrNormalMap *map = &scene->normals;
    if (!map->image) return say(WR_VERDICT_NONE, why, "the scene has no normal map");
    if (scene->bump == WR_BUMP_NONE) return say(WR_VERDICT_NONE, why, "bump mode is none");
    if (!lit(plan, ask)) return say(WR_VERDICT_SPARED, why, "no light depends on the normal");
    if (map->strength == 0) return say(WR_VERDICT_SPARED, why, "its strength is 0");
    if (map->object) return say(WR_VERDICT_RUN, why, "its object-space normals replace the others");
    if (map_still(scene)) return say(WR_VERDICT_SPARED, why, "it repeats 0 times: it has no slope");
    if (map_even(map->image)) return say(WR_VERDICT_SPARED, why, "the normal map is flat");
    switch (wr_scene_frame(scene)) {
    case WR_FRAME_MIKK:
        return say(WR_VERDICT_RUN, why, "a light depends on its normals, in frames of MikkTSpace");
    case WR_FRAME_LECTURE:
        return say(WR_VERDICT_RUN, why,
                   "a light depends on its normals, in frames along Pu and Pv");
    default:
        return say(WR_VERDICT_RUN, why,
                   map->combine == WR_COMBINE_SLOPES
                       ? "its slopes are added to the table's, and a light depends on them"
                       : "a light depends on its slopes");
    }
}

WrVerdict wr_decide_reoriented(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (!runs(plan, WR_EFFECT_NORMALS))
        return say(WR_VERDICT_NONE, why, "the normal map is not used");
    if (ask->scene->normals.combine == WR_COMBINE_SLOPES)
        return say(WR_VERDICT_NONE, why, "the table's slopes and the normal map's are added");
    if (!runs(plan, WR_EFFECT_BUMP))
        return say(WR_VERDICT_SPARED, why, "the normal map has no relief on it");
    return say(WR_VERDICT_RUN, why, "the relief's normals are rotated with those of the map");
}

void wr_settle_reoriented(WrPlan *plan, const WrPlanRequest *ask)
{
    plan->combine =
        runs(plan, WR_EFFECT_REORIENTED) ? ask->scene->normals.combine : WR_COMBINE_SLOPES;
}

void wr_settle_normals(WrPlan *plan, const WrPlanRequest *ask)
{
    const bool run = runs(plan, WR_EFFECT_NORMALS);
    plan->map_frame = run ? wr_scene_frame(ask->scene) : WR_FRAME_GRADIENT;
    plan->map_filtered =
        runs(plan, WR_EFFECT_NORMALS) && wants_filter(ask->dials) && !map_still(ask->scene);
    plan->map_anisotropic = plan->map_filtered && ask->dials->footprint == WR_FOOTPRINT_ANISOTROPIC;
}

WrVerdict wr_decide_filter(const WrPlan *plan, const WrPlanRequest *ask, const char **why)
{
    if (!wants_filter(ask->dials))
        return say(WR_VERDICT_NONE, why, "the dials are not set to filtering");
    if (plan->source != WR_SOURCE_TABLE) return say(WR_VERDICT_NONE, why, "the table is not used");
    if (still(ask->scene)) return say(WR_VERDICT_SPARED, why, "replication is 0,0: F is constant");
    return say(WR_VERDICT_RUN, why,
               "footprints above a texel use a pyramid; smaller ones its level 0");
}

void wr_settle_filter(WrPlan *plan, const WrPlanRequest *ask)
{
    plan->anisotropic =
        runs(plan, WR_EFFECT_FILTER) && ask->dials->footprint == WR_FOOTPRINT_ANISOTROPIC;
}
