#include "render/tile.h"
#include "base/hash.h"
#include "render/frame.h"
#include "render/pipe.h"
#include "system/clock.h"

#include <string.h>

/* The largest power of two up to x. */
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

void wr_tile_jitter(WrDepthTile *tile, int k, signed char *shift)
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
                         .k = k };
    if (k > 1 && job->plan->spread == WR_SPREAD_JITTERED) wr_tile_jitter(&tile, k, scratch->shift);
    if (job->mesh) {
        double start = wr_clock_seconds();
        wr_view_mesh_raster(job->mesh, job->view, &tile);
        wr_did(scratch, WR_EFFECT_DEPTH);
        scratch->whole[WR_STAGE_VISIBILITY] += wr_clock_seconds() - start;
    }
    return tile;
}

/* Add the K samples of each pixel of a row in pairs: x0+x1, x2+x3, ... until one is left, so that the
   sum of K = 2^m equal values is exact (HC92). */
static void fold_row(float *row, int pixels, int samples)
{
    for (int k = samples; k > 1; k = (k + 1) / 2) {
        const int half = (k + 1) / 2;
        for (int p = 0; p < pixels; p++) {
            const float *in = row + 4 * p * k;
            float *out = row + 4 * p * half;
            for (int j = 0; j < k / 2; j++)
                for (int c = 0; c < 4; c++) out[4 * j + c] = in[8 * j + c] + in[8 * j + 4 + c];
            if (!(k & 1)) continue;
            for (int c = 0; c < 4; c++) out[4 * (half - 1) + c] = in[4 * (k - 1) + c];
        }
    }
}

/* The sums of `pixels` pixels beside each other into the first row. */
static void fold(float *sample, int pixels, int k, size_t step)
{
    for (int y = 0; y < k; y++) fold_row(sample + (size_t)y * step, pixels, k);
    for (int gap = 1; gap < k; gap *= 2)
        for (int y = 0; y + gap < k; y += 2 * gap)
            for (int i = 0; i < 4 * pixels; i++)
                sample[(size_t)y * step + (size_t)i] +=
                    sample[(size_t)(y + gap) * step + (size_t)i];
}

void wr_tile_mean(float *sample, int k, size_t step, float out[4])
{
    const float share = 1.0f / (float)(k * k);
    fold(sample, 1, k, step);
    for (int c = 0; c < 4; c++) out[c] = sample[c] * share;
}

static float *pixel_at(const WrTileJob *job, int x, int y)
{
    return job->rgba + wr_tile_place(job, x, y) * 4;
}

/* Where the rows of a tile go. */
typedef struct Rows {
    float *rgba, *normals;          /* of the first row; NULL: not wanted */
    size_t rgba_step, normals_step; /* floats a row */
} Rows;

/* Several short rows in one strip. */
static void run_packed(const WrTileJob *job, int k, const WrDepthTile *tile, const Rows *out,
                       WrTileScratch *scratch)
{
    WrScatter *places = &scratch->scatter;
    const int many = WR_SPAN / tile->w;
    float rgba[WR_SPAN][4], normals[WR_SPAN][3];
    for (int top = 0; top < tile->h; top += many) {
        const double start = wr_clock_seconds();
        const int rows = tile->h - top < many ? tile->h - top : many;
        places->count = 0;
        for (int i = 0; i < rows * tile->w; i++) {
            const int x = i % tile->w, y = top + i / tile->w;
            const signed char *shift = tile->shift ? tile->shift + 2 * (y * tile->w + x) : NULL;
            places->x[places->count] = tile->x + x + (shift ? shift[0] / 256.0 : 0);
            places->y[places->count] = tile->y + y + (shift ? shift[1] / 256.0 : 0);
            places->cell[places->count++] = y * tile->w + x;
        }
        memset(rgba, 0, sizeof rgba);
        memset(normals, 0, sizeof normals);
        WrSink sink = { .rgba = out->rgba ? rgba[0] : NULL,
                        .normals = out->normals ? normals[0] : NULL };
        const double packed = wr_clock_seconds();
        job->pipe->points(job, k, tile, &sink, scratch);
        const double ready = wr_clock_seconds();
        scratch->all_strips += ready - packed;
        for (int y = 0; y < rows; y++) {
            const size_t from = (size_t)(y * tile->w), w = (size_t)tile->w, to = (size_t)(top + y);
            if (out->rgba) memcpy(out->rgba + to * out->rgba_step, rgba[from], w * sizeof rgba[0]);
            if (out->normals)
                memcpy(out->normals + to * out->normals_step, normals[from], w * sizeof normals[0]);
        }
        scratch->whole[WR_STAGE_STORE] += wr_clock_seconds() - ready + packed - start;
    }
}

/* All samples of a tile. */
static void run_rows(const WrTileJob *job, int k, const WrDepthTile *tile, const Rows *out,
                     WrTileScratch *scratch)
{
    if (tile->w <= WR_SPAN / 2 && tile->h > 1) {
        run_packed(job, k, tile, out, scratch);
        return;
    }
    const double start = wr_clock_seconds();
    for (int y = 0; y < tile->h; y++) {
        WrSink sink = { .rgba = out->rgba ? out->rgba + (size_t)y * out->rgba_step : NULL,
                        .normals =
                            out->normals ? out->normals + (size_t)y * out->normals_step : NULL };
        job->pipe->row(job, k, tile, y, &sink, scratch);
    }
    scratch->all_strips += wr_clock_seconds() - start;
}

/* One sample a pixel, straight into the picture. rgba false: n' alone. */
static void render_point(const WrTileJob *job, WrTilePart part, bool rgba, WrTileScratch *scratch)
{
    WrDepthTile tile = wr_tile_depth(job, 1, part.x, part.y, part.w, part.h, scratch);
    const size_t wide = (size_t)job->width;
    Rows out = { .rgba = rgba ? pixel_at(job, part.x, part.y) : NULL,
                 .rgba_step = 4 * wide,
                 .normals_step = 3 * wide };
    if (job->normals) out.normals = job->normals + wr_tile_place(job, part.x, part.y) * 3;
    run_rows(job, 1, &tile, &out, scratch);
}

/* The mean of K x K. */
static void render_samples(const WrTileJob *job, WrTilePart part, WrTileScratch *scratch)
{
    const int k = job->samples, w = part.w * k, h = part.h * k;
    const size_t step = sizeof scratch->sample[0] / sizeof(float);
    WrDepthTile tile = wr_tile_depth(job, k, part.x * k, part.y * k, w, h, scratch);
    const int64_t covered = scratch->covered;
    const Rows out = { .rgba = scratch->sample[0][0], .rgba_step = step };
    double start = wr_clock_seconds();
    for (int y = 0; y < h; y++) memset(scratch->sample[y], 0, (size_t)w * sizeof(float[4]));
    scratch->whole[WR_STAGE_CLEAR] += wr_clock_seconds() - start;
    run_rows(job, k, &tile, &out, scratch);
    scratch->covered = covered; /* that was samples */
    wr_did(scratch, WR_EFFECT_SAMPLES);
    start = wr_clock_seconds();
    const float share = 1.0f / (float)(k * k);
    for (int y = 0; y < part.h; y++) {
        float *pixel = pixel_at(job, part.x, part.y + y);
        fold(scratch->sample[y * k][0], part.w, k, step);
        const float *folded = scratch->sample[y * k][0];
        for (int i = 0; i < 4 * part.w; i++) pixel[i] = folded[i] * share;
        for (int p = 0; p < part.w; p++) scratch->covered += pixel[4 * p + 3] > 0.0f;
    }
    scratch->whole[WR_STAGE_RESOLVE] += wr_clock_seconds() - start;
}

/* Nothing anywhere on the tile yet. */
static void clear(const WrTileJob *job, WrTilePart part)
{
    for (int y = part.y; y < part.y + part.h; y++) {
        memset(pixel_at(job, part.x, y), 0, (size_t)part.w * 4 * sizeof(float));
        if (job->normals)
            memset(job->normals + wr_tile_place(job, part.x, y) * 3, 0,
                   (size_t)part.w * 3 * sizeof(float));
    }
}

/* The part of it that the object may be on; w or h 0: none. */
static WrTilePart touched(const WrTileJob *job, WrTilePart part)
{
    const WrView *view = job->view;
    const int K = job->samples, x1 = part.x + part.w, y1 = part.y + part.h;
    const WrDepthTile tile = {
        .x = part.x * K - K, .y = part.y * K - K, .w = (part.w + 2) * K, .h = (part.h + 2) * K
    };
    if (job->mesh)
        return wr_view_mesh_touches(job->mesh, view, &tile) ? part : (WrTilePart){ 0, 0, 0, 0 };
    part.x = part.x > view->x0 ? part.x : view->x0;
    part.y = part.y > view->y0 ? part.y : view->y0;
    part.w = (x1 < view->x1 ? x1 : view->x1) - part.x;
    part.h = (y1 < view->y1 ? y1 : view->y1) - part.y;
    return part;
}

void wr_tile_render(const WrTileJob *job, WrTilePart part, int index, WrTileScratch *scratch)
{
    const int64_t before = scratch->shaded;
    const double start = wr_clock_seconds();
    scratch->seen = job->seen ? &job->seen[index] : NULL;
    clear(job, part);
    part = touched(job, part);
    scratch->whole[WR_STAGE_CLEAR] += wr_clock_seconds() - start;
    if (part.w <= 0 || part.h <= 0) return;
    const WrSampling how = job->plan->sampling;
    if (how == WR_SAMPLING_ONE) render_point(job, part, true, scratch);
    else if (job->normals) render_point(job, part, false, scratch);
    if (how == WR_SAMPLING_ALL) render_samples(job, part, scratch);
    if (how == WR_SAMPLING_ADAPTIVE) wr_refine_tile(job, part.x, part.y, part.w, part.h, scratch);
    scratch->tiles += scratch->shaded > before;
}

bool wr_tile_pick(const WrTileJob *job, int gx, int gy, WrTileScratch *scratch, double *u,
                  double *v, int *face)
{
    return job->pipe->pick(job, gx, gy, scratch, u, v, face);
}
