#include "brush/coverage.h"

#include "base/memory.h"
#include "base/pool.h"
#include "field/field.h"
#include "system/clock.h"

#include <math.h>
#include <stdalign.h>

#define MANY_PAGES 64 /* number worth several threads */
#define FEW_PAGES 8   /* between checks of the clock */

void wr_coverage_init(WrCoverage *cover, const WrBrushGround *ground, const WrBrush *brush,
                      WrCoverageRule rule)
{
    *cover = (WrCoverage){ .rule = rule, .tiles_u = wr_field_tiles_u(ground->field) };
    wr_maker_init(&cover->maker, ground, brush);
    size_t tiles = (size_t)cover->tiles_u * (size_t)wr_field_tiles_v(ground->field);
    cover->pages = wr_alloc(tiles, sizeof(WrPage *));
}

void wr_coverage_fini(WrCoverage *cover)
{
    for (int i = 0; i < cover->made.count; i++) {
        wr_free(cover->made.data[i]->rest);
        wr_free(cover->made.data[i]->target);
        wr_free(cover->made.data[i]);
    }
    wr_array_free(&cover->made);
    wr_array_free(&cover->changed);
    wr_array_free(&cover->makes);
    wr_free(cover->pages);
    cover->pages = NULL;
    wr_maker_fini(&cover->maker);
}

static WrPage *page_of(WrCoverage *cover, int tx, int ty)
{
    WrPage **slot = &cover->pages[(size_t)ty * (size_t)cover->tiles_u + (size_t)tx];
    if (!*slot) {
        *slot = wr_alloc(1, sizeof **slot);
        (*slot)->tx = tx;
        (*slot)->ty = ty;
        if (cover->rule == WR_COVERAGE_SUM)
            (*slot)->rest = wr_alloc(WR_TILE * WR_TILE, sizeof(float));
        wr_array_push(&cover->made, *slot);
    }
    return *slot;
}

/* Called for each tile before its texels are covered. */
static bool prepare(void *ctx, int tx, int ty)
{
    WrCoverage *cover = ctx;
    if (wr_maker_closed(&cover->maker, tx, ty)) return false;
    WrPage *page = page_of(cover, tx, ty);
    if (!page->listed) {
        page->listed = true;
        page->low_y = page->low_x = WR_TILE;
        page->high_x = page->high_y = -1;
        wr_array_push(&cover->changed, page);
    }
    return true;
}

static void note(WrPage *page, const WrRun *run)
{
    int y = run->at / WR_TILE, x = run->at % WR_TILE;
    page->low_y = y < page->low_y ? y : page->low_y;
    page->high_y = y > page->high_y ? y : page->high_y;
    page->low_x = x < page->low_x ? x : page->low_x;
    page->high_x = x + run->count > page->high_x ? x + run->count : page->high_x;
}

/* True if the run's texels may gain coverage; then adds it. */
static bool gain(const WrCoverage *cover, WrPage *page, const WrDabShape *shape, const WrRun *run)
{
    const WrBrushKernels *kernels = shape->kernels;
    float *to = page->cover + run->at;
    if (cover->rule == WR_COVERAGE_MAX && !kernels->below(to, (float)shape->strongest, run->count))
        return false;
    if (cover->rule == WR_COVERAGE_OVER && shape->kind == WR_SHAPE_ELLIPSE && !run->head &&
        !run->tail && !shape->ellipse.rounded) {
        kernels->soft_over(&shape->ellipse, run->y, run->x, run->count, to);
        return true;
    }
    alignas(WR_ALIGN) float fresh[WR_TILE];
    wr_run_cover(shape, run, fresh);
    switch (cover->rule) {
    case WR_COVERAGE_MAX:
        if (!kernels->grows(to, fresh, run->count)) return false;
        kernels->join(to, fresh, run->count);
        return true;
    case WR_COVERAGE_OVER: kernels->over(to, fresh, run->count); return true;
    case WR_COVERAGE_SUM: kernels->sum(to, page->rest + run->at, fresh, run->count); return true;
    }
    return false;
}

static void visit(void *ctx, const WrDabShape *shape, const WrScanPatch *patch)
{
    WrCoverage *cover = ctx;
    WrPage *page = cover->pages[(size_t)patch->ty * (size_t)cover->tiles_u + (size_t)patch->tx];
    for (int k = 0; k < patch->count; k++)
        if (gain(cover, page, shape, &patch->runs[k])) note(page, &patch->runs[k]);
}

void wr_coverage_add(WrCoverage *cover, const WrDabShape *shape)
{
    wr_scan(cover->maker.ground.field, shape, cover->maker.ground.pool, prepare, visit, cover);
}

static void make_target(WrCoverage *cover, WrPage *page)
{
    page->target = wr_alloc(WR_TILE * WR_TILE, sizeof(float));
    wr_blend_target_tile(&cover->maker.targets, page->tx, page->ty, page->target);
}

const float *wr_coverage_target(WrCoverage *cover, int tx, int ty)
{
    if (cover->maker.targets.kind == WR_BLEND_TARGET_NONE) return NULL;
    WrPage *page = page_of(cover, tx, ty);
    if (!page->target) make_target(cover, page);
    return page->target;
}

static void make_one(int index, int worker, void *ctx)
{
    (void)worker;
    WrCoverage *cover = ctx;
    WrStrokeResolve *make = &cover->makes.data[index];
    WrPage *page = cover->pages[(size_t)make->ty * (size_t)cover->tiles_u + (size_t)make->tx];
    if (cover->maker.targets.kind != WR_BLEND_TARGET_NONE && !page->target)
        make_target(cover, page);
    make->target = page->target;
    wr_stroke_resolve(&cover->maker, make);
}

/* Resolves the last `count` of the changed pages. */
static void make_some(WrCoverage *cover, int count)
{
    cover->makes.count = 0;
    for (int i = 0; i < count; i++) {
        WrPage *page = cover->changed.data[--cover->changed.count];
        WrStrokeResolve make = { .tx = page->tx,
                                 .ty = page->ty,
                                 .low_y = page->low_y,
                                 .high_y = page->high_y,
                                 .low_x = page->low_x,
                                 .count = page->high_x - page->low_x,
                                 .cover = page->cover,
                                 .rest = page->rest,
                                 .within_1 = cover->rule != WR_COVERAGE_SUM };
        page->listed = false;
        if (page->high_x < 0 || !wr_stroke_resolve_needed(&cover->maker, &make)) continue;
        wr_stroke_resolve_open(&cover->maker, &make);
        wr_array_push(&cover->makes, make);
    }
    int made = cover->makes.count;
    wr_pool_run(made >= MANY_PAGES ? cover->maker.ground.pool : NULL, made, make_one, cover);
}

bool wr_coverage_make(WrCoverage *cover, double until)
{
    while (cover->changed.count > 0) {
        bool pool = cover->maker.ground.pool && cover->changed.count >= MANY_PAGES;
        int most = until == HUGE_VAL ? cover->changed.count : pool ? MANY_PAGES : FEW_PAGES;
        make_some(cover, most < cover->changed.count ? most : cover->changed.count);
        if (until < HUGE_VAL && wr_clock_seconds() >= until) break;
    }
    return cover->changed.count > 0;
}
