/* Memory estimates of commands, compared with their actual use. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "command/estimate.h"
#include "command/session.h"
#include "command/command_table.h"
#include "field/field.h"

static WrSession *table_of(int width, int height)
{
    char line[40];
    snprintf(line, sizeof line, "table %dx%d", width, height);
    const char *const lines[] = { line, NULL };
    return session_of(lines);
}

static WrEstimate estimate_of(const WrSession *session, const char *line)
{
    WrError err;
    WrEstimate out;
    if (!wr_session_estimate(session, line, &out, &err)) fail_msg("%s\n  %s", line, err.text);
    return out;
}

/* Each generator form has a separate row, or one without an estimate; any other verb at least one for all forms. */
static void every_edit_and_output_has_a_price(void **state)
{
    (void)state;
    for (const WrCommand *const *row = wr_commands, *c; (c = *row) != NULL; row++) {
        if (c->kind != WR_CLASS_EDIT && c->kind != WR_CLASS_OUTPUT) continue;
        WrForm form;
        if (!wr_family_find(c->name) || !c->form) {
            if (!wr_estimate_has(c->name, NULL)) fail_msg("%s has no price", c->name);
            continue;
        }
        for (int i = 0; c->form(i, &form); i++)
            if (!wr_estimate_has(c->name, form.name))
                fail_msg("%s %s has no price", c->name, form.name);
    }
}

static void every_example_is_estimated_and_nothing_changes(void **state)
{
    (void)state;
    WrSession *s = table_of(64, 64);
    WrHash before = wr_session_hash(s);
    for (const WrCommand *const *row = wr_commands, *c; (c = *row) != NULL; row++) {
        WrEstimate e = estimate_of(s, c->example);
        if (!(e.bytes >= 0.0 && e.bytes < 1e9)) fail_msg("%s: %g bytes", c->example, e.bytes);
    }
    assert_true(wr_hash_equal(before, wr_session_hash(s)));
    wr_session_free(s);
}

/* The heights, as the layer's table stores them. */
static void memory_is_near_what_tables_hold(void **state)
{
    (void)state;
    static const char *const lines[] = { "pattern bricks", "noise perlin", "adjust invert" };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        WrSession *s = table_of(1024, 1024);
        must_run(s, "noise value");
        double said = estimate_of(s, lines[i]).bytes, held = 4.0 * 1024 * 1024;
        if (said < held / 2.0 || said > held * 2.0)
            fail_msg("%s: said %g bytes, holds %g", lines[i], said, held);
        wr_session_free(s);
    }
}

static double bytes_of(int size, const char *line)
{
    WrSession *s = table_of(size, size);
    const double bytes = estimate_of(s, line).bytes;
    wr_session_free(s);
    return bytes;
}

static void memory_rises_with_size_and_counts(void **state)
{
    (void)state;
    static const char *const pairs[][2] = {
        { "solid sphere radius=9", "solid sphere radius=20" },
        { "solid torus across=4", "solid torus across=40" },
        { "solid letters ab", "solid letters abcd" },
        { "solid surface sphere size=64", "solid surface sphere size=128" },
        { "render a.png size=64x64", "render a.png size=640x640" },
        { "stroke points=0,0;0.1,0 radius=9", "stroke points=0,0;0.9,0 radius=9" },
    };
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++)
        if (!(bytes_of(256, pairs[i][0]) < bytes_of(256, pairs[i][1])))
            fail_msg("%s is not less than %s", pairs[i][0], pairs[i][1]);
    assert_true(bytes_of(256, "pattern bricks") < bytes_of(512, "pattern bricks"));
}

/* ---- memory ---- */

/* Bytes in use at the peak of the line, beyond those before it; by the program's own count, so that neither the system nor
   other processes matter. The line is undone. */
static double peak_of(WrSession *s, const char *line)
{
    const int before = wr_session_history_position(s);
    const int64_t held = wr_memory_bytes();
    wr_memory_peak_begin();
    must_run(s, line);
    const int64_t peak = wr_memory_peak() - held;
    if (wr_session_history_position(s) != before) {
        must_run(s, "undo");
        must_run(s, "layer rename 1 a"); /* drops the step that could be redone */
    }
    return (double)peak;
}

/* An estimate is at most FACTOR times the peak and MORE bytes, of rows and lists; a command without an amount needs no
   more than these. */
#define FACTOR 2.0
#define MORE 5e6
#define TABLES_MAX 9.1 /* the guide's bound for all of them, in tables of floats */

/* Each estimate is a bound, and not far above the peak. Lines after a + prepare the following ones; those after a -
   are like the one before them, and run with WR_FULL. Those without an estimate only show that the guide's bound holds. */
static void memory_stays_within_the_estimate(void **state)
{
    (void)state;
    static const char *const lines[] = {
        "export height a.png",
        "pattern bricks",
        "noise perlin",
        "noise perlin blend=add",
        "formula fourier terms=3,2,0.5",
        "text Wrinkles size=300",
        "solid sphere radius=500",
        "solid torus across=64 rows=64",
        "solid sphere radius=20 layout=chance spacing=30,0 join=smooth",
        "solid sphere radius=9 points=0.1,0.1;0.9,0.2;0.5,0.9 spacing=3,0",
        "solid surface sphere size=600",
        "terrain fractal",
        "terrain thermal rounds=1",
        "terrain hydraulic rain=0.01",
        "terrain terraces",
        "adjust offset du=100 dv=50",
        "adjust flip-u",
        "adjust rotate angle=90",
        "adjust crop x=3 y=3 width=1900 height=1400",
        "adjust resize width=3000 height=2000",
        "adjust resize width=1000 height=700",
        "adjust seamless how=frequency",
        "adjust match-edges",
        "adjust even-light sigma=50",
        "adjust levels in-low=0.2",
        "adjust invert",
        "adjust normalise",
        "adjust blur sigma=2",
        "adjust blur sigma=50",
        "adjust sharpen amount=2 sigma=20",
        "adjust median radius=4",
        "adjust curves points=0,0.2;0.5,0.3;1,1",
        "adjust dilate radius=16",
        "adjust slope-limit limit=0.001 side=mean",
        "adjust slope-limit limit=0.001",
        "adjust noise octaves=8",
        "adjust warp octaves=8",
        "adjust invert layers=all",
        "transform move=17,9",
        "transform turn=31 scale=0.7,-1.2",
        "select invert",
        "select height low=0 high=0.5",
        "select slope low=0 high=30",
        "+select ellipse centre=0.5,0.5 radii=0.45,0.4",
        "select grow by=30",
        "select feather by=40",
        "select flood 0.5,0.5 tolerance=100",
        "select invert",
        "rim",
        "adjust invert",
        "adjust blur sigma=50",
        "noise perlin",
        "noise perlin blend=add",
        "transform move=17,9",
        "terrain fractal",
        "+select none",
        "grid cells=512x512 width=2",
        "ramp linear from=0,0 to=1,0",
        "flood 0.5,0.5 tolerance=100",
        "shape rectangle a=0.1,0.1 b=0.9,0.9 paint=fill",
        "dab 0.5,0.5 radius=400",
        "stroke radius=200 strength=0.1 points=0.1,0.1;0.9,0.9;0.1,0.9;0.9,0.1",
        "layer merge 2",
        "layer flatten",
        "layer mask 2 from=height low=0.2",
        "layer mask 2 live=\"noise; curvature\"",
        "+layer flatten",
        "copy a.exr",
        "save a.exr",
        "save a.ora",
        "export height a.png",
        "export normal+y a.exr",
        "export slopes a.exr",
        "export slope a.png",
        "export curvature a.png",
        "export occlusion a.png",
        "export horizon a.exr",
        "export roughness a.png",
        "export cavity a.png",
        "export direction a.png",
        "export displacement a.png",
        "export mask a.png",
        "export wear a.png",
        "export packed a.png",
        "export contact a.png",
        "export glb a.glb",
        "export 3mf a.3mf error=1",
        "export gltf a.glb error=1",
        "export lines a.svg",
        "export profile a.png",
        "export normal-object a.png",
        "maps blender .",
        "-maps unity .",
        "-maps godot .",
        "render a8.png size=700x700",
    };
    WrSession *s = table_of(1985, 1473);
    must_run(s, "noise perlin");
    must_run(s, "layer add \"second\"");
    must_run(s, "noise value");
    wr_session_set_outputs(s, true);
    const double texels = 1985.0 * 1473.0;
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        if (lines[i][0] == '+') {
            must_run(s, lines[i] + 1);
            continue;
        }
        if (lines[i][0] == '-' && !getenv("WR_FULL")) continue;
        const char *line = lines[i] + (lines[i][0] == '-');
        const WrEstimate e = estimate_of(s, line);
        const double peak = peak_of(s, line);
        if (getenv("WR_TELL"))
            print_message("%-50.50s said %5.1f, took %5.1f bytes a texel, %.2f\n", line,
                          e.bytes / texels, peak / texels, e.bytes / peak);
        if (peak > TABLES_MAX * 4.0 * texels)
            fail_msg("%s: took %.1f tables", line, peak / texels / 4.0);
        if (!e.unknown &&
            (peak > e.bytes + (e.bytes > 0.0 ? 0.0 : MORE) || e.bytes > peak * FACTOR + MORE))
            fail_msg("%s: said %g bytes, took %g", line, e.bytes, peak);
    }
    wr_session_free(s);
}

/* One band of a large picture is in memory; under a tolerance, all of it. */
static void large_pictures_take_the_memory_of_a_band(void **state)
{
    (void)state;
    WrSession *s = table_of(64, 64);
    const WrEstimate small = estimate_of(s, "render a.png size=1024x1024");
    const WrEstimate large = estimate_of(s, "render a.png size=16384x16384");
    must_run(s, "tolerance rms=0.01");
    const WrEstimate whole = estimate_of(s, "render a.png size=16384x16384");
    assert_true(small.bytes > 16e6 && large.bytes > small.bytes);
    assert_true(large.bytes < 80e6 && whole.bytes > 4e9);
    wr_session_free(s);
}

static void estimates_are_told_in_a_few_words(void **state)
{
    (void)state;
    static const struct {
        WrEstimate estimate;
        const char *text;
    } cases[] = {
        { { .bytes = 3e8 }, "300 MB" },
        { { .bytes = 6e7 }, "" },
        { { .bytes = 7.2e7 }, "72 MB" },
        { { .bytes = 4.2e9 }, "4.2 GB" },
        { { .bytes = 9e9, .unknown = "why" }, "" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[WR_ESTIMATE_TEXT];
        wr_estimate_print(&cases[i].estimate, text);
        assert_string_equal(text, cases[i].text);
    }
}

/* The time left is extrapolated from the fraction done, which thus must not start again for each table. */
static void rises(void *ctx, double fraction)
{
    double *last = ctx;
    if (fraction < *last) fail_msg("%g was reported after %g", fraction, *last);
    *last = fraction;
}

static void the_fraction_done_only_rises(void **state)
{
    (void)state;
    static const char *const lines[] = { "adjust resize width=300 height=200",
                                         "adjust flip-u",
                                         "adjust blur sigma=9 layers=all",
                                         "transform move=17,9 layers=all",
                                         "transform turn=30",
                                         "layer mask 2 live=\"wear; noise; occlusion\"" };
    WrSession *s = table_of(256, 256);
    must_run(s, "noise perlin");
    must_run(s, "layer add \"second\"");
    must_run(s, "noise value");
    must_run(s, "layer mask 2 from=height low=0.2");
    must_run(s, "select ellipse centre=0.5,0.5 radii=0.45,0.4");
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        double last = 0.0;
        const WrProgress progress = { .report = rises, .ctx = &last };
        wr_progress_set(&progress);
        must_run(s, lines[i]);
        wr_progress_set(NULL);
        if (last < 0.99) fail_msg("%s: ended at %g", lines[i], last);
        must_run(s, "undo");
    }
    wr_session_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_edit_and_output_has_a_price),
        cmocka_unit_test(every_example_is_estimated_and_nothing_changes),
        cmocka_unit_test(memory_rises_with_size_and_counts),
        cmocka_unit_test(memory_is_near_what_tables_hold),
        cmocka_unit_test(memory_stays_within_the_estimate),
        cmocka_unit_test(large_pictures_take_the_memory_of_a_band),
        cmocka_unit_test(estimates_are_told_in_a_few_words),
        cmocka_unit_test(the_fraction_done_only_rises),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
