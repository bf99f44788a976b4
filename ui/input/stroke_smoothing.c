#include "ui/input/stroke_smoothing.h"

#include <math.h>

#define STEP 3.0 /* pixels along the pointer's path between points of a curve */

static double mix(double a, double b, double t)
{
    return a + t * (b - a);
}

static WrSmoothingPoint between(const WrSmoothingPoint *a, const WrSmoothingPoint *b, double t)
{
    return (WrSmoothingPoint){ mix(a->x, b->x, t),
                               mix(a->y, b->y, t),
                               mix(a->pressure, b->pressure, t),
                               mix(a->tilt_x, b->tilt_x, t),
                               mix(a->tilt_y, b->tilt_y, t),
                               mix(a->seconds, b->seconds, t) };
}

void wr_smoothing_begin(WrSmoothing *steady, WrSmoothingKind kind, double length,
                        const WrSmoothingPoint *at)
{
    steady->kind = length > 0.0 ? kind : WR_SMOOTHING_OFF;
    steady->length = length;
    steady->pointer = steady->follower = *at;
}

/* Position of the follower after the pointer has moved `s` pixels from `a` in the direction (mx, my). */
static void follow_smooth(const WrSmoothing *steady, const WrSmoothingPoint *a, double mx,
                          double my, double s, double *x, double *y)
{
    double length = steady->length, decay = exp(-s / length);
    double lag = s + length * (decay - 1.0); /* s - L + L exp(-s/L), without cancellation at 0 */
    *x = a->x + mx * lag + (steady->follower.x - a->x) * decay;
    *y = a->y + my * lag + (steady->follower.y - a->y) * decay;
}

/* Position of the follower on a string. True if it was dragged. */
static bool follow_string(const WrSmoothing *steady, const WrSmoothingPoint *a, double mx,
                          double my, double s, double *x, double *y)
{
    double length = steady->length, px = steady->follower.x, py = steady->follower.y;
    /* vector from the follower to the pointer: along and across the pointer's path */
    double dx = a->x - px, dy = a->y - py;
    double along = dx * mx + dy * my, across = dy * mx - dx * my;
    double reach = length * length - across * across;
    double half = reach > 0.0 ? sqrt(reach) : 0.0;
    double slack = half - along; /* distance until the string is taut */
    if (s <= slack) return false;
    if (slack > 0.0) along = half;
    double dragged = slack > 0.0 ? s - slack : s;
    /* Taut: along = L cos t, across = L sin t. A string left slightly too long by rounding is not pulled in. */
    double t = atan2(across, along);
    t = 2.0 * atan(tan(t / 2.0) * exp(-dragged / length));
    double qx = a->x + mx * s, qy = a->y + my * s;
    *x = qx - length * (cos(t) * mx - sin(t) * my);
    *y = qy - length * (cos(t) * my + sin(t) * mx);
    return true;
}

int wr_smoothing_move(WrSmoothing *steady, const WrSmoothingPoint *to,
                      WrSmoothingPoint out[WR_SMOOTHING_POINTS])
{
    const WrSmoothingPoint from = steady->pointer;
    double dx = to->x - from.x, dy = to->y - from.y, way = hypot(dx, dy);
    if (steady->kind == WR_SMOOTHING_OFF) {
        steady->pointer = steady->follower = *to;
        out[0] = *to;
        return 1;
    }
    if (!(way > 0.0)) { /* only pressure, tilt or time changed */
        steady->pointer = *to;
        return 0;
    }
    int steps = way > STEP * WR_SMOOTHING_POINTS ? WR_SMOOTHING_POINTS : (int)ceil(way / STEP);
    int count = 0;
    for (int i = 1; i <= steps; i++) {
        double t = (double)i / steps, x = 0.0, y = 0.0;
        bool moved = true;
        if (steady->kind == WR_SMOOTHING_SMOOTH)
            follow_smooth(steady, &from, dx / way, dy / way, way * t, &x, &y);
        else moved = follow_string(steady, &from, dx / way, dy / way, way * t, &x, &y);
        if (!moved) continue;
        out[count] = between(&from, to, t);
        out[count].x = x;
        out[count].y = y;
        count++;
    }
    if (count > 0) steady->follower = out[count - 1];
    steady->pointer = *to;
    return count;
}

int wr_smoothing_end(WrSmoothing *steady, bool catch_up, WrSmoothingPoint *out)
{
    bool comes =
        steady->kind == WR_SMOOTHING_SMOOTH || (steady->kind == WR_SMOOTHING_STRING && catch_up);
    const WrSmoothingPoint *p = &steady->pointer, *f = &steady->follower;
    if (!comes || (p->x == f->x && p->y == f->y)) return 0;
    *out = steady->follower = steady->pointer;
    return 1;
}
