#include "field/seam.h"

#include "base/memory.h"
#include "base/text.h"
#include "field/field.h"

#include <math.h>
#include <stdint.h>

enum { ROOTS, SQUARES, MOST, MEANS };

/* The means of each difference along one line. */
typedef struct Line {
    double of[WR_SEAM_DIFFERENCES][MEANS];
} Line;

/* One axis of a cell. Line n is the boundary before texel n. */
typedef struct Axis {
    const WrField *field;
    bool along_v;     /* lines are columns */
    int table;        /* texels of the whole table across the lines */
    int size, length; /* texels of the cell across the lines, and along them */
    int shift;        /* offset of the neighbour along the edge */
} Axis;

/* The n-th of `looks` positions, spread evenly over `length`. */
static int place(int n, int looks, int length)
{
    return (int)((int64_t)n * length / looks);
}

static int fewer(int n)
{
    return n < WR_SEAM_LOOKS ? n : WR_SEAM_LOOKS;
}

/* Reads the texels about the edge at position k along it. The table always wraps here: an axis that
 * ends is judged like a cell repeated by another program. */
static void read_edge(const Axis *a, int k, float t[4])
{
    for (int n = 0; n < 4; n++) {
        const int across = (n - 2 + a->table) % a->table;
        const int along = n < 2 ? (k + a->shift) % a->length : k;
        t[n] = a->along_v ? wr_field_get(a->field, across, along)
                          : wr_field_get(a->field, along, across);
    }
}

static void add_place(float t0, float t1, float t2, float t3, Line *line)
{
    const double before = (double)t1 - (double)t0, step = (double)t2 - (double)t1,
                 after = (double)t3 - (double)t2;
    const double d[WR_SEAM_DIFFERENCES] = { fabs(step), fabs(after - before),
                                            fabs(after - 2 * step + before) };
    for (int k = 0; k < WR_SEAM_DIFFERENCES; k++) {
        line->of[k][ROOTS] += sqrt(d[k]);
        line->of[k][SQUARES] += d[k] * d[k];
        line->of[k][MOST] = fmax(line->of[k][MOST], d[k]);
    }
}

/* Converts sums over `places` positions to means. */
static void finish(Line *line, int places)
{
    for (int k = 0; k < WR_SEAM_DIFFERENCES; k++) {
        const double root = line->of[k][ROOTS] / places;
        line->of[k][ROOTS] = root * root;
        line->of[k][SQUARES] = sqrt(line->of[k][SQUARES] / places);
    }
}

static Line measure_edge(const Axis *a)
{
    Line edge = { 0 };
    for (int k = 0; k < a->length; k++) {
        float t[4];
        read_edge(a, k, t);
        add_place(t[0], t[1], t[2], t[3], &edge);
    }
    finish(&edge, a->length);
    return edge;
}

/* Adds the positions of `count` lines, spread over the cell, to their sums: columns row by row, rows
 * four rows each. */
static void add_columns(const Axis *a, int count, Line *lines)
{
    const int places = fewer(a->length), inside = a->size - 3;
    float *row = wr_alloc_unset((size_t)a->size, sizeof *row);
    for (int p = 0; p < places; p++) {
        wr_field_read(a->field, 0, place(p, places, a->length), a->size, 1, row, (size_t)a->size);
        for (int n = 0; n < count; n++) {
            const float *t = row + place(n, count, inside);
            add_place(t[0], t[1], t[2], t[3], &lines[n]);
        }
    }
    wr_free(row);
}

static void add_rows(const Axis *a, int count, Line *lines)
{
    const int places = fewer(a->length), inside = a->size - 3;
    const size_t w = (size_t)a->length;
    float *rows = wr_alloc_unset(4 * w, sizeof *rows);
    for (int n = 0; n < count; n++) {
        wr_field_read(a->field, 0, place(n, count, inside), a->length, 4, rows, w);
        for (int p = 0; p < places; p++) {
            const float *t = rows + place(p, places, a->length);
            add_place(t[0], t[w], t[2 * w], t[3 * w], &lines[n]);
        }
    }
    wr_free(rows);
}

/* Keeps the larger one of each mean. */
static void enlarge(Line *most, const Line *line)
{
    for (int k = 0; k < WR_SEAM_DIFFERENCES; k++)
        for (int m = 0; m < MEANS; m++) most->of[k][m] = fmax(most->of[k][m], line->of[k][m]);
}

/* The largest means of the lines inside the cell that do not read across its edges. */
static Line measure_inside(const Axis *a, const Line *edge, double *rank)
{
    const int count = fewer(a->size - 3);
    Line inside = { 0 }, *lines = wr_alloc((size_t)count, sizeof *lines);
    int less = 0;
    if (a->along_v) add_columns(a, count, lines);
    else add_rows(a, count, lines);
    for (int n = 0; n < count; n++) {
        finish(&lines[n], fewer(a->length));
        enlarge(&inside, &lines[n]);
        less += lines[n].of[WR_SEAM_BEND][SQUARES] < edge->of[WR_SEAM_BEND][SQUARES];
    }
    wr_free(lines);
    *rank = (double)less / count;
    return inside;
}

/* Largest effect of rounding each texel by half a code, in codes: weights 1 1; 1 1 1 1; 1 3 3 1. */
static const double codes[WR_SEAM_DIFFERENCES] = { 1, 2, 4 };

/* The quotient of one mean of difference k at the edge and of difference l inside. Differences within
 * rounding count as 0. */
static double quotient(const Line *seam, int k, const Line *inside, int l, int mean, double noise)
{
    const double rounding = codes[k] * noise;
    return seam->of[k][mean] > rounding ? seam->of[k][mean] / (inside->of[l][mean] + rounding) : 0;
}

/* Selects the mean with the largest quotient. */
static void take_ratio(WrSeamEdge *edge, int k, const Line *seam, const Line *inside, double noise)
{
    int worst = SQUARES;
    for (int m = 0; m < MEANS; m++)
        if (quotient(seam, k, inside, k, m, noise) > quotient(seam, k, inside, k, worst, noise))
            worst = m;
    edge->across[k] = seam->of[k][worst];
    edge->inside[k] = inside->of[k][worst];
    edge->ratio[k] = quotient(seam, k, inside, k, worst, noise);
}

/* A step on a steep slope may be smaller than the slope itself. Its second difference reveals it: that
 * is larger than any change of slope inside, and three times the step. */
static bool hidden_step(const WrSeamEdge *edge, const Line *seam, const Line *inside, double noise)
{
    for (int m = 0; m < MEANS; m++)
        if (quotient(seam, WR_SEAM_BEND, inside, WR_SEAM_BEND, m, noise) > edge->limit &&
            quotient(seam, WR_SEAM_BEND, inside, WR_SEAM_SLOPE, m, noise) > edge->limit &&
            4 * seam->of[WR_SEAM_STEP][m] > seam->of[WR_SEAM_BEND][m])
            return true;
    return false;
}

/* A grid of n + 1 points repeats its first line. Mirrored cells also have two equal lines, but no bend
 * between them. */
static bool repeats(const Axis *a, const WrSeamEdge *edge)
{
    bool level = true;
    float first[4], t[4];
    if (edge->ratio[WR_SEAM_BEND] <= edge->limit) return false;
    read_edge(a, 0, first);
    for (int k = 0; k < a->length; k++) {
        read_edge(a, k, t);
        if (t[1] < t[2] || t[1] > t[2]) return false;
        level = level && !(t[1] < first[1] || t[1] > first[1]);
    }
    return !level;
}

static int order_of(const WrSeamEdge *edge, const Line *seam, const Line *inside, double noise)
{
    if (edge->ratio[WR_SEAM_STEP] > edge->limit) return -1;
    if (edge->ratio[WR_SEAM_SLOPE] > edge->limit) return 0;
    if (hidden_step(edge, seam, inside, noise)) return -1;
    if (edge->repeats) return 0;
    return edge->ratio[WR_SEAM_BEND] > edge->limit ? 1 : 2;
}

/* Rounding error of float for the largest height. */
static double float_noise(const Axis *a)
{
    double most = 0;
    for (int k = 0; k < a->length; k++) {
        float t[4];
        read_edge(a, k, t);
        for (int n = 0; n < 4; n++) most = fmax(most, fabs((double)t[n]));
    }
    return 1e-6 * most;
}

static int cell_size(int table, int copies)
{
    return copies > 1 ? table / copies : table;
}

static WrSeamEdge measure(const WrField *field, bool along_v, const WrSeamOptions *o)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    const int cell_w = cell_size(w, o->copies[0]), cell_h = cell_size(h, o->copies[1]);
    const WrWrap wrap = along_v ? wr_field_wrap_u(field) : wr_field_wrap_v(field);
    const Axis a = { .field = field,
                     .along_v = along_v,
                     .table = along_v ? w : h,
                     .size = along_v ? cell_w : cell_h,
                     .length = along_v ? cell_h : cell_w,
                     .shift = o->shift[along_v ? 0 : 1] };
    WrSeamEdge edge = { .ends = wrap != WR_WRAP_PERIODIC, .order = 2 };
    edge.measured = a.size >= WR_SEAM_LEAST && a.length > 0;
    if (!edge.measured) return edge;
    const double noise = o->noise + float_noise(&a);
    const Line seam = measure_edge(&a), inside = measure_inside(&a, &seam, &edge.rank);
    edge.limit = WR_SEAM_CLEARLY + WR_SEAM_FEW / fewer(a.size - 3);
    for (int k = 0; k < WR_SEAM_DIFFERENCES; k++) take_ratio(&edge, k, &seam, &inside, noise);
    edge.repeats = repeats(&a, &edge);
    edge.order = order_of(&edge, &seam, &inside, noise);
    return edge;
}

WrSeam wr_seam_measure(const WrField *field, const WrSeamOptions *options)
{
    const WrSeamOptions plain = { 0 }, *o = options ? options : &plain;
    return (WrSeam){ measure(field, true, o), measure(field, false, o) };
}

int wr_seam_worst(const WrSeamEdge *edge)
{
    static const int by_order[] = { WR_SEAM_STEP, WR_SEAM_SLOPE, WR_SEAM_BEND };
    const double *r = edge->ratio;
    if (edge->order < 1 && r[edge->order + 1] <= edge->limit) return WR_SEAM_BEND;
    if (edge->order < 2) return by_order[edge->order + 1];
    return r[WR_SEAM_STEP] >= r[WR_SEAM_SLOPE] ? WR_SEAM_STEP : WR_SEAM_SLOPE;
}

bool wr_seam_shows(const WrSeamEdge *edge)
{
    return edge->order < 1;
}

void wr_seam_text(const WrSeamEdge *edge, WrText *text)
{
    static const char *const names[] = { "height differs", "slope changes",
                                         "second difference changes" };
    const int k = wr_seam_worst(edge);
    if (edge->across[k] <= 0 && edge->inside[k] <= 0) {
        wr_text_add(text, "level ground");
        return;
    }
    wr_text_addf(text,
                 "%s by %.3g across the edge, by %.3g across the worst line inside: %.3g times",
                 names[k], edge->across[k], edge->inside[k], edge->ratio[k]);
}
