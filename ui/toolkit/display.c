#include "ui/toolkit/display.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static bool said(const char *text)
{
    return text && text[0];
}

static bool is_wayland(const WrDisplayEnv *env)
{
    return said(env->wayland) || (env->session && strcmp(env->session, "wayland") == 0);
}

WrDisplayEnv wr_display_env(void)
{
    return (WrDisplayEnv){ getenv("SDL_VIDEODRIVER"), getenv("DISPLAY"), getenv("WAYLAND_DISPLAY"),
                           getenv("XDG_SESSION_TYPE") };
}

const char *wr_display_driver(const WrDisplayEnv *env)
{
    if (said(env->driver) || !is_wayland(env)) return NULL;
    return said(env->x11) ? "x11,wayland" : "wayland,x11";
}

bool wr_display_no_output(const char *asked, const char *opened)
{
    static const char *const unseen[] = { "dummy", "offscreen", "evdev" };
    if (!opened || (asked && strstr(asked, opened))) return false;
    for (size_t i = 0; i < sizeof unseen / sizeof *unseen; i++)
        if (strcmp(opened, unseen[i]) == 0) return true;
    return false;
}

const char *wr_display_driver_note(const WrDisplayEnv *env, const char *opened)
{
    const bool native = opened && strcmp(opened, "wayland") == 0;
    if (!is_wayland(env) || !opened || (!native && strcmp(opened, "x11") != 0)) return NULL;
    if (!native)
        return said(env->driver)
                   ? NULL
                   : "The session is Wayland, where pens would act as mice: the window runs on "
                     "XWayland, which passes on all pen values. SDL_VIDEODRIVER=wayland opens it "
                     "on "
                     "Wayland itself.";
    if (said(env->driver))
        return "SDL_VIDEODRIVER opens the window on Wayland itself, where pens act as mice. "
               "Without it the window goes through XWayland, where there is one.";
    return said(env->x11)
               ? "XWayland opened no window; on Wayland itself pens act as mice."
               : "There is no XWayland (DISPLAY is not set); on Wayland itself pens act as mice.";
}
