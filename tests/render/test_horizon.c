/* A plane that extends to the horizon: nearby it is bit-identical to the finite one, far away it fades; its picture
   equals the reference's, and eyes below it, on it and far away get finite values. */
#include "test.h"
#include "field/scheme_list.h"
#include "render_scenes.h"

#include "image/image.h"
#include "scene/objects.h"

#define WIDE 75
#define HIGH 58

/* The table repeats `repeats` times as often as on a plane of 1.3 x 0.9; the eye is at height `above`. */
static WrScene *plane_of(bool endless, double above)
{
    WrScene *scene = scene_of("plane");
    scene->shape.value[0] = 1.3, scene->shape.value[1] = 0.9;
    scene->shape.value[2] = endless;
    scene->posed = true;
    scene->rotate_deg = (WrVec3){ -90, 0, 0 };
    scene->still = true;
    scene->bump = WR_BUMP_BLINN;
    scene->material.specular = 0.2;
    scene->camera = (WrCamera){ .eye = { 0.2, above, 1.7 },
                                .target = { -0.1, 0.4 * above, 0.1 },
                                .up = { 0, 1, 0 },
                                .fov_deg = 50 };
    return scene;
}

static Shot picture(const WrScene *scene, const WrField *field, const char *isa)
{
    return shoot(scene, field, WIDE, HIGH, 2, isa, false);
}

/* Within the finite plane, where a pixel covers less than an eighth of half a period. */
static void near_by_it_is_the_finite_plane_to_the_bit(void **state)
{
    (void)state;
    WrField *field = bumpy_field(61, 47);
    for (int k = 0; k < 4; k++) {
        WrScene *ends = plane_of(false, k % 2 ? -0.7 : 0.8),
                *goes = plane_of(true, k % 2 ? -0.7 : 0.8);
        ends->replicate_u = goes->replicate_u = 1;
        ends->replicate_v = goes->replicate_v = 0.8;
        ends->camera.fov_deg = goes->camera.fov_deg = 33;
        goes->dials.shading = ends->dials.shading = k / 2 ? WR_SHADING_DOUBLE : WR_SHADING_FLOAT;
        Shot a = picture(ends, field, "auto"), b = picture(goes, field, "auto");
        int same = 0, more = 0;
        for (int i = 0; i < WIDE * HIGH; i++) {
            const float *p = a.frame.rgba + 4 * i, *q = b.frame.rgba + 4 * i;
            if (p[3] == 1.0f) same += memcmp(p, q, 4 * sizeof *p) == 0;
            else more += q[3] == 1.0f;
        }
        assert_in_range(same, a.frame.covered, a.frame.covered);
        assert_true(a.frame.covered > 300 && more > 600);
        put_away(&a);
        put_away(&b);
        wr_scene_free(ends);
        wr_scene_free(goes);
    }
    wr_field_free(field);
}

/* Down a column coverage increases monotonically, from none above the horizon to full; in a few rows it is in
   between. */
static void it_fades_at_the_horizon(void **state)
{
    (void)state;
    WrField *field = bumpy_field(61, 47);
    WrScene *scene = plane_of(true, 0.5);
    Shot shot = picture(scene, field, "auto");
    int between = 0, none = 0;
    for (int y = 0; y < HIGH; y++) {
        const float *p = shot.frame.rgba + 4 * (y * WIDE + 31);
        between += p[3] > 0 && p[3] < 1;
        none += p[3] == 0;
        if (y > 0) assert_true(p[3] >= p[3 - 4 * WIDE]);
        if (y == HIGH - 1) assert_true(p[3] == 1.0f);
    }
    assert_true(between >= 2 && none >= 5);
    put_away(&shot);
    wr_scene_free(scene);
    wr_field_free(field);
}

static int count_unlike(const Shot *shot, const WrReference *ours, double off)
{
    int unlike = 0;
    for (int i = 0; i < WIDE * HIGH; i++) {
        bool far = false;
        for (int c = 0; c < 4; c++)
            far |= !(fabs((double)shot->frame.rgba[4 * i + c] - ours->rgba[4 * i + c]) <= off);
        unlike += far;
    }
    return unlike;
}

/* Alone, or with a sphere above, seen from above and below; stretched; in both precisions. */
static void pictures_are_those_of_the_reference(void **state)
{
    (void)state;
    WrField *field = bumpy_field(61, 47);
    for (int k = 0; k < 6; k++) {
        WrScene *scene = plane_of(true, k % 3 == 1 ? -0.6 : 0.45);
        scene->bump = k == 5 ? WR_BUMP_EXACT : WR_BUMP_BLINN;
        scene->scheme = WR_SCHEME_BSPLINE_FIT; /* used by the reference */
        scene->replicate_u = 1.5;
        if (k == 3) scene->sizes = (WrVec3){ 1, 0.8, 1 };
        if (k == 4) scene->dials.shading = WR_SHADING_DOUBLE;
        if (k % 2) {
            WrScene *two = wr_scene_add_object(scene, false);
            wr_shape_default(WR_SURFACE_sphere, &two->shape);
            two->size = 0.4;
            two->height = 0;
            wr_scene_free(scene);
            scene = two;
        }
        Shot shot = picture(scene, field, k == 2 ? "ref" : "auto");
        WrReference ours = { 0 };
        WrError err = { "" };
        const WrReferenceRequest request = { .field = field,
                                             .scene = scene,
                                             .width = WIDE,
                                             .height = HIGH,
                                             .turn_deg = 15,
                                             .first = 1,
                                             .most = 1 };
        if (!wr_reference_render(&request, shot.pool, &ours, &err)) fail_msg("%s", err.text);
        const int unlike = count_unlike(&shot, &ours, 1e-3);
        if (unlike > 12) fail_msg("%d: %d pixels", k, unlike);
        wr_reference_fini(&ours);
        put_away(&shot);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

/* All samples of a pixel fade by the pixel's footprint: more samples hardly change coverage. */
static void fading_goes_by_pixels_whatever_the_samples(void **state)
{
    (void)state;
    WrField *field = bumpy_field(61, 47);
    WrScene *scene = plane_of(true, 0.5);
    scene->bump = WR_BUMP_NONE;
    Shot one = picture(scene, field, "auto");
    scene->dials.aa = WR_AA_SUPERSAMPLE;
    scene->dials.samples = 5;
    Shot many = picture(scene, field, "auto");
    int off = 0;
    for (int i = 0; i < WIDE * HIGH; i++)
        off += fabsf(one.frame.rgba[4 * i + 3] - many.frame.rgba[4 * i + 3]) > 0.12f;
    assert_int_equal(off, 0);
    put_away(&one);
    put_away(&many);
    wr_scene_free(scene);
    wr_field_free(field);
}

/* Squares of 0 and 1 with known mean, one texel each; one sample per pixel, without filter dials. A pixel that covers
   many texels shows their mean: single texels would make an error of a half in half of the pixels. */
static void far_colours_are_the_mean_of_their_picture(void **state)
{
    (void)state;
    WrField *field = bumpy_field(61, 47);
    WrScene *scene = plane_of(true, 0.5);
    scene->bump = WR_BUMP_NONE;
    scene->material.specular = 0;
    Shot white = picture(scene, field, "auto");
    scene->colour = wr_image_new(310, 170, 3, NULL);
    double mean = 0;
    uint32_t random = 2026;
    for (int i = 0; i < 310 * 170; i++) {
        random = random * 1664525u + 1013904223u;
        const float value = random >> 30 == 0; /* one in four */
        for (int c = 0; c < 3; c++) scene->colour->data[3 * i + c] = value;
        mean += (double)value / (310 * 170);
    }
    Shot shot = picture(scene, field, "auto");
    double off = 0;
    int count = 0;
    for (int i = 0; i < WIDE * HIGH / 2; i++) {
        const float *w = white.frame.rgba + 4 * i, *p = shot.frame.rgba + 4 * i;
        if (!(w[3] > 0) || w[3] >= 1 || !(w[1] > 0.001f)) continue;
        const double share = (double)p[1] / (double)w[1] - mean;
        off += share * share;
        count++;
    }
    assert_true(count > 40);
    if (!(sqrt(off / count) < 0.04)) fail_msg("%g of %d", sqrt(off / count), count);
    put_away(&white);
    put_away(&shot);
    wr_scene_free(scene);
    wr_field_free(field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(near_by_it_is_the_finite_plane_to_the_bit),
        cmocka_unit_test(it_fades_at_the_horizon),
        cmocka_unit_test(pictures_are_those_of_the_reference),
        cmocka_unit_test(fading_goes_by_pixels_whatever_the_samples),
        cmocka_unit_test(far_colours_are_the_mean_of_their_picture),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
