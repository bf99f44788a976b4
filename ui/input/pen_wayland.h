/* pen_wayland.h - pens of Wayland's tablet protocol, on SDL's connection. Private to the pen files, and to tests. */
#pragma once
#include <SDL.h>

typedef struct WrPen WrPen;
typedef struct WrPenWayland WrPenWayland;

/* NULL: the window is not on Wayland, or there are no pens; then *why is a sentence with the reason. */
WrPenWayland *wr_pen_wayland_new(WrPen *pen, const char **why);
/* For a surface of a connection; both are borrowed. NULL: the compositor has no tablet protocol. */
struct wl_display;
struct wl_surface;
WrPenWayland *wr_pen_wayland_open(WrPen *pen, struct wl_display *display,
                                  struct wl_surface *surface);
void wr_pen_wayland_free(WrPenWayland *wayland); /* NULL is allowed */
/* Move the events that were read from the connection to the pen's queue. */
void wr_pen_wayland_update(WrPenWayland *wayland);
/* SDL reported a mouse event: at the place of a pen that is near, it is made of the pen's. */
void wr_pen_wayland_mouse(WrPenWayland *wayland, const SDL_MouseMotionEvent *event);
/* Seconds after which the connection must be read again; 0: not before SDL's next event. */
double wr_pen_wayland_wait(const WrPenWayland *wayland);
