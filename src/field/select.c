/* Selections by height, slope and flood fill; growing, shrinking and combination. */
#include "field/select.h"

#include "base/enum_rows.h"
#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "field/derivatives.h"
#include "field/field.h"
#include "field/scheme_list.h"
#include "field/ops.h"
#include "field/select_internal.h"

#include <math.h>
#include <string.h>

/* ---- bounding box ---- */

static void mark(const WrField *selection, bool *columns, bool *rows)
{
    const int width = wr_field_width(selection), height = wr_field_height(selection);
    for (int ty = 0; ty < wr_field_tiles_v(selection) && !wr_progress_stopped(); ty++)
        for (int tx = 0; tx < wr_field_tiles_u(selection); tx++) {
            const float *tile = wr_field_tile(selection, tx, ty);
            const float level = wr_field_level(selection);
            if (!tile && level == 0.0f) continue;
            for (int k = 0; k < WR_TILE * WR_TILE; k++) {
                int i = tx * WR_TILE + k % WR_TILE, j = ty * WR_TILE + k / WR_TILE;
                if (i >= width || j >= height || (tile ? tile[k] : level) == 0.0f) continue;
                columns[i] = rows[j] = true;
            }
        }
}

/* The shortest run of texels that contains all marked ones; on a periodic axis the complement of the
 * widest gap. */
static bool run_of(const bool *marked, int n, bool periodic, int *from, int *count)
{
    int first = -1, last = -1, before = -1, widest = 0, begin = 0;
    for (int i = 0; i < n; i++) {
        if (!marked[i]) continue;
        if (first < 0) first = i;
        if (before >= 0 && i - before - 1 > widest) {
            widest = i - before - 1;
            begin = i;
        }
        before = last = i;
    }
    if (first < 0) return false;
    bool over = periodic && widest > first + n - 1 - last;
    *from = over ? begin : first;
    *count = over ? n - widest : last - first + 1;
    return true;
}

bool wr_select_box_all(const WrField *const *fields, int count, WrSelectBox *box)
{
    if (count == 0) return false;
    const WrField *selection = fields[0];
    const int width = wr_field_width(selection), height = wr_field_height(selection);
    bool *columns = wr_alloc((size_t)width, sizeof *columns);
    bool *rows = wr_alloc((size_t)height, sizeof *rows);
    for (int k = 0; k < count; k++) mark(fields[k], columns, rows);
    bool any = run_of(columns, width, wr_field_wrap_u(selection) == WR_WRAP_PERIODIC, &box->i,
                      &box->count_i) &&
               run_of(rows, height, wr_field_wrap_v(selection) == WR_WRAP_PERIODIC, &box->j,
                      &box->count_j);
    wr_free(columns);
    wr_free(rows);
    return any;
}

bool wr_select_box(const WrField *selection, WrSelectBox *box)
{
    return wr_select_box_all(&selection, 1, box);
}

/* ---- flood fill ---- */

/* A run of `count` texels of one row from column x on; on a periodic axis it may continue at the first
   column. */
typedef struct Run {
    int x, y, count;
} Run;

typedef struct RunList {
    Run *runs; /* owned */
    size_t count, capacity;
} RunList;

typedef struct Flood {
    int width, height, tiles_u;
    bool wrap_u, wrap_v, diagonal;
    const float **tiles; /* [tiles_v][tiles_u], owned */
    float level;
    double low, high; /* range of heights of the region */
    uint64_t *marks;  /* [height][words], a bit for each visited texel; owned */
    size_t words;
    RunList now, next;
} Flood;

static bool push(RunList *list, Run run, WrError *err)
{
    if (list->count == list->capacity) {
        size_t grown = list->capacity ? 2 * list->capacity : 1024;
        Run *runs = wr_try_alloc(grown, sizeof *runs, "flood", err);
        if (!runs) return false;
        if (list->count) memcpy(runs, list->runs, list->count * sizeof *runs);
        wr_free(list->runs);
        list->runs = runs;
        list->capacity = grown;
    }
    list->runs[list->count++] = run;
    return true;
}

static bool is_marked(const Flood *f, int x, int y)
{
    return f->marks[(size_t)y * f->words + (size_t)(x >> 6)] >> (x & 63) & 1;
}

static void mark_flood(Flood *f, int x, int y)
{
    f->marks[(size_t)y * f->words + (size_t)(x >> 6)] |= (uint64_t)1 << (x & 63);
}

/* In range, and not yet visited. */
static bool is_open(const Flood *f, int x, int y)
{
    if (is_marked(f, x, y)) return false;
    const float *tile = f->tiles[(y / WR_TILE) * f->tiles_u + x / WR_TILE];
    double height = tile ? tile[(y % WR_TILE) * WR_TILE + x % WR_TILE] : f->level;
    return height >= f->low && height <= f->high;
}

static int left_of(const Flood *f, int x)
{
    return x > 0 ? x - 1 : f->wrap_u ? f->width - 1 : -1;
}

static int right_of(const Flood *f, int x)
{
    return x + 1 < f->width ? x + 1 : f->wrap_u ? 0 : -1;
}

/* Marks the whole run that contains the open texel (x, y), and adds it to the next list. */
static bool take_run(Flood *f, int x, int y, WrError *err)
{
    Run run = { x, y, 1 };
    mark_flood(f, x, y);
    for (int i = left_of(f, x); i >= 0 && is_open(f, i, y); i = left_of(f, i)) {
        mark_flood(f, i, y);
        run.x = i;
        run.count++;
    }
    for (int i = right_of(f, x); i >= 0 && is_open(f, i, y); i = right_of(f, i)) {
        mark_flood(f, i, y);
        run.count++;
    }
    return push(&f->next, run, err);
}

/* Visits all runs of row y that touch the run, also at corners if these count. */
static bool take_row(Flood *f, Run run, int y, WrError *err)
{
    if (y < 0 || y >= f->height) {
        if (!f->wrap_v) return true;
        y = y < 0 ? f->height - 1 : 0;
    }
    int x = run.x, count = run.count;
    if (f->diagonal && count < f->width) {
        int before = left_of(f, x);
        if (before >= 0) {
            x = before;
            count++;
        }
        count++; /* texels are counted from the one behind the end; at a clamped edge the loop stops
                    by itself */
    }
    for (int k = 0; k < count && x >= 0; k++, x = right_of(f, x))
        if (is_open(f, x, y) && !take_run(f, x, y, err)) return false;
    return true;
}

/* Proceeds in waves, so that only the runs at the border of the region are stored. */
static bool spread(Flood *f, const WrProgress *progress, WrError *err)
{
    while (f->next.count > 0) {
        RunList done = f->now;
        f->now = f->next;
        f->next = done;
        f->next.count = 0;
        if (wr_progress_cancelled(progress)) return wr_fail(err, "cancelled");
        for (size_t i = 0; i < f->now.count; i++) {
            if (i % 1024 == 1023 && wr_progress_cancelled(progress))
                return wr_fail(err, "cancelled");
            Run run = f->now.runs[i];
            if (!take_row(f, run, run.y - 1, err) || !take_row(f, run, run.y + 1, err))
                return false;
        }
    }
    return true;
}

static bool mark_rows(void *ctx, int worker, int j, int rows, float *out)
{
    const Flood *f = ctx;
    (void)worker;
    for (int y = 0; y < rows; y++)
        for (int x = 0; x < f->width; x++)
            out[(size_t)y * (size_t)f->width + (size_t)x] = is_marked(f, x, j + y) ? 1.0f : 0.0f;
    return true;
}

/* The value of most texels, so that few tiles are needed. */
static float most(const Flood *f)
{
    int64_t reached = 0;
    for (size_t i = 0; i < (size_t)f->height * f->words; i++)
        reached += __builtin_popcountll(f->marks[i]);
    return 2 * reached > (int64_t)f->width * f->height ? 1.0f : 0.0f;
}

/* Index of the texel that contains `part` of the axis. */
static int index_of(double part, int count, bool wrap)
{
    if (wrap) part = wr_field_reduce(part, 1.0);
    double i = floor(part * count);
    return i < 0.0 ? 0 : i < count ? (int)i : count - 1;
}

/* Caches the tile pointers of the whole table, so that a texel access does not walk the tree. */
static bool fetch(Flood *f, const WrField *field, WrError *err)
{
    int tiles_v = wr_field_tiles_v(field);
    f->words = ((size_t)f->width + 63) / 64;
    f->marks = wr_try_alloc((size_t)f->height * f->words, sizeof *f->marks, "flood", err);
    f->tiles = wr_try_alloc((size_t)f->tiles_u * (size_t)tiles_v, sizeof *f->tiles, "flood", err);
    if (!f->marks || !f->tiles) return false;
    for (int ty = 0; ty < tiles_v; ty++)
        for (int tx = 0; tx < f->tiles_u; tx++)
            f->tiles[ty * f->tiles_u + tx] = wr_field_tile(field, tx, ty);
    return true;
}

WrField *wr_select_flood(const WrField *field, double u, double v, double tolerance, bool diagonal,
                         WrPool *pool, const WrProgress *progress, WrError *err)
{
    if (!isfinite(u) || !isfinite(v) || !(tolerance >= 0.0)) {
        wr_fail(err,
                "flood from %.9g,%.9g within %.9g: must be a point and a tolerance of 0 or more", u,
                v, tolerance);
        return NULL;
    }
    Flood f = { .width = wr_field_width(field),
                .height = wr_field_height(field),
                .tiles_u = wr_field_tiles_u(field),
                .wrap_u = wr_field_wrap_u(field) == WR_WRAP_PERIODIC,
                .wrap_v = wr_field_wrap_v(field) == WR_WRAP_PERIODIC,
                .diagonal = diagonal,
                .level = wr_field_level(field) };
    int x = index_of(u, f.width, f.wrap_u), y = index_of(1.0 - v, f.height, f.wrap_v);
    double start = wr_field_get(field, x, y);
    f.low = start - tolerance;
    f.high = start + tolerance;
    WrField *made = NULL;
    if (fetch(&f, field, err) && take_run(&f, x, y, err) && spread(&f, progress, err))
        made = wr_select_from_rows(field, most(&f), mark_rows, &f, pool, progress, err);
    wr_free(f.marks);
    wr_free(f.tiles);
    wr_free(f.now.runs);
    wr_free(f.next.runs);
    return made;
}

/* ---- growing and shrinking ---- */

/* Growing and shrinking by exact Euclidean distance: the distance along columns first, by a sweep down
   and a sweep up, then across rows as the lower envelope of parabolas (Felzenszwalb and Huttenlocher,
   Distance Transforms of Sampled Functions, 2012). Squared distances are integers, so there is no
   rounding before the root. On a periodic axis the nearest image lies within half a period: columns are
   swept twice round, and rows are extended by half a period at either end. */

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
 * q from x = ((dq + q^2) - (dp + p^2)) / (2 (q - p)) on; for integer columns the rounded quotient produces
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
            result = wr_select_from_rows(a, wr_field_level(a), distance_rows, &d, pool,
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

/* ---- by height and slope; combination ---- */

/* Selections by height and slope, their combination, and the builder of selections made row by row. */

#define TEXELS (WR_TILE * WR_TILE)

static int min_int(int a, int b)
{
    return a < b ? a : b;
}

static bool fail(WrError *err, const char *what, const char *name, double value, const char *right)
{
    return wr_fail(err, "selection by %s: %s %.9g: must be %s", what, name, value, right);
}

/* Processes a group of tile rows at a time. */
typedef struct Build {
    WrSelectRows make;
    void *ctx;
    int width, height, first; /* first row of the group */
    float level;
    float *rows;  /* [group][WR_TILE][width] */
    bool *failed; /* [group] */
} Build;

static void build_piece(int index, int worker, void *ctx)
{
    Build *build = ctx;
    int j = build->first + index * WR_TILE, rows = min_int(WR_TILE, build->height - j);
    size_t count = (size_t)rows * (size_t)build->width;
    float *out = build->rows + (size_t)index * WR_TILE * (size_t)build->width;
    for (size_t i = 0; i < count; i++) out[i] = build->level;
    build->failed[index] = !build->make(build->ctx, worker, j, rows, out);
}

static bool build_group(Build *build, int count, WrField *field, WrPool *pool, WrError *err)
{
    if (!wr_pool_run(pool, count, build_piece, build)) return wr_fail(err, "cancelled");
    for (int k = 0; k < count; k++) {
        if (build->failed[k]) return wr_fail(err, "selection: not enough memory");
        int j = build->first + k * WR_TILE;
        wr_field_write(field, 0, j, build->width, min_int(WR_TILE, build->height - j),
                       build->rows + (size_t)k * WR_TILE * (size_t)build->width,
                       (size_t)build->width);
    }
    return true;
}

WrField *wr_select_from_rows(const WrField *like, float level, WrSelectRows make, void *ctx,
                             WrPool *pool, const WrProgress *progress, WrError *err)
{
    Build build = { .make = make,
                    .ctx = ctx,
                    .width = wr_field_width(like),
                    .height = wr_field_height(like),
                    .level = level };
    int group = min_int(2 * wr_pool_threads(pool), wr_field_tiles_v(like));
    build.rows = wr_try_alloc((size_t)group * WR_TILE * (size_t)build.width, sizeof *build.rows,
                              "selection", err);
    if (!build.rows) return NULL;
    build.failed = wr_alloc((size_t)group, sizeof *build.failed);
    WrField *field = wr_field_new(build.width, build.height, wr_field_wrap_u(like),
                                  wr_field_wrap_v(like), level, err);
    bool good = true;
    for (int ty = 0; good && ty < wr_field_tiles_v(like); ty += group) {
        build.first = ty * WR_TILE;
        if (!wr_progress_step(progress, (double)ty / wr_field_tiles_v(like)))
            good = wr_fail(err, "cancelled");
        else
            good =
                build_group(&build, min_int(group, wr_field_tiles_v(like) - ty), field, pool, err);
    }
    wr_free(build.rows);
    wr_free(build.failed);
    if (good) return field;
    wr_field_free(field);
    return NULL;
}

/* 1 in low..high, falling linearly to 0 at `soft` outside. */
typedef struct Band {
    const WrField *field;
    double low, high, soft;
    double relief;  /* slope only */
    float *scratch; /* slope only: [threads][WR_TILE + 2][pitch] */
    size_t pitch;
} Band;

static float in_band(const Band *band, double x)
{
    double outside = x < band->low ? band->low - x : x > band->high ? x - band->high : 0.0;
    if (outside <= 0.0) return 1.0f;
    return outside < band->soft ? (float)(1.0 - outside / band->soft) : 0.0f;
}

static bool height_rows(void *ctx, int worker, int j, int rows, float *out)
{
    (void)worker;
    const Band *band = ctx;
    int width = wr_field_width(band->field);
    wr_field_read(band->field, 0, j, width, rows, out, (size_t)width);
    for (size_t i = 0; i < (size_t)rows * (size_t)width; i++) out[i] = in_band(band, out[i]);
    return true;
}

/* Checks common to both kinds of band. */
static bool check_band(const Band *band, const char *what, WrError *err)
{
    if (!isfinite(band->low)) return fail(err, what, "low", band->low, "finite");
    if (!isfinite(band->high)) return fail(err, what, "high", band->high, "finite");
    if (band->low > band->high)
        return wr_fail(err, "selection by %s: low %.9g: must not be above high, %.9g", what,
                       band->low, band->high);
    if (!(band->soft >= 0.0) || !isfinite(band->soft))
        return fail(err, what, "soft", band->soft, "0 or more and finite");
    return true;
}

WrField *wr_select_height(const WrField *field, double low, double high, double soft, WrPool *pool,
                          WrError *err)
{
    Band band = { .field = field, .low = low, .high = high, .soft = soft };
    if (!check_band(&band, "height", err)) return NULL;
    float level = in_band(&band, wr_field_level(field));
    return wr_select_from_rows(field, level, height_rows, &band, pool, wr_progress_here(), err);
}

/* Numbers that rise with an angle, between which the band is surely 1, or beyond which it is surely 0: arc tangents are computed
   only near the ends and where it fades. */
typedef struct Sure {
    double one_from, one_to;   /* 1 above one_from and below one_to */
    double zero_to, zero_from; /* 0 below zero_to and above zero_from */
} Sure;

#define SURE 1e-3 /* degrees; more than the roundings of angles, in float too */

/* The tangent of an angle in 0..90 degrees. */
static double tangent(double degrees)
{
    double sine, cosine;
    if (degrees >= 90.0) return INFINITY;
    if (degrees < 0.0) return -1.0;
    wr_sincos_turns(degrees / 360.0, &sine, &cosine);
    return sine / cosine;
}

/* Minus the cosine of an angle in 0..180 degrees. */
static double minus_cosine(double degrees)
{
    double sine, cosine;
    if (degrees >= 180.0) return INFINITY;
    if (degrees < 0.0) return -INFINITY;
    wr_sincos_turns(degrees / 360.0, &sine, &cosine);
    return -cosine;
}

/* rising: a function of the angle. The ends of its range have no other side. */
static Sure sure_of(const Band *band, double most, double (*rising)(double degrees))
{
    return (Sure){ band->low <= 0.0 ? -INFINITY : rising(band->low + SURE),
                   band->high >= most ? INFINITY : rising(band->high - SURE),
                   rising(band->low - band->soft - SURE), rising(band->high + band->soft + SURE) };
}

static inline bool is_sure(const Sure *sure, double x, float *value)
{
    if (x > sure->one_from && x < sure->one_to) *value = 1.0f;
    else if (x < sure->zero_to || x > sure->zero_from) *value = 0.0f;
    else return false;
    return true;
}

static bool slope_rows(void *ctx, int worker, int j, int rows, float *out)
{
    const Band *band = ctx;
    int width = wr_field_width(band->field);
    size_t pitch = band->pitch;
    float *in = band->scratch + (size_t)worker * (WR_TILE + 2) * pitch;
    const Sure sure = sure_of(band, 90.0, tangent);
    wr_field_read(band->field, -1, j - 1, width + 2, rows + 2, in, pitch);
    for (int y = 0; y < rows; y++) {
        const float *at = in + (size_t)(y + 1) * pitch + 1;
        for (int i = 0; i < width; i++) {
            double su = 0.5 * ((double)at[i + 1] - at[i - 1]);
            double sv = 0.5 * ((double)at[(size_t)i + pitch] - at[i - (int64_t)pitch]);
            double slope = band->relief * sqrt(su * su + sv * sv);
            float *to = &out[(size_t)y * (size_t)width + (size_t)i];
            if (is_sure(&sure, slope, to)) continue;
            double angle = slope > 0.0 ? wr_atan2(slope, 1.0) / WR_RAD_PER_DEG : 0.0;
            *to = in_band(band, angle);
        }
    }
    return true;
}

static bool check_slope(const Band *band, WrError *err)
{
    if (!check_band(band, "slope", err)) return false;
    if (band->low < 0.0) return fail(err, "slope", "low", band->low, "0..90 degrees");
    if (band->high > 90.0) return fail(err, "slope", "high", band->high, "0..90 degrees");
    if (!(band->relief > 0.0) || !isfinite(band->relief))
        return fail(err, "slope", "relief", band->relief, "above 0 and finite");
    return true;
}

WrField *wr_select_slope(const WrField *field, double relief, double low, double high, double soft,
                         WrPool *pool, WrError *err)
{
    Band band = { .field = field, .low = low, .high = high, .soft = soft, .relief = relief };
    if (!check_slope(&band, err)) return NULL;
    band.pitch = (size_t)wr_field_width(field) + 2;
    size_t threads = (size_t)wr_pool_threads(pool);
    band.scratch = wr_try_alloc(threads * (WR_TILE + 2) * band.pitch, sizeof *band.scratch,
                                "selection by slope", err);
    if (!band.scratch) return NULL;
    WrField *result = wr_select_from_rows(field, in_band(&band, 0.0), slope_rows, &band, pool,
                                          wr_progress_here(), err);
    wr_free(band.scratch);
    return result;
}

/* ---- by direction ---- */

#define SHORT 1e-100 /* squares of shorter slopes lose digits */

typedef struct Facing {
    Band band;
    WrDerivatives ground;
    double sine, cosine; /* of the azimuth */
} Facing;

static bool facing_rows(void *ctx, int worker, int j, int rows, float *out)
{
    (void)worker;
    const Facing *f = ctx;
    const int width = wr_field_width(f->band.field);
    const Sure sure = sure_of(&f->band, 180.0, minus_cosine);
    WrDerivativesRow row = wr_derivatives_row_new(width, false);
    WrDerivativesBand *band = wr_derivatives_open(&f->ground, 0, j, width, rows);
    for (int y = 0; y < rows; y++) {
        wr_derivatives_row(band, y, &row);
        for (int i = 0; i < width; i++) {
            /* downhill is (-p, -q): the angle from the azimuth has the tangent |cross| / dot */
            const double p = row.p[i], q = row.q[i], length = sqrt(p * p + q * q);
            const double dot = -(p * f->cosine + q * f->sine);
            const double cross = fabs(p * f->sine - q * f->cosine);
            float *to = &out[(size_t)y * (size_t)width + (size_t)i];
            if (length > SHORT && is_sure(&sure, -dot / length, to)) continue;
            *to = in_band(&f->band, p == 0.0 && q == 0.0
                                        ? 180.0f
                                        : (float)(wr_atan2(cross, dot) / WR_RAD_PER_DEG));
        }
    }
    wr_derivatives_close(band);
    wr_derivatives_row_free(&row);
    return true;
}

WrField *wr_select_facing(const WrField *field, double azimuth, double low, double high,
                          double soft, WrPool *pool, WrError *err)
{
    Facing f = { .band = { .field = field, .low = low, .high = high, .soft = soft },
                 .ground = { .field = field,
                             .scheme = WR_SCHEME_CENTRAL,
                             .height = 1.0,
                             .cell_w = wr_field_width(field),
                             .cell_h = wr_field_height(field) } };
    if (!check_band(&f.band, "direction", err)) return NULL;
    wr_sincos_turns(azimuth / 360.0, &f.sine, &f.cosine);
    return wr_select_from_rows(field, in_band(&f.band, 180.0f), facing_rows, &f, pool,
                               wr_progress_here(), err);
}

WR_ROWS(wr_select_modes);
const char *const wr_select_modes[WR_SELECT_MODES + 1] = {
    [WR_ROW(WR_SELECT_REPLACE)] = "replace",
    [WR_ROW(WR_SELECT_ADD)] = "add",
    [WR_ROW(WR_SELECT_SUBTRACT)] = "subtract",
    [WR_ROW(WR_SELECT_INTERSECT)] = "intersect",
};
WR_ROWS_END(wr_select_modes, WR_SELECT_MODES);

static float join(WrSelectMode mode, float a, float b)
{
    float other = mode == WR_SELECT_SUBTRACT ? 1.0f - b : b;
    if (mode == WR_SELECT_REPLACE) return b;
    return mode == WR_SELECT_ADD ? (a > b ? a : b) : (a < other ? a : other);
}

/* True if b at `level` leaves every a unchanged. */
static bool keeps(WrSelectMode mode, float level)
{
    return mode == WR_SELECT_INTERSECT ? level >= 1.0f : mode != WR_SELECT_REPLACE && level <= 0.0f;
}

static double row_part(const WrField *field, int ty)
{
    return (double)ty / wr_field_tiles_v(field);
}

static void join_tile(WrField *out, const WrField *a, const WrField *b, WrSelectMode mode, int tx,
                      int ty)
{
    const float *ta = wr_field_tile(a, tx, ty), *tb = wr_field_tile(b, tx, ty);
    float *to = wr_field_tile_write(out, tx, ty);
    float la = wr_field_level(a), lb = wr_field_level(b);
    for (int i = 0; i < TEXELS; i++) to[i] = join(mode, ta ? ta[i] : la, tb ? tb[i] : lb);
}

WrField *wr_select_combine(const WrField *a, const WrField *b, WrSelectMode mode, WrError *err)
{
    if (mode == WR_SELECT_REPLACE) return wr_field_share(b);
    if (!a) return mode == WR_SELECT_SUBTRACT ? wr_select_invert(b) : wr_field_share(b);
    if (!wr_field_alike(a, b)) {
        wr_fail(err, "selection of %dx%d texels: must have the size and edges of the other, %dx%d",
                wr_field_width(b), wr_field_height(b), wr_field_width(a), wr_field_height(a));
        return NULL;
    }
    bool sparse = keeps(mode, wr_field_level(b));
    WrField *out = sparse ? wr_field_share(a)
                          : wr_field_new(wr_field_width(a), wr_field_height(a), wr_field_wrap_u(a),
                                         wr_field_wrap_v(a),
                                         join(mode, wr_field_level(a), wr_field_level(b)), err);
    for (int ty = 0; ty < wr_field_tiles_v(a) && wr_progress_report(row_part(a, ty)); ty++)
        for (int tx = 0; tx < wr_field_tiles_u(a); tx++)
            if (wr_field_tile(b, tx, ty) || (!sparse && wr_field_tile(a, tx, ty)))
                join_tile(out, a, b, mode, tx, ty);
    return out;
}

WrField *wr_select_invert(const WrField *a)
{
    WrField *out = wr_field_new(wr_field_width(a), wr_field_height(a), wr_field_wrap_u(a),
                                wr_field_wrap_v(a), 1.0f - wr_field_level(a), NULL);
    for (int ty = 0; ty < wr_field_tiles_v(a) && wr_progress_report(row_part(a, ty)); ty++)
        for (int tx = 0; tx < wr_field_tiles_u(a); tx++) {
            const float *from = wr_field_tile(a, tx, ty);
            if (!from) continue;
            float *to = wr_field_tile_write(out, tx, ty);
            for (int i = 0; i < TEXELS; i++) to[i] = 1.0f - from[i];
        }
    return out;
}

/* Blurs and clamps: rounding may move the blurred sum slightly outside 0..1. */
WrField *wr_select_feather(const WrField *a, double sigma, WrPool *pool, WrError *err)
{
    const WrOpInfo *blur = wr_op_find("blur"), *clamp = wr_op_find("clamp");
    WrOpOptions options = { .pool = pool, .progress = wr_progress_here() };
    if (sigma == 0.0) return wr_field_share(a);
    WrField *blurred = wr_op_run(blur, a, &sigma, &options, err);
    if (!blurred) return NULL;
    const double range[2] = { 0.0, 1.0 };
    WrField *result = wr_op_run(clamp, blurred, range, &options, err);
    wr_field_free(blurred);
    return result;
}
