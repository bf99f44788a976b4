/* pen_internal.h - shared state of the pen files: pen.c the queue, the values and SDL's touches, pen_x11.c the devices of XInput2,
   pen_record.c files. Private to them, and to tests. */
#pragma once
#include "ui/input/pen.h"
#include "ui/input/pen_curve.h"

#include "base/array.h"
#include "base/text.h"

#include <SDL.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#define WR_PEN_BUTTONS 3 /* 1 the tip, 2 and 3 on the barrel */
#define WR_PEN_KEEP 4096 /* read events that are kept for the tester */

/* One event in the device's own units. */
typedef struct WrPenReading {
    WrPenKind kind;
    int button;            /* DOWN, UP */
    double x, y;           /* pixels of the window */
    double pressure;       /* pressure_low..pressure_high */
    double tilt_x, tilt_y; /* -1..1 */
    double turn_deg;       /* any angle */
    double seconds;
} WrPenReading;

typedef enum WrPenAxisRole {
    WR_PEN_AXIS_X,
    WR_PEN_AXIS_Y,
    WR_PEN_AXIS_PRESSURE,
    WR_PEN_AXIS_TILT_X,
    WR_PEN_AXIS_TILT_Y,
    WR_PEN_AXIS_WHEEL, /* rotation about the pen's own axis */
    WR_PEN_AXES
} WrPenAxisRole;

typedef struct WrPenAxis {
    int number; /* index in the device; -1: missing */
    bool absolute;
    double low, high;
    double value; /* newest: an event contains only changes */
} WrPenAxis;

/* Internal data of a device. */
typedef struct WrPenUnit {
    WrPenDevice shown;
    int server_id; /* on the X server; -1: none */
    WrPenAxis axes[WR_PEN_AXES];
    SDL_TouchID touch; /* SDL's identifier of a touch device */
    WrTouch fingers;   /* its fingers */
    bool replayed;     /* exists only in a file */
    unsigned held;
    double x, y, raw, tilt_x, tilt_y, turn_deg, seconds; /* newest values */
    bool raw_known;
    bool raw_moved;   /* it has changed, hovering included */
    int still;        /* events with the tip down and constant pressure */
    bool clock_known; /* times are synchronised with the window's clock */
    double clock_offset;
    uint32_t clock_last; /* ms as received; they wrap */
    int64_t clock_ms;
} WrPenUnit;

typedef struct WrPenX11 WrPenX11;
typedef struct WrPenWayland WrPenWayland;

/* A key or button event of SDL, and the number of pen events before it. */
typedef struct WrPenMark {
    Uint32 type, timestamp;
    int64_t total;
} WrPenMark;

typedef struct WrPenKept { /* curve for a device name */
    char name[96];
    WrPenCurve curve;
} WrPenKept;

/* A file being replayed. */
typedef struct WrPenReplay {
    WR_ARRAY(WrPenEvent) events;
    int next;
    double speed;
    double delay;    /* seconds before the first event */
    double began_at; /* clock; 0: not read yet */
} WrPenReplay;

struct WrPen {
    SDL_Window *window;    /* borrowed; NULL in tests */
    SDL_threadID thread;   /* the window's thread */
    WrPenX11 *x11;         /* owned; NULL: not on X11 */
    WrPenWayland *wayland; /* owned; NULL: not on Wayland. Without both there are no pens. */
    const char *why_not;
    WR_ARRAY(WrPenUnit) units;
    WR_ARRAY(WrPenKept) kept;
    WR_ARRAY(WrPenEvent) queue; /* some read events, then the unread ones */
    int taken;                  /* read events in the queue */
    int64_t first;              /* number of queue.data[0] among all events */
    WR_ARRAY(WrPenMark) marks;  /* in order of arrival */
    double came_at, taken_at;   /* clock of the last event */
    double pen_at;              /* clock of the last event of a pen, not a finger */
    FILE *record;               /* NULL: none */
    bool record_failed;
    WR_ARRAY(bool) recorded; /* device i is declared in the file */
    WrPenReplay replay;
    WrText words; /* text of the diagnosis */
};

/* ---- pen.c ---- */
/* Index of the device of that kind and name; a new one is added without other data. */
int wr_pen_unit(WrPen *pen, const char *name, bool eraser, bool finger);
/* Convert server milliseconds (wrapping after 49 days) to seconds that never decrease. */
double wr_pen_seconds(WrPenUnit *unit, uint32_t ms);
/* Clamp a reading, count its faults, and add the event to the queue. */
void wr_pen_feed(WrPen *pen, int index, const WrPenReading *reading);
/* Record a device's newest pressure 0..1; down: the tip is down after this event. */
void wr_pen_watch(WrPenUnit *unit, double raw, bool down);
/* The device or its window focus was lost: release its buttons. */
void wr_pen_lose(WrPen *pen, int index);
/* Add an event unchanged to the queue. */
void wr_pen_push(WrPen *pen, const WrPenEvent *event);
/* Record a key or button event of SDL. */
void wr_pen_mark(WrPen *pen, const SDL_Event *event);

/* ---- pen_x11.c, or pen_plain.c on systems without X ---- */
/* NULL: there are no pens, and *why is a sentence with the reason. */
WrPenX11 *wr_pen_x11_new(WrPen *pen, const char **why);
void wr_pen_x11_free(WrPenX11 *x11);
void wr_pen_x11_sync(WrPenX11 *x11);
/* Handle an SDL_SYSWMEVENT inside an event watch. */
void wr_pen_x11_event(WrPen *pen, const SDL_Event *event);

/* ---- pen.c: touches ---- */

/* ---- pen_record.c ---- */
void wr_pen_record_event(WrPen *pen, const WrPenEvent *event);
/* Add due events to the queue. */
void wr_pen_replay_step(WrPen *pen);
void wr_pen_replay_end(WrPen *pen);
/* Evaluate WRINKLE_PEN_RECORD and WRINKLE_PEN_REPLAY. */
void wr_pen_record_start(WrPen *pen);
