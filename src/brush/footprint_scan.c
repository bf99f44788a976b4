#include "brush/footprint_scan.h"

#include "base/array.h"
#include "base/memory.h"
#include "base/pool.h"
#include "field/field.h"

#include <math.h>

#define SMALL 12.0    /* texels: for a smaller reach all rows use one span, which costs less */
#define MANY_TILES 12 /* across; number worth several threads */

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

/* The part of a band in one tile. */
typedef struct Piece {
    const Band *band;
    int i, count, texel;
} Piece;

/* Shared by all pieces of a scan; the scan owns the lists. */
typedef struct Scan {
    const WrField *field;
    const WrDabShape *shape;
    WrWindow columns, rows;
    WrPrepare prepare;
    WrVisit visit;
    void *ctx;
    WR_ARRAY(Piece) pieces, later; /* for several threads; for this one afterwards */
} Scan;

static void visit_piece(const Scan *scan, const Piece *piece)
{
    WrScanPatch patch;
    patch_of(piece->band, piece->i, piece->count, piece->texel, &patch);
    if (patch.count) scan->visit(scan->ctx, scan->shape, &patch);
}

static void work(int index, int worker, void *ctx)
{
    (void)worker;
    const Scan *scan = ctx;
    visit_piece(scan, &scan->pieces.data[index]);
}

/* The band from row j on. */
static Band begin_band(const Scan *scan, int j)
{
    const WrField *field = scan->field;
    Band band = { .j = j, .width = wr_field_width(field) };
    band.whole =
        wr_field_wrap_u(field) == WR_WRAP_PERIODIC && scan->shape->reach_x >= 0.5 * band.width;
    band.count = wr_tile_run(j, scan->rows.high, wr_field_height(field), &band.texel);
    find_spans(&band, scan->shape, scan->columns);
    return band;
}

/* The next prepared piece of a band from column *i on; false at its end. */
static bool next_piece(const Scan *scan, const Band *band, int *i, Piece *piece)
{
    while (*i <= band->all.high) {
        *piece = (Piece){ .band = band, .i = *i };
        piece->count = wr_tile_run(*i, band->all.high, band->width, &piece->texel);
        *i += piece->count;
        if (!scan->prepare ||
            scan->prepare(scan->ctx, piece->texel / WR_TILE, band->texel / WR_TILE))
            return true;
    }
    return false;
}

/* True for shapes of many tiles. A motion longer than a period meets a tile twice: then tiles are processed sequentially. */
static bool many(const Scan *scan, const WrPool *pool)
{
    const int wide = scan->columns.high - scan->columns.low + 1;
    const int tall = scan->rows.high - scan->rows.low + 1;
    return pool && wr_pool_threads(pool) > 1 && wide >= MANY_TILES * WR_TILE &&
           tall >= WR_TILE / 2 && scan->shape->kind != WR_SHAPE_TEXEL &&
           wide <= wr_field_width(scan->field) && tall <= wr_field_height(scan->field);
}

/* All tiles of the shape at once: threads are woken once for a motion. Tiles that the two ends of a period share are scanned twice: the second time
   after the threads. */
static void scan_together(Scan *scan, WrPool *pool)
{
    const int most = (scan->rows.high - scan->rows.low) / WR_TILE + 3;
    Band *bands = wr_alloc((size_t)most, sizeof *bands), *band = bands;
    for (int j = scan->rows.low; j <= scan->rows.high; j += (band++)->count) {
        Piece piece;
        *band = begin_band(scan, j);
        const bool again = band > bands && band->texel / WR_TILE == bands->texel / WR_TILE;
        int i = band->all.low, texel;
        if (i > band->all.high) continue;
        wr_tile_run(i, i, band->width, &texel);
        for (const int first = i; next_piece(scan, band, &i, &piece);) {
            const bool meet = piece.i > first && piece.texel / WR_TILE == texel / WR_TILE;
            if (again || meet) wr_array_push(&scan->later, piece);
            else wr_array_push(&scan->pieces, piece);
        }
    }
    wr_pool_run(pool, scan->pieces.count, work, scan);
    for (int i = 0; i < scan->later.count; i++) visit_piece(scan, &scan->later.data[i]);
    wr_array_free(&scan->pieces);
    wr_array_free(&scan->later);
    wr_free(bands);
}

void wr_scan(const WrField *field, const WrDabShape *shape, WrPool *pool, WrPrepare prepare,
             WrVisit visit, void *ctx)
{
    int width = wr_field_width(field), height = wr_field_height(field);
    Scan scan = { .field = field, .shape = shape, .prepare = prepare, .visit = visit, .ctx = ctx };
    scan.columns = wr_window(shape->x, shape->dx, shape->reach_x, width, wr_field_wrap_u(field));
    scan.rows = wr_window(shape->y, shape->dy, shape->reach_y, height, wr_field_wrap_v(field));
    if (scan.columns.low > scan.columns.high) return;
    if (many(&scan, pool)) {
        scan_together(&scan, pool);
        return;
    }
    int count;
    for (int j = scan.rows.low; j <= scan.rows.high; j += count) {
        const Band band = begin_band(&scan, j);
        Piece piece;
        count = band.count;
        for (int i = band.all.low; next_piece(&scan, &band, &i, &piece);)
            visit_piece(&scan, &piece);
    }
}

void wr_run_cover(const WrDabShape *shape, const WrRun *run, float *fresh)
{
    wr_shape_row(shape, run->y, run->x, run->count, fresh);
    for (int i = 0; i < run->head; i++) fresh[i] = 0.0f;
    for (int i = run->count - run->tail; i < run->count; i++) fresh[i] = 0.0f;
}
