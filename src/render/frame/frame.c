#include "render/frame/frame.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "field/field.h"
#include "render/frame/frame_internal.h"
#include "render/simd/simd_kernels.h"
#include "render/pipeline/pipeline.h"
#include "scene/objects.h"
#include "system/clock.h"

#include <math.h>
#include <string.h>

WrRenderer *wr_renderer_new(WrPool *pool, const char *isa, WrError *err)
{
    if (!wr_kernels_get(isa, false, err)) return NULL;
    WrRenderer *renderer = wr_alloc(1, sizeof *renderer);
    renderer->pool = pool;
    renderer->threads = wr_pool_threads(pool);
    renderer->scratch = wr_alloc((size_t)renderer->threads, sizeof *renderer->scratch);
    wr_code_bins_fill(renderer->bins);
    snprintf(renderer->isa, sizeof renderer->isa, "%s", isa ? isa : "auto");
    wr_table_init(&renderer->table);
    renderer->steady = &renderer->own_steady;
    return renderer;
}

int wr_renderer_threads(const WrRenderer *renderer)
{
    return renderer->threads;
}

const char *wr_renderer_isa(const WrRenderer *renderer)
{
    return renderer->isa;
}

static void forget_view(WrRenderer *renderer)
{
    if (renderer->seen) wr_view_fini(&renderer->view);
    wr_scene_free(renderer->scene);
    renderer->scene = NULL;
    renderer->seen = false;
}

void wr_renderer_forget(WrRenderer *renderer)
{
    forget_view(renderer);
    wr_dirty_fini(&renderer->keep);
    wr_frame_drop_tables(renderer);
    wr_frame_drop_meshes(renderer, NULL);
    wr_view_triangles_fini(&renderer->triangles);
    wr_dice_fini(&renderer->dice);
    wr_triangles_free(renderer->square);
    renderer->square = NULL;
    wr_uv_cache_fini(&renderer->sight);
    wr_sparse_hits_fini(&renderer->knots);
    wr_shadow_rays_body_fini(&renderer->body);
    wr_relight_fini(&renderer->own_steady);
}

void wr_renderer_free(WrRenderer *renderer)
{
    if (!renderer) return;
    wr_renderer_forget(renderer);
    wr_group_free(renderer);
    for (int i = 0; i < renderer->threads; i++) {
        if (renderer->scratch[i]) {
            wr_free(renderer->scratch[i]->wide);
            wr_free(renderer->scratch[i]->nearest);
        }
        wr_free(renderer->scratch[i]);
    }
    wr_free(renderer->scratch);
    wr_free(renderer->rgba);
    wr_free(renderer->codes);
    wr_backdrop_fini(&renderer->backdrop);
    wr_free(renderer);
}

static bool check_size(const WrFrameRequest *request, WrError *err)
{
    const int width = request->width, height = request->height;
    if (width < 1 || height < 1 || width > 16384 || height > 16384)
        return wr_fail(err, "picture size %dx%d: each side must be 1..16384", width, height);
    if (request->first < 0 || request->rows < 0 || request->first > height - request->rows)
        return wr_fail(err, "%d rows from row %d on, of a picture of %d", request->rows,
                       request->first, height);
    return true;
}

static void drop_picture(WrRenderer *renderer)
{
    wr_free(renderer->rgba);
    wr_free(renderer->codes);
    renderer->rgba = NULL;
    renderer->codes = NULL;
    renderer->width = renderer->height = 0;
}

/* Allocates the picture. A band reuses the memory of the band before it. */
static bool bring_memory(WrRenderer *renderer, const WrFrameRequest *request, WrError *err)
{
    const bool banded = request->rows > 0, codes = request->codes.wanted;
    const int width = request->width, height = request->height;
    const int rows = banded ? request->rows : height;
    if (renderer->width != width || renderer->height != height || renderer->banded != banded ||
        renderer->room < rows)
        drop_picture(renderer);
    if (renderer->width == 0) renderer->room = rows;
    const size_t room = (size_t)width * (size_t)renderer->room;
    if (codes && !renderer->codes)
        renderer->codes = wr_try_alloc(room, sizeof *renderer->codes, "picture", err);
    if (!codes && !renderer->rgba)
        renderer->rgba = wr_try_alloc(room, 4 * sizeof(float), "picture", err);
    return codes ? renderer->codes != NULL : renderer->rgba != NULL;
}

bool wr_frame_resize(WrRenderer *renderer, const WrFrameRequest *request, WrError *err)
{
    if (!check_size(request, err)) return false;
    if (!renderer->among && !bring_memory(renderer, request, err)) return false;
    renderer->banded = request->rows > 0;
    renderer->width = request->width;
    renderer->height = request->height;
    renderer->top = renderer->banded ? request->first : 0;
    renderer->rows = renderer->banded ? request->rows : request->height;
    return true;
}

static void want_codes(WrRenderer *renderer, const WrFrameCodes *codes, WrTileJob *job)
{
    job->codes = renderer->codes;
    job->rgba = NULL;
    job->coder.tone = wr_tone_curve(&codes->tone);
    wr_backdrop_update(&renderer->backdrop, codes, renderer->radius, job->width, job->height,
                       job->top, job->rows, &job->coder, renderer->pool);
    job->backdrop = &renderer->backdrop;
}

WrTileJob wr_frame_canvas(WrRenderer *renderer, const WrFrameRequest *request)
{
    const WrPlan *plan = &renderer->plan;
    WrTileJob job = {
        .view = &renderer->view,
        .plan = plan,
        .scene = renderer->scene,
        .pipe = plan->shading_double ? &wr_pipe_double : &wr_pipe,
        .kernels = request ? renderer->kernels : wr_kernels_get(renderer->isa, false, NULL),
        .kernels_double = wr_kernels_double(renderer->isa, NULL),
        .mesh = renderer->mesh,
        .triangles = renderer->triangles.source ? &renderer->triangles : NULL,
        .newton = renderer->mesh && plan->newton != 0,
        .samples = renderer->samples,
        .width = renderer->width,
        .height = renderer->height,
        .top = renderer->top,
        .rows = renderer->rows,
        .rgba = renderer->rgba,
        .rgba_pitch = (size_t)renderer->width,
        .y0 = renderer->top,
        .coder = { wr_kernels_get(renderer->isa, false, NULL), renderer->bins, { .plain = true } }
    };
    if (job.triangles)
        job.triangle_look = wr_frame_look_up(&renderer->triangles, renderer->view.scale);
    job.dice = renderer->dice.triangles ? &renderer->dice : NULL;
    if (request && request->codes.wanted) want_codes(renderer, &request->codes, &job);
    if (request) job.normals = request->normals, job.map = request->map;
    wr_tile_size(job.samples, plan->sampling == WR_SAMPLING_ADAPTIVE, request && request->only,
                 &job.tile_w, &job.tile_h);
    return job;
}

WrTileJob wr_frame_job(WrRenderer *renderer, const WrFrameRequest *request)
{
    WrTileJob job = wr_frame_canvas(renderer, request);
    if (!request) {
        job.look = renderer->look, job.look_double = renderer->look_double;
        job.parallax = renderer->parallax;
        return job;
    }
    wr_frame_fill_looks(renderer, request, renderer->view.scale, &job);
    renderer->look = job.look, renderer->look_double = job.look_double;
    renderer->parallax = job.parallax;
    wr_frame_fill_sight(renderer, &job);
    job.cast = &renderer->cast;
    job.cast_count =
        wr_plan_calls(&renderer->plan, WR_EFFECT_CAST) ? renderer->cast.count : renderer->cast.all;
    job.cast_unit = 1 / renderer->view.scale;
    job.wide = wr_wide_of(job.kernels);
    job.wide_codes = wr_wide_codes_of(job.kernels);
    job.balls = renderer->balls;
    wr_pipe_wide(&job);
    wr_frame_bind_sparse_hits(renderer, &job);
    return job;
}

static bool same_view(const WrRenderer *renderer, const WrFrameRequest *request)
{
    const WrFrameRequest *last = &renderer->last;
    return renderer->seen && renderer->scene == request->scene &&
           last->turn_deg == request->turn_deg && last->width == request->width &&
           last->height == request->height;
}

/* Bounding radius, cached while the shape is unchanged. */
static double radius_of(WrRenderer *renderer, const WrShape *shape)
{
    if (renderer->radius > 0 && memcmp(&renderer->sized, shape, sizeof *shape) == 0)
        return renderer->radius;
    renderer->sized = *shape;
    return renderer->radius = wr_shape_radius(shape);
}

static bool find_outside(WrRenderer *renderer, const WrFrameRequest *request, bool *outside,
                         WrError *err)
{
    *outside = renderer->outside;
    return same_view(renderer, request) ||
           wr_view_outside(request->scene, radius_of(renderer, &request->scene->shape),
                           request->turn_deg, request->width, request->height, outside, err);
}

/* Largest displacement on screen by F, in pixels; 0 where it displaces nothing. */
static bool find_rise(WrRenderer *renderer, const WrFrameRequest *request, double *rise,
                      WrError *err)
{
    *rise = -1;
    return (!request->scene->displaced && !request->scene->parallax) ||
           wr_view_rise(request->scene, request->field, radius_of(renderer, &request->scene->shape),
                        request->turn_deg, request->width, request->height, rise, err);
}

/* Texels that an edit reaches beyond the texel of a fetch. Adaptive sampling also estimates between texels, from
   the same table. */
static int reach_of(const WrPlan *plan)
{
    return wr_schemes[plan->scheme].reach + (plan->sampling == WR_SAMPLING_ADAPTIVE ? 2 : 0);
}

/* Adds the region that shadows and occlusion reach beyond the edit: the changed horizons. False: it is unknown. */
static bool add_horizon_edit(WrRenderer *renderer)
{
    const WrPlan *plan = &renderer->plan;
    const uint64_t shown = renderer->keep.field ? wr_field_key(renderer->keep.field) : 0;
    if (!wr_plan_runs(plan, WR_EFFECT_SHADOW) && !wr_plan_runs(plan, WR_EFFECT_OCCLUSION))
        return true;
    if (!wr_plan_runs(plan, WR_EFFECT_BUMP)) return false; /* no tile records its fetches */
    if (shown == renderer->horizon_key) return true;
    if (!renderer->horizon_edit || shown != renderer->horizon_before) return false;
    wr_dirty_add_texels(&renderer->keep, renderer->looked, renderer->horizon_edit);
    return true;
}

/* True if the last picture fits this request, apart from edits of the table. */
static bool rests(WrRenderer *renderer, const WrFrameRequest *request, const WrPlan *before,
                  const WrKernels *kernels)
{
    const bool mapped = !request->map || request->map == renderer->last.map;
    return wr_frame_may_keep(request) && !request->normals && mapped &&
           same_view(renderer, request) &&
           wr_frame_same_output(&renderer->last.codes, &request->codes) &&
           renderer->kernels == kernels && wr_plan_same(before, &renderer->plan) &&
           wr_dirty_compare(&renderer->keep, renderer->looked, reach_of(&renderer->plan)) &&
           add_horizon_edit(renderer);
}

/* True if view and mesh of the last picture fit this request. */
static bool view_stands(const WrRenderer *renderer, const WrFrameRequest *request,
                        const WrPlan *before, const WrPlanRequest *ask)
{
    WrPlan lively = renderer->plan;
    WrPlanRequest other = *ask;
    if (!same_view(renderer, request)) return false;
    if (wr_plan_same(before, &renderer->plan)) return true;
    other.facts.lively = true;
    wr_plan_samples(&lively, &other);
    return wr_plan_same(before, &lively);
}

/* Falls back to all samples where adaptive sampling does not pay or needs a bound that is unknown. */
static void look_for_life(WrRenderer *renderer, const WrFrameRequest *request, WrPlanRequest *ask)
{
    WrPlan *plan = &renderer->plan;
    const WrForce *force = request->force;
    if (plan->sampling != WR_SAMPLING_ADAPTIVE || (force && force[WR_EFFECT_BOUND])) return;
    ask->facts.lively = plan->refine == WR_REFINE_BOUND && !wr_plan_runs(plan, WR_EFFECT_BOUND);
    if (!ask->facts.lively) {
        wr_frame_start_counts(renderer);
        const WrTileJob job = wr_frame_job(renderer, request);
        ask->facts.lively = !wr_refine_pays(&job, renderer->scratch[0]);
    }
    if (ask->facts.lively) wr_plan_samples(plan, ask);
}

/* Prepares view and mesh of a completely new picture. */
static bool prepare_view(WrRenderer *renderer, const WrFrameRequest *request,
                         const WrKernels *kernels, WrError *err)
{
    const WrScene *scene = request->scene;
    const WrPlan *plan = &renderer->plan;
    /* before the old one is released: it may be the same */
    WrScene *shared = wr_scene_share(scene);
    forget_view(renderer);
    renderer->scene = shared;
    renderer->last = *request;
    renderer->samples = plan->samples;
    renderer->seen = wr_view_init(&renderer->view, scene, radius_of(renderer, &scene->shape), plan,
                                  request->turn_deg, request->width, request->height, err);
    if (!renderer->seen) return false;
    if (!wr_frame_prepare_meshes(renderer, request, kernels, err)) {
        forget_view(renderer);
        return false;
    }
    if (!wr_progress_stopped()) return true;
    wr_frame_drop_meshes(renderer, NULL); /* drops half-built meshes */
    wr_view_triangles_fini(&renderer->triangles);
    forget_view(renderer);
    return wr_fail(err, "cancelled");
}

bool wr_frame_decide(WrRenderer *renderer, const WrFrameRequest *request, WrError *err)
{
    const WrDials *dials = request->dials ? request->dials : &request->scene->dials;
    const WrKernels *kernels =
        wr_kernels_get(renderer->isa, dials->arithmetic == WR_ARITHMETIC_FAST, err);
    if (!kernels) return false;
    const WrPlan before = renderer->plan;
    WrPlanRequest ask = {
        .scene = request->scene, .dials = dials, .force = request->force, .full = request->full
    };
    ask.facts.normals = request->normals;
    ask.facts.among = renderer->among;
    ask.facts.hiders = renderer->cast.count;
    if (!find_outside(renderer, request, &ask.facts.outside, err)) return false;
    if (!find_rise(renderer, request, &ask.facts.rise, err)) return false;
    if (!wr_frame_prepare_table(renderer, request, &ask, err)) return false;
    if (!wr_frame_prepare_maps(renderer, request, err)) return false;
    const bool stands = renderer->stands = view_stands(renderer, request, &before, &ask);
    renderer->sighting = renderer->sighted = false; /* not yet known */
    ask.facts.rests = false;
    const WrKernels *last = renderer->kernels;
    renderer->kernels = kernels;
    if (stands) look_for_life(renderer, request, &ask);
    ask.facts.rests = rests(renderer, request, &before, last);
    wr_plan_again(&renderer->plan, &ask);
    renderer->ask = ask;
    return true;
}

bool wr_frame_prepare(WrRenderer *renderer, const WrFrameRequest *request, WrError *err)
{
    if (!wr_plan_runs(&renderer->plan, WR_EFFECT_AGAIN)) return true;
    wr_dirty_fini(&renderer->keep);
    renderer->outside = renderer->ask.facts.outside;
    if (!prepare_view(renderer, request, renderer->kernels, err)) return false;
    if (!renderer->stands) look_for_life(renderer, request, &renderer->ask);
    return true;
}

/* Chooses the relight cache's use for a picture of one object. */
static void choose_steady(WrRenderer *renderer, const WrFrameRequest *request)
{
    const WrRelightPart part = { .scene = request->scene,
                                 .plan = &renderer->plan,
                                 .field = wr_field_key(request->field) };
    wr_frame_choose_steady(renderer, request, &part, &renderer, 1);
}

/* Selects the tiles of a static view that edits reach, or all; the selected tiles record their fetches again. */
static void start_keep(WrRenderer *renderer, const WrFrameRequest *request, FrameJob *job,
                       const WrDirty *const *own)
{
    if (!wr_plan_runs(&renderer->plan, WR_EFFECT_AGAIN)) {
        job->keeps = own, job->keep_count = 1;
        return;
    }
    wr_did(renderer->scratch[0], WR_EFFECT_AGAIN);
    job->cancel = request->cancel;
    if (renderer->steady->use == WR_RELIGHT_KNOWN) return; /* no tile records its fetches */
    if (!wr_frame_may_keep(request)) return;
    wr_frame_start_notes(&job->tile, &renderer->keep);
    job->tile.seen = &renderer->keep;
}

void wr_frame_shown(WrRenderer *renderer)
{
    if (renderer->sighting) renderer->sight.whole = true;
    if (renderer->keep.patches) wr_dirty_field(&renderer->keep, renderer->looked);
}

/* Renders a picture of one object. */
static bool single_frame(WrRenderer *renderer, const WrFrameRequest *request, WrFrame *frame,
                         WrError *err)
{
    const double started = wr_clock_seconds();
    const WrDirty *const own = &renderer->keep;
    wr_group_free(renderer);
    if (!wr_frame_resize(renderer, request, err)) return false;
    const WrScene *scene = request->scene;
    if (!wr_frame_casts(&renderer, &scene, &request->field, 1, request, err)) return false;
    if (!wr_frame_decide(renderer, request, err)) return false;
    choose_steady(renderer, request);
    if (!wr_frame_prepare(renderer, request, err)) return false;
    wr_frame_update_visibility(renderer, request, (WrHash){ 0 },
                               wr_plan_runs(&renderer->plan, WR_EFFECT_AGAIN));
    wr_frame_start_counts(renderer);
    FrameJob job = { .tile = wr_frame_job(renderer, request),
                     .scratch = renderer->scratch,
                     .only = request->only };
    start_keep(renderer, request, &job, &own);
    const double prepared = wr_clock_seconds() - started;
    if (!wr_frame_run(renderer, &job)) {
        wr_dirty_fini(&renderer->keep);
        return wr_fail(err, "cancelled");
    }
    wr_frame_shown(renderer);
    wr_frame_account(renderer, prepared, started, frame);
    if (renderer->steady->use == WR_RELIGHT_NOTE) renderer->steady->whole = true;
    return true;
}

bool wr_renderer_frame(WrRenderer *renderer, const WrFrameRequest *request, WrFrame *frame,
                       WrError *err)
{
    if (wr_scene_object_count(request->scene) > 1 || request->scene->hidden)
        return wr_group_frame(renderer, request, frame, err);
    WrFrameRequest own = *request;
    if (own.fields && own.fields[0]) own.field = own.fields[0];
    return single_frame(renderer, &own, frame, err);
}

bool wr_renderer_pick(WrRenderer *renderer, double x, double y, double *u, double *v, int *face)
{
    int object;
    return wr_renderer_pick_object(renderer, x, y, &object, u, v, face);
}

bool wr_renderer_pick_object(WrRenderer *renderer, double x, double y, int *object, double *u,
                             double *v, int *face)
{
    if (!(x >= 0 && y >= 0 && x < renderer->width && y < renderer->height)) return false;
    if (renderer->group) return wr_group_pick(renderer, x, y, object, u, v, face);
    *object = 0;
    if (!renderer->seen) return false;
    WrTileJob job = wr_frame_job(renderer, NULL);
    return wr_tile_pick(&job, (int)(x * renderer->samples), (int)(y * renderer->samples),
                        renderer->scratch[0], u, v, face);
}
