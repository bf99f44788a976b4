/* desktop.h - how large the desktop wants everything, and how it knows a window. */
#pragma once
#include <SDL.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Dots an inch that the desktop asks for, 96 where everything has its usual size; 0: it does not say. By the settings
   that it tells programs (XSETTINGS: Xft/DPI), else by the server's resources (Xft.dpi). */
double wr_desktop_dpi(SDL_Window *window);

/* The X server's number of the window; 0: it has none, as under Wayland. */
unsigned long wr_desktop_window(SDL_Window *window);

/* Dots an inch of what was read: an _XSETTINGS_SETTINGS property, and lines of resources. Both come from other programs; 0
   where they are damaged or do not say, or say what nobody means (outside 48..768). */
double wr_desktop_dpi_of_settings(const unsigned char *bytes, size_t count);
double wr_desktop_dpi_of_resources(const char *text);

#ifdef __cplusplus
}
#endif
