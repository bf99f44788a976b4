/* pen.h - tablet input: pressure, tilt, turn, eraser and hover, and fingers with pressure, beside SDL's mouse. Uses XInput2,
   or Wayland's tablet protocol, on SDL's own connection (SDL 2 has no pens); fingers through SDL. On other systems there are
   no pens, and the calls do nothing.

   Events are received in an SDL event watch, with the server's time and sub-pixel positions, and queued until the
   window reads them: none is dropped, however slow a frame was. All other calls are from the window's thread. */
#pragma once
#include "ui/input/pen_curve.h"
#include "ui/input/touch.h"

#include <SDL.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;

typedef enum WrPenKind {
    WR_PEN_MOTION, /* button 0: hover */
    WR_PEN_DOWN,
    WR_PEN_UP,
    WR_PEN_LOST,   /* the device or its window focus was lost: its actions end here */
    WR_PEN_CANCEL, /* a second finger came: the press is taken back */
    WR_PEN_GRIP,   /* two or more fingers move; button 1: the first such event */
    WR_PEN_TAP,    /* two or more fingers tapped; button: their number */
    WR_PEN_KINDS
} WrPenKind;

typedef struct WrPenEvent {
    WrPenKind kind;
    int device;  /* index into the devices */
    bool eraser; /* the eraser end */
    bool finger;
    int button;    /* DOWN, UP: 1 the tip, 2 and 3 on the barrel; also of GRIP and TAP */
    unsigned held; /* bit n: button n is down after this event */
    double x, y;   /* pixels of the window, sub-pixel: 0.5 is the centre of the first */
    double raw;    /* pressure 0..1 from the device, clamped */
    /* pressure after the device's curve; 1 while a device without pressure is down */
    double pressure;
    double tilt_x, tilt_y; /* -1..1, to the right and towards the user; 0 without */
    double turn_deg;       /* about the pen's own axis, clockwise, -180..180; 0 without */
    WrGrip grip;           /* of GRIP */
    double seconds;        /* server time; only differences are meaningful */
} WrPenEvent;

typedef struct WrPenDevice {
    char name[96];
    bool eraser, finger, there;                       /* there: plugged in and enabled */
    bool has_pressure, has_tilt, has_turn, has_place; /* capabilities claimed by the device */
    double pressure_low, pressure_high;               /* range of the axis */
    /* statistics */
    int64_t events, presses, bad_values;
    double raw_least, raw_most; /* while pressed */
    bool pressure_moves;        /* it has changed while pressed */
    WrPenCurve curve;
} WrPenDevice;

typedef struct WrPen WrPen;

/* SDL's mouse events with this `which` are made of a pen's, for the widgets. */
#define WR_PEN_MOUSEID ((Uint32)-3)

/* Never fails: without XInput 2.2 or Wayland's tablet protocol there are no pens. window is borrowed. */
WrPen *wr_pen_new(SDL_Window *window);
void wr_pen_free(WrPen *pen); /* NULL is allowed */

/* The oldest unread event; false if there is none. */
bool wr_pen_next(WrPen *pen, WrPenEvent *event);
/* The oldest unread event before `before`, an event of SDL's keyboard or of a mouse button. Keeps the order of user
 * actions even if many events arrive in one frame. Call until it returns false. */
bool wr_pen_next_before(WrPen *pen, const SDL_Event *before, WrPenEvent *event);
/* True if SDL's mouse events only duplicate those of a pen, so that the canvas must ignore them (widgets use them):
   while a pen is down, and for 0.1 s after its last event. */
bool wr_pen_moves_mouse(const WrPen *pen);
/* True if a pen is near the surface: fingers are then palms. */
bool wr_pen_in_range(const WrPen *pen);

int wr_pen_device_count(const WrPen *pen);
const WrPenDevice *wr_pen_device(const WrPen *pen, int index);
/* Set the pressure curve of a device, and of a present or future device of that name. Curves are stored by name. An
   invalid curve changes nothing. */
void wr_pen_set_curve(WrPen *pen, int index, const WrPenCurve *curve);
void wr_pen_keep_curve(WrPen *pen, const char *name, const WrPenCurve *curve);
/* Suspected fault of a device in one or two sentences, with the remedy; "" if none. Valid until the next call. index
   -1: reason for having no pens at all. */
const char *wr_pen_diagnosis(WrPen *pen, int index);
/* The newest event of any device, read or not, for the tester. */
bool wr_pen_newest(const WrPen *pen, WrPenEvent *event);
/* Number of all events so far, and of unread ones. None is ever dropped. */
int64_t wr_pen_total(const WrPen *pen);
int wr_pen_waiting(const WrPen *pen);
/* Event number 0..total - 1, read or not; false if it was dropped. The last 4096 are always kept. */
bool wr_pen_event_at(const WrPen *pen, int64_t number, WrPenEvent *event);

/* Record all events to a text file, one per line, as they arrive; "" ends it. And replay such a file in place of
 * devices: `speed` times as fast as recorded, 0: each one as soon as the previous was read. Devices of the file are
 * matched by name and kind, or added. "" ends a replay; held buttons are then released as lost.
 *
 *   wrinkle-pen 1                                            the first line
 *   device INDEX KIND PRESSURE TILT LOW HIGH NAME            before its first event. KIND: pen, eraser or
 *                                                            finger; PRESSURE, TILT: 1 if it has one
 *   EVENT SECONDS INDEX BUTTON HELD X Y RAW PRESSURE TILT_X TILT_Y [TURN [DX DY SCALE GRIP_TURN]]
 *                                                            as in WrPenEvent; EVENT: motion, down, up, lost,
 *                                                            cancel, grip or tap
 *
 * Lines that begin with # are comments. Errors contain the line number: syntax, range, decreasing time, or
 * inconsistent held buttons. Nothing is replayed then. */
bool wr_pen_record(WrPen *pen, const char *path, WrError *err);
bool wr_pen_replay(WrPen *pen, const char *path, double speed, WrError *err);
bool wr_pen_replaying(const WrPen *pen);
/* Seconds until wr_pen_next should be called again even without an event of SDL; 0: not necessary. */
double wr_pen_wait(const WrPen *pen);
/* When this returns, SDL can read every event that the X server has now. */
void wr_pen_sync(WrPen *pen);
