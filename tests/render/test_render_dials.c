/* test_render_dials.c - every rung of every dial on hard scenes: finite, unit normals, independent of threads and
   instruction set; block mask and normals of a request; storage and visibility dials. */
#include "test.h"
#include "field/scheme_list.h"
#include "render_scenes.h"

#include "base/memory.h"
#include "base/error.h"
#include "base/hash.h"
#include "field/field.h"
#include "render/kernels/kern.h"
#include "render/textures/height_copies.h"
#include "scene/scene.h"

#define SIDE 72

/* A picture for any request; normals NULL: not requested. */
static Shot picture(const WrScene *scene, const WrField *field, const WrDials *dials, int side,
                    int threads, const char *isa, float *normals)
{
    WrError err = { "" };
    Shot shot = { .pool = wr_pool_new(threads) };
    shot.renderer = wr_renderer_new(shot.pool, isa, &err);
    WrFrameRequest request = { .field = field,
                               .scene = scene,
                               .width = side,
                               .height = side,
                               .turn_deg = 15,
                               .dials = dials,
                               .normals = normals };
    if (!shot.renderer || !wr_renderer_frame(shot.renderer, &request, &shot.frame, &err))
        fail_msg("%s", err.text);
    return shot;
}

/* ---- every rung ---------------------------------------------------------------------------------- */

typedef void (*Visit)(const WrScene *scene, const WrField *field, const char *what);

/* Call for each rung of each dial, alone and with other dials it depends on. */
static void each_rung(const char *surface, const WrField *field, double height, Visit visit)
{
    static const WrAntialias bases[] = { WR_AA_POINT, WR_AA_MOMENTS, WR_AA_ADAPTIVE, WR_AA_POINT };
    for (int d = 0; d < WR_DIAL_COUNT; d++) {
        const WrDial *dial = &wr_dials[d];
        for (int base = 0; base < 4; base++) /* the last with fast arithmetic */
            for (int rung = 0; rung < 16; rung++) {
                WrScene *scene = scene_of(surface);
                scene->height = height;
                scene->dials.aa = bases[base];
                scene->dials.samples = 3;
                if (base == 3) scene->dials.arithmetic = WR_ARITHMETIC_FAST;
                double value = rung;
                if (dial->choices == 0 && isnan(dial->rungs[rung])) value = NAN;
                else if (dial->choices == 0) value = dial->rungs[rung];
                if (dial->choices > 0 && rung >= dial->choices) value = NAN;
                if (isnan(value)) {
                    wr_scene_free(scene);
                    break;
                }
                if (d == WR_DIAL_SAMPLES && value > 4) value = 4;
                dial->set(scene, value);
                if (base == 0 || (dial->matters && dial->matters(scene))) {
                    char what[80];
                    snprintf(what, sizeof what, "%s %s=%g aa=%d%s", surface, dial->name, value,
                             (int)scene->dials.aa, base == 3 ? " fast" : "");
                    visit(scene, field, what);
                }
                wr_scene_free(scene);
            }
    }
}

static void expect_sound(const WrScene *scene, const WrField *field, const char *what)
{
    float *normals = wr_alloc(SIDE * SIDE * 3, sizeof *normals);
    Shot shot = picture(scene, field, NULL, SIDE, 2, "auto", normals);
    int there = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        for (int c = 0; c < 4; c++)
            if (!isfinite(shot.frame.rgba[4 * i + c])) fail_msg("%s: pixel %d not finite", what, i);
        double x = (double)normals[3 * i], y = (double)normals[3 * i + 1];
        double len = sqrt(x * x + y * y + (double)normals[3 * i + 2] * (double)normals[3 * i + 2]);
        there += len > 0;
        /* Each half-float member has an error of at most 2^-11, so |n'| differs from 1 by at most 2^-11. */
        const double off = scene->dials.shading == WR_SHADING_HALF ? ldexp(1.01, -11) : 1e-5;
        if (len != 0 && !(fabs(len - 1) < off)) fail_msg("%s: |n'| = %g at %d", what, len, i);
    }
    assert_in_range(there, 100, SIDE * SIDE);
    put_away(&shot);
    wr_free(normals);
}

/* A table with extreme content: a step, Nyquist, the largest numbers, a tiny one. */
static WrField *wild_field(int w, int h)
{
    TestRandom random = { 7 };
    WrField *field = wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_CLAMP, 0, NULL);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++)
            wr_field_set(field, i, j, (float)(test_random(&random) + (i < w / 2) + (i + j) % 2));
    wr_field_set(field, 1, 1, 3.4e38f);
    wr_field_set(field, 2, 1, -3.4e38f);
    wr_field_set(field, w - 1, h - 1, 1e-40f);
    return field;
}

static void hc12_to_hc26_every_rung_gives_finite_light_and_unit_normals(void **state)
{
    (void)state;
    WrField *smooth = bumpy_field(48, 20), *wild = wild_field(33, 7);
    each_rung("sphere", smooth, -1, expect_sound); /* F = -R somewhere (HC12), beyond it (HC13) */
    each_rung("cube", wild, 1e30, expect_sound);   /* HC14, HC15, HC50 */
    each_rung("torus", wild, 1e-30, expect_sound); /* HC16, HC18 */
    each_rung("cone", wild, 3, expect_sound);      /* HC04, HC24 - HC26 */
    wr_field_free(smooth);
    wr_field_free(wild);
}

static void hc42_hc43_hc56_every_rung_takes_the_smallest_tables(void **state)
{
    (void)state;
    const int sizes[][2] = { { 1, 1 }, { 1, 9 }, { 5, 1 }, { 2, 3 } };
    for (int k = 0; k < 4; k++) {
        WrField *field = bumpy_field(sizes[k][0], sizes[k][1]);
        each_rung("plane", field, 0.3, expect_sound);
        wr_field_free(field);
    }
}

/* HC27: a plane seen at 0.01 degrees, its footprints thousands of texels long. */
static void hc27_grazing_views_are_finite_under_every_rung(void **state)
{
    (void)state;
    WrField *field = bumpy_field(256, 256);
    for (int aa = 0; aa < WR_AA_COUNT; aa++)
        for (int shape = 0; shape < 2; shape++) {
            WrScene *scene = scene_of("plane");
            scene->dials.aa = (WrAntialias)aa;
            scene->dials.footprint = (WrFootprint)shape;
            scene->dials.refine = (WrRefine)shape;
            scene->posed = true;
            scene->rotate_deg = (WrVec3){ -89.99, 0, 0 };
            scene->camera.fit = false;
            scene->camera.eye = (WrVec3){ 0, 0, 1.2 };
            WrFrameRequest request = { .field = field, .scene = scene, .width = 64, .height = 64 };
            WrPool *pool = wr_pool_new(1);
            WrRenderer *renderer = wr_renderer_new(pool, "auto", NULL);
            WrFrame frame;
            assert_true(wr_renderer_frame(renderer, &request, &frame, NULL));
            for (int i = 0; i < 64 * 64 * 4; i++) assert_true(isfinite(frame.rgba[i]));
            wr_renderer_free(renderer);
            wr_pool_free(pool);
            wr_scene_free(scene);
        }
    wr_field_free(field);
}

static void expect_same_bits(const WrScene *scene, const WrField *field, const char *what)
{
    if (scene->dials.arithmetic == WR_ARITHMETIC_FAST) return;
    Shot one = picture(scene, field, NULL, 97, 1, "ref", NULL);
    const char *const sets[] = { "v1", "v2", "v3", "v4" };
    for (int k = 0; k < 4; k++) {
        if (!wr_kernels_get(sets[k], false, NULL)) continue;
        Shot other = picture(scene, field, NULL, 97, k % 3 + 1, sets[k], NULL);
        if (!same_picture(&one, &other)) fail_msg("%s: %s differs", what, sets[k]);
        put_away(&other);
    }
    put_away(&one);
}

static void every_rung_has_the_same_bits_on_any_threads_and_instruction_set(void **state)
{
    (void)state;
    WrField *field = bumpy_field(50, 70);
    each_rung("torus", field, 0.02, expect_same_bits);
    each_rung("sphere", field, 0.02, expect_same_bits);
    wr_field_free(field);
}

/* ---- a request's mask and normals ---------------------------------------------------------------- */

static void expect_blocks(const WrScene *scene, const WrField *field, const char *what)
{
    if (scene->dials.arithmetic == WR_ARITHMETIC_FAST) return; /* no bit identity there */
    const int blocks = (SIDE + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK;
    unsigned char only[(SIDE / WR_FRAME_BLOCK + 1) * (SIDE / WR_FRAME_BLOCK + 1)] = { 0 };
    Shot whole = picture(scene, field, NULL, SIDE, 2, "auto", NULL);
    for (int i = 0; i < blocks * blocks; i++) only[i] = i % 7 % 3 != 1; /* alone and in rows */
    WrFrameRequest request = {
        .field = field, .scene = scene, .width = SIDE, .height = SIDE, .turn_deg = 15, .only = only
    };
    WrPool *pool = wr_pool_new(2);
    WrRenderer *renderer = wr_renderer_new(pool, "auto", NULL);
    WrFrame frame;
    assert_true(wr_renderer_frame(renderer, &request, &frame, NULL));
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const size_t at = 4 * (size_t)(y * SIDE + x);
            const float *want = whole.frame.rgba + at, none[4] = { 0 };
            bool asked = only[y / WR_FRAME_BLOCK * blocks + x / WR_FRAME_BLOCK];
            if (memcmp(frame.rgba + at, asked ? want : none, sizeof none) != 0)
                fail_msg("%s: pixel %d,%d of a block that was%s asked for", what, x, y,
                         asked ? "" : " not");
        }
    wr_renderer_free(renderer);
    wr_pool_free(pool);
    put_away(&whole);
}

static void blocks_that_are_asked_for_have_the_bits_of_the_whole_picture(void **state)
{
    (void)state;
    WrField *field = bumpy_field(50, 70);
    each_rung("bezier", field, 0.02, expect_blocks);
    each_rung("cube", field, 0.02, expect_blocks);
    wr_field_free(field);
}

/* Meshes cached for other samples, while view, surface and dials change: bit-identical to a new renderer. */
static void meshes_that_are_held_are_kept_up_to_date(void **state)
{
    (void)state;
    static const struct {
        const char *surface;
        int samples, mesh, side;
        double turn_deg;
    } passes[] = { { "torus", 1, 0, 40, 0 },   { "torus", 4, 0, 40, 0 },
                   { "torus", 1, 0, 40, 30 },  { "torus", 4, 1, 40, 30 },
                   { "torus", 4, 1, 24, 30 },  { "bezier", 4, 0, 24, 30 },
                   { "sphere", 4, 0, 24, 30 }, { "torus", 1, 0, 40, 30 },
                   { "torus", 3, 0, 40, 30 },  { "torus", 4, 0, 40, 30 },
                   { "curl", 3, 0, 40, 30 } };
    WrField *field = bumpy_field(50, 70);
    WrError err = { "" };
    WrRenderer *renderer = wr_renderer_new(NULL, NULL, &err);
    assert_non_null(renderer);
    for (size_t i = 0; i < sizeof passes / sizeof *passes; i++) {
        WrFrame held, fresh;
        WrScene *scene = scene_of(passes[i].surface);
        WrRenderer *other = wr_renderer_new(NULL, NULL, &err);
        scene->dials.aa = WR_AA_SUPERSAMPLE;
        scene->dials.samples = passes[i].samples;
        scene->dials.mesh = passes[i].mesh;
        WrFrameRequest request = { .field = field,
                                   .scene = scene,
                                   .width = passes[i].side,
                                   .height = passes[i].side,
                                   .turn_deg = passes[i].turn_deg,
                                   .hold = true };
        assert_true(wr_renderer_frame(renderer, &request, &held, &err));
        request.hold = false;
        assert_true(wr_renderer_frame(other, &request, &fresh, &err));
        if (memcmp(held.rgba, fresh.rgba, frame_bytes(&fresh)) != 0)
            fail_msg("pass %zu has other bits than a new renderer's", i);
        wr_renderer_free(other);
        wr_scene_free(scene);
    }
    wr_renderer_free(renderer);
    wr_field_free(field);
}

/* Tables cached from earlier settings, while the table is edited: bit-identical to a new renderer. */
static void copies_that_are_held_are_kept_up_to_date(void **state)
{
    (void)state;
    static const WrScheme schemes[] = { WR_SCHEME_BSPLINE_FIT, WR_SCHEME_CENTRAL,
                                        WR_SCHEME_BILINEAR, WR_SCHEME_CENTRAL,
                                        WR_SCHEME_BSPLINE_FIT };
    static const WrAntialias aas[] = { WR_AA_POINT, WR_AA_MOMENTS, WR_AA_FILTER, WR_AA_POINT,
                                       WR_AA_MOMENTS };
    WrField *field = bumpy_field(50, 70);
    WrError err = { "" };
    WrScene *scene = scene_of("cylinder");
    WrRenderer *renderer = wr_renderer_new(NULL, NULL, &err);
    assert_non_null(renderer);
    for (int i = 0; i < 5; i++) {
        WrFrame held;
        scene->scheme = schemes[i];
        scene->dials.aa = aas[i];
        scene->bump = i % 2 ? WR_BUMP_BLINN : WR_BUMP_EXACT;
        wr_field_set(field, 10 + i, 20, 1.0f - 0.1f * (float)i);
        WrFrameRequest request = { .field = field,
                                   .scene = scene,
                                   .width = SIDE,
                                   .height = SIDE,
                                   .turn_deg = 15,
                                   .hold = true };
        if (!wr_renderer_frame(renderer, &request, &held, &err)) fail_msg("%s", err.text);
        Shot fresh = picture(scene, field, NULL, SIDE, 1, "auto", NULL);
        assert_memory_equal(held.rgba, fresh.frame.rgba, SIDE * SIDE * 4 * sizeof(float));
        put_away(&fresh);
    }
    wr_renderer_free(renderer);
    wr_scene_free(scene);
    wr_field_free(field);
}

/* The plane's n' in closed form: (-Fu, -Fv, 1) normalised. */
static void normals_are_those_of_the_formula_at_pixel_centres(void **state)
{
    (void)state;
    WrField *field = wr_field_new(8, 8, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    float *normals = wr_alloc(SIDE * SIDE * 3, sizeof *normals);
    for (int aa = 0; aa < WR_AA_COUNT; aa++) {
        WrScene *scene = scene_of("plane");
        for (int j = 0; j < 8; j++)
            for (int i = 0; i < 8; i++) wr_field_set(field, i, j, (float)i); /* Fu = 8 * 0.02 * 3 */
        scene->dials.aa = (WrAntialias)aa;
        scene->lights[0].strength = 0; /* no light depends on n': it is computed all the same */
        scene->camera.orthographic = true;
        Shot shot = picture(scene, field, NULL, SIDE, 2, "auto", normals);
        int right = 0, there = 0;
        const double fu = 8 * 0.02 * 3, len = sqrt(1 + fu * fu);
        for (int i = 0; i < SIDE * SIDE; i++) {
            there += normals[3 * i + 2] != 0;
            right += fabs((double)normals[3 * i] + fu / len) < 1e-5 &&
                     fabs((double)normals[3 * i + 2] - 1 / len) < 1e-5;
        }
        assert_true(there > 1000);
        if (aa != WR_AA_FILTER && aa != WR_AA_MOMENTS)
            assert_true(right > there / 2); /* except the seam's texels */
        put_away(&shot);
        wr_scene_free(scene);
    }
    wr_free(normals);
    wr_field_free(field);
}

/* ---- heights of fewer bits -------------------------------------------------------------------------- */

/* RMS difference of two pictures' normals over covered pixels. */
static double normal_error(const WrScene *scene, const WrField *field, const WrDials *dials,
                           const float *want)
{
    float *normals = wr_alloc(SIDE * SIDE * 3, sizeof *normals);
    Shot shot = picture(scene, field, dials, SIDE, 2, "auto", normals);
    double sum = 0;
    int there = 0;
    for (int i = 0; i < SIDE * SIDE * 3; i++) {
        sum += pow((double)normals[i] - (double)want[i], 2);
        there += want[i] != 0;
    }
    put_away(&shot);
    wr_free(normals);
    return sqrt(sum / fmax(1, there / 3.0));
}

/* HC51, HC52: a code step is range / M; half a step at either end of a central difference is a slope of
   step n / 2 at most, sqrt(1/12 + 1/12) step n / 2 in the mean: the steps of rounded numbers are even. */
static void hc51_hc52_fewer_bits_err_by_half_a_step_times_the_slopes_gain(void **state)
{
    (void)state;
    const int n = 64;
    WrField *field = wr_field_new(n, n, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++)
            wr_field_set(field, i, j,
                         (float)(0.5 + 0.25 * sin(2 * WR_PI * (i + 0.5) / n) +
                                 0.25 * cos(2 * WR_PI * (2 * j + 0.3) / n)));
    WrScene *scene = scene_of("plane");
    scene->replicate_u = scene->replicate_v = 1;
    scene->height = 0.01;
    scene->camera.orthographic = true;
    WrDials dials = scene->dials;
    dials.heights = WR_HEIGHTS_DOUBLE;
    dials.shading = WR_SHADING_DOUBLE;
    float *want = wr_alloc(SIDE * SIDE * 3, sizeof *want);
    Shot best = picture(scene, field, &dials, SIDE, 1, "auto", want);
    double error[WR_HEIGHTS_COUNT];
    dials.shading = WR_SHADING_FLOAT;
    for (int h = 0; h < WR_HEIGHTS_COUNT; h++) {
        dials.heights = (WrHeights)h;
        error[h] = normal_error(scene, field, &dials, want);
    }
    /* Two slopes, each of rms step / sqrt(12) * sqrt(2) * n / 2, smoothed by bilinear interpolation (4/9 of the
       variance of independent texels); the normal changes as the slope does. */
    double steps[WR_HEIGHTS_COUNT] = {
        [WR_HEIGHTS_HALF] = 1.0 / 2048, [WR_HEIGHTS_16] = 1.0 / 65535, [WR_HEIGHTS_8] = 1.0 / 255
    };
    for (int h = WR_HEIGHTS_HALF; h < WR_HEIGHTS_COUNT; h++) {
        double slope = scene->height * steps[h] / sqrt(12.0) * sqrt(2.0) * n / 2 * 2.0 / 3;
        if (!(error[h] < 3 * sqrt(2) * slope) || !(error[h] > slope / 4))
            fail_msg("heights %d: error %g, expected about %g", h, error[h], sqrt(2) * slope);
    }
    assert_true(error[WR_HEIGHTS_FLOAT] < 1e-6 && error[WR_HEIGHTS_DOUBLE] < 1e-6);
    assert_true(error[WR_HEIGHTS_16] < error[WR_HEIGHTS_HALF]);
    assert_true(error[WR_HEIGHTS_HALF] < error[WR_HEIGHTS_8]);
    put_away(&best);
    wr_free(want);
    wr_scene_free(scene);
    wr_field_free(field);
}

/* binary16 has 11 significant bits and steps of 2^-24 at its lower end. */
static void halves_are_the_nearest_halves(void **state)
{
    (void)state;
    assert_true(wr_round_half(1.0f) == 1.0f && wr_round_half(-0.0f) == 0.0f);
    assert_true(wr_round_half(2049.0f) == 2048.0f && wr_round_half(2051.0f) == 2052.0f); /* even */
    assert_true(wr_round_half(65519.0f) == 65504.0f && wr_round_half(1e30f) == 65504.0f);
    assert_true(wr_round_half(-7e5f) == -65504.0f);
    assert_true(wr_round_half(0x1p-24f) == 0x1p-24f && wr_round_half(0x1p-25f) == 0.0f);
    assert_true(wr_round_half(0x1.8p-25f) == 0x1p-24f);
    TestRandom random = { 3 };
    for (int i = 0; i < 20000; i++) {
        float x = (float)(ldexp(test_random(&random) - 0.5, (int)(30 * test_random(&random)) - 14));
        float h = wr_round_half(x), step = (float)ldexp(1, fmax(ilogb((double)x), -14) - 10);
        assert_true(fabsf(h - x) <= step / 2);
        assert_true(remainder((double)h, (double)step) == 0);
    }
}

/* An edit updates the quantized table bit-identically to a new one, also if the range changes. */
static void rounded_tables_are_refreshed_to_the_bits_of_new_ones(void **state)
{
    (void)state;
    for (int h = WR_HEIGHTS_HALF; h < WR_HEIGHTS_COUNT; h++) {
        WrField *field = bumpy_field(200, 150);
        WrQuantizedHeights kept = { 0 };
        for (int step = 0; step < 6; step++) {
            float low, high, value = step == 3 ? 9.0f : 0.1f * (float)step;
            wr_field_set(field, 39 * step, 20 * step, value);
            wr_field_range(field, &low, &high);
            WrQuantizedHeights fresh = { 0 };
            const WrField *a =
                wr_quantized_heights_update(&kept, field, (WrHeights)h, low, high, NULL);
            const WrField *b =
                wr_quantized_heights_update(&fresh, field, (WrHeights)h, low, high, NULL);
            assert_true(wr_hash_equal(wr_field_hash(a), wr_field_hash(b)));
            wr_quantized_heights_drop(&fresh);
        }
        wr_quantized_heights_drop(&kept);
        wr_field_free(field);
    }
}

/* ---- visibility ----------------------------------------------------------------------------------- */

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

/* The error not exceeded by four covered pixels in five: excludes silhouettes, where the inversion is
   ill-conditioned. */
static double usual_error(const WrScene *scene, const WrField *field, const WrDials *dials,
                          const float *want)
{
    float *normals = wr_alloc(SIDE * SIDE * 3, sizeof *normals);
    double *apart = wr_alloc(SIDE * SIDE, sizeof *apart);
    Shot shot = picture(scene, field, dials, SIDE, 2, "auto", normals);
    int there = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const float *a = normals + 3 * i, *b = want + 3 * i;
        if (a[0] == 0 && a[1] == 0 && a[2] == 0) continue;
        apart[there++] =
            hypot(hypot((double)(a[0] - b[0]), (double)(a[1] - b[1])), (double)(a[2] - b[2]));
    }
    qsort(apart, (size_t)there, sizeof *apart, by_size);
    double error = apart[there * 4 / 5];
    put_away(&shot);
    wr_free(normals);
    wr_free(apart);
    return error;
}

/* More steps of Newton's method, and a finer mesh, come nearer to a very fine picture in double. */
static void newton_and_mesh_bring_the_picture_nearer(void **state)
{
    (void)state;
    WrField *field = bumpy_field(64, 64);
    WrScene *scene = scene_of("torus");
    float *want = wr_alloc(SIDE * SIDE * 3, sizeof *want);
    WrDials dials = scene->dials;
    dials.shading = WR_SHADING_DOUBLE;
    dials.newton = 8;
    Shot best = picture(scene, field, &dials, SIDE, 2, "auto", want);
    dials = scene->dials;
    double error[4];
    for (int steps = 0; steps < 4; steps++) {
        dials.newton = steps;
        error[steps] = usual_error(scene, field, &dials, want);
    }
    if (!(error[0] > 10 * error[1] && error[1] > 2 * error[2] && error[3] < 1e-5))
        fail_msg("0..3 steps: %g %g %g %g", error[0], error[1], error[2], error[3]);
    dials.newton = 0;
    dials.mesh = 2;
    double finer = usual_error(scene, field, &dials, want);
    dials.mesh = -2;
    double coarser = usual_error(scene, field, &dials, want);
    if (!(finer < error[0] && error[0] < coarser))
        fail_msg("mesh 2, 0, -2: %g %g %g", finer, error[0], coarser);
    put_away(&best);
    wr_free(want);
    wr_scene_free(scene);
    wr_field_free(field);
}

/* Half-precision normals and light are half floats; each rounding of a stage is 1/2048 for numbers up to 1, and the
   highlight's power raises n.h to the 30th. */
static void half_shading_is_of_halves_and_near(void **state)
{
    (void)state;
    WrField *field = bumpy_field(64, 64);
    WrScene *scene = scene_of("sphere");
    scene->material.specular = 0.4;
    scene->material.shininess = 30;
    WrDials dials = scene->dials;
    float *full = wr_alloc(SIDE * SIDE * 3, sizeof *full);
    float *half = wr_alloc(SIDE * SIDE * 3, sizeof *half);
    Shot want = picture(scene, field, &dials, SIDE, 1, "auto", full);
    dials.shading = WR_SHADING_HALF;
    Shot got = picture(scene, field, &dials, SIDE, 2, "auto", half);
    double worst = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        for (int c = 0; c < 4; c++) {
            const float x = got.frame.rgba[4 * i + c];
            assert_true(same_bits((double)x, (double)wr_round_half(x)));
            worst = fmax(worst, fabs((double)x - (double)want.frame.rgba[4 * i + c]));
        }
        for (int c = 0; c < 3; c++)
            assert_true(fabsf(half[3 * i + c] - full[3 * i + c]) <= 0x1p-12f);
    }
    if (!(worst > 1e-4 && worst < 30.0 * 4 / 2048)) fail_msg("half shading is off by %g", worst);
    Shot other =
        picture(scene, field, &dials, SIDE, 1, "ref", NULL); /* the same on every processor */
    assert_true(same_picture(&got, &other));
    put_away(&other);
    put_away(&got);
    put_away(&want);
    wr_free(full);
    wr_free(half);
    wr_scene_free(scene);
    wr_field_free(field);
}

/* A threshold of many texels stops at the first step: the picture of newton=1. */
static void texels_stop_the_inversion(void **state)
{
    (void)state;
    WrField *field = bumpy_field(64, 64);
    WrScene *scene = scene_of("torus");
    WrDials loose = scene->dials, one = scene->dials, tight = scene->dials, all = scene->dials;
    loose.newton = all.newton = tight.newton = 4;
    loose.texels = 16;
    tight.texels = 1e-9;
    one.newton = 1;
    Shot a = picture(scene, field, &loose, SIDE, 2, "auto", NULL);
    Shot b = picture(scene, field, &one, SIDE, 2, "auto", NULL);
    Shot c = picture(scene, field, &tight, SIDE, 2, "auto", NULL);
    Shot d = picture(scene, field, &all, SIDE, 2, "auto", NULL);
    assert_true(same_picture(&a, &b));
    assert_true(same_picture(&c, &d));
    put_away(&a);
    put_away(&b);
    put_away(&c);
    put_away(&d);
    wr_scene_free(scene);
    wr_field_free(field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hc12_to_hc26_every_rung_gives_finite_light_and_unit_normals),
        cmocka_unit_test(hc42_hc43_hc56_every_rung_takes_the_smallest_tables),
        cmocka_unit_test(hc27_grazing_views_are_finite_under_every_rung),
        cmocka_unit_test(every_rung_has_the_same_bits_on_any_threads_and_instruction_set),
        cmocka_unit_test(blocks_that_are_asked_for_have_the_bits_of_the_whole_picture),
        cmocka_unit_test(meshes_that_are_held_are_kept_up_to_date),
        cmocka_unit_test(copies_that_are_held_are_kept_up_to_date),
        cmocka_unit_test(normals_are_those_of_the_formula_at_pixel_centres),
        cmocka_unit_test(hc51_hc52_fewer_bits_err_by_half_a_step_times_the_slopes_gain),
        cmocka_unit_test(halves_are_the_nearest_halves),
        cmocka_unit_test(rounded_tables_are_refreshed_to_the_bits_of_new_ones),
        cmocka_unit_test(newton_and_mesh_bring_the_picture_nearer),
        cmocka_unit_test(texels_stop_the_inversion),
        cmocka_unit_test(half_shading_is_of_halves_and_near),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
