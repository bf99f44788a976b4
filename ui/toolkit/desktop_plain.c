/* No desktop of X: what a system gets that nobody has written a file for, in the place of desktop_x11.c. */
#include "ui/toolkit/desktop.h"

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
