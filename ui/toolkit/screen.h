/* screen.h - the ways to put pictures of the window on the screen, and which to try first. Tested without one. */
#pragma once
#include <stdbool.h>

typedef enum WrScreenWay {
    WR_SCREEN_OPENGL, /* by the graphics card */
    WR_SCREEN_DIRECT, /* by software, the window's surface straight to the display: X11 has such a thing */
    WR_SCREEN_SURFACE, /* by software, the surface put up in whatever way SDL finds */
    WR_SCREEN_ANY,     /* whatever SDL finds */
    WR_SCREEN_WAYS
} WrScreenWay;

/* In the order to be tried; returns how many.
 *
 * driver  SDL's video driver: "x11", "wayland", "dummy", ...; NULL: none
 * gpu     there is a graphics card. Without one SDL's software renderer, straight to the display, is several
 *         times faster than any OpenGL made of software
 * wanted  WRINKLE_RENDERER: "opengl" first, anything else software first; NULL: as gpu says */
int wr_screen_ways(const char *driver, bool gpu, const char *wanted,
                   WrScreenWay ways[WR_SCREEN_WAYS]);
const char *wr_screen_words(WrScreenWay way); /* "by OpenGL" */
