/* What a generator made joins a layer. */
#include "command/generate.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "document/blend.h"
#include "document/document.h"
#include "document/edit.h"
#include "field/field.h"
#include "generate/generator.h"

#include <float.h>
#include <string.h>

#define TEXELS (WR_TILE * WR_TILE)

typedef struct Joining {
    WrBlend blend;
    float radius;
    double offset;
    const WrField *heights, *weight; /* weight NULL: 1 everywhere */
    WrField *layer;
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

/* A tile that comes out as it was stays the very tile. */
static void join_tile(const Joining *join, int tx, int ty)
{
    if (join->weight && is_nothing(join->weight, tx, ty)) return;
    float heights[TEXELS], result[TEXELS];
    const float *made = wr_field_tile(join->heights, tx, ty);
    const float *old = wr_field_tile(join->layer, tx, ty);
    float level = wr_field_level(join->heights), old_level = wr_field_level(join->layer);
    for (int i = 0; i < TEXELS; i++) {
        heights[i] = bounded((double)(made ? made[i] : level) + join->offset);
        result[i] = old ? old[i] : old_level;
    }
    WrBlendTile tile = { .heights = heights, .cover_level = 1.0f, .mask_level = 1.0f };
    if (join->weight) {
        tile.mask = wr_field_tile(join->weight, tx, ty);
        tile.mask_level = wr_field_level(join->weight);
    }
    wr_blend_tile(join->blend, 1.0f, join->radius, &tile, TEXELS, result);
    int columns = wr_field_width(join->layer) - tx * WR_TILE;
    int rows = wr_field_height(join->layer) - ty * WR_TILE;
    columns = columns < WR_TILE ? columns : WR_TILE;
    rows = rows < WR_TILE ? rows : WR_TILE;
    float *out = NULL;
    for (int y = 0; y < rows; y++) {
        const float *row = result + y * WR_TILE;
        for (int x = 0; x < columns && !out; x++) {
            float was = old ? old[y * WR_TILE + x] : old_level;
            if (memcmp(&row[x], &was, sizeof was) != 0)
                out = wr_field_tile_write(join->layer, tx, ty);
        }
        if (out) memcpy(out + y * WR_TILE, row, (size_t)columns * sizeof *row);
    }
}

static bool join_all(const Joining *join, const WrProgress *progress, WrError *err)
{
    for (int ty = 0; ty < wr_field_tiles_v(join->layer); ty++) {
        if (!wr_progress_step(progress, (double)ty / wr_field_tiles_v(join->layer)))
            return wr_fail(err, "cancelled");
        for (int tx = 0; tx < wr_field_tiles_u(join->layer); tx++) join_tile(join, tx, ty);
    }
    return true;
}

/* Where and how much it acts: coverage times selection. A new field, or NULL for everywhere. */
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
                  WrLayer *layer, const WrProgress *progress, WrError *err)
{
    const WrGenerator *generator = wr_call_generator(call);
    WrField *weight = weight_of(relief->cover, selection);
    Joining joining = {
        .blend = (WrBlend)wr_call_choice(call, wr_generator_argument(generator, "blend")),
        .radius = (float)wr_call_number(call, wr_generator_argument(generator, "radius")),
        .offset = wr_call_number(call, wr_generator_argument(generator, "offset")),
        .heights = relief->heights,
        .weight = weight,
        .layer = layer->heights,
    };
    bool good = join_all(&joining, progress, err);
    if (good) wr_edit_mark(layer->cover, weight);
    wr_field_free(weight);
    return good;
}
