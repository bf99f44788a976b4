#include "render/frame/tile.h"

#include "base/hash.h"
#include "render/frame/frame.h"
#include "render/frame/tile_internal.h"
#include "render/pipeline/pipeline.h"
#include "scene/objects.h"
#include "system/clock.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Means of a row of `width` pixels, from k rows of samples `step` floats apart, which are overwritten. Returns
   the number of covered pixels. */
static int tile_means(int k, int width, float *sample, size_t step, float *pixel);

static void tile_code(const WrTileJob *apart, WrTilePart part, WrTileScratch *scratch);

/* tile_apart: a job that renders to the tile's own floats. tile_code: encodes those floats to the picture. */
static WrTileJob tile_apart(const WrTileJob *job, WrTilePart part, WrTileScratch *scratch);

/* Clears the tile; of codes only those beside `part`, because each is written once. */
static void tile_clear(const WrTileJob *job, WrTilePart whole, WrTilePart part);

/* Sets the cost bits that every pixel of the tile has, whatever it shows. */
static void tile_start_map(const WrTileJob *job, WrTilePart whole, WrTileScratch *scratch);

/* Draws all samples of a tile in the grid of k x k samples a pixel. */
static void tile_samples(const WrTileJob *job, int k, const WrDepthTile *tile,
                         const WrTileRows *out, WrTileScratch *scratch);

/* Encodes a row of premultiplied colours, [width][4], into the picture's codes. */
static void tile_code_row(const WrTileJob *job, int x, int y, int width, const float *rgba,
                          WrTileScratch *scratch);

/* ---- multi object ---- */

/* Tile of several objects: drawn front to back; each sample shows the nearest object (E51-E53).
   Order of a tile: clear, then for each object a depth tile (raster) and strips of samples (pipeline), then
   means and codes. All arrays belong to the thread's scratch; sample[y][x] has rows of WR_TILE_SAMPLES_W
   samples of four floats, premultiplied. */

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

/* One unit in the last place nearer than the bounding sphere: samples are rounded to float, the sphere is not. */
float wr_tile_hidden_from(const WrTileJob *job)
{
    const float nearest = (float)job->view->nearest;
    return nearest - FLT_EPSILON * fabsf(nearest);
}

/* Draws all objects' samples into scratch->sample and, where requested, n' into the picture.
   Front to back: a later object overwrites a sample only where it is nearer, by nearest[][] (depth, object). */
static void draw(const Touching *touching, int k, WrTilePart whole, bool light, int index,
                 WrTileScratch *scratch)
{
    const bool several = touching->count > 1;
    for (int i = 0; i < touching->count; i++) {
        const WrTileJob *job = touching->job[i];
        const WrTilePart part = touching->part[i];
        /* All that follows lies behind: drawing can stop (E52). Samples from the relight cache have no depth. */
        if (i > 0 && !job->relight && !wr_plan_runs(job->plan, WR_EFFECT_HIDDEN) &&
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
        if (several && !job->relight) out.nearest = &scratch->nearest[y][x];
        scratch->notes = wr_dirty_open(job->seen, index, whole.x, whole.y);
        const WrDepthTile tile =
            wr_tile_depth(job, k, part.x * k, part.y * k, part.w * k, part.h * k, scratch);
        tile_samples(job, k, &tile, &out, scratch);
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
        scratch->covered += tile_means(k, whole.w, scratch->sample[y * k][0], step, to);
        if (canvas->codes) tile_code_row(canvas, whole.x, whole.y + y, whole.w, row[0], scratch);
    }
}

/* Adaptive sampling of the tile. */
static void refine(const WrTileJob *canvas, const WrTileJob *jobs, int count, WrTilePart part,
                   int index, WrTileScratch *scratch)
{
    const WrTileJob apart = canvas->codes ? tile_apart(canvas, part, scratch) : *canvas;
    wr_refine_group(&apart, jobs, count, part, index, scratch);
    if (canvas->codes) tile_code(&apart, part, scratch);
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
    if (canvas->map) tile_start_map(canvas, tile, scratch);
    const WrTilePart none = { tile.x, tile.y, 0, 0 };
    const WrTilePart whole = touching.count > 0 ? united(&touching) : none;
    tile_clear(canvas, tile, whole);
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

/* Largest power of two up to x.
   With `blocks` the tile must contain whole blocks of WR_FRAME_BLOCK pixels, else it is as wide as the sample
   array allows. */
static int power_below(int x)
{
    int p = 1;
    while (2 * p <= x) p *= 2;
    return p;
}

void wr_tile_size(int samples, bool adaptive, bool blocks, int *tile_w, int *tile_h)
{
    *tile_w = WR_TILE_SAMPLES_W / samples;
    *tile_h = samples < 32 ? 32 / samples : 1;
    if (adaptive) *tile_w = WR_REFINE_W, *tile_h = WR_REFINE_H;
    if (!blocks) return;
    const int tall = samples < WR_TILE_SAMPLES_H ? WR_TILE_SAMPLES_H / samples : 1;
    *tile_w = *tile_w < WR_FRAME_BLOCK ? power_below(*tile_w) : *tile_w - *tile_w % WR_FRAME_BLOCK;
    *tile_h = tall < WR_FRAME_BLOCK ? power_below(tall) : WR_FRAME_BLOCK;
}

/* Fills tile->shift for a grid of k x k a pixel (spread=jittered).
   A hash of the grid position, not a random sequence: the same sample has the same offset in every tile,
   thread and run. -127..127 of 1/256 sample keeps it inside its cell. */
static void tile_jitter(WrDepthTile *tile, int k, signed char *shift)
{
    for (int y = 0; y < tile->h; y++)
        for (int x = 0; x < tile->w; x++) {
            const uint32_t gx = (uint32_t)(tile->x + x), gy = (uint32_t)(tile->y + y);
            uint32_t h = wr_mix32(gx + 0x9e3779b9U * (uint32_t)k);
            h = wr_mix32(h + gy);
            signed char *at = shift + 2 * (y * tile->w + x);
            at[0] = (signed char)((int)((h & 0xffffU) % 255U) - 127);
            at[1] = (signed char)((int)((h >> 16) % 255U) - 127);
        }
    tile->shift = shift;
}

WrDepthTile wr_tile_depth(const WrTileJob *job, int k, int x, int y, int w, int h,
                          WrTileScratch *scratch)
{
    WrDepthTile tile = { .x = x,
                         .y = y,
                         .w = w,
                         .h = h,
                         .close = scratch->close,
                         .u = scratch->u,
                         .v = scratch->v,
                         .k = k,
                         .kernels = job->kernels };
    if (k > 1 && job->plan->spread == WR_SPREAD_JITTERED) tile_jitter(&tile, k, scratch->shift);
    if (job->mesh && !job->seen_before && !job->relight) {
        double start = wr_clock_seconds();
        wr_view_mesh_raster(job->mesh, job->view, &tile);
        wr_did(scratch, WR_EFFECT_DEPTH);
        scratch->whole[WR_STAGE_VISIBILITY] += wr_clock_seconds() - start;
    }
    if (job->triangles && !job->relight) {
        double start = wr_clock_seconds();
        wr_view_triangles_raster(job->triangles, job->view, &tile);
        wr_did(scratch, WR_EFFECT_DEPTH);
        if (wr_plan_runs(job->plan, WR_EFFECT_BLOCKS)) wr_did(scratch, WR_EFFECT_BLOCKS);
        scratch->whole[WR_STAGE_VISIBILITY] += wr_clock_seconds() - start;
    }
    return tile;
}

static WrSampleColour load(const float *from)
{
    WrSampleColour sample;
    memcpy(&sample, from, sizeof sample);
    return sample;
}

static void store(float *to, WrSampleColour sample)
{
    memcpy(to, &sample, sizeof sample);
}

/* Adds the K samples of each pixel of a row in pairs: x0+x1, x2+x3, ... until one is left, so that the sum of K
   = 2^m equal values is exact (HC92). */
static void fold_row(float *row, int pixels, int samples)
{
    if (samples == 4) {
        for (int p = 0; p < pixels; p++) {
            const float *in = row + 16 * p;
            store(row + 4 * p, (load(in) + load(in + 4)) + (load(in + 8) + load(in + 12)));
        }
        return;
    }
    for (int k = samples; k > 1; k = (k + 1) / 2) {
        const int half = (k + 1) / 2;
        for (int p = 0; p < pixels; p++) {
            const float *in = row + 4 * p * k;
            float *out = row + 4 * p * half;
            for (int j = 0; j < k / 2; j++)
                store(out + 4 * j, load(in + 8 * j) + load(in + 8 * j + 4));
            if (k & 1) store(out + 4 * (half - 1), load(in + 4 * (k - 1)));
        }
    }
}

/* Adds k rows of samples of `pixels` neighbouring pixels into the first row.
   First across each row, then rows in pairs. The order is fixed by k alone, so a pixel's bits do not depend on
   its tile. */
static void fold(float *sample, int pixels, int k, size_t step)
{
    for (int y = 0; y < k; y++) fold_row(sample + (size_t)y * step, pixels, k);
    for (int gap = 1; gap < k; gap *= 2)
        for (int y = 0; y + gap < k; y += 2 * gap) {
            float *restrict to = sample + (size_t)y * step;
            const float *restrict from = to + (size_t)gap * step;
#pragma omp simd
            for (int i = 0; i < 4 * pixels; i++) to[i] += from[i];
        }
}

void wr_tile_mean(float *sample, int k, size_t step, float out[4])
{
    const float share = 1.0f / (float)(k * k);
    fold(sample, 1, k, step);
    for (int c = 0; c < 4; c++) out[c] = sample[c] * share;
}

static int tile_means(int k, int width, float *sample, size_t step, float *pixel)
{
    const float share = 1.0f / (float)(k * k);
    int covered = 0;
    fold(sample, width, k, step);
#pragma omp simd
    for (int i = 0; i < 4 * width; i++) pixel[i] = sample[i] * share;
    for (int p = 0; p < width; p++) covered += pixel[4 * p + 3] > 0.0f;
    return covered;
}

static uint32_t *code_at(const WrTileJob *job, int x, int y)
{
    return job->codes + wr_tile_place(job, x, y);
}

static WrSink row_sink(const WrTileRows *rows, int y)
{
    const size_t row = (size_t)y, samples = row * rows->wide;
    return (WrSink){ .rgba = rows->rgba ? rows->rgba + row * rows->rgba_step : NULL,
                     .normals = rows->normals ? rows->normals + 3 * samples : NULL,
                     .codes = rows->codes ? rows->codes + row * rows->codes_step : NULL,
                     .nearest = rows->nearest ? rows->nearest + row * rows->nearest_step : NULL };
}

/* Copies a finished row of codes, opaque. Alpha marked pixels not yet covered. */
static void put_codes(const uint32_t *restrict from, int count, uint32_t *restrict to)
{
#pragma omp simd
    for (int x = 0; x < count; x++) to[x] = from[x] | 0xff000000U;
}

/* Background codes of `count` pixels from (x, y) on; mask 0xffffff sets their alpha to 0. */
static void fill_codes(const WrTileJob *job, int x, int y, int count, uint32_t mask,
                       uint32_t *restrict to)
{
    const WrBehind *behind = wr_tile_behind(job, x, y);
    if (job->backdrop->across) {
        for (int i = 0; i < count; i++) to[i] = behind[i].code & mask;
        return;
    }
    const uint32_t code = behind->code & mask;
#pragma omp simd
    for (int i = 0; i < count; i++) to[i] = code;
}

/* `from` and `to` are the covered interval of the strip: background codes are written beside it, and each code
   is written once. */
void wr_tile_behind_strip(const WrTileJob *job, const WrSink *sink, int from, int to,
                          WrTileScratch *scratch)
{
    const uint32_t opaque = 0xffffffffU;
    fill_codes(job, sink->x, sink->y, from, opaque, sink->codes);
    fill_codes(job, sink->x + to, sink->y, sink->wide - to, opaque, sink->codes + to);
    scratch->behind = true;
}

/* Several short rows stored one after the other.
   Strips are WR_SPAN long; rows of a narrow tile would leave most of a vector's lanes empty, so several rows
   are joined. */
typedef struct Packed {
    float rgba[WR_SPAN][4], normals[WR_SPAN][3];
    uint32_t codes[WR_SPAN];
    WrNearest nearest[WR_SPAN];
} Packed;

/* One float output of samples: its packed copy and its destination. */
typedef struct Plane {
    float *packed, *to; /* to NULL: not requested */
    size_t each, step;  /* floats a sample, and floats a row of `to` */
} Plane;
#define PLANES 2

static void find_planes(const WrTileRows *out, Packed *packed, Plane planes[PLANES])
{
    planes[0] = (Plane){ packed->rgba[0], out->rgba, 4, out->rgba_step };
    planes[1] = (Plane){ packed->normals[0], out->normals, 3, 3 * out->wide };
}

/* Loads zeros, or the samples that other objects have left there. */
static void update_packed(const WrTileRows *out, int top, int rows, int width, Packed *packed,
                          const Plane planes[PLANES])
{
    const size_t w = (size_t)width, from = (size_t)top;
    for (int i = 0; i < PLANES; i++) {
        const Plane *p = &planes[i];
        const size_t row = w * p->each;
        if (p->to && !out->over) memset(p->packed, 0, (size_t)rows * row * sizeof(float));
        for (size_t y = 0; y < (size_t)rows && p->to && out->over; y++)
            memcpy(p->packed + y * row, p->to + (from + y) * p->step, row * sizeof(float));
    }
    for (size_t y = 0; y < (size_t)rows && out->nearest; y++)
        memcpy(packed->nearest + y * w, out->nearest + (from + y) * out->nearest_step,
               w * sizeof *packed->nearest);
}

/* Stores the packed rows at their destinations. */
static void put_packed(const WrTileRows *out, int top, int rows, int width, const Packed *packed,
                       const Plane planes[PLANES])
{
    const size_t w = (size_t)width, to = (size_t)top;
    for (int i = 0; i < PLANES; i++) {
        const Plane *p = &planes[i];
        const size_t row = w * p->each;
        for (size_t y = 0; y < (size_t)rows && p->to; y++)
            memcpy(p->to + (to + y) * p->step, p->packed + y * row, row * sizeof(float));
    }
    for (size_t y = 0; y < (size_t)rows; y++) {
        if (out->codes)
            put_codes(packed->codes + y * w, width, out->codes + (to + y) * out->codes_step);
        if (out->nearest)
            memcpy(out->nearest + (to + y) * out->nearest_step, packed->nearest + y * w,
                   w * sizeof *packed->nearest);
    }
}

/* Loads the background of the rows, with alpha 0 while no object covers them. */
static void fill_packed(const WrTileJob *job, const WrDepthTile *tile, int top, int rows,
                        uint32_t *codes)
{
    for (int y = 0; y < rows; y++)
        fill_codes(job, tile->x, tile->y + top + y, tile->w, 0xffffffU, codes + y * tile->w);
}

/* Positions of the packed samples. */
static void place_packed(const WrDepthTile *tile, int top, int rows, WrScatter *places)
{
    places->count = 0;
    for (int i = 0; i < rows * tile->w; i++) {
        const int x = i % tile->w, y = top + i / tile->w;
        const signed char *shift = tile->shift ? tile->shift + 2 * (y * tile->w + x) : NULL;
        places->x[places->count] = tile->x + x + (shift ? shift[0] / 256.0 : 0);
        places->y[places->count] = tile->y + y + (shift ? shift[1] / 256.0 : 0);
        places->cell[places->count++] = y * tile->w + x;
    }
}

/* Draws several short rows in one strip. */
static void run_packed(const WrTileJob *job, int k, const WrDepthTile *tile, const WrTileRows *out,
                       WrTileScratch *scratch)
{
    const int many = WR_SPAN / tile->w;
    Packed packed;
    Plane planes[PLANES];
    find_planes(out, &packed, planes);
    for (int top = 0; top < tile->h; top += many) {
        const double start = wr_clock_seconds();
        const int rows = tile->h - top < many ? tile->h - top : many;
        place_packed(tile, top, rows, &scratch->scatter);
        update_packed(out, top, rows, tile->w, &packed, planes);
        if (out->codes) fill_packed(job, tile, top, rows, packed.codes);
        WrSink sink = { .rgba = out->rgba ? packed.rgba[0] : NULL,
                        .normals = out->normals ? packed.normals[0] : NULL,
                        .codes = out->codes ? packed.codes : NULL,
                        .nearest = out->nearest ? packed.nearest : NULL };
        const double ready = wr_clock_seconds();
        job->pipe->points(job, k, tile, &sink, scratch);
        const double done = wr_clock_seconds();
        scratch->all_strips += done - ready;
        put_packed(out, top, rows, tile->w, &packed, planes);
        scratch->whole[WR_STAGE_STORE] += wr_clock_seconds() - done + ready - start;
    }
}

/* once: a strip writes each code itself, without a copy; not with several objects or faces, which may cover a
   sample twice. */
static void tile_samples(const WrTileJob *job, int k, const WrDepthTile *tile,
                         const WrTileRows *out, WrTileScratch *scratch)
{
    if (tile->w <= WR_SPAN / 2 && tile->h > 1) {
        run_packed(job, k, tile, out, scratch);
        return;
    }
    const double start = wr_clock_seconds();
    uint32_t codes[WR_SPAN];
    for (int y = 0; y < tile->h; y++) {
        WrSink sink = row_sink(out, y);
        uint32_t *to = sink.codes;
        sink.once = to && !sink.nearest && job->view->quad_count < 2;
        sink.x = tile->x, sink.y = tile->y + y, sink.wide = tile->w;
        scratch->behind = !sink.once;
        if (to && !sink.once)
            fill_codes(job, tile->x, tile->y + y, tile->w, 0xffffffU, sink.codes = codes);
        job->pipe->row(job, k, tile, y, &sink, scratch);
        if (!scratch->behind) wr_tile_behind_strip(job, &sink, 0, 0, scratch);
        if (to && !sink.once) put_codes(codes, tile->w, to);
    }
    scratch->all_strips += wr_clock_seconds() - start;
}

/* Renders one sample a pixel, straight into the picture. light false: n' only. */
static void render_point(const WrTileJob *job, WrTilePart part, bool light, WrTileScratch *scratch)
{
    WrDepthTile tile = wr_tile_depth(job, 1, part.x, part.y, part.w, part.h, scratch);
    const size_t wide = (size_t)job->width;
    WrTileRows out = { .rgba_step = 4 * job->rgba_pitch, .wide = wide, .codes_step = wide };
    if (light && job->codes) out.codes = code_at(job, part.x, part.y);
    else if (light) out.rgba = wr_tile_pixel(job, part.x, part.y);
    if (job->normals) out.normals = job->normals + wr_tile_place(job, part.x, part.y) * 3;
    tile_samples(job, 1, &tile, &out, scratch);
}

/* Renders the mean of K x K samples. */
static void render_samples(const WrTileJob *job, WrTilePart part, WrTileScratch *scratch)
{
    const int k = job->samples, w = part.w * k, h = part.h * k;
    const size_t step = sizeof scratch->sample[0] / sizeof(float);
    WrDepthTile tile = wr_tile_depth(job, k, part.x * k, part.y * k, w, h, scratch);
    const int64_t covered = scratch->covered;
    const WrTileRows out = { .rgba = scratch->sample[0][0], .rgba_step = step };
    double start = wr_clock_seconds();
    for (int y = 0; y < h; y++) memset(scratch->sample[y], 0, (size_t)w * sizeof(float[4]));
    scratch->whole[WR_STAGE_CLEAR] += wr_clock_seconds() - start;
    tile_samples(job, k, &tile, &out, scratch);
    scratch->covered = covered; /* it counted samples */
    if (k > 1) wr_did(scratch, WR_EFFECT_SAMPLES);
    start = wr_clock_seconds();
    for (int y = 0; y < part.h; y++)
        scratch->covered += tile_means(k, part.w, scratch->sample[y * k][0], step,
                                       wr_tile_pixel(job, part.x, part.y + y));
    scratch->whole[WR_STAGE_RESOLVE] += wr_clock_seconds() - start;
}

/* Codes are written once: here only those beside `part`, the area that the object may cover. */
static void clear_codes(const WrTileJob *job, WrTilePart whole, WrTilePart part)
{
    const int left = part.x - whole.x, right = whole.x + whole.w - part.x - part.w;
    for (int y = whole.y; y < whole.y + whole.h; y++) {
        const bool beside = part.w <= 0 || y < part.y || y >= part.y + part.h;
        const int from = beside ? whole.w : left, rest = beside ? 0 : right;
        uint32_t *row = code_at(job, whole.x, y);
        fill_codes(job, whole.x, y, from, 0xffffffffU, row);
        fill_codes(job, whole.x + whole.w - rest, y, rest, 0xffffffffU, row + whole.w - rest);
    }
}

static void tile_clear(const WrTileJob *job, WrTilePart whole, WrTilePart part)
{
    if (job->codes) clear_codes(job, whole, part);
    for (int y = whole.y; y < whole.y + whole.h; y++) {
        if (!job->codes)
            memset(wr_tile_pixel(job, whole.x, y), 0, (size_t)whole.w * 4 * sizeof(float));
        if (job->normals)
            memset(job->normals + wr_tile_place(job, whole.x, y) * 3, 0,
                   (size_t)whole.w * 3 * sizeof(float));
    }
}

static void tile_start_map(const WrTileJob *job, WrTilePart whole, WrTileScratch *scratch)
{
    const int all = job->plan->sampling == WR_SAMPLING_ALL ? job->samples : 1;
    scratch->mapped = whole;
    for (int y = whole.y; y < whole.y + whole.h; y++)
        memset(job->map + wr_tile_place(job, whole.x, y),
               WR_MAP_RENDERED | wr_tile_encode_samples(all), (size_t)whole.w);
}

/* Clips the run at *from to the pixels from a to b, with one more at each end. */
static void crop(double a, double b, int *from, int *count)
{
    const int end = *from + *count;
    const double first = floor(a) - 1, last = floor(b) + 2;
    *from = first > *from ? (first < end ? (int)first : end) : *from;
    *count = (last < end ? (last > *from ? (int)last : *from) : end) - *from;
}

WrTilePart wr_tile_touched(const WrTileJob *job, WrTilePart part)
{
    const WrView *view = job->view;
    const int K = job->samples, x1 = part.x + part.w, y1 = part.y + part.h;
    const WrDepthTile tile = {
        .x = part.x * K - K, .y = part.y * K - K, .w = (part.w + 2) * K, .h = (part.h + 2) * K
    };
    if (job->mesh || job->triangles) {
        double box[4];
        if (!(job->mesh ? wr_view_mesh_box(job->mesh, view, &tile, box)
                        : wr_view_triangles_box(job->triangles, view, &tile, box)))
            return (WrTilePart){ 0, 0, 0, 0 };
        crop(box[0] / K, box[2] / K, &part.x, &part.w);
        crop(box[1] / K, box[3] / K, &part.y, &part.h);
        return part;
    }
    part.x = part.x > view->x0 ? part.x : view->x0;
    part.y = part.y > view->y0 ? part.y : view->y0;
    part.w = (x1 < view->x1 ? x1 : view->x1) - part.x;
    part.h = (y1 < view->y1 ? y1 : view->y1) - part.y;
    return part;
}

/* Renders several samples a pixel. */
static void render_many(const WrTileJob *job, WrTilePart part, WrTileScratch *scratch)
{
    if (job->plan->sampling != WR_SAMPLING_ADAPTIVE) render_samples(job, part, scratch);
    else wr_refine_tile(job, part.x, part.y, part.w, part.h, scratch);
}

static WrTileJob tile_apart(const WrTileJob *job, WrTilePart part, WrTileScratch *scratch)
{
    WrTileJob own = *job;
    own.rgba = scratch->mean[0];
    own.rgba_pitch = (size_t)part.w;
    own.x0 = part.x, own.y0 = part.y;
    memset(scratch->mean, 0, (size_t)part.w * (size_t)part.h * sizeof *scratch->mean);
    return own;
}

static void tile_code_row(const WrTileJob *job, int x, int y, int width, const float *rgba,
                          WrTileScratch *scratch)
{
    scratch->not_finite += wr_code_row(&job->coder, wr_tile_behind(job, x, y),
                                       job->backdrop->across, width, rgba, code_at(job, x, y));
}

static void tile_code(const WrTileJob *apart, WrTilePart part, WrTileScratch *scratch)
{
    const double start = wr_clock_seconds();
    for (int y = part.y; y < part.y + part.h; y++)
        tile_code_row(apart, part.x, y, part.w, wr_tile_pixel(apart, part.x, y), scratch);
    scratch->whole[WR_STAGE_RESOLVE] += wr_clock_seconds() - start;
}

/* Renders several samples a pixel to codes, by way of the tile's own floats. */
static void render_many_codes(const WrTileJob *job, WrTilePart part, WrTileScratch *scratch)
{
    const WrTileJob apart = tile_apart(job, part, scratch);
    render_many(&apart, part, scratch);
    tile_code(&apart, part, scratch);
}

/* Counts the tile if every run skipped work. `before`: sample counts before the tile.
   bits: a set of reasons to skip. A tile counts as spared for it if every run of samples was skipped for one
   of them. */
static void count_spared(WrTileScratch *scratch, const int64_t before[WR_RUN_KINDS])
{
    for (int bits = 1; bits < WR_RUN_KINDS; bits++) {
        bool all = true;
        for (int run = 0; run < WR_RUN_KINDS; run++)
            all &= (run & bits) != 0 || scratch->spared[run] == before[run];
        scratch->spared_tiles[bits] += all;
    }
}

/* n' is stored for one sample at the centre, also in pictures of many samples; that pass comes first. */
void wr_tile_render(const WrTileJob *job, WrTilePart whole, int index, WrTileScratch *scratch)
{
    const int64_t before = scratch->shaded;
    int64_t spared[WR_RUN_KINDS];
    memcpy(spared, scratch->spared, sizeof spared);
    const double start = wr_clock_seconds();
    scratch->notes = wr_dirty_open(job->seen, index, whole.x, whole.y);
    const bool beside = wr_plan_runs(job->plan, WR_EFFECT_BESIDE);
    if (beside) wr_did(scratch, WR_EFFECT_BESIDE);
    const WrTilePart part = beside ? whole : wr_tile_touched(job, whole);
    if (job->map) tile_start_map(job, whole, scratch);
    tile_clear(job, whole, part);
    scratch->whole[WR_STAGE_CLEAR] += wr_clock_seconds() - start;
    if (part.w > 0 && part.h > 0) {
        const bool one = job->plan->sampling == WR_SAMPLING_ONE && !job->view->endless;
        if (one || job->normals) render_point(job, part, one, scratch);
        if (!one && job->codes) render_many_codes(job, part, scratch);
        else if (!one) render_many(job, part, scratch);
    }
    wr_dirty_close(job->seen, index);
    scratch->tiles += scratch->shaded > before;
    if (scratch->shaded > before) count_spared(scratch, spared);
}

bool wr_tile_pick(const WrTileJob *job, int gx, int gy, WrTileScratch *scratch, double *u,
                  double *v, int *face)
{
    return job->pipe->pick(job, gx, gy, scratch, u, v, face);
}
