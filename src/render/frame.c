#include "render/frame.h"
#include "base/clock.h"
#include "base/memory.h"
#include "render/keep.h"
#include "render/table.h"
#include "render/tile.h"

#include <string.h>

/* The colour picture as the kernels want it. */
typedef struct ColourCopy {
    const WrImage *source; /* shared; what rgba was made from */
    WrWrap wrap_u, wrap_v;
    float *rgba; /* apron of one texel */
    int pitch;
} ColourCopy;

struct WrRenderer {
    WrPool *pool;
    char isa[8];
    WrTable table;
    WrViewMesh mesh;
    ColourCopy colour;
    WrTileScratch **scratch; /* [threads], made on first use */
    int threads;
    float *rgba; /* the last picture */
    int width, height;
    WrPlan plan;
    WrView view; /* of the last frame, for picking */
    WrScene *scene;
    int samples;
    bool seen; /* view and scene are set */
    WrKeep keep;
    WrFrameRequest last;      /* of the last whole or refreshed picture; for its numbers only */
    const WrKernels *kernels; /* that it was made with */
    int64_t covered;
};

WrRenderer *wr_renderer_new(WrPool *pool, const char *isa, WrError *err)
{
    if (!wr_kernels_get(isa, false, err)) return NULL;
    WrRenderer *renderer = wr_alloc(1, sizeof *renderer);
    renderer->pool = pool;
    renderer->threads = wr_pool_threads(pool);
    renderer->scratch = wr_alloc((size_t)renderer->threads, sizeof *renderer->scratch);
    snprintf(renderer->isa, sizeof renderer->isa, "%s", isa ? isa : "auto");
    wr_table_init(&renderer->table);
    return renderer;
}

static void forget_view(WrRenderer *renderer)
{
    if (renderer->seen) wr_view_fini(&renderer->view);
    wr_scene_free(renderer->scene);
    renderer->scene = NULL;
    renderer->seen = false;
}

static void drop_colour(ColourCopy *copy)
{
    wr_image_free((WrImage *)copy->source);
    wr_free(copy->rgba);
    *copy = (ColourCopy){ 0 };
}

void wr_renderer_free(WrRenderer *renderer)
{
    if (!renderer) return;
    forget_view(renderer);
    wr_keep_fini(&renderer->keep);
    wr_table_fini(&renderer->table);
    wr_view_mesh_fini(&renderer->mesh);
    drop_colour(&renderer->colour);
    for (int i = 0; i < renderer->threads; i++) wr_free(renderer->scratch[i]);
    wr_free(renderer->scratch);
    wr_free(renderer->rgba);
    wr_free(renderer);
}

/* Index of a texel of the apron: round, or the edge. */
static int wrap(int i, int n, WrWrap how)
{
    if (how == WR_WRAP_PERIODIC) return (i % n + n) % n;
    return i < 0 ? 0 : i >= n ? n - 1 : i;
}

static bool bring_colour(ColourCopy *copy, const WrImage *image, const WrField *field, WrError *err)
{
    WrWrap wrap_u = wr_field_wrap_u(field), wrap_v = wr_field_wrap_v(field);
    if (copy->source == image && copy->wrap_u == wrap_u && copy->wrap_v == wrap_v) return true;
    drop_colour(copy);
    const int w = image->width, h = image->height, c = image->channels;
    copy->rgba =
        wr_try_alloc((size_t)(w + 2) * (size_t)(h + 2), 4 * sizeof(float), "colour picture", err);
    if (!copy->rgba) return false;
    copy->source = wr_image_share(image);
    copy->wrap_u = wrap_u, copy->wrap_v = wrap_v;
    copy->pitch = w + 2;
    for (int j = -1; j <= h; j++)
        for (int i = -1; i <= w; i++) {
            const float *in =
                image->data +
                ((size_t)wrap(j, h, wrap_v) * (size_t)w + (size_t)wrap(i, w, wrap_u)) * (size_t)c;
            float *out = copy->rgba + ((size_t)(j + 1) * (size_t)copy->pitch + (size_t)(i + 1)) * 4;
            out[0] = in[0];
            out[1] = c >= 3 ? in[1] : in[0];
            out[2] = c >= 3 ? in[2] : in[0];
        }
    return true;
}

/* Decide, make what the decision needs, and decide again once the gradient table is known. */
static bool prepare_table(WrRenderer *renderer, const WrFrameRequest *request, const WrDials *dials,
                          WrError *err)
{
    const WrScene *scene = request->scene;
    const WrField *field = request->field;
    WrTable *table = &renderer->table;
    WrPlan *plan = &renderer->plan;
    WrTableFacts facts = { .flat = wr_table_flat(table, field) };
    facts.zero = facts.flat && wr_field_get(field, 0, 0) == 0.0f;
    wr_plan_build(plan, scene, dials, &facts, request->plan_off);
    if (plan->gradient_table) {
        if (!wr_table_bring(table, WR_COPY_GRADIENT, field, renderer->pool, err)) return false;
        facts.slope_free = wr_table_slope_free(table);
        wr_plan_build(plan, scene, dials, &facts, request->plan_off);
    }
    const bool looked = plan->bump != WR_BUMP_NONE && scene->analytic.kind == WR_ANALYTIC_OFF;
    const bool fitted = looked && scene->scheme == WR_SCHEME_BSPLINE_FIT;
    const bool heights = looked && !fitted && (!plan->gradient_table || plan->need_heights);
    if (!plan->gradient_table && !facts.slope_free) wr_table_drop(table, WR_COPY_GRADIENT);
    if (!fitted) wr_table_drop(table, WR_COPY_FITTED);
    if (!heights) wr_table_drop(table, WR_COPY_HEIGHTS);
    if (fitted && !wr_table_bring(table, WR_COPY_FITTED, field, renderer->pool, err)) return false;
    return !heights || wr_table_bring(table, WR_COPY_HEIGHTS, field, renderer->pool, err);
}

static WrLook make_look(const WrRenderer *renderer, const WrFrameRequest *request, double scale)
{
    const WrScene *scene = request->scene;
    const WrCopy *copies = renderer->table.copies;
    const WrCopy *heights =
        &copies[scene->scheme == WR_SCHEME_BSPLINE_FIT ? WR_COPY_FITTED : WR_COPY_HEIGHTS];
    const WrCopy *gradient = &copies[WR_COPY_GRADIENT];
    const double height = scene->height * scale;
    return (WrLook){ .heights = heights->data,
                     .gradient = gradient->data,
                     .pitch = heights->data ? heights->pitch : gradient->pitch,
                     .width = wr_field_width(request->field),
                     .height = wr_field_height(request->field),
                     .ru = scene->replicate_u,
                     .rv = scene->replicate_v,
                     .periodic_u = wr_field_wrap_u(request->field) == WR_WRAP_PERIODIC,
                     .periodic_v = wr_field_wrap_v(request->field) == WR_WRAP_PERIODIC,
                     .wide = renderer->plan.wide,
                     .scale_f = (float)height,
                     .scale_u = (float)(height * scene->replicate_u),
                     .scale_v = (float)(height * scene->replicate_v) };
}

static WrColourLook make_colour_look(const WrRenderer *renderer, const WrFrameRequest *request)
{
    if (!renderer->plan.colour) return (WrColourLook){ 0 };
    const WrImage *image = request->scene->colour;
    return (WrColourLook){ .rgba = renderer->colour.rgba,
                           .pitch = renderer->colour.pitch,
                           .width = image->width,
                           .height = image->height,
                           .ru = request->scene->replicate_u,
                           .rv = request->scene->replicate_v,
                           .periodic_u = renderer->colour.wrap_u == WR_WRAP_PERIODIC,
                           .periodic_v = renderer->colour.wrap_v == WR_WRAP_PERIODIC };
}

static bool resize(WrRenderer *renderer, int width, int height, WrError *err)
{
    if (width < 1 || height < 1 || width > 16384 || height > 16384)
        return wr_fail(err, "picture size %dx%d: each side must be 1..16384", width, height);
    if (renderer->rgba && renderer->width == width && renderer->height == height) return true;
    float *rgba = wr_try_alloc((size_t)width * (size_t)height, 4 * sizeof(float), "picture", err);
    if (!rgba) return false;
    wr_free(renderer->rgba);
    renderer->rgba = rgba;
    renderer->width = width;
    renderer->height = height;
    return true;
}

typedef struct FrameJob {
    WrTileJob tile;
    WrTileScratch **scratch;
    int tiles_u;
    const WrKeep *keep; /* render only what this one's changes touch; NULL: all */
    const volatile int *cancel;
} FrameJob;

static void render_tile(int index, int worker, void *ctx)
{
    FrameJob *job = ctx;
    if (job->cancel && *job->cancel) return;
    if (job->keep && !wr_keep_touches(job->keep, index)) return;
    wr_tile_render(&job->tile, index % job->tiles_u, index / job->tiles_u, index,
                   job->scratch[worker]);
}

static void start_counts(WrRenderer *renderer)
{
    for (int i = 0; i < renderer->threads; i++) {
        if (!renderer->scratch[i]) renderer->scratch[i] = wr_alloc(1, sizeof(WrTileScratch));
        WrTileScratch *s = renderer->scratch[i];
        memset(s->seconds, 0, sizeof s->seconds);
        s->covered = s->shaded = s->tiles = 0;
        s->strips = 0;
    }
}

/* What each effect cost and touched, into the plan's rows. */
static void account(WrRenderer *renderer, const double seconds[WR_STAGE_COUNT], int64_t tiles,
                    int64_t shaded)
{
    static const int stage_of[WR_EFFECT_COUNT] = {
        [WR_EFFECT_DIFFUSE] = WR_STAGE_DIFFUSE,
        [WR_EFFECT_SPECULAR] = WR_STAGE_SPECULAR,
        [WR_EFFECT_COLOUR] = WR_STAGE_COLOUR,
        [WR_EFFECT_BUMP] = WR_STAGE_BUMP,
        [WR_EFFECT_GRADIENT] = WR_STAGE_LOOK,
        [WR_EFFECT_WIDE] = -1,
        [WR_EFFECT_INVARIANT] = WR_STAGE_BUMP,
        [WR_EFFECT_EXACT] = WR_STAGE_BUMP,
        [WR_EFFECT_CURVATURE] = WR_STAGE_CURVATURE,
        [WR_EFFECT_SAMPLES] = WR_STAGE_RESOLVE,
        [WR_EFFECT_BACK] = -1,
        [WR_EFFECT_DEPTH] = WR_STAGE_VISIBILITY,
        [WR_EFFECT_AGAIN] = -1,
        [WR_EFFECT_NEWTON] = WR_STAGE_NEWTON,
        [WR_EFFECT_PERSPECTIVE] = -1,
    };
    for (int e = 0; e < WR_EFFECT_COUNT; e++) {
        WrPlanRow *row = &renderer->plan.rows[e];
        if (!row->run) continue;
        row->tiles = tiles;
        row->pixels = shaded;
        double spent = stage_of[e] >= 0 ? seconds[stage_of[e]] : 0;
        if (e == WR_EFFECT_BUMP && !renderer->plan.gradient_table) spent += seconds[WR_STAGE_LOOK];
        row->ns_per_pixel = shaded > 0 ? 1e9 * spent / (double)shaded : 0;
    }
}

static void finish_frame(WrRenderer *renderer, bool refreshed, double prepared, double started,
                         WrFrame *frame)
{
    double seconds[WR_STAGE_COUNT] = { 0 };
    int64_t tiles = 0;
    *frame = (WrFrame){ .width = renderer->width,
                        .height = renderer->height,
                        .rgba = renderer->rgba,
                        .plan = &renderer->plan };
    for (int i = 0; i < renderer->threads; i++) {
        const WrTileScratch *s = renderer->scratch[i];
        for (int k = 0; k < WR_STAGE_COUNT; k++) seconds[k] += s->seconds[k];
        frame->covered += s->covered;
        frame->shaded += s->shaded;
        tiles += s->tiles;
    }
    if (refreshed) frame->covered = renderer->covered; /* heights do not move the outline */
    renderer->covered = frame->covered;
    account(renderer, seconds, tiles, frame->shaded);
    frame->times = (WrStageTimes){
        .prepare = prepared,
        .visibility = seconds[WR_STAGE_VISIBILITY] + seconds[WR_STAGE_NEWTON],
        .geometry = seconds[WR_STAGE_GEOMETRY] + seconds[WR_STAGE_CURVATURE],
        .bump = seconds[WR_STAGE_LOOK] + seconds[WR_STAGE_BUMP],
        .shade = seconds[WR_STAGE_COLOUR] + seconds[WR_STAGE_DIFFUSE] + seconds[WR_STAGE_SPECULAR],
        .resolve = seconds[WR_STAGE_RESOLVE],
        .total = wr_clock_seconds() - started,
    };
}

static WrTileJob make_job(WrRenderer *renderer, const WrFrameRequest *request,
                          const WrKernels *kernels)
{
    WrTileJob job = { .view = &renderer->view,
                      .plan = &renderer->plan,
                      .scene = renderer->scene,
                      .kernels = kernels,
                      .mesh = renderer->plan.mesh ? &renderer->mesh : NULL,
                      .samples = renderer->samples,
                      .width = renderer->width,
                      .height = renderer->height,
                      .rgba = renderer->rgba };
    if (request) {
        job.look = make_look(renderer, request, renderer->view.scale);
        job.colour = make_colour_look(renderer, request);
    }
    wr_tile_size(job.samples, &job.tile_w, &job.tile_h);
    return job;
}

/* Do two plans run the same stages? */
static bool same_stages(const WrPlan *a, const WrPlan *b)
{
    return a->diffuse == b->diffuse && a->specular == b->specular && a->colour == b->colour &&
           a->bump == b->bump && a->need_heights == b->need_heights && a->wide == b->wide &&
           a->gradient_table == b->gradient_table && a->samples == b->samples;
}

/* May the last picture stand where the table has not changed? */
static bool may_refresh(WrRenderer *renderer, const WrFrameRequest *request, const WrPlan *before,
                        const WrKernels *kernels)
{
    const WrFrameRequest *last = &renderer->last;
    return request->keep && renderer->seen && renderer->scene == request->scene &&
           last->turn_deg == request->turn_deg && last->width == request->width &&
           last->height == request->height && renderer->kernels == kernels &&
           same_stages(before, &renderer->plan) &&
           wr_keep_compare(&renderer->keep, request->field,
                           wr_schemes[request->scene->scheme].reach + 2);
}

/* View and mesh of a whole new picture. */
static bool prepare_view(WrRenderer *renderer, const WrFrameRequest *request,
                         const WrKernels *kernels, WrError *err)
{
    const WrScene *scene = request->scene;
    WrScene *shared = wr_scene_share(scene); /* before the old one goes: it may be the same */
    forget_view(renderer);
    renderer->scene = shared;
    renderer->samples = renderer->plan.samples;
    renderer->seen = wr_view_init(&renderer->view, scene, request->turn_deg, request->width,
                                  request->height, renderer->samples, err);
    if (!renderer->seen) return false;
    if (renderer->plan.mesh)
        wr_view_mesh_prepare(&renderer->mesh, &scene->shape, &renderer->view, renderer->samples,
                             kernels, renderer->pool);
    else wr_view_mesh_fini(&renderer->mesh);
    return true;
}

static bool prepare_colour(WrRenderer *renderer, const WrFrameRequest *request, WrError *err)
{
    if (renderer->plan.colour)
        return bring_colour(&renderer->colour, request->scene->colour, request->field, err);
    drop_colour(&renderer->colour);
    return true;
}

bool wr_renderer_frame(WrRenderer *renderer, const WrFrameRequest *request, WrFrame *frame,
                       WrError *err)
{
    const double started = wr_clock_seconds();
    const WrDials *dials = request->dials ? request->dials : &request->scene->dials;
    const WrKernels *kernels =
        wr_kernels_get(renderer->isa, dials->arithmetic == WR_ARITHMETIC_FAST, err);
    if (!kernels || !resize(renderer, request->width, request->height, err)) return false;
    const WrPlan before = renderer->plan;
    if (!prepare_table(renderer, request, dials, err)) return false;
    if (!prepare_colour(renderer, request, err)) return false;
    const bool refresh = may_refresh(renderer, request, &before, kernels);
    if (!refresh) {
        wr_keep_fini(&renderer->keep);
        if (!prepare_view(renderer, request, kernels, err)) return false;
    }
    FrameJob job = { .tile = make_job(renderer, request, kernels), .scratch = renderer->scratch };
    start_counts(renderer);
    job.tiles_u = (request->width + job.tile.tile_w - 1) / job.tile.tile_w;
    int tiles = job.tiles_u * ((request->height + job.tile.tile_h - 1) / job.tile.tile_h);
    if (refresh) {
        job.keep = &renderer->keep;
        wr_plan_again(&renderer->plan, true,
                      "the view rests: only tiles that an edit reached are new");
    } else {
        job.cancel = request->cancel;
    }
    if (request->keep && !refresh) {
        wr_keep_start(&renderer->keep, tiles);
        job.tile.seen = renderer->keep.seen;
    }
    const double prepared = wr_clock_seconds() - started;
    wr_pool_run(renderer->pool, tiles, render_tile, &job);
    if (job.cancel && *job.cancel) {
        wr_keep_fini(&renderer->keep);
        return wr_fail(err, "cancelled");
    }
    if (request->keep) wr_keep_field(&renderer->keep, request->field);
    renderer->last = *request;
    renderer->kernels = kernels;
    finish_frame(renderer, refresh, prepared, started, frame);
    return true;
}

bool wr_renderer_pick(WrRenderer *renderer, double x, double y, double *u, double *v, int *face)
{
    if (!renderer->seen || !(x >= 0 && y >= 0 && x < renderer->width && y < renderer->height))
        return false;
    const WrKernels *kernels = wr_kernels_get(renderer->isa, false, NULL);
    WrTileJob job = make_job(renderer, NULL, kernels);
    return wr_tile_pick(&job, (int)(x * renderer->samples), (int)(y * renderer->samples),
                        renderer->scratch[0], u, v, face);
}
