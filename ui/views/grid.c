#include "ui/views/grid.h"
#include "ui/canvas/view.h"
#include "ui/desk/settings.h"
#include "ui/gui/gui.h"
#include "ui/gui/theme.h"

#include <math.h>
#include <stdio.h>

#define NEAR_UNITS 7.0
#define CLOSEST_UNITS 5.0 /* between two lines that are drawn */
#define LABEL_UNITS 44.0  /* between two numbers of the ruler */
#define LINE 0x704a8fdcu

double wr_grid_step(const WrApp *app, int axis)
{
    const WrCanvasView *v = app->view;
    if (!app->settings->grid) return 0.0;
    return (double)(axis ? v->table_h : v->table_w) / app->settings->grid_parts;
}

double wr_grid_snap(const WrApp *app, int axis, double texel)
{
    double step = wr_grid_step(app, axis);
    if (!(step > 0.0)) return texel;
    double line = step * rint(texel / step);
    return fabs(line - texel) * app->view->zoom < NEAR_UNITS * wr_gui_scale() ? line : texel;
}

/* The pixel of a place along an axis. */
static double pixel_of(const WrCanvasView *v, int axis, double texel)
{
    double x, y;
    wr_view_to_pixel(v, axis ? 0.0 : texel, axis ? texel : 0.0, &x, &y);
    return axis ? y : x;
}

/* The number of texels from the cell's left or upper edge, at the line's end. */
static void number(const WrCanvasView *v, int axis, double at, double texel, double most)
{
    char text[24];
    double from = texel - most * floor(texel / most), tall = wr_gui_line_height(WR_FONT_SMALL);
    snprintf(text, sizeof text, "%.5g", from);
    double wide = wr_gui_text_width(WR_FONT_SMALL, text), gap = 3.0 * wr_gui_scale();
    double x = axis ? v->x + v->w - wide - 2 * gap : at + gap,
           y = axis ? at : v->y + v->h - tall - gap;
    wr_gui_draw_fill(x - gap, y, wide + 2 * gap, tall, WR_COLOUR_CHIP, gap);
    wr_gui_draw_text(x, y, WR_FONT_SMALL, WR_COLOUR_LABEL, text);
}

static void lines_along(const WrApp *app, int axis)
{
    const WrCanvasView *v = app->view;
    double step = wr_grid_step(app, axis), x0, y0, x1, y1, scale = wr_gui_scale();
    if (step * v->zoom < CLOSEST_UNITS * scale) return;
    wr_view_to_texel(v, v->x, v->y, &x0, &y0);
    wr_view_to_texel(v, v->x + v->w, v->y + v->h, &x1, &y1);
    double low = axis ? fmin(y0, y1) : fmin(x0, x1), high = axis ? fmax(y0, y1) : fmax(x0, x1);
    int each = (int)ceil(LABEL_UNITS * scale / (step * v->zoom));
    for (double k = ceil(low / step); k * step <= high; k += 1.0) {
        double at = rint(pixel_of(v, axis, k * step));
        if (axis) wr_gui_draw_fill(v->x, at, v->w, 1, LINE, 0);
        else wr_gui_draw_fill(at, v->y, 1, v->h, LINE, 0);
        if (fmod(k, each) == 0.0) number(v, axis, at, k * step, axis ? v->table_h : v->table_w);
    }
}

void wr_grid_draw(const WrApp *app)
{
    if (!app->settings->grid) return;
    lines_along(app, 0);
    lines_along(app, 1);
}
