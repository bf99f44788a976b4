/* The renderer in hard cases: near planes, views from inside, edges, tiny patches, seams, back faces, odd sizes, NaN,
   scales of twenty decades, poles. */
#include "test.h"
#include "render_scenes.h"

#include "base/error.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/scene.h"
#include "base/vec.h"

static double mean_coverage(const Shot *shot)
{
    double sum = 0;
    int count = shot->frame.width * shot->frame.height;
    for (int i = 0; i < count; i++) sum += (double)shot->frame.rgba[4 * i + 3];
    return sum / count;
}

static void all_finite(const Shot *shot)
{
    for (size_t i = 0; i < frame_bytes(&shot->frame) / sizeof(float); i++)
        assert_true(isfinite(shot->frame.rgba[i]));
}

/* A camera inside the patch's extent: parts are behind the eye. The mesh must match closed forms of the same
   plane. */
static void hc82_hc83_a_patch_across_the_near_plane_is_clipped(void **state)
{
    (void)state;
    WrField *field = bumpy_field(32, 32);
    WrScene *scene = scene_of("plane");
    scene->camera = (WrCamera){
        .eye = { 0, 0.0, 0.05 }, .target = { 0, 1, 0 }, .up = { 0, 0, 1 }, .fov_deg = 90
    };
    Shot closed = shoot(scene, field, 120, 100, 2, "auto", false);
    /* The same square as a bent patch with its corner unmoved uses mesh and Newton. */
    wr_shape_default(WR_SURFACE_bent, &scene->shape);
    scene->shape.value[2] = scene->shape.value[3] = scene->shape.value[4] = 0;
    scene->posed = true;
    scene->rotate_deg = (WrVec3){ 0, 0, 0 };
    Shot mesh = shoot(scene, field, 120, 100, 2, "auto", false);
    all_finite(&closed);
    all_finite(&mesh);
    assert_true(closed.frame.covered > 2000);
    int differ = 0;
    for (int i = 0; i < 120 * 100; i++)
        differ += fabsf(closed.frame.rgba[4 * i] - mesh.frame.rgba[4 * i]) > 2e-3f;
    /* silhouettes, and the distant strip where texels are smaller than rounding */
    assert_true(differ < 60);
    put_away(&closed);
    put_away(&mesh);
    wr_scene_free(scene);
    wr_field_free(field);
}

static void hc84_from_inside_a_sphere_its_inside_is_seen_everywhere(void **state)
{
    (void)state;
    WrField *field = bumpy_field(32, 32);
    const char *const bodies[] = { "sphere", "cube", "torus" };
    for (int k = 0; k < 3; k++) {
        WrScene *scene = scene_of(bodies[k]);
        double x = k == 2 ? 1 : 0;
        scene->posed = true;
        scene->camera = (WrCamera){
            .eye = { x, 0, 0.1 }, .target = { x + 0.2, 1, 0.15 }, .up = { 0, 0, 1 }, .fov_deg = 80
        };
        WrFrameRequest request = { .field = field, .scene = scene, .width = 64, .height = 64 };
        Shot shot = shoot(scene, field, 64, 64, 1, "auto", false);
        assert_true(wr_renderer_frame(shot.renderer, &request, &shot.frame, NULL));
        all_finite(&shot);
        if (shot.frame.covered != 64 * 64)
            fail_msg("%s: %lld of 4096 pixels", bodies[k], (long long)shot.frame.covered);
        put_away(&shot);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

static void hc85_no_background_shows_through_shared_edges(void **state)
{
    (void)state;
    WrField *field = bumpy_field(32, 32);
    WrScene *scene = scene_of("bent");
    scene->shape.value[2] = scene->shape.value[3] = 0;
    scene->shape.value[4] = 0.3;
    scene->camera = (WrCamera){ .eye = { 0, 0, 1.2 }, .up = { 0, 1, 0 }, .fov_deg = 20 };
    scene->posed = true;
    for (int size = 97; size < 120; size += 11) { /* sizes that put edges on samples and beside
                                                     them */
        Shot shot = shoot(scene, field, size, size, 3, "auto", false);
        assert_int_equal(shot.frame.covered, size * size);
        put_away(&shot);
    }
    wr_scene_free(scene);
    wr_field_free(field);
}

static void hc86_a_patch_smaller_than_a_pixel_has_the_right_mean_coverage(void **state)
{
    (void)state;
    WrField *field = bumpy_field(32, 32);
    const char *const bodies[] = { "sphere", "bezier", "plane" };
    for (int k = 0; k < 3; k++) {
        WrScene *scene = scene_of(bodies[k]);
        scene->camera =
            (WrCamera){ .orthographic = true, .eye = { 0, 0, 9 }, .up = { 0, 1, 0 }, .size = 20 };
        scene->dials = (WrDials){ .aa = WR_AA_SUPERSAMPLE, .samples = 64 };
        Shot tiny = shoot(scene, field, 4, 4, 2, "auto", false); /* pixels of 5 x 5 units */
        scene->dials.samples = 2;
        Shot large = shoot(scene, field, 1024, 1024, 2, "auto", false);
        assert_true(mean_coverage(&large) > 0.0005);
        assert_near(mean_coverage(&tiny) / mean_coverage(&large), 1, 0.1);
        put_away(&tiny);
        put_away(&large);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

static void hc57_the_seam_of_a_closed_surface_does_not_show(void **state)
{
    (void)state;
    /* A cylinder rotated so that u = 0 faces the viewer, against one with its table rolled by half a period and
       rotated by half a turn: its seam is at the back. */
    WrField *field = bumpy_field(64, 32), *rolled = bumpy_field(64, 32);
    for (int j = 0; j < 32; j++)
        for (int i = 0; i < 64; i++)
            wr_field_set(rolled, i, j, wr_field_get(field, (i + 32) % 64, j));
    WrScene *scene = scene_of("cylinder");
    scene->replicate_u = 1;
    scene->posed = true;
    scene->rotate_deg = (WrVec3){ -90, 0, 0 };
    Shot seam = shoot(scene, field, 100, 100, 1, "auto", false);
    WrFrameRequest request = {
        .field = rolled, .scene = scene, .width = 100, .height = 100, .turn_deg = 195
    };
    Shot back = shoot(scene, field, 100, 100, 1, "auto", false);
    assert_true(wr_renderer_frame(back.renderer, &request, &back.frame, NULL));
    assert_near((double)worst_difference(&seam, &back), 0, 1e-4);
    put_away(&seam);
    put_away(&back);
    wr_scene_free(scene);
    wr_field_free(field);
    wr_field_free(rolled);
}

/* The paper: from behind, dents and bumps are exchanged. The plane from behind equals the plane from the front with
   its table mirrored and its heights negated. */
static void hc23_from_behind_dents_and_bumps_exchange(void **state)
{
    (void)state;
    WrField *field = bumpy_field(40, 40), *mirrored = bumpy_field(40, 40);
    for (int j = 0; j < 40; j++)
        for (int i = 0; i < 40; i++) wr_field_set(mirrored, i, j, -wr_field_get(field, 39 - i, j));
    WrScene *scene = scene_of("plane");
    scene->posed = true;
    scene->replicate_u = 1;
    WrFrameRequest behind = {
        .field = field, .scene = scene, .width = 80, .height = 80, .turn_deg = 180
    };
    WrFrameRequest front = { .field = mirrored, .scene = scene, .width = 80, .height = 80 };
    Shot a = shoot(scene, field, 80, 80, 1, "auto", false),
         b = shoot(scene, field, 80, 80, 1, "auto", false);
    assert_true(wr_renderer_frame(a.renderer, &behind, &a.frame, NULL));
    assert_true(wr_renderer_frame(b.renderer, &front, &b.frame, NULL));
    assert_true(a.frame.covered > 500);
    assert_near((double)worst_difference(&a, &b), 0, 2e-4);
    put_away(&a);
    put_away(&b);
    wr_scene_free(scene);
    wr_field_free(field);
    wr_field_free(mirrored);
}

static void hc92_the_mean_of_equal_samples_is_that_sample(void **state)
{
    (void)state;
    /* Flat plane, directional light and viewer: all samples of a pixel are equal. */
    WrField *flat = wr_field_new(8, 8, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    WrScene *scene = scene_of("plane");
    scene->camera =
        (WrCamera){ .orthographic = true, .eye = { 0, 0, 3 }, .up = { 0, 1, 0 }, .size = 0.5 };
    Shot point = shoot(scene, flat, 20, 20, 1, "auto", false);
    scene->dials.aa = WR_AA_SUPERSAMPLE;
    for (int k = 2; k <= 64; k *= 2) {
        scene->dials.samples = k;
        Shot many = shoot(scene, flat, 20, 20, 2, "auto", false);
        assert_true(same_picture(&point, &many));
        put_away(&many);
    }
    scene->dials.samples = 3;
    Shot three = shoot(scene, flat, 20, 20, 2, "auto", false);
    assert_near((double)worst_difference(&point, &three), 0, 8 * 6e-8);
    put_away(&three);
    put_away(&point);
    wr_scene_free(scene);
    wr_field_free(flat);
}

static void hc95_pictures_of_1x1_and_1xn_work_and_0_is_refused(void **state)
{
    (void)state;
    WrField *field = bumpy_field(16, 16);
    WrScene *scene = scene_of("sphere");
    const int sizes[][2] = { { 1, 1 }, { 1, 41 }, { 41, 1 }, { 257, 3 } };
    for (int k = 0; k < 4; k++) {
        Shot shot = shoot(scene, field, sizes[k][0], sizes[k][1], 2, "auto", false);
        assert_true(shot.frame.covered > 0);
        put_away(&shot);
    }
    WrError err = { "" };
    WrFrame frame;
    WrRenderer *renderer = wr_renderer_new(NULL, NULL, &err);
    const int bad[][2] = { { 0, 0 }, { 0, 5 }, { -1, 5 }, { 16385, 1 } };
    for (int k = 0; k < 4; k++) {
        WrFrameRequest request = {
            .field = field, .scene = scene, .width = bad[k][0], .height = bad[k][1]
        };
        assert_false(wr_renderer_frame(renderer, &request, &frame, &err));
        assert_non_null(strstr(err.text, "must be 1..16384"));
    }
    wr_renderer_free(renderer);
    wr_scene_free(scene);
    wr_field_free(field);
}

static void hc96_a_value_that_is_not_a_number_becomes_black_and_is_counted(void **state)
{
    (void)state;
    float rgba[] = { NAN, 0.5f, 0, 1, INFINITY, 1, 2, 1, -1, 0.25f, 1, 1 };
    WrFrame frame = { .width = 3, .height = 1, .rgba = rgba };
    uint8_t out[9];
    assert_int_equal(wr_frame_to_srgb8(&frame, &(const WrFrameCodes){ 0 }, false, out, NULL), 2);
    const uint8_t want[] = { 0, 188, 0, 0, 255, 255, 0, 137, 255 };
    assert_memory_equal(out, want, 9);
}

static void codes_of_8_bits_are_those_of_the_curve(void **state)
{
    (void)state;
    TestRandom random = { 12 };
    for (int i = 0; i < 20000; i++) {
        float x = (float)(i < 10000 ? i / 9999.0 : pow(test_random(&random), 4));
        float rgba[] = { x, x, x, 1 };
        WrFrame frame = { .width = 1, .height = 1, .rgba = rgba };
        uint8_t out[3];
        assert_int_equal(wr_frame_to_srgb8(&frame, &(const WrFrameCodes){ 0 }, false, out, NULL),
                         0);
        double code = 255 * (double)wr_srgb_encode(x); /* within rounding of the float borders */
        assert_near(out[0], code, 0.5 + 2e-4);
    }
}

static void scales_of_20_decades_give_the_same_picture(void **state)
{
    (void)state;
    WrField *field = bumpy_field(32, 32);
    /* HC09 in pictures: object, height and camera scaled together */
    const double scales[] = { 1e-20, 1e20 };
    for (int k = 0; k < 2; k++) {
        WrScene *scene = scene_of("torus");
        Shot plain = shoot(scene, field, 64, 64, 1, "auto", false);
        for (int i = 0; i < 2; i++) scene->shape.value[i] *= scales[k];
        scene->height *= scales[k];
        Shot scaled = shoot(scene, field, 64, 64, 1, "auto", false);
        assert_near((double)worst_difference(&plain, &scaled), 0, 2e-3);
        put_away(&plain);
        put_away(&scaled);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

static void poles_are_finite_whatever_the_table(void **state)
{
    (void)state;
    /* HC03, HC148: look straight down on the pole of a sphere with a rough table. */
    WrField *field = bumpy_field(64, 64);
    TestRandom random = { 3 };
    for (int i = 0; i < 64; i++)
        for (int j = 0; j < 64; j++) wr_field_set(field, i, j, (float)test_random(&random));
    for (int mode = 0; mode < WR_BUMP_COUNT; mode++) {
        WrScene *scene = scene_of("sphere");
        scene->posed = true;
        scene->bump = (WrBumpMode)mode;
        Shot shot =
            shoot(scene, field, 65, 65, 1, "auto", false); /* the centre pixel is the pole */
        all_finite(&shot);
        assert_true(shot.frame.rgba[4 * (32 * 65 + 32) + 3] == 1);
        put_away(&shot);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

static void what_lies_under_a_pixel_is_found(void **state)
{
    (void)state;
    WrField *field = bumpy_field(16, 16);
    for (int kind = 0; kind < WR_SURFACE_COUNT; kind++) {
        WrScene *scene = scene_of(wr_surfaces[kind]->name);
        Shot shot = shoot(scene, field, 90, 70, 1, "auto", false);
        WrPlacement place;
        assert_true(wr_scene_place(scene, 15, 90.0 / 70, &place, NULL));
        int found = 0;
        for (int y = 0; y < 70; y += 5)
            for (int x = 0; x < 90; x += 5) {
                double u, v;
                int face;
                bool hit = wr_renderer_pick(shot.renderer, x + 0.5, y + 0.5, &u, &v, &face);
                assert_true(hit == (shot.frame.rgba[4 * (y * 90 + x) + 3] > 0));
                if (!hit) continue;
                WrSurfacePoint at; /* the hit must be on the pixel's ray */
                wr_surface_at(&scene->shape, face, u, v, &at);
                WrVec3 p = v3_sub(at.p, place.centre);
                const double *m = place.rotation;
                WrVec3 w = { m[0] * p.x + m[1] * p.y + m[2] * p.z,
                             m[3] * p.x + m[4] * p.y + m[5] * p.z,
                             m[6] * p.x + m[7] * p.y + m[8] * p.z };
                w = v3_sub(w, place.eye);
                double depth = v3_dot(w, place.forward), half = place.half_height;
                double sx = (v3_dot(w, place.right) / depth / half * 70 / 90 + 1) * 45;
                double sy = (1 - v3_dot(w, place.up) / depth / half) * 35;
                assert_near(sx, x + 0.5, 0.3);
                assert_near(sy, y + 0.5, 0.3);
                found++;
            }
        assert_true(found > 10);
        assert_false(
            wr_renderer_pick(shot.renderer, -1, 5, &(double){ 0 }, &(double){ 0 }, &(int){ 0 }));
        put_away(&shot);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

/* Tiles outside the object's bounds are skipped: compare with intersection tests that do not use them. */
static void no_pixel_is_lost_wherever_the_camera_stands(void **state)
{
    (void)state;
    enum { W = 70, H = 53 };
    TestRandom random = { 11 };
    WrField *field = bumpy_field(8, 8);
    int covered = 0, clipped = 0;
    const int count = test_amount(60, 22); /* all surfaces */
    for (int n = 0; n < count; n++) {
        WrScene *scene = scene_of(wr_surfaces[n % WR_SURFACE_COUNT]->name);
        WrCamera *camera = &scene->camera;
        const double far = n % 4 == 0 ? 0.6 : 1 + 4 * test_random(&random);
        double *eye[] = { &camera->eye.x, &camera->eye.y, &camera->eye.z };
        double *target[] = { &camera->target.x, &camera->target.y, &camera->target.z };
        for (int i = 0; i < 3; i++) {
            *eye[i] = far * (2 * test_random(&random) - 1);
            *target[i] = 1.2 * (2 * test_random(&random) - 1);
        }
        camera->fit = false;
        camera->orthographic = n % 3 == 0;
        camera->size = 0.5 + 3 * test_random(&random);
        camera->fov_deg = 20 + 100 * test_random(&random);
        Shot shot = shoot(scene, field, W, H, 1, "auto", false);
        int seen = 0;
        for (int y = 0; y < H; y++)
            for (int x = 0; x < W; x++) {
                double u, v;
                int face;
                const bool hit = wr_renderer_pick(shot.renderer, x, y, &u, &v, &face);
                if (hit != (shot.frame.rgba[4 * (y * W + x) + 3] > 0))
                    fail_msg("%s, camera %d: pixel %d,%d %s", wr_surfaces[scene->shape.kind]->name,
                             n, x, y, hit ? "is lost" : "comes from nowhere");
                seen += hit;
            }
        covered += seen > 0;
        clipped += seen > 0 && seen < W * H;
        put_away(&shot);
        wr_scene_free(scene);
    }
    assert_true(3 * covered > count && 6 * clipped > count);
    wr_field_free(field);
}

static void a_cancelled_frame_says_so(void **state)
{
    (void)state;
    WrField *field = bumpy_field(16, 16);
    WrScene *scene = scene_of("sphere");
    WrError err = { "" };
    WrFrame frame;
    volatile int cancel = 1;
    WrRenderer *renderer = wr_renderer_new(NULL, NULL, &err);
    WrFrameRequest request = {
        .field = field, .scene = scene, .width = 64, .height = 64, .cancel = &cancel
    };
    assert_false(wr_renderer_frame(renderer, &request, &frame, &err));
    assert_string_equal(err.text, "cancelled");
    wr_renderer_free(renderer);
    wr_scene_free(scene);
    wr_field_free(field);
}

static void a_white_picture_changes_nothing_and_a_grey_one_scales(void **state)
{
    (void)state;
    WrField *field = bumpy_field(16, 16);
    WrScene *scene = scene_of("sphere");
    scene->material.specular = 0;
    Shot plain = shoot(scene, field, 64, 64, 1, "auto", false);
    scene->colour = wr_image_new(3, 2, 3, NULL);
    for (int i = 0; i < 18; i++) scene->colour->data[i] = 0.5f;
    Shot grey = shoot(scene, field, 64, 64, 1, "auto", false);
    for (int i = 0; i < 64 * 64; i++)
        assert_near((double)grey.frame.rgba[4 * i], 0.5 * (double)plain.frame.rgba[4 * i], 1e-6);
    for (int i = 0; i < 18; i++) scene->colour->data[i] = 1.0f;
    Shot white = shoot(scene, field, 64, 64, 1, "auto", false);
    assert_false(wr_plan_runs(white.frame.plan, WR_EFFECT_COLOUR));
    assert_true(same_picture(&plain, &white));
    put_away(&plain);
    put_away(&grey);
    put_away(&white);
    wr_scene_free(scene);
    wr_field_free(field);
}

/* Number of a pixel's samples on a cube, by slabs in double precision, from the placement alone. */
static int samples_on_cube(const WrPlacement *at, double half, int side, int k, int i, int j)
{
    int on = 0;
    for (int n = 0; n < k * k; n++) {
        const double x = (2 * (i + (n % k + 0.5) / k) / side - 1) * at->half_height;
        const double y = (1 - 2 * (j + (n / k + 0.5) / k) / side) * at->half_height;
        const WrVec3 d = v3_add(at->forward, v3_add(v3_scale(at->right, x), v3_scale(at->up, y)));
        double low = -INFINITY, high = INFINITY;
        for (int axis = 0; axis < 3; axis++) { /* to object space: by the rotation's columns */
            const double *r = at->rotation + axis;
            const double o = r[0] * at->eye.x + r[3] * at->eye.y + r[6] * at->eye.z;
            const double v = r[0] * d.x + r[3] * d.y + r[6] * d.z;
            low = fmax(low, fmin((-half - o) / v, (half - o) / v));
            high = fmin(high, fmax((-half - o) / v, (half - o) / v));
        }
        on += high > low;
    }
    return on;
}

/* Faces meet without gaps and do not extend beyond the object: no sample beside it is covered. */
static void outlines_of_flat_faces_have_the_samples_that_are_on_them(void **state)
{
    (void)state;
    enum { VIEW = 400 };
    WrError err;
    WrPlacement placed;
    WrField *field = bumpy_field(32, 32);
    WrScene *scene = scene_of("cube");
    scene->shape.value[0] = 0.6;
    scene->posed = true;
    scene->rotate_deg = (WrVec3){ 28, -53, 0 }; /* pictures are rotated by 15 */
    scene->camera.fit = true;
    scene->camera.fov_deg = 35;
    scene->camera.target = (WrVec3){ 0, 0, 0 };
    scene->camera.eye = (WrVec3){ 0, 0, 1 };
    scene->dials.aa = WR_AA_SUPERSAMPLE;
    scene->dials.samples = 4;
    assert_true(wr_scene_place(scene, 15, 1, &placed, &err));
    Shot shot = shoot(scene, field, VIEW, VIEW, 1, "auto", false);
    const WrFrame frame = shot.frame;
    int outline = 0;
    for (int n = 0; n < VIEW * VIEW; n++) {
        const double covered = 16 * (double)frame.rgba[4 * n + 3];
        if (covered <= 0 || covered >= 16) continue;
        const int on = samples_on_cube(&placed, 0.6, VIEW, 4, n % VIEW, n / VIEW);
        outline++;
        if (on != (int)lrint(covered))
            fail_msg("pixel %d, %d: %g samples, not %d", n % VIEW, n / VIEW, covered, on);
    }
    assert_true(outline > 900);
    put_away(&shot);
    wr_scene_free(scene);
    wr_field_free(field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hc82_hc83_a_patch_across_the_near_plane_is_clipped),
        cmocka_unit_test(hc84_from_inside_a_sphere_its_inside_is_seen_everywhere),
        cmocka_unit_test(hc85_no_background_shows_through_shared_edges),
        cmocka_unit_test(hc86_a_patch_smaller_than_a_pixel_has_the_right_mean_coverage),
        cmocka_unit_test(hc57_the_seam_of_a_closed_surface_does_not_show),
        cmocka_unit_test(hc23_from_behind_dents_and_bumps_exchange),
        cmocka_unit_test(hc92_the_mean_of_equal_samples_is_that_sample),
        cmocka_unit_test(hc95_pictures_of_1x1_and_1xn_work_and_0_is_refused),
        cmocka_unit_test(hc96_a_value_that_is_not_a_number_becomes_black_and_is_counted),
        cmocka_unit_test(codes_of_8_bits_are_those_of_the_curve),
        cmocka_unit_test(scales_of_20_decades_give_the_same_picture),
        cmocka_unit_test(poles_are_finite_whatever_the_table),
        cmocka_unit_test(what_lies_under_a_pixel_is_found),
        cmocka_unit_test(no_pixel_is_lost_wherever_the_camera_stands),
        cmocka_unit_test(a_cancelled_frame_says_so),
        cmocka_unit_test(a_white_picture_changes_nothing_and_a_grey_one_scales),
        cmocka_unit_test(outlines_of_flat_faces_have_the_samples_that_are_on_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
