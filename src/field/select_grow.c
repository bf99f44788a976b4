/* Growing and shrinking by exact Euclidean distance: the distance along columns first, by a sweep down
   and a sweep up, then across rows as the lower envelope of parabolas (Felzenszwalb and Huttenlocher,
   Distance Transforms of Sampled Functions, 2012). Squared distances are integers, so there is no
   rounding before the root. On a periodic axis the nearest image lies within half a period: columns are
   swept twice round, and rows are extended by half a period at either end. */
#include "field/select.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "field/field.h"
#include "field/select_internal.h"

#include <math.h>

#define FAR UINT16_MAX /* no target in this column; real distances are under WR_FIELD_MAX */

/* Scratch memory of one thread for rows; [span]. */
typedef struct Envelope {
    double *start;  /* position from which each parabola of the envelope is the lowest */
    int *apex;      /* its column, which may lie outside the table */
    double *square; /* [width] squared distance, or infinite */
} Envelope;

typedef struct Distance {
    const WrField *a;
    bool inside; /* distances to a >= 1/2, else to a < 1/2 */
    bool any;    /* a target exists; set by any thread, only to true */
    bool *some;  /* [tiles_u] a target exists in this tile column */
    double r;
    int width, height;
    uint16_t *down; /* [height][width] distance to the nearest target in the column */
    Envelope *envelopes;
} Distance;

static bool is_target(const Distance *d, const float *tile, int index)
{
    float a = tile ? tile[index] : wr_field_level(d->a);
    return (a >= 0.5f) == d->inside;
}

static uint16_t one_more(uint16_t steps)
{
    return steps == FAR ? FAR : (uint16_t)(steps + 1);
}

/* Stores for each texel of a row the distance up (or down) to the last target. */
static void sweep_row(Distance *d, int tx, int j, bool first, uint16_t *steps)
{
    const float *tile = wr_field_tile(d->a, tx, j / WR_TILE);
    uint16_t *row = d->down + (size_t)j * (size_t)d->width;
    int at = tx * WR_TILE, count = d->width - at < WR_TILE ? d->width - at : WR_TILE;
    for (int x = 0; x < count; x++) {
        bool target = is_target(d, tile, j % WR_TILE * WR_TILE + x);
        if (target) d->some[tx] = true;
        steps[x] = target ? 0 : one_more(steps[x]);
        if (first || steps[x] < row[at + x]) row[at + x] = steps[x];
    }
}

/* False: cancelled, which is checked at intervals. wr_pool_run then returns false. */
static bool goes_on(int j)
{
    return j % 256 != 0 || !wr_progress_stopped();
}

static void column_piece(int tx, int worker, void *ctx)
{
    (void)worker;
    Distance *d = ctx;
    int rounds = wr_field_wrap_v(d->a) == WR_WRAP_PERIODIC ? 2 : 1;
    uint16_t steps[WR_TILE];
    for (int x = 0; x < WR_TILE; x++) steps[x] = FAR;
    for (int round = 0; round < rounds; round++)
        for (int j = 0; j < d->height && goes_on(j); j++) sweep_row(d, tx, j, round == 0, steps);
    for (int x = 0; x < WR_TILE; x++) steps[x] = FAR;
    for (int round = 0; round < rounds; round++)
        for (int j = d->height; j-- > 0 && goes_on(j);) sweep_row(d, tx, j, false, steps);
}

static int wrap_index(int i, int n)
{
    int rest = i % n;
    return rest < 0 ? rest + n : rest;
}

/* square[i] = min over columns q of (i - q)^2 + down[q]^2. A parabola at q is lower than the one at p <
 * q from x = ((dq + q^2) - (dp + p^2)) / (2 (q - p)) on; for integer columns the rounded quotient gives
 * the same decision as the exact one. */
static void envelope_row(const Distance *d, const uint16_t *down, Envelope *e)
{
    int around = wr_field_wrap_u(d->a) == WR_WRAP_PERIODIC ? d->width / 2 + 1 : 0;
    int top = -1;
    for (int q = -around; q < d->width + around; q++) {
        uint16_t steps = down[wrap_index(q, d->width)];
        if (steps == FAR) continue;
        double dq = (double)steps * steps + (double)q * q, from = -INFINITY;
        for (; top >= 0; top--) {
            int p = e->apex[top];
            uint16_t other = down[wrap_index(p, d->width)];
            from = (dq - ((double)other * other + (double)p * p)) / (2.0 * (q - p));
            if (from > e->start[top]) break;
        }
        top++;
        e->apex[top] = q;
        e->start[top] = top == 0 ? -INFINITY : from;
    }
    for (int i = 0, k = 0; i < d->width; i++) {
        if (top < 0) {
            e->square[i] = INFINITY;
            continue;
        }
        while (k < top && e->start[k + 1] < i) k++;
        uint16_t steps = down[wrap_index(e->apex[k], d->width)];
        double across = i - e->apex[k];
        e->square[i] = across * across + (double)steps * steps;
    }
}

static bool distance_rows(void *ctx, int worker, int j, int rows, float *out)
{
    const Distance *d = ctx;
    Envelope *e = &d->envelopes[worker];
    size_t width = (size_t)d->width;
    wr_field_read(d->a, 0, j, d->width, rows, out, width);
    for (int y = 0; y < rows; y++) {
        float *row = out + (size_t)y * width;
        envelope_row(d, d->down + (size_t)(j + y) * width, e);
        for (int i = 0; i < d->width; i++) {
            double away = sqrt(e->square[i]), x = d->inside ? d->r + 1.0 - away : away - d->r;
            float edge = (float)(x < 0.0 ? 0.0 : x > 1.0 ? 1.0 : x);
            bool takes = d->inside ? edge > row[i] : edge < row[i];
            row[i] = takes ? edge : row[i];
        }
    }
    return true;
}

static bool make_room(Distance *d, int threads, WrError *err)
{
    size_t width = (size_t)d->width, span = 2 * width + 4;
    d->down =
        wr_try_alloc(width * (size_t)d->height, sizeof *d->down, "distances of a selection", err);
    if (!d->down) return false;
    d->some = wr_alloc((size_t)wr_field_tiles_u(d->a), sizeof *d->some);
    d->envelopes = wr_alloc((size_t)threads, sizeof *d->envelopes);
    for (int i = 0; i < threads; i++) {
        d->envelopes[i].start = wr_alloc(span, sizeof *d->envelopes[i].start);
        d->envelopes[i].apex = wr_alloc(span, sizeof *d->envelopes[i].apex);
        d->envelopes[i].square = wr_alloc(width, sizeof *d->envelopes[i].square);
    }
    return true;
}

static void free_room(Distance *d, int threads)
{
    for (int i = 0; d->envelopes && i < threads; i++) {
        wr_free(d->envelopes[i].start);
        wr_free(d->envelopes[i].apex);
        wr_free(d->envelopes[i].square);
    }
    wr_free(d->envelopes);
    wr_free(d->some);
    wr_free(d->down);
}

static WrField *change(const WrField *a, double r, bool grow, WrPool *pool, WrError *err)
{
    if (!(r >= 0.0) || !isfinite(r)) {
        wr_fail(err, "%s a selection by %.9g texels: must be 0 or more and finite",
                grow ? "grow" : "shrink", r);
        return NULL;
    }
    if (r == 0.0) return wr_field_share(a);
    Distance d = {
        .a = a, .inside = grow, .r = r, .width = wr_field_width(a), .height = wr_field_height(a)
    };
    int threads = wr_pool_threads(pool);
    WrField *result = NULL;
    if (make_room(&d, threads, err)) {
        bool whole = wr_pool_run(pool, wr_field_tiles_u(a), column_piece, &d);
        bool any = false;
        for (int tx = 0; tx < wr_field_tiles_u(a); tx++) any |= d.some[tx];
        if (!whole) wr_fail(err, "cancelled");
        else if (!any) result = wr_field_share(a);
        else
            result = wr_select_build(a, wr_field_level(a), distance_rows, &d, pool,
                                     wr_progress_here(), err);
    }
    free_room(&d, threads);
    return result;
}

WrField *wr_select_grow(const WrField *a, double r, WrPool *pool, WrError *err)
{
    return change(a, r, true, pool, err);
}

WrField *wr_select_shrink(const WrField *a, double r, WrPool *pool, WrError *err)
{
    return change(a, r, false, pool, err);
}
