/* The portal by libdbus. Every bus call is sent and its answer awaited with a deadline, so that an unresponsive bus
   or portal cannot block for longer. */
#include "ui/app/jobs/portal.h"

#include "base/progress.h"
#include "system/clock.h"
#include "system/shared_object.h"
#include "system/path.h"
#include "system/process.h"

#include <dbus/dbus.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LIBRARY "libdbus-1.so.3"
#define BUS "org.freedesktop.DBus"
#define BUS_PATH "/org/freedesktop/DBus"
#define DESKTOP "org.freedesktop.portal.Desktop"
#define DESKTOP_PATH "/org/freedesktop/portal/desktop"
#define CHOOSER "org.freedesktop.portal.FileChooser"
#define REQUEST "org.freedesktop.portal.Request"
#define SLICE_MS 50 /* between two checks of `stop` */
#define ADDRESS 4096

/* ---- the library ---- */

#define FUNCTIONS(X)                                                                               \
    X(connection_open_private)                                                                     \
    X(connection_set_exit_on_disconnect)                                                           \
    X(connection_close)                                                                            \
    X(connection_unref)                                                                            \
    X(connection_send)                                                                             \
    X(connection_flush)                                                                            \
    X(connection_read_write)                                                                       \
    X(connection_pop_message)                                                                      \
    X(connection_get_is_connected)                                                                 \
    X(error_init)                                                                                  \
    X(error_free)                                                                                  \
    X(threads_init_default)                                                                        \
    X(validate_utf8)                                                                               \
    X(message_new_method_call)                                                                     \
    X(message_unref)                                                                               \
    X(message_get_type)                                                                            \
    X(message_get_reply_serial)                                                                    \
    X(message_get_sender)                                                                          \
    X(message_get_path)                                                                            \
    X(message_is_signal)                                                                           \
    X(message_iter_init)                                                                           \
    X(message_iter_init_append)                                                                    \
    X(message_iter_append_basic)                                                                   \
    X(message_iter_append_fixed_array)                                                             \
    X(message_iter_open_container)                                                                 \
    X(message_iter_close_container)                                                                \
    X(message_iter_get_arg_type)                                                                   \
    X(message_iter_get_basic)                                                                      \
    X(message_iter_recurse)                                                                        \
    X(message_iter_next)

typedef struct Library {
#define MEMBER(name) __typeof__(dbus_##name) *name;
    FUNCTIONS(MEMBER)
#undef MEMBER
    bool good;
} Library;

/* Called for each dialog; the library is opened once and never unloaded. */
static bool load(Library *dbus)
{
    void *object = wr_object_open(LIBRARY);
    if (!object) return false;
    dbus->good = true;
#define FIND(name)                                                                                 \
    *(void **)&dbus->name = wr_object_find(object, "dbus_" #name);                                 \
    dbus->good = dbus->good && dbus->name;
    FUNCTIONS(FIND)
#undef FIND
    return dbus->good && dbus->threads_init_default();
}

/* ---- the bus ---- */

typedef struct Bus {
    Library dbus;
    DBusConnection *connection;
    const volatile int *stop;
    char unique[64], handle[300],
        portal[64];      /* unique name, object of the request, name of the portal */
    bool answered, gone; /* the portal has answered; the portal or the bus was lost */
    WrPortalEnd end;
    char *path;
    size_t size;
} Bus;

bool wr_portal_may_be(void)
{
    char path[ADDRESS];
    const char *said = getenv("DBUS_SESSION_BUS_ADDRESS"), *folder = getenv("XDG_RUNTIME_DIR");
    if (said && *said) return true;
    if (!folder || folder[0] != '/') return false;
    snprintf(path, sizeof path, "%.4000s/bus", folder);
    return wr_path_is_there(path);
}

static bool connect_to_bus(Bus *bus)
{
    char address[ADDRESS];
    DBusError error;
    const char *said = getenv("DBUS_SESSION_BUS_ADDRESS"), *folder = getenv("XDG_RUNTIME_DIR");
    if (said && *said) snprintf(address, sizeof address, "%s", said);
    else snprintf(address, sizeof address, "unix:path=%.4000s/bus", folder ? folder : "");
    bus->dbus.error_init(&error);
    bus->connection = bus->dbus.connection_open_private(address, &error);
    bus->dbus.error_free(&error);
    if (bus->connection) bus->dbus.connection_set_exit_on_disconnect(bus->connection, FALSE);
    return bus->connection != NULL;
}

/* ---- received messages ---- */

static const char *text_at(const Bus *bus, DBusMessageIter *at)
{
    const char *text = "";
    const int type = bus->dbus.message_iter_get_arg_type(at);
    if (type == DBUS_TYPE_STRING || type == DBUS_TYPE_OBJECT_PATH)
        bus->dbus.message_iter_get_basic(at, &text);
    return text;
}

/* Read the first of the URIs in a variant. */
static void take_uris(Bus *bus, DBusMessageIter *variant)
{
    DBusMessageIter list, item;
    if (bus->dbus.message_iter_get_arg_type(variant) != DBUS_TYPE_VARIANT) return;
    bus->dbus.message_iter_recurse(variant, &list);
    if (bus->dbus.message_iter_get_arg_type(&list) != DBUS_TYPE_ARRAY) return;
    bus->dbus.message_iter_recurse(&list, &item);
    if (wr_portal_path(text_at(bus, &item), bus->path, bus->size)) bus->end = WR_PORTAL_CHOSE;
}

/* Response(u response, a{sv} results): 0 is success, 1 cancelled by the user, 2 ended otherwise. */
static void take_response(Bus *bus, DBusMessage *message)
{
    DBusMessageIter at, entries, entry;
    dbus_uint32_t code = 2;
    bus->answered = true;
    bus->end = WR_PORTAL_NONE;
    if (!bus->dbus.message_iter_init(message, &at) ||
        bus->dbus.message_iter_get_arg_type(&at) != DBUS_TYPE_UINT32)
        return;
    bus->dbus.message_iter_get_basic(&at, &code);
    if (code == 1) bus->end = WR_PORTAL_CANCELLED;
    if (code != 0 || !bus->dbus.message_iter_next(&at) ||
        bus->dbus.message_iter_get_arg_type(&at) != DBUS_TYPE_ARRAY)
        return;
    bus->dbus.message_iter_recurse(&at, &entries);
    for (; bus->dbus.message_iter_get_arg_type(&entries) == DBUS_TYPE_DICT_ENTRY;
         bus->dbus.message_iter_next(&entries)) {
        bus->dbus.message_iter_recurse(&entries, &entry);
        const bool uris = strcmp(text_at(bus, &entry), "uris") == 0;
        if (bus->dbus.message_iter_next(&entry) && uris) take_uris(bus, &entry);
    }
}

/* NameOwnerChanged(s name, s old, s new) */
static bool is_end_of_portal(const Bus *bus, DBusMessage *message)
{
    DBusMessageIter at;
    if (!bus->dbus.message_is_signal(message, BUS, "NameOwnerChanged")) return false;
    const char *sender = bus->dbus.message_get_sender(message);
    if (!sender || strcmp(sender, BUS) != 0 || !bus->dbus.message_iter_init(message, &at))
        return false;
    const bool its = strcmp(text_at(bus, &at), DESKTOP) == 0;
    if (!its || !bus->dbus.message_iter_next(&at) || !bus->dbus.message_iter_next(&at))
        return false;
    return text_at(bus, &at)[0] == '\0';
}

static void hear(Bus *bus, DBusMessage *message)
{
    if (is_end_of_portal(bus, message)) bus->gone = true;
    if (!bus->dbus.message_is_signal(message, REQUEST, "Response")) return;
    const char *sender = bus->dbus.message_get_sender(message),
               *path = bus->dbus.message_get_path(message);
    if (!sender || !path || strcmp(path, bus->handle) != 0) return;
    if (bus->portal[0] && strcmp(sender, bus->portal) != 0) return; /* from another sender */
    take_response(bus, message);
}

/* The next message until the deadline; NULL: none, or stopped. The caller unrefs it. */
static DBusMessage *next(Bus *bus, double deadline)
{
    for (;;) {
        DBusMessage *message = bus->dbus.connection_pop_message(bus->connection);
        if (message || wr_cancel_requested(bus->stop) || wr_clock_seconds() >= deadline)
            return message;
        if (!bus->dbus.connection_read_write(bus->connection, SLICE_MS)) {
            bus->gone = true;
            return NULL;
        }
    }
}

/* Send a message (ownership passes) and wait for the reply. NULL: an error, a timeout, or stopped. The caller unrefs
   it. */
static DBusMessage *exchange(Bus *bus, DBusMessage *message, double deadline)
{
    dbus_uint32_t serial = 0;
    const bool sent = bus->dbus.connection_send(bus->connection, message, &serial);
    bus->dbus.message_unref(message);
    while (sent && !bus->gone) {
        DBusMessage *heard = next(bus, deadline);
        if (!heard) return NULL;
        if (bus->dbus.message_get_reply_serial(heard) == serial) {
            if (bus->dbus.message_get_type(heard) == DBUS_MESSAGE_TYPE_METHOD_RETURN) return heard;
            bus->dbus.message_unref(heard);
            return NULL;
        }
        hear(bus, heard);
        bus->dbus.message_unref(heard);
    }
    return NULL;
}

/* ---- sent messages ---- */

static void add_text(const Bus *bus, DBusMessageIter *to, const char *text)
{
    if (!bus->dbus.validate_utf8(text, NULL)) text = "";
    bus->dbus.message_iter_append_basic(to, DBUS_TYPE_STRING, &text);
}

/* A dictionary entry: its key, and the variant for its value. */
typedef struct Entry {
    DBusMessageIter entry, value;
} Entry;

static void begin(const Bus *bus, DBusMessageIter *options, const char *name, const char *kind,
                  Entry *e)
{
    bus->dbus.message_iter_open_container(options, DBUS_TYPE_DICT_ENTRY, NULL, &e->entry);
    bus->dbus.message_iter_append_basic(&e->entry, DBUS_TYPE_STRING, &name);
    bus->dbus.message_iter_open_container(&e->entry, DBUS_TYPE_VARIANT, kind, &e->value);
}

static void end(const Bus *bus, DBusMessageIter *options, Entry *e)
{
    bus->dbus.message_iter_close_container(&e->entry, &e->value);
    bus->dbus.message_iter_close_container(options, &e->entry);
}

static void add_option(const Bus *bus, DBusMessageIter *options, const char *name, const char *text)
{
    Entry e;
    begin(bus, options, name, "s", &e);
    add_text(bus, &e.value, text);
    end(bus, options, &e);
}

/* Bytes of a path with terminating 0. */
static void add_path(const Bus *bus, DBusMessageIter *options, const char *name, const char *path)
{
    Entry e;
    DBusMessageIter bytes;
    begin(bus, options, name, "ay", &e);
    bus->dbus.message_iter_open_container(&e.value, DBUS_TYPE_ARRAY, "y", &bytes);
    bus->dbus.message_iter_append_fixed_array(&bytes, DBUS_TYPE_BYTE, &path, (int)strlen(path) + 1);
    bus->dbus.message_iter_close_container(&e.value, &bytes);
    end(bus, options, &e);
}

/* (s a(us)): name of the filter, and its patterns. */
static void add_filter(const Bus *bus, DBusMessageIter *filters, const char *called,
                       const char *const *endings)
{
    static const char *const any[] = { "", NULL };
    DBusMessageIter filter, patterns, pattern;
    bus->dbus.message_iter_open_container(filters, DBUS_TYPE_STRUCT, NULL, &filter);
    add_text(bus, &filter, called);
    bus->dbus.message_iter_open_container(&filter, DBUS_TYPE_ARRAY, "(us)", &patterns);
    for (const char *const *e = endings ? endings : any; *e; e++) {
        const dbus_uint32_t glob = 0;
        char text[64] = "*";
        if (endings) wr_portal_pattern(*e, text, sizeof text);
        bus->dbus.message_iter_open_container(&patterns, DBUS_TYPE_STRUCT, NULL, &pattern);
        bus->dbus.message_iter_append_basic(&pattern, DBUS_TYPE_UINT32, &glob);
        add_text(bus, &pattern, text);
        bus->dbus.message_iter_close_container(&patterns, &pattern);
    }
    bus->dbus.message_iter_close_container(&filter, &patterns);
    bus->dbus.message_iter_close_container(filters, &filter);
}

static void add_filters(const Bus *bus, DBusMessageIter *options, const WrPortalRequest *ask)
{
    Entry e;
    DBusMessageIter filters;
    begin(bus, options, "filters", "a(sa(us))", &e);
    bus->dbus.message_iter_open_container(&e.value, DBUS_TYPE_ARRAY, "(sa(us))", &filters);
    add_filter(bus, &filters, ask->kind, ask->endings);
    add_filter(bus, &filters, ask->all, NULL);
    bus->dbus.message_iter_close_container(&e.value, &filters);
    end(bus, options, &e);
}

static DBusMessage *question(const Bus *bus, const WrPortalRequest *ask, const char *token)
{
    DBusMessageIter at, options;
    DBusMessage *message = bus->dbus.message_new_method_call(DESKTOP, DESKTOP_PATH, CHOOSER,
                                                             ask->save ? "SaveFile" : "OpenFile");
    if (!message) return NULL;
    bus->dbus.message_iter_init_append(message, &at);
    add_text(bus, &at, ask->parent);
    add_text(bus, &at, ask->title);
    bus->dbus.message_iter_open_container(&at, DBUS_TYPE_ARRAY, "{sv}", &options);
    add_option(bus, &options, "handle_token", token);
    add_option(bus, &options, "accept_label", ask->accept);
    if (ask->endings) add_filters(bus, &options, ask);
    if (ask->folder[0] == '/') add_path(bus, &options, "current_folder", ask->folder);
    if (ask->save && ask->name[0]) add_option(bus, &options, "current_name", ask->name);
    bus->dbus.message_iter_close_container(&at, &options);
    return message;
}

/* ---- sequence of calls ---- */

static DBusMessage *call_bus(const Bus *bus, const char *what, const char *argument)
{
    DBusMessageIter at;
    DBusMessage *message = bus->dbus.message_new_method_call(BUS, BUS_PATH, BUS, what);
    if (!message || !argument) return message;
    bus->dbus.message_iter_init_append(message, &at);
    add_text(bus, &at, argument);
    return message;
}

static bool call_answered(Bus *bus, DBusMessage *message, double deadline, char *answer,
                          size_t size)
{
    DBusMessageIter at;
    DBusMessage *heard = message ? exchange(bus, message, deadline) : NULL;
    if (!heard) return false;
    if (answer && bus->dbus.message_iter_init(heard, &at))
        snprintf(answer, size, "%s", text_at(bus, &at));
    if (answer == bus->handle) {
        const char *sender = bus->dbus.message_get_sender(heard);
        snprintf(bus->portal, sizeof bus->portal, "%s", sender ? sender : "");
    }
    bus->dbus.message_unref(heard);
    return true;
}

/* Get our unique name, and subscribe to the answer and to the loss of the portal. */
static bool introduce(Bus *bus, const char *token, double deadline)
{
    char sender[64];
    static const char answers[] = "type='signal',interface='" REQUEST "',member='Response'";
    static const char ends[] = "type='signal',sender='" BUS "',interface='" BUS
                               "',member='NameOwnerChanged',arg0='" DESKTOP "'";
    if (!call_answered(bus, call_bus(bus, "Hello", NULL), deadline, bus->unique,
                       sizeof bus->unique))
        return false;
    snprintf(sender, sizeof sender, "%s", bus->unique[0] == ':' ? bus->unique + 1 : bus->unique);
    for (char *c = sender; *c; c++)
        if (*c == '.') *c = '_';
    snprintf(bus->handle, sizeof bus->handle, DESKTOP_PATH "/request/%s/%s", sender, token);
    return call_answered(bus, call_bus(bus, "AddMatch", answers), deadline, NULL, 0) &&
           call_answered(bus, call_bus(bus, "AddMatch", ends), deadline, NULL, 0);
}

static void close_request(const Bus *bus)
{
    DBusMessage *message =
        bus->dbus.message_new_method_call(DESKTOP, bus->handle, REQUEST, "Close");
    if (!message) return;
    bus->dbus.connection_send(bus->connection, message, NULL);
    bus->dbus.connection_flush(bus->connection);
    bus->dbus.message_unref(message);
}

static WrPortalEnd ask_bus(Bus *bus, const WrPortalRequest *ask)
{
    static volatile int count;
    char token[40];
    const double deadline = wr_clock_seconds() + ask->patience;
    snprintf(token, sizeof token, "wrinkle%ld_%d", (long)wr_process_id(),
             __atomic_add_fetch(&count, 1, __ATOMIC_RELAXED));
    if (!connect_to_bus(bus) || !introduce(bus, token, deadline)) return WR_PORTAL_NONE;
    /* Use the portal's name of the request, which differs from ours only in old portals. */
    if (!call_answered(bus, question(bus, ask, token), deadline, bus->handle, sizeof bus->handle)) {
        if (!bus->gone) close_request(bus); /* a late portal must not open a second dialog */
        return wr_cancel_requested(bus->stop) ? WR_PORTAL_CANCELLED : WR_PORTAL_NONE;
    }
    while (!bus->answered && !bus->gone && !wr_cancel_requested(bus->stop)) {
        DBusMessage *heard = next(bus, wr_clock_seconds() + 3600.0);
        if (!heard) continue;
        hear(bus, heard);
        bus->dbus.message_unref(heard);
    }
    if (bus->answered) return bus->end;
    if (wr_cancel_requested(bus->stop)) close_request(bus);
    return wr_cancel_requested(bus->stop) ? WR_PORTAL_CANCELLED : WR_PORTAL_NONE;
}

WrPortalEnd wr_portal_request(const WrPortalRequest *ask, const volatile int *stop, char *path,
                              size_t size)
{
    Bus bus = { .stop = stop, .path = path, .size = size };
    path[0] = '\0';
    if (!wr_portal_may_be() || !load(&bus.dbus)) return WR_PORTAL_NONE;
    const WrPortalEnd end = ask_bus(&bus, ask);
    if (bus.connection) {
        bus.dbus.connection_close(bus.connection);
        bus.dbus.connection_unref(bus.connection);
    }
    if (end != WR_PORTAL_CHOSE) path[0] = '\0';
    return end;
}
