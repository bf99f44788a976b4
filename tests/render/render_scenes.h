/* render_scenes.h - scenes, their pictures and comparisons, for the renderer tests. Include after test.h. */
#pragma once
#include "base/error.h"
#include "field/field.h"
#include "field/wrap.h"
#include "scene/scene.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/pool.h"
#include "render/frame/frame.h"
#include "render/reference/reference.h"

static inline WrField *bumpy_field(int w, int h)
{
    WrField *field = wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++) {
            double u = (i + 0.5) / w, v = 1 - (j + 0.5) / h;
            wr_field_set(
                field, i, j,
                (float)(0.5 * sin(2 * WR_PI * (3 * u + 2 * v)) + 0.3 * cos(2 * WR_PI * 5 * v)));
        }
    return field;
}

/* Random mantissas; all rows differ. */
static inline WrField *random_field(int w, int h, uint64_t seed)
{
    TestRandom random = { seed };
    WrField *field = wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++) wr_field_set(field, i, j, (float)test_random(&random));
    return field;
}

static inline WrField *level_field(int w, int h, double value)
{
    return wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, (float)value, NULL);
}

static inline void look_from(WrScene *scene, double x, double y, double z)
{
    scene->camera.fit = false;
    scene->camera.eye = (WrVec3){ x, y, z };
}

/* The radius in pixels of a sphere of radius r seen from distance d in the middle of a picture of `side` pixels: its
   silhouette is where rays from the eye touch it, at r / sqrt(d^2 - r^2) from the axis at distance 1. */
static inline double seen_radius(const WrScene *scene, int side, double r, double d)
{
    const double f = 0.5 * side / tan(scene->camera.fov_deg * WR_PI / 360);
    return f * r / sqrt(d * d - r * r);
}

static inline WrScene *scene_of(const char *surface)
{
    WrScene *scene = wr_scene_new();
    wr_shape_default((WrSurfaceKind)wr_surface_find(surface), &scene->shape);
    scene->height = 0.02;
    scene->replicate_u = 3;
    scene->replicate_v = 2;
    return scene;
}

typedef struct Shot {
    WrPool *pool;
    WrRenderer *renderer;
    WrFrame frame;
} Shot;

static inline Shot shoot(const WrScene *scene, const WrField *field, int w, int h, int threads,
                         const char *isa, bool full)
{
    WrError err = { "" };
    Shot shot = { .pool = wr_pool_new(threads) };
    shot.renderer = wr_renderer_new(shot.pool, isa, &err);
    WrFrameRequest request = {
        .field = field, .scene = scene, .width = w, .height = h, .turn_deg = 15, .full = full
    };
    if (!shot.renderer || !wr_renderer_frame(shot.renderer, &request, &shot.frame, &err))
        fail_msg("%s", err.text);
    return shot;
}

static inline void put_away(Shot *shot)
{
    wr_renderer_free(shot->renderer);
    wr_pool_free(shot->pool);
}

/* Free everything that a test's own view consists of. */
static inline void free_view(WrRenderer *renderer, WrPool *pool, WrScene *scene, WrField *field)
{
    wr_renderer_free(renderer);
    wr_pool_free(pool);
    wr_scene_free(scene);
    wr_field_free(field);
}

static inline size_t frame_bytes(const WrFrame *frame)
{
    return (size_t)frame->width * (size_t)frame->height * 4 * sizeof(float);
}

static inline bool same_picture(const Shot *a, const Shot *b)
{
    return memcmp(a->frame.rgba, b->frame.rgba, frame_bytes(&a->frame)) == 0;
}

static inline float worst_difference(const Shot *a, const Shot *b)
{
    float worst = 0;
    for (size_t i = 0; i < frame_bytes(&a->frame) / sizeof(float); i++) {
        float d = fabsf(a->frame.rgba[i] - b->frame.rgba[i]);
        worst = d > worst ? d : worst;
    }
    return worst;
}

/* A static view after each of several edits of the table is bit-identical to a new picture (E29). */
static inline void expect_refreshed(const WrScene *scene, int which)
{
    WrField *field = random_field(300, 200, 4);
    Shot kept = shoot(scene, field, 140, 112, 2, "auto", false);
    const WrFrameRequest request = {
        .field = field, .scene = scene, .width = 140, .height = 112, .turn_deg = 15, .keep = true
    };
    assert_true(wr_renderer_frame(kept.renderer, &request, &kept.frame, NULL));
    TestRandom random = { 5 };
    for (int step = 0; step < 4; step++) {
        wr_field_set(field, (int)(300 * test_random(&random)), (int)(200 * test_random(&random)),
                     (float)(2 * test_random(&random)));
        assert_true(wr_renderer_frame(kept.renderer, &request, &kept.frame, NULL));
        Shot fresh = shoot(scene, field, 140, 112, 2, "auto", false);
        if (!same_picture(&kept, &fresh)) fail_msg("case %d, step %d", which, step);
        put_away(&fresh);
    }
    put_away(&kept);
    wr_field_free(field);
}

/* The reference's picture, one sample per pixel: R,G,B,A as floats. The caller frees it (wr_free). */
static inline float *true_picture(const WrScene *scene, const WrField *field, int w, int h)
{
    WrPool *pool = wr_pool_new(2);
    WrError err = { "" };
    WrReference want = { 0 };
    const WrReferenceRequest request = { .field = field,
                                         .scene = scene,
                                         .width = w,
                                         .height = h,
                                         .turn_deg = 15,
                                         .first = 1,
                                         .most = 1 };
    if (!wr_reference_render(&request, pool, &want, &err)) fail_msg("%s", err.text);
    float *rgba = wr_alloc((size_t)(w * h), 4 * sizeof *rgba);
    for (int k = 0; k < 4 * w * h; k++) rgba[k] = (float)want.rgba[k];
    wr_reference_fini(&want);
    wr_pool_free(pool);
    return rgba;
}
