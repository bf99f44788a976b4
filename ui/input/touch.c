/* Fingers on a touch screen: a state machine of presses, motions and releases. */
#include "ui/input/touch.h"

#include "base/exactmath.h"

#include <math.h>
#include <string.h>

#define SLOP 8.0           /* pixels: a finger that moves less rests */
#define TAP_SECONDS 0.4    /* from the first press to the last release */
#define CANCEL_SECONDS 0.5 /* a stroke of this age goes on when a second finger comes */
#define SHORTEST 20.0      /* pixels: closer fingers neither zoom nor turn */

static int finger_of(const WrTouch *t, int64_t id)
{
    for (int i = 0; i < t->count; i++)
        if (t->fingers[i].id == id) return i;
    return -1;
}

static bool has_moved(const WrFinger *f)
{
    return hypot(f->x - f->from_x, f->y - f->from_y) > SLOP;
}

static WrTouchOut report(WrTouchReport kind, const WrFinger *f)
{
    return (WrTouchOut){
        .report = kind, .x = f->x, .y = f->y, .pressure = f->pressure, .seconds = f->seconds
    };
}

/* At the place and time of its press. */
static WrTouchOut report_press(const WrFinger *f)
{
    WrTouchOut out = report(WR_TOUCH_PRESS, f);
    out.x = f->from_x;
    out.y = f->from_y;
    return out;
}

/* Start the next motion at the present places of the fingers. */
static void measure(WrTouch *t)
{
    const WrFinger *a = &t->fingers[0], *b = &t->fingers[t->count > 1 ? 1 : 0];
    t->x = 0.5 * (a->x + b->x);
    t->y = 0.5 * (a->y + b->y);
    t->length = hypot(b->x - a->x, b->y - a->y);
    t->angle = atan2(b->y - a->y, b->x - a->x) * WR_DEG_PER_RAD;
}

static int press(WrTouch *t, const WrFinger *finger, WrTouchOut *out)
{
    if (t->count >= WR_FINGERS || finger_of(t, finger->id) >= 0) return 0;
    int count = 0;
    WrFinger f = *finger;
    f.from_x = f.x;
    f.from_y = f.y;
    t->fingers[t->count++] = f;
    if (t->state == WR_TOUCH_NONE) {
        t->state = WR_TOUCH_WAITS;
        t->began = f.seconds;
        t->moved = t->turns = false;
        t->most = 1;
        t->turned = 0.0;
        return 0;
    }
    if (t->state == WR_TOUCH_PAINTS && f.seconds - t->began < CANCEL_SECONDS) {
        out[count++] = report(WR_TOUCH_CANCEL, &t->fingers[0]);
        t->state = WR_TOUCH_GRIPS;
        t->began = -INFINITY; /* no tap */
    }
    if (t->state == WR_TOUCH_WAITS) t->state = WR_TOUCH_GRIPS;
    if (t->count > t->most) t->most = t->count;
    measure(t);
    return count;
}

static int grip(WrTouch *t, const WrFinger *f, WrTouchOut *out)
{
    const WrTouch before = *t;
    if (t->count < 2) return 0;
    measure(t);
    *out = report(WR_TOUCH_GRIP, f);
    out->begins = !t->moved;
    if (!t->moved) {
        for (int i = 0; i < t->count; i++)
            if (has_moved(&t->fingers[i])) t->moved = true;
        if (!t->moved) return 0;
    }
    const bool apart = t->length >= SHORTEST && before.length >= SHORTEST;
    const double turn = apart ? wr_signed_degrees(t->angle - before.angle) : 0.0;
    out->x = t->x;
    out->y = t->y;
    out->grip = (WrGrip){ .dx = t->x - before.x,
                          .dy = t->y - before.y,
                          .scale = apart ? t->length / before.length : 1.0,
                          .turn_deg = t->turns ? turn : 0.0 };
    t->turned += turn;
    if (fabs(t->turned) > WR_TOUCH_TURN_DEG) t->turns = true;
    return 1;
}

static int move(WrTouch *t, const WrFinger *finger, WrTouchOut *out)
{
    const int i = finger_of(t, finger->id);
    if (i < 0) return 0;
    WrFinger *f = &t->fingers[i];
    int count = 0;
    f->x = finger->x;
    f->y = finger->y;
    if (t->state == WR_TOUCH_GRIPS) return grip(t, finger, out);
    if (t->state == WR_TOUCH_WAITS && has_moved(f)) {
        out[count++] = report_press(f);
        t->state = WR_TOUCH_PAINTS;
    }
    if (t->state == WR_TOUCH_PAINTS && i == 0) out[count++] = report(WR_TOUCH_MOTION, finger);
    return count;
}

static int lift(WrTouch *t, const WrFinger *finger, WrTouchOut *out)
{
    const int i = finger_of(t, finger->id);
    if (i < 0) return 0;
    const WrFinger f = t->fingers[i];
    int count = 0;
    memmove(&t->fingers[i], &t->fingers[i + 1], (size_t)(WR_FINGERS - 1 - i) * sizeof *t->fingers);
    t->count--;
    if (t->state == WR_TOUCH_WAITS) out[count++] = report_press(&f);
    if (t->state == WR_TOUCH_WAITS || (t->state == WR_TOUCH_PAINTS && i == 0)) {
        out[count++] = report(WR_TOUCH_RELEASE, finger);
        t->state = WR_TOUCH_IGNORED;
    }
    if (t->count == 0 && t->state == WR_TOUCH_GRIPS && !t->moved &&
        finger->seconds - t->began < TAP_SECONDS) {
        out[count] = report(WR_TOUCH_TAP, finger);
        out[count++].fingers = t->most;
    }
    if (t->count > 0) measure(t);
    else t->state = WR_TOUCH_NONE;
    return count;
}

int wr_touch_event(WrTouch *touch, WrTouchKind kind, const WrFinger *finger,
                   WrTouchOut out[WR_TOUCH_OUT])
{
    return kind == WR_TOUCH_DOWN   ? press(touch, finger, out)
           : kind == WR_TOUCH_MOVE ? move(touch, finger, out)
                                   : lift(touch, finger, out);
}
