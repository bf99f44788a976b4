/* pen.h - tablets: pressure, tilt, eraser and hover, and fingers with pressure, beside SDL's mouse.
   XInput2 on SDL's own X11 connection (SDL 2 has no pens); fingers through SDL. Elsewhere there are no
   pens, and the calls do nothing.

   Events are taken in an SDL event watch, with the server's clock and sub-pixel places, and kept in a
   queue until the window asks: none is dropped, however slow a picture was. All other calls come from
   the window's thread. */
#pragma once
#include "ui/input/pen_curve.h"

#include <SDL.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;

typedef enum WrPenKind {
    WR_PEN_MOTION, /* button 0: hover */
    WR_PEN_DOWN,
    WR_PEN_UP,
    WR_PEN_LOST, /* the device went away, or the window lost it: what it did ends here */
    WR_PEN_KINDS
} WrPenKind;

typedef struct WrPenEvent {
    WrPenKind kind;
    int device;  /* index into the devices */
    bool eraser; /* the other end */
    bool finger;
    int button;      /* DOWN, UP: 1 the tip, 2 and 3 on the barrel */
    unsigned held;   /* bit n: button n is down after this event */
    double x, y;     /* pixels of the window, sub-pixel: 0.5 is the middle of the first */
    double raw;      /* pressure 0..1 as the device says, brought into range */
    double pressure; /* the same by the device's curve; 1 while a device without pressure is down */
    double tilt_x, tilt_y; /* -1..1, to the right and towards the user; 0 without */
    double seconds;        /* of the server's clock; only differences mean something */
} WrPenEvent;

typedef struct WrPenDevice {
    char name[96];
    bool eraser, finger, there;             /* there: plugged in and enabled */
    bool has_pressure, has_tilt, has_place; /* what it promises */
    double pressure_low, pressure_high;     /* its range */
    /* what came so far */
    int64_t events, presses, bad_values;
    double raw_least, raw_most; /* while pressed */
    bool pressure_moves;        /* it ever changed while pressed */
    WrPenCurve curve;
} WrPenDevice;

typedef struct WrPen WrPen;

/* Never fails: without an X11 window, or XInput 2.2, there are no pens. window is borrowed. */
WrPen *wr_pen_new(SDL_Window *window);
void wr_pen_free(WrPen *pen); /* NULL is fine */

/* The oldest event that was not taken yet; false if there is none. */
bool wr_pen_next(WrPen *pen, WrPenEvent *event);
/* The same of those that came before `before`, an event of SDL's keyboard or of a mouse button: what hands did
 * one after another is done so, however many events one picture was late. Ask until it is false. */
bool wr_pen_next_before(WrPen *pen, const SDL_Event *before, WrPenEvent *event);
/* SDL's mouse events for the canvas are only the echo of a pen: leave them out (widgets keep them). True
   while a pen is down, and for 0.1 s after its last event. */
bool wr_pen_moves_mouse(const WrPen *pen);
/* A pen is near the surface: fingers are palms. */
bool wr_pen_in_range(const WrPen *pen);

int wr_pen_device_count(const WrPen *pen);
const WrPenDevice *wr_pen_device(const WrPen *pen, int index);
/* Pressure curves are kept by the device's name: that of one that is there, and that of one that is, or
   will be, called so. A curve that is not valid changes nothing. */
void wr_pen_set_curve(WrPen *pen, int index, const WrPenCurve *curve);
void wr_pen_keep_curve(WrPen *pen, const char *name, const WrPenCurve *curve);
/* What seems to be wrong with a device, in one or two sentences, and what to do; "" if all is well. The
   words belong to the pen until the next call. index -1: why there are no pens at all. */
const char *wr_pen_diagnosis(WrPen *pen, int index);
/* The newest event of any device, taken or not, for the tester. */
bool wr_pen_newest(const WrPen *pen, WrPenEvent *event);
/* How many events ever came, and how many of them wait to be taken. None is ever dropped. */
int64_t wr_pen_total(const WrPen *pen);
int wr_pen_waiting(const WrPen *pen);
/* Event number 0..total - 1, taken or not; false if it is forgotten. The last 4096 never are. */
bool wr_pen_recent(const WrPen *pen, int64_t number, WrPenEvent *event);

/* Write every event to a text file, one a line, as it comes; "" ends it. And feed such a file back in
 * place of devices: `speed` times as fast as it was, 0: each as soon as the last was taken. Devices of
 * the file are found by name and kind, or added. "" ends a replay; what is held then is lost.
 *
 *   wrinkle-pen 1                                            the first line
 *   device INDEX KIND PRESSURE TILT LOW HIGH NAME            before its first event. KIND: pen, eraser or
 *                                                            finger; PRESSURE, TILT: 1 if it has one
 *   EVENT SECONDS INDEX BUTTON HELD X Y RAW PRESSURE TILT_X TILT_Y    as in WrPenEvent; EVENT: motion,
 *                                                            down, up or lost
 *
 * A line that begins with # is passed over. Errors name the line: what does not parse, is out of range,
 * runs back in time, or says that buttons are held that are not. Nothing is replayed then. */
bool wr_pen_record(WrPen *pen, const char *path, WrError *err);
bool wr_pen_replay(WrPen *pen, const char *path, double speed, WrError *err);
bool wr_pen_replaying(const WrPen *pen);
/* Every event that the X server has by now is in SDL's reach when this returns. */
void wr_pen_sync(WrPen *pen);
