#include "brush/draw.h"

#include "base/memory.h"
#include "brush/preset.h"
#include "field/field.h"

#include <math.h>

bool wr_draw_by_motions(const WrBrush *b)
{
    return !b->preset && !b->tip && !wr_mode_work(b->mode)->move && !(b->flow < 1.0) &&
           !b->buildup && b->aspect <= 1.0 && b->jitter_place == 0.0 && b->jitter_size == 0.0 &&
           (b->pressure == WR_PRESSURE_STRENGTH || b->pressure == WR_PRESSURE_NONE);
}

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

double wr_draw_height(WrDraw *draw, double x, double y, double radius)
{
    wr_draw_finish(draw, HUGE_VAL);
    return wr_move_height(draw->cover.maker.ground.field, x, y, radius);
}

bool wr_draw_finish(WrDraw *draw, double until)
{
    return !draw->moves && wr_coverage_make(&draw->cover, until);
}
