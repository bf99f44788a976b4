/* Geometry that a frame's surface is rasterised from: a grid cut for the view, or a mesh file. */
#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "field/field.h"
#include "field/scheme.h"
#include "render/frame/frame_internal.h"
#include "render/pipeline/pipeline.h"
#include "render/simd/simd_kernels.h"
#include "render/tessellation/dice.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "surface/patches.h"

#include <math.h>
#include <stdio.h>

/* ---- mesh files ---- */

/* Frees all view meshes except one, which may be NULL. */
void wr_frame_drop_meshes(WrRenderer *renderer, const WrViewMesh *but)
{
    for (int i = 0; i < WR_HELD_MESHES; i++)
        if (&renderer->meshes[i] != but) wr_view_mesh_fini(&renderer->meshes[i]);
}

/* Number of sixteenths of a solid texture's rings, or of its finest cells, around the object.
   Newton's method must find (u, v) to a part of a texel; a solid texture has no texels, so 1/16 of its finest
   period counts as one. */
static double grains(const WrRenderer *renderer, const WrScene *scene)
{
    const WrSolidTexture *grain = &scene->grain;
    if (renderer->plan.grain == WR_SOLID_TEXTURE_OFF) return 0;
    const WrSolidTextureInfo *info = &wr_grains[grain->kind];
    const double rings = info->ringed ? grain->rings : 0;
    const double cells = info->noisy ? ldexp(grain->cells, (int)grain->octaves - 1) : 0;
    return 16 * 2 * WR_PI * fmax(rings, cells) / renderer->view.scale;
}

/* The passes of one progressive picture differ in their samples a side and keep what they build: one mesh is
   held for each number. */
static void prepare_mesh(WrRenderer *renderer, const WrFrameRequest *request,
                         const WrKernels *kernels)
{
    const WrScene *scene = request->scene;
    const WrPlan *plan = &renderer->plan;
    const WrMeshRequest ask = {
        .mesh = plan->mesh,
        .newton = plan->newton,
        .texels = plan->texels,
        .table_w = fmax(grains(renderer, scene),
                        fabs(scene->replicate_u) * wr_field_width(request->field)),
        .table_h = fmax(grains(renderer, scene),
                        fabs(scene->replicate_v) * wr_field_height(request->field))
    };
    int slot = 0;
    while (slot + 1 < WR_HELD_MESHES && 1 << slot < plan->samples) slot++;
    const bool grid = plan->inversion == WR_INVERT_MESH && wr_plan_runs(plan, WR_EFFECT_DEPTH);
    renderer->mesh = grid ? &renderer->meshes[slot] : NULL;
    if (!request->hold || !renderer->mesh) wr_frame_drop_meshes(renderer, renderer->mesh);
    if (renderer->mesh)
        wr_view_mesh_prepare(renderer->mesh, &scene->shape, &renderer->view, &ask, kernels,
                             renderer->pool);
}

const WrTriangles *wr_frame_triangles(WrRenderer *renderer, const WrScene *scene)
{
    if (renderer->dice.triangles) return renderer->dice.triangles;
    if (scene->triangles) return scene->triangles;
    if (!renderer->square) renderer->square = wr_triangles_square();
    return renderer->square;
}

/* Chooses the facets to keep: those of moving views are few, and remain while it rests; the others are freed while
   it moves. */
static void choose_dice(WrRenderer *renderer, bool moving)
{
    const WrDice before = renderer->dice;
    if (renderer->dice_moving != moving) {
        renderer->dice = renderer->dice_aside;
        renderer->dice_aside = before;
        renderer->dice_moving = moving;
    }
    if (moving) wr_dice_fini(&renderer->dice_aside);
}

/* Prepares a displaced surface. Whatever lies nearer than the base's bounding sphere is known to the comparison
   of several objects.
   `rise` is in object units, `nearest` in world units. */
static bool prepare_dice(WrRenderer *renderer, const WrFrameRequest *request, WrError *err)
{
    const WrPlan *plan = &renderer->plan;
    WrView *view = &renderer->view;
    const WrDiceRequest ask = { .scene = request->scene,
                                .field = renderer->looked,
                                .view = view,
                                .epsilon = plan->dice,
                                .moving = request->moving,
                                .pool = renderer->pool,
                                .cancel = request->cancel };
    if (!wr_plan_runs(plan, WR_EFFECT_DISPLACED)) {
        wr_dice_fini(&renderer->dice);
        wr_dice_fini(&renderer->dice_aside);
        return true;
    }
    choose_dice(renderer, request->moving);
    if (!wr_dice_update(&renderer->dice, &ask, err)) return false;
    view->nearest -= renderer->dice.rise * request->scene->size;
    if (request->moving)
        snprintf(renderer->plan.rows[WR_EFFECT_DISPLACED].reason,
                 sizeof renderer->plan.rows[WR_EFFECT_DISPLACED].reason,
                 "the view moves: facets are few, and kept for all directions");
    else if (renderer->dice.epsilon > plan->dice)
        snprintf(renderer->plan.rows[WR_EFFECT_DISPLACED].reason,
                 sizeof renderer->plan.rows[WR_EFFECT_DISPLACED].reason,
                 "facets are as many as there may be: they are within %.3g pixels, not %.3g",
                 renderer->dice.epsilon, plan->dice);
    return true;
}

/* Prepares parallax: the height of the relief above and below its base. */
static void prepare_parallax(WrRenderer *renderer, const WrScene *scene)
{
    double range[2];
    WrView *view = &renderer->view;
    if (!wr_plan_runs(&renderer->plan, WR_EFFECT_PARALLAX)) return;
    wr_parallax_range(scene, &renderer->bounds, &renderer->plan, scene->height, range);
    view->nearest -= fmax(fabs(range[0]), fabs(range[1])) * scene->size;
    if (wr_surfaces[scene->shape.kind]->inversion == WR_INVERT_PLANE)
        wr_view_widen(view, range[0] * view->scale, range[1] * view->scale);
    if (wr_parallax_has_shell(&scene->shape)) wr_view_grow(view, range[1] * view->scale);
}

static bool prepare_triangles(WrRenderer *renderer, const WrScene *scene, WrError *err)
{
    if (renderer->plan.inversion == WR_INVERT_TRIANGLES)
        return wr_view_triangles_prepare(
            &renderer->triangles, wr_frame_triangles(renderer, scene), &renderer->view,
            !wr_plan_runs(&renderer->plan, WR_EFFECT_BLOCKS), renderer->pool, err);
    wr_view_triangles_fini(&renderer->triangles);
    return true;
}

/* Pointers into the mesh's arrays, read with fixed strides: eight floats for each corner, three indices for
   each triangle. */
WrTriangleLook wr_frame_look_up(const WrViewTriangles *triangles, double scale)
{
    const WrTriangles *source = triangles->source;
    const WrPatches *patches = source->patches;
    WrTriangleLook look = { .corners = &source->corners[0].p[0],
                            .triangles = &source->triangles[0].corner[0],
                            .scale = scale };
    if (!patches) return look;
    look.patches = &patches->patch[0].point[0];
    look.patch_of = patches->of;
    look.scale_u = patches->scale_u, look.scale_v = patches->scale_v;
    return look;
}

bool wr_frame_prepare_meshes(WrRenderer *renderer, const WrFrameRequest *request,
                             const WrKernels *kernels, WrError *err)
{
    prepare_mesh(renderer, request, kernels);
    prepare_parallax(renderer, request->scene);
    return prepare_dice(renderer, request, err) && prepare_triangles(renderer, request->scene, err);
}

bool wr_renderer_pick_triangle(WrRenderer *renderer, double x, double y, int32_t *triangle)
{
    double u, v;
    int face;
    if (renderer->plan.inversion != WR_INVERT_TRIANGLES ||
        !wr_renderer_pick(renderer, x, y, &u, &v, &face))
        return false;
    *triangle = renderer->scratch[0]->picked;
    if (renderer->dice.base_of) *triangle = renderer->dice.base_of[*triangle];
    return true;
}

/* ---- all surfaces ---- */

/* Reuse of a static view's uv cache (uv_cache.h) and relight cache (relight_cache.h): when they are read and
   when they are filled.
   The uv cache holds (u, v) of each sample: an edit of the table keeps it. The relight cache holds positions
   and normals: a change of lights keeps it. */

#define SIGHT_MAX (1 << 24) /* pixels; 8 bytes each */
#define PLACES (1 << 16)    /* samples along a side: in 256ths they are exact in single precision */

/* True if an edit can change samples that did not fetch it: parallax may hit the relief anywhere, and among
   several objects the displaced surface moves. */
static bool reaches_far(const WrScene *scene)
{
    bool any = scene->parallax || (scene->other_count > 0 && scene->displaced);
    for (int i = 0; i < scene->other_count; i++)
        any |= scene->others[i]->parallax || scene->others[i]->displaced;
    return any;
}

static bool is_whole(const WrFrameRequest *request)
{
    return request->keep && !request->only && !request->rows;
}

bool wr_frame_may_keep(const WrFrameRequest *request)
{
    return is_whole(request) && !reaches_far(request->scene);
}

/* Patches within a tile are the unit of re-rendering; `whole` makes the tile itself the unit. */
void wr_frame_start_notes(const WrTileJob *canvas, WrDirty *keep)
{
    const WrPlan *plan = canvas->plan;
    const int k = canvas->samples, w = canvas->width * k, h = canvas->height * k;
    const bool jittered = k > 1 && plan->spread == WR_SPREAD_JITTERED;
    /* Refined pixels depend on their neighbours, and jittered positions have to identify their sample. */
    const bool whole =
        plan->sampling == WR_SAMPLING_ADAPTIVE || (jittered && (w > PLACES || h > PLACES));
    wr_dirty_start(keep, wr_frame_tiles(canvas), canvas->tile_w, canvas->tile_h, whole);
}

bool wr_frame_same_output(const WrFrameCodes *a, const WrFrameCodes *b)
{
    return a->wanted == b->wanted &&
           (!a->wanted || (wr_background_equal(&a->background, &b->background) &&
                           wr_tone_equal(&a->tone, &b->tone)));
}

/* With forced effects nothing is recorded: the picture differs from the planned one. */
static bool is_forced(const WrFrameRequest *request)
{
    const WrForce *force = request->force;
    return request->full || (force && (force[WR_EFFECT_DEPTH] || force[WR_EFFECT_NEWTON] ||
                                       force[WR_EFFECT_BESIDE] || force[WR_EFFECT_HIDDEN]));
}

/* Reads the uv cache of a static view, or starts to fill it. One sample a pixel, single precision.
   Filled by the first frame of a view, read by the following ones; `beside` is the hash of all objects'
   places. */
static bool update_uv_cache(WrRenderer *renderer, const WrFrameRequest *request, WrHash beside,
                            bool anew)
{
    const WrPlan *plan = &renderer->plan;
    const int64_t objects = renderer->among ? renderer->among : 1;
    WrUvCacheKey key;
    /* If only light changed, the next edit can still use it. */
    if (!renderer->mesh && renderer->relight->use != WR_RELIGHT_KNOWN)
        wr_uv_cache_fini(&renderer->uv_cache);
    const bool small = objects * request->width * request->height <= SIGHT_MAX;
    renderer->uses_uv_cache = small && wr_frame_may_keep(request) && renderer->mesh &&
                              plan->newton != 0 && plan->sampling == WR_SAMPLING_ONE &&
                              !plan->shading_double && !is_forced(request);
    if (!renderer->uses_uv_cache || renderer->relight->use == WR_RELIGHT_KNOWN) {
        renderer->uses_uv_cache = false;
        return false;
    }
    const WrTileJob job = { .plan = plan, .scene = renderer->scene };
    wr_uv_cache_key(&key, renderer->mesh, &renderer->view, wr_tile_exact(&job), renderer->kernels);
    key.beside = beside;
    if (wr_uv_cache_update(&renderer->uv_cache, &key)) return true;
    renderer->uses_uv_cache = renderer->uv_cache.u != NULL && anew;
    return false;
}

void wr_frame_update_visibility(WrRenderer *renderer, const WrFrameRequest *request, WrHash beside,
                                bool anew)
{
    WrPlanRequest *ask = &renderer->ask;
    ask->facts.uv_cached = renderer->uv_cached = update_uv_cache(renderer, request, beside, anew);
    wr_plan_again(&renderer->plan, ask);
}

static bool is_any_forced(const WrForce *force)
{
    bool any = false;
    for (int e = 0; force && e < WR_EFFECT_COUNT; e++) any |= force[e] != WR_FORCE_NONE;
    return any;
}

/* True if no effect is forced and the request is only for the picture. */
static bool may_be_steady(const WrFrameRequest *request)
{
    return is_whole(request) && !request->normals && !request->map &&
           !is_any_forced(request->force) && !request->full;
}

/* Writes the cache's status for the plan's row. hinders: reason why nothing is stored, or NULL. */
static void report_relight(WrRelight *relight, const WrRelightView *view, const char *hinders)
{
    char bytes[40];
    const double size = (double)wr_relight_bytes(view);
    snprintf(bytes, sizeof bytes, "%.3g MB, %.3g bytes a sample", size * 1e-6,
             size / ((double)view->width * view->height));
    if (hinders)
        snprintf(relight->status, sizeof relight->status, "new, and not kept: %s", hinders);
    else if (relight->use == WR_RELIGHT_KNOWN)
        snprintf(relight->status, sizeof relight->status,
                 "the view rests, and only its light changed: they are known (%s)", bytes);
    else
        snprintf(relight->status, sizeof relight->status,
                 "new; while a view rests they are kept (%s)", bytes);
}

/* True if the light of every part depends on n'. */
static bool has_normals(const WrRelightView *view)
{
    bool all = true;
    for (int i = 0; i < view->count; i++) all &= view->parts[i].plan->normals;
    return all;
}

/* True for a sphere with several samples a pixel: computing it is faster than reading it from memory. */
static bool is_soon_anew(const WrRelightView *view)
{
    const WrRelightPart *only = view->parts;
    return view->count == 1 && only->plan->samples > 1 && only->scene->light_count == 1 &&
           wr_wide_of(view->kernels) && wr_pipe_at_once(only->plan);
}

/* Reason why such a view is not stored, or NULL. */
static const char *hinders_of(const WrRelightView *view)
{
    const char *why = NULL;
    for (int i = 0; i < view->count && !why; i++)
        why = wr_relight_hinders(view->parts[i].scene, view->parts[i].plan);
    if (!why && is_soon_anew(view)) why = "they are made anew as soon as they are read";
    if (!why && wr_relight_bytes(view) > WR_RELIGHT_MAX)
        why = "they would take more than " WR_RELIGHT_MAX_TEXT;
    return why;
}

/* The first frame of a view only records the view, the second fills the cache, and from the third on lights
   are computed from it. So a moving camera never pays for storing samples. */
void wr_frame_choose_relight_cache(WrRenderer *renderer, const WrFrameRequest *request,
                                   const WrRelightPart *parts, WrRenderer *const *owners, int count)
{
    WrRelight *relight = renderer->relight;
    const int k = count > 0 ? parts[0].plan->samples : 1;
    const WrRelightView view = { .parts = parts,
                                 .count = count,
                                 .kernels = renderer->kernels,
                                 .turn_deg = request->turn_deg,
                                 .width = k * request->width,
                                 .height = k * request->height };
    const char *hinders = count > 0 ? hinders_of(&view) : NULL;
    bool anew = false;
    for (int i = 0; i < count; i++) anew |= wr_plan_runs(parts[i].plan, WR_EFFECT_AGAIN);
    const bool may = may_be_steady(request) && count > 0 && !hinders && anew && has_normals(&view);
    relight->use = may ? wr_relight_update(relight, &view) : WR_RELIGHT_NONE;
    if (count > 0) report_relight(relight, &view, hinders);
    for (int i = 0; i < count; i++) {
        WrPlanRequest *ask = &owners[i]->ask;
        ask->facts.relight = relight->use == WR_RELIGHT_KNOWN;
        ask->facts.relight_status = relight->status;
        ask->facts.normals |= relight->use == WR_RELIGHT_NOTE; /* on the dark side as well */
        wr_plan_again(&owners[i]->plan, ask);
    }
}

void wr_frame_fill_uv_cache(WrRenderer *renderer, WrTileJob *job)
{
    const WrRelight *relight = renderer->relight;
    job->uv_cache = renderer->uses_uv_cache ? &renderer->uv_cache : NULL;
    job->seen_before = renderer->uv_cached;
    if (relight->use == WR_RELIGHT_NONE) return;
    if (relight->use == WR_RELIGHT_KNOWN) job->relight = relight;
    else job->noting = relight;
    job->lamps = relight->lamps;
    job->recalls = wr_relight_groups(job->scene, job->plan);
}
