/* 8-bit pictures: equal to those converted from the float picture, for any way of rendering; and the fused pass for a
   single light. */
#include "test.h"
#include "render_cases.h"

#include "render/kernels/kern.h"
#include "render/frame/pixel_encode.h"

/* ---- the codes themselves ---- */

/* By definition: the number of borders that a value has reached. */
static uint32_t counted(float x)
{
    uint32_t code = 0;
    while (code < 255 && x >= wr_srgb_borders[code + 1]) code++;
    return code;
}

static void expect_code(const uint32_t *bins, float x)
{
    const uint32_t got = wr_code_at(bins, wr_srgb_bin_position(x)), want = counted(x);
    if (got != want) fail_msg("%a: code %u, not %u", (double)x, got, want);
}

static void every_value_has_the_code_of_the_borders(void **state)
{
    (void)state;
    static uint32_t bins[WR_CODE_BINS + 1];
    TestRandom random = { 5 };
    wr_code_bins_fill(bins);
    for (int code = 0; code < 256; code++) {
        float below = wr_srgb_borders[code], above = below;
        for (int k = 0; k < 40; k++) {
            expect_code(bins, below);
            expect_code(bins, above);
            below = nextafterf(below, -1);
            above = nextafterf(above, 2);
        }
    }
    for (int k = 0; k < 200000; k++) {
        expect_code(bins, (float)test_random(&random));
        expect_code(bins, (float)(0.004 * test_random(&random)));
    }
    for (int i = 0; i <= WR_CODE_BINS; i++) {
        expect_code(bins, (float)i / WR_CODE_BINS);
        expect_code(bins, nextafterf((float)i / WR_CODE_BINS, 0));
    }
    static const float ends[] = { -1,         -0.0f, 1e-45f,   1e-30f,   1,
                                  1.0000001f, 3e38f, INFINITY, -INFINITY };
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) expect_code(bins, ends[i]);
    assert_int_equal(wr_code_at(bins, wr_srgb_bin_position(NAN)), 0);
}

/* ---- pictures ---- */

static const WrFrameCodes ways[] = {
    { .background.top = { 0, 0, 0 } },
    { .background.top = { 0.13, 0.4, 0.021 } },
    { .background = { WR_BACKGROUND_NONE, { 1, 0.7, 0.00012 }, { 0 } } },
    { .background = { WR_BACKGROUND_GRADIENT, { 0.02, 0.4, 1.7 }, { 0.9, 0.4, 0.00012 } } },
    { .background = { WR_BACKGROUND_GRADIENT, { 0.02, 0.4, 1.7 }, { 0.9, 0.4, 0.00012 } },
      .tone = { WR_TONE_SOFT, 1.37, NULL } },
    { .background.kind = WR_BACKGROUND_SURROUNDINGS },
    { .background.kind = WR_BACKGROUND_SURROUNDINGS, .tone.exposure = -0.71 },
};
#define WAYS ((int)(sizeof ways / sizeof *ways))

/* An environment for the modes that show it. */
static void update_sky(WrScene *scene)
{
    WrError err = { "" };
    wr_environment_set(&scene->environment, WR_ENVIRONMENT_MAP_SKY,
                       wr_environment_map_built(WR_ENVIRONMENT_MAP_SKY, &err), NULL, NULL);
    scene->environment.turn_deg = 33.3;
}

static WrFrameCodes way_for(int i, const WrScene *scene)
{
    WrFrameCodes way = ways[i];
    way.wanted = true;
    way.scene = scene;
    return way;
}

static void expect_codes(const WrFrame *frame, const uint8_t *bytes, const char *what)
{
    assert_null(frame->rgba);
    for (int i = 0; i < frame->width * frame->height; i++) {
        const uint32_t code = frame->codes[i];
        const uint8_t *b = bytes + 4 * (size_t)i;
        if (code != (0xff000000U | (uint32_t)b[2] << 16 | (uint32_t)b[1] << 8 | b[0]))
            fail_msg("%s: pixel %d,%d is %08x, not %02x%02x%02x", what, i % frame->width,
                     i / frame->width, code, b[2], b[1], b[0]);
    }
}

/* The float picture converted to codes. */
static uint8_t *bytes_of(const WrFrame *frame, const WrFrameCodes *how, int64_t *not_finite)
{
    uint8_t *bytes = wr_alloc((size_t)frame->width * (size_t)frame->height, 4);
    *not_finite = wr_frame_to_srgb8(frame, how, true, bytes, NULL);
    return bytes;
}

static void try_case(const Case *c, const WrField *field, WrField *edited, TestRandom *random,
                     const char *isa, bool fast)
{
    static const int threads[] = { 1, 2, 7 };
    WrError err = { "" };
    WrScene *scene = scene_for(c);
    WrFrame frame;
    scene->dials.arithmetic = fast ? WR_ARITHMETIC_FAST : WR_ARITHMETIC_EXACT;
    WrFrameRequest request = { .field = field,
                               .scene = scene,
                               .width = 41 + (int)(300 * test_random(random)),
                               .height = 37 + (int)(60 * test_random(random)),
                               .turn_deg = 25 };
    if (test_random(random) < 0.5) update_sky(scene);
    const WrFrameCodes way = way_for((int)(WAYS * test_random(random)), scene);
    WrPool *pool = wr_pool_new(threads[(int)(3 * test_random(random))]);
    WrRenderer *floats = wr_renderer_new(pool, isa, &err),
               *codes = wr_renderer_new(pool, isa, &err);
    for (int step = 0; step < 3; step++) { /* whole, whole again, and after an edit */
        int64_t not_finite = 0;
        char what[80];
        request.field = step == 2 ? edited : field;
        request.keep = true;
        request.codes.wanted = false;
        if (!wr_renderer_frame(floats, &request, &frame, &err)) fail_msg("%s", err.text);
        const int64_t covered = frame.covered;
        uint8_t *bytes = bytes_of(&frame, &way, &not_finite);
        request.codes = way;
        if (!wr_renderer_frame(codes, &request, &frame, &err)) fail_msg("%s", err.text);
        snprintf(what, sizeof what, "%s aa=%d %dx%d %s%s, step %d", c->surface, (int)c->aa,
                 request.width, request.height, isa, fast ? " fast" : "", step);
        expect_codes(&frame, bytes, what);
        assert_true(frame.covered == covered);
        assert_true(frame.not_finite == 0 && not_finite == 0);
        wr_free(bytes);
    }
    wr_renderer_free(floats);
    wr_renderer_free(codes);
    wr_pool_free(pool);
    wr_scene_free(scene);
}

static void codes_are_those_of_the_float_picture(void **state)
{
    (void)state;
    static const char *const sets[] = { "ref", "v1", "v2", "v3", "v4" };
    const bool full = getenv("WR_FULL");
    TestRandom random = { 3 };
    WrField *field = bumpy_field(61, 37), *edited = wr_field_share(field);
    for (int i = 20; i < 27; i++) wr_field_set(edited, i, 11, 0.7f);
    for (int s = 0; s < 5; s++)
        for (int i = 0; i < CASES; i++) {
            if (!wr_kernels_get(sets[s], false, NULL)) continue;
            if (!full && i % 5 != s) continue;
            try_case(&cases[i], field, edited, &random, sets[s], false);
            if (s >= 3) try_case(&cases[i], field, edited, &random, sets[s], true);
        }
    wr_field_free(field);
    wr_field_free(edited);
}

/* A renderer used for both alternately, and with another background. */
static void codes_and_floats_leave_each_other_alone(void **state)
{
    (void)state;
    WrError err = { "" };
    WrField *field = bumpy_field(61, 37);
    WrScene *scene = scene_of("sphere");
    WrRenderer *renderer = wr_renderer_new(NULL, NULL, &err);
    update_sky(scene);
    Shot fresh = shoot(scene, field, 301, 50, 1, "auto", false);
    for (int step = 0; step < 4 * WAYS; step++) {
        WrFrameCodes way = way_for(step / 2 % WAYS, scene);
        int64_t not_finite;
        WrFrame frame;
        WrFrameRequest request = {
            .field = field, .scene = scene, .width = 301, .height = 50, .turn_deg = 15, .keep = true
        };
        way.wanted = step % 4 != 3;
        request.codes = way;
        assert_true(wr_renderer_frame(renderer, &request, &frame, &err));
        uint8_t *bytes = bytes_of(&fresh.frame, &way, &not_finite);
        if (request.codes.wanted) expect_codes(&frame, bytes, "by turns");
        else assert_memory_equal(frame.rgba, fresh.frame.rgba, frame_bytes(&frame));
        wr_free(bytes);
    }
    wr_renderer_free(renderer);
    put_away(&fresh);
    wr_scene_free(scene);
    wr_field_free(field);
}

/* An environment background and the tone curve, by independent formulas: the ray of each pixel, rotated about y, and
   light in double precision. */
static void what_lies_behind_is_what_each_ray_meets(void **state)
{
    (void)state;
    WrError err = { "" };
    WrField *field = bumpy_field(11, 7);
    WrScene *scene = scene_of("sphere");
    WrPool *pool = wr_pool_new(3);
    WrRenderer *renderer = wr_renderer_new(pool, NULL, &err);
    enum { W = 67, H = 45 };
    update_sky(scene);
    scene->environment.strength = 0.83;
    scene->camera.fit = false;
    scene->camera.eye = (WrVec3){ 2.5, 0.4, 3.1 };
    scene->camera.target = (WrVec3){ 0.2, 0.1, -0.3 };
    scene->camera.fov_deg = 71;
    const double angle = 33.3 * M_PI / 180, half = tan(71 * M_PI / 360);
    const WrVec3 ahead =
        v3_unit(v3_sub(scene->camera.target, scene->camera.eye), (WrVec3){ 0, 0, 1 });
    const WrVec3 right = v3_unit(v3_cross(ahead, (WrVec3){ 0, 1, 0 }), (WrVec3){ 1, 0, 0 });
    const WrVec3 up = v3_cross(right, ahead);
    WrFrame frame;
    WrFrameRequest request = { .field = field, .scene = scene, .width = W, .height = H };
    request.codes = way_for(WAYS - 1, scene);
    request.codes.tone = (WrTone){ WR_TONE_SOFT, 0.6, NULL };
    int bare = 0;
    WrFrameRequest floats = request;
    floats.codes.wanted = false;
    assert_true(wr_renderer_frame(renderer, &floats, &frame, &err));
    bool covered[W * H];
    for (int i = 0; i < W * H; i++) covered[i] = frame.rgba[4 * i + 3] > 0;
    assert_true(wr_renderer_frame(renderer, &request, &frame, &err));
    for (int i = 0; i < W * H; i++) {
        const double x = (2.0 * (i % W + 0.5) / W - 1) * half * W / H;
        const double y = (1 - 2.0 * (i / W + 0.5) / H) * half;
        const WrVec3 d = v3_mad(v3_mad(ahead, right, x), up, y);
        /* the environment is rotated by `angle` about y, so the visible direction is rotated back */
        const WrVec3 back = { d.x * cos(angle) - d.z * sin(angle), d.y,
                              d.x * sin(angle) + d.z * cos(angle) };
        double rgb[3];
        if (covered[i]) continue;
        wr_environment_map_at(scene->environment.light, back, rgb);
        for (int c = 0; c < 3; c++) {
            const double light = 0.83 * rgb[c] * pow(2, 0.6);
            const double seen = light > 0.5 ? 1 - 1 / (4 * light) : light;
            const double code = 255 * (double)wr_srgb_encode((float)seen);
            assert_near((frame.codes[i] >> (16 - 8 * c)) & 255, code, 0.51);
        }
        bare++;
    }
    assert_true(bare > W * H / 4);
    wr_renderer_free(renderer);
    wr_pool_free(pool);
    wr_scene_free(scene);
    wr_field_free(field);
}

/* ---- one light in one pass ---- */

static void some_light(WrLight *light, TestRandom *random)
{
    light->kind = test_random(random) < 0.5 ? WR_LIGHT_POINT : WR_LIGHT_DIRECTIONAL;
    light->where = (WrVec3){ 4 * test_random(random) - 2, 3 * test_random(random),
                             1 + 2 * test_random(random) };
    light->colour = (WrVec3){ test_random(random), test_random(random), test_random(random) };
    light->strength = 0.5 + test_random(random);
}

/* A second light of almost zero intensity forces the stages for several lights. */
static void one_light_in_one_pass_has_the_bits_of_the_stages(void **state)
{
    (void)state;
    TestRandom random = { 8 };
    WrField *field = bumpy_field(61, 37);
    for (int k = 0; k < (getenv("WR_FULL") ? 400 : 60); k++) {
        WrScene *scene = scene_of(k % 3 == 0 ? "sphere" : k % 3 == 1 ? "torus" : "plane");
        scene->camera.orthographic = k & 1;
        scene->material.gate = k & 2;
        scene->material.ambient = test_random(&random);
        scene->material.specular = k % 5 ? test_random(&random) : 0;
        scene->material.diffuse = k % 7 ? test_random(&random) : 0;
        scene->material.shininess = 1 + 60 * test_random(&random);
        scene->material.colour =
            (WrVec3){ test_random(&random), test_random(&random), test_random(&random) };
        if (k & 8) scene->colour = spots();
        wr_free(scene->lights);
        scene->lights = wr_alloc(2, sizeof *scene->lights);
        scene->light_count = 1;
        some_light(&scene->lights[0], &random);
        Shot one = shoot(scene, field, 97, 61, 1, "auto", false);
        scene->lights[1] = scene->lights[0];
        scene->lights[1].strength = 1e-30;
        scene->light_count = 2;
        Shot two = shoot(scene, field, 97, 61, 1, "auto", false);
        const float off = worst_difference(&one, &two);
        if (!(off <= 1e-25f)) fail_msg("scene %d: off by %g", k, (double)off);
        put_away(&one);
        put_away(&two);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_value_has_the_code_of_the_borders),
        cmocka_unit_test(codes_are_those_of_the_float_picture),
        cmocka_unit_test(codes_and_floats_leave_each_other_alone),
        cmocka_unit_test(what_lies_behind_is_what_each_ray_meets),
        cmocka_unit_test(one_light_in_one_pass_has_the_bits_of_the_stages),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
