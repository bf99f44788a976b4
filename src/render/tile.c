#include "render/tile.h"
#include "base/clock.h"

#include <float.h>
#include <string.h>

void wr_tile_size(int samples, int *tile_w, int *tile_h)
{
    *tile_w = WR_TILE_SAMPLES_W / samples;
    *tile_h = samples < 32 ? 32 / samples : 1;
}

/* Clock readings cost as much as a short stage, so one strip in eight is timed and counts for eight. */
#define TIMED 8

typedef struct Watch {
    WrTileScratch *scratch;
    bool on;
    double last;
} Watch;

static Watch watch_start(WrTileScratch *scratch)
{
    bool on = scratch->strips++ % TIMED == 0;
    return (Watch){ scratch, on, on ? wr_clock_seconds() : 0 };
}

static void watch_lap(Watch *watch, WrStage stage)
{
    if (!watch->on) return;
    double now = wr_clock_seconds();
    watch->scratch->seconds[stage] += TIMED * (now - watch->last);
    watch->last = now;
}

/* F as a formula: one point at a time, in double. */
static void look_analytic(const WrTileJob *job, WrStrip *strip)
{
    for (int i = 0; i < strip->count; i++) {
        double f, fu, fv;
        wr_scene_height(job->scene, NULL, (double)strip->u[i], (double)strip->v[i], &f, &fu, &fv);
        strip->f[i] = (float)(f * job->view->scale);
        strip->fu[i] = (float)(fu * job->view->scale);
        strip->fv[i] = (float)(fv * job->view->scale);
    }
}

static void light_strip(const WrTileJob *job, WrStrip *strip, Watch *watch)
{
    const WrKernels *k = job->kernels;
    const WrPlan *plan = job->plan;
    const WrMaterial *material = &job->scene->material;
    k->begin((float)material->ambient, strip);
    if (plan->colour) {
        k->colour(&job->colour, strip);
        watch_lap(watch, WR_STAGE_COLOUR);
    }
    if (plan->specular) k->view(&job->view->rays, strip);
    watch_lap(watch, plan->specular ? WR_STAGE_SPECULAR : WR_STAGE_DIFFUSE);
    if (!plan->diffuse && !plan->specular) return;
    for (int i = 0; i < job->view->light_count; i++) {
        const WrKernLight *light = &job->view->lights[i];
        k->light(light, strip);
        if (plan->diffuse) k->diffuse(light, (float)material->diffuse, strip);
        watch_lap(watch, WR_STAGE_DIFFUSE);
        if (!plan->specular) continue;
        k->specular(light, (float)material->specular, (float)material->shininess, material->gate,
                    strip);
        watch_lap(watch, WR_STAGE_SPECULAR);
    }
}

/* All stages of the plan from (u, v) to the colour. */
static void shade_strip(const WrTileJob *job, int face, WrStrip *strip, WrBlocks *seen,
                        Watch *watch)
{
    const WrKernels *k = job->kernels;
    const WrPlan *plan = job->plan;
    const WrSurfaceKind kind = job->scene->shape.kind;
    if (plan->diffuse || plan->specular) {
        k->geometry[kind](&job->view->shape, face, strip);
        watch_lap(watch, WR_STAGE_GEOMETRY);
        if (plan->curvature) {
            k->curvature[kind](&job->view->shape, face, strip);
            watch_lap(watch, WR_STAGE_CURVATURE);
        }
        if (plan->bump != WR_BUMP_NONE) {
            if (job->scene->analytic.kind != WR_ANALYTIC_OFF) look_analytic(job, strip);
            else k->look[job->scene->scheme](&job->look, strip);
            if (seen && job->scene->analytic.kind == WR_ANALYTIC_OFF) wr_keep_note(seen, strip);
            watch_lap(watch, WR_STAGE_LOOK);
        }
        k->bump[plan->bump](&job->view->rays, strip);
        watch_lap(watch, WR_STAGE_BUMP);
    }
    light_strip(job, strip, watch);
    const WrVec3 c = job->scene->material.colour;
    k->finish((const float[3]){ (float)c.x, (float)c.y, (float)c.z }, strip);
}

/* Finished strip -> its samples' places in row y: straight into the picture where a sample is a pixel. */
static void scatter(const WrTileJob *job, const WrDepthTile *tile, int y, WrTileScratch *scratch)
{
    const WrStrip *strip = &scratch->strip;
    if (job->samples == 1) {
        float *row = job->rgba + ((size_t)(tile->y + y) * (size_t)job->width + (size_t)tile->x) * 4;
        for (int i = 0; i < strip->count; i++) {
            float *out = row + 4 * strip->index[i];
            out[0] = strip->cr[i];
            out[1] = strip->cg[i];
            out[2] = strip->cb[i];
            scratch->covered += out[3] == 0.0f;
            out[3] = 1.0f;
        }
        return;
    }
    for (int i = 0; i < strip->count; i++) {
        int x = strip->index[i];
        scratch->plane[0][y][x] = strip->cr[i];
        scratch->plane[1][y][x] = strip->cg[i];
        scratch->plane[2][y][x] = strip->cb[i];
        scratch->plane[3][y][x] = 1.0f;
    }
}

static void finish_strip(const WrTileJob *job, const WrDepthTile *tile, int face, int y,
                         WrTileScratch *scratch, Watch *watch)
{
    WrStrip *strip = &scratch->strip;
    if (strip->count == 0) return;
    shade_strip(job, face, strip, scratch->seen, watch);
    scatter(job, tile, y, scratch);
    watch_lap(watch, WR_STAGE_RESOLVE);
    scratch->shaded += strip->count;
}

/* Samples of row y that the mesh covers, with their parameters made exact. */
static void locate_mesh(const WrTileJob *job, const WrDepthTile *tile, int y, WrStrip *strip,
                        Watch *watch)
{
    const size_t row = (size_t)y * (size_t)tile->w;
    const WrSurfaceInfo *info = wr_surfaces[job->scene->shape.kind];
    int count = 0;
    for (int x = 0; x < tile->w; x++) {
        if (tile->close[row + (size_t)x] == -FLT_MAX) continue;
        strip->index[count] = x;
        strip->u[count] = tile->u[row + (size_t)x];
        strip->v[count++] = tile->v[row + (size_t)x];
    }
    strip->count = count;
    watch_lap(watch, WR_STAGE_VISIBILITY);
    if (count == 0) return;
    /* Newton doubles the digits at each step; a coarse mesh starts with fewer. */
    const int steps = job->mesh->mu < 64 || job->mesh->mv < 64 ? 3 : 2;
    job->kernels->polish[job->scene->shape.kind](
        &job->view->rays, &job->view->shape, (float)tile->x, (float)(tile->y + y),
        1.0f / (float)job->mesh->mu, 1.0f / (float)job->mesh->mv, info->closed_u, info->closed_v,
        steps, strip);
    watch_lap(watch, WR_STAGE_NEWTON);
}

static WrHitKernel closed_form(const WrKernels *kernels, WrInversion inversion)
{
    switch (inversion) {
    case WR_INVERT_SPHERE: return kernels->hit_sphere;
    case WR_INVERT_CYLINDER: return kernels->hit_cylinder;
    case WR_INVERT_CONE: return kernels->hit_cone;
    default: return NULL;
    }
}

static void render_row(const WrTileJob *job, const WrDepthTile *tile, int y, WrTileScratch *scratch)
{
    const WrView *view = job->view;
    WrStrip *strip = &scratch->strip;
    Watch watch = watch_start(scratch);
    const float gx = (float)tile->x, gy = (float)(tile->y + y);
    if (job->mesh) {
        locate_mesh(job, tile, y, strip, &watch);
        finish_strip(job, tile, 0, y, scratch, &watch);
        return;
    }
    WrHitKernel hit = closed_form(job->kernels, wr_surfaces[job->scene->shape.kind]->inversion);
    if (hit) {
        hit(&view->rays, &view->shape, gx, gy, tile->w, strip);
        watch_lap(&watch, WR_STAGE_VISIBILITY);
        finish_strip(job, tile, 0, y, scratch, &watch);
        return;
    }
    for (int i = 0; i < view->quad_count; i++) {
        job->kernels->hit_quad(&view->rays, &view->quads[i], gx, gy, tile->w, strip);
        watch_lap(&watch, WR_STAGE_VISIBILITY);
        finish_strip(job, tile, view->quad_face[i], y, scratch, &watch);
    }
}

/* Add the K samples of each pixel of a row in pairs: x0+x1, x2+x3, ... until one is left, so that the
   sum of K = 2^m equal values is exact (HC92). */
static void fold_row(float *row, int pixels, int samples)
{
    for (int k = samples; k > 1; k = (k + 1) / 2) {
        const int half = (k + 1) / 2;
        for (int p = 0; p < pixels; p++) {
            const float *in = row + p * k;
            float *out = row + p * half;
            for (int j = 0; j < k / 2; j++) out[j] = in[2 * j] + in[2 * j + 1];
            if (k & 1) out[half - 1] = in[k - 1];
        }
    }
}

static void fold_tile(const WrDepthTile *tile, int samples, float plane[][WR_TILE_SAMPLES_W])
{
    const int pixels = tile->w / samples;
    for (int y = 0; y < tile->h; y++) fold_row(plane[y], pixels, samples);
    for (int top = 0; top < tile->h; top += samples)
        for (int step = 1; step < samples; step *= 2)
            for (int y = top; y + step < top + samples; y += 2 * step)
                for (int p = 0; p < pixels; p++) plane[y][p] += plane[y + step][p];
}

/* Nothing anywhere on the tile yet. */
static void clear(const WrTileJob *job, const WrDepthTile *tile, WrTileScratch *scratch)
{
    for (int y = 0; y < tile->h; y++) {
        if (job->samples > 1) {
            for (int c = 0; c < 4; c++)
                memset(scratch->plane[c][y], 0, (size_t)tile->w * sizeof(float));
        } else {
            size_t at = ((size_t)(tile->y + y) * (size_t)job->width + (size_t)tile->x) * 4;
            memset(job->rgba + at, 0, (size_t)tile->w * 4 * sizeof(float));
        }
    }
}

/* The mean of each pixel's samples. */
static void store_pixels(const WrTileJob *job, const WrDepthTile *tile, WrTileScratch *scratch)
{
    const int k = job->samples;
    const float share = 1.0f / (float)(k * k);
    if (k == 1) return;
    for (int c = 0; c < 4; c++) fold_tile(tile, k, scratch->plane[c]);
    for (int y = 0; y < tile->h / k; y++) {
        size_t at = ((size_t)(tile->y / k + y) * (size_t)job->width + (size_t)(tile->x / k)) * 4;
        float *out = job->rgba + at;
        for (int p = 0; p < tile->w / k; p++) {
            for (int c = 0; c < 4; c++) out[4 * p + c] = scratch->plane[c][y * k][p] * share;
            scratch->covered += out[4 * p + 3] > 0.0f;
        }
    }
}

static WrDepthTile depth_tile(const WrTileJob *job, int tile_x, int tile_y, WrTileScratch *scratch)
{
    int x = tile_x * job->tile_w, y = tile_y * job->tile_h, k = job->samples;
    int w = job->width - x < job->tile_w ? job->width - x : job->tile_w;
    int h = job->height - y < job->tile_h ? job->height - y : job->tile_h;
    return (WrDepthTile){ x * k, y * k, w * k, h * k, scratch->close, scratch->u, scratch->v };
}

void wr_tile_render(const WrTileJob *job, int tile_x, int tile_y, int index, WrTileScratch *scratch)
{
    WrDepthTile tile = depth_tile(job, tile_x, tile_y, scratch);
    const int64_t before = scratch->shaded;
    scratch->seen = job->seen ? &job->seen[index] : NULL;
    clear(job, &tile, scratch);
    if (!job->mesh || wr_view_mesh_touches(job->mesh, &tile)) {
        if (job->mesh) {
            double start = wr_clock_seconds();
            wr_view_mesh_raster(job->mesh, job->view, &tile);
            scratch->seconds[WR_STAGE_VISIBILITY] += wr_clock_seconds() - start;
        }
        for (int y = 0; y < tile.h; y++) render_row(job, &tile, y, scratch);
    }
    double start = wr_clock_seconds();
    store_pixels(job, &tile, scratch);
    scratch->seconds[WR_STAGE_RESOLVE] += wr_clock_seconds() - start;
    scratch->tiles += scratch->shaded > before;
}

bool wr_tile_pick(const WrTileJob *job, int gx, int gy, WrTileScratch *scratch, double *u,
                  double *v, int *face)
{
    WrDepthTile tile = { gx, gy, 1, 1, scratch->close, scratch->u, scratch->v };
    WrStrip *strip = &scratch->strip;
    Watch watch = { scratch, false, 0 };
    WrHitKernel hit = closed_form(job->kernels, wr_surfaces[job->scene->shape.kind]->inversion);
    strip->count = 0;
    *face = 0;
    if (job->mesh) {
        wr_view_mesh_raster(job->mesh, job->view, &tile);
        locate_mesh(job, &tile, 0, strip, &watch);
    } else if (hit) {
        hit(&job->view->rays, &job->view->shape, (float)gx, (float)gy, 1, strip);
    }
    for (int i = 0; !hit && i < job->view->quad_count && strip->count == 0; i++) {
        job->kernels->hit_quad(&job->view->rays, &job->view->quads[i], (float)gx, (float)gy, 1,
                               strip);
        *face = job->view->quad_face[i];
    }
    if (strip->count == 0) return false;
    *u = (double)strip->u[0];
    *v = (double)strip->v[0];
    return true;
}
