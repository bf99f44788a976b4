/* Pens of XInput2, on SDL's connection to the X server.

   Each pen is a slave device of the server and is selected individually. Selecting a master device would replace the
   events from which SDL makes its mouse.

   A pen's position is computed from its own axes. The position in the event is one event late in its integer part,
   since the server fills it in before it moves the pointer. */
#include "ui/input/pen.h"
#include "ui/input/pen_internal.h"

#include "base/array.h"
#include "base/memory.h"

#include <SDL.h>
#include <SDL_syswm.h>
#include <X11/Xatom.h>
#include <X11/extensions/XInput2.h>
#include <stdio.h>
#include <string.h>

#define TOOL_TYPE WR_PEN_AXES /* index after the names of the axes */
#define ATOMS (WR_PEN_AXES + 1)

struct WrPenX11 {
    Display *display; /* SDL's */
    Window window, root;
    int opcode; /* extension number in events */
    Atom atoms[ATOMS];
    int root_w, root_h; /* pixels of all displays together */
};

static const char *const atom_names[ATOMS] = { "Abs X",          "Abs Y",      "Abs Pressure",
                                               "Abs Tilt X",     "Abs Tilt Y", "Abs Wheel",
                                               "Wacom Tool Type" };

/* A device may be unplugged between two requests. The server then sends an error, which would end the program without
   this handler. */
static int ignore_error(Display *display, XErrorEvent *event)
{
    (void)display, (void)event;
    return 0;
}

/* ---- classification of devices ---- */

/* True if `word` (lower case) is in the text; as a separate word if `whole`. */
static bool has_word(const char *text, const char *word, bool whole)
{
    size_t n = strlen(word);
    for (const char *at = text; *at; at++) {
        if (SDL_strncasecmp(at, word, n) != 0) continue;
        bool begins = at == text || !SDL_isalpha((unsigned char)at[-1]);
        if (!whole || (begins && !SDL_isalpha((unsigned char)at[n]))) return true;
    }
    return false;
}

static bool named_like_pen(const char *name)
{
    return has_word(name, "stylus", false) || has_word(name, "eraser", false) ||
           has_word(name, "pen", true);
}

/* The driver's type: STYLUS, ERASER, PAD, TOUCH, CURSOR; "" if unknown. */
static void tool_type(const WrPenX11 *x, int id, char out[32])
{
    Atom type;
    int format;
    unsigned long count, left;
    unsigned char *data = NULL;
    out[0] = '\0';
    if (XIGetProperty(x->display, id, x->atoms[TOOL_TYPE], 0, 1, False, XA_ATOM, &type, &format,
                      &count, &left, &data) != Success)
        return;
    if (data && type == XA_ATOM && format == 32 && count == 1) {
        uint32_t atom; /* this call packs 32 bits in 4 bytes */
        memcpy(&atom, data, sizeof atom);
        char *name = atom ? XGetAtomName(x->display, atom) : NULL;
        if (name) SDL_strlcpy(out, name, 32);
        if (name) XFree(name);
    }
    if (data) XFree(data);
}

static void take_axis(const WrPenX11 *x, const XIValuatorClassInfo *v, WrPenAxis axes[WR_PEN_AXES])
{
    for (int role = 0; role < WR_PEN_AXES; role++)
        if (v->label == x->atoms[role])
            axes[role] = (WrPenAxis){ .number = v->number,
                                      .absolute = v->mode == XIModeAbsolute,
                                      .low = v->min,
                                      .high = v->max,
                                      .value = v->value };
}

static bool is_absolute(const WrPenAxis *axis)
{
    return axis->number >= 0 && axis->absolute && axis->high > axis->low;
}

/* True for a pen; also finds its axes. */
static bool is_pen(const WrPenX11 *x, const XIDeviceInfo *info, WrPenAxis axes[WR_PEN_AXES],
                   bool *eraser)
{
    char type[32];
    bool touch = false;
    for (int i = 0; i < WR_PEN_AXES; i++) axes[i] = (WrPenAxis){ .number = -1 };
    if (info->use != XISlavePointer && info->use != XIFloatingSlave) return false;
    for (int i = 0; i < info->num_classes; i++) {
        if (info->classes[i]->type == XIValuatorClass)
            take_axis(x, (const XIValuatorClassInfo *)info->classes[i], axes);
        touch |= info->classes[i]->type == XITouchClass;
    }
    bool pressure = is_absolute(&axes[WR_PEN_AXIS_PRESSURE]);
    bool named = named_like_pen(info->name) && axes[WR_PEN_AXIS_X].number >= 0;
    if (touch || (!pressure && !named)) return false;
    tool_type(x, info->deviceid, type);
    if (strcmp(type, "PAD") == 0 || strcmp(type, "TOUCH") == 0 || strcmp(type, "CURSOR") == 0)
        return false;
    *eraser = type[0] ? strcmp(type, "ERASER") == 0 : has_word(info->name, "eraser", false);
    return true;
}

/* ---- table of devices ---- */

static void measure_root(WrPenX11 *x)
{
    XWindowAttributes attributes;
    if (!XGetWindowAttributes(x->display, x->root, &attributes)) return;
    x->root_w = attributes.width;
    x->root_h = attributes.height;
}

static void listen_to(const WrPenX11 *x, Window window, int id, const int *events, int count)
{
    unsigned char bits[XIMaskLen(XI_LASTEVENT)] = { 0 };
    XIEventMask mask = { .deviceid = id, .mask_len = sizeof bits, .mask = bits };
    for (int i = 0; i < count; i++) XISetMask(bits, events[i]);
    XISelectEvents(x->display, window, &mask, 1);
}

static void adopt(WrPen *pen, const XIDeviceInfo *info, const WrPenAxis axes[WR_PEN_AXES],
                  bool eraser)
{
    static const int events[] = { XI_Motion, XI_ButtonPress, XI_ButtonRelease, XI_DeviceChanged };
    int index = -1;
    for (int i = 0; i < pen->units.count; i++)
        if (pen->units.data[i].server_id == info->deviceid) index = i;
    if (index < 0) {
        index = wr_pen_unit(pen, info->name, eraser, false);
        if (pen->units.data[index].server_id >= 0) { /* a second device of that name */
            char name[96];
            snprintf(name, sizeof name, "%.80s (%d)", info->name, info->deviceid);
            index = wr_pen_unit(pen, name, eraser, false);
        }
    }
    WrPenUnit *unit = &pen->units.data[index];
    const WrPenAxis *pressure = &axes[WR_PEN_AXIS_PRESSURE];
    memcpy(unit->axes, axes, sizeof unit->axes);
    unit->server_id = info->deviceid;
    unit->replayed = false;
    unit->shown.there = true;
    unit->shown.has_place = is_absolute(&axes[WR_PEN_AXIS_X]) && is_absolute(&axes[WR_PEN_AXIS_Y]);
    unit->shown.has_pressure = is_absolute(pressure);
    unit->shown.has_tilt =
        is_absolute(&axes[WR_PEN_AXIS_TILT_X]) && is_absolute(&axes[WR_PEN_AXIS_TILT_Y]);
    unit->shown.has_turn = is_absolute(&axes[WR_PEN_AXIS_WHEEL]);
    unit->shown.pressure_low = unit->shown.has_pressure ? pressure->low : 0.0;
    unit->shown.pressure_high = unit->shown.has_pressure ? pressure->high : 1.0;
    listen_to(pen->x11, pen->x11->window, info->deviceid, events, 4);
}

/* True if the server still lists that device. */
static bool is_listed(const WrPenUnit *unit, const XIDeviceInfo *list, int count)
{
    for (int i = 0; i < count; i++)
        if (list[i].deviceid == unit->server_id) return list[i].enabled;
    return false;
}

static void scan(WrPen *pen)
{
    WrPenX11 *x = pen->x11;
    int count = 0;
    WrPenAxis axes[WR_PEN_AXES];
    bool eraser;
    XErrorHandler before = XSetErrorHandler(ignore_error);
    measure_root(x);
    XIDeviceInfo *list = XIQueryDevice(x->display, XIAllDevices, &count);
    if (!list) count = 0;
    for (int i = 0; i < pen->units.count; i++) {
        WrPenUnit *unit = &pen->units.data[i];
        if (unit->server_id < 0 || is_listed(unit, list, count)) continue;
        wr_pen_lose(pen, i);
        unit->shown.there = false;
        unit->server_id = -1;
    }
    for (int i = 0; i < count; i++)
        if (list[i].enabled && is_pen(x, &list[i], axes, &eraser))
            adopt(pen, &list[i], axes, eraser);
    if (list) XIFreeDeviceInfo(list);
    XSync(x->display, False);
    XSetErrorHandler(before);
}

/* ---- creation ---- */

WrPenX11 *wr_pen_x11_new(WrPen *pen, const char **why)
{
    static const int changes[] = { XI_HierarchyChanged };
    SDL_SysWMinfo info;
    int first_event, first_error, major = 2, minor = 2, opcode;
    SDL_VERSION(&info.version);
    if (!SDL_GetWindowWMInfo(pen->window, &info) || info.subsystem != SDL_SYSWM_X11) {
        *why = "The window is not on an X server, so pens act as mice.";
        return NULL;
    }
    Display *display = info.info.x11.display;
    if (!XQueryExtension(display, "XInputExtension", &opcode, &first_event, &first_error) ||
        XIQueryVersion(display, &major, &minor) != Success || major * 100 + minor < 202) {
        *why = "The X server has no XInput 2.2, so pens act as mice.";
        return NULL;
    }
    WrPenX11 *x = wr_alloc(1, sizeof *x);
    x->display = display;
    x->window = info.info.x11.window;
    x->root = DefaultRootWindow(display);
    x->opcode = opcode;
    if (!XInternAtoms(display, (char **)atom_names, ATOMS, False, x->atoms)) {
        wr_free(x);
        *why = "The X server is out of memory, so pens act as mice.";
        return NULL;
    }
    pen->x11 = x;
    listen_to(x, x->root, XIAllDevices, changes, 1);
    scan(pen);
    SDL_EventState(SDL_SYSWMEVENT, SDL_ENABLE);
    return x;
}

void wr_pen_x11_sync(WrPenX11 *x)
{
    XSync(x->display, False);
}

void wr_pen_x11_free(WrPenX11 *x)
{
    if (x) SDL_EventState(SDL_SYSWMEVENT, SDL_DISABLE);
    wr_free(x); /* the connection belongs to SDL */
}

/* ---- events ---- */

/* An event contains only the changed axes. */
static void take_axes(WrPenUnit *unit, const XIValuatorState *state)
{
    const double *value = state->values;
    for (int number = 0; number < state->mask_len * 8; number++) {
        if (!XIMaskIsSet(state->mask, number)) continue;
        for (int role = 0; role < WR_PEN_AXES; role++)
            if (unit->axes[role].number == number) unit->axes[role].value = *value;
        value++;
    }
}

/* Position in pixels of all screens; the axis range covers their whole width. */
static double on_root(const WrPenAxis *axis, int pixels)
{
    return (axis->value - axis->low) * pixels / (axis->high + 1.0 - axis->low);
}

/* -1..1: the usual range -64..63 counts as -64..64. */
static double tilt_of(const WrPenAxis *axis)
{
    if (axis->low < 0.0 && axis->high > 0.0)
        return axis->value / (-axis->low > axis->high ? -axis->low : axis->high);
    return (2.0 * axis->value - axis->low - axis->high) / (axis->high - axis->low);
}

/* The axis of an art pen covers one rotation: -900..899 of the wacom driver. */
static double turn_of(const WrPenAxis *axis)
{
    return 360.0 * (axis->value - 0.5 * (axis->low + axis->high + 1.0)) /
           (axis->high + 1.0 - axis->low);
}

static WrPenReading reading_of(const WrPen *pen, const WrPenUnit *unit)
{
    int window_x, window_y;
    const WrPenAxis *axes = unit->axes;
    SDL_GetWindowPosition(pen->window, &window_x, &window_y);
    WrPenReading r = { .x = on_root(&axes[WR_PEN_AXIS_X], pen->x11->root_w) - window_x,
                       .y = on_root(&axes[WR_PEN_AXIS_Y], pen->x11->root_h) - window_y,
                       .pressure = axes[WR_PEN_AXIS_PRESSURE].value };
    if (unit->shown.has_tilt) {
        r.tilt_x = tilt_of(&axes[WR_PEN_AXIS_TILT_X]);
        r.tilt_y = tilt_of(&axes[WR_PEN_AXIS_TILT_Y]);
    }
    if (unit->shown.has_turn) r.turn_deg = turn_of(&axes[WR_PEN_AXIS_WHEEL]);
    return r;
}

/* True if a button recorded as pressed is not: another client received its release. */
static bool missed_release(const WrPenUnit *unit, const XIButtonState *buttons)
{
    for (int b = 1; b <= WR_PEN_BUTTONS; b++)
        if ((unit->held & 1u << b) &&
            (buttons->mask_len * 8 <= b || !XIMaskIsSet(buttons->mask, b)))
            return true;
    return false;
}

static void device_event(WrPen *pen, const XIDeviceEvent *event)
{
    int index = -1;
    for (int i = 0; i < pen->units.count; i++)
        if (pen->units.data[i].server_id == event->deviceid) index = i;
    if (index < 0 || (event->flags & XIPointerEmulated)) return;
    WrPenUnit *unit = &pen->units.data[index];
    if (!unit->shown.has_place) { /* only SDL's mouse events are available */
        unit->shown.events++;
        return;
    }
    if (event->evtype == XI_ButtonPress) measure_root(pen->x11); /* displays may have changed */
    take_axes(unit, &event->valuators);
    if (missed_release(unit, &event->buttons)) wr_pen_lose(pen, index);
    WrPenReading r = reading_of(pen, unit);
    r.kind = event->evtype == XI_ButtonPress     ? WR_PEN_DOWN
             : event->evtype == XI_ButtonRelease ? WR_PEN_UP
                                                 : WR_PEN_MOTION;
    r.button = r.kind == WR_PEN_MOTION ? 0 : event->detail;
    r.seconds = wr_pen_seconds(unit, (uint32_t)event->time);
    wr_pen_feed(pen, index, &r);
}

void wr_pen_x11_event(WrPen *pen, const SDL_Event *event)
{
    const SDL_SysWMmsg *message = event->syswm.msg;
    if (!message || message->subsystem != SDL_SYSWM_X11) return;
    const XGenericEventCookie *cookie = &message->msg.x11.event.xcookie;
    if (message->msg.x11.event.type != GenericEvent || cookie->extension != pen->x11->opcode ||
        !cookie->data)
        return;
    switch (cookie->evtype) {
    case XI_Motion:
    case XI_ButtonPress:
    case XI_ButtonRelease: device_event(pen, cookie->data); break;
    case XI_HierarchyChanged:
    case XI_DeviceChanged: scan(pen); break;
    default: break;
    }
}
