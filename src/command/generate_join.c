/* Blending of a generator's output into a layer. */
#include "command/generate.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "document/blend.h"
#include "document/document.h"
#include "document/edit.h"
#include "field/field.h"
#include "generate/generator.h"

#include <float.h>
#include <stdint.h>
#include <string.h>

#define TEXELS (WR_TILE * WR_TILE)

#define BATCH 64 /* tiles processed in one parallel step */

/* Result of a layer tile. */
typedef enum Fate {
    STAYS,
    SHARED, /* shares the generated tile by reference */
    JOINED
} Fate;

typedef struct Joining {
    WrBlend blend;
    float radius;
    double offset;
    const WrField *heights, *weight; /* weight NULL: 1 everywhere */
    WrField *layer;
    WrPool *pool;
    int first; /* index of the batch's first tile */
    Fate fate[BATCH];
    float *out[BATCH];       /* output tiles */
    float (*result)[TEXELS]; /* [BATCH] */
} Joining;

static float bounded(double x)
{
    return x > FLT_MAX ? FLT_MAX : x < -FLT_MAX ? -FLT_MAX : (float)x;
}

static float unit(float x)
{
    return x > 0.0f ? x < 1.0f ? x : 1.0f : 0.0f;
}

static bool is_nothing(const WrField *weight, int tx, int ty)
{
    const float *tile = wr_field_tile(weight, tx, ty);
    if (!tile) return !(wr_field_level(weight) > 0.0f);
    for (int i = 0; i < TEXELS; i++)
        if (tile[i] > 0.0f) return false;
    return true;
}

typedef struct Place {
    int tx, ty;
    int columns, rows; /* part of a border tile inside the table */
} Place;

static Place place_of(const Joining *join, int index)
{
    int tiles_u = wr_field_tiles_u(join->layer), at = join->first + index;
    Place p = { .tx = at % tiles_u, .ty = at / tiles_u };
    int columns = wr_field_width(join->layer) - p.tx * WR_TILE;
    int rows = wr_field_height(join->layer) - p.ty * WR_TILE;
    p.columns = columns < WR_TILE ? columns : WR_TILE;
    p.rows = rows < WR_TILE ? rows : WR_TILE;
    return p;
}

/* Generated heights plus the base height; never -0. */
static void lift(const Joining *join, const Place *p, float *heights)
{
    const float *made = wr_field_tile(join->heights, p->tx, p->ty);
    float level = wr_field_level(join->heights);
    double offset = join->offset;
    for (int i = 0; i < TEXELS; i++)
        heights[i] = bounded((double)(made ? made[i] : level) + offset);
}

static void blend_tile(const Joining *join, const Place *p, const float *old, float *result)
{
    float heights[TEXELS], old_level = wr_field_level(join->layer);
    lift(join, p, heights);
    for (int i = 0; i < TEXELS; i++) result[i] = old ? old[i] : old_level;
    WrBlendTile tile = { .heights = heights, .cover_level = 1.0f, .mask_level = 1.0f };
    if (join->weight) {
        tile.mask = wr_field_tile(join->weight, p->tx, p->ty);
        tile.mask_level = wr_field_level(join->weight);
    }
    wr_blend_tile(join->blend, 1.0f, join->radius, &tile, TEXELS, result);
}

static bool differs(const Joining *join, const Place *p, const float *old, const float *result)
{
    float level[WR_TILE];
    for (int x = 0; x < WR_TILE; x++) level[x] = wr_field_level(join->layer);
    for (int y = 0; y < p->rows; y++)
        if (memcmp(result + y * WR_TILE, old ? old + y * WR_TILE : level,
                   (size_t)p->columns * sizeof *result) != 0)
            return true;
    return false;
}

/* True if the result equals the generated tile, so that it can be shared: it replaces the old one, and no height is
 * -0, which would become 0. */
static bool is_result(const Joining *join, const float *made)
{
    if (!made || join->weight || join->offset != 0.0 ||
        (join->blend != WR_BLEND_REPLACE && join->blend != WR_BLEND_MIX))
        return false;
    int minus = 0;
#pragma omp simd reduction(| : minus)
    for (int i = 0; i < TEXELS; i++) {
        int32_t bits;
        memcpy(&bits, &made[i], sizeof bits);
        minus |= bits == INT32_MIN;
    }
    return !minus;
}

/* Unchanged tiles stay shared with the old layer. */
static void judge_tile(int index, int worker, void *ctx)
{
    (void)worker;
    Joining *join = ctx;
    Place p = place_of(join, index);
    const float *made = wr_field_tile(join->heights, p.tx, p.ty);
    const float *old = wr_field_tile(join->layer, p.tx, p.ty);
    join->fate[index] = STAYS;
    if (join->weight && is_nothing(join->weight, p.tx, p.ty)) return;
    bool itself = is_result(join, made);
    if (!itself) blend_tile(join, &p, old, join->result[index]);
    if (differs(join, &p, old, itself ? made : join->result[index]))
        join->fate[index] = itself ? SHARED : JOINED;
}

static void write_tile(int index, int worker, void *ctx)
{
    (void)worker;
    const Joining *join = ctx;
    Place p = place_of(join, index);
    for (int y = 0; y < p.rows && join->out[index]; y++)
        memcpy(join->out[index] + y * WR_TILE, join->result[index] + y * WR_TILE,
               (size_t)p.columns * sizeof(float));
}

/* Serial: only this thread may change the tree of tiles. */
static void fetch_tiles(Joining *join, int count)
{
    for (int k = 0; k < count; k++) {
        Place p = place_of(join, k);
        bool whole = p.columns == WR_TILE && p.rows == WR_TILE;
        join->out[k] = NULL;
        if (join->fate[k] == SHARED) wr_field_tile_share(join->layer, join->heights, p.tx, p.ty);
        if (join->fate[k] == JOINED)
            join->out[k] =
                (whole ? wr_field_tile_fresh : wr_field_tile_write)(join->layer, p.tx, p.ty);
    }
}

static bool join_all(Joining *join, const WrProgress *progress, WrError *err)
{
    int tiles = wr_field_tiles_u(join->layer) * wr_field_tiles_v(join->layer);
    for (join->first = 0; join->first < tiles; join->first += BATCH) {
        if (!wr_progress_step(progress, (double)join->first / tiles))
            return wr_fail(err, "cancelled");
        int count = tiles - join->first < BATCH ? tiles - join->first : BATCH;
        if (!wr_pool_run(join->pool, count, judge_tile, join)) return wr_fail(err, "cancelled");
        fetch_tiles(join, count);
        if (!wr_pool_run(join->pool, count, write_tile, join)) return wr_fail(err, "cancelled");
    }
    return true;
}

/* Blend weight: coverage times selection. A new field, or NULL for 1 everywhere. */
static WrField *weight_of(const WrField *cover, const WrField *selection)
{
    if (!cover && !selection) return NULL;
    if (!cover || !selection) return wr_field_share(cover ? cover : selection);
    WrField *weight = wr_field_share(cover);
    float *row = wr_alloc((size_t)wr_field_width(cover), 2 * sizeof *row);
    int width = wr_field_width(cover);
    for (int j = 0; j < wr_field_height(cover) && !wr_progress_stopped(); j++) {
        wr_field_read(cover, 0, j, width, 1, row, (size_t)width);
        wr_field_read(selection, 0, j, width, 1, row + width, (size_t)width);
        for (int i = 0; i < width; i++) row[i] = unit(row[i]) * unit(row[width + i]);
        wr_field_write(weight, 0, j, width, 1, row, (size_t)width);
    }
    wr_free(row);
    return weight;
}

bool wr_call_join(const WrCall *call, const WrRelief *relief, const WrField *selection,
                  WrLayer *layer, WrPool *pool, const WrProgress *progress, WrError *err)
{
    float(*result)[TEXELS] = wr_try_alloc(BATCH, sizeof *result, "tiles to be joined", err);
    if (!result) return false;
    const WrGenerator *generator = wr_call_generator(call);
    WrField *weight =
        weight_of(relief->cover, wr_family_find(generator->family)->beyond ? NULL : selection);
    Joining joining = {
        .blend = (WrBlend)wr_call_choice(call, wr_generator_argument(generator, "blend")),
        .radius = (float)wr_call_number(call, wr_generator_argument(generator, "radius")),
        .offset = wr_call_number(call, wr_generator_argument(generator, "offset")),
        .heights = relief->heights,
        .weight = weight,
        .layer = layer->heights,
        .pool = pool,
        .result = result,
    };
    bool good = join_all(&joining, progress, err);
    if (good) wr_edit_mark(layer->cover, weight);
    wr_field_free(weight);
    wr_free(result);
    return good;
}
