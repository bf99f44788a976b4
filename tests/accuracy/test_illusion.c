/* The illusion measurement against closed forms, and against pictures compared here. */
#include "test.h"
#include "render/render_scenes.h"

#include "accuracy/illusion.h"
#include "base/text.h"
#include "scene/objects.h"

static WrScene *ahead_of(const char *surface, double height, double distance)
{
    WrScene *scene = scene_of(surface);
    scene->still = scene->posed = true;
    scene->rotate_deg = (WrVec3){ 0, 0, 0 };
    scene->height = height;
    scene->camera.fit = false;
    scene->camera.eye = (WrVec3){ 0, 0, distance };
    scene->material.specular = 0;
    return scene;
}

static WrIllusion measured(const WrScene *scene, const WrField *field, int w, int h)
{
    const WrIllusionRequest request = {
        .field = field, .scene = scene, .width = w, .height = h, .threads = 2
    };
    WrIllusion out = { 0 };
    WrError err = { "" };
    if (!wr_illusion_measure(&request, &out, &err)) fail_msg("%s", err.text);
    return out;
}

/* A sphere of radius R and one of R + c seen from d: silhouettes at f r / sqrt(d^2 - r^2). The same point has the
   same light. */
static void a_raised_ball(void **state)
{
    (void)state;
    const double R = 0.83, c = 0.137, d = 4.1;
    WrField *field = level_field(7, 5, c / 0.73);
    WrScene *scene = ahead_of("sphere", 0.73, d);
    scene->shape.value[0] = R;
    WrIllusion it = measured(scene, field, 203, 201);
    const double f = 100.5 / tan(scene->camera.fov_deg * WR_PI / 360);
    const double inner = f * R / sqrt(d * d - R * R);
    const double outer = f * (R + c) / sqrt(d * d - (R + c) * (R + c));
    assert_near(it.hausdorff, outer - inner, 0.25);
    assert_near(it.outline / (WR_PI * (outer * outer - inner * inner)), 1, 0.01);
    assert_near(it.perimeter / (2 * WR_PI * inner), 1, 0.03);
    assert_near(it.outline_mean / ((outer * outer - inner * inner) / (2 * inner)), 1, 0.04);
    assert_near(it.shading_at, 0, 1e-7);
    assert_near(it.shadow, 0, 1e-7);
    assert_true(it.shading > 0.001);
    assert_true(it.way > it.way_mean && it.way < it.rise);
    wr_illusion_fini(&it);
    wr_scene_free(scene);
    wr_field_free(field);
}

/* A plane at d raised by c: its corner moves from f/d to f/(d - c) times (1/2, 1/2); bump mapping does not show
   this. */
static void a_raised_plane(void **state)
{
    (void)state;
    const double c = 0.4173, d = 2.9;
    WrField *field = level_field(7, 5, c);
    WrScene *scene = ahead_of("plane", 1, d);
    WrIllusion it = measured(scene, field, 180, 181);
    const double f = 90.5 / tan(scene->camera.fov_deg * WR_PI / 360);
    const double near = f / (d - c), far = f / d;
    assert_near(it.hausdorff, (near - far) / sqrt(2), 0.6);
    assert_near(it.outline / (near * near - far * far), 1, 0.01);
    assert_near(it.way, (near - far) / sqrt(2), 0.8);
    assert_near(it.shading_at, 0, 1e-7);
    wr_illusion_fini(&it);
    wr_scene_free(scene);
    wr_field_free(field);
}

/* RMS of a - b where c and d cover the whole pixel. */
static double apart(const float *a, const float *b, const float *c, const float *d, int count)
{
    double sum = 0;
    int common = 0;
    for (int i = 0; i < count; i++) {
        if (c[4 * i + 3] < 0.9999f || d[4 * i + 3] < 0.9999f) continue;
        common++;
        for (int k = 0; k < 3; k++) sum += pow((double)a[4 * i + k] - (double)b[4 * i + k], 2) / 3;
    }
    return sqrt(sum / common);
}

/* Outline, shading and shadow equal those of pictures rendered here one by one; D - B is their sum. */
static void the_parts_are_those_of_the_pictures(void **state)
{
    (void)state;
    enum { W = 73, H = 61 };
    WrField *field = random_field(17, 13, 8);
    WrScene *scene = scene_of("torus");
    scene->height = 0.09;
    scene->material.shadow = true; /* switched by the measurement itself */
    WrIllusion it = { 0 };
    const WrIllusionRequest request = {
        .field = field, .scene = scene, .width = W, .height = H, .turn_deg = 15, .threads = 1
    };
    assert_true(wr_illusion_measure(&request, &it, NULL));
    Shot shot[3];
    double outline = 0;
    scene->displaced = true; /* all are seen from a camera that fits this one */
    wr_scene_hold_camera(scene, scene, (double)W / H);
    for (int k = 0; k < 3; k++) {
        scene->displaced = k > 0, scene->material.shadow = k > 1;
        scene->dials.aa = WR_AA_SUPERSAMPLE, scene->dials.samples = 4, scene->dials.dice = 0.125;
        shot[k] = shoot(scene, field, W, H, 2, "auto", false);
    }
    const float *b = shot[0].frame.rgba, *d0 = shot[1].frame.rgba, *d = shot[2].frame.rgba;
    for (int i = 0; i < W * H; i++) outline += fabs((double)b[4 * i + 3] - (double)d[4 * i + 3]);
    assert_near(it.outline, outline, 1e-6);
    assert_near(it.shading, apart(b, d0, b, d, W * H), 1e-9);
    assert_near(it.shadow, apart(d, d0, b, d, W * H), 1e-9);
    assert_near(it.all, apart(d, b, b, d, W * H), 1e-9);
    assert_true(it.shadow > 0.01 && it.shading > 0.01);
    assert_true(it.all <= it.shading + it.shadow && it.all >= fabs(it.shading - it.shadow));
    for (int i = 0; i < W * H; i++)
        assert_near((double)it.map[3 * i], fabs((double)b[4 * i + 3] - (double)d[4 * i + 3]), 1e-6);
    for (int k = 0; k < 3; k++) put_away(&shot[k]);
    wr_illusion_fini(&it);
    wr_scene_free(scene);
    wr_field_free(field);
}

/* The displacement of pixels is proportional to the height: at the suggested height it stays within half a pixel. */
static void the_advice_holds(void **state)
{
    (void)state;
    WrField *field = random_field(17, 13, 8);
    WrScene *scene = scene_of("sphere");
    scene->height = 0.06;
    /* Lower ones are seen with the same camera. */
    wr_scene_hold_camera(scene, scene, 1);
    WrIllusion it = measured(scene, field, 120, 120);
    WrText text = { 0 };
    double height = 0;
    wr_illusion_advice(&it, &text);
    const char *below = strstr(wr_text_get(&text), "Below height ");
    assert_non_null(below);
    assert_int_equal(sscanf(below, "Below height %lf", &height), 1);
    assert_true(it.hausdorff > 1);
    wr_illusion_fini(&it);
    scene->height = height;
    it = measured(scene, field, 120, 120);
    assert_true(it.hausdorff < 0.55 && it.way < 0.5);
    wr_illusion_fini(&it);
    wr_text_fini(&text);
    wr_scene_free(scene);
    wr_field_free(field);
}

static void what_cannot_be_measured_is_refused(void **state)
{
    (void)state;
    WrField *field = level_field(7, 5, 1);
    WrScene *scene = scene_of("sphere");
    WrIllusionRequest request = { .field = field, .scene = scene, .width = 20, .height = 3000 };
    WrIllusion out = { 0 };
    WrError err = { "" };
    assert_false(wr_illusion_measure(&request, &out, &err));
    assert_non_null(strstr(err.text, "20x3000"));
    scene->height = 0, request.height = 20;
    assert_false(wr_illusion_measure(&request, &out, &err));
    assert_non_null(strstr(err.text, "nothing to displace"));
    wr_scene_free(scene);
    wr_field_free(field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_raised_ball),
        cmocka_unit_test(a_raised_plane),
        cmocka_unit_test(the_parts_are_those_of_the_pictures),
        cmocka_unit_test(the_advice_holds),
        cmocka_unit_test(what_cannot_be_measured_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
