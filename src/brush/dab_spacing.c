#include "brush/dab_spacing.h"

#include "base/exactmath.h"
#include "brush/tip.h"
#include "field/field.h"

#include <math.h>

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

/* At very low pressure the step is that of 1/64 of the brush, so that no path takes forever. */
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

void wr_spaced_push(WrSpaced *s, double x, double y, double pressure)
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

bool wr_spaced_next(WrSpaced *s, WrDab *dab)
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

bool wr_spaced_last(WrSpaced *s, WrDab *dab)
{
    if (!s->holds) return false;
    s->holds = false;
    *dab = s->first;
    return true;
}
