/* Placement of numbers beside their points: for each point in turn, the best free place around it. */
#include "accuracy/plot.h"

#include "accuracy/accuracy_benchmark.h"
#include "accuracy/report.h"
#include "base/enum_rows.h"
#include "base/exactmath.h"
#include "base/file.h"
#include "base/memory.h"
#include "image/vector_drawing.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* ---- labels ---- */

#define DIGIT_W 9.5
#define NUMBER_H 18.0
#define NEAREST 17.0 /* distance from a point to the centre of its number */
#define RING 6.0     /* distance between rings of places */
#define TURNS 16     /* places on a ring */
#define CLOSE 8.0    /* a line this near to a point seems to end there */
/* Penalties of a place, in pixels of distance. */
#define NEAR_OTHER 24.0
#define THROUGH 60.0 /* the line to the point passes another point or number */

WrPlotBox wr_plot_number_box(WrPlotSpot middle, int number)
{
    const double w = DIGIT_W * (number < 10 ? 1 : number < 100 ? 2 : 3) + 4;
    return (WrPlotBox){ middle.x - w / 2, middle.y - NUMBER_H / 2, w, NUMBER_H };
}

static double distance(WrPlotSpot a, WrPlotSpot b)
{
    return hypot(a.x - b.x, a.y - b.y);
}

/* Distance of a spot from the line between two. */
static double beside(WrPlotSpot spot, WrPlotSpot a, WrPlotSpot b)
{
    const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
    if (square == 0) return distance(spot, a);
    const double t = fmin(1, fmax(0, ((spot.x - a.x) * dx + (spot.y - a.y) * dy) / square));
    return distance(spot, (WrPlotSpot){ a.x + t * dx, a.y + t * dy });
}

typedef struct Sheet {
    const WrPlotBox *frame, *taken;
    const WrPlotSpot *points;
    int count, boxes;
    const WrPlotSpot *placed; /* [done] */
    int done;
} Sheet;

static WrPlotBox mark_box(WrPlotSpot at)
{
    return (WrPlotBox){ at.x - WR_PLOT_MARK, at.y - WR_PLOT_MARK, 2 * WR_PLOT_MARK,
                        2 * WR_PLOT_MARK };
}

static bool free_place(const Sheet *sheet, const WrPlotBox *box)
{
    const WrPlotBox *frame = sheet->frame;
    if (box->x < frame->x + 2 || box->x + box->w > frame->x + frame->w - 2 ||
        box->y < frame->y + 2 || box->y + box->h > frame->y + frame->h - 2)
        return false;
    for (int i = 0; i < sheet->boxes; i++)
        if (!wr_plot_apart(box, &sheet->taken[i])) return false;
    for (int i = 0; i < sheet->count; i++) {
        const WrPlotBox mark = mark_box(sheet->points[i]);
        if (!wr_plot_apart(box, &mark)) return false;
    }
    for (int i = 0; i < sheet->done; i++) {
        const WrPlotBox other = wr_plot_number_box(sheet->placed[i], i + 1);
        if (!wr_plot_apart(box, &other)) return false;
    }
    return true;
}

/* Ambiguity of a free place: penalty for being mistaken for another point's number.
   In pixels: the distance from the point, plus penalties if another point is nearer or a leader line would be
   ambiguous. */
static double badness(const Sheet *sheet, int own, WrPlotSpot at)
{
    const WrPlotSpot point = sheet->points[own];
    double bad = distance(at, point);
    bool nearer = false, through = false;
    for (int i = 0; i < sheet->count; i++) {
        const WrPlotSpot other = sheet->points[i];
        if (distance(other, point) < 1) continue; /* visually the same point */
        nearer |= distance(at, other) < distance(at, point);
        through |= beside(other, at, point) < CLOSE && distance(other, point) > CLOSE;
    }
    for (int i = 0; i < sheet->done; i++)
        through |= beside(sheet->placed[i], at, point) < NUMBER_H / 2 + 2 ||
                   beside(at, sheet->placed[i], sheet->points[i]) < NUMBER_H / 2 + 2;
    return bad + NEAR_OTHER * nearer + THROUGH * through;
}

/* Rings of growing radius until even a place without penalty would be worse than the best found. A greedy
   placement: earlier numbers are not moved, so the result depends on the order, which is that of the front. */
static WrPlotSpot place(const Sheet *sheet, int own)
{
    const WrPlotSpot point = sheet->points[own];
    WrPlotSpot best = point;
    double least = INFINITY;
    for (double radius = NEAREST; radius < fmin(least, sheet->frame->w + sheet->frame->h);
         radius += RING)
        for (int turn = 0; turn < TURNS; turn++) {
            /* Above and to the right first, among equally good places. */
            const double angle =
                WR_PI * (0.25 + (turn % 2 ? -1 : 1) * (turn + 1) / 2 * 2.0 / TURNS);
            const WrPlotSpot at = { point.x + radius * cos(angle), point.y - radius * sin(angle) };
            const WrPlotBox box = wr_plot_number_box(at, own + 1);
            if (!free_place(sheet, &box)) continue;
            const double bad = badness(sheet, own, at);
            if (bad >= least - 1e-6) continue;
            least = bad;
            best = at;
        }
    return best;
}

void wr_plot_number_places(const WrPlotBox *frame, const WrPlotSpot *points, int count, int numbers,
                           const WrPlotBox *taken, int boxes, WrPlotSpot *out)
{
    Sheet sheet = { frame, taken, points, count, boxes, out, 0 };
    for (int i = 0; i < numbers; i++) {
        out[i] = place(&sheet, i);
        sheet.done = i + 1;
    }
}

/* ---- plots ---- */

/* Geometry and drawing of the plot of error against time, for any canvas. */

#define ROOM 1.12 /* margin beyond the outer values */

static const double steps[3] = { 1, 2, 5 };

/* Round number of an index: 0 is 1, 1 is 2, 2 is 5, 3 is 10, -1 is 0.5. Powers of ten below 1 are computed by
   division, so that they equal the decimal literals.
   index = 3 k + i is steps[i] 10^k: both directions of the mapping are exact, so ticks equal the decimal
   literals in labels. */
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

/* At least a factor of 3.2 between the ends, extended downwards and upwards in turn, so that each axis has two
   ticks or more. */
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

/* Steps 1, 3, 6, ...: all of 1-2-5, then powers of ten, then every second one, until they fit. */
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

/* 0..1 along a logarithmic axis. */
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
static double shown_error(const WrAccuracyBenchmark *benchmark, const WrRung *rung)
{
    const double own = benchmark->reference.last_rms;
    return isfinite(own) ? fmax(rung->errors.rms, own) : rung->errors.rms;
}

/* The front, fastest first: in order of insertion, which is quick for the few settings of a benchmark.
   The front is the set of rungs that no other rung beats in both time and error. */
static void find_front(WrPlot *plot)
{
    const WrRung *rungs = plot->benchmark->rungs;
    for (int i = 0; i < plot->benchmark->count; i++) {
        if (!rungs[i].front || !wr_plot_has_point(&rungs[i])) continue;
        int at = plot->fronts++;
        for (; at > 0 && rungs[plot->front[at - 1]].seconds > rungs[i].seconds; at--)
            plot->front[at] = plot->front[at - 1];
        plot->front[at] = i;
    }
}

bool wr_plot_init(const WrAccuracyBenchmark *benchmark, WrPlot *out)
{
    const size_t room = (size_t)benchmark->count + 1;
    *out = (WrPlot){ .benchmark = benchmark, .time = { 1, 10 }, .error = { 1, 10 } };
    out->spots = wr_alloc(room, sizeof *out->spots);
    out->front = wr_alloc(room, sizeof *out->front);
    double *times = wr_alloc(room, sizeof *times), *errors = wr_alloc(room, sizeof *errors);
    double least = INFINITY;
    int n = 0;
    for (int i = 0; i < benchmark->count; i++) {
        if (!wr_plot_has_point(&benchmark->rungs[i])) continue;
        times[n] = 1e3 * benchmark->rungs[i].seconds;
        errors[n++] = shown_error(benchmark, &benchmark->rungs[i]);
        least = fmin(least, errors[n - 1]);
    }
    const bool good = wr_plot_axis(times, n, &out->time);
    /* The reference's own error is included if it is not far below. */
    if (benchmark->reference.last_rms > least / 10) errors[n++] = benchmark->reference.last_rms;
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
    for (int i = 0; i < plot->benchmark->count; i++) {
        const WrRung *rung = &plot->benchmark->rungs[i];
        plot->spots[i] = wr_plot_has_point(rung)
                             ? (WrPlotSpot){ x_of(plot, 1e3 * rung->seconds),
                                             y_of(plot, shown_error(plot->benchmark, rung)) }
                             : (WrPlotSpot){ -1e9, -1e9 };
    }
}

/* Height of the reference's line in the plot; false if it is below the axis. */
static bool plot_reference(const WrPlot *plot, double *y)
{
    const double own = plot->benchmark->reference.last_rms;
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
    if (!plot_reference(p, &y)) return;
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
        for (int i = 0; i < plot->benchmark->count; i++) {
            const WrRung *rung = &plot->benchmark->rungs[i];
            if (rung->front == (front == 1) && wr_plot_has_point(rung))
                canvas->mark(canvas->ctx, plot->spots[i], (3 + front) * canvas->unit,
                             WR_PLOT_SERIES + rung->axis);
        }
    if (ringed >= 0 && wr_plot_has_point(&plot->benchmark->rungs[ringed]))
        canvas->ring(canvas->ctx, plot->spots[ringed], 7.5 * canvas->unit, 2 * canvas->unit);
}

/* ---- pages ---- */

/* The plot of error against time as a file: with spreads, numbers, a key, and the front as a list, each setting in full.
   Its lines are wrapped and the page is made higher, so that every name is included.
   The list is laid out twice: once to count its lines, which set the page's height, and once to draw. */

/* Layout in pixels from the upper left corner. */
#define WIDTH 1280
#define PLOT_LEFT 100
#define PLOT_RIGHT 1085
#define PLOT_TOP 76
#define PLOT_BOTTOM 666
#define KEY_LEFT 1105
#define LIST_TOP 762 /* centre of its first line */
#define LINE 23
#define LEFT 20
#define NUMBER_RIGHT 40
#define TIME_RIGHT 130
#define ERROR_RIGHT 230
#define SETTING_LEFT 252
#define SIZE 15.0 /* of text */
#define TITLE 19.0
#define BASELINE 0.36 /* below the middle of a line, of the size */

/* Characters that fit: settings and file names have about 8.5 and 11 pixels a character. */
#define SETTING_FITS 112
#define NAME_FITS 48
#define REFERENCE_W 270 /* width of the text at the reference's line */

#define LISTED 24 /* maximum listed settings of the front */
#define SCALE 1.6 /* of marks and lines; the window's are smaller */

/* ---- the canvas ---- */

/* One colour and one mark per axis, from a palette for colour-blind readers: a disc or a polygon. */
static const struct {
    uint32_t rgb;
    int corners; /* 0: a disc */
    double turn; /* of the first corner from the right, turns clockwise */
} series_marks[] = { { 0x0072b2, 0, 0 },    { 0xd55e00, 4, 0.125 }, { 0x009e73, 3, 0.75 },
                     { 0xcc79a7, 3, 0.25 }, { 0xb8a000, 6, 0.25 },  { 0xe69f00, 4, 0 },
                     { 0x56b4e9, 5, 0.75 } };
_Static_assert(WR_LENGTH(series_marks) == WR_AXIS_COUNT + 1,
               "a mark for each axis and for combinations");

static uint32_t colour_of(WrPlotInk ink)
{
    static const uint32_t colours[WR_PLOT_SERIES] = {
        [WR_PLOT_GRID] = 0xdedede, [WR_PLOT_REFERENCE] = 0x707070, [WR_PLOT_FRONT] = 0x303030
    };
    return ink < WR_PLOT_SERIES ? colours[ink] : series_marks[ink - WR_PLOT_SERIES].rgb;
}

static void line(void *ctx, const WrPlotSpot *points, int count, double width, WrPlotInk ink)
{
    WrVectorDrawingPoint at[WR_PLOT_LINE];
    for (int i = 0; i < count; i++)
        at[i] = (WrVectorDrawingPoint){ (float)points[i].x, (float)points[i].y };
    wr_vector_drawing_colour(ctx, ink == WR_PLOT_GRID ? 1 : width, colour_of(ink));
    wr_vector_drawing_line(ctx, at, count);
}

static WrPlotSpot around(WrPlotSpot middle, double radius, double turns)
{
    double s, c;
    wr_sincos_turns(turns, &s, &c);
    return (WrPlotSpot){ middle.x + radius * c, middle.y + radius * s };
}

/* A polygon is its outline around the disc that fits into it. */
static void mark(void *ctx, WrPlotSpot at, double radius, WrPlotInk ink)
{
    const int corners = series_marks[ink - WR_PLOT_SERIES].corners;
    const double turn = series_marks[ink - WR_PLOT_SERIES].turn;
    const double inner = corners == 0 ? 1 : around((WrPlotSpot){ 0 }, 1, 0.5 / corners).x;
    WrPlotSpot outline[7];
    for (int i = 0; i <= corners; i++)
        outline[i] = around(at, radius, turn + (double)i / fmax(1, corners));
    line(ctx, (const WrPlotSpot[]){ at, at }, 2, 2 * radius * inner, ink);
    if (corners > 0) line(ctx, outline, corners + 1, 1.5, ink);
}

static void ring(void *ctx, WrPlotSpot at, double radius, double width)
{
    WrPlotSpot points[33];
    for (int i = 0; i < 33; i++) points[i] = around(at, radius, i / 32.0);
    line(ctx, points, 33, width, WR_PLOT_RING);
}

static void write_word(WrVectorDrawing *to, const char *text, double x, double y, double size,
                       double anchor)
{
    wr_vector_drawing_colour(to, 1, 0);
    wr_vector_drawing_word(to, text, x, y + BASELINE * size, size, anchor);
}

static void word(void *ctx, const char *text, double x, double y, double anchor, WrPlotInk ink)
{
    (void)ink;
    write_word(ctx, text, x, y, SIZE, anchor);
}

/* ---- numbers in the plot ---- */

/* The front's points, then all others. The caller frees. */
static WrPlotSpot *list_spots(const WrPlot *plot, int *count)
{
    const WrRung *rungs = plot->benchmark->rungs;
    WrPlotSpot *spots = wr_alloc((size_t)plot->benchmark->count + 1, sizeof *spots);
    *count = 0;
    for (int i = 0; i < plot->fronts; i++) spots[(*count)++] = plot->spots[plot->front[i]];
    for (int i = 0; i < plot->benchmark->count; i++)
        if (wr_plot_has_point(&rungs[i]) && !rungs[i].front) spots[(*count)++] = plot->spots[i];
    return spots;
}

/* The front's steps: two boxes from each point to the next. */
static int add_steps(const WrPlotSpot *spots, int fronts, WrPlotBox *out)
{
    int count = 0;
    for (int i = 0; i + 1 < fronts; i++) {
        const WrPlotSpot from = spots[i], to = spots[i + 1];
        out[count++] = (WrPlotBox){ from.x, from.y - 1, to.x - from.x, 2 };
        out[count++] = (WrPlotBox){ to.x - 1, from.y, 2, to.y - from.y };
    }
    return count;
}

/* The numbers of the front, each connected to its point by a line. */
static void draw_numbers(const WrPlot *plot, WrVectorDrawing *to)
{
    const WrPlotBox frame = { plot->x, plot->y, plot->w, plot->h };
    double y;
    int count;
    WrPlotSpot *spots = list_spots(plot, &count);
    WrPlotSpot *places = wr_alloc((size_t)plot->fronts + 1, sizeof *places);
    WrPlotBox *taken = wr_alloc(2 * (size_t)plot->fronts + 2, sizeof *taken);
    int boxes = add_steps(spots, plot->fronts, taken);
    if (plot_reference(plot, &y)) {
        taken[boxes++] = (WrPlotBox){ frame.x, y - 1, frame.w, 2 };
        taken[boxes++] = (WrPlotBox){ frame.x, y - 24, REFERENCE_W, 24 };
    }
    wr_plot_number_places(&frame, spots, count, plot->fronts, taken, boxes, places);
    for (int i = 0; i < plot->fronts; i++) {
        char number[12];
        snprintf(number, sizeof number, "%d", i + 1);
        /* The line ends before the number. */
        const double dx = spots[i].x - places[i].x, dy = spots[i].y - places[i].y,
                     part = fmin(1, 10 / hypot(dx, dy));
        const WrPlotSpot lead[] = { { places[i].x + part * dx, places[i].y + part * dy },
                                    spots[i] };
        line(to, lead, 2, 1, WR_PLOT_REFERENCE);
        write_word(to, number, places[i].x, places[i].y, SIZE, 0.5);
    }
    wr_free(spots);
    wr_free(places);
    wr_free(taken);
}

static void draw_spreads(const WrPlot *plot, WrVectorDrawing *to)
{
    for (int i = 0; i < plot->benchmark->count; i++) {
        const WrRung *rung = &plot->benchmark->rungs[i];
        if (!wr_plot_has_point(rung)) continue;
        const double start = wr_plot_place(&plot->time, 1e3 * (rung->seconds - rung->spread)),
                     end = wr_plot_place(&plot->time, 1e3 * (rung->seconds + rung->spread));
        const double y = plot->spots[i].y;
        const WrPlotSpot bar[] = { { plot->x + plot->w * fmax(0, start), y },
                                   { plot->x + plot->w * fmin(1, end), y } };
        line(to, bar, 2, 1.4, WR_PLOT_SERIES + rung->axis);
    }
}

/* ---- the key ---- */

static bool has_series(const WrAccuracyBenchmark *benchmark, int axis)
{
    for (int i = 0; i < benchmark->count; i++)
        if (wr_plot_has_point(&benchmark->rungs[i]) && (int)benchmark->rungs[i].axis == axis)
            return true;
    return false;
}

static void draw_key(const WrAccuracyBenchmark *benchmark, bool ringed, WrVectorDrawing *to)
{
    double y = PLOT_TOP + 10;
    const WrPlotSpot front[] = { { KEY_LEFT - 10, y }, { KEY_LEFT + 10, y } };
    line(to, front, 2, 1.5 * SCALE, WR_PLOT_FRONT);
    write_word(to, "front", KEY_LEFT + 20, y, SIZE, 0);
    for (int axis = 0; axis <= WR_AXIS_COUNT; axis++) {
        if (!has_series(benchmark, axis)) continue;
        y += LINE;
        mark(to, (WrPlotSpot){ KEY_LEFT, y }, 4 * SCALE, WR_PLOT_SERIES + axis);
        write_word(to, axis < WR_AXIS_COUNT ? wr_axis_labels[axis] : "combinations", KEY_LEFT + 20,
                   y, SIZE, 0);
    }
    if (!ringed) return;
    y += LINE;
    ring(to, (WrPlotSpot){ KEY_LEFT, y }, 5 * SCALE, 2 * SCALE);
    write_word(to, "as it stands", KEY_LEFT + 20, y, SIZE, 0);
}

/* ---- the list ---- */

typedef struct List {
    WrVectorDrawing *to; /* NULL: lines are only counted */
    int lines;
} List;

static void add_word(const List *list, double x, double anchor, const char *text)
{
    if (list->to) write_word(list->to, text, x, LIST_TOP + LINE * list->lines, SIZE, anchor);
}

/* Wraps at words, or within a word that is longer than a line. */
static void add_setting(List *list, const char *setting)
{
    char text[SETTING_FITS + 1];
    for (;;) {
        size_t length = strlen(setting);
        if (length > SETTING_FITS) {
            length = SETTING_FITS;
            while (length > 0 && setting[length] != ' ') length--;
            if (length == 0) length = SETTING_FITS;
        }
        memcpy(text, setting, length);
        text[length] = '\0';
        add_word(list, SETTING_LEFT, 0, text);
        list->lines++;
        setting += length;
        if (!*setting) return;
        setting += strspn(setting, " ");
    }
}

static void add_row(List *list, const char *number, const WrRung *rung)
{
    char text[40];
    add_word(list, NUMBER_RIGHT, 1, number);
    snprintf(text, sizeof text, "%.3g", 1e3 * rung->seconds);
    add_word(list, TIME_RIGHT, 1, text);
    snprintf(text, sizeof text, "%.2g", rung->errors.rms);
    add_word(list, ERROR_RIGHT, 1, text);
    add_setting(list, rung->full);
}

/* Lists the front, and the scene's own setting if it is not on it. */
static void add_list(const WrPlot *plot, int ringed, List *list)
{
    const WrRung *rungs = plot->benchmark->rungs;
    add_word(list, LEFT, 0, "the front, fast to near");
    list->lines++;
    add_word(list, TIME_RIGHT, 1, "ms");
    add_word(list, ERROR_RIGHT, 1, "RMS error");
    add_word(list, SETTING_LEFT, 0, "setting");
    list->lines++;
    for (int i = 0; i < plot->fronts && i < LISTED; i++) {
        char number[12];
        snprintf(number, sizeof number, "%d", i + 1);
        add_row(list, number, &rungs[plot->front[i]]);
    }
    if (ringed >= 0 && !rungs[ringed].front) add_row(list, "o", &rungs[ringed]);
}

/* ---- the page ---- */

/* Truncates a long name at its start, since the end is more specific. */
static void draw_title(const WrAccuracyBenchmark *benchmark, const char *name, WrVectorDrawing *to)
{
    const size_t length = strlen(name);
    const char *from = length > NAME_FITS ? name + length - NAME_FITS : name;
    WrText title = { 0 };
    while ((*from & 0xc0) == 0x80) from++; /* inside a character */
    wr_text_addf(&title, "%s%s%serror against time, %d x %d pixels, %d %s",
                 from > name ? "..." : "", from, name[0] ? ": " : "", benchmark->width,
                 benchmark->height, benchmark->threads,
                 benchmark->threads == 1 ? "thread" : "threads");
    write_word(to, wr_text_get(&title), (PLOT_LEFT + PLOT_RIGHT) / 2.0, 24, TITLE, 0.5);
    wr_text_fini(&title);
    write_word(to, "RMS error of linear intensity", LEFT, PLOT_TOP - 24, SIZE, 0);
    write_word(to, "time of a frame, ms (bars: half of the runs lie within)",
               (PLOT_LEFT + PLOT_RIGHT) / 2.0, PLOT_BOTTOM + 48, SIZE, 0.5);
}

static int find_current(const WrAccuracyBenchmark *benchmark)
{
    for (int i = 0; i < benchmark->count; i++)
        if (benchmark->rungs[i].current && wr_plot_has_point(&benchmark->rungs[i])) return i;
    return -1;
}

static void draw_page(const WrPlot *plot, const char *name, int ringed, WrVectorDrawing *to)
{
    const WrPlotCanvas canvas = { .ctx = to,
                                  .unit = SCALE,
                                  .text = SIZE,
                                  .times = WR_PLOT_TICKS,
                                  .errors = WR_PLOT_TICKS,
                                  .line = line,
                                  .mark = mark,
                                  .ring = ring,
                                  .word = word };
    List list = { .to = to };
    draw_title(plot->benchmark, name, to);
    draw_spreads(plot, to);
    draw_numbers(plot, to);
    wr_plot_draw(plot, &canvas, "the reference, at its last doubling", ringed);
    draw_key(plot->benchmark, ringed >= 0, to);
    add_list(plot, ringed, &list);
}

bool wr_report_plot(const WrAccuracyBenchmark *benchmark, const char *name, const char *path,
                    WrError *err)
{
    char ending[16];
    WrPlot plot;
    List list = { 0 };
    wr_path_ending(path, ending);
    if (strcmp(ending, "svg") != 0 && strcmp(ending, "pdf") != 0 && strcmp(ending, "png") != 0)
        return wr_fail(err, "plot %s: the name must end in .pdf, .png or .svg", path);
    wr_plot_init(benchmark, &plot);
    wr_plot_lay_out(&plot, PLOT_LEFT, PLOT_TOP, PLOT_RIGHT - PLOT_LEFT, PLOT_BOTTOM - PLOT_TOP);
    const int ringed = find_current(benchmark);
    add_list(&plot, ringed, &list);
    WrVectorDrawing *to = wr_vector_drawing_new(path, WIDTH, LIST_TOP + LINE * list.lines, 3, err);
    if (to) draw_page(&plot, name, ringed, to);
    const bool good = to && wr_vector_drawing_write(to, err);
    wr_vector_drawing_free(to);
    wr_plot_fini(&plot);
    return good;
}
