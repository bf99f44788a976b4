#include "generate/tile_builder.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "field/field.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>

#define BATCH 64 /* tiles between two reports */
#define TEXELS (WR_TILE * WR_TILE)

/* One field's tiles of a batch: their buffers, and the tiles that are +0 throughout. */
typedef struct Made {
    WrField *field;
    float *tile[BATCH];
    bool empty[BATCH];
} Made;

typedef struct Build {
    WrGenerateFill fill;
    const void *ctx;
    const WrProgress *progress;
    int *tile; /* [tiles] the wanted tiles, tx + ty tiles_u */
    int tiles, tiles_u, first;
    Made made[2]; /* heights, cover; no field: absent */
} Build;

static WrGenerateBlock block_at(const Build *build, int tile)
{
    const WrField *field = build->made[0].field;
    WrGenerateBlock b = { .width = wr_field_width(field), .height = wr_field_height(field) };
    b.i = tile % build->tiles_u * WR_TILE;
    b.j = tile / build->tiles_u * WR_TILE;
    b.count_i = b.width - b.i < WR_TILE ? b.width - b.i : WR_TILE;
    b.count_j = b.height - b.j < WR_TILE ? b.height - b.j : WR_TILE;
    return b;
}

static void mend(float *texels)
{
    for (int k = 0; k < TEXELS; k++) {
        float h = texels[k];
        h = h > FLT_MAX ? FLT_MAX : h < -FLT_MAX ? -FLT_MAX : h;
        texels[k] = h == h ? h : 0.0f;
    }
}

/* True if all are +0. One pass without branches for the usual case: OR of all bits, and of all-ones exponents (infinity and
   NaN). */
static bool keep_finite(float *texels)
{
    uint32_t bits = 0, beyond = 0;
#pragma omp simd reduction(| : bits, beyond)
    for (int k = 0; k < TEXELS; k++) {
        uint32_t word;
        memcpy(&word, &texels[k], sizeof word);
        bits |= word;
        beyond |= (word & 0x7f800000U) == 0x7f800000U;
    }
    if (!beyond) return bits == 0;
    mend(texels);
    for (int k = 0; k < TEXELS; k++)
        if (texels[k] != 0.0f || signbit(texels[k])) return false;
    return true;
}

static void make_tile(int index, int worker, void *ctx)
{
    Build *build = ctx;
    if (wr_progress_cancelled(build->progress)) return;
    WrGenerateBlock b = block_at(build, build->tile[build->first + index]);
    for (int k = 0; k < 2 && build->made[k].field; k++)
        memset(build->made[k].tile[index], 0, sizeof(float) * TEXELS);
    build->fill(build->ctx, &b, worker, build->made[0].tile[index],
                build->made[1].field ? build->made[1].tile[index] : NULL);
    for (int k = 0; k < 2 && build->made[k].field; k++)
        build->made[k].empty[index] = keep_finite(build->made[k].tile[index]);
}

/* Tiles are computed in their final memory; those that are +0 throughout are freed. A tile's memory is allocated before the
   threads start, since writing the field's tree is for one thread only; each thread then fills tiles of its own. */
static bool run_batch(Build *build, WrPool *pool, int count)
{
    const int u = build->tiles_u, *tile = build->tile + build->first;
    for (int n = 0; n < 2 && build->made[n].field; n++)
        for (int k = 0; k < count; k++)
            build->made[n].tile[k] =
                wr_field_tile_fresh(build->made[n].field, tile[k] % u, tile[k] / u);
    if (!wr_pool_run(pool, count, make_tile, build) || wr_progress_cancelled(build->progress))
        return false;
    for (int n = 0; n < 2 && build->made[n].field; n++)
        for (int k = 0; k < count; k++)
            if (build->made[n].empty[k])
                wr_field_tile_drop(build->made[n].field, tile[k] % u, tile[k] / u);
    return true;
}

static bool run_batches(Build *build, WrPool *pool, double from)
{
    for (build->first = 0; build->first < build->tiles; build->first += BATCH) {
        const int left = build->tiles - build->first;
        double done = (double)build->first / build->tiles;
        if (!wr_progress_step(build->progress, from + (1.0 - from) * done)) return false;
        if (!run_batch(build, pool, left < BATCH ? left : BATCH)) return false;
    }
    return wr_progress_step(build->progress, 1.0);
}

static bool run(Build *build, const WrGenerateJob *job, double from)
{
    const WrField *field = build->made[0].field;
    const int all = wr_field_tiles_u(field) * wr_field_tiles_v(field);
    build->tiles_u = wr_field_tiles_u(field);
    build->tile = wr_alloc((size_t)all, sizeof *build->tile);
    for (int k = 0; k < all; k++)
        if (!job->wanted || job->wanted[k]) build->tile[build->tiles++] = k;
    const bool good = run_batches(build, job->pool, from);
    wr_free(build->tile);
    return good;
}

static WrField *empty_like(const WrField *like, WrError *err)
{
    return wr_field_new(wr_field_width(like), wr_field_height(like), wr_field_wrap_u(like),
                        wr_field_wrap_v(like), 0.0f, err);
}

bool wr_generate_build(const WrGenerateJob *job, WrGenerateFill fill, const void *ctx, bool covered,
                       double from, WrRelief *out, WrError *err)
{
    WrRelief relief = { empty_like(job->like, err), NULL };
    if (relief.heights && covered) relief.cover = empty_like(job->like, err);
    Build build = { .fill = fill,
                    .ctx = ctx,
                    .progress = job->progress,
                    .made = { { .field = relief.heights }, { .field = relief.cover } } };
    bool good = relief.heights && (!covered || relief.cover);
    if (good) good = run(&build, job, from) || wr_fail(err, "cancelled");
    if (good) *out = relief;
    else wr_relief_fini(&relief);
    return good;
}

void wr_generate_note(const WrGenerateJob *job, const char *format, ...)
{
    if (!job->note) return;
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    job->note(job->note_ctx, text);
}
