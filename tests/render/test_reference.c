/* The reference against closed forms, against the definitions of its parts, and against the fast path. */
#include "test.h"
#include "render_scenes.h"

#include "base/error.h"
#include "field/analytic.h"
#include "field/field.h"
#include "image/image.h"
#include "render/reference/reference.h"
#include "render/reference/reference_shade.h"
#include "scene/scene.h"
#include "base/vec.h"

static WrReference render(const WrScene *scene, const WrField *field, int w, int h, int first,
                          int most)
{
    WrError err = { "" };
    WrReference out = { 0 };
    WrPool *pool = wr_pool_new(2);
    const WrReferenceRequest request = {
        .field = field, .scene = scene, .width = w, .height = h, .first = first, .most = most
    };
    if (!wr_reference_render(&request, pool, &out, &err)) fail_msg("%s", err.text);
    wr_pool_free(pool);
    return out;
}

static WrField *flat_field(void)
{
    return wr_field_new(4, 4, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
}

/* The unrotated object, seen along -z, `size` scene units high. */
static void look_straight(WrScene *scene, double size)
{
    scene->posed = true;
    scene->rotate_deg = (WrVec3){ 0, 0, 0 };
    scene->camera.orthographic = true;
    scene->camera.size = size;
}

/* One light from `to`, one colour: I = C (ka + kd n.l) + ks (n.h)^s written out for a test. */
static double lit(const WrScene *scene, WrVec3 n, WrVec3 to, WrVec3 eye)
{
    const WrMaterial *m = &scene->material;
    const double l = sqrt(v3_dot(to, to));
    const WrVec3 h = v3_add(v3_scale(to, 1 / l), eye);
    const double nl = v3_dot(n, to) / l, nh = v3_dot(n, h) / sqrt(v3_dot(h, h));
    double shine = nl > 0 && nh > 0 ? m->specular * pow(nh, m->shininess) : 0;
    return m->colour.x * (m->ambient + m->diffuse * fmax(0, nl)) + shine;
}

static void a_formula_on_the_plane_has_its_intensity_in_closed_form(void **state)
{
    (void)state;
    WrScene *scene = wr_scene_new();
    WrAnalyticTerm terms[] = { { .i = 2, .j = 0, .a = 1.5 }, { .i = 1, .j = 2, .a = -2 } };
    scene->analytic = (WrAnalytic){ WR_ANALYTIC_POLY, 2, terms };
    scene->height = 0.4;
    look_straight(scene, 1.25);
    const int size = 50; /* pixels of 0.025: the patch, 1 wide, covers 40 of them */
    WrReference r = render(scene, NULL, size, size, 1, 1);
    const WrVec3 eye = { 0, 0, 1 };
    for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++) {
            const double *got = r.rgba + 4 * (y * size + x);
            const bool on = x >= 5 && x < 45 && y >= 5 && y < 45;
            assert_true(got[3] == (on ? 1 : 0));
            if (!on) continue;
            double u = (x - 5 + 0.5) / 40, v = 1 - (y - 5 + 0.5) / 40;
            double fu = 0.4 * (3 * u - 2 * v * v), fv = 0.4 * (-4 * u * v);
            WrVec3 n = v3_unit((WrVec3){ -fu, -fv, 1 }, eye);
            assert_near(got[0], lit(scene, n, scene->lights[0].where, eye), 1e-12);
            assert_near(r.normal[3 * (y * size + x)], n.x, 1e-12);
        }
    scene->analytic = (WrAnalytic){ 0 };
    wr_reference_fini(&r);
    wr_scene_free(scene);
}

static void the_mean_over_a_pixel_of_a_ramp_is_its_middle(void **state)
{
    (void)state;
    WrScene *scene = wr_scene_new();
    WrField *field = wr_field_new(4, 4, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0, NULL);
    scene->colour = wr_image_new(2, 1, 1, NULL);
    scene->colour->data[1] = 1;
    scene->material.diffuse = scene->material.specular = 0;
    scene->material.ambient = 2;
    scene->material.colour = (WrVec3){ 1, 0.5, 0 };
    look_straight(scene, 1);
    const int size = 16;
    WrReference r = render(scene, field, size, size, 8, 8);
    for (int x = 4; x < 12; x++) { /* between the two texels' centres C = 2 u - 1/2 */
        const double *got = r.rgba + 4 * (7 * size + x), u = (x + 0.5) / size;
        assert_near(got[0], 2 * (2 * u - 0.5), 1e-13);
        assert_near(got[1], 2 * u - 0.5, 1e-13);
        assert_true(got[2] == 0);
    }
    wr_reference_fini(&r);
    wr_field_free(field);
    wr_scene_free(scene);
}

static void a_sphere_covers_the_area_of_its_disk(void **state)
{
    (void)state;
    WrScene *scene = scene_of("sphere");
    WrField *field = flat_field();
    look_straight(scene, 2.5);
    const int size = 60, k = 8;
    WrReference r = render(scene, field, size, size, k, k);
    double area = 0, cell = 2.5 / (size * k);
    for (int i = 0; i < size * size; i++) area += r.rgba[4 * i + 3] * k * k * cell * cell;
    /* A circle passes through at most 8 R / cell + 4 cells, and only those are counted wrongly. */
    assert_near(area, WR_PI, (8 / cell + 4) * cell * cell);
    assert_near(area, WR_PI, 1e-3);
    assert_int_equal(r.lost, 0);
    wr_reference_fini(&r);
    wr_field_free(field);
    wr_scene_free(scene);
}

static void the_middle_of_a_sphere_is_lit_as_by_hand(void **state)
{
    (void)state;
    WrScene *scene = scene_of("sphere");
    WrField *field = flat_field();
    look_straight(scene, 2.5);
    scene->lights[0].where = (WrVec3){ 3, 0, 4 }; /* n.l = 0.8, n.h = sqrt((1 + 0.8) / 2) */
    WrReference r = render(scene, field, 31, 31, 1, 1);
    const WrMaterial *m = &scene->material;
    double want =
        m->colour.x * (m->ambient + 0.8 * m->diffuse) + m->specular * pow(0.9, m->shininess / 2);
    const size_t middle = 15 * 31 + 15;
    assert_near(r.rgba[4 * middle], want, 1e-12);
    assert_near(r.normal[3 * middle + 2], 1, 1e-12);
    wr_reference_fini(&r);
    wr_field_free(field);
    wr_scene_free(scene);
}

/* The nearest root of |eye + t d| = R by the quadratic formula. */
static void a_sphere_in_perspective_is_hit_where_the_quadratic_says(void **state)
{
    (void)state;
    WrScene *scene = scene_of("sphere");
    WrField *field = flat_field();
    scene->posed = true;
    scene->rotate_deg = (WrVec3){ 0, 0, 0 };
    scene->camera.fit = false;
    scene->camera.eye = (WrVec3){ 0.3, -0.2, 3 };
    scene->camera.target = (WrVec3){ 0.3, -0.2, 0 };
    scene->camera.fov_deg = 60;
    const int size = 64;
    WrReference r = render(scene, field, size, size, 1, 1);
    const WrVec3 e = scene->camera.eye;
    int hits = 0;
    for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++) {
            double half = tan(30 * WR_RAD_PER_DEG);
            WrVec3 d = { half * (2 * (x + 0.5) / size - 1), half * (1 - 2 * (y + 0.5) / size), -1 };
            double a = v3_dot(d, d), b = v3_dot(e, d), disc = b * b - a * (v3_dot(e, e) - 1);
            const double *got = r.normal + 3 * (y * size + x);
            assert_true(r.rgba[4 * (y * size + x) + 3] == (disc >= 0 ? 1 : 0));
            if (disc < 0) continue;
            WrVec3 p = v3_mad(e, d, (-b - sqrt(disc)) / a);
            double bound = 1e-13 / sqrt(disc) + 1e-13; /* the conditioning of the root */
            assert_near(got[0], p.x, bound);
            assert_near(got[1], p.y, bound);
            assert_near(got[2], p.z, bound);
            hits++;
        }
    assert_true(hits > 900);
    wr_reference_fini(&r);
    wr_field_free(field);
    wr_scene_free(scene);
}

/* The torus as the zeros of a polynomial: g = (p.p + R^2 - r^2)^2 - 4 R^2 (x^2 + y^2). */
static double torus_g(WrVec3 p, double R, double r)
{
    double k = v3_dot(p, p) + R * R - r * r;
    return k * k - 4 * R * R * (p.x * p.x + p.y * p.y);
}

/* The first sign change of g along a ray, in steps of 1/400, then by halving. */
static bool march_torus(WrVec3 q, WrVec3 d, double R, double r, WrVec3 *p)
{
    for (int i = 0; i < 1600; i++) {
        double from = -2 + i / 400.0, to = from + 1 / 400.0;
        if ((torus_g(v3_mad(q, d, from), R, r) > 0) == (torus_g(v3_mad(q, d, to), R, r) > 0))
            continue;
        for (int k = 0; k < 60; k++) {
            double middle = 0.5 * (from + to);
            if (torus_g(v3_mad(q, d, middle), R, r) > 0) from = middle;
            else to = middle;
        }
        *p = v3_mad(q, d, from);
        return true;
    }
    return false;
}

static void a_torus_is_hit_where_its_polynomial_is_zero(void **state)
{
    (void)state;
    WrScene *scene = scene_of("torus");
    WrField *field = flat_field();
    scene->camera.orthographic = true;
    scene->camera.size = 3;
    scene->posed = true;
    scene->rotate_deg = (WrVec3){ -65, 20, 0 };
    const double R = scene->shape.value[0], r = scene->shape.value[1];
    const int size = 90;
    WrReference got = render(scene, field, size, size, 1, 1);
    WrReferenceView view;
    assert_true(wr_reference_view_init(&view, scene, 0, size, size, NULL));
    int hits = 0, unlike = 0;
    for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++) {
            const WrReferenceRay ray = wr_reference_view_ray(&view, x + 0.5, y + 0.5);
            const double *n = got.normal + 3 * (y * size + x);
            WrVec3 p;
            bool hit = march_torus(ray.q, ray.d, R, r, &p);
            unlike += hit != (got.rgba[4 * (y * size + x) + 3] > 0);
            if (!hit || got.rgba[4 * (y * size + x) + 3] == 0) continue;
            double rho = sqrt(p.x * p.x + p.y * p.y), c = (rho - R) / r;
            WrVec3 want = { c * p.x / rho, c * p.y / rho, p.z / r };
            if (fabs(v3_dot(want, ray.d)) < 0.05)
                continue; /* near the silhouette roots are
                                                               ill-conditioned */
            assert_near(n[0], want.x, 1e-9);
            assert_near(n[1], want.y, 1e-9);
            assert_near(n[2], want.z, 1e-9);
            hits++;
        }
    assert_true(hits > 2000);
    assert_in_range(unlike, 0, 2); /* marching may step over a tangential hit */
    assert_int_equal(got.lost, 0);
    wr_reference_view_fini(&view);
    wr_reference_fini(&got);
    wr_field_free(field);
    wr_scene_free(scene);
}

static void doubling_stops_when_the_picture_stands_still(void **state)
{
    (void)state;
    WrScene *scene = scene_of("sphere");
    WrField *field = bumpy_field(16, 16);
    WrReferenceRequest request = { .field = field,
                                   .scene = scene,
                                   .width = 40,
                                   .height = 40,
                                   .first = 2,
                                   .most = 32,
                                   .change_rms = 0.004 };
    WrReference r = { 0 };
    WrError err = { "" };
    assert_true(wr_reference_render(&request, NULL, &r, &err));
    assert_true(r.converged && r.samples > 2 && r.samples <= 32);
    assert_true(r.last_rms < 0.004 && r.last_max >= r.last_rms);
    const int stopped = r.samples;
    WrReference coarse = render(scene, field, 40, 40, stopped / 2, stopped / 2);
    WrReference fine = render(scene, field, 40, 40, stopped, stopped);
    double sum = 0;
    int covered = 0;
    for (int i = 0; i < 40 * 40; i++) {
        if (fine.rgba[4 * i + 3] == 0 && coarse.rgba[4 * i + 3] == 0) continue;
        covered++;
        for (int c = 0; c < 3; c++) sum += pow(fine.rgba[4 * i + c] - coarse.rgba[4 * i + c], 2);
    }
    assert_near(r.last_rms, sqrt(sum / (3.0 * covered)), 1e-14);
    assert_memory_equal(r.rgba, fine.rgba, 40 * 40 * 4 * sizeof(double));
    request.change_rms = 0; /* all the way */
    request.most = 2 * stopped;
    assert_true(wr_reference_render(&request, NULL, &r, &err));
    assert_int_equal(r.samples, 2 * stopped);
    assert_false(r.converged);
    assert_true(r.last_rms < 0.004);
    assert_true(isnan(fine.last_rms) && !fine.converged); /* a single picture has no change */
    wr_reference_fini(&r);
    wr_reference_fini(&coarse);
    wr_reference_fini(&fine);
    wr_field_free(field);
    wr_scene_free(scene);
}

static void hc92_equal_intensities_have_exactly_their_own_mean(void **state)
{
    (void)state;
    WrScene *scene = wr_scene_new();
    WrField *field = flat_field();
    look_straight(scene, 1);
    WrReference one = render(scene, field, 4, 4, 1, 1), many = render(scene, field, 4, 4, 16, 16);
    assert_memory_equal(one.rgba, many.rgba, 16 * 4 * sizeof(double));
    wr_reference_fini(&one);
    wr_reference_fini(&many);
    wr_field_free(field);
    wr_scene_free(scene);
}

static void the_bits_do_not_depend_on_the_number_of_threads(void **state)
{
    (void)state;
    WrField *field = bumpy_field(37, 20);
    WrScene *scene = scene_of("torus");
    WrReference r[3] = { 0 };
    for (int k = 0; k < 3; k++) {
        WrPool *pool = wr_pool_new((const int[]){ 1, 2, 7 }[k]);
        const WrReferenceRequest request = {
            .field = field, .scene = scene, .width = 40, .height = 30, .first = 2, .most = 4
        };
        assert_true(wr_reference_render(&request, pool, &r[k], NULL));
        wr_pool_free(pool);
        assert_memory_equal(r[k].rgba, r[0].rgba, 40 * 30 * 4 * sizeof(double));
        assert_memory_equal(r[k].normal, r[0].normal, 40 * 30 * 3 * sizeof(double));
        assert_true(same_bits(r[k].last_rms, r[0].last_rms));
    }
    for (int k = 0; k < 3; k++) wr_reference_fini(&r[k]);
    wr_scene_free(scene);
    wr_field_free(field);
}

static void only_the_blocks_that_are_wanted_are_rendered(void **state)
{
    (void)state;
    WrField *field = flat_field();
    WrScene *scene = wr_scene_new();
    look_straight(scene, 0.4);
    const unsigned char only[2] = { 0, 1 };
    const WrReferenceRequest request = { .field = field,
                                         .scene = scene,
                                         .width = 2 * WR_FRAME_BLOCK - 3,
                                         .height = WR_FRAME_BLOCK,
                                         .first = 1,
                                         .most = 1,
                                         .only = only };
    WrReference r = { 0 };
    assert_true(wr_reference_render(&request, NULL, &r, NULL));
    for (int x = 0; x < r.width; x++)
        assert_true(r.rgba[4 * (5 * r.width + x) + 3] == (x >= WR_FRAME_BLOCK ? 1 : 0));
    wr_reference_fini(&r);
    wr_scene_free(scene);
    wr_field_free(field);
}

static void what_cannot_be_is_refused_and_leaves_the_last_picture(void **state)
{
    (void)state;
    WrField *field = flat_field();
    WrScene *scene = wr_scene_new();
    const int stop = 1;
    const WrReferenceRequest good = { .field = field, .scene = scene, .width = 3, .height = 3 };
    WrReference r = { .samples = 77 };
    WrReferenceRequest bad[] = { good, good, good, good, good, good, good, good };
    bad[0].width = 0;
    bad[1].height = 4097;
    bad[2].first = 3;
    bad[3].first = 8, bad[3].most = 4;
    bad[4].most = 65;
    bad[5].change_rms = NAN;
    bad[6].cancel = &stop;
    bad[7].field = NULL;
    for (int k = 0; k < 8; k++) {
        WrError err = { "" };
        assert_false(wr_reference_render(&bad[k], NULL, &r, &err));
        assert_true(err.text[0] && r.samples == 77 && !r.rgba);
        if (k == 6) assert_string_equal(err.text, "cancelled");
    }
    scene->camera.target = scene->camera.eye;
    assert_false(wr_reference_render(&good, NULL, &r, NULL));
    wr_scene_free(scene);
    wr_field_free(field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_formula_on_the_plane_has_its_intensity_in_closed_form),
        cmocka_unit_test(the_mean_over_a_pixel_of_a_ramp_is_its_middle),
        cmocka_unit_test(a_sphere_covers_the_area_of_its_disk),
        cmocka_unit_test(the_middle_of_a_sphere_is_lit_as_by_hand),
        cmocka_unit_test(a_sphere_in_perspective_is_hit_where_the_quadratic_says),
        cmocka_unit_test(a_torus_is_hit_where_its_polynomial_is_zero),
        cmocka_unit_test(doubling_stops_when_the_picture_stands_still),
        cmocka_unit_test(hc92_equal_intensities_have_exactly_their_own_mean),
        cmocka_unit_test(the_bits_do_not_depend_on_the_number_of_threads),
        cmocka_unit_test(only_the_blocks_that_are_wanted_are_rendered),
        cmocka_unit_test(what_cannot_be_is_refused_and_leaves_the_last_picture),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
