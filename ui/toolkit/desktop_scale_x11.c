/* The desktop's scale, read from the X server that SDL is connected to. */
#include "ui/toolkit/desktop_scale.h"

#include <SDL_syswm.h>
#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <stdio.h>

#define LONGEST (1 << 18) /* size limit of a property in units of 4 bytes */

/* A window may vanish during the request. */
static int ignore_error(Display *display, XErrorEvent *event)
{
    (void)display, (void)event;
    return 0;
}

/* Bytes of a window's property, with a terminating 0 that is not counted; NULL: missing. Freed by XFree. */
static unsigned char *property(Display *display, Window window, Atom name, Atom type, size_t *count)
{
    Atom is;
    int bits;
    unsigned long items, left;
    unsigned char *bytes = NULL;
    *count = 0;
    if (XGetWindowProperty(display, window, name, 0, LONGEST, False, type, &is, &bits, &items,
                           &left, &bytes) != Success)
        return NULL;
    if (bytes && (is != type || bits != 8)) {
        XFree(bytes);
        return NULL;
    }
    *count = items;
    return bytes;
}

static double dpi_of_settings(Display *display)
{
    char name[32];
    size_t count;
    snprintf(name, sizeof name, "_XSETTINGS_S%d", DefaultScreen(display));
    const Window owner = XGetSelectionOwner(display, XInternAtom(display, name, False));
    if (owner == None) return 0;
    const Atom settings = XInternAtom(display, "_XSETTINGS_SETTINGS", False);
    unsigned char *bytes = property(display, owner, settings, settings, &count);
    const double dpi = bytes ? wr_desktop_dpi_of_settings(bytes, count) : 0;
    if (bytes) XFree(bytes);
    return dpi;
}

static double dpi_of_resources(Display *display)
{
    size_t count;
    unsigned char *text =
        property(display, DefaultRootWindow(display), XA_RESOURCE_MANAGER, XA_STRING, &count);
    const double dpi = text ? wr_desktop_dpi_of_resources((const char *)text) : 0;
    if (text) XFree(text);
    return dpi;
}

double wr_desktop_dpi(SDL_Window *window)
{
    SDL_SysWMinfo info;
    SDL_VERSION(&info.version);
    if (!SDL_GetWindowWMInfo(window, &info) || info.subsystem != SDL_SYSWM_X11) return 0;
    Display *display = info.info.x11.display;
    XErrorHandler before = XSetErrorHandler(ignore_error);
    double dpi = dpi_of_settings(display);
    if (dpi == 0) dpi = dpi_of_resources(display);
    XSync(display, False);
    XSetErrorHandler(before);
    return dpi;
}

unsigned long wr_desktop_window(SDL_Window *window)
{
    SDL_SysWMinfo info;
    SDL_VERSION(&info.version);
    if (!SDL_GetWindowWMInfo(window, &info) || info.subsystem != SDL_SYSWM_X11) return 0;
    return info.info.x11.window;
}
