/* Displaced surfaces in the reference: closed forms, silhouettes included; meeting layers; comparison with an
   independent search. */
#include "test.h"
#include "field/scheme_list.h"
#include "render_scenes.h"

#include "base/error.h"
#include "base/vec.h"
#include "render/reference/reference.h"
#include "render/reference/reference_shade.h"

static WrScene *displaced_of(const char *surface, double height)
{
    WrScene *scene = scene_of(surface);
    scene->displaced = true;
    scene->height = height;
    return scene;
}

static WrScene *ahead_of(const char *surface, double height, double distance)
{
    WrScene *scene = displaced_of(surface, height);
    scene->still = scene->posed = true;
    scene->rotate_deg = (WrVec3){ 0, 0, 0 };
    scene->camera.fit = false;
    scene->camera.eye = (WrVec3){ 0, 0, distance };
    return scene;
}

static void stand(WrReferenceStage *stage, const WrScene *scene, const WrField *field)
{
    WrError err = { "" };
    if (!wr_reference_stage_init(stage, field, scene, 0, 100, 100, true, NULL, &err) ||
        !wr_reference_stage_raise(stage, field, NULL, &err))
        fail_msg("%s", err.text);
}

static bool sample(const WrReferenceStage *stage, double x, double y, WrReferenceSample *out)
{
    return wr_reference_sample(stage, x, y, (WrReferenceShare){ 0, 1 }, out);
}

/* The sphere of radius R + c from d: its silhouette's radius is f (R + c) / sqrt(d^2 - (R + c)^2) pixels, to a
   millionth; inside it n' and the light are those of the larger sphere's point. */
static void a_raised_ball_is_a_larger_ball(void **state)
{
    (void)state;
    static const double way[][3] = { { 0.83, 0.137, 4.1 }, { 1.21, -0.31, 5.3 } };
    for (int k = 0; k < 2; k++) {
        WrScene *scene = ahead_of("sphere", 0.73, way[k][2]);
        WrField *field = level_field(7, 5, way[k][1] / 0.73);
        scene->shape.value[0] = way[k][0];
        WrReferenceStage stage;
        WrReferenceSample got;
        stand(&stage, scene, field);
        const double c = (double)wr_field_get(field, 0, 0) * 0.73, r = way[k][0] + c, d = way[k][2];
        const double f = 50 / tan(scene->camera.fov_deg * WR_PI / 360);
        const double rim = f * r / sqrt(d * d - r * r);
        for (int i = 0; i < 40; i++) {
            const double a = 0.37 + i, x = cos(a), y = sin(a);
            assert_true(sample(&stage, 50 + x * (rim - 1e-6), 50 + y * (rim - 1e-6), &got));
            assert_false(sample(&stage, 50 + x * (rim + 1e-6), 50 + y * (rim + 1e-6), &got));
            const double t = (i + 0.5) / 40, across = t * rim / f;
            assert_true(sample(&stage, 50 + x * t * rim, 50 + y * t * rim, &got));
            const double b = 1 + across * across,
                         away = (d - sqrt(d * d - b * (d * d - r * r))) / b;
            assert_near(got.depth, away, 1e-11);
            assert_near(got.normal.x, away * across * x / r, 1e-10);
            assert_near(got.normal.y, -away * across * y / r, 1e-10);
        }
        wr_reference_stage_fini(&stage);
        wr_scene_free(scene);
        wr_field_free(field);
    }
}

/* A plane at d that faces the eye, raised by c: its corners are f (1/2) / (d - c) pixels from the centre. */
static void a_raised_plane_comes_nearer(void **state)
{
    (void)state;
    const double c = 0.4173, d = 2.9;
    WrScene *scene = ahead_of("plane", 1, d);
    WrField *field = level_field(7, 5, c);
    WrReferenceStage stage;
    WrReferenceSample got;
    stand(&stage, scene, field);
    const double f = 50 / tan(scene->camera.fov_deg * WR_PI / 360);
    const double rim = f / 2 / (d - (double)wr_field_get(field, 0, 0));
    for (int i = 0; i < 20; i++) {
        const double along = (i / 10.0 - 0.97) * rim;
        assert_true(sample(&stage, 50 + rim - 1e-6, 50 + along, &got));
        assert_near(got.depth, d - (double)wr_field_get(field, 0, 0), 1e-11);
        assert_false(sample(&stage, 50 + rim + 1e-6, 50 + along, &got));
        assert_true(sample(&stage, 50 + along, 50 - rim + 1e-6, &got));
        assert_false(sample(&stage, 50 + along, 50 - rim - 1e-6, &got));
    }
    wr_reference_stage_fini(&stage);
    wr_scene_free(scene);
    wr_field_free(field);
}

/* ---- a search of another kind ---- */

/* Height of the point above the relief of a sphere of radius r. */
static double above(const WrReferenceStage *stage, double r, WrVec3 p)
{
    double f, fu, fv;
    const double u = atan2(p.y, p.x) / (2 * WR_PI), across = hypot(p.x, p.y);
    wr_reference_height(stage, u < 0 ? u + 1 : u, 0.5 + atan2(p.z, across) / WR_PI, &f, &fu, &fv);
    return v3_len(p) - r - f;
}

/* March along the ray by small steps until it is below, then bisect: the parameter there, or NAN. */
static double marched(const WrReferenceStage *stage, double r, const WrReferenceRay *ray,
                      double from, double to)
{
    const int steps = 6000;
    double s = from;
    for (int i = 1; i <= steps; i++) {
        double next = from + (to - from) * i / steps;
        if (above(stage, r, v3_mad(ray->q, ray->d, next)) > 0) {
            s = next;
            continue;
        }
        for (int k = 0; k < 60; k++) {
            const double mid = (s + next) / 2;
            if (above(stage, r, v3_mad(ray->q, ray->d, mid)) > 0) s = mid;
            else next = mid;
        }
        return next;
    }
    return NAN;
}

/* Rays over a rough sphere; where they are nearly tangential, the steps may miss a hit of the reference. */
static void it_meets_what_a_march_meets(void **state)
{
    (void)state;
    WrField *field = random_field(11, 7, 31);
    WrScene *scene = ahead_of("sphere", 0.11, 3.7);
    scene->replicate_u = 3, scene->replicate_v = 1;
    scene->shape.value[0] = 0.937;
    WrReferenceStage stage;
    stand(&stage, scene, field);
    int both = 0, one = 0;
    for (int i = 0; i < 700; i++) {
        const double x = 50 + 33 * sqrt((i + 0.5) / 700) * cos(2.4 * i);
        const double y = 50 + 33 * sqrt((i + 0.5) / 700) * sin(2.4 * i);
        const WrReferenceRay ray = wr_reference_view_ray(&stage.view, x, y);
        WrReferenceHit hit;
        const bool met = wr_reference_raised_hit(&stage.raised, &ray, &hit);
        const double want = marched(&stage, 0.937, &ray, -1.3, 1.3);
        one += met != !isnan(want);
        if (!met || isnan(want)) continue;
        both++;
        if (fabs(hit.s - want) > 1e-9) one++;
    }
    assert_true(both > 400);
    assert_int_equal(one, 0);
    wr_reference_stage_fini(&stage);
    wr_scene_free(scene);
    wr_field_free(field);
}

/* ---- meeting layers (HC124) ---- */

/* A cube displaced by c is a larger cube with intact edges and corners; with a cell and a height for each face: the
   box between six planes. */
static void a_raised_cube_is_a_larger_box(void **state)
{
    (void)state;
    WrField *field = level_field(7, 5, 0.173);
    WrScene *scene = ahead_of("cube", 1, 4.3);
    scene->rotate_deg = (WrVec3){ 31, 24, 11 };
    WrReferenceStage stage;
    stand(&stage, scene, field);
    const double half = scene->shape.value[0] + (double)wr_field_get(field, 0, 0);
    int inside = 0;
    for (int i = 0; i < 4000; i++) {
        const WrReferenceRay ray =
            wr_reference_view_ray(&stage.view, 50 + 45 * cos(0.7 * i) * sqrt(i / 4e3),
                                  50 + 45 * sin(0.7 * i) * sqrt(i / 4e3));
        const double q[3] = { ray.q.x, ray.q.y, ray.q.z }, d[3] = { ray.d.x, ray.d.y, ray.d.z };
        double in = -INFINITY, out = INFINITY;
        for (int k = 0; k < 3; k++) {
            const double a = (-half - q[k]) / d[k], b = (half - q[k]) / d[k];
            in = fmax(in, fmin(a, b)), out = fmin(out, fmax(a, b));
        }
        WrReferenceHit hit;
        const bool met = wr_reference_raised_hit(&stage.raised, &ray, &hit);
        if (fabs(out - in) > 1e-9 && met != (in < out))
            fail_msg("ray %d: %d, %g %g", i, met, in, out);
        if (!met || !(in < out)) continue;
        assert_near(hit.s, in, 1e-10);
        inside++;
    }
    assert_true(inside > 1000);
    wr_reference_stage_fini(&stage);
    wr_scene_free(scene);
    wr_field_free(field);
}

/* The fast path's triangles converge to the reference with finer subdivision: all kinds of surfaces, layers that
   separate at seams. */
static void facets_come_to_it(void **state)
{
    (void)state;
    static const char *const kinds[] = { "sphere", "cube", "torus", "cylinder", "ribbon" };
    WrField *field = random_field(13, 9, 4);
    for (int k = 0; k < 5; k++) {
        WrScene *scene = displaced_of(kinds[k], k == 4 ? 0.1 : 0.16);
        double rms[2];
        scene->replicate_u = k == 3 ? 1.37 : 2, scene->replicate_v = 1;
        scene->scheme = WR_SCHEME_BSPLINE_FIT;
        scene->dials.aa = WR_AA_SUPERSAMPLE, scene->dials.samples = 4;
        WrError err = { "" };
        WrReference truth = { 0 };
        WrPool *pool = wr_pool_new(2);
        const WrReferenceRequest request = { .field = field,
                                             .scene = scene,
                                             .width = 37,
                                             .height = 29,
                                             .turn_deg = 15,
                                             .first = 4,
                                             .most = 4 };
        if (!wr_reference_render(&request, pool, &truth, &err)) fail_msg("%s", err.text);
        for (int i = 0; i < 2; i++) {
            scene->dials.dice = i == 0 ? 2 : 0.0625;
            Shot shot = shoot(scene, field, 37, 29, 2, "auto", false);
            double sum = 0;
            for (int at = 0; at < 37 * 29 * 4; at++)
                sum += pow((double)shot.frame.rgba[at] - truth.rgba[at], 2);
            rms[i] = sqrt(sum / (37 * 29 * 4));
            put_away(&shot);
        }
        /* On a cube the last triangles before its edges are slanted; the reference's are not. */
        if (!(rms[1] < (k == 1 ? 0.02 : 0.006) && rms[1] < 0.6 * rms[0]))
            fail_msg("%s: %g, %g", kinds[k], rms[0], rms[1]);
        wr_reference_fini(&truth);
        wr_pool_free(pool);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

/* A sphere shrunk to its centre, heights of a million: all values are finite. */
static void no_heights_make_nonsense(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        WrField *field = k == 0 ? level_field(7, 5, 1) : random_field(9, 7, 5);
        WrScene *scene = ahead_of("sphere", k == 0 ? -1 : 1e6, 4);
        WrReferenceStage stage;
        WrReferenceSample got;
        stand(&stage, scene, field);
        for (int i = 0; i < 400; i++)
            if (sample(&stage, 5 * (i % 20) + 0.31, 5 * (i / 20) + 0.77, &got))
                assert_true(isfinite(got.rgb[0]) && isfinite(got.normal.x) && isfinite(got.depth));
        wr_reference_stage_fini(&stage);
        wr_scene_free(scene);
        wr_field_free(field);
    }
}

static void what_is_too_large_is_refused(void **state)
{
    (void)state;
    WrField *field = random_field(300, 200, 5);
    WrScene *scene = ahead_of("sphere", 0.1, 4);
    scene->replicate_u = 71, scene->replicate_v = 3;
    WrReferenceStage stage;
    WrError err = { "" };
    assert_true(wr_reference_stage_init(&stage, field, scene, 0, 10, 10, true, NULL, &err));
    assert_false(wr_reference_stage_raise(&stage, field, NULL, &err));
    assert_non_null(strstr(err.text, "12780000"));
    wr_reference_stage_fini(&stage);
    wr_scene_free(scene);
    wr_field_free(field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_raised_ball_is_a_larger_ball),
        cmocka_unit_test(a_raised_plane_comes_nearer),
        cmocka_unit_test(it_meets_what_a_march_meets),
        cmocka_unit_test(a_raised_cube_is_a_larger_box),
        cmocka_unit_test(facets_come_to_it),
        cmocka_unit_test(no_heights_make_nonsense),
        cmocka_unit_test(what_is_too_large_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
