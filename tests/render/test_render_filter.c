/* test_render_filter.c - pyramids of slopes, footprints, filtered pictures, highlights widened by moments. */
#include "test.h"
#include "field/scheme_list.h"
#include "render_scenes.h"

#include "base/memory.h"
#include "base/error.h"
#include "field/field.h"
#include "render/kernels/kern.h"
#include "render/textures/slope_pyramid.h"
#include "render/visibility/view.h"
#include "scene/scene.h"
#include "shade/bump.h"

static const float *texel_of(const WrPyramid *pyramid, int level, int i, int j)
{
    const WrPyramidLevel *at = &pyramid->level[level];
    return at->data + (size_t)((j + 1) * at->pitch + i + 1) * (size_t)pyramid->floats;
}

static WrPyramid pyramid_of(const WrField *field, WrPyramidKind kind)
{
    WrPyramid pyramid = { 0 };
    WrError err = { "" };
    if (!wr_pyramid_update(&pyramid, kind, field, NULL, &err)) fail_msg("%s", err.text);
    return pyramid;
}

/* ---- pyramids ------------------------------------------------------------------------------------ */

/* Mean of n x n texels from (i, j), around the ends, in double. */
static double box(const WrField *field, int i, int j, int n)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    double sum = 0;
    for (int y = 0; y < n; y++)
        for (int x = 0; x < n; x++)
            sum += (double)wr_field_get(field, (i + x + w) % w, (j + y + h) % h);
    return sum / (n * n);
}

/* Theorem: the mean of the slopes over a box is the slope of the box-filtered F. */
static void means_of_slopes_are_slopes_of_the_box_filtered_heights(void **state)
{
    (void)state;
    WrField *field = random_field(16, 8, 1);
    WrPyramid pyramid = pyramid_of(field, WR_PYRAMID_SLOPES);
    for (int level = 1; level <= 3; level++)
        for (int j = 0; j < 8 >> level; j++)
            for (int i = 0; i < 16 >> level; i++) {
                const int n = 1 << level, x = i * n, y = j * n;
                const float *t = texel_of(&pyramid, level, i, j);
                double fu = (box(field, x + 1, y, n) - box(field, x - 1, y, n)) * 16 / 2;
                double fv = (box(field, x, y - 1, n) - box(field, x, y + 1, n)) * 8 / 2;
                assert_near((double)t[0], fu, 1e-5);
                assert_near((double)t[1], fv, 1e-5);
                assert_near((double)t[2], box(field, x, y, n), 1e-6);
            }
    wr_pyramid_drop(&pyramid);
    wr_field_free(field);
}

static void hc55_every_level_of_any_size_keeps_the_mean_and_the_phase(void **state)
{
    (void)state;
    const int sizes[][2] = { { 64, 16 }, { 5, 3 }, { 1, 9 }, { 7, 1 }, { 48, 100 }, { 33, 31 } };
    for (int s = 0; s < 6; s++) {
        const int w = sizes[s][0], h = sizes[s][1];
        WrField *field = wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
        double mean = 0;
        for (int j = 0; j < h; j++)
            for (int i = 0; i < w; i++) {
                wr_field_set(field, i, j, (float)(0.3 + sin(2 * WR_PI * (i + 0.5) / w)));
                mean += (double)wr_field_get(field, i, j) / (w * h);
            }
        WrPyramid pyramid = pyramid_of(field, WR_PYRAMID_SLOPES);
        for (int level = 1; level < pyramid.levels; level++) {
            const WrPyramidLevel *at = &pyramid.level[level];
            double sum = 0, in_phase = 0, across = 0;
            for (int j = 0; j < at->height; j++)
                for (int i = 0; i < at->width; i++) {
                    double f = (double)texel_of(&pyramid, level, i, j)[2];
                    double phase = 2 * WR_PI * (i + 0.5) / at->width;
                    sum += f / (at->width * at->height);
                    in_phase += f * sin(phase), across += f * cos(phase);
                }
            assert_near(sum, mean, 1e-6);
            if (at->width >= 3) assert_true(fabs(across) < 1e-4 * in_phase);
        }
        const WrPyramidLevel *last = &pyramid.level[pyramid.levels - 1];
        assert_true(last->width == 1 && last->height == 1);
        wr_pyramid_drop(&pyramid);
        wr_field_free(field);
    }
}

/* F = A sin(2 pi k u): central differences are A W sin(2 pi k / W) cos(...), whose mean square over whole
   periods is half their peak's square. */
static void the_covariance_of_a_sinusoid_is_half_its_peak_slope_squared(void **state)
{
    (void)state;
    const int w = 64, h = 16, k = 5;
    const double A = 0.3, peak = A * w * sin(2 * WR_PI * k / w);
    WrField *field = wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 1e3f, NULL);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++)
            wr_field_set(field, i, j, (float)(A * sin(2 * WR_PI * k * (i + 0.5) / w)));
    WrPyramid pyramid = pyramid_of(field, WR_PYRAMID_MOMENTS);
    const float *top = texel_of(&pyramid, pyramid.levels - 1, 0, 0);
    assert_near((double)top[0], 0, 1e-5);
    assert_near((double)top[4], peak * peak / 2, 1e-5 * peak * peak);
    assert_near((double)top[5], 0, 1e-5);
    assert_near((double)top[6], 0, 1e-5);
    wr_pyramid_drop(&pyramid);
    wr_field_free(field);
}

static void hc93_no_covariance_is_negative(void **state)
{
    (void)state;
    WrField *field = random_field(61, 47, 5);
    for (int i = 0; i < 61; i++) wr_field_set(field, i, 9, 3e7f); /* a cliff beside small slopes */
    WrPyramid pyramid = pyramid_of(field, WR_PYRAMID_MOMENTS);
    for (int level = 1; level < pyramid.levels; level++)
        for (int j = 0; j < pyramid.level[level].height; j++)
            for (int i = 0; i < pyramid.level[level].width; i++) {
                const float *t = texel_of(&pyramid, level, i, j);
                double uu = (double)t[4], uv = (double)t[5], vv = (double)t[6];
                assert_true(uu >= 0 && vv >= 0);
                assert_true(uu * vv - uv * uv >= -1e-6 * uu * vv);
            }
    wr_pyramid_drop(&pyramid);
    wr_field_free(field);
}

static void edits_refresh_a_pyramid_to_the_bits_of_a_new_one(void **state)
{
    (void)state;
    const int sizes[][2] = { { 200, 150 }, { 257, 129 }, { 64, 300 } };
    TestRandom random = { 4 };
    for (int s = 0; s < 3; s++)
        for (int kind = 0; kind < WR_PYRAMID_COUNT; kind++) {
            const int w = sizes[s][0], h = sizes[s][1];
            WrField *field = random_field(w, h, 2);
            WrPyramid kept = pyramid_of(field, (WrPyramidKind)kind);
            for (int step = 0; step < 6; step++) {
                int i = step == 0 ? 0 : (int)(w * test_random(&random));
                int j = step == 1 ? h - 1 : (int)(h * test_random(&random));
                wr_field_set(field, i, j, 5);
                assert_true(wr_pyramid_update(&kept, (WrPyramidKind)kind, field, NULL, NULL));
                assert_true(kept.texels_refreshed < w * h);
                WrPyramid fresh = pyramid_of(field, (WrPyramidKind)kind);
                for (int l = 0; l < kept.levels; l++) {
                    const WrPyramidLevel *a = &kept.level[l], *b = &fresh.level[l];
                    size_t bytes = (size_t)(a->pitch * (a->height + 2) * kept.floats) * 4;
                    if (a->data && memcmp(a->data, b->data, bytes) != 0)
                        fail_msg("%dx%d kind %d step %d level %d", w, h, kind, step, l);
                }
                wr_pyramid_drop(&fresh);
            }
            wr_pyramid_drop(&kept);
            wr_field_free(field);
        }
}

/* ---- footprints ------------------------------------------------------------------------------------ */

static void hc56_levels_and_look_ups_of_known_footprints(void **state)
{
    (void)state;
    WrField *field = random_field(256, 256, 1);
    WrPyramid pyramid = pyramid_of(field, WR_PYRAMID_SLOPES);
    const WrLook look = {
        .width = 256, .height = 256, .ru = 1, .rv = 1, .periodic_u = true, .pyramid = &pyramid
    };
    const struct {
        float r[2], w[2];
        double level[2];
        int taps;
    } cases[] = { { { 0.5f, 0 }, { 0, 0.9f }, { 0, 0 }, 1 },
                  { { 8, 0 }, { 0, 8 }, { 3, 3 }, 1 },
                  { { 8, 0 }, { 0, 1 }, { 3, 0 }, 8 },
                  { { 0, 2 }, { 12, 0 }, { log2(12), 1 }, 6 },
                  { { 100, 0 }, { 0, 1 }, { log2(100), log2(100.0 / 16) }, 16 },
                  { { 0, 0 }, { 0, 0 }, { 0, 0 }, 1 },
                  { { NAN, 0 }, { 0, 1 }, { 8, 8 }, 0 },
                  { { 1e9f, 0 }, { 0, 1e3f }, { 8, 8 }, 16 } };
    WrStrip *strip = wr_alloc(1, sizeof *strip);
    const WrKernels *kernels = wr_kernels_get("auto", false, NULL);
    for (int wide = 0; wide < 2; wide++) {
        strip->count = 8;
        for (int i = 0; i < 8; i++) {
            strip->rx[i] = cases[i].r[0], strip->ry[i] = cases[i].r[1];
            strip->wx[i] = cases[i].w[0], strip->wy[i] = cases[i].w[1];
        }
        kernels->spread(&look, wide, strip);
        for (int i = 0; i < 8; i++) {
            if (i != 6) assert_near((double)strip->level[i], cases[i].level[wide], 1e-4);
            assert_true(strip->level[i] >= 0 && strip->level[i] <= 8);
            assert_in_range(strip->taps[i], 1, 16);
            if (cases[i].taps > 0) assert_int_equal(strip->taps[i], wide ? cases[i].taps : 1);
        }
    }
    wr_free(strip);
    wr_pyramid_drop(&pyramid);
    wr_field_free(field);
}

/* Footprints against differences of (u, v) picked at neighbouring pixels. */
static void footprints_are_the_differences_between_neighbouring_pixels(void **state)
{
    (void)state;
    const char *const surfaces[] = { "plane", "sphere", "torus", "bezier", "cone" };
    WrField *field = random_field(64, 64, 1);
    const WrKernels *kernels = wr_kernels_get("auto", false, NULL);
    WrStrip *strip = wr_alloc(1, sizeof *strip);
    for (int s = 0; s < 5; s++) {
        enum { SIDE = 400 };
        WrScene *scene = scene_of(surfaces[s]);
        Shot shot = shoot(scene, field, SIDE, SIDE, 1, "auto", false);
        WrView view;
        assert_true(wr_view_init(&view, scene, wr_shape_radius(&scene->shape), shot.frame.plan, 15,
                                 SIDE, SIDE, NULL));
        double x = 80.5, y = 190.5, at[2], right[2], down[2];
        int face;
        while (x < 300 && !wr_renderer_pick(shot.renderer, x - 20, y, &at[0], &at[1], &face)) x++;
        assert_true(wr_renderer_pick(shot.renderer, x, y, &at[0], &at[1], &face));
        assert_true(wr_renderer_pick(shot.renderer, x + 1, y, &right[0], &right[1], &face));
        assert_true(wr_renderer_pick(shot.renderer, x, y + 1, &down[0], &down[1], &face));
        const WrLook look = {
            .width = 64, .height = 64, .ru = 3, .rv = 2, .periodic_u = true, .periodic_v = true
        };
        strip->count = 1;
        strip->x[0] = (float)(x - 0.5), strip->y[0] = 190;
        strip->u[0] = (float)at[0], strip->v[0] = (float)at[1];
        kernels->geometry[scene->shape.kind](&view.shape, 0, strip);
        kernels->footprint(&wr_view_grid(&view, 1)->rays, &look, 1, strip);
        double want[4] = { 192 * (right[0] - at[0]), -128 * (right[1] - at[1]),
                           192 * (down[0] - at[0]), -128 * (down[1] - at[1]) };
        float got[4] = { strip->rx[0], strip->ry[0], strip->wx[0], strip->wy[0] };
        double size = hypot(hypot(want[0], want[1]), hypot(want[2], want[3]));
        for (int k = 0; k < 4; k++)
            if (!(fabs((double)got[k] - want[k]) < 0.03 * size))
                fail_msg("%s: %d: %g, difference says %g", surfaces[s], k, (double)got[k], want[k]);
        wr_view_fini(&view);
        put_away(&shot);
        wr_scene_free(scene);
    }
    wr_free(strip);
    wr_field_free(field);
}

/* ---- pictures -------------------------------------------------------------------------------------- */

/* E17, and HC94 for small footprints. */
static void filtering_has_the_bits_of_point_where_no_footprint_exceeds_a_texel(void **state)
{
    (void)state;
    WrField *field = bumpy_field(12, 10);
    for (int scheme = 0; scheme < WR_SCHEME_COUNT; scheme++)
        for (int how = 0; how < 8; how++) {
            WrScene *scene = scene_of(how & 1 ? "plane" : "cube");
            scene->scheme = (WrScheme)scheme;
            scene->replicate_u = scene->replicate_v = 1;
            scene->camera.orthographic = true;
            Shot point = shoot(scene, field, 160, 160, 2, "auto", false);
            scene->dials.aa = how & 2 ? WR_AA_MOMENTS : WR_AA_FILTER;
            scene->dials.footprint = how & 4 ? WR_FOOTPRINT_ANISOTROPIC : WR_FOOTPRINT_ISOTROPIC;
            scene->dials.moments = how & 4 ? WR_MOMENTS_LEAN : WR_MOMENTS_TOKSVIG;
            Shot filtered = shoot(scene, field, 160, 160, 2, "auto", false);
            if (!same_picture(&point, &filtered)) fail_msg("scheme %d, how %d", scheme, how);
            assert_int_equal(filtered.frame.plan->rows[WR_EFFECT_FILTER].pixels, 0);
            put_away(&point);
            put_away(&filtered);
            wr_scene_free(scene);
        }
    wr_field_free(field);
}

static void hc94_a_flat_table_under_moments_has_the_bits_of_point(void **state)
{
    (void)state;
    WrField *flat = wr_field_new(128, 128, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.7f, NULL);
    for (int model = 0; model < WR_MOMENTS_COUNT; model++) {
        WrScene *scene = scene_of("torus");
        scene->material.shininess = 200;
        Shot point = shoot(scene, flat, 60, 60, 2, "auto", true);
        scene->dials.aa = WR_AA_MOMENTS;
        scene->dials.moments = (WrMoments)model;
        Shot moments = shoot(scene, flat, 60, 60, 2, "auto", true); /* no effect may be skipped */
        assert_true(wr_plan_runs(moments.frame.plan, WR_EFFECT_SPREAD));
        assert_true(same_picture(&point, &moments));
        put_away(&point);
        put_away(&moments);
        wr_scene_free(scene);
    }
    wr_field_free(flat);
}

/* Every pixel covers a whole number of periods: the mean slope is 0, so filtering produces the smooth plane. */
static void far_away_the_filtered_table_is_smooth(void **state)
{
    (void)state;
    WrField *field = bumpy_field(64, 64);
    for (int shape = 0; shape < WR_FOOTPRINT_COUNT; shape++) {
        WrScene *scene = scene_of("plane");
        scene->height = 0.5;
        scene->replicate_u = scene->replicate_v = 200;
        scene->dials.aa = WR_AA_FILTER;
        scene->dials.footprint = (WrFootprint)shape;
        Shot filtered = shoot(scene, field, 40, 40, 2, "auto", false);
        scene->bump = WR_BUMP_NONE;
        Shot smooth = shoot(scene, field, 40, 40, 2, "auto", false);
        float worst = worst_difference(&filtered, &smooth);
        if (!(worst < 1e-2f)) fail_msg("shape %d: %g", shape, (double)worst);
        put_away(&filtered);
        put_away(&smooth);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

/* E29 with pyramids: an edit reaches farther on coarse levels. The last case: rows of a sphere that use fused loops
   (render/simd/simd_kernels.h), which are not bit-identical. */
static void a_resting_filtered_view_is_refreshed_to_the_bits_of_a_new_picture(void **state)
{
    (void)state;
    const WrAntialias how[] = { WR_AA_FILTER, WR_AA_MOMENTS, WR_AA_ADAPTIVE, WR_AA_SUPERSAMPLE };
    for (int k = 0; k < 9; k++) {
        WrField *field = bumpy_field(300, 200);
        WrScene *scene = scene_of(k == 8 ? "sphere" : k & 1 ? "plane" : "torus");
        scene->dials.aa = how[k / 2 % 4];
        scene->dials.footprint = k == 8 ? WR_FOOTPRINT_ISOTROPIC : WR_FOOTPRINT_ANISOTROPIC;
        if (k == 8) scene->dials.arithmetic = WR_ARITHMETIC_FAST;
        scene->dials.samples = 2;
        if (k == 5) scene->dials.heights = WR_HEIGHTS_8;
        if (k == 6) scene->dials.shading = WR_SHADING_DOUBLE;
        scene->replicate_u = scene->replicate_v = 1;
        const int w = k == 8 ? 230 : 140,
                  h = k == 8 ? 190 : 112; /* more than a tile, also of `adaptive` */
        Shot kept = shoot(scene, field, w, h, 2, "auto", false);
        WrFrameRequest request = {
            .field = field, .scene = scene, .width = w, .height = h, .turn_deg = 15, .keep = true
        };
        assert_true(wr_renderer_frame(kept.renderer, &request, &kept.frame, NULL));
        int64_t whole = kept.frame.shaded, least = whole;
        TestRandom random = { 5 };
        for (int step = 0; step < 8; step++) {
            int i = step == 0 ? 0 : (int)(300 * test_random(&random));
            int j = step == 1 ? 199 : (int)(200 * test_random(&random));
            wr_field_set(field, i, j, (float)(2 * test_random(&random)));
            assert_true(wr_renderer_frame(kept.renderer, &request, &kept.frame, NULL));
            Shot fresh = shoot(scene, field, w, h, 2, "auto", false);
            if (k == 8 ? !(worst_difference(&kept, &fresh) < 2e-4f) : !same_picture(&kept, &fresh))
                fail_msg("case %d, step %d", k, step);
            least = kept.frame.shaded < least ? kept.frame.shaded : least;
            put_away(&fresh);
        }
        assert_true(least < whole); /* otherwise nothing was cached */
        put_away(&kept);
        wr_scene_free(scene);
        wr_field_free(field);
    }
}

/* ---- highlights ------------------------------------------------------------------------------------- */

/* The mean of the program's lobe over normals whose tangents are spread by a Gaussian of covariance (a, b, c) about
   the z axis, by a rule of 81 x 81 points. */
static double mean_lobe(WrVec3 h, double s, double a, double b, double c)
{
    enum { N = 40 };
    double l11 = sqrt(a), l21 = a > 0 ? b / l11 : 0, l22 = sqrt(fmax(0, c - l21 * l21));
    double sum = 0, weight = 0;
    for (int i = -N; i <= N; i++)
        for (int j = -N; j <= N; j++) {
            double p = 5.0 * i / N, q = 5.0 * j / N, w = exp(-(p * p + q * q) / 2);
            WrVec3 n = { l11 * p, l21 * p + l22 * q, 1 };
            n = v3_unit(n, n);
            sum += w * pow(fmax(0, v3_dot(n, h)), s);
            weight += w;
        }
    return sum / weight;
}

/* Exact except for the lobe's shape, which is a Gaussian only near its middle: within 8 % of the peak. */
static void lean_is_the_mean_of_the_lobe_over_gaussian_slopes(void **state)
{
    (void)state;
    const double spreads[][3] = {
        { 0.01, 0, 0.01 }, { 0.04, 0.01, 0.005 }, { 0.002, 0, 0.03 }, { 0.02, -0.015, 0.02 }
    };
    const WrKernels *kernels = wr_kernels_get("auto", false, NULL);
    WrStrip *strip = wr_alloc(1, sizeof *strip);
    const WrKernLight light = { .rgb = { 1, 1, 1 } };
    for (int k = 0; k < 4; k++)
        for (int t = 0; t < 9; t++) {
            const WrKernShine shine = { 1, 60, true };
            double x = (t % 3 - 1) * 0.15, y = (t / 3 - 1) * 0.15;
            WrVec3 h = v3_unit((WrVec3){ x, y, 1 }, (WrVec3){ 0, 0, 1 });
            strip->count = 1;
            strip->bz[0] = strip->nz[0] = strip->ex[0] = strip->n_dot_l[0] = 1;
            strip->bx[0] = strip->by[0] = strip->ey[0] = strip->ez[0] = 0;
            strip->lx[0] = strip->vx[0] = (float)h.x;
            strip->ly[0] = strip->vy[0] = (float)h.y;
            strip->lz[0] = strip->vz[0] = (float)h.z;
            strip->see[0] = (float)spreads[k][0];
            strip->sef[0] = (float)spreads[k][1];
            strip->sff[0] = (float)spreads[k][2];
            strip->sr[0] = strip->sg[0] = strip->sb[0] = 0;
            kernels->specular_lean(&light, &shine, strip);
            double want = mean_lobe(h, 60, spreads[k][0], spreads[k][1], spreads[k][2]);
            double peak =
                mean_lobe((WrVec3){ 0, 0, 1 }, 60, spreads[k][0], spreads[k][1], spreads[k][2]);
            if (!(fabs((double)strip->sr[0] - want) < 0.08 * peak))
                fail_msg("spread %d, direction %d: %g, mean %g, peak %g", k, t,
                         (double)strip->sr[0], want, peak);
        }
    wr_free(strip);
}

/* Slopes of a sheared, stretched patch: C = J S J^T against tangents of normals bent by a small step along
   each slope (finite differences of the paper's formula in double). */
static void the_spread_of_slopes_is_carried_across_the_bent_normal(void **state)
{
    (void)state;
    const WrKernels *kernels = wr_kernels_get("auto", false, NULL);
    WrStrip *strip = wr_alloc(1, sizeof *strip);
    TestRandom random = { 11 };
    for (int trial = 0; trial < 200; trial++) {
        WrVec3 pu = { 0.3 + test_random(&random), test_random(&random) - 0.5,
                      test_random(&random) - 0.5 };
        WrVec3 pv = { test_random(&random) - 0.5, 0.3 + 2 * test_random(&random),
                      test_random(&random) - 0.5 };
        WrVec3 N = v3_cross(pu, pv), n = v3_unit(N, N);
        double fu = test_random(&random) - 0.5, fv = test_random(&random) - 0.5;
        double suu = test_random(&random), svv = test_random(&random), suv = 0.4 * sqrt(suu * svv);
        WrVec3 bent = v3_unit(wr_bump_normal(WR_BUMP_BLINN, N, n, pu, pv, n, n, 0, fu, fv), n);
        const double e = 1e-5;
        WrVec3 du = v3_scale(
            v3_sub(v3_unit(wr_bump_normal(WR_BUMP_BLINN, N, n, pu, pv, n, n, 0, fu + e, fv), n),
                   bent),
            1 / e);
        WrVec3 dv = v3_scale(
            v3_sub(v3_unit(wr_bump_normal(WR_BUMP_BLINN, N, n, pu, pv, n, n, 0, fu, fv + e), n),
                   bent),
            1 / e);
        strip->count = 1;
        strip->pux[0] = (float)pu.x, strip->puy[0] = (float)pu.y, strip->puz[0] = (float)pu.z;
        strip->pvx[0] = (float)pv.x, strip->pvy[0] = (float)pv.y, strip->pvz[0] = (float)pv.z;
        strip->nx[0] = (float)n.x, strip->ny[0] = (float)n.y, strip->nz[0] = (float)n.z;
        strip->bx[0] = (float)bent.x, strip->by[0] = (float)bent.y, strip->bz[0] = (float)bent.z;
        strip->n_len[0] = (float)v3_len(N);
        strip->suu[0] = (float)suu, strip->suv[0] = (float)suv, strip->svv[0] = (float)svv;
        kernels->widen(false, strip);
        WrVec3 a = { (double)strip->ex[0], (double)strip->ey[0], (double)strip->ez[0] };
        WrVec3 b = v3_cross(bent, a);
        double ua = v3_dot(du, a), va = v3_dot(dv, a), ub = v3_dot(du, b), vb = v3_dot(dv, b);
        double want[3] = { suu * ua * ua + 2 * suv * ua * va + svv * va * va,
                           suu * ua * ub + suv * (ua * vb + va * ub) + svv * va * vb,
                           suu * ub * ub + 2 * suv * ub * vb + svv * vb * vb };
        double got[3] = { (double)strip->see[0], (double)strip->sef[0], (double)strip->sff[0] };
        double size = want[0] + want[2];
        for (int k = 0; k < 3; k++)
            if (!(fabs(got[k] - want[k]) < 1e-3 * size))
                fail_msg("trial %d: %d: %g, differences say %g", trial, k, got[k], want[k]);
    }
    wr_free(strip);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(means_of_slopes_are_slopes_of_the_box_filtered_heights),
        cmocka_unit_test(hc55_every_level_of_any_size_keeps_the_mean_and_the_phase),
        cmocka_unit_test(the_covariance_of_a_sinusoid_is_half_its_peak_slope_squared),
        cmocka_unit_test(hc93_no_covariance_is_negative),
        cmocka_unit_test(edits_refresh_a_pyramid_to_the_bits_of_a_new_one),
        cmocka_unit_test(hc56_levels_and_look_ups_of_known_footprints),
        cmocka_unit_test(footprints_are_the_differences_between_neighbouring_pixels),
        cmocka_unit_test(filtering_has_the_bits_of_point_where_no_footprint_exceeds_a_texel),
        cmocka_unit_test(hc94_a_flat_table_under_moments_has_the_bits_of_point),
        cmocka_unit_test(far_away_the_filtered_table_is_smooth),
        cmocka_unit_test(a_resting_filtered_view_is_refreshed_to_the_bits_of_a_new_picture),
        cmocka_unit_test(lean_is_the_mean_of_the_lobe_over_gaussian_slopes),
        cmocka_unit_test(the_spread_of_slopes_is_carried_across_the_bent_normal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
