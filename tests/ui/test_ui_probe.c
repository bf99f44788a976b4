/* The inspector's values at a point, and the stored choice of a tolerance in the window. */
#include "test.h"
#include "field/scheme_list.h"

#include "accuracy/tolerance.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "field/field.h"
#include "scene/objects.h"
#include "shade/reflection_models.h"

#include "ui/patch/preview/preview.h"
#include "ui/panels/accuracy/accuracy_work.h"

#define SIZE 64

static WrField *waves(void)
{
    WrField *field = wr_field_new(SIZE, SIZE, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int j = 0; j < SIZE; j++)
        for (int i = 0; i < SIZE; i++)
            wr_field_set(field, i, j, (float)(0.5 + 0.3 * sin(i * 0.39) * cos(j * 0.19)));
    return field;
}

static WrScene *scene_of(const char *surface)
{
    WrScene *scene = wr_scene_new();
    wr_shape_default((WrSurfaceKind)wr_surface_find(surface), &scene->shape);
    scene->height = 0.07;
    scene->scheme = WR_SCHEME_BSPLINE;
    return scene;
}

static void assert_vector(WrVec3 a, WrVec3 b, double tolerance)
{
    assert_near(a.x, b.x, tolerance);
    assert_near(a.y, b.y, tolerance);
    assert_near(a.z, b.z, tolerance);
}

/* A point found through a pixel, requested again by its u and v, is the same point: the projection, the formulas and
   the reference's inversion agree. */
static void a_place_is_the_same_by_its_pixel_and_by_its_parameters(void **state)
{
    (void)state;
    static const char *const surfaces[] = { "plane", "sphere", "cylinder", "torus" };
    WrField *field = waves();
    int seen = 0;
    for (int k = 0; k < 4; k++)
        for (int i = 0; i < 30; i++) {
            WrScene *scene = scene_of(surfaces[k]);
            WrWork *pixel = wr_work_new(WR_WORK_PROBE, NULL, field, scene, 20, 300, 200);
            pixel->x = 80.3 + 4.9 * i;
            pixel->y = 60.7 + 2.6 * i;
            assert_true(wr_accuracy_probe(pixel));
            assert_true(pixel->seen);
            if (pixel->probe.hit) {
                WrWork *table = wr_work_new(WR_WORK_PROBE, NULL, field, scene, 20, 300, 200);
                table->on_table = true;
                table->x = pixel->probe.u;
                table->y = pixel->probe.v;
                assert_true(wr_accuracy_probe(table));
                const WrProbe *a = &pixel->probe, *b = &table->probe;
                assert_true(b->hit && table->seen);
                assert_vector(a->at.p, b->at.p, 1e-9);
                assert_vector(a->d, b->d, 1e-7);
                assert_vector(a->perturbed, b->perturbed, 1e-7);
                assert_near(a->tilt_deg, b->tilt_deg, 1e-6);
                assert_near(a->dropped_deg, b->dropped_deg, 1e-6);
                assert_near(a->level, b->level, 1e-6);
                assert_near(a->rgb[0], b->rgb[0], 1e-6);
                wr_work_free(table);
                seen++;
            }
            wr_work_free(pixel);
            wr_scene_free(scene);
        }
    assert_true(seen > 60);
    wr_field_free(field);
}

/* The centre of a sphere's back: no footprint, but the exact formulas. */
static void what_the_view_does_not_show_has_no_footprint(void **state)
{
    (void)state;
    WrField *field = waves();
    WrScene *scene = scene_of("sphere");
    WrWork *front = wr_work_new(WR_WORK_PROBE, NULL, field, scene, 0, 200, 200);
    front->x = front->y = 100.5;
    assert_true(wr_accuracy_probe(front) && front->probe.hit);
    WrWork *back = wr_work_new(WR_WORK_PROBE, NULL, field, scene, 0, 200, 200);
    back->on_table = true;
    back->x = front->probe.u < 0.5 ? front->probe.u + 0.5 : front->probe.u - 0.5;
    back->y = 1 - front->probe.v;
    assert_true(wr_accuracy_probe(back) && back->probe.hit);
    assert_false(back->seen);
    assert_vector(back->probe.at.p, v3_neg(front->probe.at.p), 1e-9);
    WrProbeRow with[WR_PROBE_ROWS], without[WR_PROBE_ROWS];
    const int some = wr_accuracy_probe_rows(&back->probe, back->seen, without);
    const int all = wr_accuracy_probe_rows(&front->probe, front->seen, with);
    assert_true(some < all && all <= WR_PROBE_ROWS);
    for (int i = 0; i < some; i++) assert_string_equal(with[i].name, without[i].name);
    wr_work_free(front);
    wr_work_free(back);
    wr_scene_free(scene);
    wr_field_free(field);
}

/* A sphere in front of a plane: the pixel reports the visible object, whichever is active. */
static void of_several_objects_the_nearest_is_told(void **state)
{
    (void)state;
    WrField *field = waves();
    WrScene *plane = scene_of("plane");
    plane->camera.fit = false;
    plane->camera.eye = (WrVec3){ 0.3, -0.2, 5 };
    WrScene *several = wr_scene_add_object(plane, false);
    wr_shape_default(WR_SURFACE_sphere, &several->shape);
    several->size = 0.21;
    several->at = (WrVec3){ 0.05, 0.02, 0.7 };
    WrScene *other = wr_scene_choose(several, 0);
    for (int k = 0; k < 2; k++)
        for (int beside = 0; beside < 2; beside++) {
            WrWork *work =
                wr_work_new(WR_WORK_PROBE, NULL, field, k ? other : several, 0, 301, 203);
            work->x = 150.5 + 24 * beside, work->y = 99.5;
            assert_true(wr_accuracy_probe(work) && work->probe.hit && work->seen);
            assert_int_equal(work->object, !beside);
            const WrVec3 p = work->probe.at.p;
            assert_near(beside ? p.z : v3_len(p), beside ? 0 : 1, 1e-9);
            wr_work_free(work);
        }
    wr_scene_free(several);
    wr_scene_free(other);
    wr_scene_free(plane);
    wr_field_free(field);
}

/* A flat table bends no normal, on any surface. */
static void a_flat_table_turns_nothing_and_drops_nothing(void **state)
{
    (void)state;
    WrField *field = wr_field_new(8, 8, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    WrScene *scene = scene_of("torus");
    WrWork *work = wr_work_new(WR_WORK_PROBE, NULL, field, scene, 0, 100, 100);
    work->on_table = true;
    work->x = 0.3;
    work->y = 0.8;
    assert_true(wr_accuracy_probe(work) && work->probe.hit);
    assert_true(work->probe.tilt_deg == 0 && work->probe.dropped_deg == 0 && work->probe.f == 0);
    assert_near(v3_len(work->probe.d), 0, 0);
    wr_work_free(work);
    wr_scene_free(scene);
    wr_field_free(field);
}

static void the_text_holds_numbers_that_read_back_whole(void **state)
{
    (void)state;
    WrText text = { 0 };
    WrProbe probe = { .hit = true, .u = 0.1, .v = 1.0 / 3, .fu = -1e-30 };
    char number[24];
    wr_accuracy_probe_text(&probe, true, &text);
    assert_non_null(strstr(wr_text_get(&text), "u, v       0.1 0.3333333333333333\n"));
    assert_non_null(strstr(wr_text_get(&text), "Fu         -1e-30\n"));
    wr_text_fini(&text);
    const double values[] = {
        0, -0.0, 1.5, -99999.4, 1e300, -1e-300, (double)INFINITY, (double)NAN
    };
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        assert_true(strlen(wr_accuracy_probe_number_text(values[i], number)) <= 10);
    assert_string_equal(wr_accuracy_probe_number_text(-0.0, number), "0");
}

/* ---- choice of a tolerance ---- */

static WrScene *with(WrScheme scheme, WrBumpMode mode, int samples)
{
    WrScene *scene = wr_scene_new();
    scene->scheme = scheme;
    scene->bump = mode;
    scene->dials.aa = samples > 1 ? WR_AA_SUPERSAMPLE : WR_AA_POINT;
    scene->dials.samples = samples;
    return scene;
}

static void the_chosen_dials_are_summarized(void **state)
{
    (void)state;
    WrChoice choice = { .met = true, .studies = 1, .reason = "because" };
    WrChosen chosen;
    wr_choice_summary(&choice, &chosen); /* nothing was chosen */
    assert_false(chosen.any);
    choice.dials = with(WR_SCHEME_CATMULL, WR_BUMP_BLINN, 6);
    wr_choice_summary(&choice, &chosen);
    assert_true(chosen.any && chosen.met && !chosen.kept);
    assert_string_equal(chosen.reason, "because");
    assert_true(chosen.dials[WR_DIAL_SCHEME] == WR_SCHEME_CATMULL);
    assert_true(chosen.dials[WR_DIAL_NORMAL] == WR_BUMP_BLINN);
    assert_true(chosen.dials[WR_DIAL_AA] == WR_AA_SUPERSAMPLE);
    assert_true(chosen.dials[WR_DIAL_SAMPLES] == 6);
    assert_string_equal(chosen.line, "blinn catmull 6\xc3\x97"
                                     "6");
    wr_choice_fini(&choice);
}

/* ---- the work itself, without a window ---- */

static void a_cancelled_piece_of_work_is_not_done(void **state)
{
    (void)state;
    static const WrWorkKind kinds[] = { WR_WORK_ERROR, WR_WORK_BENCHMARK, WR_WORK_PAIR, WR_WORK_MAP,
                                        WR_WORK_CASES };
    WrField *field = waves();
    WrScene *scene = scene_of("torus");
    volatile int cancel = 1;
    const WrProgress progress = { .cancel = &cancel };
    WrPool *pool = wr_pool_new(1);
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        WrWorkTools tools = { 0 };
        WrWork *work = wr_work_new(kinds[k], &tools, field, scene, 0, 400, 300);
        work->other = wr_scene_share(scene);
        wr_work_jobs.run(work, pool, &progress);
        assert_false(work->done);
        assert_true(work->err.text[0] != '\0');
        wr_work_jobs.drop(work);
        wr_work_tools_fini(&tools);
    }
    wr_pool_free(pool);
    wr_scene_free(scene);
    wr_field_free(field);
}

/* A scene without height has no slope error. The rest is sampling error, which decreases with the number of samples;
   the error map has its maximum at the reported value. */
static void the_measured_error_falls_with_the_samples(void **state)
{
    (void)state;
    WrField *field = waves();
    WrPool *pool = wr_pool_new(1);
    const WrProgress progress = { 0 };
    double rms[2];
    for (int k = 0; k < 2; k++) {
        WrWorkTools tools = { 0 };
        WrScene *scene = scene_of("sphere");
        scene->height = 0;
        scene->dials.aa = WR_AA_SUPERSAMPLE;
        scene->dials.samples = k ? 5 : 1;
        WrWork *work = wr_work_new(WR_WORK_ERROR, &tools, field, scene, 0, 90, 60);
        wr_work_jobs.run(work, pool, &progress);
        assert_true(work->done);
        assert_int_equal(work->measured_w, 90);
        assert_int_equal(work->measured_h, 60);
        float largest = 0;
        for (int i = 0; i < 90 * 60; i++)
            if (!isnan(work->values[i]) && work->values[i] > largest) largest = work->values[i];
        assert_near((double)largest, work->errors.max, 1e-6);
        assert_true(work->high <= (double)largest && work->high > 0);
        rms[k] = work->errors.rms;
        wr_work_jobs.drop(work);
        wr_work_tools_fini(&tools);
        wr_scene_free(scene);
    }
    assert_true(rms[1] < 0.5 * rms[0]);
    wr_pool_free(pool);
    wr_field_free(field);
}

/* Variations on a static scene. */
static void other_samples(WrScene *scene, WrField *field)
{
    (void)field;
    scene->dials.aa = WR_AA_SUPERSAMPLE;
    scene->dials.samples = 2;
}

static void other_scheme(WrScene *scene, WrField *field)
{
    (void)field;
    scene->scheme = WR_SCHEME_BILINEAR;
}

static void other_light(WrScene *scene, WrField *field)
{
    (void)field;
    scene->lights_given = true; /* as every light command does */
    scene->lights[0].strength *= 0.71;
}

static void other_energy(WrScene *scene, WrField *field)
{
    (void)field;
    scene->material.energy = WR_ENERGY_PUBLISHED;
}

static void other_normal(WrScene *scene, WrField *field)
{
    (void)field;
    scene->bump = WR_BUMP_INVARIANT;
}

static void other_heights(WrScene *scene, WrField *field)
{
    (void)scene;
    wr_field_set(field, 5, 7, wr_field_get(field, 5, 7) + 0.9F);
}

/* The error from further work with the same tools equals that with new ones, whether the reference was cached or
   not. */
static void expect_kept(WrWorkTools *tools, WrPool *pool, WrField *field, WrScene *scene,
                        double turn, bool kept)
{
    const WrProgress progress = { 0 };
    WrWorkTools fresh = { 0 };
    WrWork *work[2];
    const double *before = tools->kept.rgba;
    const double seconds = tools->kept.seconds;
    for (int k = 0; k < 2; k++) {
        work[k] = wr_work_new(WR_WORK_ERROR, k ? &fresh : tools, field, scene, turn, 28, 20);
        wr_work_jobs.run(work[k], pool, &progress);
        assert_true(work[k]->done);
    }
    assert_true(work[0]->errors.rms == work[1]->errors.rms && work[0]->errors.rms > 0);
    assert_true(work[0]->errors.max == work[1]->errors.max);
    assert_int_equal(before && tools->kept.rgba == before && tools->kept.seconds == seconds, kept);
    for (int k = 0; k < 2; k++) wr_work_jobs.drop(work[k]);
    wr_work_tools_fini(&fresh);
}

static void the_reference_is_kept_while_the_scene_rests(void **state)
{
    static const struct {
        void (*change)(WrScene *scene, WrField *field);
        bool kept;
    } cases[] = { { other_samples, true }, { other_scheme, true },  { other_light, false },
                  { other_energy, false }, { other_normal, false }, { other_heights, false } };
    (void)state;
    WrField *field = waves();
    WrScene *scene = scene_of("sphere");
    WrPool *pool = wr_pool_new(1);
    WrWorkTools tools = { 0 };
    scene->material.model = WR_REFLECT_GGX;
    expect_kept(&tools, pool, field, scene, 11, false);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        WrScene *other = wr_scene_clone(scene);
        wr_scene_free(scene);
        scene = other;
        cases[i].change(scene, field);
        expect_kept(&tools, pool, field, scene, 11, cases[i].kept);
    }
    expect_kept(&tools, pool, field, scene, 12, false);
    expect_kept(&tools, pool, field, scene, 12, true);
    wr_work_tools_fini(&tools);
    wr_pool_free(pool);
    wr_scene_free(scene);
    wr_field_free(field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_place_is_the_same_by_its_pixel_and_by_its_parameters),
        cmocka_unit_test(what_the_view_does_not_show_has_no_footprint),
        cmocka_unit_test(of_several_objects_the_nearest_is_told),
        cmocka_unit_test(a_flat_table_turns_nothing_and_drops_nothing),
        cmocka_unit_test(the_text_holds_numbers_that_read_back_whole),
        cmocka_unit_test(the_chosen_dials_are_summarized),
        cmocka_unit_test(a_cancelled_piece_of_work_is_not_done),
        cmocka_unit_test(the_measured_error_falls_with_the_samples),
        cmocka_unit_test(the_reference_is_kept_while_the_scene_rests),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
