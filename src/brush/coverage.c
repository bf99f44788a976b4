#include "brush/coverage.h"

#include "base/memory.h"
#include "base/pool.h"
#include "brush/footprint_scan.h"
#include "field/field.h"
#include "system/clock.h"

#include <math.h>
#include <stdalign.h>
#include <string.h>

/* ---- blend target ---- */

#define TEXELS (WR_TILE * WR_TILE)

/* A clone's source offset in texels, rounded to a fine grid so that whole texels are detected; limited
   in size. */
static double shift(double source, int n, WrWrap wrap)
{
    double texels = source * n;
    if (wrap == WR_WRAP_PERIODIC) texels -= n * floor(texels / n);
    if (!(fabs(texels) <= 2.0 * n)) texels = texels > 0.0 ? 2.0 * n : texels < 0.0 ? -2.0 * n : 0.0;
    return rint(texels * 65536.0) / 65536.0;
}

/* brush from wr_brush_sane. */
static WrTargets wr_targets(const WrBrushGround *ground, const WrField *start, const WrBrush *brush)
{
    return (WrTargets){ .kind = wr_mode_work(brush->mode)->target,
                        .start = start,
                        .below = ground->below,
                        .neutral = isfinite(ground->neutral) ? ground->neutral : 0.0f,
                        .shift_x =
                            shift(brush->source_u, wr_field_width(start), wr_field_wrap_u(start)),
                        .shift_y =
                            shift(-brush->source_v, wr_field_height(start), wr_field_wrap_v(start)),
                        .reach = (int)brush->reach };
}

static int limit(int i, int n)
{
    return i < 0 ? 0 : i < n ? i : n - 1;
}

/* Reads one row, j inside the table. */
static void read_row(const WrField *field, int i, int j, int count, float *out)
{
    int width = wr_field_width(field);
    bool clamps = wr_field_wrap_u(field) == WR_WRAP_CLAMP;
    for (int k = 0; k < count;) {
        int texel, run;
        if (clamps && (i + k < 0 || i + k >= width)) {
            texel = limit(i + k, width);
            run = 1;
        } else {
            run = wr_tile_run(i + k, i + count - 1, width, &texel);
        }
        const float *tile = wr_field_tile(field, texel / WR_TILE, j / WR_TILE);
        const float *from = tile ? tile + j % WR_TILE * WR_TILE + texel % WR_TILE : NULL;
        for (int n = 0; n < run; n++) out[k + n] = from ? from[n] : wr_field_level(field);
        k += run;
    }
}

void wr_read_box(const WrField *field, int i, int j, int count_i, int count_j, int pitch,
                 float *out)
{
    int height = wr_field_height(field);
    bool clamps = wr_field_wrap_v(field) == WR_WRAP_CLAMP;
    for (int row = 0; row < count_j; row++) {
        int at = j + row, wrapped = at % height < 0 ? at % height + height : at % height;
        read_row(field, i, clamps ? limit(at, height) : wrapped, count_i,
                 out + (size_t)row * (size_t)pitch);
    }
}

static void below_tile(const WrTargets *t, int tx, int ty, float *out)
{
    const float *tile = t->below ? wr_field_tile(t->below, tx, ty) : NULL;
    float level = t->below ? wr_field_level(t->below) : t->neutral;
    if (tile) memcpy(out, tile, TEXELS * sizeof *out);
    else
        for (int k = 0; k < TEXELS; k++) out[k] = level;
}

/* Bilinear between whole texels; an integer shift copies. One tap more than a tile on the right and below: shifts are
   floored, so the second taps of the last row and column lie there. */
static void shifted_tile(const WrTargets *t, int tx, int ty, float *out)
{
    enum { SIDE = WR_TILE + 1 };
    float taps[SIDE * SIDE];
    double whole_x = floor(t->shift_x), whole_y = floor(t->shift_y);
    double fx = t->shift_x - whole_x, fy = t->shift_y - whole_y;
    wr_read_box(t->start, tx * WR_TILE + (int)whole_x, ty * WR_TILE + (int)whole_y, SIDE, SIDE,
                SIDE, taps);
    for (int y = 0; y < WR_TILE; y++)
        for (int x = 0; x < WR_TILE; x++) {
            const float *at = taps + y * SIDE + x;
            double upper = at[0] * (1.0 - fx) + at[1] * fx;
            double lower = at[SIDE] * (1.0 - fx) + at[SIDE + 1] * fx;
            out[y * WR_TILE + x] = (float)(upper * (1.0 - fy) + lower * fy);
        }
}

/* Half the width of a disc's row `off` texels from its middle; at least 0. */
static int half_width(int reach, int off)
{
    double r = reach + 0.5, half2 = r * r - (double)off * off;
    return half2 > 0.0 ? (int)sqrt(half2) : 0;
}

/* Prefix sums of rows give the sum of any part of a row by one difference. */
static void sharp_tile(const WrTargets *t, int tx, int ty, float *out)
{
    /* Sharpening: target = f + (f - mean of a disc). Rows of the disc are runs, and a run's sum is the difference of two
       prefix sums: O(reach) per texel instead of O(reach^2). In double, so that the differences keep their digits. */
    int reach = t->reach, side = WR_TILE + 2 * reach, texels = 0;
    float *row = wr_alloc((size_t)side, sizeof *row);
    double *sums = wr_alloc((size_t)side + 1, sizeof *sums);
    double *means = wr_alloc(TEXELS, sizeof *means);
    for (int off = -reach; off <= reach; off++) texels += 2 * half_width(reach, off) + 1;
    for (int j = 0; j < side; j++) {
        wr_read_box(t->start, tx * WR_TILE - reach, ty * WR_TILE - reach + j, side, 1, side, row);
        for (int i = 0; i < side; i++) sums[i + 1] = sums[i] + row[i];
        for (int y = 0; y < WR_TILE; y++) {
            int off = j - reach - y;
            if (off < -reach || off > reach) continue;
            int half = half_width(reach, off);
            const double *left = sums + reach - half, *right = sums + reach + half + 1;
            for (int x = 0; x < WR_TILE; x++) means[y * WR_TILE + x] += right[x] - left[x];
        }
    }
    wr_read_box(t->start, tx * WR_TILE, ty * WR_TILE, WR_TILE, WR_TILE, WR_TILE, out);
    for (int k = 0; k < TEXELS; k++) {
        double f = out[k];
        out[k] = wr_finite_float(f + (f - means[k] / texels));
    }
    wr_free(row);
    wr_free(sums);
    wr_free(means);
}

#define LEVELS 10 /* 2^9 <= 2 WR_REACH_MAX + 1 < 2^10 */

/* Maxima (of heights times sign) of runs of 1, 2, 4, ... texels starting at each texel. */
static void doublings(const float *row, int side, float sign, int levels, float *runs)
{
    for (int i = 0; i < side; i++) runs[i] = sign * row[i];
    for (int level = 1; level < levels; level++) {
        const float *from = runs + (size_t)(level - 1) * (size_t)side;
        float *to = runs + (size_t)level * (size_t)side;
        int half = 1 << (level - 1), last = side - 2 * half;
        for (int i = 0; i <= last; i++) to[i] = from[i] > from[i + half] ? from[i] : from[i + half];
    }
}

/* Maximum over a disc, row by row of the disc: the maximum of a run of n texels is that of the two runs of 2^k <= n at its
   ends, which may overlap (sparse table). sign = -1 computes minima. */
static void extreme_tile(const WrTargets *t, int tx, int ty, float sign, float *out)
{
    int reach = t->reach, side = WR_TILE + 2 * reach, levels = 1;
    while ((1 << levels) <= 2 * reach + 1) levels++;
    float *row = wr_alloc((size_t)side, sizeof *row);
    float *runs = wr_alloc((size_t)side * LEVELS, sizeof *runs);
    for (int k = 0; k < TEXELS; k++) out[k] = -3.4028234663852886e38f;
    for (int j = 0; j < side; j++) {
        wr_read_box(t->start, tx * WR_TILE - reach, ty * WR_TILE - reach + j, side, 1, side, row);
        doublings(row, side, sign, levels, runs);
        for (int y = 0; y < WR_TILE; y++) {
            int off = j - reach - y;
            if (off < -reach || off > reach) continue;
            int half = half_width(reach, off), level = 0;
            while ((2 << level) <= 2 * half + 1) level++;
            const float *left = runs + (size_t)level * (size_t)side + (reach - half);
            const float *right = left + (2 * half + 1 - (1 << level));
            float *to = out + y * WR_TILE;
            for (int x = 0; x < WR_TILE; x++) {
                float larger = left[x] > right[x] ? left[x] : right[x];
                to[x] = to[x] > larger ? to[x] : larger;
            }
        }
    }
    for (int k = 0; k < TEXELS; k++) out[k] = sign * out[k];
    wr_free(row);
    wr_free(runs);
}

void wr_targets_compute_tile(const WrTargets *t, int tx, int ty, float *out)
{
    switch (t->kind) {
    case WR_BLEND_TARGET_NONE: break;
    case WR_BLEND_TARGET_BELOW: below_tile(t, tx, ty, out); break;
    case WR_BLEND_TARGET_SHIFTED: shifted_tile(t, tx, ty, out); break;
    case WR_BLEND_TARGET_SHARP: sharp_tile(t, tx, ty, out); break;
    case WR_BLEND_TARGET_LARGEST: extreme_tile(t, tx, ty, 1.0f, out); break;
    case WR_BLEND_TARGET_SMALLEST: extreme_tile(t, tx, ty, -1.0f, out); break;
    }
}

/* ---- stroke resolve ---- */

void wr_stroke_resolver_init(WrStrokeResolver *maker, const WrBrushGround *ground,
                             const WrBrush *brush)
{
    *maker = (WrStrokeResolver){ .ground = *ground, .brush = *brush };
    maker->start = wr_field_share(ground->field);
    maker->work = wr_mode_work(brush->mode);
    if (ground->mark && maker->work->lowers_mark) maker->mark_start = wr_field_share(ground->mark);
    maker->args = wr_mode_args(brush);
    maker->targets = wr_targets(ground, maker->start, brush);
}

void wr_stroke_resolver_fini(WrStrokeResolver *maker)
{
    wr_field_free(maker->start);
    wr_field_free(maker->mark_start);
    maker->start = maker->mark_start = NULL;
}

static int texel_at(double x, int n, WrWrap wrap)
{
    double cell = floor(x + 0.5);
    if (wrap == WR_WRAP_PERIODIC) cell -= n * floor(cell / n);
    return cell > 0.0 ? (cell < n ? (int)cell : n - 1) : 0;
}

void wr_stroke_resolver_set_flatten_height(WrStrokeResolver *maker, double x, double y)
{
    if (!maker->work->first_height) return;
    const WrField *field = maker->start;
    maker->args.to = wr_field_get(field, texel_at(x, wr_field_width(field), wr_field_wrap_u(field)),
                                  texel_at(y, wr_field_height(field), wr_field_wrap_v(field)));
}

/* True if nothing is selected in that tile. */
static bool maker_closed(const WrStrokeResolver *maker, int tx, int ty)
{
    const WrField *selection = maker->ground.selection;
    return selection && !wr_field_tile(selection, tx, ty) && !(wr_field_level(selection) > 0.0f);
}

/* The effective weight of the coverage. Coverage c of a stroke becomes the weight c opacity s with the selection s. With
   buildup, coverage sums beyond 1; `rest` holds the part of the sum that a float would lose, so that a million faint dabs
   still count (HC76). */
static void parts(const WrStrokeResolver *maker, const WrStrokeResolve *make,
                  const float *selection, int at, float *part)
{
    const float *cover = make->cover + at, *rest = make->rest ? make->rest + at : NULL;
    float opacity = (float)maker->brush.opacity;
    if (maker->brush.buildup) {
        for (int i = 0; i < make->count; i++)
            part[i] = (float)(((double)cover[i] + (rest ? rest[i] : 0.0f)) * opacity);
    } else {
        for (int i = 0; i < make->count; i++)
            part[i] = (cover[i] < 1.0f ? cover[i] : 1.0f) * opacity;
    }
    if (!maker->ground.selection) return;
    float level = wr_field_level(maker->ground.selection);
    for (int i = 0; i < make->count; i++) {
        float s = selection ? selection[at + i] : level;
        s = s > 0.0f ? s : 0.0f;
        part[i] *= s < 1.0f ? s : 1.0f;
    }
}

static const float *selection_of(const WrStrokeResolver *maker, const WrStrokeResolve *make)
{
    const WrField *selection = maker->ground.selection;
    return selection ? wr_field_tile(selection, make->tx, make->ty) : NULL;
}

bool wr_stroke_resolve_needed(const WrStrokeResolver *maker, const WrStrokeResolve *make)
{
    if (maker_closed(maker, make->tx, make->ty) || !(maker->brush.opacity > 0.0)) return false;
    const float *selection = selection_of(maker, make);
    for (int y = make->low_y; y <= make->high_y; y++) {
        int at = y * WR_TILE + make->low_x, any = 0;
        for (int i = at; i < at + make->count; i++)
            any |= make->cover[i] > 0.0f && (!selection || selection[i] > 0.0f);
        if (any) return true;
    }
    return false;
}

void wr_stroke_resolve_open(const WrStrokeResolver *maker, WrStrokeResolve *make)
{
    WrField *mark = maker->ground.mark;
    make->out = wr_field_tile_place(maker->ground.field, make->tx, make->ty);
    make->mark = mark ? wr_field_tile_place(mark, make->tx, make->ty) : NULL;
}

/* Painting raises the mark to the weight; erasing removes that fraction of the previous mark. */
static void make_mark(const WrStrokeResolver *maker, const float *before, const float *part,
                      int count, float *mark)
{
    float level = maker->mark_start ? wr_field_level(maker->mark_start) : 0.0f;
    for (int i = 0; i < count; i++) {
        float p = part[i] < 1.0f ? part[i] : 1.0f;
        if (maker->mark_start) {
            float was = before ? before[i] : level;
            mark[i] = p > 0.0f ? was * (1.0f - p) : was;
        } else {
            mark[i] = mark[i] < p ? p : mark[i];
        }
    }
}

/* Every texel is computed from the table at the stroke's start and the coverage so far, never from its present height: the
   result does not depend on how often or in which order tiles are resolved. */
void wr_stroke_resolve(const WrStrokeResolver *maker, const WrStrokeResolve *make)
{
    alignas(WR_ALIGN) float part[WR_TILE], flat[WR_TILE];
    float *out = wr_field_place_write(maker->ground.field, make->out);
    float *mark = make->mark ? wr_field_place_write(maker->ground.mark, make->mark) : NULL;
    const float *selection = selection_of(maker, make);
    const float *start = wr_field_tile(maker->start, make->tx, make->ty);
    const float *mark_start =
        maker->mark_start ? wr_field_tile(maker->mark_start, make->tx, make->ty) : NULL;
    if (!start)
        for (int i = 0; i < WR_TILE; i++) flat[i] = wr_field_level(maker->start);
    bool all_counts = make->within_1 && !maker->brush.buildup && maker->brush.opacity == 1.0 &&
                      !maker->ground.selection;
    for (int y = make->low_y; y <= make->high_y; y++) {
        int at = y * WR_TILE + make->low_x;
        const float *counts = all_counts ? make->cover + at : part;
        if (!all_counts) parts(maker, make, selection, at, part);
        if (mark)
            make_mark(maker, mark_start ? mark_start + at : NULL, counts, make->count, mark + at);
        maker->work->cover(&maker->args, start ? start + at : flat, counts,
                           make->target ? make->target + at : NULL, make->count, out + at);
    }
}

#define MANY_PAGES 64   /* number worth several threads */
#define FEW_PAGES 8     /* between checks of the clock */
#define POOL_PAGES 256  /* the same, by several threads */
#define LARGE 256.0     /* texels: reach of shapes that are added together, */
#define TOGETHER 32     /* their largest number, */
#define TEXELS_MOST 1e8 /* and the texels of all, so that the clock is read in between */

void wr_coverage_init(WrCoverage *cover, const WrBrushGround *ground, const WrBrush *brush,
                      WrCoverageRule rule)
{
    *cover = (WrCoverage){ .rule = rule,
                           .tiles_u = wr_field_tiles_u(ground->field),
                           .strongest = HUGE_VAL };
    wr_stroke_resolver_init(&cover->maker, ground, brush);
    size_t tiles = (size_t)cover->tiles_u * (size_t)wr_field_tiles_v(ground->field);
    cover->pages = wr_alloc(tiles, sizeof(WrPage *));
}

void wr_coverage_fini(WrCoverage *cover)
{
    for (int i = 0; i < cover->made.count; i++) {
        wr_field_tile_free(cover->made.data[i]->cover);
        wr_free(cover->made.data[i]->rest);
        wr_free(cover->made.data[i]->target);
        wr_free(cover->made.data[i]);
    }
    wr_array_free(&cover->made);
    wr_array_free(&cover->changed);
    wr_array_free(&cover->makes);
    wr_array_free(&cover->waiting);
    wr_free(cover->pages);
    cover->pages = NULL;
    wr_stroke_resolver_fini(&cover->maker);
}

/* Pages exist only for touched tiles; `changed` lists those with new coverage since the last resolve. */
static WrPage *page_of(WrCoverage *cover, int tx, int ty)
{
    WrPage **slot = &cover->pages[(size_t)ty * (size_t)cover->tiles_u + (size_t)tx];
    if (!*slot) {
        *slot = wr_alloc(1, sizeof **slot);
        (*slot)->tx = tx;
        (*slot)->ty = ty;
        wr_array_push(&cover->made, *slot);
    }
    return *slot;
}

/* The coverage of a page, allocated on first use: by the thread that fills it, since the system clears new memory. */
static float *texels_of(const WrCoverage *cover, WrPage *page)
{
    if (page->cover) return page->cover;
    if (cover->rule == WR_COVERAGE_SUM) page->rest = wr_alloc(TEXELS, sizeof(float));
    page->cover = wr_field_tile_make();
    return memset(page->cover, 0, TEXELS * sizeof(float));
}

/* Called for each tile before its texels are covered. False if they cannot gain coverage: a large brush passes most of its tiles
   again with every motion. */
static bool prepare(void *ctx, int tx, int ty)
{
    WrCoverage *cover = ctx;
    if (maker_closed(&cover->maker, tx, ty)) return false;
    WrPage *page = page_of(cover, tx, ty);
    if ((double)page->least >= cover->strongest) return false;
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

/* An upper bound of a shape's coverage in the tile whose first texel lies at (x, y), not wrapped: at a distance to the motion
   that no texel of the tile falls below. The last factor is more than all rounding errors. */
static float bound_in_tile(const WrDabShape *shape, double x, double y)
{
    const WrCapsule *c = &shape->capsule;
    const double half = 0.5 * (WR_TILE - 1), diagonal = 1.4143 * half; /* > sqrt(2) half */
    if (shape->kind != WR_SHAPE_DAB && shape->kind != WR_SHAPE_MOTION)
        return (float)shape->strongest;
    x += half - c->x, y += half - c->y;
    const double t = fmin(fmax((x * c->dx + y * c->dy) * c->inverse_length2, 0.0), 1.0);
    const double ex = x - t * c->dx, ey = y - t * c->dy, d = sqrt(ex * ex + ey * ey) - diagonal;
    if (d <= c->inner) return (float)shape->strongest;
    const double s = fmax((c->radius - d) * c->inverse_edge, 0.0);
    return (float)(shape->strongest * s * s * (3.0 - 2.0 * s) * (1.0 + 1e-12));
}

static void visit(void *ctx, const WrDabShape *shape, const WrScanPatch *patch)
{
    WrCoverage *cover = ctx;
    WrPage *page = cover->pages[(size_t)patch->ty * (size_t)cover->tiles_u + (size_t)patch->tx];
    const WrRun *run = &patch->runs[0];
    const bool greatest = cover->rule == WR_COVERAGE_MAX;
    bool any = false;
    if (greatest &&
        page->least >= bound_in_tile(shape, run->x - run->at % WR_TILE, run->y - run->at / WR_TILE))
        return;
    texels_of(cover, page);
    for (int k = 0; k < patch->count; k++)
        if (gain(cover, page, shape, &patch->runs[k])) note(page, &patch->runs[k]), any = true;
    if (greatest && any) page->least = shape->kernels->least(page->cover, TEXELS);
}

/* The largest bound first: it raises the least coverage of a tile, and the motions whose bounds are not above it are passed over. So
   the motions of a frame cost little more than the few that are nearest, however many there are. The greatest coverage does
   not depend on the order. */
static void add_waiting(WrCoverage *cover)
{
    const WrBrushGround *ground = &cover->maker.ground;
    if (cover->waiting.count == 0) return;
    cover->strongest = 0;
    for (int i = 0; i < cover->waiting.count; i++)
        cover->strongest = fmax(cover->strongest, (double)(float)cover->waiting.data[i].strongest);
    wr_scan_together(ground->field, cover->waiting.data, cover->waiting.count, ground->pool,
                     prepare, visit, bound_in_tile, cover);
    cover->strongest = HUGE_VAL;
    cover->waiting.count = 0;
}

void wr_coverage_add(WrCoverage *cover, const WrDabShape *shape)
{
    if (cover->rule == WR_COVERAGE_MAX && shape->reach_x >= LARGE) {
        const double texels = 4 * shape->reach_x * shape->reach_y;
        wr_array_push(&cover->waiting, *shape);
        if (cover->waiting.count == TOGETHER || cover->waiting.count * texels > TEXELS_MOST)
            add_waiting(cover);
        return;
    }
    if (cover->rule == WR_COVERAGE_MAX) cover->strongest = (double)(float)shape->strongest;
    wr_scan(cover->maker.ground.field, shape, cover->maker.ground.pool, prepare, visit, cover);
    cover->strongest = HUGE_VAL;
}

void wr_coverage_add_texel(WrCoverage *cover, int x, int y, float c)
{
    if (!prepare(cover, x / WR_TILE, y / WR_TILE)) return;
    WrPage *page = page_of(cover, x / WR_TILE, y / WR_TILE);
    const int at = y % WR_TILE * WR_TILE + x % WR_TILE, block = at & -WR_BRUSH_BLOCK;
    float *to = &texels_of(cover, page)[at];
    switch (cover->rule) {
    case WR_COVERAGE_MAX: *to = *to < c ? c : *to; break;
    case WR_COVERAGE_OVER: *to += (1.0f - *to) * c; break;
    case WR_COVERAGE_SUM: {
        const double sum = (double)*to + page->rest[at] + c;
        *to = (float)sum;
        page->rest[at] = (float)(sum - *to);
        break;
    }
    }
    note(page, &(WrRun){ .at = block, .count = WR_BRUSH_BLOCK });
}

static void make_target(WrCoverage *cover, WrPage *page)
{
    page->target = wr_alloc(WR_TILE * WR_TILE, sizeof(float));
    wr_targets_compute_tile(&cover->maker.targets, page->tx, page->ty, page->target);
}

const float *wr_coverage_target(WrCoverage *cover, int tx, int ty)
{
    if (cover->maker.targets.kind == WR_BLEND_TARGET_NONE) return NULL;
    WrPage *page = page_of(cover, tx, ty);
    if (!page->target) make_target(cover, page);
    return page->target;
}

void wr_coverage_set_target(WrCoverage *cover, int x, int y, float target)
{
    const int at = y % WR_TILE * WR_TILE + x % WR_TILE;
    wr_coverage_target(cover, x / WR_TILE, y / WR_TILE);
    WrPage *page = page_of(cover, x / WR_TILE, y / WR_TILE);
    if (!page->cover || page->cover[at] == 0.0f) page->target[at] = target;
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
    add_waiting(cover);
    while (cover->changed.count > 0) {
        bool pool = cover->maker.ground.pool && cover->changed.count >= MANY_PAGES;
        int most = until == HUGE_VAL ? cover->changed.count : pool ? POOL_PAGES : FEW_PAGES;
        make_some(cover, most < cover->changed.count ? most : cover->changed.count);
        if (until < HUGE_VAL && wr_clock_seconds() >= until) break;
    }
    return cover->changed.count > 0;
}
