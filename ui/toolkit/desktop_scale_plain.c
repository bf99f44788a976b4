/* Fallback for desktop_scale_x11.c on systems without X. */
#include "ui/toolkit/desktop_scale.h"

double wr_desktop_dpi(SDL_Window *window)
{
    (void)window;
    return 0;
}

unsigned long wr_desktop_window(SDL_Window *window)
{
    (void)window;
    return 0;
}
