/* Fingers on a touch screen, through SDL: one at a time, and none while a pen is near. */
#include "ui/input/pen.h"
#include "ui/input/pen_internal.h"

#include <SDL.h>

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

void wr_pen_finger_event(WrPen *pen, const SDL_TouchFingerEvent *event)
{
    if (event->touchId == SDL_MOUSE_TOUCHID ||
        SDL_GetTouchDeviceType(event->touchId) != SDL_TOUCH_DEVICE_DIRECT)
        return;
    if (event->windowID != 0 && event->windowID != SDL_GetWindowID(pen->window)) return;
    int index = unit_of(pen, event->touchId), width, height;
    WrPenUnit *unit = &pen->units.data[index];
    if (wr_pen_in_range(pen)) { /* a palm */
        wr_pen_lose(pen, index);
        return;
    }
    bool down = event->type == SDL_FINGERDOWN;
    if (down ? unit->held != 0 : unit->held == 0 || unit->finger != event->fingerId) return;
    unit->finger = event->fingerId;
    SDL_GetWindowSize(pen->window, &width, &height);
    WrPenReading r = { .kind = down                          ? WR_PEN_DOWN
                               : event->type == SDL_FINGERUP ? WR_PEN_UP
                                                             : WR_PEN_MOTION,
                       .button = 1,
                       .x = (double)event->x * width,
                       .y = (double)event->y * height,
                       .pressure = (double)event->pressure,
                       .seconds = wr_pen_seconds(unit, event->timestamp) };
    wr_pen_feed(pen, index, &r);
}
