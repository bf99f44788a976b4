/* What commands are said to cost before they begin, against what they do cost. */
#include "test.h"

#include "base/clock.h"
#include "command/estimate.h"
#include "command/table.h"
#include "test_session_help.h"

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
    for (const WrCommand *c = wr_commands; c->name; c++) {
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
    for (const WrCommand *c = wr_commands; c->name; c++) {
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

/* Seconds of work that the line takes, whatever others do on the machine; the least of two. */
static double cost_of(int size, const char *line)
{
    double least = 1e9;
    for (int run = 0; run < 2; run++) {
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

/* Or it is done at once after all, as what is hidden costs nothing. */
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
        cmocka_unit_test(every_edit_and_output_has_a_price),
        cmocka_unit_test(every_example_is_estimated_and_nothing_changes),
        cmocka_unit_test(estimates_rise_with_size_and_counts),
        cmocka_unit_test(estimates_are_near_what_commands_take),
        cmocka_unit_test(memory_is_near_what_tables_hold),
        cmocka_unit_test(what_runs_for_minutes_is_told),
        cmocka_unit_test(estimates_are_told_in_a_few_words),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
