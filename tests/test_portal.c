/* Requests and answers of the portal, with a test portal on a private bus. */
#include "test.h"

#include "test_folder.h"

#include "ui/jobs/portal.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/enum_rows.h"

#include <dbus/dbus.h>

#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#define DESKTOP "org.freedesktop.portal.Desktop"
#define REQUEST "org.freedesktop.portal.Request"

/* ---- a bus ---- */

static pid_t daemon_process;

/* False: there is no dbus-daemon. */
static bool start_bus(void)
{
    static const char conf[] =
        "<busconfig><type>session</type><listen>unix:dir=/tmp</listen><policy "
        "context=\"default\"><allow send_destination=\"*\" eavesdrop=\"true\"/>"
        "<allow eavesdrop=\"true\"/><allow own=\"*\"/></policy></busconfig>";
    int ends[2];
    char address[300] = "";
    WrError err;
    if (!wr_file_write("bus.conf", conf, sizeof conf - 1, &err) || pipe(ends) != 0) return false;
    daemon_process = fork();
    if (daemon_process == 0) {
        prctl(PR_SET_PDEATHSIG, SIGTERM);
        dup2(ends[1], 1);
        execlp("dbus-daemon", "dbus-daemon", "--config-file=bus.conf", "--nofork",
               "--print-address=1", (char *)NULL);
        _exit(127);
    }
    close(ends[1]);
    const ssize_t n = read(ends[0], address, sizeof address - 1);
    close(ends[0]);
    if (n <= 0) return false;
    address[strcspn(address, "\n")] = '\0';
    setenv("DBUS_SESSION_BUS_ADDRESS", address, 1);
    return true;
}

/* ---- a portal ---- */

typedef struct Act {
    bool replies, dies, fails; /* it accepts the request, then ends; it answers with an error */
    bool old;                  /* and gives it another name */
    bool waits;                /* until it is asked to close */
    bool stranger;             /* another sender answers first, with /tmp/stranger */
    dbus_uint32_t code;
    const char *uris[3]; /* NULL-terminated */
} Act;

/* The value at `at` and the following ones as text. */
static void flatten(DBusMessageIter *at, FILE *out)
{
    for (int type; (type = dbus_message_iter_get_arg_type(at)) != DBUS_TYPE_INVALID;
         dbus_message_iter_next(at)) {
        DBusMessageIter inner;
        const char *text;
        dbus_uint32_t number;
        unsigned char byte;
        if (type == DBUS_TYPE_STRING) {
            dbus_message_iter_get_basic(at, &text);
            if (strncmp(text, "wrinkle", 7) == 0) text = "TOKEN";
            fprintf(out, "'%s' ", text);
        } else if (type == DBUS_TYPE_UINT32) {
            dbus_message_iter_get_basic(at, &number);
            fprintf(out, "%u ", (unsigned)number);
        } else if (type == DBUS_TYPE_BYTE) {
            dbus_message_iter_get_basic(at, &byte);
            fprintf(out, byte >= 0x20 && byte < 0x7f ? "%c" : "<%02x>", byte);
        } else {
            dbus_message_iter_recurse(at, &inner);
            fputs("[", out);
            flatten(&inner, out);
            fputs("] ", out);
        }
    }
}

static void respond(DBusConnection *bus, const char *to, const char *handle, dbus_uint32_t code,
                    const char *const *uris)
{
    DBusMessage *signal_ = dbus_message_new_signal(handle, REQUEST, "Response");
    DBusMessageIter at, results, entry, value, list;
    const char *name = "uris", *other = "writable";
    const dbus_bool_t yes = TRUE;
    dbus_message_set_destination(signal_, to);
    dbus_message_iter_init_append(signal_, &at);
    dbus_message_iter_append_basic(&at, DBUS_TYPE_UINT32, &code);
    dbus_message_iter_open_container(&at, DBUS_TYPE_ARRAY, "{sv}", &results);
    dbus_message_iter_open_container(&results, DBUS_TYPE_DICT_ENTRY, NULL, &entry);
    dbus_message_iter_append_basic(&entry, DBUS_TYPE_STRING, &other);
    dbus_message_iter_open_container(&entry, DBUS_TYPE_VARIANT, "b", &value);
    dbus_message_iter_append_basic(&value, DBUS_TYPE_BOOLEAN, &yes);
    dbus_message_iter_close_container(&entry, &value);
    dbus_message_iter_close_container(&results, &entry);
    dbus_message_iter_open_container(&results, DBUS_TYPE_DICT_ENTRY, NULL, &entry);
    dbus_message_iter_append_basic(&entry, DBUS_TYPE_STRING, &name);
    dbus_message_iter_open_container(&entry, DBUS_TYPE_VARIANT, "as", &value);
    dbus_message_iter_open_container(&value, DBUS_TYPE_ARRAY, "s", &list);
    for (; *uris; uris++) dbus_message_iter_append_basic(&list, DBUS_TYPE_STRING, uris);
    dbus_message_iter_close_container(&value, &list);
    dbus_message_iter_close_container(&entry, &value);
    dbus_message_iter_close_container(&results, &entry);
    dbus_message_iter_close_container(&at, &results);
    dbus_connection_send(bus, signal_, NULL);
    dbus_connection_flush(bus);
    dbus_message_unref(signal_);
}

static void token_of(DBusMessage *message, char token[64])
{
    DBusMessageIter at, options, entry, value;
    dbus_message_iter_init(message, &at);
    while (dbus_message_iter_get_arg_type(&at) != DBUS_TYPE_ARRAY) dbus_message_iter_next(&at);
    dbus_message_iter_recurse(&at, &options);
    for (; dbus_message_iter_get_arg_type(&options) == DBUS_TYPE_DICT_ENTRY;
         dbus_message_iter_next(&options)) {
        const char *name, *text;
        dbus_message_iter_recurse(&options, &entry);
        dbus_message_iter_get_basic(&entry, &name);
        if (strcmp(name, "handle_token") != 0) continue;
        dbus_message_iter_next(&entry);
        dbus_message_iter_recurse(&entry, &value);
        dbus_message_iter_get_basic(&value, &text);
        snprintf(token, 64, "%s", text);
    }
}

static void take_question(DBusConnection *bus, DBusConnection *other, DBusMessage *message,
                          const Act *act)
{
    DBusMessageIter at;
    char token[64] = "", sender[64], handle[300];
    FILE *asked = fopen("asked", "w");
    fprintf(asked, "%s ", dbus_message_get_member(message));
    if (dbus_message_iter_init(message, &at)) flatten(&at, asked);
    fclose(asked);
    if (act->fails) {
        DBusMessage *error =
            dbus_message_new_error(message, DBUS_ERROR_UNKNOWN_METHOD, "no such thing");
        dbus_connection_send(bus, error, NULL);
        dbus_connection_flush(bus);
        dbus_message_unref(error);
    }
    if (!act->replies) return;
    token_of(message, token);
    snprintf(sender, sizeof sender, "%s", dbus_message_get_sender(message) + 1);
    for (char *c = sender; *c; c++)
        if (*c == '.') *c = '_';
    snprintf(handle, sizeof handle, "/org/freedesktop/portal/desktop/request/%s/%s%s", sender,
             token, act->old ? "_old" : "");
    DBusMessage *reply = dbus_message_new_method_return(message);
    const char *said = handle;
    dbus_message_append_args(reply, DBUS_TYPE_OBJECT_PATH, &said, DBUS_TYPE_INVALID);
    dbus_connection_send(bus, reply, NULL);
    dbus_connection_flush(bus);
    dbus_message_unref(reply);
    static const char *const strange[] = { "file:///tmp/stranger", NULL };
    usleep(20000);
    if (act->stranger) respond(other, dbus_message_get_sender(message), handle, 0, strange);
    if (act->stranger) usleep(50000);
    if (act->dies) _exit(0);
    if (!act->waits) respond(bus, dbus_message_get_sender(message), handle, act->code, act->uris);
}

static void be_portal(const Act *act, int ready)
{
    DBusError error;
    dbus_error_init(&error);
    DBusConnection *bus = dbus_bus_get_private(DBUS_BUS_SESSION, &error);
    DBusConnection *other = dbus_bus_get_private(DBUS_BUS_SESSION, &error);
    if (!bus || !other ||
        dbus_bus_request_name(bus, DESKTOP, 0, &error) != DBUS_REQUEST_NAME_REPLY_PRIMARY_OWNER)
        _exit(1);
    if (write(ready, "r", 1) != 1) _exit(1);
    while (dbus_connection_read_write(bus, -1))
        for (DBusMessage *message; (message = dbus_connection_pop_message(bus));
             dbus_message_unref(message)) {
            if (dbus_message_is_method_call(message, REQUEST, "Close")) {
                FILE *closed = fopen("closed", "w");
                fclose(closed);
            } else if (dbus_message_get_type(message) == DBUS_MESSAGE_TYPE_METHOD_CALL) {
                take_question(bus, other, message, act);
            }
        }
    _exit(0);
}

static pid_t start_portal(const Act *act)
{
    int ends[2];
    char byte;
    unlink("asked");
    unlink("closed");
    assert_int_equal(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        close(ends[0]);
        be_portal(act, ends[1]);
    }
    close(ends[1]);
    assert_int_equal(read(ends[0], &byte, 1), 1);
    close(ends[0]);
    return child;
}

static void end_portal(pid_t portal)
{
    kill(portal, SIGKILL);
    waitpid(portal, NULL, 0);
}

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
    const WrPortalEnd end = wr_portal_ask(ask, &never, path, 4096);
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
    assert_int_equal(wr_portal_ask(&ask, &never, path, sizeof path), WR_PORTAL_NONE);
    char *bus = strdup(getenv("DBUS_SESSION_BUS_ADDRESS"));
    setenv("DBUS_SESSION_BUS_ADDRESS", "unix:path=/nowhere/bus", 1);
    assert_int_equal(wr_portal_ask(&ask, &never, path, sizeof path), WR_PORTAL_NONE);
    setenv("DBUS_SESSION_BUS_ADDRESS", "no address", 1);
    assert_int_equal(wr_portal_ask(&ask, &never, path, sizeof path), WR_PORTAL_NONE);
    unsetenv("DBUS_SESSION_BUS_ADDRESS");
    setenv("XDG_RUNTIME_DIR", "/nowhere", 1);
    assert_false(wr_portal_may_be());
    assert_int_equal(wr_portal_ask(&ask, &never, path, sizeof path), WR_PORTAL_NONE);
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
    assert_int_equal(wr_portal_ask(&plain, &stop, path, sizeof path), WR_PORTAL_CANCELLED);
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
    if (daemon_process > 0) { /* otherwise it would mean a process group */
        kill(daemon_process, SIGTERM);
        waitpid(daemon_process, NULL, 0);
    }
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
