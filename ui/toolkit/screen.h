/* screen.h - renderer back ends of the window, and their order. Tested without a display. */
#pragma once
#include <stdbool.h>

typedef enum WrScreenWay {
    WR_SCREEN_OPENGL,  /* by the graphics card */
    WR_SCREEN_DIRECT,  /* software, with a window surface directly on the display, as in X11 */
    WR_SCREEN_SURFACE, /* software, with SDL's default presentation of the surface */
    WR_SCREEN_ANY,     /* SDL's default renderer */
    WR_SCREEN_WAYS
} WrScreenWay;

/* Write the back ends in the order to try; returns their number.
 *
 * driver  SDL's video driver: "x11", "wayland", "dummy", ...; NULL: none
 * gpu     there is a graphics card. Without one, SDL's software renderer directly on the display is several
 *         times faster than a software OpenGL
 * wanted  WRINKLE_RENDERER: "opengl" first, anything else software first; NULL: depends on gpu */
int wr_screen_ways(const char *driver, bool gpu, const char *wanted,
                   WrScreenWay ways[WR_SCREEN_WAYS]);
const char *wr_screen_words(WrScreenWay way); /* "by OpenGL" */
