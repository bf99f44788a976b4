#include "base/exactmath.h"
#include "base/memory.h"
#include "brush/brush.h"
#include "brush/dab.h"
#include "brush/paint.h"
#include "brush/mypaint_engine.h"
#include "brush/mesh_dab.h"
#include "brush/tip.h"
#include "field/field.h"
#include "system/clock.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct WrSpaced {
    const WrBrush *brush; /* sane; borrowed */
    const WrField *field; /* for its size; borrowed; NULL: on a mesh, without ends */
    bool begun;           /* `from` is valid */
    WrDab from, to; /* the ends of the present piece of the path: x, y, and pressure as alpha */
    double length, done; /* of the piece; position of the last dab along it, negative: before it */
    double step;         /* from the last dab to the next */
    uint64_t number;     /* of the next dab */
    double last_x, last_y; /* position of the last dab on the path */
    bool holds;            /* the first dab is held until the second defines a direction, */
    bool waits;            /* and the second until the first is drawn */
    double first_pressure;
    WrDab first, second;
} WrSpaced;

/* ---- dab spacing ---- */

#define LEAST_STEP 0.25 /* texels */
#define NEARLY 1e-6     /* texels: tolerance for a dab at the path's end */

/* Random number `which` of a dab, 0 <= x < 1. */
static double chance(const WrSpaced *s, uint64_t number, unsigned which)
{
    uint64_t z = s->brush->seed + 0x9e3779b97f4a7c15u * (8 * number + which + 1);
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    z ^= z >> 31;
    return (double)(z >> 11) * 0x1p-53;
}

static bool sizes(const WrBrush *brush)
{
    return brush->pressure == WR_PRESSURE_SIZE || brush->pressure == WR_PRESSURE_BOTH;
}

static bool strengthens(const WrBrush *brush)
{
    return brush->pressure == WR_PRESSURE_STRENGTH || brush->pressure == WR_PRESSURE_BOTH;
}

/* At very low pressure the step is that of 1/64 of the brush, so that every path ends. */
static double step_after(const WrBrush *brush, double pressure)
{
    double part = sizes(brush) ? (pressure > 1.0 / 64.0 ? pressure : 1.0 / 64.0) : 1.0;
    double step = brush->spacing * brush->radius * part;
    return step > LEAST_STEP ? step : LEAST_STEP;
}

/* (dx, dy): the path's direction at the dab. */
static void turn(const WrSpaced *s, uint64_t number, double pressure, double dx, double dy,
                 WrDab *dab)
{
    const WrBrush *brush = s->brush;
    double turns = brush->angle_deg / 360.0;
    if (brush->jitter_angle_deg > 0.0)
        turns += (2.0 * chance(s, number, 2) - 1.0) * brush->jitter_angle_deg / 360.0;
    dab->angle_rad = 2.0 * WR_PI * (turns - floor(turns));
    if (!brush->follow && !brush->tip) return;
    double way_rad = dx != 0.0 || dy != 0.0 ? wr_atan2(-dy, dx) : 0.0;
    if (brush->follow) dab->angle_rad += way_rad;
    if (brush->tip)
        dab->tip_cell = wr_tip_pick(brush->tip, number, way_rad, pressure, chance(s, number, 4));
}

/* The dab at (x, y) of the path. */
static WrDab dab_at(const WrSpaced *s, double x, double y, double pressure, double dx, double dy)
{
    uint64_t number = s->number;
    const WrBrush *brush = s->brush;
    WrDab dab = { .x = x,
                  .y = y,
                  .radius = brush->radius * (sizes(brush) ? pressure : 1.0),
                  .hardness = brush->hardness,
                  .alpha = brush->flow * (strengthens(brush) ? pressure : 1.0),
                  .aspect = brush->aspect,
                  .dx = dx,
                  .dy = dy };
    if (brush->jitter_size > 0.0) dab.radius *= 1.0 - brush->jitter_size * chance(s, number, 3);
    if (brush->jitter_place > 0.0) { /* uniformly over a disc */
        double sine, cosine, far = brush->jitter_place * brush->radius;
        far *= sqrt(chance(s, number, 0));
        wr_sincos_turns(chance(s, number, 1), &sine, &cosine);
        dab.x += far * cosine;
        dab.y += far * sine;
    }
    turn(s, number, pressure, dx, dy, &dab);
    return dab;
}

/* Adds the next point of the path; spaced_next must have returned false since the previous one.
 * Texels, not wrapped; pressure 0..1. */
static void spaced_push(WrSpaced *s, double x, double y, double pressure)
{
    WrDab to = { .x = x, .y = y, .alpha = pressure };
    s->from = s->begun ? s->to : to;
    s->to = to;
    double dx = to.x - s->from.x, dy = to.y - s->from.y;
    s->done -= s->length;
    s->length = sqrt(dx * dx + dy * dy);
    if (!s->begun) {
        s->begun = true;
        s->done = s->step = 0.0;
        s->length = 0.0;
    }
}

/* First position along the piece where a dab may touch a clamped table: *low as a fraction of its
 * length; above 1 if never. */
static void meets(double from, double way, double margin, int n, double *low, double *high)
{
    if (way == 0.0) {
        if (from < -margin || from > n + margin) *low = 2.0;
        return;
    }
    double a = (-margin - from) / way, b = (n + margin - from) / way;
    if (a > b) {
        double c = a;
        a = b;
        b = c;
    }
    *low = a > *low ? a : *low;
    *high = b < *high ? b : *high;
}

/* Steps over positions far outside a clamped table are skipped at once. */
static void skip(WrSpaced *s)
{
    if (!s->field) return;
    double margin = s->brush->radius * (2.0 + s->brush->jitter_place) + 2.0;
    double low = 0.0, high = 1.0;
    if (wr_field_wrap_u(s->field) == WR_WRAP_CLAMP)
        meets(s->from.x, s->to.x - s->from.x, margin, wr_field_width(s->field), &low, &high);
    if (wr_field_wrap_v(s->field) == WR_WRAP_CLAMP)
        meets(s->from.y, s->to.y - s->from.y, margin, wr_field_height(s->field), &low, &high);
    if (low > high || s->done >= high * s->length) low = 1.0;
    double steps = floor((low * s->length - s->done) / s->step) - 1.0;
    if (!(steps >= 1.0)) return;
    s->done += steps * s->step;
    s->number += (uint64_t)steps;
    double t = s->done / s->length;
    s->last_x = s->from.x + t * (s->to.x - s->from.x);
    s->last_y = s->from.y + t * (s->to.y - s->from.y);
}

/* The next dab, if the piece reaches it. */
static bool due(WrSpaced *s, WrDab *dab)
{
    bool first = s->number == 0;
    if (!first) skip(s);
    if (!s->begun || (!first && s->done + s->step > s->length + NEARLY)) return false;
    s->done += s->step;
    double t = s->length > 0.0 ? s->done / s->length : 1.0;
    t = t > 0.0 ? (t < 1.0 ? t : 1.0) : 0.0;
    double x = s->from.x + t * (s->to.x - s->from.x), y = s->from.y + t * (s->to.y - s->from.y);
    double pressure = s->from.alpha + t * (s->to.alpha - s->from.alpha);
    double dx = first ? 0.0 : x - s->last_x, dy = first ? 0.0 : y - s->last_y;
    *dab = dab_at(s, x, y, pressure, dx, dy);
    s->step = step_after(s->brush, pressure);
    s->last_x = x;
    s->last_y = y;
    s->number++;
    return true;
}

/* The next dab up to that point; false if there is none. */
static bool spaced_next(WrSpaced *s, WrDab *dab)
{
    if (s->waits) {
        s->waits = false;
        *dab = s->second;
        return true;
    }
    WrDab made;
    if (!due(s, &made)) return false;
    if (s->brush->follow && s->number == 1) { /* no direction yet */
        s->holds = true;
        s->first = made;
        s->first_pressure = s->from.alpha;
        if (!due(s, &made)) return false;
    }
    *dab = made;
    if (!s->holds) return true;
    s->holds = false;
    s->waits = true;
    s->second = made;
    *dab = s->first;
    turn(s, 0, s->first_pressure, made.dx, made.dy, dab);
    return true;
}

/* At the end of the path: a first dab that is still held. */
static bool spaced_last(WrSpaced *s, WrDab *dab)
{
    if (!s->holds) return false;
    s->holds = false;
    *dab = s->first;
    return true;
}

#define ON_THE_WAY 0.25             /* texels */
#define PIECES_MAX 65536.0          /* of the way between two samples on a mesh */
#define SAME_PRESSURE (1.0 / 128.0) /* smaller pressure differences are ignored */

typedef struct Spot {
    double x, y; /* texels, from wr_paint_place */
    double pressure, tilt_x, tilt_y, turn_deg, seconds;
    WrMeshStep step; /* on a mesh: x and y are developed */
    int64_t number;  /* of the stroke's sample that it belongs to, from 1 */
} Spot;

struct WrStroke {
    WrDraw draw;
    WrPreset *preset; /* shared, or NULL */
    WrTip *tip;
    WR_ARRAY(Spot) queue;
    int taken;              /* from the queue */
    int64_t samples, drawn; /* numbers of the last one pushed, and of the last one in the heights */
    bool steps;             /* on a mesh: `pushed` is valid, the last spot that was queued */
    Spot pushed;
    bool begun; /* `last` is valid */

    /* by motions */
    bool motions;
    bool waiting; /* `held` is valid and not drawn yet */
    Spot last, held;

    /* by dabs */
    WrSpaced spaced;
    WrEngine *engine; /* NULL: spaced */
    double x, y;      /* of the last sample, not wrapped */
};

static void sink_dab(void *ctx, const WrDab *dab)
{
    wr_draw_dab(ctx, dab);
}

static double sink_height(void *ctx, double x, double y, double radius)
{
    return wr_draw_height(ctx, x, y, radius);
}

WrStroke *wr_stroke_new_on(const WrBrushGround *ground, const WrBrush *brush)
{
    WrStroke *stroke = wr_alloc(1, sizeof *stroke);
    WrBrush sane = wr_brush_sane(brush);
    if (sane.preset) sane.preset = stroke->preset = wr_preset_share(sane.preset);
    if (sane.tip) sane.tip = stroke->tip = wr_tip_share(sane.tip);
    wr_draw_init(&stroke->draw, ground, &sane);
    stroke->motions = !ground->mesh && wr_draw_by_motions(&sane);
    stroke->spaced.brush = &stroke->draw.cover.maker.brush;
    stroke->spaced.field = ground->mesh ? NULL : ground->field;
    WrDabSink sink = { .ctx = &stroke->draw, .dab = sink_dab, .height = sink_height };
    if (sane.preset) stroke->engine = wr_engine_new(&stroke->draw.cover.maker.brush, &sink);
    return stroke;
}

WrStroke *wr_stroke_new(WrField *field, const WrBrush *brush)
{
    WrBrushGround ground = { .field = field };
    return wr_stroke_new_on(&ground, brush);
}

static const WrBrush *brush_of(const WrStroke *stroke)
{
    return &stroke->draw.cover.maker.brush;
}

/* The vector from a to b, the shorter way round on periodic axes. */
static void way(const WrStroke *stroke, const Spot *a, const Spot *b, double *dx, double *dy)
{
    const WrField *field = stroke->draw.cover.maker.ground.field;
    int width = wr_field_width(field), height = wr_field_height(field);
    *dx = b->x - a->x;
    *dy = b->y - a->y;
    if (stroke->draw.cover.maker.ground.mesh) return;
    if (wr_field_wrap_u(field) == WR_WRAP_PERIODIC) *dx -= width * rint(*dx / width);
    if (wr_field_wrap_v(field) == WR_WRAP_PERIODIC) *dy -= height * rint(*dy / height);
}

/* ---- by motions ---- */

static void draw(WrStroke *stroke, const Spot *to)
{
    double dx, dy;
    way(stroke, &stroke->last, to, &dx, &dy);
    wr_draw_motion(&stroke->draw, stroke->last.x, stroke->last.y, dx, dy, stroke->last.pressure,
                   to->pressure);
    stroke->last = *to;
    stroke->waiting = false;
}

/* True if the change since the last spot drawn is too small for a footprint. */
static bool is_near(const WrStroke *stroke, const Spot *spot)
{
    double dx, dy, near = brush_of(stroke)->radius / 32.0;
    if (near < 0.25) near = 0.25;
    way(stroke, &stroke->last, spot, &dx, &dy);
    return dx * dx + dy * dy < near * near &&
           fabs(spot->pressure - stroke->last.pressure) <= SAME_PRESSURE;
}

/* True if the straight motion from the last spot to `to` passes the held one, in position and pressure. */
static bool passes_held(const WrStroke *stroke, const Spot *to)
{
    double dx, dy, hx, hy;
    way(stroke, &stroke->last, to, &dx, &dy);
    way(stroke, &stroke->last, &stroke->held, &hx, &hy);
    double length2 = dx * dx + dy * dy;
    double t = length2 > 0.0 ? (hx * dx + hy * dy) / length2 : 0.0;
    t = t > 0.0 ? t : 0.0;
    t = t < 1.0 ? t : 1.0;
    double ex = hx - t * dx, ey = hy - t * dy;
    double pressure = stroke->last.pressure + t * (to->pressure - stroke->last.pressure);
    return ex * ex + ey * ey <= ON_THE_WAY * ON_THE_WAY &&
           fabs(stroke->held.pressure - pressure) <= SAME_PRESSURE;
}

static void take_motion(WrStroke *stroke, const Spot *spot)
{
    if (!stroke->begun) {
        stroke->begun = true;
        stroke->last = *spot;
        draw(stroke, spot);
    } else if (is_near(stroke, spot)) {
        stroke->held = *spot;
        stroke->waiting = spot->x != stroke->last.x || spot->y != stroke->last.y ||
                          spot->pressure != stroke->last.pressure;
    } else {
        if (stroke->waiting && !passes_held(stroke, spot)) draw(stroke, &stroke->held);
        draw(stroke, spot);
    }
}

/* ---- by dabs ---- */

static void take_point(WrStroke *stroke, const Spot *spot)
{
    double dx, dy;
    if (stroke->begun) {
        way(stroke, &stroke->last, spot, &dx, &dy);
        stroke->x += dx;
        stroke->y += dy;
    } else {
        stroke->x = spot->x;
        stroke->y = spot->y;
    }
    stroke->draw.piece =
        (WrMeshPiece){ stroke->begun ? stroke->last.step : spot->step, spot->step };
    stroke->begun = true;
    stroke->last = *spot;
    if (!stroke->engine) {
        spaced_push(&stroke->spaced, stroke->x, stroke->y, spot->pressure);
        return;
    }
    WrEnginePoint point = { .x = stroke->x,
                            .y = stroke->y,
                            .pressure = spot->pressure,
                            .tilt_x = spot->tilt_x,
                            .tilt_y = spot->tilt_y,
                            .turn_deg = spot->turn_deg,
                            .seconds = spot->seconds };
    wr_engine_push(stroke->engine, &point);
}

/* ---- the queue ---- */

static double between(double a, double b, double t)
{
    return a + t * (b - a);
}

static void flatten_to(WrStroke *stroke, const WrMeshStep *step)
{
    double x, y;
    WrStrokeResolver *maker = &stroke->draw.cover.maker;
    wr_mesh_texels_place(maker->ground.mesh, &step->spot, &x, &y);
    wr_stroke_resolver_set_flatten_height(maker, x, y);
}

/* Samples are joined along the surface: points of the chord, a quarter of the radius apart, are moved to it. */
static void push_on_mesh(WrStroke *stroke, Spot spot, WrVec3 p)
{
    const WrMeshTexels *mesh = stroke->draw.cover.maker.ground.mesh;
    const Spot from = stroke->pushed;
    if (!isfinite(p.x) || !isfinite(p.y) || !isfinite(p.z)) return;
    const bool first = !stroke->steps;
    if (first) {
        spot.step = wr_mesh_step_first(mesh, p);
        flatten_to(stroke, &spot.step);
    }
    const double stride = fmax(1.0, brush_of(stroke)->radius / 4.0) * wr_mesh_texel_side(mesh);
    const WrVec3 way = v3_sub(p, from.step.spot.p);
    const int steps = first ? 1 : (int)fmin(PIECES_MAX, fmax(1.0, ceil(v3_len(way) / stride)));
    for (int i = 1; i <= steps; i++) {
        const double t = (double)i / steps;
        Spot next = spot;
        if (!first) {
            next.step =
                wr_mesh_step_next(mesh, &stroke->pushed.step, v3_mad(from.step.spot.p, way, t));
            next.pressure = between(from.pressure, spot.pressure, t);
            next.tilt_x = between(from.tilt_x, spot.tilt_x, t);
            next.tilt_y = between(from.tilt_y, spot.tilt_y, t);
            next.turn_deg = from.turn_deg + t * wr_signed_degrees(spot.turn_deg - from.turn_deg);
            next.seconds = between(from.seconds, spot.seconds, t);
        }
        next.x = next.step.x, next.y = next.step.y;
        wr_array_push(&stroke->queue, next);
        stroke->pushed = next;
    }
    stroke->steps = true;
}

void wr_stroke_push(WrStroke *stroke, WrSample sample)
{
    Spot spot = { .pressure = sample.pressure > 0.0 ? sample.pressure : 0.0, /* NaN: 0 */
                  .tilt_x = sample.tilt_x,
                  .tilt_y = sample.tilt_y,
                  .turn_deg = sample.turn_deg,
                  .seconds = sample.seconds,
                  .number = ++stroke->samples };
    if (spot.pressure > 1.0) spot.pressure = 1.0;
    if (brush_of(stroke)->pressure == WR_PRESSURE_NONE && !stroke->engine) spot.pressure = 1.0;
    WrStrokeResolver *maker = &stroke->draw.cover.maker;
    if (maker->ground.mesh) {
        push_on_mesh(stroke, spot, sample.p);
        return;
    }
    if (!wr_paint_place(maker->ground.field, sample.u, sample.v, &spot.x, &spot.y)) return;
    if (!stroke->begun && stroke->queue.count == 0)
        wr_stroke_resolver_set_flatten_height(maker, spot.x, spot.y);
    wr_array_push(&stroke->queue, spot);
}

/* Processes the next sample; false if there is none. */
static bool take(WrStroke *stroke)
{
    if (stroke->taken == stroke->queue.count) {
        stroke->taken = stroke->queue.count = 0;
        return false;
    }
    Spot spot = stroke->queue.data[stroke->taken++];
    if (stroke->motions) take_motion(stroke, &spot);
    else take_point(stroke, &spot);
    return true;
}

/* Does one piece of work; false if none was left. */
static bool work(WrStroke *stroke)
{
    WrDab dab;
    if (stroke->engine) {
        if (wr_engine_step(stroke->engine)) return true;
    } else if (!stroke->motions && spaced_next(&stroke->spaced, &dab)) {
        wr_draw_dab(&stroke->draw, &dab);
        return true;
    }
    return take(stroke);
}

int64_t wr_stroke_drawn(const WrStroke *stroke)
{
    return stroke->drawn;
}

/* All coverage is resolved. more: the last sample taken may have dabs left. */
static void note_drawn(WrStroke *stroke, bool more)
{
    const bool waits = stroke->taken < stroke->queue.count;
    const int64_t next = waits ? stroke->queue.data[stroke->taken].number : stroke->samples + 1;
    const int64_t drawn = next - 1 - (more && !stroke->motions);
    stroke->drawn = drawn > stroke->drawn ? drawn : stroke->drawn;
}

/* Half the time is for dabs and half for resolving heights, starting with the remaining ones. */
bool wr_stroke_work(WrStroke *stroke, double seconds)
{
    bool all = !(seconds < HUGE_VAL);
    double now = all ? 0.0 : wr_clock_seconds(), until = all ? HUGE_VAL : now + seconds;
    if (wr_draw_finish(&stroke->draw, until)) return true;
    note_drawn(stroke, true);
    bool more = work(stroke);
    while (more && (all || wr_clock_seconds() < now + 0.5 * seconds)) more = work(stroke);
    if (wr_draw_finish(&stroke->draw, until)) return true;
    note_drawn(stroke, more);
    return more;
}

void wr_stroke_add(WrStroke *stroke, WrSample sample)
{
    wr_stroke_push(stroke, sample);
    wr_stroke_work(stroke, HUGE_VAL);
}

/* A stroke of the round brush, which is a motion on the table, ends where the pen did on a mesh too. */
static void draw_end(WrStroke *stroke)
{
    WrSpaced *s = &stroke->spaced;
    const WrDab dab = dab_at(s, s->to.x, s->to.y, s->to.alpha, 0.0, 0.0);
    wr_draw_dab(&stroke->draw, &dab);
}

static void finish(WrStroke *stroke)
{
    wr_stroke_work(stroke, HUGE_VAL);
    WrDab dab;
    if (stroke->waiting) draw(stroke, &stroke->held);
    if (stroke->engine) wr_engine_pen_up(stroke->engine);
    if (!stroke->engine && spaced_last(&stroke->spaced, &dab)) wr_draw_dab(&stroke->draw, &dab);
    if (stroke->steps && wr_draw_by_motions(brush_of(stroke))) draw_end(stroke);
    wr_stroke_work(stroke, HUGE_VAL);
}

void wr_stroke_finish(WrStroke *stroke)
{
    if (!stroke) return;
    finish(stroke);
    wr_stroke_abandon(stroke);
}

void wr_stroke_abandon(WrStroke *stroke)
{
    if (!stroke) return;
    wr_engine_free(stroke->engine);
    wr_draw_fini(&stroke->draw);
    wr_preset_free(stroke->preset);
    wr_tip_free(stroke->tip);
    wr_array_free(&stroke->queue);
    wr_free(stroke);
}
