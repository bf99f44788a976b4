/* Choice of the window system, for each kind of session. */
#include "test.h"

#include "ui/toolkit/video_driver.h"

typedef struct Row {
    WrDisplayEnv env; /* driver, x11, wayland, session */
    const char *driver;
} Row;

static void xwayland_is_chosen_where_there_is_one(void **state)
{
    (void)state;
    static const Row rows[] = {
        { { NULL, ":0", NULL, "x11" }, NULL },
        { { NULL, ":0", NULL, NULL }, NULL },
        { { NULL, NULL, NULL, NULL }, NULL },
        { { NULL, ":0", "", "tty" }, NULL },
        { { NULL, ":1", "wayland-0", "wayland" }, "x11,wayland" },
        { { NULL, ":1", NULL, "wayland" }, "x11,wayland" },
        { { "", ":1", "wayland-1", NULL }, "x11,wayland" },
        { { NULL, NULL, "wayland-0", "wayland" }, "wayland,x11" },
        { { NULL, "", "wayland-0", NULL }, "wayland,x11" },
        /* the user's choice takes precedence */
        { { "wayland", ":1", "wayland-0", "wayland" }, NULL },
        { { "x11", ":1", "wayland-0", "wayland" }, NULL },
        { { "dummy", NULL, "wayland-0", "wayland" }, NULL },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const char *got = wr_display_driver(&rows[i].env);
        if (!rows[i].driver) assert_null(got);
        else assert_string_equal(got, rows[i].driver);
    }
}

/* The same sessions, by the driver that SDL finally opened. */
static void the_word_says_what_becomes_of_pens(void **state)
{
    (void)state;
    static const struct {
        WrDisplayEnv env;
        const char *opened, *has; /* NULL: no message */
    } rows[] = {
        { { NULL, ":0", NULL, "x11" }, "x11", NULL },
        { { NULL, ":1", "wayland-0", "wayland" }, "x11", "runs on XWayland" },
        { { NULL, ":1", "wayland-0", "wayland" }, "wayland", NULL },
        { { NULL, NULL, "wayland-0", "wayland" }, "wayland", NULL },
        { { "wayland", ":1", "wayland-0", NULL }, "wayland", NULL },
        { { "x11", ":1", "wayland-0", NULL }, "x11", NULL }, /* as requested */
        { { NULL, ":1", "wayland-0", NULL }, "dummy", NULL },
        { { NULL, ":1", "wayland-0", NULL }, NULL, NULL },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const char *word = wr_display_driver_message(&rows[i].env, rows[i].opened);
        if (!rows[i].has) {
            assert_null(word);
            continue;
        }
        assert_non_null(word);
        assert_non_null(strstr(word, rows[i].has));
    }
}

static void a_window_that_nobody_sees_is_found_out(void **state)
{
    (void)state;
    assert_true(wr_display_no_output(NULL, "dummy"));
    assert_true(wr_display_no_output(NULL, "offscreen"));
    assert_true(wr_display_no_output("x11,wayland", "offscreen"));
    assert_false(wr_display_no_output("dummy", "dummy")); /* requested by tests */
    assert_false(wr_display_no_output("offscreen,x11", "offscreen"));
    assert_false(wr_display_no_output(NULL, "x11"));
    assert_false(wr_display_no_output(NULL, "wayland"));
    assert_false(wr_display_no_output(NULL, "KMSDRM"));
    assert_true(wr_display_none(&(WrDisplayEnv){ NULL, NULL, NULL, "wayland" }));
    assert_true(wr_display_none(&(WrDisplayEnv){ "", "", "", "tty" }));
    assert_false(wr_display_none(&(WrDisplayEnv){ NULL, ":0", NULL, NULL }));
    assert_false(wr_display_none(&(WrDisplayEnv){ NULL, NULL, "wayland-0", NULL }));
    assert_false(wr_display_none(&(WrDisplayEnv){ "offscreen", NULL, NULL, NULL }));
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(a_window_that_nobody_sees_is_found_out),
                                        cmocka_unit_test(xwayland_is_chosen_where_there_is_one),
                                        cmocka_unit_test(the_word_says_what_becomes_of_pens) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
