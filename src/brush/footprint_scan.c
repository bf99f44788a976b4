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
    const WrDabShape *shape;
    const Band *band;
    int i, count, texel;
    int next;    /* index of the next piece of the tile; -1: none */
    float bound; /* WrBound; negative: visited */
} Piece;

/* One shape's rectangle of texels. */
typedef struct Scan {
    const WrField *field;
    const WrDabShape *shape;
    WrWindow columns, rows;
} Scan;

static Scan begin_scan(const WrField *field, const WrDabShape *shape)
{
    const int width = wr_field_width(field), height = wr_field_height(field);
    return (Scan){
        .field = field,
        .shape = shape,
        .columns = wr_window(shape->x, shape->dx, shape->reach_x, width, wr_field_wrap_u(field)),
        .rows = wr_window(shape->y, shape->dy, shape->reach_y, height, wr_field_wrap_v(field))
    };
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

/* The next piece of a band from column *i on; false at its end. */
static bool next_piece(const Scan *scan, const Band *band, int *i, Piece *piece)
{
    if (*i > band->all.high) return false;
    *piece = (Piece){ .shape = scan->shape, .band = band, .i = *i, .next = -1 };
    piece->count = wr_tile_run(*i, band->all.high, band->width, &piece->texel);
    *i += piece->count;
    return true;
}

static void visit_piece(const Piece *piece, WrVisit visit, void *ctx)
{
    WrScanPatch patch;
    patch_of(piece->band, piece->i, piece->count, piece->texel, &patch);
    if (patch.count) visit(ctx, piece->shape, &patch);
}

/* True for shapes of many tiles, worth several threads. */
static bool many(const Scan *scan, const WrPool *pool)
{
    const int wide = scan->columns.high - scan->columns.low + 1;
    const int tall = scan->rows.high - scan->rows.low + 1;
    return pool && wr_pool_threads(pool) > 1 && wide >= MANY_TILES * WR_TILE &&
           tall >= WR_TILE / 2 && scan->shape->kind != WR_SHAPE_TEXEL;
}

/* ---- several shapes, tile by tile ---- */

/* first[] lists the pieces of each tile: an index into `pieces`, NOT_YET or REFUSED. */
#define NOT_YET (-1)
#define REFUSED (-2)

typedef struct Together {
    const WrField *field;
    WrPrepare prepare;
    WrVisit visit;
    WrBound bound;
    void *ctx;
    int *first;
    WR_ARRAY(Piece) pieces;
    WR_ARRAY(int) tiles; /* that have pieces */
} Together;

static void add_piece(Together *all, Piece piece)
{
    const int tx = piece.texel / WR_TILE, ty = piece.band->texel / WR_TILE;
    const int tile = ty * wr_field_tiles_u(all->field) + tx;
    int *first = &all->first[tile];
    if (*first == NOT_YET) {
        if (all->prepare && !all->prepare(all->ctx, tx, ty)) *first = REFUSED;
        else wr_array_push(&all->tiles, tile);
    }
    if (*first == REFUSED) return;
    piece.next = *first;
    *first = all->pieces.count;
    piece.bound = !all->bound ? 1
                              : all->bound(piece.shape, piece.i - piece.texel % WR_TILE,
                                           piece.band->j - piece.band->texel % WR_TILE);
    wr_array_push(&all->pieces, piece);
}

static Band *add_shape(Together *all, const WrDabShape *shape, Band *bands)
{
    const Scan scan = begin_scan(all->field, shape);
    if (scan.columns.low > scan.columns.high) return bands;
    for (int j = scan.rows.low; j <= scan.rows.high; j += (bands++)->count) {
        Piece piece;
        *bands = begin_band(&scan, j);
        for (int i = bands->all.low; next_piece(&scan, bands, &i, &piece);) add_piece(all, piece);
    }
    return bands;
}

/* Pieces of one tile, which the two ends of a period may share, are visited one after the other. */
static void visit_tile(int index, int worker, void *ctx)
{
    (void)worker;
    const Together *all = ctx;
    Piece *pieces = all->pieces.data;
    const int first = all->first[all->tiles.data[index]];
    for (;;) {
        int largest = first;
        for (int k = first; k >= 0; k = pieces[k].next)
            if (pieces[k].bound >= pieces[largest].bound) largest = k; /* the list is backwards */
        if (!(pieces[largest].bound > 0)) return;
        visit_piece(&pieces[largest], all->visit, all->ctx);
        pieces[largest].bound = -1;
    }
}

static int most_bands(const WrField *field, const WrDabShape *shape)
{
    const Scan scan = begin_scan(field, shape);
    return (scan.rows.high - scan.rows.low) / WR_TILE + 3;
}

void wr_scan_together(const WrField *field, const WrDabShape *shapes, int count, WrPool *pool,
                      WrPrepare prepare, WrVisit visit, WrBound bound, void *ctx)
{
    Together all = {
        .field = field, .prepare = prepare, .visit = visit, .bound = bound, .ctx = ctx
    };
    const size_t tiles = (size_t)wr_field_tiles_u(field) * (size_t)wr_field_tiles_v(field);
    int most = 0;
    for (int i = 0; i < count; i++) most += most_bands(field, &shapes[i]);
    Band *bands = wr_alloc((size_t)most, sizeof *bands), *band = bands;
    all.first = wr_alloc(tiles, sizeof *all.first);
    for (size_t i = 0; i < tiles; i++) all.first[i] = NOT_YET;
    for (int i = 0; i < count; i++) band = add_shape(&all, &shapes[i], band);
    wr_pool_run(pool, all.tiles.count, visit_tile, &all);
    wr_array_free(&all.pieces);
    wr_array_free(&all.tiles);
    wr_free(all.first);
    wr_free(bands);
}

void wr_scan(const WrField *field, const WrDabShape *shape, WrPool *pool, WrPrepare prepare,
             WrVisit visit, void *ctx)
{
    const Scan scan = begin_scan(field, shape);
    if (scan.columns.low > scan.columns.high) return;
    if (many(&scan, pool)) {
        wr_scan_together(field, shape, 1, pool, prepare, visit, NULL, ctx);
        return;
    }
    int count;
    for (int j = scan.rows.low; j <= scan.rows.high; j += count) {
        const Band band = begin_band(&scan, j);
        Piece piece;
        count = band.count;
        for (int i = band.all.low; next_piece(&scan, &band, &i, &piece);)
            if (!prepare || prepare(ctx, piece.texel / WR_TILE, band.texel / WR_TILE))
                visit_piece(&piece, visit, ctx);
    }
}

void wr_run_cover(const WrDabShape *shape, const WrRun *run, float *fresh)
{
    wr_shape_row(shape, run->y, run->x, run->count, fresh);
    for (int i = 0; i < run->head; i++) fresh[i] = 0.0f;
    for (int i = run->count - run->tail; i < run->count; i++) fresh[i] = 0.0f;
}
