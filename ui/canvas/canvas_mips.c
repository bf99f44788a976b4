#include "ui/canvas/canvas_mips.h"

#include "base/array.h"
#include "base/memory.h"
#include "base/pool.h"
#include "field/field.h"
#include "system/clock.h"

#include <math.h>
#include <string.h>

/* size limit of the means in bytes; beyond it the cache is cleared */
#define CACHE_LIMIT (96u << 20)
#define BASE 2 /* level that is kept for all tiles, whatever is shown */
#define BASE_SIDE (WR_TILE >> BASE)
#define MANY_TILES 256 /* number worth several threads */

typedef struct Block {
    float *mean; /* owned; NULL until first used (and always at levels 0 and BASE) */
    bool rough;
} Block;

struct WrCanvasMips {
    WrField *field; /* shared */
    int level, tiles_u, tiles_v;
    Block *blocks; /* [tiles_v * tiles_u] */
    size_t bytes;  /* size of the means */
    bool rough;    /* some returned block was rough */
    /* of tiles that have been read, each once after a change; NULL until the range is requested */
    float *base;                 /* [tiles_v * tiles_u][BASE_SIDE * BASE_SIDE] means */
    float *tile_low, *tile_high; /* [tiles_v * tiles_u] */
    bool *tile_known;
    float *row_low, *row_high; /* ranges of the rows of tiles, [tiles_v] */
    bool *row_known;           /* the range of each of its tiles is known */
    WrTileVisitor changed;     /* callback of the running update */
    void *ctx;
};

WrCanvasMips *wr_canvas_mips_new(void)
{
    return wr_alloc(1, sizeof(WrCanvasMips));
}

static void drop_blocks(WrCanvasMips *cells)
{
    for (int i = 0; cells->blocks && i < cells->tiles_u * cells->tiles_v; i++) {
        wr_free(cells->blocks[i].mean);
        cells->blocks[i] = (Block){ 0 };
    }
    cells->bytes = 0;
}

static void drop_all(WrCanvasMips *cells)
{
    drop_blocks(cells);
    wr_free(cells->blocks);
    wr_free(cells->base);
    wr_free(cells->tile_low);
    wr_free(cells->tile_high);
    wr_free(cells->tile_known);
    wr_free(cells->row_low);
    wr_free(cells->row_high);
    wr_free(cells->row_known);
    wr_field_free(cells->field);
    *cells = (WrCanvasMips){ 0 };
}

void wr_canvas_mips_free(WrCanvasMips *cells)
{
    if (!cells) return;
    drop_all(cells);
    wr_free(cells);
}

static void tile_changed(int tx, int ty, void *ctx)
{
    WrCanvasMips *cells = ctx;
    int at = ty * cells->tiles_u + tx;
    wr_free(cells->blocks[at].mean);
    cells->blocks[at] = (Block){ 0 };
    if (cells->tile_known) cells->tile_known[at] = cells->row_known[ty] = false;
    cells->changed(tx, ty, cells->ctx);
}

static bool same_frame(const WrField *a, const WrField *b)
{
    return wr_field_width(a) == wr_field_width(b) && wr_field_height(a) == wr_field_height(b) &&
           wr_field_level(a) == wr_field_level(b) && wr_field_wrap_u(a) == wr_field_wrap_u(b) &&
           wr_field_wrap_v(a) == wr_field_wrap_v(b);
}

bool wr_canvas_mips_update(WrCanvasMips *cells, const WrField *field, int level,
                           WrTileVisitor changed, void *ctx)
{
    bool same = cells->field && same_frame(cells->field, field);
    WrField *share = wr_field_share(field);
    if (!same) {
        drop_all(cells);
        cells->tiles_u = wr_field_tiles_u(field);
        cells->tiles_v = wr_field_tiles_v(field);
        cells->blocks = wr_alloc((size_t)cells->tiles_u * (size_t)cells->tiles_v, sizeof(Block));
        cells->field = share;
        cells->level = level;
        return false;
    }
    bool another = level != cells->level || cells->bytes > CACHE_LIMIT;
    if (another) drop_blocks(cells);
    cells->level = level;
    cells->changed = changed;
    cells->ctx = ctx;
    if (wr_field_key(field) != wr_field_key(cells->field))
        wr_field_changes(cells->field, share, tile_changed, cells);
    wr_field_free(cells->field);
    cells->field = share;
    return !another;
}

/* Means over squares of 2^level texels; squares at the table's edge contain only the w x h texels inside. Rows are summed first,
   in vectors: the unused texels beyond the edge are finite. */
static void make_means(int level, int w, int h, const float *tile, float *mean)
{
    const int step = 1 << level, side = WR_TILE >> level;
    for (int j = 0; j < side && j * step < h; j++) {
        const int y0 = j * step, y1 = y0 + step < h ? y0 + step : h;
        float sums[WR_TILE];
        memcpy(sums, tile + WR_TILE * y0, sizeof sums);
        for (int y = y0 + 1; y < y1; y++)
            for (int x = 0; x < WR_TILE; x++) sums[x] += tile[WR_TILE * y + x];
        for (int i = 0; i < side && i * step < w; i++) {
            const int x0 = i * step, x1 = x0 + step < w ? x0 + step : w;
            float sum = 0.0f;
            for (int x = x0; x < x1; x++) sum += sums[x];
            mean[side * j + i] = sum / (float)((x1 - x0) * (y1 - y0));
        }
    }
}

/* One texel in place of each mean: the first, which is always inside the table. */
static void make_rough(const WrCanvasMips *cells, const float *tile, float *mean)
{
    int step = 1 << cells->level, side = WR_TILE >> cells->level;
    for (int j = 0; j < side; j++)
        for (int i = 0; i < side; i++) mean[side * j + i] = tile[WR_TILE * step * j + step * i];
}

/* Number of the tile's texels inside the table along one axis. */
static int inside(int t, int size)
{
    const int rest = size - t * WR_TILE;
    return rest < WR_TILE ? rest : WR_TILE;
}

/* True if blocks of the tile come from its means of level BASE. */
static bool has_base(const WrCanvasMips *cells, int tx, int ty)
{
    return cells->level >= BASE && cells->tile_known &&
           cells->tile_known[ty * cells->tiles_u + tx] &&
           inside(tx, wr_field_width(cells->field)) == WR_TILE &&
           inside(ty, wr_field_height(cells->field)) == WR_TILE;
}

/* Means of means: a sixteenth of the memory to read. */
static void make_from_base(const WrCanvasMips *cells, int at, float *mean)
{
    const float *base = cells->base + (size_t)at * (BASE_SIDE * BASE_SIDE);
    const int side = WR_TILE >> cells->level, step = 1 << (cells->level - BASE);
    for (int j = 0; j < side; j++)
        for (int i = 0; i < side; i++) {
            float sum = 0.0f;
            for (int y = j * step; y < (j + 1) * step; y++)
                for (int x = i * step; x < (i + 1) * step; x++) sum += base[BASE_SIDE * y + x];
            mean[side * j + i] = sum / (float)(step * step);
        }
}

static void make_block(WrCanvasMips *cells, int tx, int ty, const float *tile, bool late)
{
    const int at = ty * cells->tiles_u + tx;
    const size_t side = WR_TILE >> cells->level;
    const int w = inside(tx, wr_field_width(cells->field));
    const int h = inside(ty, wr_field_height(cells->field));
    Block *block = &cells->blocks[at];
    if (!block->mean) {
        block->mean = wr_alloc(side * side, sizeof(float));
        __atomic_fetch_add(&cells->bytes, side * side * sizeof(float) + WR_ALIGN, __ATOMIC_RELAXED);
    }
    block->rough = late;
    if (late) make_rough(cells, tile, block->mean);
    else if (has_base(cells, tx, ty)) make_from_base(cells, at, block->mean);
    else make_means(cells->level, w, h, tile, block->mean);
}

const float *wr_canvas_mips_block(WrCanvasMips *cells, int tx, int ty, double deadline, float *flat)
{
    const int at = ty * cells->tiles_u + tx;
    const Block *block = &cells->blocks[at];
    if (block->mean && !block->rough) return block->mean;
    const float *tile = wr_field_tile(cells->field, tx, ty);
    if (!tile) {
        *flat = wr_field_level(cells->field);
        return NULL;
    }
    if (cells->level == 0) return tile;
    const bool based = has_base(cells, tx, ty);
    if (based && cells->level == BASE) return cells->base + (size_t)at * (BASE_SIDE * BASE_SIDE);
    const bool late = !based && wr_clock_seconds() > deadline;
    if (late) __atomic_store_n(&cells->rough, true, __ATOMIC_RELAXED);
    if (!block->mean || !late) make_block(cells, tx, ty, tile, late);
    return block->mean;
}

/* ---- several threads ---- */

typedef struct Work {
    WrCanvasMips *cells;
    const bool *columns, *rows;
    double deadline;
} Work;

static void make_row(int ty, int worker, void *ctx)
{
    const Work *work = ctx;
    float flat;
    (void)worker;
    if (!work->rows[ty]) return;
    for (int tx = 0; tx < work->cells->tiles_u; tx++)
        if (work->columns[tx]) wr_canvas_mips_block(work->cells, tx, ty, work->deadline, &flat);
}

void wr_canvas_mips_prepare(WrCanvasMips *cells, const bool *columns, const bool *rows,
                            double deadline, WrPool *pool)
{
    Work work = { cells, columns, rows, deadline };
    wr_pool_run(pool, cells->tiles_v, make_row, &work);
}

bool wr_canvas_mips_rough(const WrCanvasMips *cells)
{
    return cells->rough;
}

void wr_canvas_mips_forget_rough(WrCanvasMips *cells)
{
    cells->rough = false;
}

/* Read a tile: range, and means of level BASE. In 64 columns of vectors; the last ones in part, at the table's edge. */
static void read_tile(const WrCanvasMips *cells, int tx, int ty)
{
    const int at = ty * cells->tiles_u + tx;
    const int w = inside(tx, wr_field_width(cells->field));
    const int h = inside(ty, wr_field_height(cells->field));
    const float *tile = wr_field_tile(cells->field, tx, ty);
    float low[WR_TILE], high[WR_TILE];
    cells->tile_low[at] = cells->tile_high[at] = tile ? tile[0] : wr_field_level(cells->field);
    if (!tile) return;
    memcpy(low, tile, sizeof low);
    memcpy(high, tile, sizeof high);
    for (int y = 1; y < h; y++)
        for (int x = 0; x < WR_TILE; x++) {
            const float f = tile[WR_TILE * y + x];
            low[x] = f < low[x] ? f : low[x];
            high[x] = f > high[x] ? f : high[x];
        }
    for (int x = 0; x < w; x++) {
        cells->tile_low[at] = low[x] < cells->tile_low[at] ? low[x] : cells->tile_low[at];
        cells->tile_high[at] = high[x] > cells->tile_high[at] ? high[x] : cells->tile_high[at];
    }
    make_means(BASE, w, h, tile, cells->base + (size_t)at * (BASE_SIDE * BASE_SIDE));
}

static void make_ranges(WrCanvasMips *cells)
{
    const size_t rows = (size_t)cells->tiles_v, tiles = (size_t)cells->tiles_u * rows;
    cells->base = wr_alloc(tiles * BASE_SIDE * BASE_SIDE, sizeof(float));
    cells->tile_known = wr_alloc(tiles, sizeof(bool));
    cells->tile_low = wr_alloc(tiles, sizeof(float));
    cells->tile_high = wr_alloc(tiles, sizeof(float));
    cells->row_known = wr_alloc(rows, sizeof(bool));
    cells->row_low = wr_alloc(rows, sizeof(float));
    cells->row_high = wr_alloc(rows, sizeof(float));
}

/* Update the range of a row from its changed tiles. */
static void read_row(int ty, int worker, void *ctx)
{
    WrCanvasMips *cells = ctx;
    float low = INFINITY, high = -INFINITY;
    (void)worker;
    if (cells->row_known[ty]) return;
    for (int tx = 0; tx < cells->tiles_u; tx++) {
        const size_t i = (size_t)ty * (size_t)cells->tiles_u + (size_t)tx;
        if (!cells->tile_known[i]) read_tile(cells, tx, ty);
        cells->tile_known[i] = true;
        low = cells->tile_low[i] < low ? cells->tile_low[i] : low;
        high = cells->tile_high[i] > high ? cells->tile_high[i] : high;
    }
    cells->row_low[ty] = low;
    cells->row_high[ty] = high;
    cells->row_known[ty] = true;
}

void wr_canvas_mips_range(WrCanvasMips *cells, WrPool *pool, float *low, float *high)
{
    int fresh = 0;
    if (!cells->tile_known) make_ranges(cells);
    for (int ty = 0; ty < cells->tiles_v; ty++) fresh += !cells->row_known[ty];
    if (fresh > 0)
        wr_pool_run(fresh * cells->tiles_u >= MANY_TILES ? pool : NULL, cells->tiles_v, read_row,
                    cells);
    for (int ty = 0; ty < cells->tiles_v; ty++) {
        if (ty == 0 || cells->row_low[ty] < *low) *low = cells->row_low[ty];
        if (ty == 0 || cells->row_high[ty] > *high) *high = cells->row_high[ty];
    }
}

int wr_canvas_mips_level(double zoom)
{
    int level = 0;
    while (level < WR_CANVAS_MIPS_LEVEL_MAX && zoom * (double)(2 << level) <= 1.0) level++;
    return level;
}

WrCellTaps wr_taps_make(double from, double to, int size, int level, bool repeats)
{
    WrCellTaps taps = { 0 };
    double middle = (from + to) / 2.0;
    if (!repeats && (middle < 0.0 || middle >= size)) {
        taps.outside = true;
        return taps;
    }
    if (!repeats) {
        from = fmax(from, 0.0);
        to = fmin(to, size);
    }
    double shift = floor(from / size) * size, total = 0.0;
    double x = from - shift, end = to - shift;
    int step = 1 << level, base = 0, count = 0;
    for (; x < end && count < WR_TAPS;) {
        if (x >= base + size) base += size;
        int cell = (int)(x - base) >> level;
        double edge = base + fmin((double)(cell + 1) * step, size);
        double stop = fmin(edge, end);
        taps.cell[count] = cell;
        taps.weight[count] = (float)(stop - x);
        total += stop - x;
        count++;
        x = edge;
    }
    for (int k = 0; k < count; k++) taps.weight[k] = (float)(taps.weight[k] / total);
    for (int k = count; k < WR_TAPS; k++) taps.cell[k] = taps.cell[0];
    if (count == 0 || !(total > 0.0)) taps.weight[0] = 1.0f;
    return taps;
}
