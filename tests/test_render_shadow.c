/* Shadows that the relief throws on itself: pictures against the reference, which marches rays through the table. */
#include "test.h"
#include "test_render_scenes.h"

#include "field/field.h"
#include "render/reference.h"
#include "scene/scene.h"

#define SIDE 96

/* A few humps, nowhere alike; 61 x 47 texels. */
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

/* Pixels of the picture, in shares of those that are covered: that the relief darkens, and that the reference has otherwise
   by over a twentieth. */
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

/* Displaced, rays meet the surface itself again: horizons over the tangent plane are near that, but where the ground ends or
   bends. */
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_have_the_shadows_of_marched_rays),
        cmocka_unit_test(displaced_surfaces_have_them_too),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
