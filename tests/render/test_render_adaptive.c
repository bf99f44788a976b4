/* test_render_adaptive.c - jittered and adaptive sampling, and the guaranteed bound of one of its rules. */
#include "test.h"
#include "field/scheme_list.h"
#include "render_scenes.h"
#include "render/pipeline/pipeline.h"

#include "field/field.h"
#include "scene/scene.h"

#define SIDE 80

/* Sum of `count` numbers, `gap` apart, in pairs: the first two, the next two, ..., until one is left. */
static float paired(float *values, int count, size_t gap)
{
    for (; count > 1; count = (count + 1) / 2)
        for (int i = 0; i < (count + 1) / 2; i++)
            values[(size_t)i * gap] = values[(size_t)(2 * i) * gap] +
                                      (2 * i + 1 < count ? values[(size_t)(2 * i + 1) * gap] : 0);
    return values[0];
}

static void means_are_sums_in_pairs_to_the_bit(void **state)
{
    (void)state;
    TestRandom random = { 7 };
    for (int k = 1; k <= 9; k++) {
        float given[9 * 11 * 4], copy[9 * 11 * 4], have[4];
        const size_t step = 11 * 4;
        for (size_t i = 0; i < 9 * step; i++)
            given[i] = copy[i] = (float)ldexp((double)(test_random_u64(&random) >> 40),
                                              -(int)(test_random_u64(&random) % 30));
        wr_tile_mean(given, k, step, have);
        for (int c = 0; c < 4; c++) {
            for (int y = 0; y < k; y++) paired(copy + (size_t)y * step + c, k, 4);
            const float want = paired(copy + c, k, step) * (1.0f / (float)(k * k));
            if (!same_bits(have[c], want))
                fail_msg("%d x %d samples: %a, not %a", k, k, have[c], want);
        }
    }
}

static Shot with_dials(WrScene *scene, const WrField *field, WrAntialias aa, WrRefine refine, int k,
                       double contrast)
{
    scene->dials.aa = aa;
    scene->dials.refine = refine;
    scene->dials.samples = k;
    scene->dials.contrast = contrast;
    return shoot(scene, field, SIDE, SIDE, 2, "auto", false);
}

static WrField *gentle_field(int w, int h)
{
    WrField *field = wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++)
            wr_field_set(field, i, j,
                         (float)(sin(2 * WR_PI * (i + 0.5) / w) * cos(2 * WR_PI * (j + 0.5) / h)));
    return field;
}

/* Scenes with a known bound. */
static WrScene *bounded_scene(int which)
{
    static const char *const surfaces[] = { "plane", "sphere", "cube" };
    WrScene *scene = scene_of(surfaces[which % 3]);
    scene->replicate_u = 1, scene->replicate_v = which % 3 == 1 ? 1 : -1;
    scene->height = which % 3 == 1 ? 0.03 : 0.02;
    scene->camera.orthographic = which / 3 % 2;
    scene->material.shininess = which / 3 % 2 ? 30 : 8;
    scene->material.gate = which % 2;
    if (which >= 6) {
        scene->lights[0].kind = WR_LIGHT_POINT;
        scene->lights[0].where = (WrVec3){ -1.5, 2, 2.5 };
    }
    if (which == 9) scene->scheme = WR_SCHEME_NEAREST;
    if (which == 10) scene->bump = WR_BUMP_NONE;
    return scene;
}

/* Guarantee of refine=bound: no pixel differs from K x K by more than `contrast`. */
static void bounded_refinement_keeps_within_its_contrast(void **state)
{
    (void)state;
    WrField *field = gentle_field(32, 24), *rough = bumpy_field(90, 70);
    int bounded = 0;
    for (int which = 0; which < 12; which++)
        for (int e = 0; e < 3; e++) {
            const double contrast = e == 0 ? 0.2 : e == 1 ? 0.05 : 0.01;
            const WrField *table = which == 5 || which == 11 ? rough : field;
            WrScene *scene = bounded_scene(which);
            if (which == 8) scene->dials.spread = WR_SPREAD_JITTERED;
            Shot all = with_dials(scene, table, WR_AA_SUPERSAMPLE, WR_REFINE_BOUND, 8, contrast);
            Shot some = with_dials(scene, table, WR_AA_ADAPTIVE, WR_REFINE_BOUND, 8, contrast);
            const bool ran = wr_plan_runs(some.frame.plan, WR_EFFECT_BOUND);
            assert_true(ran || same_picture(&all, &some));
            assert_true(ran || e > 0 || table == rough);
            bounded += ran;
            float worst = worst_difference(&all, &some);
            if (!((double)worst <= contrast + 2e-6))
                fail_msg("scene %d, contrast %g: off by %g", which, contrast, (double)worst);
            if (e == 0 && table == field && !(2 * some.frame.shaded < all.frame.shaded))
                fail_msg("scene %d: %g of %g samples: nothing is gained", which,
                         (double)some.frame.shaded, (double)all.frame.shaded);
            put_away(&all);
            put_away(&some);
            wr_scene_free(scene);
        }
    assert_true(bounded > 12);
    wr_field_free(field);
    wr_field_free(rough);
}

/* ---- cases without savings ---- */

/* Relief finer than pixels everywhere: fewer samples would never suffice, so all are used at once, and the plan
   reports it. Gentle relief produces the opposite report. */
static void what_would_spare_nothing_takes_all_at_once(void **state)
{
    (void)state;
    const char *const surfaces[] = { "plane", "sphere", "torus", "bezier" };
    WrField *rough = random_field(256, 256, 3), *gentle = gentle_field(32, 24);
    for (int s = 0; s < 4; s++)
        for (int how = 0; how < 2 * WR_REFINE_COUNT; how++) {
            WrScene *scene = scene_of(surfaces[s]);
            const WrRefine rule = (WrRefine)(how / 2);
            const int k = how & 1 ? 8 : 4;
            Shot all = with_dials(scene, rough, WR_AA_SUPERSAMPLE, rule, k, 0.002);
            Shot some = with_dials(scene, rough, WR_AA_ADAPTIVE, rule, k, 0.002);
            assert_int_equal(some.frame.plan->sampling, WR_SAMPLING_ALL);
            assert_int_equal(some.frame.shaded, all.frame.shaded);
            assert_true(same_picture(&all, &some));
            put_away(&some);
            some = with_dials(scene, gentle, WR_AA_ADAPTIVE, WR_REFINE_CONTRAST, k, 0.002);
            assert_int_equal(some.frame.plan->sampling, WR_SAMPLING_ADAPTIVE);
            put_away(&some);
            put_away(&all);
            wr_scene_free(scene);
        }
    wr_field_free(rough);
    wr_field_free(gentle);
}

/* With contrast 0 no bound and no estimate is small enough: every pixel equals supersampling. */
static void refined_pixels_have_the_bits_of_supersampling(void **state)
{
    (void)state;
    WrField *field = bumpy_field(40, 30);
    const char *const surfaces[] = { "plane", "sphere", "cube", "torus", "cylinder" };
    for (int s = 0; s < 5; s++)
        for (int k = 2; k <= 5; k++) {
            WrScene *scene = scene_of(surfaces[s]);
            scene->dials.spread = k & 1 ? WR_SPREAD_JITTERED : WR_SPREAD_REGULAR;
            Shot all = with_dials(scene, field, WR_AA_SUPERSAMPLE, WR_REFINE_BOUND, k, 0);
            for (int how = 0; how < WR_REFINE_COUNT; how++) {
                Shot some = with_dials(scene, field, WR_AA_ADAPTIVE, (WrRefine)how, k, 0);
                /* An estimate may find all samples equal: then their mean is each of them, except for rounding. */
                const float allowed = how == WR_REFINE_CONTRAST ? 1e-6f : 0;
                if (!(worst_difference(&all, &some) <= allowed))
                    fail_msg("%s, K = %d, rule %d: %g off", surfaces[s], k, how,
                             (double)worst_difference(&all, &some));
                put_away(&some);
            }
            put_away(&all);
            wr_scene_free(scene);
        }
    wr_field_free(field);
}

/* HC92: the mean of equal samples is that sample, to (K^2 - 1) units in the last place; exactly where K is a
   power of two. */
static void hc92_equal_samples_keep_their_value_jittered_and_adaptive(void **state)
{
    (void)state;
    WrField *flat = wr_field_new(8, 8, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    const int counts[] = { 1, 2, 3, 16, 64 };
    for (int c = 0; c < 5; c++)
        for (int how = 0; how < 4; how++) {
            WrScene *scene = scene_of("plane");
            scene->camera.orthographic = true;
            scene->dials.spread = how & 1 ? WR_SPREAD_JITTERED : WR_SPREAD_REGULAR;
            Shot one = with_dials(scene, flat, WR_AA_POINT, WR_REFINE_CONTRAST, 1, 0);
            Shot many = with_dials(scene, flat, how & 2 ? WR_AA_ADAPTIVE : WR_AA_SUPERSAMPLE,
                                   WR_REFINE_BOUND, counts[c], 0);
            const size_t at = 4 * (SIDE / 2 * SIDE + SIDE / 2);
            float a = one.frame.rgba[at], b = many.frame.rgba[at];
            int k = counts[c];
            bool power = (k & (k - 1)) == 0;
            if (!(fabsf(a - b) <= (power ? 0 : (float)(k * k - 1) * 0x1p-24f)))
                fail_msg("K = %d, how %d: %.9g, %.9g", k, how, (double)a, (double)b);
            put_away(&one);
            put_away(&many);
            wr_scene_free(scene);
        }
    wr_field_free(flat);
}

/* A pixel equal to its neighbours keeps its one sample; at an edge K x K are taken. */
static void contrast_refines_edges_and_leaves_the_rest(void **state)
{
    (void)state;
    WrField *flat = wr_field_new(8, 8, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    WrScene *scene = scene_of("plane");
    scene->camera.orthographic = true;
    Shot all = with_dials(scene, flat, WR_AA_SUPERSAMPLE, WR_REFINE_CONTRAST, 8, 0.01);
    Shot some = with_dials(scene, flat, WR_AA_ADAPTIVE, WR_REFINE_CONTRAST, 8, 0.01);
    int edge = 0;
    for (size_t i = 0; i < SIDE * SIDE; i++) {
        const float *a = all.frame.rgba + 4 * i, *b = some.frame.rgba + 4 * i;
        if (a[3] > 0 && a[3] < 1 && b[3] > 0 && b[3] < 1) { /* a pixel of the edge: all of K x K */
            assert_memory_equal(a, b, 4 * sizeof *a);
            edge++;
        } else if (a[3] == 1) assert_true(fabsf(a[0] - b[0]) < 0.01f);
    }
    assert_true(edge > 100);
    assert_true(some.frame.shaded < all.frame.shaded / 4);
    put_away(&all);
    put_away(&some);
    wr_scene_free(scene);
    wr_field_free(flat);
}

/* ---- accuracy of `contrast` ---- */

/* Fraction of pixels with a channel that differs by more than that. */
static double share_off(const Shot *a, const Shot *b, double than, double *most)
{
    int off = 0;
    *most = 0;
    for (size_t i = 0; i < SIDE * SIDE; i++) {
        double worst = 0;
        for (size_t c = 0; c < 4; c++)
            worst = fmax(worst,
                         fabs((double)a->frame.rgba[4 * i + c] - (double)b->frame.rgba[4 * i + c]));
        off += worst > than;
        *most = fmax(*most, worst);
    }
    return off / (double)(SIDE * SIDE);
}

/* Relief that pixels resolve, for every kind of fetch and surface, under two lights of different colours, one of them
   near: within 1/512 of K x K, with less than half of the samples. */
static void contrast_keeps_near_all_samples(void **state)
{
    static const char *const surfaces[] = { "sphere", "plane",  "cube",    "torus",
                                            "bezier", "ribbon", "cylinder" };
    const double within = 1.0 / 512;
    (void)state;
    WrField *field = gentle_field(32, 24);
    for (int which = 0; which < 7 * WR_SCHEME_COUNT; which++) {
        WrScene *scene = scene_of(surfaces[which % 7]);
        const int k = which & 1 ? 8 : 4;
        scene->scheme = (WrScheme)(which / 7);
        scene->replicate_u = scene->replicate_v = 1;
        scene->height = 0.03;
        scene->camera.orthographic = which % 3 == 0;
        scene->material.gate = which % 5 == 0;
        scene->lights = wr_realloc(scene->lights, 1, 2, sizeof *scene->lights);
        scene->lights[1] = (WrLight){ WR_LIGHT_POINT, { 3, 1, 2 }, { 0.2, 0.5, 1 }, 0.7, 0, false };
        scene->light_count = 2;
        Shot all = with_dials(scene, field, WR_AA_SUPERSAMPLE, WR_REFINE_CONTRAST, k, within);
        Shot some = with_dials(scene, field, WR_AA_ADAPTIVE, WR_REFINE_CONTRAST, k, within);
        double most;
        const double off = share_off(&all, &some, within, &most);
        /* An estimate: with a scheme whose slopes jump at texels, single pixels may differ more. */
        const bool jumps = scene->scheme <= WR_SCHEME_BILINEAR;
        if (off > (jumps ? 1e-3 : 0) || (!jumps && 2 * some.frame.shaded > all.frame.shaded))
            fail_msg("%s %s, K = %d: %g of the pixels off, %g at most, %g of %g samples",
                     surfaces[which % 7], wr_schemes[scene->scheme].name, k, off, most,
                     (double)some.frame.shaded, (double)all.frame.shaded);
        put_away(&all);
        put_away(&some);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

/* Scratches narrower than a pixel and far apart: most are between the first samples, which are all equal. They are
   found all the same, since pixels are known to cover several texels. */
static void detail_between_the_first_samples_is_found(void **state)
{
    (void)state;
    const char *const surfaces[] = { "plane", "sphere", "torus" };
    WrField *field = wr_field_new(512, 512, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int j = 0; j < 512; j++)
        for (int i = 0; i < 512; i++)
            if ((i + j / 8) % 61 < 2 || (j - i / 16 + 512) % 83 < 2) wr_field_set(field, i, j, 1);
    for (int s = 0; s < 3; s++) {
        WrScene *scene = scene_of(surfaces[s]);
        scene->replicate_u = scene->replicate_v = 1;
        scene->height = 0.002;
        const double within = 1.0 / 512;
        Shot all = with_dials(scene, field, WR_AA_SUPERSAMPLE, WR_REFINE_CONTRAST, 8, within);
        Shot some = with_dials(scene, field, WR_AA_ADAPTIVE, WR_REFINE_CONTRAST, 8, within);
        double most;
        const double off = share_off(&all, &some, within, &most);
        if (off > 0.006 || most > 0.02)
            fail_msg("%s: %g of the pixels off, %g at most", surfaces[s], off, most);
        put_away(&all);
        put_away(&some);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

/* A static view, while edits make it rough and gentle again: its pictures equal those of a new renderer. */
static void a_resting_view_follows_from_few_samples_to_all(void **state)
{
    (void)state;
    WrError err;
    WrField *gentle = gentle_field(64, 64), *rough = random_field(64, 64, 5);
    WrField *field = wr_field_share(gentle);
    WrScene *scene = scene_of("torus");
    scene->replicate_u = scene->replicate_v = 2;
    Shot kept = with_dials(scene, field, WR_AA_ADAPTIVE, WR_REFINE_CONTRAST, 4, 0.002);
    WrFrameRequest request = {
        .field = field, .scene = scene, .width = SIDE, .height = SIDE, .turn_deg = 15, .keep = true
    };
    int found = 0;
    for (int step = 0; step < 6; step++) {
        const WrField *from = step / 2 % 2 ? rough : gentle;
        for (int j = 0; j < 64 && step % 2 == 0; j++)
            for (int i = 0; i < 64; i++) wr_field_set(field, i, j, wr_field_get(from, i, j));
        if (step & 1) wr_field_set(field, 7 * step, 3, 0.4f);
        if (!wr_renderer_frame(kept.renderer, &request, &kept.frame, &err))
            fail_msg("%s", err.text);
        Shot fresh = shoot(scene, field, SIDE, SIDE, 1, "auto", false);
        if (!same_picture(&kept, &fresh)) fail_msg("step %d", step);
        assert_int_equal(kept.frame.plan->sampling, fresh.frame.plan->sampling);
        found |= 1 << kept.frame.plan->sampling;
        put_away(&fresh);
    }
    assert_int_equal(found, 1 << WR_SAMPLING_ALL | 1 << WR_SAMPLING_ADAPTIVE);
    put_away(&kept);
    wr_scene_free(scene);
    wr_field_free(field);
    wr_field_free(gentle);
    wr_field_free(rough);
}

static double rms_between(const Shot *a, const Shot *b)
{
    double sum = 0;
    for (size_t i = 0; i < (size_t)4 * SIDE * SIDE; i++) {
        const double d = (double)a->frame.rgba[i] - (double)b->frame.rgba[i];
        sum += d * d;
    }
    return sqrt(sum / (4.0 * SIDE * SIDE));
}

/* Light that falls off linearly over a sphere has its mean at each pixel's centre, however steep: only the silhouette
   is refined, and the picture is as accurate as with K x K everywhere. */
static void an_even_slope_of_light_is_not_refined(void **state)
{
    (void)state;
    WrField *flat = wr_field_new(8, 8, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    WrScene *scene = scene_of("sphere");
    scene->material.specular = 0;
    scene->lights[0].strength = 3;
    Shot fine = with_dials(scene, flat, WR_AA_SUPERSAMPLE, WR_REFINE_CONTRAST, 32, 0.02);
    Shot all = with_dials(scene, flat, WR_AA_SUPERSAMPLE, WR_REFINE_CONTRAST, 4, 0.02);
    Shot some = with_dials(scene, flat, WR_AA_ADAPTIVE, WR_REFINE_CONTRAST, 4, 0.02);
    assert_true(some.frame.shaded < all.frame.shaded / 2);
    assert_true(rms_between(&some, &fine) < 1.2 * rms_between(&all, &fine));
    put_away(&fine);
    put_away(&all);
    put_away(&some);
    wr_scene_free(scene);
    wr_field_free(flat);
}

/* Positions are uniform over each cell: the mean of a ramp's jittered samples over many pixels is its middle, and one
   sample per cell makes the mean of K x K better than that of K x K random ones (its error is that of K^2 strata,
   each 1/K wide: variance K^-4 / 12 in the ramp's units). */
static void jittered_samples_are_even_and_stratified(void **state)
{
    (void)state;
    const int K = 4;
    WrField *field = wr_field_new(8, 8, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0, NULL);
    WrScene *scene = scene_of("plane");
    scene->bump = WR_BUMP_NONE;
    scene->replicate_u = scene->replicate_v = 1;
    scene->camera.orthographic = true;
    scene->material.specular = 0;
    scene->lights[0].kind = WR_LIGHT_POINT;
    scene->lights[0].where = (WrVec3){ 1, 0.4, 0.3 };
    scene->dials.spread = WR_SPREAD_JITTERED;
    Shot fine = with_dials(scene, field, WR_AA_SUPERSAMPLE, WR_REFINE_CONTRAST, 16, 0);
    Shot jitter = with_dials(scene, field, WR_AA_SUPERSAMPLE, WR_REFINE_CONTRAST, K, 0);
    scene->dials.spread = WR_SPREAD_REGULAR;
    Shot regular = with_dials(scene, field, WR_AA_SUPERSAMPLE, WR_REFINE_CONTRAST, 64, 0);
    double mean = 0, square = 0, square_fine = 0, ramp = 0;
    int count = 0;
    for (int y = 20; y < 60; y++)
        for (int x = 20; x < 60; x++) {
            size_t at = 4 * (size_t)(y * SIDE + x);
            double d = (double)(jitter.frame.rgba[at] - regular.frame.rgba[at]);
            double f = (double)(fine.frame.rgba[at] - regular.frame.rgba[at]);
            double gx = (double)(regular.frame.rgba[at + 4] - regular.frame.rgba[at]);
            double gy = (double)(regular.frame.rgba[at + 4 * SIDE] - regular.frame.rgba[at]);
            mean += d, square += d * d, square_fine += f * f;
            ramp += (gx * gx + gy * gy) / (12.0 * K * K * K * K);
            count++;
        }
    assert_true(fabs(mean / count) < 4 * sqrt(ramp) / count);
    assert_true(square > 0.5 * ramp && square < 2 * ramp);
    assert_true(square_fine < square / 100); /* K^-4: 256 times less */
    put_away(&fine);
    put_away(&jitter);
    put_away(&regular);
    wr_scene_free(scene);
    wr_field_free(field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(means_are_sums_in_pairs_to_the_bit),
        cmocka_unit_test(bounded_refinement_keeps_within_its_contrast),
        cmocka_unit_test(detail_between_the_first_samples_is_found),
        cmocka_unit_test(what_would_spare_nothing_takes_all_at_once),
        cmocka_unit_test(a_resting_view_follows_from_few_samples_to_all),
        cmocka_unit_test(refined_pixels_have_the_bits_of_supersampling),
        cmocka_unit_test(hc92_equal_samples_keep_their_value_jittered_and_adaptive),
        cmocka_unit_test(contrast_refines_edges_and_leaves_the_rest),
        cmocka_unit_test(contrast_keeps_near_all_samples),
        cmocka_unit_test(an_even_slope_of_light_is_not_refined),
        cmocka_unit_test(jittered_samples_are_even_and_stratified),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
