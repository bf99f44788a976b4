/* Self-shadowing of the relief: pictures against the reference, which marches rays through the table. */
#include "test.h"
#include "field/scheme_list.h"
#include "render_scenes.h"

#include "field/field.h"
#include "render/reference/reference.h"
#include "scene/scene.h"
#include "base/exactmath.h"

#define SIDE 96

/* A few different humps; 61 x 47 texels. */
static WrField *humps(void)
{
    WrError err;
    WrField *field = wr_field_new(61, 47, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, &err);
    for (int j = 0; j < 47; j++)
        for (int i = 0; i < 61; i++) {
            const double x = 2 * 3.14159265358979 * (i + 0.37) / 61;
            const double y = 2 * 3.14159265358979 * (j + 0.71) / 47;
            const double f = sin(x + 0.3) * cos(2 * y) + 0.4 * cos(3 * x - y);
            wr_field_set(field, i, j, (float)(f * f));
        }
    return field;
}

static WrScene *shadowy(const char *surface, double height)
{
    WrShape shape;
    WrScene *scene = wr_scene_new();
    wr_shape_default((WrSurfaceKind)wr_surface_find(surface), &shape);
    wr_scene_set_shape(scene, &shape);
    scene->height = height;
    scene->replicate_u = 3.1, scene->replicate_v = 2;
    scene->scheme = WR_SCHEME_BSPLINE_FIT;
    scene->bump = WR_BUMP_EXACT;
    scene->material.shadow = true;
    scene->material.specular = 0;
    scene->lights[0].where = (WrVec3){ -0.83, 0.41, 0.43 };
    return scene;
}

/* Fractions of covered pixels: darkened by the relief, and different from the reference by over a twentieth. */
static void shares(const char *surface, double height, bool displaced, double *dark, double *off)
{
    WrError err = { "" };
    WrField *field = humps();
    WrScene *scene = shadowy(surface, height), *bare;
    scene->displaced = displaced;
    scene->dials.dice = 0.125;
    bare = wr_scene_clone(scene);
    bare->material.shadow = false;
    const WrFrameRequest request = {
        .field = field, .scene = scene, .width = SIDE, .height = SIDE
    };
    const WrFrameRequest without = { .field = field, .scene = bare, .width = SIDE, .height = SIDE };
    WrRenderer *renderer = wr_renderer_new(NULL, "auto", &err),
               *other = wr_renderer_new(NULL, "auto", &err);
    WrFrame frame, plain;
    WrReference truth = { 0 };
    int covered = 0;
    assert_true(wr_renderer_frame(renderer, &request, &frame, &err));
    assert_true(wr_renderer_frame(other, &without, &plain, &err));
    assert_true(frame.plan->rows[WR_EFFECT_SHADOW].ran);
    assert_false(plain.plan->rows[WR_EFFECT_SHADOW].run);
    const WrReferenceRequest wanted = {
        .field = field, .scene = scene, .width = SIDE, .height = SIDE, .first = 1, .most = 1
    };
    if (!wr_reference_render(&wanted, NULL, &truth, &err)) fail_msg("%s", err.text);
    *dark = *off = 0;
    for (int k = 0; k < SIDE * SIDE; k++) {
        if (frame.rgba[4 * k + 3] < 1) continue;
        covered++;
        assert_true(frame.rgba[4 * k] <= plain.rgba[4 * k]);
        *dark += frame.rgba[4 * k] < plain.rgba[4 * k];
        *off += fabs((double)frame.rgba[4 * k] - (double)truth.rgba[4 * k]) > 0.05;
    }
    *dark /= covered, *off /= covered;
    wr_reference_fini(&truth);
    wr_renderer_free(renderer);
    wr_renderer_free(other);
    wr_scene_free(scene);
    wr_scene_free(bare);
    wr_field_free(field);
}

static void pictures_have_the_shadows_of_marched_rays(void **state)
{
    const char *const surfaces[] = { "plane", "sphere", "torus", "cylinder" };
    (void)state;
    for (int s = 0; s < 4; s++)
        for (int sign = -1; sign <= 1; sign += 2) {
            double dark, off;
            shares(surfaces[s], sign * (s ? 0.21 : 0.06), false, &dark, &off);
            print_message("%s %d: %g dark, %g off\n", surfaces[s], sign, dark, off);
            assert_true(dark > 0.04);
            assert_true(off < 0.04);
        }
}

/* With displacement, rays intersect the surface itself: horizons over the tangent plane approximate that, except
   where the ground ends or bends. */
static void displaced_surfaces_have_them_too(void **state)
{
    (void)state;
    for (int s = 0; s < 2; s++) {
        double dark, off;
        shares(s ? "sphere" : "plane", s ? 0.07 : 0.06, true, &dark, &off);
        print_message("displaced %d: %g dark, %g off\n", s, dark, off);
        assert_true(dark > 0.04);
        assert_true(off < 0.08);
    }
}

/* ---- round lamps, and the sky ---- */

/* RMS over covered pixels: picture minus reference, and picture minus picture without the effect. */
static void compared(WrScene *scene, WrScene *without, double *off, double *effect)
{
    WrError err = { "" };
    WrField *field = humps();
    WrRenderer *renderer[2] = { wr_renderer_new(NULL, "auto", &err),
                                wr_renderer_new(NULL, "auto", &err) };
    WrFrame frame[2];
    WrReference truth = { 0 };
    enum { SMALL = 32 };
    double sums[2] = { 0, 0 };
    int covered = 0;
    for (int k = 0; k < 2; k++) {
        const WrFrameRequest request = {
            .field = field, .scene = k ? without : scene, .width = SMALL, .height = SMALL
        };
        if (!wr_renderer_frame(renderer[k], &request, &frame[k], &err)) fail_msg("%s", err.text);
    }
    const WrReferenceRequest wanted = {
        .field = field, .scene = scene, .width = SMALL, .height = SMALL, .first = 1, .most = 1
    };
    if (!wr_reference_render(&wanted, NULL, &truth, &err)) fail_msg("%s", err.text);
    for (int k = 0; k < SMALL * SMALL; k++) {
        if (frame[0].rgba[4 * k + 3] < 1) continue;
        covered++;
        sums[0] += pow((double)frame[0].rgba[4 * k] - truth.rgba[4 * k], 2);
        sums[1] += pow((double)frame[0].rgba[4 * k] - (double)frame[1].rgba[4 * k], 2);
    }
    *off = sqrt(sums[0] / covered), *effect = sqrt(sums[1] / covered);
    wr_reference_fini(&truth);
    for (int k = 0; k < 2; k++) wr_renderer_free(renderer[k]);
    wr_field_free(field);
}

/* A light of 7 degrees, whose disc the reference samples; hard shadows give another picture. */
static void round_lamps_have_penumbras(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        double off, effect;
        WrScene *scene = shadowy(k ? "sphere" : "plane", k ? 0.13 : 0.06);
        scene->lights[0].size_deg = 7;
        if (k) scene->lights[0].kind = WR_LIGHT_POINT, scene->lights[0].where.z = 2.1;
        WrScene *hard = wr_scene_clone(scene);
        hard->lights[0].size_deg = 0;
        compared(scene, hard, &off, &effect);
        print_message("round %d: %g off, %g of effect\n", k, off, effect);
        assert_true(effect > 0.01);
        assert_true(off < 0.7 * effect);
        wr_scene_free(scene);
        wr_scene_free(hard);
    }
}

/* A straight ridge across the light's direction: over the floor behind it the horizon is straight, its slope is the
   ridge's height divided by the distance to its last texel, and the visible part of the light is a segment of its
   disc: 1/2 + (x sqrt(1 - x^2) + asin x) / pi. */
static void a_ridge_has_the_penumbra_of_a_disc(void **state)
{
    (void)state;
    enum { WIDE = 256, RIDGE = 16 };
    const double elevation = 21.3 * WR_PI / 180, radius = 6.7, height = 0.1;
    WrError err = { "" };
    WrField *field = wr_field_new(WIDE, 8, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, &err);
    for (int i = 0; i < RIDGE * 8; i++) wr_field_set(field, i % RIDGE, i / RIDGE, 1);
    WrScene *scene = shadowy("plane", height);
    scene->replicate_u = scene->replicate_v = 1;
    scene->scheme = WR_SCHEME_CENTRAL, scene->bump = WR_BUMP_BLINN;
    scene->material.ambient = 0, scene->material.diffuse = 1;
    scene->material.colour = (WrVec3){ 1, 1, 1 };
    scene->posed = true;
    scene->camera.fit = false, scene->camera.orthographic = true, scene->camera.size = 1;
    scene->camera.eye = (WrVec3){ 0, 0, 3 }, scene->camera.target = (WrVec3){ 0, 0, 0 };
    scene->lights[0].where = (WrVec3){ -cos(elevation), 0, sin(elevation) };
    scene->lights[0].size_deg = radius;
    WrRenderer *renderer = wr_renderer_new(NULL, "auto", &err);
    const WrFrameRequest request = {
        .field = field, .scene = scene, .width = SIDE, .height = SIDE
    };
    WrFrame frame;
    double worst = 0;
    int partly = 0;
    if (!wr_renderer_frame(renderer, &request, &frame, &err)) fail_msg("%s", err.text);
    for (int k = 0; k < SIDE; k++) {
        const double way = (k + 0.5) / SIDE - (RIDGE - 0.5) / WIDE;
        if (way < 0.05 || way > 0.8) continue;
        const double horizon = atan2(height, way);
        const double x = fmin(fmax((elevation - horizon) / (radius * WR_PI / 180), -1), 1);
        const double want = (0.5 + (x * sqrt(1 - x * x) + asin(x)) / WR_PI) * sin(elevation);
        const double got = (double)frame.rgba[4 * (SIDE * (SIDE / 2) + k)];
        worst = fmax(worst, fabs(got - want));
        partly += fabs(x) < 1;
    }
    print_message("ridge: %g off over %d pixels in part\n", worst, partly);
    assert_true(partly > 15);
    assert_true(worst < 3e-4);
    wr_renderer_free(renderer);
    wr_scene_free(scene);
    wr_field_free(field);
}

/* Ambient light alone, proportional to the visible sky: the reference marches in 48 directions. */
static void hollows_see_less_of_the_sky(void **state)
{
    (void)state;
    static const char *const surfaces[] = { "plane", "cylinder", "torus" };
    for (int k = 0; k < 3; k++) {
        double off, effect;
        WrScene *scene = shadowy(surfaces[k], k ? -0.12 : 0.06);
        scene->material.shadow = k == 1;
        scene->material.occlusion = true;
        scene->material.ambient = 0.8;
        if (k == 0) scene->light_count = 0;
        WrScene *open = wr_scene_clone(scene);
        open->material.occlusion = false;
        compared(scene, open, &off, &effect);
        print_message("%s: %g off, %g of effect\n", surfaces[k], off, effect);
        assert_true(effect > 0.05);
        assert_true(off < (k == 2 ? 0.4 : 0.25) * effect);
        wr_scene_free(scene);
        wr_scene_free(open);
    }
}

/* More directions are closer to the reference. */
static void directions_are_a_dial(void **state)
{
    (void)state;
    double off[2], effect;
    for (int k = 0; k < 2; k++) {
        WrScene *scene = shadowy("plane", 0.06);
        scene->material.occlusion = true;
        scene->material.ambient = 0.8;
        scene->light_count = 0;
        scene->dials.horizons = k ? 64 : 6; /* 4, a multiple of it */
        WrScene *open = wr_scene_clone(scene);
        open->material.occlusion = false;
        compared(scene, open, &off[k], &effect);
        wr_scene_free(scene);
        wr_scene_free(open);
    }
    print_message("4 directions: %g off, 64: %g\n", off[0], off[1]);
    assert_true(off[1] < 0.8 * off[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_have_the_shadows_of_marched_rays),
        cmocka_unit_test(displaced_surfaces_have_them_too),
        cmocka_unit_test(round_lamps_have_penumbras),
        cmocka_unit_test(a_ridge_has_the_penumbra_of_a_disc),
        cmocka_unit_test(hollows_see_less_of_the_sky),
        cmocka_unit_test(directions_are_a_dial),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
