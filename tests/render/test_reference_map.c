/* Normal maps in the reference, independently of the kernels: both sets of normals agree, with and without a table's
   bump, on surfaces and meshes; the inspector's values are the same. */
#include "test.h"
#include "field/scheme_list.h"
#include "mesh_grids.h"
#include "render_scenes.h"

#include "image/image.h"
#include "render/reference/reference.h"
#include "scene/normal_map.h"
#include "scene/objects.h"

#define WIDE 63
#define HIGH 48

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
    WrNormalMapReport told;
    scene->normals.image = wr_normal_map_decode(file, green, channels, WR_CODING_AUTO, &told, NULL);
    assert_non_null(scene->normals.image);
    scene->normals.strength = 1;
    wr_image_free(file);
}

static int falling(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x < y) - (x > y);
}

/* The largest angle in degrees between the picture's normals and the reference's, except for the few pixels where
   rounding decides about texel, triangle or side; and the number of pixels with both. */
static double worst_angle(const WrScene *scene, const WrField *field, int *count)
{
    static float normals[HIGH * WIDE][3];
    static double angles[HIGH * WIDE];
    WrError err = { "" };
    WrPool *pool = wr_pool_new(2);
    WrRenderer *renderer = wr_renderer_new(pool, "auto", &err);
    const WrFrameRequest request = { .field = field,
                                     .scene = scene,
                                     .width = WIDE,
                                     .height = HIGH,
                                     .turn_deg = 15,
                                     .normals = normals[0] };
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
        const float *a = normals[i];
        const double *b = reference.normal + 3 * i;
        const double bb = b[0] * b[0] + b[1] * b[1] + b[2] * b[2];
        if (!(frame.rgba[4 * i + 3] > 0) || !(bb > 0)) continue;
        const double d[3] = { (double)a[0] - b[0], (double)a[1] - b[1], (double)a[2] - b[2] };
        const double angle = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) * 180 / WR_PI;
        angles[(*count)++] = angle;
    }
    qsort(angles, (size_t)*count, sizeof *angles, falling);
    const double worst = angles[*count / 50];
    wr_reference_fini(&reference);
    wr_renderer_free(renderer);
    wr_pool_free(pool);
    return worst;
}

/* With tangent frames, or along the object's axes. */
static void turn_by(WrScene *scene, int k)
{
    static const WrNormalFrame frames[] = { WR_FRAME_MIKK, WR_FRAME_LECTURE, WR_FRAME_AUTO };
    WrNormalMapReport told;
    scene->normals.frame = frames[k % 3];
    if (k % 4 != 1) return;
    WrImage *file = random_map(19, 23, 16, 3, 9);
    for (int i = 0; i < 3 * 19 * 23; i += 3) file->data[i + 1 + k % 2] = 1 - file->data[i];
    wr_image_free(scene->normals.image);
    scene->normals.image = wr_normal_map_read_object(file, k % 8 == 1, WR_CODING_AUTO, &told, NULL);
    scene->normals.object = true;
    wr_image_free(file);
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
    if (k % 3 == 1)
        scene->normals.laid = (WrTextureSample){ .own = true, .ru = 1.5, .rv = k % 2 ? 1 : -2 };
    scene->bump = k % 7 == 5 ? WR_BUMP_INVARIANT : k % 7 == 3 ? WR_BUMP_EXACT : WR_BUMP_BLINN;
    if (k >= 12) turn_by(scene, k / 2 + k / 12);
    if (k % 7 != 5 && scene->height != 0) scene->bump = WR_BUMP_EXACT; /* the exact formula */
    scene->dials.shading = WR_SHADING_DOUBLE;
    if (k % 5 == 3) /* normals along the object's axes transform by cofactors, mirrored or not */
        scene->sizes = (WrVec3){ 1, 0.6, k % 2 ? -0.8 : 0.8 };
    return scene;
}

static void pictures_have_the_references_normals(void **state)
{
    (void)state;
    for (int k = 0; k < (getenv("WR_FULL") ? 168 : 36); k++) {
        int count;
        WrScene *scene = scene_number(k);
        WrField *field = random_field(40, 29, 3);
        if (k % 9 == 8) {
            wr_field_free(field);
            field = wr_field_new(40, 29, WR_WRAP_CLAMP, WR_WRAP_PERIODIC, 0, NULL);
        }
        const double worst = worst_angle(scene, field, &count);
        if (getenv("WR_SHOW")) printf("%2d: %g of %d\n", k, worst, count);
        if (!(count > 150 && worst < 2e-3)) fail_msg("case %d: %g of %d", k, worst, count);
        wr_scene_free(scene);
        wr_field_free(field);
    }
}

/* Relief that turns with the map: kernels and reference in all frames, bump modes and repetitions. */
static void relief_over_a_map_has_the_references_normals(void **state)
{
    (void)state;
    for (int k = 0; k < (getenv("WR_FULL") ? 168 : 48); k++) {
        int count;
        WrScene *scene = scene_number(k);
        WrField *field = random_field(41, 29, 3);
        if (scene->height == 0) scene->height = 0.003;
        scene->normals.combine = k / 2 % 2 ? WR_COMBINE_SURFACE : WR_COMBINE_REORIENTED;
        if (scene->bump == WR_BUMP_BLINN) scene->bump = WR_BUMP_EXACT;
        const double worst = worst_angle(scene, field, &count);
        if (getenv("WR_SHOW")) printf("%2d: %g of %d\n", k, worst, count);
        if (!(count > 150 && worst < 2e-3)) fail_msg("case %d: %g of %d", k, worst, count);
        wr_scene_free(scene);
        wr_field_free(field);
    }
}

/* A plane whose map leans by one slope everywhere: reoriented normals are those of the plane without a map, turned
   as the map turns z (Rodrigues); added slopes are not. In single precision too. */
static void on_a_leaning_plane_the_relief_is_turned(void **state)
{
    static float normals[3][40 * 37][3];
    (void)state;
    for (int k = 0; k < 12; k++) {
        const double p = 0.37 + 0.09 * k, q = 0.81 - 0.13 * k;
        const double length = sqrt(1 + p * p + q * q);
        const double axis[3] = { q / hypot(p, q), -p / hypot(p, q), 0 }; /* z x (-p, -q, 1) */
        WrField *field = random_field(23, 31, (uint64_t)k);
        WrRenderer *renderer = wr_renderer_new(NULL, "auto", NULL);
        WrScene *scene = scene_of("plane");
        WrImage *file = wr_image_new(3, 2, 3, NULL);
        file->type = WR_PIXEL_F32;
        for (int t = 0; t < 18; t += 3) {
            file->data[t] = (float)(-p / length), file->data[t + 1] = (float)(-q / length);
            file->data[t + 2] = (float)(1 / length);
        }
        put_map(scene, file, WR_GREEN_UP, 0);
        scene->normals.laid = (WrTextureSample){ .own = true, .ru = 1, .rv = 1 };
        scene->normals.frame = k % 3 == 1   ? WR_FRAME_MIKK
                               : k % 3 == 2 ? WR_FRAME_LECTURE
                                            : WR_FRAME_GRADIENT;
        scene->height = 0.01;
        scene->posed = true, scene->rotate_deg = (WrVec3){ 0, -15, 0 };
        if (k % 2) scene->dials.shading = WR_SHADING_DOUBLE;
        WrFrame frame;
        for (int s = 0; s < 3; s++) {
            const WrFrameRequest request = { .field = field,
                                             .scene = scene,
                                             .width = 40,
                                             .height = 37,
                                             .turn_deg = 15,
                                             .normals = normals[s][0] };
            scene->normals.strength = s > 0;
            scene->normals.combine = s == 1 ? WR_COMBINE_REORIENTED : WR_COMBINE_SLOPES;
            assert_true(wr_renderer_frame(renderer, &request, &frame, NULL));
        }
        int seen = 0;
        double worst = 0, added = 0;
        for (int i = 0; i < 40 * 37; i++) {
            if (!(frame.rgba[4 * i + 3] > 0)) continue;
            const float *d = normals[0][i];
            const double c = 1 / length, s = sqrt(1 - c * c);
            const double a[3] = { (double)d[0], (double)d[1], (double)d[2] };
            const double along = (axis[0] * a[0] + axis[1] * a[1]) * (1 - c);
            const double want[3] = { a[0] * c + axis[1] * a[2] * s + axis[0] * along,
                                     a[1] * c - axis[0] * a[2] * s + axis[1] * along,
                                     a[2] * c + (axis[0] * a[1] - axis[1] * a[0]) * s };
            seen++;
            for (int j = 0; j < 3 && want[2] > 0.01; j++) {
                worst = fmax(worst, fabs((double)normals[1][i][j] - want[j]));
                added = fmax(added, fabs((double)normals[2][i][j] - want[j]));
            }
        }
        if (getenv("WR_SHOW")) printf("%2d: turned %g, added %g\n", k, worst, added);
        if (!(seen > 300 && worst < 2e-5 && added > 0.05))
            fail_msg("case %d: %g, added %g", k, worst, added);
        wr_renderer_free(renderer);
        wr_scene_free(scene);
        wr_field_free(field);
    }
}

/* A mesh in front of another, both with tangent frames: a hidden point does not use the other mesh's triangles. */
static void objects_that_hide_each_other_have_them_too(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        int count;
        WrScene *first = scene_number(k ? 16 : 28);
        WrScene *scene = wr_scene_add_object(first, true);
        WrField *field = random_field(40, 29, 3);
        scene->at = (WrVec3){ 0.7, 0.3, 0.5 };
        const double worst = worst_angle(scene, field, &count);
        if (!(count > 300 && worst < 1e-3)) fail_msg("case %d: %g of %d", k, worst, count);
        wr_scene_free(scene);
        wr_scene_free(first);
        wr_field_free(field);
    }
}

/* ---- frames computed by hand ---- */

typedef struct Corner {
    float p[3], uv[2];
} Corner;

static WrTriangles *triangle_of(const Corner corner[3])
{
    float p[3][3], uv[3][2];
    float n[3][3] = { { 0, 0, 1 }, { 0, 0, 1 }, { 0, 0, 1 } };
    int32_t corners[1][3] = { { 0, 1, 2 } };
    for (int k = 0; k < 3; k++)
        memcpy(p[k], corner[k].p, sizeof p[k]), memcpy(uv[k], corner[k].uv, sizeof uv[k]);
    const WrTrianglesSource source = { .points = (const float(*)[3])p,
                                       .normals = (const float(*)[3])n,
                                       .uv = (const float(*)[2])uv,
                                       .corners = (const int32_t(*)[3])corners,
                                       .point_count = 3,
                                       .triangle_count = 1 };
    return wr_triangles_new(&source, NULL);
}

/* Sheared (u,v): T by hand is (2,-1,0), and B in the lecture is (1,1,0), normalised; MikkTSpace's B is n x T.
   Mirrored, both run against v. The map tilts by 0.6 along x, or y, everywhere. */
static void one_triangle_turns_the_map_as_by_hand(void **state)
{
    static const Corner sheared[3] = { { { 0, 0, 0 }, { 0.5f, 0 } },
                                       { { 1, 0, 0 }, { 1, 0.5f } },
                                       { { 0, 1, 0 }, { 0, 1 } } };
    const double a = 1 / sqrt(5), b = 1 / sqrt(2);
    const struct {
        WrNormalFrame frame;
        int channel;
        double x, y;
    } cases[] = { { WR_FRAME_AUTO, 0, 2 * a, -a },
                  { WR_FRAME_AUTO, 1, a, 2 * a },
                  { WR_FRAME_LECTURE, 0, 2 * a, -a },
                  { WR_FRAME_LECTURE, 1, b, b },
                  { WR_FRAME_OBJECT, 1, 0, 1 } };
    (void)state;
    for (int k = 0; k < 20; k++) {
        const int which = k % 5, mirrored = k / 5 % 2;
        const double sign = mirrored && cases[which].frame != WR_FRAME_OBJECT ? -1 : 1;
        Corner corner[3];
        WrScene *scene = scene_of("mesh");
        WrImage *file = wr_image_new(2, 2, 3, NULL);
        WrNormalMapReport told;
        memcpy(corner, sheared, sizeof corner);
        for (int i = 0; i < 3 && mirrored; i++) corner[i].uv[0] = 1 - corner[i].uv[0];
        wr_scene_set_triangles(scene, triangle_of(corner), "a.obj", NULL);
        file->type = WR_PIXEL_F32;
        for (int i = 0; i < 12; i += 3)
            file->data[i + cases[which].channel] = 0.6f, file->data[i + 2] = 0.8f;
        scene->normals.object = cases[which].frame == WR_FRAME_OBJECT;
        scene->normals.frame = scene->normals.object ? WR_FRAME_AUTO : cases[which].frame;
        scene->normals.image =
            scene->normals.object
                ? wr_normal_map_read_object(file, false, WR_CODING_AUTO, &told, NULL)
                : wr_normal_map_decode(file, WR_GREEN_UP, 0, WR_CODING_AUTO, &told, NULL);
        scene->normals.strength = 1;
        if (k >= 10) scene->bump = WR_BUMP_INVARIANT, scene->dials.aa = WR_AA_FILTER;
        scene->posed = true, scene->rotate_deg = (WrVec3){ 0, -15, 0 };
        static float normals[40 * 40][3];
        WrField *field = wr_field_new(8, 8, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
        WrRenderer *renderer = wr_renderer_new(NULL, "auto", NULL);
        const WrFrameRequest request = { .field = field,
                                         .scene = scene,
                                         .width = 40,
                                         .height = 40,
                                         .turn_deg = 15,
                                         .normals = normals[0] };
        WrFrame frame;
        int seen = 0;
        assert_true(wr_renderer_frame(renderer, &request, &frame, NULL));
        /* mirrored in u: T is reversed, and MikkTSpace's B stays, since the sign reverses n x T */
        const double turn = cases[which].channel == 0 ? sign : 1;
        for (int i = 0; i < 40 * 40; i++) {
            const float *n = normals[i];
            WrProbe probe;
            if (!(frame.rgba[4 * i + 3] > 0)) continue;
            seen++;
            assert_near((double)n[0], 0.6 * turn * cases[which].x, 1e-5);
            assert_near((double)n[1], 0.6 * turn * cases[which].y, 1e-5);
            assert_near((double)n[2], 0.8, 1e-5);
            if (seen % 50) continue;
            assert_true(wr_reference_probe(field, scene, 40, 40, 15, i % 40 + 0.5, i / 40 + 0.5,
                                           &probe, NULL));
            assert_near(probe.perturbed.x, 0.6 * turn * cases[which].x, 1e-7);
            assert_near(probe.perturbed.y, 0.6 * turn * cases[which].y, 1e-7);
        }
        assert_true(seen > 100);
        wr_renderer_free(renderer);
        wr_image_free(file);
        wr_field_free(field);
        wr_scene_free(scene);
    }
}

/* A fold: the corner normals differ by 50 degrees, so their mean between them is shorter than 1. The lecture's n' =
   0.6 T + 0.8 N uses unit vectors; with the unnormalised mean, the map would tilt by 2 degrees more. */
static void a_fold_takes_the_normal_of_length_1(void **state)
{
    static const float p[3][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } };
    static const float uv[3][2] = { { 0.5f, 0 }, { 1, 0.5f }, { 0, 1 } };
    static const int32_t corners[1][3] = { { 0, 1, 2 } };
    const double lean = 50 / 57.29577951308232;
    const float n[3][3] = { { 0, 0, 1 }, { 0, 0, 1 }, { 0, (float)sin(lean), (float)cos(lean) } };
    (void)state;
    const WrTrianglesSource source = { .points = p,
                                       .normals = n,
                                       .uv = uv,
                                       .corners = corners,
                                       .point_count = 3,
                                       .triangle_count = 1 };
    WrScene *scene = scene_of("mesh");
    wr_scene_set_triangles(scene, wr_triangles_new(&source, NULL), "a.obj", NULL);
    WrImage *file = wr_image_new(2, 2, 3, NULL);
    file->type = WR_PIXEL_F32;
    for (int i = 0; i < 12; i += 3) file->data[i] = 0.6f, file->data[i + 2] = 0.8f;
    scene->normals.frame = WR_FRAME_LECTURE;
    put_map(scene, file, WR_GREEN_UP, 0);
    scene->posed = true, scene->rotate_deg = (WrVec3){ 0, -15, 0 };
    static float normals[40 * 40][3];
    WrField *field = wr_field_new(8, 8, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    WrRenderer *renderer = wr_renderer_new(NULL, "auto", NULL);
    const WrFrameRequest request = { .field = field,
                                     .scene = scene,
                                     .width = 40,
                                     .height = 40,
                                     .turn_deg = 15,
                                     .normals = normals[0] };
    WrFrame frame;
    int seen = 0;
    assert_true(wr_renderer_frame(renderer, &request, &frame, NULL));
    for (int i = 0; i < 40 * 40; i++) {
        WrProbe probe;
        if (!(frame.rgba[4 * i + 3] > 0)) continue;
        if (!wr_reference_probe(field, scene, 40, 40, 15, i % 40 + 0.5, i / 40 + 0.5, &probe,
                                NULL) ||
            !probe.hit)
            continue;
        /* (u, v) = (1/2, 0) + b (1/2, 1/2) + c (-1/2, 1): b and c are the weights of the second and third corner */
        const double du = probe.u - 0.5, b = (2 * du + probe.v) * 2 / 3, c = probe.v - b / 2;
        const double mean[3] = { 0, c * sin(lean), 1 - c + c * cos(lean) };
        const double length = sqrt(mean[1] * mean[1] + mean[2] * mean[2]), t = 1 / sqrt(5);
        double want[3] = { 0.6 * 2 * t, -0.6 * t + 0.8 * mean[1] / length, 0.8 * mean[2] / length };
        const double unit = sqrt(want[0] * want[0] + want[1] * want[1] + want[2] * want[2]);
        const double got[3] = { probe.perturbed.x, probe.perturbed.y, probe.perturbed.z };
        for (int k = 0; k < 3; k++) {
            assert_near(got[k], want[k] / unit, 1e-6);
            assert_near((double)normals[i][k], want[k] / unit, 2e-5);
        }
        seen++;
    }
    assert_true(seen > 100);
    wr_renderer_free(renderer);
    wr_field_free(field);
    wr_scene_free(scene);
}

/* The probe of a pixel has the picture's normal and intensity. */
static void a_probe_has_the_map(void **state)
{
    (void)state;
    for (int k = 0; k < 36; k += 2) {
        WrScene *scene = scene_number(k);
        WrField *field = random_field(40, 29, 3);
        WrProbe with, without;
        Shot shot = shoot(scene, field, WIDE, HIGH, 1, "auto", false);
        WrError err = { "" };
        int seen = 0, same = 0;
        for (int i = 0; i < 10; i++) {
            const int x = 14 + 7 * i % 37, y = 10 + 5 * i % 29;
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

/* Far away, with aa=filter: the mean of slopes, close to many samples of the reference. */
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
        scene->normals.laid = (WrTextureSample){ .own = true, .ru = 2, .rv = 2 };
        scene->material.specular = 0;
        WrField *field = wr_field_new(8, 8, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
        if (k / 3) scene->dials.footprint = WR_FOOTPRINT_ANISOTROPIC;
        const WrReferenceRequest truth = { .field = field,
                                           .scene = scene,
                                           .width = 48,
                                           .height = 48,
                                           .turn_deg = 15,
                                           .first = 4,
                                           .most = 4 };
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
        if (!(error[1] < error[0] / 2.5))
            fail_msg("case %d: %g, filtered %g", k, error[0], error[1]);
        wr_reference_fini(&reference);
        wr_scene_free(scene);
        wr_field_free(field);
    }
}

/* Rough relief over a rough map that leans by 35 degrees, both finer than pixels, in a mirror's direction: the widened
   highlight is close to many samples. Without relief's and map's share of the turn it is too narrow. */
static void moments_of_relief_over_a_map_come_near_the_reference(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        double error[2], mean = 0;
        WrScene *scene = scene_of("plane");
        WrImage *file = wr_image_new(530, 470, 3, NULL);
        WrField *field = wr_field_new(510, 490, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
        file->type = WR_PIXEL_F32;
        for (int t = 0; t < 530 * 470; t++) {
            const double x = 2 * WR_PI * (t % 530) / 530, y = 2 * WR_PI * (t / 530) / 470;
            const double p = 0.7 + 0.1 * sin(41 * x + 3 * y), q = 0.1 * sin(5 * x - 37 * y);
            const double w = sqrt(1 + p * p + q * q);
            file->data[3 * t] = (float)(-p / w), file->data[3 * t + 1] = (float)(-q / w);
            file->data[3 * t + 2] = (float)(1 / w);
        }
        for (int t = 0; t < 510 * 490; t++) {
            const double x = 2 * WR_PI * (t % 510) / 510, y = 2 * WR_PI * (t / 510) / 490;
            wr_field_set(
                field, t % 510, t / 510,
                (float)(sin(43 * x - 11 * y) + sin(31 * x + 29 * y) + sin(7 * x + 47 * y)));
        }
        put_map(scene, file, WR_GREEN_UP, 0);
        scene->normals.laid = (WrTextureSample){ .own = true, .ru = 1, .rv = 1 };
        scene->normals.combine = k % 2 ? WR_COMBINE_SURFACE : WR_COMBINE_REORIENTED;
        scene->replicate_u = scene->replicate_v = 1;
        scene->height = k / 2 ? 0.0003 : 0.0006;
        scene->posed = true, scene->rotate_deg = (WrVec3){ 0, -15, 0 };
        scene->camera.orthographic = true, scene->camera.size = 1.1;
        scene->lights[0].kind = WR_LIGHT_DIRECTIONAL;
        scene->lights[0].where = (WrVec3){ -sin(2 * atan(0.7)), 0, cos(2 * atan(0.7)) };
        scene->material.diffuse = 0, scene->material.specular = 1, scene->material.shininess = 60;
        scene->dials.moments = WR_MOMENTS_LEAN;
        scene->dials.footprint = WR_FOOTPRINT_ANISOTROPIC;
        scene->scheme = WR_SCHEME_CENTRAL;
        const WrReferenceRequest truth = { .field = field,
                                           .scene = scene,
                                           .width = 32,
                                           .height = 32,
                                           .turn_deg = 15,
                                           .first = 16,
                                           .most = 16 };
        WrReference reference = { 0 };
        WrError err = { "" };
        if (!wr_reference_render(&truth, NULL, &reference, &err)) fail_msg("%s", err.text);
        double bias[2] = { 0, 0 };
        for (int f = 0; f < 2; f++) {
            scene->dials.aa = f ? WR_AA_MOMENTS : WR_AA_FILTER;
            Shot shot = shoot(scene, field, 32, 32, 1, "auto", false);
            double squares = 0;
            int inside = 0;
            mean = 0;
            for (int i = 0; i < 32 * 32; i++) {
                if (reference.rgba[4 * i + 3] < 1 || shot.frame.rgba[4 * i + 3] < 1) continue;
                const double d = (double)shot.frame.rgba[4 * i] - reference.rgba[4 * i];
                squares += d * d, inside++, mean += reference.rgba[4 * i], bias[f] += d;
            }
            error[f] = sqrt(squares / inside), mean /= inside, bias[f] /= inside;
            put_away(&shot);
        }
        if (getenv("WR_SHOW"))
            printf("%d: mean %g; off by filter %g, %g in the mean, moments %g, %g\n", k, mean,
                   error[0], bias[0], error[1], bias[1]);
        if (!(error[1] < 0.09 && fabs(bias[1]) < 0.06 && bias[0] > 0.25))
            fail_msg("case %d: %g, %g in the mean", k, error[1], bias[1]);
        wr_reference_fini(&reference);
        wr_scene_free(scene);
        wr_field_free(field);
    }
}

/* A sphere with height 1 everywhere, displaced by c, is a sphere of radius R + c: the probe of a pixel matches that
   sphere. */
static void a_displaced_ball_is_told_of_as_a_larger_one(void **state)
{
    (void)state;
    WrError err = { "" };
    const double c = 0.273;
    WrField *level = wr_field_new(9, 7, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 1, NULL);
    WrScene *scene = scene_of("sphere"), *large = NULL;
    float map[2][WIDE * HIGH];
    scene->height = c, scene->displaced = true;
    scene->replicate_u = scene->replicate_v = 1;
    scene->camera.fit = false;
    scene->camera.eye = (WrVec3){ 0.3, 0.2, 4 }, scene->camera.target = (WrVec3){ 0.1, 0, 0 };
    large = wr_scene_clone(scene);
    large->displaced = false, large->height = 0, large->shape.value[0] = 1 + c;
    int hits = 0;
    for (int k = 0; k < 60; k++) {
        WrProbe a, b;
        const double x = WIDE * ((k % 10) + 0.317) / 10, y = HIGH * ((k / 10) + 0.719) / 6;
        assert_true(wr_reference_probe(level, scene, WIDE, HIGH, 15, x, y, &a, &err));
        assert_true(wr_reference_probe(level, large, WIDE, HIGH, 15, x, y, &b, &err));
        assert_true(a.hit == b.hit);
        if (!a.hit) continue;
        hits++;
        assert_true(fabs(a.u - b.u) < 1e-9 && fabs(a.v - b.v) < 1e-9);
        assert_true(a.f == c && a.tilt_deg < 1e-5);
        for (int i = 0; i < 4; i++)
            assert_true(fabs(a.footprint[i] - b.footprint[i]) < 1e-6 * (1 + fabs(b.footprint[i])));
        for (int i = 0; i < 3; i++) assert_true(fabs(a.rgb[i] - b.rgb[i]) < 1e-7);
    }
    assert_true(hits > 15);
    for (int k = 0; k < 2; k++)
        if (!wr_reference_map(level, k ? large : scene, WIDE, HIGH, 15, WR_MAP_LEVEL, NULL, NULL,
                              map[k], &err))
            fail_msg("%s", err.text);
    for (int i = 0; i < WIDE * HIGH; i++) {
        assert_true(isnan(map[0][i]) == isnan(map[1][i]));
        assert_true(isnan(map[0][i]) || fabs((double)map[0][i] - (double)map[1][i]) < 1e-4);
    }
    wr_scene_free(scene);
    wr_scene_free(large);
    wr_field_free(level);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_displaced_ball_is_told_of_as_a_larger_one),
        cmocka_unit_test(pictures_have_the_references_normals),
        cmocka_unit_test(relief_over_a_map_has_the_references_normals),
        cmocka_unit_test(on_a_leaning_plane_the_relief_is_turned),
        cmocka_unit_test(objects_that_hide_each_other_have_them_too),
        cmocka_unit_test(one_triangle_turns_the_map_as_by_hand),
        cmocka_unit_test(a_fold_takes_the_normal_of_length_1),
        cmocka_unit_test(a_probe_has_the_map),
        cmocka_unit_test(filtered_maps_come_near_the_reference),
        cmocka_unit_test(moments_of_relief_over_a_map_come_near_the_reference),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
