/* Flood fill: the connected region of heights near that of one texel. */
#include "field/select.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "field/field.h"
#include "field/select_internal.h"

#include <math.h>
#include <string.h>

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

static void mark(Flood *f, int x, int y)
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
    mark(f, x, y);
    for (int i = left_of(f, x); i >= 0 && is_open(f, i, y); i = left_of(f, i)) {
        mark(f, i, y);
        run.x = i;
        run.count++;
    }
    for (int i = right_of(f, x); i >= 0 && is_open(f, i, y); i = right_of(f, i)) {
        mark(f, i, y);
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
        wr_fail(err, "flood from %.9g,%.9g within %.9g: must be a place and a height of 0 or more",
                u, v, tolerance);
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
        made = wr_select_build(field, most(&f), mark_rows, &f, pool, progress, err);
    wr_free(f.marks);
    wr_free(f.tiles);
    wr_free(f.now.runs);
    wr_free(f.next.runs);
    return made;
}
