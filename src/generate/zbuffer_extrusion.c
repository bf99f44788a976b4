/* Extruded outlines: distances by a grid of edge lists, ray intersections by steps limited by the
   distance. */
#include "generate/zbuffer_extrusion.h"

#include "base/array.h"
#include "base/error.h"
#include "generate/zbuffer_shapes.h"

#include <stdint.h>

#define EDGES_MAX 4194304
#define CELLS 256 /* maximum cells of the grid along its longer side */
#define BANDS                                                                                      \
    16 /* strips in the height of a cell: outlines consist of many short edges, of which a
          horizontal line meets few */

typedef struct Edge {
    double p, q, dp, dq; /* from (p, q) by (dp, dq) */
    double inverse;      /* 1 / length^2 */
} Edge;

typedef struct List {
    int first, count;
} List;

struct WrZLetters {
    double depth, bevel;
    WrZBevel kind;
    Edge *edges;
    int count;
    double low[2], high[2]; /* bounding box of the outlines */
    double origin[2], cell; /* of the grid */
    int across, up;         /* its cells */
    double near;            /* distances below that are exact */
    List *cells;            /* [up][across] edges within `near` of the cell */
    List *bands;            /* [up BANDS] edges that a strip across meets */
    int *items;             /* of all lists */
    signed char *inside;    /* [up][across] of cells without edges near: 1 or -1 */
};

/* ---- building ---- */

static bool add_edges(WrZLetters *l, const WrZContour *c, WrError *err)
{
    for (int i = 0; i < c->count; i++) {
        const double *from = &c->points[2 * i], *to = &c->points[2 * ((i + 1) % c->count)];
        if (!(fabs(from[0]) <= 1e6 && fabs(from[1]) <= 1e6))
            return wr_fail(err, "outline point %d: %g,%g: must be finite, within 1e6", i + 1,
                           from[0], from[1]);
        Edge e = { .p = from[0], .q = from[1], .dp = to[0] - from[0], .dq = to[1] - from[1] };
        double square = e.dp * e.dp + e.dq * e.dq;
        if (!(square > 1e-24)) continue;
        e.inverse = 1.0 / square;
        for (int k = 0; k < 2; k++) {
            l->low[k] = l->count == 0 || from[k] < l->low[k] ? from[k] : l->low[k];
            l->high[k] = l->count == 0 || from[k] > l->high[k] ? from[k] : l->high[k];
        }
        l->edges[l->count++] = e;
    }
    return true;
}

static void lay_grid(WrZLetters *l)
{
    double wide = l->high[0] - l->low[0], high = l->high[1] - l->low[1];
    double side = wide > high ? wide : high;
    l->cell = side / CELLS > 0.5 * l->bevel ? side / CELLS : 0.5 * l->bevel;
    l->near = l->bevel > l->cell ? l->bevel : l->cell;
    for (int k = 0; k < 2; k++) l->origin[k] = l->low[k] - l->near;
    l->across = (int)((wide + 2.0 * l->near) / l->cell) + 1;
    l->up = (int)((high + 2.0 * l->near) / l->cell) + 1;
}

static double edge_square(const Edge *e, double p, double q)
{
    double x = p - e->p, y = q - e->q, s = (x * e->dp + y * e->dq) * e->inverse;
    s = s < 0.0 ? 0.0 : s > 1.0 ? 1.0 : s;
    x -= s * e->dp;
    y -= s * e->dq;
    return x * x + y * y;
}

static int cell_of(const WrZLetters *l, double x, int axis)
{
    double i = floor((x - l->origin[axis]) / l->cell);
    int last = (axis == 0 ? l->across : l->up) - 1;
    return i < 0.0 ? 0 : i > last ? last : (int)i;
}

static int band_of(const WrZLetters *l, double q)
{
    double j = floor((q - l->origin[1]) / l->cell * BANDS);
    int last = l->up * BANDS - 1;
    return j < 0.0 ? 0 : j > last ? last : (int)j;
}

static void put(const WrZLetters *l, List *list, int edge)
{
    if (l->items) l->items[list->first + list->count] = edge;
    list->count++;
}

/* Counts the items of the lists, or fills them. */
static void put_edge(WrZLetters *l, int edge)
{
    const Edge *e = &l->edges[edge];
    double p0 = e->dp < 0.0 ? e->p + e->dp : e->p, p1 = e->dp < 0.0 ? e->p : e->p + e->dp;
    double q0 = e->dq < 0.0 ? e->q + e->dq : e->q, q1 = e->dq < 0.0 ? e->q : e->q + e->dq;
    double reach = (l->near + 0.7072 * l->cell) * 1.000001;
    int j0 = cell_of(l, q0 - l->near, 1), j1 = cell_of(l, q1 + l->near, 1);
    int i0 = cell_of(l, p0 - l->near, 0), i1 = cell_of(l, p1 + l->near, 0);
    for (int j = j0; j <= j1; j++)
        for (int i = i0; i <= i1; i++) {
            double p = l->origin[0] + (i + 0.5) * l->cell, q = l->origin[1] + (j + 0.5) * l->cell;
            if (edge_square(e, p, q) <= reach * reach) put(l, &l->cells[j * l->across + i], edge);
        }
    for (int j = band_of(l, q0 - 1e-9); j <= band_of(l, q1 + 1e-9); j++) put(l, &l->bands[j], edge);
}

static int place_lists(List *lists, int count, int first)
{
    for (int i = 0; i < count; i++) {
        lists[i].first = first;
        first += lists[i].count;
        lists[i].count = 0;
    }
    return first;
}

/* The nonzero rule, by the crossings of a line to the right. */
static bool is_inside(const WrZLetters *l, double p, double q)
{
    const List *band = &l->bands[band_of(l, q)];
    int winding = 0;
    for (int k = 0; k < band->count; k++) {
        const Edge *e = &l->edges[l->items[band->first + k]];
        bool below = e->q <= q, end_below = e->q + e->dq <= q;
        if (below == end_below) continue;
        double side = e->dp * (q - e->q) - (p - e->p) * e->dq; /* > 0: to the right, going up */
        if (below && side > 0.0) winding++;
        if (!below && side < 0.0) winding--;
    }
    return winding != 0;
}

static bool fill_grid(WrZLetters *l, WrError *err)
{
    size_t cells = (size_t)l->across * (size_t)l->up;
    l->cells = wr_alloc(cells, sizeof *l->cells);
    const int bands = l->up * BANDS;
    l->bands = wr_alloc((size_t)bands, sizeof *l->bands);
    l->inside = wr_alloc(cells, 1);
    for (int i = 0; i < l->count; i++) put_edge(l, i);
    double total = 0.0;
    for (size_t i = 0; i < cells; i++) total += l->cells[i].count;
    for (int j = 0; j < bands; j++) total += l->bands[j].count;
    if (total > 2e8) return wr_fail(err, "outlines of %d edges: must be fewer", l->count);
    int end = place_lists(l->bands, bands, place_lists(l->cells, (int)cells, 0));
    l->items = wr_try_alloc((size_t)end + 1, sizeof *l->items, "outlines", err);
    if (!l->items) return false;
    for (int i = 0; i < l->count; i++) put_edge(l, i);
    for (int j = 0; j < l->up; j++)
        for (int i = 0; i < l->across; i++) {
            double p = l->origin[0] + (i + 0.5) * l->cell, q = l->origin[1] + (j + 0.5) * l->cell;
            if (l->cells[j * l->across + i].count == 0)
                l->inside[j * l->across + i] = is_inside(l, p, q) ? 1 : -1;
        }
    return true;
}

WrZLetters *wr_zletters_new(const WrZContour *contours, int count, double depth, double bevel,
                            WrZBevel kind, WrError *err)
{
    int64_t edges = 0;
    for (int i = 0; i < count; i++) edges += contours[i].count;
    if (!(depth > 0.0 && depth <= 1e6) || !(bevel >= 0.0 && bevel <= depth)) {
        wr_fail(err, "depth %g with bevel %g: depth must be above 0, bevel 0..depth", depth, bevel);
        return NULL;
    }
    if (edges > EDGES_MAX) {
        wr_fail(err, "outlines of %lld points: must be at most %d", (long long)edges, EDGES_MAX);
        return NULL;
    }
    WrZLetters *l = wr_alloc(1, sizeof *l);
    *l = (WrZLetters){ .depth = depth, .bevel = bevel, .kind = kind };
    l->edges = wr_alloc((size_t)edges + 1, sizeof *l->edges);
    bool good = true;
    for (int i = 0; i < count && good; i++) good = add_edges(l, &contours[i], err);
    if (good && !(l->high[0] > l->low[0] && l->high[1] > l->low[1]))
        good = wr_fail(err, "the outlines hold no area");
    if (good) {
        lay_grid(l);
        good = fill_grid(l, err);
    }
    if (good) return l;
    wr_zletters_free(l);
    return NULL;
}

void wr_zletters_free(WrZLetters *letters)
{
    if (!letters) return;
    wr_free(letters->edges);
    wr_free(letters->cells);
    wr_free(letters->bands);
    wr_free(letters->items);
    wr_free(letters->inside);
    wr_free(letters);
}

void wr_zletters_box(const WrZLetters *letters, double low[3], double high[3])
{
    for (int k = 0; k < 2; k++) {
        low[k] = letters->low[k];
        high[k] = letters->high[k];
    }
    low[2] = 0.0;
    high[2] = letters->depth;
}

/* ---- distances ---- */

static double beyond(double x, double low, double high)
{
    return x < low ? low - x : x > high ? x - high : 0.0;
}

double wr_zletters_distance(const WrZLetters *l, double p, double q)
{
    double x = beyond(p, l->low[0], l->high[0]), y = beyond(q, l->low[1], l->high[1]);
    if (x * x + y * y >= l->near * l->near) return -sqrt(x * x + y * y);
    int at = cell_of(l, q, 1) * l->across + cell_of(l, p, 0);
    const List *list = &l->cells[at];
    if (list->count == 0) return l->inside[at] * l->near;
    double least = l->near * l->near;
    for (int k = 0; k < list->count; k++) {
        double square = edge_square(&l->edges[l->items[list->first + k]], p, q);
        if (square < least) least = square;
    }
    return is_inside(l, p, q) ? sqrt(least) : -sqrt(least);
}

/* A bound of the distance to the body, negative inside. */
static double gap(const WrZLetters *l, double p, double q, double w)
{
    double top = w - l->depth, under = -w;
    double most = top > under ? top : under;
    double d = wr_zletters_distance(l, p, q), s = top + l->bevel, e = l->bevel - d;
    if (-d > most) most = -d;
    if (!(s > 0.0 && e > 0.0)) return most;
    double bevel = l->kind == WR_Z_BEVEL_ROUND ? sqrt(s * s + e * e) - l->bevel
                                               : (s + e - l->bevel) * 0.70710678118654752;
    return bevel > most ? bevel : most;
}

static double gap_at(const WrZLetters *l, const double a[3], const double b[3], double t)
{
    return gap(l, a[0] + b[0] * t, a[1] + b[1] * t, a[2] + b[2] * t);
}

/* ---- lines ---- */

/* The part of the line within `reach` of the box; empty if none. */
static WrZSpan box_span(const WrZLetters *l, const double a[3], const double b[3], double reach)
{
    WrZSpan span = { -INFINITY, INFINITY };
    for (int k = 0; k < 3; k++) {
        double low = k < 2 ? l->low[k] : 0.0, high = k < 2 ? l->high[k] : l->depth;
        double mid = 0.5 * (low + high);
        span = wr_zspan_meet(span, wr_zspan_slab(a[k] - mid, b[k], 0.5 * (high - low) + reach));
    }
    return span;
}

/* A vertical line on a flat body. */
static bool flat_meet(const WrZLetters *l, const double a[3], double down, double *t)
{
    double d = wr_zletters_distance(l, a[0], a[1]), top = l->depth;
    if (d < 0.0) return false;
    if (d < l->bevel) {
        double e = l->bevel - d;
        top -= l->kind == WR_Z_BEVEL_CHAMFER ? e : l->bevel - sqrt(l->bevel * l->bevel - e * e);
    }
    *t = down > 0.0 ? (top - a[2]) / down : -a[2] / down;
    return true;
}

/* The crossing between `out` and `in`, whose gaps differ in sign: false position (Illinois variant). */
static double cross(const WrZLetters *l, const double a[3], const double b[3], double out,
                    double gap_out, double in, double gap_in)
{
    for (int i = 0; i < 60 && fabs(out - in) > 1e-12 * (1.0 + fabs(in)); i++) {
        double t = out + (in - out) * (gap_out / (gap_out - gap_in));
        if (!((t < out && t > in))) t = 0.5 * (out + in);
        double g = gap_at(l, a, b, t);
        if (g > 0.0) {
            out = t;
            gap_out = g;
            gap_in *= 0.5;
        } else {
            in = t;
            gap_in = g;
            gap_out *= 0.5;
            if (g == 0.0) return t;
        }
    }
    return in;
}

bool wr_zletters_meet(const WrZLetters *l, const double a[3], const double b[3], double *t)
{
    if (b[0] == 0.0 && b[1] == 0.0) return flat_meet(l, a, b[2], t);
    double speed = sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
    WrZSpan span = box_span(l, a, b, 0.0);
    if (!(span.low <= span.high)) return false;
    double at = span.high, before = 0.0, g_before = 0.0;
    for (int i = 0; i < 500 && at >= span.low; i++) {
        double g = gap_at(l, a, b, at);
        if (g <= 1e-9) {
            *t = at;
            return true;
        }
        if (g < 0.05 && i > 0 && g_before > g) { /* close by: try a point inside */
            double guess = at - 1.5 * g * (before - at) / (g_before - g);
            double g_guess = guess > span.low ? gap_at(l, a, b, guess) : 1.0;
            if (g_guess <= 0.0 && at - guess < 8.0 * g / speed) {
                *t = cross(l, a, b, at, g, guess, g_guess);
                return true;
            }
        }
        before = at;
        g_before = g;
        at -= (g > 1e-6 ? g : 1e-6) / speed;
    }
    return false;
}

bool wr_zletters_clear(const WrZLetters *l, const double a[3], const double b[3], double reach)
{
    if (b[0] == 0.0 && b[1] == 0.0) return wr_zletters_distance(l, a[0], a[1]) < -reach;
    double speed = sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
    WrZSpan span = box_span(l, a, b, reach);
    if (!(span.low <= span.high)) return true;
    double at = span.high;
    for (int i = 0; i < 64; i++) {
        double g = gap_at(l, a, b, at) - reach;
        if (g <= 0.0) return false;
        at -= (g > 1e-3 ? g : 1e-3) / speed;
        if (at < span.low) return true;
    }
    return false;
}
