/* Dirty regions (E29): edits of the table in a static view. After each of 500 random edits, also at corners and edges
   of the table, every pixel is bit-identical to a new picture, for any surface, scheme, anti-aliasing method and kind
   of axis; unaffected parts are not rendered. */
#include "test.h"
#include "field/scheme_list.h"
#include "render_scenes.h"

#define SCENES 25
#define EDITS 20 /* of each */

static int below(TestRandom *random, int n)
{
    return (int)(n * test_random(random));
}

/* Not level, but with zero central differences: effects that depend on slopes find none. */
static WrField *chequered_field(TestRandom *random)
{
    const int w = 2 * (9 + below(random, 60)), h = 2 * (7 + below(random, 50));
    WrField *field = wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.3f, NULL);
    for (int j = 0; j < h; j++)
        for (int i = j % 2; i < w; i += 2) wr_field_set(field, i, j, 0.7f);
    return field;
}

static WrField *some_field(TestRandom *random)
{
    if (test_random(random) < 0.15) return chequered_field(random);
    const int w = 37 + below(random, 300), h = 29 + below(random, 200);
    const WrWrap wraps[] = { WR_WRAP_PERIODIC, WR_WRAP_CLAMP };
    WrField *field =
        wr_field_new(w, h, wraps[below(random, 2)], wraps[below(random, 2)], 0.5f, NULL);
    if (test_random(random) < 0.2) return field; /* a level table */
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++) wr_field_set(field, i, j, (float)test_random(random));
    return field;
}

/* Most cases have one sample per pixel on closed-form surfaces, as most views do. */
static WrScene *some_scene(TestRandom *random, int k)
{
    static const char *const surfaces[] = { "sphere", "plane", "torus", "cube", "cone", "bezier" };
    static const WrAntialias aa[] = { WR_AA_POINT,   WR_AA_POINT,    WR_AA_FILTER,
                                      WR_AA_MOMENTS, WR_AA_ADAPTIVE, WR_AA_SUPERSAMPLE };
    WrScene *scene = scene_of(surfaces[k % 6]);
    scene->dials.aa = aa[below(random, 6)];
    scene->dials.samples = 2 + below(random, 3);
    scene->dials.spread = test_random(random) < 0.5 ? WR_SPREAD_JITTERED : scene->dials.spread;
    scene->dials.footprint = test_random(random) < 0.5 ? WR_FOOTPRINT_ANISOTROPIC : 0;
    scene->scheme = (WrScheme)below(random, WR_SCHEME_COUNT);
    scene->bump = (WrBumpMode)(1 + below(random, 3));
    scene->replicate_u = 0.3 + 2 * test_random(random);
    scene->replicate_v = -0.3 - 2 * test_random(random);
    if (test_random(random) < 0.5) scene->replicate_u = scene->replicate_v = 1;
    scene->material.specular = test_random(random) < 0.5 ? 0 : 0.4;
    scene->camera.orthographic = test_random(random) < 0.3;
    return scene;
}

/* A small periodic table, smooth in places, so that horizon distances vary. */
static WrField *hiding_field(TestRandom *random)
{
    const int w = 21 + below(random, 60), h = 18 + below(random, 50);
    WrField *field = wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.5f, NULL);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++)
            wr_field_set(field, i, j, (float)(test_random(random) * (i > w / 2 ? 0.2 : 1)));
    return field;
}

/* Its relief casts shadows, or occludes the sky, or both. */
static WrScene *hiding_scene(TestRandom *random, int k)
{
    static const char *const surfaces[] = { "sphere", "plane", "torus", "bezier" };
    WrScene *scene = some_scene(random, k);
    wr_shape_default((WrSurfaceKind)wr_surface_find(surfaces[k % 4]), &scene->shape);
    scene->material.shadow = k % 3 != 1;
    scene->material.occlusion = k % 3 != 0;
    scene->dials.horizons = 4 + 4 * below(random, 3);
    scene->height = test_random(random) < 0.5 ? -scene->height : scene->height;
    return scene;
}

/* Change adjacent texels; every third time at a corner or an edge. */
static void edit(TestRandom *random, WrField *field, int step)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    const int most = test_random(random) < 0.3 ? 30 : 4;
    const int side_i = 1 + below(random, most), side_j = 1 + below(random, most);
    int i = below(random, w), j = below(random, h);
    if (step % 3 == 0) i = test_random(random) < 0.5 ? 0 : w - 1;
    if (step % 6 == 0) j = test_random(random) < 0.5 ? 0 : h - 1;
    const double low = 3 * test_random(random), more = test_random(random) < 0.3 ? 0 : 1;
    for (int y = 0; y < side_j; y++)
        for (int x = 0; x < side_i; x++)
            if (i + x < w && j + y < h)
                wr_field_set(field, i + x, j + y, (float)(low + more * test_random(random)));
}

typedef struct Drawn {
    int64_t kept, whole;
} Drawn;

static Drawn check_scene(TestRandom *random, int k, bool hides)
{
    WrField *field = hides ? hiding_field(random) : some_field(random);
    WrScene *scene = hides ? hiding_scene(random, k) : some_scene(random, k);
    WrPool *pool = wr_pool_new(1 + k % 3);
    WrRenderer *renderer = wr_renderer_new(pool, NULL, NULL);
    WrFrameRequest request = { .scene = scene,
                               .width = 60 + below(random, 240),
                               .height = 40 + below(random, 60),
                               .turn_deg = 360 * test_random(random),
                               .codes.wanted = test_random(random) < 0.5 };
    const size_t size = (size_t)request.width * (size_t)request.height;
    Drawn drawn = { 0 };
    const int edits = test_amount(EDITS, 7);
    for (int step = 0; step <= edits; step++) {
        WrFrame frame, fresh;
        WrError err = { "" };
        request.field = field;
        request.keep = true;
        if (!wr_renderer_frame(renderer, &request, &frame, &err)) fail_msg("%s", err.text);
        request.keep = false;
        WrRenderer *other = wr_renderer_new(pool, NULL, NULL); /* has no cached data */
        assert_true(wr_renderer_frame(other, &request, &fresh, &err));
        if (request.codes.wanted ? memcmp(frame.codes, fresh.codes, size * sizeof *frame.codes)
                                 : memcmp(frame.rgba, fresh.rgba, frame_bytes(&frame)))
            fail_msg("scene %d, edit %d: another picture", k, step);
        assert_int_equal(frame.covered, fresh.covered);
        wr_renderer_free(other);
        if (step > 0) drawn.kept += frame.shaded, drawn.whole += fresh.shaded;
        WrField *next = wr_field_share(field); /* the renderer caches the old one */
        edit(random, next, step);
        wr_field_free(field);
        field = next;
    }
    free_view(renderer, pool, scene, field);
    return drawn;
}

static void every_pixel_is_that_of_a_new_picture_after_any_edit(void **state)
{
    (void)state;
    TestRandom random = { 2906 };
    Drawn all = { 0 };
    for (int k = 0; k < SCENES; k++) {
        const Drawn one = check_scene(&random, k, false);
        all.kept += one.kept, all.whole += one.whole;
    }
    assert_in_range(all.kept, 1, all.whole / 3);
}

/* Shadows and occlusion extend beyond the edit as far as the horizon changed. */
static void shadows_are_those_of_a_new_picture_after_any_edit(void **state)
{
    (void)state;
    TestRandom random = { 471 };
    Drawn all = { 0 };
    for (int k = 0; k < 6; k++) {
        const Drawn one = check_scene(&random, k, true);
        all.kept += one.kept, all.whole += one.whole;
    }
    assert_in_range(all.kept, 1, all.whole * 9 / 10);
}

/* Effects skipped for a table without slopes run after the first slope. */
static void the_first_slope_is_seen(void **state)
{
    (void)state;
    TestRandom random = { 66 };
    WrField *field = chequered_field(&random);
    WrScene *scene = scene_of("plane");
    Shot kept = shoot(scene, field, 90, 70, 1, "auto", false);
    const WrFrameRequest request = {
        .field = field, .scene = scene, .width = 90, .height = 70, .turn_deg = 15, .keep = true
    };
    assert_true(wr_renderer_frame(kept.renderer, &request, &kept.frame, NULL));
    assert_false(wr_plan_runs(kept.frame.plan, WR_EFFECT_BUMP));
    wr_field_set(field, 5, 6, 1.7f);
    assert_true(wr_renderer_frame(kept.renderer, &request, &kept.frame, NULL));
    Shot fresh = shoot(scene, field, 90, 70, 1, "auto", false);
    assert_true(wr_plan_runs(fresh.frame.plan, WR_EFFECT_BUMP));
    assert_true(same_picture(&kept, &fresh));
    put_away(&fresh);
    put_away(&kept);
    wr_scene_free(scene);
    wr_field_free(field);
}

/* An edit of one texel costs a few patches of a sphere, and nothing if it is hidden. */
static void a_dab_costs_the_pixels_that_it_reaches(void **state)
{
    (void)state;
    WrField *field = random_field(512, 512, 7);
    WrScene *scene = scene_of("sphere");
    scene->replicate_u = scene->replicate_v = 1;
    WrPool *pool = wr_pool_new(1);
    WrRenderer *renderer = wr_renderer_new(pool, NULL, NULL);
    const WrFrameRequest request = {
        .field = field, .scene = scene, .width = 512, .height = 512, .keep = true
    };
    WrFrame frame;
    assert_true(wr_renderer_frame(renderer, &request, &frame, NULL));
    const int64_t whole = frame.shaded;
    int64_t drawn = 0;
    int unseen = 0;
    for (int step = 0; step < 64; step++) {
        wr_field_set(field, step % 8 * 64 + 31, step / 8 * 64 + 29, 2);
        assert_true(wr_renderer_frame(renderer, &request, &frame, NULL));
        drawn += frame.shaded;
        unseen += frame.shaded == 0;
        if (step / 8 != 0 && step / 8 != 7) /* near a pole a patch covers more of the edit */
            assert_in_range(frame.shaded, 0, whole / 80);
    }
    assert_in_range(unseen, 64 / 4, 64 * 3 / 4);
    assert_in_range(drawn, 1, whole / 2);
    free_view(renderer, pool, scene, field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_pixel_is_that_of_a_new_picture_after_any_edit),
        cmocka_unit_test(shadows_are_those_of_a_new_picture_after_any_edit),
        cmocka_unit_test(the_first_slope_is_seen),
        cmocka_unit_test(a_dab_costs_the_pixels_that_it_reaches),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
