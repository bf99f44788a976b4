/* Slope limit: the largest function G below F whose heights differ by at most `limit` from one texel to
 * the next along an axis, and by sqrt(2) limit along a diagonal:
 *
 *   G(p) = min over q of F(q) + limit |p - q|,   |p - q| the length of the shortest path by such steps.
 *
 * It is the largest solution of G = min(F, G of the eight neighbours + a step). Float addition is
 * monotonic, so rounded sums have one largest solution too, and lowering texels in any order until none
 * changes converges to it: the result does not depend on the order of the sweeps or the number of
 * threads.
 *
 * A path may be reordered: vertical and diagonal steps, then horizontal ones. So one sweep down, one up
 * and one along each row do nearly everything; a second round propagates across the seams, and the rest
 * is rounding. Sweeps down and up process row by row, all texels of a row at once; rows are independent
 * in the third. The smallest function above F is computed the same way for -F.
 *
 * The heights are floats: a limit under half a unit in the last place of the heights acts as 0, and
 * along a long slope the rounding errors of its steps accumulate. */
#include "field/ops_internal.h"

#include "base/progress.h"
#include "field/field.h"

#include <math.h>

typedef struct Sweep {
    const WrOpJob *job;
    WrOpPlane *plane;
    float step, diagonal;
    bool wraps_u, wraps_v;
    bool negated;
    int changed; /* atomic while rows are swept by several threads */
} Sweep;

#define ROWS 16 /* rows of a piece of work, and of a sweep between two checks for cancellation */

static float *row_at(const WrOpPlane *plane, int j)
{
    return plane->at + (size_t)j * plane->pitch;
}

static int rows_of_piece(const WrOpPlane *plane, int index, int *first)
{
    *first = index * ROWS;
    return plane->height - *first < ROWS ? plane->height - *first : ROWS;
}

static void load_rows(int index, int worker, void *ctx)
{
    (void)worker;
    const Sweep *sweep = ctx;
    int first, rows = rows_of_piece(sweep->plane, index, &first);
    wr_field_read(sweep->job->in, 0, first, sweep->plane->width, rows, row_at(sweep->plane, first),
                  sweep->plane->pitch);
    if (!sweep->negated) return;
    for (int y = first; y < first + rows; y++) {
        float *row = row_at(sweep->plane, y);
        for (int x = 0; x < sweep->plane->width; x++) row[x] = -row[x];
    }
}

/* Sets the two texels beside a row's ends; without neighbours, to the maximum. */
static void set_margins(const Sweep *sweep, float *row)
{
    int width = sweep->plane->width;
    row[-1] = sweep->wraps_u ? row[width - 1] : FLT_MAX;
    row[width] = sweep->wraps_u ? row[0] : FLT_MAX;
}

/* Lowers `row` to the limit given by its neighbour row. */
static bool lower_row(const Sweep *sweep, float *from, float *restrict row)
{
    int changed = 0, width = sweep->plane->width;
    float step = sweep->step, diagonal = sweep->diagonal;
    set_margins(sweep, from);
#pragma omp simd reduction(| : changed)
    for (int x = 0; x < width; x++) {
        float straight = from[x] + step;
        float slant = (from[x - 1] < from[x + 1] ? from[x - 1] : from[x + 1]) + diagonal;
        float low = straight < slant ? straight : slant;
        changed |= low < row[x];
        row[x] = low < row[x] ? low : row[x];
    }
    return changed != 0;
}

/* True if the sweep should stop before row y; the caller checks for cancellation after it. */
static bool gives_up(const Sweep *sweep, int y)
{
    return y % ROWS == 0 && wr_progress_cancelled(sweep->job->progress);
}

/* A table of one periodic row is its own neighbour: the diagonals from the ends of the row would lower
   it like the steps along it, but are longer, so there is nothing to do. */
static bool sweep_down(const Sweep *sweep)
{
    const WrOpPlane *plane = sweep->plane;
    int height = plane->height;
    bool changed = false;
    if (height == 1) return false;
    if (sweep->wraps_v) changed |= lower_row(sweep, row_at(plane, height - 1), row_at(plane, 0));
    for (int y = 1; y < height && !gives_up(sweep, y); y++)
        changed |= lower_row(sweep, row_at(plane, y - 1), row_at(plane, y));
    return changed;
}

static bool sweep_up(const Sweep *sweep)
{
    const WrOpPlane *plane = sweep->plane;
    int height = plane->height;
    bool changed = false;
    if (height == 1) return false;
    if (sweep->wraps_v) changed |= lower_row(sweep, row_at(plane, 0), row_at(plane, height - 1));
    for (int y = height - 2; y >= 0 && !gives_up(sweep, y); y--)
        changed |= lower_row(sweep, row_at(plane, y + 1), row_at(plane, y));
    return changed;
}

static bool too_steep(const Sweep *sweep, float *row)
{
    set_margins(sweep, row);
    for (int x = 0; x < sweep->plane->width; x++) {
        float low = (row[x - 1] < row[x + 1] ? row[x - 1] : row[x + 1]) + sweep->step;
        if (low < row[x]) return true;
    }
    return false;
}

/* Sweeps right and left, twice each if the row is periodic. */
static void sweep_row(const Sweep *sweep, float *row)
{
    int width = sweep->plane->width;
    for (int round = 0; round < 2; round++) {
        float low = sweep->wraps_u ? row[width - 1] : FLT_MAX;
        for (int x = 0; x < width; x++) {
            low += sweep->step;
            low = row[x] < low ? row[x] : low;
            row[x] = low;
        }
        low = sweep->wraps_u ? row[0] : FLT_MAX;
        for (int x = width - 1; x >= 0; x--) {
            low += sweep->step;
            low = row[x] < low ? row[x] : low;
            row[x] = low;
        }
        if (!sweep->wraps_u) break;
    }
}

static void sweep_rows(int index, int worker, void *ctx)
{
    (void)worker;
    Sweep *sweep = ctx;
    int first, rows = rows_of_piece(sweep->plane, index, &first);
    for (int y = first; y < first + rows; y++) {
        if (!too_steep(sweep, row_at(sweep->plane, y))) continue;
        sweep_row(sweep, row_at(sweep->plane, y));
        __atomic_store_n(&sweep->changed, 1, __ATOMIC_RELAXED);
    }
}

/* Fills the plane with the largest limited function below F (or -F). The number of rounds is unknown,
   so each round gets a smaller part of the progress. */
static bool limit_plane(const WrOpJob *job, WrOpPlane *plane, double limit, bool negated)
{
    Sweep sweep = { .job = job,
                    .plane = plane,
                    .step = wr_op_float(limit),
                    .diagonal = wr_op_float(limit * sqrt(2.0)),
                    .wraps_u = wr_field_wrap_u(job->in) == WR_WRAP_PERIODIC,
                    .wraps_v = wr_field_wrap_v(job->in) == WR_WRAP_PERIODIC,
                    .negated = negated };
    int pieces = (plane->height + ROWS - 1) / ROWS;
    wr_pool_run(job->pool, pieces, load_rows, &sweep);
    bool again = true;
    for (int round = 1; again; round++) {
        if (!wr_op_step(job, 1.0 - 1.0 / round)) return false;
        sweep.changed = 0;
        again = sweep_down(&sweep);
        if (!wr_op_step(job, 1.0 - 1.0 / (round + 0.3))) return false;
        again = sweep_up(&sweep) || again;
        if (!wr_op_step(job, 1.0 - 1.0 / (round + 0.6))) return false;
        wr_pool_run(job->pool, pieces, sweep_rows, &sweep);
        again = again || sweep.changed;
    }
    return true;
}

typedef struct Sides {
    const WrOpPlane *below, *above; /* `above` contains -F's; either may be NULL */
} Sides;

static void make_limited(const WrOpJob *job, const void *ctx, WrOpBlock b, float *out, size_t pitch,
                         void *scratch)
{
    (void)job, (void)scratch;
    const Sides *sides = ctx;
    for (int y = 0; y < b.count_j; y++) {
        const float *low = sides->below ? row_at(sides->below, b.j + y) + b.i : NULL;
        const float *high = sides->above ? row_at(sides->above, b.j + y) + b.i : NULL;
        float *row = out + (size_t)y * pitch;
        for (int x = 0; x < b.count_i; x++)
            row[x] = !high  ? low[x]
                     : !low ? -high[x]
                            : (float)(0.5 * ((double)low[x] - (double)high[x]));
    }
}

/* param: limit, side */
WrField *wr_op_slope_limit(WrOpJob *job, const double *param)
{
    int side = (int)param[1];
    WrOpPlane below = { 0 }, above = { 0 };
    Sides sides = { side == WR_SIDE_ABOVE ? NULL : &below, side == WR_SIDE_BELOW ? NULL : &above };
    double middle = side == WR_SIDE_MEAN ? 0.45 : 0.9;
    bool good = true;
    job->to = side == WR_SIDE_ABOVE ? 0.0 : middle;
    if (sides.below)
        good = wr_op_plane_init(&below, job) && limit_plane(job, &below, param[0], false);
    job->from = job->to;
    job->to = 0.9;
    if (good && sides.above)
        good = wr_op_plane_init(&above, job) && limit_plane(job, &above, param[0], true);
    job->from = 0.9;
    job->to = 1.0;
    WrOpWork work = { .make = make_limited, .ctx = &sides, .reach = -1 };
    WrField *out = good ? wr_op_build_same(job, &work) : NULL;
    wr_op_plane_fini(&below);
    wr_op_plane_fini(&above);
    return out;
}
