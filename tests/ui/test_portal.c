/* Requests and answers of the portal, with a test portal on a private bus. */
#include "test.h"

#include "portal_help.h"
#include "test_folder.h"

#include "ui/app/jobs/portal.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/enum_rows.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* ---- questions ---- */

static const WrPortalRequest plain = { .title = "Open",
                                       .accept = "Open",
                                       .folder = "",
                                       .name = "",
                                       .parent = "",
                                       .kind = "Pictures",
                                       .all = "All files",
                                       .patience = 20.0 };
static volatile int never;

static WrPortalEnd answer(const Act *act, const WrPortalRequest *ask, char path[4096])
{
    const pid_t portal = start_portal(act);
    const WrPortalEnd end = wr_portal_request(ask, &never, path, 4096);
    end_portal(portal);
    return end;
}

static bool no_bus;
#define NEEDS_BUS                                                                                  \
    (void)state;                                                                                   \
    if (no_bus) skip()

static void a_question_says_all_that_the_portal_can_use(void **state)
{
    NEEDS_BUS;
    static const char *const endings[] = { "png", "jp2", NULL };
    char path[4096], *asked = NULL;
    size_t length;
    WrError err;
    const Act act = { .replies = true, .uris = { "file:///tmp/a.png" } };
    WrPortalRequest ask = plain;
    ask.title = "S\xc3\xa4ve \"as\"";
    ask.accept = "Keep";
    ask.folder = "/tmp/two words \xff";
    ask.name = "a b.exr";
    ask.parent = "x11:1a0000f";
    ask.endings = endings;
    ask.save = true;
    assert_int_equal(answer(&act, &ask, path), WR_PORTAL_CHOSE);
    assert_true(wr_file_read("asked", 10000, &asked, &length, &err));
    assert_string_equal(
        asked,
        "SaveFile 'x11:1a0000f' 'S\xc3\xa4ve \"as\"' [['handle_token' ['TOKEN' ] ] "
        "['accept_label' ['Keep' ] ] ['filters' [[['Pictures' [[0 '*.[pP][nN][gG]' ] "
        "[0 '*.[jJ][pP]2' ] ] ] ['All files' [[0 '*' ] ] ] ] ] ] "
        "['current_folder' [[/tmp/two words <ff><00>] ] ] ['current_name' ['a b.exr' ] ] ] ");
    wr_free(asked);
    ask.save = false;
    ask.endings = NULL;
    ask.folder = "";
    assert_int_equal(answer(&act, &ask, path), WR_PORTAL_CHOSE);
    assert_true(wr_file_read("asked", 10000, &asked, &length, &err));
    assert_non_null(strstr(asked, "OpenFile"));
    assert_null(strstr(asked, "filters"));
    assert_null(strstr(asked, "current"));
    wr_free(asked);
}

static void every_end_is_told_apart(void **state)
{
    NEEDS_BUS;
    static const struct {
        Act act;
        WrPortalEnd end;
        const char *path;
    } rows[] = {
        { { .replies = true, .uris = { "file:///tmp/one.exr" } }, WR_PORTAL_CHOSE, "/tmp/one.exr" },
        { { .replies = true, .uris = { "file:///tmp/a%25b%20c%C3%A4%ff", "file:///tmp/two" } },
          WR_PORTAL_CHOSE,
          "/tmp/a%b c\xc3\xa4\xff" },
        { { .replies = true, .old = true, .uris = { "file:///tmp/old" } },
          WR_PORTAL_CHOSE,
          "/tmp/old" },
        { { .replies = true, .stranger = true, .uris = { "file:///tmp/own" } },
          WR_PORTAL_CHOSE,
          "/tmp/own" },
        { { .replies = true, .code = 1, .uris = { "file:///tmp/no" } }, WR_PORTAL_CANCELLED, "" },
        { { .replies = true, .code = 2 }, WR_PORTAL_NONE, "" },
        { { .replies = true, .uris = { NULL } }, WR_PORTAL_NONE, "" },
        { { .replies = true, .uris = { "https://example.org/a.png" } }, WR_PORTAL_NONE, "" },
        { { .replies = true, .dies = true }, WR_PORTAL_NONE, "" },
        { { .fails = true }, WR_PORTAL_NONE, "" },
    };
    for (int i = 0; i < WR_LENGTH(rows); i++) {
        char path[4096];
        const WrPortalEnd end = answer(&rows[i].act, &plain, path);
        if (end != rows[i].end || strcmp(path, rows[i].path) != 0)
            fail_msg("row %d: %d '%s', not %d '%s'", i, end, path, rows[i].end, rows[i].path);
    }
}

static void who_does_not_answer_is_given_up_and_told(void **state)
{
    NEEDS_BUS;
    char path[4096];
    WrPortalRequest ask = plain;
    ask.patience = 0.25;
    const Act silent = { .replies = false };
    assert_int_equal(answer(&silent, &ask, path), WR_PORTAL_NONE);
    /* no portal */
    assert_int_equal(wr_portal_request(&ask, &never, path, sizeof path), WR_PORTAL_NONE);
    char *bus = strdup(getenv("DBUS_SESSION_BUS_ADDRESS"));
    setenv("DBUS_SESSION_BUS_ADDRESS", "unix:path=/nowhere/bus", 1);
    assert_int_equal(wr_portal_request(&ask, &never, path, sizeof path), WR_PORTAL_NONE);
    setenv("DBUS_SESSION_BUS_ADDRESS", "no address", 1);
    assert_int_equal(wr_portal_request(&ask, &never, path, sizeof path), WR_PORTAL_NONE);
    unsetenv("DBUS_SESSION_BUS_ADDRESS");
    setenv("XDG_RUNTIME_DIR", "/nowhere", 1);
    assert_false(wr_portal_may_be());
    assert_int_equal(wr_portal_request(&ask, &never, path, sizeof path), WR_PORTAL_NONE);
    setenv("DBUS_SESSION_BUS_ADDRESS", bus, 1);
    free(bus);
    assert_true(wr_portal_may_be());
}

static volatile int stop;

static void *stop_soon(void *arg)
{
    (void)arg;
    while (access("asked", F_OK) != 0) usleep(1000);
    usleep(50000);
    stop = 1;
    return NULL;
}

static void a_dialog_that_is_stopped_is_closed(void **state)
{
    NEEDS_BUS;
    char path[4096];
    pthread_t thread;
    const Act act = { .replies = true, .waits = true };
    const pid_t portal = start_portal(&act);
    stop = 0;
    assert_int_equal(pthread_create(&thread, NULL, stop_soon, NULL), 0);
    assert_int_equal(wr_portal_request(&plain, &stop, path, sizeof path), WR_PORTAL_CANCELLED);
    pthread_join(thread, NULL);
    for (int i = 0; i < 20000 && access("closed", F_OK) != 0; i++) usleep(1000);
    assert_int_equal(access("closed", F_OK), 0);
    end_portal(portal);
}

static void only_paths_of_this_machine_come_out_of_uris(void **state)
{
    (void)state;
    static const struct {
        const char *uri, *path;
    } rows[] = { { "file:///a", "/a" },
                 { "file://localhost/a/b%2Fc", "/a/b/c" },
                 { "file:///%e4%80", "/\xe4\x80" },
                 { "file:///100%25%20", "/100% " },
                 { "file:///", NULL },
                 { "file://other/a", NULL },
                 { "file:a", NULL },
                 { "file:///a%0", NULL },
                 { "file:///a%", NULL },
                 { "file:///a%zz", NULL },
                 { "file:///a%00b", NULL },
                 { "file:///a?b", NULL },
                 { "file:///a#b", NULL },
                 { "/a", NULL },
                 { "", NULL },
                 { "file:///0123456789012345678", NULL } }; /* too long */
    for (int i = 0; i < WR_LENGTH(rows); i++) {
        char path[20];
        const bool good = wr_portal_path(rows[i].uri, path, sizeof path);
        if (good != (rows[i].path != NULL) || (good && strcmp(path, rows[i].path) != 0))
            fail_msg("%s became %s", rows[i].uri, good ? path : "nothing");
    }
    char pattern[12];
    wr_portal_pattern("j2", pattern, sizeof pattern);
    assert_string_equal(pattern, "*.[jJ]2");
    wr_portal_pattern("abcdefgh", pattern, sizeof pattern); /* truncated, never overrun */
    assert_true(strlen(pattern) < sizeof pattern);
}

static int enter(void **state)
{
    if (enter_folder(state) != 0) return -1;
    no_bus = !start_bus();
    if (no_bus) printf("no bus, so no portal is tried: apt-get install dbus-daemon\n");
    return 0;
}

static int leave(void **state)
{
    end_bus();
    return remove_folder(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_question_says_all_that_the_portal_can_use),
        cmocka_unit_test(every_end_is_told_apart),
        cmocka_unit_test(who_does_not_answer_is_given_up_and_told),
        cmocka_unit_test(a_dialog_that_is_stopped_is_closed),
        cmocka_unit_test(only_paths_of_this_machine_come_out_of_uris),
    };
    return cmocka_run_group_tests(tests, enter, leave);
}
