/* Blocks near the differences of two tables. */
#include "field/changed_blocks.h"

#include "base/array.h"
#include "base/memory.h"

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#define ACROSS (WR_CHANGED_SIDE / WR_TILE) /* tiles along a block's side */

typedef struct Changed {
    const WrFieldChange *change;
    int reach;
    uint8_t *marked; /* [tiles_v][tiles_u] */
} Changed;

/* Texels along an axis. */
typedef struct TileRange {
    int from, to;
} TileRange;

static int least(int a, int b)
{
    return a < b ? a : b;
}

/* The tiles of a span that may extend outside, as one or two runs: beyond an edge they wrap to the
 * other. */
static int tile_runs(TileRange s, int n, WrWrap wrap, TileRange run[2])
{
    const int last = (n - 1) / WR_TILE;
    if (wrap == WR_WRAP_CLAMP || s.to - s.from + 1 >= n) {
        bool all = wrap != WR_WRAP_CLAMP;
        run[0].from = all || s.from < 0 ? 0 : s.from / WR_TILE;
        run[0].to = all || s.to >= n ? last : s.to / WR_TILE;
        return 1;
    }
    if (s.from >= 0 && s.to < n) {
        run[0] = (TileRange){ s.from / WR_TILE, s.to / WR_TILE };
        return 1;
    }
    run[0] = (TileRange){ 0, (s.from < 0 ? s.to : s.to - n) / WR_TILE };
    run[1] = (TileRange){ (s.from < 0 ? s.from + n : s.from) / WR_TILE, last };
    return 2;
}

void wr_mark_tiles(const WrField *like, const WrFieldRect *texels, int reach, uint8_t *marked)
{
    TileRange across[2], down[2];
    const int runs_u = tile_runs((TileRange){ texels->i0 - reach, texels->i1 - 1 + reach },
                                 wr_field_width(like), wr_field_wrap_u(like), across);
    const int runs_v = tile_runs((TileRange){ texels->j0 - reach, texels->j1 - 1 + reach },
                                 wr_field_height(like), wr_field_wrap_v(like), down);
    for (int a = 0; a < runs_v; a++)
        for (int ty = down[a].from; ty <= down[a].to; ty++)
            for (int b = 0; b < runs_u; b++)
                memset(marked + ty * wr_field_tiles_u(like) + across[b].from, 1,
                       (size_t)(across[b].to - across[b].from + 1));
}

static bool differs(const float *a, float level_a, const float *b, float level_b, int k)
{
    float x = a ? a[k] : level_a, y = b ? b[k] : level_b;
    return memcmp(&x, &y, sizeof x) != 0;
}

/* Marks the tiles around the changed texels of a tile. */
static void mark_around(int tx, int ty, void *ctx)
{
    const Changed *c = ctx;
    const WrField *was = c->change->was, *in = c->change->now;
    const float *a = wr_field_tile(was, tx, ty), *b = wr_field_tile(in, tx, ty);
    const float level_a = wr_field_level(was), level_b = wr_field_level(in);
    const int columns = least(WR_TILE, wr_field_width(in) - tx * WR_TILE);
    const int rows = least(WR_TILE, wr_field_height(in) - ty * WR_TILE);
    TileRange i = { WR_TILE, -1 }, j = { WR_TILE, -1 };
    for (int y = 0; y < rows; y++)
        for (int x = 0; x < columns; x++) {
            if (!differs(a, level_a, b, level_b, y * WR_TILE + x)) continue;
            i.from = least(i.from, x);
            i.to = x > i.to ? x : i.to;
            j.from = least(j.from, y);
            j.to = y;
        }
    if (i.to < 0) return;
    const WrFieldRect texels = { tx * WR_TILE + i.from, tx * WR_TILE + i.to + 1,
                                 ty * WR_TILE + j.from, ty * WR_TILE + j.to + 1 };
    wr_mark_tiles(in, &texels, c->reach, c->marked);
}

/* The smallest block around the marked tiles of a square of tiles; no texels if there are none. */
static WrFieldRect block_of(const WrField *like, const uint8_t *marked, int left, int top)
{
    const int tiles_u = wr_field_tiles_u(like), tiles_v = wr_field_tiles_v(like);
    TileRange i = { tiles_u, -1 }, j = { tiles_v, -1 };
    for (int ty = top; ty < least(top + ACROSS, tiles_v); ty++)
        for (int tx = left; tx < least(left + ACROSS, tiles_u); tx++) {
            if (!marked[ty * tiles_u + tx]) continue;
            i.from = least(i.from, tx);
            i.to = tx > i.to ? tx : i.to;
            j.from = least(j.from, ty);
            j.to = ty;
        }
    if (i.to < 0) return (WrFieldRect){ 0 };
    return (WrFieldRect){ i.from * WR_TILE, least((i.to + 1) * WR_TILE, wr_field_width(like)),
                          j.from * WR_TILE, least((j.to + 1) * WR_TILE, wr_field_height(like)) };
}

void wr_mark_changes(const WrFieldChange *changes, int change_count, int reach, uint8_t *marked)
{
    for (int k = 0; k < change_count; k++) {
        Changed c = { &changes[k], reach, marked };
        wr_field_changes(changes[k].was, changes[k].now, mark_around, &c);
    }
}

int wr_changed_blocks(const WrFieldChange *changes, int change_count, int reach,
                      WrFieldRect **blocks)
{
    WR_ARRAY(WrFieldRect) all = { 0 };
    const WrField *like = changes[0].now;
    const int tiles_u = wr_field_tiles_u(like), tiles_v = wr_field_tiles_v(like);
    uint8_t *marked = wr_alloc((size_t)tiles_u * (size_t)tiles_v, 1);
    wr_mark_changes(changes, change_count, reach, marked);
    for (int ty = 0; ty < tiles_v; ty += ACROSS)
        for (int tx = 0; tx < tiles_u; tx += ACROSS) {
            const WrFieldRect block = block_of(like, marked, tx, ty);
            if (block.i1 > block.i0) wr_array_push(&all, block);
        }
    wr_free(marked);
    *blocks = all.data;
    return all.count;
}

/* ---- parts of tables ---- */

/* The span of a block with its margin along an axis of n texels. */
static TileRange with_margin(int from, int to, int margin, int n, WrWrap wrap)
{
    TileRange span = { from - margin, to + margin };
    if (wrap == WR_WRAP_CLAMP && span.from < 0) span.from = 0;
    if (wrap == WR_WRAP_CLAMP && span.to > n) span.to = n;
    return span;
}

WrField *wr_field_crop(const WrField *field, const WrFieldRect *block, int margin, int at[2])
{
    const TileRange i =
        with_margin(block->i0, block->i1, margin, wr_field_width(field), wr_field_wrap_u(field));
    const TileRange j =
        with_margin(block->j0, block->j1, margin, wr_field_height(field), wr_field_wrap_v(field));
    const int width = i.to - i.from, height = j.to - j.from;
    float *texels = wr_alloc_unset((size_t)width * (size_t)height, sizeof *texels);
    WrField *crop =
        wr_field_new(width, height, WR_WRAP_CLAMP, WR_WRAP_CLAMP, wr_field_level(field), NULL);
    wr_field_read(field, i.from, j.from, width, height, texels, (size_t)width);
    wr_field_write(crop, 0, 0, width, height, texels, (size_t)width);
    wr_free(texels);
    at[0] = block->i0 - i.from;
    at[1] = block->j0 - j.from;
    return crop;
}

static bool same_rows(const float *a, const float *b, int columns, int rows)
{
    bool same = true;
    for (int y = 0; same && y < rows; y++)
        same = memcmp(a + y * WR_TILE, b + y * WR_TILE, sizeof *a * (size_t)columns) == 0;
    return same;
}

static bool is_level(const float *texels, int columns, int rows, float level)
{
    bool is = true;
    for (int y = 0; is && y < rows; y++)
        for (int x = 0; x < columns; x++)
            is &= memcmp(&texels[y * WR_TILE + x], &level, sizeof level) == 0;
    return is;
}

void wr_field_put_block(WrField *field, const WrFieldRect *block, const WrField *made,
                        const int at[2])
{
    float before[WR_TILE * WR_TILE], now[WR_TILE * WR_TILE];
    for (int j = block->j0; j < block->j1; j += WR_TILE)
        for (int i = block->i0; i < block->i1; i += WR_TILE) {
            const int columns = least(WR_TILE, block->i1 - i), rows = least(WR_TILE, block->j1 - j);
            wr_field_read(field, i, j, columns, rows, before, WR_TILE);
            wr_field_read(made, at[0] + i - block->i0, at[1] + j - block->j0, columns, rows, now,
                          WR_TILE);
            if (same_rows(before, now, columns, rows)) continue;
            if (is_level(now, columns, rows, wr_field_level(field)))
                wr_field_tile_drop(field, i / WR_TILE, j / WR_TILE);
            else wr_field_write(field, i, j, columns, rows, now, WR_TILE);
        }
}
