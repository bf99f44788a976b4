/* Memory estimates of commands, compared with their actual use. */
#include "test.h"
#include "test_folder.h"
#include "test_session_help.h"

#include "base/error.h"
#include "command/estimate.h"
#include "command/session.h"
#include "command/command_table.h"
#include "field/field.h"

#include <fcntl.h>
#include <malloc.h>
#include <sys/wait.h>

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
    WrSession *s = table_of(64);
    WrHash before = wr_session_hash(s);
    for (const WrCommand *const *row = wr_commands, *c; (c = *row) != NULL; row++) {
        WrEstimate e = estimate_of(s, c->example);
        if (!(e.bytes >= 0.0 && e.bytes < 1e9)) fail_msg("%s: %g bytes", c->example, e.bytes);
    }
    assert_true(wr_hash_equal(before, wr_session_hash(s)));
    wr_session_free(s);
}

/* Heights and coverage, as the layer's tables store them. */
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

static double bytes_of(int size, const char *line)
{
    WrSession *s = table_of(size);
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

/* Sanitizers use additional memory. */
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

/* Peak growth in bytes of a process that runs the line; 0: unknown on this system. */
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
        malloc_trim(0); /* so that free memory is not reused unnoticed */
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

#define FACTOR 2.2 /* largest ratio in either direction */
#define BEGUN 8e6  /* bytes: a block of tiles, some of which existed before */

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

/* One band of a large picture is in memory; under a tolerance, all of it. */
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_edit_and_output_has_a_price),
        cmocka_unit_test(every_example_is_estimated_and_nothing_changes),
        cmocka_unit_test(memory_rises_with_size_and_counts),
        cmocka_unit_test(memory_is_near_what_tables_hold),
        cmocka_unit_test(memory_is_near_the_peak_of_a_process),
        cmocka_unit_test(large_pictures_take_the_memory_of_a_band),
        cmocka_unit_test(estimates_are_told_in_a_few_words),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
