#include "brush/footprint_scan.h"

#include "base/memory.h"
#include "base/pool.h"
#include "field/field.h"

#include <math.h>

#define SMALL 12.0    /* texels: for a smaller reach all rows use one span, which costs less */
#define MANY_TILES 12 /* in a row of tiles; number worth several threads */

static double clamp(double value, double low, double high)
{
    return value > low ? (value < high ? value : high) : low;
}

WrWindow wr_window(double p, double d, double r, int n, WrWrap wrap)
{
    double low = d < 0.0 ? p + d : p, high = d < 0.0 ? p : p + d;
    if (wrap == WR_WRAP_CLAMP)
        return (WrWindow){ (int)clamp(ceil(low - r), 0.0, n),
                           (int)clamp(floor(high + r), -1.0, n - 1.0) };
    /* texels farther than half a period have a nearer image; a shape of length 0 meets none twice */
    r = r < 0.5 * n ? r : 0.5 * n;
    WrWindow w = { (int)ceil(low - r), (int)floor(high + r) };
    if (d == 0.0 && w.high - w.low >= n) w.high = w.low + n - 1;
    return w;
}

int wr_tile_run(int i, int last, int n, int *texel)
{
    *texel = i % n < 0 ? i % n + n : i % n;
    int count = WR_TILE - *texel % WR_TILE;
    if (count > n - *texel) count = n - *texel;
    return count < last - i + 1 ? count : last - i + 1;
}

/* Rows j .. j + count - 1, all in one row of tiles. */
typedef struct Band {
    int j, texel, count;
    WrWindow span[WR_TILE]; /* column range of each row */
    WrWindow all;           /* union of the column ranges */
    bool whole;             /* the shape spans the table's period */
    int width;              /* of the table */
} Band;

/* floor of |x| < 2^31, without a call */
static int floor_int(double x)
{
    int whole = (int)x;
    return whole - (x < whole);
}

static void find_spans(Band *band, const WrDabShape *shape, WrWindow columns)
{
    if (shape->reach_x < SMALL && shape->kind != WR_SHAPE_MOTION) {
        band->all = columns;
        for (int row = 0; row < band->count; row++) band->span[row] = columns;
        return;
    }
    band->all = (WrWindow){ columns.high + 1, columns.low - 1 };
    for (int row = 0; row < band->count; row++) {
        WrWindow *span = &band->span[row];
        *span = (WrWindow){ 0, -1 };
        double low, high;
        if (!wr_shape_span(shape, band->j + row, &low, &high)) continue;
        low = clamp(low, columns.low, columns.high + 1.0);
        high = clamp(high, columns.low - 1.0, columns.high);
        *span = (WrWindow){ -floor_int(-low), floor_int(high) };
        if (span->low < band->all.low) band->all.low = span->low;
        if (span->high > band->all.high) band->all.high = span->high;
    }
}

/* The additional texels of a widened run are outside the shape and get no coverage; but if the brush is
 * as large as the table they would be another image's texels, and at the table's edge unused ones. */
static WrRun run_of(const Band *band, int row, int first, int last, int texel)
{
    int at = texel % WR_TILE, head = at % WR_BRUSH_BLOCK, end = head + last - first + 1;
    WrRun run = { .y = band->j + row, .x = first - head };
    run.count = (end + WR_BRUSH_BLOCK - 1) / WR_BRUSH_BLOCK * WR_BRUSH_BLOCK;
    run.at = (band->texel + row) % WR_TILE * WR_TILE + at - head;
    int beyond = texel - head + run.count - band->width; /* texels beyond the table's edge */
    run.head = band->whole ? head : 0;
    run.tail = band->whole ? run.count - end : beyond > 0 ? beyond : 0;
    return run;
}

/* The part of a band in one tile: columns i .. i + count - 1, texel column `texel`. */
static void patch_of(const Band *band, int i, int count, int texel, WrScanPatch *patch)
{
    patch->tx = texel / WR_TILE;
    patch->ty = band->texel / WR_TILE;
    patch->count = 0;
    for (int row = 0; row < band->count; row++) {
        WrWindow span = band->span[row];
        int first = span.low > i ? span.low : i;
        int last = span.high < i + count - 1 ? span.high : i + count - 1;
        if (first <= last)
            patch->runs[patch->count++] = run_of(band, row, first, last, texel + first - i);
    }
}

/* Tiles of one band, for several threads. */
typedef struct Crew {
    const Band *band;
    const WrDabShape *shape;
    WrVisit visit;
    void *ctx;
    struct Piece {
        int i, count, texel;
    } pieces[2 * WR_FIELD_MAX / WR_TILE];
    int count;
} Crew;

static void work(int index, int worker, void *ctx)
{
    (void)worker;
    const Crew *crew = ctx;
    const struct Piece *piece = &crew->pieces[index];
    WrScanPatch patch;
    patch_of(crew->band, piece->i, piece->count, piece->texel, &patch);
    if (patch.count) crew->visit(crew->ctx, crew->shape, &patch);
}

/* A motion longer than a period meets a tile twice: then tiles are processed sequentially. */
static bool many(const Band *band, const WrPool *pool, const WrDabShape *shape)
{
    int reach = band->all.high - band->all.low + 1;
    return pool && wr_pool_threads(pool) > 1 && reach >= MANY_TILES * WR_TILE &&
           band->count >= WR_TILE / 2 && shape->kind != WR_SHAPE_TEXEL && reach <= band->width;
}

static void scan_band(const Band *band, const WrDabShape *shape, WrPool *pool, WrPrepare prepare,
                      WrVisit visit, void *ctx)
{
    Crew crew;
    crew.count = 0;
    bool together = many(band, pool, shape);
    for (int i = band->all.low; i <= band->all.high;) {
        int texel, count = wr_tile_run(i, band->all.high, band->width, &texel);
        if (!prepare || prepare(ctx, texel / WR_TILE, band->texel / WR_TILE)) {
            if (together) {
                crew.pieces[crew.count++] = (struct Piece){ i, count, texel };
            } else {
                WrScanPatch patch;
                patch_of(band, i, count, texel, &patch);
                if (patch.count) visit(ctx, shape, &patch);
            }
        }
        i += count;
    }
    if (!crew.count) return;
    crew.band = band;
    crew.shape = shape;
    crew.visit = visit;
    crew.ctx = ctx;
    const struct Piece *first = &crew.pieces[0], *last = &crew.pieces[crew.count - 1];
    bool meet = crew.count > 1 && first->texel / WR_TILE == last->texel / WR_TILE;
    wr_pool_run(pool, crew.count - meet, work, &crew);
    if (meet) work(crew.count - 1, 0, &crew); /* the two ends of a period share a tile */
}

void wr_scan(const WrField *field, const WrDabShape *shape, WrPool *pool, WrPrepare prepare,
             WrVisit visit, void *ctx)
{
    int width = wr_field_width(field), height = wr_field_height(field);
    WrWindow columns =
        wr_window(shape->x, shape->dx, shape->reach_x, width, wr_field_wrap_u(field));
    WrWindow rows = wr_window(shape->y, shape->dy, shape->reach_y, height, wr_field_wrap_v(field));
    if (columns.low > columns.high) return;
    Band band = { .width = width };
    band.whole = wr_field_wrap_u(field) == WR_WRAP_PERIODIC && shape->reach_x >= 0.5 * width;
    for (int j = rows.low; j <= rows.high; j += band.count) {
        band.j = j;
        band.count = wr_tile_run(j, rows.high, height, &band.texel);
        find_spans(&band, shape, columns);
        scan_band(&band, shape, pool, prepare, visit, ctx);
    }
}

void wr_run_cover(const WrDabShape *shape, const WrRun *run, float *fresh)
{
    wr_shape_row(shape, run->y, run->x, run->count, fresh);
    for (int i = 0; i < run->head; i++) fresh[i] = 0.0f;
    for (int i = run->count - run->tail; i < run->count; i++) fresh[i] = 0.0f;
}
