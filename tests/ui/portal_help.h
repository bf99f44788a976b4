/* portal_help.h - a file portal for tests, on a private bus: start_bus, then start_portal or be_portal. It writes each
   request to the file `asked` of the current folder. */
#pragma once
#include "base/error.h"
#include "base/file.h"

#include <dbus/dbus.h>

#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#define DESKTOP "org.freedesktop.portal.Desktop"
#define REQUEST "org.freedesktop.portal.Request"

/* ---- a bus ---- */

static pid_t daemon_process;

/* False: there is no dbus-daemon. */
static inline bool start_bus(void)
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
    bool old;                  /* and renames it */
    bool waits;                /* until it is asked to close */
    bool stranger;             /* another sender answers first, with /tmp/stranger */
    dbus_uint32_t code;
    const char *uris[3]; /* NULL-terminated */
    const char *file;    /* or: its first line is the path, without % */
} Act;

/* The value at `at` and the following ones as text. */
static inline void flatten(DBusMessageIter *at, FILE *out)
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

static inline void respond(DBusConnection *bus, const char *to, const char *handle,
                           dbus_uint32_t code, const char *const *uris)
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

static inline void token_of(DBusMessage *message, char token[64])
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

static inline void take_question(DBusConnection *bus, DBusConnection *other, DBusMessage *message,
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
    if (act->waits) return;
    char uri[4096] = "file://";
    FILE *file = act->file ? fopen(act->file, "r") : NULL;
    const char *const read_uri[] = { uri, NULL };
    if (file && fgets(uri + 7, sizeof uri - 7, file)) uri[strcspn(uri, "\n")] = '\0';
    if (file) fclose(file);
    respond(bus, dbus_message_get_sender(message), handle, act->code, file ? read_uri : act->uris);
}

/* libdbus may have read the address of another bus before, so it is given. */
static inline DBusConnection *join_bus(void)
{
    DBusConnection *bus = dbus_connection_open_private(getenv("DBUS_SESSION_BUS_ADDRESS"), NULL);
    return bus && dbus_bus_register(bus, NULL) ? bus : NULL;
}

static inline void be_portal(const Act *act, int ready)
{
    DBusConnection *bus = join_bus(), *other = join_bus();
    if (!bus || !other ||
        dbus_bus_request_name(bus, DESKTOP, 0, NULL) != DBUS_REQUEST_NAME_REPLY_PRIMARY_OWNER)
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

static inline pid_t start_portal(const Act *act)
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

static inline void end_portal(pid_t portal)
{
    kill(portal, SIGKILL);
    waitpid(portal, NULL, 0);
}

static inline void end_bus(void)
{
    if (daemon_process <= 0) return; /* otherwise it would mean a process group */
    kill(daemon_process, SIGTERM);
    waitpid(daemon_process, NULL, 0);
}
