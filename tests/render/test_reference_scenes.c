/* The reference and the fast path in its most exact mode, which share no kernel, render the same pictures: every
   surface, and each element of a scene. */
#include "test.h"
#include "field/scheme_list.h"
#include "render_scenes.h"

#include "base/memory.h"
#include "base/error.h"
#include "base/enum_rows.h"
#include "field/analytic.h"
#include "field/field.h"
#include "image/image.h"
#include "render/reference/reference.h"
#include "render/reference/reference_intersect.h"
#include "scene/scene.h"
#include "surface/data.h"
#include "base/vec.h"

#define SIZE 120

/* True where the base, without bumps, bends by less than 12 degrees to every neighbour: away from silhouettes,
   creases and occlusion borders. */
static bool smooth(const WrReference *base, int x, int y)
{
    const double *n = base->normal + 3 * (y * SIZE + x);
    const WrVec3 here = { n[0], n[1], n[2] };
    for (int k = 0; k < 9; k++) {
        const int i = x + k % 3 - 1, j = y + k / 3 - 1;
        if (i < 0 || j < 0 || i >= SIZE || j >= SIZE) return false;
        const double *m = base->normal + 3 * (j * SIZE + i);
        const WrVec3 there = { m[0], m[1], m[2] };
        if (v3_dot(here, there) < 0.978) return false;
    }
    return true;
}

static WrReference reference_of(const WrScene *scene, const WrField *field, WrPool *pool)
{
    WrReference out = { 0 };
    WrError err = { "" };
    const WrReferenceRequest request = { .field = field,
                                         .scene = scene,
                                         .width = SIZE,
                                         .height = SIZE,
                                         .turn_deg = 15,
                                         .first = 1,
                                         .most = 1 };
    if (!wr_reference_render(&request, pool, &out, &err)) fail_msg("%s", err.text);
    return out;
}

/* Where the base is smooth, the largest difference is below `bound`. Elsewhere the fast path's silhouette, from a
 * mesh with an error of at most a quarter of a pixel, may differ in one pixel in a hundred. */
static void assert_agree(WrScene *scene, const WrField *field, double bound)
{
    scene->scheme = WR_SCHEME_BSPLINE_FIT;
    if (scene->bump != WR_BUMP_INVARIANT) scene->bump = WR_BUMP_EXACT;
    Shot shot = shoot(scene, field, SIZE, SIZE, 2, "ref", false);
    WrReference ours = reference_of(scene, field, shot.pool);
    const double height = scene->height;
    scene->height = 0;
    WrReference base = reference_of(scene, field, shot.pool);
    scene->height = height;
    int covered = 0, unlike = 0, inner = 0;
    double worst = 0;
    for (int i = 0; i < SIZE * SIZE; i++) {
        const float *a = shot.frame.rgba + 4 * i;
        const double *b = ours.rgba + 4 * i;
        covered += b[3] > 0;
        unlike += (double)a[3] != b[3];
        if ((double)a[3] != b[3] || b[3] == 0 || !smooth(&base, i % SIZE, i / SIZE)) continue;
        inner++;
        for (int c = 0; c < 3; c++) worst = fmax(worst, fabs((double)a[c] - b[c]));
    }
    assert_true(inner > covered / 2 && inner > 400);
    assert_true(100 * unlike <= covered);
    assert_near(worst, 0, bound);
    assert_int_equal(ours.lost, 0);
    wr_reference_fini(&ours);
    wr_reference_fini(&base);
    put_away(&shot);
}

/* A stretched object and its kind; returns the number of covered pixels. Flattening magnifies errors of normals:
 * single precision is limited to a factor of 32 (wr_scene_is_thin). */
static int assert_sees(WrScene *scene, const WrField *field, const char *what, int k)
{
    scene->scheme = WR_SCHEME_BSPLINE_FIT;
    scene->bump = WR_BUMP_EXACT;
    Shot shot = shoot(scene, field, SIZE, SIZE, 2, "ref", false);
    WrReference ours = reference_of(scene, field, shot.pool);
    int covered = 0, unlike = 0, far_off = 0;
    for (int i = 0; i < SIZE * SIZE; i++) {
        const float *a = shot.frame.rgba + 4 * i;
        const double *b = ours.rgba + 4 * i;
        covered += b[3] > 0;
        unlike += (double)a[3] != b[3];
        for (int c = 0; c < 4; c++) assert_true(isfinite(a[c]) && isfinite(b[c]));
        bool far = false;
        for (int c = 0; c < 3 && (double)a[3] == b[3]; c++) far |= fabs((double)a[c] - b[c]) > 1e-3;
        far_off += far;
    }
    if (40 * unlike > covered + 400 || 50 * far_off > covered)
        fail_msg("%s, sizes %d: of %d pixels %d are there in one only, %d are others", what, k,
                 covered, unlike, far_off);
    wr_reference_fini(&ours);
    put_away(&shot);
    return covered;
}

/* Float has 24 bits; n' loses up to W of them to slopes, and the highlight's power s of the rest. */
#define FLOAT_BOUND 2e-5

static void every_surface_looks_alike(void **state)
{
    (void)state;
    WrField *field = bumpy_field(64, 64);
    for (int kind = 0; kind < WR_SURFACE_COUNT; kind++) {
        WrScene *scene = scene_of(wr_surfaces[kind]->name);
        assert_agree(scene, field, FLOAT_BOUND);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

/* HC153: different scales, mirrored or flattened, near and far, with positional lights. */
static void hc153_stretched_objects_look_alike(void **state)
{
    (void)state;
    static const WrVec3 sizes[] = { { 1, 1, 2 },  { 1, 0.4, -1 },  { -0.7, 1, 0.3 },
                                    { 1, 0, 1 },  { 1, 1, -100 },  { 0.02, 1, -0.9 },
                                    { 0, -1, 1 }, { -1, -0.5, -2 } };
    WrField *field = bumpy_field(64, 64);
    int covered = 0;
    for (int kind = 0; kind < WR_SURFACE_COUNT; kind++)
        for (int k = kind % 2; k < WR_LENGTH(sizes); k += getenv("WR_FULL") ? 1 : 7) {
            WrScene *scene = scene_of(wr_surfaces[kind]->name);
            scene->sizes = sizes[k];
            scene->size = fmax(fabs(sizes[k].x), fmax(fabs(sizes[k].y), fabs(sizes[k].z)));
            scene->posed = true;
            scene->rotate_deg = (WrVec3){ -60, 25, 10 };
            scene->height *= 0.5;
            if (k % 2) scene->camera.orthographic = true;
            if (k % 3 == 1)
                scene->lights[0] =
                    (WrLight){ WR_LIGHT_POINT, { -2, 3, 4 }, { 1, 1, 1 }, 1, 0, false };
            covered += assert_sees(scene, field, wr_surfaces[kind]->name, k);
            wr_scene_free(scene);
        }
    assert_true(covered > 40000);
    wr_field_free(field);
}

/* A stretched sphere is an ellipsoid in both renderers. */
static void hc153_a_stretched_ball_is_an_ellipsoid(void **state)
{
    (void)state;
    WrField *field = bumpy_field(16, 16);
    WrScene *ball = scene_of("sphere"), *other = scene_of("superellipsoid");
    ball->sizes = (WrVec3){ 0.6, -1.5, 1.1 }, ball->size = 1.5;
    for (int i = 0; i < 3; i++) other->shape.value[i] = (double[]){ 0.6, 1.5, 1.1 }[i];
    ball->shape.value[0] = other->shape.value[3] = other->shape.value[4] = 1;
    ball->height = other->height = 0;
    ball->posed = other->posed = true;
    ball->rotate_deg = other->rotate_deg = (WrVec3){ -40, 30, 10 };
    ball->camera.fit = other->camera.fit = false;
    ball->camera.eye = other->camera.eye = (WrVec3){ 1, 2, 6 };
    Shot a = shoot(ball, field, SIZE, SIZE, 2, "ref", false);
    Shot b = shoot(other, field, SIZE, SIZE, 2, "ref", false);
    int covered = 0, unlike = 0, inner = 0;
    for (int i = 0; i < SIZE * SIZE; i++) {
        const float *p = a.frame.rgba + 4 * i, *q = b.frame.rgba + 4 * i;
        bool same = p[3] == q[3];
        for (int c = 0; c < 3; c++) same &= fabs((double)p[c] - (double)q[c]) < 2e-4;
        covered += p[3] > 0, inner += p[3] > 0 && same, unlike += !same;
    }
    assert_true(covered > 1000 && inner > 900 && 50 * unlike < covered); /* along the silhouette */
    put_away(&a);
    put_away(&b);
    wr_scene_free(ball);
    wr_scene_free(other);
    wr_field_free(field);
}

/* Scenes of surfaces with text parameters; each text of the row, or NULL. */
static WrScene *scene_of_words(const char *surface, const char *const *text)
{
    WrError err = { "" };
    WrScene *scene = scene_of(surface);
    WrSurfaceData *data = wr_surface_data_make(scene->shape.kind, text, &err);
    if (!data) fail_msg("%s", err.text);
    WrShape shape = scene->shape;
    wr_shape_borrow_data(&shape, data);
    wr_scene_set_shape(scene, &shape);
    wr_surface_data_free(data);
    return scene;
}

/* With corners, tips, a ring; a sphere and a shell by formulas. */
static void profiles_and_formulas_look_alike(void **state)
{
    (void)state;
    static const char *const words[][4] = {
        { "revolution", "0.5,-0.7;0.5,0.3;0.5,0.3;0,0.8;0,0.8" },
        { "revolution", "0,-0.6;0.7,-0.6;0.7,-0.6;0.6,0.1;0.6,0.1;0.9,0.5" },
        { "revolution", "0.5,0;0.9,-0.3;1.2,0;0.9,0.3;0.5,0" },
        { "formula", "cos(2*pi*u)*cos(pi*(v-0.5))", "sin(2*pi*u)*cos(pi*(v-0.5))",
          "sin(pi*(v-0.5))" },
        { "formula", "exp(-2.6*u)*cos(9*pi*u)*(1.05+cos(2*pi*v))",
          "exp(-2.6*u)*sin(9*pi*u)*(1.05+cos(2*pi*v))",
          "4.2*(1-exp(-2.6*u))+1.2*exp(-2.6*u)*sin(2*pi*v)" },
    };
    WrField *field = bumpy_field(32, 32);
    for (size_t k = 0; k < sizeof words / sizeof *words; k++) {
        WrScene *scene = scene_of_words(words[k][0], words[k] + 1);
        /* A float in radians, up to 9 pi, has an error of 1e-6, and slopes are divided by lengths down to 0.07. */
        assert_agree(scene, field, k < 3 ? FLOAT_BOUND : k == 3 ? 2e-4 : 8e-4);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

static void superellipsoids_of_every_form_look_alike(void **state)
{
    (void)state;
    static const double forms[][2] = {
        { 0.2, 0.2 }, { 1, 0.3 }, { 2, 2 }, { 1.4, 1.7 }, { 3, 0.5 }
    };
    WrField *field = bumpy_field(32, 32);
    for (size_t k = 0; k < sizeof forms / sizeof *forms; k += (size_t)test_step(2, 2)) {
        WrScene *scene = scene_of("superellipsoid");
        scene->shape.value[3] = forms[k][0], scene->shape.value[4] = forms[k][1];
        assert_agree(scene, field, FLOAT_BOUND);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

static void lights_of_every_kind_shine_alike(void **state)
{
    (void)state;
    WrField *field = bumpy_field(32, 32);
    for (int k = 0; k < 4; k++) {
        WrScene *scene = scene_of(k % 2 ? "torus" : "sphere");
        WrLight lights[2] = {
            { WR_LIGHT_POINT, { 1, 2, 2.5 }, { 1, 0.5, 0.2 }, 0.8, 0, false },
            { k < 2 ? WR_LIGHT_DIRECTIONAL : WR_LIGHT_POINT,
              { -3, 1, 1 },
              { 0, 0.4, 1 },
              0.6,
              0,
              false },
        };
        wr_free(scene->lights);
        scene->lights = wr_alloc(2, sizeof *scene->lights);
        memcpy(scene->lights, lights, sizeof lights);
        scene->light_count = 2;
        scene->material.gate = k < 2;
        scene->material.shininess = (const double[]){ 0, 1, 7.5, 200 }[k];
        assert_agree(scene, field, FLOAT_BOUND);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

/* Heights that differ at the two ends of an axis, to reveal clamping. */
static WrField *uneven_field(WrWrap wrap_u, WrWrap wrap_v)
{
    WrField *field = wr_field_new(24, 18, wrap_u, wrap_v, 0, NULL);
    for (int j = 0; j < 18; j++)
        for (int i = 0; i < 24; i++)
            wr_field_set(field, i, j, (float)(sin(0.31 * i + 0.1) * cos(0.23 * j) + 0.05 * i));
    return field;
}

static void axes_that_end_and_fractions_of_repeats_look_alike(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        WrField *field = uneven_field(k & 1 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC,
                                      k & 2 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC);
        WrScene *scene = scene_of(k == 1 ? "cylinder" : "plane");
        scene->replicate_u = k == 3 ? -1.5 : 1.3;
        scene->replicate_v = 0.7;
        assert_agree(scene, field, FLOAT_BOUND);
        wr_scene_free(scene);
        wr_field_free(field);
    }
}

static void a_colour_picture_looks_alike(void **state)
{
    (void)state;
    TestRandom random = { 5 };
    WrField *field = bumpy_field(32, 32);
    for (int channels = 1; channels <= 4; channels++) {
        WrScene *scene = scene_of(channels % 2 ? "cube" : "sphere");
        scene->colour = wr_image_new(7, 5, channels, NULL);
        for (int i = 0; i < 35 * channels; i++)
            scene->colour->data[i] = (float)test_random(&random);
        scene->material.colour = (WrVec3){ 0.9, 0.5, 0.7 };
        assert_agree(scene, field, FLOAT_BOUND);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

static void a_formula_looks_alike(void **state)
{
    (void)state;
    WrField *field = bumpy_field(8, 8);
    WrScene *scene = scene_of("sphere");
    WrAnalyticTerm terms[] = { { .i = 3, .j = 2, .a = 1, .phase_u_deg = 30 },
                               { .i = 1, .j = 4, .a = 0.5 } };
    scene->analytic = (WrAnalytic){ WR_ANALYTIC_FOURIER, 2, terms };
    scene->replicate_u = 2;
    assert_agree(scene, field, FLOAT_BOUND);
    scene->analytic = (WrAnalytic){ 0 };
    wr_scene_free(scene);
    wr_field_free(field);
}

static void hc84_from_inside_the_same_side_is_seen(void **state)
{
    (void)state;
    static const char *const surfaces[] = { "sphere", "cylinder", "cube", "torus", "cone" };
    WrField *field = bumpy_field(32, 32);
    for (int k = 0; k < 5; k++) {
        WrScene *scene = scene_of(surfaces[k]);
        scene->camera.fit = false;
        scene->camera.eye = (WrVec3){ 0.05, -0.1, 0.2 };
        if (k == 3) scene->camera.eye = (WrVec3){ 1, 0, 0.02 }, scene->posed = true;
        if (k == 3) scene->rotate_deg = (WrVec3){ -90, 0, 0 };
        scene->camera.target = v3_add(scene->camera.eye, (WrVec3){ 0.1, -0.2, -1 });
        scene->camera.fov_deg = 80;
        WrLight inside = { WR_LIGHT_POINT, scene->camera.eye, { 1, 1, 1 }, 1, 0, false };
        scene->lights[0] = inside;
        assert_agree(scene, field, FLOAT_BOUND);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

static void hc23_an_open_surface_shows_its_back_alike(void **state)
{
    (void)state;
    static const char *const surfaces[] = { "plane", "cylinder", "bent", "ribbon", "bezier" };
    WrField *field = bumpy_field(32, 32);
    for (int k = 0; k < 5; k++) {
        WrScene *scene = scene_of(surfaces[k]);
        scene->posed = true;
        scene->rotate_deg = (WrVec3){ 25, 160, 0 };
        if (k == 1) scene->rotate_deg = (WrVec3){ -50, 0, 0 };
        scene->camera.orthographic = k % 2 == 0;
        assert_agree(scene, field, FLOAT_BOUND);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

static void the_other_model_is_its_own_reference(void **state)
{
    (void)state;
    WrField *field = bumpy_field(32, 32);
    WrScene *scene = scene_of("torus");
    scene->bump = WR_BUMP_INVARIANT;
    assert_agree(scene, field, FLOAT_BOUND);
    wr_scene_free(scene);
    wr_field_free(field);
}

/* Degenerate surfaces, and the hardest ones for Newton's method, terminate with finite pictures. */
static void hc06_hc07_hc08_odd_surfaces_give_finite_pictures(void **state)
{
    (void)state;
    WrField *field = bumpy_field(16, 16);
    for (int k = 0; k < 7; k++) {
        WrScene *scene = scene_of(k < 3 ? "bezier" : k < 6 ? "torus" : "ribbon");
        double *v = scene->shape.value;
        for (int i = 0; k == 0 && i < 48; i++) v[i] = 0.25;                /* one point */
        for (int i = 0; k == 1 && i < 48; i++) v[i] = i / 3 % 4 * (i % 3); /* a line */
        for (int i = 0; k == 2 && i < 12; i++) v[i] = 0; /* an edge degenerated to a point */
        if (k == 3) v[1] = 0;
        if (k == 4) v[0] = v[1] = 0.6;
        if (k == 5) v[0] = 0.3, v[1] = 0.7;
        if (k == 6) v[2] = 40, v[4] = 3;
        WrReference r = reference_of(scene, field, NULL);
        for (int i = 0; i < SIZE * SIZE * 4; i++) assert_true(isfinite(r.rgba[i]));
        wr_reference_fini(&r);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

/* Scaled by 10^20 either way together with its heights, an object produces the same picture. */
static void hc09_size_does_not_matter(void **state)
{
    (void)state;
    WrField *field = bumpy_field(16, 16);
    WrReference r[3];
    for (int k = 0; k < 3; k++) {
        const double scale = (const double[]){ 1, 1e20, 1e-20 }[k];
        WrScene *scene = scene_of("torus");
        scene->shape.value[0] *= scale, scene->shape.value[1] *= scale;
        scene->height *= scale;
        r[k] = reference_of(scene, field, NULL);
        int unlike = 0;
        for (int i = 0; i < SIZE * SIZE * 4; i++)
            unlike += !(fabs(r[k].rgba[i] - r[0].rgba[i]) < 1e-6);
        assert_in_range(unlike, 0, 8); /* rounding on the silhouette */
        wr_scene_free(scene);
    }
    for (int k = 0; k < 3; k++) wr_reference_fini(&r[k]);
    wr_field_free(field);
}

/* Newton's method on two planes through the ray, from (u, v); the root's s, or INFINITY. */
static double root_from(const WrShape *shape, const WrReferenceRay *ray, double u, double v)
{
    const WrVec3 d = v3_unit(ray->d, ray->d), aside = { d.y, d.z, d.x };
    const WrVec3 a = v3_unit(v3_cross(d, aside), d), b = v3_cross(d, a);
    for (int k = 0; k < 12; k++) {
        WrSurfacePoint at;
        wr_surface_at(shape, 0, u, v, &at);
        const WrVec3 gap = v3_sub(ray->q, at.p);
        const double m[4] = { v3_dot(at.pu, a), v3_dot(at.pv, a), v3_dot(at.pu, b),
                              v3_dot(at.pv, b) };
        const double ga = v3_dot(gap, a), gb = v3_dot(gap, b), det = m[0] * m[3] - m[1] * m[2];
        const double du = (ga * m[3] - gb * m[1]) / det, dv = (gb * m[0] - ga * m[2]) / det;
        u += du, v += dv;
        if (!(u > -0.5 && u < 1.5 && v > -0.5 && v < 1.5)) return INFINITY;
        if (fabs(du) + fabs(dv) > 1e-11) continue;
        if (u < 0 || u > 1 || v < 0 || v > 1) return INFINITY;
        wr_surface_at(shape, 0, u, v, &at);
        return v3_dot(v3_sub(at.p, ray->q), ray->d) / v3_dot(ray->d, ray->d);
    }
    return INFINITY;
}

/* No root found by a search from 400 starts is nearer than the reference's. */
static void the_nearest_root_is_found_where_surfaces_fold(void **state)
{
    (void)state;
    TestRandom random = { 5 };
    for (int k = 0; k < 4; k++) {
        WrScene *scene = scene_of((const char *[]){ "bezier", "ribbon", "curl", "bezier" }[k]);
        if (k == 1)
            scene->shape.value[1] = 0.5, scene->shape.value[2] = 2, scene->shape.value[4] = 1;
        for (int i = 0; k == 3 && i < 48; i++) scene->shape.value[i] += test_random(&random) - 0.5;
        WrReferenceView view;
        assert_true(wr_reference_view_init(&view, scene, 15, 24, 24, NULL));
        int hits = 0;
        for (int pixel = 0; pixel < 24 * 24; pixel++) {
            const WrReferenceRay ray =
                wr_reference_view_ray(&view, pixel % 24 + 0.5, pixel / 24 + 0.5);
            WrReferenceHit hit = { .s = INFINITY };
            hits += wr_reference_view_hit(&view, &ray, &hit);
            double nearest = INFINITY;
            for (int i = 0; i < 400; i++)
                nearest = fmin(nearest, root_from(&scene->shape, &ray, (i % 20 + 0.5) / 20,
                                                  (i / 20 + 0.5) / 20.0));
            assert_false(nearest < hit.s - 1e-9);
            if (isfinite(hit.s)) { /* and the root is on the ray */
                WrSurfacePoint at;
                wr_surface_at(&scene->shape, 0, hit.u, hit.v, &at);
                const WrVec3 off = v3_cross(v3_sub(at.p, ray.q), ray.d);
                assert_near(v3_len(off), 0, 1e-10);
            }
        }
        assert_true(hits > 70);
        wr_reference_view_fini(&view);
        wr_scene_free(scene);
    }
}

static void hc14_hc15_hc50_huge_heights_give_finite_pictures(void **state)
{
    (void)state;
    static const double heights[] = { 1, 1e-300, 1e300, -1e30 };
    WrField *field = wr_field_new(6, 6, WR_WRAP_CLAMP, WR_WRAP_PERIODIC, 0, NULL);
    for (int i = 0; i < 36; i++) wr_field_set(field, i % 6, i / 6, i % 2 ? 3e38f : -3e38f);
    for (int k = 0; k < 4 * WR_SURFACE_COUNT; k++) {
        WrScene *scene = scene_of(wr_surfaces[k / 4]->name);
        scene->height = heights[k % 4];
        scene->bump = k % 3 ? WR_BUMP_EXACT : WR_BUMP_INVARIANT;
        if (k % 5 == 0) scene->replicate_u = 1e200;
        WrReference r = { 0 };
        const WrReferenceRequest request = {
            .field = field, .scene = scene, .width = 24, .height = 24, .first = 1, .most = 1
        };
        assert_true(wr_reference_render(&request, NULL, &r, NULL));
        for (int i = 0; i < 24 * 24; i++) {
            const double *n = r.normal + 3 * i, *c = r.rgba + 4 * i;
            assert_true(isfinite(c[0] + c[1] + c[2]));
            if (c[3] > 0) assert_near(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-12);
        }
        wr_reference_fini(&r);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_surface_looks_alike),
        cmocka_unit_test(hc153_stretched_objects_look_alike),
        cmocka_unit_test(hc153_a_stretched_ball_is_an_ellipsoid),
        cmocka_unit_test(profiles_and_formulas_look_alike),
        cmocka_unit_test(superellipsoids_of_every_form_look_alike),
        cmocka_unit_test(lights_of_every_kind_shine_alike),
        cmocka_unit_test(axes_that_end_and_fractions_of_repeats_look_alike),
        cmocka_unit_test(a_colour_picture_looks_alike),
        cmocka_unit_test(a_formula_looks_alike),
        cmocka_unit_test(hc84_from_inside_the_same_side_is_seen),
        cmocka_unit_test(hc23_an_open_surface_shows_its_back_alike),
        cmocka_unit_test(the_other_model_is_its_own_reference),
        cmocka_unit_test(hc06_hc07_hc08_odd_surfaces_give_finite_pictures),
        cmocka_unit_test(hc09_size_does_not_matter),
        cmocka_unit_test(the_nearest_root_is_found_where_surfaces_fold),
        cmocka_unit_test(hc14_hc15_hc50_huge_heights_give_finite_pictures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
