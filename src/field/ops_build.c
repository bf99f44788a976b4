/* The frame of table operations: batches of blocks, reading with edges, blocks to recompute, building of the result. */
#include "base/array.h"
#include "base/cpu.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "field/field.h"
#include "field/filter_kernels.h"
#include "field/ops_internal.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

/* ---- the kernels of this processor ---- */

static const WrCpuBuilds builds = { &wr_taps_v1, &wr_taps_v3, &wr_taps_v4 };

const WrTaps *wr_taps_at(int index)
{
    return wr_cpu_build(&builds, index);
}

const WrTaps *wr_taps(void)
{
    return wr_cpu_best(&builds);
}

/* ---- reports, batches, reading with repeated edges, planes ---- */

/* Helpers of operations besides the builder: reports, batches, reading with repeated edges, planes. */

#define ROWS 64 /* of a plane, between two checks for cancellation */

bool wr_op_step(const WrOpJob *job, double fraction)
{
    if (wr_progress_step(job->progress, job->from + (job->to - job->from) * fraction)) return true;
    return wr_fail(job->err, "%s: cancelled", job->name);
}

typedef struct Batch {
    WrPiece piece;
    void *ctx;
    const WrProgress *progress;
    int first;
} Batch;

static void run_piece(int index, int worker, void *ctx)
{
    const Batch *batch = ctx;
    if (!wr_progress_cancelled(batch->progress))
        batch->piece(batch->first + index, worker, batch->ctx);
}

bool wr_op_pieces(const WrOpJob *job, int count, WrPiece piece, void *ctx)
{
    enum { PIECES = 64 };
    Batch batch = { piece, ctx, job->progress, 0 };
    if (!wr_op_step(job, 0.0)) return false;
    for (int first = 0; first < count; first += PIECES) {
        int pieces = count - first < PIECES ? count - first : PIECES;
        batch.first = first;
        wr_pool_run(job->pool, pieces, run_piece, &batch);
        if (!wr_op_step(job, (double)(first + pieces) / count)) return false;
    }
    return true;
}

/* Indices from .. from + count - 1 of an axis of n texels: the range to read, and the output position
   of its first texel; the rest repeats the ends. */
typedef struct Span {
    int from, count, at;
} Span;

static int clamp_index(int i, int low, int high)
{
    return i < low ? low : i > high ? high : i;
}

static Span span_inside(int from, int count, int n, WrWrap wrap)
{
    if (wrap == WR_WRAP_PERIODIC) return (Span){ from, count, 0 };
    int first = clamp_index(from, 0, n - 1), last = clamp_index(from + count - 1, 0, n - 1);
    return (Span){ first, last - first + 1, clamp_index(first - from, 0, count - 1) };
}

void wr_op_read(const WrField *field, int i, int j, int count_i, int count_j, float *out,
                size_t pitch)
{
    Span u = span_inside(i, count_i, wr_field_width(field), wr_field_wrap_u(field));
    Span v = span_inside(j, count_j, wr_field_height(field), wr_field_wrap_v(field));
    wr_field_read(field, u.from, v.from, u.count, v.count, out + (size_t)v.at * pitch + u.at,
                  pitch);
    for (int y = v.at; y < v.at + v.count; y++) {
        float *row = out + (size_t)y * pitch;
        int end = u.at + u.count;
        for (int x = 0; x < u.at; x++) row[x] = row[u.at];
        for (int x = end; x < count_i; x++) row[x] = row[end - 1];
    }
    for (int y = 0; y < count_j; y++) {
        int from = clamp_index(y, v.at, v.at + v.count - 1);
        if (from != y)
            memcpy(out + (size_t)y * pitch, out + (size_t)from * pitch,
                   sizeof *out * (size_t)count_i);
    }
}

bool wr_op_plane_init(WrOpPlane *plane, const WrOpJob *job)
{
    int width = wr_field_width(job->in), height = wr_field_height(job->in);
    size_t pitch = ((size_t)width + 4 + 15) / 16 * 16 + 16;
    if (!wr_op_step(job, 0.0)) return false;
    float *block = wr_try_alloc_unset(pitch * (size_t)height, sizeof *block, job->name, job->err);
    if (!block) return false;
    for (int y = 0; y < height; y++) { /* vector code also computes on the padding between rows */
        /* the system clears each page when it is first written: seconds for the largest tables */
        if (y % ROWS == 0 && wr_progress_cancelled(job->progress)) {
            wr_free(block);
            return wr_fail(job->err, "%s: cancelled", job->name);
        }
        float *row = block + pitch * (size_t)y;
        memset(row, 0, 2 * sizeof *row);
        memset(row + 2 + width, 0, (pitch - 2 - (size_t)width) * sizeof *row);
    }
    *plane = (WrOpPlane){ block, block + 2, pitch, width, height };
    return true;
}

void wr_op_plane_fini(WrOpPlane *plane)
{
    wr_free(plane->block);
    *plane = (WrOpPlane){ 0 };
}

/* ---- blocks to recompute after a partial change ---- */

#define ACROSS (WR_OP_SIDE / WR_TILE) /* tiles along a block's side */

/* The blocks that may differ from the previous result: those within `reach` of a changed texel. The caller frees them. */
static WrOpBlock *op_changed_blocks(const WrOpJob *job, int reach, int *count)
{
    WrFieldRect *rects;
    const WrFieldChange change = { job->was, job->in };
    *count = wr_changed_blocks(&change, 1, reach, &rects);
    WrOpBlock *blocks = wr_alloc((size_t)*count + 1, sizeof *blocks);
    for (int k = 0; k < *count; k++)
        blocks[k] = (WrOpBlock){ rects[k].i0, rects[k].j0, rects[k].i1 - rects[k].i0,
                                 rects[k].j1 - rects[k].j0, false };
    wr_free(rects);
    return blocks;
}

/* ---- the builder ---- */

/* Builds a table from blocks of new heights. The blocks of a batch are computed in parallel. A thread
   processes several blocks of one column, since a filter can reuse rows read for the block above.
   Changed tiles are allocated at once but inserted into the table sequentially, since that may copy
   nodes of the tree. The choice of batches never affects a height. */

#define SIDE WR_OP_SIDE
#define BATCH 128 /* blocks between two reports */
#define TALL 8    /* maximum number of blocks in a column */
#define BLOCK_TILES (ACROSS * ACROSS)

/* Buffers of a thread. */
typedef struct Bench {
    float now[SIDE * SIDE], before[SIDE * SIDE], mask[SIDE * SIDE];
} Bench;

typedef struct Build {
    const WrOpJob *job;
    const WrOpWork *work;
    WrField *out;
    const WrField *base; /* content of unchanged parts; `out` itself, except for partial updates */
    bool same;           /* base is the input */
    bool blends;         /* base is a share of the input: the mask applies */
    WrOpBlock *blocks;   /* [count], the blocks to compute again; NULL: all */
    int count, first;    /* number of blocks, some without texels; first of the present batch */
    int blocks_u, tall;  /* across the table; blocks of a piece of work */
    Bench *bench;        /* [threads] */
    char *scratch;       /* [threads][scratch_pitch] */
    size_t scratch_pitch;
    float *tile[BATCH][BLOCK_TILES]; /* new tiles; NULL: unchanged */
} Build;

static int min_int(int a, int b)
{
    return a < b ? a : b;
}

/* Blocks are numbered down a column, column after column; those below the table have no texels. */
static WrOpBlock block_at(const Build *build, int index)
{
    if (build->blocks) return build->blocks[index];
    const int stack = index / build->tall, below = index % build->tall;
    const int i = stack % build->blocks_u * SIDE;
    const int j = (stack / build->blocks_u * build->tall + below) * SIDE;
    return (WrOpBlock){ i, j, min_int(SIDE, wr_field_width(build->out) - i),
                        min_int(SIDE, wr_field_height(build->out) - j), false };
}

/* First and last tile of texels from .. to along an axis of n texels, for a loop over tiles modulo
   their number. */
static void tile_span(int from, int to, int n, WrWrap wrap, int *first, int *last)
{
    int tiles = (n + WR_TILE - 1) / WR_TILE;
    bool all = wrap == WR_WRAP_PERIODIC && (from < 0 || to >= n);
    if (all) { /* all tiles at the seam, for simplicity: the texels on its other side may belong to
                  two tiles */
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

/* True if every tile of `field` around the block is NULL. */
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
    if (block.count_j <= 0 || wr_progress_cancelled(build->job->progress)) return true;
    if (build->blends && mask && wr_field_level(mask) <= 0.0f && is_flat(mask, block, 0))
        return true;
    return build->work->reach >= 0 && is_flat(build->job->in, block, build->work->reach);
}

/* Clamps to float's range. NaN can result only from heights near its ends: no change. */
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

/* Equal heights keep their bits: a filter would turn -0 into 0. */
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

/* The previous content of the block, and its pitch. */
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

/* A rectangle of heights, and its previous content; mask: NULL, or the weight of the change. */
typedef struct Part {
    const float *before, *mask;
    float *now;
    size_t before_pitch;
    int columns, rows;
} Part;

/* Applies mask and range to the new heights. True if any of them changed. */
static bool finish_part(const Build *build, const Part *part)
{
    bool changed = false;
    if (!part->mask && !build->work->moves)
        return wr_taps()->settle(part->before, part->before_pitch, part->now, SIDE, part->columns,
                                 part->rows);
    for (int y = 0; y < part->rows; y++) {
        const float *before = part->before + (size_t)y * part->before_pitch;
        float *now = part->now + y * SIDE;
        keep_finite(before, now, part->columns);
        if (part->mask) blend(part->mask + y * SIDE, before, now, part->columns);
        if (!build->work->moves) keep_equal(before, now, part->columns);
        changed |= row_differs(before, now, part->columns);
    }
    return changed;
}

/* Unused texels have the level. */
static float *new_tile(const Build *build, const Part *part)
{
    const float level = wr_field_level(build->out);
    float *tile = wr_field_tile_make();
    if (part->rows * part->columns < WR_TILE * WR_TILE)
        for (int k = 0; k < WR_TILE * WR_TILE; k++) tile[k] = level;
    for (int y = 0; y < part->rows; y++)
        if (part->columns == WR_TILE)
            memcpy(tile + y * WR_TILE, part->now + y * SIDE, WR_TILE * sizeof *tile);
        else memcpy(tile + y * WR_TILE, part->now + y * SIDE, (size_t)part->columns * sizeof *tile);
    return tile;
}

static void make_tiles(const Build *build, const WrOpBlock *b, Bench *bench, const float *before,
                       size_t pitch, float **tile)
{
    const bool masked = build->blends && build->job->mask;
    for (int t = 0; t < BLOCK_TILES; t++) {
        const int x = t % ACROSS * WR_TILE, y = t / ACROSS * WR_TILE;
        if (x >= b->count_i || y >= b->count_j) continue;
        const Part part = { .before = before + (size_t)y * pitch + x,
                            .mask = masked ? bench->mask + y * SIDE + x : NULL,
                            .now = bench->now + y * SIDE + x,
                            .before_pitch = pitch,
                            .columns = min_int(WR_TILE, b->count_i - x),
                            .rows = min_int(WR_TILE, b->count_j - y) };
        if (finish_part(build, &part)) tile[t] = new_tile(build, &part);
    }
}

/* False if there was nothing to do. */
static bool make_block(const Build *build, WrOpBlock b, int worker, float **tile)
{
    const WrOpWork *work = build->work;
    Bench *bench = &build->bench[worker];
    char *scratch = build->scratch + (size_t)worker * build->scratch_pitch;
    if (nothing_to_do(build, b)) return false;
    work->make(build->job, work->ctx, b, bench->now, SIDE, scratch);
    size_t pitch;
    const float *before = read_before(build, &b, scratch, bench, &pitch);
    if (build->blends && build->job->mask)
        wr_field_read(build->job->mask, b.i, b.j, b.count_i, b.count_j, bench->mask, SIDE);
    make_tiles(build, &b, bench, before, pitch, tile);
    return true;
}

static void make_stack(int index, int worker, void *ctx)
{
    Build *build = ctx;
    bool follows = false;
    for (int k = index * build->tall; k < (index + 1) * build->tall; k++) {
        WrOpBlock b = block_at(build, build->first + k);
        b.follows = follows;
        follows = make_block(build, b, worker, build->tile[k]);
    }
}

/* The recomputed tile may now be equal to the base's. */
static void put_base(Build *build, WrOpBlock b, int t)
{
    int x = t % ACROSS, y = t / ACROSS, tx = b.i / WR_TILE + x, ty = b.j / WR_TILE + y;
    if (build->out == build->base || x * WR_TILE >= b.count_i || y * WR_TILE >= b.count_j) return;
    if (wr_field_tile(build->out, tx, ty) != wr_field_tile(build->base, tx, ty))
        wr_field_tile_share(build->out, build->base, tx, ty);
}

static void put_tiles(Build *build, int count)
{
    for (int index = 0; index < count; index++) {
        const WrOpBlock b = block_at(build, build->first + index);
        for (int t = 0; t < BLOCK_TILES; t++) {
            float *tile = build->tile[index][t];
            if (tile)
                wr_field_tile_put(build->out, b.i / WR_TILE + t % ACROSS,
                                  b.j / WR_TILE + t / ACROSS, tile);
            else put_base(build, b, t);
        }
    }
}

static bool run_batches(Build *build)
{
    const int count = build->count;
    if (!wr_op_step(build->job, 0.0)) return false;
    for (int first = 0; first < count; first += BATCH) {
        int blocks = min_int(BATCH, count - first);
        build->first = first;
        /* pieces that a cancellation skips leave no tile of the last batch behind */
        memset(build->tile, 0, sizeof build->tile);
        wr_pool_run(build->job->pool, blocks / build->tall, make_stack, build);
        put_tiles(build, blocks);
        if (wr_progress_cancelled(build->job->progress))
            return wr_fail(build->job->err, "%s: cancelled", build->job->name);
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
    return wr_field_alike(a, b) && memcmp(&x, &y, sizeof x) == 0;
}

/* Several columns for each thread, so that none waits for long. */
static int stack_height(int blocks, int threads)
{
    int tall = TALL;
    while (tall > 1 && blocks < 4 * threads * tall) tall /= 2;
    return tall;
}

/* Lists the blocks, and selects the table that they are written to. */
static void plan_blocks(Build *build, WrField *base)
{
    const WrOpJob *job = build->job;
    const int window = build->work->window;
    const int blocks_v = (wr_field_height(base) + SIDE - 1) / SIDE;
    build->blocks_u = (wr_field_width(base) + SIDE - 1) / SIDE;
    build->base = build->out = base;
    if (!job->was || window == 0 || !same_shape(job->was, job->in) ||
        !same_shape(job->made, base)) {
        build->tall = stack_height(build->blocks_u * blocks_v, wr_pool_threads(job->pool));
        build->count = build->blocks_u * ((blocks_v + build->tall - 1) / build->tall) * build->tall;
        return;
    }
    build->tall = 1;
    build->blocks = op_changed_blocks(job, window / 2, &build->count);
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
    build->bench = wr_try_alloc_unset(threads, sizeof *build->bench, job->name, job->err);
    if (build->bench)
        build->scratch = wr_try_alloc_unset(threads, build->scratch_pitch, job->name, job->err);
    bool good = build->scratch && run_batches(build);
    WrField *out = build->out;
    if (out != base) wr_field_free(base);
    wr_free(build->blocks);
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
