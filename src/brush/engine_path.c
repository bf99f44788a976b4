#include <math.h>
#include <string.h>

#include "brush/engine_internal.h"

#define STRIDE 8.0      /* radii and dabs: maximum motion of one call, ... */
#define NEAR_DAB 4e-6   /* dabs: distances too small for float */
#define STRIDES 65536   /* ... unless this many calls are not enough for a step */
#define CORNER 0.25     /* texels; largest deviation of a step from a corner */
#define FARTHEST 1e15   /* texels from the table's corner; halves are exact there */
#define LONGEST 65536.0 /* texels: the middle of a longer segment between two points is skipped */
/* texels per second: a slower motion is treated as this fast, after the rest */
#define SLOWEST 4.0

/* ---- the path ---- */

static void add_knot(WrEngine *engine, WrEnginePoint point, bool jump)
{
    if (engine->at > 1024) { /* earlier knots are no longer needed */
        engine->knots.count -= engine->at;
        memmove(engine->knots.data, engine->knots.data + engine->at,
                (size_t)engine->knots.count * sizeof *engine->knots.data);
        engine->at = 0;
    }
    wr_array_push(&engine->knots, ((WrKnot){ point, jump }));
}

/* Interpolates the pen between two points. */
static WrEnginePoint between(const WrEnginePoint *a, const WrEnginePoint *b, double seconds)
{
    double length = b->seconds - a->seconds;
    double t = length > 0.0 ? (seconds - a->seconds) / length : 1.0;
    return (WrEnginePoint){ .x = a->x + t * (b->x - a->x),
                            .y = a->y + t * (b->y - a->y),
                            .pressure = a->pressure + t * (b->pressure - a->pressure),
                            .tilt_x = a->tilt_x + t * (b->tilt_x - a->tilt_x),
                            .tilt_y = a->tilt_y + t * (b->tilt_y - a->tilt_y),
                            .seconds = seconds };
}

/* The two ends of a segment that is too long: up to half of LONGEST from each end. */
static void add_jump(WrEngine *engine, const WrEnginePoint *to, double length)
{
    WrEnginePoint from = engine->knots.data[engine->knots.count - 1].point;
    double seconds = (to->seconds - from.seconds) * (LONGEST / length),
           part = 0.5 * LONGEST / length;
    WrEnginePoint halt = between(&from, to, from.seconds + (to->seconds - from.seconds) * part);
    WrEnginePoint go = halt, end = *to;
    go.x = to->x - part * (to->x - from.x);
    go.y = to->y - part * (to->y - from.y);
    halt.seconds = go.seconds = from.seconds + 0.5 * seconds;
    end.seconds = from.seconds + seconds;
    add_knot(engine, halt, false);
    add_knot(engine, go, true);
    add_knot(engine, end, false);
}

void wr_engine_push(WrEngine *engine, const WrEnginePoint *point)
{
    WrEnginePoint next = *point;
    if (!isfinite(next.x) || !isfinite(next.y)) return;
    next.x = clamp(next.x, -FARTHEST, FARTHEST);
    next.y = clamp(next.y, -FARTHEST, FARTHEST);
    next.pressure = clamp(next.pressure, 0.0, 1.0);
    next.tilt_x = isnan(next.tilt_x) ? 0.0 : clamp(next.tilt_x, -1.0, 1.0);
    next.tilt_y = isnan(next.tilt_y) ? 0.0 : clamp(next.tilt_y, -1.0, 1.0);
    next.seconds = 0.0;
    double given = isfinite(point->seconds) ? point->seconds : engine->given, length = 0.0;
    if (engine->knots.count > 0) {
        const WrEnginePoint *last = &engine->knots.data[engine->knots.count - 1].point;
        double dx = next.x - last->x, dy = next.y - last->y;
        length = sqrt(dx * dx + dy * dy);
        double slowest = WR_ENGINE_REST + length / SLOWEST, seconds = given - engine->given;
        if (!(seconds > 0.0)) seconds = length / WR_ENGINE_SPEED;
        next.seconds = last->seconds + (seconds < slowest ? seconds : slowest);
    }
    engine->given = given;
    if (length > LONGEST) {
        add_jump(engine, &next, length);
    } else {
        add_knot(engine, next, false);
    }
}

void wr_engine_finish(WrEngine *engine)
{
    engine->finished = true;
}

/* ---- steps ---- */

/* The pen at a time within the knots. */
static WrEnginePoint pen(const WrEngine *engine, double seconds)
{
    const WrKnot *knots = engine->knots.data;
    int i = engine->at;
    while (i + 2 < engine->knots.count && knots[i + 1].point.seconds < seconds) i++;
    if (i + 1 >= engine->knots.count) return knots[i].point;
    return between(&knots[i].point, &knots[i + 1].point, seconds);
}

/* Squared distance of p from the segment a..b. */
static double off_way(const WrEnginePoint *a, const WrEnginePoint *b, const WrEnginePoint *p)
{
    double dx = b->x - a->x, dy = b->y - a->y, px = p->x - a->x, py = p->y - a->y;
    double length2 = dx * dx + dy * dy;
    double t = length2 > 0.0 ? clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0.0;
    px -= t * dx;
    py -= t * dy;
    return px * px + py * py;
}

/* The step's end: at most `latest`, but a step ends at a corner or a jump on the way. *knot: that
 * corner or jump; 0 if none. */
static double step_end(const WrEngine *engine, double latest, int *knot)
{
    WrEnginePoint from = pen(engine, engine->now), to = pen(engine, latest);
    *knot = 0;
    for (int i = engine->at + 1; i < engine->knots.count; i++) {
        const WrKnot *k = &engine->knots.data[i];
        if (k->point.seconds > latest) break;
        bool jumps = i + 1 < engine->knots.count && k[1].jump;
        if (k->point.seconds < engine->now) continue;
        if (!jumps && (k->point.seconds <= engine->now || k->point.seconds >= latest ||
                       off_way(&from, &to, &k->point) <= CORNER * CORNER))
            continue;
        *knot = i;
        return k->point.seconds;
    }
    return latest;
}

/* The fraction of a call to make, so that it does not end exactly with a dab: all except some
   thousandths of a dab's distance, a power of two. */
static double nudge(const WrEngine *engine, const WrEnginePoint *to, double seconds)
{
    double more = wr_engine_count(engine, to, seconds), all = wr_engine_due(engine) + more;
    bool close = all > 0.5 && fabs(all - rint(all)) < NEAR_DAB * (1.0 + all);
    if (!close) return 1.0;
    if (!(more > 64.0 * NEAR_DAB)) return 0.0;
    double part = 1.0 / 16.0;
    while (part > 1.0 / 4096.0 && more * part > 0.008) part *= 0.5;
    return 1.0 - part;
}

/* Moves to a point in `seconds`, in parts. The parts of a second are exact in binary if the step is. */
static void stride(WrEngine *engine, const WrEnginePoint *to, double seconds)
{
    WrEnginePoint a = engine->pen, b = *to;
    double dx = b.x - a.x, dy = b.y - a.y, length = sqrt(dx * dx + dy * dy);
    double dabs = wr_engine_count(engine, to, seconds), whole = seconds + engine->left;
    int parts = 1;
    while (parts < STRIDES && (length > STRIDE * engine->radius * parts || dabs > STRIDE * parts))
        parts *= 2;
    a.seconds = 0.0;
    b.seconds = parts;
    engine->left = 0.0;
    engine->dabs = 0;
    for (int i = 1; i <= parts; i++) {
        double piece = whole / parts + engine->left;
        WrEnginePoint next = between(&a, &b, i);
        double part = nudge(engine, &next, piece);
        engine->left = piece - piece * part;
        if (part > 0.0) {
            WrEnginePoint from = engine->pen;
            from.seconds = 0.0;
            next.seconds = 1.0;
            if (part < 1.0) next = between(&from, &next, part);
            wr_engine_go(engine, &next, piece * part);
            engine->pen = next;
        }
    }
}

static void pass_jump(WrEngine *engine, int knot)
{
    const WrEnginePoint *halt = &engine->knots.data[knot].point, *go = halt;
    go = &engine->knots.data[knot + 1].point;
    engine->origin_x += go->x - halt->x;
    engine->origin_y += go->y - halt->y;
    engine->last_x += go->x - halt->x;
    engine->last_y += go->y - halt->y;
    engine->pen.x += go->x - halt->x;
    engine->pen.y += go->y - halt->y;
    engine->at = knot + 1;
}

bool wr_engine_step(WrEngine *engine)
{
    if (engine->knots.count == 0) return false;
    if (!engine->begun) {
        WrEnginePoint first = engine->knots.data[0].point;
        wr_engine_begin(engine, &first);
        return true;
    }
    double last = engine->knots.data[engine->knots.count - 1].point.seconds;
    double latest = (engine->steps + 1) * WR_ENGINE_STEP;
    if (latest > last) {
        if (!engine->finished) return false;
        if (engine->ended) {
            if (engine->touched) return false;
            wr_engine_tap(engine);
            return true;
        }
        latest = last;
    }
    int knot;
    double end = step_end(engine, latest, &knot);
    WrEnginePoint to = knot > 0 ? engine->knots.data[knot].point : pen(engine, end);
    if (end > engine->now) stride(engine, &to, end - engine->now);
    engine->now = end;
    engine->ended = engine->finished && end >= last;
    if (end >= (engine->steps + 1) * WR_ENGINE_STEP) engine->steps++;
    while (engine->at + 1 < engine->knots.count &&
           engine->knots.data[engine->at + 1].point.seconds < engine->now)
        engine->at++;
    if (knot > 0 && knot + 1 < engine->knots.count && engine->knots.data[knot + 1].jump)
        pass_jump(engine, knot);
    return true;
}
