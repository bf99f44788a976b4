/* The reference's own table, normal, probe and maps. */
#include "test.h"
#include "field/scheme_list.h"
#include "render_scenes.h"

#include "base/memory.h"
#include "base/error.h"
#include "field/analytic.h"
#include "field/field.h"
#include "render/reference/reference.h"
#include "render/reference/reference_shade.h"
#include "scene/scene.h"
#include "shade/bump.h"

/* A scene whose F is the table itself. */
static WrScene *plain_scene(void)
{
    WrScene *scene = wr_scene_new();
    scene->height = 1;
    return scene;
}

static void hc58_the_spline_goes_through_every_sample(void **state)
{
    (void)state;
    static const int sizes[][2] = { { 1, 1 }, { 2, 1 }, { 1, 3 }, { 2, 2 }, { 3, 5 }, { 64, 37 } };
    TestRandom random = { 11 };
    WrScene *scene = plain_scene();
    for (int k = 0; k < 24; k++) {
        const int w = sizes[k / 4][0], h = sizes[k / 4][1];
        WrField *field = wr_field_new(w, h, k & 1 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC,
                                      k & 2 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC, 0, NULL);
        for (int i = 0; i < w * h; i++)
            wr_field_set(field, i % w, i / w, (float)(200 * test_random(&random) - 100));
        WrReferenceTable table;
        assert_true(wr_reference_table_init(&table, field, NULL, NULL));
        for (int i = 0; i < w * h; i++) {
            double f, fu, fv, u = (i % w + 0.5) / w, v = 1 - (i / w + 0.5) / h;
            wr_reference_table_at(&table, scene, u, v, &f, &fu, &fv);
            assert_near(f, (double)wr_field_get(field, i % w, i / w), 200 * 1e-12);
        }
        wr_reference_table_fini(&table);
        wr_field_free(field);
    }
    wr_scene_free(scene);
}

/* The quadratic is extrapolated beyond the ends, and cubic splines reproduce it exactly. */
static void a_quadratic_between_ends_is_exact_up_to_them(void **state)
{
    (void)state;
    WrScene *scene = plain_scene();
    WrField *field = wr_field_new(8, 16, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0, NULL);
    for (int j = 0; j < 16; j++)
        for (int i = 0; i < 8; i++) {
            double u = (i + 0.5) / 8, v = 1 - (j + 0.5) / 16; /* all exact in float */
            wr_field_set(field, i, j, (float)(u * u - 3 * v * v + 2 * u * v + 1));
        }
    WrReferenceTable table;
    assert_true(wr_reference_table_init(&table, field, NULL, NULL));
    for (int k = 0; k <= 400; k++) {
        double u = (k % 21) / 20.0, v = k / 400.0, f, fu, fv;
        wr_reference_table_at(&table, scene, u, v, &f, &fu, &fv);
        assert_near(f, u * u - 3 * v * v + 2 * u * v + 1, 1e-12);
        assert_near(fu, 2 * u + 2 * v, 1e-11);
        assert_near(fv, -6 * v + 2 * u, 1e-11);
    }
    double f, fu, fv, end;
    scene->replicate_u = 2;
    wr_reference_table_at(&table, scene, 0.5, 0.3, &end, &fu, &fv);
    wr_reference_table_at(&table, scene, 0.9, 0.3, &f, &fu, &fv);
    assert_true(f == end && fu == 0 && fv != 0); /* beyond the end F is constant along u */
    wr_reference_table_fini(&table);
    wr_field_free(field);
    wr_scene_free(scene);
}

static void hc47_a_flat_table_has_no_slope_to_the_bit(void **state)
{
    (void)state;
    WrScene *scene = plain_scene();
    for (int wrap = 0; wrap < 2; wrap++) {
        WrField *field = wr_field_new(9, 7, (WrWrap)wrap, (WrWrap)wrap, 1e6f / 3, NULL);
        WrReferenceTable table;
        assert_true(wr_reference_table_init(&table, field, NULL, NULL));
        for (int k = 0; k < 50; k++) {
            double f, fu, fv;
            wr_reference_table_at(&table, scene, k / 49.0, k * k / 2401.0, &f, &fu, &fv);
            assert_true(f == (double)(1e6f / 3) && fu == 0 && fv == 0);
        }
        wr_reference_table_fini(&table);
        wr_field_free(field);
    }
    wr_scene_free(scene);
}

static void the_spline_is_the_fields_own_to_float(void **state)
{
    (void)state;
    WrScene *scene = plain_scene();
    scene->scheme = WR_SCHEME_BSPLINE_FIT;
    scene->replicate_u = 2.5, scene->replicate_v = -3;
    WrField *field = bumpy_field(20, 30);
    WrReferenceTable table;
    assert_true(wr_reference_table_init(&table, field, NULL, NULL));
    for (int k = 0; k < 60; k++) {
        double u = k / 60.0, v = k * 7 % 60 / 60.0, a[3], b[3];
        wr_reference_table_at(&table, scene, u, v, &a[0], &a[1], &a[2]);
        wr_scene_height(scene, field, u, v, &b[0], &b[1], &b[2]);
        assert_near(a[0], b[0], 1e-6);
        assert_near(a[1], b[1], 1e-4);
        assert_near(a[2], b[2], 1e-4);
    }
    wr_reference_table_fini(&table);
    wr_field_free(field);
    wr_scene_free(scene);
}

static double spread_out(TestRandom *random, int range)
{
    const double m = 2 * test_random(random) - 1;
    return scalbn(m, (int)(test_random(random) * 2 * range) - range);
}

/* For any height and slope, at points of every surface. */
static void normals_are_those_of_the_meaning(void **state)
{
    (void)state;
    TestRandom random = { 3 };
    for (int k = 0; k < 60000; k++) {
        WrShape shape;
        wr_shape_default((WrSurfaceKind)(k % WR_SURFACE_COUNT), &shape);
        WrSurfacePoint at;
        wr_surface_at(&shape, 0, k % 7 ? test_random(&random) : 0, k % 5 ? test_random(&random) : 1,
                      &at);
        const int range = k % 3 == 0 ? 300 : 6;
        double f = spread_out(&random, range), fu = spread_out(&random, range);
        double fv = k % 11 ? spread_out(&random, range) : 0;
        const WrBumpMode mode = (WrBumpMode)(k % WR_BUMP_COUNT);
        WrVec3 ours = wr_reference_normal(mode, &at, f, fu, fv);
        WrVec3 meant =
            wr_bump_unit_normal(mode, at.n, at.n_unit, at.pu, at.pv, at.n_u, at.n_v, f, fu, fv);
        assert_near(v3_angle_rad(ours, meant), 0, 1e-7);
        if (k % 3) assert_near(v3_angle_rad(ours, meant), 0, 2e-8);
        assert_near(v3_len(ours), 1, 1e-14);
    }
}

static WrProbe probe(const WrScene *scene, const WrField *field, double x, double y)
{
    WrError err = { "" };
    WrProbe out;
    if (!wr_reference_probe(field, scene, 120, 90, 15, x, y, &out, &err)) fail_msg("%s", err.text);
    return out;
}

static void a_probe_holds_the_formulas(void **state)
{
    (void)state;
    WrField *field = bumpy_field(32, 32);
    for (int kind = 0; kind < WR_SURFACE_COUNT; kind++) {
        WrScene *scene = scene_of(wr_surfaces[kind]->name);
        WrProbe p = { 0 };
        for (int k = 0; k < 60 && !(p.hit && p.tilt_deg > 0.1); k++)
            p = probe(scene, field, 30.3 + 6 * (k % 10), 25.6 + 6 * (k / 10));
        assert_true(p.hit);
        WrSurfacePoint at;
        double f, fu, fv;
        wr_surface_at(&scene->shape, p.face, p.u, p.v, &at);
        wr_scene_height(scene, field, p.u, p.v, &f, &fu, &fv);
        assert_memory_equal(&p.at, &at, sizeof at);
        assert_true(p.f == f && p.fu == fu && p.fv == fv);
        assert_near(v3_len(p.d), v3_len(p.a), 1e-12 * v3_len(p.a));                   /* B9 */
        assert_near(tan(p.tilt_deg * WR_RAD_PER_DEG), v3_len(p.d) / at.n_len, 1e-10); /* B10 */
        const bool curved = v3_len(at.n_u) + v3_len(at.n_v) > 0;
        if (curved) assert_true(p.dropped_deg > 0 && p.dropped_deg < 30);
        else assert_near(p.dropped_deg, 0, 1e-6); /* A4 */
        const WrProbe none = probe(scene, field, 1, 1);
        assert_false(none.hit);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

/* The footprint is the derivative of texel position by pixel position. */
static void a_footprint_is_how_texels_move_with_the_pixel(void **state)
{
    (void)state;
    WrField *field = bumpy_field(32, 48);
    for (int kind = 0; kind < WR_SURFACE_COUNT; kind++) {
        WrScene *scene = scene_of(wr_surfaces[kind]->name);
        scene->camera.orthographic = kind % 2;
        const double step = 1e-4, x = 58.3, y = 47.6;
        const WrProbe p = probe(scene, field, x, y);
        const WrProbe right = probe(scene, field, x + step, y),
                      down = probe(scene, field, x, y + step);
        const double u = 32 * scene->replicate_u / step, v = -48 * scene->replicate_v / step;
        const double want[4] = { (right.u - p.u) * u, (right.v - p.v) * v, (down.u - p.u) * u,
                                 (down.v - p.v) * v };
        double longer = fmax(hypot(want[0], want[1]), hypot(want[2], want[3]));
        for (int i = 0; i < 4; i++) assert_near(p.footprint[i], want[i], 1e-3 * longer);
        assert_near(p.level, fmax(0, log2(longer)), 1e-2);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

static void hc27_hc56_along_an_outline_a_footprint_stays_finite(void **state)
{
    (void)state;
    WrField *field = bumpy_field(32, 32);
    WrScene *scene = scene_of("sphere");
    scene->camera.orthographic = true;
    scene->posed = true;
    scene->rotate_deg = (WrVec3){ 0, 0, 0 };
    scene->camera.size = 2;
    for (int k = 0; k < 60; k++) { /* the silhouette at x = 105: increasingly near to it, and at the
                                      poles */
        const WrProbe p = probe(scene, field, 105 - scalbn(1, -k), 45);
        const WrProbe pole = probe(scene, field, 60, scalbn(1, -k));
        for (int i = 0; i < 4; i++)
            assert_true(fabs(p.footprint[i]) <= 1e9 && fabs(pole.footprint[i]) <= 1e9);
        assert_true(p.level >= 0 && p.level < 32 && pole.level >= 0 && pole.level < 32);
    }
    scene->replicate_u = scene->replicate_v = 0;
    assert_true(probe(scene, field, 60, 45).level == 0);
    wr_scene_free(scene);
    wr_field_free(field);
}

/* With F as a formula and the exact normal, the scene's own intensity equals the reference's. */
static void a_probes_light_is_the_pictures(void **state)
{
    (void)state;
    WrAnalyticTerm term = { .i = 3, .j = 2, .a = 1 };
    WrScene *scene = scene_of("torus");
    scene->analytic = (WrAnalytic){ WR_ANALYTIC_FOURIER, 1, &term };
    scene->bump = WR_BUMP_EXACT;
    WrReference r = { 0 };
    const WrReferenceRequest request = {
        .scene = scene, .width = 120, .height = 90, .turn_deg = 15, .first = 1, .most = 1
    };
    assert_true(wr_reference_render(&request, NULL, &r, NULL));
    for (int k = 0; k < 60; k++) {
        const int x = k * 37 % 120, y = k * 11 % 90;
        const WrProbe p = probe(scene, NULL, x + 0.5, y + 0.5);
        const double *rgba = r.rgba + 4 * (y * 120 + x);
        assert_true(p.hit == (rgba[3] == 1));
        for (int c = 0; c < 3 && p.hit; c++) assert_near(p.rgb[c], rgba[c], 1e-14);
    }
    scene->analytic = (WrAnalytic){ 0 };
    wr_reference_fini(&r);
    wr_scene_free(scene);
}

static void maps_hold_what_probes_say(void **state)
{
    (void)state;
    WrField *field = bumpy_field(32, 32);
    WrScene *scene = scene_of("sphere");
    WrPool *pool = wr_pool_new(2);
    float *map = wr_alloc(120 * 90, sizeof *map);
    for (int scheme = 0; scheme < WR_SCHEME_COUNT; scheme++)
        for (int kind = 0; kind < WR_MAP_COUNT; kind++) {
            scene->scheme = (WrScheme)scheme;
            assert_true(wr_reference_map(field, scene, 120, 90, 15, (WrProbeMap)kind, pool, NULL,
                                         map, NULL));
            for (int k = 0; k < 40; k++) {
                const int x = k * 37 % 120, y = k * 11 % 90;
                const WrProbe p = probe(scene, field, x + 0.5, y + 0.5);
                const double want[] = { p.dropped_deg, p.tilt_deg, p.level, p.f, 0 };
                const double got = (double)map[y * 120 + x];
                assert_true(p.hit == !isnan(got));
                if (p.hit && kind != WR_MAP_NORMAL)
                    assert_near(got, want[kind], 1e-4 * (1 + fabs(want[kind])));
                if (!p.hit || kind != WR_MAP_NORMAL) continue;
                const int code = (int)got;
                const double n[3] = { p.perturbed.x, p.perturbed.y, p.perturbed.z };
                for (int c = 0; c < 3; c++)
                    assert_near((code >> (16 - 8 * c) & 255) / 127.5 - 1, n[c], 1 / 255.0 + 1e-4);
            }
        }
    const int stop = 1;
    WrError err = { "" };
    assert_false(wr_reference_map(field, scene, 120, 90, 15, WR_MAP_TILT, pool, &stop, map, &err));
    assert_string_equal(err.text, "cancelled");
    assert_false(wr_reference_map(field, scene, 0, 90, 15, WR_MAP_TILT, pool, NULL, map, &err));
    scene->camera.target = scene->camera.eye;
    WrProbe p;
    assert_false(wr_reference_probe(field, scene, 120, 90, 0, 1, 1, &p, &err));
    wr_free(map);
    wr_pool_free(pool);
    wr_scene_free(scene);
    wr_field_free(field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hc58_the_spline_goes_through_every_sample),
        cmocka_unit_test(a_quadratic_between_ends_is_exact_up_to_them),
        cmocka_unit_test(hc47_a_flat_table_has_no_slope_to_the_bit),
        cmocka_unit_test(the_spline_is_the_fields_own_to_float),
        cmocka_unit_test(normals_are_those_of_the_meaning),
        cmocka_unit_test(a_probe_holds_the_formulas),
        cmocka_unit_test(a_footprint_is_how_texels_move_with_the_pixel),
        cmocka_unit_test(hc27_hc56_along_an_outline_a_footprint_stays_finite),
        cmocka_unit_test(a_probes_light_is_the_pictures),
        cmocka_unit_test(maps_hold_what_probes_say),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
