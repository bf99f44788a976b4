#include "brush/paint.h"

#include "base/memory.h"
#include "brush/preset.h"
#include "field/field.h"

#include <float.h>
#include <math.h>
#include <stdalign.h>

/* ---- dabs ---- */

/* A motion is the exact sweep of a round dab along a segment (a capsule): no dabs, no spacing. Only brushes whose cross
   section does not change along the segment, except in strength, can be drawn so. */
bool wr_draw_by_motions(const WrBrush *b)
{
    return !b->preset && !b->tip && !wr_mode_work(b->mode)->move && !(b->flow < 1.0) &&
           !b->buildup && b->aspect <= 1.0 && b->jitter_place == 0.0 && b->jitter_size == 0.0 &&
           (b->pressure == WR_PRESSURE_STRENGTH || b->pressure == WR_PRESSURE_NONE);
}

/* MAX: overlapping dabs of one stroke do not add up. OVER: c' = c + a (1 - c), builds up to 1. SUM: without limit. */
static WrCoverageRule rule_of(const WrBrush *b)
{
    if (b->buildup) return WR_COVERAGE_SUM;
    return b->preset || b->flow < 1.0 ? WR_COVERAGE_OVER : WR_COVERAGE_MAX;
}

void wr_draw_init(WrDraw *draw, const WrBrushGround *ground, const WrBrush *brush)
{
    *draw = (WrDraw){ 0 };
    wr_coverage_init(&draw->cover, ground, brush, rule_of(brush));
    draw->moves =
        wr_mode_work(brush->mode)->move || (brush->preset && wr_preset_smudges(brush->preset));
    WrCopy *copies = wr_alloc(WR_COPIES_MAX, sizeof *copies);
    draw->copy_count = wr_symmetry_copies(&brush->symmetry, ground->field, copies);
    draw->copies = wr_realloc(copies, WR_COPIES_MAX, (size_t)draw->copy_count, sizeof *copies);
}

void wr_draw_fini(WrDraw *draw)
{
    wr_coverage_fini(&draw->cover);
    wr_mover_fini(&draw->mover);
    wr_free(draw->copies);
    draw->copies = NULL;
}

static bool does_nothing(const WrDraw *draw)
{
    const WrBrush *brush = &draw->cover.maker.brush;
    return !(brush->opacity > 0.0) || !(brush->radius > 0.0) ||
           (draw->cover.maker.work->as_strong && brush->strength == 0.0 && !draw->moves);
}

static void add_texel(WrDraw *draw, double x, double y, double pressure)
{
    WrDabShape shape;
    if (wr_shape_of_texel(draw->cover.maker.ground.field, x, y, pressure, &shape))
        wr_coverage_add(&draw->cover, &shape);
}

/* A line one texel wide: one texel per column, or per row if it is steep. */
static void draw_line(WrDraw *draw, double x, double y, double dx, double dy, double pressure,
                      double growth)
{
    const WrField *field = draw->cover.maker.ground.field;
    bool steep = fabs(dy) > fabs(dx);
    double from = steep ? y : x, way = steep ? dy : dx;
    bool clamped = WR_WRAP_CLAMP == (steep ? wr_field_wrap_v(field) : wr_field_wrap_u(field));
    int n = steep ? wr_field_height(field) : wr_field_width(field);
    double low = floor((way < 0.0 ? from + way : from) + 0.5);
    double high = floor((way < 0.0 ? from : from + way) + 0.5);
    if (clamped) {
        low = low > 0.0 ? low : 0.0;
        high = high < n ? high : n;
    }
    for (double k = low; k <= high; k += 1.0) {
        double t = way != 0.0 ? (k - from) / way : 1.0;
        t = t > 0.0 ? (t < 1.0 ? t : 1.0) : 0.0;
        add_texel(draw, x + t * dx, y + t * dy, pressure + t * growth);
    }
}

/* On a grid of 2^-20 texels, copies by whole texels, mirrors and quarter turns are exact. */
static double on_grid(double x)
{
    return rint(x * 1048576.0) / 1048576.0;
}

void wr_draw_motion(WrDraw *draw, double x, double y, double dx, double dy, double pressure_start,
                    double pressure_end)
{
    if (does_nothing(draw) || !(pressure_start > 0.0 || pressure_end > 0.0)) return;
    const WrStrokeResolver *maker = &draw->cover.maker;
    if (draw->copy_count > 1) {
        x = on_grid(x);
        y = on_grid(y);
        dx = on_grid(dx);
        dy = on_grid(dy);
    }
    for (int k = 0; k < draw->copy_count; k++) {
        const WrCopy *c = &draw->copies[k];
        double cx = c->a * x + c->b * y + c->dx, cy = c->c * x + c->d * y + c->dy;
        double cdx = c->a * dx + c->b * dy, cdy = c->c * dx + c->d * dy;
        WrDabShape shape;
        if (maker->brush.radius <= WR_THIN)
            draw_line(draw, cx, cy, cdx, cdy, pressure_start, pressure_end - pressure_start);
        else if (wr_shape_of_motion(maker->ground.field, &maker->brush, cx, cy, cdx, cdy,
                                    pressure_start, pressure_end, &shape))
            wr_coverage_add(&draw->cover, &shape);
    }
}

void wr_draw_dab(WrDraw *draw, const WrDab *dab)
{
    if (does_nothing(draw)) return;
    const WrStrokeResolver *maker = &draw->cover.maker;
    if (maker->ground.mesh) {
        wr_mesh_dab(draw, dab);
        return;
    }
    WrDab fine = *dab;
    fine.x = on_grid(dab->x);
    fine.y = on_grid(dab->y);
    fine.dx = on_grid(dab->dx);
    fine.dy = on_grid(dab->dy);
    for (int k = 0; k < draw->copy_count; k++) {
        const WrCopy *c = &draw->copies[k];
        WrDabShape shape;
        if (!wr_shape_of_dab(maker->ground.field, maker->brush.tip, &fine, c, &shape)) continue;
        if (draw->moves)
            wr_move_dab(&draw->mover, &draw->cover, &shape, dab->radius,
                        c->a * fine.dx + c->b * fine.dy, c->c * fine.dx + c->d * fine.dy, dab->drag,
                        dab->dragged);
        else wr_coverage_add(&draw->cover, &shape);
    }
}

/* Pending coverage is resolved first, since the height under the brush must include the stroke so far. */
double wr_draw_height(WrDraw *draw, double x, double y, double radius)
{
    wr_draw_finish(draw, HUGE_VAL);
    if (draw->cover.maker.ground.mesh) return wr_mesh_height(draw, x, y, radius);
    return wr_move_height(draw->cover.maker.ground.field, x, y, radius);
}

bool wr_draw_finish(WrDraw *draw, double until)
{
    return !draw->moves && wr_coverage_make(&draw->cover, until);
}

/* ---- strokes ---- */

#define FAR_OFF 4e9 /* texels; beyond the largest radius from any table */
#define ASPECT_MAX 1000.0

static double clamp(double value, double low, double high)
{
    return value > low ? (value < high ? value : high) : low; /* NaN becomes low */
}

static double clamp_signed(double value, double most)
{
    return isnan(value) ? 0.0 : clamp(value, -most, most);
}

/* Sanitises a brush's properties besides its round shape. */
static void sane_shape(WrBrush *sane)
{
    sane->aspect = clamp(sane->aspect, 1.0, ASPECT_MAX);
    sane->angle_deg = isfinite(sane->angle_deg) ? fmod(sane->angle_deg, 360.0) : 0.0;
    sane->jitter_place = clamp(sane->jitter_place, 0.0, 100.0);
    sane->jitter_angle_deg = clamp(sane->jitter_angle_deg, 0.0, 180.0);
    sane->jitter_size = clamp(sane->jitter_size, 0.0, 1.0);
    /* the breadth matters: dabs of a thin ellipse at a tenth of its length would be visible */
    double spacing = wr_brush_modes[sane->mode].spacing / (sane->tip ? 1.0 : sane->aspect);
    if (sane->tip && wr_tip_spacing(sane->tip) > 0.0) spacing = wr_tip_spacing(sane->tip);
    sane->spacing = clamp(sane->spacing > 0.0 ? sane->spacing : spacing, 0.01, 10.0);
    double reach = sane->reach > 0.0 ? sane->reach : sane->radius / 8.0;
    sane->reach = rint(clamp(reach, 1.0, WR_REACH_MAX));
}

WrBrush wr_brush_sane(const WrBrush *brush)
{
    WrBrush sane = *brush;
    sane.radius = clamp(brush->radius, 0.0, 1e9);
    sane.hardness = clamp(brush->hardness, 0.0, 1.0);
    /* twice float's range spans it from end to end */
    sane.strength = clamp_signed(brush->strength, 2.0 * FLT_MAX);
    sane.to = clamp_signed(brush->to, FLT_MAX);
    sane.source_u = clamp_signed(brush->source_u, 1e9);
    sane.source_v = clamp_signed(brush->source_v, 1e9);
    sane.opacity = clamp(brush->opacity, 0.0, 1.0);
    sane.flow = clamp(brush->flow, 0.0, 1.0);
    if ((unsigned)brush->mode >= WR_BRUSH_MODE_COUNT) sane.mode = WR_BRUSH_RAISE;
    if ((unsigned)brush->pressure >= WR_PRESSURE_COUNT) sane.pressure = WR_PRESSURE_STRENGTH;
    sane_shape(&sane);
    return sane;
}

/* The edge is at least one texel wide, also for hardness 1: a narrower one would show stairs in the relief. */
double wr_brush_inner(const WrBrush *brush)
{
    double soft = brush->hardness * brush->radius, hard = brush->radius - 1.0;
    double inner = soft < hard ? soft : hard;
    return inner > WR_THIN ? inner : WR_THIN;
}

/* Texel coordinates with centres at whole numbers: x = u W - 1/2, y = (1 - v) H - 1/2. */
static double place(double u, int n, WrWrap wrap, bool runs_down)
{
    double p = wrap == WR_WRAP_PERIODIC ? wr_field_reduce(u, 1.0) : u;
    double x = n * (runs_down ? 1.0 - p : p) - 0.5;
    return clamp(x, -FAR_OFF, FAR_OFF);
}

bool wr_paint_place(const WrField *field, double u, double v, double *x, double *y)
{
    if (!isfinite(u) || !isfinite(v)) return false;
    *x = place(u, wr_field_width(field), wr_field_wrap_u(field), false);
    *y = place(v, wr_field_height(field), wr_field_wrap_v(field), true);
    return true;
}

bool wr_paint_is_plain(const WrBrush *brush)
{
    const WrModeWork *work = wr_mode_work(brush->mode);
    const WrSymmetry *s = &brush->symmetry;
    return wr_draw_by_motions(brush) && work->target == WR_BLEND_TARGET_NONE &&
           !work->first_height && !s->mirror_u && !s->mirror_v && s->radial <= 1 &&
           s->repeat_u <= 1 && s->repeat_v <= 1;
}

/* A single dab, resolved in place. */
typedef struct Spot {
    WrField *field;
    const WrModeWork *work;
    WrModeArgs args;
    float opacity;
} Spot;

static bool any_cover(const float *fresh, int count)
{
    for (int i = 0; i < count; i++)
        if (fresh[i] > 0.0f) return true;
    return false;
}

static void visit(void *ctx, const WrDabShape *shape, const WrScanPatch *patch)
{
    const Spot *spot = ctx;
    float *out = NULL; /* fetched with the first texel that changes */
    for (int k = 0; k < patch->count; k++) {
        const WrRun *run = &patch->runs[k];
        alignas(WR_ALIGN) float fresh[WR_TILE];
        wr_run_cover(shape, run, fresh);
        if (!out && !any_cover(fresh, run->count)) continue;
        if (!out) out = wr_field_tile_write(spot->field, patch->tx, patch->ty);
        for (int i = 0; i < run->count; i++) fresh[i] *= spot->opacity;
        spot->work->cover(&spot->args, out + run->at, fresh, NULL, run->count, out + run->at);
    }
}

/* ---- dabs that are simply added, tile by tile ---- */

/* The value of low .. high nearest to p. */
static double nearest(double p, int low, int high)
{
    return p < low ? low : p > high ? high : rint(p);
}

/* True if the dab covers any texel of a rectangle; computed as in the kernels. */
static bool covers(const WrCapsule *c, int i, int j, int count_i, int count_j)
{
    double ex = nearest(c->x, i, i + count_i - 1) - c->x;
    double ey = nearest(c->y, j, j + count_j - 1) - c->y, d2 = ex * ex + ey * ey;
    return d2 < c->radius2 && c->radius - sqrt(d2) > 0.0;
}

/* True if columns may be widened to whole blocks. That would touch another image's texels if the dab
 * spans the table, and unused ones if the table ends within a block. */
static bool may_widen(const WrField *field, const WrDabShape *shape)
{
    int width = wr_field_width(field);
    bool spans =
        wr_field_wrap_u(field) == WR_WRAP_PERIODIC && shape->reach_x >= 0.5 * width - WR_DAB_BLOCK;
    return !spans && width % WR_DAB_BLOCK == 0;
}

static void add_band(WrField *field, const WrDabShape *shape, double strength, WrWindow columns,
                     const WrDabRows *rows, int j, int count_j, int texel_j)
{
    bool widens = may_widen(field, shape);
    WrDabPart part = { .rows = rows, .y = j, .count = count_j };
    for (int i = columns.low, count; i <= columns.high; i += count) {
        int texel;
        count = wr_tile_run(i, columns.high, wr_field_width(field), &texel);
        if (!covers(&shape->capsule, i, j, count, count_j)) continue;
        part.x = i - texel % WR_TILE;
        part.low = i - part.x;
        part.high = part.low + count - 1;
        if (widens) {
            part.low &= -WR_DAB_BLOCK;
            part.high |= WR_DAB_BLOCK - 1;
        }
        float *tile = wr_field_tile_write(field, texel / WR_TILE, texel_j / WR_TILE);
        shape->kernels->dab_tile(&shape->capsule, &part, strength,
                                 tile + texel_j % WR_TILE * WR_TILE);
    }
}

static void add_dab(WrField *field, const WrDabShape *shape, double strength)
{
    WrWindow columns =
        wr_window(shape->x, 0.0, shape->reach_x, wr_field_width(field), wr_field_wrap_u(field));
    WrWindow rows =
        wr_window(shape->y, 0.0, shape->reach_y, wr_field_height(field), wr_field_wrap_v(field));
    if (columns.low > columns.high) return;
    for (int j = rows.low, count; j <= rows.high; j += count) {
        WrDabRows spans;
        int texel;
        count = wr_tile_run(j, rows.high, wr_field_height(field), &texel);
        shape->kernels->dab_rows(&shape->capsule, j, count, &spans);
        add_band(field, shape, strength, columns, &spans, j, count, texel);
    }
}

void wr_paint_dab(WrField *field, const WrBrush *brush, double x, double y)
{
    Spot spot = { .field = field,
                  .work = wr_mode_work(brush->mode),
                  .args = wr_mode_args(brush),
                  .opacity = (float)brush->opacity };
    if (!(brush->opacity > 0.0) || !(brush->radius > 0.0) ||
        (spot.work->as_strong && brush->strength == 0.0))
        return;
    WrDabShape shape;
    bool there = brush->radius <= WR_THIN
                     ? wr_shape_of_texel(field, x, y, 1.0, &shape)
                     : wr_shape_of_motion(field, brush, x, y, 0.0, 0.0, 1.0, 1.0, &shape);
    bool plain = brush->opacity == 1.0 && fabs(brush->strength) <= WR_BRUSH_STRONG &&
                 (brush->mode == WR_BRUSH_RAISE || brush->mode == WR_BRUSH_LOWER);
    double strength = brush->mode == WR_BRUSH_RAISE ? brush->strength : -brush->strength;
    if (there && plain && shape.kind == WR_SHAPE_DAB) add_dab(field, &shape, strength);
    else if (there) wr_scan(field, &shape, NULL, NULL, visit, &spot);
}
