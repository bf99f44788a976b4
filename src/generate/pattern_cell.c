/* Patterns of cells about points: dots, Voronoi cells, cracks. */
#include "base/error.h"
#include "base/memory.h"
#include "generate/pattern.h"

#include <math.h>

/* ---- points, one per cell ---- */

typedef struct Points {
    WrCells cells;
    double *place; /* [rows][across][2], owned: position within its cell, 0..1 */
} Points;

/* scatter 0: the centres of the cells, 1: anywhere in them. */
static bool place_points(Points *p, uint32_t seed, double scatter, WrError *err)
{
    int across = p->cells.across, rows = p->cells.rows;
    p->place = wr_try_alloc((size_t)across * (size_t)rows, 2 * sizeof *p->place,
                            "the points of cells", err);
    if (!p->place) return false;
    for (int j = 0; j < rows; j++)
        for (int i = 0; i < across; i++)
            for (int k = 0; k < 2; k++)
                p->place[2 * (j * across + i) + k] =
                    0.5 + scatter * (wr_chance(seed, i, j, 10 + k) - 0.5);
    return true;
}

/* The vector from (u, v) to the point of cell (i, j), which may lie beyond the table; all in cells. */
static void way_to(const Points *p, double u, double v, int i, int j, double way[2])
{
    int own_i = wr_modulo(i, p->cells.across), own_j = wr_modulo(j, p->cells.rows);
    const double *place = p->place + 2 * (own_j * p->cells.across + own_i);
    way[0] = i + place[0] - u;
    way[1] = j + place[1] - v;
}

/* ---- dots ---- */

#define LAYOUTS(X) X(SQUARE, "square") X(STAGGERED, "staggered")
enum { LAYOUTS(WR_WORD_ID) };
static const char *const layouts[] = { LAYOUTS(WR_WORD) NULL };

const WrParam wr_params_dots[] = {
    WR_P_ACROSS(8),
    WR_P_ROWS(8),
    WR_P_CHOICE("layout", "Layout", SQUARE, layouts,
                "square: a grid; staggered: rows offset by half a cell"),
    WR_P_NUMBER("size", "Size", 0.8, 0, 2, 1, "", "diameter, relative to a cell's shorter side"),
    WR_P_PART("bevel", "Bevel", 1, "share of the radius that is bevelled; 1: up to the centre"),
    WR_P_PROFILE,
    WR_P_PART("scatter", "Scatter", 0, "random offset within the cells"),
    WR_P_PART("vary", "Vary", 0, "random reduction of size"),
    WR_P_SEED,
    WR_P_HEIGHT,
    WR_P_ORIGIN,
    WR_P_END
};

typedef struct Dots {
    Points points;
    double radius, bevel, vary; /* radius: texels */
    WrProfile profile;
    bool staggered;
    uint32_t seed;
} Dots;

/* The first and the last of the 5 cells about `at` whose points, anywhere in them, may be within `reach` cells of it; a little
   more, for roundings. */
static void cells_near(double at, double reach, int *first, int *last)
{
    const int cell = (int)floor(at);
    const double part = at - cell, far = reach < 2.0 ? reach + 1e-6 : 3.0;
    const int before = (int)floor(far + 1.0 - part), after = (int)floor(far + part);
    *first = cell - (before < 2 ? before : 2);
    *last = cell + (after < 2 ? after : 2);
}

/* The height of the dot of cell (i, j), whose centre is at the vector `way` in cells; 0 beyond its radius. */
static double one_dot(const Dots *d, const double way[2], int i, int j)
{
    const WrCells *c = &d->points.cells;
    const double dx = way[0] * c->cell_width, dy = way[1] * c->cell_height;
    const double square = dx * dx + dy * dy;
    if (square >= (d->radius + 1.0) * (d->radius + 1.0)) return 0.0; /* none is larger */
    double smaller = 0.0;
    if (d->vary > 0.0)
        smaller = d->vary * wr_chance(d->seed, wr_modulo(i, c->across), wr_modulo(j, c->rows), 12);
    const double radius = d->radius * (1.0 - smaller);
    if (square >= (radius + 1.0) * (radius + 1.0)) return 0.0;
    const WrEdge edge = { radius * d->bevel, d->profile };
    return wr_edge_height(&edge, radius - sqrt(square)) * (1.0 - 0.5 * smaller);
}

static double dot_at(const void *ctx, double x, double y)
{
    const Dots *d = ctx;
    const WrCells *c = &d->points.cells;
    const double u = x / c->cell_width, v = y / c->cell_height;
    double best = 0.0;
    int first_i, last_i, first_j, last_j;
    cells_near(v, (d->radius + 1.0) / c->cell_height, &first_j, &last_j);
    for (int j = first_j; j <= last_j; j++) {
        const double place = d->staggered && wr_modulo(j, 2) ? u - 0.5 : u;
        cells_near(place, (d->radius + 1.0) / c->cell_width, &first_i, &last_i);
        for (int i = first_i; i <= last_i; i++) {
            double way[2];
            way_to(&d->points, place, v, i, j, way);
            const double h = one_dot(d, way, i, j);
            best = h > best ? h : best;
        }
    }
    return best;
}

bool wr_pattern_dots(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                     WrError *err)
{
    const WrParams params = { wr_params_dots, values };
    Dots d = { .points = { .cells = wr_cells_of(&params, job->like) },
               .bevel = wr_param_number(&params, "bevel"),
               .vary = wr_param_number(&params, "vary"),
               .profile = (WrProfile)wr_param_whole(&params, "profile"),
               .staggered = wr_param_whole(&params, "layout") == STAGGERED,
               .seed = wr_param_seed(&params) };
    const WrCells *c = &d.points.cells;
    double side = c->cell_width < c->cell_height ? c->cell_width : c->cell_height;
    d.radius = 0.5 * side * wr_param_number(&params, "size");
    if (d.staggered) wr_note_rows(job, c->rows, 2, "the layout");
    if (!place_points(&d.points, d.seed, wr_param_number(&params, "scatter"), err)) return false;
    bool good = wr_pattern_make(&params, job, dot_at, &d, 1, out, err);
    wr_free(d.points.place);
    return good;
}

/* ---- the two nearest points ---- */

#define METRICS(X) X(EUCLID, "euclid") X(MANHATTAN, "manhattan") X(CHEBYSHEV, "chebyshev")
typedef enum Metric { METRICS(WR_WORD_ID) } Metric;
static const char *const metrics[] = { METRICS(WR_WORD) NULL };

static double measured(Metric metric, const double way[2])
{
    double a = fabs(way[0]), b = fabs(way[1]);
    if (metric == MANHATTAN) return a + b;
    if (metric == CHEBYSHEV) return a > b ? a : b;
    return sqrt(a * a + b * b);
}

typedef struct Nearest {
    double first, second;         /* distances, cells */
    double way[2], second_way[2]; /* to the points */
    int i, j, second_i, second_j; /* their cells, not reduced */
} Nearest;

/* Each cell holds one point. Points outside of the 5 x 5 cells about the sample's are at least 2 cells away. In all three
   metrics the point of the sample's own cell is at most 2 away, and so is that of the adjacent cell on its nearer side: the
   nearest and the second nearest are found. */
static Nearest find_nearest(const Points *p, Metric metric, double u, double v)
{
    Nearest n = { .first = INFINITY, .second = INFINITY };
    int cell_i = (int)floor(u), cell_j = (int)floor(v);
    for (int j = cell_j - 2; j <= cell_j + 2; j++)
        for (int i = cell_i - 2; i <= cell_i + 2; i++) {
            double way[2];
            way_to(p, u, v, i, j, way);
            double distance = measured(metric, way);
            if (distance < n.first) {
                n.second = n.first;
                n.second_i = n.i;
                n.second_j = n.j;
                n.second_way[0] = n.way[0];
                n.second_way[1] = n.way[1];
                n.first = distance;
                n.i = i;
                n.j = j;
                n.way[0] = way[0];
                n.way[1] = way[1];
            } else if (distance < n.second) {
                n.second = distance;
                n.second_i = i;
                n.second_j = j;
                n.second_way[0] = way[0];
                n.second_way[1] = way[1];
            }
        }
    return n;
}

/* Distance in texels to the line equidistant from the points a and b (vectors, in cells): with n = b -
 * a it is n.p = (|b|^2 - |a|^2)/2, and a step of one texel along x changes n.p by n.x/cell_width. */
static double to_border(const WrCells *c, const double a[2], const double b[2])
{
    double nx = b[0] - a[0], ny = b[1] - a[1];
    double sx = nx / c->cell_width, sy = ny / c->cell_height, steep = sqrt(sx * sx + sy * sy);
    double past = 0.5 * (b[0] * b[0] + b[1] * b[1] - a[0] * a[0] - a[1] * a[1]);
    return steep > 0.0 ? past / steep : 0.0;
}

/* Distance in texels to the nearest border of the cell of n's first point. */
static double to_borders(const Points *p, const Nearest *n, double u, double v)
{
    double best = INFINITY;
    for (int j = n->j - 2; j <= n->j + 2; j++)
        for (int i = n->i - 2; i <= n->i + 2; i++) {
            double way[2];
            if (i == n->i && j == n->j) continue;
            way_to(p, u, v, i, j, way);
            double d = to_border(&p->cells, n->way, way);
            best = d < best ? d : best;
        }
    return best;
}

/* ---- Voronoi cells ---- */

#define SHOWN(X)                                                                                   \
    X(FIRST, "f1")                                                                                 \
    X(SECOND, "f2")                                                                                \
    X(DIFFERENCE, "f2-f1")                                                                         \
    X(CELLS, "cells")                                                                              \
    X(DOMES, "domes")
typedef enum Shown { SHOWN(WR_WORD_ID) } Shown;
static const char *const shown[] = { SHOWN(WR_WORD) NULL };

const WrParam wr_params_voronoi[] = {
    WR_P_ACROSS(8),
    WR_P_ROWS(8),
    WR_P_CHOICE("value", "Value", FIRST, shown,
                "f1: distance to the nearest point; f2: to the second; f2-f1: their difference; "
                "cells: a height for each cell; domes: a dome in each cell"),
    WR_P_CHOICE("metric", "Distance", EUCLID, metrics, "metric of the distance"),
    WR_P_PART("scatter", "Scatter", 0.9, "random offset of the points within the cells"),
    WR_P_SEED,
    WR_P_HEIGHT,
    WR_P_ORIGIN,
    WR_P_END
};

typedef struct Voronoi {
    Points points;
    Metric metric;
    Shown value;
    uint32_t seed;
} Voronoi;

static double level_of(const Voronoi *w, int i, int j)
{
    const WrCells *c = &w->points.cells;
    return wr_chance(w->seed, wr_modulo(i, c->across), wr_modulo(j, c->rows), 13);
}

/* A height for each cell, with an edge one texel wide between two. */
static double level_at(const Voronoi *w, const Nearest *n)
{
    double texel = 0.5 / w->points.cells.cell_width + 0.5 / w->points.cells.cell_height;
    double d = w->metric == EUCLID ? to_border(&w->points.cells, n->way, n->second_way)
                                   : 0.5 * (n->second - n->first) / texel;
    double own = level_of(w, n->i, n->j), other = level_of(w, n->second_i, n->second_j);
    double part = d < 0.5 ? 0.5 - d : 0.0;
    return own + part * (other - own);
}

static double voronoi_at(const void *ctx, double x, double y)
{
    const Voronoi *w = ctx;
    const WrCells *c = &w->points.cells;
    Nearest n = find_nearest(&w->points, w->metric, x / c->cell_width, y / c->cell_height);
    switch (w->value) {
    case FIRST: return n.first;
    case SECOND: return n.second;
    case DIFFERENCE: return n.second - n.first;
    case CELLS: return level_at(w, &n);
    case DOMES: break;
    }
    return 1.0 - n.first * n.first;
}

bool wr_pattern_voronoi(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                        WrError *err)
{
    const WrParams params = { wr_params_voronoi, values };
    Voronoi w = { .points = { .cells = wr_cells_of(&params, job->like) },
                  .metric = (Metric)wr_param_whole(&params, "metric"),
                  .value = (Shown)wr_param_whole(&params, "value"),
                  .seed = wr_param_seed(&params) };
    if (!place_points(&w.points, w.seed, wr_param_number(&params, "scatter"), err)) return false;
    bool good = wr_pattern_make(&params, job, voronoi_at, &w, 1, out, err);
    wr_free(w.points.place);
    return good;
}

/* ---- cracks ---- */

const WrParam wr_params_cracks[] = {
    WR_P_ACROSS(8),
    WR_P_ROWS(8),
    WR_P_TEXELS("gap", "Gap", 5, 64, "width of the cracks"),
    WR_P_BEVEL(12),
    WR_P_PROFILE,
    WR_P_PART("scatter", "Scatter", 0.85, "irregularity of the cells"),
    WR_P_TEXELS("jagged", "Jagged", 3, 32, "irregularity of the cracks"),
    WR_P_PIECES(0.2, 0.3, 0.15, 0.15),
    WR_P_PIECE_HEIGHT,
    WR_P_ORIGIN,
    WR_P_END
};

typedef struct Cracks {
    Points points;
    WrPieces pieces;
    double gap, jagged;
    WrNoise stray_x[2], stray_y[2];
} Cracks;

static double crack_at(const void *ctx, double x, double y)
{
    const Cracks *k = ctx;
    const WrCells *c = &k->points.cells;
    double px = x, py = y;
    if (k->jagged > 0.0) {
        px += k->jagged * wr_piece_roughness(k->stray_x, &k->pieces, x, y);
        py += k->jagged * wr_piece_roughness(k->stray_y, &k->pieces, x, y);
    }
    double u = px / c->cell_width, v = py / c->cell_height;
    Nearest n = find_nearest(&k->points, EUCLID, u, v);
    double d = to_borders(&k->points, &n, u, v) - 0.5 * k->gap;
    return wr_piece(&k->pieces, d, -1.6 * n.way[0], -1.6 * n.way[1], wr_modulo(n.i, c->across),
                    wr_modulo(n.j, c->rows), x, y);
}

bool wr_pattern_cracks(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                       WrError *err)
{
    const WrParams params = { wr_params_cracks, values };
    Cracks k = { .points = { .cells = wr_cells_of(&params, job->like) },
                 .gap = wr_param_number(&params, "gap"),
                 .jagged = wr_param_number(&params, "jagged") };
    const WrCells *c = &k.points.cells;
    k.pieces = wr_pieces_of(&params, c);
    for (int i = 0; i < 2; i++) {
        double times = i == 0 ? 2.0 : 6.0;
        k.stray_x[i] =
            wr_pattern_noise(k.pieces.seed + 21U + (uint32_t)i, c->across * times, c->rows * times);
        k.stray_y[i] =
            wr_pattern_noise(k.pieces.seed + 25U + (uint32_t)i, c->across * times, c->rows * times);
    }
    if (!place_points(&k.points, k.pieces.seed, wr_param_number(&params, "scatter"), err))
        return false;
    bool good = wr_pattern_make(&params, job, crack_at, &k, 1, out, err);
    wr_free(k.points.place);
    return good;
}
