#include "field/measure.h"

#include "base/exactmath.h"
#include "base/progress.h"
#include "field/derivatives.h"
#include "field/field.h"
#include "field/maps.h"
#include "field/ops.h"
#include "field/scheme_list.h"
#include "field/select_internal.h"

#include <math.h>

/* ---- convexity and sky: maps (maps.h) in units of texels, row by row ---- */

typedef struct MapRows {
    WrFieldMapKind kind;
    WrMapJob job;
    double scale; /* multiple of the map */
} MapRows;

static WrMapJob job_of(const WrField *field, double relief)
{
    const WrDerivatives ground = { .field = field,
                                   .scheme = WR_SCHEME_CENTRAL,
                                   .height = relief,
                                   .cell_w = wr_field_width(field),
                                   .cell_h = wr_field_height(field) };
    return wr_map_default(&ground);
}

static bool map_rows(void *ctx, int worker, int j, int rows, float *out)
{
    (void)worker;
    const MapRows *m = ctx;
    const int width = wr_field_width(m->job.ground.field);
    const WrMapPart part = { 0, j, width, rows, (size_t)width };
    if (!wr_map_make(m->kind, &m->job, &part, NULL, out, NULL, NULL)) return false;
    for (size_t i = 0; i < (size_t)rows * (size_t)width && m->scale != 1.0; i++)
        out[i] = (float)(m->scale * (double)out[i]);
    return true;
}

WrField *wr_measure_convexity(const WrField *field, double relief, double scale, WrPool *pool,
                              WrError *err)
{
    const WrOpOptions options = { .pool = pool, .progress = wr_progress_here() };
    WrField *blurred = wr_op_run(wr_op_find("blur"), field, &scale, &options, err);
    if (!blurred) return NULL;
    MapRows m = { WR_FIELD_MAP_CURVATURE, job_of(blurred, relief), scale };
    WrField *made = wr_select_from_rows(field, 0.0f, map_rows, &m, pool, wr_progress_here(), err);
    wr_field_free(blurred);
    return made;
}

WrField *wr_measure_sky(const WrField *field, double relief, int reach, WrPool *pool, WrError *err)
{
    MapRows m = { WR_FIELD_MAP_OCCLUSION, job_of(field, relief), 1.0 };
    m.job.reach = reach;
    return wr_select_from_rows(field, 1.0f, map_rows, &m, pool, wr_progress_here(), err);
}

/* ---- joins ---- */

typedef struct Joining {
    const WrField *a, *b;
    WrJoin join;
} Joining;

static float join_one(WrJoin join, float a, float b)
{
    switch (join) {
    case WR_JOIN_MULTIPLY: return a * b;
    case WR_JOIN_SUBTRACT: return a > b ? a - b : 0.0f;
    case WR_JOIN_MAX: return a > b ? a : b;
    case WR_JOIN_ADD: break;
    }
    return a + b;
}

static bool join_rows(void *ctx, int worker, int j, int rows, float *out)
{
    (void)worker;
    const Joining *joining = ctx;
    const int width = wr_field_width(joining->a);
    float b[WR_TILE];
    for (int y = 0; y < rows; y++)
        for (int i = 0; i < width; i += WR_TILE) {
            const int count = width - i < WR_TILE ? width - i : WR_TILE;
            float *a = out + (size_t)y * (size_t)width + (size_t)i;
            wr_field_read(joining->a, i, j + y, count, 1, a, WR_TILE);
            wr_field_read(joining->b, i, j + y, count, 1, b, WR_TILE);
            for (int k = 0; k < count; k++) a[k] = join_one(joining->join, a[k], b[k]);
        }
    return true;
}

WrField *wr_measure_join(const WrField *a, const WrField *b, WrJoin join, WrPool *pool,
                         WrError *err)
{
    Joining joining = { a, b, join };
    const float level = join_one(join, wr_field_level(a), wr_field_level(b));
    return wr_select_from_rows(a, level, join_rows, &joining, pool, wr_progress_here(), err);
}
