/* Geometry and drawing of the plot of error against time, for any canvas. */
#include "accuracy/plot.h"

#include "accuracy/ladder.h"
#include "base/memory.h"

#include <math.h>
#include <stdio.h>

#define ROOM 1.12 /* margin beyond the outer values */

static const double steps[3] = { 1, 2, 5 };

/* Round number of an index: 0 is 1, 1 is 2, 2 is 5, 3 is 10, -1 is 0.5. Powers of ten below 1 are computed by
   division, so that they equal the decimal literals. */
static double round_number(int index)
{
    const int k = (int)floor(index / 3.0);
    const double step = steps[index - 3 * k];
    return k < 0 ? step / pow(10.0, -k) : step * pow(10.0, k);
}

/* Index of the largest round number at or below a positive value. */
static int round_below(double value)
{
    int index = 3 * (int)floor(log10(value)) - 1;
    while (round_number(index + 1) <= value) index++;
    return index;
}

bool wr_plot_axis(const double *values, int count, WrPlotAxis *out)
{
    double low = INFINITY, high = 0;
    for (int i = 0; i < count; i++) {
        if (!(values[i] > 1e-300) || !(values[i] < 1e300)) continue;
        low = fmin(low, values[i]);
        high = fmax(high, values[i]);
    }
    if (high <= 0) return false;
    int from = round_below(low / ROOM), to = round_below(high * ROOM) + 1;
    for (bool down = true; round_number(to) < 3.2 * round_number(from); down = !down) {
        if (down) from--;
        else to++;
    }
    *out = (WrPlotAxis){ round_number(from), round_number(to) };
    return true;
}

int wr_plot_ticks(const WrPlotAxis *axis, double *out, int room)
{
    const int first = round_below(axis->low * (1 + 1e-12));
    for (int step = 1;; step = step == 1 ? 3 : step + 3) {
        int count = 0;
        bool fits = true;
        for (int i = first; fits && round_number(i) <= axis->high * (1 + 1e-12); i++) {
            if (round_number(i) < axis->low * (1 - 1e-12) || i % step != 0) continue;
            fits = count < room;
            if (fits) out[count++] = round_number(i);
        }
        if (fits) return count;
    }
}

double wr_plot_place(const WrPlotAxis *axis, double value)
{
    if (!(value > 0)) return 0;
    return log(value / axis->low) / log(axis->high / axis->low);
}

int wr_plot_nearest(const WrPlotSpot *points, int count, double x, double y, double reach)
{
    int best = -1;
    double least = reach;
    for (int i = 0; i < count; i++) {
        const double d = hypot(points[i].x - x, points[i].y - y);
        if (d > least || (best >= 0 && d == least)) continue;
        best = i;
        least = d;
    }
    return best;
}

double wr_plot_round_up(double value)
{
    if (!(value > 1e-300) || !(value < 1e300)) return 1;
    const int below = round_below(value * (1 - 1e-12));
    return round_number(below) >= value * (1 - 1e-12) ? round_number(below)
                                                      : round_number(below + 1);
}

char *wr_plot_number(double value, char *text)
{
    const double size = fabs(value);
    if (isnan(value)) snprintf(text, 16, "\xe2\x80\x93");
    else if (size > 0 && (size < 1e-3 || size >= 1e5)) snprintf(text, 16, "%.2g", value);
    else if (size >= 100) snprintf(text, 16, "%.0f", value);
    else snprintf(text, 16, "%.3g", value);
    return text;
}

/* ---- geometry ---- */

bool wr_plot_has_point(const WrRung *rung)
{
    return !rung->model && !rung->note.text[0] && rung->seconds > 0 && rung->errors.rms > 0;
}

/* Errors below the reference's own are not measurable, so they are drawn at its line. */
static double shown_error(const WrLadder *ladder, const WrRung *rung)
{
    const double own = ladder->reference.last_rms;
    return isfinite(own) ? fmax(rung->errors.rms, own) : rung->errors.rms;
}

/* The front, fastest first: in order of insertion, which is quick for the few settings of a ladder. */
static void find_front(WrPlot *plot)
{
    const WrRung *rungs = plot->ladder->rungs;
    for (int i = 0; i < plot->ladder->count; i++) {
        if (!rungs[i].front || !wr_plot_has_point(&rungs[i])) continue;
        int at = plot->fronts++;
        for (; at > 0 && rungs[plot->front[at - 1]].seconds > rungs[i].seconds; at--)
            plot->front[at] = plot->front[at - 1];
        plot->front[at] = i;
    }
}

bool wr_plot_init(const WrLadder *ladder, WrPlot *out)
{
    const size_t room = (size_t)ladder->count + 1;
    *out = (WrPlot){ .ladder = ladder, .time = { 1, 10 }, .error = { 1, 10 } };
    out->spots = wr_alloc(room, sizeof *out->spots);
    out->front = wr_alloc(room, sizeof *out->front);
    double *times = wr_alloc(room, sizeof *times), *errors = wr_alloc(room, sizeof *errors);
    double least = INFINITY;
    int n = 0;
    for (int i = 0; i < ladder->count; i++) {
        if (!wr_plot_has_point(&ladder->rungs[i])) continue;
        times[n] = 1e3 * ladder->rungs[i].seconds;
        errors[n++] = shown_error(ladder, &ladder->rungs[i]);
        least = fmin(least, errors[n - 1]);
    }
    const bool good = wr_plot_axis(times, n, &out->time);
    /* The reference's own error is included if it is not far below. */
    if (ladder->reference.last_rms > least / 10) errors[n++] = ladder->reference.last_rms;
    wr_plot_axis(errors, n, &out->error);
    wr_free(times);
    wr_free(errors);
    find_front(out);
    return good;
}

void wr_plot_fini(WrPlot *plot)
{
    wr_free(plot->spots);
    wr_free(plot->front);
}

static double x_of(const WrPlot *plot, double ms)
{
    return plot->x + plot->w * wr_plot_place(&plot->time, ms);
}

static double y_of(const WrPlot *plot, double rms)
{
    return plot->y + plot->h * (1 - wr_plot_place(&plot->error, rms));
}

void wr_plot_lay_out(WrPlot *plot, double x, double y, double w, double h)
{
    plot->x = x;
    plot->y = y;
    plot->w = w;
    plot->h = h;
    for (int i = 0; i < plot->ladder->count; i++) {
        const WrRung *rung = &plot->ladder->rungs[i];
        plot->spots[i] = wr_plot_has_point(rung)
                             ? (WrPlotSpot){ x_of(plot, 1e3 * rung->seconds),
                                             y_of(plot, shown_error(plot->ladder, rung)) }
                             : (WrPlotSpot){ -1e9, -1e9 };
    }
}

bool wr_plot_reference(const WrPlot *plot, double *y)
{
    const double own = plot->ladder->reference.last_rms;
    *y = y_of(plot, own);
    return own > plot->error.low && own < plot->error.high;
}

/* ---- drawing ---- */

static void draw_line(const WrPlotCanvas *c, WrPlotSpot a, WrPlotSpot b, double width,
                      WrPlotInk ink)
{
    c->line(c->ctx, (const WrPlotSpot[2]){ a, b }, 2, width * c->unit, ink);
}

static void draw_axes(const WrPlot *p, const WrPlotCanvas *c)
{
    double ticks[WR_PLOT_TICKS];
    char text[16];
    const double right = p->x + p->w, bottom = p->y + p->h;
    int count = wr_plot_ticks(&p->error, ticks, c->errors);
    for (int i = 0; i < count; i++) {
        const double y = y_of(p, ticks[i]);
        draw_line(c, (WrPlotSpot){ p->x, y }, (WrPlotSpot){ right, y }, 1, WR_PLOT_GRID);
        c->word(c->ctx, wr_plot_number(ticks[i], text), p->x - 6 * c->unit, y, 1, WR_PLOT_LABEL);
    }
    count = wr_plot_ticks(&p->time, ticks, c->times);
    for (int i = 0; i < count; i++) {
        const double x = x_of(p, ticks[i]);
        draw_line(c, (WrPlotSpot){ x, p->y }, (WrPlotSpot){ x, bottom }, 1, WR_PLOT_GRID);
        c->word(c->ctx, wr_plot_number(ticks[i], text), x, bottom + 8 * c->unit + c->text / 2, 0.5,
                WR_PLOT_LABEL);
    }
    const WrPlotSpot frame[] = {
        { p->x, p->y }, { right, p->y }, { right, bottom }, { p->x, bottom }, { p->x, p->y }
    };
    c->line(c->ctx, frame, 5, c->unit, WR_PLOT_FRAME);
}

static void draw_reference(const WrPlot *p, const WrPlotCanvas *c, const char *words)
{
    double y;
    if (!wr_plot_reference(p, &y)) return;
    for (double x = p->x; x < p->x + p->w; x += 8 * c->unit)
        draw_line(c, (WrPlotSpot){ x, y }, (WrPlotSpot){ fmin(x + 4 * c->unit, p->x + p->w), y }, 1,
                  WR_PLOT_REFERENCE);
    c->word(c->ctx, words, p->x + 5 * c->unit, y - 2 * c->unit - c->text / 2, 0, WR_PLOT_REFERENCE);
}

/* Steps: from each setting on the front, the next more accurate one needs more time. */
static void draw_front(const WrPlot *p, const WrPlotCanvas *c)
{
    for (int i = 0; i + 1 < p->fronts; i++) {
        const WrPlotSpot from = p->spots[p->front[i]], to = p->spots[p->front[i + 1]];
        const WrPlotSpot step[] = { from, { to.x, from.y }, to };
        c->line(c->ctx, step, 3, 1.5 * c->unit, WR_PLOT_FRONT);
    }
}

void wr_plot_draw(const WrPlot *plot, const WrPlotCanvas *canvas, const char *reference, int ringed)
{
    draw_axes(plot, canvas);
    draw_reference(plot, canvas, reference);
    draw_front(plot, canvas);
    for (int front = 0; front < 2; front++) /* points of the front on top */
        for (int i = 0; i < plot->ladder->count; i++) {
            const WrRung *rung = &plot->ladder->rungs[i];
            if (rung->front == (front == 1) && wr_plot_has_point(rung))
                canvas->mark(canvas->ctx, plot->spots[i], (3 + front) * canvas->unit,
                             WR_PLOT_SERIES + rung->axis);
        }
    if (ringed >= 0 && wr_plot_has_point(&plot->ladder->rungs[ringed]))
        canvas->ring(canvas->ctx, plot->spots[ringed], 7.5 * canvas->unit, 2 * canvas->unit);
}
