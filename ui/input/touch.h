/* touch.h - fingers on a touch screen: one finger is a pointer; two or more pan, zoom and turn, or tap.

   The press of a finger is delayed until it moves or is lifted, so that the first of two fingers does not paint. A stroke that
   began just before the second finger came is cancelled; an older one goes on, and the second finger is ignored.
   Pure; tested without a window. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

#define WR_FINGERS 10

typedef enum WrTouchKind { WR_TOUCH_DOWN, WR_TOUCH_MOVE, WR_TOUCH_UP } WrTouchKind;

/* Motion of two fingers since the previous event. */
typedef struct WrGrip {
    double dx, dy;   /* pixels, of their middle */
    double scale;    /* ratio of their distances, > 0 */
    double turn_deg; /* clockwise; 0 until they have turned by WR_TOUCH_TURN_DEG */
} WrGrip;
#define WR_TOUCH_TURN_DEG 10.0

typedef struct WrFinger {
    int64_t id;
    double x, y;              /* pixels */
    double from_x, from_y;    /* at its press */
    double pressure, seconds; /* at its press */
} WrFinger;

typedef enum WrTouchState {
    WR_TOUCH_NONE,
    WR_TOUCH_WAITS,   /* one finger, not reported yet */
    WR_TOUCH_PAINTS,  /* fingers[0] is the pointer */
    WR_TOUCH_GRIPS,   /* two or more */
    WR_TOUCH_IGNORED, /* until all fingers are lifted */
} WrTouchState;

/* Zeroed: no fingers. */
typedef struct WrTouch {
    WrTouchState state;
    WrFinger fingers[WR_FINGERS]; /* in order of their presses */
    int count, most;              /* fingers that are down; and were, since the first */
    bool moved, turns;            /* the grip moves, and turns, the view */
    double began;                 /* seconds of the first press */
    double x, y, length,
        angle;     /* middle, distance and direction of the first two fingers at the last event */
    double turned; /* degrees since the grip began */
} WrTouch;

typedef enum WrTouchReport {
    WR_TOUCH_PRESS,
    WR_TOUCH_MOTION,
    WR_TOUCH_RELEASE,
    WR_TOUCH_CANCEL, /* the press is taken back */
    WR_TOUCH_GRIP,
    WR_TOUCH_TAP
} WrTouchReport;

typedef struct WrTouchOut {
    WrTouchReport report;
    double x, y; /* of the finger; of a grip or tap: of the middle */
    double pressure, seconds;
    WrGrip grip;
    bool begins; /* the first report of a grip */
    int fingers; /* of a tap */
} WrTouchOut;
#define WR_TOUCH_OUT 2

/* Handle a finger's event; x, y in pixels, seconds increasing. Returns the number of reports in `out`. */
int wr_touch_event(WrTouch *touch, WrTouchKind kind, const WrFinger *finger,
                   WrTouchOut out[WR_TOUCH_OUT]);
