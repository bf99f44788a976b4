/* From blocks of new heights to a table. A batch of blocks is made in parallel; then the tiles that
   differ are fetched one after the other, since that may copy nodes of the tree; then they are filled in
   parallel. Which blocks make a batch does not depend on the number of threads, nor does any height. */
#include "field/ops_inner.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "field/field.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#define SIDE WR_OP_SIDE
#define BATCH 32                /* blocks; 8 MB of new heights */
#define ACROSS (SIDE / WR_TILE) /* tiles along a block's side */
#define BLOCK_TILES (ACROSS * ACROSS)

/* Per thread. */
typedef struct Bench {
    float before[SIDE * SIDE], mask[SIDE * SIDE];
} Bench;

typedef struct Build {
    const WrOpJob *job;
    const WrOpWork *work;
    WrField *out;
    const WrField
        *base;   /* what is where nothing changes; `out` itself, but where little is done again */
    bool same;   /* base is the input */
    bool blends; /* base is a share of the input: the mask applies */
    WrOpBlock *blocks; /* [count], those that are done again; NULL: all */
    int count, blocks_u, first;
    float (*result)[SIDE * SIDE]; /* [BATCH] */
    Bench *bench;                 /* [threads] */
    char *scratch;                /* [threads][scratch_pitch] */
    size_t scratch_pitch;
    float *tile[BATCH][BLOCK_TILES]; /* where to write; NULL: unchanged */
    bool changed[BATCH][BLOCK_TILES];
} Build;

static int min_int(int a, int b)
{
    return a < b ? a : b;
}

static WrOpBlock block_at(const Build *build, int index)
{
    if (build->blocks) return build->blocks[index];
    int i = index % build->blocks_u * SIDE, j = index / build->blocks_u * SIDE;
    return (WrOpBlock){ i, j, min_int(SIDE, wr_field_width(build->out) - i),
                        min_int(SIDE, wr_field_height(build->out) - j) };
}

/* First and last tile of texels from .. to along an axis of n texels, as far as a loop over tiles modulo
   their number has to go. */
static void tile_span(int from, int to, int n, WrWrap wrap, int *first, int *last)
{
    int tiles = (n + WR_TILE - 1) / WR_TILE;
    bool all = wrap == WR_WRAP_PERIODIC && (from < 0 || to >= n);
    if (all) { /* to be simple, at the seam: the texels on its other side may be two tiles' */
        *first = (from - WR_TILE) / WR_TILE - 1;
        *last = (to + WR_TILE) / WR_TILE + 1;
        if (*last - *first >= tiles) *first = 0, *last = tiles - 1;
        return;
    }
    *first = from < 0 ? 0 : from / WR_TILE;
    *last = to >= n ? tiles - 1 : to / WR_TILE;
}

static int modulo(int i, int n)
{
    int rest = i % n;
    return rest < 0 ? rest + n : rest;
}

/* Is every tile of `field` around the block NULL? */
static bool is_flat(const WrField *field, WrOpBlock b, int reach)
{
    int u0, u1, v0, v1;
    tile_span(b.i - reach, b.i + b.count_i - 1 + reach, wr_field_width(field),
              wr_field_wrap_u(field), &u0, &u1);
    tile_span(b.j - reach, b.j + b.count_j - 1 + reach, wr_field_height(field),
              wr_field_wrap_v(field), &v0, &v1);
    int tiles_u = wr_field_tiles_u(field), tiles_v = wr_field_tiles_v(field);
    for (int ty = v0; ty <= v1; ty++)
        for (int tx = u0; tx <= u1; tx++)
            if (wr_field_tile(field, modulo(tx, tiles_u), modulo(ty, tiles_v))) return false;
    return true;
}

static bool nothing_to_do(const Build *build, WrOpBlock block)
{
    const WrField *mask = build->job->mask;
    if (wr_progress_cancelled(build->job->progress)) return true;
    if (build->blends && mask && wr_field_level(mask) <= 0.0f && is_flat(mask, block, 0))
        return true;
    return build->work->reach >= 0 && is_flat(build->job->in, block, build->work->reach);
}

/* Beyond float's range: its ends. Not a number can only come of heights near those: no change. */
static void keep_finite(const float *restrict before, float *restrict row, int count)
{
    for (int i = 0; i < count; i++) {
        float x = row[i] > FLT_MAX ? FLT_MAX : row[i];
        x = x < -FLT_MAX ? -FLT_MAX : x;
        row[i] = x == x ? x : before[i];
    }
}

static void blend(const float *restrict mask, const float *restrict before, float *restrict row,
                  int count)
{
    for (int i = 0; i < count; i++) {
        double m = mask[i] > 0.0f ? mask[i] < 1.0f ? mask[i] : 1.0 : 0.0, was = before[i];
        float mixed = (float)(was + m * ((double)row[i] - was));
        row[i] = mask[i] >= 1.0f ? row[i] : mask[i] > 0.0f ? mixed : before[i];
    }
}

/* Equal heights keep their bits: a filter turns -0 into 0. */
static void keep_equal(const float *restrict before, float *restrict row, int count)
{
    for (int i = 0; i < count; i++) row[i] = row[i] == before[i] ? before[i] : row[i];
}

static bool row_differs(const float *restrict before, const float *restrict row, int count)
{
    uint32_t differs = 0;
#pragma omp simd reduction(| : differs)
    for (int i = 0; i < count; i++) {
        uint32_t was, is;
        memcpy(&was, &before[i], sizeof was);
        memcpy(&is, &row[i], sizeof is);
        differs |= was ^ is;
    }
    return differs != 0;
}

/* A filter's row without a mask: the steps above in one. */
static bool settle_row(const float *restrict before, float *restrict row, int count)
{
    uint32_t differs = 0;
#pragma omp simd reduction(| : differs)
    for (int i = 0; i < count; i++) {
        float x = row[i], was = before[i];
        x = x > FLT_MAX ? FLT_MAX : x;
        x = x < -FLT_MAX ? -FLT_MAX : x;
        bool changes = x < was || x > was; /* not where x is not a number */
        x = changes ? x : was;
        uint32_t old, now;
        memcpy(&old, &was, sizeof old);
        memcpy(&now, &x, sizeof now);
        differs |= old ^ now;
        row[i] = x;
    }
    return differs != 0;
}

/* What the block was, and its pitch. */
static const float *read_before(const Build *build, const WrOpBlock *b, const char *scratch,
                                Bench *bench, size_t *pitch)
{
    const WrOpWork *work = build->work;
    *pitch = SIDE;
    if (work->input.pitch && build->same) {
        *pitch = work->input.pitch;
        return (const float *)(const void *)scratch + work->input.at;
    }
    wr_field_read(build->base, b->i, b->j, b->count_i, b->count_j, bench->before, SIDE);
    return bench->before;
}

/* One tile's part of a row. True if any height of it changed. */
static bool finish_part(const Build *build, const float *before, const float *mask, float *row,
                        int count)
{
    if (!mask && !build->work->moves) return settle_row(before, row, count);
    keep_finite(before, row, count);
    if (mask) blend(mask, before, row, count);
    if (!build->work->moves) keep_equal(before, row, count);
    return row_differs(before, row, count);
}

static void make_block(int index, int worker, void *ctx)
{
    Build *build = ctx;
    const WrOpWork *work = build->work;
    WrOpBlock b = block_at(build, build->first + index);
    float *now = build->result[index];
    Bench *bench = &build->bench[worker];
    char *scratch = build->scratch + (size_t)worker * build->scratch_pitch;
    memset(build->changed[index], 0, sizeof build->changed[index]);
    if (nothing_to_do(build, b)) return;
    work->make(build->job, work->ctx, b, now, SIDE, scratch);
    size_t pitch;
    const float *before = read_before(build, &b, scratch, bench, &pitch);
    bool masked = build->blends && build->job->mask;
    if (masked) wr_field_read(build->job->mask, b.i, b.j, b.count_i, b.count_j, bench->mask, SIDE);
    for (int y = 0; y < b.count_j; y++)
        for (int x = 0; x < b.count_i; x += WR_TILE)
            build->changed[index][y / WR_TILE * ACROSS + x / WR_TILE] |= finish_part(
                build, before + (size_t)y * pitch + x, masked ? bench->mask + y * SIDE + x : NULL,
                now + y * SIDE + x, min_int(WR_TILE, b.count_i - x));
}

/* A tile that is written whole need not be copied before. */
static float *open_tile(Build *build, WrOpBlock b, int t)
{
    int x = t % ACROSS, y = t / ACROSS;
    bool whole = b.count_i >= (x + 1) * WR_TILE && b.count_j >= (y + 1) * WR_TILE;
    return (whole ? wr_field_tile_fresh : wr_field_tile_write)(build->out, b.i / WR_TILE + x,
                                                               b.j / WR_TILE + y);
}

/* What is done again may now be what the base has. */
static void put_base(Build *build, WrOpBlock b, int t)
{
    int x = t % ACROSS, y = t / ACROSS, tx = b.i / WR_TILE + x, ty = b.j / WR_TILE + y;
    if (build->out == build->base || x * WR_TILE >= b.count_i || y * WR_TILE >= b.count_j) return;
    if (wr_field_tile(build->out, tx, ty) != wr_field_tile(build->base, tx, ty))
        wr_field_tile_share(build->out, build->base, tx, ty);
}

static void fetch_tiles(Build *build, int count)
{
    for (int index = 0; index < count; index++) {
        WrOpBlock b = block_at(build, build->first + index);
        for (int t = 0; t < BLOCK_TILES; t++) {
            build->tile[index][t] = build->changed[index][t] ? open_tile(build, b, t) : NULL;
            if (!build->changed[index][t]) put_base(build, b, t);
        }
    }
}

static void fill_tiles(int index, int worker, void *ctx)
{
    (void)worker;
    Build *build = ctx;
    WrOpBlock b = block_at(build, build->first + index);
    for (int t = 0; t < BLOCK_TILES; t++) {
        float *tile = build->tile[index][t];
        if (!tile) continue;
        int x = t % ACROSS * WR_TILE, y = t / ACROSS * WR_TILE;
        size_t bytes = sizeof *tile * (size_t)min_int(WR_TILE, b.count_i - x);
        for (int row = 0; row < WR_TILE && y + row < b.count_j; row++)
            memcpy(tile + row * WR_TILE, build->result[index] + (y + row) * SIDE + x, bytes);
    }
}

static bool run_batches(Build *build)
{
    const int count = build->count;
    if (!wr_op_step(build->job, 0.0)) return false;
    for (int first = 0; first < count; first += BATCH) {
        int blocks = min_int(BATCH, count - first);
        build->first = first;
        wr_pool_run(build->job->pool, blocks, make_block, build);
        if (wr_progress_cancelled(build->job->progress))
            return wr_fail(build->job->err, "%s: cancelled", build->job->name);
        fetch_tiles(build, blocks);
        wr_pool_run(build->job->pool, blocks, fill_tiles, build);
        if (!wr_op_step(build->job, (double)(first + blocks) / count)) return false;
    }
    return true;
}

WrField *wr_op_base(const WrOpJob *job, int width, int height, WrWrap wrap_u, WrWrap wrap_v)
{
    const WrField *in = job->in;
    if (width == wr_field_width(in) && height == wr_field_height(in) &&
        wrap_u == wr_field_wrap_u(in) && wrap_v == wr_field_wrap_v(in))
        return wr_field_share(in);
    return wr_field_new(width, height, wrap_u, wrap_v, wr_field_level(in), job->err);
}

static bool same_shape(const WrField *a, const WrField *b)
{
    const float x = wr_field_level(a), y = wr_field_level(b);
    return wr_field_width(a) == wr_field_width(b) && wr_field_height(a) == wr_field_height(b) &&
           wr_field_wrap_u(a) == wr_field_wrap_u(b) && wr_field_wrap_v(a) == wr_field_wrap_v(b) &&
           memcmp(&x, &y, sizeof x) == 0;
}

/* Which blocks there are, and what they are written over. */
static void plan_blocks(Build *build, WrField *base)
{
    const WrOpJob *job = build->job;
    const int window = build->work->window;
    build->blocks_u = (wr_field_width(base) + SIDE - 1) / SIDE;
    build->count = build->blocks_u * ((wr_field_height(base) + SIDE - 1) / SIDE);
    build->base = build->out = base;
    if (!job->was || window == 0 || !same_shape(job->was, job->in) || !same_shape(job->made, base))
        return;
    build->blocks = wr_op_changed_blocks(job, window / 2, &build->count);
    build->out = wr_field_share(job->made);
}

WrField *wr_op_build(const WrOpJob *job, WrField *base, const WrOpWork *work)
{
    if (!base) return NULL;
    bool same = wr_field_key(base) == wr_field_key(job->in);
    size_t threads = (size_t)wr_pool_threads(job->pool);
    Build *build = wr_alloc(1, sizeof *build);
    build->job = job;
    build->work = work;
    build->same = same;
    plan_blocks(build, base);
    build->blends = wr_field_width(base) == wr_field_width(job->in) &&
                    wr_field_height(base) == wr_field_height(job->in);
    build->scratch_pitch = (work->scratch + WR_ALIGN) / WR_ALIGN * WR_ALIGN;
    build->result = wr_try_alloc_unset((size_t)min_int(BATCH, build->count) + 1,
                                       sizeof *build->result, job->name, job->err);
    if (build->result)
        build->bench = wr_try_alloc_unset(threads, sizeof *build->bench, job->name, job->err);
    if (build->bench)
        build->scratch = wr_try_alloc_unset(threads, build->scratch_pitch, job->name, job->err);
    bool good = build->scratch && run_batches(build);
    WrField *out = build->out;
    if (out != base) wr_field_free(base);
    wr_free(build->blocks);
    wr_free(build->result);
    wr_free(build->bench);
    wr_free(build->scratch);
    wr_free(build);
    if (good) return out;
    wr_field_free(out);
    return NULL;
}

WrField *wr_op_build_same(const WrOpJob *job, const WrOpWork *work)
{
    return wr_op_build(job, wr_field_share(job->in), work);
}
