#include "render/textures/slope_pyramid.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "field/field.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* ---- slope bounds ---- */

/* Bounds of |Fu|, |Fv| over a box of (u, v), from bounds per tile of the table. A box of more than TILES_MAX
   tiles has the bound of the whole table: the search would cost more than it saves. */

#define REACH 3      /* texels: those that a fetch reads beside its position, and rounding */
#define TILES_MAX 64 /* largest number of tiles of a box */

/* Texels of an axis, from <= to; on a periodic one they may extend past both ends. */
typedef struct Run {
    int from, to;
} Run;

static double limited(double x)
{
    return x > 0 ? fmin(x, 1) : 0;
}

/* Positions a .. b of the axis; flipped: texel 0 is at 1.
   `flipped`: rows run down. The run is widened by REACH texels: taps beside the position and rounding. */
static Run run_of(double a, double b, int size, bool periodic, bool flipped)
{
    const Run all = { 0, size - 1 };
    const double low = fmin(a, b), high = fmax(a, b), turns = periodic ? floor(low) : 0;
    double from = low - turns, to = high - turns;
    if (!(to - from < 1) || (periodic && to >= 1)) return all;
    if (!periodic) from = limited(from), to = limited(to);
    const Run run = { (int)floor(size * (flipped ? 1 - to : from)) - REACH,
                      (int)floor(size * (flipped ? 1 - from : to)) + REACH };
    if (run.to - run.from >= size) return all;
    if (periodic) return run;
    return (Run){ run.from > 0 ? run.from : 0, run.to < size ? run.to : size - 1 };
}

static int around(int i, int size)
{
    return i < 0 ? i + size : i >= size ? i - size : i;
}

/* The first texel of the next tile. */
static int next_tile(int i, int size)
{
    const int at = around(i, size), end = at - at % WR_TILE + WR_TILE;
    return i + (end < size ? end : size) - at;
}

/* Adds the slopes of tile `at`, including those to tile `first`.
   Without slopes per tile only flatness can be decided: equal heights in all tiles, else unbounded. */
static void add_tile(const WrLevel *level, int at, int first, float steepest[2])
{
    const bool even =
        !level->steep && level->low[at] == level->high[at] && level->low[at] == level->low[first];
    for (int c = 0; c < 2; c++) {
        const float steep = level->steep ? level->steep[at][c] : even ? 0 : INFINITY;
        steepest[c] = steep > steepest[c] ? steep : steepest[c];
    }
}

void wr_level_box(const WrLevel *level, double u0, double u1, double v0, double v1,
                  float steepest[2])
{
    const int width = level->width, height = level->height;
    for (int c = 0; c < 2; c++) steepest[c] = level->steepest[c];
    if (!(u0 <= u1 && v0 <= v1)) return; /* NaN included */
    const Run x = run_of(level->ru * u0, level->ru * u1, width, level->periodic_u, false);
    const Run y = run_of(level->rv * v0, level->rv * v1, height, level->periodic_v, true);
    float most[2] = { 0, 0 };
    int tiles = 0, first = -1;
    for (int j = y.from; j <= y.to; j = next_tile(j, height))
        for (int i = x.from; i <= x.to; i = next_tile(i, width)) {
            const int tu = around(i, width) / WR_TILE, tv = around(j, height) / WR_TILE;
            const int at = tv * level->tiles_u + tu;
            first = first < 0 ? at : first;
            if (++tiles > TILES_MAX) return;
            add_tile(level, at, first, most);
        }
    for (int c = 0; c < 2; c++) steepest[c] = most[c];
}

/* A texel during construction.
   Level l has one texel for a box of about 2^l x 2^l table texels, as floats of fu, fv, f, - and for MOMENTS
   suu, suv, svv, -. Level 0 of the slope kinds is the gradient copy itself. Each level has an apron of one
   texel. */
typedef struct Cell {
    double fu, fv, f, suu, suv, svv;
} Cell;

static float narrow(double x)
{
    return (float)(x > FLT_MAX ? FLT_MAX : x < -FLT_MAX ? -FLT_MAX : x);
}

/* Size of the next level. Blocks of RANGE double in size; the last block of a row may be partial. */
static int half(WrPyramidKind kind, int size)
{
    int next = kind == WR_PYRAMID_RANGE ? (size + 1) / 2 : size / 2;
    return next > 1 ? next : 1;
}

void wr_pyramid_drop(WrPyramid *pyramid)
{
    for (int l = 0; l < WR_PYRAMID_LEVELS; l++) wr_free(pyramid->level[l].data);
    wr_field_free(pyramid->seen);
    memset(pyramid, 0, sizeof *pyramid);
}

static float *texel(const WrPyramid *pyramid, int level, int i, int j)
{
    const WrPyramidLevel *at = &pyramid->level[level];
    size_t place = (size_t)(j + 1) * (size_t)at->pitch + (size_t)(i + 1);
    return at->data + place * (size_t)pyramid->floats;
}

/* ---- one level from the one below ---------------------------------------------------------------- */

typedef struct Job {
    WrPyramid *pyramid;
    const WrField *field; /* source of level 1; NULL: level 1 exists */
    WrWrap wrap_u, wrap_v;
    int level; /* level to build */
    /* bits of the levels whose outermost texels changed: their aprons must be updated */
    unsigned ends;
} Job;

/* Central differences of the table at [i0, i1) x [j0, j1), equal to those of the gradient copy. */
static void read_table(const WrField *field, int i0, int i1, int j0, int j1, Cell *out)
{
    const int w = i1 - i0, h = j1 - j0;
    const double half_w = 0.5 * wr_field_width(field), half_h = 0.5 * wr_field_height(field);
    const size_t ring = (size_t)w + 2;
    float *t = wr_alloc(ring * ((size_t)h + 2), sizeof *t);
    wr_field_read(field, i0 - 1, j0 - 1, w + 2, h + 2, t, ring);
    for (int y = 0; y < h; y++) {
        const float *up = t + (size_t)y * ring + 1, *mid = up + ring, *down = mid + ring;
        for (int x = 0; x < w; x++)
            out[(size_t)y * (size_t)w + (size_t)x] =
                (Cell){ .fu = (double)narrow(((double)mid[x + 1] - mid[x - 1]) * half_w),
                        .fv = (double)narrow(((double)up[x] - down[x]) * half_h),
                        .f = (double)mid[x] };
    }
    wr_free(t);
}

static void read_level(const WrPyramid *pyramid, int level, int i0, int i1, int j0, int j1,
                       Cell *out)
{
    for (int j = j0; j < j1; j++)
        for (int i = i0; i < i1; i++) {
            const float *t = texel(pyramid, level, i, j);
            Cell cell = { .fu = (double)t[0], .fv = (double)t[1], .f = (double)t[2] };
            if (pyramid->kind == WR_PYRAMID_MOMENTS)
                cell.suu = (double)t[4], cell.suv = (double)t[5], cell.svv = (double)t[6];
            *out++ = cell;
        }
}

/* Sizes need not be even (HC55): texel i of m covers n/m texels of the level below, from i n / m on; ends
   count in part. Weights are exact ratios and sum to 1, so the mean is preserved at each level and no phase
   shift occurs. */
WrShare wr_pyramid_box_weights(int i, int n, int m)
{
    WrShare s = { (int)((int64_t)i * n / m), 0, { 0 } };
    int last = (int)(((int64_t)(i + 1) * n + m - 1) / m); /* one past the end */
    for (int k = s.from; k < last && s.count < 4; k++) {
        int64_t a = (int64_t)i * n, b = (int64_t)(i + 1) * n; /* in 1/m texels */
        int64_t low = (int64_t)k * m > a ? (int64_t)k * m : a;
        int64_t high = (int64_t)(k + 1) * m < b ? (int64_t)(k + 1) * m : b;
        s.weight[s.count++] = (double)(high - low) / (double)n;
    }
    return s;
}

/* Mean first, then the covariance around it.
   Law of total covariance: the mean of covariances plus the covariance of means. E[p^2] - E[p]^2 would cancel
   for large slopes of small variance, and become negative (HC93, HC142). */
static Cell gather(const Cell *source, size_t pitch, const WrShare *u, const WrShare *v)
{
    Cell sum = { 0 };
    for (int b = 0; b < v->count; b++)
        for (int a = 0; a < u->count; a++) {
            const Cell *c = &source[(size_t)b * pitch + (size_t)a];
            double w = u->weight[a] * v->weight[b];
            sum.fu += w * c->fu, sum.fv += w * c->fv, sum.f += w * c->f;
        }
    for (int b = 0; b < v->count; b++)
        for (int a = 0; a < u->count; a++) {
            const Cell *c = &source[(size_t)b * pitch + (size_t)a];
            double w = u->weight[a] * v->weight[b], du = c->fu - sum.fu, dv = c->fv - sum.fv;
            sum.suu += w * (c->suu + du * du);
            sum.suv += w * (c->suv + du * dv);
            sum.svv += w * (c->svv + dv * dv);
        }
    return sum;
}

static void store(const WrPyramid *pyramid, const Cell *cell, float *out)
{
    out[0] = narrow(cell->fu), out[1] = narrow(cell->fv), out[2] = narrow(cell->f);
    if (pyramid->kind != WR_PYRAMID_MOMENTS) return;
    out[4] = narrow(cell->suu), out[5] = narrow(cell->suv), out[6] = narrow(cell->svv);
}

/* Builds texels [i0, i1) of row j of a level. */
static void make_row(const Job *job, int i0, int i1, int j)
{
    const WrPyramid *pyramid = job->pyramid;
    const WrPyramidLevel *to = &pyramid->level[job->level], *from = to - 1;
    const WrShare v = wr_pyramid_box_weights(j, from->height, to->height);
    WrShare first = wr_pyramid_box_weights(i0, from->width, to->width);
    WrShare last = wr_pyramid_box_weights(i1 - 1, from->width, to->width);
    const int a = first.from, b = last.from + last.count;
    Cell *source = wr_alloc((size_t)(b - a) * (size_t)v.count, sizeof *source);
    if (job->level == 1) read_table(job->field, a, b, v.from, v.from + v.count, source);
    else read_level(pyramid, job->level - 1, a, b, v.from, v.from + v.count, source);
    for (int i = i0; i < i1; i++) {
        WrShare u = wr_pyramid_box_weights(i, from->width, to->width);
        Cell cell = gather(source + (u.from - a), (size_t)(b - a), &u, &v);
        store(pyramid, &cell, texel(pyramid, job->level, i, j));
    }
    wr_free(source);
}

/* RANGE: least and largest fu, fv of a block; comparisons only, so bounds are exact. */
static void join_range(const float *in, float *out)
{
    out[0] = in[0] < out[0] ? in[0] : out[0];
    out[1] = in[1] > out[1] ? in[1] : out[1];
    out[2] = in[2] < out[2] ? in[2] : out[2];
    out[3] = in[3] > out[3] ? in[3] : out[3];
}

static void make_range_row(const Job *job, int i0, int i1, int j)
{
    const WrPyramid *pyramid = job->pyramid;
    if (job->level == 0) {
        Cell *row = wr_alloc((size_t)(i1 - i0), sizeof *row);
        read_table(job->field, i0, i1, j, j + 1, row);
        for (int i = i0; i < i1; i++) {
            float *out = texel(pyramid, 0, i, j);
            out[0] = out[1] = (float)row[i - i0].fu;
            out[2] = out[3] = (float)row[i - i0].fv;
        }
        wr_free(row);
        return;
    }
    const WrPyramidLevel *from = &pyramid->level[job->level - 1];
    for (int i = i0; i < i1; i++) {
        float *out = texel(pyramid, job->level, i, j);
        memcpy(out, texel(pyramid, job->level - 1, 2 * i, 2 * j), 4 * sizeof *out);
        for (int b = 2 * j; b < 2 * j + 2 && b < from->height; b++)
            for (int a = 2 * i; a < 2 * i + 2 && a < from->width; a++)
                join_range(texel(pyramid, job->level - 1, a, b), out);
    }
}

static void make(const Job *job, int i0, int i1, int j)
{
    if (job->pyramid->kind == WR_PYRAMID_RANGE) make_range_row(job, i0, i1, j);
    else make_row(job, i0, i1, j);
}

/* ---- the apron ---------------------------------------------------------------------------------- */

int wr_pyramid_fold(int i, int n, WrWrap wrap)
{
    if (wrap == WR_WRAP_PERIODIC) return (i % n + n) % n;
    return i < 0 ? 0 : i >= n ? n - 1 : i;
}

static void border(const Job *job, int i, int j)
{
    const WrPyramidLevel *at = &job->pyramid->level[job->level];
    int from_i = wr_pyramid_fold(i, at->width, job->wrap_u);
    int from_j = wr_pyramid_fold(j, at->height, job->wrap_v);
    memcpy(texel(job->pyramid, job->level, i, j), texel(job->pyramid, job->level, from_i, from_j),
           (size_t)job->pyramid->floats * sizeof(float));
}

static void make_apron(const Job *job)
{
    const WrPyramidLevel *at = &job->pyramid->level[job->level];
    for (int i = -1; i <= at->width; i++) border(job, i, -1), border(job, i, at->height);
    for (int j = 0; j < at->height; j++) border(job, -1, j), border(job, at->width, j);
}

/* ---- incremental update --------------------------------------------------------------------------- */

static int first_level(const WrPyramid *pyramid)
{
    return pyramid->kind == WR_PYRAMID_RANGE ? 0 : 1;
}

static void make_whole_row(int j, int worker, void *ctx)
{
    (void)worker;
    const Job *job = ctx;
    make(job, 0, job->pyramid->level[job->level].width, j);
}

static void make_all(Job *job, WrPool *pool)
{
    WrPyramid *pyramid = job->pyramid;
    for (job->level = first_level(pyramid); job->level < pyramid->levels; job->level++) {
        wr_pool_run(pool, pyramid->level[job->level].height, make_whole_row, job);
        make_apron(job);
    }
    pyramid->texels_refreshed =
        (int64_t)wr_field_width(job->field) * (int64_t)wr_field_height(job->field);
}

/* Rebuilds everything that depends on texels [a, b) x [c, d) of the table, which may extend one texel outside
   it. */
static void remake(Job *job, int a, int b, int c, int d)
{
    WrPyramid *pyramid = job->pyramid;
    const int w = wr_field_width(job->field), h = wr_field_height(job->field);
    for (job->level = first_level(pyramid); job->level < pyramid->levels; job->level++) {
        const WrPyramidLevel *at = &pyramid->level[job->level];
        /* One texel more on each side than the quotients give: rounded sizes drift slightly. */
        int i0 = (int)((int64_t)a * at->width / w) - 1, i1 = (int)((int64_t)b * at->width / w) + 2;
        int j0 = (int)((int64_t)c * at->height / h) - 1,
            j1 = (int)((int64_t)d * at->height / h) + 2;
        i0 = i0 < 0 ? 0 : i0, j0 = j0 < 0 ? 0 : j0;
        i1 = i1 > at->width ? at->width : i1, j1 = j1 > at->height ? at->height : j1;
        for (int j = j0; j < j1 && i0 < i1; j++) make(job, i0, i1, j);
        if (i0 == 0 || j0 == 0 || i1 == at->width || j1 == at->height)
            job->ends |= 1U << job->level;
    }
}

/* A tile's texels change the slopes of their neighbours, across periodic ends too. On a clamped axis the
   extrapolated end depends on 2 texels inside.
   reach: one texel for central differences, two more for extrapolated ends. */
static void remake_tile(int tx, int ty, void *ctx)
{
    Job *job = ctx;
    if (wr_progress_stopped()) return;
    const int w = wr_field_width(job->field), h = wr_field_height(job->field), reach = 3;
    const WrFieldRect own = wr_field_difference(job->pyramid->seen, job->field, tx, ty);
    if (own.i0 == own.i1) return;
    const int a = own.i0 - reach, b = own.i1 + reach, c = own.j0 - reach, d = own.j1 + reach;
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++) {
            int a2 = a + x * w, b2 = b + x * w, c2 = c + y * h, d2 = d + y * h;
            if (b2 <= 0 || a2 >= w || d2 <= 0 || c2 >= h) continue;
            remake(job, a2 < 0 ? 0 : a2, b2 > w ? w : b2, c2 < 0 ? 0 : c2, d2 > h ? h : d2);
        }
    job->pyramid->texels_refreshed += (own.i1 - own.i0) * (own.j1 - own.j0);
}

bool wr_pyramid_allocate(WrPyramid *pyramid, WrPyramidKind kind, int width, int height,
                         WrError *err)
{
    int w = width, h = height;
    wr_pyramid_drop(pyramid);
    pyramid->kind = kind;
    pyramid->floats = kind == WR_PYRAMID_MOMENTS ? 8 : 4;
    for (int level = 0;; level++) {
        pyramid->level[level].width = w, pyramid->level[level].height = h;
        pyramid->level[level].pitch = w + 2;
        pyramid->levels = level + 1;
        if (level >= first_level(pyramid)) {
            pyramid->level[level].data =
                wr_try_alloc((size_t)(w + 2) * (size_t)(h + 2),
                             (size_t)pyramid->floats * sizeof(float), "pyramid of slopes", err);
            if (!pyramid->level[level].data) {
                wr_pyramid_drop(pyramid);
                return false;
            }
        }
        if (w == 1 && h == 1) return true;
        w = half(kind, w), h = half(kind, h);
    }
}

static bool same_layout(const WrField *a, const WrField *b)
{
    return a && wr_field_width(a) == wr_field_width(b) &&
           wr_field_height(a) == wr_field_height(b) && wr_field_wrap_u(a) == wr_field_wrap_u(b) &&
           wr_field_wrap_v(a) == wr_field_wrap_v(b);
}

bool wr_pyramid_update(WrPyramid *pyramid, WrPyramidKind kind, const WrField *field, WrPool *pool,
                       WrError *err)
{
    Job job = { .pyramid = pyramid,
                .field = field,
                .wrap_u = wr_field_wrap_u(field),
                .wrap_v = wr_field_wrap_v(field) };
    const int tiles = wr_field_tiles_u(field) * wr_field_tiles_v(field);
    const bool same = pyramid->kind == kind && same_layout(pyramid->seen, field);
    pyramid->texels_refreshed = 0;
    const int changed = same ? wr_field_changed_tiles(pyramid->seen, field) : tiles;
    if (changed == 0) return true;
    if (same && changed <= tiles / 2) {
        wr_field_changes(pyramid->seen, field, remake_tile, &job);
        for (job.level = first_level(pyramid); job.level < pyramid->levels; job.level++)
            if (job.ends >> job.level & 1) make_apron(&job);
    } else {
        if (!same &&
            !wr_pyramid_allocate(pyramid, kind, wr_field_width(field), wr_field_height(field), err))
            return false;
        make_all(&job, pool);
    }
    if (wr_progress_stopped()) {
        wr_pyramid_drop(pyramid); /* incomplete */
        return wr_fail(err, "cancelled");
    }
    wr_field_free(pyramid->seen);
    pyramid->seen = wr_field_share(field);
    return true;
}

bool wr_pyramid_finish(WrPyramid *pyramid, WrWrap wrap_u, WrWrap wrap_v, WrPool *pool, WrError *err)
{
    Job job = { .pyramid = pyramid, .wrap_u = wrap_u, .wrap_v = wrap_v };
    for (job.level = 1; job.level < pyramid->levels; job.level++) {
        if (job.level > 1)
            wr_pool_run(pool, pyramid->level[job.level].height, make_whole_row, &job);
        make_apron(&job);
    }
    if (!wr_progress_stopped()) return true;
    wr_pyramid_drop(pyramid); /* incomplete */
    return wr_fail(err, "cancelled");
}
