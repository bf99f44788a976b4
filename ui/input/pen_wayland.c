/* Pens of Wayland's tablet protocol (tablet-unstable-v2), on SDL's connection.

   Events are read by SDL and wait in a queue of their own until wr_pen_wayland_update. SDL binds the protocol itself, for its mouse.
   Some compositors send a pen's events only to the newest binding, which is this one; then mouse events for the widgets
   are made here. */
#include "ui/input/pen_wayland.h"
#include "ui/input/pen_internal.h"

#include "base/array.h"
#include "base/memory.h"

#include <tablet-unstable-v2-client-protocol.h>

#include <SDL.h>
#include <SDL_syswm.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <wayland-client.h>

#define PRESSURE_MAX 65535.0
#define TILT_DEG 64.0 /* the tilt that counts as 1, as on X11 */
/* codes of linux/input-event-codes.h */
#define BARREL_FIRST 0x14b
#define BARREL_SECOND 0x14c
#define NEAR_SECONDS 0.004 /* intervals at which events are read that do not wake SDL */
#define FAR_SECONDS 0.03
#define ECHO_PIXELS 3.0

typedef struct Tablet {
    WrPenWayland *wayland;
    struct zwp_tablet_v2 *proxy;
    char name[64];
} Tablet;

typedef struct Tool {
    WrPenWayland *wayland;
    struct zwp_tablet_tool_v2 *proxy;
    const char *kind; /* "pen", "eraser", ...; NULL: not a pen */
    bool eraser, pressure, tilt, turn;
    int index; /* of the device; -1: not yet */
    bool near; /* over the window */
    WrPenReading now;
    /* since the last frame event */
    bool moved, leaves;
    unsigned pressed, released; /* bits of buttons */
} Tool;

typedef struct Seat {
    struct wl_seat *seat;
    struct zwp_tablet_seat_v2 *tablets; /* NULL: not yet */
} Seat;

struct WrPenWayland {
    WrPen *pen;
    struct wl_display *display; /* borrowed, as is: */
    struct wl_surface *surface;
    struct wl_event_queue *queue;
    struct wl_registry *registry;
    struct zwp_tablet_manager_v2 *manager; /* NULL: the compositor has none */
    WR_ARRAY(Seat) seats;
    WR_ARRAY(Tablet *) tablets; /* owned */
    WR_ARRAY(Tool *) tools;     /* owned */
    bool echoes;                /* SDL makes mouse events of the pen */
    bool updates;               /* inside wr_pen_wayland_update */
};

/* ---- devices ---- */

/* The device of a tool on a tablet: "Intuos pen". */
static void adopt(Tool *tool, const char *tablet)
{
    WrPen *pen = tool->wayland->pen;
    char name[96];
    if (!tool->kind) return;
    snprintf(name, sizeof name, "%.63s %s", tablet, tool->kind);
    tool->index = wr_pen_unit(pen, name, tool->eraser, false);
    WrPenUnit *unit = &pen->units.data[tool->index];
    unit->replayed = false;
    unit->shown.there = unit->shown.has_place = true;
    unit->shown.has_pressure = tool->pressure;
    unit->shown.has_tilt = tool->tilt;
    unit->shown.has_turn = tool->turn;
    unit->shown.pressure_low = 0.0;
    unit->shown.pressure_high = PRESSURE_MAX;
}

/* ---- mouse events for the widgets ---- */

static void push_mouse(const WrPenWayland *w, const WrPenReading *r)
{
    const Uint32 window = w->pen->window ? SDL_GetWindowID(w->pen->window) : 0;
    const int x = (int)floor(r->x), y = (int)floor(r->y);
    SDL_Event event = { .motion = { .type = SDL_MOUSEMOTION,
                                    .windowID = window,
                                    .which = WR_PEN_MOUSEID,
                                    .x = x,
                                    .y = y } };
    if (w->echoes) return;
    if (r->kind == WR_PEN_DOWN || r->kind == WR_PEN_UP) {
        if (r->button != 1) return;
        const bool down = r->kind == WR_PEN_DOWN;
        event.button =
            (SDL_MouseButtonEvent){ .type = down ? SDL_MOUSEBUTTONDOWN : SDL_MOUSEBUTTONUP,
                                    .windowID = window,
                                    .which = WR_PEN_MOUSEID,
                                    .button = SDL_BUTTON_LEFT,
                                    .state = down ? SDL_PRESSED : SDL_RELEASED,
                                    .clicks = 1,
                                    .x = x,
                                    .y = y };
    }
    SDL_PushEvent(&event);
}

/* ---- tools ---- */

static void feed(Tool *tool, WrPenKind kind, int button)
{
    WrPenReading r = tool->now;
    r.kind = kind;
    r.button = button;
    wr_pen_feed(tool->wayland->pen, tool->index, &r);
    push_mouse(tool->wayland, &r);
}

static void tool_type(void *data, struct zwp_tablet_tool_v2 *proxy, uint32_t type)
{
    Tool *tool = data;
    (void)proxy;
    tool->eraser = type == ZWP_TABLET_TOOL_V2_TYPE_ERASER;
    tool->kind = type == ZWP_TABLET_TOOL_V2_TYPE_PEN        ? "pen"
                 : type == ZWP_TABLET_TOOL_V2_TYPE_ERASER   ? "eraser"
                 : type == ZWP_TABLET_TOOL_V2_TYPE_BRUSH    ? "brush"
                 : type == ZWP_TABLET_TOOL_V2_TYPE_PENCIL   ? "pencil"
                 : type == ZWP_TABLET_TOOL_V2_TYPE_AIRBRUSH ? "airbrush"
                                                            : NULL;
}

static void tool_serial(void *data, struct zwp_tablet_tool_v2 *proxy, uint32_t high, uint32_t low)
{
    (void)data, (void)proxy, (void)high, (void)low;
}

static void tool_capability(void *data, struct zwp_tablet_tool_v2 *proxy, uint32_t capability)
{
    Tool *tool = data;
    (void)proxy;
    if (capability == ZWP_TABLET_TOOL_V2_CAPABILITY_PRESSURE) tool->pressure = true;
    if (capability == ZWP_TABLET_TOOL_V2_CAPABILITY_TILT) tool->tilt = true;
    if (capability == ZWP_TABLET_TOOL_V2_CAPABILITY_ROTATION) tool->turn = true;
}

static void tool_done(void *data, struct zwp_tablet_tool_v2 *proxy)
{
    Tool *tool = data;
    const WrPenWayland *w = tool->wayland;
    (void)proxy;
    adopt(tool, w->tablets.count > 0 ? w->tablets.data[0]->name : "tablet");
}

static void lose(Tool *tool)
{
    if (tool->index >= 0) wr_pen_lose(tool->wayland->pen, tool->index);
    tool->near = tool->moved = tool->leaves = false;
    tool->pressed = tool->released = 0;
}

static void tool_removed(void *data, struct zwp_tablet_tool_v2 *proxy)
{
    Tool *tool = data;
    WrPenWayland *w = tool->wayland;
    int kept = 0;
    lose(tool);
    if (tool->index >= 0) w->pen->units.data[tool->index].shown.there = false;
    for (int i = 0; i < w->tools.count; i++)
        if (w->tools.data[i] != tool) w->tools.data[kept++] = w->tools.data[i];
    w->tools.count = kept;
    zwp_tablet_tool_v2_destroy(proxy);
    wr_free(tool);
}

static void tool_proximity_in(void *data, struct zwp_tablet_tool_v2 *proxy, uint32_t serial,
                              struct zwp_tablet_v2 *tablet, struct wl_surface *surface)
{
    Tool *tool = data;
    (void)proxy, (void)serial;
    if (!tool->kind || surface != tool->wayland->surface) return;
    const Tablet *on = tablet ? zwp_tablet_v2_get_user_data(tablet) : NULL;
    adopt(tool, on ? on->name : "tablet");
    tool->near = true;
}

static void tool_proximity_out(void *data, struct zwp_tablet_tool_v2 *proxy)
{
    Tool *tool = data;
    (void)proxy;
    tool->leaves = tool->near;
}

static void tool_down(void *data, struct zwp_tablet_tool_v2 *proxy, uint32_t serial)
{
    (void)proxy, (void)serial;
    ((Tool *)data)->pressed |= 1u << 1;
}

static void tool_up(void *data, struct zwp_tablet_tool_v2 *proxy)
{
    (void)proxy;
    ((Tool *)data)->released |= 1u << 1;
}

/* Pixels of the window for one unit of the surface. */
static double pixels(const WrPenWayland *w)
{
    int units, wide;
    if (!w->pen->window) return 1.0;
    SDL_GetWindowSize(w->pen->window, &units, NULL);
    SDL_GetWindowSizeInPixels(w->pen->window, &wide, NULL);
    return units > 0 ? (double)wide / units : 1.0;
}

static void tool_motion(void *data, struct zwp_tablet_tool_v2 *proxy, wl_fixed_t x, wl_fixed_t y)
{
    Tool *tool = data;
    const double scale = pixels(tool->wayland);
    (void)proxy;
    tool->now.x = wl_fixed_to_double(x) * scale;
    tool->now.y = wl_fixed_to_double(y) * scale;
    tool->moved = true;
}

static void tool_pressure(void *data, struct zwp_tablet_tool_v2 *proxy, uint32_t pressure)
{
    Tool *tool = data;
    (void)proxy;
    tool->now.pressure = pressure;
    tool->moved = true;
}

static void tool_distance(void *data, struct zwp_tablet_tool_v2 *proxy, uint32_t distance)
{
    (void)data, (void)proxy, (void)distance;
}

static double tilt_of(wl_fixed_t degrees)
{
    return fmin(1.0, fmax(-1.0, wl_fixed_to_double(degrees) / TILT_DEG));
}

static void tool_tilt(void *data, struct zwp_tablet_tool_v2 *proxy, wl_fixed_t x, wl_fixed_t y)
{
    Tool *tool = data;
    (void)proxy;
    tool->now.tilt_x = tilt_of(x);
    tool->now.tilt_y = tilt_of(y);
    tool->moved = true;
}

static void tool_rotation(void *data, struct zwp_tablet_tool_v2 *proxy, wl_fixed_t degrees)
{
    Tool *tool = data;
    (void)proxy;
    tool->now.turn_deg = wl_fixed_to_double(degrees);
    tool->moved = true;
}

static void tool_slider(void *data, struct zwp_tablet_tool_v2 *proxy, int32_t position)
{
    (void)data, (void)proxy, (void)position;
}

static void tool_wheel(void *data, struct zwp_tablet_tool_v2 *proxy, wl_fixed_t degrees,
                       int32_t clicks)
{
    (void)data, (void)proxy, (void)degrees, (void)clicks;
}

static void tool_button(void *data, struct zwp_tablet_tool_v2 *proxy, uint32_t serial,
                        uint32_t button, uint32_t state)
{
    Tool *tool = data;
    (void)proxy, (void)serial;
    const unsigned bit = button == BARREL_FIRST ? 1u << 2 : button == BARREL_SECOND ? 1u << 3 : 0;
    if (state == ZWP_TABLET_TOOL_V2_BUTTON_STATE_PRESSED) tool->pressed |= bit;
    else tool->released |= bit;
}

/* The events of a frame happened at the same time. */
static void tool_frame(void *data, struct zwp_tablet_tool_v2 *proxy, uint32_t time)
{
    Tool *tool = data;
    (void)proxy;
    if (tool->near) {
        WrPenUnit *unit = &tool->wayland->pen->units.data[tool->index];
        tool->now.seconds = wr_pen_seconds(unit, time);
        for (int b = 1; b <= WR_PEN_BUTTONS; b++)
            if (tool->released & 1u << b) feed(tool, WR_PEN_UP, b);
        if (tool->moved && !tool->pressed && !tool->released) feed(tool, WR_PEN_MOTION, 0);
        for (int b = 1; b <= WR_PEN_BUTTONS; b++)
            if (tool->pressed & 1u << b) feed(tool, WR_PEN_DOWN, b);
    }
    tool->moved = false;
    tool->pressed = tool->released = 0;
    if (tool->leaves) lose(tool);
}

static const struct zwp_tablet_tool_v2_listener tool_listener = {
    .type = tool_type,
    .hardware_serial = tool_serial,
    .hardware_id_wacom = tool_serial,
    .capability = tool_capability,
    .done = tool_done,
    .removed = tool_removed,
    .proximity_in = tool_proximity_in,
    .proximity_out = tool_proximity_out,
    .down = tool_down,
    .up = tool_up,
    .motion = tool_motion,
    .pressure = tool_pressure,
    .distance = tool_distance,
    .tilt = tool_tilt,
    .rotation = tool_rotation,
    .slider = tool_slider,
    .wheel = tool_wheel,
    .button = tool_button,
    .frame = tool_frame,
};

/* ---- tablets ---- */

static void tablet_name(void *data, struct zwp_tablet_v2 *proxy, const char *name)
{
    (void)proxy;
    SDL_strlcpy(((Tablet *)data)->name, name, sizeof((Tablet *)data)->name);
}

static void tablet_id(void *data, struct zwp_tablet_v2 *proxy, uint32_t vendor, uint32_t product)
{
    (void)data, (void)proxy, (void)vendor, (void)product;
}

static void tablet_path(void *data, struct zwp_tablet_v2 *proxy, const char *path)
{
    (void)data, (void)proxy, (void)path;
}

static void tablet_done(void *data, struct zwp_tablet_v2 *proxy)
{
    (void)data, (void)proxy;
}

static void tablet_removed(void *data, struct zwp_tablet_v2 *proxy)
{
    Tablet *tablet = data;
    WrPenWayland *w = tablet->wayland;
    int kept = 0;
    for (int i = 0; i < w->tablets.count; i++)
        if (w->tablets.data[i] != tablet) w->tablets.data[kept++] = w->tablets.data[i];
    w->tablets.count = kept;
    zwp_tablet_v2_destroy(proxy);
    wr_free(tablet);
}

static const struct zwp_tablet_v2_listener tablet_listener = { .name = tablet_name,
                                                               .id = tablet_id,
                                                               .path = tablet_path,
                                                               .done = tablet_done,
                                                               .removed = tablet_removed };

/* ---- seats ---- */

static void seat_tablet(void *data, struct zwp_tablet_seat_v2 *seat, struct zwp_tablet_v2 *proxy)
{
    WrPenWayland *w = data;
    Tablet *tablet = wr_alloc(1, sizeof *tablet);
    (void)seat;
    *tablet = (Tablet){ .wayland = w, .proxy = proxy, .name = "tablet" };
    wr_array_push(&w->tablets, tablet);
    zwp_tablet_v2_add_listener(proxy, &tablet_listener, tablet);
}

static void seat_tool(void *data, struct zwp_tablet_seat_v2 *seat, struct zwp_tablet_tool_v2 *proxy)
{
    WrPenWayland *w = data;
    Tool *tool = wr_alloc(1, sizeof *tool);
    (void)seat;
    *tool = (Tool){ .wayland = w, .proxy = proxy, .index = -1 };
    wr_array_push(&w->tools, tool);
    zwp_tablet_tool_v2_add_listener(proxy, &tool_listener, tool);
}

static void seat_pad(void *data, struct zwp_tablet_seat_v2 *seat, struct zwp_tablet_pad_v2 *proxy)
{
    (void)data, (void)seat;
    zwp_tablet_pad_v2_destroy(proxy); /* its buttons are keys of the desktop's settings */
}

static const struct zwp_tablet_seat_v2_listener seat_listener = { .tablet_added = seat_tablet,
                                                                  .tool_added = seat_tool,
                                                                  .pad_added = seat_pad };

/* The manager and the seats are announced in any order. */
static void follow_seats(WrPenWayland *w)
{
    for (int i = 0; w->manager && i < w->seats.count; i++) {
        Seat *seat = &w->seats.data[i];
        if (seat->tablets) continue;
        seat->tablets = zwp_tablet_manager_v2_get_tablet_seat(w->manager, seat->seat);
        zwp_tablet_seat_v2_add_listener(seat->tablets, &seat_listener, w);
    }
}

static void global_added(void *data, struct wl_registry *registry, uint32_t name,
                         const char *interface, uint32_t version)
{
    WrPenWayland *w = data;
    (void)version;
    if (strcmp(interface, zwp_tablet_manager_v2_interface.name) == 0 && !w->manager)
        w->manager = wl_registry_bind(registry, name, &zwp_tablet_manager_v2_interface, 1);
    if (strcmp(interface, wl_seat_interface.name) == 0)
        wr_array_push(&w->seats,
                      ((Seat){ wl_registry_bind(registry, name, &wl_seat_interface, 1), NULL }));
    follow_seats(w);
}

static void global_removed(void *data, struct wl_registry *registry, uint32_t name)
{
    (void)data, (void)registry, (void)name; /* tools report their own removal */
}

static const struct wl_registry_listener registry_listener = { global_added, global_removed };

/* ---- creation ---- */

WrPenWayland *wr_pen_wayland_open(WrPen *pen, struct wl_display *display,
                                  struct wl_surface *surface)
{
    WrPenWayland *w = wr_alloc(1, sizeof *w);
    w->pen = pen;
    w->display = display;
    w->surface = surface;
    w->queue = wl_display_create_queue(display);
    struct wl_display *wrapper = w->queue ? wl_proxy_create_wrapper(display) : NULL;
    if (wrapper) {
        wl_proxy_set_queue((struct wl_proxy *)wrapper, w->queue);
        w->registry = wl_display_get_registry(wrapper);
        wl_proxy_wrapper_destroy(wrapper);
    }
    if (w->registry) {
        wl_registry_add_listener(w->registry, &registry_listener, w);
        wl_display_roundtrip_queue(display, w->queue);                 /* the seats, */
        if (w->manager) wl_display_roundtrip_queue(display, w->queue); /* and their tools */
    }
    if (w->manager) return w;
    wr_pen_wayland_free(w);
    return NULL;
}

WrPenWayland *wr_pen_wayland_new(WrPen *pen, const char **why)
{
    SDL_SysWMinfo info;
    SDL_VERSION(&info.version);
    if (!SDL_GetWindowWMInfo(pen->window, &info) || info.subsystem != SDL_SYSWM_WAYLAND)
        return NULL;
    WrPenWayland *w = wr_pen_wayland_open(pen, info.info.wl.display, info.info.wl.surface);
    if (!w)
        *why = "This desktop does not pass tablets on to programs (zwp_tablet_manager_v2), so pens "
               "act as mice.";
    return w;
}

void wr_pen_wayland_free(WrPenWayland *w)
{
    if (!w) return;
    for (int i = 0; i < w->tools.count; i++) {
        zwp_tablet_tool_v2_destroy(w->tools.data[i]->proxy);
        wr_free(w->tools.data[i]);
    }
    for (int i = 0; i < w->tablets.count; i++) {
        zwp_tablet_v2_destroy(w->tablets.data[i]->proxy);
        wr_free(w->tablets.data[i]);
    }
    for (int i = 0; i < w->seats.count; i++) {
        if (w->seats.data[i].tablets) zwp_tablet_seat_v2_destroy(w->seats.data[i].tablets);
        wl_seat_destroy(w->seats.data[i].seat);
    }
    if (w->manager) zwp_tablet_manager_v2_destroy(w->manager);
    if (w->registry) wl_registry_destroy(w->registry);
    if (w->queue) wl_event_queue_destroy(w->queue);
    wr_array_free(&w->tools);
    wr_array_free(&w->tablets);
    wr_array_free(&w->seats);
    wr_free(w);
}

/* ---- events ---- */

void wr_pen_wayland_update(WrPenWayland *w)
{
    if (w->updates) return; /* by an event that is pushed there */
    w->updates = true;
    wl_display_dispatch_queue_pending(w->display, w->queue);
    w->updates = false;
}

static bool is_near(const WrPenWayland *w)
{
    for (int i = 0; i < w->tools.count; i++)
        if (w->tools.data[i]->near) return true;
    return false;
}

void wr_pen_wayland_mouse(WrPenWayland *w, const SDL_MouseMotionEvent *event)
{
    for (int i = 0; i < w->tools.count && event->which != WR_PEN_MOUSEID; i++) {
        const Tool *tool = w->tools.data[i];
        if (tool->near && hypot(event->x - tool->now.x, event->y - tool->now.y) < ECHO_PIXELS)
            w->echoes = true;
    }
}

double wr_pen_wayland_wait(const WrPenWayland *w)
{
    if (w->tools.count == 0 || w->echoes) return 0.0; /* SDL's own events wake the main loop */
    return is_near(w) ? NEAR_SECONDS : FAR_SECONDS;
}
