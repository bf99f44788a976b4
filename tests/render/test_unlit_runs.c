/* Runs of samples facing away from all lights skip lighting and bump: the picture is bit-identical to the full
   computation, on every surface, number of threads and instruction set. */
#include "test.h"
#include "field/scheme_list.h"
#include "render_scenes.h"

#include "image/image.h"
#include "render/kernels/kern.h"

static const char *const surfaces[] = { "sphere", "plane",  "cube", "torus",
                                        "cone",   "bezier", "curl", "cylinder" };
#define SURFACES ((int)(sizeof surfaces / sizeof *surfaces))

static double between(TestRandom *random, double a, double b)
{
    return a + (b - a) * test_random(random);
}

/* Smooth except for single texels, also beside tile borders and at the table's ends. */
static WrField *some_field(TestRandom *random)
{
    const int w = 64 + (int)(200 * test_random(random)), h = 64 + (int)(150 * test_random(random));
    const WrWrap wrap = test_random(random) < 0.6 ? WR_WRAP_PERIODIC : WR_WRAP_CLAMP;
    WrField *field = wr_field_new(w, h, wrap, wrap, 0.25f, NULL);
    const double waves = test_random(random) < 0.6 ? between(random, 0, 0.2) : 0;
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++)
            wr_field_set(field, i, j,
                         (float)(waves * sin(2 * WR_PI * (3.0 * i / w + 2.0 * j / h))));
    for (int k = (int)(4 * test_random(random)); k > 0; k--) {
        const bool edge = test_random(random) < 0.5;
        int i = (int)(w * test_random(random)), j = (int)(h * test_random(random));
        if (edge) i = i / WR_TILE * WR_TILE - (int)(2 * test_random(random));
        if (edge) j = j / WR_TILE * WR_TILE - (int)(2 * test_random(random));
        wr_field_set(field, (i + w) % w, (j + h) % h, (float)between(random, -2, 2));
    }
    return field;
}

static WrLight some_light(TestRandom *random)
{
    WrLight light = { .kind = test_random(random) < 0.6 ? WR_LIGHT_DIRECTIONAL : WR_LIGHT_POINT,
                      .colour = { 1, 0.8, 0.5 },
                      .strength = between(random, 0.2, 2) };
    const double far = light.kind == WR_LIGHT_POINT ? between(random, 0.2, 4) : 1;
    light.where = (WrVec3){ far * between(random, -1, 1), far * between(random, -1, 1),
                            far * between(random, -1.5, 0.5) };
    return light;
}

static void some_image(WrScene *scene)
{
    WrImage *image = wr_image_new(8, 8, 3, NULL);
    for (int i = 0; i < 8 * 8 * 3; i++) image->data[i] = (float)(i % 7) / 7;
    scene->colour = image;
}

static WrScene *some_scene(TestRandom *random)
{
    static const double heights[] = { 0, 0.001, 0.01, 0.1 };
    WrScene *scene = scene_of(surfaces[(int)(SURFACES * test_random(random))]);
    scene->replicate_u = (int)between(random, -2, 4);
    scene->replicate_v = (int)between(random, 1, 4);
    scene->scheme = test_random(random) < 0.6 ? WR_SCHEME_CENTRAL : WR_SCHEME_NEAREST;
    scene->height = heights[(int)(4 * test_random(random))] * between(random, -1, 1);
    scene->camera.orthographic = test_random(random) < 0.5;
    scene->light_count = test_random(random) < 0.6 ? 1 : 3;
    wr_free(scene->lights);
    scene->lights = wr_alloc((size_t)scene->light_count, sizeof *scene->lights);
    for (int i = 0; i < scene->light_count; i++) scene->lights[i] = some_light(random);
    scene->dials.aa = test_random(random) < 0.6   ? WR_AA_POINT
                      : test_random(random) < 0.5 ? WR_AA_SUPERSAMPLE
                                                  : WR_AA_ADAPTIVE;
    scene->dials.samples = 3;
    if (test_random(random) < 0.2) some_image(scene);
    if (test_random(random) < 0.1) scene->dials.shading = WR_SHADING_DOUBLE;
    return scene;
}

static const char *some_isa(TestRandom *random)
{
    static const char *const names[] = { "ref", "v1", "v2", "v3", "v4" };
    const char *name = names[(int)(5 * test_random(random))];
    return wr_kernels_get(name, false, NULL) ? name : "auto";
}

static void the_dark_side_has_the_bits_of_all_of_it(void **state)
{
    static const int threads[] = { 1, 2, 7 };
    TestRandom random = { 77 };
    int spared = 0, bumped = 0;
    (void)state;
    const int rounds = getenv("WR_FULL") ? 4000 : 400;
    for (int k = 0; k < rounds; k++) {
        WrField *field = some_field(&random);
        WrScene *scene = some_scene(&random);
        const int size = 24 + (int)(50 * test_random(&random));
        Shot planned =
            shoot(scene, field, 2 * size, size, threads[k % 3], some_isa(&random), false);
        Shot full = shoot(scene, field, 2 * size, size, 1, some_isa(&random), true);
        const WrPlanRow *light = &planned.frame.plan->rows[WR_EFFECT_DIFFUSE];
        const WrPlanRow *bump = &planned.frame.plan->rows[WR_EFFECT_BUMP];
        if (!same_picture(&planned, &full))
            fail_msg("scene %d: off by %g", k, (double)worst_difference(&planned, &full));
        assert_int_equal(full.frame.plan->rows[WR_EFFECT_DIFFUSE].pixels, full.frame.shaded);
        assert_in_range(light->pixels, 0, planned.frame.shaded);
        spared += light->pixels < planned.frame.shaded;
        bumped += bump->run && light->pixels < planned.frame.shaded &&
                  bump->pixels < planned.frame.shaded;
        put_away(&planned);
        put_away(&full);
        wr_scene_free(scene);
        wr_field_free(field);
    }
    assert_in_range(spared, rounds / 5, rounds); /* otherwise nothing was tested */
    assert_in_range(bumped, rounds / 20, rounds);
}

/* A plane seen from the front with the light slightly behind: dark except where one texel faces the light. */
static void one_texel_brings_the_light_back(void **state)
{
    static const int where[][2] = { { 0, 0 },   { 255, 255 }, { 63, 64 }, { 64, 63 },
                                    { 0, 200 }, { 130, 255 }, { 140, 40 } };
    (void)state;
    WrField *field = wr_field_new(256, 256, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    WrScene *scene = scene_of("plane");
    scene->replicate_u = scene->replicate_v = 1;
    scene->material.ambient = 0;
    scene->lights[0] = (WrLight){ .where = { 1, 0.4, -0.4 }, .colour = { 1, 1, 1 }, .strength = 1 };
    scene->posed = true;
    for (size_t k = 0; k <= sizeof where / sizeof *where; k++) {
        const bool any = k < sizeof where / sizeof *where;
        if (any) wr_field_set(field, where[k][0], where[k][1], 1);
        Shot planned = shoot(scene, field, 400, 400, 2, "auto", false);
        Shot full = shoot(scene, field, 400, 400, 2, "auto", true);
        const WrPlanRow *light = &planned.frame.plan->rows[WR_EFFECT_DIFFUSE];
        float brightest = 0;
        for (int i = 0; i < 400 * 400; i++) brightest = fmaxf(brightest, planned.frame.rgba[4 * i]);
        assert_true(same_picture(&planned, &full));
        assert_true((brightest > 0) == any);
        if (light->pixels >= planned.frame.shaded || (light->pixels > 0) != any)
            fail_msg("texel %zu: light on %lld of %lld samples", k, (long long)light->pixels,
                     (long long)planned.frame.shaded);
        put_away(&planned);
        put_away(&full);
        if (any) wr_field_set(field, where[k][0], where[k][1], 0);
    }
    wr_scene_free(scene);
    wr_field_free(field);
}

/* A bar across the table, with slopes along one parameter, causes the only light. */
static void slopes_along_either_parameter_count(void **state)
{
    (void)state;
    for (int along = 0; along < 2; along++) {
        WrField *field = wr_field_new(256, 256, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
        WrScene *scene = scene_of("plane");
        for (int i = 0; i < 256 * 12; i++) {
            const int across = i % 256, at = 100 + i / 256;
            wr_field_set(field, along ? across : at, along ? at : across, 1);
        }
        scene->replicate_u = scene->replicate_v = 1;
        scene->posed = true;
        scene->lights[0] = (WrLight){ .colour = { 1, 1, 1 }, .strength = 1 };
        scene->lights[0].where =
            along ? (WrVec3){ 0, 1, -0.3 } : (WrVec3){ 0.9659, 0, -0.2588 - 0.3 };
        Shot planned = shoot(scene, field, 200, 200, 2, "auto", false);
        Shot full = shoot(scene, field, 200, 200, 2, "auto", true);
        float brightest = 0;
        for (int i = 0; i < 200 * 200; i++) brightest = fmaxf(brightest, full.frame.rgba[4 * i]);
        assert_true(brightest > 0.2f);
        assert_true(same_picture(&planned, &full));
        assert_in_range(planned.frame.plan->rows[WR_EFFECT_DIFFUSE].pixels, 1,
                        planned.frame.shaded);
        put_away(&planned);
        put_away(&full);
        wr_scene_free(scene);
        wr_field_free(field);
    }
}

/* Fast arithmetic bends a sphere's normals without tangents, which this test needs: the same number of samples is
   skipped, and data of earlier pictures is cleared. */
static void fast_arithmetic_spares_as_much(void **state)
{
    (void)state;
    WrError err = { "" };
    WrField *field = bumpy_field(64, 64);
    WrScene *scene = scene_of("sphere"), *other = scene_of("sphere");
    scene->height = 0.01;
    scene->lights[0] =
        (WrLight){ .where = { 0.5, 0.2, -0.9 }, .colour = { 1, 0.9, 0.8 }, .strength = 1 };
    other->height = 0.003;
    WrRenderer *renderer = wr_renderer_new(NULL, "auto", &err);
    Shot exact = shoot(scene, field, 150, 150, 1, "auto", false);
    scene->dials.arithmetic = WR_ARITHMETIC_FAST;
    for (int shine = 5; shine < 60; shine += 40) { /* separate stages; fused kernels */
        scene->material.shininess = shine;
        Shot fast = shoot(scene, field, 150, 150, 1, "auto", false);
        WrFrame frame;
        WrFrameRequest request = { .field = field, .scene = other, .width = 150, .height = 150 };
        const int64_t lit = fast.frame.plan->rows[WR_EFFECT_BUMP].pixels;
        const int64_t want = exact.frame.plan->rows[WR_EFFECT_BUMP].pixels;
        assert_in_range(want, exact.frame.shaded / 4, exact.frame.shaded * 9 / 10);
        assert_in_range(lit, want * 98 / 100, want * 102 / 100);
        for (int turn = 0; turn < 3; turn++) {
            request.turn_deg = 40 * turn;
            if (!wr_renderer_frame(renderer, &request, &frame, &err)) fail_msg("%s", err.text);
        }
        request.scene = scene;
        request.turn_deg = 15;
        if (!wr_renderer_frame(renderer, &request, &frame, &err)) fail_msg("%s", err.text);
        assert_memory_equal(frame.rgba, fast.frame.rgba, 150 * 150 * 4 * sizeof(float));
        put_away(&fast);
    }
    put_away(&exact);
    wr_renderer_free(renderer);
    wr_scene_free(scene);
    wr_scene_free(other);
    wr_field_free(field);
}

/* A static view: an edit may bring light to dark runs. */
static void edits_bring_the_light_back(void **state)
{
    TestRandom random = { 5 };
    WrError err = { "" };
    (void)state;
    for (int k = 0; k < 6; k++) {
        WrField *field = some_field(&random);
        WrScene *scene = some_scene(&random);
        WrPool *pool = wr_pool_new(2);
        WrRenderer *renderer = wr_renderer_new(pool, NULL, &err);
        for (int edit = 0; edit < 12; edit++) {
            WrFrame frame;
            const WrFrameRequest request = { .field = field,
                                             .scene = scene,
                                             .width = 90,
                                             .height = 60,
                                             .turn_deg = 15,
                                             .keep = true };
            if (!wr_renderer_frame(renderer, &request, &frame, &err)) fail_msg("%s", err.text);
            Shot fresh = shoot(scene, field, 90, 60, 1, "auto", true);
            if (memcmp(frame.rgba, fresh.frame.rgba, frame_bytes(&frame)) != 0)
                fail_msg("scene %d, after edit %d", k, edit);
            put_away(&fresh);
            WrField *next = wr_field_share(field);
            wr_field_set(next, (int)(wr_field_width(field) * test_random(&random)),
                         (int)(wr_field_height(field) * test_random(&random)),
                         (float)between(&random, -3, 3));
            wr_field_free(field);
            field = next;
        }
        free_view(renderer, pool, scene, field);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_dark_side_has_the_bits_of_all_of_it),
        cmocka_unit_test(one_texel_brings_the_light_back),
        cmocka_unit_test(slopes_along_either_parameter_count),
        cmocka_unit_test(edits_bring_the_light_back),
        cmocka_unit_test(fast_arithmetic_spares_as_much),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
