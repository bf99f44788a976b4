/* What commands are said to cost before they begin, against what they do cost. */
#include "test.h"
#include "test_folder.h"
#include "test_session_help.h"

#include "base/error.h"
#include "command/estimate.h"
#include "command/session.h"
#include "command/table.h"
#include "field/field.h"
#include "system/clock.h"

#include <fcntl.h>
#include <malloc.h>
#include <sys/wait.h>

#define MOMENT 0.1 /* seconds that are not worth a word */

static WrSession *table_of(int size)
{
    char line[40];
    snprintf(line, sizeof line, "table %dx%d", size, size);
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

static double seconds_of(int size, const char *line)
{
    WrSession *s = table_of(size);
    double seconds = estimate_of(s, line).seconds;
    wr_session_free(s);
    return seconds;
}

/* A generator's form has a row of its own, or one that says that nothing is known; any other verb at least
   one for all of it. */
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
    WrSession *s = table_of(64);
    WrHash before = wr_session_hash(s);
    for (const WrCommand *const *row = wr_commands, *c; (c = *row) != NULL; row++) {
        WrEstimate e = estimate_of(s, c->example);
        if (!(e.seconds >= 0.0 && e.seconds < 60.0 && e.bytes >= 0.0 && e.bytes < 1e9))
            fail_msg("%s: %g s, %g bytes", c->example, e.seconds, e.bytes);
    }
    assert_true(wr_hash_equal(before, wr_session_hash(s)));
    wr_session_free(s);
}

static void estimates_rise_with_size_and_counts(void **state)
{
    (void)state;
    static const char *const pairs[][2] = {
        { "noise perlin octaves=2", "noise perlin octaves=5" },
        { "noise perlin", "noise perlin warp=1" },
        { "formula fourier terms=3,0,0.5", "formula fourier terms=3,0,0.5;1,1,1" },
        { "terrain hydraulic", "terrain hydraulic rain=2" },
        { "terrain thermal rounds=10", "terrain thermal rounds=100" },
        { "adjust median radius=2", "adjust median radius=9" },
        { "solid sphere radius=9", "solid sphere radius=20" },
        { "solid torus across=4", "solid torus across=40" },
        { "solid letters ab", "solid letters abcd" },
        { "solid surface sphere size=64", "solid surface sphere size=128" },
        { "render a.png size=64x64", "render a.png size=640x640" },
        { "pattern scratches count=3", "pattern scratches count=30" },
        { "stroke points=0,0;0.1,0 radius=9", "stroke points=0,0;0.9,0 radius=9" },
    };
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++)
        if (!(seconds_of(256, pairs[i][0]) < seconds_of(256, pairs[i][1])))
            fail_msg("%s is not less than %s", pairs[i][0], pairs[i][1]);
    assert_true(seconds_of(256, "pattern bricks") < seconds_of(512, "pattern bricks"));
}

/* Seconds of work that the line takes, whatever others do on the machine; of what is done in a moment, the least of
   two. */
static double cost_of(int size, const char *line)
{
    double least = 1e9;
    for (int run = 0; run < 2 && (run == 0 || least < MOMENT); run++) {
        WrSession *s = table_of(size);
        must_run(s, "noise value cells=4 amplitude=1");
        double before = wr_clock_process_seconds();
        must_run(s, line);
        least = fmin(least, wr_clock_process_seconds() - before);
        wr_session_free(s);
    }
    return least;
}

/* Builds that check themselves are slower, so it is the commands' mean ratio that the others are held to. */
static void estimates_are_near_what_commands_take(void **state)
{
    (void)state;
    static const char *const lines[] = {
        "pattern bricks",
        "pattern weave",
        "noise simplex",
        "noise perlin warp=1",
        "formula fourier terms=3,0,0.5;0,5,0.25;1,1,1",
        "terrain thermal rounds=12",
        "terrain hydraulic rain=0.2",
        "adjust median radius=16",
        "solid torus across=32 rows=32",
        "solid surface sphere size=512",
        "pattern scratches count=120",
    };
    static const int sizes[] = { 384, 768 };
    enum { COUNT = 2 * (int)(sizeof lines / sizeof *lines) };
    double ratio[COUNT], sum = 0.0;
    for (int i = 0; i < COUNT; i++) {
        ratio[i] =
            log(cost_of(sizes[i % 2], lines[i / 2]) / seconds_of(sizes[i % 2], lines[i / 2]));
        sum += ratio[i] / COUNT;
    }
    print_message("this build takes %.2g times the prices\n", exp(sum));
    for (int i = 0; i < COUNT; i++)
        if (fabs(ratio[i] - sum) > log(5.0))
            fail_msg("%s at %d: %g times the estimate, all together %g", lines[i / 2], sizes[i % 2],
                     exp(ratio[i]), exp(sum));
}

/* Asked at every texel how far away the edge is, a ridge takes several times as long. */
static void a_ridge_costs_more_than_a_bevel(void **state)
{
    (void)state;
    WrSession *s = wr_session_new(NULL);
    WrEstimate ridge, bevel;
    assert_true(wr_session_estimate(s, "rim kind=ridge", &ridge, NULL));
    assert_true(wr_session_estimate(s, "rim kind=bevel", &bevel, NULL));
    assert_true(ridge.seconds > 3 * bevel.seconds);
    wr_session_free(s);
}

/* Sheared noise is not made row by row: its octaves cost more. */
static void sheared_noise_costs_more_than_other(void **state)
{
    (void)state;
    WrSession *s = wr_session_new(NULL);
    WrEstimate sheared, other;
    assert_true(wr_session_estimate(s, "adjust noise kind=sheared octaves=3", &sheared, NULL));
    for (int i = 0; i < 3; i++) {
        static const char *const lines[] = { "adjust noise kind=perlin octaves=3",
                                             "adjust noise kind=gradient octaves=3",
                                             "adjust noise kind=value octaves=3" };
        assert_true(wr_session_estimate(s, lines[i], &other, NULL));
        assert_true(sheared.seconds > 1.5 * other.seconds);
    }
    wr_session_free(s);
}

/* Lattices from loose to so close that nearly all is hidden. */
static void crowds_are_near_what_they_take(void **state)
{
    (void)state;
    static const char *const shapes[] = { "sphere", "torus", "capsule", "box", "cylinder" };
    static const int sizes[] = { 256, 2048 }, counts[] = { 32, 128, 1024 };
    enum { SHAPES = (int)(sizeof shapes / sizeof *shapes), COUNT = SHAPES * 2 * 3 };
    const int kinds = getenv("WR_FULL") ? 3 : 2, count = SHAPES * 2 * kinds;
    double ratio[COUNT], sum = 0.0;
    char line[64];
    for (int i = 0; i < count; i++) {
        int size = sizes[i / SHAPES % 2], along = counts[i / SHAPES / 2];
        snprintf(line, sizeof line, "solid %s rows=%d across=%d", shapes[i % SHAPES], along, along);
        double said = seconds_of(size, line);
        ratio[i] = log(cost_of(size, line) / said);
        sum += ratio[i] / count;
        if (getenv("WR_TELL"))
            print_message("%4d %-40s said %6.2f s, took %.2f of it\n", size, line, said,
                          exp(ratio[i]));
    }
    for (int i = 0; i < count; i++)
        if (fabs(ratio[i] - sum) > log(3.0))
            fail_msg("%s, %d along each side, at %d: %g times the estimate, all together %g",
                     shapes[i % SHAPES], counts[i / SHAPES / 2], sizes[i / SHAPES % 2],
                     exp(ratio[i]), exp(sum));
}

/* Every kind of solid, upright and leaning, alone and close together; an ordinary run takes every other. What is done
   in a moment may be said to take several. */
static void solids_are_near_what_they_take(void **state)
{
    (void)state;
    static const char *const shapes[] = { "sphere",   "ellipsoid",   "box",
                                          "cylinder", "cone",        "torus",
                                          "capsule",  "letters abc", "letters a size=300" };
    static const char *const leans[] = { "", " tilt=30", " rotate=40,25,0" };
    static const int sizes[] = { 512, 256 }, counts[] = { 2, 12 };
    enum { SHAPES = (int)(sizeof shapes / sizeof *shapes), COUNT = SHAPES * 3 * 2 };
    const int step = getenv("WR_FULL") ? 1 : 2;
    double ratio[COUNT], sum = 0.0;
    char line[96];
    for (int i = 0; i < COUNT; i += step) {
        const int kind = i / SHAPES / 3, along = counts[kind];
        snprintf(line, sizeof line, "solid %s rows=%d across=%d%s", shapes[i % SHAPES], along,
                 along, leans[i / SHAPES % 3]);
        const double said = seconds_of(sizes[kind], line) + MOMENT;
        ratio[i] = log((cost_of(sizes[kind], line) + MOMENT) / said);
        sum += ratio[i] * step / COUNT;
        if (getenv("WR_TELL"))
            print_message("%4d %-56s said %7.3f s, took %.2f of it\n", sizes[kind], line, said,
                          exp(ratio[i]));
    }
    for (int i = 0; i < COUNT; i += step)
        if (fabs(ratio[i] - sum) > log(3.0))
            fail_msg("solid %s%s, %d along each side: %g times the estimate, all together %g",
                     shapes[i % SHAPES], leans[i / SHAPES % 3], counts[i / SHAPES / 3],
                     exp(ratio[i]), exp(sum));
}

/* Heights and coverage, as the layer's own tables hold them. */
static void memory_is_near_what_tables_hold(void **state)
{
    (void)state;
    static const char *const lines[] = { "pattern bricks", "noise perlin", "adjust invert" };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        WrSession *s = table_of(1024);
        must_run(s, "noise value");
        double said = estimate_of(s, lines[i]).bytes, held = 2.0 * 4.0 * 1024 * 1024;
        if (said < held / 2.0 || said > held * 2.0)
            fail_msg("%s: said %g bytes, holds %g", lines[i], said, held);
        wr_session_free(s);
    }
}

/* ---- files ---- */

/* The library of files has started. */
static void warm(WrSession *s)
{
    wr_session_set_outputs(s, true);
    must_run(s, "save warm.exr");
    must_run(s, "export height warm.png");
}

static void files_are_near_what_they_take(void **state)
{
    (void)state;
    static const char *const lines[] = {
        "save a.exr",
        "save a.ora",
        "export height a.png",
        "export height a.exr",
        "export height a.tif",
        "export normal+y a.png",
        "export normal-y a.exr",
        "export lines a.png",
        "export lines a.svg",
    };
    enum { COUNT = (int)(sizeof lines / sizeof *lines) };
    double ratio[COUNT], sum = 0.0;
    WrSession *s = table_of(768);
    must_run(s, "noise perlin cells=9 amplitude=1");
    warm(s);
    for (int i = 0; i < COUNT; i++) {
        double said = estimate_of(s, lines[i]).seconds, before = wr_clock_process_seconds();
        must_run(s, lines[i]);
        ratio[i] = log((wr_clock_process_seconds() - before) / said);
        sum += ratio[i] / COUNT;
    }
    for (int i = 0; i < COUNT; i++) {
        if (getenv("WR_TELL")) print_message("%-24s %.2f\n", lines[i], exp(ratio[i]));
        if (fabs(ratio[i] - sum) > log(5.0))
            fail_msg("%s: %g times the estimate, all together %g", lines[i], exp(ratio[i]),
                     exp(sum));
    }
    wr_session_free(s);
}

/* ---- memory ---- */

/* Sanitizers keep memory of their own. */
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
static double status_bytes(const char *name)
{
    char line[256];
    double kb = 0.0;
    FILE *file = fopen("/proc/self/status", "re");
    while (file && fgets(line, sizeof line, file))
        if (strncmp(line, name, strlen(name)) == 0) kb = strtod(line + strlen(name) + 1, NULL);
    if (file) fclose(file);
    return kb * 1024.0;
}

/* Bytes of memory by which a process that runs the line grows at most; 0: this system does not tell. */
static double peak_of(WrSession *s, const char *line)
{
    int ends[2];
    double peak = 0.0;
    assert_int_equal(pipe(ends), 0);
    pid_t child = fork();
    if (child == 0) {
        WrError err;
        int fd = open("/proc/self/clear_refs", O_WRONLY | O_CLOEXEC);
        wr_field_trim();
        malloc_trim(0); /* what is free already is not used again unseen */
        double before = status_bytes("VmRSS");
        bool good = fd >= 0 && write(fd, "5", 1) == 1 && wr_session_run(s, line, &err);
        peak = status_bytes("VmHWM") - before;
        _exit(!good || write(ends[1], &peak, sizeof peak) != (ssize_t)sizeof peak);
    }
    int status;
    assert_true(waitpid(child, &status, 0) == child);
    if (status == 0) assert_int_equal(read(ends[0], &peak, sizeof peak), (ssize_t)sizeof peak);
    close(ends[0]);
    close(ends[1]);
    return status == 0 ? peak : 0.0;
}
#endif

#define FACTOR 2.2 /* more than that it is not off either way */
#define BEGUN 8e6  /* bytes: a block of tiles of which some were there before */

static void memory_is_near_the_peak_of_a_process(void **state)
{
    (void)state;
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    static const char *const lines[] = {
        "pattern bricks",
        "noise perlin",
        "adjust invert",
        "adjust blur sigma=9",
        "terrain thermal rounds=3",
        "terrain hydraulic rain=0.02",
        "solid torus across=64 rows=64",
        "solid surface sphere size=600",
        "adjust resize width=3000 height=3000",
        "export lines a.svg",
    };
    WrSession *s = table_of(1536);
    must_run(s, "noise perlin");
    wr_session_set_outputs(s, true);
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        double said = estimate_of(s, lines[i]).bytes, peak = peak_of(s, lines[i]);
        if (getenv("WR_TELL"))
            print_message("%-40s said %6.1f MB, took %6.1f MB\n", lines[i], said / 1e6, peak / 1e6);
        if (peak > 0.0 && (said < peak / FACTOR || said > (peak + BEGUN) * FACTOR) &&
            !getenv("WR_TELL"))
            fail_msg("%s: said %g bytes, took %g", lines[i], said, peak);
    }
    wr_session_free(s);
#endif
}

/* Or it is done at once after all, as what is hidden costs nothing. */
/* Of a large picture a band is held; under a tolerance, all of it. */
static void large_pictures_take_the_memory_of_a_band(void **state)
{
    (void)state;
    WrSession *s = table_of(64);
    const WrEstimate small = estimate_of(s, "render a.png size=1024x1024");
    const WrEstimate large = estimate_of(s, "render a.png size=16384x16384");
    must_run(s, "tolerance rms=0.01");
    const WrEstimate whole = estimate_of(s, "render a.png size=16384x16384");
    assert_true(small.bytes > 16e6 && large.bytes > small.bytes);
    assert_true(large.bytes < 80e6 && whole.bytes > 4e9);
    wr_session_free(s);
}

static void what_runs_for_minutes_is_told(void **state)
{
    (void)state;
    static const char *const lines[] = {
        "solid cylinder radius=16384",        "solid torus rows=1024 across=1024",
        "solid letters ab size=16384",        "solid surface sphere size=16384",
        "solid sphere rows=1024 across=1024", "terrain thermal rounds=100000",
    };
    char text[WR_ESTIMATE_TEXT];
    WrSession *s = table_of(256);
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        WrEstimate e = estimate_of(s, lines[i]);
        if (e.seconds <= 1.0 && cost_of(256, lines[i]) > 5.0 * e.seconds)
            fail_msg("%s: said to take %g s", lines[i], e.seconds);
        if (e.seconds <= 1.0) continue;
        wr_estimate_print(&e, text);
        assert_memory_equal(text, "about ", 6);
    }
    wr_session_free(s);
}

static void estimates_are_told_in_a_few_words(void **state)
{
    (void)state;
    static const struct {
        WrEstimate estimate;
        const char *text;
    } cases[] = {
        { { .seconds = 12, .bytes = 3e8 }, "about 12 s, 300 MB" },
        { { .seconds = 0.4, .bytes = 6e7 }, "" },
        { { .seconds = 0.2, .bytes = 4.2e9 }, "about 0.2 s, 4.2 GB" },
        { { .seconds = 240, .bytes = 0 }, "about 4 min" },
        { { .seconds = 7200, .bytes = 2e6 }, "about 2 h, 2 MB" },
        { { .seconds = 9, .unknown = "why" }, "" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[WR_ESTIMATE_TEXT];
        wr_estimate_print(&cases[i].estimate, text);
        assert_string_equal(text, cases[i].text);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ridge_costs_more_than_a_bevel),
        cmocka_unit_test(sheared_noise_costs_more_than_other),
        cmocka_unit_test(every_edit_and_output_has_a_price),
        cmocka_unit_test(every_example_is_estimated_and_nothing_changes),
        cmocka_unit_test(estimates_rise_with_size_and_counts),
        cmocka_unit_test(estimates_are_near_what_commands_take),
        cmocka_unit_test(crowds_are_near_what_they_take),
        cmocka_unit_test(solids_are_near_what_they_take),
        cmocka_unit_test(memory_is_near_what_tables_hold),
        cmocka_unit_test(files_are_near_what_they_take),
        cmocka_unit_test(memory_is_near_the_peak_of_a_process),
        cmocka_unit_test(large_pictures_take_the_memory_of_a_band),
        cmocka_unit_test(what_runs_for_minutes_is_told),
        cmocka_unit_test(estimates_are_told_in_a_few_words),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
