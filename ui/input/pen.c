/* Queue of pen events, and calibration of device values. The sources are pen_x11.c, pen_wayland.c, SDL's touches and
   pen_record.c. */
#include "ui/input/pen.h"
#include "ui/toolkit/words.h"
#include "ui/input/pen_curve.h"
#include "ui/input/pen_internal.h"
#include "ui/input/pen_wayland.h"

#include "base/exactmath.h"
#include "base/array.h"
#include "base/memory.h"
#include "base/text.h"
#include "system/clock.h"

#include <SDL.h>
#include <math.h>
#include <string.h>

#define ECHO_SECONDS 0.1  /* mouse events within this time after a pen event are its duplicates */
#define RANGE_SECONDS 1.0 /* a pen with an event this recent is near the surface */
#define MARKS_MAX 512     /* limit of unread keys and buttons */
/* events with the tip down and constant pressure: pressure does not work */
#define STILL_EVENTS 8

/* ---- creation ---- */

static void pen_finger_event(WrPen *pen, const SDL_TouchFingerEvent *event);

static void lose_all(WrPen *pen)
{
    for (int i = 0; i < pen->units.count; i++) {
        wr_pen_lose(pen, i);
        pen->units.data[i].fingers = (WrTouch){ 0 };
    }
}

/* Called by SDL in the thread that reads the server's events, the window's. Other threads push events too; from them
   only keys and buttons are of these kinds, and they are not user input. */
static int SDLCALL watch(void *data, SDL_Event *event)
{
    WrPen *pen = data;
    switch (event->type) {
    case SDL_SYSWMEVENT:
        if (pen->x11) wr_pen_x11_event(pen, event);
        break;
    case SDL_FINGERDOWN:
    case SDL_FINGERMOTION:
    case SDL_FINGERUP: pen_finger_event(pen, &event->tfinger); break;
    case SDL_WINDOWEVENT:
        if (event->window.event == SDL_WINDOWEVENT_HIDDEN ||
            event->window.event == SDL_WINDOWEVENT_MINIMIZED)
            lose_all(pen);
        break;
    case SDL_MOUSEMOTION:
        if (pen->wayland) wr_pen_wayland_mouse(pen->wayland, &event->motion);
        break;
    case SDL_KEYDOWN:
    case SDL_KEYUP:
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP:
        if (SDL_ThreadID() != pen->thread) break;
        if (pen->wayland) wr_pen_wayland_update(pen->wayland);
        wr_pen_mark(pen, event);
        break;
    default: break;
    }
    return 1;
}

WrPen *wr_pen_new(SDL_Window *window)
{
    WrPen *pen = wr_alloc(1, sizeof *pen);
    pen->window = window;
    pen->thread = SDL_ThreadID();
    pen->came_at = pen->taken_at = pen->pen_at = -1e9;
    pen->why_not = "There is no window.";
    if (window) {
        pen->x11 = wr_pen_x11_new(pen, &pen->why_not);
        if (!pen->x11) pen->wayland = wr_pen_wayland_new(pen, &pen->why_not);
        SDL_AddEventWatch(watch, pen);
    }
    wr_pen_record_start(pen);
    return pen;
}

void wr_pen_free(WrPen *pen)
{
    if (!pen) return;
    if (pen->window) SDL_DelEventWatch(watch, pen);
    wr_pen_replay_end(pen);
    wr_pen_record(pen, "", NULL);
    wr_pen_x11_free(pen->x11);
    wr_pen_wayland_free(pen->wayland);
    wr_array_free(&pen->units);
    wr_array_free(&pen->kept);
    wr_array_free(&pen->queue);
    wr_array_free(&pen->marks);
    wr_array_free(&pen->recorded);
    wr_text_fini(&pen->words);
    wr_free(pen);
}

/* ---- devices ---- */

/* Names are printed in lines of text: remove control characters, and truncate at a UTF-8 character boundary. */
static void copy_name(char out[96], const char *name)
{
    size_t n = 0;
    for (; name[n] && n < 95; n++) out[n] = (unsigned char)name[n] < 0x20 ? ' ' : name[n];
    if (name[n])
        while (n > 0 && ((unsigned char)name[n] & 0xc0) == 0x80) n--;
    while (n > 0 && out[n - 1] == ' ') n--;
    out[n] = '\0';
    if (n == 0) memcpy(out, "?", 2);
}

int wr_pen_unit(WrPen *pen, const char *name, bool eraser, bool finger)
{
    WrPenUnit unit = { .shown = { .eraser = eraser,
                                  .finger = finger,
                                  .pressure_high = 1.0,
                                  .raw_least = 1.0,
                                  .curve = wr_pen_curve_default() },
                       .server_id = -1 };
    copy_name(unit.shown.name, name);
    for (int i = 0; i < WR_PEN_AXES; i++) unit.axes[i].number = -1;
    for (int i = 0; i < pen->units.count; i++) {
        const WrPenDevice *old = &pen->units.data[i].shown;
        if (strcmp(old->name, unit.shown.name) == 0 && old->eraser == eraser &&
            old->finger == finger)
            return i;
    }
    for (int i = 0; i < pen->kept.count; i++)
        if (strcmp(pen->kept.data[i].name, unit.shown.name) == 0)
            unit.shown.curve = pen->kept.data[i].curve;
    wr_array_push(&pen->units, unit);
    return pen->units.count - 1;
}

int wr_pen_device_count(const WrPen *pen)
{
    return pen->units.count;
}

const WrPenDevice *wr_pen_device(const WrPen *pen, int index)
{
    return index >= 0 && index < pen->units.count ? &pen->units.data[index].shown : NULL;
}

void wr_pen_keep_curve(WrPen *pen, const char *name, const WrPenCurve *curve)
{
    WrPenKept kept = { .curve = *curve };
    int at = 0;
    if (!wr_pen_curve_valid(curve)) return;
    copy_name(kept.name, name);
    for (int i = 0; i < pen->units.count; i++)
        if (strcmp(pen->units.data[i].shown.name, kept.name) == 0)
            pen->units.data[i].shown.curve = *curve;
    while (at < pen->kept.count && strcmp(pen->kept.data[at].name, kept.name) != 0) at++;
    if (at < pen->kept.count) pen->kept.data[at] = kept;
    else wr_array_push(&pen->kept, kept);
}

void wr_pen_set_curve(WrPen *pen, int index, const WrPenCurve *curve)
{
    if (index < 0 || index >= pen->units.count) return;
    char name[96];
    memcpy(name, pen->units.data[index].shown.name, sizeof name);
    wr_pen_keep_curve(pen, name, curve);
}

/* ---- values ---- */

double wr_pen_seconds(WrPenUnit *unit, uint32_t ms)
{
    if (!unit->clock_known) {
        unit->clock_known = true;
        unit->clock_last = ms;
        unit->clock_ms = 0;
        unit->clock_offset = wr_clock_seconds();
    }
    int32_t step = (int32_t)(ms - unit->clock_last);
    if (step > 0) {
        unit->clock_ms += step;
        unit->clock_last = ms;
    }
    return unit->clock_offset + (double)unit->clock_ms * 1e-3;
}

/* Clamp a device value to low..high; invalid ones are counted. */
static double taken(WrPenUnit *unit, double value, double low, double high, double before)
{
    if (isfinite(value) && value >= low && value <= high) return value;
    unit->shown.bad_values++;
    return !isfinite(value) ? before : value < low ? low : high;
}

static double raw_of(WrPenUnit *unit, double pressure)
{
    const WrPenDevice *d = &unit->shown;
    if (!d->has_pressure || !(d->pressure_high > d->pressure_low)) return 0.0;
    double share = (pressure - d->pressure_low) / (d->pressure_high - d->pressure_low);
    return taken(unit, share, 0.0, 1.0, unit->raw);
}

void wr_pen_watch(WrPenUnit *unit, double raw, bool down)
{
    WrPenDevice *d = &unit->shown;
    bool changed = unit->raw_known && raw != unit->raw;
    if (changed) unit->raw_moved = true;
    if (changed && down && (unit->held & 2u)) d->pressure_moves = true;
    if (down && raw < d->raw_least) d->raw_least = raw;
    if (down && raw > d->raw_most) d->raw_most = raw;
    if (down && !unit->raw_moved && unit->still <= STILL_EVENTS) unit->still++;
    unit->raw = raw;
    unit->raw_known = true;
}

/* True if the pen has no pressure, or claims to have it but never changes it. */
static bool is_mute(const WrPenUnit *unit)
{
    return !unit->shown.has_pressure || (!unit->raw_moved && unit->still > STILL_EVENTS);
}

void wr_pen_feed(WrPen *pen, int index, const WrPenReading *r)
{
    WrPenUnit *unit = &pen->units.data[index];
    unsigned before = unit->held, bit = 0;
    if (wr_pen_replaying(pen)) return; /* a file replaces the devices */
    if (r->kind == WR_PEN_DOWN || r->kind == WR_PEN_UP) {
        if (r->button < 1 || r->button > WR_PEN_BUTTONS) return;
        bit = 1u << r->button;
        if (((before & bit) != 0) == (r->kind == WR_PEN_DOWN)) return; /* unchanged */
    }
    const bool ends = r->kind == WR_PEN_LOST || r->kind == WR_PEN_CANCEL;
    unsigned held = ends ? 0 : r->kind == WR_PEN_UP ? before & ~bit : before | bit;
    WrPenDevice *d = &unit->shown;
    wr_pen_watch(unit, raw_of(unit, r->pressure), (held & 2u) != 0);
    if (isfinite(r->x) && isfinite(r->y)) {
        unit->x = r->x;
        unit->y = r->y;
    } else {
        d->bad_values++;
    }
    unit->tilt_x = d->has_tilt ? taken(unit, r->tilt_x, -1.0, 1.0, unit->tilt_x) : 0.0;
    unit->tilt_y = d->has_tilt ? taken(unit, r->tilt_y, -1.0, 1.0, unit->tilt_y) : 0.0;
    unit->turn_deg = d->has_turn && isfinite(r->turn_deg) ? wr_signed_degrees(r->turn_deg) : 0.0;
    if (isfinite(r->seconds) && r->seconds > unit->seconds) unit->seconds = r->seconds;
    unit->held = held;
    d->events++;
    if (r->kind == WR_PEN_DOWN && r->button == 1) d->presses++;
    bool down = ((before | held) & 2u) != 0;
    WrPenEvent event = { .kind = r->kind,
                         .device = index,
                         .eraser = d->eraser,
                         .finger = d->finger,
                         .button = bit ? r->button : 0,
                         .held = held,
                         .x = unit->x,
                         .y = unit->y,
                         .raw = unit->raw,
                         .pressure = !is_mute(unit) ? wr_pen_curve_apply(&d->curve, unit->raw)
                                     : down         ? 1.0
                                                    : 0.0,
                         .tilt_x = unit->tilt_x,
                         .tilt_y = unit->tilt_y,
                         .turn_deg = unit->turn_deg,
                         .seconds = unit->seconds };
    wr_pen_push(pen, &event);
}

void wr_pen_lose(WrPen *pen, int index)
{
    const WrPenUnit *unit = &pen->units.data[index];
    if (unit->held == 0) return;
    const WrPenDevice *d = &unit->shown;
    WrPenReading r = { .kind = WR_PEN_LOST,
                       .x = unit->x,
                       .y = unit->y,
                       .pressure =
                           d->pressure_low + unit->raw * (d->pressure_high - d->pressure_low),
                       .tilt_x = unit->tilt_x,
                       .tilt_y = unit->tilt_y,
                       .turn_deg = unit->turn_deg,
                       .seconds = unit->seconds };
    wr_pen_feed(pen, index, &r);
}

/* ---- the queue ---- */

void wr_pen_push(WrPen *pen, const WrPenEvent *event)
{
    if (pen->taken >= 2 * WR_PEN_KEEP) { /* drop old events that were read */
        int gone = pen->taken - WR_PEN_KEEP;
        pen->queue.count -= gone;
        pen->taken -= gone;
        pen->first += gone;
        memmove(pen->queue.data, pen->queue.data + gone,
                (size_t)pen->queue.count * sizeof *pen->queue.data);
    }
    wr_array_push(&pen->queue, *event);
    pen->came_at = wr_clock_seconds();
    if (!event->finger) pen->pen_at = pen->came_at;
    wr_pen_record_event(pen, event);
}

void wr_pen_sync(WrPen *pen)
{
    if (pen->x11) wr_pen_x11_sync(pen->x11);
}

double wr_pen_wait(const WrPen *pen)
{
    return pen->wayland ? wr_pen_wayland_wait(pen->wayland) : 0.0;
}

bool wr_pen_next(WrPen *pen, WrPenEvent *event)
{
    if (pen->wayland) wr_pen_wayland_update(pen->wayland);
    if (wr_pen_replaying(pen)) wr_pen_replay_step(pen);
    if (pen->taken >= pen->queue.count) return false;
    *event = pen->queue.data[pen->taken++];
    pen->taken_at = wr_clock_seconds();
    return true;
}

static void drop_marks(WrPen *pen, int count)
{
    pen->marks.count -= count;
    if (count > 0 && pen->marks.count > 0)
        memmove(pen->marks.data, pen->marks.data + count,
                (size_t)pen->marks.count * sizeof *pen->marks.data);
}

void wr_pen_mark(WrPen *pen, const SDL_Event *event)
{
    WrPenMark mark = { event->type, event->common.timestamp, wr_pen_total(pen) };
    if (pen->marks.count >= MARKS_MAX) drop_marks(pen, MARKS_MAX / 2); /* unread */
    wr_array_push(&pen->marks, mark);
}

bool wr_pen_next_before(WrPen *pen, const SDL_Event *before, WrPenEvent *event)
{
    for (int i = 0; i < pen->marks.count; i++) {
        WrPenMark mark = pen->marks.data[i];
        if (mark.type != before->type || mark.timestamp != before->common.timestamp) continue;
        drop_marks(pen, i); /* the events before these were read */
        if (pen->first + pen->taken < mark.total) return wr_pen_next(pen, event);
        drop_marks(pen, 1);
        break;
    }
    return false;
}

bool wr_pen_newest(const WrPen *pen, WrPenEvent *event)
{
    return wr_pen_event_at(pen, wr_pen_total(pen) - 1, event);
}

int64_t wr_pen_total(const WrPen *pen)
{
    return pen->first + pen->queue.count;
}

int wr_pen_waiting(const WrPen *pen)
{
    return pen->queue.count - pen->taken;
}

bool wr_pen_event_at(const WrPen *pen, int64_t number, WrPenEvent *event)
{
    if (number < pen->first || number >= wr_pen_total(pen)) return false;
    *event = pen->queue.data[number - pen->first];
    return true;
}

/* ---- duplicate mouse events ---- */

bool wr_pen_moves_mouse(const WrPen *pen)
{
    double now = wr_clock_seconds();
    if (pen->taken < pen->queue.count) return true;
    for (int i = 0; i < pen->units.count; i++)
        if (pen->units.data[i].held || pen->units.data[i].fingers.count > 0) return true;
    return now - pen->came_at < ECHO_SECONDS || now - pen->taken_at < ECHO_SECONDS;
}

bool wr_pen_in_range(const WrPen *pen)
{
    for (int i = 0; i < pen->units.count; i++)
        if (pen->units.data[i].held && !pen->units.data[i].shown.finger) return true;
    return wr_clock_seconds() - pen->pen_at < RANGE_SECONDS;
}

/* ---- diagnosis ---- */

static void diagnose(const WrPenUnit *unit, WrText *words)
{
    const WrPenDevice *d = &unit->shown;
    if (!d->there) {
        wr_text_add(
            words, wr_words("It is unplugged or switched off. Plug it in again, or switch it on."));
    } else if (!d->has_place) {
        wr_text_add(words, wr_words("It reports movements like a mouse, without a position on the "
                                    "tablet, so it paints like a mouse, without pressure. Set its "
                                    "mode to absolute in the tablet's settings."));
    } else if (d->events == 0) {
        wr_text_add(words, wr_words("It has not reported anything yet. Move it over the tablet."));
    } else if (!d->has_pressure) {
        wr_text_add(
            words,
            wr_words(d->finger
                         ? "This screen does not report the pressure of fingers: it counts as 1."
                         : "It has no pressure: every touch counts as 1. If it should have "
                           "pressure, try another driver."));
    } else if (is_mute(unit)) {
        char text[400];
        wr_words_print(text, sizeof text,
                       wr_words("It should have pressure, but always reports %.3g: every touch "
                                "counts as 1. Check the tablet's settings, or try another driver."),
                       unit->raw);
        wr_text_add(words, text);
    } else if (d->bad_values > 0) {
        wr_text_addf(words,
                     wr_words("%lld of its values were not numbers or out of range, and were "
                              "clamped. If strokes jump, the driver is faulty."),
                     (long long)d->bad_values);
    } else if (d->presses >= 3 && d->raw_most < 0.6) {
        char text[400];
        wr_words_print(text, sizeof text,
                       wr_words("The hardest press so far was %.2f of its range. Lower the curve's "
                                "maximum to about that."),
                       d->raw_most);
        wr_text_add(words, text);
    }
}

const char *wr_pen_diagnosis(WrPen *pen, int index)
{
    wr_text_clear(&pen->words);
    if (index >= 0 && index < pen->units.count) diagnose(&pen->units.data[index], &pen->words);
    else if (!pen->x11 && !pen->wayland) wr_text_add(&pen->words, pen->why_not);
    else if (pen->units.count == 0 && pen->wayland)
        wr_text_add(&pen->words,
                    "No tablet was found. Plug it in, or check the desktop's settings.");
    else if (pen->units.count == 0)
        wr_text_add(&pen->words,
                    "No tablet was found. If one is plugged in, its driver is missing: on "
                    "Debian that is the package xserver-xorg-input-wacom.");
    return wr_text_get(&pen->words);
}

/* ---- fingers on a touch screen, through SDL ---- */

/* None while a pen is near. */

static int unit_of(WrPen *pen, SDL_TouchID touch)
{
    for (int i = 0; i < pen->units.count; i++)
        if (pen->units.data[i].shown.finger && !pen->units.data[i].replayed &&
            pen->units.data[i].touch == touch)
            return i;
    const char *name = NULL;
    for (int i = 0; i < SDL_GetNumTouchDevices(); i++)
        if (SDL_GetTouchDevice(i) == touch) name = SDL_GetTouchName(i);
    int index = wr_pen_unit(pen, name ? name : "touch screen", false, true);
    WrPenUnit *unit = &pen->units.data[index];
    unit->touch = touch;
    unit->shown.there = unit->shown.has_pressure = unit->shown.has_place = true;
    return index;
}

static void feed_report(WrPen *pen, int index, const WrTouchOut *out)
{
    WrPenUnit *unit = &pen->units.data[index];
    if (out->report == WR_TOUCH_GRIP || out->report == WR_TOUCH_TAP) {
        const bool grips = out->report == WR_TOUCH_GRIP;
        WrPenEvent event = { .kind = grips ? WR_PEN_GRIP : WR_PEN_TAP,
                             .device = index,
                             .finger = true,
                             .button = grips ? out->begins : out->fingers,
                             .held = unit->held,
                             .x = out->x,
                             .y = out->y,
                             .grip = out->grip,
                             .seconds = out->seconds };
        if (!wr_pen_replaying(pen)) wr_pen_push(pen, &event);
        return;
    }
    WrPenReading r = { .kind = out->report == WR_TOUCH_PRESS     ? WR_PEN_DOWN
                               : out->report == WR_TOUCH_RELEASE ? WR_PEN_UP
                               : out->report == WR_TOUCH_CANCEL  ? WR_PEN_CANCEL
                                                                 : WR_PEN_MOTION,
                       .button = 1,
                       .x = out->x,
                       .y = out->y,
                       .pressure = out->pressure,
                       .seconds = out->seconds };
    wr_pen_feed(pen, index, &r);
}

static void pen_finger_event(WrPen *pen, const SDL_TouchFingerEvent *event)
{
    const SDL_TouchDeviceType type = SDL_GetTouchDeviceType(event->touchId);
    if (event->touchId == SDL_MOUSE_TOUCHID || type == SDL_TOUCH_DEVICE_INDIRECT_ABSOLUTE ||
        type == SDL_TOUCH_DEVICE_INDIRECT_RELATIVE)
        return;
    if (event->windowID != 0 && event->windowID != SDL_GetWindowID(pen->window)) return;
    int index = unit_of(pen, event->touchId), width, height;
    WrPenUnit *unit = &pen->units.data[index];
    if (wr_pen_in_range(pen)) { /* a palm */
        wr_pen_lose(pen, index);
        unit->fingers = (WrTouch){ 0 };
        return;
    }
    SDL_GetWindowSize(pen->window, &width, &height);
    const WrTouchKind kind = event->type == SDL_FINGERDOWN ? WR_TOUCH_DOWN
                             : event->type == SDL_FINGERUP ? WR_TOUCH_UP
                                                           : WR_TOUCH_MOVE;
    const WrFinger finger = { .id = event->fingerId,
                              .x = (double)event->x * width,
                              .y = (double)event->y * height,
                              .pressure = (double)event->pressure,
                              .seconds = wr_pen_seconds(unit, event->timestamp) };
    WrTouchOut out[WR_TOUCH_OUT];
    const int count = wr_touch_event(&unit->fingers, kind, &finger, out);
    for (int i = 0; i < count; i++) feed_report(pen, index, &out[i]);
    pen->came_at = wr_clock_seconds();
}
