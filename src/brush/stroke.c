#include "base/memory.h"
#include "brush/draw.h"
#include "brush/engine.h"
#include "brush/paint.h"
#include "brush/dab_spacing.h"
#include "field/field.h"
#include "system/clock.h"

#include <math.h>

#define ON_THE_WAY 0.25             /* texels */
#define SAME_PRESSURE (1.0 / 128.0) /* smaller pressure differences are ignored */

typedef struct Spot {
    double x, y; /* texels, from wr_paint_place */
    double pressure, tilt_x, tilt_y, seconds;
} Spot;

struct WrStroke {
    WrDraw draw;
    WrPreset *preset; /* shared, or NULL */
    WrTip *tip;
    WR_ARRAY(Spot) queue;
    int taken;  /* from the queue */
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
    stroke->motions = wr_draw_by_motions(&sane);
    stroke->spaced.brush = &stroke->draw.cover.maker.brush;
    stroke->spaced.field = ground->field;
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
    stroke->begun = true;
    stroke->last = *spot;
    if (!stroke->engine) {
        wr_spaced_push(&stroke->spaced, stroke->x, stroke->y, spot->pressure);
        return;
    }
    WrEnginePoint point = { .x = stroke->x,
                            .y = stroke->y,
                            .pressure = spot->pressure,
                            .tilt_x = spot->tilt_x,
                            .tilt_y = spot->tilt_y,
                            .seconds = spot->seconds };
    wr_engine_push(stroke->engine, &point);
}

/* ---- the queue ---- */

void wr_stroke_push(WrStroke *stroke, WrSample sample)
{
    Spot spot = { .pressure = sample.pressure > 0.0 ? sample.pressure : 0.0, /* NaN: 0 */
                  .tilt_x = sample.tilt_x,
                  .tilt_y = sample.tilt_y,
                  .seconds = sample.seconds };
    if (spot.pressure > 1.0) spot.pressure = 1.0;
    if (brush_of(stroke)->pressure == WR_PRESSURE_NONE && !stroke->engine) spot.pressure = 1.0;
    WrMaker *maker = &stroke->draw.cover.maker;
    if (!wr_paint_place(maker->ground.field, sample.u, sample.v, &spot.x, &spot.y)) return;
    if (!stroke->begun && stroke->queue.count == 0) wr_maker_first(maker, spot.x, spot.y);
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
    } else if (!stroke->motions && wr_spaced_next(&stroke->spaced, &dab)) {
        wr_draw_dab(&stroke->draw, &dab);
        return true;
    }
    return take(stroke);
}

/* Half the time is for dabs and half for resolving heights, starting with the remaining ones. */
bool wr_stroke_work(WrStroke *stroke, double seconds)
{
    bool all = !(seconds < HUGE_VAL);
    double now = all ? 0.0 : wr_clock_seconds(), until = all ? HUGE_VAL : now + seconds;
    if (wr_draw_finish(&stroke->draw, until)) return true;
    bool more = work(stroke);
    while (more && (all || wr_clock_seconds() < now + 0.5 * seconds)) more = work(stroke);
    return wr_draw_finish(&stroke->draw, until) || more;
}

void wr_stroke_add(WrStroke *stroke, WrSample sample)
{
    wr_stroke_push(stroke, sample);
    wr_stroke_work(stroke, HUGE_VAL);
}

static void finish(WrStroke *stroke)
{
    wr_stroke_work(stroke, HUGE_VAL);
    WrDab dab;
    if (stroke->waiting) draw(stroke, &stroke->held);
    if (stroke->engine) wr_engine_finish(stroke->engine);
    if (!stroke->engine && wr_spaced_last(&stroke->spaced, &dab)) wr_draw_dab(&stroke->draw, &dab);
    wr_stroke_work(stroke, HUGE_VAL);
}

void wr_stroke_free(WrStroke *stroke)
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
