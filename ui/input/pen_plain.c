/* Fallback for pen_x11.c on other systems: no pens. Fingers come through SDL; the system presents a pen as a mouse
   without pressure. */
#include "ui/input/pen_internal.h"

WrPenX11 *wr_pen_x11_new(WrPen *pen, const char **why)
{
    (void)pen;
    *why = "This build does not support this system's tablets, so pens act as mice.";
    return NULL;
}

void wr_pen_x11_free(WrPenX11 *x11)
{
    (void)x11;
}

void wr_pen_x11_sync(WrPenX11 *x11)
{
    (void)x11;
}

void wr_pen_x11_event(WrPen *pen, const SDL_Event *event)
{
    (void)pen;
    (void)event;
}
