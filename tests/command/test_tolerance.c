/* Choice of dials by a tolerance: it holds on the whole picture, failures are reported, and the frame equals that of
   the chosen settings. */
#include "test.h"
#include "session_help.h"

#include "accuracy/metrics.h"
#include "accuracy/tolerance.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/text.h"
#include "command/session.h"
#include "render/frame/frame.h"
#include "scene/scene.h"

#include <stdlib.h>
#include <unistd.h>

#define SIDE 80
#define LARGE 224

typedef struct Bench {
    WrSession *session;
    WrRenderer *renderer;
    WrFrameRequest request;
    WrScene *scene; /* the session's, to set a tolerance */
} Bench;

static Bench bench_of(const char *const *lines)
{
    WrError err;
    Bench bench = { .session = session_of(lines), .renderer = wr_renderer_new(NULL, NULL, &err) };
    assert_non_null(bench.renderer);
    bench.scene = wr_scene_clone(doc(bench.session)->scene);
    bench.request = (WrFrameRequest){ .field = wr_document_composite(doc(bench.session), NULL),
                                      .scene = bench.scene,
                                      .width = SIDE,
                                      .height = SIDE };
    return bench;
}

static void bench_fini(Bench *bench)
{
    wr_renderer_free(bench->renderer);
    wr_scene_free(bench->scene);
    wr_session_free(bench->session);
}

static WrChoice choose(Bench *bench, WrToleranceKind kind, double value)
{
    WrError err;
    WrFrame frame;
    WrChoice choice = { 0 };
    bench->scene->tolerance = (WrTolerance){ kind, value };
    if (!wr_tolerance_choose(bench->renderer, &bench->request, &choice, &frame, &err))
        fail_msg("%s", err.text);
    return choice;
}

static WrFrame frame_of(Bench *bench, const WrChoice *choice)
{
    WrError err;
    WrFrame frame;
    if (!wr_choice_frame(bench->renderer, &bench->request, choice, &frame, &err))
        fail_msg("%s", err.text);
    return frame;
}

/* most: samples along a side. The caller ends it with wr_reference_fini. */
static WrReference reference_of(const Bench *bench, int most)
{
    WrError err;
    WrReference reference = { 0 };
    const WrReferenceRequest wanted = { .field = bench->request.field,
                                        .scene = bench->scene,
                                        .width = SIDE,
                                        .height = SIDE,
                                        .most = most };
    assert_true(wr_reference_render(&wanted, NULL, &reference, &err));
    return reference;
}

static const char *const ball[] = { "table 64x64",
                                    "noise gradient cells=4 octaves=2 amplitude=0.6 level=0 seed=3",
                                    "surface sphere R=1",
                                    "replicate 2,1",
                                    "bump mode=blinn height=0.06",
                                    "material specular=0.3 shininess=25",
                                    NULL };
static const char *const sheet[] = { "table 64x64", "grid cells=8x8 width=2", "surface plane",
                                     "bump mode=blinn height=0.02", NULL };
static const char *const band[] = { "table 128x64", "pattern bricks across=4 rows=4",
                                    "surface ribbon", "bump mode=blinn height=0.02", NULL };
static const char *const formula[] = { "analytic fourier terms=3,0,0.5,0,0;0,4,0.4,30,60",
                                       "surface cylinder", "bump mode=blinn height=0.03", NULL };

/* ---- the promise ---- */

static void the_measured_error_keeps_to_the_tolerance_or_it_says_so(void **state)
{
    (void)state;
    static const char *const *const scenes[] = { ball, sheet, band, formula };
    static const double tolerances[] = { 0.05, 0.015, 0.006 };
    int met = 0;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        Bench bench = bench_of(scenes[i]);
        WrReference reference = reference_of(&bench, 16);
        for (size_t t = 0; t < sizeof tolerances / sizeof *tolerances; t++) {
            WrErrors errors;
            WrChoice choice = choose(&bench, WR_TOLERANCE_RMS, tolerances[t]);
            const WrFrame frame = frame_of(&bench, &choice);
            wr_errors_measure(frame.rgba, NULL, &reference, NULL, &errors);
            if (choice.met && errors.rms > tolerances[t])
                fail_msg("scene %d: %g, not %g: %s", (int)i, errors.rms, tolerances[t],
                         choice.reason);
            met += choice.met;
            wr_choice_fini(&choice);
        }
        wr_reference_fini(&reference);
        bench_fini(&bench);
    }
    /* All tolerances except the finest on the most fragmented scene are reachable with 16 x 16 samples. */
    assert_in_range(met, 10, 12);
}

static void expect_to_hold(const char *const *scene, const double tolerances[2], int most)
{
    Bench bench = bench_of(scene);
    WrReference reference = reference_of(&bench, most);
    for (int t = 0; t < 2; t++) {
        WrErrors errors;
        WrChoice choice = choose(&bench, WR_TOLERANCE_RMS, tolerances[t]);
        const WrFrame frame = frame_of(&bench, &choice);
        wr_errors_measure(frame.rgba, NULL, &reference, NULL, &errors);
        if (choice.met && errors.rms > tolerances[t])
            fail_msg("%s: %g, not %g: %s", scene[1], errors.rms, tolerances[t], choice.reason);
        wr_choice_fini(&choice);
    }
    wr_reference_fini(&reference);
    bench_fini(&bench);
}

/* Along such outlines 2 x 2, 4 x 4 and 8 x 8 samples may agree on the same wrong coverage; some are between two
   blocks, one of which is empty at every level. */
static void outlines_that_run_with_the_pixels_rows_do_not_deceive(void **state)
{
    (void)state;
    for (int n = 0; n < 5; n += test_step(2, 2)) {
        char camera[80];
        snprintf(camera, sizeof camera, "camera orthographic size=%g", 1.2 + 0.0219 * n);
        const char *const square[] = { "table 32x32",
                                       "fill 0",
                                       "surface plane",
                                       camera,
                                       "material diffuse=0.9 specular=0",
                                       "light clear",
                                       "light directional to=0,0,1",
                                       NULL };
        expect_to_hold(square, (const double[2]){ 0.02, 0.006 }, 32);
    }
}

/* A bump in one corner of a flat table. */
static void relief_in_a_corner_of_the_picture_is_seen(void **state)
{
    (void)state;
    static const char *const places[] = { "0.03,0.04", "0.5,0.02",    "0.52,0.47", "0.96,0.93",
                                          "0.51,0.5",  "0.555,0.445", "0.6,0.53" };
    for (size_t i = 0; i < sizeof places / sizeof *places; i += (size_t)test_step(2, 3)) {
        char dab[80];
        snprintf(dab, sizeof dab, "dab %s radius=5 strength=1", places[i]);
        const char *const spot[] = { "table 128x128",
                                     dab,
                                     "surface plane",
                                     "replicate 1,1",
                                     "bump mode=blinn height=0.05",
                                     NULL };
        expect_to_hold(spot, (const double[2]){ 0.02, 0.005 }, 16);
    }
}

/* No number of samples repairs the silhouette error of the usual mesh. */
static void outlines_of_a_mesh_are_no_coarser_than_the_tolerance(void **state)
{
    (void)state;
    static const char *const ring[] = { "table 64x64",
                                        "fill 0",
                                        "surface torus R=1 r=0.4",
                                        "camera perspective fov=40",
                                        "material diffuse=0.9 specular=0",
                                        NULL };
    expect_to_hold(ring, (const double[2]){ 0.0025, 0.0012 }, 32);
}

static int samples_of(const WrChoice *choice)
{
    return choice->dials->dials.aa == WR_AA_POINT ? 1 : choice->dials->dials.samples;
}

/* One whole picture, and a check of a bounded number of its pixels: at most 16 blocks of this size. */
static void a_calm_picture_is_rendered_once_and_checked_in_part(void **state)
{
    (void)state;
    WrError err;
    WrFrame frame;
    WrChoice choice = { 0 };
    Bench bench = bench_of(ball);
    bench.scene->height = 0;
    bench.scene->tolerance = (WrTolerance){ WR_TOLERANCE_RMS, 0.05 };
    bench.request.width = bench.request.height = LARGE;
    assert_true(wr_tolerance_choose(bench.renderer, &bench.request, &choice, &frame, &err));
    assert_true(choice.met);
    assert_int_equal(choice.frames, 2);
    assert_int_equal(samples_of(&choice), 1);
    assert_true(frame.shaded <= frame.covered + 16 * 16 * WR_FRAME_BLOCK * WR_FRAME_BLOCK);
    assert_null(strstr(choice.reason, "corrected"));
    wr_choice_fini(&choice);
    bench_fini(&bench);
}

/* The expectations are those of calm pictures: on a lively one the first setting misses, and one correction follows. */
static void a_setting_that_was_expected_to_suffice_is_corrected(void **state)
{
    (void)state;
    static const char *const *const scenes[] = { ball, sheet, band };
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        WrError err;
        WrFrame frame;
        WrErrors errors;
        Bench bench = bench_of(scenes[i]);
        WrReference reference = reference_of(&bench, 16);
        WrChoice choice = choose(&bench, WR_TOLERANCE_RMS, 0.01);
        assert_non_null(strstr(choice.reason, "was corrected once"));
        assert_true(choice.met && choice.frames >= 4 && samples_of(&choice) > 1);
        WrScene *one = wr_scene_clone(doc(bench.session)->scene);
        WrFrameRequest request = bench.request;
        request.scene = one;
        one->dials.aa = WR_AA_POINT;
        assert_true(wr_renderer_frame(bench.renderer, &request, &frame, &err));
        wr_errors_measure(frame.rgba, NULL, &reference, NULL, &errors);
        assert_true(errors.rms > 0.01); /* the correction was necessary */
        frame = frame_of(&bench, &choice);
        wr_errors_measure(frame.rgba, NULL, &reference, NULL, &errors);
        assert_true(errors.rms <= 0.01);
        wr_scene_free(one);
        wr_choice_fini(&choice);
        wr_reference_fini(&reference);
        bench_fini(&bench);
    }
}

/* Random tables, surfaces and tolerances, at sizes that no block divides. */
static void random_tables_at_odd_sizes_keep_to_the_tolerance_or_it_says_so(void **state)
{
    (void)state;
    static const char *const surfaces[] = { "plane", "sphere R=1", "cylinder", "torus", "cube" };
    int met = 0, tried = 0;
    for (uint32_t n = 0; n < 15; n += (uint32_t)test_step(2, 3)) {
        char table[40], noise[120], surface[40], height[60];
        const uint32_t random = wr_mix32(n + 77);
        const int width = 41 + (int)(random % 50), rows = 35 + (int)(random / 64 % 60);
        const double value = 0.004 * (1 + random / 4096 % 8);
        snprintf(table, sizeof table, "table %ux%u", 17 + random % 90, 23 + random / 512 % 70);
        snprintf(noise, sizeof noise,
                 "noise gradient cells=%u octaves=2 amplitude=0.6 level=0 seed=%u", 2 + n % 6, n);
        snprintf(surface, sizeof surface, "surface %s", surfaces[n % 5]);
        snprintf(height, sizeof height, "bump mode=blinn height=%g", 0.01 * (1 + n % 4));
        const char *const lines[] = { table, noise, surface, height, NULL };
        WrErrors errors;
        WrReference reference = { 0 };
        WrError err;
        Bench bench = bench_of(lines);
        bench.request.width = width;
        bench.request.height = rows;
        const WrReferenceRequest wanted = { .field = bench.request.field,
                                            .scene = bench.scene,
                                            .width = width,
                                            .height = rows,
                                            .most = 16 };
        assert_true(wr_reference_render(&wanted, NULL, &reference, &err));
        WrChoice choice = choose(&bench, WR_TOLERANCE_RMS, value);
        wr_errors_measure(frame_of(&bench, &choice).rgba, NULL, &reference, NULL, &errors);
        if (choice.met && errors.rms > value)
            fail_msg("%s, %dx%d: %g: %s", surface, width, rows, errors.rms, choice.reason);
        assert_int_equal(strstr(choice.reason, "MISSED") == NULL, choice.met);
        met += choice.met, tried++;
        wr_choice_fini(&choice);
        wr_reference_fini(&reference);
        bench_fini(&bench);
    }
    assert_in_range(met, tried - tried / 5, tried);
}

static void a_cancelled_choice_is_none(void **state)
{
    (void)state;
    WrError err = { "" };
    WrFrame frame;
    Bench bench = bench_of(ball);
    WrChoice choice = choose(&bench, WR_TOLERANCE_RMS, 0.05);
    const WrScene *before = choice.dials;
    const volatile int cancel = 1;
    bench.request.cancel = &cancel;
    bench.request.turn_deg = 10;
    assert_false(wr_tolerance_frame(bench.renderer, &bench.request, &choice, &frame, &err));
    assert_non_null(strstr(err.text, "cancelled"));
    assert_ptr_equal(choice.dials, before);
    assert_true(choice.turn_deg == 0);
    assert_false(
        wr_tolerance_turn(bench.renderer, &bench.request, (double[]){ 0, 90 }, 2, &choice, &err));
    assert_ptr_equal(choice.dials, before);
    wr_choice_fini(&choice);
    bench_fini(&bench);
}

static void a_tolerance_that_nothing_meets_is_said_to_be_so(void **state)
{
    (void)state;
    Bench bench = bench_of(ball);
    WrChoice choice = choose(&bench, WR_TOLERANCE_RMS, 1e-7);
    assert_false(choice.met);
    assert_true(choice.rms > 1e-7);
    assert_non_null(strstr(choice.reason, "MISSED"));
    wr_choice_fini(&choice);
    bench_fini(&bench);
}

static void a_coarser_tolerance_takes_no_more_samples(void **state)
{
    (void)state;
    Bench bench = bench_of(ball);
    int64_t shaded[3];
    static const double tolerances[3] = { 0.1, 0.01, 0.003 };
    for (int t = 0; t < 3; t++) {
        WrChoice choice = choose(&bench, WR_TOLERANCE_RMS, tolerances[t]);
        shaded[t] = frame_of(&bench, &choice).shaded;
        wr_choice_fini(&choice);
    }
    assert_true(shaded[0] <= shaded[1] && shaded[1] < shaded[2]);
    bench_fini(&bench);
}

static void a_table_without_relief_needs_one_sample_inside(void **state)
{
    (void)state;
    static const char *const flat[] = { "table 64x64", "surface sphere R=1", NULL };
    Bench bench = bench_of(flat);
    WrChoice choice = choose(&bench, WR_TOLERANCE_RMS, 0.05);
    assert_true(choice.met);
    assert_int_equal(choice.dials->dials.aa, WR_AA_POINT);
    wr_choice_fini(&choice);
    bench_fini(&bench);
}

static void a_time_is_spent_and_not_passed(void **state)
{
    (void)state;
    Bench bench = bench_of(ball);
    WrChoice little = choose(&bench, WR_TOLERANCE_TIME, 1e-4);
    WrChoice plenty = choose(&bench, WR_TOLERANCE_TIME, 60);
    const int64_t few = frame_of(&bench, &little).shaded;
    const int64_t many = frame_of(&bench, &plenty).shaded;
    assert_true(plenty.met);
    assert_true(many > 20 * few); /* towards 16 x 16 where it helps */
    assert_true(plenty.rms < little.rms);
    wr_choice_fini(&little);
    wr_choice_fini(&plenty);
    bench_fini(&bench);
}

static void the_worst_pixel_has_a_tolerance_too(void **state)
{
    (void)state;
    Bench bench = bench_of(ball);
    WrChoice fine = choose(&bench, WR_TOLERANCE_MAX, 0.1);
    WrChoice coarse = choose(&bench, WR_TOLERANCE_MAX, 1.5);
    assert_true(coarse.met && coarse.max <= 1.5);
    assert_true(!fine.met || fine.max <= 0.1);
    assert_true(frame_of(&bench, &coarse).shaded <= frame_of(&bench, &fine).shaded);
    wr_choice_fini(&fine);
    wr_choice_fini(&coarse);
    bench_fini(&bench);
}

/* ---- the frame ---- */

/* The picture delivered with a choice equals the one rendered with its settings. */
static void choosing_gives_the_picture_that_the_choice_makes(void **state)
{
    (void)state;
    static const WrTolerance tolerances[] = { { WR_TOLERANCE_RMS, 0.02 },
                                              { WR_TOLERANCE_RMS, 0.004 },
                                              { WR_TOLERANCE_MAX, 0.11 },
                                              { WR_TOLERANCE_TIME, 0.003 } };
    static const char *const *const scenes[] = { ball, band, formula };
    const size_t floats = (size_t)4 * SIDE * SIDE;
    float *got = wr_alloc(floats, sizeof *got);
    for (size_t s = 0; s < sizeof scenes / sizeof *scenes; s++) {
        Bench bench = bench_of(scenes[s]);
        for (size_t t = 0; t < sizeof tolerances / sizeof *tolerances; t++) {
            WrError err;
            WrFrame frame;
            WrChoice choice = { 0 };
            bench.scene->tolerance = tolerances[t];
            assert_true(wr_tolerance_choose(bench.renderer, &bench.request, &choice, &frame, &err));
            const int64_t covered = frame.covered;
            memcpy(got, frame.rgba, floats * sizeof *got);
            const WrFrame again = frame_of(&bench, &choice);
            assert_memory_equal(got, again.rgba, floats * sizeof *got);
            assert_int_equal(again.covered, covered);
            wr_choice_fini(&choice);
        }
        bench_fini(&bench);
    }
    wr_free(got);
}

static void expect_the_same(const WrChoice *a, const WrChoice *b)
{
    const WrScene *x = a->dials, *y = b->dials;
    assert_int_equal(x->scheme, y->scheme);
    assert_int_equal(x->bump, y->bump);
    assert_int_equal(x->dials.mesh, y->dials.mesh);
    assert_int_equal(samples_of(a), samples_of(b));
    assert_true(a->rms == b->rms && a->max == b->max);
}

/* No clock is involved: the dials do not depend on machine load or the number of threads. */
static void the_same_picture_gets_the_same_dials(void **state)
{
    (void)state;
    static const WrTolerance tolerances[] = { { WR_TOLERANCE_RMS, 0.007 },
                                              { WR_TOLERANCE_MAX, 0.09 } };
    static const int threads[] = { 1, 2, 7 };
    Bench bench = bench_of(ball);
    for (size_t t = 0; t < sizeof tolerances / sizeof *tolerances; t++) {
        WrChoice first = choose(&bench, tolerances[t].kind, tolerances[t].value);
        for (size_t n = 0; n < sizeof threads / sizeof *threads; n++) {
            WrError err;
            WrPool *pool = wr_pool_new(threads[n]);
            Bench other = bench;
            other.renderer = wr_renderer_new(pool, NULL, &err);
            assert_non_null(other.renderer);
            for (int run = 0; run < 2; run++) {
                WrChoice choice = choose(&other, tolerances[t].kind, tolerances[t].value);
                expect_the_same(&first, &choice);
                wr_choice_fini(&choice);
            }
            wr_renderer_free(other.renderer);
            wr_pool_free(pool);
        }
        wr_choice_fini(&first);
    }
    bench_fini(&bench);
}

static void a_choice_is_kept_while_its_picture_stays(void **state)
{
    (void)state;
    WrError err;
    WrFrame frame;
    WrChoice choice = { 0 };
    Bench bench = bench_of(ball);
    bench.scene->tolerance = (WrTolerance){ WR_TOLERANCE_RMS, 0.01 };
    assert_true(wr_tolerance_frame(bench.renderer, &bench.request, &choice, &frame, &err));
    const WrScene *kept = choice.dials;
    const int64_t first = frame.shaded;
    assert_true(wr_tolerance_frame(bench.renderer, &bench.request, &choice, &frame, &err));
    assert_ptr_equal(choice.dials, kept);
    assert_true(frame.shaded < first);
    bench.request.turn_deg = 10;
    assert_true(wr_tolerance_frame(bench.renderer, &bench.request, &choice, &frame, &err));
    assert_true(choice.turn_deg == 10);
    wr_choice_fini(&choice);
    bench_fini(&bench);
}

/* The largest error of any pixel against the reference, on scenes with silhouettes, corners and highlights. */
/* For a turn's frames, dials are chosen once and hold on frames that were not used for the choice. */
static void one_choice_does_for_all_frames_of_a_turn(void **state)
{
    (void)state;
    WrError err;
    WrFrame frame;
    WrChoice choice = { 0 };
    double turns[12];
    Bench bench = bench_of(band);
    bench.scene->tolerance = (WrTolerance){ WR_TOLERANCE_RMS, 0.015 };
    for (int i = 0; i < 12; i++) turns[i] = 30 * i;
    assert_true(wr_tolerance_turn(bench.renderer, &bench.request, turns, 12, &choice, &err));
    assert_true(choice.met);
    assert_non_null(strstr(choice.reason, "12 frames: met; dials chosen on 3 of them for all"));
    const WrScene *chosen = choice.dials;
    for (int i = 1; i < 12; i += 4) {
        WrErrors errors;
        WrReference reference = { 0 };
        const WrReferenceRequest wanted = { .field = bench.request.field,
                                            .scene = bench.scene,
                                            .width = SIDE,
                                            .height = SIDE,
                                            .turn_deg = turns[i],
                                            .most = 16 };
        bench.request.turn_deg = turns[i];
        assert_true(wr_tolerance_frame(bench.renderer, &bench.request, &choice, &frame, &err));
        assert_ptr_equal(choice.dials, chosen);
        assert_true(wr_reference_render(&wanted, NULL, &reference, &err));
        wr_errors_measure(frame.rgba, NULL, &reference, NULL, &errors);
        if (errors.rms > 0.015) fail_msg("turn %g: %g: %s", turns[i], errors.rms, choice.reason);
        wr_reference_fini(&reference);
    }
    wr_choice_fini(&choice);
    bench_fini(&bench);
}

static void the_worst_pixel_keeps_to_the_tolerance_or_it_says_so(void **state)
{
    (void)state;
    static const char *const roll[] = {
        "table 96x70",
        "noise perlin cells=5 octaves=3 amplitude=0.5 level=0 seed=8",
        "surface curl R=0.2 q=1.25",
        "rotate -18,20,0",
        "bump mode=blinn height=0.05",
        "material specular=0.4 shininess=50",
        NULL
    };
    static const char *const *const scenes[] = { ball, sheet, band, roll };
    static const double tolerances[] = { 0.3, 0.1, 0.03, 0.01 };
    int met = 0, tried = 0;
    const size_t step = (size_t)test_step(2, 2);
    for (size_t i = step - 1; i < sizeof scenes / sizeof *scenes; i += step) {
        Bench bench = bench_of(scenes[i]);
        WrReference reference = reference_of(&bench, 32);
        for (size_t t = 0; t < sizeof tolerances / sizeof *tolerances; t++) {
            WrErrors errors;
            WrChoice choice = choose(&bench, WR_TOLERANCE_MAX, tolerances[t]);
            const WrFrame frame = frame_of(&bench, &choice);
            wr_errors_measure(frame.rgba, NULL, &reference, NULL, &errors);
            assert_true(choice.max > 0); /* nothing is measured automatically */
            if (choice.met && errors.max > tolerances[t])
                fail_msg("scene %d: %g, not %g: %s", (int)i, errors.max, tolerances[t],
                         choice.reason);
            met += choice.met, tried++;
            wr_choice_fini(&choice);
        }
        wr_reference_fini(&reference);
        bench_fini(&bench);
    }
    assert_in_range(met, tried / 2, tried - 1);
}

/* Seconds are converted to an operation count by a speed that is measured once and stored. */
static void a_time_buys_the_same_dials_again(void **state)
{
    (void)state;
    char folder[] = "/tmp/wrinkle-speed-XXXXXX", path[64];
    assert_non_null(mkdtemp(folder));
    setenv("WRINKLE_STATE", folder, 1);
    Bench bench = bench_of(ball);
    WrChoice first = choose(&bench, WR_TOLERANCE_TIME, 0.004);
    snprintf(path, sizeof path, "%s/speed", folder);
    assert_int_equal(access(path, R_OK), 0);
    for (int run = 0; run < 3; run++) {
        WrChoice again = choose(&bench, WR_TOLERANCE_TIME, 0.004);
        expect_the_same(&first, &again);
        wr_choice_fini(&again);
    }
    wr_choice_fini(&first);
    bench_fini(&bench);
    unsetenv("WRINKLE_STATE");
    unlink(path);
    rmdir(folder);
}

static void an_empty_picture_takes_no_samples(void **state)
{
    (void)state;
    static const char *const away[] = { "table 16x16", "surface sphere R=1",
                                        "camera perspective eye=0,0,9 target=0,0,20 fov=30", NULL };
    Bench bench = bench_of(away);
    WrChoice choice = choose(&bench, WR_TOLERANCE_RMS, 0.01);
    assert_true(choice.met);
    assert_int_equal(frame_of(&bench, &choice).shaded, 0);
    wr_choice_fini(&choice);
    bench_fini(&bench);
}

static void a_scene_without_a_tolerance_has_no_choice(void **state)
{
    (void)state;
    WrError err;
    WrFrame frame;
    WrChoice choice = { 0 };
    Bench bench = bench_of(sheet);
    assert_false(wr_tolerance_choose(bench.renderer, &bench.request, &choice, &frame, &err));
    assert_non_null(strstr(err.text, "tolerance rms=0.004"));
    assert_null(choice.dials);
    bench_fini(&bench);
}

/* ---- the command ---- */

static void a_tolerance_goes_into_the_scenes_lines_and_comes_back(void **state)
{
    (void)state;
    static const struct {
        const char *line;
        WrToleranceKind kind;
        double value;
    } cases[] = { { "tolerance rms=0.004", WR_TOLERANCE_RMS, 0.004 },
                  { "tolerance max=0.05", WR_TOLERANCE_MAX, 0.05 },
                  { "tolerance time=8ms", WR_TOLERANCE_TIME, 0.008 },
                  { "tolerance time=0.5s", WR_TOLERANCE_TIME, 0.5 },
                  { "tolerance off", WR_TOLERANCE_NONE, 0 } };
    WrSession *session = wr_session_new(NULL), *again = wr_session_new(NULL);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        must_run(session, cases[i].line);
        const WrTolerance *tolerance = &doc(session)->scene->tolerance;
        assert_int_equal(tolerance->kind, cases[i].kind);
        assert_true(tolerance->value == cases[i].value);
    }
    must_run(session, "tolerance rms=0.004");
    must_run(again, "tolerance rms=0.004");
    assert_true(wr_hash_equal(wr_session_hash(session), wr_session_hash(again)));
    must_run(session, "undo");
    assert_int_equal(doc(session)->scene->tolerance.kind, WR_TOLERANCE_NONE);
    wr_session_free(session);
    wr_session_free(again);
}

static void a_tolerance_is_one_thing_with_a_sensible_value(void **state)
{
    (void)state;
    WrSession *session = wr_session_new(NULL);
    must_fail(session, "tolerance", "none is given");
    must_fail(session, "tolerance rms=0.1 max=0.2", "several are given");
    must_fail(session, "tolerance rms=0", "rms");
    must_fail(session, "tolerance rms=-1", "rms");
    must_fail(session, "tolerance rms=nan", "rms");
    must_fail(session, "tolerance max=1e9", "max");
    must_fail(session, "tolerance time=8min", "8ms or 0.5s");
    must_fail(session, "tolerance time=0ms", "8ms or 0.5s");
    must_fail(session, "tolerance time=8000", "8ms or 0.5s");
    wr_session_free(session);
}

static void a_session_renders_under_the_tolerance_and_tells_its_choice(void **state)
{
    (void)state;
    WrError err;
    WrFrame frame;
    WrText text = { 0 };
    WrSession *session = session_of(ball);
    assert_null(wr_session_choice(session)->dials);
    must_run(session, "tolerance rms=0.02");
    const WrHash before = wr_session_hash(session);
    assert_true(wr_session_frame(session, SIDE, SIDE, 0, &frame, &err));
    const WrChoice *choice = wr_session_choice(session);
    assert_true(choice->dials && choice->met);
    assert_true(wr_hash_equal(wr_session_hash(session), before)); /* its own dials stay */
    wr_choice_print(choice, &text);
    assert_non_null(strstr(wr_text_get(&text), "whole picture: "));
    assert_non_null(strstr(wr_text_get(&text), "scheme="));
    assert_non_null(strstr(choice->reason, "tolerance rms=0.02: met"));
    wr_text_fini(&text);
    wr_session_free(session);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_measured_error_keeps_to_the_tolerance_or_it_says_so),
        cmocka_unit_test(outlines_that_run_with_the_pixels_rows_do_not_deceive),
        cmocka_unit_test(relief_in_a_corner_of_the_picture_is_seen),
        cmocka_unit_test(outlines_of_a_mesh_are_no_coarser_than_the_tolerance),
        cmocka_unit_test(a_calm_picture_is_rendered_once_and_checked_in_part),
        cmocka_unit_test(a_setting_that_was_expected_to_suffice_is_corrected),
        cmocka_unit_test(random_tables_at_odd_sizes_keep_to_the_tolerance_or_it_says_so),
        cmocka_unit_test(a_cancelled_choice_is_none),
        cmocka_unit_test(a_tolerance_that_nothing_meets_is_said_to_be_so),
        cmocka_unit_test(a_coarser_tolerance_takes_no_more_samples),
        cmocka_unit_test(a_table_without_relief_needs_one_sample_inside),
        cmocka_unit_test(a_time_is_spent_and_not_passed),
        cmocka_unit_test(the_worst_pixel_has_a_tolerance_too),
        cmocka_unit_test(choosing_gives_the_picture_that_the_choice_makes),
        cmocka_unit_test(the_same_picture_gets_the_same_dials),
        cmocka_unit_test(a_choice_is_kept_while_its_picture_stays),
        cmocka_unit_test(one_choice_does_for_all_frames_of_a_turn),
        cmocka_unit_test(the_worst_pixel_keeps_to_the_tolerance_or_it_says_so),
        cmocka_unit_test(a_time_buys_the_same_dials_again),
        cmocka_unit_test(an_empty_picture_takes_no_samples),
        cmocka_unit_test(a_scene_without_a_tolerance_has_no_choice),
        cmocka_unit_test(a_tolerance_goes_into_the_scenes_lines_and_comes_back),
        cmocka_unit_test(a_tolerance_is_one_thing_with_a_sensible_value),
        cmocka_unit_test(a_session_renders_under_the_tolerance_and_tells_its_choice),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
