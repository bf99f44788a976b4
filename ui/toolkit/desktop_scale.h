/* desktop_scale.h - scale of the desktop, and the system's identifier of a window. */
#pragma once
#include <SDL.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Dots per inch set by the desktop, 96 for normal size; 0: unknown. Read from XSETTINGS (Xft/DPI), else from the
   server's resources (Xft.dpi). */
double wr_desktop_dpi(SDL_Window *window);

/* The X server's number of the window; 0: none, as under Wayland. */
unsigned long wr_desktop_window(SDL_Window *window);

/* Dots per inch in an _XSETTINGS_SETTINGS property, and in lines of resources. Both come from other programs; 0 if
   they are damaged, lack the value or contain an implausible one (outside 48..768). */
double wr_desktop_dpi_of_settings(const unsigned char *bytes, size_t count);
double wr_desktop_dpi_of_resources(const char *text);

#ifdef __cplusplus
}
#endif
