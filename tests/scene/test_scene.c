/* Scenes: ownership, placement, and F with its factors. */
#include "test.h"
#include "field/scheme_list.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "field/field.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "base/vec.h"

static double between(TestRandom *random, double low, double high)
{
    return low + (high - low) * test_random(random);
}

static WrVec3 rotated(const WrPlacement *p, WrVec3 a)
{
    const double *r = p->rotation;
    return (WrVec3){ r[0] * a.x + r[1] * a.y + r[2] * a.z, r[3] * a.x + r[4] * a.y + r[5] * a.z,
                     r[6] * a.x + r[7] * a.y + r[8] * a.z };
}

static WrPlacement placed(const WrScene *scene, double turn_deg, double aspect)
{
    WrPlacement p;
    WrError err = { "" };
    if (!wr_scene_place(scene, turn_deg, aspect, &p, &err)) fail_msg("%s", err.text);
    return p;
}

static void assert_vec(WrVec3 a, double x, double y, double z, double tolerance)
{
    assert_near(a.x, x, tolerance);
    assert_near(a.y, y, tolerance);
    assert_near(a.z, z, tolerance);
}

/* Three orthonormal vectors, the third the cross product of the others: up to a few roundings of half of 2.2e-16, as
   many as in a component. */
static void assert_orthonormal(WrVec3 x, WrVec3 y, WrVec3 z)
{
    const double t = 2e-15;
    assert_near(v3_dot(x, x), 1, t);
    assert_near(v3_dot(y, y), 1, t);
    assert_near(v3_dot(x, y), 0, t);
    WrVec3 c = v3_cross(x, y);
    assert_vec(c, z.x, z.y, z.z, t);
}

static void a_new_scene_is_the_unit_plane_under_one_light(void **state)
{
    (void)state;
    WrScene *scene = wr_scene_new();
    assert_int_equal(scene->shape.kind, WR_SURFACE_plane);
    assert_true(scene->shape.value[0] == 1 && scene->shape.value[1] == 1);
    assert_int_equal(scene->bump, WR_BUMP_BLINN);
    assert_int_equal(scene->scheme, WR_SCHEME_CENTRAL);
    assert_int_equal(scene->light_count, 1);
    assert_false(scene->lights_given);
    assert_true(scene->lights[0].where.x < 0 && scene->lights[0].where.y > 0); /* upper left */
    assert_true(scene->material.gate);
    assert_int_equal(scene->analytic.kind, WR_ANALYTIC_OFF);
    WrPlacement p = placed(scene, 0, 1);
    assert_vec(p.forward, 0, 0, -1, 0);
    assert_vec(p.right, 1, 0, 0, 0);
    assert_vec(p.up, 0, 1, 0, 0);
    assert_vec(rotated(&p, (WrVec3){ 0, 0, 1 }), 0, 0, 1, 0); /* facing the viewer */
    wr_scene_free(scene);
    wr_scene_free(NULL);
}

static void a_clone_shares_nothing_that_either_may_change(void **state)
{
    (void)state;
    WrScene *scene = wr_scene_new();
    scene->analytic.kind = WR_ANALYTIC_POLY;
    scene->analytic.count = 1;
    scene->analytic.terms = wr_alloc(1, sizeof *scene->analytic.terms);
    scene->analytic.terms[0] = (WrAnalyticTerm){ .i = 1, .j = 2, .a = 3 };
    scene->colour_laid.path = wr_strdup("wood.png");
    scene->height = 0.25;
    WrScene *clone = wr_scene_clone(scene);
    clone->analytic.terms[0].a = 7;
    clone->lights[0].strength = 9;
    clone->colour_laid.path[0] = 'f';
    clone->height = 1;
    assert_true(scene->analytic.terms[0].a == 3 && scene->lights[0].strength == 1);
    assert_string_equal(scene->colour_laid.path, "wood.png");
    assert_true(scene->height == 0.25);
    wr_scene_free(scene);
    assert_true(clone->analytic.terms[0].a == 7 && clone->analytic.terms[0].j == 2);
    assert_string_equal(clone->colour_laid.path, "food.png");
    wr_scene_free(clone);
}

static void a_shared_scene_lives_until_its_last_owner_frees_it(void **state)
{
    (void)state;
    WrScene *scene = wr_scene_new();
    const WrScene *first = wr_scene_share(scene), *second = wr_scene_share(first);
    assert_ptr_equal(first, second);
    wr_scene_free(scene);
    wr_scene_free((WrScene *)first);
    assert_true(second->height == 0.1); /* read after two of three are freed: for the sanitizer */
    WrScene *clone = wr_scene_clone(second);
    wr_scene_free((WrScene *)second);
    assert_true(clone->height == 0.1);
    wr_scene_free(clone);
}

static void rotations_are_about_the_worlds_x_then_y_then_z(void **state)
{
    (void)state;
    WrScene *scene = wr_scene_new();
    scene->posed = true;
    scene->rotate_deg = (WrVec3){ 90, 90, 0 };
    WrPlacement p = placed(scene, 0, 1);
    assert_vec(rotated(&p, (WrVec3){ 0, 1, 0 }), 1, 0, 0, 0);  /* y -> z -> x */
    assert_vec(rotated(&p, (WrVec3){ 0, 0, 1 }), 0, -1, 0, 0); /* z -> -y, stays */
    scene->rotate_deg = (WrVec3){ 90, 0, 90 };
    p = placed(scene, 0, 1);
    assert_vec(rotated(&p, (WrVec3){ 1, 0, 0 }), 0, 1, 0, 0); /* x stays, then -> y */
    assert_vec(rotated(&p, (WrVec3){ 0, 0, 1 }), 1, 0, 0, 0); /* z -> -y -> x */
    p = placed(scene, 90, 1);
    assert_vec(rotated(&p, (WrVec3){ 0, 0, 1 }), 0, 0, -1, 0); /* the turntable comes last */
    assert_vec(p.centre, 0.5, 0.5, 0, 0);
    wr_scene_free(scene);
}

static void hc88_placements_are_orthonormal_after_any_turn(void **state)
{
    (void)state;
    TestRandom random = { 1 };
    WrScene *scene = wr_scene_new();
    scene->posed = true;
    for (int i = 0; i < 2000; i++) {
        scene->rotate_deg = (WrVec3){ between(&random, -1e6, 1e6), between(&random, -400, 400),
                                      between(&random, -400, 400) };
        scene->camera.eye =
            (WrVec3){ between(&random, -3, 3), between(&random, -3, 3), between(&random, -3, 3) };
        scene->camera.up =
            (WrVec3){ between(&random, -1, 1), between(&random, -1, 1), between(&random, -1, 1) };
        WrPlacement p = placed(scene, between(&random, -1e9, 1e9), 1.5);
        const double *r = p.rotation;
        assert_orthonormal((WrVec3){ r[0], r[1], r[2] }, (WrVec3){ r[3], r[4], r[5] },
                           (WrVec3){ r[6], r[7], r[8] });
        assert_orthonormal(p.right, p.up, v3_neg(p.forward));
    }
    wr_scene_free(scene);
}

/* 0.01 radian per frame at 60 Hz for a day, in degrees; the resulting angle is the given number. */
static void hc87_a_day_of_turning_loses_nothing(void **state)
{
    (void)state;
    WrScene *scene = wr_scene_new();
    const long double degree = 3.14159265358979323846264338327950288L / 180;
    for (int64_t tick = 60 * 86400 - 500; tick <= 60 * 86400; tick++) {
        double deg = (double)tick * (0.01 / WR_RAD_PER_DEG);
        WrPlacement p = placed(scene, deg, 1);
        long double left = remainderl((long double)deg, 360) * degree;
        assert_near(p.rotation[0], (double)cosl(left), 1e-15);
        assert_near(p.rotation[2], (double)sinl(left), 1e-15);
    }
    WrPlacement a = placed(scene, 33.25, 1), b = placed(scene, 33.25 + 360.0 * 20000000, 1);
    assert_memory_equal(&a, &b, sizeof a);
    wr_scene_free(scene);
}

/* Every point of the object is in front of the eye and inside the picture. */
static void assert_in_view(const WrScene *scene, const WrPlacement *p, double aspect)
{
    const WrSurfaceInfo *info = wr_surfaces[scene->shape.kind];
    for (int k = 0; k < 21 * 21 * info->faces; k++) {
        WrSurfacePoint o;
        wr_surface_at(&scene->shape, k % info->faces, k / info->faces % 21 / 20.0,
                      k / info->faces / 21 / 20.0, &o);
        WrVec3 at = v3_sub(rotated(p, v3_sub(o.p, p->centre)), p->eye);
        double depth = v3_dot(at, p->forward);
        double high = p->half_height * (p->orthographic ? 1 : depth);
        assert_true(depth > 0);
        assert_true(fabs(v3_dot(at, p->up)) < high);
        assert_true(fabs(v3_dot(at, p->right)) < high * aspect);
    }
}

static void fit_shows_the_whole_object_at_every_aspect_and_not_much_more(void **state)
{
    (void)state;
    static const double aspects[] = { 0.2, 0.7, 1, 1.6, 5 }, fovs[] = { 1, 35, 90, 150 };
    WrScene *scene = wr_scene_new();
    for (int kind = 0; kind < WR_SURFACE_COUNT; kind++) {
        wr_shape_default((WrSurfaceKind)kind, &scene->shape);
        for (int i = 0; i < 40; i++) {
            double aspect = aspects[i % 5];
            scene->camera.orthographic = i % 2;
            scene->camera.fov_deg = fovs[i / 2 % 4];
            scene->camera.eye = i % 3 ? (WrVec3){ 0, 0, 1 } : (WrVec3){ 3, 4, 1 };
            WrPlacement p = placed(scene, 17 * i, aspect);
            assert_in_view(scene, &p, aspect);
            /* the ball's outline comes near the nearer border */
            double border = p.half_height * (aspect < 1 ? aspect : 1);
            double ball =
                p.radius / (p.orthographic ? 1 : sqrt(v3_dot(p.eye, p.eye) - p.radius * p.radius));
            assert_true(ball < border && ball > 0.95 * border);
        }
    }
    wr_scene_free(scene);
}

/* Silhouette of a sphere around the world's origin, in units of half_height. */
static double outline_of(const WrPlacement *p, double r)
{
    const double d2 = v3_dot(p->eye, p->eye);
    return p->orthographic ? r : d2 > r * r ? r / sqrt(d2 - r * r) : INFINITY;
}

static void set_displaced(WrScene *scene, int object)
{
    WrScene *other = wr_scene_clone(wr_scene_object(scene, object));
    other->displaced = true;
    wr_scene_set_object(scene, object, other);
}

/* A sphere displaced by F: within the margin the camera equals that of the base, bit for bit; beyond it is a tight
   fit, for one object and for two. */
static void fit_moves_only_for_what_is_displaced_beyond_the_picture(void **state)
{
    (void)state;
    static const double heights[] = { 0.0, 0.031, -0.0387, 0.0613, 0.12, -0.73, 4.1 };
    static const double aspects[] = { 0.43, 1, 1.77 };
    int kept = 0;
    for (int i = 0; i < 7 * 3 * 2 * 2; i++) {
        const double aspect = aspects[i / 7 % 3], height = heights[i % 7];
        WrScene *scene = wr_scene_new();
        wr_shape_default(WR_SURFACE_sphere, &scene->shape);
        scene->camera.orthographic = i / 21 % 2;
        scene->camera.fov_deg = 34.7;
        scene->height = height;
        if (i >= 42) { /* the copy, within the margin, is active */
            WrScene *both = wr_scene_add_object(scene, true);
            wr_scene_free(scene);
            scene = both;
            scene->at = (WrVec3){ 0.3, 0.1, -0.2 };
            scene->size = 0.41;
        }
        const WrPlacement base = placed(scene, 11, aspect);
        scene->displaced = true;
        if (i >= 42) set_displaced(scene, 0);
        const WrPlacement raised = placed(scene, 11, aspect);
        const double r = 1 + fabs(height), shorter = aspect < 1 ? aspect : 1;
        const double border = raised.half_height * shorter, out = outline_of(&raised, r);
        if (outline_of(&base, r) < base.half_height * shorter * (1 - 1e-12)) {
            kept++;
            assert_memory_equal(&raised.eye, &base.eye, sizeof base.eye);
            assert_true(raised.half_height == base.half_height);
        } else {
            assert_near(out / border, 1, 1e-12);
        }
        assert_true(out < border * (1 + 1e-12));
        wr_scene_free(scene);
    }
    assert_in_range(kept, 25, 50);
}

static void fit_holds_about_another_target_and_a_given_eye_stays(void **state)
{
    (void)state;
    WrScene *scene = wr_scene_new();
    scene->camera.target = (WrVec3){ 0.5, -1, 0.2 };
    scene->camera.eye = (WrVec3){ 2, 1, 3 };
    WrPlacement p = placed(scene, 30, 0.5);
    assert_in_view(scene, &p, 0.5);
    WrVec3 along = v3_unit(v3_sub(p.eye, scene->camera.target), (WrVec3){ 0, 0, 0 });
    WrVec3 asked = v3_unit((WrVec3){ 1.5, 2, 2.8 }, along);
    assert_vec(along, asked.x, asked.y, asked.z, 1e-15);
    scene->camera.fit = false;
    p = placed(scene, 30, 0.5);
    assert_vec(p.eye, 2, 1, 3, 0);
    scene->camera.orthographic = true;
    scene->camera.size = 3;
    assert_true(placed(scene, 30, 0.5).half_height == 1.5);
    wr_scene_free(scene);
}

static void an_up_along_the_view_gives_way_to_another_axis(void **state)
{
    (void)state;
    WrScene *scene = wr_scene_new();
    scene->camera.eye = (WrVec3){ 0, 5, 0 };
    WrPlacement p = placed(scene, 0, 1); /* from above: right stays right, the far side is up */
    assert_vec(p.right, 1, 0, 0, 1e-15);
    assert_vec(p.up, 0, 0, -1, 1e-15);
    scene->camera.eye = (WrVec3){ 0, -5, 0 };
    p = placed(scene, 0, 1);
    assert_vec(p.right, 1, 0, 0, 1e-15);
    assert_vec(p.up, 0, 0, 1, 1e-15);
    scene->camera.eye = (WrVec3){ 1, 0, 0 };
    scene->camera.up = (WrVec3){ -1e-300, 0, 0 };
    p = placed(scene, 0, 1);
    assert_vec(p.up, 0, 1, 0, 1e-15);
    scene->camera.up = (WrVec3){ 0, 0, 0 };
    p = placed(scene, 0, 1);
    assert_vec(p.up, 0, 1, 0, 1e-15);
    wr_scene_free(scene);
}

static void assert_refused(const WrScene *scene, double turn_deg, double aspect, const char *word)
{
    WrPlacement p = { .radius = -7 };
    WrError err = { "" };
    assert_false(wr_scene_place(scene, turn_deg, aspect, &p, &err));
    if (!strstr(err.text, word)) fail_msg("\"%s\" does not say \"%s\"", err.text, word);
    assert_true(p.radius == -7);
}

static void impossible_cameras_are_refused_and_nothing_is_written(void **state)
{
    (void)state;
    WrScene *scene = wr_scene_new();
    const WrCamera good = scene->camera;
    assert_refused(scene, NAN, 1, "turn");
    assert_refused(scene, 0, 0, "aspect ratio");
    assert_refused(scene, 0, NAN, "aspect ratio");
    scene->camera.target = scene->camera.eye = (WrVec3){ 1, 2, 3 };
    assert_refused(scene, 0, 1, "eye = target = 1,2,3");
    scene->camera = good;
    scene->camera.fov_deg = 180;
    assert_refused(scene, 0, 1, "fov = 180");
    scene->camera = good;
    scene->camera.eye.y = INFINITY;
    assert_refused(scene, 0, 1, "finite");
    scene->camera.eye.y = 1e300;
    assert_refused(scene, 0, 1, "far apart");
    scene->camera = good;
    scene->posed = true;
    scene->rotate_deg.z = NAN;
    assert_refused(scene, 0, 1, "rotate");
    wr_scene_free(scene);
}

static void every_surface_first_shows_its_front(void **state)
{
    (void)state;
    WrScene *scene = wr_scene_new();
    for (int kind = 0; kind < WR_SURFACE_COUNT; kind++) {
        wr_shape_default((WrSurfaceKind)kind, &scene->shape);
        WrPlacement p = placed(scene, 0, 1);
        WrSurfacePoint o;
        for (int face = 0; face < wr_surfaces[kind]->faces; face++) {
            wr_surface_at(&scene->shape, face, 0.5, 0.5, &o);
            double facing = rotated(&p, o.n_unit).z;
            if (kind == WR_SURFACE_torus) continue; /* v = 1/2 is inside the hole */
            if (kind == WR_SURFACE_cube)            /* +Z, +X and the lid */
                assert_true((facing > 0.3) == (face == 0 || face == 1 || face == 4));
            else assert_true(facing > 0.4);
        }
        WrVec3 axis = rotated(&p, (WrVec3){ 0, 0, 1 });
        if (kind == WR_SURFACE_sphere || kind == WR_SURFACE_cylinder || kind == WR_SURFACE_cone) {
            assert_vec(axis, 0, 1, 0, 0);                              /* poles upright */
            assert_vec(rotated(&p, (WrVec3){ -1, 0, 0 }), 0, 0, 1, 0); /* u = 1/2 in front */
        }
        if (kind == WR_SURFACE_torus) assert_true(axis.z > 0.4 && axis.y > 0.4); /* into the hole */
        if (kind == WR_SURFACE_cube) /* its upright edges are upright in the picture */
            assert_near(rotated(&p, (WrVec3){ 0, 1, 0 }).x, 0, 1e-3);
    }
    wr_scene_free(scene);
}

/* A smooth bump in a 16 x 16 table. */
static WrField *smooth_table(WrWrap wrap)
{
    WrField *field = wr_field_new(16, 16, wrap, wrap, 0, NULL);
    for (int k = 0; k < 256; k++) {
        double s, c;
        wr_sincos_turns((k % 16 + 0.5) / 16, &s, &c);
        double t = (k / 16 + 0.5) / 16;
        wr_field_set(field, k % 16, k / 16, (float)(s + t * t * (1 - t) * c));
    }
    return field;
}

/* d F / du by central differences of F itself, with a scheme whose slope is that of its value. */
static void assert_slopes(const WrScene *scene, const WrField *field, double u, double v)
{
    const double h = 1e-5;
    double fu, fv, f[4];
    wr_scene_height(scene, field, u, v, NULL, &fu, &fv);
    wr_scene_height(scene, field, u + h, v, &f[0], NULL, NULL);
    wr_scene_height(scene, field, u - h, v, &f[1], NULL, NULL);
    wr_scene_height(scene, field, u, v + h, &f[2], NULL, NULL);
    wr_scene_height(scene, field, u, v - h, &f[3], NULL, NULL);
    assert_near((f[0] - f[1]) / (2 * h), fu, 1e-4);
    assert_near((f[2] - f[3]) / (2 * h), fv, 1e-4);
}

static void slopes_carry_height_and_replication(void **state)
{
    (void)state;
    WrScene *scene = wr_scene_new();
    WrField *field = smooth_table(WR_WRAP_PERIODIC), *clamped = smooth_table(WR_WRAP_CLAMP);
    WrAnalyticTerm terms[] = { { .i = 2, .j = 1, .a = 3 }, { .i = 0, .j = 3, .a = -1 } };
    scene->scheme = WR_SCHEME_BSPLINE;
    static const double replicas[][2] = { { 1, 1 }, { 3, -2 }, { 0.5, 7 } };
    TestRandom random = { 3 };
    for (int i = 0; i < 300; i++) {
        scene->height = i % 2 ? -0.7 : 0.2;
        scene->replicate_u = replicas[i % 3][0];
        scene->replicate_v = replicas[i % 3][1];
        /* away from the ends of a replica, where a clamped table and a polynomial end */
        double u = (between(&random, 0.05, 0.9) + i % 2) / scene->replicate_u;
        double v = (between(&random, 0.05, 0.9) + i % 5) / scene->replicate_v;
        assert_slopes(scene, field, u, v);
        assert_slopes(scene, clamped, u, v);
        scene->analytic = (WrAnalytic){ WR_ANALYTIC_POLY, 2, terms };
        assert_slopes(scene, NULL, u, v);
        scene->analytic = (WrAnalytic){ 0 };
        double f, table, x = between(&random, 0.05, 0.9), y = 0.4;
        wr_scene_height(scene, field, (x + 3) / scene->replicate_u, y / scene->replicate_v, &f,
                        NULL, NULL);
        wr_field_sample(field, scene->scheme, 1, &x, &y, &table, NULL, NULL);
        assert_near(f, scene->height * table, 1e-14 * 100);
    }
    wr_field_free(field);
    wr_field_free(clamped);
    wr_scene_free(scene);
}

static void hc41_no_replication_is_flat_and_a_negative_one_mirrors(void **state)
{
    (void)state;
    WrScene *scene = wr_scene_new();
    WrField *field = smooth_table(WR_WRAP_PERIODIC);
    double f[2], fu[2], fv[2];
    scene->replicate_u = scene->replicate_v = 0;
    wr_scene_height(scene, field, 0.3, 0.8, &f[0], &fu[0], &fv[0]);
    wr_scene_height(scene, field, 0.9, 0.1, &f[1], &fu[1], &fv[1]);
    assert_true(f[0] == f[1] && fu[0] == 0 && fv[0] == 0);
    scene->replicate_u = -1;
    scene->replicate_v = 1;
    wr_scene_height(scene, field, 0.25, 0.5, &f[0], &fu[0], &fv[0]);
    scene->replicate_u = 1;
    wr_scene_height(scene, field, 0.75, 0.5, &f[1], &fu[1], &fv[1]);
    assert_true(f[0] == f[1] && fu[0] == -fu[1] && fv[0] == fv[1]);
    wr_field_free(field);
    wr_scene_free(scene);
}

static void beyond_a_clamped_table_f_is_constant_and_its_slope_zero(void **state)
{
    (void)state;
    WrScene *scene = wr_scene_new();
    WrField *field = smooth_table(WR_WRAP_CLAMP);
    scene->replicate_u = scene->replicate_v = 2;
    double f[2], fu, fv;
    wr_scene_height(scene, field, 0.6, 0.7, &f[0], &fu, &fv);
    wr_scene_height(scene, field, 0.9, 0.8, &f[1], NULL, NULL);
    assert_true(f[0] == f[1] && fu == 0 && fv == 0);
    wr_scene_height(scene, field, 0.3, 0.2, &f[0], &fu, &fv);
    assert_true(fu != 0 && fv != 0); /* inside it is not */
    wr_field_free(field);
    wr_scene_free(scene);
}

static void huge_heights_stay_finite(void **state)
{
    (void)state;
    WrScene *scene = wr_scene_new();
    WrField *field = wr_field_new(2, 3, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int k = 0; k < 6; k++)
        wr_field_set(field, k % 2, k / 2, k % 2 ? 3e38f : -3e38f * (float)(k / 2));
    scene->height = 1e308;
    scene->replicate_u = scene->replicate_v = -1e308;
    for (int scheme = 0; scheme < WR_SCHEME_COUNT; scheme++) {
        double f, fu, fv;
        scene->scheme = (WrScheme)scheme;
        wr_scene_height(scene, field, 0.3, 0.7, &f, &fu, &fv);
        assert_true(isfinite(f) && isfinite(fu) && isfinite(fv));
    }
    wr_field_free(field);
    wr_scene_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_new_scene_is_the_unit_plane_under_one_light),
        cmocka_unit_test(a_clone_shares_nothing_that_either_may_change),
        cmocka_unit_test(a_shared_scene_lives_until_its_last_owner_frees_it),
        cmocka_unit_test(rotations_are_about_the_worlds_x_then_y_then_z),
        cmocka_unit_test(hc88_placements_are_orthonormal_after_any_turn),
        cmocka_unit_test(hc87_a_day_of_turning_loses_nothing),
        cmocka_unit_test(fit_shows_the_whole_object_at_every_aspect_and_not_much_more),
        cmocka_unit_test(fit_moves_only_for_what_is_displaced_beyond_the_picture),
        cmocka_unit_test(fit_holds_about_another_target_and_a_given_eye_stays),
        cmocka_unit_test(an_up_along_the_view_gives_way_to_another_axis),
        cmocka_unit_test(impossible_cameras_are_refused_and_nothing_is_written),
        cmocka_unit_test(every_surface_first_shows_its_front),
        cmocka_unit_test(slopes_carry_height_and_replication),
        cmocka_unit_test(hc41_no_replication_is_flat_and_a_negative_one_mirrors),
        cmocka_unit_test(beyond_a_clamped_table_f_is_constant_and_its_slope_zero),
        cmocka_unit_test(huge_heights_stay_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
