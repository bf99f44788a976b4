/* display.h - by which system of windows the window opens, and what that means for pens. SDL 2 knows pens of no system, and
   ours are read from X servers; XWayland is one, and passes on what pens send. */
#pragma once
#include <stdbool.h>

/* What the environment says; each may be NULL. */
typedef struct WrDisplayEnv {
    const char *driver;  /* SDL_VIDEODRIVER: the user's own choice, which holds */
    const char *x11;     /* DISPLAY */
    const char *wayland; /* WAYLAND_DISPLAY */
    const char *session; /* XDG_SESSION_TYPE */
} WrDisplayEnv;

WrDisplayEnv wr_display_env(void);
/* What SDL shall try, in this order; NULL: what it tries by itself. */
const char *wr_display_driver(const WrDisplayEnv *env);
/* SDL has opened a driver that shows nothing, and nobody asked for it. asked: SDL's hint for the driver, or NULL. */
bool wr_display_unseen(const char *asked, const char *opened);
/* Why the window came where it is and what follows for pens, when SDL has opened it by that driver; NULL: nothing to
   say. In English; not the caller's. */
const char *wr_display_word(const WrDisplayEnv *env, const char *opened);
