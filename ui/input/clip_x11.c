/* Pictures from the X server's clipboard, on a separate connection, since SDL's would take our events. Large data
   arrives in pieces (INCR of the Inter-Client Communication Conventions Manual, section 2.7.2). */
#include "ui/input/clip.h"

#include "base/array.h"
#include "base/memory.h"
#include "system/clock.h"

#include <SDL.h>
#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <string.h>

#define WAIT_SECONDS 2.0
#define BYTES_MAX (256 << 20)

typedef WR_ARRAY(char) Bytes;

typedef struct Asking {
    Display *display;
    Window window;
    Atom clipboard, type, incr, property; /* type: of the requested picture */
    double until;
    Bytes got;
} Asking;

/* The next event of that type for our property. */
static bool wait_for(Asking *ask, int type, XEvent *event)
{
    while (wr_clock_seconds() < ask->until) {
        if (XCheckTypedWindowEvent(ask->display, ask->window, type, event)) {
            if (type != PropertyNotify || (event->xproperty.atom == ask->property &&
                                           event->xproperty.state == PropertyNewValue))
                return true;
            continue;
        }
        /* if this program owns the clipboard, SDL answers that there is no picture */
        SDL_PumpEvents();
        SDL_Delay(2);
    }
    return false;
}

/* Append the property's content and delete the property, which requests the next piece. */
static bool take(Asking *ask, Atom *type, unsigned long *count)
{
    unsigned char *data = NULL;
    int format = 0;
    unsigned long rest = 0;
    *count = 0;
    if (XGetWindowProperty(ask->display, ask->window, ask->property, 0, BYTES_MAX / 4, True,
                           AnyPropertyType, type, &format, count, &rest, &data) != Success)
        return false;
    bool fits = format == 8 && (size_t)ask->got.count + *count <= BYTES_MAX;
    for (unsigned long i = 0; fits && *type == ask->type && i < *count; i++)
        wr_array_push(&ask->got, (char)data[i]);
    if (data) XFree(data);
    return *type == ask->incr || (fits && *type == ask->type);
}

static bool take_all(Asking *ask)
{
    XEvent event;
    Atom type = None;
    unsigned long count;
    if (!wait_for(ask, SelectionNotify, &event) || event.xselection.property == None) return false;
    while (XCheckTypedWindowEvent(ask->display, ask->window, PropertyNotify, &event)) {
    }
    if (!take(ask, &type, &count)) return false;
    if (type != ask->incr) return ask->got.count > 0;
    do {
        ask->until = wr_clock_seconds() + WAIT_SECONDS;
        if (!wait_for(ask, PropertyNotify, &event) || !take(ask, &type, &count)) return false;
    } while (count > 0);
    return ask->got.count > 0;
}

static bool ask(Asking *ask)
{
    if (XGetSelectionOwner(ask->display, ask->clipboard) == None) return false;
    XSelectInput(ask->display, ask->window, PropertyChangeMask);
    XConvertSelection(ask->display, ask->clipboard, ask->type, ask->property, ask->window,
                      CurrentTime);
    XFlush(ask->display);
    return take_all(ask);
}

/* Requested formats, best first: MIME type, file extension and first bytes. */
static const struct {
    const char *type, *ending, *magic;
    int length; /* length of magic */
} formats[] = {
    { "image/svg+xml", "svg", "<", 1 },      { "image/png", "png", "\x89PNG\r\n\x1a\n", 8 },
    { "image/tiff", "tif", "II*\0", 4 },     { "image/tiff", "tif", "MM\0*", 4 },
    { "image/bmp", "bmp", "BM", 2 },         { "image/x-bmp", "bmp", "BM", 2 },
    { "image/x-MS-bmp", "bmp", "BM", 2 },    { "image/jpeg", "jpg", "\xff\xd8\xff", 3 },
    { "text/uri-list", "uri", "file://", 7 }
};

#define FORMATS ((int)(sizeof formats / sizeof *formats))

static bool is_format(const Bytes *bytes, int i)
{
    return bytes->count > formats[i].length &&
           memcmp(bytes->data, formats[i].magic, (size_t)formats[i].length) == 0;
}

/* Request the formats in turn. Index of the received one, -1: none. */
static int ask_all(Asking *asking)
{
    for (int i = 0; i < FORMATS; i++) {
        if (i > 0 && strcmp(formats[i].type, formats[i - 1].type) == 0) continue;
        asking->got.count = 0;
        asking->type = XInternAtom(asking->display, formats[i].type, False);
        asking->until = wr_clock_seconds() + WAIT_SECONDS;
        if (!ask(asking)) {
            if (wr_clock_seconds() >= asking->until) return -1; /* its owner does not answer */
            continue;
        }
        for (int k = i; k < FORMATS && strcmp(formats[k].type, formats[i].type) == 0; k++)
            if (is_format(&asking->got, k)) return k;
    }
    return -1;
}

bool wr_clip_picture(char **bytes, size_t *length, const char **ending)
{
    Asking asking = { .display = XOpenDisplay(NULL) };
    if (!asking.display) return false;
    Display *d = asking.display;
    asking.window = XCreateSimpleWindow(d, DefaultRootWindow(d), 0, 0, 1, 1, 0, 0, 0);
    asking.clipboard = XInternAtom(d, "CLIPBOARD", False);
    asking.incr = XInternAtom(d, "INCR", False);
    asking.property = XInternAtom(d, "WRINKLE_PICTURE", False);
    const int format = ask_all(&asking);
    XDestroyWindow(d, asking.window);
    XCloseDisplay(d);
    if (format < 0) {
        wr_array_free(&asking.got);
        return false;
    }
    *bytes = asking.got.data;
    *length = (size_t)asking.got.count;
    *ending = formats[format].ending;
    return true;
}
