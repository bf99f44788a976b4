#include "generate/build.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "field/field.h"

#include <float.h>
#include <stdarg.h>
#include <string.h>

#define BATCH 64 /* tiles between two reports */
#define TEXELS (WR_TILE * WR_TILE)

typedef struct Build {
    WrGenerateFill fill;
    const void *ctx;
    const WrProgress *progress;
    WrRelief *relief;
    int tiles_u, first;
    float (*heights)[TEXELS]; /* [BATCH] */
    float (*cover)[TEXELS];   /* [BATCH] or NULL */
} Build;

static WrGenerateBlock block_at(const Build *build, int tile)
{
    const WrField *field = build->relief->heights;
    WrGenerateBlock b = { .width = wr_field_width(field), .height = wr_field_height(field) };
    b.i = tile % build->tiles_u * WR_TILE;
    b.j = tile / build->tiles_u * WR_TILE;
    b.count_i = b.width - b.i < WR_TILE ? b.width - b.i : WR_TILE;
    b.count_j = b.height - b.j < WR_TILE ? b.height - b.j : WR_TILE;
    return b;
}

static void keep_finite(const WrGenerateBlock *b, float *texels)
{
    for (int y = 0; y < b->count_j; y++)
        for (int x = 0; x < b->count_i; x++) {
            float h = texels[y * WR_TILE + x];
            h = h > FLT_MAX ? FLT_MAX : h < -FLT_MAX ? -FLT_MAX : h;
            texels[y * WR_TILE + x] = h == h ? h : 0.0f;
        }
}

static void make_tile(int index, int worker, void *ctx)
{
    Build *build = ctx;
    if (wr_progress_cancelled(build->progress)) return;
    WrGenerateBlock b = block_at(build, build->first + index);
    float *heights = build->heights[index], *cover = build->cover ? build->cover[index] : NULL;
    memset(heights, 0, sizeof *build->heights);
    if (cover) memset(cover, 0, sizeof *build->cover);
    build->fill(build->ctx, &b, worker, heights, cover);
    keep_finite(&b, heights);
    if (cover) keep_finite(&b, cover);
}

/* Tiles that are +0 throughout stay without memory. */
static void keep_tile(WrField *field, int tx, int ty, const float *texels)
{
    static const float nothing[TEXELS];
    if (memcmp(texels, nothing, sizeof nothing) == 0) return;
    memcpy(wr_field_tile_write(field, tx, ty), texels, sizeof nothing);
}

static bool run(Build *build, WrPool *pool, int tiles, double from)
{
    for (build->first = 0; build->first < tiles; build->first += BATCH) {
        double done = (double)build->first / tiles;
        if (!wr_progress_step(build->progress, from + (1.0 - from) * done)) return false;
        int count = tiles - build->first < BATCH ? tiles - build->first : BATCH;
        wr_pool_run(pool, count, make_tile, build);
        if (wr_progress_cancelled(build->progress)) return false;
        for (int k = 0; k < count; k++) {
            int tx = (build->first + k) % build->tiles_u, ty = (build->first + k) / build->tiles_u;
            keep_tile(build->relief->heights, tx, ty, build->heights[k]);
            if (build->cover) keep_tile(build->relief->cover, tx, ty, build->cover[k]);
        }
    }
    return wr_progress_step(build->progress, 1.0);
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
    Build build = { .fill = fill, .ctx = ctx, .progress = job->progress, .relief = &relief };
    bool good = relief.heights && (!covered || relief.cover);
    if (good) {
        build.tiles_u = wr_field_tiles_u(relief.heights);
        build.heights = wr_try_alloc(BATCH, sizeof *build.heights, "a generated relief", err);
        if (covered) build.cover = wr_try_alloc(BATCH, sizeof *build.cover, "its coverage", err);
        good = build.heights && (!covered || build.cover);
    }
    if (good && !run(&build, job->pool, build.tiles_u * wr_field_tiles_v(relief.heights), from))
        good = wr_fail(err, "cancelled");
    wr_free(build.heights);
    wr_free(build.cover);
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
