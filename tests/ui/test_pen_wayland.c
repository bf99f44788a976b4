/* Pens of Wayland's tablet protocol: a compositor of this test, in a thread of its own, plays a tablet; the window's reader
   is its client over a pair of sockets. */
#include "test.h"

#include "ui/input/pen_internal.h"
#include "ui/input/pen_wayland.h"

#include <tablet-unstable-v2-server-protocol.h>

#include <pthread.h>
#include <sys/socket.h>
#include <wayland-client.h>
#include <wayland-server.h>

/* ---- the compositor ---- */

typedef struct Server {
    struct wl_display *display;
    struct wl_client *client;
    struct wl_resource *tablet_seat, *tablet, *tools[2];
    struct wl_resource *surfaces[2]; /* in order of creation */
    int surface_count;
    uint32_t serial;
    void (*work)(void); /* to be run by the thread; NULL: none */
    bool stop;
    pthread_mutex_t lock;
    pthread_cond_t done;
    pthread_t thread;
} Server;

static Server server;

static void destroy(struct wl_client *client, struct wl_resource *resource)
{
    (void)client;
    wl_resource_destroy(resource);
}

static const struct wl_surface_interface surface_calls = { .destroy = destroy };

static void create_surface(struct wl_client *client, struct wl_resource *compositor, uint32_t id)
{
    (void)compositor;
    struct wl_resource *made = wl_resource_create(client, &wl_surface_interface, 1, id);
    wl_resource_set_implementation(made, &surface_calls, NULL, NULL);
    server.surfaces[server.surface_count++] = made;
}

static const struct wl_compositor_interface compositor_calls = { .create_surface = create_surface };

static void bind_compositor(struct wl_client *client, void *data, uint32_t version, uint32_t id)
{
    (void)data, (void)version;
    struct wl_resource *made = wl_resource_create(client, &wl_compositor_interface, 1, id);
    wl_resource_set_implementation(made, &compositor_calls, NULL, NULL);
}

static void bind_seat(struct wl_client *client, void *data, uint32_t version, uint32_t id)
{
    (void)data, (void)version;
    struct wl_resource *made = wl_resource_create(client, &wl_seat_interface, 1, id);
    wl_resource_set_implementation(made, NULL, NULL, NULL);
}

static const struct zwp_tablet_seat_v2_interface tablet_seat_calls = { destroy };
static const struct zwp_tablet_v2_interface tablet_calls = { destroy };
static const struct zwp_tablet_tool_v2_interface tool_calls = { .destroy = destroy };

static struct wl_resource *add_tool(struct wl_client *client, uint32_t type, bool turns)
{
    struct wl_resource *tool = wl_resource_create(client, &zwp_tablet_tool_v2_interface, 1, 0);
    wl_resource_set_implementation(tool, &tool_calls, NULL, NULL);
    zwp_tablet_seat_v2_send_tool_added(server.tablet_seat, tool);
    zwp_tablet_tool_v2_send_type(tool, type);
    zwp_tablet_tool_v2_send_hardware_serial(tool, 1, 2);
    zwp_tablet_tool_v2_send_capability(tool, ZWP_TABLET_TOOL_V2_CAPABILITY_PRESSURE);
    zwp_tablet_tool_v2_send_capability(tool, ZWP_TABLET_TOOL_V2_CAPABILITY_TILT);
    zwp_tablet_tool_v2_send_capability(tool, ZWP_TABLET_TOOL_V2_CAPABILITY_DISTANCE);
    if (turns) zwp_tablet_tool_v2_send_capability(tool, ZWP_TABLET_TOOL_V2_CAPABILITY_ROTATION);
    zwp_tablet_tool_v2_send_done(tool);
    return tool;
}

static void get_tablet_seat(struct wl_client *client, struct wl_resource *manager, uint32_t id,
                            struct wl_resource *seat)
{
    (void)manager, (void)seat;
    server.tablet_seat = wl_resource_create(client, &zwp_tablet_seat_v2_interface, 1, id);
    wl_resource_set_implementation(server.tablet_seat, &tablet_seat_calls, NULL, NULL);
    server.tablet = wl_resource_create(client, &zwp_tablet_v2_interface, 1, 0);
    wl_resource_set_implementation(server.tablet, &tablet_calls, NULL, NULL);
    zwp_tablet_seat_v2_send_tablet_added(server.tablet_seat, server.tablet);
    zwp_tablet_v2_send_name(server.tablet, "Test tablet");
    zwp_tablet_v2_send_id(server.tablet, 0x56a, 0x315);
    zwp_tablet_v2_send_done(server.tablet);
    server.tools[0] = add_tool(client, ZWP_TABLET_TOOL_V2_TYPE_PEN, true);
    server.tools[1] = add_tool(client, ZWP_TABLET_TOOL_V2_TYPE_ERASER, false);
    add_tool(client, ZWP_TABLET_TOOL_V2_TYPE_MOUSE, false);
}

static const struct zwp_tablet_manager_v2_interface manager_calls = { get_tablet_seat, destroy };

static void bind_manager(struct wl_client *client, void *data, uint32_t version, uint32_t id)
{
    (void)data, (void)version;
    struct wl_resource *made = wl_resource_create(client, &zwp_tablet_manager_v2_interface, 1, id);
    wl_resource_set_implementation(made, &manager_calls, NULL, NULL);
}

static void *serve(void *arg)
{
    (void)arg;
    for (;;) {
        wl_event_loop_dispatch(wl_display_get_event_loop(server.display), 2);
        pthread_mutex_lock(&server.lock);
        if (server.work) server.work();
        server.work = NULL;
        const bool stop = server.stop;
        pthread_cond_signal(&server.done);
        pthread_mutex_unlock(&server.lock);
        if (stop) return NULL;
        wl_display_flush_clients(server.display);
    }
}

static void on_server(void (*work)(void))
{
    pthread_mutex_lock(&server.lock);
    server.work = work;
    while (server.work) pthread_cond_wait(&server.done, &server.lock);
    pthread_mutex_unlock(&server.lock);
}

/* ---- the client ---- */

typedef enum Globals { SEAT_FIRST, MANAGER_FIRST, NO_MANAGER } Globals;

typedef struct Client {
    struct wl_display *display;
    struct wl_registry *registry;
    struct wl_compositor *compositor;
    struct wl_surface *window, *other;
    WrPen *pen;
} Client;

static void global(void *data, struct wl_registry *registry, uint32_t name, const char *interface,
                   uint32_t version)
{
    Client *client = data;
    (void)version;
    if (strcmp(interface, "wl_compositor") == 0)
        client->compositor = wl_registry_bind(registry, name, &wl_compositor_interface, 1);
}

static void global_gone(void *data, struct wl_registry *registry, uint32_t name)
{
    (void)data, (void)registry, (void)name;
}

static const struct wl_registry_listener listener = { global, global_gone };

static void begin(Client *client, Globals globals)
{
    int ends[2];
    server = (Server){ .display = wl_display_create() };
    pthread_mutex_init(&server.lock, NULL);
    pthread_cond_init(&server.done, NULL);
    wl_global_create(server.display, &wl_compositor_interface, 1, NULL, bind_compositor);
    if (globals == SEAT_FIRST)
        wl_global_create(server.display, &wl_seat_interface, 1, NULL, bind_seat);
    if (globals != NO_MANAGER)
        wl_global_create(server.display, &zwp_tablet_manager_v2_interface, 1, NULL, bind_manager);
    if (globals != SEAT_FIRST)
        wl_global_create(server.display, &wl_seat_interface, 1, NULL, bind_seat);
    assert_int_equal(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends), 0);
    server.client = wl_client_create(server.display, ends[0]);
    assert_int_equal(pthread_create(&server.thread, NULL, serve, NULL), 0);
    *client = (Client){ .display = wl_display_connect_to_fd(ends[1]), .pen = wr_pen_new(NULL) };
    assert_non_null(client->display);
    client->registry = wl_display_get_registry(client->display);
    wl_registry_add_listener(client->registry, &listener, client);
    wl_display_roundtrip(client->display);
    client->window = wl_compositor_create_surface(client->compositor);
    client->other = wl_compositor_create_surface(client->compositor);
    client->pen->wayland = wr_pen_wayland_open(client->pen, client->display, client->window);
}

static void finish(Client *client)
{
    wr_pen_free(client->pen);
    wl_surface_destroy(client->window);
    wl_surface_destroy(client->other);
    wl_compositor_destroy(client->compositor);
    wl_registry_destroy(client->registry);
    wl_display_disconnect(client->display);
    pthread_mutex_lock(&server.lock);
    server.stop = true;
    pthread_mutex_unlock(&server.lock);
    pthread_join(server.thread, NULL);
    wl_display_destroy_clients(server.display);
    wl_display_destroy(server.display);
}

/* The compositor does that, and the client reads as SDL does. */
static void after(Client *client, void (*work)(void))
{
    on_server(work);
    wl_display_roundtrip(client->display);
}

static WrPenEvent next(Client *client)
{
    WrPenEvent event = { 0 };
    assert_true(wr_pen_next(client->pen, &event));
    return event;
}

static void nothing_more(Client *client)
{
    WrPenEvent event;
    assert_false(wr_pen_next(client->pen, &event));
}

/* ---- motions of tools ---- */

static void enter(struct wl_resource *tool, int surface)
{
    zwp_tablet_tool_v2_send_proximity_in(tool, ++server.serial, server.tablet,
                                         server.surfaces[surface]);
}

static void place(struct wl_resource *tool, double x, double y, uint32_t pressure)
{
    zwp_tablet_tool_v2_send_motion(tool, wl_fixed_from_double(x), wl_fixed_from_double(y));
    zwp_tablet_tool_v2_send_pressure(tool, pressure);
}

static void a_stroke(void)
{
    static uint32_t time = 1000;
    struct wl_resource *tool = server.tools[0];
    time += 100;
    enter(tool, 0);
    place(tool, 100.25, 50.5, 0);
    zwp_tablet_tool_v2_send_tilt(tool, wl_fixed_from_double(32), wl_fixed_from_double(-16));
    zwp_tablet_tool_v2_send_rotation(tool, wl_fixed_from_double(350));
    zwp_tablet_tool_v2_send_frame(tool, time);
    zwp_tablet_tool_v2_send_down(tool, ++server.serial);
    zwp_tablet_tool_v2_send_pressure(tool, 13107); /* a fifth */
    zwp_tablet_tool_v2_send_frame(tool, time + 8);
    place(tool, 110, 51, 65535);
    zwp_tablet_tool_v2_send_tilt(tool, wl_fixed_from_double(80), wl_fixed_from_double(0));
    zwp_tablet_tool_v2_send_rotation(tool, wl_fixed_from_double(90));
    zwp_tablet_tool_v2_send_frame(tool, time + 16);
    zwp_tablet_tool_v2_send_up(tool);
    zwp_tablet_tool_v2_send_pressure(tool, 0);
    zwp_tablet_tool_v2_send_frame(tool, time + 24);
    zwp_tablet_tool_v2_send_proximity_out(tool);
    zwp_tablet_tool_v2_send_frame(tool, time + 32);
}

static void check_stroke(Client *client)
{
    WrPenEvent e = next(client);
    assert_int_equal(e.kind, WR_PEN_MOTION);
    assert_true(e.x == 100.25 && e.y == 50.5 && e.tilt_x == 0.5 && e.tilt_y == -0.25);
    assert_true(e.turn_deg == -10.0 && e.raw == 0.0 && e.held == 0);
    assert_false(e.eraser);
    const double began = e.seconds;
    e = next(client);
    assert_int_equal(e.kind, WR_PEN_DOWN);
    assert_int_equal(e.button, 1);
    assert_near(e.raw, 0.2, 1e-15);
    assert_near(e.seconds - began, 0.008, 1e-9);
    assert_true(e.x == 100.25 && e.held == 2);
    e = next(client);
    assert_int_equal(e.kind, WR_PEN_MOTION);
    assert_true(e.x == 110 && e.y == 51 && e.raw == 1.0 && e.held == 2);
    assert_true(e.tilt_x == 1.0 && e.tilt_y == 0.0 && e.turn_deg == 90.0);
    e = next(client);
    assert_int_equal(e.kind, WR_PEN_UP);
    assert_true(e.held == 0 && e.raw == 0.0);
    assert_near(e.seconds - began, 0.024, 1e-9);
    nothing_more(client);
}

static void a_pen_has_its_values(void **state)
{
    (void)state;
    for (int globals = SEAT_FIRST; globals <= MANAGER_FIRST; globals++) {
        Client client;
        begin(&client, (Globals)globals);
        assert_non_null(client.pen->wayland);
        assert_int_equal(wr_pen_device_count(client.pen), 2); /* without the puck */
        const WrPenDevice *d = wr_pen_device(client.pen, 0);
        assert_string_equal(d->name, "Test tablet pen");
        assert_true(d->there && d->has_place && d->has_pressure && d->has_tilt && d->has_turn);
        d = wr_pen_device(client.pen, 1);
        assert_string_equal(d->name, "Test tablet eraser");
        assert_true(d->eraser && !d->has_turn);
        after(&client, a_stroke);
        check_stroke(&client);
        assert_int_equal(wr_pen_device(client.pen, 0)->bad_values, 0);
        finish(&client);
    }
}

static void erase_elsewhere(void)
{
    enter(server.tools[1], 1); /* another surface */
    place(server.tools[1], 5, 5, 100);
    zwp_tablet_tool_v2_send_down(server.tools[1], ++server.serial);
    zwp_tablet_tool_v2_send_frame(server.tools[1], 5);
    zwp_tablet_tool_v2_send_up(server.tools[1]);
    zwp_tablet_tool_v2_send_proximity_out(server.tools[1]);
    zwp_tablet_tool_v2_send_frame(server.tools[1], 6);
}

static void erase(void)
{
    enter(server.tools[1], 0);
    place(server.tools[1], 5, 6, 65535);
    zwp_tablet_tool_v2_send_down(server.tools[1], ++server.serial);
    zwp_tablet_tool_v2_send_frame(server.tools[1], 7);
}

static void leave(void)
{
    zwp_tablet_tool_v2_send_proximity_out(server.tools[1]);
    zwp_tablet_tool_v2_send_frame(server.tools[1], 8);
}

static void unplug(void)
{
    zwp_tablet_tool_v2_send_removed(server.tools[1]);
    zwp_tablet_v2_send_removed(server.tablet);
}

static void an_eraser_works_over_the_window_alone_and_ends_when_it_leaves(void **state)
{
    (void)state;
    Client client;
    begin(&client, SEAT_FIRST);
    after(&client, erase_elsewhere);
    nothing_more(&client);
    after(&client, erase);
    WrPenEvent e = next(&client);
    assert_int_equal(e.kind, WR_PEN_DOWN);
    assert_true(e.eraser && e.x == 5 && e.y == 6 && e.raw == 1.0);
    after(&client, leave);
    assert_int_equal(next(&client).kind, WR_PEN_LOST);
    after(&client, erase);
    assert_int_equal(next(&client).kind, WR_PEN_DOWN);
    after(&client, unplug);
    assert_int_equal(next(&client).kind, WR_PEN_LOST);
    nothing_more(&client);
    assert_false(wr_pen_device(client.pen, 1)->there);
    assert_true(wr_pen_device(client.pen, 0)->there);
    finish(&client);
}

static void press_buttons(void)
{
    static const uint32_t codes[] = { 0x14b, 0x14c, 0x149 }; /* the third is none of ours */
    struct wl_resource *tool = server.tools[0];
    enter(tool, 0);
    for (int i = 0; i < 3; i++) {
        zwp_tablet_tool_v2_send_button(tool, ++server.serial, codes[i], 1);
        zwp_tablet_tool_v2_send_frame(tool, 10 + i);
    }
    for (int i = 0; i < 3; i++) zwp_tablet_tool_v2_send_button(tool, ++server.serial, codes[i], 0);
    zwp_tablet_tool_v2_send_frame(tool, 20);
}

static void the_buttons_on_the_barrel_are_2_and_3(void **state)
{
    (void)state;
    Client client;
    begin(&client, SEAT_FIRST);
    after(&client, press_buttons);
    for (int up = 0; up < 2; up++)
        for (int button = 2; button <= 3; button++) {
            const WrPenEvent e = next(&client);
            assert_int_equal(e.kind, up ? WR_PEN_UP : WR_PEN_DOWN);
            assert_int_equal(e.button, button);
        }
    nothing_more(&client);
    finish(&client);
}

#define MANY 20000

static void move_a_lot(void)
{
    static int sent;
    for (int i = 0; i < 200; i++, sent++) {
        place(server.tools[0], sent % 4000, sent / 4000, (uint32_t)(sent % 65536));
        zwp_tablet_tool_v2_send_frame(server.tools[0], (uint32_t)(100 + sent));
    }
}

static void none_of_many_events_is_lost(void **state)
{
    (void)state;
    Client client;
    begin(&client, SEAT_FIRST);
    after(&client, press_buttons);
    for (int i = 0; i < 4; i++) next(&client);
    for (int i = 0; i < MANY / 200; i++) {
        after(&client, move_a_lot);
        if (i % 7 == 0) wr_pen_wayland_update(client.pen->wayland);
    }
    for (int i = 0; i < MANY; i++) {
        const WrPenEvent e = next(&client);
        assert_int_equal(e.kind, WR_PEN_MOTION);
        assert_true(e.x == i % 4000 && e.y == i / 4000);
        assert_near(e.raw, (i % 65536) / 65535.0, 1e-15);
    }
    nothing_more(&client);
    finish(&client);
}

/* Mouse events of the pen, for widgets. */
static int mice(void)
{
    SDL_Event event;
    int count = 0;
    while (SDL_PeepEvents(&event, 1, SDL_GETEVENT, SDL_MOUSEMOTION, SDL_MOUSEBUTTONUP) > 0)
        count += event.motion.which == WR_PEN_MOUSEID;
    return count;
}

static void widgets_get_a_mouse_unless_sdl_makes_one(void **state)
{
    (void)state;
    Client client;
    assert_int_equal(SDL_InitSubSystem(SDL_INIT_EVENTS), 0);
    begin(&client, SEAT_FIRST);
    after(&client, a_stroke);
    check_stroke(&client);
    assert_int_equal(mice(), 4);
    assert_true(wr_pen_wait(client.pen) > 0.0);
    after(&client, press_buttons); /* near, at 110, 51 */
    for (int i = 0; i < 4; i++) next(&client);
    const SDL_MouseMotionEvent far = { .x = 300, .y = 51 }, echo = { .x = 110, .y = 51 };
    mice();
    wr_pen_wayland_mouse(client.pen->wayland, &far); /* a real mouse */
    after(&client, a_stroke);
    check_stroke(&client);
    assert_int_equal(mice(), 4);
    after(&client, press_buttons);
    for (int i = 0; i < 4; i++) next(&client);
    wr_pen_wayland_mouse(client.pen->wayland, &echo);
    after(&client, a_stroke);
    check_stroke(&client);
    assert_int_equal(mice(), 0);
    assert_true(wr_pen_wait(client.pen) == 0.0);
    finish(&client);
    SDL_QuitSubSystem(SDL_INIT_EVENTS);
}

static void without_the_protocol_there_are_no_pens(void **state)
{
    (void)state;
    Client client;
    begin(&client, NO_MANAGER);
    assert_null(client.pen->wayland);
    nothing_more(&client);
    finish(&client);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_pen_has_its_values),
        cmocka_unit_test(an_eraser_works_over_the_window_alone_and_ends_when_it_leaves),
        cmocka_unit_test(the_buttons_on_the_barrel_are_2_and_3),
        cmocka_unit_test(none_of_many_events_is_lost),
        cmocka_unit_test(widgets_get_a_mouse_unless_sdl_makes_one),
        cmocka_unit_test(without_the_protocol_there_are_no_pens),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
