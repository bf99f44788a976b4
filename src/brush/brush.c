#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "brush/coverage.h"
#include "brush/paint.h"
#include "field/field.h"

#include <stdalign.h>

WrBrush wr_brush_default(void)
{
    return (WrBrush){ .radius = 16.0,
                      .hardness = 0.5,
                      .strength = 0.1,
                      .mode = WR_BRUSH_RAISE,
                      .opacity = 1.0,
                      .flow = 1.0,
                      .aspect = 1.0 };
}

double wr_brush_coverage(const WrBrush *brush, double d)
{
    WrBrush sane = wr_brush_sane(brush);
    if (!(sane.radius > wr_brush_inner(&sane))) return d < sane.radius ? 1.0 : 0.0;
    WrCapsule dab = wr_capsule(&sane, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0);
    float cover[WR_BRUSH_BLOCK];
    wr_brush_kernels()->dab(&dab, 0.0, d, WR_BRUSH_BLOCK, cover);
    return cover[0];
}

static void dab_by_stroke(const WrBrushGround *ground, const WrBrush *brush, double u, double v)
{
    WrStroke *stroke = wr_stroke_new_on(ground, brush);
    wr_stroke_add(stroke, (WrSample){ .u = u, .v = v, .pressure = 1.0 });
    wr_stroke_finish(stroke);
}

void wr_brush_dab_on(const WrBrushGround *ground, const WrBrush *brush, double u, double v)
{
    WrBrush sane = wr_brush_sane(brush);
    double x, y;
    if (ground->mark || ground->selection || !wr_paint_is_plain(&sane))
        dab_by_stroke(ground, brush, u, v);
    else if (wr_paint_place(ground->field, u, v, &x, &y)) wr_paint_dab(ground->field, &sane, x, y);
}

void wr_brush_dab(WrField *field, const WrBrush *brush, double u, double v)
{
    wr_brush_dab_on(&(WrBrushGround){ .field = field }, brush, u, v);
}

/* Tiles of a shape in one row of tiles, for several threads. */
typedef struct Filling {
    const WrStrokeResolver *maker;
    WrStrokeResolve makes[WR_FIELD_MAX / WR_TILE];
    int count;
} Filling;

static void fill_one(int index, int worker, void *ctx)
{
    (void)worker;
    const Filling *filling = ctx;
    WrStrokeResolve make = filling->makes[index];
    const WrStrokeResolver *maker = filling->maker;
    /* whole blocks; texels beyond the table's edge get no coverage */
    float *inside = NULL, *target = NULL;
    if (make.count % WR_BRUSH_BLOCK) {
        inside = wr_alloc(WR_TILE * WR_TILE, sizeof *inside);
        for (int y = 0; y <= make.high_y; y++)
            for (int x = 0; x < make.count; x++)
                inside[y * WR_TILE + x] = make.cover[y * WR_TILE + x];
        make.cover = inside;
        make.count = (make.count / WR_BRUSH_BLOCK + 1) * WR_BRUSH_BLOCK;
    }
    if (maker->targets.kind != WR_BLEND_TARGET_NONE) {
        target = wr_alloc(WR_TILE * WR_TILE, sizeof *target);
        wr_targets_compute_tile(&maker->targets, make.tx, make.ty, target);
        make.target = target;
    }
    wr_stroke_resolve(maker, &make);
    wr_free(target);
    wr_free(inside);
}

/* flat: [WR_TILE * WR_TILE] of the coverage's level */
static void fill_row(Filling *filling, const WrField *coverage, int ty, const float *flat)
{
    const WrStrokeResolver *maker = filling->maker;
    filling->count = 0;
    for (int tx = 0; tx < wr_field_tiles_u(coverage); tx++) {
        const float *cover = wr_field_tile(coverage, tx, ty);
        int width = wr_field_width(coverage) - tx * WR_TILE;
        int height = wr_field_height(coverage) - ty * WR_TILE;
        WrStrokeResolve make = { .tx = tx,
                                 .ty = ty,
                                 .high_y = (height < WR_TILE ? height : WR_TILE) - 1,
                                 .count = width < WR_TILE ? width : WR_TILE,
                                 .cover = cover ? cover : flat };
        if (!wr_stroke_resolve_needed(maker, &make)) continue;
        wr_stroke_resolve_open(maker, &make);
        filling->makes[filling->count++] = make;
    }
    wr_pool_run(filling->count > 4 ? maker->ground.pool : NULL, filling->count, fill_one, filling);
}

bool wr_brush_fill(const WrBrushGround *ground, const WrBrush *brush, const WrField *coverage,
                   double first_u, double first_v, WrError *err)
{
    WrBrush sane = wr_brush_sane(brush);
    if (!wr_mode_work(sane.mode)->cover)
        return wr_fail(
            err,
            "mode=%s: moves heights along the path, so it cannot fill a shape: choose another mode",
            wr_brush_modes[sane.mode].name);
    if (wr_field_width(coverage) != wr_field_width(ground->field) ||
        wr_field_height(coverage) != wr_field_height(ground->field))
        return wr_fail(err, "a shape of %dx%d: must be of the table's size, %dx%d",
                       wr_field_width(coverage), wr_field_height(coverage),
                       wr_field_width(ground->field), wr_field_height(ground->field));
    if (sane.strength == 0.0 && wr_mode_work(sane.mode)->as_strong) return true;
    sane.buildup = false; /* applied once */
    WrStrokeResolver maker;
    wr_stroke_resolver_init(&maker, ground, &sane);
    double x, y;
    if (wr_paint_place(ground->field, first_u, first_v, &x, &y))
        wr_stroke_resolver_set_flatten_height(&maker, x, y);
    float *flat = wr_alloc(WR_TILE * WR_TILE, sizeof *flat);
    for (int k = 0; k < WR_TILE * WR_TILE; k++) flat[k] = wr_field_level(coverage);
    Filling *filling = wr_alloc(1, sizeof *filling);
    filling->maker = &maker;
    bool good = true;
    int rows = wr_field_tiles_v(coverage);
    for (int ty = 0; good && ty < rows; ty++) {
        good = wr_progress_step(ground->progress, (double)ty / rows);
        if (good) fill_row(filling, coverage, ty, flat);
    }
    wr_free(filling);
    wr_free(flat);
    wr_stroke_resolver_fini(&maker);
    return good || wr_fail(err, "cancelled");
}
