/* Places of the copies of a solid, with random variation. */
#include "generate/solid_places.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/progress.h"
#include "field/field.h"
#include "generate/path.h"
#include "generate/pattern.h"

#include <math.h>
#include <string.h>

static void multiply(const double a[9], const double b[9], double out[9])
{
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++) {
            double sum = 0.0;
            for (int k = 0; k < 3; k++) sum += a[3 * row + k] * b[3 * k + column];
            out[3 * row + column] = sum;
        }
}

/* Reduces to [0, n) if the axis is periodic; by whole periods, so without rounding. */
static double wrapped(double x, int n, WrWrap wrap)
{
    if (wrap == WR_WRAP_CLAMP) return x;
    x -= n * floor(x / n);
    return x < n ? x : 0.0;
}

typedef struct Lattice {
    const WrParams *params;
    double x, y; /* of `at` */
    double step[2];
    int across, rows;
    double base[9], other[9]; /* rotation, and that of every other copy */
    double stagger;
    uint32_t seed;
    WrWrap wrap_u, wrap_v;
    int width, height;
    const WrPath *path;        /* NULL: none; then step[0] is an arc length */
    const double (*points)[2]; /* [across] by chance; NULL: none */
} Lattice;

/* -1..1 */
static double chance(const Lattice *l, int i, int j, int use)
{
    return 2.0 * wr_chance(l->seed, i, j, use) - 1.0;
}

/* The row's rotation is loosened by random angles about all axes, applied after it: R = L B, matrices row by row. */
static void turn_loosely(const Lattice *l, int i, int j, double out[9])
{
    const double *base = (i + j) % 2 ? l->other : l->base;
    double turn = wr_param_number(l->params, "turn"), tilt = wr_param_number(l->params, "tilt");
    double loose[9];
    const double angles[3] = { tilt * chance(l, i, j, 3), tilt * chance(l, i, j, 4),
                               turn * chance(l, i, j, 5) };
    if (turn > 0.0 || tilt > 0.0) {
        wr_z_turn(angles, loose);
        multiply(loose, base, out);
    } else {
        for (int k = 0; k < 9; k++) out[k] = base[k];
    }
}

/* With its x along the path's direction, which is turned about z after all else. */
static void turn_place(const Lattice *l, int i, int j, const WrStand *stand, double out[9])
{
    double own[9];
    const double along[9] = {
        stand->cosine, -stand->sine, 0, stand->sine, stand->cosine, 0, 0, 0, 1
    };
    turn_loosely(l, i, j, l->path ? own : out);
    if (l->path) multiply(along, own, out);
}

/* Relative to the middle of the lattice, or of the table; y up. (0, 0) is the first of the lowest row. */
static WrStand stand_of(const Lattice *l, int i, int j)
{
    WrStand s = { .cosine = 1.0 };
    double dx = i - 0.5 * (l->across - 1), dy = (j - 0.5 * (l->rows - 1)) * l->step[1];
    const double shift = j % 2 ? l->stagger : 0.0;
    if (l->points) {
        s.x = l->points[i][0] - 0.5 * l->width;
        s.y = l->points[i][1] - 0.5 * l->height;
    } else if (l->path) {
        s = wr_path_at(l->path, (i + shift) * l->step[0]);
        s.x = s.x - 0.5 * l->width - s.sine * dy;
        s.y = 0.5 * l->height - s.y + s.cosine * dy;
    } else {
        s.x = (dx + shift) * l->step[0];
        s.y = dy;
    }
    return s;
}

/* wr_z_place rounds to a fixed fraction of a texel, so that a copy that is moved by whole periods of the table has the same
   bits: the relief tiles exactly. */
static WrSolidPlace place(const Lattice *l, int i, int j)
{
    const double jitter = wr_param_number(l->params, "jitter");
    const double deep = wr_param_number(l->params, "deep");
    const WrStand stand = stand_of(l, i, j);
    WrSolidPlace p = { .scale = 1.0 + wr_param_number(l->params, "vary") * chance(l, i, j, 2) };
    double x = l->x + wr_z_place(stand.x + jitter * chance(l, i, j, 0));
    double y = l->y - wr_z_place(stand.y + jitter * chance(l, i, j, 1));
    p.at[0] = wrapped(x, l->width, l->wrap_u);
    p.at[1] = wrapped(y, l->height, l->wrap_v);
    p.at[2] = -wr_param_number(l->params, "sink") * p.scale;
    if (deep > 0.0) p.at[2] -= deep * wr_chance(l->seed, i, j, 6);
    turn_place(l, i, j, &stand, p.turn);
    return p;
}

/* ---- layouts ---- */

/* Every other row half a step aside, and rows nearest to sqrt(3)/2 steps apart; over the whole table their number is even,
   so that they close. */
static void set_hexagon(Lattice *l, const double spacing[2])
{
    const double wide = 0.5 * sqrt(3.0) * l->step[0];
    l->stagger = 0.5;
    if (spacing[0] > 0.0 || spacing[1] > 0.0) {
        if (!(spacing[1] > 0.0)) l->step[1] = wide;
        return;
    }
    const double pairs = floor(0.5 * l->height / wide + 0.5);
    l->rows = pairs < 1.0 ? 2 : pairs > WR_SOLID_MAX / 2 ? WR_SOLID_MAX : 2 * (int)pairs;
    l->step[1] = (double)l->height / l->rows;
}

/* The spacing that divides the path's length and is nearest to the wanted one; without one, `across` copies. */
static void set_path(Lattice *l, const double spacing[2], bool closed)
{
    const double length = wr_path_length(l->path);
    double gaps = closed ? l->across : l->across - 1;
    if (spacing[0] > 0.0) {
        gaps = floor(length / spacing[0] + 0.5);
        gaps = gaps < 1.0 ? 1.0 : gaps > WR_SOLID_MAX * 16 ? WR_SOLID_MAX * 16 : gaps;
        l->across = (int)gaps + !closed;
    }
    l->step[0] = gaps > 0.0 ? length / gaps : 0.0;
    if (!(spacing[1] > 0.0)) l->step[1] = l->step[0];
}

static bool set_layout(Lattice *l, WrPath *path, double (**points)[2], WrError *err)
{
    const double *spacing = wr_param_value(l->params, "spacing")->number;
    const WrParamValue *curve = wr_param_value(l->params, "points");
    const bool closed = wr_param_whole(l->params, "closed") == 1;
    const int layout = wr_param_whole(l->params, "layout");
    int64_t count;
    l->step[0] = spacing[0] > 0.0 ? spacing[0] : (double)l->width / l->across;
    l->step[1] = spacing[1] > 0.0 ? spacing[1] : (double)l->height / l->rows;
    if (curve->count > 0) {
        if (!wr_path_make(path, curve->points, curve->count, closed, l->width, l->height, err))
            return false;
        l->path = path;
        set_path(l, spacing, closed && curve->count > 2);
    } else if (layout == WR_LAYOUT_CHANCE) {
        if (!wr_chance_points(l->width, l->height, l->wrap_u == WR_WRAP_PERIODIC,
                              l->wrap_v == WR_WRAP_PERIODIC, l->step[0], l->seed, points, &count,
                              err))
            return false;
        l->points = (const double(*)[2]) * points;
        l->across = (int)count;
        l->rows = 1;
    } else if (layout == WR_LAYOUT_HEXAGON) {
        set_hexagon(l, spacing);
    }
    return true;
}

/* ---- chance ---- */

#define TRIES 30 /* of a new point beside an old one; Bridson's number */
#define CELLS_MAX (1 << 22)
#define CHANCE 16 /* the first purpose of random numbers here: solids use those below */

typedef struct Chance {
    double size[2], distance;
    bool wraps[2];
    int cells[2], reach[2];
    int32_t *cell; /* [cells] point + 1; 0: empty */
    double (*xy)[2];
    int32_t count;
} Chance;

static int cell_of(const Chance *c, const double p[2], int axis)
{
    const int i = (int)(p[axis] / c->size[axis] * c->cells[axis]);
    return i < c->cells[axis] ? i : c->cells[axis] - 1;
}

static bool is_free(const Chance *c, const double p[2])
{
    const int x = cell_of(c, p, 0), y = cell_of(c, p, 1);
    for (int j = y - c->reach[1]; j <= y + c->reach[1]; j++)
        for (int i = x - c->reach[0]; i <= x + c->reach[0]; i++) {
            if ((!c->wraps[0] && (i < 0 || i >= c->cells[0])) ||
                (!c->wraps[1] && (j < 0 || j >= c->cells[1])))
                continue;
            const int32_t k = c->cell[(size_t)wr_modulo(j, c->cells[1]) * (size_t)c->cells[0] +
                                      (size_t)wr_modulo(i, c->cells[0])];
            double sum = 0.0;
            for (int a = 0; k > 0 && a < 2; a++) {
                double d = fabs(p[a] - c->xy[k - 1][a]);
                if (c->wraps[a] && d > 0.5 * c->size[a]) d = c->size[a] - d;
                sum += d * d;
            }
            if (k > 0 && sum < c->distance * c->distance) return false;
        }
    return true;
}

static void add_point(Chance *c, const double p[2])
{
    memcpy(c->xy[c->count++], p, sizeof *c->xy);
    c->cell[(size_t)cell_of(c, p, 1) * (size_t)c->cells[0] + (size_t)cell_of(c, p, 0)] = c->count;
}

/* A place at random within 1 to 2 distances of an old point, even by area; false: beyond an end. */
static bool try_place(const Chance *c, const double from[2], uint32_t seed, int number, int attempt,
                      double p[2])
{
    const double r = c->distance * sqrt(1.0 + 3.0 * wr_chance(seed, number, attempt, CHANCE));
    double turn[2];
    wr_sincos_turns(wr_chance(seed, number, attempt, CHANCE + 1), &turn[1], &turn[0]);
    for (int a = 0; a < 2; a++) {
        p[a] = from[a] + r * turn[a];
        if (c->wraps[a]) p[a] -= c->size[a] * floor(p[a] / c->size[a]);
        if (!(p[a] >= 0.0 && p[a] < c->size[a])) return false;
    }
    return true;
}

/* Each cell of the grid is so small that it holds one point at most, so that only near cells are compared. */
bool wr_chance_points(double width, double height, bool wraps_u, bool wraps_v, double distance,
                      uint32_t seed, double (**xy)[2], int64_t *count, WrError *err)
{
    Chance c = { .size = { width, height }, .distance = distance, .wraps = { wraps_u, wraps_v } };
    const double cells = 2.0 * ceil(width / distance) * ceil(height / distance);
    if (!(cells <= CELLS_MAX / 2))
        return wr_fail(err, "spacing=%g: too many copies: must be at least %.3g", distance,
                       ceil(sqrt(4.2 * width * height / CELLS_MAX)));
    for (int a = 0; a < 2; a++) {
        c.cells[a] = (int)ceil(c.size[a] * sqrt(2.0) / distance);
        const double reach = ceil(distance * c.cells[a] / c.size[a]);
        c.reach[a] = reach < c.cells[a] ? (int)reach : c.cells[a];
    }
    const size_t room = (size_t)c.cells[0] * (size_t)c.cells[1];
    c.cell = wr_try_alloc(room, sizeof *c.cell, "places of solids", err);
    c.xy = c.cell ? wr_try_alloc(room, sizeof *c.xy, "places of solids", err) : NULL;
    int32_t *open = c.xy ? wr_try_alloc(room, sizeof *open, "places of solids", err) : NULL;
    bool good = open != NULL;
    int32_t left = 0;
    if (good) {
        const double first[2] = { width * wr_chance(seed, 0, 0, CHANCE + 2),
                                  height * wr_chance(seed, 0, 0, CHANCE + 3) };
        add_point(&c, first);
        open[left++] = 0;
    }
    for (int number = 1; left > 0; number++) {
        const int32_t k = (int32_t)(wr_chance(seed, number, 0, CHANCE + 2) * left);
        double p[2];
        int attempt = 0;
        if (number % 1024 == 0 && wr_progress_stopped()) {
            good = wr_fail(err, "cancelled");
            break;
        }
        for (; attempt < TRIES; attempt++)
            if (try_place(&c, c.xy[open[k]], seed, number, attempt, p) && is_free(&c, p)) break;
        if (attempt == TRIES) {
            open[k] = open[--left];
        } else {
            add_point(&c, p);
            open[left++] = c.count - 1;
        }
    }
    wr_free(open);
    wr_free(c.cell);
    if (good) {
        *xy = c.xy;
        *count = c.count;
    } else {
        wr_free(c.xy);
    }
    return good;
}

/* ---- all ---- */

bool wr_solid_places(const WrParams *params, const WrGenerateJob *job, WrSolidPlace **places,
                     int64_t *count, WrError *err)
{
    const double *at = wr_param_value(params, "at")->number;
    Lattice l = { .params = params,
                  .across = wr_param_whole(params, "across"),
                  .rows = wr_param_whole(params, "rows"),
                  .stagger = wr_param_number(params, "stagger"),
                  .seed = wr_param_seed(params),
                  .wrap_u = wr_field_wrap_u(job->like),
                  .wrap_v = wr_field_wrap_v(job->like),
                  .width = wr_field_width(job->like),
                  .height = wr_field_height(job->like) };
    WrPath path = { 0 };
    double(*points)[2] = NULL;
    l.x = wr_z_place(at[0] * l.width - 0.5);
    l.y = wr_z_place((1.0 - at[1]) * l.height - 0.5);
    const double about_x[3] = { wr_param_number(params, "alternate"), 0.0, 0.0 };
    double alternate[9];
    wr_z_turn(wr_param_value(params, "rotate")->number, l.base);
    wr_z_turn(about_x, alternate);
    multiply(l.base, alternate, l.other);
    WrSolidPlace *made = NULL;
    if (set_layout(&l, &path, &points, err)) {
        *count = (int64_t)l.across * l.rows;
        made = wr_try_alloc((size_t)*count, sizeof *made, "places of solids", err);
    }
    for (int j = 0; made && j < l.rows; j++)
        for (int i = 0; i < l.across; i++) made[(int64_t)j * l.across + i] = place(&l, i, j);
    wr_path_fini(&path);
    wr_free(points);
    if (made) *places = made;
    return made != NULL;
}
