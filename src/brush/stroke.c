#include <math.h>

#include "base/memory.h"
#include "brush/paint.h"

#define ON_THE_WAY 0.25             /* texels */
#define SAME_PRESSURE (1.0 / 128.0) /* pressures closer than this are not told apart */

typedef struct Spot {
    double x, y; /* texels, as wr_paint_place gives them */
    double pressure;
} Spot;

struct WrStroke {
    WrPaint paint; /* its start and cover are owned here */
    WrField *start, *cover;
    bool begun;   /* `last` is there */
    bool waiting; /* `held` is there and not drawn yet */
    Spot last, held;
};

WrStroke *wr_stroke_new_on(const WrBrushGround *ground, const WrBrush *brush)
{
    WrField *field = ground->field;
    WrStroke *stroke = wr_alloc(1, sizeof *stroke);
    stroke->start = wr_field_share(field);
    stroke->cover = wr_field_new(wr_field_width(field), wr_field_height(field), WR_WRAP_PERIODIC,
                                 WR_WRAP_PERIODIC, 0.0f, NULL);
    stroke->paint = (WrPaint){ .field = field,
                               .start = stroke->start,
                               .cover = stroke->cover,
                               .mark = ground->mark,
                               .selection = ground->selection,
                               .brush = wr_brush_sane(brush),
                               .kernels = wr_brush_kernels() };
    return stroke;
}

WrStroke *wr_stroke_new(WrField *field, const WrBrush *brush)
{
    WrBrushGround ground = { .field = field };
    return wr_stroke_new_on(&ground, brush);
}

/* The way from a to b, the shorter way round on periodic axes. */
static void way(const WrField *field, const Spot *a, const Spot *b, double *dx, double *dy)
{
    int width = wr_field_width(field), height = wr_field_height(field);
    *dx = b->x - a->x;
    *dy = b->y - a->y;
    if (wr_field_wrap_u(field) == WR_WRAP_PERIODIC) *dx -= width * rint(*dx / width);
    if (wr_field_wrap_v(field) == WR_WRAP_PERIODIC) *dy -= height * rint(*dy / height);
}

static void draw(WrStroke *stroke, const Spot *to)
{
    double dx, dy;
    way(stroke->paint.field, &stroke->last, to, &dx, &dy);
    wr_paint_motion(&stroke->paint, stroke->last.x, stroke->last.y, dx, dy, stroke->last.pressure,
                    to->pressure);
    stroke->last = *to;
    stroke->waiting = false;
}

/* Too little has happened since the last spot drawn to be worth a footprint. */
static bool is_near(const WrStroke *stroke, const Spot *spot)
{
    double dx, dy, near = stroke->paint.brush.radius / 32.0;
    if (near < 0.25) near = 0.25;
    way(stroke->paint.field, &stroke->last, spot, &dx, &dy);
    return dx * dx + dy * dy < near * near &&
           fabs(spot->pressure - stroke->last.pressure) <= SAME_PRESSURE;
}

/* Whether the straight motion from the last spot to `to` passes the held one, place and pressure. */
static bool passes_held(const WrStroke *stroke, const Spot *to)
{
    double dx, dy, hx, hy;
    way(stroke->paint.field, &stroke->last, to, &dx, &dy);
    way(stroke->paint.field, &stroke->last, &stroke->held, &hx, &hy);
    double length2 = dx * dx + dy * dy;
    double t = length2 > 0.0 ? (hx * dx + hy * dy) / length2 : 0.0;
    t = t > 0.0 ? t : 0.0;
    t = t < 1.0 ? t : 1.0;
    double ex = hx - t * dx, ey = hy - t * dy;
    double pressure = stroke->last.pressure + t * (to->pressure - stroke->last.pressure);
    return ex * ex + ey * ey <= ON_THE_WAY * ON_THE_WAY &&
           fabs(stroke->held.pressure - pressure) <= SAME_PRESSURE;
}

void wr_stroke_add(WrStroke *stroke, WrSample sample)
{
    Spot spot = { .pressure = sample.pressure > 0.0 ? sample.pressure : 0.0 }; /* NaN: 0 */
    if (spot.pressure > 1.0) spot.pressure = 1.0;
    if (!wr_paint_place(stroke->paint.field, sample.u, sample.v, &spot.x, &spot.y)) return;
    if (!stroke->begun) {
        stroke->begun = true;
        stroke->last = spot;
        draw(stroke, &spot);
    } else if (is_near(stroke, &spot)) {
        stroke->held = spot;
        stroke->waiting = spot.x != stroke->last.x || spot.y != stroke->last.y ||
                          spot.pressure != stroke->last.pressure;
    } else {
        if (stroke->waiting && !passes_held(stroke, &spot)) draw(stroke, &stroke->held);
        draw(stroke, &spot);
    }
}

void wr_stroke_free(WrStroke *stroke)
{
    if (!stroke) return;
    if (stroke->waiting) draw(stroke, &stroke->held);
    wr_field_free(stroke->start);
    wr_field_free(stroke->cover);
    wr_free(stroke);
}
