#include "render/frame/frame.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "field/field.h"
#include "render/frame/frame_internal.h"
#include "render/pipeline/pipeline.h"
#include "render/simd/simd_kernels.h"
#include "scene/objects.h"
#include "system/clock.h"

#include <math.h>
#include <string.h>

/* ---- Cost counters of a frame, by stage and by effect ---- */

/* scratch[i] belongs to thread i and is reused from frame to frame; counters are summed when all threads have
   finished. */

void wr_frame_start_counts(WrRenderer *renderer)
{
    for (int i = 0; i < renderer->threads; i++) {
        if (!renderer->scratch[i]) renderer->scratch[i] = wr_alloc(1, sizeof(WrTileScratch));
        WrTileScratch *s = renderer->scratch[i];
        const bool wide = wr_plan_runs(&renderer->plan, WR_EFFECT_DOUBLE);
        if (wide && !s->wide) s->wide = wr_alloc(3, sizeof *s->wide);
        if (renderer->group && !s->nearest)
            s->nearest = wr_alloc(WR_TILE_SAMPLES_H, sizeof *s->nearest);
        memset(s->seconds, 0, sizeof s->seconds);
        memset(s->whole, 0, sizeof s->whole);
        s->all = s->all_strips = 0;
        s->covered = s->not_finite = s->shaded = s->tiles = s->wide_samples = s->wide_tints = 0;
        memset(s->spared, 0, sizeof s->spared);
        memset(s->spared_tiles, 0, sizeof s->spared_tiles);
        s->strips = 0;
        s->ran = 0;
    }
}

/* ---- time of each stage ---- */

/* Sum of all threads' counters. */
typedef struct Counts {
    int64_t tiles, shaded, filtered, tinted;
    int64_t spared[WR_RUN_KINDS], spared_tiles[WR_RUN_KINDS]; /* as in WrTileScratch */
    WrEffects ran;
} Counts;

/* Writes cost and touched samples of each effect to the plan's rows.
   A row's pixels are those that were shaded, without the runs in which the effect was skipped (`spared`);
   spared_tiles is indexed by the union of the bits. */
static void account(WrPlan *plan, const double seconds[WR_STAGE_COUNT], const Counts *counts)
{
    const int64_t shaded = counts->shaded;
    for (int c = 0; c < WR_COST_COUNT; c++) plan->cost[c] = 0;
    for (int e = 0; e < WR_EFFECT_COUNT; e++) {
        WrPlanRow *row = &plan->rows[e];
        row->seconds = 0;
        row->ran = counts->ran >> e & 1;
        if (!row->run) continue;
        const unsigned spared = wr_effects[e].spared;
        row->tiles = counts->tiles - counts->spared_tiles[spared];
        row->pixels = e == WR_EFFECT_FILTER ? counts->filtered
                      : e == WR_EFFECT_TINT ? counts->tinted
                                            : shaded;
        for (unsigned run = 0; run < WR_RUN_KINDS; run++)
            if (run & spared) row->pixels -= counts->spared[run];
    }
    for (int stage = 0; stage < WR_STAGE_COUNT; stage++)
        wr_plan_charge(plan, (WrStage)stage, seconds[stage]);
    plan->shaded = shaded;
    for (int e = 0; e < WR_EFFECT_COUNT; e++)
        plan->rows[e].ns_per_pixel = shaded > 0 ? 1e9 * plan->rows[e].seconds / (double)shaded : 0;
}

/* Adds one thread's stage times. One strip in sixteen is measured; the total time of strips is divided in that
   ratio. Returns the rest of its tiles' time. */
static double add_thread(const WrTileScratch *s, double seconds[WR_STAGE_COUNT])
{
    double strips = 0, left = s->all;
    for (int k = 0; k < WR_STAGE_COUNT; k++) {
        strips += s->seconds[k];
        left -= s->whole[k];
    }
    left = fmax(left, 0);
    const double share = strips > 0 ? fmin(s->all_strips, left) / strips : 0;
    for (int k = 0; k < WR_STAGE_COUNT; k++) seconds[k] += s->whole[k] + share * s->seconds[k];
    return left - share * strips;
}

/* Work is threads x (total - prepared) + prepared: the time that all threads had. The parts not spent in tiles
   are waiting. */
void wr_frame_account(WrRenderer *renderer, double prepared, double started, WrFrame *frame)
{
    double seconds[WR_STAGE_COUNT] = { 0 }, rest = 0, busy = 0;
    Counts counts = { 0 };
    WrPlan *plan = &renderer->plan;
    const double total = wr_clock_seconds() - started;
    *frame = (WrFrame){ .width = renderer->width,
                        .height = renderer->rows,
                        .first = renderer->top,
                        .of = renderer->height,
                        .plan = plan };
    if (renderer->last.codes.wanted) frame->codes = renderer->codes;
    else frame->rgba = renderer->rgba;
    for (int i = 0; i < renderer->threads; i++) {
        const WrTileScratch *s = renderer->scratch[i];
        rest += add_thread(s, seconds);
        busy += s->all;
        frame->covered += s->covered;
        frame->shaded += s->shaded;
        frame->not_finite += s->not_finite;
        counts.tiles += s->tiles;
        counts.filtered += s->wide_samples;
        counts.tinted += s->wide_tints;
        for (int run = 0; run < WR_RUN_KINDS; run++) {
            counts.spared[run] += s->spared[run];
            counts.spared_tiles[run] += s->spared_tiles[run];
        }
        counts.ran |= s->ran;
    }
    if (!wr_plan_runs(plan, WR_EFFECT_AGAIN))
        frame->covered = renderer->covered; /* heights do not change the outline */
    renderer->covered = frame->covered;
    counts.shaded = frame->shaded;
    account(plan, seconds, &counts);
    plan->work = prepared + renderer->threads * (total - prepared);
    plan->cost[WR_COST_PREPARE] += prepared;
    plan->cost[WR_COST_REST] += rest;
    plan->cost[WR_COST_WAIT] += plan->work - prepared - busy;
    frame->times = (WrStageTimes){
        .prepare = prepared,
        .visibility = seconds[WR_STAGE_VISIBILITY] + seconds[WR_STAGE_NEWTON],
        .geometry = seconds[WR_STAGE_GEOMETRY] + seconds[WR_STAGE_CURVATURE],
        .bump = seconds[WR_STAGE_FOOTPRINT] + seconds[WR_STAGE_LOOK] + seconds[WR_STAGE_PYRAMID] +
                seconds[WR_STAGE_NORMALS] + seconds[WR_STAGE_BUMP] + seconds[WR_STAGE_SPREAD],
        .shade = seconds[WR_STAGE_COLOUR] + seconds[WR_STAGE_TINT] + seconds[WR_STAGE_DIFFUSE] +
                 seconds[WR_STAGE_SPECULAR] + seconds[WR_STAGE_SURROUND] +
                 seconds[WR_STAGE_MIRROR] + seconds[WR_STAGE_SHADOW] + seconds[WR_STAGE_CAST] +
                 seconds[WR_STAGE_OCCLUSION] + seconds[WR_STAGE_LIGHT],
        .resolve = seconds[WR_STAGE_RESOLVE] + seconds[WR_STAGE_BOUND] + seconds[WR_STAGE_STORE],
        .pyramid = renderer->pyramid_seconds,
        .total = total,
    };
}

/* ---- Horizon and ambient occlusion tables of the height field, updated with each frame ---- */

/* Both tables follow the field, not the view: turning the object keeps them. */

void wr_frame_drop_horizon(WrRenderer *renderer)
{
    wr_horizon_drop(&renderer->horizon);
    wr_field_free(renderer->horizon_field);
    wr_free(renderer->horizon_edit);
    renderer->horizon_field = NULL;
    renderer->horizon_edit = NULL;
}

/* Updates the horizons after an edit of the table.
   horizon_before -> horizon_key: the edit marks texels whose horizons changed between these two versions of
   the table. */
static bool update_horizon(WrRenderer *renderer, WrError *err)
{
    WrHorizon *horizon = &renderer->horizon;
    const size_t texels = (size_t)horizon->width * (size_t)horizon->height;
    if (!renderer->horizon_edit)
        renderer->horizon_edit = wr_try_alloc(texels, 1, "horizons of the table", err);
    if (!renderer->horizon_edit ||
        !wr_horizon_update(horizon, renderer->horizon_field, renderer->looked,
                           renderer->horizon_sign, renderer->horizon_edit, renderer->pool, err)) {
        wr_frame_drop_horizon(renderer);
        return false;
    }
    wr_field_free(renderer->horizon_field);
    renderer->horizon_field = wr_field_share(renderer->looked);
    renderer->horizon_before = renderer->horizon_key;
    renderer->horizon_key = wr_field_key(renderer->looked);
    return true;
}

/* Updates the table's horizons; after an edit, only the changed ones.
   Horizons of -F are those of a negative height; a change of sign rebuilds them. */
bool wr_frame_update_horizon(WrRenderer *renderer, const WrFrameRequest *request, WrError *err)
{
    const double sign = request->scene->height < 0 ? -1 : 1;
    const uint64_t key = wr_field_key(renderer->looked);
    WrHorizon *horizon = &renderer->horizon;
    const WrPlan *plan = &renderer->plan;
    if (!wr_plan_runs(plan, WR_EFFECT_SHADOW) && !wr_plan_runs(plan, WR_EFFECT_OCCLUSION)) {
        if (!request->hold) wr_frame_drop_horizon(renderer);
        return true;
    }
    const bool like = horizon->slope && renderer->horizon_sign == sign &&
                      horizon->directions == plan->horizons &&
                      wr_field_alike(renderer->horizon_field, renderer->looked);
    if (like && renderer->horizon_key == key) return true;
    if (like) return update_horizon(renderer, err);
    wr_frame_drop_horizon(renderer);
    renderer->horizon_key = key, renderer->horizon_sign = sign;
    renderer->horizon_field = wr_field_share(renderer->looked);
    return wr_horizon_make(horizon, renderer->looked, plan->horizons, sign, renderer->pool, err);
}

/* `horizon_edit` marks the texels whose horizons changed between the keys before and after; the occlusion of those
   alone is summed again. */
bool wr_frame_update_occlusion(WrRenderer *renderer, const WrFrameRequest *request, WrError *err)
{
    if (wr_plan_runs(&renderer->plan, WR_EFFECT_OCCLUSION))
        return wr_occlusion_map_table_update(&renderer->opening, request->scene, renderer->looked,
                                             &(WrOcclusionMapEdit){ renderer->horizon_key,
                                                                    renderer->horizon_before,
                                                                    renderer->horizon_edit },
                                             &renderer->horizon, renderer->pool, err);
    if (!request->hold) wr_occlusion_map_table_drop(&renderer->opening);
    return true;
}

/* ---- Shadow casters of each object of a picture, found before it is planned ---- */

/* True if forced effects request even casters that cannot hide a lamp. */
static bool wants_all(const WrFrameRequest *request)
{
    return request->full || (request->force && request->force[WR_EFFECT_CAST] == WR_FORCE_ON);
}

/* True if forced effects replace even displaced casters by their bases. */
static bool keeps_bases(const WrFrameRequest *request)
{
    return request->force && request->force[WR_EFFECT_DISPLACED] == WR_FORCE_OFF;
}

/* A caster's mesh is kept in its renderer's `body`, so that several pictures of a still object build it once. */
bool wr_frame_casts(WrRenderer *const *renderers, const WrScene *const *scenes,
                    const WrField *const *fields, int count, const WrFrameRequest *request,
                    WrError *err)
{
    const WrDials *dials = request->dials ? request->dials : &request->scene->dials;
    WrShadowRaysBody *bodies[WR_OBJECTS_MAX];
    for (int i = 0; i < count; i++) {
        renderers[i]->cast.count = renderers[i]->cast.all = 0;
        bodies[i] = &renderers[i]->body;
    }
    if (dials->rays == 0 || !wr_shadow_rays_needed(request->scene)) return true;
    for (int i = 0; i < count; i++) {
        const WrShadowRaysRequest ask = { .scenes = scenes,
                                          .fields = fields,
                                          .bodies = bodies,
                                          .count = count,
                                          .at = i,
                                          .rays = dials->rays,
                                          .all = wants_all(request),
                                          .moves = !keeps_bases(request),
                                          .turn_deg = request->turn_deg,
                                          .aspect = (double)request->width / request->height };
        if (!wr_shadow_rays_prepare(&renderers[i]->cast, &ask, err)) return false;
    }
    return true;
}

/* ---- tiles ---- */

/* Tile scheduling of a frame: all tiles, the requested blocks, or the patches that edits of a static view reach. */

static int least(int a, int b)
{
    return a < b ? a : b;
}

static void render_part(const FrameJob *job, WrTilePart part, int index, WrTileScratch *scratch)
{
    if (job->objects)
        wr_tile_render_group(&job->tile, job->objects, job->count, part, index, scratch);
    else wr_tile_render(&job->tile, part, index, scratch);
}

/* True if the changes of a static view's tables reach the tile. */
static bool touches(const FrameJob *job, int index)
{
    bool any = job->keep_count == 0;
    for (int i = 0; i < job->keep_count && !any; i++) any = wr_dirty_touches(job->keeps[i], index);
    return any;
}

/* Renders the requested blocks of the tile, neighbouring ones at once: long rows are faster.
   only [blocks down][blocks across] of the whole picture, WR_FRAME_BLOCK pixels wide; a tile is a whole number
   of blocks, so one row of `only` is read. */
static void render_asked(const FrameJob *job, WrTilePart tile, int index, WrTileScratch *scratch)
{
    const int blocks = (job->tile.width + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK;
    const unsigned char *row = job->only + tile.y / WR_FRAME_BLOCK * blocks;
    const int end = tile.x + tile.w;
    for (int x = tile.x, next; x < end; x = next) {
        const bool asked = row[x / WR_FRAME_BLOCK];
        next = x;
        while (next < end && (row[next / WR_FRAME_BLOCK] != 0) == asked)
            next = least(end, (next / WR_FRAME_BLOCK + 1) * WR_FRAME_BLOCK);
        if (asked) render_part(job, (WrTilePart){ x, tile.y, next - x, tile.h }, index, scratch);
    }
}

static bool touches_patch(const FrameJob *job, int index, int column, int row)
{
    bool any = false;
    for (int i = 0; i < job->keep_count && !any; i++)
        any = wr_dirty_touches_patch(job->keeps[i], index, column, row);
    return any;
}

/* Renders the tile's patches that those changes reach: runs of patches, and rows with the same runs at once.
   A run is contiguous patches; runs of equal extent in successive rows become one rectangle, because a
   pipeline strip has a fixed overhead. */
static void render_touched(const FrameJob *job, WrTilePart tile, int index, WrTileScratch *scratch)
{
    const WrDirty *keep = job->keeps[0];
    WrTilePart next = { 0, 0, 0, 0 };
    for (int row = 0; row * keep->patch_h < tile.h; row++)
        for (int from = 0, to; from * keep->patch_w < tile.w; from = to + 1) {
            for (to = from; to < keep->across && touches_patch(job, index, to, row);) to++;
            if (to == from) continue;
            const int x = from * keep->patch_w, y = row * keep->patch_h;
            const WrTilePart run = { tile.x + x, tile.y + y, least(to * keep->patch_w, tile.w) - x,
                                     least(tile.h - y, keep->patch_h) };
            if (run.x == next.x && run.w == next.w && run.y == next.y + next.h) {
                next.h += run.h;
                continue;
            }
            if (next.h > 0) render_part(job, next, index, scratch);
            next = run;
        }
    if (next.h > 0) render_part(job, next, index, scratch);
}

/* Tile `index` counts along rows. Threads share the counter of the pool; a tile writes only its own pixels and
   its thread's scratch. */
static void render_tile(int index, int worker, void *ctx)
{
    FrameJob *job = ctx;
    const WrTileJob *tile = &job->tile;
    WrTilePart part = { index % job->tiles_u * tile->tile_w, index / job->tiles_u * tile->tile_h, 0,
                        0 };
    part.w = least(tile->width - part.x, tile->tile_w);
    part.h = least(tile->rows - part.y, tile->tile_h);
    part.y += tile->top;
    if (wr_cancel_requested(job->cancel)) return;
    if (!touches(job, index)) return;
    const double start = wr_clock_seconds();
    if (job->only) render_asked(job, part, index, job->scratch[worker]);
    else if (job->keep_count > 0) render_touched(job, part, index, job->scratch[worker]);
    else render_part(job, part, index, job->scratch[worker]);
    job->scratch[worker]->all += wr_clock_seconds() - start;
}

static int tiles_across(const WrTileJob *tile)
{
    return (tile->width + tile->tile_w - 1) / tile->tile_w;
}

int wr_frame_tiles(const WrTileJob *tile)
{
    return tiles_across(tile) * ((tile->rows + tile->tile_h - 1) / tile->tile_h);
}

bool wr_frame_run(WrRenderer *renderer, FrameJob *job)
{
    job->tiles_u = tiles_across(&job->tile);
    const bool whole =
        wr_pool_run_with_progress(renderer->pool, wr_frame_tiles(&job->tile), render_tile, job);
    return whole && !wr_cancel_requested(job->cancel);
}

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
    renderer->relight = &renderer->own_relight;
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

/* Drops everything that can be computed again; the picture, its size and the thread scratch remain. */
void wr_renderer_forget(WrRenderer *renderer)
{
    forget_view(renderer);
    wr_dirty_fini(&renderer->keep);
    wr_frame_drop_tables(renderer);
    wr_frame_drop_meshes(renderer, NULL);
    wr_view_triangles_fini(&renderer->triangles);
    wr_dice_fini(&renderer->dice);
    wr_dice_fini(&renderer->dice_aside);
    wr_triangles_free(renderer->square);
    renderer->square = NULL;
    wr_uv_cache_fini(&renderer->uv_cache);
    wr_shadow_rays_body_fini(&renderer->body);
    wr_relight_fini(&renderer->own_relight);
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

/* 16384: coordinates in 1/256 samples stay within 32 bits, their products within 64 (raster.c). */
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
static bool update_memory(WrRenderer *renderer, const WrFrameRequest *request, WrError *err)
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
    if (!renderer->among && !update_memory(renderer, request, err)) return false;
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
    job->coder.tone = wr_tone_curve_params(&codes->tone);
    wr_backdrop_update(&renderer->backdrop, codes, renderer->radius, job->width, job->height,
                       job->top, job->rows, &job->coder, renderer->pool);
    job->backdrop = &renderer->backdrop;
}

/* request NULL: a job for picking, without codes and by exact kernels. */
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
    if (renderer->dice.base) {
        job.triangle_look.base_of = renderer->dice.base_of;
        job.triangle_look.base_triangles = &renderer->dice.base->triangles[0].corner[0];
        job.triangle_look.base_corners = &renderer->dice.base->corners[0].p[0];
    }
    if (request && request->codes.wanted) want_codes(renderer, &request->codes, &job);
    if (request) job.normals = request->normals, job.map = request->map;
    wr_tile_size(job.samples, plan->sampling == WR_SAMPLING_ADAPTIVE, request && request->only,
                 &job.tile_w, &job.tile_h);
    return job;
}

/* Pointers into the renderer's tables: valid until the next frame prepares its own. Looks and parallax are
   kept for picks, which come between frames. */
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
    wr_frame_fill_uv_cache(renderer, &job);
    job.cast = &renderer->cast;
    job.cast_count =
        wr_plan_calls(&renderer->plan, WR_EFFECT_CAST) ? renderer->cast.count : renderer->cast.all;
    job.cast_unit = 1 / renderer->view.scale;
    job.wide = renderer->wide;
    job.wide_codes = request->staged ? NULL : wr_wide_codes_of(job.kernels);
    job.balls = renderer->balls;
    wr_pipe_wide(&job);
    return job;
}

/* Scenes are immutable while shared: equal pointers mean equal content. */
static bool same_view(const WrRenderer *renderer, const WrFrameRequest *request)
{
    const WrFrameRequest *last = &renderer->last;
    return renderer->seen && renderer->scene == request->scene && last->staged == request->staged &&
           last->moving == request->moving && last->turn_deg == request->turn_deg &&
           last->width == request->width && last->height == request->height;
}

/* Bounding radius, cached while the shape is unchanged.
   memcmp of shapes is valid: they are copied whole, padding included. */
static double radius_of(WrRenderer *renderer, const WrShape *shape)
{
    if (renderer->radius > 0 && memcmp(&renderer->sized, shape, sizeof *shape) == 0)
        return renderer->radius;
    renderer->sized = *shape;
    return renderer->radius = wr_shape_radius(shape);
}

/* Depends on view and shape only, so a view that is kept keeps the result. */
static bool find_outside(WrRenderer *renderer, const WrFrameRequest *request, bool *outside,
                         WrError *err)
{
    *outside = renderer->outside;
    return same_view(renderer, request) ||
           wr_view_outside(request->scene, radius_of(renderer, &request->scene->shape),
                           request->turn_deg, request->width, request->height, outside, err);
}

/* Largest displacement on screen by F, in pixels; -1 where it displaces nothing, or is unknown. */
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

/* Adds the region that shadows and occlusion reach beyond the edit: the changed horizons. False: it is unknown.
   A relief's shadow reaches beyond the edited texels; horizon_edit lists the texels whose horizon changed. */
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

/* True if the last picture fits this request, apart from edits of the table.
   Then only edited tiles are rendered (E29). Every input of a picture must be compared here. */
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

/* True if view and mesh of the last picture fit this request.
   A plan that differs only in sampling, chosen by look_for_life, also keeps view and mesh. */
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

/* Prepares view and mesh of a completely new picture.
   The scene is shared first: forget_view releases the old one, which may be the same object. */
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
    wr_dice_fini(&renderer->dice);
    wr_view_triangles_fini(&renderer->triangles);
    forget_view(renderer);
    return wr_fail(err, "cancelled");
}

/* The order is fixed by dependencies: facts of the view and the table, the plan, textures the plan calls for,
   the choice of samples, and last whether the picture rests, which compares the finished plan. */
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
    renderer->uses_uv_cache = renderer->uv_cached = false; /* not yet known */
    ask.facts.rests = false;
    const WrKernels *last = renderer->kernels;
    renderer->kernels = kernels;
    renderer->wide = request->staged ? NULL : wr_wide_of(kernels);
    if (stands) look_for_life(renderer, request, &ask);
    ask.facts.rests = rests(renderer, request, &before, last);
    wr_plan_again(&renderer->plan, &ask);
    renderer->ask = ask;
    return true;
}

/* Only where tiles are rendered anew in full; a resting view keeps its view, mesh and notes. */
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
    wr_frame_choose_relight_cache(renderer, request, &part, &renderer, 1);
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
    if (renderer->relight->use == WR_RELIGHT_KNOWN) return; /* no tile records its fetches */
    if (!wr_frame_may_keep(request)) return;
    wr_frame_start_notes(&job->tile, &renderer->keep);
    job->tile.seen = &renderer->keep;
}

/* After success only: a cancelled frame must not count as complete. */
void wr_frame_mark_current(WrRenderer *renderer)
{
    if (renderer->uses_uv_cache) renderer->uv_cache.whole = true;
    if (renderer->keep.patches) wr_dirty_store_field(&renderer->keep, renderer->looked);
}

/* Renders a picture of one object.
   Invariant: after success `last`, `plan`, `keep` describe the picture in memory. After cancellation `keep` is
   dropped, so that the next frame renders everything. */
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
    wr_frame_mark_current(renderer);
    wr_frame_account(renderer, prepared, started, frame);
    if (renderer->relight->use == WR_RELIGHT_NOTE) renderer->relight->whole = true;
    return true;
}

/* A hidden single object is a group as well: its picture is the background alone. */
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

/* (x, y) in pixels becomes a sample of the grid, so that a pick meets the point that was drawn there. */
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
