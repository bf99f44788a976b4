#include "ui/canvas/overlays/snap_grid.h"
#include "ui/canvas/view.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"

#include <math.h>
#include <stdio.h>

#define NEAR_UNITS 7.0
#define CLOSEST_UNITS 5.0 /* least distance of two drawn lines */
#define LABEL_UNITS 44.0  /* least distance of two numbers on the ruler */
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

/* Distance in texels from the cell's left or upper edge, at the line's end (px, py). */
static void number(const WrCanvasView *v, int axis, double px, double py, double texel, double most)
{
    char text[24];
    double from = texel - most * floor(texel / most), tall = wr_gui_line_height(WR_FONT_SMALL);
    wr_words_print(text, sizeof text, "%.5g", from);
    double wide = wr_gui_text_width(WR_FONT_SMALL, text), gap = 3.0 * wr_gui_scale();
    double x = axis ? v->x + v->w - wide - 2 * gap : px + gap,
           y = axis ? py : v->y + v->h - tall - gap;
    wr_gui_draw_fill(x - gap, y, wide + 2 * gap, tall, WR_COLOUR_CHIP, gap);
    wr_gui_draw_text(x, y, WR_FONT_SMALL, WR_COLOUR_LABEL, text);
}

void wr_grid_line(const WrCanvasView *v, int axis, double texel, const double low[2],
                  const double high[2], WrColour colour)
{
    double x0, y0, x1, y1, width = v->turn == 0.0 ? 1.0 : 1.2;
    wr_view_place(v, axis ? low[0] : texel, axis ? texel : low[1], &x0, &y0);
    wr_view_place(v, axis ? high[0] : texel, axis ? texel : high[1], &x1, &y1);
    if (v->turn != 0.0) wr_gui_draw_line(x0, y0, x1, y1, colour, width);
    else if (axis) wr_gui_draw_fill(v->x, rint(y0), v->w, 1, colour, 0);
    else wr_gui_draw_fill(rint(x0), v->y, 1, v->h, colour, 0);
}

static void lines_along(const WrApp *app, int axis)
{
    const WrCanvasView *v = app->view;
    double step = wr_grid_step(app, axis), low[2], high[2], px, py, scale = wr_gui_scale();
    if (step * v->zoom < CLOSEST_UNITS * scale) return;
    wr_view_bounds(v, low, high);
    int each = (int)ceil(LABEL_UNITS * scale / (step * v->zoom));
    for (double k = ceil(low[axis] / step); k * step <= high[axis]; k += 1.0) {
        wr_grid_line(v, axis, k * step, low, high, LINE);
        if (fmod(k, each) != 0.0 || v->turn != 0.0) continue;
        wr_view_place(v, k * step, k * step, &px, &py);
        number(v, axis, rint(px), rint(py), k * step, axis ? v->table_h : v->table_w);
    }
}

void wr_grid_draw(const WrApp *app)
{
    if (!app->settings->grid) return;
    lines_along(app, 0);
    lines_along(app, 1);
}
