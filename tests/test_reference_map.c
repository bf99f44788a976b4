/* The reference renders a normal map apart from the kernels: its normals and theirs agree, with and without a table's
   bump, on surfaces and meshes; what an inspector tells is the same. */
#include "test.h"
#include "test_mesh_grids.h"
#include "test_render_scenes.h"

#include "image/image.h"
#include "render/reference.h"
#include "scene/normal_map.h"

#define WIDE 90
#define HIGH 70

/* Random codes of any size: slopes up to about 1. */
static WrImage *random_map(int w, int h, int bits, int channels, uint64_t seed)
{
    TestRandom random = { seed };
    const double last = bits == 8 ? 255 : 65535;
    WrImage *image = wr_image_new(w, h, channels, NULL);
    image->type = bits == 8 ? WR_PIXEL_U8 : bits == 16 ? WR_PIXEL_U16 : WR_PIXEL_F32;
    for (int t = 0; t < w * h; t++) {
        const double p = 2 * test_random(&random) - 1, q = 2 * test_random(&random) - 1;
        const double length = sqrt(1 + p * p + q * q),
                     n[3] = { p / length, q / length, 1 / length };
        for (int c = 0; c < channels; c++)
            image->data[channels * t + c] =
                (float)(bits == 32 ? n[c] : floor(last * (n[c] / 2 + 0.5) + 0.5) / last);
    }
    return image;
}

static void put_map(WrScene *scene, WrImage *file, WrGreen green, int channels)
{
    WrNormalTold told;
    scene->normals.image = wr_normal_map_read(file, green, channels, &told, NULL);
    assert_non_null(scene->normals.image);
    scene->normals.strength = 1;
    wr_image_free(file);
}

/* The worst angle, degrees, between the picture's normals and the reference's, but for the few pixels where rounding
   decides which texel, which triangle or which side is met; and how many pixels have both. */
static double worst_angle(const WrScene *scene, const WrField *field, int *count)
{
    static float normals[HIGH][WIDE][3];
    static double angles[HIGH * WIDE];
    WrError err = { "" };
    WrPool *pool = wr_pool_new(2);
    WrRenderer *renderer = wr_renderer_new(pool, "auto", &err);
    const WrFrameRequest request = { .field = field,
                                     .scene = scene,
                                     .width = WIDE,
                                     .height = HIGH,
                                     .turn_deg = 15,
                                     .normals = normals[0][0] };
    const WrReferenceRequest truth = { .field = field,
                                       .scene = scene,
                                       .width = WIDE,
                                       .height = HIGH,
                                       .turn_deg = 15,
                                       .first = 1,
                                       .most = 1 };
    WrFrame frame;
    WrReference reference = { 0 };
    if (!wr_renderer_frame(renderer, &request, &frame, &err) ||
        !wr_reference_render(&truth, pool, &reference, &err))
        fail_msg("%s", err.text);
    *count = 0;
    for (int i = 0; i < WIDE * HIGH; i++) {
        const float *a = normals[0][i];
        const double *b = reference.normal + 3 * i;
        const double bb = b[0] * b[0] + b[1] * b[1] + b[2] * b[2];
        if (!(frame.rgba[4 * i + 3] > 0) || !(bb > 0)) continue;
        const double d[3] = { (double)a[0] - b[0], (double)a[1] - b[1], (double)a[2] - b[2] };
        const double angle = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) * 180 / WR_PI;
        int k = (*count)++;
        for (; k > 0 && angles[k - 1] < angle; k--) angles[k] = angles[k - 1];
        angles[k] = angle;
    }
    const double worst = angles[*count / 50];
    wr_reference_fini(&reference);
    wr_renderer_free(renderer);
    wr_pool_free(pool);
    return worst;
}

static WrScene *scene_number(int k)
{
    static const char *const surfaces[] = {
        "plane", "sphere", "torus", "cylinder", "mesh", "cube"
    };
    static const WrGreen greens[] = { WR_GREEN_UP, WR_GREEN_DOWN };
    static const int bits[] = { 8, 16, 32 };
    WrScene *scene = scene_of(surfaces[k % 6]);
    if (k % 6 == 4)
        wr_scene_set_triangles(scene, mesh_grid(on_sphere, 24, 12, true), "a.obj", NULL);
    put_map(scene, random_map(5 + 7 * k, 31 - k % 13, bits[k % 3], k % 4 == 3 ? 2 : 3, (uint64_t)k),
            greens[k / 2 % 2], k % 4 == 2 ? 2 : 0);
    scene->height = k % 2 ? 0.004 : 0;
    scene->scheme = WR_SCHEME_BSPLINE_FIT; /* the reference's */
    scene->normals.strength = k % 5 == 4 ? -0.3 : 0.4;
    if (k % 3 == 1) scene->normals.laid = (WrLaid){ .own = true, .ru = 1.5, .rv = k % 2 ? 1 : -2 };
    scene->bump = k % 7 == 5 ? WR_BUMP_INVARIANT : k % 7 == 3 ? WR_BUMP_EXACT : WR_BUMP_BLINN;
    if (k % 7 != 5 && scene->height != 0) scene->bump = WR_BUMP_EXACT; /* the truth */
    scene->dials.shading = WR_SHADING_DOUBLE;
    return scene;
}

static void pictures_have_the_references_normals(void **state)
{
    (void)state;
    for (int k = 0; k < (getenv("WR_FULL") ? 84 : 24); k++) {
        int count;
        WrScene *scene = scene_number(k);
        WrField *field = random_field(40, 29, 3);
        if (k % 9 == 8) {
            wr_field_free(field);
            field = wr_field_new(40, 29, WR_WRAP_CLAMP, WR_WRAP_PERIODIC, 0, NULL);
        }
        const double worst = worst_angle(scene, field, &count);
        if (getenv("WR_SHOW")) printf("%2d: %g of %d\n", k, worst, count);
        if (!(count > 300 && worst < 2e-3)) fail_msg("case %d: %g of %d", k, worst, count);
        wr_scene_free(scene);
        wr_field_free(field);
    }
}

/* The probe of a pixel has the normal of the picture, and the intensity. */
static void a_probe_has_the_map(void **state)
{
    (void)state;
    for (int k = 0; k < 12; k++) {
        WrScene *scene = scene_number(k);
        WrField *field = random_field(40, 29, 3);
        WrProbe with, without;
        Shot shot = shoot(scene, field, WIDE, HIGH, 1, "auto", false);
        WrError err = { "" };
        int seen = 0, same = 0;
        for (int i = 0; i < 40; i++) {
            const int x = 20 + 7 * i % 53, y = 15 + 5 * i % 41;
            if (!wr_reference_probe(field, scene, WIDE, HIGH, 15, x + 0.5, y + 0.5, &with, &err))
                fail_msg("%s", err.text);
            if (!with.hit) continue;
            seen++;
            const float *rgba = shot.frame.rgba + 4 * (WIDE * y + x);
            same += fabs((double)rgba[0] - with.rgb[0]) < 1e-3;
            const double strength = scene->normals.strength;
            scene->normals.strength = 0;
            assert_true(
                wr_reference_probe(field, scene, WIDE, HIGH, 15, x + 0.5, y + 0.5, &without, &err));
            scene->normals.strength = strength;
            assert_true(with.fu != without.fu && with.tilt_deg != without.tilt_deg);
        }
        if (!(seen > 3 && same >= seen - 1)) fail_msg("case %d: %d of %d", k, same, seen);
        put_away(&shot);
        wr_scene_free(scene);
        wr_field_free(field);
    }
}

/* Far away, under aa=filter: the mean of slopes, which many samples of the reference come near to. */
static void filtered_maps_come_near_the_reference(void **state)
{
    static const char *const surfaces[] = { "plane", "mesh", "sphere" };
    (void)state;
    for (int k = 0; k < 6; k++) {
        double error[2];
        WrScene *scene = scene_of(surfaces[k % 3]);
        if (k % 3 == 1)
            wr_scene_set_triangles(scene, mesh_grid(on_sphere, 48, 24, true), "a.obj", NULL);
        put_map(scene, random_map(190, 170, 16, 3, 5), WR_GREEN_UP, 0);
        scene->normals.strength = 0.1;
        scene->normals.laid = (WrLaid){ .own = true, .ru = 2, .rv = 2 };
        scene->material.specular = 0;
        WrField *field = wr_field_new(8, 8, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
        if (k / 3) scene->dials.footprint = WR_FOOTPRINT_ANISOTROPIC;
        const WrReferenceRequest truth = { .field = field,
                                           .scene = scene,
                                           .width = 48,
                                           .height = 48,
                                           .turn_deg = 15,
                                           .first = 8,
                                           .most = 8 };
        WrReference reference = { 0 };
        WrError err = { "" };
        if (!wr_reference_render(&truth, NULL, &reference, &err)) fail_msg("%s", err.text);
        for (int f = 0; f < 2; f++) {
            scene->dials.aa = f ? WR_AA_FILTER : WR_AA_POINT;
            Shot shot = shoot(scene, field, 48, 48, 1, "auto", false);
            double squares = 0;
            int inside = 0;
            for (int i = 0; i < 48 * 48; i++) {
                if (reference.rgba[4 * i + 3] < 1 || shot.frame.rgba[4 * i + 3] < 1) continue;
                const double d = (double)shot.frame.rgba[4 * i] - reference.rgba[4 * i];
                squares += d * d, inside++;
            }
            error[f] = sqrt(squares / inside);
            put_away(&shot);
        }
        if (getenv("WR_SHOW")) printf("%d: point %g, filter %g\n", k, error[0], error[1]);
        if (!(error[1] < error[0] / 3)) fail_msg("case %d: %g, filtered %g", k, error[0], error[1]);
        wr_reference_fini(&reference);
        wr_scene_free(scene);
        wr_field_free(field);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_have_the_references_normals),
        cmocka_unit_test(a_probe_has_the_map),
        cmocka_unit_test(filtered_maps_come_near_the_reference),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
