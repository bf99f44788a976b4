#include "brush/paint.h"

const WrBrushModeInfo wr_brush_modes[WR_BRUSH_MODE_COUNT] = {
    [WR_BRUSH_RAISE] = { "raise", "Raise", "adds strength to the height" },
    [WR_BRUSH_LOWER] = { "lower", "Lower", "takes strength from the height" },
    [WR_BRUSH_TO] = { "to", "Level", "brings the height towards a given one, by strength at most" },
};

WrBrush wr_brush_default(void)
{
    return (WrBrush){ .radius = 16.0, .hardness = 0.5, .strength = 0.1, .mode = WR_BRUSH_RAISE };
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

void wr_brush_dab(WrField *field, const WrBrush *brush, double u, double v)
{
    WrPaint paint = { .field = field,
                      .brush = wr_brush_sane(brush),
                      .kernels = wr_brush_kernels() };
    double x, y;
    if (wr_paint_place(field, u, v, &x, &y)) wr_paint_motion(&paint, x, y, 0.0, 0.0, 1.0, 1.0);
}

void wr_brush_dab_on(const WrBrushGround *ground, const WrBrush *brush, double u, double v)
{
    if (!ground->mark && !ground->selection) {
        wr_brush_dab(ground->field, brush, u, v);
        return;
    }
    WrStroke *stroke = wr_stroke_new_on(ground, brush);
    wr_stroke_add(stroke, (WrSample){ .u = u, .v = v, .pressure = 1.0 });
    wr_stroke_free(stroke);
}
