/* test_environment_light.c - environment light: its picture and spherical harmonics against closed forms, pictures against the
   integral over all directions. */
#include "test.h"
#include "field/scheme_list.h"
#include "render_scenes.h"

#include "image/image.h"
#include "shade/environment_blur.h"
#include "shade/environment_map.h"
#include "shade/reflection_models.h"

typedef double Sky(WrVec3 d, int c);

/* An environment of w x h texels; data: radiance of each direction. */
static WrEnvironmentMap *surroundings(int w, int h, Sky *sky)
{
    WrEnvironmentMapChanges changes;
    WrError err = { "" };
    WrImage *image = wr_image_new(w, h, 3, &err);
    image->type = WR_PIXEL_F32;
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++)
            for (int c = 0; c < 3; c++)
                image->data[3 * (j * w + i) + c] =
                    (float)sky(wr_environment_map_direction((i + 0.5) / w, 1 - (j + 0.5) / h), c);
    WrEnvironmentMap *s = wr_environment_map_new(image, &changes, &err);
    wr_image_free(image);
    if (!s) fail_msg("%s", err.text);
    return s;
}

static const double unturned[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };

/* E / pi for a normal, up to that order. */
static double light_up_to(const WrEnvironmentMap *s, const double axes[9], int order, WrVec3 n,
                          int c)
{
    double f[3][WR_FORM_TERMS];
    wr_environment_map_form(s, axes, 1, order, f);
    const double *k = f[c];
    return k[0] + k[1] * n.x + k[2] * n.y + k[3] * n.z + k[4] * n.x * n.x + k[5] * n.y * n.y +
           k[6] * n.z * n.z + k[7] * n.x * n.y + k[8] * n.y * n.z + k[9] * n.z * n.x;
}

static double light_of(const WrEnvironmentMap *s, const double axes[9], WrVec3 n, int c)
{
    return light_up_to(s, axes, 2, n, c);
}

static WrVec3 random_direction(TestRandom *random)
{
    const double z = 2 * test_random(random) - 1, t = 2 * WR_PI * test_random(random);
    return (WrVec3){ sqrt(1 - z * z) * cos(t), sqrt(1 - z * z) * sin(t), z };
}

static const WrVec3 east = { 0.48, 0.6, 0.64 }; /* unit */

static double linear(WrVec3 d, int c)
{
    return 1.1 + 0.3 * c + (0.7 - 0.2 * c) * v3_dot(d, east);
}

/* 4 times a second-order harmonic about an axis. */
static double banded(WrVec3 d, int c)
{
    const double x = v3_dot(d, east);
    return 2.3 + c + 1.5 * x * x;
}

static double half(WrVec3 d, int c)
{
    (void)c;
    return d.y > 0 ? 1 : 0;
}

/* For L = a + b (d.e): a, then a + 2/3 b (n.e), and no further terms. */
static void fewer_orders_leave_out_what_is_beyond_them(void **state)
{
    (void)state;
    TestRandom random = { 5 };
    WrEnvironmentMap *one = surroundings(151, 73, linear);
    for (int k = 0; k < 20; k++) {
        const WrVec3 n = random_direction(&random);
        for (int c = 0; c < 3; c++) {
            const double mean = 1.1 + 0.3 * c;
            const double turned = mean + 2.0 / 3 * (0.7 - 0.2 * c) * v3_dot(n, east);
            assert_near(light_up_to(one, unturned, 0, n, c), mean, 2e-3);
            assert_near(light_up_to(one, unturned, 1, n, c), turned, 2e-3);
        }
    }
    wr_environment_map_free(one);
}

static void harmonics_are_those_of_the_closed_forms(void **state)
{
    (void)state;
    TestRandom random = { 3 };
    WrEnvironmentMap *one = surroundings(151, 73, linear), *two = surroundings(146, 71, banded);
    WrEnvironmentMap *dome = surroundings(512, 256, half);
    for (int k = 0; k < 40; k++) {
        const WrVec3 n = random_direction(&random);
        const double x = v3_dot(n, east);
        for (int c = 0; c < 3; c++) {
            assert_near(light_of(one, unturned, n, c),
                        1.1 + 0.3 * c + 2.0 / 3 * (0.7 - 0.2 * c) * x, 6e-4);
            /* x^2 = 1/3 + (x^2 - 1/3); the cosine lobe keeps a quarter of the latter */
            assert_near(light_of(two, unturned, n, c),
                        2.3 + c + 1.5 * (1.0 / 3 + (x * x - 1.0 / 3) / 4), 1.5e-3);
        }
        assert_near(light_of(dome, unturned, n, 0), 0.5 * (1 + n.y), 0.03); /* order 4 is lost */
    }
    wr_environment_map_free(one);
    wr_environment_map_free(two);
    wr_environment_map_free(dome);
}

static int lit_texel;

static double sun(WrVec3 d, int c)
{
    double u, v;
    wr_environment_map_place(d, &u, &v);
    (void)c;
    return (int)(512 * u) == 301 && (int)(256 * (1 - v)) == lit_texel ? 1e5 : 0;
}

/* For a small sun the harmonics approach those of a delta, within the sharp bounds. */
static void a_sun_is_within_the_bounds(void **state)
{
    (void)state;
    TestRandom random = { 5 };
    for (lit_texel = 3; lit_texel < 256; lit_texel += 97) {
        WrEnvironmentMap *s = surroundings(512, 256, sun);
        const WrVec3 at = wr_environment_map_direction(301.5 / 512, 1 - (lit_texel + 0.5) / 256);
        const double angle =
            4 * WR_PI / 512 * sin(WR_PI / 512) * sin(WR_PI * (lit_texel + 0.5) / 256);
        const double all = 1e5 * angle;
        for (int k = 0; k < 60; k++) {
            const WrVec3 n = random_direction(&random);
            const double c = v3_dot(n, at), e = WR_PI * light_of(s, unturned, n, 0) / all;
            assert_near(e, 0.25 + 0.5 * c + 5.0 / 32 * (3 * c * c - 1), 1e-5);
            const double off = e - fmax(0, c);
            if (!(off >= -19.0 / 480 - 1e-5 && off <= 3.0 / 32 + 1e-5))
                fail_msg("%g off at %g", off, c);
        }
        wr_environment_map_free(s);
    }
}

static double speckled(WrVec3 d, int c)
{
    TestRandom random = { (uint64_t)(1e6 * (d.x + 3) + 1e7 * (d.y + 2) + 3e5 * (d.z + 1)) +
                          (uint64_t)c };
    return test_random(&random);
}

/* HC111, HC112: continuous at the seam and near the poles, for any size. */
static void poles_and_seam_are_continuous(void **state)
{
    static const int sizes[][2] = { { 1, 1 }, { 1, 5 }, { 7, 1 }, { 13, 6 }, { 16, 9 } };
    (void)state;
    TestRandom random = { 9 };
    for (int k = 0; k < 5; k++) {
        WrEnvironmentMap *s = surroundings(sizes[k][0], sizes[k][1], speckled);
        for (int i = 0; i < 50; i++) {
            const double t = 2 * WR_PI * test_random(&random), h = 2 * test_random(&random) - 1;
            const double e = 1e-9, y = i % 2 ? 1 : -1;
            const WrVec3 near[][2] = { { { 0, y, 0 }, { e * cos(t), y, e * sin(t) } },
                                       { { e, h, 1 }, { -e, h, 1 } },
                                       { { 0, h, 1 }, { -0.0, h, 1 } } };
            for (int m = 0; m < 3; m++) {
                double a[3], b[3];
                wr_environment_map_at(s, near[m][0], a);
                wr_environment_map_at(s, near[m][1], b);
                for (int c = 0; c < 3; c++) {
                    assert_near(a[c], b[c], 1e-6);
                    assert_true(a[c] >= 0 && a[c] <= 1);
                }
            }
        }
        double middle[3];
        wr_environment_map_at(s, (WrVec3){ 0, 0, 0 }, middle);
        assert_true(isfinite(middle[0]));
        wr_environment_map_free(s);
    }
}

static void places_are_the_directions_inverse(void **state)
{
    (void)state;
    TestRandom random = { 11 };
    const WrVec3 right = wr_environment_map_direction(0.75, 0.5),
                 ahead = wr_environment_map_direction(0.5, 0.5);
    assert_near(right.x, 1, 1e-15);
    assert_near(ahead.z, -1, 1e-15);
    assert_near(wr_environment_map_direction(0.3, 1).y, 1, 1e-15);
    for (int i = 0; i < 100; i++) {
        const WrVec3 d = random_direction(&random);
        double u, v;
        wr_environment_map_place(v3_scale(d, 3.7), &u, &v);
        assert_near(v3_len(v3_sub(wr_environment_map_direction(u, v), d)), 0, 1e-14);
    }
}

/* HC114: invalid values of a file are converted to valid light and reported. */
static void invalid_light_is_replaced_and_counted(void **state)
{
    (void)state;
    static const float numbers[] = { NAN, -3, INFINITY, 1e30f, -INFINITY, 2.5f };
    WrImage *image = wr_image_new(3, 2, 1, NULL);
    WrEnvironmentMapChanges changes;
    memcpy(image->data, numbers, sizeof numbers);
    image->type = WR_PIXEL_F32;
    WrEnvironmentMap *s = wr_environment_map_new(image, &changes, NULL);
    assert_int_equal(changes.not_numbers, 3); /* in each of the three colours */
    assert_int_equal(changes.negative, 6);
    assert_int_equal(changes.too_large, 6);
    const float *got = s->image->data;
    assert_true(got[0] == 0 && got[3] == 0 && got[6] == 1e9f && got[9] == 1e9f && got[15] == 2.5f);
    for (int i = 0; i < WR_HARMONICS; i++) assert_true(isfinite(s->harmonic[i][2]));
    wr_environment_map_free(s);
    image->type = WR_PIXEL_U8;
    image->data[0] = 0.5f;
    s = wr_environment_map_new(image, &changes, NULL);
    assert_near((double)s->image->data[0], 0.21404114, 1e-6); /* decoded from sRGB */
    wr_environment_map_free(s);
    wr_image_free(image);
}

/* ---- pictures ---- */

static WrScene *scene_under(WrEnvironmentMap *light, int model, int energy)
{
    WrScene *scene = scene_of("sphere");
    WrMaterial *m = &scene->material;
    scene->light_count = 0;
    scene->lights_given = true;
    m->model = (WrReflect)model, m->energy = (WrEnergy)energy;
    m->ambient = 0, m->specular = 0, m->diffuse = 1;
    m->roughness = .37, m->metalness = .23, m->ior = 1.61;
    m->colour = (WrVec3){ .91, .53, .17 };
    scene->dials.aa = WR_AA_POINT;
    scene->scheme = WR_SCHEME_BSPLINE_FIT; /* makes n' equal to the reference's */
    scene->bump = WR_BUMP_EXACT;
    scene->posed = true;
    scene->rotate_deg = (WrVec3){ 23, 41, 7 };
    wr_environment_set(&scene->environment, WR_ENVIRONMENT_MAP_FILE, light, "sky", NULL);
    return scene;
}

/* Largest difference of the picture; *middle: of pixels that face the viewer. */
static double apart(const WrScene *scene, const WrField *field, double *middle)
{
    enum { W = 17, H = 15 };
    Shot shot = shoot(scene, field, W, H, 2, "auto", false);
    float *want = true_picture(scene, field, W, H);
    double worst = *middle = 0;
    for (int i = 0; i < W * H * 4; i++) {
        if (want[i / 4 * 4 + 3] != 1 || shot.frame.rgba[i / 4 * 4 + 3] != 1) continue;
        const double off = fabs((double)want[i] - (double)shot.frame.rgba[i]);
        worst = fmax(worst, off);
        if (hypot(i / 4 % W - 8, i / 4 / W - 7) < 4.5) *middle = fmax(*middle, off);
    }
    put_away(&shot);
    wr_free(want);
    return worst;
}

/* Bumps, a rotated object and a rotated environment against the integral: Lambert's agrees to rounding where
   harmonics are exact. */
static void diffuse_light_is_the_integral(void **state)
{
    (void)state;
    static const struct {
        int model, energy;
        double most;
    } cases[] = { { WR_REFLECT_BLINN_PHONG, 0, 5e-4 },
                  { WR_REFLECT_OREN_NAYAR, 0, 0.065 },
                  { WR_REFLECT_OREN_NAYAR, 1, 0.05 },
                  { WR_REFLECT_GGX, 0, 0.005 },
                  { WR_REFLECT_GGX, 1, 0.005 } };
    WrField *field = bumpy_field(16, 16);
    for (int k = 0; k < 5; k++)
        for (int in_double = 0; in_double < 2; in_double++) {
            WrScene *scene =
                scene_under(surroundings(130, 67, linear), cases[k].model, cases[k].energy);
            scene->environment.turn_deg = 33.7, scene->environment.strength = 0.83;
            if (in_double) scene->dials.shading = WR_SHADING_DOUBLE;
            double middle;
            const double off = apart(scene, field, &middle);
            if (!(off < cases[k].most)) fail_msg("case %d: %g apart", k, off);
            wr_scene_free(scene);
        }
    wr_field_free(field);
}

/* Reflections blurred by each model's lobe, against the integral of its formula. */
static void reflections_are_the_integral(void **state)
{
    (void)state;
    static const struct {
        int model, energy;
        double roughness, shininess, most, middle;
    } cases[] = {
        { WR_REFLECT_BLINN_PHONG, 0, 0, 23.7, 0.1, 0.01 },
        { WR_REFLECT_PHONG, 0, 0, 23.7, 0.1, 0.01 },
        { WR_REFLECT_PHONG, 1, 0, 23.7, 0.1, 0.01 },
        { WR_REFLECT_GGX, 0, .31, 0, 0.1, 0.01 },
        { WR_REFLECT_GGX, 1, .61, 0, 0.1, 0.02 },
        { WR_REFLECT_GGX, 0, .05, 0, 0.1, 0.01 },
        { WR_REFLECT_TORRANCE_SPARROW, 0, .43, 0, 0.1, 0.01 },
        { WR_REFLECT_TORRANCE_SPARROW, 1, .43, 0, 0.1, 0.01 },
    };
    WrField *field = bumpy_field(16, 16);
    for (int k = 0; k < 8; k++)
        for (int in_double = 0; in_double < 2; in_double++) {
            WrScene *scene =
                scene_under(surroundings(130, 67, linear), cases[k].model, cases[k].energy);
            WrMaterial *m = &scene->material;
            m->diffuse = 0, m->specular = 0.87, m->tint = 0.21;
            m->roughness = cases[k].roughness, m->shininess = cases[k].shininess;
            scene->environment.turn_deg = 33.7, scene->environment.strength = 0.83;
            if (in_double) scene->dials.shading = WR_SHADING_DOUBLE;
            double middle;
            const double off = apart(scene, field, &middle);
            if (getenv("WR_SHOW")) print_message("case %d: %g, %g\n", k, off, middle);
            if (!(off < cases[k].most && middle < cases[k].middle))
                fail_msg("case %d: %g, %g apart", k, off, middle);
            wr_scene_free(scene);
        }
    wr_field_free(field);
}

/* Closed form for the mean of c = l.r over the lobe of GGX facets with n = v = r. */
static double facets_mean(double alpha)
{
    const double a2 = alpha * alpha, a = (1 + a2) / 2, k = (1 - a2) / 2;
    const double w = 2 * a2 / (k * k) * (a / a2 - 1 + log(a2 / a));
    return 2 * a2 * (a * a / a2 - a2 - 2 * a * log(a / a2)) / (k * k * k * w);
}

/* A linear sky stays linear. */
static void expect_blurred(const WrEnvironmentMap *s, const WrEnvironmentBrdf *g, double mean,
                           WrPool *pool)
{
    const int w = wr_blur_width(g, 16);
    float *blurred = wr_alloc((size_t)w * (size_t)w / 2, 3 * sizeof *blurred);
    assert_true(wr_environment_map_blur(s, g, w, pool, blurred, NULL));
    for (int i = 0; i < w * w / 2; i += 37) {
        const WrVec3 d = wr_environment_map_direction((i % w + 0.5) / w, 1 - (i / w + 0.5) * 2 / w);
        assert_near((double)blurred[3 * i + 1], 1.4 + 0.5 * mean * v3_dot(d, east), 5e-4);
    }
    wr_free(blurred);
}

static void lobes_have_their_closed_forms(void **state)
{
    (void)state;
    static const double alphas[] = { 1.0 / 61, 0.0437, 0.11, 0.25, 0.83 };
    WrPool *pool = wr_pool_new(2);
    WrEnvironmentMap *s = surroundings(211, 96, linear);
    double order[3];
    for (int k = 0; k < 5; k++) {
        const WrEnvironmentBrdf g = { .lobe = WR_LOBE_FACETS, .alpha = alphas[k], .gated = true };
        wr_blur_orders(&g, 3, order);
        assert_near(order[0], 1, 1e-14);
        assert_near(order[1], facets_mean(alphas[k]), 1e-5);
        if (k > 1) expect_blurred(s, &g, order[1], pool);
    }
    const WrEnvironmentBrdf all = { .lobe = WR_LOBE_FACETS, .alpha = 1, .gated = true }; /* HC101 */
    const WrEnvironmentBrdf power = {
        .lobe = WR_LOBE_POWER, .alpha = 0.2, .power = 11.3, .gated = true
    };
    const WrEnvironmentBrdf half_power = { .lobe = WR_LOBE_HALF, .alpha = 0.3, .power = 21.7 };
    wr_blur_orders(&all, 2, order);
    assert_near(order[1], 2.0 / 3, 1e-6);
    wr_blur_orders(&power, 2, order);
    assert_near(order[1], 12.3 / 13.3, 1e-5); /* for c^s the mean of c is (s + 1) / (s + 2) */
    wr_blur_orders(&half_power, 2, order);    /* x^p for x = (1 + c) / 2 */
    assert_near(order[1], 2 * (21.7 / 2 + 1) / (21.7 / 2 + 2) - 1, 1e-5);
    wr_environment_map_free(s);
    wr_pool_free(pool);
}

static double white(WrVec3 d, int c)
{
    (void)d, (void)c;
    return 1;
}

static double nearly_white(WrVec3 d, int c)
{
    (void)c;
    return d.x > 0.9 ? 1 + 1e-6 : 1; /* fetched, since it is not constant */
}

/* HC115: constant, and fetched */
static void a_white_furnace_is_white(void **state)
{
    (void)state;
    static const int models[] = { WR_REFLECT_BLINN_PHONG, WR_REFLECT_OREN_NAYAR, WR_REFLECT_GGX,
                                  WR_REFLECT_GGX };
    static const double within[] = { 2e-6, 2e-4, 5e-3, 0.13 }; /* rough metal loses light */
    WrField *field = bumpy_field(16, 16);
    for (int k = 0; k < 8; k++) {
        WrEnvironmentMap *from =
            k % 2 ? surroundings(37, 18, nearly_white) : surroundings(1, 1, white);
        WrScene *scene = scene_under(from, models[k / 2], 0);
        scene->material.colour = (WrVec3){ 1, 1, 1 };
        scene->material.specular = k / 2 > 1 ? 1 : 0;
        scene->material.metalness = k / 2 > 2 ? 1 : 0;
        Shot shot = shoot(scene, field, 21, 17, 1, "auto", false);
        for (int i = 0; i < 21 * 17 * 4; i++)
            if (shot.frame.rgba[i / 4 * 4 + 3] == 1) {
                assert_near((double)shot.frame.rgba[i], 1, within[k / 2]);
                assert_true((double)shot.frame.rgba[i] < 1 + 5e-3);
            }
        put_away(&shot);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

static Shot turned_by(double turn_deg, int columns, const WrField *field)
{
    WrEnvironmentMap *from = surroundings(128, 64, speckled);
    WrImage *image = wr_image_new(128, 64, 3, NULL);
    WrEnvironmentMapChanges changes;
    image->type = WR_PIXEL_F32;
    for (int i = 0; i < 128 * 64; i++)
        memcpy(image->data + 3 * i, from->image->data + 3 * (i / 128 * 128 + (i + columns) % 128),
               3 * sizeof(float));
    WrScene *scene = scene_under(wr_environment_map_new(image, &changes, NULL), 0, 0);
    scene->environment.turn_deg = turn_deg;
    Shot shot = shoot(scene, field, 31, 27, 1, "auto", false);
    wr_scene_free(scene);
    wr_image_free(image);
    wr_environment_map_free(from);
    return shot;
}

/* HC116: a rotation equals a shift of the picture's columns. */
static void turning_is_shifting_the_picture(void **state)
{
    (void)state;
    WrField *field = bumpy_field(16, 16);
    Shot still = turned_by(0, 0, field), once = turned_by(-1080, 0, field);
    Shot turned = turned_by(22.5 * 3, 0, field), shifted = turned_by(0, 24, field);
    assert_true(same_picture(&still, &once));
    assert_false(same_picture(&still, &turned));
    assert_true((double)worst_difference(&turned, &shifted) < 1e-6);
    assert_true((double)worst_difference(&still, &shifted) > 1e-4);
    put_away(&still);
    put_away(&once);
    put_away(&turned);
    put_away(&shifted);
    wr_field_free(field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fewer_orders_leave_out_what_is_beyond_them),
        cmocka_unit_test(harmonics_are_those_of_the_closed_forms),
        cmocka_unit_test(a_sun_is_within_the_bounds),
        cmocka_unit_test(poles_and_seam_are_continuous),
        cmocka_unit_test(places_are_the_directions_inverse),
        cmocka_unit_test(invalid_light_is_replaced_and_counted),
        cmocka_unit_test(diffuse_light_is_the_integral),
        cmocka_unit_test(lobes_have_their_closed_forms),
        cmocka_unit_test(reflections_are_the_integral),
        cmocka_unit_test(a_white_furnace_is_white),
        cmocka_unit_test(turning_is_shifting_the_picture),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
