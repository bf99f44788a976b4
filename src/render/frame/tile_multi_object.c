/* Tile of several objects: drawn front to back; each sample shows the nearest object (E51-E53). */
#include "render/pipeline/pipeline.h"
#include "render/frame/tile_internal.h"
#include "scene/objects.h"
#include "system/clock.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Objects whose bound overlaps the tile, nearest first as the jobs are. */
typedef struct Touching {
    const WrTileJob *job[WR_OBJECTS_MAX];
    WrTilePart part[WR_OBJECTS_MAX];
    int count;
} Touching;

static void find_touching(const WrTileJob *jobs, int count, WrTilePart whole, Touching *out)
{
    out->count = 0;
    for (int i = 0; i < count; i++) {
        const bool beside = wr_plan_runs(jobs[i].plan, WR_EFFECT_BESIDE);
        const WrTilePart part = beside ? whole : wr_tile_touched(&jobs[i], whole);
        if (part.w <= 0 || part.h <= 0) continue;
        out->job[out->count] = &jobs[i];
        out->part[out->count++] = part;
    }
}

/* Bounding rectangle of all objects on the tile. */
static WrTilePart united(const Touching *touching)
{
    WrTilePart all = touching->part[0];
    for (int i = 1; i < touching->count; i++) {
        const WrTilePart part = touching->part[i];
        const int x1 = all.x + all.w, y1 = all.y + all.h;
        const int right = part.x + part.w, bottom = part.y + part.h;
        all.x = part.x < all.x ? part.x : all.x;
        all.y = part.y < all.y ? part.y : all.y;
        all.w = (right > x1 ? right : x1) - all.x;
        all.h = (bottom > y1 ? bottom : y1) - all.y;
    }
    return all;
}

/* Clears the samples of a tile, k x k a pixel. */
static void empty(int k, WrTilePart whole, bool nearest, WrTileScratch *scratch)
{
    const size_t width = (size_t)(whole.w * k);
    for (int y = 0; y < whole.h * k; y++) {
        memset(scratch->sample[y], 0, width * sizeof(float[4]));
        if (!nearest) continue;
        for (size_t x = 0; x < width; x++) scratch->nearest[y][x] = (WrNearest){ INFINITY, 0 };
    }
}

/* Largest depth among the tile's samples; INFINITY if one of them is background. */
static float farthest(int k, WrTilePart whole, const WrTileScratch *scratch)
{
    float depth = -INFINITY;
    for (int y = 0; y < whole.h * k; y++) {
        for (int x = 0; x < whole.w * k; x++) {
            const float deep = scratch->nearest[y][x].depth;
            depth = deep > depth ? deep : depth;
        }
        if (depth == INFINITY) break;
    }
    return depth;
}

float wr_tile_hidden_from(const WrTileJob *job)
{
    const float nearest = (float)job->view->nearest;
    return nearest - FLT_EPSILON * fabsf(nearest);
}

/* Draws all objects' samples into scratch->sample and, where requested, n' into the picture. */
static void draw(const Touching *touching, int k, WrTilePart whole, bool light, int index,
                 WrTileScratch *scratch)
{
    const bool several = touching->count > 1;
    for (int i = 0; i < touching->count; i++) {
        const WrTileJob *job = touching->job[i];
        const WrTilePart part = touching->part[i];
        /* All that follows lies behind: drawing can stop (E52). Samples from the relight cache have no depth. */
        if (i > 0 && !job->steady && !wr_plan_runs(job->plan, WR_EFFECT_HIDDEN) &&
            farthest(k, whole, scratch) < wr_tile_hidden_from(job))
            break;
        if (i > 0 && wr_plan_runs(job->plan, WR_EFFECT_HIDDEN)) wr_did(scratch, WR_EFFECT_HIDDEN);
        const int x = (part.x - whole.x) * k, y = (part.y - whole.y) * k;
        WrTileRows out = { .rgba_step = 4 * WR_TILE_SAMPLES_W,
                           .wide = (size_t)job->width,
                           .over = several,
                           .nearest_step = WR_TILE_SAMPLES_W };
        if (light) out.rgba = scratch->sample[y][x];
        if (k == 1 && job->normals)
            out.normals = job->normals + 3 * wr_tile_place(job, part.x, part.y);
        if (several && !job->steady) out.nearest = &scratch->nearest[y][x];
        scratch->notes = wr_dirty_open(job->seen, index, whole.x, whole.y);
        const WrDepthTile tile =
            wr_tile_depth(job, k, part.x * k, part.y * k, part.w * k, part.h * k, scratch);
        wr_tile_samples(job, k, &tile, &out, scratch);
    }
}

/* Stores the means of the samples in the picture. */
static void resolve(const WrTileJob *canvas, WrTilePart whole, WrTileScratch *scratch)
{
    const int k = canvas->samples;
    const size_t step = sizeof scratch->sample[0] / sizeof(float);
    float row[WR_TILE_SAMPLES_W][4];
    for (int y = 0; y < whole.h; y++) {
        float *to = canvas->codes ? row[0] : wr_tile_pixel(canvas, whole.x, whole.y + y);
        scratch->covered += wr_tile_means(k, whole.w, scratch->sample[y * k][0], step, to);
        if (canvas->codes) wr_tile_code_row(canvas, whole.x, whole.y + y, whole.w, row[0], scratch);
    }
}

/* Adaptive sampling of the tile. */
static void refine(const WrTileJob *canvas, const WrTileJob *jobs, int count, WrTilePart part,
                   int index, WrTileScratch *scratch)
{
    const WrTileJob apart = canvas->codes ? wr_tile_apart(canvas, part, scratch) : *canvas;
    wr_refine_group(&apart, jobs, count, part, index, scratch);
    if (canvas->codes) wr_tile_code(&apart, part, scratch);
}

/* All samples everywhere. */
static void sample(const WrTileJob *canvas, const Touching *touching, WrTilePart whole, int index,
                   WrTileScratch *scratch)
{
    const int k = canvas->samples;
    const int64_t covered = scratch->covered;
    empty(k, whole, touching->count > 1, scratch);
    draw(touching, k, whole, true, index, scratch);
    scratch->covered = covered; /* it counted samples */
    if (k > 1) wr_did(scratch, WR_EFFECT_SAMPLES);
    const double start = wr_clock_seconds();
    resolve(canvas, whole, scratch);
    scratch->whole[WR_STAGE_RESOLVE] += wr_clock_seconds() - start;
}

void wr_tile_render_group(const WrTileJob *canvas, const WrTileJob *jobs, int count,
                          WrTilePart tile, int index, WrTileScratch *scratch)
{
    const int64_t before = scratch->shaded;
    Touching touching;
    const double start = wr_clock_seconds();
    find_touching(jobs, count, tile, &touching);
    if (canvas->map) wr_tile_start_map(canvas, tile, scratch);
    const WrTilePart none = { tile.x, tile.y, 0, 0 };
    const WrTilePart whole = touching.count > 0 ? united(&touching) : none;
    wr_tile_clear(canvas, tile, whole);
    scratch->whole[WR_STAGE_CLEAR] += wr_clock_seconds() - start;
    if (touching.count == 0) return;
    if (canvas->normals && canvas->samples > 1) {
        empty(1, whole, touching.count > 1, scratch);
        draw(&touching, 1, whole, false, index, scratch);
    }
    if (canvas->plan->sampling == WR_SAMPLING_ADAPTIVE)
        refine(canvas, jobs, count, whole, index, scratch);
    else sample(canvas, &touching, whole, index, scratch);
    for (int i = 0; i < touching.count; i++) wr_dirty_close(touching.job[i]->seen, index);
    scratch->tiles += scratch->shaded > before;
}
