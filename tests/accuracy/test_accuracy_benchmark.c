#include "test.h"
#include "field/scheme_list.h"

#include "accuracy/report.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "field/analytic.h"
#include "field/field.h"
#include "scene/objects.h"
#include "scene/scene.h"

#include <unistd.h>

/* ---- tested settings ---- */

static WrRung *settings_of(const WrScene *scene, WrAxis axis, int *count)
{
    *count = wr_accuracy_benchmark_settings(scene, axis, NULL, 0);
    WrRung *rungs = wr_alloc((size_t)*count, sizeof *rungs);
    assert_int_equal(wr_accuracy_benchmark_settings(scene, axis, rungs, *count), *count);
    return rungs;
}

/* A setting applies to the whole picture: all objects use its scheme and normals, except one with another model;
   other dials stay per object. */
static void all_objects_take_a_setting(void **state)
{
    (void)state;
    WrScene *one = wr_scene_new();
    WrScene *two = wr_scene_add_object(one, false);
    two->bump = WR_BUMP_INVARIANT;
    two->scheme = WR_SCHEME_NEAREST;
    WrScene *scene = wr_scene_add_object(two, false);
    scene->bump = WR_BUMP_BLINN;
    scene->scheme = WR_SCHEME_CENTRAL;
    const WrSetting slopes = { 1, { WR_DIAL_SCHEME }, { WR_SCHEME_CATMULL } };
    const WrSetting both = { 2,
                             { WR_DIAL_SCHEME, WR_DIAL_NORMAL },
                             { WR_SCHEME_BSPLINE, WR_BUMP_EXACT } };
    WrScene *a = wr_setting_apply(&slopes, scene), *b = wr_setting_apply(&both, scene);
    WrScene *best = wr_accuracy_benchmark_best_except_axis(scene, WR_AXIS_ANTIALIASING);
    for (int i = 0; i < 3; i++) {
        const WrScene *was = wr_scene_object(scene, i);
        const bool model = was->bump == WR_BUMP_INVARIANT;
        assert_int_equal(wr_scene_object(a, i)->scheme, WR_SCHEME_CATMULL);
        assert_int_equal(wr_scene_object(a, i)->bump, was->bump);
        assert_int_equal(wr_scene_object(b, i)->scheme, WR_SCHEME_BSPLINE);
        assert_int_equal(wr_scene_object(b, i)->bump, model ? WR_BUMP_INVARIANT : WR_BUMP_EXACT);
        assert_int_equal(wr_scene_object(best, i)->scheme, WR_SCHEME_BSPLINE_FIT);
        assert_int_equal(wr_scene_object(best, i)->bump, model ? WR_BUMP_INVARIANT : WR_BUMP_EXACT);
    }
    /* the first is unchanged */
    assert_int_equal(wr_scene_object(scene, 1)->scheme, WR_SCHEME_NEAREST);
    WrScene *all[6] = { one, two, scene, a, b, best };
    for (int i = 0; i < 6; i++) wr_scene_free(all[i]);
}

static void every_rung_of_a_dial_that_matters_is_tried_alone(void **state)
{
    (void)state;
    int count;
    WrScene *scene = wr_scene_new();
    WrRung *rungs = settings_of(scene, WR_AXIS_DERIVATIVE, &count);
    bool seen[WR_SCHEME_COUNT] = { false };
    assert_true(rungs[0].current);
    seen[scene->scheme] = true;
    for (int i = 1; i < count; i++) {
        assert_int_equal(rungs[i].setting.count, 1);
        assert_int_equal(rungs[i].setting.dial[0], WR_DIAL_SCHEME);
        assert_false(seen[(int)rungs[i].setting.value[0]]); /* once */
        seen[(int)rungs[i].setting.value[0]] = true;
    }
    for (int s = 0; s < WR_SCHEME_COUNT; s++) assert_true(seen[s]);
    wr_free(rungs);
    wr_scene_free(scene);
}

static void a_formula_has_no_schemes_and_a_plane_no_mesh(void **state)
{
    (void)state;
    int count;
    WrAnalyticTerm term = { 1, 0, 0.5, 0, 0 };
    WrScene *scene = wr_scene_new();
    WrRung *rungs = settings_of(scene, WR_AXIS_VISIBILITY, &count);
    assert_int_equal(count, 1); /* as it is */
    wr_free(rungs);
    scene->analytic = (WrAnalytic){ WR_ANALYTIC_POLY, 1, &term };
    rungs = settings_of(scene, WR_AXIS_DERIVATIVE, &count);
    assert_int_equal(count, 1);
    wr_free(rungs);
    scene->analytic = (WrAnalytic){ 0 };
    wr_scene_free(scene);
}

static void no_two_rungs_are_the_same_scene(void **state)
{
    (void)state;
    int count;
    WrScene *scene = wr_scene_new();
    wr_shape_default(WR_SURFACE_torus, &scene->shape);
    WrRung *rungs = settings_of(scene, WR_AXIS_COUNT, &count);
    for (int i = 0; i < count; i++) {
        WrScene *a = wr_setting_apply(&rungs[i].setting, scene);
        for (int k = 0; k < i; k++) {
            if (rungs[i].axis == WR_AXIS_COUNT && rungs[k].axis != WR_AXIS_COUNT)
                continue; /* in some scenes a combination reduces to one dial */
            WrScene *b = wr_setting_apply(&rungs[k].setting, scene);
            bool same = true;
            for (int d = 0; d < WR_DIAL_COUNT; d++)
                same = same && wr_dials[d].get(a) == wr_dials[d].get(b);
            assert_false(same);
            wr_scene_free(b);
        }
        wr_scene_free(a);
    }
    wr_free(rungs);
    wr_scene_free(scene);
}

static void the_invariant_mode_is_marked_as_another_model(void **state)
{
    (void)state;
    int count, models = 0;
    WrScene *scene = wr_scene_new();
    WrRung *rungs = settings_of(scene, WR_AXIS_NORMAL, &count);
    for (int i = 0; i < count; i++) models += rungs[i].model;
    assert_int_equal(models, 1);
    wr_free(rungs);
    wr_scene_free(scene);
}

static void settings_print_as_the_commands_arguments(void **state)
{
    (void)state;
    WrText text = { 0 };
    WrSetting none = { 0 };
    WrSetting two = { 2, { WR_DIAL_AA, WR_DIAL_CONTRAST }, { WR_AA_ADAPTIVE, 0.005 } };
    wr_setting_print(&none, &text);
    assert_string_equal(wr_text_get(&text), "as it stands");
    wr_text_clear(&text);
    wr_setting_print(&two, &text);
    assert_string_equal(wr_text_get(&text), "aa=adaptive contrast=0.005");
    wr_text_fini(&text);
}

/* ---- the front ---- */

static WrRung made_rung(double seconds, double rms)
{
    WrRung rung = { .axis = WR_AXIS_COUNT, .seconds = seconds };
    rung.errors.rms = rms;
    return rung;
}

static void the_front_holds_what_nothing_beats_in_both(void **state)
{
    (void)state;
    WrRung rungs[] = { made_rung(1, 0.1),   made_rung(2, 0.05), made_rung(3, 0.05),
                       made_rung(4, 0.01),  made_rung(5, 0.2),  made_rung(2.5, 0.04999),
                       made_rung(0.5, 0.3), made_rung(9, 0.001) };
    WrAccuracyBenchmark benchmark = { .rungs = rungs, .count = 8 };
    rungs[7].model = true;
    wr_accuracy_benchmark_front(&benchmark);
    const bool expected[] = { true, true, false, true, false, false, true, false };
    for (int i = 0; i < 8; i++) assert_int_equal(rungs[i].front, expected[i]);
}

static void equal_rungs_leave_one_on_the_front(void **state)
{
    (void)state;
    WrRung rungs[] = { made_rung(1, 0.1), made_rung(1, 0.1), made_rung(1, 0.1) };
    WrAccuracyBenchmark benchmark = { .rungs = rungs, .count = 3 };
    wr_accuracy_benchmark_front(&benchmark);
    assert_int_equal(rungs[0].front + rungs[1].front + rungs[2].front, 1);
}

/* ---- faults ---- */

static WrRung arithmetic_rung(int dial, double value, double own_rms)
{
    return (WrRung){ .axis = WR_AXIS_ARITHMETIC,
                     .setting = { 1, { dial }, { value } },
                     .own_rms = own_rms };
}

/* True if the rung of that index, in a scene with float heights and shading, is reported as a fault. */
static bool at_fault(WrRung *rungs, int count, double as_it_stands, int which)
{
    WrScene *scene = wr_scene_new();
    WrAccuracyBenchmark benchmark = { .rungs = rungs,
                                      .count = count,
                                      .arithmetic_rms = as_it_stands };
    WrText text = { 0 };
    wr_accuracy_benchmark_faults(&benchmark, scene);
    wr_report_text(&benchmark, "", &text);
    const bool told = strstr(wr_text_get(&text), "a fault of the program") != NULL;
    bool any = false;
    for (int i = 0; i < count; i++) any |= rungs[i].fault;
    assert_int_equal(told, any);
    wr_text_fini(&text);
    wr_scene_free(scene);
    return rungs[which].fault;
}

static void more_bits_and_a_larger_error_are_told_as_a_fault(void **state)
{
    (void)state;
    WrRung wide[] = { arithmetic_rung(WR_DIAL_HEIGHTS, WR_HEIGHTS_DOUBLE, 0.0312),
                      arithmetic_rung(WR_DIAL_HEIGHTS, WR_HEIGHTS_8, 0.05) };
    assert_true(at_fault(wide, 2, 0.0007, 0));
    assert_false(at_fault(wide, 2, 0.03, 0)); /* within rounding errors */
    assert_false(at_fault(wide, 2, 0.0007, 1));
    WrRung shades[] = { arithmetic_rung(WR_DIAL_SHADING, WR_SHADING_HALF, 0.001),
                        arithmetic_rung(WR_DIAL_SHADING, WR_SHADING_DOUBLE, 0.02) };
    assert_true(at_fault(shades, 2, NAN, 1)); /* more than half precision explains */
    WrRung fast[] = { arithmetic_rung(WR_DIAL_ARITHMETIC, WR_ARITHMETIC_FAST, 0.3) };
    assert_false(at_fault(fast, 1, 0.0007, 0)); /* a cheap rung may have errors */
    fast[0].note.text[0] = 'x';
    assert_false(at_fault(fast, 1, 0.5, 0));
    WrRung other[] = { arithmetic_rung(WR_DIAL_SHADING, WR_SHADING_DOUBLE, 0.02),
                       arithmetic_rung(WR_DIAL_HEIGHTS, WR_HEIGHTS_8, 0.001) };
    assert_false(at_fault(other, 2, NAN, 0)); /* neither of two dials is the more expensive */
}

/* ---- a small measurement ---- */

static WrField *waves(int size)
{
    WrField *field = wr_field_new(size, size, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    float *row = wr_alloc((size_t)size, sizeof *row);
    for (int j = 0; j < size; j++) {
        for (int i = 0; i < size; i++)
            row[i] = (float)(0.5 + 0.25 * sin(6 * M_PI * (i + 0.5) / size) +
                             0.2 * cos(10 * M_PI * (j + 0.5) / size));
        wr_field_write(field, 0, j, size, 1, row, (size_t)size);
    }
    wr_free(row);
    return field;
}

static const WrRung *rung_named(const WrAccuracyBenchmark *benchmark, const char *name)
{
    WrText text = { 0 };
    const WrRung *found = NULL;
    for (int i = 0; i < benchmark->count && !found; i++) {
        wr_text_clear(&text);
        wr_setting_print(&benchmark->rungs[i].setting, &text);
        if (strcmp(wr_text_get(&text), name) == 0) found = &benchmark->rungs[i];
    }
    wr_text_fini(&text);
    assert_non_null(found);
    return found;
}

/* One measurement shared by all tests of this group. */
typedef struct Measured {
    WrField *field;
    WrScene *scene;
    WrAccuracyBenchmark benchmark;
} Measured;

static int measure(void **state)
{
    WrError err;
    Measured *m = wr_alloc(1, sizeof *m);
    m->field = waves(32);
    m->scene = wr_scene_new();
    wr_shape_default(WR_SURFACE_sphere, &m->scene->shape);
    m->scene->replicate_u = 3;
    m->scene->height = 0.05;
    const WrAccuracyBenchmarkRequest request = { .field = m->field,
                                                 .scene = m->scene,
                                                 .width = 48,
                                                 .height = 40,
                                                 .threads = 1,
                                                 .runs = 3,
                                                 .most = 16,
                                                 .axis = WR_AXIS_COUNT };
    if (!wr_accuracy_benchmark_measure(&request, &m->benchmark, &err)) fail_msg("%s", err.text);
    *state = m;
    return 0;
}

static int forget(void **state)
{
    Measured *m = *state;
    wr_accuracy_benchmark_fini(&m->benchmark);
    wr_scene_free(m->scene);
    wr_field_free(m->field);
    wr_free(m);
    return 0;
}

static void more_samples_come_nearer_where_theory_says_so(void **state)
{
    /* At the sphere's silhouette k x k samples have an error of O(1/k) at worst: 16 x 16 must be far better than one,
       and slopes of higher order better than none. */
    const Measured *m = *state;
    const WrRung *one = &m->benchmark.rungs[0];
    const WrRung *many =
        rung_named(&m->benchmark, "scheme=bspline-fit mode=exact aa=supersample samples=16");
    const WrRung *flat = rung_named(&m->benchmark, "mode=none");
    assert_true(one->current);
    assert_true(many->errors.rms < one->errors.rms / 4);
    assert_true(many->errors.coverage_rms < one->errors.coverage_rms / 4);
    assert_true(flat->own_rms > 4 * rung_named(&m->benchmark, "mode=exact")->own_rms);
    assert_true(isnan(many->own_rms)); /* a combination belongs to no axis */
}

static void no_rung_of_arithmetic_is_at_fault(void **state)
{
    const Measured *m = *state;
    assert_true(m->benchmark.arithmetic_rms > 0);
    for (int i = 0; i < m->benchmark.count; i++) assert_false(m->benchmark.rungs[i].fault);
}

static void every_rung_is_timed_and_the_reference_tells_of_itself(void **state)
{
    const Measured *m = *state;
    for (int i = 0; i < m->benchmark.count; i++) {
        const WrRung *rung = &m->benchmark.rungs[i];
        assert_string_equal(rung->note.text, "");
        assert_true(rung->seconds > 0 && rung->runs >= 3 && rung->spread >= 0);
        assert_true(rung->shaded > 0);
    }
    assert_int_equal(m->benchmark.reference.samples, 16);
    assert_true(m->benchmark.reference.last_rms > 0);
    assert_true(m->benchmark.blinn_phong > 0 && m->benchmark.blinn_colour > 0);
}

static int fields_of(const char *line)
{
    int fields = 1;
    bool quoted = false;
    for (; *line && *line != '\n'; line++) {
        quoted ^= *line == '"';
        fields += *line == ',' && !quoted;
    }
    return fields;
}

static void the_csv_has_the_same_columns_in_every_line(void **state)
{
    const Measured *m = *state;
    WrText text = { 0 };
    wr_report_csv(&m->benchmark, &text);
    int lines = 0;
    const int columns = fields_of(wr_text_get(&text));
    for (const char *line = wr_text_get(&text); *line; line = strchr(line, '\n') + 1, lines++)
        assert_int_equal(fields_of(line), columns);
    assert_int_equal(lines, m->benchmark.count + 1);
    wr_text_fini(&text);
}

static void the_table_names_every_rung_and_the_papers_claim(void **state)
{
    const Measured *m = *state;
    WrText text = { 0 }, setting = { 0 };
    wr_report_text(&m->benchmark, "waves", &text);
    for (int i = 0; i < m->benchmark.count; i++) {
        wr_text_clear(&setting);
        wr_setting_print(&m->benchmark.rungs[i].setting, &setting);
        assert_non_null(strstr(wr_text_get(&text), wr_text_get(&setting)));
    }
    assert_non_null(strstr(wr_text_get(&text), "about 4 times Phong"));
    assert_non_null(strstr(wr_text_get(&text), "another model"));
    wr_text_fini(&setting);
    wr_text_fini(&text);
}

static void a_plot_is_drawn_whole_or_not_at_all(void **state)
{
    const Measured *m = *state;
    WrError err;
    char folder[] = "/tmp/wrinkle-benchmark-XXXXXX";
    assert_non_null(mkdtemp(folder));
    char *svg = wr_path_join(folder, "it's.svg"), *bmp = wr_path_join(folder, "plot.bmp");
    char *bytes;
    size_t length;
    if (!wr_report_plot(&m->benchmark, "a 'name' with \"quotes\"", svg, &err))
        fail_msg("%s", err.text);
    assert_true(wr_file_read(svg, 1 << 24, &bytes, &length, &err));
    assert_non_null(strstr(bytes, "</svg>"));
    assert_non_null(strstr(bytes, "the front, fast to near"));
    assert_non_null(strstr(bytes, "antialiasing"));
    assert_non_null(strstr(bytes, "time of a frame, ms"));
    assert_false(wr_report_plot(&m->benchmark, "", bmp, &err));
    assert_non_null(strstr(err.text, ".png or .svg"));
    assert_int_not_equal(access(bmp, F_OK), 0);
    unlink(svg);
    assert_int_equal(rmdir(folder), 0); /* no other file stays */
    wr_free(bytes);
    wr_free(svg);
    wr_free(bmp);
}

static bool stop_at_once(WrProgress *progress)
{
    static int stop = 1;
    progress->cancel = &stop;
    return true;
}

static void a_cancelled_measurement_leaves_nothing(void **state)
{
    const Measured *m = *state;
    WrError err;
    WrProgress progress = { 0 };
    WrAccuracyBenchmark benchmark = { 0 };
    stop_at_once(&progress);
    const WrAccuracyBenchmarkRequest request = { .field = m->field,
                                                 .scene = m->scene,
                                                 .width = 16,
                                                 .height = 16,
                                                 .axis = WR_AXIS_COUNT,
                                                 .progress = &progress };
    assert_false(wr_accuracy_benchmark_measure(&request, &benchmark, &err));
    assert_null(benchmark.rungs);
    assert_string_equal(err.text, "cancelled");
}

int main(void)
{
    const struct CMUnitTest settings[] = {
        cmocka_unit_test(all_objects_take_a_setting),
        cmocka_unit_test(every_rung_of_a_dial_that_matters_is_tried_alone),
        cmocka_unit_test(a_formula_has_no_schemes_and_a_plane_no_mesh),
        cmocka_unit_test(no_two_rungs_are_the_same_scene),
        cmocka_unit_test(the_invariant_mode_is_marked_as_another_model),
        cmocka_unit_test(settings_print_as_the_commands_arguments),
        cmocka_unit_test(the_front_holds_what_nothing_beats_in_both),
        cmocka_unit_test(equal_rungs_leave_one_on_the_front),
        cmocka_unit_test(more_bits_and_a_larger_error_are_told_as_a_fault),
    };
    const struct CMUnitTest measured[] = {
        cmocka_unit_test(more_samples_come_nearer_where_theory_says_so),
        cmocka_unit_test(no_rung_of_arithmetic_is_at_fault),
        cmocka_unit_test(every_rung_is_timed_and_the_reference_tells_of_itself),
        cmocka_unit_test(the_csv_has_the_same_columns_in_every_line),
        cmocka_unit_test(the_table_names_every_rung_and_the_papers_claim),
        cmocka_unit_test(a_plot_is_drawn_whole_or_not_at_all),
        cmocka_unit_test(a_cancelled_measurement_leaves_nothing),
    };
    return cmocka_run_group_tests(settings, NULL, NULL) |
           cmocka_run_group_tests(measured, measure, forget);
}
