/* The blocks of an operation to recompute after a partial change of its input. */
#include "field/ops_internal.h"

#include "base/array.h"
#include "base/memory.h"
#include "field/field.h"

#include <stdint.h>
#include <string.h>

#define ACROSS (WR_OP_SIDE / WR_TILE) /* tiles along a block's side */

typedef struct Changed {
    const WrOpJob *job;
    int reach;
    int tiles_u, tiles_v;
    uint8_t *marked; /* [tiles_v][tiles_u] */
} Changed;

/* Texels along an axis. */
typedef struct Span {
    int from, to;
} Span;

static int least(int a, int b)
{
    return a < b ? a : b;
}

/* The tiles of a span that may extend outside, as one or two runs: beyond an edge they wrap to the
 * other. */
static int tile_runs(Span s, int n, WrWrap wrap, Span run[2])
{
    const int last = (n - 1) / WR_TILE;
    if (wrap == WR_WRAP_CLAMP || s.to - s.from + 1 >= n) {
        bool all = wrap != WR_WRAP_CLAMP;
        run[0].from = all || s.from < 0 ? 0 : s.from / WR_TILE;
        run[0].to = all || s.to >= n ? last : s.to / WR_TILE;
        return 1;
    }
    if (s.from >= 0 && s.to < n) {
        run[0] = (Span){ s.from / WR_TILE, s.to / WR_TILE };
        return 1;
    }
    run[0] = (Span){ 0, (s.from < 0 ? s.to : s.to - n) / WR_TILE };
    run[1] = (Span){ (s.from < 0 ? s.from + n : s.from) / WR_TILE, last };
    return 2;
}

static void mark(const Changed *c, Span i, Span j)
{
    const WrField *in = c->job->in;
    Span across[2], down[2];
    int runs_u = tile_runs((Span){ i.from - c->reach, i.to + c->reach }, wr_field_width(in),
                           wr_field_wrap_u(in), across);
    int runs_v = tile_runs((Span){ j.from - c->reach, j.to + c->reach }, wr_field_height(in),
                           wr_field_wrap_v(in), down);
    for (int a = 0; a < runs_v; a++)
        for (int ty = down[a].from; ty <= down[a].to; ty++)
            for (int b = 0; b < runs_u; b++)
                memset(c->marked + (size_t)ty * (size_t)c->tiles_u + across[b].from, 1,
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
    const WrField *was = c->job->was, *in = c->job->in;
    const float *a = wr_field_tile(was, tx, ty), *b = wr_field_tile(in, tx, ty);
    const float level_a = wr_field_level(was), level_b = wr_field_level(in);
    const int columns = least(WR_TILE, wr_field_width(in) - tx * WR_TILE);
    const int rows = least(WR_TILE, wr_field_height(in) - ty * WR_TILE);
    Span i = { WR_TILE, -1 }, j = { WR_TILE, -1 };
    for (int y = 0; y < rows; y++)
        for (int x = 0; x < columns; x++) {
            if (!differs(a, level_a, b, level_b, y * WR_TILE + x)) continue;
            i.from = least(i.from, x);
            i.to = x > i.to ? x : i.to;
            j.from = least(j.from, y);
            j.to = y;
        }
    if (i.to < 0) return;
    mark(c, (Span){ tx * WR_TILE + i.from, tx * WR_TILE + i.to },
         (Span){ ty * WR_TILE + j.from, ty * WR_TILE + j.to });
}

/* The smallest block around the marked tiles of a square of tiles; no texels if there are none. */
static WrOpBlock block_of(const Changed *c, int left, int top)
{
    Span i = { c->tiles_u, -1 }, j = { c->tiles_v, -1 };
    for (int ty = top; ty < least(top + ACROSS, c->tiles_v); ty++)
        for (int tx = left; tx < least(left + ACROSS, c->tiles_u); tx++) {
            if (!c->marked[(size_t)ty * (size_t)c->tiles_u + (size_t)tx]) continue;
            i.from = least(i.from, tx);
            i.to = tx > i.to ? tx : i.to;
            j.from = least(j.from, ty);
            j.to = ty;
        }
    if (i.to < 0) return (WrOpBlock){ 0 };
    const int x = i.from * WR_TILE, y = j.from * WR_TILE;
    return (WrOpBlock){ x, y, least((i.to + 1) * WR_TILE, wr_field_width(c->job->in)) - x,
                        least((j.to + 1) * WR_TILE, wr_field_height(c->job->in)) - y, false };
}

WrOpBlock *wr_op_changed_blocks(const WrOpJob *job, int reach, int *count)
{
    Changed c = { .job = job,
                  .reach = reach,
                  .tiles_u = wr_field_tiles_u(job->in),
                  .tiles_v = wr_field_tiles_v(job->in) };
    WR_ARRAY(WrOpBlock) blocks = { 0 };
    c.marked = wr_alloc((size_t)c.tiles_u * (size_t)c.tiles_v, 1);
    wr_field_changes(job->was, job->in, mark_around, &c);
    for (int ty = 0; ty < c.tiles_v; ty += ACROSS)
        for (int tx = 0; tx < c.tiles_u; tx += ACROSS) {
            WrOpBlock block = block_of(&c, tx, ty);
            if (block.count_i > 0) wr_array_push(&blocks, block);
        }
    wr_free(c.marked);
    *count = blocks.count;
    return blocks.data;
}
