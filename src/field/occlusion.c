/* Maps of ambient occlusion and of horizons: sweeps along lines of the whole table, or searches within a reach. */
#include "field/occlusion.h"

#include "base/cpu.h"
#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "field/field.h"
#include "field/horizon.h"
#include "field/occlusion_kern.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* A direction and its opposite: the one of the two with rising coordinates of its main axis. */
typedef struct WrSkyCourse {
    bool upright; /* the main axis is j, else i */
    int q, p;     /* after q texels of it, 1, 2 or 4, the line has moved by p of the other */
    int k;        /* index of the direction */
    double step;  /* scene units from one texel of the main axis to the next */
    WrSkyShare share;
} WrSkyCourse;

/* pair: 0 .. directions / 2 - 1. */
static WrSkyCourse sky_course(const WrOcclusion *occlusion, int pair);

#define WR_SKY_BITS 28 /* bits of the largest height; sums at quarter texels use two more */

/* The whole table, in integer steps of a power of two, so that different floats stay different. */
typedef struct WrSky {
    const WrOcclusion *occlusion;
    const WrMapPart *part;
    int32_t *steps;
    size_t pitch;
    double unit;  /* scene units a step */
    double range; /* scene units */
    int k;        /* < 0: occlusion */
    const float *p, *q;
    float *out;
    const WrSkyKernels *kernels;
} WrSky;

/* ---- sweeps along all lines of a direction, LANES of them side by side ---- */

#define LANES WR_SKY_LANES
#define BUNDLE 4 /* stripes that a thread processes at once */
#define AHEAD 8  /* rows of prefetching, for tables that no cache holds */

/* All lines of one direction. */
typedef struct Lines {
    const WrSky *sky;
    WrSkyCourse course;
    int along, across; /* texels of the main axis and of the other */
    bool turns_along, turns_across;
    bool closes;          /* lines repeat beyond the table */
    int ahead;            /* rows searched beyond the table */
    int first, stripes;   /* stripes of lanes, over the other axis */
    double scale;         /* of heights in steps, per row */
    size_t texels;        /* stride of the map in texels */
    struct Work **worker; /* [threads] */
} Lines;

/* The adjacent lines of a stripe. */
typedef struct Stripe {
    int32_t *h;      /* [ahead + along + ahead][LANES] */
    float *slope[2]; /* [along][LANES] */
} Stripe;

/* Adjacent stripes are written row by row, so that more of each cache line of a row is used. */
typedef struct Work {
    Stripe stripe[BUNDLE];
    int64_t *seen; /* [ahead + along + ahead][LANES] */
    int *rows;     /* [along + ahead] */
} Work;

/* Lines are a few tables long: most indices need no division. */
static int place(int64_t at, int n, bool turns)
{
    if (!turns) return at < 0 ? 0 : at < n ? (int)at : n - 1;
    if (at >= n) at -= n;
    else if (at < 0) at += n;
    if (at >= 0 && at < n) return (int)at;
    const int left = (int)(at % n);
    return left < 0 ? left + n : left;
}

/* Offset of a line along the other axis after some rows, in texels; q is 1, 2 or 4. */
static int64_t whole_of(int64_t parts, int q)
{
    return q == 1 ? parts : q == 2 ? parts >> 1 : parts >> 2;
}

/* Reads the texels of row `row` of the main axis, lanes from `from` on along the other. In the upright case lanes are
   adjacent texels of a row (stride 1), otherwise they are `pitch` apart; rows of the main axis have the other stride. A
   stripe at a periodic end, or partly beyond a clamped one, is read texel by texel through `place`. */
static void texels(const Lines *l, int row, int64_t from, int32_t *restrict out)
{
    const WrSky *sky = l->sky;
    const size_t own = l->course.upright ? sky->pitch : 1,
                 other = l->course.upright ? 1 : sky->pitch;
    const int32_t *at = sky->steps + (size_t)row * own;
    const int first = place(from, l->across, l->turns_across);
    const bool inside = l->turns_across || (from >= 0 && from < l->across);
    if (inside && first + LANES <= l->across) {
        at += (size_t)first * other;
        if (other == 1) __builtin_prefetch(at + (row + AHEAD < l->along ? AHEAD * own : 0));
        if (other == 1) memcpy(out, at, LANES * sizeof *out);
        else
            for (int i = 0; i < LANES; i++) out[i] = at[(size_t)i * other];
        return;
    }
    for (int i = 0; i < LANES; i++)
        out[i] = at[(size_t)place(from + i, l->across, l->turns_across) * other];
}

/* Samples row s, also beyond the table, for lanes that start at `base` and meet texels in rows of this
   * phase. The line leaves row s at the lateral position p (s - phase) / q; the height there is linear between the two texels
   beside it:
       q h = (q - part) h[whole] + part h[whole + 1],   part = p (s - phase) mod q
   All heights of a direction are multiplied by q <= 4, so the interpolation is exact in integers (WR_SKY_BITS + 2 <= 30 bits)
   and no texel differs from itself by a rounding; `scale` contains 1/q. */
static void sample(const Lines *l, int64_t s, int64_t base, int phase, int32_t *restrict out)
{
    const int q = l->course.q;
    const int64_t moved = (int64_t)l->course.p * (s - phase), whole = whole_of(moved, q);
    const int part = (int)(moved - whole * q), row = place(s, l->along, l->turns_along);
    texels(l, row, base + whole, out);
    if (q == 1) return;
    if (part == 0) {
        for (int i = 0; i < LANES; i++) out[i] *= q;
        return;
    }
    int32_t beside[LANES];
    texels(l, row, base + whole + 1, beside);
    for (int i = 0; i < LANES; i++) out[i] = (q - part) * out[i] + part * beside[i];
}

/* Row k beyond the table on one side. */
static int64_t outside(const Lines *l, int sign, int k)
{
    return sign > 0 ? l->along + k : -1 - k;
}

/* Beyond the table only rows matter that are higher, in some lane, than all rows before them. A row that is not higher than a
   nearer one has at most its slope from every texel below that height. The rows are collected from near to far and then
   reversed: the sweep goes from the far end backwards and keeps the upper hull of the rows passed, so the hull starts with
   the farthest row. */
static int beyond(const Lines *l, int sign, int64_t base, int phase, int32_t *h, int *rows)
{
    const WrSkyKernels *kernels = l->sky->kernels;
    const int32_t *near = h + (size_t)(l->ahead + (sign > 0 ? 0 : l->along - 1)) * LANES;
    int32_t highest[LANES], row[LANES];
    int count = 0;
    for (int i = 0; i < LANES; i++) highest[i] = INT32_MIN;
    for (int k = 0; k < l->ahead; k++) {
        const int64_t s = outside(l, sign, k);
        if (l->closes) k = kernels->higher(near, sign, k, l->ahead, highest);
        else sample(l, s, base, phase, row);
        if (l->closes ? k == l->ahead : kernels->higher(row, 1, 0, 1, highest) == 1) continue;
        const int64_t at = outside(l, sign, k) + l->ahead;
        memcpy(h + at * LANES, l->closes ? near + (ptrdiff_t)sign * k * LANES : row, sizeof row);
        rows[count++] = (int)at;
    }
    for (int i = 0; i < count / 2; i++) {
        const int far = rows[count - 1 - i];
        rows[count - 1 - i] = rows[i];
        rows[i] = far;
    }
    return count;
}

static int opposite_of(const Lines *l)
{
    const int directions = l->sky->occlusion->directions;
    return (l->course.k + directions / 2) % directions;
}

/* Horizons ahead and behind, for lanes from `base` on. `rows` lists indices of `h`, whose first `ahead` rows lie before the
   table: the slopes of table row i are stored at i + ahead, therefore the pointer passed is moved back by `ahead` rows. It is
   used only for rows of the table. */
static void sweep_both(const Lines *l, int64_t base, int phase, const Work *work,
                       const Stripe *stripe)
{
    const int opposite = opposite_of(l);
    int32_t *h = stripe->h;
    for (int side = 0; side < 2; side++) {
        if (l->sky->k >= 0 && l->sky->k != (side ? opposite : l->course.k)) continue;
        const int count = beyond(l, side ? -1 : 1, base, phase, h, work->rows);
        for (int i = 0; i < l->along; i++)
            work->rows[count + i] = l->ahead + (side ? i : l->along - 1 - i);
        const WrSkySweep sweep = { h, work->seen, work->rows, count + l->along, count };
        float *slope = stripe->slope[side] - (ptrdiff_t)l->ahead * LANES;
        l->sky->kernels->sweep(&sweep, l->scale, slope);
    }
}

/* ---- results ------------------------------------------------------------------------------------- */

/* Runs of adjacent texels, up to the number processed at once. */
typedef struct Batch {
    WrSkyRun run[LANES];
    int count;
} Batch;

/* Stores the horizon of the one requested direction.
       out = 0 for s <= level,   2 (s - level) up to s = 2 level,   s beyond
   Continuous, so that roughness at the resolution of the heights causes no steps in the map. */
static void put_horizon(const Lines *l, const WrSkyRun *run)
{
    const float level = l->course.share.level;
    const float *slope = l->sky->k == l->course.k ? run->ahead : run->behind;
    for (int i = 0; i < run->count; i++) {
        const float over = slope[i] > level ? 2 * (slope[i] - level) : 0;
        run->loss[i] = over < slope[i] ? over : slope[i];
    }
}

static void put_batch(const Lines *l, Batch *batch)
{
    if (l->sky->k < 0) l->sky->kernels->share(&l->course.share, batch->run, batch->count);
    else
        for (int r = 0; r < batch->count; r++) put_horizon(l, &batch->run[r]);
    batch->count = 0;
}

/* at: the first texel. Prefetches the same column some rows further down. */
static inline void add_run(const Lines *l, Batch *batch, size_t at, const float *ahead,
                           const float *behind, int count)
{
    const WrSky *sky = l->sky;
    WrSkyRun *run = &batch->run[batch->count++];
    *run = (WrSkyRun){ ahead, behind, NULL, NULL, sky->out + at, count };
    if (sky->k < 0) {
        const size_t later = AHEAD * sky->part->pitch;
        run->p = sky->p + at, run->q = sky->q + at;
        if (at + later < l->texels) {
            __builtin_prefetch(run->p + later, 0, 2);
            __builtin_prefetch(run->q + later, 0, 2);
            __builtin_prefetch(run->loss + later, 0, 2);
        }
    }
    if (batch->count == LANES) put_batch(l, batch);
}

/* Stores the lanes of row s for lines whose other axis runs along the table's rows. */
static void put_row(const Lines *l, int64_t start, int lanes, int s, const Stripe *stripe,
                    Batch *batch)
{
    const size_t from = (size_t)s * LANES, row = (size_t)s * l->sky->part->pitch;
    const float *ahead = stripe->slope[0] + from, *behind = stripe->slope[1] + from;
    for (int i = 0, more; i < lanes; i += more) {
        const int64_t at = start + i;
        const int across = place(at, l->across, l->turns_across);
        more = l->across - across < lanes - i ? l->across - across : lanes - i;
        if (!l->turns_across && at < 0) more = -at < lanes - i ? (int)-at : lanes - i;
        else if (!l->turns_across && at >= l->across) more = lanes - i;
        else add_run(l, batch, row + (size_t)across, ahead + i, behind + i, more);
    }
}

/* Stores rows s to s + LANES - 1 of lines that run along the table's rows: lane by lane, because texels
 * are contiguous along a lane. */
static int put_block(const Lines *l, int64_t start, int lanes, int s, const Stripe *stripe,
                     Batch *batch)
{
    float turned[2][LANES][LANES];
    const int rows = l->along - s < LANES ? l->along - s : LANES;
    for (int side = 0; side < 2; side++)
        for (int k = 0; k < rows; k++)
            for (int i = 0; i < LANES; i++)
                turned[side][i][k] = stripe->slope[side][(size_t)(s + k) * LANES + (size_t)i];
    for (int i = 0; i < lanes; i++) {
        if (!l->turns_across && (start + i < 0 || start + i >= l->across)) continue;
        const size_t row = (size_t)place(start + i, l->across, l->turns_across);
        add_run(l, batch, row * l->sky->part->pitch + (size_t)s, turned[0][i], turned[1][i], rows);
    }
    put_batch(l, batch);
    return rows;
}

/* Texels that are not contiguous: gathered copies of their data. */
typedef struct Loose {
    float p[LANES * LANES], q[LANES * LANES], out[LANES * LANES];
    size_t at[LANES * LANES];
    int count;
} Loose;

static void put_loose(const Lines *l, Loose *loose, Batch *batch)
{
    put_batch(l, batch);
    for (int i = 0; i < loose->count; i++)
        if (loose->at[i] < l->texels) l->sky->out[loose->at[i]] = loose->out[i];
    loose->count = 0;
}

/* Stores the lanes of row s of oblique lines that run along the table's rows. */
static void take_leaning(const Lines *l, int64_t start, int lanes, int s, const Stripe *stripe,
                         Loose *loose, Batch *batch)
{
    const WrSky *sky = l->sky;
    const int from = loose->count;
    for (int i = 0; i < lanes; i++) {
        const bool there = l->turns_across || (start + i >= 0 && start + i < l->across);
        const size_t row = (size_t)place(start + i, l->across, l->turns_across);
        const size_t at = row * sky->part->pitch + (size_t)s;
        loose->at[from + i] = there ? at : SIZE_MAX;
        /* beyond the edge the texel belongs to another line */
        loose->out[from + i] = there ? sky->out[at] : 0;
        if (sky->k >= 0) continue;
        loose->p[from + i] = sky->p[at];
        loose->q[from + i] = sky->q[at];
    }
    const size_t first = (size_t)s * LANES;
    batch->run[batch->count++] =
        (WrSkyRun){ stripe->slope[0] + first, stripe->slope[1] + first, loose->p + from,
                    loose->q + from,          loose->out + from,        lanes };
    loose->count += lanes;
    if (batch->count == LANES) put_loose(l, loose, batch);
}

static int lanes_from(const Lines *l, int64_t base)
{
    const int64_t left = l->turns_across ? l->across - base : LANES;
    return left < LANES ? (int)left : LANES;
}

static void put_lines(const Lines *l, int64_t base, int stripes, int phase, const Work *work)
{
    const int q = l->course.q, p = l->course.p;
    Batch batch;
    Loose loose;
    batch.count = loose.count = 0;
    for (int s = phase, more = q; s < l->along; s += more) {
        for (int k = 0; k < stripes; k++) {
            const int64_t from = base + k * LANES;
            const int64_t start = from + whole_of((int64_t)p * (s - phase), q);
            const int lanes = lanes_from(l, from);
            const Stripe *stripe = &work->stripe[k];
            if (l->course.upright) put_row(l, start, lanes, s, stripe, &batch);
            else if (p == 0) more = put_block(l, start, lanes, s, stripe, &batch);
            else take_leaning(l, start, lanes, s, stripe, &loose, &batch);
        }
    }
    put_loose(l, &loose, &batch);
}

static void free_work(Work *work)
{
    if (!work) return;
    for (int k = 0; k < BUNDLE; k++) {
        wr_free(work->stripe[k].h);
        wr_free(work->stripe[k].slope[0]), wr_free(work->stripe[k].slope[1]);
    }
    wr_free(work->seen), wr_free(work->rows);
    wr_free(work);
}

static Work *new_work(const Lines *l)
{
    const size_t rows = (size_t)l->along + 2 * (size_t)l->ahead, main = (size_t)l->along;
    Work *work = wr_alloc(1, sizeof *work);
    for (int k = 0; k < BUNDLE && k < l->stripes; k++) {
        Stripe *stripe = &work->stripe[k];
        stripe->h = wr_alloc_unset(rows * LANES, sizeof(int32_t));
        for (int side = 0; side < 2; side++)
            stripe->slope[side] = wr_alloc(main * LANES, sizeof(float));
    }
    work->seen = wr_alloc_unset(rows * LANES, sizeof(int64_t));
    work->rows = wr_alloc_unset(rows, sizeof(int));
    return work;
}

static int bundles_of(const Lines *l)
{
    return (l->stripes + BUNDLE - 1) / BUNDLE;
}

static void piece(int index, int worker, void *ctx)
{
    const Lines *l = ctx;
    const int bundles = bundles_of(l), first = index % bundles * BUNDLE, phase = index / bundles;
    const int left = l->stripes - first, stripes = left < BUNDLE ? left : BUNDLE;
    const int64_t base = l->first + (int64_t)first * LANES;
    if (!l->worker[worker]) l->worker[worker] = new_work(l);
    const Work *work = l->worker[worker];
    for (int s = 0; s < l->along; s++)
        for (int k = 0; k < stripes; k++)
            sample(l, s, base + k * LANES, phase,
                   work->stripe[k].h + (size_t)(s + l->ahead) * LANES);
    for (int k = 0; k < stripes; k++)
        sweep_both(l, base + k * LANES, phase, work, &work->stripe[k]);
    put_lines(l, base, stripes, phase, work);
}

/* ---- one direction ------------------------------------------------------------------------------- */

static int64_t common(int64_t a, int64_t b)
{
    return b == 0 ? a : common(b, a % b);
}

/* Number of rows after which a line repeats: it returns to its start, or runs along clamped edges. */
static int64_t period_of(const Lines *l)
{
    const int64_t q = l->course.q, p = llabs((long long)l->course.p);
    int64_t settle = 0, period = 1;
    if (l->turns_along) period = l->along / common(l->along, q) * q;
    else settle += l->along;
    if (p == 0) return settle + period;
    if (!l->turns_across) return settle + (l->across + p - 1) / p * q + period;
    if (!l->turns_along) return settle + q * l->across;
    const int64_t drift = p * period / q;
    return period * (l->across / common(l->across, drift % l->across));
}

static void open_lines(Lines *l)
{
    const WrField *field = l->sky->occlusion->field;
    const bool turns_u = wr_field_wrap_u(field) == WR_WRAP_PERIODIC;
    const bool turns_v = wr_field_wrap_v(field) == WR_WRAP_PERIODIC;
    const int w = wr_field_width(field), h = wr_field_height(field), longer = w > h ? w : h;
    const int most = longer * WR_OCCLUSION_ROUND > WR_OCCLUSION_MIN ? longer * WR_OCCLUSION_ROUND
                                                                    : WR_OCCLUSION_MIN;
    l->along = l->course.upright ? h : w;
    l->across = l->course.upright ? w : h;
    l->turns_along = l->course.upright ? turns_v : turns_u;
    l->turns_across = l->course.upright ? turns_u : turns_v;
    const int64_t period = period_of(l);
    l->ahead = period <= most ? (int)period : most;
    l->course.share.level =
        period <= most ? 0 : (float)(l->sky->range / (l->ahead * l->course.step));
    l->scale = l->sky->unit / (l->course.q * l->course.step);
    const int drift = (int)whole_of((int64_t)l->course.p * l->along, l->course.q);
    const int less = l->turns_across || drift < 0 ? 0 : drift,
              more = l->turns_across || drift > 0 ? 0 : -drift;
    l->first = -less - (less > 0 ? LANES : 0);
    l->stripes = (l->across + more + (more > 0 ? LANES : 0) - l->first + LANES - 1) / LANES;
    l->closes = l->ahead == l->along; /* no other line has that period */
    l->texels = l->sky->part->pitch * (size_t)l->sky->part->h;
}

/* Processes both directions of a pair: adds the sky fraction that they hide to `out`, or stores the
 * horizon of the requested one. False: cancelled. */
static bool sky_run_pair(const WrSky *sky, int pair, WrPool *pool)
{
    const int threads = wr_pool_threads(pool);
    Lines l = { .sky = sky, .course = sky_course(sky->occlusion, pair) };
    const int opposite = opposite_of(&l);
    if (sky->k >= 0 && sky->k != l.course.k && sky->k != opposite) return true;
    open_lines(&l);
    l.worker = wr_alloc((size_t)threads, sizeof *l.worker);
    const bool good = wr_pool_run(pool, bundles_of(&l) * l.course.q, piece, &l);
    for (int i = 0; i < threads; i++) free_work(l.worker[i]);
    wr_free(l.worker);
    return good;
}

/* ---- searches within a reach, texel by texel ---- */

#define NEAR_ROWS 16 /* rows of the map in one piece of work */

typedef struct Near {
    const WrOcclusion *occlusion;
    const WrMapPart *part;
    int k; /* < 0: occlusion */
    const float *p, *q;
    float *out;
    const WrSkyKernels *kernels;
} Near;

/* A piece's heights with a margin of the search distance on all sides. */
typedef struct Ground {
    float *heights;
    size_t pitch;
    int reach;
} Ground;

static Ground open_ground(const Near *near, int y, int rows)
{
    const WrOcclusion *o = near->occlusion;
    /* one more texel for samples between two */
    const int reach = o->reach + 1, wide = near->part->w + 2 * reach;
    Ground g = { NULL, (size_t)wide, reach };
    g.heights = wr_alloc_unset((size_t)wide * (size_t)(rows + 2 * reach), sizeof(float));
    for (int j = 0; j < rows + 2 * reach; j++) {
        float *row = g.heights + (size_t)j * g.pitch;
        wr_derivatives_read_clamped(o->field, near->part->x - reach, near->part->y + y + j - reach,
                                    wide, row);
        for (int i = 0; i < wide; i++) row[i] *= (float)o->height;
    }
    return g;
}

static int floor_div(int a, int b)
{
    return a / b - (a % b < 0);
}

/* The horizon along a direction (sign 1) or against it, for `count` texels whose first is at c. */
static void look_along(const Near *near, const Ground *g, const WrSkyCourse *course, int sign,
                       const float *c, int count, float *best)
{
    const ptrdiff_t own = course->upright ? (ptrdiff_t)g->pitch : 1;
    const ptrdiff_t other = course->upright ? 1 : (ptrdiff_t)g->pitch;
    memset(best, 0, (size_t)count * sizeof *best);
    for (int t = 1; t <= near->occlusion->reach; t++) {
        const int moved = sign * course->p * t, whole = floor_div(moved, course->q);
        const float part = (float)(moved - whole * course->q) / (float)course->q;
        const float *a = c + sign * t * own + whole * other;
        near->kernels->look(c, a, a + other, part, (float)(1 / (t * course->step)), count, best);
    }
}

static void strip(const Near *near, const Ground *g, int x, int y, int from, int count)
{
    const size_t at = (size_t)y * near->part->pitch + (size_t)x;
    const float *c = g->heights + (size_t)(y - from + g->reach) * g->pitch + (size_t)(x + g->reach);
    float ahead[WR_SKY_STRIP], behind[WR_SKY_STRIP];
    for (int pair = 0; pair < near->occlusion->directions / 2; pair++) {
        const WrSkyCourse course = sky_course(near->occlusion, pair);
        const int opposite =
            (course.k + near->occlusion->directions / 2) % near->occlusion->directions;
        if (near->k >= 0 && near->k != course.k && near->k != opposite) continue;
        if (near->k != opposite) look_along(near, g, &course, 1, c, count, ahead);
        if (near->k != course.k) look_along(near, g, &course, -1, c, count, behind);
        const WrSkyRun run = { ahead,
                               behind,
                               near->k < 0 ? near->p + at : NULL,
                               near->k < 0 ? near->q + at : NULL,
                               near->out + at,
                               count };
        if (near->k < 0) near->kernels->share(&course.share, &run, 1);
        else
            memcpy(near->out + at, near->k == course.k ? ahead : behind,
                   (size_t)count * sizeof(float));
    }
}

static void piece_near(int index, int worker, void *ctx)
{
    const Near *near = ctx;
    const int y = index * NEAR_ROWS, left = near->part->h - y,
              rows = left < NEAR_ROWS ? left : NEAR_ROWS;
    Ground g = open_ground(near, y, rows);
    (void)worker;
    for (int j = y; j < y + rows; j++) {
        for (int x = 0; x < near->part->w; x += WR_SKY_STRIP) {
            const int more = near->part->w - x;
            strip(near, &g, x, j, y, more < WR_SKY_STRIP ? more : WR_SKY_STRIP);
        }
    }
    wr_free(g.heights);
}

/* occlusion.c: the search with a reach. k as in occlusion.h; k < 0: occlusion. */
static bool sky_near(const WrOcclusion *occlusion, const WrMapPart *part, int k, const float *p,
                     const float *q, WrPool *pool, float *out, WrError *err)
{
    Near near = { occlusion, part, k, p, q, out, wr_sky_kernels() };
    if (wr_pool_run_with_progress(pool, (part->h + NEAR_ROWS - 1) / NEAR_ROWS, piece_near, &near))
        return true;
    return wr_fail(err, "occlusion: cancelled");
}

/* ---- the maps ---- */

#define FILL_ROWS 64 /* rows of the table that a thread processes at once */

static const WrCpuBuilds builds = { &wr_sky_kernels_v1, &wr_sky_kernels_v3, &wr_sky_kernels_v4 };

const WrSkyKernels *wr_sky_kernels_at(int index)
{
    return wr_cpu_build(&builds, index);
}

const WrSkyKernels *wr_sky_kernels(void)
{
    return wr_cpu_best(&builds);
}

/* ---- directions ---------------------------------------------------------------------------------- */

/* In scene units, y up. */
static void vector_of(const WrOcclusion *o, int k, double *x, double *y)
{
    double i, j;
    wr_horizon_direction((k + o->directions) % o->directions, o->directions, &i, &j);
    *x = i * o->texel_w;
    *y = j * o->texel_h; /* anticlockwise: rows count downwards like the table's directions, so the
                            direction is -j */
}

static double turns_of(const WrOcclusion *o, int k)
{
    double x, y;
    vector_of(o, k, &x, &y);
    const double turns = wr_atan2(y, x) / (2 * WR_PI);
    return turns < 0 ? turns + 1 : turns;
}

double wr_occlusion_degrees(const WrOcclusion *occlusion, int k)
{
    return 360 * turns_of(occlusion, k);
}

static double between(double from, double to)
{
    return to < from ? to + 1 - from : to - from;
}

static WrSkyCourse sky_course(const WrOcclusion *occlusion, int pair)
{
    const WrOcclusion *o = occlusion;
    const int half = o->directions / 2, fine = o->directions < 8 ? 1 : o->directions / 8;
    double i, j, x, y;
    wr_horizon_direction(pair, o->directions, &i, &j);
    j = -j;
    WrSkyCourse c = { .upright = fabs(j) >= fabs(i) }; /* rows of texels are contiguous */
    const bool back = (c.upright ? j : i) < 0;
    c.k = back ? pair + half : pair;
    if (back) i = -i, j = -j;
    c.q = fine;
    c.p = (int)lrint(fine * (c.upright ? i : j));
    while (c.q > 1 && c.p % 2 == 0) c.q /= 2, c.p /= 2;
    vector_of(o, c.k, &x, &y);
    c.step = sqrt(x * x + y * y);
    const double before = turns_of(o, c.k - 1), after = turns_of(o, c.k + 1);
    c.share = (WrSkyShare){ .ux = (float)(x / c.step),
                            .uy = (float)(y / c.step),
                            .weight = (float)(between(before, after) / 2),
                            .first = pair == 0,
                            .last = pair == half - 1 };
    return c;
}

/* ---- a table ------------------------------------------------------------------------------------- */

typedef struct Rows {
    WrSky *sky;
    double scale; /* steps for F = 1 */
} Rows;

static void fill_rows(int index, int worker, void *ctx)
{
    const Rows *rows = ctx;
    const WrSky *sky = rows->sky;
    const int w = sky->part->w, end = (index + 1) * FILL_ROWS;
    float *row = wr_alloc_unset((size_t)w, sizeof *row);
    (void)worker;
    for (int j = index * FILL_ROWS; j < end && j < sky->part->h; j++) {
        int32_t *out = sky->steps + (size_t)j * sky->pitch;
        wr_field_read(sky->occlusion->field, 0, j, w, 1, row, (size_t)w);
        for (int i = 0; i < w; i++) out[i] = (int32_t)lrint(rows->scale * (double)row[i]);
    }
    wr_free(row);
}

static int pieces_of(const WrSky *sky)
{
    return (sky->part->h + FILL_ROWS - 1) / FILL_ROWS;
}

static bool fill_steps(WrSky *sky, WrPool *pool, WrError *err)
{
    const WrOcclusion *o = sky->occlusion;
    const int w = sky->part->w, h = sky->part->h;
    float low, high;
    wr_field_range(o->field, &low, &high);
    int exponent;
    frexp(fmax(fabs((double)low), fabs((double)high)), &exponent);
    Rows rows = { sky, ldexp(o->height < 0 ? -1 : 1, WR_SKY_BITS - exponent) };
    sky->unit = fabs(o->height) * ldexp(1, exponent - WR_SKY_BITS);
    sky->range = fabs(o->height) * ((double)high - (double)low);
    /* not a power of two, to avoid cache conflicts */
    sky->pitch = (size_t)w + 16 + (size_t)(w % 2 == 0);
    sky->steps = wr_try_alloc_unset(sky->pitch * (size_t)h, sizeof(int32_t), "occlusion", err);
    if (sky->steps) wr_pool_run(pool, pieces_of(sky), fill_rows, &rows);
    return sky->steps != NULL;
}

static bool run_table(WrSky *sky, WrPool *pool, WrError *err)
{
    const int pairs = sky->occlusion->directions / 2;
    for (int pair = 0; pair < pairs; pair++)
        if (!sky_run_pair(sky, pair, pool) || !wr_progress_report((pair + 1.0) / pairs))
            return wr_fail(err, "occlusion: cancelled");
    return true;
}

static bool make(const WrOcclusion *occlusion, const WrMapPart *part, int k, const float *p,
                 const float *q, WrPool *pool, float *out, WrError *err)
{
    if (occlusion->reach > 0) return sky_near(occlusion, part, k, p, q, pool, out, err);
    WrSky sky = { occlusion, part, NULL, 0, 0, 0, k, p, q, out, wr_sky_kernels() };
    const bool good = fill_steps(&sky, pool, err) && run_table(&sky, pool, err);
    wr_free(sky.steps);
    return good;
}

bool wr_occlusion_make(const WrOcclusion *occlusion, const WrMapPart *part, const float *p,
                       const float *q, WrPool *pool, float *out, WrError *err)
{
    return make(occlusion, part, -1, p, q, pool, out, err);
}

bool wr_occlusion_horizon(const WrOcclusion *occlusion, const WrMapPart *part, int k, WrPool *pool,
                          float *out, WrError *err)
{
    return make(occlusion, part, k, NULL, NULL, pool, out, err);
}
