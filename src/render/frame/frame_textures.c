/* Tables that a renderer keeps up to date: height copies, pyramids, the colour picture. */
#include "base/error.h"
#include "field/scheme_list.h"
#include "base/memory.h"
#include "field/field.h"
#include "image/image.h"
#include "render/frame/frame_internal.h"
#include "render/textures/solid_texture_setup.h"
#include "render/plan/plan_internal.h"
#include "scene/scene.h"
#include "shade/slope.h"
#include "surface/patches.h"
#include "system/clock.h"

#include <math.h>

void wr_frame_drop_tables(WrRenderer *renderer)
{
    wr_table_fini(&renderer->table);
    wr_pyramid_drop(&renderer->pyramid);
    wr_pyramid_drop(&renderer->range);
    wr_quantized_heights_drop(&renderer->rounded);
    wr_color_mips_drop(&renderer->tint);
    for (int k = 0; k < WR_FACET_KINDS; k++) wr_color_mips_drop(&renderer->facets[k]);
    wr_normal_mips_drop(&renderer->relief);
    wr_env_lookup_drop(&renderer->mirror);
    wr_env_prefilter_drop(&renderer->grades);
    wr_frame_drop_horizon(renderer);
    wr_occlusion_map_table_drop(&renderer->opening);
    wr_frames_drop(&renderer->frames);
}

/* Updates the height copies that the plan needs and frees the others.
   `hold` keeps copies that this plan does not read: several plans alternate then (passes of a tolerance,
   bench). */
static bool update_copies(WrRenderer *renderer, const WrFrameRequest *request, bool slope_free,
                          WrError *err)
{
    const bool hold = request->hold;
    WrTable *table = &renderer->table;
    const WrPlan *plan = &renderer->plan;
    const WrField *field = renderer->looked;
    const bool gradient = wr_plan_runs(plan, WR_EFFECT_GRADIENT);
    const bool looked = plan->source == WR_SOURCE_TABLE;
    const bool fitted = looked && wr_schemes[plan->scheme].taps == WR_TAPS_FITTED;
    const bool read = wr_plan_runs(plan, WR_EFFECT_EXACT) ||
                      wr_plan_runs(plan, WR_EFFECT_PARALLAX) || wr_plan_is_weighted(request->scene);
    const bool heights = looked && !fitted && (!gradient || read);
    if (!gradient && !slope_free && !hold) wr_table_drop(table, WR_COPY_GRADIENT);
    if (!fitted && !hold) wr_table_drop(table, WR_COPY_FITTED);
    if (!heights && !hold) wr_table_drop(table, WR_COPY_HEIGHTS);
    if (fitted && !wr_table_update(table, WR_COPY_FITTED, field, renderer->pool, err)) return false;
    return !heights || wr_table_update(table, WR_COPY_HEIGHTS, field, renderer->pool, err);
}

/* Slopes for filtering, with second moments if they widen highlights; ranges of slopes bound the intensity's
   change (E16). */
static bool update_pyramids(WrRenderer *renderer, bool hold, WrError *err)
{
    const WrPlan *plan = &renderer->plan;
    const bool filter = wr_plan_runs(plan, WR_EFFECT_FILTER);
    const bool range = wr_plan_runs(plan, WR_EFFECT_BOUND) && wr_plan_runs(plan, WR_EFFECT_BUMP);
    const WrPyramidKind kind =
        wr_plan_runs(plan, WR_EFFECT_SPREAD) ? WR_PYRAMID_MOMENTS : WR_PYRAMID_SLOPES;
    if (!filter && !hold) wr_pyramid_drop(&renderer->pyramid);
    if (!range) wr_pyramid_drop(&renderer->range);
    if (filter &&
        !wr_pyramid_update(&renderer->pyramid, kind, renderer->looked, renderer->pool, err))
        return false;
    return !range || wr_pyramid_update(&renderer->range, WR_PYRAMID_RANGE, renderer->looked,
                                       renderer->pool, err);
}

/* 8 and 16 bits are steps between the least and the largest height, so the range must be known first. `looked`
   is the field that every later copy is made from. */
static bool round_heights(WrRenderer *renderer, const WrFrameRequest *request, WrError *err)
{
    const WrPlan *plan = &renderer->plan;
    float low = 0, high = 0;
    if (plan->heights == WR_HEIGHTS_16 || plan->heights == WR_HEIGHTS_8)
        wr_table_range(&renderer->table, &low, &high);
    renderer->looked = wr_quantized_heights_update(&renderer->rounded, request->field,
                                                   plan->heights, low, high, err);
    renderer->table.precision = plan->precision;
    return renderer->looked != NULL;
}

/* Share of the table's tiles with non-zero slopes.
   Decides whether runs over flat parts are worth testing for. */
static double sloped_share(const WrRenderer *renderer, const WrField *field)
{
    const WrTable *table = &renderer->table;
    const bool gradient = wr_plan_runs(&renderer->plan, WR_EFFECT_GRADIENT);
    const int tiles = wr_field_tiles_u(field) * wr_field_tiles_v(field);
    int sloped = 0;
    if (gradient) return (double)table->sloped / tiles;
    for (int i = 0; i < tiles; i++) sloped += table->low[i] != table->high[i];
    return (double)sloped / tiles;
}

/* The plan is built up to twice: the first one decides whether a gradient table is needed, whose slopes may
   prove that bump has no effect; the second one uses that fact. */
bool wr_frame_prepare_table(WrRenderer *renderer, const WrFrameRequest *request, WrPlanRequest *ask,
                            WrError *err)
{
    const WrField *field = request->field;
    WrTable *table = &renderer->table;
    WrPlan *plan = &renderer->plan;
    WrPlanFacts *facts = &ask->facts;
    facts->flat = wr_table_flat(table, field);
    if (!table->ranged) return wr_fail(err, "cancelled");
    facts->ends =
        wr_field_wrap_u(field) != WR_WRAP_PERIODIC || wr_field_wrap_v(field) != WR_WRAP_PERIODIC;
    facts->zero = facts->flat && wr_field_get(field, 0, 0) == 0.0f;
    wr_plan_build(plan, ask);
    if (!round_heights(renderer, request, err)) return false;
    if (wr_plan_runs(plan, WR_EFFECT_GRADIENT)) {
        if (!wr_table_update(table, WR_COPY_GRADIENT, renderer->looked, renderer->pool, err))
            return false;
        facts->slope_free = wr_table_slope_free(table);
        wr_plan_build(plan, ask);
    }
    if (!update_copies(renderer, request, facts->slope_free, err)) return false;
    const double started = wr_clock_seconds();
    if (!update_pyramids(renderer, request->hold, err)) return false;
    renderer->pyramid_seconds = wr_clock_seconds() - started;
    const bool looked = plan->source == WR_SOURCE_TABLE && plan->precision == WR_PRECISION_SINGLE;
    facts->sloped = looked ? sloped_share(renderer, field) : -1;
    if (wr_plan_runs(plan, WR_EFFECT_PARALLAX) && plan->source == WR_SOURCE_TABLE)
        wr_height_bounds_update(&renderer->bounds, table, plan->scheme, renderer->looked);
    return true;
}

/* Tangent frames belong to the corners of triangles: only meshes have them. */
static bool update_relief(WrRenderer *renderer, const WrFrameRequest *request, WrError *err)
{
    const WrField *field = request->field;
    const WrPlan *plan = &renderer->plan;
    const bool framed = plan->map_frame == WR_FRAME_MIKK || plan->map_frame == WR_FRAME_LECTURE;
    if (!framed || plan->inversion != WR_INVERT_TRIANGLES) wr_frames_drop(&renderer->frames);
    else if (!wr_frames_update(&renderer->frames,
                               renderer->dice.base ? renderer->dice.base
                                                   : wr_frame_triangles(renderer, request->scene),
                               plan->map_frame, err))
        return false;
    if (wr_plan_runs(plan, WR_EFFECT_NORMALS))
        return wr_normal_mips_update(&renderer->relief, request->scene->normals.image,
                                     plan->map_frame == WR_FRAME_OBJECT, wr_field_wrap_u(field),
                                     wr_field_wrap_v(field), renderer->pool, err);
    wr_normal_mips_drop(&renderer->relief);
    return true;
}

/* One blurred copy suffices where the width is constant (`mirror`), several where it varies (`grades`); an
   even environment needs neither. */
static bool update_mirror(WrRenderer *renderer, const WrFrameRequest *request, WrError *err)
{
    const WrPlan *plan = &renderer->plan;
    const WrEnvironmentMap *light = request->scene->environment.light;
    const bool blurred = wr_plan_runs(plan, WR_EFFECT_BLUR);
    WrEnvironmentBrdf gloss;
    if (!plan->graded && !request->hold) wr_env_prefilter_drop_rungs(&renderer->grades);
    if (plan->graded || wr_plan_runs(plan, WR_EFFECT_VARIED)) {
        if (!wr_env_prefilter_update(&renderer->grades, request->scene, plan, renderer->pool, err))
            return false;
    }
    if (plan->graded || !wr_plan_runs(plan, WR_EFFECT_MIRROR) || (light->even && !blurred)) {
        wr_env_lookup_drop(&renderer->mirror);
        return true;
    }
    wr_scene_gloss(&request->scene->material, &gloss);
    return wr_env_lookup_update(&renderer->mirror, light, blurred ? &gloss : NULL, plan->gloss,
                                renderer->pool, err);
}

/* True if light reads roughness or metalness from a picture of that kind.
   A picture without a reader would cost memory and fetches. */
static bool wants_facets(const WrPlan *plan, const WrScene *scene, int kind)
{
    return wr_plan_runs(plan, WR_EFFECT_FACETS) && scene->facets[kind].image &&
           (kind == WR_FACET_ROUGHNESS ? wr_reflects[scene->material.model].roughness
                                       : wr_reflects[scene->material.model].metalness);
}

static bool update_facets(WrRenderer *renderer, const WrFrameRequest *request, WrError *err)
{
    const WrField *field = request->field;
    const WrPlan *plan = &renderer->plan;
    for (int k = 0; k < WR_FACET_KINDS; k++) {
        WrColorMips *tint = &renderer->facets[k];
        if (!wants_facets(plan, request->scene, k)) {
            wr_color_mips_drop(tint);
            continue;
        }
        if (!wr_color_mips_update(tint, request->scene->facets[k].image, wr_field_wrap_u(field),
                                  wr_field_wrap_v(field), err))
            return false;
        if (plan->facets_filtered && !wr_color_mips_update_pyramid(tint, renderer->pool, err))
            return false;
    }
    return true;
}

/* Order: horizons before occlusion, which sums over them. All wrap as the table does, because they are laid
   over the same (u, v). */
bool wr_frame_prepare_maps(WrRenderer *renderer, const WrFrameRequest *request, WrError *err)
{
    const WrPlan *plan = &renderer->plan;
    const WrField *field = request->field;
    WrColorMips *tint = &renderer->tint;
    if (!update_relief(renderer, request, err)) return false;
    if (!update_mirror(renderer, request, err)) return false;
    if (!wr_frame_update_horizon(renderer, request, err)) return false;
    if (!wr_frame_update_occlusion(renderer, request, err)) return false;
    if (!update_facets(renderer, request, err)) return false;
    if (!wr_plan_runs(plan, WR_EFFECT_COLOUR)) {
        wr_color_mips_drop(tint);
        return true;
    }
    if (!wr_color_mips_update(tint, request->scene->colour, wr_field_wrap_u(field),
                              wr_field_wrap_v(field), err))
        return false;
    if (wr_plan_runs(plan, WR_EFFECT_TINT))
        return wr_color_mips_update_pyramid(tint, renderer->pool, err);
    if (!request->hold) wr_pyramid_drop(&tint->pyramid);
    return true;
}

/* Cells of the table side by side, one for each face or patch; 1, 1 if the surface has one cell. */
static void cells_of(const WrScene *scene, int *columns, int *rows)
{
    const WrPatches *set = scene->triangles ? scene->triangles->patches : NULL;
    wr_surface_cells(&scene->shape, columns, rows);
    if (set && set->table == WR_PATCH_OWN) *columns = set->columns, *rows = set->rows;
}

/* Largest footprint: filters may not read beyond the margin of a cell. A fetch of side s reads 3 s, the blocks
   on both sides of its position in the next coarser level, and one more texel for slopes.
   Faces of a cube share a table: a filter that reads past a cell's margin would blend in the neighbouring
   face. */
static double reach_of(const WrScene *scene, double width, double height)
{
    int columns, rows;
    cells_of(scene, &columns, &rows);
    if (columns * rows == 1) return 0;
    const double margin = WR_CELL_MARGIN * fmin(fabs(width) / columns, fabs(height) / rows);
    return fmax((margin - 1) / 3, 0.01);
}

/* Lengths in kernel units: `scale` turns the height into them. `reach` limits the footprint, in texels. */
static WrLookd make_look(const WrRenderer *renderer, const WrFrameRequest *request, double scale)
{
    const WrScene *scene = request->scene;
    const WrPlan *plan = &renderer->plan;
    const WrSlopeScale by =
        wr_slope_scale(plan->bump, scene->height, scene->replicate_u, scene->replicate_v, scale);
    return (WrLookd){ .width = wr_field_width(request->field),
                      .height = wr_field_height(request->field),
                      .ru = scene->replicate_u,
                      .rv = scene->replicate_v,
                      .periodic_u = wr_field_wrap_u(request->field) == WR_WRAP_PERIODIC,
                      .periodic_v = wr_field_wrap_v(request->field) == WR_WRAP_PERIODIC,
                      .wide = wr_plan_runs(plan, WR_EFFECT_WIDE),
                      .scale_f = by.f,
                      .scale_u = by.u,
                      .scale_v = by.v,
                      .reach = reach_of(scene, wr_field_width(request->field) * scene->replicate_u,
                                        wr_field_height(request->field) * scene->replicate_v),
                      .pyramid = wr_plan_runs(plan, WR_EFFECT_FILTER) ? &renderer->pyramid : NULL,
                      .range = renderer->range.seen ? &renderer->range : NULL };
}

/* Effects of a fetch at level 0, by its inputs.
   The effects are reported per pixel in the effect map. */
static WrEffects looks_of(const WrFrameRequest *request, const WrRenderer *renderer,
                          const WrLookd *look)
{
    const bool slopes =
        renderer->plan.scheme == WR_SCHEME_CENTRAL || renderer->plan.scheme == WR_SCHEME_NEAREST;
    const bool in_double = renderer->table.precision != WR_PRECISION_SINGLE;
    return (slopes ? WR_EFFECT_BIT(WR_EFFECT_GRADIENT) : 0) |
           (look->wide ? WR_EFFECT_BIT(WR_EFFECT_WIDE) : 0) |
           (in_double ? WR_EFFECT_BIT(WR_EFFECT_DOUBLE) : 0) |
           (renderer->looked != request->field ? WR_EFFECT_BIT(WR_EFFECT_ROUNDED) : 0);
}

/* True if the plan considered this effect and left it out.
   WR_RUN rows run everywhere and WR_NONE rows nowhere; only a spared one is tested per run of samples. */
static bool spares(const WrPlan *plan, WrEffect effect)
{
    return plan->rows[effect].verdict == WR_VERDICT_SPARED && !wr_plan_runs(plan, effect);
}

/* Tiles' slope bounds for skipping: parts without slopes (ground), and sides that no bump can turn to the
   light (dark). */
static void fill_level(const WrRenderer *renderer, const WrFrameRequest *request, WrTileJob *job)
{
    const WrPlan *plan = &renderer->plan;
    job->ground = spares(plan, WR_EFFECT_GROUND);
    job->dark = spares(plan, WR_EFFECT_DARK);
    if (!wr_plan_runs(plan, WR_EFFECT_BUMP) || !(job->ground || job->dark)) return;
    const bool gradient = wr_plan_runs(plan, WR_EFFECT_GRADIENT);
    WrLevel *level = &job->level;
    *level = (WrLevel){ .steep = gradient ? (const float(*)[2])renderer->table.steep : NULL,
                        .low = renderer->table.low,
                        .high = renderer->table.high,
                        .steepest = { INFINITY, INFINITY },
                        .tiles_u = wr_field_tiles_u(request->field),
                        .tiles_v = wr_field_tiles_v(request->field),
                        .width = job->look.width,
                        .height = job->look.height,
                        .ru = job->look.ru,
                        .rv = job->look.rv,
                        .periodic_u = job->look.periodic_u,
                        .periodic_v = job->look.periodic_v };
    for (int c = 0; gradient && c < 2; c++) {
        level->steepest[c] = renderer->table.steepest[c];
        level->gentlest[c] = renderer->table.gentlest[c];
    }
}

/* Single-precision fetch parameters, with the copies that they read.
   One description in double is the source of both, so that they cannot differ in anything but precision. */
static WrLook narrowed(const WrLookd *look, const float *heights, const float *gradient)
{
    return (WrLook){ .heights = heights,
                     .gradient = gradient,
                     .pitch = look->pitch,
                     .width = look->width,
                     .height = look->height,
                     .ru = look->ru,
                     .rv = look->rv,
                     .periodic_u = look->periodic_u,
                     .periodic_v = look->periodic_v,
                     .wide = look->wide,
                     .scale_f = (float)look->scale_f,
                     .scale_u = (float)look->scale_u,
                     .scale_v = (float)look->scale_v,
                     .reach = (float)look->reach,
                     .pyramid = look->pyramid,
                     .range = look->range };
}

/* Fills a picture mapped over (u,v), and the frame in which footprints are measured. */
static void fill_picture(const WrFrameRequest *request, const WrColorMips *tint,
                         const WrTextureSample *laid, bool filtered, WrPictureLook *to)
{
    double ru, rv;
    wr_scene_repeat(request->scene, laid, &ru, &rv);
    const WrColourLook look = { .rgba = tint->rgba,
                                .pitch = tint->pitch,
                                .width = tint->source->width,
                                .height = tint->source->height,
                                .ru = ru,
                                .rv = rv,
                                .periodic_u = tint->wrap_u == WR_WRAP_PERIODIC,
                                .periodic_v = tint->wrap_v == WR_WRAP_PERIODIC };
    const double reach = reach_of(request->scene, look.width * ru, look.height * rv);
    to->near = look;
    to->far_double = (WrLookd){ .width = look.width,
                                .height = look.height,
                                .ru = ru,
                                .rv = rv,
                                .periodic_u = look.periodic_u,
                                .periodic_v = look.periodic_v,
                                .reach = reach,
                                .pyramid = filtered ? &tint->pyramid : NULL };
    to->far = narrowed(&to->far_double, NULL, NULL);
}

/* Only kinds that light reads are filled; the others keep rgba NULL. */
static void fill_facets(const WrRenderer *renderer, const WrFrameRequest *request, WrTileJob *job)
{
    for (int k = 0; k < WR_FACET_KINDS; k++)
        if (wants_facets(&renderer->plan, request->scene, k))
            fill_picture(request, &renderer->facets[k], &request->scene->facets[k].laid,
                         renderer->plan.facets_filtered, &job->facets[k]);
}

/* Slopes of heights are derivatives by the patch's parameters. In a tangent frame they are the map's own, with
   reversed sign where the map is mirrored. */
static WrSlopeScale map_scale(const WrRenderer *renderer, const WrScene *scene, double ru,
                              double rv, double scale)
{
    const double strength = scene->normals.strength;
    if (renderer->plan.map_frame == WR_FRAME_GRADIENT)
        return wr_slope_scale(renderer->plan.bump, strength, ru, rv, scale);
    return (WrSlopeScale){ 0, ru != 0 ? copysign(strength, strength * ru) : 0,
                           rv != 0 ? copysign(strength, strength * rv) : 0 };
}

/* The normal map: slopes over the unit cell, independent of the table's height. */
static void fill_map(const WrRenderer *renderer, const WrFrameRequest *request, double scale,
                     WrTileJob *job)
{
    const WrScene *scene = request->scene;
    const WrNormalMips *relief = &renderer->relief;
    double ru, rv;
    wr_scene_repeat(scene, &scene->normals.laid, &ru, &rv);
    const WrSlopeScale by = map_scale(renderer, scene, ru, rv, scale);
    const WrLookd look = { .width = relief->source->width,
                           .height = relief->source->height,
                           .ru = ru,
                           .rv = rv,
                           .periodic_u = relief->wrap_u == WR_WRAP_PERIODIC,
                           .periodic_v = relief->wrap_v == WR_WRAP_PERIODIC,
                           .wide = fmax(fabs(ru), fabs(rv)) >= WR_WIDE_FROM,
                           .scale_u = by.u,
                           .scale_v = by.v,
                           .reach = reach_of(scene, relief->source->width * ru,
                                             relief->source->height * rv),
                           .pyramid = &relief->pyramid };
    job->relief_double = look;
    job->frames = &renderer->frames;
    job->relief = narrowed(&look, NULL, NULL);
}

/* The solid texture is a function of P: its scale is that of the kernel's P. */
static void fill_grain(const WrPlan *plan, const WrSolidTexture *grain, double scale,
                       WrTileJob *job)
{
    wr_solid_texture_kern_fill(grain, plan->grain, wr_plan_runs(plan, WR_EFFECT_OCTAVES),
                               wr_plan_runs(plan, WR_EFFECT_FADED), scale, &job->grain_double);
    wr_solid_texture_kern_narrow(&job->grain_double, &job->grain);
}

/* Published energy needs no table of albedos; kd or ks 0 removes the term from the kernel's sum. */
static void fill_matter(const WrPlan *plan, const WrFrameRequest *request, WrTileJob *job)
{
    WrMaterial m = request->scene->material;
    if (!plan->kept) m.energy = WR_ENERGY_PUBLISHED; /* no albedo is needed */
    wr_scene_matter(&m, &job->matter);
    if (!wr_plan_runs(plan, WR_EFFECT_DIFFUSE)) job->matter.kd = 0;
    if (!wr_plan_runs(plan, WR_EFFECT_SPECULAR)) job->matter.ks = 0;
}

/* Doubles first, then narrowed copies: `look` and `look_double` describe the same copy of the table, whose
   pitch and apron are equal in both precisions. */
void wr_frame_fill_looks(const WrRenderer *renderer, const WrFrameRequest *request, double scale,
                         WrTileJob *job)
{
    const WrTableCopy *copies = renderer->table.copies;
    const bool fitted = wr_schemes[renderer->plan.scheme].taps == WR_TAPS_FITTED;
    const WrTableCopy *heights = &copies[fitted ? WR_COPY_FITTED : WR_COPY_HEIGHTS];
    const WrTableCopy *gradient = &copies[WR_COPY_GRADIENT];
    WrLookd look = make_look(renderer, request, scale);
    look.heights = heights->fine;
    look.gradient = gradient->fine;
    look.pitch = heights->seen ? heights->pitch : gradient->pitch;
    job->look_double = look;
    job->look = narrowed(&look, heights->data, gradient->data);
    job->looks = looks_of(request, renderer, &look);
    job->horizon = &renderer->horizon;
    job->opening = &renderer->opening;
    job->relief_height = fabs(request->scene->height) * scale;
    if (wr_plan_runs(&renderer->plan, WR_EFFECT_PARALLAX))
        wr_parallax_fill(&job->parallax, request->scene, request->field, &renderer->bounds,
                         &renderer->plan, scale);
    fill_level(renderer, request, job);
    if (wr_plan_runs(&renderer->plan, WR_EFFECT_GRAIN) ||
        wr_plan_runs(&renderer->plan, WR_EFFECT_EMBOSSED) ||
        wr_plan_runs(&renderer->plan, WR_EFFECT_VARIED))
        fill_grain(&renderer->plan, &request->scene->grain, renderer->view.scale, job);
    if (wr_plan_runs(&renderer->plan, WR_EFFECT_MODEL)) fill_matter(&renderer->plan, request, job);
    if (wr_plan_runs(&renderer->plan, WR_EFFECT_SURROUND) ||
        wr_plan_runs(&renderer->plan, WR_EFFECT_MIRROR))
        wr_environment_map_look(request->scene, &renderer->plan, renderer->view.rotation,
                                &renderer->mirror, &job->surround);
    fill_facets(renderer, request, job);
    if (wr_plan_runs(&renderer->plan, WR_EFFECT_VARIED) || renderer->plan.graded)
        wr_env_prefilter_fill(&renderer->grades, request->scene, job);
    if (wr_plan_runs(&renderer->plan, WR_EFFECT_COLOUR))
        fill_picture(request, &renderer->tint, &request->scene->colour_laid,
                     wr_plan_runs(&renderer->plan, WR_EFFECT_TINT), &job->colour);
    if (renderer->plan.grain != WR_SOLID_TEXTURE_OFF)
        wr_solid_texture_texels(request->scene, job->grain_texels);
    job->grain_roughens = request->scene->grain.drives & WR_SOLID_TEXTURE_ROUGHENS &&
                          request->scene->grain.kind != WR_SOLID_TEXTURE_OFF;
    if (wr_plan_runs(&renderer->plan, WR_EFFECT_NORMALS)) fill_map(renderer, request, scale, job);
}
