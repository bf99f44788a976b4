/* Fallback for pen_wayland.c where the tablet protocol is missing: no pens. */
#include "ui/input/pen_wayland.h"

#include <stddef.h>

WrPenWayland *wr_pen_wayland_new(WrPen *pen, const char **why)
{
    (void)pen, (void)why;
    return NULL;
}

void wr_pen_wayland_free(WrPenWayland *wayland)
{
    (void)wayland;
}

void wr_pen_wayland_update(WrPenWayland *wayland)
{
    (void)wayland;
}

void wr_pen_wayland_mouse(WrPenWayland *wayland, const SDL_MouseMotionEvent *event)
{
    (void)wayland, (void)event;
}

double wr_pen_wayland_wait(const WrPenWayland *wayland)
{
    (void)wayland;
    return 0.0;
}
