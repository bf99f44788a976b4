/* pen_internal.h - what the files of the pen share: pen.c the queue and the numbers, pen_x11.c the devices
   of XInput2, pen_finger.c SDL's touches, pen_record.c files. Nobody else includes it, but for tests. */
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
#define WR_PEN_KEEP 4096 /* events that were taken and are kept for the tester */

/* One event in the device's own units, as it came. */
typedef struct WrPenReading {
    WrPenKind kind;
    int button;            /* DOWN, UP */
    double x, y;           /* pixels of the window */
    double pressure;       /* pressure_low..pressure_high */
    double tilt_x, tilt_y; /* -1..1 */
    double seconds;
} WrPenReading;

typedef enum WrPenAxisRole {
    WR_PEN_AXIS_X,
    WR_PEN_AXIS_Y,
    WR_PEN_AXIS_PRESSURE,
    WR_PEN_AXIS_TILT_X,
    WR_PEN_AXIS_TILT_Y,
    WR_PEN_AXES
} WrPenAxisRole;

typedef struct WrPenAxis {
    int number; /* of the device; -1: it has none */
    bool absolute;
    double low, high;
    double value; /* newest: an event only tells what changed */
} WrPenAxis;

/* A device with what only the pen knows. */
typedef struct WrPenUnit {
    WrPenDevice shown;
    int server_id; /* of the X server; -1: none */
    WrPenAxis axes[WR_PEN_AXES];
    SDL_TouchID touch;   /* of a finger device */
    SDL_FingerID finger; /* the one that is down */
    bool replayed;       /* known only from a file */
    unsigned held;
    double x, y, raw, tilt_x, tilt_y, seconds; /* newest */
    bool raw_known;
    bool raw_moved;   /* it ever changed, also while hovering */
    int still;        /* events with the tip down while it never did */
    bool clock_known; /* times are put on the window's clock */
    double clock_offset;
    uint32_t clock_last; /* ms as they came; they wrap */
    int64_t clock_ms;
} WrPenUnit;

typedef struct WrPenX11 WrPenX11;

/* A key or button of SDL's, and how many events of pens had come before it. */
typedef struct WrPenMark {
    Uint32 type, timestamp;
    int64_t total;
} WrPenMark;

typedef struct WrPenKept { /* a curve for whatever is called so */
    char name[96];
    WrPenCurve curve;
} WrPenKept;

/* A file that is being fed back. */
typedef struct WrPenReplay {
    WR_ARRAY(WrPenEvent) events;
    int next;
    double speed;
    double delay;    /* seconds before the first */
    double began_at; /* clock; 0: nobody has asked yet */
} WrPenReplay;

struct WrPen {
    SDL_Window *window;  /* borrowed; NULL in tests */
    SDL_threadID thread; /* the window's */
    WrPenX11 *x11;       /* owned; NULL: no pens */
    const char *why_not;
    WR_ARRAY(WrPenUnit) units;
    WR_ARRAY(WrPenKept) kept;
    WR_ARRAY(WrPenEvent) queue; /* from some that were taken to the newest */
    int taken;                  /* of the queue */
    int64_t first;              /* number of queue.data[0] among all that ever came */
    WR_ARRAY(WrPenMark) marks;  /* in the order in which they came */
    double came_at, taken_at;   /* clock, of the last event */
    double pen_at;              /* clock, of the last event of a pen, not a finger */
    FILE *record;               /* NULL: none */
    bool record_failed;
    WR_ARRAY(bool) recorded; /* device i is declared in the file */
    WrPenReplay replay;
    WrText words; /* of the diagnosis */
};

/* ---- pen.c ---- */
/* A device of that kind and name, old or new; nothing else of a new one is set. */
int wr_pen_unit(WrPen *pen, const char *name, bool eraser, bool finger);
/* Server milliseconds (they wrap after 49 days) as seconds that never run backwards. */
double wr_pen_seconds(WrPenUnit *unit, uint32_t ms);
/* Bring a reading into range, count what is wrong with it, and put the event into the queue. */
void wr_pen_feed(WrPen *pen, int index, const WrPenReading *reading);
/* Note a device's newest pressure 0..1; down: with the tip down after this event. */
void wr_pen_watch(WrPenUnit *unit, double raw, bool down);
/* The device went away, or the window lost it: what it holds is let go. */
void wr_pen_lose(WrPen *pen, int index);
/* An event as it is, into the queue. */
void wr_pen_push(WrPen *pen, const WrPenEvent *event);
/* A key or button of SDL's came. */
void wr_pen_mark(WrPen *pen, const SDL_Event *event);

/* ---- pen_x11.c, or pen_plain.c where a system has no such file ---- */
/* NULL: there are no pens, and *why is a sentence that says why not. */
WrPenX11 *wr_pen_x11_new(WrPen *pen, const char **why);
void wr_pen_x11_free(WrPenX11 *x11);
void wr_pen_x11_sync(WrPenX11 *x11);
/* An SDL_SYSWMEVENT inside an event watch. */
void wr_pen_x11_event(WrPen *pen, const SDL_Event *event);

/* ---- pen_finger.c ---- */
void wr_pen_finger_event(WrPen *pen, const SDL_TouchFingerEvent *event);

/* ---- pen_record.c ---- */
void wr_pen_record_event(WrPen *pen, const WrPenEvent *event);
/* Put what is due into the queue. */
void wr_pen_replay_step(WrPen *pen);
void wr_pen_replay_end(WrPen *pen);
/* WRINKLE_PEN_RECORD and WRINKLE_PEN_REPLAY. */
void wr_pen_record_start(WrPen *pen);
