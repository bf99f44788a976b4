/* video_driver.h - choice of the window system, and its effect on pens. SDL 2 supports no pens; the program reads them
   from X servers. XWayland is one and forwards pen events. */
#pragma once
#include <stdbool.h>

/* Environment variables; each may be NULL. */
typedef struct WrDisplayEnv {
    const char *driver;  /* SDL_VIDEODRIVER: the user's choice, which takes precedence */
    const char *x11;     /* DISPLAY */
    const char *wayland; /* WAYLAND_DISPLAY */
    const char *session; /* XDG_SESSION_TYPE */
} WrDisplayEnv;

WrDisplayEnv wr_display_env(void);
/* Drivers for SDL to try, in this order; NULL: SDL's default. */
const char *wr_display_driver(const WrDisplayEnv *env);
/* True if the environment names no X11 or Wayland display and no driver. SDL would then open the console or a driver without
   output. */
bool wr_display_none(const WrDisplayEnv *env);
/* True if SDL has opened a driver without output that was not requested. asked: SDL's hint for the driver, or
   NULL. */
bool wr_display_no_output(const char *asked, const char *opened);
/* Message on the chosen driver and its effect on pens; NULL: none. In English; static. */
const char *wr_display_driver_message(const WrDisplayEnv *env, const char *opened);

/* ---- renderer back ends of the window, and their order ---- */

/* Tested without a display. */

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
