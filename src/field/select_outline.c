/* Outlines by marching squares: cells lie between the centres of four texels; where two neighbours are
   on different sides of 1/2, the outline passes between them. Each such crossing belongs to one loop,
   which is followed from cell to cell with the inside on its left. */
#include "field/select.h"

#include "base/array.h"
#include "base/error.h"
#include "base/progress.h"
#include "field/field.h"
#include "field/select_internal.h"

#include <math.h>

/* Sides of a cell, and corners: side k lies between corners k and k + 1. */
enum { TOP, RIGHT, BOTTOM, LEFT, SIDES };

static const int corner_i[SIDES] = { 0, 1, 1, 0 };
static const int corner_j[SIDES] = { 0, 0, 1, 1 };

/* The cell whose top left corner is the centre of texel (i, j), anywhere in the unrolled plane, and the
 * side through which the loop entered. */
typedef struct Walker {
    int64_t i, j;
    int side;
} Walker;

typedef struct Trace {
    const WrField *field;
    int width, height;
    bool periodic_u, periodic_v;
    int across, down; /* lattice: centres, with a ring of empty ones round clamped axes */
    uint8_t *seen;    /* bits [2][down][across]: visited crossings to the right and down from each
                         centre */
    WR_ARRAY(WrSelectPoint)
    points; /* x, y in texels from the first centre, until finish_points */
    WR_ARRAY(WrOutlineLoop) loops;
    int passed; /* crossings so far, joined or not */
} Trace;

static int64_t wrap64(int64_t i, int64_t n)
{
    int64_t rest = i % n;
    return rest < 0 ? rest + n : rest;
}

/* Value of a texel; selections end at clamped edges. */
static float value_at(const Trace *t, int64_t i, int64_t j)
{
    if (t->periodic_u) i = wrap64(i, t->width);
    if (t->periodic_v) j = wrap64(j, t->height);
    if (i < 0 || i >= t->width || j < 0 || j >= t->height) return 0.0f;
    return wr_field_get(t->field, (int)i, (int)j);
}

static float corner(const Trace *t, const Walker *w, int k)
{
    return value_at(t, w->i + corner_i[k % SIDES], w->j + corner_j[k % SIDES]);
}

static bool is_inside(float a)
{
    return a >= 0.5f;
}

/* The side through which a loop that entered by w->side leaves the cell. */
static int way_out(const Trace *t, const Walker *w)
{
    bool in[SIDES + 1];
    float c[SIDES];
    int passages = 0, other = w->side;
    for (int k = 0; k < SIDES; k++) in[k] = is_inside(c[k] = corner(t, w, k));
    in[SIDES] = in[0];
    for (int k = 0; k < SIDES; k++)
        if (in[k] != in[k + 1]) {
            passages++;
            if (k != w->side) other = k;
        }
    if (passages == 2) return other;
    /* A saddle: the loop turns round a corner whose value differs from the middle. Side k joins corners
     * k and k + 1; around corner k it turns to side k - 1, around k + 1 to side k + 1. */
    bool middle = is_inside((c[0] + c[1] + c[2] + c[3]) * 0.25f);
    return in[w->side] != middle ? (w->side + 3) % SIDES : (w->side + 1) % SIDES;
}

/* Lattice index of a side's crossing: from the centre (i, j) to the right, or down. */
static size_t passage_of(const Trace *t, const Walker *w)
{
    int64_t i = w->i + (w->side == RIGHT), j = w->j + (w->side == BOTTOM);
    int64_t column = t->periodic_u ? wrap64(i, t->width) : i + 1;
    int64_t row = t->periodic_v ? wrap64(j, t->height) : j + 1;
    bool down = w->side == RIGHT || w->side == LEFT;
    return ((size_t)down * (size_t)t->down + (size_t)row) * (size_t)t->across + (size_t)column;
}

static bool see(Trace *t, size_t passage)
{
    uint8_t bit = (uint8_t)(1U << passage % 8);
    bool seen = t->seen[passage / 8] & bit;
    t->seen[passage / 8] |= bit;
    return seen;
}

/* Position of the outline on a side, in texels from the first centre. */
static WrSelectPoint point_on(const Trace *t, const Walker *w)
{
    bool level = w->side == TOP || w->side == BOTTOM;
    int64_t i = w->i + (w->side == RIGHT), j = w->j + (w->side == BOTTOM);
    double a = value_at(t, i, j), b = level ? value_at(t, i + 1, j) : value_at(t, i, j + 1);
    double part = (0.5 - a) / (b - a);
    return (WrSelectPoint){ (double)i + (level ? part : 0.0), (double)j + (level ? 0.0 : part) };
}

/* Adds a point to the open loop; removes the previous one if it is in the middle of a straight run. */
static void add_point(Trace *t, int first, WrSelectPoint p)
{
    if (t->points.count - first >= 2) {
        WrSelectPoint *last = &t->points.data[t->points.count - 1], *before = last - 1;
        double ax = last->u - before->u, ay = last->v - before->v;
        double bx = p.u - last->u, by = p.v - last->v;
        if (ax * by == ay * bx && ax * bx + ay * by > 0.0) {
            *last = p;
            return;
        }
    }
    wr_array_push(&t->points, p);
}

/* Moves through `side` into the next cell. */
static void cross_side(Walker *w, int side)
{
    w->i += side == RIGHT ? 1 : side == LEFT ? -1 : 0;
    w->j += side == BOTTOM ? 1 : side == TOP ? -1 : 0;
    w->side = (side + 2) % SIDES;
}

/* Follows one loop from a walker that just entered a cell. */
static bool follow(Trace *t, Walker w, WrError *err)
{
    Walker start = w;
    WrOutlineLoop loop = { .first = t->points.count };
    while (!see(t, passage_of(t, &w))) {
        if (++t->passed > WR_OUTLINE_POINTS)
            return wr_fail(err, "outline of the selection: over %d points, too fine to draw",
                           WR_OUTLINE_POINTS);
        if (t->passed % 65536 == 0 && wr_progress_stopped()) return wr_fail(err, "cancelled");
        add_point(t, loop.first, point_on(t, &w));
        cross_side(&w, way_out(t, &w));
    }
    WrSelectPoint again = t->points.data[loop.first];
    again.u += (double)(w.i - start.i);
    again.v += (double)(w.j - start.j);
    add_point(t, loop.first, again); /* only to test whether the last point is on a straight run */
    loop.count = --t->points.count - loop.first;
    loop.wind_u = (int)((w.i - start.i) / t->width);
    loop.wind_v = (int)((start.j - w.j) / t->height); /* v runs up */
    wr_array_push(&t->loops, loop);
    return true;
}

/* Starts loops at the crossings from the centre (i, j) to the right and down. With the inside on the
 * left, a loop runs down between two neighbours of a row if the right one is inside, and to the right
 * between two of a column if the upper one is. (On the left as seen with v up, and on the page.) */
static bool start_at(Trace *t, int i, int j, WrError *err)
{
    bool here = is_inside(value_at(t, i, j));
    bool right = is_inside(value_at(t, i + 1, j)), below = is_inside(value_at(t, i, j + 1));
    Walker across = { i, right ? j : j - 1, right ? TOP : BOTTOM };
    Walker along = { here ? i : i - 1, j, here ? LEFT : RIGHT };
    size_t seen = passage_of(t, &across);
    if (here != right && !(t->seen[seen / 8] >> seen % 8 & 1) && !follow(t, across, err))
        return false;
    seen = passage_of(t, &along);
    return here == below || t->seen[seen / 8] >> seen % 8 & 1 || follow(t, along, err);
}

/* True if an outline may start in the tile. Not if it and those to its right and below are NULL, except
 * that a table selected everywhere ends at its clamped edges. */
static bool may_start(const Trace *t, int tx, int ty)
{
    int tiles_u = wr_field_tiles_u(t->field), tiles_v = wr_field_tiles_v(t->field);
    int right = (tx + 1) % tiles_u, below = (ty + 1) % tiles_v;
    if (wr_field_tile(t->field, tx, ty) || wr_field_tile(t->field, right, ty) ||
        wr_field_tile(t->field, tx, below))
        return true;
    bool edge_u = !t->periodic_u && (tx == 0 || tx == tiles_u - 1);
    bool edge_v = !t->periodic_v && (ty == 0 || ty == tiles_v - 1);
    return is_inside(wr_field_level(t->field)) && (edge_u || edge_v);
}

/* in[y][x]: texel (i + x, j + y) is inside. Rows and columns 0..WR_TILE + 1; most of them belong to the
 * tile and are read directly. */
typedef struct Patch {
    int i, j, count_i, count_j;
    bool in[WR_TILE + 2][WR_TILE + 2];
} Patch;

static void read_patch(const Trace *t, int tx, int ty, Patch *p)
{
    const float *tile = wr_field_tile(t->field, tx, ty);
    bool level = is_inside(wr_field_level(t->field));
    for (int y = 0; y < p->count_j; y++)
        for (int x = 0; x < p->count_i; x++) {
            int i = p->i + x - tx * WR_TILE, j = p->j + y - ty * WR_TILE;
            bool mine = i >= 0 && i < WR_TILE && j >= 0 && j < WR_TILE && p->i + x < t->width &&
                        p->j + y < t->height;
            if (!mine) p->in[y][x] = is_inside(value_at(t, p->i + x, p->j + y));
            else p->in[y][x] = tile ? is_inside(tile[j * WR_TILE + i]) : level;
        }
}

static bool trace_tile(Trace *t, int tx, int ty, WrError *err)
{
    Patch p;
    /* the ring of empty centres round a clamped table belongs to the tiles at its left and top */
    p.i = tx == 0 && !t->periodic_u ? -1 : tx * WR_TILE;
    p.j = ty == 0 && !t->periodic_v ? -1 : ty * WR_TILE;
    int i1 = (tx + 1) * WR_TILE < t->width ? (tx + 1) * WR_TILE : t->width;
    int j1 = (ty + 1) * WR_TILE < t->height ? (ty + 1) * WR_TILE : t->height;
    p.count_i = i1 + 1 - p.i;
    p.count_j = j1 + 1 - p.j;
    read_patch(t, tx, ty, &p);
    for (int y = 0; y < p.count_j - 1; y++)
        for (int x = 0; x < p.count_i - 1; x++) {
            bool here = p.in[y][x];
            if (here == p.in[y][x + 1] && here == p.in[y + 1][x]) continue;
            if (!start_at(t, p.i + x, p.j + y, err)) return false;
        }
    return true;
}

/* Converts texels to u, v, with each loop's first point in the cell [0,1). */
static void finish_points(Trace *t)
{
    for (int k = 0; k < t->loops.count; k++) {
        WrOutlineLoop loop = t->loops.data[k];
        WrSelectPoint *p = t->points.data + loop.first;
        double i = t->periodic_u ? floor((p->u + 0.5) / t->width) * t->width : 0.0;
        double j = t->periodic_v ? floor((p->v + 0.5) / t->height) * t->height : 0.0;
        for (int n = 0; n < loop.count; n++, p++) {
            p->u = (p->u - i + 0.5) / t->width;
            p->v = 1.0 - (p->v - j + 0.5) / t->height;
        }
    }
}

bool wr_select_outline(const WrField *selection, WrOutline *outline, WrError *err)
{
    Trace t = { .field = selection,
                .width = wr_field_width(selection),
                .height = wr_field_height(selection),
                .periodic_u = wr_field_wrap_u(selection) == WR_WRAP_PERIODIC,
                .periodic_v = wr_field_wrap_v(selection) == WR_WRAP_PERIODIC };
    t.across = t.width + (t.periodic_u ? 0 : 2);
    t.down = t.height + (t.periodic_v ? 0 : 2);
    size_t passages = 2 * (size_t)t.across * (size_t)t.down;
    t.seen = wr_try_alloc(passages / 8 + 1, 1, "outline of the selection", err);
    if (!t.seen) return false;
    bool good = true;
    for (int ty = 0; good && ty < wr_field_tiles_v(selection); ty++) {
        good = !wr_progress_stopped() || wr_fail(err, "cancelled");
        for (int tx = 0; good && tx < wr_field_tiles_u(selection); tx++)
            if (may_start(&t, tx, ty)) good = trace_tile(&t, tx, ty, err);
    }
    wr_free(t.seen);
    if (!good) {
        wr_array_free(&t.points);
        wr_array_free(&t.loops);
        return false;
    }
    finish_points(&t);
    *outline = (WrOutline){ t.points.data, t.loops.data, t.points.count, t.loops.count };
    return true;
}

void wr_outline_fini(WrOutline *outline)
{
    wr_free(outline->points);
    wr_free(outline->loops);
    *outline = (WrOutline){ 0 };
}
