/* test_color_mips.c - colour texture over the footprints of pixels: its means against pictures with many samples per
   pixel; tiling. */
#include "test.h"
#include "render_scenes.h"

#include "image/image.h"
#include "render/kernels/kern.h"
#include "render/textures/mips.h"

static WrImage *checker(int width, int height)
{
    WrImage *image = wr_image_new(width, height, 1, NULL);
    for (int i = 0; i < width * height; i++) image->data[i] = (float)((i % width + i / width) & 1);
    return image;
}

static WrImage *random_image(int width, int height, int channels, uint64_t seed)
{
    TestRandom random = { seed };
    WrImage *image = wr_image_new(width, height, channels, NULL);
    for (int i = 0; i < width * height * channels; i++)
        image->data[i] = (float)test_random(&random);
    return image;
}

/* ---- the pyramid ----------------------------------------------------------------------------------- */

static const float *texel_of(const WrColorMips *tint, int level, int i, int j)
{
    const WrPyramidLevel *at = &tint->pyramid.level[level];
    return at->data + (size_t)((j + 1) * at->pitch + i + 1) * 4;
}

static WrColorMips tint_of(const WrImage *image, WrWrap wrap, WrPool *pool)
{
    WrColorMips tint = { 0 };
    assert_true(wr_color_mips_update(&tint, image, wrap, wrap, NULL));
    assert_true(wr_color_mips_update_pyramid(&tint, pool, NULL));
    return tint;
}

static void check_apron(const WrColorMips *tint, int level, bool round)
{
    const int w = tint->pyramid.level[level].width, h = tint->pyramid.level[level].height;
    for (int j = -1; j <= h; j++)
        for (int i = -1; i <= w; i++) {
            const int x = round ? (i + w) % w : i < 0 ? 0 : i < w ? i : w - 1;
            const int y = round ? (j + h) % h : j < 0 ? 0 : j < h ? j : h - 1;
            assert_memory_equal(texel_of(tint, level, i, j), texel_of(tint, level, x, y), 12);
        }
}

static void every_level_of_any_size_keeps_the_mean_and_the_phase(void **state)
{
    const int sizes[][2] = { { 64, 16 }, { 5, 3 }, { 1, 9 }, { 7, 1 }, { 48, 100 }, { 33, 31 } };
    (void)state;
    for (int s = 0; s < 12; s++) {
        const int w = sizes[s % 6][0], h = sizes[s % 6][1];
        WrImage *image = random_image(w, h, s < 6 ? 3 : 1, (uint64_t)s);
        double mean[3] = { 0 };
        for (int i = 0; i < w * h; i++) {
            image->data[i * image->channels] =
                (float)(0.5 + 0.5 * sin(2 * WR_PI * (i % w + 0.5) / w));
            for (int c = 0; c < 3; c++)
                mean[c] += (double)image->data[i * image->channels + c % image->channels] / (w * h);
        }
        WrColorMips tint = tint_of(image, s & 1 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC, NULL);
        for (int level = 1; level < tint.pyramid.levels; level++) {
            const WrPyramidLevel *at = &tint.pyramid.level[level];
            double sum[3] = { 0 }, in_phase = 0, across = 0;
            for (int k = 0; k < at->width * at->height; k++) {
                const float *t = texel_of(&tint, level, k % at->width, k / at->width);
                const double phase = 2 * WR_PI * (k % at->width + 0.5) / at->width;
                for (int c = 0; c < 3; c++) sum[c] += (double)t[c] / (at->width * at->height);
                in_phase += (double)t[0] * sin(phase), across += (double)t[0] * cos(phase);
            }
            for (int c = 0; c < 3; c++) assert_near(sum[c], mean[c], 1e-6);
            if (at->width >= 3) assert_true(fabs(across) < 1e-4 * in_phase);
            check_apron(&tint, level, !(s & 1));
        }
        wr_color_mips_drop(&tint);
        wr_image_free(image);
    }
}

static void threads_make_the_bits_of_one(void **state)
{
    (void)state;
    WrImage *image = random_image(301, 77, 3, 9);
    WrPool *pool = wr_pool_new(5);
    WrColorMips one = tint_of(image, WR_WRAP_PERIODIC, NULL);
    WrColorMips five = tint_of(image, WR_WRAP_PERIODIC, pool);
    for (int level = 1; level < one.pyramid.levels; level++)
        for (int j = 0; j < one.pyramid.level[level].height; j++)
            assert_memory_equal(texel_of(&one, level, 0, j), texel_of(&five, level, 0, j),
                                (size_t)one.pyramid.level[level].width * 16);
    wr_color_mips_drop(&one);
    wr_color_mips_drop(&five);
    wr_pool_free(pool);
    wr_image_free(image);
}

/* ---- pictures -------------------------------------------------------------------------------------- */

#define SIDE 64

/* For fully covered pixels: RMS difference from the means of 16 x 16 samples, and these pixels' own deviation from
   their mean. */
typedef struct Apart {
    double rms, worst, deviation;
    int pixels;
} Apart;

static Apart compare(const Shot *shot, const Shot *truth)
{
    Apart apart = { 0 };
    double sum = 0, squares = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const float *a = shot->frame.rgba + 4 * i, *b = truth->frame.rgba + 4 * i;
        if (!(a[3] == 1.0f && b[3] == 1.0f)) continue;
        const double d = (double)a[1] - (double)b[1];
        apart.rms += d * d, apart.worst = fmax(apart.worst, fabs(d));
        sum += (double)a[1], squares += (double)a[1] * (double)a[1];
        apart.pixels++;
    }
    assert_true(apart.pixels > 100);
    const double mean = sum / apart.pixels;
    apart.rms = sqrt(apart.rms / apart.pixels);
    apart.deviation = sqrt(fmax(0, squares / apart.pixels - mean * mean));
    return apart;
}

static Shot shoot_as(WrScene *scene, const WrField *field, WrAntialias aa, bool anisotropic)
{
    scene->dials.aa = aa;
    scene->dials.samples = 16;
    scene->dials.footprint = anisotropic ? WR_FOOTPRINT_ANISOTROPIC : WR_FOOTPRINT_ISOTROPIC;
    return shoot(scene, field, SIDE, SIDE, 2, "auto", false);
}

/* A smooth object with ambient light alone: its picture is C. */
static WrScene *plain_scene(const char *surface, WrImage *image)
{
    WrScene *scene = scene_of(surface);
    scene->bump = WR_BUMP_NONE;
    scene->material.ambient = 1;
    scene->material.diffuse = scene->material.specular = 0;
    scene->material.colour = (WrVec3){ 1, 1, 1 };
    scene->colour = image;
    scene->replicate_u = scene->replicate_v = 1;
    return scene;
}

/* Squares of one texel are grey as soon as a pixel covers several. */
static void a_fine_checker_is_grey(void **state)
{
    (void)state;
    WrField *flat = wr_field_new(8, 8, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int k = 0; k < 4; k++) {
        WrScene *scene = plain_scene("plane", checker(1024 - k % 2 * 4, 1024));
        scene->rotate_deg = (WrVec3){ k * 10, 7, 0 };
        scene->posed = true;
        Shot truth = shoot_as(scene, flat, WR_AA_SUPERSAMPLE, false);
        Shot point = shoot_as(scene, flat, WR_AA_POINT, false);
        Shot filtered = shoot_as(scene, flat, k < 2 ? WR_AA_FILTER : WR_AA_MOMENTS, k & 1);
        const Apart of_truth = compare(&truth, &truth), of_point = compare(&point, &truth);
        const Apart of_filter = compare(&filtered, &truth);
        if (getenv("WR_SHOW"))
            printf("deviation: truth %.4f, point %.4f, filtered %.4f; off %.4f\n",
                   of_truth.deviation, of_point.deviation, of_filter.deviation, of_filter.rms);
        assert_true(of_point.deviation > 0.05 && of_truth.deviation < 0.03);
        assert_true(of_filter.deviation < 1e-3 && of_filter.rms < of_truth.deviation + 1e-3);
        put_away(&truth);
        put_away(&point);
        put_away(&filtered);
        wr_scene_free(scene);
    }
    wr_field_free(flat);
}

/* Pictures of odd sizes on all kinds of surface, lit or unlit, smooth or not: much closer to 16 x 16 samples than one
   fetch is. */
static void filtered_pictures_are_near_many_samples(void **state)
{
    static const char *const surfaces[] = {
        "plane", "sphere", "torus", "cube", "cone", "cylinder"
    };
    static const int sizes[][2] = { { 333, 217 }, { 129, 700 }, { 601, 401 } };
    (void)state;
    WrField *field = bumpy_field(16, 16);
    for (int k = 0; k < 18; k++) {
        const int *size = sizes[k % 3];
        WrScene *scene = plain_scene(surfaces[k % 6],
                                     random_image(size[0], size[1], k & 1 ? 3 : 1, (uint64_t)k));
        scene->replicate_u = 1 + k % 2, scene->replicate_v = k % 5 ? 1 : -1;
        if (k % 3 == 1) scene->material.diffuse = 0.5;
        if (k % 4 == 1) scene->bump = WR_BUMP_BLINN, scene->height = 0.004;
        if (k == 7 || k == 10 || k == 11) { /* of a formula: only C is filtered */
            scene->bump = WR_BUMP_BLINN, scene->height = 0.01;
            scene->dials.arithmetic = WR_ARITHMETIC_FAST; /* which bends in one step */
            scene->analytic =
                (WrAnalytic){ WR_ANALYTIC_POLY, 1, wr_alloc(1, sizeof(WrAnalyticTerm)) };
            scene->analytic.terms[0] = (WrAnalyticTerm){ .i = 2, .j = 1, .a = 1 };
            scene->material.diffuse = 0.5;
        }
        if (k % 7 == 2) scene->dials.shading = WR_SHADING_DOUBLE;
        Shot truth = shoot_as(scene, field, WR_AA_SUPERSAMPLE, false);
        Shot point = shoot_as(scene, field, WR_AA_POINT, false);
        Shot filtered = shoot_as(scene, field, WR_AA_FILTER, true);
        const Apart a = compare(&point, &truth), b = compare(&filtered, &truth);
        if (getenv("WR_SHOW"))
            printf("%2d %-8s point %.4f, filtered %.4f, worst %.3f\n", k, surfaces[k % 6], a.rms,
                   b.rms, b.worst);
        if (!(b.rms < 0.35 * a.rms)) fail_msg("case %d: %g against %g", k, b.rms, a.rms);
        assert_true(wr_plan_runs(filtered.frame.plan, WR_EFFECT_TINT));
        put_away(&truth);
        put_away(&point);
        put_away(&filtered);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

static WrScene *mixed_scene(int k)
{
    static const char *const surfaces[] = { "torus", "sphere", "plane", "cube", "cylinder" };
    WrScene *scene = scene_of(surfaces[k % 5]);
    scene->colour = random_image(97 + k, 203, k & 1 ? 3 : 1, (uint64_t)k + 1);
    scene->dials.aa = k % 3 == 2 ? WR_AA_MOMENTS : WR_AA_FILTER;
    scene->dials.footprint = k & 2 ? WR_FOOTPRINT_ANISOTROPIC : WR_FOOTPRINT_ISOTROPIC;
    if (k % 4 == 3) scene->bump = WR_BUMP_NONE;
    if (k % 7 == 5) scene->bump = WR_BUMP_EXACT;
    if (k % 5 == 4) scene->dials.shading = WR_SHADING_DOUBLE;
    if (k % 8 == 6) scene->dials.shading = WR_SHADING_HALF;
    if (k % 3 == 1)
        scene->colour_laid.own = true, scene->colour_laid.ru = 2.5, scene->colour_laid.rv = -1;
    if (k % 6 == 4) scene->material.diffuse = scene->material.specular = 0;
    if (k % 9 == 7) scene->lights[0].where = (WrVec3){ 0, 0, -1 };
    return scene;
}

static void planned_full_threads_and_instruction_sets_agree_to_the_bit(void **state)
{
    static const char *const sets[] = { "ref", "v1", "v2", "v3", "v4" };
    (void)state;
    for (int k = 0; k < (getenv("WR_FULL") ? 90 : 10); k++) {
        WrField *field = random_field(70, 41, (uint64_t)k);
        WrScene *scene = mixed_scene(k);
        Shot first = shoot(scene, field, 150, 70, 1, "auto", false);
        Shot full = shoot(scene, field, 150, 70, 3, "auto", true);
        const bool exact = scene->bump == WR_BUMP_EXACT; /* class B on flat surfaces */
        if (!(exact || same_picture(&first, &full))) fail_msg("case %d: full", k);
        for (int s = 0; s < 5; s++) {
            if (!wr_kernels_get(sets[s], false, NULL)) continue;
            Shot other = shoot(scene, field, 150, 70, 2 + s, sets[s], false);
            if (!same_picture(&first, &other)) fail_msg("case %d: %s", k, sets[s]);
            put_away(&other);
        }
        put_away(&first);
        put_away(&full);
        wr_scene_free(scene);
        wr_field_free(field);
    }
}

/* E64: a picture without texels smaller than a pixel is fetched unfiltered. */
static void coarse_pictures_have_the_bits_of_point(void **state)
{
    (void)state;
    WrField *field = bumpy_field(12, 10);
    for (int k = 0; k < 4; k++) {
        WrScene *scene = plain_scene(k & 1 ? "plane" : "cube", random_image(4, 3, 3, 3));
        scene->camera.orthographic = true;
        scene->bump = k & 2 ? WR_BUMP_BLINN : WR_BUMP_NONE;
        Shot point = shoot_as(scene, field, WR_AA_POINT, true);
        Shot filtered = shoot_as(scene, field, WR_AA_FILTER, true);
        assert_true(same_picture(&point, &filtered));
        assert_true(filtered.frame.plan->rows[WR_EFFECT_TINT].ran);
        assert_int_equal(filtered.frame.plan->rows[WR_EFFECT_TINT].pixels, 0);
        put_away(&point);
        put_away(&filtered);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

/* E29: colours are unchanged when an edit of the table is shown. */
static void a_resting_view_is_refreshed_to_the_bits_of_a_new_picture(void **state)
{
    (void)state;
    for (int k = 0; k < 6; k++) {
        WrScene *scene = mixed_scene(k * 3);
        scene->replicate_u = scene->replicate_v = 1;
        expect_refreshed(scene, k);
        wr_scene_free(scene);
    }
}

/* ---- tiling ---------------------------------------------------------------------------------------- */

static void a_picture_is_laid_as_often_as_told(void **state)
{
    (void)state;
    WrField *flat = wr_field_new(8, 8, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int k = 0; k < 3; k++) {
        WrScene *scene = plain_scene("sphere", random_image(16, 8, 3, 7));
        const double ru = k ? 3 : 1, rv = k ? k : 1;
        scene->replicate_u = ru, scene->replicate_v = rv;
        Shot table = shoot_as(scene, flat, WR_AA_POINT, false);
        scene->replicate_u = 5, scene->replicate_v = 7;
        scene->colour_laid.own = true, scene->colour_laid.ru = ru, scene->colour_laid.rv = rv;
        Shot own = shoot_as(scene, flat, WR_AA_POINT, false);
        assert_true(same_picture(&table, &own));
        scene->colour_laid.own = false;
        Shot other = shoot_as(scene, flat, WR_AA_POINT, false);
        assert_false(same_picture(&table, &other));
        put_away(&table);
        put_away(&own);
        put_away(&other);
        wr_scene_free(scene);
    }
    wr_field_free(flat);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_level_of_any_size_keeps_the_mean_and_the_phase),
        cmocka_unit_test(threads_make_the_bits_of_one),
        cmocka_unit_test(a_fine_checker_is_grey),
        cmocka_unit_test(filtered_pictures_are_near_many_samples),
        cmocka_unit_test(planned_full_threads_and_instruction_sets_agree_to_the_bit),
        cmocka_unit_test(coarse_pictures_have_the_bits_of_point),
        cmocka_unit_test(a_resting_view_is_refreshed_to_the_bits_of_a_new_picture),
        cmocka_unit_test(a_picture_is_laid_as_often_as_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
