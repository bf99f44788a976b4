/* pipeline_body.h - the stages of the plan over one strip. Included by pipeline.c and pipeline_double.c, which
   define REAL and the names of that precision. Deliberately without a guard. */

typedef WR_T(WrStrip) Strip;
typedef WR_T(WrKernels) Kernels;
typedef WR_T(WrRays) Rays;

/* Only one strip in WR_TIMED reads the clock: two readings per stage would cost more than short stages. */
typedef struct Watch {
    WrTileScratch *scratch;
    bool on;
    double last;
} Watch;

static Watch watch_start(WrTileScratch *scratch)
{
    bool on = scratch->strips++ % WR_TIMED == 0;
    return (Watch){ scratch, on, on ? wr_clock_seconds() : 0 };
}

static void watch_lap(Watch *watch, WrStage stage)
{
    if (!watch->on) return;
    double now = wr_clock_seconds();
    watch->scratch->seconds[stage] += now - watch->last;
    watch->last = now;
}

static bool runs(const WrTileJob *job, WrEffect effect)
{
    return wr_plan_runs(job->plan, effect);
}

/* The surface is a mesh, whose frame comes with the hit. */
static bool met_whole(const WrTileJob *job)
{
    return job->triangles && (!job->dice || job->dice->base);
}

static void did(const Watch *watch, WrEffect effect)
{
    wr_did(watch->scratch, effect);
}

/* Samples a side per pixel in the grid of these rays.
   Adaptive sampling renders with several grids of k x k samples; each has its own rays, and their address
   identifies it. */
static int grid_of(const WrView *view, const Rays *rays)
{
    int i = 0;
    while (i + 1 < view->grid_count && &VIEWED(&view->grids[i], rays) != rays) i++;
    return view->grids[i].k;
}

/* Records the fetches of the strip in the dirty regions. */
static void note_looks(const WrTileJob *job, const Rays *rays, const Strip *strip,
                       const WrTileScratch *scratch)
{
    if (scratch->notes.patches)
        wr_dirty_add_places(&scratch->notes, grid_of(job->view, rays), strip->count, sizeof(REAL),
                            strip->x, strip->y, strip->tu, strip->tv);
}

#include "render/pipeline/stage_half_precision_body.h"
#include "render/pipeline/stage_fetch_body.h"
#include "render/pipeline/stage_normal_map_body.h"
#include "render/pipeline/stage_relief_weights_body.h"

/* Closed-form kernels of the surface; NULL: it has none. */
static const WR_T(WrRound) * round_of(const WrTileJob *job)
{
    const WR_T(WrRound) *round = &KERNELS_OF(job)->round[job->plan->inversion];
    return round->hit ? round : NULL;
}

/* True if light is computed. */
static bool lit(const WrSink *sink)
{
    return sink->rgba || sink->codes;
}

#include "render/pipeline/stage_infinite_plane_body.h"
#include "render/pipeline/stage_relight_store_body.h"
#include "render/pipeline/stage_shadow_body.h"
#include "render/pipeline/stage_light_body.h"
#include "render/pipeline/stage_depth_body.h"
#include "render/pipeline/stage_parallax_body.h"
#include "render/pipeline/stage_displaced_body.h"

/* Size of each pixel on the surface, and the change of the normal across it.
   The bounds of E16: |dP| over a pixel, of the slopes over that part of the table, and of n' as their
   consequence. */
static void bound_geometry(const WrTileJob *job, const Rays *rays, int quad, const WrSink *sink,
                           Strip *strip, Watch *watch)
{
    const Kernels *k = KERNELS_OF(job);
    const bool sphere = quad < 0, bumped = job->plan->bump != WR_BUMP_NONE;
    did(watch, WR_EFFECT_BOUND);
    if (sphere) k->bound_sphere(rays, &VIEWED(job->view, shape), (REAL)sink->pixel, strip);
    else k->bound_quad(rays, &VIEWED(job->view, quads)[quad], (REAL)sink->pixel, strip);
    if (bumped) k->bound_slopes(LOOK_OF(job), strip);
    k->bound_normal(sphere, bumped, strip);
}

/* Effects that each normal formula runs. */
static const WrEffects normal_effects[] = {
    [WR_BUMP_NONE] = 0,
    [WR_BUMP_BLINN] = WR_EFFECT_BIT(WR_EFFECT_BUMP),
    [WR_BUMP_INVARIANT] = WR_EFFECT_BIT(WR_EFFECT_BUMP) | WR_EFFECT_BIT(WR_EFFECT_INVARIANT),
    [WR_BUMP_EXACT] = WR_EFFECT_BIT(WR_EFFECT_BUMP) | WR_EFFECT_BIT(WR_EFFECT_EXACT),
};
_Static_assert(sizeof normal_effects / sizeof *normal_effects == WR_BUMP_COUNT, "all formulas");

/* uv [samples][2] by position in the row; strip->index leads there from the compacted strip. */
static void store_parameters(const WrSink *sink, const Strip *strip)
{
    for (int i = 0; i < strip->count; i++) {
        sink->uv[2 * strip->index[i]] = (float)strip->u[i];
        sink->uv[2 * strip->index[i] + 1] = (float)strip->v[i];
    }
}

/* True if n' is computed directly from n and the slopes and nothing else reads the tangents.
   The tangent frame is then never stored: the kernel derives it from P. */
static bool bends_at_once(const WrTileJob *job, const WrSink *sink)
{
    return job->plan->bump == WR_BUMP_BLINN && KERNELS_OF(job)->bend[job->plan->inversion] &&
           !runs(job, WR_EFFECT_FILTER) && !runs(job, WR_EFFECT_TINT) &&
           !runs(job, WR_EFFECT_SPREAD) && !runs(job, WR_EFFECT_SHADOW) &&
           !runs(job, WR_EFFECT_PARALLAX) && !job->plan->map_filtered &&
           !runs(job, WR_EFFECT_REORIENTED) && !job->plan->facets_filtered &&
           job->plan->map_frame == WR_FRAME_GRADIENT && !sink->bound;
}

/* P, n, and the other parts of the surface's frame that the plan needs.
   Of round surfaces P comes from the hit, of meshes from Newton's last step; all others evaluate their formula
   at (u, v). */
static void surface_strip(const WrTileJob *job, int face, bool level, const WrSink *sink,
                          Strip *strip, Watch *watch)
{
    const WR_T(WrRound) *round = round_of(job);
    const bool parallax = runs(job, WR_EFFECT_PARALLAX);
    if (job->dice && job->dice->base) did(watch, WR_EFFECT_DISPLACED);
    else if (job->dice || parallax) base_strip(job, face, strip, watch);
    if (job->triangles || parallax) return; /* the frame came with the hit, or was just computed */
    if (round && runs(job, WR_EFFECT_TANGENTS) && !level && !bends_at_once(job, sink)) {
        round->tangents(&VIEWED(job->view, shape), strip);
        did(watch, WR_EFFECT_TANGENTS);
    }
    if (round) round->normals(&VIEWED(job->view, shape), strip);
    else if (job->mesh && job->newton)
        KERNELS_OF(job)->frame[job->view->shape_d.kind](&VIEWED(job->view, shape), strip);
    else KERNELS_OF(job)->geometry[job->view->shape_d.kind](&VIEWED(job->view, shape), face, strip);
    watch_lap(watch, WR_STAGE_GEOMETRY);
}

/* n' of the samples, from the table's slopes if it has any.
   Order: slopes of the table, then those of the normal map are added to them or combined, then eased towards the horizon, then n'.
   The solid texture bends n' afterwards, because its slopes are in space and not along Pu, Pv. */
static void bend_strip(const WrTileJob *job, const Rays *rays, bool level, const WrSink *sink,
                       Strip *strip, WrTileScratch *scratch, Watch *watch)
{
    const Kernels *k = KERNELS_OF(job);
    const WrBumpMode bump = level ? WR_BUMP_NONE : job->plan->bump;
    REAL side[WR_SPAN];
    memcpy(side, strip->s, (size_t)strip->count * sizeof *side); /* footprints overwrite it */
    if (bump != WR_BUMP_NONE && job->plan->source != WR_SOURCE_NONE)
        look_relief(job, rays, strip, scratch, watch);
    if (bump != WR_BUMP_NONE && runs(job, WR_EFFECT_NORMALS))
        look_map(job, rays, strip, scratch, watch);
    if (bump != WR_BUMP_NONE && runs(job, WR_EFFECT_HORIZON)) ease_slopes(job, rays, strip);
    if (bump != WR_BUMP_NONE && bends_at_once(job, sink)) {
        k->bend[job->plan->inversion](rays, &VIEWED(job->view, shape), strip);
        did(watch, WR_EFFECT_TANGENTS);
    } else {
        k->bump[bump](rays, strip);
    }
    if (job->dice) face_viewer(job, rays, strip);
    if (runs(job, WR_EFFECT_PARALLAX)) face_ray(rays, side, strip);
    scratch->ran |= normal_effects[bump] &
                    (runs(job, WR_EFFECT_BUMP) ? ~(WrEffects)0 : ~WR_EFFECT_BIT(WR_EFFECT_BUMP));
    watch_lap(watch, WR_STAGE_BUMP);
    if (runs(job, WR_EFFECT_EMBOSSED)) emboss(job, rays, strip, watch);
    if (runs(job, WR_EFFECT_SPREAD) && lit(sink)) {
        strip->gathered = k->gathered(strip);
        if (strip->gathered && !runs(job, WR_EFFECT_WIDENED)) {
            const size_t size = (size_t)strip->count * sizeof(REAL);
            memset(strip->see, 0, size), memset(strip->sef, 0, size), memset(strip->sff, 0, size);
        } else k->widen(job->plan->bump == WR_BUMP_INVARIANT, strip);
        if (runs(job, WR_EFFECT_WIDENED)) did(watch, WR_EFFECT_WIDENED);
        did(watch, WR_EFFECT_SPREAD);
        watch_lap(watch, WR_STAGE_SPREAD);
    }
    keep_half3(job, strip->bx, strip->by, strip->bz, strip->count, watch);
}

/* Work that the run can skip, once P and n are known. lit: it is known not to be dark. deferred: as in is_dark. */
static unsigned spared_of(const WrTileJob *job, const Rays *rays, bool level, bool lit,
                          const WR_T(WrRound) * deferred, Strip *strip, WrTileScratch *scratch,
                          Watch *watch)
{
    const bool dark = !lit && is_dark(job, rays, level, deferred, strip);
    const unsigned spared = (level ? WR_RUN_LEVEL : 0) | (dark ? WR_RUN_DARK : 0);
    if (runs(job, WR_EFFECT_GROUND) && !dark) did(watch, WR_EFFECT_GROUND);
    if (spared && scratch->notes.patches && job->plan->bump != WR_BUMP_NONE)
        note_spared(job, rays, strip, scratch);
    return spared;
}

/* P, n and n' of the samples, as far as light needs them. Returns the skipped work, bits of WrRun.
   Order: hidden samples are dropped before anything expensive (keep_near), then the dark test, then curvature
   and bump. */
static unsigned normal_strip(const WrTileJob *job, const Rays *rays, int face, const WrSink *sink,
                             Strip *strip, WrTileScratch *scratch, Watch *watch)
{
    const bool level = is_level(job, strip);
    did(watch, WR_EFFECT_STEADY);
    surface_strip(job, face, level, sink, strip, watch);
    if (sink->nearest) keep_near(job, sink, strip, watch);
    if (strip->count == 0) return 0;
    const WR_T(WrRound) *deferred = bends_at_once(job, sink) ? round_of(job) : NULL;
    const unsigned spared = spared_of(job, rays, level, false, deferred, strip, scratch, watch);
    if (spared & WR_RUN_DARK) return spared;
    if (runs(job, WR_EFFECT_CURVATURE)) {
        const WrSurfaceKind kind = job->view->shape_d.kind;
        KERNELS_OF(job)->curvature[kind](&VIEWED(job->view, shape), face, strip);
        did(watch, WR_EFFECT_CURVATURE);
        watch_lap(watch, WR_STAGE_CURVATURE);
    }
    bend_strip(job, rays, level, sink, strip, scratch, watch);
    return spared;
}

/* All stages of the plan from the hit to the colour. quad: of a planar surface, or -1. Returns the skipped work,
   bits of WrRun. */
static unsigned shade_strip(const WrTileJob *job, const Rays *rays, int quad, const WrSink *sink,
                            Strip *strip, WrTileScratch *scratch, Watch *watch)
{
    const int face = quad >= 0 ? job->view->quad_face[quad] : job->dice ? scratch->face : 0;
    unsigned spared = 0;
    if (runs(job, WR_EFFECT_PARAMETERS) && !job->triangles) {
        if (!scratch->uv_known) round_of(job)->params(&VIEWED(job->view, shape), strip);
        did(watch, WR_EFFECT_PARAMETERS);
        watch_lap(watch, WR_STAGE_PARAMETERS);
    }
    if (runs(job, WR_EFFECT_PARALLAX)) meet_relief(job, rays, face, strip, scratch, watch);
    if (sink->uv && !sink->nearest) store_parameters(sink, strip);
    if (job->plan->normals && strip->count > 0) {
        spared = normal_strip(job, rays, face, sink, strip, scratch, watch);
    } else if (sink->nearest && strip->count > 0) {
        surface_strip(job, face, true, sink, strip, watch);
        keep_near(job, sink, strip, watch);
    }
    if (strip->count == 0) return spared;
    /* only of samples that are not hidden */
    if (sink->uv && sink->nearest) store_parameters(sink, strip);
    if (sink->bound) bound_geometry(job, rays, quad, sink, strip, watch);
    watch_lap(watch, WR_STAGE_BOUND);
    if (!lit(sink)) {
        stretch_strip(job->view, strip);
        return spared;
    }
    if (job->noting) note_known(job, strip);
    if (spared & WR_RUN_DARK) ambient_strip(job, rays, strip, watch);
    else spared |= light_strip(job, rays, sink, strip, watch);
    keep_half3(job, strip->cr, strip->cg, strip->cb, strip->count, watch);
    return spared;
}

#include "render/pipeline/stage_store_body.h"

/* Records the visibility effects that ran for the strip, and their precision.
   Effects are noted where they run, not where they are planned: `effects` reports the difference. */
static void note_view(const WrTileJob *job, const Rays *rays, WrTileScratch *scratch)
{
    if (rays->perspective) wr_did(scratch, WR_EFFECT_PERSPECTIVE);
    if (!job->view->cull) wr_did(scratch, WR_EFFECT_BACK);
    if (sizeof(REAL) == sizeof(double)) wr_did(scratch, WR_EFFECT_DOUBLE);
}

/* Adds the strip's costs to the pixels' cost map. */
static void note_map(const WrTileJob *job, const Rays *rays, unsigned spared, const Strip *strip,
                     const WrTileScratch *scratch)
{
    const int k = grid_of(job->view, rays);
    const bool looked = job->plan->bump != WR_BUMP_NONE && !(spared & (WR_RUN_LEVEL | WR_RUN_DARK));
    const bool shone = runs(job, WR_EFFECT_DIFFUSE) || runs(job, WR_EFFECT_SPECULAR);
    const int light = shone && !(spared & WR_RUN_DARK) ? WR_MAP_LIT : 0;
    const bool filtered = looked && runs(job, WR_EFFECT_FILTER);
    const bool tinted = !looked && runs(job, WR_EFFECT_TINT);
    for (int i = 0; i < strip->count; i++) {
        const bool wide = (filtered && scratch->wide_of[i]) || (tinted && scratch->tint_of[i]);
        /* outside the picture */
        if (strip->x[i] < (REAL)-0.5 || strip->y[i] < (REAL)-0.5) continue;
        const int bits =
            WR_MAP_COVERED | light | (looked ? WR_MAP_LOOKED : 0) | (wide ? WR_MAP_WIDE : 0);
        wr_tile_map(job, scratch, (int)(strip->x[i] + (REAL)0.5) / k,
                    (int)(strip->y[i] + (REAL)0.5) / k, (uint8_t)bits);
    }
}

/* Stores the strip's results and counts its samples. */
static void put_strip(const WrTileJob *job, const Rays *rays, unsigned spared, const WrSink *sink,
                      const Strip *strip, WrTileScratch *scratch, Watch *watch)
{
    note_view(job, rays, scratch);
    if (lit(sink)) scratch->spared[spared] += strip->count;
    if (job->map) note_map(job, rays, spared, strip, scratch);
    store(job, sink, strip, scratch);
    if (runs(job, WR_EFFECT_HORIZON)) fade_strip(job, rays, sink, strip, watch);
    watch_lap(watch, WR_STAGE_STORE);
    if (lit(sink)) scratch->shaded += strip->count;
}

/* A strip may lose samples in shade_strip (hidden by a nearer object), so the count is tested again. */
static void finish_strip(const WrTileJob *job, const Rays *rays, int quad, const WrSink *sink,
                         WrTileScratch *scratch, Watch *watch)
{
    Strip *strip = STRIP_OF(scratch);
    if (strip->count == 0) return;
    const unsigned spared = shade_strip(job, rays, quad, sink, strip, scratch, watch);
    if (strip->count > 0) put_strip(job, rays, spared, sink, strip, scratch, watch);
}

/* ---- visibility ---------------------------------------------------------------------------------- */

#include "render/pipeline/stage_visibility_body.h"
#include "render/pipeline/stage_relight_body.h"

static void pour(const WrScatter *places, Strip *strip)
{
    for (int i = 0; i < places->count; i++) {
        strip->x[i] = (REAL)places->x[i];
        strip->y[i] = (REAL)places->y[i];
    }
}

static const Rays *rays_of(const WrTileJob *job, int k)
{
    return &VIEWED(wr_view_grid(job->view, k), rays);
}

/* Ways to find the visible points, in order of precedence: relight cache, triangles of a mesh file or a
   displaced surface, grid mesh with Newton's method, closed forms, planar faces. */
static void points(const WrTileJob *job, int k, const WrDepthTile *tile, const WrSink *sink,
                   WrTileScratch *scratch)
{
    const Rays *rays = rays_of(job, k);
    const WrView *view = job->view;
    const WrScatter *places = &scratch->scatter;
    const Kernels *kernels = KERNELS_OF(job);
    Strip *strip = STRIP_OF(scratch);
    Watch watch = watch_start(scratch);
    if (places->count == 0) return;
    if (job->relight) {
        recall_places(job, places, strip);
        light_known(job, rays, sink, scratch, &watch);
        return;
    }
    if (job->triangles) {
        for (scratch->face = 0; scratch->face < faces_of(job); scratch->face++) {
            meet_places(job, rays, tile, places, runs(job, WR_EFFECT_PARAMETERS), scratch, &watch);
            finish_strip(job, rays, -1, sink, scratch, &watch);
        }
        return;
    }
    if (job->mesh) {
        if (job->seen_before) recall_mesh(job, rays, tile, places, strip, &watch);
        else locate_mesh(job, rays, tile, places, strip, &watch);
        finish_strip(job, rays, -1, sink, scratch, &watch);
        return;
    }
    const WR_T(WrRound) *round = round_of(job);
    if (round) {
        pour(places, strip);
        if (go_along(job, rays)) take_all(places->count, strip);
        else round->hit_at(rays, &VIEWED(view, shell), places->count, strip);
        watch_lap(&watch, WR_STAGE_VISIBILITY);
        finish_strip(job, rays, -1, sink, scratch, &watch);
        return;
    }
    for (int i = 0; i < view->quad_count; i++) {
        pour(places, strip);
        kernels->hit_quad_at(rays, &VIEWED(view, quads)[i], places->count, strip);
        watch_lap(&watch, WR_STAGE_VISIBILITY);
        finish_strip(job, rays, i, sink, scratch, &watch);
    }
}

/* Row y of the tile as a scatter. */
static void row_places(const WrDepthTile *tile, int y, WrScatter *places)
{
    places->count = tile->w;
    for (int x = 0; x < tile->w; x++) {
        int cell = y * tile->w + x;
        const signed char *shift = tile->shift ? tile->shift + 2 * cell : NULL;
        places->x[x] = tile->x + x + (shift ? shift[0] / 256.0 : 0);
        places->y[x] = tile->y + y + (shift ? shift[1] / 256.0 : 0);
        places->cell[x] = cell;
    }
}

/* Stores the positions of the hits, if a later stage needs them. */
static void note_places(const WrTileJob *job, const WrSink *sink, bool noted, REAL gx, REAL gy,
                        Strip *strip)
{
    if (!runs(job, WR_EFFECT_FILTER) && !runs(job, WR_EFFECT_TINT) && !job->plan->map_filtered &&
        !job->plan->facets_filtered && !sink->bound && !job->map && !runs(job, WR_EFFECT_HORIZON) &&
        !runs(job, WR_EFFECT_FADED) && !runs(job, WR_EFFECT_PARALLAX) && !noted)
        return;
    for (int i = 0; i < strip->count; i++) {
        strip->x[i] = gx + (REAL)strip->index[i];
        strip->y[i] = gy;
    }
}

#include "render/pipeline/stage_simd_body.h"

/* As points, for a row of neighbouring samples: rays are affine in the column, and hits have no list of
   positions unless a later stage reads them (note_places). */
static void row(const WrTileJob *job, int k, const WrDepthTile *tile, int y, const WrSink *sink,
                WrTileScratch *scratch)
{
    const WrView *view = job->view;
    const Kernels *kernels = KERNELS_OF(job);
    if (tile->shift) {
        row_places(tile, y, &scratch->scatter);
        points(job, k, tile, sink, scratch);
        return;
    }
    const Rays *rays = rays_of(job, k);
    Strip *strip = STRIP_OF(scratch);
    Watch watch = watch_start(scratch);
    const REAL gx = (REAL)tile->x, gy = (REAL)(tile->y + y);
    if (job->relight) {
        recall_row_of(job, rays, tile, y, strip);
        light_known(job, rays, sink, scratch, &watch);
        return;
    }
    if (job->triangles) {
        for (scratch->face = 0; scratch->face < faces_of(job); scratch->face++) {
            meet_row(job, rays, tile, y, scratch, &watch);
            finish_strip(job, rays, -1, sink, scratch, &watch);
        }
        return;
    }
    if (job->mesh) {
        if (job->seen_before) recall_row(job, rays, tile, y, strip, &watch);
        else locate_row(job, rays, tile, y, strip, &watch);
        finish_strip(job, rays, -1, sink, scratch, &watch);
        return;
    }
    const WR_T(WrRound) *round = round_of(job);
    if (round) {
        if (wide_row(job, rays, gx, gy, tile->w, sink, scratch, &watch)) return;
        scratch->uv_known =
            !runs(job, WR_EFFECT_PARALLAX) && met_wide(job, rays, gx, gy, tile->w, strip);
        if (go_along(job, rays)) take_all(tile->w, strip);
        else if (!scratch->uv_known) round->hit(rays, &VIEWED(view, shell), gx, gy, tile->w, strip);
        note_places(job, sink, scratch->notes.patches || job->noting, gx, gy, strip);
        watch_lap(&watch, WR_STAGE_VISIBILITY);
        finish_strip(job, rays, -1, sink, scratch, &watch);
        scratch->uv_known = false;
        return;
    }
    for (int i = 0; i < view->quad_count; i++) {
        kernels->hit_quad(rays, &VIEWED(view, quads)[i], gx, gy, tile->w, strip);
        note_places(job, sink, scratch->notes.patches || job->noting, gx, gy, strip);
        watch_lap(&watch, WR_STAGE_VISIBILITY);
        finish_strip(job, rays, i, sink, scratch, &watch);
    }
}

static bool pick(const WrTileJob *job, int gx, int gy, WrTileScratch *scratch, double *u, double *v,
                 int *face)
{
    const Rays *rays = rays_of(job, job->samples);
    Strip *strip = STRIP_OF(scratch);
    WrScatter *places = &scratch->scatter;
    Watch watch = { scratch, false, 0 };
    const WR_T(WrRound) *round = round_of(job);
    places->count = 1;
    places->x[0] = gx, places->y[0] = gy, places->cell[0] = 0;
    strip->count = 0;
    *face = 0;
    if (job->triangles) {
        WrDepthTile tile = wr_tile_depth(job, job->samples, gx, gy, 1, 1, scratch);
        for (scratch->face = 0; scratch->face < faces_of(job) && strip->count == 0;
             scratch->face++) {
            meet_places(job, rays, &tile, places, true, scratch, &watch);
            *face = scratch->face;
        }
        if (strip->count > 0) scratch->picked = (int32_t)tile.u[0];
    } else if (job->mesh) {
        WrDepthTile tile = wr_tile_depth(job, job->samples, gx, gy, 1, 1, scratch);
        locate_mesh(job, rays, &tile, places, strip, &watch);
    } else if (round) {
        pour(places, strip);
        if (go_along(job, rays)) take_all(1, strip);
        else round->hit_at(rays, &VIEWED(job->view, shell), 1, strip);
        round->params(&VIEWED(job->view, shape), strip);
    }
    const bool quads = !round && !job->mesh && !job->triangles;
    for (int i = 0; quads && i < job->view->quad_count && strip->count == 0; i++) {
        pour(places, strip);
        KERNELS_OF(job)->hit_quad_at(rays, &VIEWED(job->view, quads)[i], 1, strip);
        *face = job->view->quad_face[i];
    }
    if (runs(job, WR_EFFECT_PARALLAX)) meet_relief(job, rays, *face, strip, scratch, &watch);
    if (strip->count == 0) return false;
    *u = (double)strip->u[0];
    *v = (double)strip->v[0];
    return true;
}

const WrPipe PIPE = { row, points, pick };
