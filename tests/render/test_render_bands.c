/* Bands of a picture: divided anywhere, on any threads, they are bit-identical to the whole. */
#include "test.h"
#include "render_cases.h"
#include "render_scenes.h"

typedef struct Picture {
    float *rgba, *normals;
    uint32_t *codes; /* in the place of rgba; or NULL */
    int64_t covered;
} Picture;

/* Bands of some height, in some order. */
static void bands(const WrFrameRequest *whole, const Picture *expected, int threads, int step,
                  bool upwards, const char *what)
{
    WrError err = { "" };
    WrPool *pool = wr_pool_new(threads);
    WrRenderer *renderer = wr_renderer_new(pool, NULL, &err);
    const size_t width = (size_t)whole->width;
    float *normals = whole->normals ? wr_alloc((size_t)step * width * 3, sizeof *normals) : NULL;
    const int count = (whole->height + step - 1) / step;
    int64_t covered = 0;
    for (int i = 0; i < count; i++) {
        WrFrame frame;
        WrFrameRequest request = *whole;
        request.normals = normals;
        request.first = (upwards ? count - 1 - i : i) * step;
        request.rows = whole->height - request.first < step ? whole->height - request.first : step;
        if (!wr_renderer_frame(renderer, &request, &frame, &err)) fail_msg("%s", err.text);
        assert_int_equal(frame.width, whole->width);
        assert_int_equal(frame.height, request.rows);
        const size_t at = (size_t)request.first * width, n = (size_t)request.rows * width;
        covered += frame.covered;
        assert_true((frame.codes != NULL) == (expected->codes != NULL));
        if (frame.codes ? memcmp(frame.codes, expected->codes + at, n * sizeof *frame.codes) != 0
                        : memcmp(frame.rgba, expected->rgba + 4 * at, 4 * n * sizeof(float)) != 0)
            fail_msg("%s: rows %d..%d are other than the whole picture's, %d threads", what,
                     request.first, request.first + request.rows - 1, threads);
        if (normals && memcmp(normals, expected->normals + 3 * at, 3 * n * sizeof(float)) != 0)
            fail_msg("%s: normals of rows %d.., %d threads", what, request.first, threads);
    }
    if (covered != expected->covered) fail_msg("%s: %lld covered", what, (long long)covered);
    wr_free(normals);
    wr_renderer_free(renderer);
    wr_pool_free(pool);
}

typedef enum Kind { LIGHT, NORMALS, CODES, KINDS } Kind;

static void try_case(const Case *c, const WrField *field, TestRandom *random, Kind kind)
{
    static const int threads[] = { 1, 2, 7 };
    WrError err = { "" };
    char what[80];
    WrScene *scene = scene_for(c);
    const int width = 41 + (int)(60 * test_random(random));
    const int height = 37 + (int)(70 * test_random(random));
    snprintf(what, sizeof what, "%s aa=%d samples=%d, %dx%d%s", c->surface, (int)c->aa, c->samples,
             width, height,
             kind == NORMALS ? ", normals"
             : kind == CODES ? ", codes"
                             : "");
    const size_t pixels = (size_t)width * (size_t)height;
    Picture expected = { .normals = kind == NORMALS ? wr_alloc(pixels * 3, sizeof(float)) : NULL };
    const WrFrameRequest request = { .field = field,
                                     .scene = scene,
                                     .width = width,
                                     .height = height,
                                     .turn_deg = 25,
                                     .normals = expected.normals,
                                     .codes.wanted = kind == CODES,
                                     .codes.background.top = { 0.2, 0.1, 0.4 } };
    WrFrame frame;
    WrPool *pool = wr_pool_new(2);
    WrRenderer *renderer = wr_renderer_new(pool, NULL, &err);
    if (!wr_renderer_frame(renderer, &request, &frame, &err)) fail_msg("%s: %s", what, err.text);
    assert_true(frame.covered > 0);
    expected.rgba = frame.rgba;
    expected.codes = (uint32_t *)frame.codes;
    expected.covered = frame.covered;
    for (int k = 0; k < 3; k++) {
        const double share = k == 1 ? 1 : test_random(random), most = k ? height : 9;
        const int step = k == 1 ? height : 1 + (int)(most * share);
        bands(&request, &expected, threads[k], step, k == 2, what);
    }
    wr_free(expected.normals);
    wr_renderer_free(renderer);
    wr_pool_free(pool);
    wr_scene_free(scene);
}

static void bands_hold_the_bits_of_the_whole_picture(void **state)
{
    (void)state;
    TestRandom random = { 11 };
    WrField *field = bumpy_field(60, 40);
    for (int round = 0; round < (getenv("WR_FULL") ? 10 : 1); round++)
        for (int i = 0; i < CASES; i++)
            for (int kind = i % test_step(1, KINDS); kind < KINDS; kind += test_step(1, KINDS))
                try_case(&cases[i], field, &random, (Kind)kind);
    wr_field_free(field);
}

/* One renderer alternately used for bands and whole pictures, with and without `keep`. */
static void bands_and_whole_pictures_leave_each_other_alone(void **state)
{
    (void)state;
    WrError err = { "" };
    WrField *field = bumpy_field(60, 40);
    WrScene *scene = scene_of("torus");
    Shot fresh = shoot(scene, field, 70, 50, 1, "auto", false);
    WrRenderer *renderer = wr_renderer_new(NULL, NULL, &err);
    WrFrame frame;
    for (int step = 0; step < 12; step++) {
        WrFrameRequest request = { .field = field,
                                   .scene = scene,
                                   .width = 70,
                                   .height = 50,
                                   .turn_deg = 15,
                                   .keep = step % 4 < 3,
                                   .first = step % 3 == 1 ? 3 * step : 0,
                                   .rows = step % 3 == 1 ? 17 : 0 };
        assert_true(wr_renderer_frame(renderer, &request, &frame, &err));
        const size_t at = (size_t)request.first * 70 * 4;
        if (memcmp(frame.rgba, fresh.frame.rgba + at, frame_bytes(&frame)) != 0)
            fail_msg("step %d", step);
        if (!request.rows) assert_true(frame.covered == fresh.frame.covered);
    }
    wr_renderer_free(renderer);
    put_away(&fresh);
    wr_scene_free(scene);
    wr_field_free(field);
}

static void bands_outside_the_picture_are_refused(void **state)
{
    (void)state;
    static const int wrong[][2] = { { -1, 3 }, { 0, -1 }, { 48, 3 }, { 0, 51 }, { 2147483647, 1 } };
    WrError err = { "" };
    WrField *field = bumpy_field(8, 8);
    WrScene *scene = scene_of("plane");
    WrRenderer *renderer = wr_renderer_new(NULL, NULL, &err);
    WrFrame frame;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        const WrFrameRequest request = { .field = field,
                                         .scene = scene,
                                         .width = 70,
                                         .height = 50,
                                         .first = wrong[i][0],
                                         .rows = wrong[i][1] };
        assert_false(wr_renderer_frame(renderer, &request, &frame, &err));
        assert_non_null(strstr(err.text, "of a picture of 50"));
    }
    wr_renderer_free(renderer);
    wr_scene_free(scene);
    wr_field_free(field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bands_hold_the_bits_of_the_whole_picture),
        cmocka_unit_test(bands_and_whole_pictures_leave_each_other_alone),
        cmocka_unit_test(bands_outside_the_picture_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
